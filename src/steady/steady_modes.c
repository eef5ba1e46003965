/* steady_modes.c: how stable the state is: the modes of an equilibrium, and the multipliers of a beat. */
#include <math.h>
#include <string.h>

#include "base/mathematics.h"
#include "fish/fish_motion.h"
#include "flow/flow.h"
#include "run/simulate.h"
#include "solver/modes.h"
#include "solver/newton.h"
#include "state/state.h"
#include "steady/steady_problem.h"

/* Wake length, in body lengths: the growth rates agree with an infinite wake to 1e-4 of speed over length. */
static const double wake_lengths = 12;
enum { MOST_EVENTS = 4000 };

static void set_growth(struct steady_values *found) {
    found->growth = found->n_exponents > 0 ? found->rate[0] : NAN;
    found->growth_frequency = found->n_exponents > 0 ? found->omega[0] / (2 * M_PI) : NAN;
}

// ---- an equilibrium

/* Set the bodies to the positions at time t: the whole body moves at the velocity of the first node. */
static void hold_bodies(const struct simulation *simulation, const struct state *equilibrium, double t) {
    const struct school *const school = simulation->school;
    struct state *const state = simulation->state;
    memcpy(state->y, equilibrium->y, (size_t)school->n_unknowns * sizeof *state->y);
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *const fish = &school->fish[f];
        double position[2], velocity[2], acceleration[2];
        fish_prescribed_node(fish, 0, equilibrium->t, position, velocity, acceleration);
        for (int i = 0; i < 2 * fish->n_nodes; i++) {
            state->y[fish->at.x + i] += (t - equilibrium->t) * velocity[i / fish->n_nodes];
        }
    }
}

enum status steady_modes_find(struct simulation *simulation, struct steady_values *found) {
    const struct school *const school = simulation->school;
    struct state *const state = simulation->state;
    const struct fish *const fish = &school->fish[0];

    // the number of events until the wakes are long enough; 0 without a stream
    double stream[2], position[2], velocity[2], acceleration[2];
    fish_prescribed_node(fish, 0, 0, position, velocity, acceleration);
    flow_external(school, 0, position[0], position[1], &stream[0], &stream[1]);
    const double speed = hypot(stream[0] - velocity[0], stream[1] - velocity[1]);
    const double duration = fmin(school->lifetime, wake_lengths * fish->length / speed);
    const int n_events = speed > 0 ? (int)fmin(MOST_EVENTS, duration / school->interval) : 0;
    found->n_exponents = 0;
    set_growth(found);
    if (n_events == 0 || school->finite || school->shedding == SHEDDING_IMPULSIVE || !(school->density > 0)) {
        return STATUS_OK;
    }

    // the held bodies grow a wake
    struct arena *const arena = arena_create(simulation->arena, "the modes of the bodies");
    struct state *kept = NULL;
    int jumped, n_most = STEADY_QUANTITIES * school->n_fish;
    steady_map_save(arena, simulation, &kept);
    TRY(event_start(state, simulation->residual, simulation->consistent));
    hold_bodies(simulation, kept, state->t);
    for (int i = 0; i < n_events; i++) {
        if (simulation->stop && *simulation->stop) {
            return status_fail(STATUS_STOPPED, "stopped %s before the modes were found",
                               simulate_stopped_by(simulation->stop));
        }
        hold_bodies(simulation, kept, fish_event_time(school, state->event + 1));
        TRY(event_next(state, simulation->residual, simulation->consistent, &jumped));
    }

    // the modes of the bodies with this wake
    struct mode *mode;
    NEW(arena, mode, n_most);
    TRY(modes_find(arena, simulation->residual, state, n_most, mode, &found->n_exponents));
    for (int i = 0; i < found->n_exponents; i++) {
        found->rate[i] = mode[i].rate;
        found->omega[i] = mode[i].omega;
    }
    TRY(steady_map_return(simulation, kept));
    arena_free(arena);
    set_growth(found);
    simulate_measure(simulation);
    return STATUS_OK;
}

// ---- a beat

void steady_modes_of_multipliers(struct steady_values *found, double period) {
    found->n_exponents = 0;
    for (int i = 0; i < found->n_multipliers; i++) {
        const double size = hypot(found->real[i], found->imaginary[i]);
        // take the first multiplier of a complex pair; a zero multiplier has no rate
        if (found->imaginary[i] < 0 || !(size > 0)) continue;
        found->rate[found->n_exponents] = log(size) / period;
        found->omega[found->n_exponents++] = atan2(found->imaginary[i], found->real[i]) / period;
    }
    set_growth(found);
}

// ---- multipliers

/* disturbance: increment of a slow quantity, in the scale of the quantity; a disturbance that grows beyond small is
 * followed no further. Of at most BEATS beats the last SLOW_BEATS count, and not the first two, in which the fast
 * quantities decay. */
static const double disturbance = 0.01, small = 0.1;
enum { BEATS = 8, SLOW_BEATS = 4 };

/* base, seen: the unknowns, over the scales, after each beat; the first column holds the start. before, after: the
 * columns used for the multipliers, before and after a beat. */
struct disturbances {
    struct steady_problem *problem;
    struct state *kept;        /* undisturbed state */
    double *add, *base, *seen; /* (n_unknowns), (n_unknowns, BEATS + 1) */
    double *before, *after;    /* (n_unknowns, n_columns) */
    int n_columns;
};

// simulate from the kept state plus the increment; subtract the undisturbed beats, unless NULL, and stop above small
static enum status follow_disturbance(struct disturbances *all, double *seen, const double *without, int *n_beats) {
    struct steady_map *const map = &all->problem->map;
    const int n = all->problem->n_unknowns;
    TRY(steady_map_return(map->simulation, all->kept));
    TRY(steady_map_add(map, n, all->problem->unknown, all->add));

    for (*n_beats = 0; *n_beats < BEATS; ++*n_beats) {
        double *const now = seen + (*n_beats + 1) * n;
        TRY(steady_map_beat(map, NULL, NULL));
        steady_problem_read(all->problem, now);
        double most = 0;
        for (int i = 0; i < n && without; i++) {
            now[i] -= without[i + (*n_beats + 1) * n];
            most = larger(most, fabs(now[i]));
        }
        if (*n_beats > 0 && !(most <= small)) break;
    }

    return STATUS_OK;
}

// disturb each unknown and collect the columns before and after the last beats
static enum status disturb_each_unknown(struct disturbances *all) {
    const struct steady_problem *const problem = all->problem;
    const size_t n = (size_t)problem->n_unknowns, bytes = n * sizeof *all->seen;
    int n_beats;
    TRY(follow_disturbance(all, all->base, NULL, &n_beats));
    for (size_t j = 0; j < n; j++) {
        memset(all->add, 0, bytes);
        all->add[j] = disturbance * steady_map_scale(&problem->map, problem->unknown[j]);
        TRY(follow_disturbance(all, all->seen, all->base, &n_beats));

        // at least one beat
        int first = n_beats - SLOW_BEATS;
        if (first < 2) first = n_beats > 2 ? 2 : 1;
        for (int k = first; k == first || k < n_beats; k++) {
            memcpy(all->before + (size_t)all->n_columns * n, all->seen + (size_t)k * n, bytes);
            memcpy(all->after + (size_t)all->n_columns * n, all->seen + (size_t)(k + 1) * n, bytes);
            all->n_columns++;
        }
    }
    return STATUS_OK;
}

enum status steady_multipliers_find(struct steady_problem *problem, double *real, double *imaginary, double *way,
                                    int *n_beats) {
    struct simulation *const simulation = problem->map.simulation;
    struct arena *const arena = arena_create(simulation->arena, "the multipliers");
    const size_t n = (size_t)problem->n_unknowns;
    const int n_before = problem->map.n_beats;
    struct disturbances all = {.problem = problem};
    NEW(arena, all.add, n);
    NEW(arena, all.base, n * (BEATS + 1));
    NEW(arena, all.seen, n * (BEATS + 1));
    NEW(arena, all.before, n * n * SLOW_BEATS);
    NEW(arena, all.after, n * n * SLOW_BEATS);

    steady_map_save(arena, simulation, &all.kept);
    enum status status = disturb_each_unknown(&all);
    if (status == STATUS_OK) {
        // change per beat without a disturbance, mean of the last beats; stored in add, which is free now
        const double *const last = all.base + BEATS * n, *const first = last - SLOW_BEATS * n;
        for (size_t i = 0; i < n; i++) all.add[i] = (last[i] - first[i]) / SLOW_BEATS;
        status = newton_multipliers(arena, (int)n, all.n_columns, all.before, all.after, all.add, real, imaginary, way);
    }

    if (status == STATUS_OK) status = steady_map_return(simulation, all.kept);
    arena_free(arena);
    *n_beats = problem->map.n_beats - n_before;
    problem->map.n_beats = n_before;
    return status;
}
