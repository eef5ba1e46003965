/* shoal.c: the functions of include/shoal.h that open, step, read and close runs, set keys, and write result files. */
#include "shoal.h"

#include <limits.h>
#include <math.h>
#include <string.h>
#include <unistd.h>

#include "base/version.h"
#include "case/sweep.h"
#include "flow/flow_at_bodies.h"
#include "library/handle.h"
#include "result/target.h"
#include "run/record.h"
#include "solver/initial_conditions.h"
#include "state/state.h"

_Static_assert((int)SHOAL_USAGE == STATUS_CASE && (int)SHOAL_FILE == STATUS_FILE &&
                   (int)SHOAL_MEMORY == STATUS_MEMORY && (int)SHOAL_SOLVER == STATUS_SOLVER,
               "public and internal status numbers agree");

// ---- the life of a run

/* The case of a new run: a path, or a text that is not NULL. */
struct opening {
    const char *path, *text, *folder;
    int n_assignments;
    const char *const *assignments;
};

static enum status open_case(struct shoal *run, const void *data) {
    const struct opening *const from = data;
    struct case_values *const values = &run->shared->values;
    if (from->text) {
        TRY(case_parse(values, from->text, strlen(from->text), "case", from->folder, from->n_assignments,
                       from->assignments));
    } else {
        TRY(case_read(values, from->path, from->n_assignments, from->assignments));
    }
    TRY(sweep_refuse(values));
    run->result_path = record_path(run->arena, values);
    TRY(simulate_start(run->arena, &run->simulation, values, handle_stop));

    // the flag of the set-up may not outlive this call
    run->simulation->stop = run->simulation->residual->stop = NULL;
    return STATUS_OK;
}

static enum status open_run(struct shoal **run, const struct opening *from, const char *function) {
    const int n = from->n_assignments;
    if (n < 0) return status_fail(STATUS_CASE, "%s: %d assignments: the number cannot be negative", function, n);
    if (n > 0) TRY(handle_need(from->assignments, function, "assignments"));
    for (int i = 0; i < n; i++) {
        if (!from->assignments[i]) return status_fail(STATUS_CASE, "%s: assignment %d is NULL", function, i);
    }
    return handle_create(run, NULL, open_case, from);
}

int shoal_open(struct shoal **run, const char *case_path, int n_assignments, const char *const *assignments) {
    TRY(handle_need(run, __func__, "run"));
    *run = NULL;
    TRY(handle_need(case_path, __func__, "case_path"));
    return open_run(run, &(struct opening){case_path, NULL, NULL, n_assignments, assignments}, __func__);
}

int shoal_open_text(struct shoal **run, const char *text, const char *folder, int n_assignments,
                    const char *const *assignments) {
    TRY(handle_need(run, __func__, "run"));
    *run = NULL;
    TRY(handle_need(text, __func__, "text"));
    return open_run(run, &(struct opening){NULL, text, folder, n_assignments, assignments}, __func__);
}

// ---- the result file of a run

// a file that lack of memory has left open is closed with the arena
static enum status free_record(struct shoal *run, const void *data) {
    (void)data;
    arena_free(run->checkpoints.arena);
    run->checkpoints.arena = NULL;
    return STATUS_OK;
}

// forget the result file; release its checkpoints and claim
static void release_record(struct shoal *run) {
    run->record = (struct record){0};
    run->record_path = NULL;
    handle_with_netcdf(run, free_record, NULL);
    durable_claim_release(&run->claim);
}

/* Fail with STATUS_FILE in a fork of the process that writes the result file, and detach the run from the file. */
static enum status check_process(struct shoal *run, const char *function) {
    if (!run->record.file || run->claim.process == getpid()) return STATUS_OK;
    status_fail(STATUS_FILE,
                "%s: %s is written by process %ld, not by this fork: the run continues without a result file", function,
                run->record_path, (long)run->claim.process);

    result_file_abandon(run->record.file);
    release_record(run);
    return STATUS_FILE;
}

// close the file with the status of the whole run, or with a failure of writing
static enum status close_record(struct shoal *run, const void *failure) {
    if (failure) return record_close(&run->record, *(const enum status *)failure);
    const bool has_ended = run->simulation->state->event >= run->simulation->n_events;
    enum status status = has_ended ? STATUS_OK : STATUS_STOPPED;
    if (run->has_failed) status = status_fail(STATUS_SOLVER, "%s", run->failure);
    if (run->simulation->residual && !run->is_torn)
        record_notes_write(run->record.file, run->simulation, "", NULL, NULL);

    // record_close returns the status of the run if the file was closed without an error
    const enum status closed = record_close(&run->record, status);
    return closed == status ? STATUS_OK : closed;
}

/* Close the file, if there is one; returns the failure, if not NULL. The run continues without the file. */
static enum status end_record(struct shoal *run, const enum status *failure) {
    enum status status = failure ? *failure : STATUS_OK;
    if (run->record.file) status = handle_with_netcdf(run, close_record, failure);
    release_record(run);
    return status;
}

void shoal_close(struct shoal *run) {
    if (!run) return;
    if (check_process(run, __func__) == STATUS_OK && run->record.file) end_record(run, NULL);
    handle_release(run);
}

static enum status write_row(struct shoal *run, const void *data) {
    (void)data;
    if (!record_is_due(&run->record, run->simulation->state->event)) return STATUS_OK;
    struct result_row row = *handle_row(run);
    return record_row(&run->record, &row);
}

static enum status replace_checkpoint(struct shoal *run, const void *data) {
    (void)data;
    return checkpoints_write(&run->checkpoints, run->simulation, &run->record);
}

static enum status write_checkpoint(struct shoal *run) {
    TRY(check_process(run, "shoal_checkpoint"));
    if (run->record.file) TRY(handle_with_netcdf(run, replace_checkpoint, NULL));
    return run->simulation->state->event < run->simulation->n_events ? handle_renew(run) : STATUS_OK;
}

// ---- steps

/* Step to the next event; with a flag that can stop the step, the state at this event is kept. */
static enum status step_simulation(struct shoal *run, const void *data) {
    (void)data;
    struct simulation *const simulation = run->simulation;
    simulation->stop = handle_stop;
    if (handle_stop) {
        if (!run->before) run->before = state_create(run->arena, simulation->school);
        state_table_copy(run->before, simulation->state, simulation->school, false);
    }

    // the flag may not outlive this call
    const enum status status = simulate_step(simulation);
    simulation->stop = simulation->residual->stop = NULL;
    return status;
}

/* Return to the last event after a stop in between. */
static enum status return_to_event(struct shoal *run) {
    struct simulation *const simulation = run->simulation;
    state_table_copy(simulation->state, run->before, simulation->school, false);
    TRY(handle_renew(run));
    run->when_reached = simulation->totals;
    return status_fail(STATUS_STOPPED, "shoal_step: stopped: the run is at the last event, t = %.10g s",
                       simulation->state->t);
}

int shoal_step(struct shoal *run) {
    TRY(handle_check_alive(run, __func__));
    TRY(handle_mend(run, __func__));
    TRY(status_ask(handle_stop));
    if (run->simulation->state->event >= run->simulation->n_events) {
        return status_fail(STATUS_CASE, "%s: the run is at its end, t = %g s: increase time.end", __func__,
                           run->simulation->state->t);
    }
    handle_forget_row(run);
    enum status status = handle_call(run, step_simulation, NULL);
    if (status == STATUS_STOPPED) return return_to_event(run);
    if (status != STATUS_OK) {
        handle_fail(run);
        return status == STATUS_CONTACT ? STATUS_SOLVER : status;
    }

    // a row that is due
    TRY(check_process(run, __func__));
    status = handle_with_netcdf(run, write_row, NULL);
    if (status != STATUS_OK) status = end_record(run, &status);
    if (status == STATUS_SOLVER) handle_fail(run);
    TRY(status);

    // restart the integrator at every checkpoint of the case, with or without a result file, so that both runs have the
    // same bits
    const struct case_values *const values = &run->shared->values;
    const long interval = lround(values->time.checkpoint_interval / values->school.shedding_interval);
    const bool is_due = interval > 0 && run->simulation->state->event % interval == 0;
    return is_due ? write_checkpoint(run) : STATUS_OK;
}

int shoal_advance(struct shoal *run, double t) {
    TRY(handle_need(run, __func__, "run"));
    if (!isfinite(t)) return status_fail(STATUS_CASE, "%s: the time %g is not finite", __func__, t);
    const struct simulation *const simulation = run->simulation;

    // number of events; the factor absorbs the rounding error of t
    const double events = ceil(t / simulation->school->interval * (1 - 1e-12));
    if (events > (double)simulation->n_events) {
        return status_fail(STATUS_CASE, "%s: t = %g s is after the end of the case, %g s", __func__, t, shoal_end(run));
    }
    if (events < (double)simulation->state->event) {
        return status_fail(STATUS_CASE, "%s: t = %g s is before the last event, at %g s: use shoal_restore", __func__,
                           t, simulation->state->t);
    }

    while ((double)simulation->state->event < events) TRY(shoal_step(run));
    return STATUS_OK;
}

// ---- time

double shoal_time(const struct shoal *run) {
    return handle_need(run, __func__, "run") == STATUS_OK ? run->simulation->state->t : NAN;
}

double shoal_end(const struct shoal *run) {
    if (handle_need(run, __func__, "run") != STATUS_OK) return NAN;
    return fish_event_time(run->simulation->school, run->simulation->n_events);
}

double shoal_interval(const struct shoal *run) {
    return handle_need(run, __func__, "run") == STATUS_OK ? run->simulation->school->interval : NAN;
}

int shoal_set(struct shoal *run, int fish, const char *key, int n, const double *values) {
    TRY(handle_check_fish(run, fish, __func__));
    TRY(handle_need(key, __func__, "key"));
    TRY(handle_need(values, __func__, "values"));
    return handle_set_key(run->simulation, fish, key, n, values);
}

// ---- reading at the last event

/* A row of the table of results, and the array for its values. */
struct reading {
    int row;
    struct shoal_array *array;
};

static enum status read_variable(struct shoal *run, const void *data) {
    const struct reading *const reading = data;
    const int i = reading->row;

    // request the buffer once, for the largest size in this run, because pointers of callers have to stay valid
    const struct result_variable *const variable = &result_table[i];
    const struct school *const school = run->simulation->school;
    size_t length[RESULT_N_DIMENSIONS];
    if (!run->buffer[i]) {
        result_values_lengths(school, wake_most(school, run->simulation->n_events), length);
        const size_t n = result_values_n(variable, length);
        run->buffer[i] = arena_new(run->arena, n + 1, result_values_size(variable->type));
    }

    // fill the buffer once per event
    int longest = 0;
    for (int f = 0; f < school->n_fish; f++) {
        const int n = run->simulation->state->wake[f].n_vortex;
        if (n > longest) longest = n;
    }
    result_values_lengths(school, longest, length);
    if (!run->is_filled[i]) result_values_fill(variable, length, handle_row(run), run->buffer[i]);
    run->is_filled[i] = true;

    const enum result_type type = variable->type;
    struct shoal_array *const array = reading->array;
    *array = (struct shoal_array){.values = run->buffer[i],
                                  .type = type == RESULT_INTEGER ? SHOAL_INT
                                          : type == RESULT_COUNT ? SHOAL_LONG
                                          : type == RESULT_TEXT  ? SHOAL_CHAR
                                                                 : SHOAL_DOUBLE,
                                  .unit = variable->unit,
                                  .long_name = variable->long_name};
    for (const enum result_dimension *d = variable->dimension; *d != NONE; d++) {
        if (*d == TIME) continue;
        array->shape[array->n_dimensions] = length[*d];
        array->dimension[array->n_dimensions++] = result_table_dimension(*d);
    }
    return STATUS_OK;
}

int shoal_read(struct shoal *run, const char *name, struct shoal_array *array) {
    TRY(handle_need(array, __func__, "array"));
    *array = (struct shoal_array){.values = NULL};
    TRY(handle_need(run, __func__, "run"));
    TRY(handle_need(name, __func__, "name"));
    int row = 0;
    while (row < result_table_n && strcmp(result_table[row].name, name) != 0) row++;
    if (row == result_table_n) {
        return status_fail(STATUS_CASE, "%s: there is no variable '%s': `shoal keys --output` lists all variables",
                           __func__, name);
    }
    TRY(handle_mend(run, __func__));
    return handle_call(run, read_variable, &(struct reading){row, array});
}

const char *shoal_variable(int i) {
    return i >= 0 && i < result_table_n ? result_table[i].name : NULL;
}

/* Points, and the flow at them, as shoal_flow has them; the caller frees the arena. */
struct points {
    int n;
    const double *points;
    double *velocity, *vorticity;
    struct arena **arena;
};

static enum status flow_at_points(struct shoal *run, const void *data) {
    const struct points *const given = data;
    const int n = given->n;
    const double *const points = given->points;
    double *const velocity = given->velocity, *const vorticity = given->vorticity, *work;
    *given->arena = arena_create(NULL, "the points of a flow");
    NEW(*given->arena, work, 7 * (size_t)n);
    double *const x = work, *const y = x + n;
    const struct targets at = {
        .n = n, .x = x, .y = y, .u = y + n, .v = y + 2 * n, .u_x = y + 3 * n, .u_y = y + 4 * n, .v_x = y + 5 * n};
    for (int i = 0; i < n; i++) {
        x[i] = points[2 * i];
        y[i] = points[2 * i + 1];
    }

    flow_field(run->simulation->residual->flow, run->simulation->state, &at, false);
    for (int i = 0; i < n; i++) {
        velocity[2 * i] = at.u[i];
        velocity[2 * i + 1] = at.v[i];
        if (vorticity) vorticity[i] = at.v_x[i] - at.u_y[i];
    }
    return STATUS_OK;
}

int shoal_flow(struct shoal *run, int n, const double *points, double *velocity, double *vorticity) {
    TRY(handle_need(run, __func__, "run"));
    if (n < 0 || n > INT_MAX / 8)
        return status_fail(STATUS_CASE, "%s: %d points: the number must be between 0 and %d", __func__, n, INT_MAX / 8);
    if (n == 0) return STATUS_OK;
    TRY(handle_need(points, __func__, "points"));
    TRY(handle_need(velocity, __func__, "velocity"));
    TRY(handle_check_alive(run, __func__));
    for (int i = 0; i < n; i++) {
        if (isfinite(points[2 * i]) && isfinite(points[2 * i + 1])) continue;
        return status_fail(STATUS_CASE, "%s: point %d, (%g, %g), is not finite", __func__, i, points[2 * i],
                           points[2 * i + 1]);
    }

    TRY(handle_mend(run, __func__));
    struct arena *arena = NULL;
    const enum status status =
        handle_call(run, flow_at_points, &(struct points){n, points, velocity, vorticity, &arena});
    arena_free(arena);
    return status;
}

int shoal_n_fish(const struct shoal *run) {
    TRY(handle_need(run, __func__, "run"));
    return run->simulation->school->n_fish;
}

int shoal_n_nodes(const struct shoal *run, int fish) {
    TRY(handle_check_fish(run, fish, __func__));
    return run->simulation->school->fish[fish].n_nodes;
}

int shoal_n_vortices(const struct shoal *run, int fish) {
    TRY(handle_check_fish(run, fish, __func__));
    return run->simulation->state->wake[fish].n_vortex;
}

int shoal_nodes(const struct shoal *run, int fish, double *x, double *y) {
    TRY(handle_check_fish(run, fish, __func__));
    TRY(handle_need(x, __func__, "x"));
    TRY(handle_need(y, __func__, "y"));
    const struct fish *const from = &run->simulation->school->fish[fish];
    memcpy(x, run->simulation->state->y + from->at.x, (size_t)from->n_nodes * sizeof *x);
    memcpy(y, run->simulation->state->y + from->at.y, (size_t)from->n_nodes * sizeof *y);
    return STATUS_OK;
}

int shoal_vortices(const struct shoal *run, int fish, double *x, double *y, double *circulation) {
    TRY(handle_check_fish(run, fish, __func__));
    const struct wake *const wake = &run->simulation->state->wake[fish];
    const size_t size = (size_t)wake->n_vortex * sizeof *x;
    if (size == 0) return STATUS_OK;

    TRY(handle_need(x, __func__, "x"));
    TRY(handle_need(y, __func__, "y"));
    TRY(handle_need(circulation, __func__, "circulation"));

    memcpy(x, wake->x, size);
    memcpy(y, wake->y, size);
    for (int i = 0; i < wake->n_vortex; i++) circulation[i] = wake_circulation(wake, i);
    return STATUS_OK;
}

// ---- files

const char *shoal_result_path(const struct shoal *run) {
    return handle_need(run, __func__, "run") == STATUS_OK ? run->result_path : NULL;
}

/* A result file to begin. */
struct target {
    const char *path;
    bool overwrite;
};

// keep an earlier result file until the first row of the new result is on disk
static enum status create_result_file(struct shoal *run, const void *data) {
    const struct target *const target = data;
    const struct result_origin origin = {.path = run->record_path,
                                         .overwrite = target->overwrite,
                                         .values = &run->shared->values,
                                         .command = "libshoal",
                                         .school = run->simulation->school,
                                         .n_events = run->simulation->n_events};
    TRY(record_create(run->checkpoints.arena, &run->record, &origin));
    TRY(write_row(run, NULL));
    return result_file_publish(run->record.file, "running");
}

// claim the path, create the result file, and remove the checkpoints of an earlier run
static enum status begin_record(struct shoal *run, const void *data) {
    const struct target *const target = data;
    run->checkpoints.arena = arena_create(run->arena, "the checkpoints");
    run->record_path = arena_text(run->checkpoints.arena, "%s", target->path);
    TRY(target_check(target->path, TARGET_NETCDF, target->overwrite));
    TRY(durable_claim_take(&run->claim, target->path));
    TRY(checkpoints_create(run->checkpoints.arena, &run->checkpoints, &run->shared->values, target->path, NULL));
    TRY(handle_with_netcdf(run, create_result_file, target));
    checkpoints_remove(&run->checkpoints);
    return STATUS_OK;
}

int shoal_write(struct shoal *run, const char *path, int overwrite) {
    TRY(handle_need(run, __func__, "run"));
    TRY(handle_need(path, __func__, "path"));
    TRY(handle_check_alive(run, __func__));
    TRY(check_process(run, __func__));
    TRY(handle_mend(run, __func__));
    if (run->record.file) {
        return status_fail(STATUS_CASE, "%s: the run already writes %s: call shoal_write_end first", __func__,
                           run->record_path);
    }

    const enum status status = handle_call(run, begin_record, &(struct target){path, overwrite});
    return status == STATUS_OK ? STATUS_OK : end_record(run, &status);
}

int shoal_checkpoint(struct shoal *run) {
    TRY(handle_check_alive(run, __func__));
    if (!run->record.file) {
        return status_fail(STATUS_CASE, "%s: a checkpoint needs a result file: call shoal_write first", __func__);
    }
    TRY(handle_mend(run, __func__));
    return write_checkpoint(run);
}

int shoal_write_end(struct shoal *run) {
    TRY(handle_need(run, __func__, "run"));
    TRY(check_process(run, __func__));
    return run->record.file ? end_record(run, NULL) : STATUS_OK;
}

// ---- the library

void shoal_listen(const volatile int *stop) {
    handle_stop = stop;
}

const char *shoal_message(void) {
    return status_message();
}

const char *shoal_version(void) {
    return version_short();
}
