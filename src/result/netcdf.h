/* netcdf.h: the only caller of the NetCDF library. A file is written as a part, which is renamed when it is complete.
 * Reading checks every variable, because a file may come from another program. Tested by tests/result/test_netcdf.c. */
#ifndef NETCDF_H
#define NETCDF_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "base/arena.h"
#include "base/status.h"
#include "result/durable.h"

enum { NETCDF_MAX_DIMENSIONS = 4 /* of a variable */, NETCDF_GLOBAL = -1 /* attributes of the file */ };

enum netcdf_type { NETCDF_TEXT, NETCDF_INT, NETCDF_INT64, NETCDF_FLOAT, NETCDF_DOUBLE };

/* ---- writing
 *
 *     netcdf_create, define..., netcdf_end_definitions, write..., netcdf_publish, write..., netcdf_finish */

/* A file that is being written. Once a call has failed, later ones do nothing, and code tells why. */
struct netcdf_writer {
    const char *path;         /* of the file: in part.target */
    struct durable_part part; /* part.target: the path for NetCDF; part.name: "" after netcdf_publish */
    int file;                 /* NetCDF's number; -1: none */
    double last_fsync;        /* s on the monotonic clock */
    int code;                 /* 0, or the reason of the first failure: see netcdf_reason */
};

/* A variable to define. NaN marks missing values of a real variable without an axis. */
struct netcdf_variable {
    const char *name, *long_name;
    const char *units; /* of numbers; "" or NULL is written as "1" */
    const char *axis;  /* "T", "X" or "Y"; NULL: none */
    const char *flags; /* the words of the values 0, 1, ..., separated by blanks; NULL: none */
    enum netcdf_type type;
    int n_dimensions, dimension[NETCDF_MAX_DIMENSIONS]; /* numbers of the dimensions */
};

/* Create a file in the classic format with 64-bit sizes (CDF-5), with the attributes Conventions, title, history (now,
 * and the command line, unless NULL) and source (this version and its libraries). Fails with STATUS_FILE or
 * STATUS_MEMORY; no file has then changed, and netcdf_finish does nothing. */
enum status netcdf_create(struct netcdf_writer *writer, const char *path, const char *title, const char *command);

/* Continue an existing file of shoal behind the last row; the definitions are unchanged. Fails with
 * STATUS_FILE or STATUS_MEMORY; netcdf_finish then does nothing. */
enum status netcdf_continue(struct netcdf_writer *writer, const char *path);

/* Replace an attribute of a file that nobody is writing by one of no more bytes, so that this survives a power cut.
 * Rows that are missing stay missing. Fails with STATUS_FILE or STATUS_MEMORY. */
enum status netcdf_patch(const char *path, const char *name, size_t n, const char *bytes);

/* Define a dimension (length 0: grows by rows) or a variable; returns the number of the dimension or variable. */
int netcdf_define_dimension(struct netcdf_writer *writer, const char *name, size_t length);
int netcdf_define_variable(struct netcdf_writer *writer, const struct netcdf_variable *variable);

/* Write an attribute of a variable, by number, or of the file (NETCDF_GLOBAL). After netcdf_end_definitions an
 * attribute can only be replaced, by at most as many bytes. */
void netcdf_write_string(struct netcdf_writer *writer, int variable, const char *name, const char *string);
void netcdf_write_bytes(struct netcdf_writer *writer, int variable, const char *name, size_t n, const char *bytes);
void netcdf_write_integer(struct netcdf_writer *writer, int variable, const char *name, int value);

/* End the definitions. Write all values afterwards: values that are not written are undefined. */
void netcdf_end_definitions(struct netcdf_writer *writer);

/* The number of a variable that has been defined. */
int netcdf_number(struct netcdf_writer *writer, const char *name);

/* Write count values of a variable from start on, with one entry per dimension; both NULL: the entire variable. */
void netcdf_write_doubles(struct netcdf_writer *writer, int variable, const size_t *start, const size_t *count,
                          const double *values);

/* The same for values in memory of the type of the variable: char, int, long (int64), or double. */
void netcdf_write(struct netcdf_writer *writer, int variable, const size_t *start, const size_t *count,
                  const void *values);

/* Make all rows visible to readers and flush to disk: now, or if the last flush is over a second ago. NetCDF writes the
 * number of rows after the rows, so that readers never see part of a row, even on a full disk. */
void netcdf_sync(struct netcdf_writer *writer, bool now);

/* Flush the file to disk and then rename the file to the path. Fails with STATUS_FILE or STATUS_MEMORY, also after a
 * failure of an earlier call, or for an existing file that must not be overwritten (target_check). */
enum status netcdf_publish(struct netcdf_writer *writer, bool overwrite);

/* Open a published file again after a failure: on a full disk the header is in place and counts complete rows only. The
 * rows in the buffer of NetCDF that could not be written are discarded: NetCDF would write and count part of these
 * rows. */
void netcdf_reopen(struct netcdf_writer *writer);

/* Close the file and release the writer. Removes an unpublished file. Fails with STATUS_FILE if closing, or a call
 * after netcdf_publish, has failed. */
enum status netcdf_finish(struct netcdf_writer *writer);

/* Release the writer in a fork of the writing process, without touching the file. */
void netcdf_abandon(struct netcdf_writer *writer);

/* The message of a NetCDF code. */
const char *netcdf_reason(int code);

/* ---- reading: every function fails with STATUS_FILE or STATUS_MEMORY and a message that names the file, and never
 * writes more values than requested, whatever the contents of the file */

struct netcdf_reader {
    struct arena *arena; /* of strings */
    const char *path;
    int file;         /* NetCDF's number */
    size_t n_rows;    /* that are whole: the length of the dimension that grows */
    size_t n_missing; /* further rows counted by the header but missing: the file was truncated */
};

/* Part of a variable: for each dimension the name, the first index and the number of values; ends with NULL. */
struct netcdf_slice {
    const char *dimension;
    size_t first, n;
};

/* Open a file of the classic formats, until the arena is freed. Refuses anything but a regular file, a damaged header,
 * and a missing value of a variable without rows. Incomplete rows do not count. The reader must be a part of the arena;
 * the path must outlive the arena. */
enum status netcdf_open(struct arena *arena, struct netcdf_reader *reader, const char *path);

/* Open a file, print the contents, close the file. arena: for scratch. Fails as netcdf_open or print. */
enum status netcdf_print(struct arena *arena, const char *path,
                         enum status (*print)(const struct netcdf_reader *reader, FILE *stream), FILE *stream);

/* An attribute of the file: a string in the arena of the reader, "" if missing; or an integer. */
enum status netcdf_attribute(const struct netcdf_reader *reader, const char *name, char **string);
enum status netcdf_read_integer(const struct netcdf_reader *reader, const char *name, int missing, int *value);

/* The length of a dimension; refused outside of min to max. */
enum status netcdf_read_length(const struct netcdf_reader *reader, const char *name, size_t min, size_t max,
                               size_t *length);

/* Name and dimensions of a variable. */
struct netcdf_shape {
    char name[80], dimension[NETCDF_MAX_DIMENSIONS][80];
    size_t length[NETCDF_MAX_DIMENSIONS];
    int n_dimensions;
    bool is_text;
};

/* Describe variable i, from 0, of the file: false beyond the last one. A variable with longer names or more dimensions
 * has the name "". */
bool netcdf_read_shape(const struct netcdf_reader *reader, int i, struct netcdf_shape *shape);

/* Whether the file has a variable of this name. */
bool netcdf_has(const struct netcdf_reader *reader, const char *name);

/* Read a part of a variable: numbers of any type as doubles, or characters, without a zero at the end. Refused is a
 * variable that is missing, of the other kind, or has not exactly these dimensions, or not so long. */
enum status netcdf_read_doubles(const struct netcdf_reader *reader, const char *name, const struct netcdf_slice *slice,
                                double *values);
enum status netcdf_read_text(const struct netcdf_reader *reader, const char *name, const struct netcdf_slice *slice,
                             char *values);

/* ---- rows of a CDF-5 file, as bytes */

struct netcdf_rows {
    uint64_t begin;         /* of all values */
    uint64_t begin_of_rows; /* of the first row */
    uint64_t bytes;         /* of each row; 0: the file has no rows */
    uint64_t n;             /* rows that are whole */
    uint64_t n_counted;     /* rows that the header counts */
};

/* The places and the number of the rows of a file. Refuses the same files as netcdf_open. */
enum status netcdf_read_rows(const char *path, struct netcdf_rows *rows);

/* Remove the rows behind the first n of a file that nobody has open. The file is whole at every time in between. Fails
 * with STATUS_FILE. */
enum status netcdf_cut_rows(const char *path, const struct netcdf_rows *rows, uint64_t n);

#endif
