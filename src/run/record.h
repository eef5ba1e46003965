/* record.h: the result file while a run goes on: which events become rows, and which status the file has at the end.
 * Tested by tests/run/test_simulate.c and tests/library/test_shoal.c. */
#ifndef RECORD_H
#define RECORD_H

#include <stdbool.h>

#include "base/arena.h"
#include "base/status.h"
#include "case/case.h"
#include "result/result_file.h"
#include "run/simulate.h"

/* The record of a run. All zero: there is no file. */
struct record {
    struct result_file *file;
    const char *path;
    long events_per_row, events_per_wake;
    long first, n_events; /* the events of the first row and of the end */
};

/* The path of the result of a case: output.file, or the name of the case with .nc. */
char *record_path(struct arena *arena, const struct case_values *values);

/* Create the file of an origin, without rows (result_file_create), or continue it behind the mark of the origin. The
 * record refers to the path until record_close; origin->effective is not used. Fails with STATUS_FILE, and then leaves
 * no new file. */
enum status record_create(struct arena *arena, struct record *record, const struct result_origin *origin);

/* Whether an event becomes a row: one in every output interval does, and so does the end. A record without a file has
 * no rows. */
bool record_is_due(const struct record *record, long event);

/* Append a row. Rows at multiples of output.wake_interval contain the wake, and so does the last row. Fails with
 * STATUS_FILE, or with STATUS_SOLVER if the run has diverged (warnings_refuse). */
enum status record_row(const struct record *record, struct result_row *row);

/* Close the file and give it the status of the run: "complete" for STATUS_OK, "stopped" for STATUS_STOPPED, else
 * "failed: " and the message. Returns the given status with the given message; only if that is STATUS_OK can it fail
 * with STATUS_FILE, because closing failed. */
enum status record_close(struct record *record, enum status status);

/* Write the warnings into the file: lines about a state that was found (may be ""), lines about the last row, and the
 * closest approach of two bodies. warn is called with data for each warning about the row; it may be NULL. */
void record_notes_write(struct result_file *file, const struct simulation *simulation, const char *found,
                        void (*warn)(const char *line, void *data), void *data);

#endif
