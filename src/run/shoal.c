/* shoal.c: the public interface: checked arguments over a simulation. */
#include "shoal.h"

#include <limits.h>
#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/version.h"
#include "case/case.h"
#include "case/sweep_members.h"
#include "model/state_table.h"
#include "output/netcdf.h"
#include "output/result_lock.h"
#include "output/result_values.h"
#include "run/checkpoints.h"
#include "run/led.h"
#include "run/record.h"
#include "run/record_notes.h"
#include "run/simulate.h"

_Static_assert((int)SHOAL_USAGE == STATUS_CASE && (int)SHOAL_FILE == STATUS_FILE &&
                   (int)SHOAL_MEMORY == STATUS_MEMORY && (int)SHOAL_SOLVER == STATUS_SOLVER,
               "a status goes to the caller as it is");

// a case, which all copies of a run share
struct shared {
    atomic_int n_users;
    struct case_values values;
};

struct shoal {
    struct shared *shared;
    struct simulation *simulation;
    int is_renewed;                        /* the integration has begun again at this event */
    struct integrator_counts when_reached; /* if so: the counts with which the event was reached */
    int has_failed;
    char failure[1024]; /* message of the step that failed */
    struct record record;
    char *record_path;              /* where it is written */
    struct checkpoints checkpoints; /* beside it */
    struct result_lock lock;
    char *result_path; /* where the case wants it */

    /* what has been read since the last step */
    int has_row;
    struct integrator_counts counts;
    struct result_row row;
    void *buffer[RESULT_TABLE_MAX]; /* of each variable read so far; stays where it is */
    unsigned char is_filled[RESULT_TABLE_MAX];
};

// NetCDF keeps a list of open files that threads must not change together
static pthread_mutex_t netcdf_lock = PTHREAD_MUTEX_INITIALIZER;

// ---- checks

// fails unless a pointer is there
static enum status need(const void *pointer, const char *function, const char *name) {
    return pointer ? STATUS_OK : status_fail(STATUS_CASE, "%s: %s is NULL", function, name);
}

static enum status check_fish(const struct shoal *run, int fish, const char *function) {
    TRY(need(run, function, "run"));
    const int n = run->simulation->school->n_fish;
    if (fish >= 0 && fish < n) return STATUS_OK;
    return status_fail(STATUS_CASE, "%s: there is no fish %d: this run has %d, numbered from 0", function, fish, n);
}

static enum status check_assignments(int n, const char *const *assignments, const char *function) {
    if (n < 0) return status_fail(STATUS_CASE, "%s: %d assignments: the number cannot be negative", function, n);
    if (n > 0) TRY(need(assignments, function, "assignments"));
    for (int i = 0; i < n; i++) {
        if (!assignments[i]) return status_fail(STATUS_CASE, "%s: assignment %d is NULL", function, i);
    }
    return STATUS_OK;
}

static int has_failed(const struct shoal *run, const char *function) {
    if (run->has_failed) status_fail(STATUS_SOLVER, "%s: the run has failed before: %s", function, run->failure);
    return run->has_failed;
}

// fails where a run cannot make a step
static enum status check_can_step(const struct shoal *run, const char *function) {
    TRY(need(run, function, "run"));
    if (has_failed(run, function)) return STATUS_SOLVER;
    if (run->simulation->state->event < run->simulation->n_events) return STATUS_OK;
    return status_fail(STATUS_CASE, "%s: the run is at its end, t = %g s: a longer one needs a larger time.end",
                       function, run->simulation->state->t);
}

// ---- the life of a run

// a run without a simulation
static enum status create(struct shoal **run) {
    *run = calloc(1, sizeof **run);
    if (*run) (*run)->shared = calloc(1, sizeof *(*run)->shared);
    if (*run && (*run)->shared) {
        atomic_init(&(*run)->shared->n_users, 1);
        (*run)->lock.descriptor = -1;
        return STATUS_OK;
    }
    free(*run);
    *run = NULL;
    return status_fail(STATUS_MEMORY, "out of memory: a run");
}

static enum status start(struct shoal *run) {
    const struct case_values *const values = &run->shared->values;
    TRY(sweep_refuse(values));
    run->result_path = record_path(values);
    if (!run->result_path) return status_fail(STATUS_MEMORY, "out of memory: a path");
    return simulate_create(&run->simulation, values);
}

// hand out a run that has read its case with this status
static int finish_opening(struct shoal **run, struct shoal *new, enum status status) {
    if (status == STATUS_OK) status = start(new);
    if (status == STATUS_OK) {
        *run = new;
    } else {
        shoal_close(new);
    }
    return status;
}

int shoal_open(struct shoal **run, const char *case_path, int n_assignments, const char *const *assignments) {
    TRY(need(run, __func__, "run"));
    *run = NULL;
    TRY(need(case_path, __func__, "case_path"));
    TRY(check_assignments(n_assignments, assignments, __func__));
    struct shoal *new;
    TRY(create(&new));
    return finish_opening(run, new, case_read(&new->shared->values, case_path, n_assignments, assignments));
}

int shoal_open_text(struct shoal **run, const char *text, const char *folder, int n_assignments,
                    const char *const *assignments) {
    TRY(need(run, __func__, "run"));
    *run = NULL;
    TRY(need(text, __func__, "text"));
    TRY(check_assignments(n_assignments, assignments, __func__));
    struct shoal *new;
    TRY(create(&new));
    return finish_opening(
        run, new, case_parse(&new->shared->values, text, strlen(text), "case", folder, n_assignments, assignments));
}

static int has_ended(const struct shoal *run) {
    return run->simulation->state->event >= run->simulation->n_events;
}

// what belongs to a result file that is closed
static void forget_record(struct shoal *run) {
    free(run->record_path);
    run->record_path = NULL;
    checkpoints_free(&run->checkpoints);
    result_lock_release(&run->lock);
    run->lock = (struct result_lock){.descriptor = -1};
}

static enum status end_record(struct shoal *run) {
    enum status status = STATUS_OK;
    if (run->has_failed) {
        status = status_fail(STATUS_SOLVER, "%s", run->failure);
    } else if (!has_ended(run)) {
        status = STATUS_STOPPED;
    }
    pthread_mutex_lock(&netcdf_lock);
    if (run->simulation->residual) record_notes_write(run->record.file, run->simulation, NULL, NULL);
    const enum status closed = record_close(&run->record, status);
    pthread_mutex_unlock(&netcdf_lock);
    forget_record(run);
    // how the run ended is no failure of closing its file
    return closed == status ? STATUS_OK : closed;
}

void shoal_close(struct shoal *run) {
    if (!run) return;
    if (run->record.file) end_record(run);
    for (int i = 0; i < RESULT_TABLE_MAX; i++) free(run->buffer[i]);
    simulate_free(run->simulation);
    if (atomic_fetch_sub(&run->shared->n_users, 1) == 1) {
        case_free(&run->shared->values);
        free(run->shared);
    }
    free(run->result_path);
    free(run);
}

// the row of the present event
static const struct result_row *row_of(struct shoal *run) {
    if (!run->has_row) simulate_row(run->simulation, &run->counts, &run->row);
    if (run->is_renewed) run->counts = run->when_reached;
    run->has_row = 1;
    return &run->row;
}

static enum status write_if_due(struct shoal *run) {
    if (!record_is_due(&run->record, run->simulation->state->event)) return STATUS_OK;
    struct result_row row = *row_of(run);
    pthread_mutex_lock(&netcdf_lock);
    enum status status = record_row(&run->record, &row);
    if (status != STATUS_OK) status = record_close(&run->record, status);
    pthread_mutex_unlock(&netcdf_lock);
    if (status != STATUS_OK) forget_record(run);
    return status;
}

// what has been read is that of another event
static void forget_row(struct shoal *run) {
    run->has_row = 0;
    run->is_renewed = 0;
    memset(run->is_filled, 0, sizeof run->is_filled);
}

// the velocity of the fluid and the muscle at the event, which a row is made of
static enum status evaluate(const struct simulation *simulation) {
    const struct state *const state = simulation->state;
    return residual_evaluate(simulation->residual, state->t, state->y, state->yp, simulation->residual->scratch);
}

// begin the integration again; a run for which that fails can only be closed
static enum status renew(struct shoal *run) {
    if (run->is_renewed) return STATUS_OK;
    run->has_row = 0;
    run->simulation->integrator->count(run->simulation->solver, &run->when_reached);
    enum status status = simulate_renew(run->simulation);
    if (status == STATUS_OK) status = evaluate(run->simulation);
    if (status == STATUS_OK) {
        run->is_renewed = 1;
        return STATUS_OK;
    }
    run->has_failed = 1;
    snprintf(run->failure, sizeof run->failure, "%s", status_message());
    return status;
}

// every run, with a file or without, begins its integration again where the case has a checkpoint
static int is_checkpoint(const struct shoal *run) {
    const struct case_values *const values = &run->shared->values;
    const long interval = lround(values->time.checkpoint_interval / values->school.shedding_interval);
    return interval > 0 && run->simulation->state->event % interval == 0;
}

static enum status checkpoint(struct shoal *run) {
    if (run->record.file) {
        pthread_mutex_lock(&netcdf_lock);
        const enum status status = checkpoints_write(&run->checkpoints, run->simulation, &run->record);
        pthread_mutex_unlock(&netcdf_lock);
        TRY(status);
    }
    return has_ended(run) ? STATUS_OK : renew(run);
}

int shoal_step(struct shoal *run) {
    TRY(check_can_step(run, __func__));
    forget_row(run);
    const enum status status = simulate_step(run->simulation);
    if (status == STATUS_OK) {
        TRY(write_if_due(run));
        return is_checkpoint(run) ? checkpoint(run) : STATUS_OK;
    }
    run->has_failed = 1;
    snprintf(run->failure, sizeof run->failure, "%s", status_message());
    return status == STATUS_CONTACT ? STATUS_SOLVER : status;
}

int shoal_advance(struct shoal *run, double t) {
    TRY(need(run, __func__, "run"));
    if (!isfinite(t)) return status_fail(STATUS_CASE, "%s: the time %g is not finite", __func__, t);
    const struct simulation *const simulation = run->simulation;
    // a time that an event has but for rounding is that event's
    const double events = ceil(t / simulation->school->interval * (1 - 1e-12));
    if (events > (double)simulation->n_events) {
        return status_fail(STATUS_CASE, "%s: t = %g s is after the end of the case, %g s", __func__, t, shoal_end(run));
    }
    while ((double)simulation->state->event < events) TRY(shoal_step(run));
    return STATUS_OK;
}

// ---- copies

static enum status copy_simulation(struct shoal *copy, const struct shoal *run) {
    const struct simulation *const from = run->simulation;
    const struct case_values *const values = &copy->shared->values;
    struct school *school;
    struct state *state;
    TRY(fish_school_create(&school, &values->school));
    enum status status = state_create(&state, school);
    if (status == STATUS_OK) status = state_table_copy(state, from->state, school);
    if (status != STATUS_OK) {
        state_free(state, school);
        fish_school_free(school);
        return status;
    }
    TRY(simulate_take_up(&copy->simulation, values, school, state, &from->totals));
    return evaluate(copy->simulation);
}

int shoal_clone(struct shoal **copy, struct shoal *run) {
    TRY(need(copy, __func__, "copy"));
    *copy = NULL;
    TRY(need(run, __func__, "run"));
    if (has_failed(run, __func__)) return STATUS_SOLVER;
    TRY(renew(run));
    struct shoal *const new = calloc(1, sizeof *new);
    if (!new) return status_fail(STATUS_MEMORY, "out of memory: a run");
    new->shared = run->shared;
    atomic_fetch_add(&new->shared->n_users, 1);
    new->is_renewed = 1;
    new->lock.descriptor = -1;
    new->when_reached = run->when_reached;
    new->result_path = strdup(run->result_path);
    const enum status status =
        new->result_path ? copy_simulation(new, run) : status_fail(STATUS_MEMORY, "out of memory: a path");
    if (status == STATUS_OK) {
        *copy = new;
    } else {
        shoal_close(new);
    }
    return status;
}

int shoal_restore(struct shoal *run, struct shoal *from) {
    TRY(need(run, __func__, "run"));
    TRY(need(from, __func__, "from"));
    if (run == from) return STATUS_OK;
    if (run->shared != from->shared) {
        return status_fail(STATUS_CASE, "%s: the two runs are not copies of one another", __func__);
    }
    if (run->record.file) {
        return status_fail(STATUS_CASE, "%s: the run writes %s: end that with shoal_write_end", __func__,
                           run->record_path);
    }
    if (has_failed(from, __func__)) return STATUS_SOLVER;
    TRY(renew(from));
    forget_row(run);
    run->simulation->totals = from->simulation->totals;
    enum status status = state_table_copy(run->simulation->state, from->simulation->state, run->simulation->school);
    if (status == STATUS_OK) status = renew(run);
    run->when_reached = from->when_reached;
    run->has_failed = status != STATUS_OK;
    if (run->has_failed) snprintf(run->failure, sizeof run->failure, "%s", status_message());
    return status;
}

// ---- time

double shoal_time(const struct shoal *run) {
    return need(run, __func__, "run") == STATUS_OK ? run->simulation->state->t : NAN;
}

double shoal_end(const struct shoal *run) {
    if (need(run, __func__, "run") != STATUS_OK) return NAN;
    return (double)run->simulation->n_events * run->simulation->school->interval;
}

double shoal_interval(const struct shoal *run) {
    return need(run, __func__, "run") == STATUS_OK ? run->simulation->school->interval : NAN;
}

int shoal_set(struct shoal *run, int fish, const char *key, int n, const double *values) {
    TRY(check_fish(run, fish, __func__));
    TRY(need(key, __func__, "key"));
    TRY(need(values, __func__, "values"));
    return led_set(run->simulation, fish, key, n, values);
}

// ---- what a run is at its last event

static enum shoal_type type_of(enum result_type type) {
    switch (type) {
        case RESULT_INTEGER: return SHOAL_INT;
        case RESULT_COUNT: return SHOAL_LONG;
        case RESULT_TEXT: return SHOAL_CHAR;
        default: return SHOAL_DOUBLE;
    }
}

// the variable of this name; result_table_n where there is none
static int find_variable(const char *name) {
    int i = 0;
    while (i < result_table_n && strcmp(result_table[i].name, name) != 0) i++;
    return i;
}

static int longest_wake(const struct simulation *simulation) {
    int longest = 0;
    for (int f = 0; f < simulation->school->n_fish; f++) {
        const int n = simulation->state->wake[f].n_vortex;
        if (n > longest) longest = n;
    }
    return longest;
}

// an array that is large enough for variable i at any event: it stays where it is
static enum status reserve(struct shoal *run, int i) {
    if (run->buffer[i]) return STATUS_OK;
    const struct school *const school = run->simulation->school;
    size_t length[RESULT_N_DIMENSIONS];
    result_values_lengths(school, wake_most(school, run->simulation->n_events), length);
    const size_t n = result_values_n(&result_table[i], length);
    run->buffer[i] = calloc(n + 1, result_values_size(result_table[i].type));
    return run->buffer[i] ? STATUS_OK : status_fail(STATUS_MEMORY, "out of memory: %s", result_table[i].name);
}

int shoal_read(struct shoal *run, const char *name, struct shoal_array *array) {
    TRY(need(array, __func__, "array"));
    *array = (struct shoal_array){.values = NULL};
    TRY(need(run, __func__, "run"));
    TRY(need(name, __func__, "name"));
    const int i = find_variable(name);
    if (i == result_table_n) {
        return status_fail(STATUS_CASE, "%s: there is no variable '%s': `shoal keys --output` lists them", __func__,
                           name);
    }
    const struct result_variable *const variable = &result_table[i];
    TRY(reserve(run, i));
    size_t length[RESULT_N_DIMENSIONS];
    result_values_lengths(run->simulation->school, longest_wake(run->simulation), length);
    if (!run->is_filled[i]) result_values_fill(variable, length, row_of(run), run->buffer[i]);
    run->is_filled[i] = 1;
    *array = (struct shoal_array){.values = run->buffer[i],
                                  .type = type_of(variable->type),
                                  .unit = variable->unit,
                                  .long_name = variable->long_name};
    for (const enum result_dimension *d = variable->dimension; *d != NONE; d++) {
        if (*d == TIME) continue;
        array->shape[array->n_dimensions] = length[*d];
        array->dimension[array->n_dimensions++] = result_table_dimension(*d);
    }
    return STATUS_OK;
}

const char *shoal_variable(int i) {
    return i >= 0 && i < result_table_n ? result_table[i].name : NULL;
}

// the velocity at points given as separate components; work: (7 n)
static enum status field(struct shoal *run, int n, const double *points, double *work, double *velocity,
                         double *vorticity) {
    double *const x = work, *const y = x + n;
    const struct induced at = {
        .n = n, .x = x, .y = y, .u = y + n, .v = y + 2 * n, .u_x = y + 3 * n, .u_y = y + 4 * n, .v_x = y + 5 * n};
    for (int i = 0; i < n; i++) {
        x[i] = points[2 * i];
        y[i] = points[2 * i + 1];
        if (!isfinite(x[i]) || !isfinite(y[i])) {
            return status_fail(STATUS_CASE, "shoal_flow: point %d, (%g, %g), is not finite", i, x[i], y[i]);
        }
    }
    TRY(flow_field(run->simulation->residual->flow, run->simulation->state, &at));
    for (int i = 0; i < n; i++) {
        velocity[2 * i] = at.u[i];
        velocity[2 * i + 1] = at.v[i];
        if (vorticity) vorticity[i] = at.v_x[i] - at.u_y[i];
    }
    return STATUS_OK;
}

int shoal_flow(struct shoal *run, int n, const double *points, double *velocity, double *vorticity) {
    TRY(need(run, __func__, "run"));
    if (n < 0 || n > INT_MAX / 8) return status_fail(STATUS_CASE, "%s: %d points cannot be", __func__, n);
    if (n == 0) return STATUS_OK;
    TRY(need(points, __func__, "points"));
    TRY(need(velocity, __func__, "velocity"));
    if (has_failed(run, __func__)) return STATUS_SOLVER;
    double *const work = calloc((size_t)n, 7 * sizeof *work);
    if (!work) return status_fail(STATUS_MEMORY, "out of memory: %d points", n);
    const enum status status = field(run, n, points, work, velocity, vorticity);
    free(work);
    return status;
}

int shoal_n_fish(const struct shoal *run) {
    TRY(need(run, __func__, "run"));
    return run->simulation->school->n_fish;
}

int shoal_n_nodes(const struct shoal *run, int fish) {
    TRY(check_fish(run, fish, __func__));
    return run->simulation->school->fish[fish].n_nodes;
}

int shoal_n_vortices(const struct shoal *run, int fish) {
    TRY(check_fish(run, fish, __func__));
    return run->simulation->state->wake[fish].n_vortex;
}

int shoal_nodes(const struct shoal *run, int fish, double *x, double *y) {
    TRY(check_fish(run, fish, __func__));
    TRY(need(x, __func__, "x"));
    TRY(need(y, __func__, "y"));
    const struct fish *const from = &run->simulation->school->fish[fish];
    memcpy(x, run->simulation->state->y + from->at.x, (size_t)from->n_nodes * sizeof *x);
    memcpy(y, run->simulation->state->y + from->at.y, (size_t)from->n_nodes * sizeof *y);
    return STATUS_OK;
}

int shoal_vortices(const struct shoal *run, int fish, double *x, double *y, double *circulation) {
    TRY(check_fish(run, fish, __func__));
    const struct wake *const wake = &run->simulation->state->wake[fish];
    const size_t size = (size_t)wake->n_vortex * sizeof *x;
    if (size == 0) return STATUS_OK;
    TRY(need(x, __func__, "x"));
    TRY(need(y, __func__, "y"));
    TRY(need(circulation, __func__, "circulation"));
    memcpy(x, wake->x, size);
    memcpy(y, wake->y, size);
    for (int i = 0; i < wake->n_vortex; i++) circulation[i] = wake_circulation(wake, i);
    return STATUS_OK;
}

// ---- files

const char *shoal_result_path(const struct shoal *run) {
    return need(run, __func__, "run") == STATUS_OK ? run->result_path : NULL;
}

// the file, its lock, and the plan of its checkpoints
static enum status start_record(struct shoal *run, const char *path, int overwrite) {
    const struct case_values *const values = &run->shared->values;
    run->record_path = strdup(path);
    if (!run->record_path) return status_fail(STATUS_MEMORY, "out of memory: a path");
    TRY(netcdf_check_target(path, overwrite));
    TRY(result_lock_take(&run->lock, path));
    TRY(checkpoints_create(&run->checkpoints, values, path, NULL));
    pthread_mutex_lock(&netcdf_lock);
    const enum status status = record_create(&run->record, values, run->simulation->school, run->simulation->n_events,
                                             run->record_path, overwrite, "libshoal");
    pthread_mutex_unlock(&netcdf_lock);
    if (status == STATUS_OK) checkpoints_remove(&run->checkpoints);
    return status;
}

int shoal_write(struct shoal *run, const char *path, int overwrite) {
    TRY(need(run, __func__, "run"));
    TRY(need(path, __func__, "path"));
    if (has_failed(run, __func__)) return STATUS_SOLVER;
    if (run->record.file) {
        return status_fail(STATUS_CASE, "%s: the run writes %s: end that with shoal_write_end", __func__,
                           run->record_path);
    }
    const enum status status = start_record(run, path, overwrite);
    if (status != STATUS_OK) {
        forget_record(run);
        return status;
    }
    return write_if_due(run);
}

int shoal_checkpoint(struct shoal *run) {
    TRY(need(run, __func__, "run"));
    if (has_failed(run, __func__)) return STATUS_SOLVER;
    if (!run->record.file) {
        return status_fail(STATUS_CASE, "%s: a checkpoint belongs to a result file: begin one with shoal_write",
                           __func__);
    }
    return checkpoint(run);
}

int shoal_write_end(struct shoal *run) {
    TRY(need(run, __func__, "run"));
    return run->record.file ? end_record(run) : STATUS_OK;
}

// ---- the library

const char *shoal_message(void) {
    return status_message();
}

const char *shoal_version(void) {
    return version_short();
}
