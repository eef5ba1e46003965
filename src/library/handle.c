/* handle.c: creation and checks of a run, the row of an event, the restart of the integrator, and the keys that can be
 * set at an event. */
#include "library/handle.h"

#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <string.h>

#include "base/mathematics.h"
#include "fish/fish_gait.h"
#include "fish/fish_school.h"

static pthread_mutex_t netcdf_lock = PTHREAD_MUTEX_INITIALIZER;

// ---- forks: the parent takes the lock before a fork; the child runs without OpenMP threads, which a fork loses

static void lock_netcdf(void) {
    pthread_mutex_lock(&netcdf_lock);
}

static void unlock_netcdf(void) {
    pthread_mutex_unlock(&netcdf_lock);
}

static bool is_child;

static void begin_child(void) {
    unlock_netcdf();
    is_child = true;
    omp_set_max_active_levels(0);
}

static void expect_forks(void) {
    pthread_atfork(lock_netcdf, unlock_netcdf, begin_child);
}

static pthread_once_t forks_once = PTHREAD_ONCE_INIT;

// ---- parts of the public functions

// a jump may have come from anywhere in the computation
static enum status lack_memory(struct shoal *run) {
    if (!run) return STATUS_MEMORY;
    run->is_torn = true;
    run->has_row = false;
    return STATUS_MEMORY;
}

enum status handle_call(struct shoal *run, handle_part *part, const void *data) {
    MEMORY_BOUNDARY(lack_memory(run));

    // the limit belongs to a thread, and the child may have new ones
    if (is_child) omp_set_max_active_levels(0);
    return part(run, data);
}

enum status handle_with_netcdf(struct shoal *run, handle_part *part, const void *data) {
    lock_netcdf();
    const enum status status = handle_call(run, part, data);
    unlock_netcdf();
    return status;
}

_Thread_local const volatile sig_atomic_t *handle_stop;

/* A run in the making: the arena is there first, then the run. */
struct creation {
    struct arena **arena;
    struct shoal **run;
    const struct shoal *of; /* the run of whose case this is another run; NULL: none */
};

// create a run without a simulation
static enum status create_empty(struct shoal *run, const void *data) {
    (void)run;
    const struct creation *const creation = data;
    const struct shoal *const of = creation->of;
    struct arena *const arena = *creation->arena = arena_create(NULL, "a run");
    struct shoal *created;
    NEW(arena, created, 1);
    created->arena = arena;
    created->claim.descriptor[0] = created->claim.descriptor[1] = -1;
    if (of) {
        created->shared = of->shared;
        atomic_fetch_add(&created->shared->n_users, 1);
    } else {
        struct arena *const of_case = arena_create(arena, "the case of a run");
        NEW(of_case, created->shared, 1);
        atomic_init(&created->shared->n_users, 1);
        created->shared->arena = of_case;
        arena_move(of_case, NULL);
    }
    *creation->run = created;
    return STATUS_OK;
}

void handle_release(struct shoal *run) {
    simulate_free(run->simulation);

    // the last copy of the run releases the case
    struct shared *const shared = run->shared;
    if (atomic_fetch_sub(&shared->n_users, 1) == 1) {
        case_free(&shared->values);
        arena_free(shared->arena);
    }
    arena_free(run->arena);
}

enum status handle_create(struct shoal **run, const struct shoal *of, handle_part *fill, const void *data) {
    pthread_once(&forks_once, expect_forks);
    struct arena *arena = NULL;
    *run = NULL;
    enum status status = handle_call(NULL, create_empty, &(struct creation){&arena, run, of});
    if (status == STATUS_OK) status = handle_call(*run, fill, data);
    if (status == STATUS_OK) return STATUS_OK;
    if (*run) {
        handle_release(*run);
    } else {
        arena_free(arena);
    }
    *run = NULL;
    return status;
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

enum status handle_check_alive(const struct shoal *run, const char *function) {
    TRY(handle_need(run, function, "run"));
    if (!run->has_failed) return STATUS_OK;
    return status_fail(STATUS_SOLVER, "%s: the run has failed before: %s", function, run->failure);
}

void handle_fail(struct shoal *run) {
    run->has_failed = true;
    snprintf(run->failure, sizeof run->failure, "%s", status_message());
}

// ---- the present event

const struct result_row *handle_row(struct shoal *run) {
    if (!run->has_row) simulate_row(run->simulation, &run->counts, &run->row);
    if (run->is_renewed) run->counts = run->when_reached;
    run->has_row = true;
    return &run->row;
}

void handle_forget_row(struct shoal *run) {
    run->has_row = run->is_renewed = false;
    memset(run->is_filled, 0, sizeof run->is_filled);
}

enum status handle_evaluate(const struct simulation *simulation) {
    const struct state *const state = simulation->state;
    return residual_evaluate(simulation->residual, &residual_run, state->t, state->y, state->yp,
                             simulation->residual->scratch);
}

static enum status renew_simulation(struct shoal *run, const void *data) {
    (void)data;
    TRY(simulate_renew(run->simulation));
    run->is_torn = false;
    return handle_evaluate(run->simulation);
}

enum status handle_renew(struct shoal *run) {
    if (run->is_renewed && !run->is_torn) return STATUS_OK;
    run->has_row = false;

    // a restart that ran out of memory leaves no solver
    if (run->simulation->solver && !run->is_renewed) simulate_count(run->simulation, &run->when_reached);

    const enum status status = handle_call(run, renew_simulation, NULL);
    run->is_renewed = status == STATUS_OK;
    if (status != STATUS_OK) handle_fail(run);
    return status;
}

enum status handle_mend(struct shoal *run, const char *function) {
    if (!run->is_torn) return STATUS_OK;
    TRY(handle_check_alive(run, function));
    return handle_renew(run);
}

enum status handle_restore(struct shoal *run, const void *state) {
    state_table_copy(run->simulation->state, state, run->simulation->school, true);
    return handle_renew(run);
}

enum status handle_take_up(struct shoal *run, const struct state *from, const struct checkpoint *checkpoint,
                           const struct integrator_counts *totals) {
    const struct case_values *const values = &run->shared->values;
    struct school_parameters parameters = values->school;
    parameters.stop = handle_stop;
    struct school *school;
    TRY(fish_school_create(run->arena, &school, &parameters));
    struct state *const state = state_create(run->arena, school);
    if (from) state_table_copy(state, from, school, true);
    if (checkpoint) TRY(checkpoint_set_state(checkpoint, state, school));

    // the simulation owns school and state
    TRY(simulate_take_up(run->arena, &run->simulation, values, school, state, totals));
    run->is_renewed = true;
    run->when_reached = *totals;
    return handle_evaluate(run->simulation);
}

// ---- keys that can be set at an event

static const struct set_key {
    const char *key;
    bool is_number;
} keys[] = {
    {"wave.amplitude", true},          {"wave.frequency", true},  {"control.bias", true},       {"motion.heave", true},
    {"control.desired_heading", true}, {"control.offset", false}, {"control.waypoints", false},
};
enum set_key_index { AMPLITUDE, FREQUENCY, BIAS, HEAVE, DESIRED_HEADING, OFFSET, WAYPOINTS, N_KEYS };

/* Change the control memory of a fish, under the conditions of the key. */
static enum status change_memory(const struct fish *fish, const struct state *state, enum set_key_index index, int n,
                                 const double *values, struct control_memory *memory) {
    const char *const key = keys[index].key, *const name = fish->name;
    const enum control_law law = fish->control.law;
    switch (index) {
        case AMPLITUDE:
            if (!(fabs(fish->amplitude) > 0)) {
                return status_fail(STATUS_CASE, "%s: the amplitude of %s in the case is 0: give an initial amplitude",
                                   key, name);
            }
            control_set(fish, memory, CONTROL_SET_AMPLITUDE, state->t, values[0]);
            break;
        case FREQUENCY:
            if (values[0] < 0) {
                return status_fail(STATUS_CASE, "%s: %g Hz: a frequency cannot be negative", key, values[0]);
            }
            control_set(fish, memory, CONTROL_SET_FREQUENCY, state->t, values[0]);
            break;
        case BIAS:
            if (law != CONTROL_NONE) {
                return status_fail(STATUS_CASE, "%s: the control law of %s sets the bias: use 'law: none'", key, name);
            }
            control_set(fish, memory, CONTROL_SET_BIAS, state->t, values[0]);
            break;
        case HEAVE:
            if (fish->motion.prescribed == PRESCRIBED_NONE || !(fish->motion.omega > 0)) {
                return status_fail(
                    STATUS_CASE,
                    "%s: the motion of %s is not prescribed, or has no frequency: set motion.prescribed and "
                    "motion.frequency in the case",
                    key, name);
            }
            control_set(fish, memory, CONTROL_SET_HEAVE, state->t, values[0]);
            break;
        case DESIRED_HEADING:
            if (law == CONTROL_NONE) {
                return status_fail(STATUS_CASE, "%s: %s has no control law: choose a control.law", key, name);
            }
            if (law == CONTROL_PLACE) {
                return status_fail(STATUS_CASE, "%s: %s points where its leader does, with 'law: place'", key, name);
            }
            if (control_n_waypoints(fish, memory) > 0) {
                return status_fail(STATUS_CASE, "%s: %s follows waypoints", key, name);
            }
            control_set(fish, memory, CONTROL_SET_HEADING, state->t, angle_radians(values[0]));
            break;
        case OFFSET:
            if (law != CONTROL_PLACE) return status_fail(STATUS_CASE, "%s: %s needs 'law: place'", key, name);
            control_set(fish, memory, CONTROL_SET_OFFSET_X, state->t, values[0]);
            control_set(fish, memory, CONTROL_SET_OFFSET_Y, state->t, values[1]);
            break;
        default:
            if (law != CONTROL_COURSE && law != CONTROL_AVERAGED_HEADING) {
                return status_fail(STATUS_CASE, "%s: %s needs 'law: course', which has a continuous bias", key, name);
            }
            control_set_waypoints(fish, memory, n / 2, values, state->y);
    }
    return STATUS_OK;
}

/* Fail if the offset in memory puts fish f on top of another one. */
static enum status refuse_places(const struct simulation *simulation, int f, const struct control_memory *memory) {
    const struct school *const school = simulation->school;
    ARENA(arena, NULL, "the offsets");
    double *offset;
    NEW(arena, offset, 2 * school->n_fish);
    for (int g = 0; g < school->n_fish; g++) {
        for (int d = 0; d < 2; d++) {
            offset[2 * g + d] = control_offset(&school->fish[g], g == f ? memory : &simulation->state->control[g], d);
        }
    }
    return fish_school_places(school, offset);
}

enum status handle_set_key(const struct simulation *simulation, int fish, const char *key, int n,
                           const double *values) {
    int found = 0;
    while (found < N_KEYS && strcmp(keys[found].key, key) != 0) found++;
    if (found == N_KEYS) {
        return status_fail(STATUS_CASE,
                           "'%s' cannot be set: only wave.amplitude, wave.frequency, control.bias, "
                           "motion.heave, control.desired_heading, control.offset and control.waypoints can",
                           key);
    }
    const bool is_number = keys[found].is_number;
    if (is_number && n != 1) return status_fail(STATUS_CASE, "%s: %d numbers: give one", key, n);
    if (found == OFFSET && n != 2) return status_fail(STATUS_CASE, "%s: %d numbers: give two", key, n);
    if (!is_number && (n < 1 || n % 2 != 0 || n > 2 * CONTROL_MAX_WAYPOINTS)) {
        return status_fail(STATUS_CASE, "%s: %d numbers: give 1 to %d pairs", key, n, CONTROL_MAX_WAYPOINTS);
    }
    for (int i = 0; i < n; i++) {
        if (!isfinite(values[i])) return status_fail(STATUS_CASE, "%s: %g is not finite", key, values[i]);
    }

    // change a copy; the curvature of a joint is singular at a turn of pi
    const struct fish *const of = &simulation->school->fish[fish];
    struct control_memory memory = simulation->state->control[fish];
    TRY(change_memory(of, simulation->state, (enum set_key_index)found, n, values, &memory));
    const double turn =
        fish_largest_turn(of, control_largest_amplitude(of, &memory), control_largest_bias(of, &memory));
    if (!(turn < M_PI)) {
        return status_fail(STATUS_CASE, "the wave would turn a joint of %s by up to %.3g rad; it must stay below 3.14",
                           of->name, turn);
    }
    if (found == OFFSET) TRY(refuse_places(simulation, fish, &memory));
    simulation->state->control[fish] = memory;
    return STATUS_OK;
}
