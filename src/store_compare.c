/* store_compare.c: writing a comparison of methods. */
#include "store_compare.h"

#include <math.h>
#include <netcdf.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "version.h"

enum { SCHEMA = 1 /* attribute shoal_compare */, PATH_BYTES = 4200 };

/* Leave with NetCDF's error code. */
#define NETCDF(call)                                     \
    do {                                                 \
        const int netcdf_code = (call);                  \
        if (netcdf_code != NC_NOERR) return netcdf_code; \
    } while (0)

/* The numbers of a row. */
static const struct column {
    const char *name, *unit, *long_name;
    size_t offset;
} columns[] = {
#define IN_ROW(field) offsetof(struct store_compare_row, field)
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

static int write_attribute(int file, int variable, const char *name, const char *text) {
    return nc_put_att_text(file, variable, name, strlen(text), text);
}

static int define(int file, const struct settings *settings, int n, const char *command) {
    const int schema = SCHEMA;
    int run, text, variable;
    NETCDF(nc_def_dim(file, "run", (size_t)n, &run));
    NETCDF(nc_def_dim(file, "text", sizeof((struct store_compare_row){0}).status, &text));
    NETCDF(write_attribute(file, NC_GLOBAL, "Conventions", "CF-1.10"));
    NETCDF(write_attribute(file, NC_GLOBAL, "title", settings->name));
    NETCDF(write_attribute(file, NC_GLOBAL, "history", command));
    NETCDF(write_attribute(file, NC_GLOBAL, "source", version_short()));
    NETCDF(nc_put_att_int(file, NC_GLOBAL, "shoal_compare", NC_INT, 1, &schema));
    NETCDF(write_attribute(file, NC_GLOBAL, "case_text", settings->text));
    NETCDF(nc_def_var(file, "method", NC_CHAR, 2, (int[]){run, text}, &variable));
    NETCDF(write_attribute(file, variable, "_Encoding", "utf-8"));
    NETCDF(nc_def_var(file, "status", NC_CHAR, 2, (int[]){run, text}, &variable));
    NETCDF(write_attribute(file, variable, "_Encoding", "utf-8"));
    for (int c = 0; c < N_COLUMNS; c++) {
        const double fill = NAN;
        NETCDF(nc_def_var(file, columns[c].name, NC_DOUBLE, 1, &run, &variable));
        NETCDF(write_attribute(file, variable, "units", columns[c].unit));
        NETCDF(write_attribute(file, variable, "long_name", columns[c].long_name));
        NETCDF(nc_put_att_double(file, variable, _FillValue, NC_DOUBLE, 1, &fill));
    }
    return nc_enddef(file);
}

static int write_text(int file, const char *name, int row, const char *value) {
    char text[sizeof((struct store_compare_row){0}).status] = {0};
    snprintf(text, sizeof text, "%s", value);
    int variable;
    NETCDF(nc_inq_varid(file, name, &variable));
    return nc_put_vara_text(file, variable, (size_t[]){(size_t)row, 0}, (size_t[]){1, sizeof text}, text);
}

static int write_rows(int file, int n, const struct store_compare_row *row) {
    for (int i = 0; i < n; i++) {
        NETCDF(write_text(file, "method", i, row[i].method));
        NETCDF(write_text(file, "status", i, row[i].status));
        for (int c = 0; c < N_COLUMNS; c++) {
            int variable;
            double value;
            memcpy(&value, (const char *)&row[i] + columns[c].offset, sizeof value);
            NETCDF(nc_inq_varid(file, columns[c].name, &variable));
            NETCDF(nc_put_var1_double(file, variable, (size_t[]){(size_t)i}, &value));
        }
    }
    return NC_NOERR;
}

enum status store_compare_write(const char *path, const struct settings *settings, int n,
                                const struct store_compare_row *row, const char *command) {
    char temporary[PATH_BYTES];
    // "./" keeps NetCDF from taking the name for an address
    snprintf(temporary, sizeof temporary, "%s%s.part", path[0] == '/' ? "" : "./", path);
    int file;
    int code = nc_create(temporary, NC_CLOBBER | NC_64BIT_DATA, &file);
    if (code == NC_NOERR) {
        code = define(file, settings, n, command);
        if (code == NC_NOERR) code = write_rows(file, n, row);
        const int closed = nc_close(file);
        if (code == NC_NOERR) code = closed;
    }
    if (code == NC_NOERR && rename(temporary, path) == 0) return STATUS_OK;
    unlink(temporary);
    return status_fail(STATUS_FILE, "%s: cannot be written (%s): choose another place with -o", path,
                       code == NC_NOERR ? "no renaming there" : nc_strerror(code));
}
