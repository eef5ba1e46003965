/* record.h: result file during a run: the events that are rows, and the status at the end. Tested by
 * tests/run/test_simulate.c and tests/library/test_shoal.c. */
#ifndef RECORD_H
#define RECORD_H

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

/* Path of the result of a case: output.file, or the name of the case with .nc. The caller frees *path. Fails with
 * STATUS_MEMORY. */
enum status record_path(const struct case_values *values, char **path);

/* Create the file for path, without a row; the record refers to path until record_close. overwrite, command: as in
 * result_file_create. n_events: of the whole run. Fails with STATUS_FILE or STATUS_MEMORY; no file remains then. */
enum status record_create(struct record *record, const struct case_values *values, const struct school *school,
                          long n_events, const char *path, int overwrite, const char *command);

/* The same for the file of a steady state: result_file_create_steady. */
enum status record_create_steady(struct record *record, const struct case_values *values, const struct school *school,
                                 long n_events, const char *path, int overwrite, const char *command);

/* The same for an existing file: record_continue appends after the rows of a mark (result_file_continue), record_extend
 * writes a new file for another end with the rows of a source, to be published (result_file_extend). */
enum status record_continue(struct record *record, const struct case_values *values, const struct school *school,
                            long n_events, const char *path, const struct result_mark *mark,
                            const struct result_checksum *checksum);
enum status record_extend(struct record *record, const struct case_values *values, const struct school *school,
                          long n_events, const struct result_source *source, const char *command);

/* Give the file the final name, with status "complete" after the last row, else "running": result_file_publish. */
enum status record_publish(const struct record *record, int is_complete);

/* Whether an event is a row: every output interval, and the end. A record without a file has no rows. */
int record_is_due(const struct record *record, long event);

/* Append a row; rows at multiples of output.wake_interval and the last row contain the wake. Fails with STATUS_FILE,
 * or, for a run that has diverged (warnings_refuse), with STATUS_SOLVER. */
enum status record_row(const struct record *record, struct result_row *row);

/* Close the file with the status of the run: STATUS_OK "complete", STATUS_STOPPED "stopped", else "failed: " and the
 * message. Returns the given status with the given message; if the given status is STATUS_OK, fails with STATUS_FILE
 * when closing fails. */
enum status record_close(struct record *record, enum status status);

/* Write all warnings about the last row and the closest approach of two bodies into the file. Call warn, which may be
 * NULL, for each warning with data. */
void record_notes_write(struct result_file *file, const struct simulation *simulation,
                        void (*warn)(const char *line, void *data), void *data);

#endif
