/* steady_search.c: see steady_search.h. */
#include "steady/steady_search.h"

#include <math.h>

#include "solver/newton.h"
#include "steady/steady_formation.h"
#include "steady/steady_reason.h"
#include "steady/steady_together.h"

/* A step of Newton's method changes the speed by no more than this, in lengths per beat. */
static const double longest_step = 1;

/* The change of the speed in a beat by the speed, where it is not known or makes no sense: one that grows. */
static const double first_slope = -0.2, least_slope = -0.01;

/* Each addition to the state lets the integrator begin again, with errors of its own: Newton's method on the speed
 * stops at this multiple of the tolerance. Beats follow to which nothing is added, so many before it is tried again;
 * two in a row must meet the tolerance. */
enum { ROUGH = 3, PATIENCE = 8 };

/* On all slow quantities of a formation it stops at this part of the tolerance, and where the beats that follow run
 * away, as they do from what is unstable, at a smaller one, by this factor, the next time; it begins where it was
 * then. */
static const double margin = 0.5, sharper = 0.3;

/* Change over the tolerance in a beat that has run away. */
static const double lost = 10;

/* Iterations of Newton's method on the speed alone; how often it is begun, and then, or at once where a fish circles,
 * that on all slow quantities; then the fish swims until it is steady. What the speed alone does not tell has a long
 * memory: an evaluation is then so many beats. */
enum { SPEED_ITERATIONS = 20, TRIES = 2, TRIES_TOGETHER = 6, AGED = 3 };

/* The speed of the first fish, and what is known of its change in a beat. */
struct search {
    struct steady_problem *problem;
    int n_tries;    /* of Newton's method on the speed alone that are left */
    int n_together; /* and on all slow quantities of the fish */
    struct steady_together together;
    double margin;       /* part of the tolerance to which a formation is solved for */
    struct state *found; /* what that came to; NULL: none has been */
    int has_failed;      /* a beat has */
    struct steady_unknown speed;
    double scale;        /* m s-1 */
    double from, change; /* in the last beat, m s-1 */
    double slope;        /* of the change by the speed, as the last two beats have it */
};

static double speed_now(const struct search *search) {
    double speed;
    steady_map_read(&search->problem->map, 1, &search->speed, &speed);
    return speed;
}

// one beat that begins with a speed: what it tells of the slope
static enum status try_beat(struct search *search, double speed, double *change) {
    const enum status status = steady_problem_beat(search->problem);
    search->has_failed = status != STATUS_OK;
    TRY(status);
    *change = speed_now(search) - speed;
    const double way = speed - search->from;
    // below that the secant is that of the integrator's errors
    if (fabs(way) > 1e-3 * search->scale) {
        search->slope = fmin(least_slope, fmax(-1, (*change - search->change) / way));
    }
    search->from = speed;
    search->change = *change;
    return STATUS_OK;
}

static enum status value(void *data, const double *speed, double *change) {
    struct search *const search = data;
    TRY(steady_problem_put_pins(search->problem, *speed));
    return try_beat(search, *speed, change);
}

static enum status slope(void *data, double *matrix) {
    const struct search *const search = data;
    *matrix = search->slope;
    return STATUS_OK;
}

static enum status solve_speed(struct search *search) {
    const struct case_steady *const settings = search->problem->settings;
    const struct newton problem = {.n = 1,
                                   .scale = &search->scale,
                                   .tolerance = ROUGH * settings->tolerance,
                                   .max_step = longest_step,
                                   .reuse = 1,
                                   .max_iterations = SPEED_ITERATIONS,
                                   .value = value,
                                   .jacobian = slope,
                                   .data = search};
    double speed = speed_now(search);
    const enum status status = newton_solve(&problem, &speed);
    if (status != STATUS_SOLVER || search->has_failed) return status;
    search->n_tries = 0;
    return STATUS_OK;
}

// the first beats: the muscle begins smoothly, and the wake has to grow
static enum status settle(struct search *search) {
    const struct steady_map *const map = &search->problem->map;
    const struct school *const school = map->simulation->school;
    double ramp = 0, change;
    for (int f = 0; f < school->n_fish; f++) ramp = fmax(ramp, school->fish[f].ramp);
    const int n_beats = (int)fmin(1e6, ceil(ramp / map->period * (1 - 1e-9))) + 2;
    for (int i = 0; i < n_beats; i++) TRY(try_beat(search, speed_now(search), &change));
    return STATUS_OK;
}

static enum status solve_fish(struct search *search) {
    if (search->n_tries-- > 0) return solve_speed(search);
    if (search->n_together-- <= 0) return STATUS_OK;
    int is_done;
    TRY(steady_together_solve(&search->together, search->problem, ROUGH * search->problem->settings->tolerance,
                              &is_done));
    if (!is_done) search->n_together = 0;
    return STATUS_OK;
}

static enum status solve(struct search *search) {
    struct steady_problem *const problem = search->problem;
    if (problem->n_unknowns == 0) return STATUS_OK;
    if (!problem->map.is_formation) return solve_fish(search);
    TRY(steady_formation_solve(problem, search->margin * problem->settings->tolerance));
    return steady_map_save(&problem->map, &search->found);
}

// the speed of a fish that circles cannot be found without its slip and turn, which remember more than a beat
static int circles(const struct school *school) {
    int circles = 0;
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *const fish = &school->fish[f];
        circles |= steady_map_freedom(fish) == STEADY_SWIMS && fabs(fish->control.bias) > 0;
    }
    return circles;
}

// beats to which nothing is added, until two in a row are steady
static enum status let_go(struct search *search, int *is_steady) {
    struct steady_problem *const problem = search->problem;
    const double tolerance = problem->settings->tolerance;
    int n_good = 0;
    double change = 0;
    for (int i = 0; i < PATIENCE && n_good < 2 && (!search->found || change <= lost * tolerance); i++) {
        TRY(steady_problem_beat(problem));
        change = steady_map_residual(&problem->map);
        n_good = change <= tolerance ? n_good + 1 : 0;
        // how the first of them compares with one that was held says nothing
        if (i == 0 && search->found) change = 0;
    }
    *is_steady = n_good == 2;
    if (*is_steady || !search->found || change <= lost * tolerance) return STATUS_OK;
    search->margin *= sharper;
    return steady_map_return(&problem->map, search->found);
}

static enum status run(struct search *search) {
    struct steady_problem *const problem = search->problem;
    TRY(settle(search));
    // a formation first gets one speed with its places kept; then all follows
    if (problem->map.is_formation) {
        if (problem->solves_speed) TRY(solve_speed(search));
        TRY(steady_problem_put_pins(problem, speed_now(search)));
    }
    for (int is_steady = 0; !is_steady;) {
        TRY(solve(search));
        TRY(let_go(search, &is_steady));
    }
    return STATUS_OK;
}

enum status steady_search_correct(struct steady_problem *problem, const double *way) {
    struct search search = {.problem = problem, .n_together = TRIES_TOGETHER, .together = {.beats = AGED}};
    int is_steady = 0;
    if (way) {
        double *const to = problem->scratch + 2 * problem->n_unknowns;
        steady_problem_read(problem, to);
        for (int i = 0; i < problem->n_unknowns; i++) to[i] += way[i];
        TRY(steady_problem_put(problem, to));
        TRY(let_go(&search, &is_steady));
    }
    while (!is_steady) {
        if (!problem->map.is_formation) TRY(solve_fish(&search));
        TRY(let_go(&search, &is_steady));
    }
    return STATUS_OK;
}

enum status steady_search_run(struct steady_problem *problem) {
    struct search search = {.problem = problem, .speed = {0, STEADY_SPEED}, .slope = first_slope, .margin = margin};
    search.scale = steady_map_scale(&problem->map, search.speed);
    const int is_circle = circles(problem->map.simulation->school);
    search.n_tries = is_circle ? 0 : TRIES;
    search.n_together = TRIES_TOGETHER;
    search.together.beats = is_circle ? 1 : AGED;
    const enum status status = run(&search);
    state_free(search.found, problem->map.simulation->school);
    const int is_late = problem->map.n_beats >= problem->settings->beats;
    if (status != STATUS_SOLVER || !is_late || !problem->map.is_formation || problem->n_unknowns == 0) return status;
    return steady_reason_find(problem);
}
