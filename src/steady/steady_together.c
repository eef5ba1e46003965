/* steady_together.c: see steady_together.h. */
#include "steady/steady_together.h"

#include <math.h>
#include <string.h>

#include "solver/newton.h"

/* A step changes the quantities by no more than this, in their scales. */
static const double longest_step = 0.3;

/* How much is added to a quantity for the Jacobian, in its scale. */
static const double difference = 0.01;

/* A Jacobian serves for so many steps; a search that takes more iterations does not converge. */
enum { STEPS = 12, ITERATIONS = 18 };

/* All in the scales of the quantities, of which there are n. */
struct solution {
    struct steady_together *together;
    struct steady_problem *problem;
    int n;
    struct steady_unknown unknown[STEADY_QUANTITIES];
    double unit[STEADY_QUANTITIES];                         /* SI */
    double u[STEADY_QUANTITIES], change[STEADY_QUANTITIES]; /* of the last evaluation */
    int n_steps;                                            /* with this Jacobian */
    struct state *begun;                                    /* where all begins */
    struct state *before, *reached;                         /* by an evaluation, for the Jacobian */
};

// the slow quantities of the fish, and what it has shed: where that is retained, the circulation around it is as much
static void list(struct solution *solution) {
    const struct steady_problem *const problem = solution->problem;
    const struct steady_map *const map = &problem->map;
    solution->n = problem->n_unknowns;
    memcpy(solution->unknown, problem->unknown, (size_t)solution->n * sizeof *solution->unknown);
    if (map->simulation->school->removed == REMOVED_RETAINED) {
        solution->unknown[solution->n++] = (struct steady_unknown){0, STEADY_SHED};
    }
    for (int i = 0; i < solution->n; i++) solution->unit[i] = steady_map_scale(map, solution->unknown[i]);
}

static void read_all(const struct solution *solution, double *value) {
    steady_map_read(&solution->problem->map, solution->n, solution->unknown, value);
    for (int i = 0; i < solution->n; i++) value[i] /= solution->unit[i];
}

static enum status put(const struct solution *solution, const double *to) {
    double add[STEADY_QUANTITIES], most = 0;
    read_all(solution, add);
    for (int i = 0; i < solution->n; i++) {
        add[i] = to[i] - add[i];
        most = fmax(most, fabs(add[i]));
        add[i] *= solution->unit[i];
    }
    // where it is there already the integration goes on
    return most > 1e-12 ? steady_map_add(&solution->problem->map, solution->n, solution->unknown, add) : STATUS_OK;
}

// what the last beat of an evaluation changes, of which each begins with these values
static enum status change_of(const struct solution *solution, const double *u, double *change) {
    for (int i = 0; i < solution->together->beats; i++) {
        TRY(put(solution, u));
        TRY(steady_problem_beat(solution->problem));
    }
    read_all(solution, change);
    for (int i = 0; i < solution->n; i++) change[i] -= u[i];
    return STATUS_OK;
}

static enum status value(void *data, const double *u, double *change) {
    struct solution *const solution = data;
    const size_t bytes = (size_t)solution->n * sizeof *u;
    TRY(steady_map_save(&solution->problem->map, &solution->before));
    TRY(change_of(solution, u, change));
    memcpy(solution->u, u, bytes);
    memcpy(solution->change, change, bytes);
    return STATUS_OK;
}

// by differences: from the same state with something added to one quantity
static enum status differences(struct solution *solution) {
    struct steady_map *const map = &solution->problem->map;
    TRY(steady_map_save(map, &solution->reached));
    for (int j = 0; j < solution->n; j++) {
        double *const column = solution->together->matrix + j * solution->n, u[STEADY_QUANTITIES];
        memcpy(u, solution->u, sizeof u);
        u[j] += difference;
        TRY(steady_map_return(map, solution->before));
        TRY(change_of(solution, u, column));
        for (int i = 0; i < solution->n; i++) column[i] = (column[i] - solution->change[i]) / difference;
    }
    solution->together->is_known = 1;
    solution->n_steps = 0;
    return steady_map_return(map, solution->reached);
}

static enum status jacobian(void *data, double *matrix) {
    struct solution *const solution = data;
    if (!solution->together->is_known || solution->n_steps == STEPS) TRY(differences(solution));
    solution->n_steps++;
    memcpy(matrix, solution->together->matrix, (size_t)(solution->n * solution->n) * sizeof *matrix);
    return STATUS_OK;
}

static enum status solve(struct solution *solution, double tolerance, int *is_done) {
    struct steady_problem *const problem = solution->problem;
    double scale[STEADY_QUANTITIES], u[STEADY_QUANTITIES];
    for (int i = 0; i < solution->n; i++) scale[i] = longest_step;
    const struct newton newton = {.n = solution->n,
                                  .scale = scale,
                                  .tolerance = tolerance / longest_step,
                                  .max_step = 1,
                                  .reuse = 1,
                                  .max_iterations = ITERATIONS,
                                  .value = value,
                                  .jacobian = jacobian,
                                  .data = solution};
    TRY(steady_map_save(&problem->map, &solution->begun));
    read_all(solution, u);
    const enum status status = newton_solve(&newton, u);
    *is_done = status == STATUS_OK;
    if (status != STATUS_SOLVER || problem->map.n_beats >= problem->settings->beats) return status;
    solution->together->is_known = 0;
    return steady_map_return(&problem->map, solution->begun);
}

enum status steady_together_solve(struct steady_together *together, struct steady_problem *problem, double tolerance,
                                  int *is_done) {
    const struct school *const school = problem->map.simulation->school;
    struct solution solution = {.together = together, .problem = problem};
    list(&solution);
    const enum status status = solve(&solution, tolerance, is_done);
    state_free(solution.begun, school);
    state_free(solution.before, school);
    state_free(solution.reached, school);
    return status;
}
