/* steady_json.c: see steady_json.h. */
#include "result/steady_json.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>

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

enum status steady_json(const struct netcdf_reader *reader, FILE *stream) {
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
