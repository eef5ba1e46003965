/* netcdf.c: writes and reads files, and checks their headers. */
#include "result/netcdf.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <math.h>
#include <netcdf.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "base/parallel.h"
#include "base/version.h"
#include "result/durable.h"
#include "result/target.h"

enum {
    SPARE_BYTES = 4096,    /* kept at the end of the header for attributes that other programs add later */
    BUFFER_BYTES = 1 << 14 /* buffer of NetCDF for writing */
};

/* Do a call of the library unless one has failed before. */
#define CALL(writer, call)                                       \
    do {                                                         \
        if ((writer)->code == NC_NOERR) (writer)->code = (call); \
    } while (0)

// ---- places and failures

const char *netcdf_reason(int code) {
    return nc_strerror(code);
}

/* Find the path for NetCDF: without "./" in front, NetCDF would take some names for addresses and drop leading blanks.
 * 0 or ENAMETOOLONG. */
static int netcdf_local_path(const char *path, char local[PATH_MAX]) {
    return snprintf(local, PATH_MAX, "%s%s", path[0] == '/' ? "" : "./", path) < PATH_MAX ? 0 : ENAMETOOLONG;
}

/* True if the memory that NetCDF can need to create or open a file is available: NetCDF crashes if out of memory. */
static bool netcdf_has_memory(void) {
    // the first call of NetCDF takes 2.2 MB
    void *volatile const needed = malloc((size_t)4 << 20);
    free(needed);
    return needed != NULL;
}

// ---- definitions

/* Whether all went well; a writer that is not open is closed. The path of the writer is now a part of the writer. */
static enum status opened(struct netcdf_writer *writer, const char *path) {
    const int code = writer->code;
    writer->path = writer->part.target + (path[0] == '/' ? 0 : strlen("./"));
    if (code == NC_NOERR) return STATUS_OK;
    netcdf_finish(writer);
    return target_failed(path, code == NC_ENOMEM ? ENOMEM : code, nc_strerror(code));
}

enum status netcdf_create(struct netcdf_writer *writer, const char *path, const char *title, const char *command) {
    char local[PATH_MAX], libraries[VERSION_LENGTH], source[2 * VERSION_LENGTH], date[32];
    size_t buffer_bytes = BUFFER_BYTES;
    *writer = (struct netcdf_writer){.path = path, .part.descriptor = -1, .file = -1, .last_fsync = -INFINITY};
    if (!netcdf_has_memory()) writer->code = ENOMEM;
    CALL(writer, netcdf_local_path(path, local));
    CALL(writer, durable_begin(&writer->part, local, 0666));
    CALL(writer, nc__create(writer->part.name, NC_CLOBBER | NC_64BIT_DATA, 0, &buffer_bytes, &writer->file));

    // the origin of the file
    version_libraries(libraries);
    snprintf(source, sizeof source, "%s, %s", version_short(), libraries);
    const time_t now = time(NULL);
    struct tm utc;
    strftime(date, sizeof date, "%Y-%m-%dT%H:%M:%SZ", gmtime_r(&now, &utc));
    // no jump leaves the part of a file behind
    const size_t length = strlen(date) + strlen(command ? command : "") + 2;
    char *const history = malloc(length);
    if (history) snprintf(history, length, "%s%s%s", date, command ? " " : "", command ? command : "");
    if (!history) CALL(writer, ENOMEM);
    netcdf_write_string(writer, NETCDF_GLOBAL, "Conventions", "CF-1.10");
    netcdf_write_string(writer, NETCDF_GLOBAL, "title", title);
    netcdf_write_string(writer, NETCDF_GLOBAL, "history", history ? history : "");
    netcdf_write_string(writer, NETCDF_GLOBAL, "source", source);
    free(history);
    return opened(writer, path);
}

enum status netcdf_continue(struct netcdf_writer *writer, const char *path) {
    size_t buffer_bytes = BUFFER_BYTES;
    *writer = (struct netcdf_writer){.path = path, .part.descriptor = -1, .file = -1, .last_fsync = -INFINITY};
    if (!netcdf_has_memory()) writer->code = ENOMEM;
    CALL(writer, netcdf_local_path(path, writer->part.target));
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

    netcdf_write_string(writer, number, "units", variable->units && *variable->units ? variable->units : "1");
    if (variable->axis) netcdf_write_string(writer, number, "axis", variable->axis);
    if (variable->flags) {
        static const int values[] = {0, 1, 2, 3};
        size_t n = 1;
        for (const char *c = variable->flags; *c; c++) n += *c == ' ';
        CALL(writer, nc_put_att_int(writer->file, number, "flag_values", NC_INT, n, values));
        netcdf_write_string(writer, number, "flag_meanings", variable->flags);
    }
    const double gap = NAN;
    const bool has_gaps = !variable->axis && (type == NC_FLOAT || type == NC_DOUBLE);
    if (has_gaps) CALL(writer, nc_put_att_double(writer->file, number, "_FillValue", type, 1, &gap));
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

void netcdf_write(struct netcdf_writer *writer, int variable, const size_t *start, const size_t *count,
                  const void *values) {
    const int file = writer->file;
    nc_type type = NC_NAT;
    CALL(writer, nc_inq_vartype(file, variable, &type));
    switch (type) {
        case NC_CHAR:
            CALL(writer, count ? nc_put_vara_text(file, variable, start, count, values)
                               : nc_put_var_text(file, variable, values));
            break;
        case NC_INT:
            CALL(writer, count ? nc_put_vara_int(file, variable, start, count, values)
                               : nc_put_var_int(file, variable, values));
            break;
        case NC_INT64:
            CALL(writer, count ? nc_put_vara_long(file, variable, start, count, values)
                               : nc_put_var_long(file, variable, values));
            break;
        default: netcdf_write_doubles(writer, variable, start, count, values);
    }
}

// ---- on disk

void netcdf_sync(struct netcdf_writer *writer, bool now) {
    CALL(writer, nc_sync(writer->file));
    if (!now && clock_seconds(CLOCK_MONOTONIC) - writer->last_fsync < 1) return;
    CALL(writer, durable_sync(writer->part.descriptor));
    writer->last_fsync = clock_seconds(CLOCK_MONOTONIC);
}

enum status netcdf_publish(struct netcdf_writer *writer, bool overwrite) {
    CALL(writer, nc_sync(writer->file));
    if (writer->code == NC_NOERR) TRY(target_check(writer->path, TARGET_NETCDF, overwrite));
    CALL(writer, durable_publish(&writer->part, overwrite));
    writer->last_fsync = clock_seconds(CLOCK_MONOTONIC);
    const int code = writer->code;
    if (code == NC_NOERR) return STATUS_OK;
    return target_failed(writer->path, code == NC_ENOMEM ? ENOMEM : code, nc_strerror(code));
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

    if (writer->part.name[0] == '\0' && writer->code != NC_NOERR) {
        status = status_fail(STATUS_FILE, "%s: cannot be closed (%s): the end may be missing", writer->path,
                             nc_strerror(writer->code));
    }

    durable_end(&writer->part);
    *writer = (struct netcdf_writer){.part.descriptor = -1, .file = -1};
    return status;
}

void netcdf_abandon(struct netcdf_writer *writer) {
    // nc_close and nc_abort write: the number stays open until the process ends
    writer->part.name[0] = '\0';
    durable_end(&writer->part);
    *writer = (struct netcdf_writer){.part.descriptor = -1, .file = -1};
}

// ---- check a file for completeness, and find the rows. NetCDF reads a missing end as zeros, and requests memory for
// the numbers of entries in the header before reading the entries: NetCDF 4.9.0 hung on 20 of 4000 damaged headers; of
// five of these, two crashed and two took more than 4 GB.
//
//     header    = "CDF" version  n_rows  dimensions  attributes  variables
//     list      = tag  n  n entries; both 0: none          tag: DIMENSION, ATTRIBUTE, VARIABLE
//     dimension = name  length                             length 0: grows by rows
//     attribute = name  type  n  n values
//     variable  = name  n  n numbers of dimensions  attributes  type  size  begin
//     name      = n  n bytes
//
// All numbers are big-endian; tags and types have 4 bytes, begin 8 (4 in version 1), others 4 (8 in version 5). Names
// and values are filled up to 4 bytes. A row holds one entry of each variable that grows, one after the other.
// https://docs.unidata.ucar.edu/netcdf-c/current/file_format_specifications.html

enum tag { DIMENSION = 10, VARIABLE = 11, ATTRIBUTE = 12 };
static const uint64_t max_size = (uint64_t)1 << 60; /* of anything, bytes */

struct header {
    FILE *file;
    uint64_t size;   /* of the file */
    bool is_damaged; /* also if the file ends within the header */
    int n_bytes;     /* of most numbers */
};

/* The next number, of n_bytes bytes; after damage, or above most, the header is damaged and the number is 0. */
static uint64_t header_number(struct header *header, int n_bytes, uint64_t most) {
    uint64_t number = 0;
    for (int i = 0; i < n_bytes; i++) {
        const int byte = fgetc(header->file);
        header->is_damaged |= byte == EOF;
        number = number << 8 | (uint64_t)(byte & 0xff);
    }
    header->is_damaged |= number > most;
    return header->is_damaged ? 0 : number;
}

/* Skip as many bytes as the next number tells, at most `most`, times the size of a value, and the padding. */
static void header_skip(struct header *header, uint64_t most, uint64_t size) {
    const uint64_t n = (size * header_number(header, header->n_bytes, most) + 3) / 4 * 4;
    const off_t place = ftello(header->file);
    header->is_damaged |= place < 0 || (uint64_t)place > header->size || n > header->size - (uint64_t)place;
    if (!header->is_damaged) fseeko(header->file, (off_t)n, SEEK_CUR);
}

/* The bytes of a value of the type that follows. */
static uint64_t header_type(struct header *header) {
    static const uint64_t bytes[] = {
        [NC_BYTE] = 1,  [NC_CHAR] = 1,   [NC_SHORT] = 2, [NC_INT] = 4,   [NC_FLOAT] = 4, [NC_DOUBLE] = 8,
        [NC_UBYTE] = 1, [NC_USHORT] = 2, [NC_UINT] = 4,  [NC_INT64] = 8, [NC_UINT64] = 8};
    const uint64_t type = header_number(header, 4, header->n_bytes == 8 ? NC_UINT64 : NC_DOUBLE);
    header->is_damaged |= type == NC_NAT;
    return bytes[type];
}

/* The number of entries of a list. */
static uint64_t header_list(struct header *header, enum tag expected) {
    const uint64_t tag = header_number(header, 4, VARIABLE + ATTRIBUTE);
    const uint64_t n = header_number(header, header->n_bytes, header->size);
    header->is_damaged |= tag != expected && (tag != 0 || n != 0);
    return header->is_damaged ? 0 : n;
}

static void header_skip_attributes(struct header *header) {
    for (uint64_t i = header_list(header, ATTRIBUTE); i > 0 && !header->is_damaged; i--) {
        header_skip(header, NC_MAX_NAME, 1);
        header_skip(header, header->size, header_type(header));
    }
}

/* Read a header behind the version. *end: of the variables that do not grow; *end_of_row: of the first row. */
static void header_read(struct header *header, int version, struct netcdf_rows *rows, uint64_t *end,
                        uint64_t *end_of_row) {
    uint64_t length[NC_MAX_DIMS], n_growing = 0, last_bytes = 0;
    *rows = (struct netcdf_rows){.begin = max_size, .begin_of_rows = max_size};
    *end = *end_of_row = 0;
    rows->n_counted = header_number(header, header->n_bytes, UINT64_MAX);

    const uint64_t n_dimensions = header_list(header, DIMENSION);
    header->is_damaged |= n_dimensions > NC_MAX_DIMS;
    for (uint64_t i = 0; i < n_dimensions && !header->is_damaged; i++) {
        header_skip(header, NC_MAX_NAME, 1);
        length[i] = header_number(header, header->n_bytes, max_size);
    }
    header_skip_attributes(header);

    for (uint64_t i = header_list(header, VARIABLE); i > 0 && !header->is_damaged; i--) {
        // the number of values, per row if the variable grows
        bool grows = false;
        uint64_t bytes = 1;
        header_skip(header, NC_MAX_NAME, 1);
        const uint64_t n = header_number(header, header->n_bytes, NC_MAX_VAR_DIMS);
        for (uint64_t d = 0; d < n && !header->is_damaged; d++) {
            const uint64_t number = header_number(header, header->n_bytes, UINT64_MAX);
            const uint64_t factor = number < n_dimensions ? length[number] : max_size;
            grows |= factor == 0;
            header->is_damaged |= factor == 0 ? d > 0 : bytes > max_size / 8 / factor;
            if (factor > 0) bytes *= factor;
        }
        header_skip_attributes(header);
        bytes *= header_type(header);

        // skip the size, which follows from type and dimensions
        header_number(header, header->n_bytes, UINT64_MAX);
        const uint64_t begin = header_number(header, version == 1 ? 4 : 8, max_size);
        uint64_t *const last = grows ? end_of_row : end;
        if (begin + bytes > *last) *last = begin + bytes;
        if (begin < rows->begin) rows->begin = begin;
        if (!grows) continue;
        if (begin < rows->begin_of_rows) rows->begin_of_rows = begin;
        n_growing++;
        last_bytes = bytes;
        rows->bytes += (bytes + 3) / 4 * 4;
        header->is_damaged |= rows->bytes > max_size;
    }

    // a single variable is not filled up
    if (n_growing == 1) rows->bytes = last_bytes;
}

static enum status not_netcdf(const char *path) {
    return status_fail(STATUS_FILE,
                       "%s: cannot be read: not a NetCDF file of a classic format: name a file that shoal wrote", path);
}

enum status netcdf_read_rows(const char *path, struct netcdf_rows *rows) {
    char magic[4] = "";
    uint64_t end, end_of_row;
    FILE *const file = fopen(path, "rb");
    if (!file) return status_fail(STATUS_FILE, "%s: cannot be read: %s", path, strerror(errno));
    struct header header = {.file = file};
    fseeko(file, 0, SEEK_END);
    header.size = (uint64_t)ftello(file);
    rewind(file);
    const bool is_netcdf = fread(magic, 1, sizeof magic, file) == sizeof magic && memcmp(magic, "CDF", 3) == 0 &&
                           (magic[3] == 1 || magic[3] == 2 || magic[3] == 5);
    header.n_bytes = magic[3] == 5 ? 8 : 4;
    header_read(&header, magic[3], rows, &end, &end_of_row);

    // a row that was added meanwhile counts in the header, which was read after the size
    fseeko(file, 0, SEEK_END);
    header.size = (uint64_t)ftello(file);
    fclose(file);

    if (!is_netcdf) return not_netcdf(path);
    if (header.is_damaged) return status_fail(STATUS_FILE, "%s: cannot be read: the header is damaged", path);
    if (end > header.size) {
        return status_fail(STATUS_FILE, "%s: the end of the file is missing: was it copied completely?", path);
    }

    // whole rows: the header can reach the disk before the rows that the header counts
    if (rows->bytes > 0 && end_of_row <= header.size) {
        rows->n = (header.size - end_of_row) / rows->bytes + 1;
        if (rows->n > rows->n_counted) rows->n = rows->n_counted;
    }
    return STATUS_OK;
}

enum status netcdf_cut_rows(const char *path, const struct netcdf_rows *rows, uint64_t n) {
    if (rows->bytes == 0) return status_fail(STATUS_FILE, "%s: has no rows", path);
    if (rows->n == n && rows->n_counted == n) return STATUS_OK;
    unsigned char number[8];
    for (int i = 0; i < 8; i++) number[i] = (unsigned char)(n >> (8 * (7 - i)) & 0xff);
    const int descriptor = open(path, O_WRONLY | O_CLOEXEC);
    int code = descriptor < 0 ? errno : 0;

    // first the number: a longer file is whole too
    if (code == 0 && pwrite(descriptor, number, sizeof number, 4) != sizeof number) code = errno;
    if (code == 0) code = durable_sync(descriptor);
    if (code == 0 && ftruncate(descriptor, (off_t)(rows->begin_of_rows + n * rows->bytes)) != 0) code = errno;
    if (code == 0) code = durable_sync(descriptor);
    if (descriptor >= 0 && close(descriptor) != 0 && code == 0) code = errno;
    if (code == 0) return STATUS_OK;
    return status_fail(STATUS_FILE, "%s: the last rows cannot be removed: %s", path, strerror(code));
}

// ---- reading files that may be anybody's

static enum status cannot_read(const char *path, int code) {
    if (code == NC_ENOMEM) return status_fail(STATUS_MEMORY, "%s: out of memory while reading", path);
    return status_fail(STATUS_FILE, "%s: cannot be read: %s", path, nc_strerror(code));
}

// ---- the file

static void netcdf_close(void *reader) {
    nc_close(((struct netcdf_reader *)reader)->file);
}

enum status netcdf_open(struct arena *arena, struct netcdf_reader *reader, const char *path) {
    *reader = (struct netcdf_reader){.arena = arena, .path = path, .file = -1};
    struct stat facts;
    struct netcdf_rows rows;
    char local[PATH_MAX];
    if (stat(path, &facts) != 0) return cannot_read(path, errno);
    if (S_ISDIR(facts.st_mode)) return status_fail(STATUS_FILE, "%s is a folder: name a file that shoal wrote", path);
    if (!S_ISREG(facts.st_mode)) return status_fail(STATUS_FILE, "%s: cannot be read: not an ordinary file", path);

    // a file of the kernel has size 0 and may block
    if (facts.st_size == 0) return not_netcdf(path);
    TRY(netcdf_read_rows(path, &rows));
    reader->n_rows = rows.n;
    reader->n_missing = rows.n_counted - rows.n;
    if (!netcdf_has_memory()) return cannot_read(path, NC_ENOMEM);
    int code = netcdf_local_path(path, local);
    if (code == 0) code = nc_open(local, NC_NOWRITE, &reader->file);

    // NetCDF also returns NC_ENOMEM for a damaged header with huge sizes
    if (code == NC_ENOMEM)
        return status_fail(STATUS_FILE, "%s: cannot be read: the header is damaged, or out of memory", path);
    if (code != NC_NOERR) return cannot_read(path, code);
    arena_defer(arena, netcdf_close, reader);
    return STATUS_OK;
}

enum status netcdf_print(struct arena *arena, const char *path,
                         enum status (*print)(const struct netcdf_reader *reader, FILE *stream), FILE *stream) {
    struct netcdf_reader *reader;
    struct arena *const scratch = arena_create(arena, path);
    NEW(scratch, reader, 1);
    TRY(netcdf_open(scratch, reader, path));
    TRY(print(reader, stream));
    arena_free(scratch);
    return STATUS_OK;
}

// ---- attributes and dimensions

enum status netcdf_attribute(const struct netcdf_reader *reader, const char *name, char **string) {
    nc_type type = NC_CHAR;
    size_t length = 0;
    const bool exists = nc_inq_att(reader->file, NC_GLOBAL, name, &type, &length) == NC_NOERR;
    *string = NULL;
    if (type != NC_CHAR) return status_fail(STATUS_FILE, "%s: attribute %s is no string", reader->path, name);
    NEW(reader->arena, *string, (exists ? length : 0) + 1);
    const int code = exists ? nc_get_att_text(reader->file, NC_GLOBAL, name, *string) : NC_NOERR;
    return code == NC_NOERR ? STATUS_OK : cannot_read(reader->path, code);
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

bool netcdf_read_shape(const struct netcdf_reader *reader, int i, struct netcdf_shape *shape) {
    char name[NC_MAX_NAME + 1];
    int n_variables, dimension[NC_MAX_VAR_DIMS];
    nc_type type;
    *shape = (struct netcdf_shape){.n_dimensions = 0};
    if (nc_inq_nvars(reader->file, &n_variables) != NC_NOERR || i >= n_variables) return false;
    if (nc_inq_var(reader->file, i, name, &type, &shape->n_dimensions, dimension, NULL) != NC_NOERR) return false;
    if (shape->n_dimensions > NETCDF_MAX_DIMENSIONS || strlen(name) >= sizeof shape->name) return true;

    for (int d = 0; d < shape->n_dimensions; d++) {
        char dimension_name[NC_MAX_NAME + 1];
        if (nc_inq_dimname(reader->file, dimension[d], dimension_name) != NC_NOERR) return false;
        if (read_length(reader, dimension[d], &shape->length[d]) != NC_NOERR) return false;
        if (strlen(dimension_name) >= sizeof *shape->dimension) return true;
        strcpy(shape->dimension[d], dimension_name);
    }

    strcpy(shape->name, name);
    shape->is_text = type == NC_CHAR;
    return true;
}

/* The number of a variable that has exactly the dimensions of a slice, so long, with start and count for NetCDF. */
static enum status netcdf_find_variable(const struct netcdf_reader *reader, const char *name, bool is_text,
                                        const struct netcdf_slice *slice, int *number, size_t *start, size_t *count) {
    int n, dimension[NC_MAX_VAR_DIMS];
    nc_type type;
    if (nc_inq_varid(reader->file, name, number) != NC_NOERR)
        return status_fail(STATUS_FILE, "%s: variable %s is missing", reader->path, name);
    const int code = nc_inq_var(reader->file, *number, NULL, &type, &n, dimension, NULL);
    if (code != NC_NOERR) return cannot_read(reader->path, code);

    bool is_right = (type == NC_CHAR) == is_text && n <= NETCDF_MAX_DIMENSIONS;
    for (int d = 0; d < n && is_right; d++) {
        char found[NC_MAX_NAME + 1];
        size_t length;
        is_right = slice[d].dimension && nc_inq_dimname(reader->file, dimension[d], found) == NC_NOERR &&
                   read_length(reader, dimension[d], &length) == NC_NOERR && strcmp(found, slice[d].dimension) == 0 &&
                   slice[d].first <= length && slice[d].n <= length - slice[d].first;
        start[d] = slice[d].first;
        count[d] = slice[d].n;
    }
    if (is_right && !slice[n].dimension) return STATUS_OK;

    // the expected form
    char dimensions[256] = "";
    for (size_t length = 0; slice->dimension && length < sizeof dimensions; slice++) {
        length += (size_t)snprintf(dimensions + length, sizeof dimensions - length, "%s%s[%zu:%zu]",
                                   length > 0 ? ", " : "", slice->dimension, slice->first, slice->first + slice->n);
    }
    return status_fail(STATUS_FILE, "%s: variable %s was not written by shoal: %s over (%s) %s expected", reader->path,
                       name, is_text ? "text" : "numbers", dimensions, is_text ? "is" : "are");
}

enum status netcdf_read_doubles(const struct netcdf_reader *reader, const char *name, const struct netcdf_slice *slice,
                                double *values) {
    int number;
    size_t start[NETCDF_MAX_DIMENSIONS], count[NETCDF_MAX_DIMENSIONS];
    TRY(netcdf_find_variable(reader, name, false, slice, &number, start, count));
    const int code = nc_get_vara_double(reader->file, number, start, count, values);
    return code == NC_NOERR ? STATUS_OK : cannot_read(reader->path, code);
}

enum status netcdf_read_text(const struct netcdf_reader *reader, const char *name, const struct netcdf_slice *slice,
                             char *values) {
    int number;
    size_t start[NETCDF_MAX_DIMENSIONS], count[NETCDF_MAX_DIMENSIONS];
    TRY(netcdf_find_variable(reader, name, true, slice, &number, start, count));
    const int code = nc_get_vara_text(reader->file, number, start, count, values);
    return code == NC_NOERR ? STATUS_OK : cannot_read(reader->path, code);
}
