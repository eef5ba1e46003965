/* steady_search.c: see steady_search.h. */
#include "run/steady_search.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "solver/multipliers.h"
#include "solver/newton.h"

/* A step of Newton's method changes the speeds by no more than this, in lengths per beat. */
static const double longest_step = 1;

/* The change of a speed in a beat by that speed, where it is not known or makes no sense: one that grows. */
static const double first_slope = -0.2, least_slope = -0.01;

/* Each addition to the state lets the integrator begin again, with errors of its own: Newton's method stops at this
 * multiple of the tolerance. Beats follow to which nothing is added, so many before it is tried again; two in a row
 * must meet the tolerance. */
enum { ROUGH = 3, PATIENCE = 8 };

/* How much is added to a slow quantity to see what becomes of it, in its scale; the beats after which what is fast has
 * gone, and those that are looked at then. */
static const double disturbance = 0.01;
enum { FAST_BEATS = 2, SLOW_BEATS = 4 };

// ---- which quantities are slow

static void list_unknowns(struct steady_search *search) {
    const struct school *const school = search->map.simulation->school;
    for (int f = 0; f < school->n_fish; f++) {
        const enum steady_freedom freedom = steady_map_freedom(&school->fish[f]);
        if (freedom == STEADY_HELD) continue;
        search->speed[search->n_speeds++] = (struct steady_unknown){f, STEADY_SPEED};
        search->unknown[search->n_unknowns++] = (struct steady_unknown){f, STEADY_SPEED};
        if (freedom == STEADY_SURGES) continue;
        search->unknown[search->n_unknowns++] = (struct steady_unknown){f, STEADY_SLIP};
        search->unknown[search->n_unknowns++] = (struct steady_unknown){f, STEADY_TURN};
        if (school->fish[f].control.law == CONTROL_NONE) continue;
        search->unknown[search->n_unknowns++] = (struct steady_unknown){f, STEADY_HEADING};
    }
}

static enum status allocate(struct steady_search *search) {
    const size_t n_fish = (size_t)search->map.simulation->school->n_fish, most = STEADY_QUANTITIES * n_fish;
    search->unknown = calloc(most, sizeof *search->unknown);
    search->speed = calloc(n_fish, sizeof *search->speed);
    double **const arrays[] = {&search->scale, &search->from, &search->change, &search->slope};
    int is_complete = search->unknown && search->speed;
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++) {
        *arrays[i] = calloc(3 * most, sizeof **arrays[i]);
        is_complete = is_complete && *arrays[i];
    }
    return is_complete ? STATUS_OK : status_fail(STATUS_MEMORY, "out of memory: the search for a steady state");
}

// what can have no steady state
static enum status refuse(const struct steady_search *search) {
    const struct school *const school = search->map.simulation->school;
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *const fish = &school->fish[f];
        const int is_held = steady_map_freedom(fish) == STEADY_HELD;
        if (!is_held && fabs(school->shear) > 0) {
            return status_fail(STATUS_CASE,
                               "%s swims through a shear, in which the stream depends on its place: hold it "
                               "with motion.driven, or set fluid.shear to 0",
                               fish->name);
        }
        if (steady_map_freedom(fish) == STEADY_SWIMS && school->walls.n > 0) {
            return status_fail(STATUS_CASE,
                               "%s swims freely beside a wall, and nothing holds its distance from it: hold it with "
                               "motion.driven (surge: free leaves it its speed), or remove fluid.walls",
                               fish->name);
        }
        if (fish->control.n_waypoints > 0 || fish->control.n_headings > 1) {
            return status_fail(
                STATUS_CASE, "%s is to change its heading: give it one desired_heading, and no waypoints", fish->name);
        }
    }
    if (search->n_speeds > 1) {
        return status_fail(STATUS_CASE,
                           "%d fish swim at speeds of their own and do not keep their places: hold all but "
                           "one with motion.driven",
                           search->n_speeds);
    }
    return STATUS_OK;
}

enum status steady_search_create(struct steady_search *search, const struct case_values *values,
                                 struct simulation *simulation) {
    *search = (struct steady_search){.values = values};
    TRY(steady_map_create(&search->map, simulation));
    TRY(allocate(search));
    list_unknowns(search);
    return refuse(search);
}

void steady_search_free(struct steady_search *search) {
    if (search->map.simulation) state_free(search->kept, search->map.simulation->school);
    steady_map_free(&search->map);
    free(search->unknown);
    free(search->speed);
    free(search->scale);
    free(search->from);
    free(search->change);
    free(search->slope);
    *search = (struct steady_search){.n_unknowns = 0};
}

// ---- beats

static enum status no_steady_state(const struct steady_search *search) {
    const struct steady_map *const map = &search->map;
    const double residual = steady_map_residual(map), per_beat = map->simulation->school->fish[0].length / map->period;
    return status_fail(STATUS_SOLVER,
                       "no steady state in %d beats (steady.beats): from beat to beat it still changes by %.2g, more "
                       "than steady.tolerance, %.2g; %s has %.4g m/s, %.2g lengths per beat",
                       map->n_beats, residual, search->values->steady.tolerance, map->simulation->school->fish[0].name,
                       map->last[0].speed, map->last[0].speed / per_beat);
}

static enum status beat(struct steady_search *search) {
    if (search->map.n_beats >= search->values->steady.beats) return no_steady_state(search);
    TRY(steady_map_beat(&search->map, NULL, NULL));
    if (search->progress) search->progress(search, search->data);
    return STATUS_OK;
}

// ---- Newton's method on the speeds: every evaluation is a beat, and the slopes are secants of what has been seen

// a beat that began with the speeds from, after which they are to: what it tells of the slopes
static void learn(struct steady_search *search, const double *from, const double *to) {
    for (int i = 0; i < search->n_speeds; i++) {
        const double change = to[i] - from[i], way = from[i] - search->from[i];
        // below that the secant is that of the integrator's errors
        if (fabs(way) > 1e-3 * search->scale[i]) {
            search->slope[i] = fmin(least_slope, fmax(-1, (change - search->change[i]) / way));
        }
        search->from[i] = from[i];
        search->change[i] = change;
    }
}

static enum status value(void *data, const double *u, double *change) {
    struct steady_search *const search = data;
    const int n = search->n_speeds;
    double *const now = search->from + 2 * n, *const add = search->change + 2 * n;
    steady_map_read(&search->map, n, search->speed, now);
    int is_elsewhere = 0;
    for (int i = 0; i < n; i++) {
        add[i] = u[i] - now[i];
        is_elsewhere |= fabs(add[i]) > 1e-12 * search->scale[i];
    }
    if (is_elsewhere) TRY(steady_map_add(&search->map, n, search->speed, add));
    TRY(beat(search));
    steady_map_read(&search->map, n, search->speed, now);
    learn(search, u, now);
    for (int i = 0; i < n; i++) change[i] = now[i] - u[i];
    return STATUS_OK;
}

static enum status slopes(void *data, double *matrix) {
    const struct steady_search *const search = data;
    const int n = search->n_speeds;
    for (int i = 0; i < n * n; i++) matrix[i] = i % (n + 1) == 0 ? search->slope[i % n] : 0;
    return STATUS_OK;
}

static enum status solve(struct steady_search *search) {
    const struct newton problem = {.n = search->n_speeds,
                                   .scale = search->scale,
                                   .tolerance = ROUGH * search->values->steady.tolerance,
                                   .max_step = longest_step,
                                   .max_iterations = search->values->steady.beats + 1,
                                   .value = value,
                                   .jacobian = slopes,
                                   .data = search};
    double *const u = search->slope + search->n_speeds;
    steady_map_read(&search->map, search->n_speeds, search->speed, u);
    return newton_solve(&problem, u);
}

// the first beats: the muscle begins smoothly, and the wake has to grow
static enum status settle(struct steady_search *search) {
    const struct school *const school = search->map.simulation->school;
    const int n = search->n_speeds;
    double ramp = 0;
    for (int f = 0; f < school->n_fish; f++) ramp = fmax(ramp, school->fish[f].ramp);
    for (int i = 0; i < n; i++) {
        search->scale[i] = steady_map_scale(&search->map, search->speed[i]);
        search->slope[i] = first_slope;
    }
    const int n_beats = (int)fmin(1e6, ceil(ramp / search->map.period * (1 - 1e-9))) + 2;
    double *const from = search->from + n, *const to = search->from + 2 * n;
    for (int i = 0; i < n_beats; i++) {
        steady_map_read(&search->map, n, search->speed, from);
        TRY(beat(search));
        steady_map_read(&search->map, n, search->speed, to);
        learn(search, from, to);
    }
    return STATUS_OK;
}

enum status steady_search_run(struct steady_search *search) {
    const double tolerance = search->values->steady.tolerance;
    TRY(settle(search));
    int n_good = 0;
    while (n_good < 2) {
        if (search->n_speeds > 0) TRY(solve(search));
        for (int i = 0; i < PATIENCE && n_good < 2; i++) {
            TRY(beat(search));
            n_good = steady_map_residual(&search->map) <= tolerance ? n_good + 1 : 0;
        }
    }
    return STATUS_OK;
}

// ---- multipliers

// the unknowns over their scales after FAST_BEATS beats, from the state that is kept with something added, and after
// each of the SLOW_BEATS that follow: the columns of seen                              (n_unknowns, 1 + SLOW_BEATS)
static enum status follow(struct steady_search *search, const double *add, double *seen) {
    struct steady_map *const map = &search->map;
    const int n = search->n_unknowns;
    TRY(steady_map_return(map, search->kept));
    TRY(steady_map_add(map, n, search->unknown, add));
    for (int i = 1; i < FAST_BEATS; i++) TRY(steady_map_beat(map, NULL, NULL));
    for (int k = 0; k <= SLOW_BEATS; k++) {
        TRY(steady_map_beat(map, NULL, NULL));
        steady_map_read(map, n, search->unknown, seen + k * n);
        for (int i = 0; i < n; i++) seen[i + k * n] /= steady_map_scale(map, search->unknown[i]);
    }
    return STATUS_OK;
}

// what a disturbance of each unknown adds: before and after each of the SLOW_BEATS  (n_unknowns, n_unknowns SLOW_BEATS)
static enum status disturb(struct steady_search *search, double *seen, double *before, double *after) {
    const int n = search->n_unknowns, size = n * (1 + SLOW_BEATS);
    double *const add = search->from, *const base = seen, *const disturbed = seen + size;
    memset(add, 0, (size_t)n * sizeof *add);
    TRY(follow(search, add, base));
    for (int j = 0; j < n; j++) {
        memset(add, 0, (size_t)n * sizeof *add);
        add[j] = disturbance * steady_map_scale(&search->map, search->unknown[j]);
        TRY(follow(search, add, disturbed));
        for (int i = 0; i < size; i++) disturbed[i] -= base[i];
        const size_t bytes = (size_t)(n * SLOW_BEATS) * sizeof *before;
        memcpy(before + j * n * SLOW_BEATS, disturbed, bytes);
        memcpy(after + j * n * SLOW_BEATS, disturbed + n, bytes);
    }
    return STATUS_OK;
}

enum status steady_search_multipliers(struct steady_search *search, double *real, double *imaginary, int *n_beats) {
    const size_t n = (size_t)search->n_unknowns, n_columns = n * SLOW_BEATS;
    const int n_before = search->map.n_beats;
    double *const before = calloc(n * n_columns, sizeof *before), *const after = calloc(n * n_columns, sizeof *after),
                  *const seen = calloc(2 * n * (1 + SLOW_BEATS), sizeof *seen);
    enum status status = before && after && seen ? steady_map_save(&search->map, &search->kept)
                                                 : status_fail(STATUS_MEMORY, "out of memory: %zu multipliers", n);
    if (status == STATUS_OK) status = disturb(search, seen, before, after);
    if (status == STATUS_OK) {
        status = multipliers_of((int)n, (int)n_columns, before, after, real, imaginary);
    }
    if (status == STATUS_OK) status = steady_map_return(&search->map, search->kept);
    free(before);
    free(after);
    free(seen);
    *n_beats = search->map.n_beats - n_before;
    search->map.n_beats = n_before;
    return status;
}
