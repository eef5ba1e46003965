/* steady_formation.c: see steady_formation.h. */
#include "run/steady_formation.h"

#include <stdlib.h>

#include "solver/newton.h"

/* A step changes the slow quantities by no more than this, in lengths, and in their other scales. */
static const double longest_step = 0.25;

/* How much is added to a quantity for the Jacobian, in its scale. */
static const double difference = 0.01;

/* Beats of an evaluation, of which the last one counts, and steps with one Jacobian, which takes as many beats for each
 * unknown; Newton's method stops at this multiple of the tolerance, since what it adds disturbs for some beats. */
enum { BEATS = 3, REUSE = 3, ROUGH = 3 };

struct formation {
    struct steady_problem *problem;
    double *change; /* over the last beat of an evaluation                   (n_unknowns) */
    double *before; /*                                                       (n_unknowns) */
    struct state *begun, *reached;
};

static enum status late_change(struct formation *formation, double *change) {
    struct steady_problem *const problem = formation->problem;
    const int n = problem->n_unknowns;
    for (int i = 1; i < BEATS; i++) TRY(steady_problem_beat(problem));
    steady_map_read(&problem->map, n, problem->unknown, formation->before);
    TRY(steady_problem_beat(problem));
    steady_map_read(&problem->map, n, problem->unknown, change);
    for (int i = 0; i < n; i++) change[i] -= formation->before[i];
    return STATUS_OK;
}

static enum status value(void *data, const double *u, double *change) {
    struct formation *const formation = data;
    struct steady_problem *const problem = formation->problem;
    TRY(steady_problem_put(problem, problem->n_unknowns, problem->unknown, u));
    TRY(steady_map_save(&problem->map, &formation->begun));
    TRY(late_change(formation, change));
    for (int i = 0; i < problem->n_unknowns; i++) formation->change[i] = change[i];
    return STATUS_OK;
}

static enum status jacobian(void *data, double *matrix) {
    struct formation *const formation = data;
    struct steady_map *const map = &formation->problem->map;
    const int n = formation->problem->n_unknowns;
    TRY(steady_map_save(map, &formation->reached));
    for (int j = 0; j < n; j++) {
        const struct steady_unknown *const unknown = &formation->problem->unknown[j];
        const double add = difference * steady_map_scale(map, *unknown);
        TRY(steady_map_return(map, formation->begun));
        TRY(steady_map_add(map, 1, unknown, &add));
        TRY(late_change(formation, matrix + j * n));
        for (int i = 0; i < n; i++) matrix[i + j * n] = (matrix[i + j * n] - formation->change[i]) / add;
    }
    return steady_map_return(map, formation->reached);
}

static enum status solve(struct formation *formation, double *scale, double *u) {
    const struct steady_problem *const problem = formation->problem;
    const int n = problem->n_unknowns;
    for (int i = 0; i < n; i++) scale[i] = longest_step * steady_map_scale(&problem->map, problem->unknown[i]);
    steady_map_read(&problem->map, n, problem->unknown, u);
    const struct newton newton = {.n = n,
                                  .scale = scale,
                                  .tolerance = ROUGH * problem->settings->tolerance / longest_step,
                                  .max_step = 1,
                                  .reuse = REUSE,
                                  .max_iterations = problem->settings->beats,
                                  .value = value,
                                  .jacobian = jacobian,
                                  .data = formation};
    return newton_solve(&newton, u);
}

enum status steady_formation_solve(struct steady_problem *problem) {
    const struct school *const school = problem->map.simulation->school;
    const size_t n = (size_t)problem->n_unknowns;
    double *const memory = calloc(4 * n, sizeof *memory);
    if (!memory) return status_fail(STATUS_MEMORY, "out of memory: a formation of %d fish", school->n_fish);
    struct formation formation = {.problem = problem, .change = memory, .before = memory + n};
    const enum status status = solve(&formation, memory + 2 * n, memory + 3 * n);
    state_free(formation.begun, school);
    state_free(formation.reached, school);
    free(memory);
    return status;
}
