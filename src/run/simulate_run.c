/* simulate_run.c: the loop over events, with rows and checkpoints; checks of a checkpoint and its result before a run
 * is resumed. */
#include "run/simulate_run.h"

#include <limits.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/arena.h"
#include "base/version.h"
#include "fish/fish_school.h"
#include "result/checkpoint.h"
#include "result/durable.h"
#include "result/netcdf.h"
#include "result/target.h"
#include "run/checkpoints.h"
#include "run/record.h"
#include "run/simulate.h"
#include "state/state.h"

// a run together with its result and its checkpoints
struct run {
    struct arena *arena;
    const struct case_values *values;
    const struct simulate_options *options;
    struct simulation *simulation;
    struct record record;
    struct checkpoints checkpoints;
    long n_steps; /* since the last event, to report progress */
    /* the state at the last event, to return to it when the run is stopped; NULL if it cannot be stopped */
    struct state *before;
};

// ---- from event to event

static enum status run_write_if_due(struct run *run) {
    if (!record_is_due(&run->record, run->simulation->state->event)) return STATUS_OK;
    struct integrator_counts counts;
    struct result_row row;
    simulate_row(run->simulation, &counts, &row);
    return record_row(&run->record, &row);
}

static enum status run_checkpoint_if_due(struct run *run) {
    struct simulation *const simulation = run->simulation;
    const bool is_end = simulation->state->event >= simulation->n_events;
    if (checkpoints_are_due(&run->checkpoints, simulation->state->event)) {
        TRY(checkpoints_write(&run->checkpoints, simulation, &run->record));
        return is_end ? STATUS_OK : simulate_renew(simulation);
    }
    if (is_end || !checkpoints_are_due_by_wall(&run->checkpoints)) return STATUS_OK;
    return checkpoints_write_by_wall(&run->checkpoints, simulation, &run->record);
}

static void run_report(const struct run *run, double t) {
    const struct simulation *const simulation = run->simulation;
    struct integrator_counts counts;
    simulation->integrator->count(simulation->solver, &counts);
    struct simulate_progress progress = {.t = t,
                                         .end = run->values->time.end,
                                         .event = simulation->state->event,
                                         .steps = counts.steps,
                                         .evaluations = counts.residual_evaluations,
                                         .newton_iterations = counts.newton_iterations,
                                         .jacobians = counts.jacobian_evaluations,
                                         .wall_time = simulate_wall_time(simulation)};
    for (int f = 0; f < simulation->school->n_fish; f++) {
        progress.n_vortices += simulation->state->wake[f].n_vortex;
    }
    run->options->progress(&progress, run->options->data);
}

/* Report between events too, because with many steps an event can take minutes. data: struct run. */
static void run_report_step(double t, void *data) {
    struct run *const run = data;
    if (++run->n_steps % 100 == 0) run_report(run, t);
}

static enum status run_loop(struct run *run) {
    const struct simulate_options *const options = run->options;
    struct simulation *const simulation = run->simulation;
    simulation->stop = options->stop;
    simulation->trace = options->trace;
    if (simulation->stop) run->before = state_create(simulation->arena, simulation->school);
    if (options->progress) {
        simulation->after_step = run_report_step;
        simulation->after_step_data = run;
    }

    while (simulation->state->event < simulation->n_events) {
        run->n_steps = 0;

        // advance to the next event; a stop falls back to the last one, where a checkpoint is written
        if (run->before) state_table_copy(run->before, simulation->state, simulation->school, false);
        const enum status status = options->stop && *options->stop ? STATUS_STOPPED : simulate_step(simulation);
        if (status == STATUS_STOPPED) {
            state_table_copy(simulation->state, run->before, simulation->school, false);
            const double t = simulation->state->t;
            TRY(checkpoints_write(&run->checkpoints, simulation, &run->record));
            return status_fail(STATUS_STOPPED, "stopped %s at t = %.10g s: continue with 'shoal resume %s'",
                               simulate_stopped_by(options->stop), t, run->checkpoints.word);
        }
        TRY(status);

        TRY(run_write_if_due(run));
        TRY(run_checkpoint_if_due(run));

        if (options->progress) run_report(run, simulation->state->t);
    }
    return STATUS_OK;
}

static enum status run_finish(struct run *run, enum status status) {
    if (status == STATUS_OK) status = run_loop(run);

    // a run that was stopped is not judged, and one that could not be renewed has nothing to judge
    if (status != STATUS_STOPPED && run->simulation->residual) {
        record_notes_write(run->record.file, run->simulation, "", run->options->warn, run->options->data);
    }
    TRY(record_close(&run->record, status));
    checkpoints_end(&run->checkpoints);
    return STATUS_OK;
}

// ---- a new run

bool simulate_can_resume(struct arena *arena, const char *result, const char *checkpoint, const char *effective,
                         double *t) {
    struct arena *const scratch = arena_create(arena, checkpoint);
    const char *const paths[] = {checkpoint, arena_text(scratch, "%s" CHECKPOINTS_PREVIOUS, checkpoint)};
    bool is_possible = false;
    for (int i = 0; i < 2 && !is_possible; i++) {
        struct checkpoint read;
        struct result_checksum checksum;
        bool is_complete;
        if (checkpoint_read(scratch, &read, paths[i]) != STATUS_OK) continue;

        // the rows identify the run, because they contain its wall times
        *t = read.t;
        is_possible = checkpoint_check_program(&read) == STATUS_OK &&
                      result_mark_check(scratch, result, &read.rows, effective, &checksum, &is_complete) == STATUS_OK &&
                      !is_complete;
    }
    arena_free(scratch);
    return is_possible;
}

static enum status run_start(struct run *run) {
    const struct simulate_options *const options = run->options;
    struct checkpoints *const checkpoints = &run->checkpoints;
    run->arena = arena_create(NULL, "a run");
    TRY(checkpoints_create(run->arena, checkpoints, run->values, options->path, options->checkpoint_at));
    if (!options->overwrite) {
        double t;
        if (simulate_can_resume(run->arena, options->path, checkpoints->path, checkpoints->effective, &t)) {
            return status_fail(STATUS_FILE,
                               "%s is an unfinished result of this case: continue from t = %.6g s with 'shoal resume "
                               "%s', or start again with --force",
                               options->path, t, checkpoints->word);
        }
        TRY(target_check(options->path, TARGET_NETCDF, false));
    }

    if (options->begin) TRY(options->begin(run->values, options->path, options->data));

    const enum status started = simulate_start(run->arena, &run->simulation, run->values, options->stop);
    if (started == STATUS_STOPPED)
        return status_fail(started, "stopped %s during the event at t = 0: start the run again",
                           simulate_stopped_by(run->options->stop));
    TRY(started);
    const struct result_origin origin = {.path = options->path,
                                         .overwrite = options->overwrite,
                                         .values = run->values,
                                         .command = options->command,
                                         .school = run->simulation->school,
                                         .n_events = run->simulation->n_events};
    TRY(record_create(run->arena, &run->record, &origin));

    // an earlier result stays in its place until the first row of the new one is safe
    enum status status = run_write_if_due(run);
    if (status == STATUS_OK) status = result_file_publish(run->record.file, "running");
    if (status == STATUS_OK) {
        checkpoints_remove(checkpoints);
        status = run_checkpoint_if_due(run);
    }

    return run_finish(run, status);
}

enum status simulate_run(const struct case_values *values, const struct simulate_options *options) {
    struct run run = {.values = values, .options = options};
    struct durable_claim claim;
    TRY(target_check(options->path, TARGET_NETCDF, true));
    TRY(durable_claim_take(&claim, options->path));
    const enum status status = run_start(&run);
    arena_free(run.arena);
    durable_claim_release(&claim);
    return status;
}

// ---- a run that is resumed

struct resume {
    struct run run;
    struct case_values values; /* of the run */
    struct checkpoint checkpoint;
    char *result; /* path of the result */
    struct durable_claim claim;
    struct result_checksum checksum; /* of the rows of the result */
    bool is_complete;                /* the run of the result has reached the end */
    char *note;                      /* why the newest checkpoint is not used; NULL: it is */
};

static enum status resume_try(struct resume *resume, const char *path) {
    struct arena *const arena = resume->run.arena;
    struct checkpoint *const checkpoint = &resume->checkpoint;
    TRY(checkpoint_read(arena, checkpoint, path));
    const enum status status = checkpoint_check_program(checkpoint);
    if (status != STATUS_OK) return status_fail(status, "%s: cannot be used: %s", path, status_message());

    // the result is in the folder of the checkpoint
    if (!resume->result) {
        const char *const slash = strrchr(path, '/');
        resume->result = arena_text(arena, "%.*s%s", slash ? (int)(slash + 1 - path) : 0, path, checkpoint->result);
    }
    if (resume->claim.part[0] == '\0') {
        if (access(resume->result, F_OK) == 0) TRY(target_check(resume->result, TARGET_NETCDF, true));
        TRY(durable_claim_take(&resume->claim, resume->result));
    }
    return result_mark_check(arena, resume->result, &checkpoint->rows, checkpoint->effective, &resume->checksum,
                             &resume->is_complete);
}

/* Say why a result without a checkpoint cannot be resumed, and what to do instead. Fails with STATUS_FILE. */
static enum status resume_refuse(struct arena *arena, const char *result, const char *checkpoint) {
    struct netcdf_reader *reader;
    char *run_status, *history;
    NEW(arena, reader, 1);
    TRY(netcdf_open(arena, reader, result));
    TRY(netcdf_attribute(reader, "run_status", &run_status));
    TRY(netcdf_attribute(reader, "history", &history));
    if (strcmp(run_status, "complete") == 0) {
        return status_fail(STATUS_FILE,
                           "%s is complete, and has no checkpoint to go on from: run it again with a later time.end",
                           result);
    }

    double t = 0;
    const struct netcdf_slice last[] = {{"time", reader->n_rows - 1, 1}, {NULL}};
    if (reader->n_rows > 0) TRY(netcdf_read_doubles(reader, "time", last, &t));
    const char *const command = strchr(history, ' ');
    return status_fail(STATUS_FILE,
                       "%s has rows up to t = %.10g s, but no checkpoint (%s) to continue from: start again with '%s', "
                       "and --force",
                       result, t, checkpoint, command ? command + 1 : history);
}

/* Find the checkpoint: path is either one or the result of one. */
static enum status resume_find(struct arena *arena, const char *path, const char **checkpoint) {
    *checkpoint = path;
    if (!target_is(path, TARGET_NETCDF)) return STATUS_OK;
    *checkpoint = checkpoints_path(arena, path);
    const char *const previous = arena_text(arena, "%s" CHECKPOINTS_PREVIOUS, *checkpoint);
    if (access(*checkpoint, F_OK) == 0 || access(previous, F_OK) == 0) return STATUS_OK;
    return resume_refuse(arena, path, *checkpoint);
}

/* Open the checkpoint at path or, if it cannot be used, the previous one, and claim the result. Fails with STATUS_FILE
 * and the reason. */
static enum status resume_open(struct resume *resume, const char *path) {
    struct arena *const arena = resume->run.arena;
    const enum status status = resume_try(resume, path);
    if (status != STATUS_FILE) return status;
    const char *const reason = arena_text(arena, "%s", status_message());

    const char *const previous = arena_text(arena, "%s" CHECKPOINTS_PREVIOUS, path);
    if (access(previous, F_OK) != 0 || resume_try(resume, previous) != STATUS_OK) {
        return status_fail(STATUS_FILE, "%s", reason);
    }
    resume->note = arena_text(arena, "%s; resuming from %s", reason, previous);
    return STATUS_OK;
}

/* Read the case of the checkpoint with assignments, as case_read does. The text of the case file and the study come
 * from the result. Fails with STATUS_CASE or STATUS_FILE. */
static enum status resume_case(struct resume *resume, const struct simulate_changes *changes) {
    struct case_values *const values = &resume->values;
    const char *const text = resume->checkpoint.effective;
    TRY(case_parse(values, text, strlen(text), resume->checkpoint.result, NULL, changes->n_assignments,
                   changes->assignments));
    resume->run.values = values;

    // the case in the checkpoint is complete, but has neither the user's text nor the study
    struct arena *const scratch = arena_create(resume->run.arena, resume->result);
    struct netcdf_reader *reader;
    char *of_file, *study;
    NEW(scratch, reader, 1);
    TRY(netcdf_open(scratch, reader, resume->result));
    TRY(netcdf_attribute(reader, "case_text", &of_file));
    TRY(netcdf_attribute(reader, "study_case", &study));
    TRY(netcdf_read_integer(reader, "study_member", 0, &values->member));

    // a run outside a study has an empty text here
    values->text = arena_text(values->arena, "%s", of_file);
    values->study = *study ? arena_text(values->arena, "%s", study) : NULL;
    arena_free(scratch);
    return STATUS_OK;
}

static enum status resume_take_up(struct resume *resume) {
    struct run *const run = &resume->run;
    struct school *school = NULL;
    TRY(fish_school_create(run->arena, &school, &run->values->school));
    struct state *const state = state_create(run->arena, school);
    const enum status status = checkpoint_set_state(&resume->checkpoint, state, school);
    if (status != STATUS_OK) {
        status_fail(status, "the checkpoint of %s cannot be used: %s", resume->result, status_message());
        return status;
    }

    TRY(simulate_take_up(run->arena, &run->simulation, run->values, school, state, &resume->checkpoint.totals));
    run->simulation->started -= resume->checkpoint.wall_time;
    return STATUS_OK;
}

/* Write the result again for another end. Its final row is left out if it was a row only because it was final. */
static enum status resume_extend(struct resume *resume, struct result_origin *origin) {
    struct run *const run = &resume->run;
    const struct simulation *const simulation = run->simulation;
    const double interval = simulation->school->interval;
    const long event = simulation->state->event, per_row = lround(run->values->time.output_interval / interval),
               per_wake = lround(run->values->output.wake_interval / interval);
    const struct result_source source = {resume->result, event / per_row + 1,
                                         event % per_row == 0 && event % per_wake != 0};
    origin->overwrite = true;
    origin->source = &source;
    TRY(record_create(run->arena, &run->record, origin));

    // in this order one of the last two checkpoints matches the result at any moment
    TRY(checkpoints_write(&run->checkpoints, simulation, &run->record));
    return result_file_publish(run->record.file, "running");
}

static enum status resume_start(struct resume *resume, const char *path, const struct simulate_changes *changes) {
    struct run *const run = &resume->run;
    const struct simulate_options *const options = run->options;
    run->arena = arena_create(NULL, "a run");
    const char *checkpoint;
    TRY(resume_find(run->arena, path, &checkpoint));
    TRY(resume_open(resume, checkpoint));

    // tell the user where the run continues, that a checkpoint is damaged, and that the processor is another one
    char here[VERSION_LENGTH], line[4 * VERSION_LENGTH + PATH_MAX];
    version_processor(here);
    if (options->note && checkpoint != path) {
        snprintf(line, sizeof line, "%s continues from t = %.10g s, %.3g s of wall time after its start (%s)", path,
                 resume->checkpoint.t, resume->checkpoint.wall_time, checkpoint);
        options->note(line, options->data);
    }
    if (options->warn && resume->note) options->warn(resume->note, options->data);
    if (options->note && strcmp(here, resume->checkpoint.processor) != 0) {
        snprintf(line, sizeof line,
                 "this processor, %s, differs from the processor of the checkpoint, %s: last bits may differ", here,
                 resume->checkpoint.processor);
        options->note(line, options->data);
    }

    if (resume->is_complete && !changes->has_other_end) {
        return status_fail(STATUS_CASE, "%s is complete: give a later --end to extend the result", resume->result);
    }

    TRY(resume_case(resume, changes));
    TRY(checkpoints_create(run->arena, &run->checkpoints, run->values, resume->result, options->checkpoint_at));
    if (options->begin) TRY(options->begin(run->values, resume->result, options->data));
    TRY(resume_take_up(resume));
    const struct simulation *const simulation = run->simulation;
    checkpoints_resume(&run->checkpoints, &resume->checkpoint, simulation->state->event, changes->has_other_end);
    if (changes->has_other_end && simulation->state->event >= simulation->n_events) {
        return status_fail(STATUS_CASE, "--end %.10g: the checkpoint is at t = %.10g s already", run->values->time.end,
                           simulation->state->t);
    }

    // Replace a newest checkpoint that cannot be used. Should the rename fail, a later resume refuses it again.
    if (resume->note) rename(run->checkpoints.previous, run->checkpoints.path);

    // continue the result without the rows after the checkpoint
    struct result_origin origin = {.path = resume->result,
                                   .values = run->values,
                                   .command = options->command,
                                   .school = simulation->school,
                                   .n_events = simulation->n_events};
    if (!changes->has_other_end) {
        origin.mark = &resume->checkpoint.rows;
        origin.checksum = &resume->checksum;
    }
    const enum status status =
        changes->has_other_end ? resume_extend(resume, &origin) : record_create(run->arena, &run->record, &origin);

    // the resumed run begins anew here, so the result has to name this place
    if (run->record.file) result_file_note(run->record.file, RESULT_CHECKPOINT_AT, resume->checkpoint.places);
    return run->record.file ? run_finish(run, status) : status;
}

enum status simulate_resume(const char *checkpoint, const struct simulate_changes *changes,
                            const struct simulate_options *options) {
    struct resume resume = {.run = {.options = options}};
    const enum status status = resume_start(&resume, checkpoint, changes);
    arena_free(resume.run.arena);
    if (resume.run.values) case_free(&resume.values);
    durable_claim_release(&resume.claim);
    return status;
}
