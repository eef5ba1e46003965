/* record.c: rows that are due, and the final status of a result file. */
#include "run/record.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "case/case.h"
#include "school/warnings.h"

enum status record_path(const struct case_values *values, char **path) {
    const char *const name = values->output.file ? values->output.file : values->name;
    const char *const ending = values->output.file ? "" : ".nc";
    struct text text = {0};
    text_add(&text, "%s%s", name, ending);
    return text_take(&text, path, "a file name");
}

static void record_begin(struct record *record, const struct case_values *values, long n_events, const char *path) {
    *record = (struct record){.path = path, .n_events = n_events};
    record->events_per_row = lround(values->time.output_interval / values->school.shedding_interval);
    record->events_per_wake = lround(values->output.wake_interval / values->school.shedding_interval);
}

// result_file_create or result_file_create_steady
typedef enum status maker(struct result_file **result, const char *path, int overwrite,
                          const struct case_values *values, const char *effective, const char *command,
                          const struct school *school, long n_events);

static enum status record_make(maker *make, struct record *record, const struct case_values *values,
                               const struct school *school, long n_events, const char *path, int overwrite,
                               const char *command) {
    record_begin(record, values, n_events, path);
    char *effective = NULL;
    TRY(case_show(values, &effective));
    const enum status status = make(&record->file, path, overwrite, values, effective, command, school, n_events);
    free(effective);
    return status;
}

enum status record_create(struct record *record, const struct case_values *values, const struct school *school,
                          long n_events, const char *path, int overwrite, const char *command) {
    return record_make(result_file_create, record, values, school, n_events, path, overwrite, command);
}

enum status record_create_steady(struct record *record, const struct case_values *values, const struct school *school,
                                 long n_events, const char *path, int overwrite, const char *command) {
    return record_make(result_file_create_steady, record, values, school, n_events, path, overwrite, command);
}

enum status record_continue(struct record *record, const struct case_values *values, const struct school *school,
                            long n_events, const char *path, const struct result_mark *mark,
                            const struct result_checksum *checksum) {
    record_begin(record, values, n_events, path);
    return result_file_continue(&record->file, path, mark, checksum, values, school, n_events);
}

enum status record_extend(struct record *record, const struct case_values *values, const struct school *school,
                          long n_events, const struct result_source *source, const char *command) {
    record_begin(record, values, n_events, source->path);
    char *effective = NULL;
    TRY(case_show(values, &effective));
    const enum status status = result_file_extend(&record->file, source, values, effective, command, school, n_events);
    free(effective);
    return status;
}

enum status record_publish(const struct record *record, int is_complete) {
    return result_file_publish(record->file, is_complete ? "complete" : "running");
}

int record_is_due(const struct record *record, long event) {
    if (!record->file) return 0;

    // the end is a row even if the end is not a multiple of the output interval
    return (event - record->first) % record->events_per_row == 0 || event == record->n_events;
}

enum status record_row(const struct record *record, struct result_row *row) {
    TRY(warnings_refuse(row->school, row->state, row->diagnostics));
    const long event = row->state->event;
    row->with_wake = (event - record->first) % record->events_per_wake == 0 || event == record->n_events;
    return result_file_row(record->file, row);
}

enum status record_close(struct record *record, enum status status) {
    // closing the file can overwrite the message, which is the reason of a failure
    char reason[4096];
    snprintf(reason, sizeof reason, "%s", status_message());

    char run_status[4096 + 16];
    if (status == STATUS_OK) {
        snprintf(run_status, sizeof run_status, "complete");
    } else if (status == STATUS_STOPPED) {
        snprintf(run_status, sizeof run_status, "stopped");
    } else {
        snprintf(run_status, sizeof run_status, "failed: %s", reason);
    }

    const enum status closed = result_file_close(record->file, run_status);
    *record = (struct record){0};
    if (status == STATUS_OK) return closed;
    return status_fail(status, "%s", reason);
}

// ---- notes about the whole run

void record_notes_write(struct result_file *file, const struct simulation *simulation,
                        void (*warn)(const char *line, void *data), void *data) {
    char line[WARNING_BYTES], lines[N_WARNINGS * (WARNING_BYTES + 1)];
    size_t length = 0;
    for (enum warning w = 0; w < N_WARNINGS; w++) {
        if (!warnings_line(w, simulation->school, simulation->state, simulation->diagnostics,
                           simulation->residual->scratch, line))
            continue;
        length += (size_t)snprintf(lines + length, sizeof lines - length, "%s%s", length > 0 ? "\n" : "", line);
        if (warn) warn(line, data);
    }

    if (length > 0) result_file_note(file, RESULT_WARNINGS, lines);

    const struct school *const school = simulation->school;
    const struct closest *const closest = simulation->state->closest;
    char text[256];
    if (!isinf(closest->distance)) {
        snprintf(text, sizeof text, "%.4f m between %.60s and %.60s at t = %.4g s", closest->distance,
                 school->fish[closest->fish[0]].name, school->fish[closest->fish[1]].name, closest->t);
        result_file_note(file, RESULT_CLOSEST_APPROACH, text);
    }

    if (school->wake_merge <= 0) return;
    long n_merged = 0, n_vortices = 0;
    for (int f = 0; f < school->n_fish; f++) {
        n_merged += simulation->state->wake[f].n_merged;
        n_vortices += simulation->state->wake[f].n_vortex;
    }
    snprintf(text, sizeof text, "%ld merged with a neighbour; %ld vortices in the wakes at the end", n_merged,
             n_vortices);
    result_file_note(file, RESULT_MERGED, text);
}
