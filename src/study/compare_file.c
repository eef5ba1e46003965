/* compare_file.c: writing and reading a comparison of methods. */
#include "study/compare_file.h"

#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "output/netcdf.h"

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

/* Bytes of the dimension text. */
enum { TEXT_BYTES = sizeof((struct compare_file_row){0}).status };

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

static void define_number(struct netcdf_writer *writer, const struct column *column, int n_dimensions, int run) {
    const struct netcdf_variable variable = {.name = column->name,
                                             .long_name = column->long_name,
                                             .units = column->unit,
                                             .type = NETCDF_DOUBLE,
                                             .n_dimensions = n_dimensions,
                                             .dimension = {run},
                                             .has_gaps = true};
    netcdf_define_variable(writer, &variable);
}

static void define(struct netcdf_writer *writer, const struct case_values *values, int n) {
    const int run = netcdf_define_dimension(writer, "run", (size_t)n);
    const int text = netcdf_define_dimension(writer, "text", TEXT_BYTES);
    netcdf_write_integer(writer, NETCDF_GLOBAL, "shoal_compare", COMPARE_FILE_SCHEMA);
    netcdf_write_string(writer, NETCDF_GLOBAL, "compare_case", values->merged);
    for (int i = 0; i < N_TEXTS; i++) {
        const struct netcdf_variable variable = {.name = texts[i].name,
                                                 .long_name = texts[i].long_name,
                                                 .type = NETCDF_TEXT,
                                                 .n_dimensions = 2,
                                                 .dimension = {run, text}};
        netcdf_define_variable(writer, &variable);
    }
    for (int c = 0; c < N_COLUMNS; c++) define_number(writer, &columns[c], 1, run);
    for (int c = 0; c < N_OF_REFERENCE; c++) define_number(writer, &of_reference[c], 0, run);
    netcdf_end_definitions(writer);
}

static void write_text(struct netcdf_writer *writer, const char *name, int row, const char *value) {
    char text[TEXT_BYTES] = {0};
    snprintf(text, sizeof text, "%s", value);
    netcdf_write_text(writer, netcdf_number(writer, name), (size_t[]){(size_t)row, 0}, (size_t[]){1, sizeof text},
                      text);
}

static void write_number(struct netcdf_writer *writer, const struct column *column, int row, double value) {
    netcdf_write_doubles(writer, netcdf_number(writer, column->name), (size_t[]){(size_t)row}, (size_t[]){1}, &value);
}

static void write_all(struct netcdf_writer *writer, const struct compare_file_reference *reference, int n,
                      const struct compare_file_row *row) {
    for (int i = 0; i < n; i++) {
        for (int k = 0; k < N_TEXTS; k++) {
            write_text(writer, texts[k].name, i, (const char *)&row[i] + texts[k].offset);
        }
        for (int c = 0; c < N_COLUMNS; c++) write_number(writer, &columns[c], i, value_of(&columns[c], &row[i]));
    }
    for (int c = 0; c < N_OF_REFERENCE; c++) {
        write_number(writer, &of_reference[c], 0, value_of(&of_reference[c], reference));
    }
}

enum status compare_file_write(const char *path, const struct case_values *values,
                               const struct compare_file_reference *reference, int n,
                               const struct compare_file_row *row, const char *command) {
    struct netcdf_writer writer;
    TRY(netcdf_create(&writer, path, values->name, command));
    define(&writer, values, n);
    write_all(&writer, reference, n, row);
    const enum status status = netcdf_publish(&writer, true);
    const enum status finished = netcdf_finish(&writer);
    return status == STATUS_OK ? finished : status;
}

// ---- reading

static enum status read_row(const struct netcdf_reader *reader, size_t i, struct compare_file_row *row) {
    for (int k = 0; k < N_TEXTS; k++) {
        const size_t room = (k == METHOD ? sizeof row->method : sizeof row->status) - 1;
        const struct netcdf_slice slice[] = {{"run", i, 1}, {"text", 0, room}, {NULL}};
        TRY(netcdf_read_text(reader, texts[k].name, slice, (char *)row + texts[k].offset));
    }
    const struct netcdf_slice slice[] = {{"run", i, 1}, {NULL}};
    for (int c = 0; c < N_COLUMNS; c++) {
        TRY(netcdf_read_doubles(reader, columns[c].name, slice, (double *)((char *)row + columns[c].offset)));
    }
    return STATUS_OK;
}

static enum status read_all(const struct netcdf_reader *reader, struct compare_file_reference *reference, int *n,
                            struct compare_file_row **row) {
    size_t n_rows, n_text;
    TRY(netcdf_read_length(reader, "run", 1, 1000000, &n_rows));
    TRY(netcdf_read_length(reader, "text", TEXT_BYTES, TEXT_BYTES, &n_text));
    *n = (int)n_rows;
    *row = calloc(n_rows, sizeof **row);
    if (!*row) return status_fail(STATUS_MEMORY, "%s: out of memory while reading", reader->path);
    for (size_t i = 0; i < n_rows; i++) TRY(read_row(reader, i, &(*row)[i]));
    const struct netcdf_slice slice[] = {{NULL}};
    for (int c = 0; c < N_OF_REFERENCE; c++) {
        TRY(netcdf_read_doubles(reader, of_reference[c].name, slice,
                                (double *)((char *)reference + of_reference[c].offset)));
    }
    return STATUS_OK;
}

enum status compare_file_read(const char *path, struct compare_file_reference *reference, int *n,
                              struct compare_file_row **row) {
    *row = NULL;
    struct netcdf_reader reader;
    TRY(netcdf_open(&reader, path));
    const enum status status = read_all(&reader, reference, n, row);
    netcdf_close(&reader);
    if (status == STATUS_OK) return STATUS_OK;
    free(*row);
    *row = NULL;
    return status;
}
