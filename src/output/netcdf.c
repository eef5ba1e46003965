/* netcdf.c: writing files. */
#include "output/netcdf.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <math.h>
#include <netcdf.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "base/version.h"
#include "output/durable.h"

enum {
    SPARE_BYTES = 4096,     /* kept at the end of the header for attributes that other programs add later */
    BUFFER_BYTES = 1 << 14, /* what NetCDF collects before it writes */
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

char *netcdf_local_path(const char *path, size_t more) {
    const size_t size = strlen(path) + more + 3;
    char *const local = calloc(size, 1);
    if (local) snprintf(local, size, "%s%s", path[0] == '/' ? "" : "./", path);
    return local;
}

bool netcdf_has_memory(void) {
    // its first call takes 2.2 MB
    void *volatile const needed = malloc((size_t)4 << 20);
    free(needed);
    return needed != NULL;
}

/* What can be wrong with the place of a file, and what to do about it. */
static enum status creation_failed(const char *path, int code) {
    char folder[PATH_MAX];
    durable_folder_of(path, folder);
    switch (code) {
        case ENOENT:
        case ENOTDIR:
            if (access(folder, F_OK) == 0) {
                return status_fail(STATUS_FILE, "%s: the folder %s takes no new files: choose another place with -o",
                                   path, folder);
            }
            return status_fail(STATUS_FILE, "%s: there is no folder %s: make it, or choose another name with -o", path,
                               folder);
        case EACCES:
        case EPERM:
        case EROFS:
            return status_fail(STATUS_FILE, "%s: the folder cannot be written to (%s): choose another name with -o",
                               path, strerror(code));
        case NC_ENOMEM:
        case ENOMEM: return status_fail(STATUS_MEMORY, "%s: out of memory while writing", path);
        default:
            return status_fail(STATUS_FILE, "%s: cannot be written (%s): make room or choose another place with -o",
                               path, nc_strerror(code));
    }
}

static enum status refuse_existing(const char *path) {
    return status_fail(STATUS_FILE, "%s exists: choose another name with -o or allow replacing it with --force", path);
}

enum status netcdf_check_target(const char *path, bool overwrite) {
    struct stat target;
    if (path[0] == '\0') return status_fail(STATUS_FILE, "the name of the result file is empty: choose one with -o");
    if (lstat(path, &target) != 0) {
        char folder[PATH_MAX];
        durable_folder_of(path, folder);
        return access(folder, W_OK | X_OK) == 0 ? STATUS_OK : creation_failed(path, errno);
    }
    if (S_ISDIR(target.st_mode))
        return status_fail(STATUS_FILE, "%s is a folder: name a file with -o, as in -o %s/run.nc", path, path);
    if (S_ISLNK(target.st_mode))
        return status_fail(STATUS_FILE, "%s is a link: name the file that it points to, or another one, with -o", path);
    if (!S_ISREG(target.st_mode))
        return status_fail(STATUS_FILE, "%s is not an ordinary file: choose another name with -o", path);
    return overwrite ? STATUS_OK : refuse_existing(path);
}

// ---- definitions

/* Where the file comes from. */
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

// the file under this name, which has just been opened, also as what can be synchronised
static void take_descriptor(struct netcdf_writer *writer, const char *name) {
    if (writer->code != NC_NOERR) return;
    writer->descriptor = open(name, O_RDONLY | O_CLOEXEC);
    if (writer->descriptor < 0) writer->code = errno;
}

// whether all went well; a writer that is not open is closed
static enum status opened(struct netcdf_writer *writer, const char *path) {
    if (writer->code == NC_NOERR) return STATUS_OK;
    const enum status status = creation_failed(path, writer->code);
    netcdf_finish(writer);
    return status;
}

enum status netcdf_create(struct netcdf_writer *writer, const char *path, const char *title, const char *command) {
    enum { ENDING = 32 };
    *writer = (struct netcdf_writer){.file = -1, .descriptor = -1, .last_fsync = -INFINITY};
    writer->target = netcdf_local_path(path, 0);
    writer->temporary = netcdf_local_path(path, ENDING);
    if (writer->target && writer->temporary && netcdf_has_memory()) {
        writer->path = writer->target + (path[0] == '/' ? 0 : strlen("./"));
        snprintf(writer->temporary + strlen(writer->temporary), ENDING, ".%ld.part", (long)getpid());
        // what is there was left by a run that was killed, or is a link; a new file is never written through one
        unlink(writer->temporary);
        size_t buffer_bytes = BUFFER_BYTES;
        CALL(writer, nc__create(writer->temporary, NC_NOCLOBBER | NC_64BIT_DATA, 0, &buffer_bytes, &writer->file));
        take_descriptor(writer, writer->temporary);
        write_origin(writer, title, command);
    } else {
        writer->code = ENOMEM;
    }
    return opened(writer, path);
}

enum status netcdf_continue(struct netcdf_writer *writer, const char *path) {
    *writer = (struct netcdf_writer){.file = -1, .descriptor = -1, .last_fsync = -INFINITY};
    writer->target = netcdf_local_path(path, 0);
    if (writer->target) {
        writer->path = writer->target + (path[0] == '/' ? 0 : strlen("./"));
        size_t buffer_bytes = BUFFER_BYTES;
        CALL(writer, nc__open(writer->target, NC_WRITE, &buffer_bytes, &writer->file));
        CALL(writer, nc_set_fill(writer->file, NC_NOFILL, NULL));
        take_descriptor(writer, writer->target);
    } else {
        writer->code = ENOMEM;
    }
    return opened(writer, path);
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
    // every value is written by us: NetCDF would fill each row first, and so write it twice
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
    CALL(writer, durable_sync(writer->descriptor));
    writer->last_fsync = seconds_now();
}

/* Give the file its name; errno or 0. A link, unlike a renaming, refuses to replace what another run has made in the
 * meantime; a file system without links has to do with the renaming. */
static int give_name(const struct netcdf_writer *writer, bool overwrite) {
    if (!overwrite) {
        if (link(writer->temporary, writer->target) == 0) return unlink(writer->temporary) == 0 ? NC_NOERR : errno;
        if (errno == EEXIST) return EEXIST;
    }
    return rename(writer->temporary, writer->target) == 0 ? NC_NOERR : errno;
}

enum status netcdf_publish(struct netcdf_writer *writer, bool overwrite) {
    netcdf_sync(writer, true);
    CALL(writer, give_name(writer, overwrite));
    if (writer->code == EEXIST && !overwrite) return refuse_existing(writer->path);
    if (writer->code != NC_NOERR) return creation_failed(writer->path, writer->code);
    free(writer->temporary);
    writer->temporary = NULL;
    CALL(writer, durable_sync_folder(writer->path));
    return writer->code == NC_NOERR ? STATUS_OK : creation_failed(writer->path, writer->code);
}

void netcdf_reopen(struct netcdf_writer *writer) {
    // nc_close and nc_abort write: the old number stays open until the program ends
    writer->file = -1;
    writer->code = NC_NOERR;
    CALL(writer, nc_open(writer->target, NC_WRITE, &writer->file));
}

enum status netcdf_finish(struct netcdf_writer *writer) {
    const int closed = writer->file >= 0 ? nc_close(writer->file) : NC_NOERR;
    CALL(writer, closed);
    if (writer->descriptor >= 0) close(writer->descriptor);
    enum status status = STATUS_OK;
    if (writer->temporary) {
        unlink(writer->temporary);
    } else if (writer->code != NC_NOERR) {
        status = status_fail(STATUS_FILE, "%s: cannot be closed (%s): its end may be missing", writer->path,
                             nc_strerror(writer->code));
    }
    free(writer->temporary);
    free(writer->target);
    *writer = (struct netcdf_writer){.file = -1, .descriptor = -1};
    return status;
}
