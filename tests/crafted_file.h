/* crafted_file.h: Makes NetCDF files in which one variable is not what it should be. */
#ifndef CRAFTED_FILE_H
#define CRAFTED_FILE_H

#include <netcdf.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "near.h"

enum craft { MISSING, OTHER_TYPE, MORE_DIMENSIONS, FEWER_DIMENSIONS, LONG_DIMENSION, N_CRAFTS };

/* The bytes of a file, to write it again. They are kept until the end of the test. */
static inline char *read_bytes(const char *path, size_t *n) {
    FILE *const file = fopen(path, "rb");
    assert_non_null(file);
    fseek(file, 0, SEEK_END);
    *n = (size_t)ftell(file);
    rewind(file);
    char *const bytes = arena_new(test_arena(), *n, 1);
    assert_int_equal(fread(bytes, 1, *n, file), *n);
    fclose(file);
    return bytes;
}

static inline void write_bytes(const char *path, size_t n, const char *bytes) {
    unlink(path);  // some file systems write at once what replaces a file
    FILE *const file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, n, file), n);
    fclose(file);
}

/* The length of a file without the zeros at its end, which NetCDF may leave there. */
static inline off_t length_of_data(const char *path) {
    size_t n;
    char *const bytes = read_bytes(path, &n);
    while (n > 0 && bytes[n - 1] == 0) n--;
    return (off_t)n;
}

/* The name of a variable of a file, by its number; 0 beyond the last. */
static inline int name_of_variable(const char *path, int number, char name[NC_MAX_NAME + 1]) {
    int file;
    assert_int_equal(nc_open(path, NC_NOWRITE, &file), NC_NOERR);
    const int code = nc_inq_varname(file, number, name);
    nc_close(file);
    return code == NC_NOERR;
}

/* Put another variable in the place of one; of a long dimension that has its name. */
static inline void craft_variable(const char *path, const char *name, enum craft how) {
    int file, number, n, dimensions[NC_MAX_VAR_DIMS], more;
    nc_type type;
    char other[NC_MAX_NAME + 4];
    assert_int_equal(nc_open(path, NC_WRITE, &file), NC_NOERR);
    assert_int_equal(nc_redef(file), NC_NOERR);
    assert_int_equal(nc_inq_varid(file, name, &number), NC_NOERR);
    assert_int_equal(nc_inq_var(file, number, NULL, &type, &n, dimensions, NULL), NC_NOERR);
    snprintf(other, sizeof other, "no_%s", name);
    assert_int_equal(nc_rename_var(file, number, other), NC_NOERR);
    assert_int_equal(nc_def_dim(file, "more", 3, &more), NC_NOERR);
    if (how == OTHER_TYPE) type = type == NC_CHAR ? NC_DOUBLE : NC_CHAR;
    if (how == MORE_DIMENSIONS || (how == FEWER_DIMENSIONS && n == 0)) {
        dimensions[n++] = more;
    } else if (how == FEWER_DIMENSIONS) {
        n--;
    } else if (how == LONG_DIMENSION && n > 0) {
        char dimension[NC_MAX_NAME + 1];
        assert_int_equal(nc_inq_dimname(file, dimensions[n - 1], dimension), NC_NOERR);
        assert_int_equal(nc_rename_dim(file, dimensions[n - 1], "short"), NC_NOERR);
        assert_int_equal(nc_def_dim(file, dimension, 5000, &dimensions[n - 1]), NC_NOERR);
    }
    if (how != MISSING) assert_int_equal(nc_def_var(file, name, type, n, dimensions, &number), NC_NOERR);
    assert_int_equal(nc_close(file), NC_NOERR);
}

#endif
