/* result_file.c: writing the result file. What is in it stands in result_table.c; how to read its status in result_info.c. */
#include "output/result_file.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "output/netcdf.h"
#include "output/result_table.h"

enum {
    STATUS_LENGTH = 256,   /* bytes kept for run_status: rewritten in place, it must never move what follows */
    SPARE_BYTES = 4096,    /* kept at the end of the header for attributes that other programs add later */
    BUFFER_BYTES = 1 << 14 /* what NetCDF collects before it writes */
};

struct result_file {
    char *path;
    int file;       /* NetCDF's number of the open file; -1: none */
    int descriptor; /* of the same file, for fsync; -1: none */
    bool is_broken; /* a write failed: what NetCDF still holds cannot be written */

    size_t length[RESULT_N_DIMENSIONS]; /* of the dimensions; 1 for TIME, as one row is written at a time */
    int *number;                        /* NetCDF's numbers of the variables           (result_table_n) */
    size_t n_rows;
    double last_fsync; /* s on the monotonic clock */
    double *buffer;    /* one row, or the whole, of the largest variable */
};

static double seconds_now(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

// ---- the header ----

/* The length of each dimension for this school. */
static void diagnostics_dimensions(struct result_file *store, const struct school *school, long n_events) {
    for (int d = 0; d < RESULT_N_DIMENSIONS; d++) store->length[d] = 1;
    store->length[FISH] = (size_t)school->n_fish;
    store->length[VORTEX] = (size_t)wake_most(school, n_events);
    store->length[XY] = 2;
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *fish = &school->fish[f];
        for (enum result_dimension d = NODE; d <= SHEET; d++) {
            const size_t length = (size_t)result_table_length(fish, d);
            if (length > store->length[d]) store->length[d] = length;
        }
        const size_t n_name = strlen(fish->name);
        if (n_name > store->length[NAME]) store->length[NAME] = n_name;
    }
}

/* The number of values of a variable, or of one row of it; of one fish where it has that dimension and per_fish. */
static size_t n_values(const struct result_file *store, const struct result_variable *variable, bool per_fish) {
    size_t n = 1;
    for (const enum result_dimension *d = variable->dimension; *d != NONE; d++)
        if (*d != FISH || !per_fish) n *= store->length[*d];
    return n;
}

static nc_type type_in_file(enum result_type type, enum precision precision) {
    switch (type) {
        case RESULT_BULK: return precision == PRECISION_SINGLE ? NC_FLOAT : NC_DOUBLE;
        case RESULT_INTEGER: return NC_INT;
        case RESULT_COUNT: return NC_INT64;
        case RESULT_TEXT: return NC_CHAR;
        default: return NC_DOUBLE;
    }
}

/* The attribute run_status, in the space that is kept for it; a longer text is cut. */
static int write_run_status(int file, const char *run_status) {
    char text[STATUS_LENGTH] = {0};
    snprintf(text, sizeof text, "%s", run_status);
    return nc_put_att_text(file, NC_GLOBAL, "run_status", sizeof text, text);
}

/* One variable with its attributes; units, long_name, and those that tell readers what fills unused slots and which
 * variables are coordinates. */
static int define_variable(struct result_file *store, int i, const int *dimension_number, enum precision precision) {
    const struct result_variable *variable = &result_table[i];
    int n = 0, dimensions[RESULT_MOST_DIMENSIONS];
    for (; variable->dimension[n] != NONE; n++) dimensions[n] = dimension_number[variable->dimension[n]];
    const nc_type type = type_in_file(variable->type, precision);
    NETCDF(nc_def_var(store->file, variable->name, type, n, dimensions, &store->number[i]));

    const int number = store->number[i];
    NETCDF(netcdf_text(store->file, number, "long_name", variable->long_name));
    if (variable->type == RESULT_TEXT) return netcdf_text(store->file, number, "_Encoding", "utf-8");
    NETCDF(netcdf_text(store->file, number, "units", variable->unit));
    if (!result_table_has(variable, FISH)) return NC_NOERR;

    const double fill = NAN;
    if (type == NC_DOUBLE || type == NC_FLOAT)
        NETCDF(nc_put_att_double(store->file, number, _FillValue, type, 1, &fill));
    const char *coordinates = "fish_name";
    if (result_table_has(variable, NODE) && strcmp(variable->name, "node_arc") != 0) coordinates = "fish_name node_arc";
    if (result_table_has(variable, SHEET) && strcmp(variable->name, "sheet_arc") != 0)
        coordinates = "fish_name sheet_arc";
    return netcdf_text(store->file, number, "coordinates", coordinates);
}

/* The global attributes; the texts of the case make a result file repeatable. */
static int define_attributes(int file, const struct case_values *values, const char *effective, const char *command) {
    const int schema = RESULT_SCHEMA;
    NETCDF(netcdf_origin(file, values->name, command));
    NETCDF(nc_put_att_int(file, NC_GLOBAL, "shoal_schema", NC_INT, 1, &schema));
    NETCDF(write_run_status(file, "running"));
    NETCDF(netcdf_text(file, NC_GLOBAL, "case_text", values->text));
    if (values->study) {
        NETCDF(netcdf_text(file, NC_GLOBAL, "study_case", values->study));
        NETCDF(nc_put_att_int(file, NC_GLOBAL, "study_member", NC_INT, 1, &values->member));
    }
    return netcdf_text(file, NC_GLOBAL, "case_effective", effective);
}

static int define_all(struct result_file *store, const struct case_values *values, const char *effective,
                      const char *command) {
    int dimension_number[RESULT_N_DIMENSIONS] = {0};
    for (enum result_dimension d = TIME; d < RESULT_N_DIMENSIONS; d++)
        NETCDF(nc_def_dim(store->file, result_table_dimension(d), d == TIME ? NC_UNLIMITED : store->length[d],
                          &dimension_number[d]));
    for (int i = 0; i < result_table_n; i++)
        NETCDF(define_variable(store, i, dimension_number, values->output.precision));
    NETCDF(define_attributes(store->file, values, effective, command));

    // every value is written by us, fill values too: NetCDF would write each row twice
    NETCDF(nc_set_fill(store->file, NC_NOFILL, NULL));
    return nc__enddef(store->file, SPARE_BYTES, sizeof(double), 0, sizeof(double));
}

// ---- values ----

static size_t size_in_memory(enum result_type type) {
    switch (type) {
        case RESULT_INTEGER: return sizeof(int);
        case RESULT_COUNT: return sizeof(long);
        case RESULT_TEXT: return sizeof(char);
        default: return sizeof(double);
    }
}

/* Put the value of school or fish f at its place in the buffer. */
static void fill_slots(const struct result_file *store, const struct result_variable *variable,
                       const struct result_row *row, int f) {
    const size_t n_slots = n_values(store, variable, true), size = size_in_memory(variable->type);
    char *slots = (char *)store->buffer + (size_t)f * n_slots * size;
    if (variable->gather) {
        variable->gather(row, f, (double *)(void *)slots);
        return;
    }
    const char *value = (const char *)result_table_owner(row, variable->owner, f) + variable->offset;
    size_t n = n_slots;
    if (variable->is_pointer) {
        memcpy(&value, value, sizeof value);
        const enum result_dimension last = variable->dimension[1];
        n = last == NAME ? strlen(value) : (size_t)result_table_length(&row->school->fish[f], last);
    }
    memcpy(slots, value, n * size);
}

/* Write the whole of a constant, or the next row of a variable with time. */
static int write_variable(const struct result_file *store, int i, const struct result_row *row) {
    const struct result_variable *variable = &result_table[i];
    if (variable->type == RESULT_TEXT)
        memset(store->buffer, 0, n_values(store, variable, false));
    else if (size_in_memory(variable->type) == sizeof(double))
        for (size_t k = 0; k < n_values(store, variable, false); k++) store->buffer[k] = NAN;
    const int n_owners = result_table_has(variable, FISH) ? row->school->n_fish : 1;
    for (int f = 0; f < n_owners; f++) fill_slots(store, variable, row, f);

    size_t start[RESULT_MOST_DIMENSIONS] = {0}, count[RESULT_MOST_DIMENSIONS];
    for (int d = 0; variable->dimension[d] != NONE; d++) count[d] = store->length[variable->dimension[d]];
    if (result_table_has(variable, TIME)) start[0] = store->n_rows;
    const void *values = store->buffer;
    switch (variable->type) {
        case RESULT_INTEGER: return nc_put_vara_int(store->file, store->number[i], start, count, values);
        case RESULT_COUNT: return nc_put_vara_long(store->file, store->number[i], start, count, values);
        case RESULT_TEXT: return nc_put_vara_text(store->file, store->number[i], start, count, values);
        default: return nc_put_vara_double(store->file, store->number[i], start, count, values);
    }
}

/* Write all constants, or all of a row. */
static int write_variables(const struct result_file *store, bool with_time, const struct result_row *row) {
    for (int i = 0; i < result_table_n; i++)
        if (result_table_has(&result_table[i], TIME) == with_time) NETCDF(write_variable(store, i, row));
    return NC_NOERR;
}

/* Show everything to readers, and once a second make it survive a power cut. NetCDF writes the number of rows after the
 * rows themselves, so that neither a reader nor a full disk ever leaves a part of a row. */
static int synchronise(struct result_file *store) {
    NETCDF(nc_sync(store->file));
    if (seconds_now() - store->last_fsync < 1) return NC_NOERR;
    if (fsync(store->descriptor) != 0) return errno;
    store->last_fsync = seconds_now();
    return NC_NOERR;
}

// ---- names and failures ----

/* What can be wrong with the place of a file, and what to do about it. */
static enum status creation_failed(const char *path, int code) {
    const char *slash = strrchr(path, '/');
    const int n_folder = slash ? (int)(slash - path) : 1;
    const char *folder = slash ? path : ".";
    switch (code) {
        case ENOENT:
        case ENOTDIR:
            return status_fail(STATUS_FILE, "%s: there is no folder %.*s: make it, or choose another name with -o",
                               path, n_folder, folder);
        case EACCES:
        case EPERM:
        case EROFS:
            return status_fail(STATUS_FILE, "%s: the folder cannot be written to (%s): choose another name with -o",
                               path, strerror(code));
        case NC_ENOMEM:
        case ENOMEM: return status_fail(STATUS_MEMORY, "%s: out of memory while writing", path);
        default:
            return status_fail(STATUS_FILE, "%s: cannot be written (%s): choose another place with -o", path,
                               nc_strerror(code));
    }
}

static enum status refuse_existing(const char *path) {
    return status_fail(STATUS_FILE, "%s exists: choose another name with -o or allow replacing it with --force", path);
}

/* Refuse a name that stands for something else than a result file that may be made or replaced. */
static enum status check_target(const char *path, int overwrite) {
    struct stat target;
    if (path[0] == '\0') return status_fail(STATUS_FILE, "the name of the result file is empty: choose one with -o");
    if (stat(path, &target) != 0) return STATUS_OK;
    if (S_ISDIR(target.st_mode))
        return status_fail(STATUS_FILE, "%s is a folder: name a file with -o, as in -o %s/run.nc", path, path);
    if (!S_ISREG(target.st_mode))
        return status_fail(STATUS_FILE, "%s is not an ordinary file: choose another name with -o", path);
    return overwrite ? STATUS_OK : refuse_existing(path);
}

/* Give the finished header its own name. A link, unlike a renaming, refuses to replace what another run has made in the
 * meantime; a file system without links has to do with the renaming. */
static enum status publish(const char *temporary, const char *path, int overwrite) {
    if (!overwrite && link(temporary, path) == 0) {
        unlink(temporary);
        return STATUS_OK;
    }
    if (!overwrite && errno == EEXIST) return refuse_existing(path);
    return rename(temporary, path) == 0 ? STATUS_OK : creation_failed(path, errno);
}

static enum status write_failed(const struct result_file *store, double t, int code) {
    return status_fail(STATUS_FILE,
                       "%s: cannot be written at t = %g s (%s): make room or choose another place with -o; what was "
                       "written before stays",
                       store->path, t, nc_strerror(code));
}

// ---- the life of a store ----

static void release(struct result_file *store) {
    if (store == NULL) return;
    if (store->file >= 0) nc_close(store->file);
    if (store->descriptor >= 0) close(store->descriptor);
    free(store->path);
    free(store->number);
    free(store->buffer);
    free(store);
}

/* A store without a file yet. */
static struct result_file *allocate(const char *path, const struct school *school, long n_events) {
    struct result_file *store = calloc(1, sizeof *store);
    if (store == NULL) return NULL;
    store->file = store->descriptor = -1;
    store->last_fsync = -INFINITY;
    diagnostics_dimensions(store, school, n_events);
    size_t most = 1;
    for (int i = 0; i < result_table_n; i++) {
        const size_t n = n_values(store, &result_table[i], false);
        if (n > most) most = n;
    }
    store->path = calloc(strlen(path) + 1, 1);
    store->number = calloc((size_t)result_table_n, sizeof *store->number);
    store->buffer = calloc(most, sizeof *store->buffer);
    if (store->path && store->number && store->buffer) {
        strcpy(store->path, path);
        return store;
    }
    release(store);
    return NULL;
}

/* Create the file under the temporary name: header and constants. */
static int write_header(struct result_file *store, const char *temporary, const struct case_values *values,
                        const char *effective, const char *command, const struct school *school) {
    size_t buffer_bytes = BUFFER_BYTES;
    NETCDF(nc__create(temporary, NC_CLOBBER | NC_64BIT_DATA, 0, &buffer_bytes, &store->file));
    NETCDF(define_all(store, values, effective, command));
    NETCDF(write_variables(store, false, &(struct result_row){.school = school}));
    store->descriptor = open(temporary, O_RDONLY | O_CLOEXEC);
    if (store->descriptor < 0) return errno;
    return synchronise(store);
}

enum status result_file_create(struct result_file **store, const char *path, int overwrite,
                               const struct case_values *values, const char *effective, const char *command,
                               const struct school *school, long n_events) {
    *store = NULL;
    TRY(check_target(path, overwrite));

    // "./" keeps NetCDF from taking the name for an address or dropping blanks that it begins with
    enum { MORE = 32 };
    const size_t size = strlen(path) + MORE;
    char *temporary = calloc(size, 1);
    struct result_file *made = allocate(path, school, n_events);
    if (temporary == NULL || made == NULL) {
        free(temporary);
        release(made);
        return status_fail(STATUS_MEMORY, "%s: out of memory while writing", path);
    }
    snprintf(temporary, size, "%s%s.%ld.part", path[0] == '/' ? "" : "./", path, (long)getpid());

    enum status status = STATUS_OK;
    const int code = write_header(made, temporary, values, effective, command, school);
    if (code != NC_NOERR) status = creation_failed(path, code);
    if (status == STATUS_OK) status = publish(temporary, path, overwrite);
    if (status == STATUS_OK) {
        *store = made;
    } else {
        release(made);
        unlink(temporary);
    }
    free(temporary);
    return status;
}

enum status result_file_row(struct result_file *store, const struct state *state, const struct residual *residual,
                            const struct diagnostics *diagnostics, const struct result_counts *counts, int with_wake) {
    const struct result_row row = {residual->school, state, residual, diagnostics, counts, with_wake != 0};
    for (int f = 0; f < row.school->n_fish; f++)
        if ((size_t)state->wake[f].n_vortex > store->length[VORTEX])
            return status_fail(STATUS_FILE, "%s: %d vortices of %s at t = %g s, but the file has room for %zu",
                               store->path, state->wake[f].n_vortex, row.school->fish[f].name, state->t,
                               store->length[VORTEX]);

    int code = write_variables(store, true, &row);
    if (code == NC_NOERR) {
        store->n_rows++;
        code = synchronise(store);
    }
    if (code == NC_NOERR) return STATUS_OK;
    store->is_broken = true;
    return write_failed(store, state->t, code);
}

/* A file on a full disk can still be closed properly: its header has its place already and counts whole rows only. */
static int close_broken(struct result_file *store, const char *run_status) {
    if (store->file >= 0) nc_close(store->file);
    store->file = -1;
    int file;
    NETCDF(nc_open(store->path, NC_WRITE, &file));
    const int code = write_run_status(file, run_status);
    const int close_code = nc_close(file);
    return code != NC_NOERR ? code : close_code;
}

static int close_whole(struct result_file *store, const char *run_status) {
    NETCDF(write_run_status(store->file, run_status));
    store->last_fsync = -INFINITY;
    NETCDF(synchronise(store));
    const int file = store->file;
    store->file = -1;
    return nc_close(file);
}

enum status result_file_close(struct result_file *store, const char *run_status) {
    if (store == NULL) return STATUS_OK;
    const int code = store->is_broken ? close_broken(store, run_status) : close_whole(store, run_status);
    if (code != NC_NOERR && !store->is_broken) close_broken(store, "failed: the last rows could not be written");
    enum status status = STATUS_OK;
    if (code != NC_NOERR)
        status = status_fail(STATUS_FILE, "%s: cannot be closed (%s): its last rows may be missing", store->path,
                             nc_strerror(code));
    release(store);
    return status;
}
