/* record.h: the result file of a run while the run goes on: which events are rows of it, and how it ends. Tested by
 * tests/run/test_simulate.c and tests/library/test_shoal.c. */
#ifndef RECORD_H
#define RECORD_H

#include "base/status.h"
#include "case/case.h"
#include "result/result_file.h"

/* Zero it to begin; there is then no file. */
struct record {
    struct result_file *file;
    const char *path;
    long events_per_row, events_per_wake;
    long first, n_events; /* the events of the first row and of the end */
};

/* The path that a case names for its result: output.file, or the name of the case with .nc. The caller frees it; NULL:
 * out of memory. */
char *record_path(const struct case_values *values);

/* Begin the file for path (kept until record_close), without a row. overwrite, command: as in result_file_create.
 * n_events: of the whole run. Fails with STATUS_FILE or STATUS_MEMORY; nothing is then left. */
enum status record_create(struct record *record, const struct case_values *values, const struct school *school,
                          long n_events, const char *path, int overwrite, const char *command);

/* The same for the file of a steady state: result_file_create_steady. */
enum status record_create_steady(struct record *record, const struct case_values *values, const struct school *school,
                                 long n_events, const char *path, int overwrite, const char *command);

/* The same for a file that is there: go on behind the rows of a mark, or make it again for another end with the rows
 * of a source, to be published (result_file_continue, result_file_extend). */
enum status record_continue(struct record *record, const struct case_values *values, const struct school *school,
                            long n_events, const char *path, const struct result_mark *mark,
                            const struct result_checksum *checksum);
enum status record_extend(struct record *record, const struct case_values *values, const struct school *school,
                          long n_events, const struct result_source *source, const char *command);

/* Give the file its name, as "running" or, where that was the last row, as "complete": result_file_publish. */
enum status record_publish(const struct record *record, int is_complete);

/* Whether an event is a row: every output interval, and the end. Not without a file. */
int record_is_due(const struct record *record, long event);

/* Append a row; the wake is in those that are due for it. Fails with STATUS_FILE. */
enum status record_row(const struct record *record, struct result_row *row);

/* Close the file and say how the run ended: STATUS_OK "complete", STATUS_STOPPED "stopped", else "failed: " and the
 * message. Returns that status with its message; where it is STATUS_OK, whether closing failed, with STATUS_FILE. */
enum status record_close(struct record *record, enum status status);

#endif
