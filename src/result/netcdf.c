/* netcdf.c: writing files. */
#include "result/netcdf.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <netcdf.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "base/version.h"
#include "result/target.h"

enum {
    SPARE_BYTES = 4096,     /* kept at the end of the header for attributes that other programs add later */
    BUFFER_BYTES = 1 << 14, /* buffer of NetCDF for writing */
    HISTORY_LENGTH = 4096   /* bytes of a longer command line are cut */
};

/* Do a call of the library unless one has failed before. */
#define CALL(writer, call)                                       \
    do {                                                         \
        if ((writer)->code == NC_NOERR) (writer)->code = (call); \
    } while (0)

static double seconds_now(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

const char *netcdf_reason(int code) {
    return nc_strerror(code);
}

// ---- places and failures

char *netcdf_local_path(const char *path) {
    const size_t size = strlen(path) + sizeof "./";
    char *const local = calloc(size, 1);
    if (local) snprintf(local, size, "%s%s", path[0] == '/' ? "" : "./", path);
    return local;
}

bool netcdf_has_memory(void) {
    // the first call of NetCDF takes 2.2 MB
    void *volatile const needed = malloc((size_t)4 << 20);
    free(needed);
    return needed != NULL;
}

static enum status failed(const char *path, int code) {
    return target_failed(path, code == NC_ENOMEM ? ENOMEM : code, nc_strerror(code));
}

// ---- definitions

/* Write the attributes on the origin of the file. */
static void write_origin(struct netcdf_writer *writer, const char *title, const char *command) {
    char libraries[VERSION_LENGTH], source[2 * VERSION_LENGTH], history[HISTORY_LENGTH], date[32];
    version_libraries(libraries);
    snprintf(source, sizeof source, "%s, %s", version_short(), libraries);
    const time_t now = time(NULL);
    struct tm utc;
    strftime(date, sizeof date, "%Y-%m-%dT%H:%M:%SZ", gmtime_r(&now, &utc));
    snprintf(history, sizeof history, "%s %s", date, command);
    netcdf_write_string(writer, NETCDF_GLOBAL, "Conventions", "CF-1.10");
    netcdf_write_string(writer, NETCDF_GLOBAL, "title", title);
    netcdf_write_string(writer, NETCDF_GLOBAL, "history", history);
    netcdf_write_string(writer, NETCDF_GLOBAL, "source", source);
}

// whether all went well; a writer that is not open is closed
static enum status opened(struct netcdf_writer *writer, const char *path) {
    const int code = writer->code;
    if (code == NC_NOERR) return STATUS_OK;
    netcdf_finish(writer);
    return failed(path, code);
}

/* Initialise a writer without a file; returns the path for NetCDF, which the caller frees, or NULL if out of memory. */
static char *writer_begin(struct netcdf_writer *writer, const char *path) {
    *writer = (struct netcdf_writer){.path = path, .part.descriptor = -1, .file = -1, .last_fsync = -INFINITY};
    char *const local = netcdf_has_memory() ? netcdf_local_path(path) : NULL;
    if (!local) writer->code = ENOMEM;
    return local;
}

static void keep_path(struct netcdf_writer *writer) {
    if (writer->code == NC_NOERR) writer->path = writer->part.target + (writer->path[0] == '/' ? 0 : strlen("./"));
}

enum status netcdf_create(struct netcdf_writer *writer, const char *path, const char *title, const char *command) {
    char *const local = writer_begin(writer, path);
    if (local) durable_sweep(local);
    CALL(writer, durable_begin(&writer->part, local, 0666));
    free(local);
    keep_path(writer);
    size_t buffer_bytes = BUFFER_BYTES;
    CALL(writer, nc__create(writer->part.name, NC_CLOBBER | NC_64BIT_DATA, 0, &buffer_bytes, &writer->file));
    write_origin(writer, title, command);
    return opened(writer, path);
}

enum status netcdf_continue(struct netcdf_writer *writer, const char *path) {
    writer->part.target = writer_begin(writer, path);
    if (writer->part.target) durable_sweep(writer->part.target);
    keep_path(writer);
    size_t buffer_bytes = BUFFER_BYTES;
    CALL(writer, nc__open(writer->part.target, NC_WRITE, &buffer_bytes, &writer->file));
    CALL(writer, nc_set_fill(writer->file, NC_NOFILL, NULL));
    if (writer->code == NC_NOERR) writer->part.descriptor = open(writer->part.target, O_RDONLY | O_CLOEXEC);
    if (writer->code == NC_NOERR && writer->part.descriptor < 0) writer->code = errno;
    return opened(writer, path);
}

enum status netcdf_patch(const char *path, const char *name, size_t n, const char *bytes) {
    struct netcdf_writer writer;
    TRY(netcdf_continue(&writer, path));
    netcdf_write_bytes(&writer, NETCDF_GLOBAL, name, n, bytes);

    // nc_close would extend the file to the number of rows in the header
    const int closed = nc_abort(writer.file);
    writer.file = -1;
    CALL(&writer, closed);
    CALL(&writer, durable_sync(writer.part.descriptor));
    return netcdf_finish(&writer);
}

int netcdf_define_dimension(struct netcdf_writer *writer, const char *name, size_t length) {
    int number = 0;
    CALL(writer, nc_def_dim(writer->file, name, length > 0 ? length : NC_UNLIMITED, &number));
    return number;
}

int netcdf_define_variable(struct netcdf_writer *writer, const struct netcdf_variable *variable) {
    static const nc_type types[] = {[NETCDF_TEXT] = NC_CHAR,
                                    [NETCDF_INT] = NC_INT,
                                    [NETCDF_INT64] = NC_INT64,
                                    [NETCDF_FLOAT] = NC_FLOAT,
                                    [NETCDF_DOUBLE] = NC_DOUBLE};
    const nc_type type = types[variable->type];
    int number = 0;
    CALL(writer, nc_def_var(writer->file, variable->name, type, variable->n_dimensions, variable->dimension, &number));
    netcdf_write_string(writer, number, "long_name", variable->long_name);

    if (type == NC_CHAR) {
        netcdf_write_string(writer, number, "_Encoding", "utf-8");
        return number;
    }

    netcdf_write_string(writer, number, "units", *variable->units ? variable->units : "1");
    const double gap = NAN;
    if (variable->has_gaps) CALL(writer, nc_put_att_double(writer->file, number, "_FillValue", type, 1, &gap));
    return number;
}

void netcdf_write_bytes(struct netcdf_writer *writer, int variable, const char *name, size_t n, const char *bytes) {
    CALL(writer, nc_put_att_text(writer->file, variable, name, n, bytes));
}

void netcdf_write_string(struct netcdf_writer *writer, int variable, const char *name, const char *string) {
    netcdf_write_bytes(writer, variable, name, strlen(string), string);
}

void netcdf_write_integer(struct netcdf_writer *writer, int variable, const char *name, int value) {
    CALL(writer, nc_put_att_int(writer->file, variable, name, NC_INT, 1, &value));
}

void netcdf_end_definitions(struct netcdf_writer *writer) {
    // disable fill values: every value is written, so NetCDF would write each row twice
    CALL(writer, nc_set_fill(writer->file, NC_NOFILL, NULL));
    CALL(writer, nc__enddef(writer->file, SPARE_BYTES, sizeof(double), 0, sizeof(double)));
}

// ---- values

int netcdf_number(struct netcdf_writer *writer, const char *name) {
    int number = -1;
    CALL(writer, nc_inq_varid(writer->file, name, &number));
    return number;
}

void netcdf_write_doubles(struct netcdf_writer *writer, int variable, const size_t *start, const size_t *count,
                          const double *values) {
    CALL(writer, count ? nc_put_vara_double(writer->file, variable, start, count, values)
                       : nc_put_var_double(writer->file, variable, values));
}

void netcdf_write_ints(struct netcdf_writer *writer, int variable, const size_t *start, const size_t *count,
                       const int *values) {
    CALL(writer, count ? nc_put_vara_int(writer->file, variable, start, count, values)
                       : nc_put_var_int(writer->file, variable, values));
}

void netcdf_write_longs(struct netcdf_writer *writer, int variable, const size_t *start, const size_t *count,
                        const long *values) {
    CALL(writer, count ? nc_put_vara_long(writer->file, variable, start, count, values)
                       : nc_put_var_long(writer->file, variable, values));
}

void netcdf_write_text(struct netcdf_writer *writer, int variable, const size_t *start, const size_t *count,
                       const char *values) {
    CALL(writer, count ? nc_put_vara_text(writer->file, variable, start, count, values)
                       : nc_put_var_text(writer->file, variable, values));
}

// ---- on disk

void netcdf_sync(struct netcdf_writer *writer, bool now) {
    CALL(writer, nc_sync(writer->file));
    if (!now && seconds_now() - writer->last_fsync < 1) return;
    CALL(writer, durable_sync(writer->part.descriptor));
    writer->last_fsync = seconds_now();
}

enum status netcdf_publish(struct netcdf_writer *writer, bool overwrite) {
    CALL(writer, nc_sync(writer->file));
    if (writer->code == NC_NOERR) TRY(target_check(writer->path, TARGET_NETCDF, overwrite));
    CALL(writer, durable_publish(&writer->part, overwrite));
    writer->last_fsync = seconds_now();
    return writer->code == NC_NOERR ? STATUS_OK : failed(writer->path, writer->code);
}

void netcdf_reopen(struct netcdf_writer *writer) {
    // nc_close and nc_abort write: the old number stays open until the program ends
    writer->file = -1;
    writer->code = NC_NOERR;
    CALL(writer, nc_open(writer->part.target, NC_WRITE, &writer->file));
}

enum status netcdf_finish(struct netcdf_writer *writer) {
    const int closed = writer->file >= 0 ? nc_close(writer->file) : NC_NOERR;
    CALL(writer, closed);
    enum status status = STATUS_OK;

    if (!writer->part.name && writer->code != NC_NOERR) {
        status = status_fail(STATUS_FILE, "%s: cannot be closed (%s): the end may be missing", writer->path,
                             nc_strerror(writer->code));
    }

    durable_end(&writer->part);
    *writer = (struct netcdf_writer){.part.descriptor = -1, .file = -1};
    return status;
}

void netcdf_abandon(struct netcdf_writer *writer) {
    // nc_close and nc_abort write: the number stays open until the process ends
    free(writer->part.name);
    writer->part.name = NULL;
    durable_end(&writer->part);
    *writer = (struct netcdf_writer){.part.descriptor = -1, .file = -1};
}
