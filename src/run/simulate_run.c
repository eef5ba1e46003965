/* simulate_run.c: the loop over events, with rows and checkpoints; checks of a checkpoint and its result before a run
 * is resumed. */
#include "run/simulate_run.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/arena.h"
#include "base/memory.h"
#include "base/text.h"
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

// a run with result and checkpoints
struct run {
    const struct case_values *values;
    const struct simulate_options *options;
    struct simulation *simulation;
    struct record record;
    struct checkpoints checkpoints;
    struct state *before; /* state at the last event, if the run can be stopped between events */
};

// ---- from event to event

static enum status run_write_if_due(struct run *run) {
    if (!record_is_due(&run->record, run->simulation->state->event)) return STATUS_OK;
    struct integrator_counts counts;
    struct result_row row;
    simulate_row(run->simulation, &counts, &row);
    return record_row(&run->record, &row);
}

static void run_report_progress(const struct run *run) {
    if (!run->options->progress) return;
    const struct simulation *const simulation = run->simulation;
    struct integrator_counts counts;
    simulation->integrator->count(simulation->solver, &counts);
    struct simulate_progress progress = {.t = simulation->state->t,
                                         .end = run->values->time.end,
                                         .event = simulation->state->event,
                                         .steps = counts.steps,
                                         .wall_time = simulate_wall_time(simulation)};
    for (int f = 0; f < simulation->school->n_fish; f++) progress.n_vortices += simulation->state->wake[f].n_vortex;
    run->options->progress(&progress, run->options->data);
}

static enum status run_checkpoint_if_due(struct run *run) {
    struct simulation *const simulation = run->simulation;
    if (!checkpoints_are_due(&run->checkpoints, simulation->state->event)) return STATUS_OK;
    TRY(checkpoints_write(&run->checkpoints, simulation, &run->record));
    return simulation->state->event < simulation->n_events ? simulate_renew(simulation) : STATUS_OK;
}

// stop at an event, with a checkpoint
static enum status run_stop(struct run *run) {
    const double t = run->simulation->state->t;
    TRY(checkpoints_write(&run->checkpoints, run->simulation, &run->record));
    return status_fail(STATUS_STOPPED, "stopped %s at t = %.10g s: continue with 'shoal resume %s'",
                       simulate_stopped_by(run->options->stop), t, run->checkpoints.word.text);
}

// advance to the next event, or restore the state at the last event and stop
static enum status run_step(struct run *run) {
    struct simulation *const simulation = run->simulation;
    if (run->options->stop && *run->options->stop) return run_stop(run);
    if (run->before) TRY(state_table_keep(run->before, simulation->state, simulation->school));
    const enum status status = simulate_step(simulation);
    if (status != STATUS_STOPPED) return status;
    TRY(state_table_keep(simulation->state, run->before, simulation->school));
    return run_stop(run);
}

static enum status run_loop(struct run *run) {
    MEMORY_BOUNDARY(STATUS_MEMORY);
    struct simulation *const simulation = run->simulation;
    simulation->stop = run->options->stop;
    if (simulation->stop) TRY(state_create(&run->before, simulation->school));
    while (simulation->state->event < simulation->n_events) {
        TRY(run_step(run));
        TRY(run_write_if_due(run));
        TRY(run_checkpoint_if_due(run));
        run_report_progress(run);
    }
    return STATUS_OK;
}

/* Run to the end and close the record. */
static enum status run_finish(struct run *run, enum status status) {
    if (status == STATUS_OK) status = run_loop(run);

    // no notes for a run that was stopped or could not be renewed
    if (status != STATUS_STOPPED && run->simulation->residual) {
        record_notes_write(run->record.file, run->simulation, run->options->warn, run->options->data);
    }
    return record_close(&run->record, status);
}

static void run_release(struct run *run) {
    if (run->simulation) state_free(run->before, run->simulation->school);
    simulate_free(run->simulation);
    checkpoints_free(&run->checkpoints);
}

// ---- a new run

static int result_is_unfinished(const char *result, const char *path, const char *effective, double *t) {
    struct checkpoint checkpoint;
    struct result_checksum checksum;
    int is_complete = 1;
    if (checkpoint_read(&checkpoint, path) != STATUS_OK) return 0;
    *t = checkpoint.t;
    // the rows tell the run: their wall times differ from run to run
    const int is_good = checkpoint_check_program(&checkpoint) == STATUS_OK &&
                        result_mark_check(result, &checkpoint.rows, effective, &checksum, &is_complete) == STATUS_OK;
    checkpoint_free(&checkpoint);
    return is_good && !is_complete;
}

int simulate_can_resume(const char *result, const char *checkpoint, const char *effective, double *t) {
    char *const previous = checkpoints_previous(checkpoint);
    const int is_possible = result_is_unfinished(result, checkpoint, effective, t) ||
                            (previous && result_is_unfinished(result, previous, effective, t));
    free(previous);
    return is_possible;
}

static enum status run_start(struct run *run) {
    MEMORY_BOUNDARY(STATUS_MEMORY);
    const struct simulate_options *const options = run->options;
    struct checkpoints *const checkpoints = &run->checkpoints;
    TRY(checkpoints_create(checkpoints, run->values, options->path, options->checkpoint_at));
    if (!options->overwrite) {
        double t;
        if (simulate_can_resume(options->path, checkpoints->path, checkpoints->effective, &t)) {
            return status_fail(STATUS_FILE,
                               "%s is an unfinished result of this case: continue from t = %.6g s with 'shoal resume "
                               "%s', or start again with --force",
                               options->path, t, checkpoints->word.text);
        }
        TRY(target_check(options->path, TARGET_NETCDF, false));
    }

    if (options->begin) TRY(options->begin(run->values, options->path, options->data));

    const enum status started = simulate_start(NULL, &run->simulation, run->values, options->stop);
    if (started == STATUS_STOPPED)
        return status_fail(started, "stopped %s during the event at t = 0: start the run again",
                           simulate_stopped_by(run->options->stop));
    TRY(started);
    TRY(record_create(&run->record, run->values, run->simulation->school, run->simulation->n_events, options->path,
                      options->overwrite, options->command));

    // an earlier result stays in place until the first row of the new result is safe
    enum status status = run_write_if_due(run);
    if (status == STATUS_OK) status = record_publish(&run->record, 0);
    if (status == STATUS_OK) {
        checkpoints_remove(checkpoints);
        status = run_checkpoint_if_due(run);
    }

    return run_finish(run, status);
}

static enum status run_all(void *data) {
    struct run *const run = data;
    const enum status status = run_start(run);
    run_release(run);
    return status;
}

enum status simulate_run(const struct case_values *values, const struct simulate_options *options) {
    struct run run = {.values = values, .options = options};
    return durable_claim_hold(options->path, run_all, &run);
}

// ---- a run that is resumed

struct resume {
    struct checkpoint checkpoint;
    char *result; /* path of the result */
    struct durable_claim claim;
    struct result_checksum checksum; /* of the rows of the result */
    int is_complete;                 /* the run of the result has reached the end */
    char *note;                      /* reason for not using the newest checkpoint; NULL: used */
};

static enum status resume_try(struct resume *resume, const char *path) {
    struct checkpoint *const checkpoint = &resume->checkpoint;
    TRY(checkpoint_read(checkpoint, path));
    enum status status = checkpoint_check_program(checkpoint);
    if (status != STATUS_OK) status_fail(status, "%s: cannot be used: %s", path, status_message());

    // the result is in the folder of the checkpoint
    if (status == STATUS_OK && !resume->result) {
        const char *const slash = strrchr(path, '/');
        struct text result = {0};
        text_add(&result, "%.*s%s", slash ? (int)(slash + 1 - path) : 0, path, checkpoint->result);
        status = text_take(&result, &resume->result, "a file name");
    }

    if (status == STATUS_OK && !resume->claim.part) {
        status = access(resume->result, F_OK) == 0 ? target_check(resume->result, TARGET_NETCDF, true) : STATUS_OK;
        if (status == STATUS_OK) status = durable_claim_take(&resume->claim, resume->result);
    }
    if (status == STATUS_OK) {
        status = result_mark_check(resume->result, &checkpoint->rows, checkpoint->effective, &resume->checksum,
                                   &resume->is_complete);
    }
    if (status != STATUS_OK) checkpoint_free(checkpoint);
    return status;
}

/* Open the checkpoint at path or, if this checkpoint cannot be used, the previous checkpoint, and claim the result.
 * Fails with STATUS_FILE and the reason, or with STATUS_MEMORY. resume_close releases everything, including the claim,
 * also after a failure. */
static enum status resume_open(struct resume *resume, const char *path) {
    *resume = (struct resume){.claim.descriptor = {-1, -1}};
    const enum status status = resume_try(resume, path);
    if (status != STATUS_FILE) return status;
    char reason[4096];
    snprintf(reason, sizeof reason, "%s", status_message());

    // fall back to the previous checkpoint
    char *const previous = checkpoints_previous(path);
    TRY(memory_check(previous, "a file name"));
    if (access(previous, F_OK) == 0 && resume_try(resume, previous) == STATUS_OK) {
        struct text note = {0};
        text_add(&note, "%s; resuming from %s", reason, previous);
        resume->note = note.text;
    }

    free(previous);
    return resume->note ? STATUS_OK : status_fail(STATUS_FILE, "%s", reason);
}

static void resume_close(struct resume *resume) {
    checkpoint_free(&resume->checkpoint);
    durable_claim_release(&resume->claim);
    free(resume->result);
    free(resume->note);
    *resume = (struct resume){.claim.descriptor = {-1, -1}};
}

/* Read the case of the checkpoint with assignments, as case_read does. The values include the text of the case file and
 * the study of the result. Fails with STATUS_CASE, STATUS_FILE or STATUS_MEMORY; *values then owns nothing. */
static enum status resume_case(const struct resume *resume, int n_assignments, const char *const *assignments,
                               struct case_values *values) {
    const char *const text = resume->checkpoint.effective;
    TRY(case_parse(values, text, strlen(text), resume->checkpoint.result, NULL, n_assignments, assignments));

    // the complete case of the checkpoint contains neither text nor study
    struct netcdf_reader reader;
    enum status status = netcdf_open(&reader, resume->result);
    if (status == STATUS_OK) {
        free(values->text);
        values->text = NULL;
        status = netcdf_read_string(&reader, "case_text", &values->text);
        if (status == STATUS_OK) status = netcdf_read_string(&reader, "study_case", &values->study);
        if (status == STATUS_OK) status = netcdf_read_integer(&reader, "study_member", 0, &values->member);
        netcdf_close(&reader);
    }

    // a run outside a study has an empty text
    if (values->study && !*values->study) {
        free(values->study);
        values->study = NULL;
    }
    if (status != STATUS_OK) case_free(values);
    return status;
}

static enum status run_take_up(struct run *run, const struct resume *resume) {
    MEMORY_BOUNDARY(STATUS_MEMORY);
    struct school *school = NULL;
    struct state *state = NULL;
    TRY(fish_school_create(&school, &run->values->school));
    enum status status = state_create(&state, school);
    if (status == STATUS_OK) {
        status = checkpoint_set_state(&resume->checkpoint, state, school);
        if (status != STATUS_OK) {
            status_fail(status, "the checkpoint of %s cannot be used: %s", resume->result, status_message());
        }
    }

    if (status != STATUS_OK) {
        state_free(state, school);
        fish_school_free(school);
        return status;
    }

    TRY(simulate_take_up(NULL, &run->simulation, run->values, school, state, &resume->checkpoint.totals));
    run->simulation->started -= resume->checkpoint.wall_time;
    return STATUS_OK;
}

// the result with another end: drop the final row if it was written only because it was final
static enum status run_extend_record(struct run *run, const struct resume *resume) {
    const struct simulation *const simulation = run->simulation;
    const struct case_time *const time = &run->values->time;
    const double interval = simulation->school->interval;
    const long event = simulation->state->event, per_row = lround(time->output_interval / interval),
               per_wake = lround(run->values->output.wake_interval / interval);
    const struct result_source source = {resume->result, event / per_row + 1,
                                         event % per_row == 0 && event % per_wake != 0};

    TRY(record_extend(&run->record, run->values, simulation->school, simulation->n_events, &source,
                      run->options->command));
    result_file_note(run->record.file, RESULT_CHECKPOINT_AT, resume->checkpoint.places);

    // in this order one of the last two checkpoints always matches the result
    TRY(checkpoints_write(&run->checkpoints, simulation, &run->record));
    return record_publish(&run->record, 0);
}

static enum status run_resume_at(struct run *run, const struct resume *resume, int with_other_end) {
    const struct simulate_options *const options = run->options;
    TRY(checkpoints_create(&run->checkpoints, run->values, resume->result, options->checkpoint_at));
    if (options->begin) TRY(options->begin(run->values, resume->result, options->data));
    TRY(run_take_up(run, resume));

    const struct simulation *const simulation = run->simulation;
    TRY(checkpoints_resume(&run->checkpoints, &resume->checkpoint, simulation->state->event, with_other_end));
    if (with_other_end && simulation->state->event >= simulation->n_events) {
        return status_fail(STATUS_CASE, "--end %.10g: the checkpoint is at t = %.10g s already", run->values->time.end,
                           simulation->state->t);
    }

    if (resume->note) checkpoints_fall_back(&run->checkpoints);

    // the existing result, without the rows after the checkpoint
    const enum status status =
        with_other_end ? run_extend_record(run, resume)
                       : record_continue(&run->record, run->values, simulation->school, simulation->n_events,
                                         resume->result, &resume->checkpoint.rows, &resume->checksum);
    return run->record.file ? run_finish(run, status) : status;
}

enum status simulate_resume(const char *checkpoint, const struct simulate_changes *changes,
                            const struct simulate_options *options) {
    struct resume resume;
    struct case_values values;
    enum status status = resume_open(&resume, checkpoint);
    if (status != STATUS_OK) goto close;

    // tell the user of a damaged checkpoint and of another processor
    char here[VERSION_LENGTH], line[4 * VERSION_LENGTH];
    version_processor(here);
    if (options->warn && resume.note) options->warn(resume.note, options->data);
    if (options->note && strcmp(here, resume.checkpoint.processor) != 0) {
        snprintf(line, sizeof line,
                 "this processor, %s, differs from the processor of the checkpoint, %s: last bits may differ", here,
                 resume.checkpoint.processor);
        options->note(line, options->data);
    }

    if (resume.is_complete && !changes->has_other_end) {
        status = status_fail(STATUS_CASE, "%s is complete: give a later --end to extend the result", resume.result);
        goto close;
    }

    status = resume_case(&resume, changes->n_assignments, changes->assignments, &values);
    if (status == STATUS_OK) {
        struct run run = {.values = &values, .options = options};
        status = run_resume_at(&run, &resume, changes->has_other_end);
        run_release(&run);
        case_free(&values);
    }
close:
    resume_close(&resume);
    return status;
}
