/* record.c: which rows are due, and how a result file ends. */
#include "run/record.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "case/case.h"
#include "school/warnings.h"

char *record_path(struct arena *arena, const struct case_values *values) {
    const char *const file = values->output.file;
    return arena_text(arena, "%s%s", file ? file : values->name, file ? "" : ".nc");
}

enum status record_create(struct arena *arena, struct record *record, const struct result_origin *origin) {
    const struct case_values *const values = origin->values;
    struct result_origin whole = *origin;
    *record = (struct record){.path = origin->path, .n_events = origin->n_events};
    record->events_per_row = lround(values->time.output_interval / values->school.shedding_interval);
    record->events_per_wake = lround(values->output.wake_interval / values->school.shedding_interval);
    if (origin->mark) return result_file_continue(arena, &record->file, origin);
    whole.effective = case_show(arena, values);
    return result_file_create(arena, &record->file, &whole);
}

bool record_is_due(const struct record *record, long event) {
    if (!record->file) return false;

    // the end is a row even if it is not a multiple of the output interval
    return (event - record->first) % record->events_per_row == 0 || event == record->n_events;
}

enum status record_row(const struct record *record, struct result_row *row) {
    TRY(warnings_refuse(row->school, row->state, row->diagnostics));
    const long event = row->state->event;
    row->with_wake = (event - record->first) % record->events_per_wake == 0 || event == record->n_events;
    return result_file_row(record->file, row);
}

enum status record_close(struct record *record, enum status status) {
    // closing the file may overwrite the message, which is the reason of the failure
    char reason[4096];
    snprintf(reason, sizeof reason, "%s", status_message());

    char failed[4096 + 16];
    snprintf(failed, sizeof failed, "failed: %s", reason);
    const char *const run_status = status == STATUS_OK ? "complete" : status == STATUS_STOPPED ? "stopped" : failed;
    const enum status closed = result_file_close(record->file, run_status);
    *record = (struct record){0};
    if (status == STATUS_OK) return closed;
    return status_fail(status, "%s", reason);
}

// ---- notes about the whole run

void record_notes_write(struct result_file *file, const struct simulation *simulation, const char *found,
                        void (*warn)(const char *line, void *data), void *data) {
    char line[WARNING_BYTES], lines[(N_WARNINGS + 4) * (WARNING_BYTES + 1)];
    size_t length = (size_t)snprintf(lines, sizeof lines, "%s", found);
    for (enum warning w = 0; w < N_WARNINGS; w++) {
        if (!warnings_line(w, simulation->residual, simulation->state, simulation->diagnostics, line)) continue;
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
}
