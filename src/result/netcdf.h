/* netcdf.h: the one place that calls the NetCDF library. A file of ours is written under a temporary name and gets its
 * own when it is complete; a file that may be anybody's is read with every variable checked. Tested by
 * tests/result/test_netcdf.c. */
#ifndef NETCDF_H
#define NETCDF_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "base/status.h"
#include "result/durable.h"

enum { NETCDF_MAX_DIMENSIONS = 4 /* of a variable */, NETCDF_GLOBAL = -1 /* attributes of the file */ };

enum netcdf_type { NETCDF_TEXT, NETCDF_INT, NETCDF_INT64, NETCDF_FLOAT, NETCDF_DOUBLE };

/* ---- writing
 *
 *     netcdf_create, define..., netcdf_end_definitions, write..., netcdf_publish, write..., netcdf_finish */

/* A file that is being written. Once a call has failed, later ones do nothing, and code tells why. */
struct netcdf_writer {
    const char *path;         /* as the caller names it */
    struct durable_part part; /* part.target: the path for NetCDF; part.name: NULL after netcdf_publish */
    int file;                 /* NetCDF's number; -1: none */
    double last_fsync;        /* s on the monotonic clock */
    int code;                 /* 0, or the reason of the first failure: see netcdf_reason */
};

/* A variable to define. */
struct netcdf_variable {
    const char *name, *long_name;
    const char *units; /* of numbers; "" is written as "1" */
    enum netcdf_type type;
    int n_dimensions, dimension[NETCDF_MAX_DIMENSIONS]; /* numbers of the dimensions */
    bool has_gaps;                                      /* NaN marks where there is no value */
};

/* Create a file in the classic format with 64-bit sizes (CDF-5), with the attributes Conventions, title, history (now,
 * and the command line) and source (this version and its libraries). Fails with STATUS_FILE or STATUS_MEMORY; nothing
 * has then changed, and netcdf_finish does nothing. */
enum status netcdf_create(struct netcdf_writer *writer, const char *path, const char *title, const char *command);

/* Go on writing a file of ours that is there, where the last one ended: its definitions stay as they are. Fails with
 * STATUS_FILE or STATUS_MEMORY; netcdf_finish then does nothing. */
enum status netcdf_continue(struct netcdf_writer *writer, const char *path);

/* Replace an attribute of a file that nobody writes by one of no more bytes, and make that survive a power cut. Rows
 * that are missing stay missing. Fails with STATUS_FILE or STATUS_MEMORY. */
enum status netcdf_patch(const char *path, const char *name, size_t n, const char *bytes);

/* Define a dimension, which grows where the length is 0, or a variable; the number it gets. */
int netcdf_define_dimension(struct netcdf_writer *writer, const char *name, size_t length);
int netcdf_define_variable(struct netcdf_writer *writer, const struct netcdf_variable *variable);

/* Write an attribute of a variable, by its number, or of the file (NETCDF_GLOBAL): before netcdf_end_definitions, or
 * later one of no more bytes than before. */
void netcdf_write_string(struct netcdf_writer *writer, int variable, const char *name, const char *string);
void netcdf_write_bytes(struct netcdf_writer *writer, int variable, const char *name, size_t n, const char *bytes);
void netcdf_write_integer(struct netcdf_writer *writer, int variable, const char *name, int value);

/* Values follow. All of them must be written: what is not is undefined. */
void netcdf_end_definitions(struct netcdf_writer *writer);

/* The number of a variable that has been defined. */
int netcdf_number(struct netcdf_writer *writer, const char *name);

/* Write count values of a variable from start on, each with one entry per dimension; both NULL: all of it. */
void netcdf_write_doubles(struct netcdf_writer *writer, int variable, const size_t *start, const size_t *count,
                          const double *values);
void netcdf_write_ints(struct netcdf_writer *writer, int variable, const size_t *start, const size_t *count,
                       const int *values);
void netcdf_write_longs(struct netcdf_writer *writer, int variable, const size_t *start, const size_t *count,
                        const long *values);
void netcdf_write_text(struct netcdf_writer *writer, int variable, const size_t *start, const size_t *count,
                       const char *values);

/* Show everything to readers, and make it survive a power cut: now, or if this has not been done for a second. NetCDF
 * writes the number of rows after the rows themselves, so that neither a reader nor a full disk ever sees a part of a
 * row. */
void netcdf_sync(struct netcdf_writer *writer, bool now);

/* Make the file survive a power cut and then give it its name. Fails with STATUS_FILE or STATUS_MEMORY, also where a
 * call before has failed, or where a file exists that must not be overwritten (target_check). */
enum status netcdf_publish(struct netcdf_writer *writer, bool overwrite);

/* Open a published file again after a failure: a header on a full disk has its place already, and counts whole rows
 * only. What NetCDF still holds of the rows that could not be written is given up with it: it would write a part of
 * them, and count it. */
void netcdf_reopen(struct netcdf_writer *writer);

/* Close the file and release the writer. Removes a file that has not been published; fails with STATUS_FILE where a
 * call after netcdf_publish, or closing itself, has failed. */
enum status netcdf_finish(struct netcdf_writer *writer);

/* Release the writer without touching its file, which another process writes: this one is a fork of it. */
void netcdf_abandon(struct netcdf_writer *writer);

/* What a code means. */
const char *netcdf_reason(int code);

/* ---- reading: every function fails with STATUS_FILE or STATUS_MEMORY and a message that names the file, and never
 * writes more than the caller has asked for, whatever the file says */

struct netcdf_reader {
    const char *path;
    int file;         /* NetCDF's number */
    size_t n_rows;    /* that are whole: the length of the dimension that grows */
    size_t n_missing; /* that the header counts besides, and the file does not hold: it was cut off */
};

/* A part of a variable: for each of its dimensions the name, the first index and the number of values; ends with
 * NULL. */
struct netcdf_slice {
    const char *dimension;
    size_t first, n;
};

/* Open a file of the classic formats. Refused is what is no regular file, has a damaged header, or lacks a value that
 * does not grow. Rows that are not whole do not count. The path must live as long as the reader. */
enum status netcdf_open(struct netcdf_reader *reader, const char *path);
void netcdf_close(struct netcdf_reader *reader);

/* Open a file, print what is in it, close it. Fails as these. */
enum status netcdf_print(const char *path, enum status (*print)(const struct netcdf_reader *reader, FILE *stream),
                         FILE *stream);

/* An attribute of the file: a string, "" where it is missing, that the caller frees; or an integer. */
enum status netcdf_read_string(const struct netcdf_reader *reader, const char *name, char **string);
enum status netcdf_read_integer(const struct netcdf_reader *reader, const char *name, int missing, int *value);

/* The length of a dimension; refused outside of min to max. */
enum status netcdf_read_length(const struct netcdf_reader *reader, const char *name, size_t min, size_t max,
                               size_t *length);

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

/* Where the rows of a file are, and how many. Refused is what netcdf_open refuses. */
enum status netcdf_read_rows(const char *path, struct netcdf_rows *rows);

/* Remove the rows behind the first n of a file that nobody has open. The file is whole at every time in between. Fails
 * with STATUS_FILE. */
enum status netcdf_cut_rows(const char *path, const struct netcdf_rows *rows, uint64_t n);

/* ---- shared by the files of netcdf only */

/* The path as NetCDF needs it: "./" keeps it from taking a name for an address or dropping blanks that it begins with.
 * NULL: out of memory. The caller frees it. */
char *netcdf_local_path(const char *path);

/* Whether there is memory for what NetCDF may need to create or open a file: it crashes where there is none. */
bool netcdf_has_memory(void);

#endif
