/* result_json.c: see result_json.h. */
#include "result/result_json.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/text.h"
#include "result/result_reader.h"

/* A number; JSON has none that is not finite. */
static void print_number(double value, FILE *stream) {
    struct text text = {0};
    text_add_number(&text, value);
    fputs(isfinite(value) && text.text ? text.text : "null", stream);
    text_free(&text);
}

/* Lists of the values, the last index the fastest. */
static void print_list(const struct netcdf_slice *slice, const double **value, FILE *stream) {
    if (!slice->dimension) {
        print_number(*(*value)++, stream);
        return;
    }

    fputc('[', stream);
    for (size_t i = 0; i < slice->n; i++) {
        if (i > 0) fputs(", ", stream);
        print_list(slice + 1, value, stream);
    }

    fputc(']', stream);
}

static size_t used_multipliers(size_t n, const double *value) {
    while (n > 0 && isnan(value[2 * n - 2])) n--;
    return n;
}

static enum status print_variable(const struct netcdf_reader *reader, const struct result_variable *variable,
                                  FILE *stream) {
    struct netcdf_slice slice[RESULT_MAX_DIMENSIONS + 1] = {{NULL, 0, 0}};
    size_t size = 1;

    for (int d = 0; variable->dimension[d] != NONE; d++) {
        slice[d].dimension = result_table_dimension(variable->dimension[d]);
        TRY(netcdf_read_length(reader, slice[d].dimension, 1, INT_MAX, &slice[d].n));
        size *= slice[d].n;
    }

    double *const values = calloc(size, sizeof *values);
    if (!values) return status_fail(STATUS_MEMORY, "%s: out of memory while reading", reader->path);
    const enum status status = netcdf_read_doubles(reader, variable->name, slice, values);

    if (status == STATUS_OK) {
        if (variable->dimension[0] == MULTIPLIER) slice[0].n = used_multipliers(slice[0].n, values);
        const double *next = values;
        fprintf(stream, ",\n  \"%s\": ", variable->name);
        print_list(slice, &next, stream);
    }

    free(values);
    return status;
}

static enum status print_names(const struct netcdf_reader *reader, FILE *stream) {
    size_t n_fish;
    TRY(netcdf_read_length(reader, "fish", 1, INT_MAX, &n_fish));
    fputs(",\n  \"fish_name\": [", stream);

    for (size_t f = 0; f < n_fish; f++) {
        char *name;
        TRY(result_reader_name(reader, f, &name));
        if (f > 0) fputs(", ", stream);
        text_print_json(stream, name);
        free(name);
    }

    fputc(']', stream);
    return STATUS_OK;
}

enum status result_json_steady(const struct netcdf_reader *reader, FILE *stream) {
    fputs("{\"file\": ", stream);
    text_print_json(stream, reader->path);
    TRY(print_names(reader, stream));

    for (int i = 0; i < result_table_n; i++) {
        const struct result_variable *const variable = &result_table[i];
        if (variable->of_steady && netcdf_has(reader, variable->name)) TRY(print_variable(reader, variable, stream));
    }

    fputs("}\n", stream);
    return STATUS_OK;
}

// ---- the summary of a file

enum { MAX_VALUES = 100000 /* of a variable in a summary */ };

/* A member of an object: an attribute of the file. */
static enum status print_attribute(const struct netcdf_reader *reader, const char *name, const char *attribute,
                                   FILE *stream) {
    char *text;
    TRY(netcdf_read_string(reader, attribute, &text));
    fprintf(stream, ",\n  \"%s\": ", name);
    text_print_json(stream, text);
    free(text);
    return STATUS_OK;
}

/* The lines of an attribute as a list. */
static enum status print_lines(const struct netcdf_reader *reader, const char *attribute, FILE *stream) {
    char *text;
    TRY(netcdf_read_string(reader, attribute, &text));
    fprintf(stream, ",\n  \"%s\": [", attribute);
    const char *before = "";
    for (char *line = strtok(text, "\n"); line; line = strtok(NULL, "\n")) {
        fputs(before, stream);
        text_print_json(stream, line);
        before = ", ";
    }
    fputc(']', stream);
    free(text);
    return STATUS_OK;
}

/* The part of a variable in a summary: the last row; slice[0].dimension is NULL if the variable is left out. */
static size_t choose_part(const struct netcdf_shape *shape, struct netcdf_slice slice[NETCDF_MAX_DIMENSIONS + 1]) {
    static const char *const detailed[] = {"node", "edge", "joint", "sheet", "control", "vortex", "x", "y"};
    size_t n = *shape->name != '\0';
    for (int d = 0; d < shape->n_dimensions && n > 0; d++) {
        const int is_row = strcmp(shape->dimension[d], "time") == 0;
        if (is_row && shape->length[d] == 0) return 0;
        slice[d] = (struct netcdf_slice){shape->dimension[d], is_row ? shape->length[d] - 1 : 0,
                                         is_row ? 1 : shape->length[d]};
        for (size_t i = 0; i < sizeof detailed / sizeof *detailed; i++) {
            if (strcmp(shape->dimension[d], detailed[i]) == 0) return 0;
        }
        if (slice[d].n > MAX_VALUES / n) return 0;
        n *= slice[d].n;
    }
    slice[shape->n_dimensions] = (struct netcdf_slice){NULL, 0, 0};
    return n;
}

/* Strings: the last dimension holds the characters. */
static enum status print_strings(const struct netcdf_reader *reader, const struct netcdf_shape *shape,
                                 const struct netcdf_slice *slice, size_t n, FILE *stream) {
    char *text = NULL, *string = NULL;
    const size_t length = slice[shape->n_dimensions - 1].n;
    enum status status = MEMORY_NEW(text, n + 1, shape->name);
    if (status == STATUS_OK) status = MEMORY_NEW(string, length + 1, shape->name);
    if (status == STATUS_OK) status = netcdf_read_text(reader, shape->name, slice, text);

    for (size_t i = 0; i < n / length && status == STATUS_OK; i++) {
        memcpy(string, text + i * length, length);
        string[length] = '\0';
        fputs(i == 0 ? "[" : ", ", stream);
        text_print_json(stream, string);
    }
    if (status == STATUS_OK) fputc(']', stream);
    free(text);
    free(string);
    return status;
}

static enum status print_part(const struct netcdf_reader *reader, const struct netcdf_shape *shape, FILE *stream) {
    struct netcdf_slice slice[NETCDF_MAX_DIMENSIONS + 1] = {{NULL, 0, 0}};
    const size_t n = choose_part(shape, slice);
    if (n == 0 || (shape->is_text && shape->n_dimensions == 0)) return STATUS_OK;
    fprintf(stream, ",\n  \"%s\": ", shape->name);
    if (shape->is_text) return print_strings(reader, shape, slice, n, stream);

    double *values;
    TRY(MEMORY_NEW(values, n, shape->name));
    const enum status status = netcdf_read_doubles(reader, shape->name, slice, values);
    if (status == STATUS_OK) {
        const double *next = values;
        print_list(slice + (slice->dimension && strcmp(slice->dimension, "time") == 0), &next, stream);
    }
    free(values);
    return status;
}

enum status result_json_summary(const struct netcdf_reader *reader, const char *kind, FILE *stream) {
    fputs("{\"file\": ", stream);
    text_print_json(stream, reader->path);
    fprintf(stream, ",\n  \"kind\": \"%s\"", kind);
    TRY(print_attribute(reader, "case", "title", stream));
    TRY(print_attribute(reader, "program", "source", stream));
    TRY(print_attribute(reader, "history", "history", stream));
    if (strcmp(kind, "run") == 0) {
        TRY(print_attribute(reader, "status", "run_status", stream));
        TRY(print_lines(reader, "warnings", stream));
        fprintf(stream, ",\n  \"rows\": %zu", reader->n_rows);
    }

    struct netcdf_shape shape;
    for (int i = 0; netcdf_read_shape(reader, i, &shape); i++) TRY(print_part(reader, &shape, stream));
    fputs("}\n", stream);
    return STATUS_OK;
}
