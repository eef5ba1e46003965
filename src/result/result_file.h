/* result_file.h: writes the file of a run. doc/output.md lists its variables. Tested by
 * tests/result/test_result_file.c. */
#ifndef RESULT_FILE_H
#define RESULT_FILE_H

#include <stdbool.h>
#include <stdint.h>

#include "base/arena.h"
#include "base/status.h"
#include "case/case.h"
#include "fish/fish.h"
#include "result/netcdf.h"
#include "result/result_table.h"

/* ---- the values of the variables of the table at one event, as arrays in memory for the result file and the public
 * interface: in C order, unused slots of a fish NaN or zero */

/* The length of each dimension for this school, with n_vortex vortices per fish; the length of TIME is 1. */
void result_values_lengths(const struct school *school, int n_vortices, size_t length[RESULT_N_DIMENSIONS]);

/* The number of values of a variable at one event. */
size_t result_values_n(const struct result_variable *variable, const size_t *length);

/* The bytes of one value. */
size_t result_values_size(enum result_type type);

/* Write all values of a variable to a buffer of result_values_n of them. No fish has more vortices than the length. */
void result_values_fill(const struct result_variable *variable, const size_t *length, const struct result_row *row,
                        void *buffer);

// ---- copy of the rows of one result file into another with room for more vortices

/* Where rows come from. */
struct result_source {
    const char *path;
    long n_rows;
    bool drop_last_wake; /* the last row gets no record of the wake */
};

// ---- the rows of a result file before a checkpoint: number and checksum

struct result_mark {
    long n_rows;
    uint32_t check; /* CRC-32 of the bytes in the file: all variables without rows, and these rows */
};

/* The state of the checksum of a growing file. Zero to begin. */
struct result_checksum {
    uint64_t done; /* bytes of the file, 0: none */
    uint32_t value;
};

/* Mark the first n_rows of a file. Bytes in the checksum are not read again. Fails with STATUS_FILE if rows are missing
 * or unreadable. */
enum status result_mark_take(const char *path, long n_rows, struct result_checksum *checksum, struct result_mark *mark);

/* Fail with STATUS_FILE, and the reason, unless the file at path has the rows of a mark and the same case (effective).
 * *is_complete: the run has reached time.end. *checksum: of the mark. arena: for scratch. */
enum status result_mark_check(struct arena *arena, const char *path, const struct result_mark *mark,
                              const char *effective, struct result_checksum *checksum, bool *is_complete);

// ---- an open result file, in an arena of its own

struct result_file;

/* The arguments of a new file. */
struct result_origin {
    const char *path;
    bool overwrite; /* replace an existing result, else fail */
    const struct case_values *values;
    const char *effective; /* the complete case (case_show) */
    const char *command;   /* command line, for the attribute history */
    const struct school *school;
    long n_events;                      /* of the whole run, without the one at the start */
    bool is_steady;                     /* with the variables of a steady state */
    const struct result_source *source; /* the first rows, of a shorter or longer run of the same case; NULL: none */
    const struct result_mark *mark;     /* of a file that is continued, with its checksum; NULL: a new file */
    const struct result_checksum *checksum;
};

/* Begin a file, with the constants of the school and the rows of the source. The file appears at the path with
 * result_file_publish, which replaces a source at the same path; result_file_close removes an unpublished file, as does
 * the end of the arena. Fails with STATUS_FILE or STATUS_MEMORY; *result is then NULL. */
enum status result_file_create(struct arena *arena, struct result_file **result, const struct result_origin *origin);

/* Write the steady state into a file with these variables, which are NaN and 0 before. */
void result_file_steady(struct result_file *result, const struct school *school, const struct steady_values *steady);

/* Flush all rows to disk, set the attribute run_status, and rename the file to the path. Fails with
 * STATUS_FILE or STATUS_MEMORY; a file that existed at the path is then unchanged. */
enum status result_file_publish(struct result_file *result, const char *run_status);

/* Continue the file of origin->path, made for this case, behind the rows of origin->mark; later rows are removed.
 * run_status is "running" again. Fails with STATUS_FILE or STATUS_MEMORY; *result is then NULL. */
enum status result_file_continue(struct arena *arena, struct result_file **result, const struct result_origin *origin);

/* Flush all rows to disk, and mark the rows. Fails with STATUS_FILE, also if the published file has lost its name. */
enum status result_file_mark(struct result_file *result, struct result_mark *mark);

/* Append one row, visible to readers at once; a power cut loses the rows of the last second. Fails with STATUS_FILE,
 * also if somebody has removed, replaced or renamed the published file. */
enum status result_file_row(struct result_file *result, const struct result_row *row);

/* Set an attribute with reserved space, before closing: run_status, warnings (a line each), closest_approach ("1.2 m
 * between a and b at t = 3 s") or checkpoint_at ("0.3,1.25": times of additional checkpoints, s). At first run_status
 * is "running", the others are empty. A longer string is cut. */
enum result_note { RESULT_STATUS, RESULT_WARNINGS, RESULT_CLOSEST_APPROACH, RESULT_CHECKPOINT_AT };
void result_file_note(struct result_file *result, enum result_note note, const char *text);

/* Release the file in a fork of the process that writes it: netcdf_abandon. */
void result_file_abandon(struct result_file *result);

/* Set the attribute run_status ("complete", "failed: why", "stopped") and close. Accepts NULL. Fails with
 * STATUS_FILE, also if the published file has lost its name; another file of this name is not changed. */
enum status result_file_close(struct result_file *result, const char *run_status);

#endif
