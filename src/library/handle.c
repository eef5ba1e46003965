/* handle.c: checks of a run, the row of an event, the restart of the integrator, and the keys that can be set at an
 * event. */
#include "library/handle.h"

#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/arena.h"
#include "base/mathematics.h"
#include "base/memory.h"
#include "fish/fish_motion.h"
#include "fish/fish_school.h"

pthread_mutex_t handle_netcdf_lock = PTHREAD_MUTEX_INITIALIZER;

// ---- forks: the parent takes the lock before a fork; the child runs without OpenMP threads, which a fork loses

static void lock_netcdf(void) {
    pthread_mutex_lock(&handle_netcdf_lock);
}

static void unlock_netcdf(void) {
    pthread_mutex_unlock(&handle_netcdf_lock);
}

static void begin_child(void) {
    pthread_mutex_unlock(&handle_netcdf_lock);
    omp_set_max_active_levels(0);
}

static void expect_forks(void) {
    pthread_atfork(lock_netcdf, unlock_netcdf, begin_child);
}

static pthread_once_t forks_once = PTHREAD_ONCE_INIT;

enum status handle_create(struct shoal **run) {
    pthread_once(&forks_once, expect_forks);

    TRY(MEMORY_NEW(*run, 1, "a run"));
    const enum status status = MEMORY_NEW((*run)->shared, 1, "a run");
    if (status != STATUS_OK) {
        free(*run);
        *run = NULL;
        return status;
    }

    atomic_init(&(*run)->shared->n_users, 1);
    (*run)->claim.descriptor[0] = (*run)->claim.descriptor[1] = -1;
    return STATUS_OK;
}

enum status handle_need(const void *pointer, const char *function, const char *name) {
    return pointer ? STATUS_OK : status_fail(STATUS_CASE, "%s: %s is NULL", function, name);
}

enum status handle_check_fish(const struct shoal *run, int fish, const char *function) {
    TRY(handle_need(run, function, "run"));

    const int n = run->simulation->school->n_fish;
    if (fish >= 0 && fish < n) return STATUS_OK;
    return status_fail(STATUS_CASE, "%s: there is no fish %d: this run has %d fish, numbered from 0", function, fish,
                       n);
}

int handle_has_failed(const struct shoal *run, const char *function) {
    if (run->has_failed) status_fail(STATUS_SOLVER, "%s: the run has failed before: %s", function, run->failure);
    return run->has_failed;
}

void handle_fail(struct shoal *run) {
    run->has_failed = 1;
    snprintf(run->failure, sizeof run->failure, "%s", status_message());
}

const struct result_row *handle_row(struct shoal *run) {
    if (!run->has_row) simulate_row(run->simulation, &run->counts, &run->row);
    if (run->is_renewed) run->counts = run->when_reached;
    run->has_row = 1;
    return &run->row;
}

void handle_forget_row(struct shoal *run) {
    run->has_row = 0;
    run->is_renewed = 0;
    memset(run->is_filled, 0, sizeof run->is_filled);
}

enum status handle_evaluate(const struct simulation *simulation) {
    MEMORY_BOUNDARY(STATUS_MEMORY);
    const struct state *const state = simulation->state;
    return residual_evaluate(simulation->residual, state->t, state->y, state->yp, simulation->residual->scratch);
}

static enum status renew_simulation(struct simulation *simulation) {
    MEMORY_BOUNDARY(STATUS_MEMORY);
    return simulate_renew(simulation);
}

enum status handle_renew(struct shoal *run) {
    if (run->is_renewed) return STATUS_OK;
    run->has_row = 0;

    // a restart that ran out of memory leaves no solver
    if (run->simulation->solver) run->simulation->integrator->count(run->simulation->solver, &run->when_reached);

    enum status status = renew_simulation(run->simulation);
    if (status == STATUS_OK) status = handle_evaluate(run->simulation);
    if (status == STATUS_OK) {
        run->is_renewed = 1;
        return STATUS_OK;
    }
    handle_fail(run);
    return status;
}

enum status handle_take_up(struct shoal *run,
                           enum status (*fill)(struct state *state, const struct school *school, const void *from),
                           const void *from, const struct integrator_counts *totals) {
    MEMORY_BOUNDARY(STATUS_MEMORY);
    const struct case_values *const values = &run->shared->values;
    struct school *school;
    TRY(fish_school_create(&school, &values->school));
    run->arena = arena_create(NULL, "a run");
    struct state *const state = state_create(run->arena, school);
    const enum status status = fill(state, school, from);
    if (status != STATUS_OK) {
        state_free(state);
        fish_school_free(school);
        return status;
    }

    // the simulation owns school and state
    run->arena = arena_create(NULL, "a run");
    run->result_path = record_path(run->arena, values);
    TRY(simulate_take_up(run->arena, &run->simulation, values, school, state, totals));
    run->is_renewed = 1;
    run->when_reached = *totals;
    return handle_evaluate(run->simulation);
}

// ---- keys that can be set at an event, with the conditions of each key

/* A change of one fish; memory: a copy, which replaces the memory of the fish after all checks. */
struct change {
    const struct fish *fish;
    const struct state *state;
    struct control_memory memory;
    int n;
    const double *values;
};

static enum status set_amplitude(struct change *change) {
    const struct fish *const fish = change->fish;
    if (!(fabs(fish->amplitude) > 0)) {
        return status_fail(
            STATUS_CASE, "wave.amplitude: the amplitude of %s in the case is 0: give an initial amplitude", fish->name);
    }
    control_set_amplitude(fish, &change->memory, change->state->t, change->values[0]);
    return STATUS_OK;
}

static enum status set_frequency(struct change *change) {
    if (change->values[0] < 0) {
        return status_fail(STATUS_CASE, "wave.frequency: %g Hz: a frequency cannot be negative", change->values[0]);
    }
    control_set_frequency(change->fish, &change->memory, change->state->t, change->values[0]);
    return STATUS_OK;
}

static enum status set_bias(struct change *change) {
    if (change->fish->control.law != CONTROL_NONE) {
        return status_fail(STATUS_CASE, "control.bias: the control law of %s sets the bias: use 'law: none'",
                           change->fish->name);
    }
    control_set_bias(change->fish, &change->memory, change->state->t, change->values[0]);
    return STATUS_OK;
}

static enum status set_heading(struct change *change) {
    const struct fish *const fish = change->fish;
    if (fish->control.law == CONTROL_NONE) {
        return status_fail(STATUS_CASE, "control.desired_heading: %s has no control law: choose a control.law",
                           fish->name);
    }
    if (control_n_waypoints(fish, &change->memory) > 0) {
        return status_fail(STATUS_CASE, "control.desired_heading: %s follows waypoints", fish->name);
    }
    control_set_heading(fish, &change->memory, change->state->t, angle_radians(change->values[0]));
    return STATUS_OK;
}

static enum status set_waypoints(struct change *change) {
    const struct fish *const fish = change->fish;
    if (fish->control.law != CONTROL_COURSE && fish->control.law != CONTROL_AVERAGED_HEADING) {
        return status_fail(STATUS_CASE, "control.waypoints: %s needs 'law: course', which has a continuous bias",
                           fish->name);
    }
    if (change->n % 2 != 0 || change->n > 2 * CONTROL_MAX_WAYPOINTS) {
        return status_fail(STATUS_CASE, "control.waypoints: %d numbers: give 1 to %d pairs", change->n,
                           CONTROL_MAX_WAYPOINTS);
    }
    control_set_waypoints(fish, &change->memory, change->n / 2, change->values, change->state->y);
    return STATUS_OK;
}

static const struct set_key {
    const char *key;
    int is_number;
    enum status (*set)(struct change *change);
} keys[] = {
    {"wave.amplitude", 1, set_amplitude},        {"wave.frequency", 1, set_frequency},    {"control.bias", 1, set_bias},
    {"control.desired_heading", 1, set_heading}, {"control.waypoints", 0, set_waypoints},
};
enum { N_KEYS = sizeof keys / sizeof *keys };

enum status handle_set_key(const struct simulation *simulation, int fish, const char *key, int n,
                           const double *values) {
    const struct set_key *found = NULL;
    for (int k = 0; k < N_KEYS; k++) {
        if (strcmp(keys[k].key, key) == 0) found = &keys[k];
    }
    if (!found) {
        return status_fail(STATUS_CASE,
                           "'%s' cannot be set: only wave.amplitude, wave.frequency, control.bias, "
                           "control.desired_heading and control.waypoints can",
                           key);
    }

    // check the values
    if (n < 1 || (found->is_number && n > 1)) {
        return status_fail(STATUS_CASE, "%s: %d numbers: give %s", key, n, found->is_number ? "one" : "pairs");
    }
    for (int i = 0; i < n; i++) {
        if (!isfinite(values[i])) return status_fail(STATUS_CASE, "%s: %g is not finite", key, values[i]);
    }

    // change a copy of the memory, then replace the memory
    struct control_memory *const memory = &simulation->state->control[fish];
    struct change change = {&simulation->school->fish[fish], simulation->state, *memory, n, values};
    TRY(found->set(&change));

    // the curvature of a joint is singular at a turn of pi
    const double amplitude = 1 + change.memory.amplitude.target;
    const double turn = fish_largest_turn(change.fish, amplitude, control_largest_bias(change.fish, &change.memory));
    if (!(turn < 3.14159)) {
        return status_fail(STATUS_CASE, "the wave would turn a joint of %s by up to %.3g rad; it must stay below 3.14",
                           change.fish->name, turn);
    }
    *memory = change.memory;
    return STATUS_OK;
}
