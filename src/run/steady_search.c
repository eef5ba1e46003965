/* steady_search.c: see steady_search.h. */
#include "run/steady_search.h"

#include <math.h>

#include "run/steady_formation.h"
#include "solver/newton.h"

/* A step of Newton's method changes the speed by no more than this, in lengths per beat. */
static const double longest_step = 1;

/* The change of the speed in a beat by the speed, where it is not known or makes no sense: one that grows. */
static const double first_slope = -0.2, least_slope = -0.01;

/* Each addition to the state lets the integrator begin again, with errors of its own: Newton's method stops at this
 * multiple of the tolerance. Beats follow to which nothing is added, so many before it is tried again; two in a row
 * must meet the tolerance. */
enum { ROUGH = 3, PATIENCE = 8 };

/* The speed of the first fish, and what is known of its change in a beat. */
struct search {
    struct steady_problem *problem;
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
    TRY(steady_problem_beat(search->problem));
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
                                   .max_iterations = settings->beats + 1,
                                   .value = value,
                                   .jacobian = slope,
                                   .data = search};
    double speed = speed_now(search);
    return newton_solve(&problem, &speed);
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

// a formation first gets one speed with its places kept; then all follows
static enum status solve(struct search *search) {
    struct steady_problem *const problem = search->problem;
    if (problem->map.is_formation && problem->n_unknowns > 0) return steady_formation_solve(problem);
    return problem->solves_speed ? solve_speed(search) : STATUS_OK;
}

enum status steady_search_run(struct steady_problem *problem) {
    struct search search = {.problem = problem, .speed = {0, STEADY_SPEED}, .slope = first_slope};
    search.scale = steady_map_scale(&problem->map, search.speed);
    TRY(settle(&search));
    if (problem->map.is_formation) {
        if (problem->solves_speed) TRY(solve_speed(&search));
        TRY(steady_problem_put_pins(problem, speed_now(&search)));
    }
    int n_good = 0;
    while (n_good < 2) {
        TRY(solve(&search));
        for (int i = 0; i < PATIENCE && n_good < 2; i++) {
            TRY(steady_problem_beat(problem));
            n_good = steady_map_residual(&problem->map) <= problem->settings->tolerance ? n_good + 1 : 0;
        }
    }
    return STATUS_OK;
}
