/* record.h: result file during a run: the events that are rows, and the status at the end. Tested by
 * tests/run/test_simulate.c and tests/library/test_shoal.c. */
#ifndef RECORD_H
#define RECORD_H

#include <stdbool.h>

#include "base/arena.h"
#include "base/status.h"
#include "case/case.h"
#include "result/result_file.h"
#include "run/simulate.h"

/* A zeroed record has no file. */
struct record {
    struct result_file *file;
    const char *path;
    long events_per_row, events_per_wake;
    long first, n_events; /* the events of the first row and of the end */
};

/* Path of the result of a case: output.file, or the name of the case with .nc. */
char *record_path(struct arena *arena, const struct case_values *values);

/* Create the file of an origin, without a row (result_file_create), or continue it behind the mark of the origin; the
 * record refers to the path until record_close. origin->effective is not used. A boundary: fails with STATUS_FILE or
 * STATUS_MEMORY; no new file remains then. */
enum status record_create(struct arena *arena, struct record *record, const struct result_origin *origin);

/* Whether an event is a row: every output interval, and the end. A record without a file has no rows. */
bool record_is_due(const struct record *record, long event);

/* Append a row; rows at multiples of output.wake_interval and the last row contain the wake. Fails with STATUS_FILE,
 * or, for a run that has diverged (warnings_refuse), with STATUS_SOLVER. */
enum status record_row(const struct record *record, struct result_row *row);

/* Close the file with the status of the run: STATUS_OK "complete", STATUS_STOPPED "stopped", else "failed: " and the
 * message. Returns the given status with the given message; if the given status is STATUS_OK, fails with STATUS_FILE
 * when closing fails. */
enum status record_close(struct record *record, enum status status);

/* Write warnings into the file: lines about a state that was found, which may be "", and those about the last row; then
 * the closest approach of two bodies. Call warn, which may be NULL, for each warning about the row with data. */
void record_notes_write(struct result_file *file, const struct simulation *simulation, const char *found,
                        void (*warn)(const char *line, void *data), void *data);

#endif
