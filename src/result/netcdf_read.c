/* netcdf_read.c: reading files that may be anybody's. */
#include <errno.h>
#include <limits.h>
#include <netcdf.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "result/netcdf.h"

static enum status netcdf_out_of_memory(const char *path) {
    return status_fail(STATUS_MEMORY, "%s: out of memory while reading", path);
}

static enum status cannot_read(const char *path, int code) {
    if (code == NC_ENOMEM) return netcdf_out_of_memory(path);
    return status_fail(STATUS_FILE, "%s: cannot be read: %s", path, nc_strerror(code));
}

// ---- the file

enum status netcdf_open(struct netcdf_reader *reader, const char *path) {
    *reader = (struct netcdf_reader){.path = path, .file = -1};
    struct stat facts;
    if (stat(path, &facts) != 0) return cannot_read(path, errno);
    if (S_ISDIR(facts.st_mode)) return status_fail(STATUS_FILE, "%s is a folder: name a file that shoal wrote", path);
    if (!S_ISREG(facts.st_mode)) return status_fail(STATUS_FILE, "%s: cannot be read: not an ordinary file", path);
    struct netcdf_rows rows;
    TRY(netcdf_read_rows(path, &rows));
    reader->n_rows = rows.n;
    reader->n_missing = rows.n_counted - rows.n;
    char *const local = netcdf_has_memory() ? netcdf_local_path(path) : NULL;
    if (!local) return netcdf_out_of_memory(path);
    const int code = nc_open(local, NC_NOWRITE, &reader->file);
    free(local);

    // NetCDF also returns NC_ENOMEM for a damaged header with huge sizes
    if (code == NC_ENOMEM)
        return status_fail(STATUS_FILE, "%s: cannot be read: the header is damaged, or out of memory", path);
    return code == NC_NOERR ? STATUS_OK : cannot_read(path, code);
}

void netcdf_close(struct netcdf_reader *reader) {
    if (reader->file >= 0) nc_close(reader->file);
    reader->file = -1;
}

enum status netcdf_print(const char *path, enum status (*print)(const struct netcdf_reader *reader, FILE *stream),
                         FILE *stream) {
    struct netcdf_reader reader;
    TRY(netcdf_open(&reader, path));
    const enum status status = print(&reader, stream);
    netcdf_close(&reader);
    return status;
}

// ---- attributes and dimensions

enum status netcdf_read_string(const struct netcdf_reader *reader, const char *name, char **string) {
    nc_type type = NC_CHAR;
    size_t length = 0;
    const bool exists = nc_inq_att(reader->file, NC_GLOBAL, name, &type, &length) == NC_NOERR;
    *string = NULL;
    if (type != NC_CHAR) return status_fail(STATUS_FILE, "%s: attribute %s is no string", reader->path, name);
    *string = calloc((exists ? length : 0) + 1, 1);
    if (!*string) return netcdf_out_of_memory(reader->path);
    const int code = exists ? nc_get_att_text(reader->file, NC_GLOBAL, name, *string) : NC_NOERR;
    if (code == NC_NOERR) return STATUS_OK;
    free(*string);
    *string = NULL;
    return cannot_read(reader->path, code);
}

enum status netcdf_read_integer(const struct netcdf_reader *reader, const char *name, int missing, int *value) {
    nc_type type;
    size_t length;
    *value = missing;
    if (nc_inq_att(reader->file, NC_GLOBAL, name, &type, &length) != NC_NOERR) return STATUS_OK;
    if (length == 1 && type == NC_INT && nc_get_att_int(reader->file, NC_GLOBAL, name, value) == NC_NOERR)
        return STATUS_OK;
    return status_fail(STATUS_FILE, "%s: attribute %s is no integer", reader->path, name);
}

/* The length of a dimension; of the one that grows the rows that are whole. */
static int read_length(const struct netcdf_reader *reader, int number, size_t *length) {
    int growing;
    const int code = nc_inq_dimlen(reader->file, number, length);
    if (code == NC_NOERR && nc_inq_unlimdim(reader->file, &growing) == NC_NOERR && growing == number)
        *length = reader->n_rows;
    return code;
}

enum status netcdf_read_length(const struct netcdf_reader *reader, const char *name, size_t min, size_t max,
                               size_t *length) {
    int number;
    if (nc_inq_dimid(reader->file, name, &number) != NC_NOERR || read_length(reader, number, length) != NC_NOERR) {
        return status_fail(STATUS_FILE, "%s: dimension %s is missing", reader->path, name);
    }
    if (*length >= min && *length <= max) return STATUS_OK;
    return status_fail(STATUS_FILE, "%s: dimension %s has an invalid length, %zu", reader->path, name, *length);
}

// ---- variables

bool netcdf_has(const struct netcdf_reader *reader, const char *name) {
    int number;
    return nc_inq_varid(reader->file, name, &number) == NC_NOERR;
}

/* Whether a variable has exactly the dimensions of a slice, so long. */
static bool has_slice(const struct netcdf_reader *reader, int n, const int *dimensions,
                      const struct netcdf_slice *slice) {
    for (int d = 0; d < n; d++, slice++) {
        char name[NC_MAX_NAME + 1];
        size_t length;
        if (!slice->dimension || nc_inq_dimname(reader->file, dimensions[d], name) != NC_NOERR) return false;
        if (read_length(reader, dimensions[d], &length) != NC_NOERR) return false;
        if (strcmp(name, slice->dimension) != 0) return false;
        if (slice->first > length || slice->n > length - slice->first) return false;
    }

    return !slice->dimension;
}

/* Fail with the expected form of a variable. */
static enum status refuse_variable(const struct netcdf_reader *reader, const char *name, bool is_text,
                                   const struct netcdf_slice *slice) {
    char dimensions[256] = "";
    for (size_t length = 0; slice->dimension; slice++) {
        length += (size_t)snprintf(dimensions + length, sizeof dimensions - length, "%s%s[%zu:%zu]",
                                   length > 0 ? ", " : "", slice->dimension, slice->first, slice->first + slice->n);
        if (length >= sizeof dimensions) break;
    }
    return status_fail(STATUS_FILE, "%s: variable %s was not written by shoal: %s over (%s) %s expected", reader->path,
                       name, is_text ? "text" : "numbers", dimensions, is_text ? "is" : "are");
}

/* The number of a variable of the expected form, with the slice as start and count for NetCDF. */
static enum status find_variable(const struct netcdf_reader *reader, const char *name, bool is_text,
                                 const struct netcdf_slice *slice, int *number, size_t *start, size_t *count) {
    int n, dimensions[NC_MAX_VAR_DIMS];
    nc_type type;
    if (nc_inq_varid(reader->file, name, number) != NC_NOERR)
        return status_fail(STATUS_FILE, "%s: variable %s is missing", reader->path, name);
    const int code = nc_inq_var(reader->file, *number, NULL, &type, &n, dimensions, NULL);
    if (code != NC_NOERR) return cannot_read(reader->path, code);
    if ((type == NC_CHAR) != is_text || n > NETCDF_MAX_DIMENSIONS || !has_slice(reader, n, dimensions, slice))
        return refuse_variable(reader, name, is_text, slice);

    for (int d = 0; d < n; d++) {
        start[d] = slice[d].first;
        count[d] = slice[d].n;
    }

    return STATUS_OK;
}

enum status netcdf_read_doubles(const struct netcdf_reader *reader, const char *name, const struct netcdf_slice *slice,
                                double *values) {
    int number;
    size_t start[NETCDF_MAX_DIMENSIONS], count[NETCDF_MAX_DIMENSIONS];
    TRY(find_variable(reader, name, false, slice, &number, start, count));
    const int code = nc_get_vara_double(reader->file, number, start, count, values);
    return code == NC_NOERR ? STATUS_OK : cannot_read(reader->path, code);
}

enum status netcdf_read_text(const struct netcdf_reader *reader, const char *name, const struct netcdf_slice *slice,
                             char *values) {
    int number;
    size_t start[NETCDF_MAX_DIMENSIONS], count[NETCDF_MAX_DIMENSIONS];
    TRY(find_variable(reader, name, true, slice, &number, start, count));
    const int code = nc_get_vara_text(reader->file, number, start, count, values);
    return code == NC_NOERR ? STATUS_OK : cannot_read(reader->path, code);
}
