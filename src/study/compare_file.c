/* compare_file.c: writing and reading a comparison of methods. */
#include "study/compare_file.h"

#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/version.h"
#include "output/netcdf.h"
#include "output/result_table.h"

enum { PATH_BYTES = 4200 };

/* The numbers of a row. */
static const struct column {
    const char *name, *unit, *long_name;
    size_t offset;
} columns[] = {
#define IN_ROW(field) offsetof(struct compare_file_row, field)
    {"rtol", "1", "relative error allowed per step", IN_ROW(rtol)},
    {"step", "s", "fixed step", IN_ROW(step)},
    {"nose_error", "1", "error of the nose at the end, in body lengths", IN_ROW(nose_error)},
    {"tail_error", "1", "error of the tail at the end, in body lengths", IN_ROW(tail_error)},
    {"wall_time", "s", "median of the wall times of the repeats", IN_ROW(wall_time)},
    {"steps", "1", "steps of the integrator", IN_ROW(steps)},
    {"evaluations", "1", "evaluations of the residual or of the rates", IN_ROW(evaluations)},
    {"newton_iterations", "1", "Newton iterations", IN_ROW(newton_iterations)},
    {"jacobian_evaluations", "1", "evaluations of the Jacobian", IN_ROW(jacobians)},
    {"linear_solves", "1", "linear systems solved", IN_ROW(linear_solves)},
};
enum { N_COLUMNS = sizeof columns / sizeof *columns };

/* The texts of a row. */
enum { METHOD, STATUS, N_TEXTS };
static const struct words {
    const char *name, *long_name;
    size_t offset;
} texts[N_TEXTS] = {
    {"method", "method; ida2 is the implicit one of order 2", IN_ROW(method)},
    {"status", "complete, or why the run ended early", IN_ROW(status)},
};

/* The numbers of the reference. */
static const struct column of_reference[] = {
#define IN_REFERENCE(field) offsetof(struct compare_file_reference, field)
    {"reference_rtol", "1", "tolerance of the reference, the implicit method of order 5", IN_REFERENCE(rtol)},
    {"reference_nose_error", "1", "error of the nose with ten times that tolerance, in body lengths",
     IN_REFERENCE(nose_error)},
    {"reference_tail_error", "1", "the same for the tail", IN_REFERENCE(tail_error)},
};
enum { N_OF_REFERENCE = sizeof of_reference / sizeof *of_reference };

/* The value of a column. */
static double value_of(const struct column *column, const void *from) {
    double value;
    memcpy(&value, (const char *)from + column->offset, sizeof value);
    return value;
}

int compare_file_listed(int i, struct result_listed *listed) {
    if (i < N_TEXTS) {
        *listed = (struct result_listed){.name = texts[i].name,
                                         .unit = "",
                                         .type = "char",
                                         .meaning = texts[i].long_name,
                                         .dimensions = "run, text"};
        return 1;
    }
    const int is_number = i - N_TEXTS < N_COLUMNS;
    if (i >= N_TEXTS + N_COLUMNS + N_OF_REFERENCE) return 0;
    const struct column *const column = is_number ? &columns[i - N_TEXTS] : &of_reference[i - N_TEXTS - N_COLUMNS];
    *listed = (struct result_listed){
        .name = column->name, .unit = column->unit, .type = "double", .meaning = column->long_name};
    if (is_number) strcpy(listed->dimensions, "run");
    return 1;
}

static int define_number(int file, const struct column *column, int n_dimensions, const int *dimension) {
    const double fill = NAN;
    int variable;
    NETCDF(nc_def_var(file, column->name, NC_DOUBLE, n_dimensions, dimension, &variable));
    NETCDF(netcdf_text(file, variable, "units", column->unit));
    NETCDF(netcdf_text(file, variable, "long_name", column->long_name));
    return nc_put_att_double(file, variable, _FillValue, NC_DOUBLE, 1, &fill);
}

static int define(int file, const struct case_values *values, int n, const char *command) {
    const int schema = RESULT_COMPARE_SCHEMA;
    int run, text, variable;
    NETCDF(nc_def_dim(file, "run", (size_t)n, &run));
    NETCDF(nc_def_dim(file, "text", sizeof((struct compare_file_row){0}).status, &text));
    NETCDF(netcdf_text(file, NC_GLOBAL, "Conventions", "CF-1.10"));
    NETCDF(netcdf_text(file, NC_GLOBAL, "title", values->name));
    NETCDF(netcdf_text(file, NC_GLOBAL, "history", command));
    NETCDF(netcdf_text(file, NC_GLOBAL, "source", version_short()));
    NETCDF(nc_put_att_int(file, NC_GLOBAL, "shoal_compare", NC_INT, 1, &schema));
    NETCDF(netcdf_text(file, NC_GLOBAL, "compare_case", values->merged));
    for (int i = 0; i < N_TEXTS; i++) {
        NETCDF(nc_def_var(file, texts[i].name, NC_CHAR, 2, (int[]){run, text}, &variable));
        NETCDF(netcdf_text(file, variable, "long_name", texts[i].long_name));
        NETCDF(netcdf_text(file, variable, "_Encoding", "utf-8"));
    }
    for (int c = 0; c < N_COLUMNS; c++) NETCDF(define_number(file, &columns[c], 1, &run));
    for (int c = 0; c < N_OF_REFERENCE; c++) NETCDF(define_number(file, &of_reference[c], 0, NULL));
    return nc_enddef(file);
}

static int write_text(int file, const char *name, int row, const char *value) {
    char text[sizeof((struct compare_file_row){0}).status] = {0};
    snprintf(text, sizeof text, "%s", value);
    int variable;
    NETCDF(nc_inq_varid(file, name, &variable));
    return nc_put_vara_text(file, variable, (size_t[]){(size_t)row, 0}, (size_t[]){1, sizeof text}, text);
}

static int write_number(int file, const struct column *column, int row, double value) {
    int variable;
    NETCDF(nc_inq_varid(file, column->name, &variable));
    return nc_put_var1_double(file, variable, (size_t[]){(size_t)row}, &value);
}

static int write_all(int file, const struct compare_file_reference *reference, int n,
                     const struct compare_file_row *row) {
    for (int i = 0; i < n; i++) {
        for (int k = 0; k < N_TEXTS; k++) {
            NETCDF(write_text(file, texts[k].name, i, (const char *)&row[i] + texts[k].offset));
        }
        for (int c = 0; c < N_COLUMNS; c++) NETCDF(write_number(file, &columns[c], i, value_of(&columns[c], &row[i])));
    }
    for (int c = 0; c < N_OF_REFERENCE; c++) {
        NETCDF(write_number(file, &of_reference[c], 0, value_of(&of_reference[c], reference)));
    }
    return NC_NOERR;
}

enum status compare_file_write(const char *path, const struct case_values *values,
                               const struct compare_file_reference *reference, int n,
                               const struct compare_file_row *row, const char *command) {
    char temporary[PATH_BYTES];
    // "./" keeps NetCDF from taking the name for an address
    snprintf(temporary, sizeof temporary, "%s%s.part", path[0] == '/' ? "" : "./", path);
    int file;
    int code = nc_create(temporary, NC_CLOBBER | NC_64BIT_DATA, &file);
    if (code == NC_NOERR) {
        code = define(file, values, n, command);
        if (code == NC_NOERR) code = write_all(file, reference, n, row);
        const int closed = nc_close(file);
        if (code == NC_NOERR) code = closed;
    }
    if (code == NC_NOERR && rename(temporary, path) == 0) return STATUS_OK;
    unlink(temporary);
    return status_fail(STATUS_FILE, "%s: cannot be written (%s): choose another place with -o", path,
                       code == NC_NOERR ? "no renaming there" : nc_strerror(code));
}

// ---- reading

static int read_row(int file, int i, size_t n_text, struct compare_file_row *row) {
    int variable;
    for (int k = 0; k < N_TEXTS; k++) {
        const size_t room = (k == METHOD ? sizeof row->method : sizeof row->status) - 1;
        NETCDF(nc_inq_varid(file, texts[k].name, &variable));
        NETCDF(nc_get_vara_text(file, variable, (size_t[]){(size_t)i, 0}, (size_t[]){1, n_text < room ? n_text : room},
                                (char *)row + texts[k].offset));
    }
    for (int c = 0; c < N_COLUMNS; c++) {
        NETCDF(nc_inq_varid(file, columns[c].name, &variable));
        NETCDF(nc_get_var1_double(file, variable, (size_t[]){(size_t)i}, (double *)((char *)row + columns[c].offset)));
    }
    return NC_NOERR;
}

static int read_all(int file, struct compare_file_reference *reference, int n, size_t n_text,
                    struct compare_file_row *row) {
    for (int i = 0; i < n; i++) NETCDF(read_row(file, i, n_text, &row[i]));
    for (int c = 0; c < N_OF_REFERENCE; c++) {
        int variable;
        NETCDF(nc_inq_varid(file, of_reference[c].name, &variable));
        NETCDF(nc_get_var_double(file, variable, (double *)((char *)reference + of_reference[c].offset)));
    }
    return NC_NOERR;
}

static size_t length_of(int file, const char *dimension) {
    int number;
    size_t length = 0;
    if (nc_inq_dimid(file, dimension, &number) == NC_NOERR) nc_inq_dimlen(file, number, &length);
    return length;
}

enum status compare_file_read(const char *path, struct compare_file_reference *reference, int *n,
                              struct compare_file_row **row) {
    *row = NULL;
    int file;
    int code = nc_open(path, NC_NOWRITE, &file);
    if (code != NC_NOERR) return status_fail(STATUS_FILE, "%s: cannot be read: %s", path, nc_strerror(code));
    *n = (int)length_of(file, "run");
    *row = calloc((size_t)*n + 1, sizeof **row);
    if (*row) code = read_all(file, reference, *n, length_of(file, "text"), *row);
    nc_close(file);
    if (!*row) return status_fail(STATUS_MEMORY, "%s: out of memory while reading", path);
    if (code == NC_NOERR) return STATUS_OK;
    free(*row);
    *row = NULL;
    return status_fail(STATUS_FILE, "%s: not a whole comparison: %s", path, nc_strerror(code));
}
