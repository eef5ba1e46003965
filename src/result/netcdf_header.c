/* netcdf_header.c: check a file for completeness, and find the rows. NetCDF reads a missing end as zeros and trusts the
 * sizes in the header.
 *
 *     header    = "CDF" version  n_rows  dimensions  attributes  variables
 *     list      = tag  n  n entries; both 0: none          tag: DIMENSION, ATTRIBUTE, VARIABLE
 *     dimension = name  length                             length 0: grows by rows
 *     attribute = name  type  n  n values
 *     variable  = name  n  n numbers of dimensions  attributes  type  size  begin
 *     name      = n  n bytes
 *
 * All numbers are big-endian; tags and types have 4 bytes, begin 8 (4 in version 1), others 4 (8 in version 5). Names
 * and values are filled up to 4 bytes. A row holds one entry of each variable that grows, one after the other.
 * https://docs.unidata.ucar.edu/netcdf-c/current/file_format_specifications.html */
#include <errno.h>
#include <fcntl.h>
#include <netcdf.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "result/durable.h"
#include "result/netcdf.h"

enum tag { DIMENSION = 10, VARIABLE = 11, ATTRIBUTE = 12 };
static const uint64_t max_size = (uint64_t)1 << 60; /* of anything, bytes */

struct header {
    FILE *file;
    uint64_t size;   /* of the file */
    bool is_damaged; /* also if the file ends within the header */
    int version, n_bytes;
    uint64_t n_rows, n_dimensions;
    uint64_t length[NC_MAX_DIMS];              /* of the dimensions */
    uint64_t begin, begin_of_rows;             /* of the first value, of the first row */
    uint64_t end;                              /* of the variables that do not grow */
    uint64_t end_of_row;                       /* of the first */
    uint64_t row_bytes, n_growing, last_bytes; /* size and variables of a row; size of the last one without padding */
};

// ---- pieces

static uint64_t read_number(struct header *header, int n_bytes) {
    uint64_t number = 0;
    for (int i = 0; i < n_bytes; i++) {
        const int byte = fgetc(header->file);
        if (byte == EOF) header->is_damaged = true;
        number = number << 8 | (uint64_t)(byte & 0xff);
    }
    return number;
}

static uint64_t fill_up(uint64_t n) {
    return (n + 3) / 4 * 4;
}

/* Skip n bytes and the padding. */
static void skip(struct header *header, uint64_t n) {
    const off_t place = ftello(header->file);
    if (place < 0 || n > header->size || fill_up(n) > header->size - (uint64_t)place) {
        header->is_damaged = true;
    } else {
        fseeko(header->file, (off_t)fill_up(n), SEEK_CUR);
    }
}

static void skip_name(struct header *header) {
    const uint64_t n = read_number(header, header->n_bytes);
    if (n > NC_MAX_NAME) header->is_damaged = true;
    if (!header->is_damaged) skip(header, n);
}

/* Bytes of a value of the type that follows; 1 after damage. */
static uint64_t read_type(struct header *header) {
    static const uint64_t bytes[] = {
        [NC_BYTE] = 1,  [NC_CHAR] = 1,   [NC_SHORT] = 2, [NC_INT] = 4,   [NC_FLOAT] = 4, [NC_DOUBLE] = 8,
        [NC_UBYTE] = 1, [NC_USHORT] = 2, [NC_UINT] = 4,  [NC_INT64] = 8, [NC_UINT64] = 8};
    const uint64_t type = read_number(header, 4);
    if (type >= NC_BYTE && type <= (header->version == 5 ? NC_UINT64 : NC_DOUBLE)) return bytes[type];
    header->is_damaged = true;
    return 1;
}

/* The number of entries of a list. */
static uint64_t read_list(struct header *header, enum tag expected) {
    const uint64_t tag = read_number(header, 4), n = read_number(header, header->n_bytes);
    if (tag == 0 && n == 0) return 0;
    if (tag != expected || n > header->size) header->is_damaged = true;
    return n;
}

// ---- the lists

static void read_dimensions(struct header *header) {
    header->n_dimensions = read_list(header, DIMENSION);
    if (header->n_dimensions > NC_MAX_DIMS) header->is_damaged = true;
    for (uint64_t i = 0; i < header->n_dimensions && !header->is_damaged; i++) {
        skip_name(header);
        header->length[i] = read_number(header, header->n_bytes);
        if (header->length[i] > max_size) header->is_damaged = true;
    }
}

static void skip_attributes(struct header *header) {
    const uint64_t n = read_list(header, ATTRIBUTE);
    for (uint64_t i = 0; i < n && !header->is_damaged; i++) {
        skip_name(header);
        const uint64_t bytes = read_type(header), n_values = read_number(header, header->n_bytes);
        if (n_values > header->size) header->is_damaged = true;
        if (!header->is_damaged) skip(header, n_values * bytes);
    }
}

/* Read the dimensions of a variable; the number of values, per row if the variable grows. */
static uint64_t read_shape(struct header *header, bool *grows) {
    const uint64_t n = read_number(header, header->n_bytes);
    uint64_t n_values = 1;
    *grows = false;
    if (n > NC_MAX_VAR_DIMS) header->is_damaged = true;

    for (uint64_t d = 0; d < n && !header->is_damaged; d++) {
        const uint64_t number = read_number(header, header->n_bytes);
        const uint64_t length = number < header->n_dimensions ? header->length[number] : max_size;
        if (length == 0 && d == 0) {
            *grows = true;
        } else if (length == 0 || n_values > max_size / 8 / length) {
            header->is_damaged = true;
        } else {
            n_values *= length;
        }
    }

    return n_values;
}

static void read_variable(struct header *header) {
    bool grows;
    skip_name(header);
    const uint64_t n_values = read_shape(header, &grows);
    if (!header->is_damaged) skip_attributes(header);
    const uint64_t bytes = n_values * read_type(header);
    read_number(header, header->n_bytes);  // skip the size, which follows from type and dimensions
    const uint64_t begin = read_number(header, header->version == 1 ? 4 : 8);
    if (begin > max_size) header->is_damaged = true;
    if (header->is_damaged) return;
    uint64_t *const end = grows ? &header->end_of_row : &header->end;
    if (begin + bytes > *end) *end = begin + bytes;
    if (begin < header->begin) header->begin = begin;
    if (!grows) return;
    if (begin < header->begin_of_rows) header->begin_of_rows = begin;
    header->n_growing++;
    header->last_bytes = bytes;
    header->row_bytes += fill_up(bytes);
    if (header->row_bytes > max_size) header->is_damaged = true;
}

static void read_header(struct header *header) {
    char magic[4] = "";
    header->begin = header->begin_of_rows = max_size;
    if (fread(magic, 1, sizeof magic, header->file) != sizeof magic) header->is_damaged = true;
    header->version = magic[3];
    header->n_bytes = header->version == 5 ? 8 : 4;
    header->n_rows = read_number(header, header->n_bytes);
    read_dimensions(header);
    if (!header->is_damaged) skip_attributes(header);
    const uint64_t n_variables = header->is_damaged ? 0 : read_list(header, VARIABLE);
    for (uint64_t i = 0; i < n_variables && !header->is_damaged; i++) read_variable(header);

    // a single variable is not filled up
    if (header->n_growing == 1) header->row_bytes = header->last_bytes;
}

/* The number of complete rows: the header can reach the disk before the rows that the header counts. */
static uint64_t n_whole_rows(const struct header *header) {
    if (header->n_growing == 0 || header->end_of_row > header->size) return 0;
    const uint64_t n = (header->size - header->end_of_row) / header->row_bytes + 1;
    return n < header->n_rows ? n : header->n_rows;
}

/* True for "CDF" and a known version. */
static bool is_netcdf(FILE *file) {
    char magic[4] = "";
    const bool is_known = fread(magic, 1, sizeof magic, file) == sizeof magic && memcmp(magic, "CDF", 3) == 0 &&
                          (magic[3] == 1 || magic[3] == 2 || magic[3] == 5);
    rewind(file);
    return is_known;
}

static uint64_t size_of(FILE *file) {
    fseeko(file, 0, SEEK_END);
    return (uint64_t)ftello(file);
}

static enum status examine(struct header *header, const char *path) {
    header->file = fopen(path, "rb");
    if (!header->file) return status_fail(STATUS_FILE, "%s: cannot be read: %s", path, strerror(errno));
    enum status status = STATUS_OK;

    if (is_netcdf(header->file)) {
        header->size = size_of(header->file);
        rewind(header->file);
        read_header(header);
        // a row that was added meanwhile counts in the header, which was read after the size
        header->size = size_of(header->file);
        if (header->is_damaged) {
            status = status_fail(STATUS_FILE, "%s: cannot be read: the header is damaged", path);
        } else if (header->end > header->size) {
            status = status_fail(STATUS_FILE, "%s: the end of the file is missing: was it copied completely?", path);
        }
    } else {
        status = status_fail(STATUS_FILE,
                             "%s: cannot be read: not a NetCDF file of a classic format: name a file that shoal wrote",
                             path);
    }

    fclose(header->file);
    return status;
}

enum status netcdf_read_rows(const char *path, struct netcdf_rows *rows) {
    struct header header = {0};
    TRY(examine(&header, path));
    *rows = (struct netcdf_rows){.begin = header.begin,
                                 .begin_of_rows = header.begin_of_rows,
                                 .bytes = header.n_growing > 0 ? header.row_bytes : 0,
                                 .n = n_whole_rows(&header),
                                 .n_counted = header.n_rows};
    return STATUS_OK;
}

// Write another number of rows and truncate the file behind the last row; errno or 0.
static int cut(int descriptor, const struct netcdf_rows *rows, uint64_t n) {
    unsigned char number[8];
    for (int i = 0; i < 8; i++) number[i] = (unsigned char)(n >> (8 * (7 - i)) & 0xff);
    // first the number: a longer file is whole too
    if (pwrite(descriptor, number, sizeof number, 4) != sizeof number) return errno;
    const int code = durable_sync(descriptor);
    if (code != 0) return code;
    if (ftruncate(descriptor, (off_t)(rows->begin_of_rows + n * rows->bytes)) != 0) return errno;
    return durable_sync(descriptor);
}

enum status netcdf_cut_rows(const char *path, const struct netcdf_rows *rows, uint64_t n) {
    if (rows->bytes == 0) return status_fail(STATUS_FILE, "%s: has no rows", path);
    if (rows->n == n && rows->n_counted == n) return STATUS_OK;
    const int descriptor = open(path, O_WRONLY | O_CLOEXEC);
    int code = descriptor < 0 ? errno : cut(descriptor, rows, n);
    if (descriptor >= 0 && close(descriptor) != 0 && code == 0) code = errno;
    if (code == 0) return STATUS_OK;
    return status_fail(STATUS_FILE, "%s: the last rows cannot be removed: %s", path, strerror(code));
}
