/* steady_together.c: see steady_together.h. */
#include "steady/steady_together.h"

#include <math.h>
#include <string.h>

#include "solver/newton.h"

/* Largest change of a quantity in one step, in the scale of the quantity. */
static const double longest_step = 0.3;

/* Difference increment of the Jacobian, in the scale of the quantity. */
static const double difference = 0.01;

/* STEPS: steps with one Jacobian. ITERATIONS: a search with more iterations does not converge. */
enum { STEPS = 12, ITERATIONS = 18 };

/* All values of the n quantities are in the scales of the quantities. */
struct solution {
    struct steady_together *together;
    struct steady_problem *problem;
    int n;
    struct steady_unknown unknown[STEADY_QUANTITIES];
    double unit[STEADY_QUANTITIES];                         /* SI */
    double u[STEADY_QUANTITIES], change[STEADY_QUANTITIES]; /* of the last evaluation */
    int n_steps;                                            /* with this Jacobian */
    struct state *begun;                                    /* at the start of the solution */
    struct state *before, *reached;                         /* before and after the last evaluation */
};

// list the slow quantities and, if removed circulation is retained, the shed circulation
static void list_quantities(struct solution *solution) {
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

static enum status put_quantities(const struct solution *solution, const double *to) {
    double add[STEADY_QUANTITIES], most = 0;
    read_all(solution, add);
    for (int i = 0; i < solution->n; i++) {
        add[i] = to[i] - add[i];
        most = fmax(most, fabs(add[i]));
        add[i] *= solution->unit[i];
    }

    // do not restart the integration without a change
    return most > 1e-12 ? steady_map_add(&solution->problem->map, solution->n, solution->unknown, add) : STATUS_OK;
}

// change in the last beat of an evaluation; every beat begins with the values u
static enum status evaluate_change(const struct solution *solution, const double *u, double *change) {
    for (int i = 0; i < solution->together->beats; i++) {
        TRY(put_quantities(solution, u));
        TRY(steady_problem_beat(solution->problem));
    }
    read_all(solution, change);
    for (int i = 0; i < solution->n; i++) change[i] -= u[i];
    return STATUS_OK;
}

static enum status together_value(void *data, const double *u, double *change) {
    struct solution *const solution = data;
    const size_t bytes = (size_t)solution->n * sizeof *u;
    TRY(steady_map_save(&solution->problem->map, &solution->before));
    TRY(evaluate_change(solution, u, change));
    memcpy(solution->u, u, bytes);
    memcpy(solution->change, change, bytes);
    return STATUS_OK;
}

// each column starts from the same state with an increment of one quantity
static enum status difference_jacobian(struct solution *solution) {
    struct steady_map *const map = &solution->problem->map;
    TRY(steady_map_save(map, &solution->reached));
    for (int j = 0; j < solution->n; j++) {
        double *const column = solution->together->matrix + j * solution->n, u[STEADY_QUANTITIES];
        memcpy(u, solution->u, sizeof u);
        u[j] += difference;
        TRY(steady_map_return(map, solution->before));
        TRY(evaluate_change(solution, u, column));
        for (int i = 0; i < solution->n; i++) column[i] = (column[i] - solution->change[i]) / difference;
    }

    solution->together->is_known = 1;
    solution->n_steps = 0;
    return steady_map_return(map, solution->reached);
}

static enum status together_jacobian(void *data, double *matrix) {
    struct solution *const solution = data;
    if (!solution->together->is_known || solution->n_steps == STEPS) TRY(difference_jacobian(solution));
    solution->n_steps++;
    memcpy(matrix, solution->together->matrix, (size_t)(solution->n * solution->n) * sizeof *matrix);
    return STATUS_OK;
}

static enum status together_newton(struct solution *solution, double tolerance, int *is_done) {
    struct steady_problem *const problem = solution->problem;
    double scale[STEADY_QUANTITIES], u[STEADY_QUANTITIES];
    for (int i = 0; i < solution->n; i++) scale[i] = longest_step;
    const struct newton newton = {.n = solution->n,
                                  .scale = scale,
                                  .tolerance = tolerance / longest_step,
                                  .max_step = 1,
                                  .reuse = 1,
                                  .max_iterations = ITERATIONS,
                                  .value = together_value,
                                  .jacobian = together_jacobian,
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
    list_quantities(&solution);
    const enum status status = together_newton(&solution, tolerance, is_done);
    state_free(solution.begun, school);
    state_free(solution.before, school);
    state_free(solution.reached, school);
    return status;
}
