/* steady_formation.c: see steady_formation.h. */
#include "run/steady_formation.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "run/steady_reason.h"
#include "solver/newton.h"

/* A step changes the slow quantities by no more than this, in lengths, and in their other scales. */
static const double longest_step = 0.25;

/* How much is added to a quantity for the Jacobian, in its scale. */
static const double difference = 0.01;

/* A step that leaves more than this of the change asks for a new Jacobian. */
static const double least_progress = 0.7;

/* Beats of an evaluation, each of which begins with the same slow quantities, so that the wake becomes that of fish
 * which have always had them. The last one counts. */
enum { BEATS = 5 };

/* All in the scales of the quantities. */
struct formation {
    struct steady_problem *problem;
    double *u, *change; /* of the last evaluation                         (n_unknowns) */
    double *held;       /* for a column of the Jacobian                   (n_unknowns) */
    double *matrix;     /* the Jacobian, column after column              (n_unknowns, n_unknowns) */
    double before;      /* norm of the change before the last step */
    struct state *begun, *reached;
};

// the change in the last of some beats, each of which begins with the same values
static enum status change_of(struct formation *formation, const double *u, double *change) {
    struct steady_problem *const problem = formation->problem;
    for (int i = 0; i < BEATS; i++) {
        TRY(steady_problem_put(problem, u));
        TRY(steady_problem_beat(problem));
    }
    steady_problem_read(problem, change);
    for (int i = 0; i < problem->n_unknowns; i++) change[i] -= u[i];
    return STATUS_OK;
}

static enum status value(void *data, const double *u, double *change) {
    struct formation *const formation = data;
    const size_t bytes = (size_t)formation->problem->n_unknowns * sizeof *u;
    TRY(steady_map_save(&formation->problem->map, &formation->begun));
    TRY(change_of(formation, u, change));
    memcpy(formation->u, u, bytes);
    memcpy(formation->change, change, bytes);
    return STATUS_OK;
}

static double norm(int n, const double *value) {
    double square = 0;
    for (int i = 0; i < n; i++) square += value[i] * value[i];
    return sqrt(square);
}

// each place has to tell
static enum status check_places(const struct formation *formation) {
    const struct steady_problem *const problem = formation->problem;
    for (int j = 0; j < problem->n_unknowns; j++) {
        const enum steady_quantity quantity = problem->unknown[j].quantity;
        if (quantity != STEADY_AHEAD && quantity != STEADY_ASIDE) continue;
        TRY(steady_reason_check(problem, norm(problem->n_unknowns, formation->matrix + j * problem->n_unknowns)));
    }
    return STATUS_OK;
}

// by differences: from the same state with something added to one quantity
static enum status differences(struct formation *formation) {
    struct steady_map *const map = &formation->problem->map;
    const int n = formation->problem->n_unknowns;
    memcpy(formation->held, formation->u, (size_t)n * sizeof *formation->held);
    TRY(steady_map_save(map, &formation->reached));
    for (int j = 0; j < n; j++) {
        double *const column = formation->matrix + j * n;
        TRY(steady_map_return(map, formation->begun));
        formation->held[j] += difference;
        TRY(change_of(formation, formation->held, column));
        formation->held[j] = formation->u[j];
        for (int i = 0; i < n; i++) column[i] = (column[i] - formation->change[i]) / difference;
    }
    TRY(steady_map_return(map, formation->reached));
    return check_places(formation);
}

static enum status jacobian(void *data, double *matrix) {
    struct formation *const formation = data;
    const int n = formation->problem->n_unknowns;
    const double now = norm(n, formation->change);
    if (now > least_progress * formation->before) TRY(differences(formation));
    formation->before = now;
    memcpy(matrix, formation->matrix, (size_t)n * (size_t)n * sizeof *matrix);
    return STATUS_OK;
}

static enum status solve(struct formation *formation, double tolerance, double *scale, double *u) {
    const struct steady_problem *const problem = formation->problem;
    const int n = problem->n_unknowns;
    for (int i = 0; i < n; i++) scale[i] = longest_step;
    steady_problem_read(problem, u);
    const struct newton newton = {.n = n,
                                  .scale = scale,
                                  .tolerance = tolerance / longest_step,
                                  .max_step = 1,
                                  .reuse = 1,
                                  .max_iterations = problem->settings->beats,
                                  .value = value,
                                  .jacobian = jacobian,
                                  .data = formation};
    return newton_solve(&newton, u);
}

enum status steady_formation_solve(struct steady_problem *problem, double tolerance) {
    const struct school *const school = problem->map.simulation->school;
    const size_t n = (size_t)problem->n_unknowns;
    double *const memory = calloc((5 + n) * n, sizeof *memory);
    if (!memory) return status_fail(STATUS_MEMORY, "out of memory: a formation of %d fish", school->n_fish);
    struct formation formation = {
        .problem = problem, .u = memory, .change = memory + n, .held = memory + 2 * n, .matrix = memory + 5 * n};
    const enum status status = solve(&formation, tolerance, memory + 3 * n, memory + 4 * n);
    state_free(formation.begun, school);
    state_free(formation.reached, school);
    free(memory);
    return status;
}
