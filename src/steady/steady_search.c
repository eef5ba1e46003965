/* steady_search.c: the search for the fixed point of the map from beat to beat, and Newton's method for all slow
 * quantities of one fish. */
#include "steady/steady_search.h"

#include <math.h>
#include <string.h>

#include "base/mathematics.h"
#include "solver/newton.h"
#include "steady/steady_formation.h"

// ---- all slow quantities of one fish

/* Settings of the evaluations of a search, and the Jacobian, which is kept between solutions. */
struct together {
    int beats; /* per evaluation; every beat begins with the same values, the last beat gives the change */
    bool is_known;
    double matrix[STEADY_QUANTITIES * STEADY_QUANTITIES]; /* by columns */
};

/* Largest change of a quantity in one step, in the scale of the quantity. */
static const double longest_together = 0.3;

/* Difference increment of the Jacobian, in the scale of the quantity. */
static const double difference = 0.01;

/* STEPS: steps with one Jacobian. ITERATIONS: a search with more iterations does not converge. */
enum { STEPS = 12, ITERATIONS = 18 };

/* All values of the n quantities are in the scales of the quantities. */
struct solution {
    struct arena *arena;
    struct together *together;
    struct steady_problem *problem;
    int n;
    struct steady_unknown unknown[STEADY_QUANTITIES];
    double unit[STEADY_QUANTITIES];                         /* SI */
    double u[STEADY_QUANTITIES], change[STEADY_QUANTITIES]; /* of the last evaluation */
    int n_steps;                                            /* with this Jacobian */
    struct state *begun;                                    /* at the start of the solution */
    struct state *before, *reached;                         /* before and after the last evaluation */
};

static void search_read_all(const struct solution *solution, double *value) {
    steady_map_read(&solution->problem->map, solution->n, solution->unknown, value);
    for (int i = 0; i < solution->n; i++) value[i] /= solution->unit[i];
}

// change in the last beat of an evaluation; every beat begins with the values u
static enum status evaluate_change(const struct solution *solution, const double *u, double *change) {
    const int n = solution->n;
    for (int beat = 0; beat < solution->together->beats; beat++) {
        double add[STEADY_QUANTITIES], most = 0;
        search_read_all(solution, add);
        for (int i = 0; i < n; i++) {
            add[i] = u[i] - add[i];
            most = larger(most, fabs(add[i]));
            add[i] *= solution->unit[i];
        }
        // do not restart the integration without a change
        if (most > 1e-12) TRY(steady_map_add(&solution->problem->map, n, solution->unknown, add));
        TRY(steady_problem_beat(solution->problem));
    }
    search_read_all(solution, change);
    for (int i = 0; i < n; i++) change[i] -= u[i];
    return STATUS_OK;
}

static enum status together_value(void *data, const double *u, double *change) {
    struct solution *const solution = data;
    const size_t bytes = (size_t)solution->n * sizeof *u;
    steady_map_save(solution->arena, solution->problem->map.simulation, &solution->before);
    TRY(evaluate_change(solution, u, change));
    memcpy(solution->u, u, bytes);
    memcpy(solution->change, change, bytes);
    return STATUS_OK;
}

static enum status together_jacobian(void *data, double *matrix) {
    struct solution *const solution = data;
    struct together *const together = solution->together;
    struct simulation *const simulation = solution->problem->map.simulation;
    const int n = solution->n;

    // each column starts from the same state with an increment of one quantity
    if (!together->is_known || solution->n_steps == STEPS) {
        steady_map_save(solution->arena, simulation, &solution->reached);
        for (int j = 0; j < n; j++) {
            double *const column = together->matrix + j * n, u[STEADY_QUANTITIES];
            memcpy(u, solution->u, sizeof u);
            u[j] += difference;
            TRY(steady_map_return(simulation, solution->before));
            TRY(evaluate_change(solution, u, column));
            for (int i = 0; i < n; i++) column[i] = (column[i] - solution->change[i]) / difference;
        }
        together->is_known = true;
        solution->n_steps = 0;
        TRY(steady_map_return(simulation, solution->reached));
    }
    solution->n_steps++;
    memcpy(matrix, together->matrix, (size_t)(n * n) * sizeof *matrix);
    return STATUS_OK;
}

// ---- the search

/* Largest change of the speed in one Newton step, in lengths per beat. After a step with a beat that fails, the search
 * returns to the state before the step, and takes smaller steps by the factor shorter; below least_step the fish swims
 * without increments of the speed alone. */
static const double longest_step = 1, shorter = 0.25, least_step = 0.01;

/* Derivative of the change of the speed per beat by the speed: initial value, and upper limit, which excludes
 * growth. */
static const double first_slope = -0.2, least_slope = -0.01;

/* Each increment of the state restarts the integrator with a restart error, so Newton's method for the speed stops at
 * ROUGH times the tolerance. At most PATIENCE beats without an increment follow before the next attempt; two successive
 * beats must meet the tolerance. */
enum { ROUGH = 3, PATIENCE = 8 };

/* Newton's method for all slow quantities of a formation stops at margin times the tolerance. If the following beats
 * diverge, as from an unstable state, the next attempt starts from the last solution with a margin smaller by the
 * factor sharper. */
static const double margin = 0.5, sharper = 0.3;

/* Change per beat over the tolerance above which the beats diverge. */
static const double lost = 10;

/* A search from the state of a neighbour has no wake to grow, and knows the slope from the neighbour's multipliers.
 * After one beat it takes Newton steps with this slope, because the wake still changes in these beats, which a secant
 * would count as the effect of the speed; only after CHORDS beats it takes secants. */
enum { CHORDS = 8 };

/* SPEED_ITERATIONS: iterations of Newton's method for the speed alone. TRIES: attempts for the speed alone, none for a
 * circling fish. TRIES_TOGETHER: subsequent attempts for all slow quantities; afterwards the fish swims until the state
 * is steady. AGED: beats of an evaluation for all slow quantities, because the other quantities have a long memory. */
enum { SPEED_ITERATIONS = 20, TRIES = 2, TRIES_TOGETHER = 6, AGED = 3 };

/* State of the search: speed of the first fish and change of the speed per beat. */
struct search {
    struct steady_problem *problem;
    int n_tries;    /* remaining attempts for the speed alone */
    int n_together; /* remaining attempts for all slow quantities of the fish */
    struct together together;
    double margin;       /* tolerance of Newton's method for a formation, over the tolerance */
    struct state *found; /* last solution for a formation; NULL: none */
    struct state *begun; /* state before the last attempt for the speed alone; NULL: none */
    bool has_failed;     /* a beat failed */
    int n_chords;        /* beats in which the slope stays */
    struct steady_unknown speed;
    double scale;        /* m s-1 */
    double step;         /* largest change of the speed in one Newton step, in lengths per beat */
    double from, change; /* speed before the last beat and change in the last beat, m s-1 */
    double slope;        /* derivative of the change by the speed: secant of the last two beats */
};

static double speed_now(const struct search *search) {
    double speed;
    steady_map_read(&search->problem->map, 1, &search->speed, &speed);
    return speed;
}

// simulate one beat from this speed and update the slope
static enum status try_beat(struct search *search, double speed, double *change) {
    const enum status status = steady_problem_beat(search->problem);
    search->has_failed = status != STATUS_OK;
    TRY(status);
    *change = speed_now(search) - speed;
    const double way = speed - search->from;

    // integration errors dominate the secant of a shorter step
    if (fabs(way) > 1e-3 * search->scale && search->problem->map.n_beats > search->n_chords) {
        search->slope = fmin(least_slope, fmax(-1, (*change - search->change) / way));
    }

    search->from = speed;
    search->change = *change;
    return STATUS_OK;
}

static enum status speed_value(void *data, const double *speed, double *change) {
    struct search *const search = data;
    TRY(steady_problem_put_pins(search->problem, *speed));
    return try_beat(search, *speed, change);
}

static enum status speed_slope(void *data, double *matrix) {
    const struct search *const search = data;
    *matrix = search->slope;
    return STATUS_OK;
}

static enum status solve_speed(struct search *search) {
    const struct case_steady *const settings = search->problem->settings;
    const struct newton problem = {.n = 1,
                                   .scale = &search->scale,
                                   .tolerance = ROUGH * settings->tolerance,
                                   .max_step = search->step,
                                   .reuse = 1,
                                   .max_iterations = SPEED_ITERATIONS,
                                   .value = speed_value,
                                   .jacobian = speed_slope,
                                   .data = search};
    struct steady_map *const map = &search->problem->map;
    double speed = speed_now(search);
    steady_map_save(map->simulation->arena, map->simulation, &search->begun);
    const enum status status = newton_solve(map->simulation->arena, &problem, &speed);
    if (status != STATUS_SOLVER || map->n_beats >= settings->beats) return status;

    search->n_tries = 0;
    if (!search->has_failed) return STATUS_OK;
    search->step *= shorter;
    if (search->step >= least_step) search->n_tries = TRIES;
    return steady_map_return(map->simulation, search->begun);
}

// solve for the speed of the only fish, later for all slow quantities
static enum status solve_fish(struct search *search) {
    if (search->n_tries-- > 0) return solve_speed(search);
    if (search->n_together-- <= 0) return STATUS_OK;
    struct steady_problem *const problem = search->problem;
    const struct steady_map *const map = &problem->map;
    struct arena *const arena = arena_create(map->simulation->arena, "the slow quantities of a fish");
    struct solution solution = {
        .arena = arena, .together = &search->together, .problem = problem, .n = problem->n_unknowns};

    // the slow quantities and, if removed circulation is retained, the shed circulation
    memcpy(solution.unknown, problem->unknown, (size_t)solution.n * sizeof *solution.unknown);
    if (map->simulation->school->removed == REMOVED_RETAINED) {
        solution.unknown[solution.n++] = (struct steady_unknown){0, STEADY_SHED};
    }
    double scale[STEADY_QUANTITIES], u[STEADY_QUANTITIES];
    for (int i = 0; i < solution.n; i++) {
        solution.unit[i] = steady_map_scale(map, solution.unknown[i]);
        scale[i] = longest_together;
    }

    const struct newton newton = {.n = solution.n,
                                  .scale = scale,
                                  .tolerance = ROUGH * problem->settings->tolerance / longest_together,
                                  .max_step = 1,
                                  .reuse = 1,
                                  .max_iterations = ITERATIONS,
                                  .value = together_value,
                                  .jacobian = together_jacobian,
                                  .data = &solution};
    steady_map_save(arena, map->simulation, &solution.begun);
    search_read_all(&solution, u);
    enum status status = newton_solve(arena, &newton, u);

    // without convergence return to the start; the fish then swims until the state is steady
    if (status == STATUS_SOLVER && map->n_beats < problem->settings->beats) {
        search->together.is_known = false;
        search->n_together = 0;
        status = steady_map_return(map->simulation, solution.begun);
    }
    arena_free(arena);
    return status;
}

// simulate beats without increments until the changes of the last two beats meet the tolerance
static enum status swim_freely(struct search *search, bool *is_steady) {
    struct steady_problem *const problem = search->problem;
    const double tolerance = problem->settings->tolerance;
    double change = INFINITY;
    bool is_lost = false;
    *is_steady = false;

    for (int i = 0; i < PATIENCE && !*is_steady && !is_lost; i++) {
        const double before = change;
        TRY(steady_problem_beat(problem));
        change = steady_map_residual(&problem->map);
        *is_steady = larger(before, change) <= tolerance;

        // of a result that is extrapolated, two free beats must agree about the slow disturbance that is left
        if (isfinite(problem->multiplier)) {
            *is_steady = i > 0 && change <= ROUGH * tolerance && steady_problem_residual(problem) <= tolerance;
        }

        // the change from a beat with held quantities to the first free beat has no meaning
        is_lost = search->found && i > 0 && !(change <= lost * tolerance);
    }

    if (!is_lost) return STATUS_OK;
    search->margin *= sharper;

    return steady_map_return(problem->map.simulation, search->found);
}

// the beats in which the ramp of the muscle ends
static int ramp_beats(const struct steady_map *map) {
    const struct school *const school = map->simulation->school;
    double ramp = 0;
    for (int f = 0; f < school->n_fish; f++) ramp = fmax(ramp, school->fish[f].ramp);
    return (int)fmin(1e6, ceil(ramp / map->period * (1 - 1e-9)));
}

static enum status run_search(struct search *search) {
    struct steady_problem *const problem = search->problem;

    // the first beats: the muscle ramp ends and the wake grows
    const struct steady_map *const map = &search->problem->map;
    double change;
    const int n_beats = problem->is_near ? 1 : ramp_beats(map) + 2;
    for (int i = 0; i < n_beats; i++) TRY(try_beat(search, speed_now(search), &change));

    // solve for a common speed of a formation at the initial places first, then for all unknowns
    if (problem->map.is_formation && !problem->is_near) {
        if (problem->solves_speed) TRY(solve_speed(search));
        TRY(steady_problem_put_pins(problem, speed_now(search)));
    }

    for (bool is_steady = false; !is_steady;) {
        if (problem->map.is_formation && problem->n_unknowns > 0) {
            TRY(steady_formation_solve(problem, search->margin * problem->settings->tolerance));
            steady_map_save(map->simulation->arena, map->simulation, &search->found);
        } else if (problem->n_unknowns > 0) {
            TRY(solve_fish(search));
        }
        TRY(swim_freely(search, &is_steady));
    }

    return STATUS_OK;
}

/* Longest lifetime of a wake, in beats, for which unknowns are held, and the beats after it. Two plates in line
 * whose wake lives for 3 beats: after 1, 2, 3, 5 and 8 more beats their places change by 7e-3, 4e-3, 2e-3, 1.5e-4
 * and 1.1e-4 lengths a beat as soon as they are released. */
static const double longest_wake = 30;
enum { SETTLING_BEATS = 5 };

enum status steady_search_hold(struct steady_problem *problem, const double *value, double *change) {
    // until the wake of the first beats is gone, and what it did to the wakes of others: the number of beats must not
    // depend on the values, whose differences give derivatives
    const struct steady_map *const map = &problem->map;
    const double lifetime = map->simulation->school->lifetime / map->period;
    const int n_beats = ramp_beats(map) + SETTLING_BEATS + (int)ceil(smaller(lifetime, longest_wake));
    for (int beat = 0; beat < n_beats; beat++) {
        TRY(steady_problem_put(problem, value));
        TRY(steady_map_beat(&problem->map, NULL, NULL));
        if (problem->progress) problem->progress(problem, problem->data);
    }
    steady_problem_read(problem, change);
    for (int i = 0; i < problem->n_unknowns; i++) change[i] -= value[i];
    return STATUS_OK;
}

enum status steady_search_correct(struct steady_problem *problem, const double *way) {
    struct search search = {.problem = problem, .n_together = TRIES_TOGETHER, .together = {.beats = AGED}};
    bool is_steady = false;
    if (way) {
        double *const to = problem->scratch + 2 * problem->n_unknowns;
        steady_problem_read(problem, to);
        for (int i = 0; i < problem->n_unknowns; i++) to[i] += way[i];
        TRY(steady_problem_put(problem, to));
        TRY(swim_freely(&search, &is_steady));
    }

    while (!is_steady) {
        if (!problem->map.is_formation) TRY(solve_fish(&search));
        TRY(swim_freely(&search, &is_steady));
    }

    return STATUS_OK;
}

enum status steady_search_run(struct steady_problem *problem) {
    struct search search = {
        .problem = problem, .speed = {0, STEADY_SPEED}, .slope = first_slope, .step = longest_step, .margin = margin};
    search.scale = steady_map_scale(&problem->map, search.speed);
    if (problem->is_near) {
        search.from = speed_now(&search);
        if (isfinite(problem->multiplier)) {
            search.slope = problem->multiplier - 1;
            search.n_chords = CHORDS;
        }
    }

    // the speed of a circling fish depends on slip and turn, which have a memory of several beats
    const struct school *const school = problem->map.simulation->school;
    bool is_circle = false;
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *const fish = &school->fish[f];
        is_circle |= steady_map_freedom(fish) == STEADY_SWIMS && fabs(fish->control.bias) > 0;
    }
    search.n_tries = is_circle ? 0 : TRIES;
    search.n_together = TRIES_TOGETHER;
    search.together.beats = is_circle ? 1 : AGED;
    const enum status status = run_search(&search);
    const bool is_late = problem->map.n_beats >= problem->settings->beats;
    if (status != STATUS_SOLVER || !is_late || !problem->map.is_formation || problem->n_unknowns == 0) return status;

    return steady_reason_find(problem);
}
