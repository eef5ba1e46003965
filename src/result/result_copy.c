/* result_copy.c: row by row, variable by variable. */
#include "result/result_copy.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct copying {
    const struct result_source *source;
    const struct result_target *target;
    struct netcdf_reader reader;
    size_t n_vortices; /* slots in the file that is read */
    double *read;      /* one row of the largest variable there */
};

/* The number of values of a variable per row and fish; to_read: with the vortices of the source only. */
static size_t n_of_fish(const struct copying *copying, const struct result_variable *variable, bool to_read) {
    size_t n = 1;
    for (const enum result_dimension *d = variable->dimension; *d != NONE; d++) {
        if (*d == TIME || *d == FISH) continue;
        n *= to_read && *d == VORTEX ? copying->n_vortices : copying->target->length[*d];
    }
    return n;
}

static enum status read_row(const struct copying *copying, const struct result_variable *variable, long row) {
    struct netcdf_slice slice[RESULT_MAX_DIMENSIONS + 1] = {0};
    for (int d = 0; variable->dimension[d] != NONE; d++) {
        const enum result_dimension dimension = variable->dimension[d];
        slice[d].dimension = result_table_dimension(dimension);
        slice[d].first = dimension == TIME ? (size_t)row : 0;
        slice[d].n = dimension == VORTEX ? copying->n_vortices : copying->target->length[dimension];
    }
    return netcdf_read_doubles(&copying->reader, variable->name, slice, copying->read);
}

static void write_row(const struct copying *copying, int i, long row) {
    const struct result_variable *const variable = &result_table[i];
    const struct result_target *const target = copying->target;
    size_t start[RESULT_MAX_DIMENSIONS] = {(size_t)row}, count[RESULT_MAX_DIMENSIONS];
    for (int d = 0; variable->dimension[d] != NONE; d++) count[d] = target->length[variable->dimension[d]];
    netcdf_write_doubles(target->writer, target->number[i], start, count, target->buffer);
}

static enum status copy_row(const struct copying *copying, int i, long row) {
    const struct result_variable *const variable = &result_table[i];
    const struct result_source *const source = copying->source;
    const size_t from = n_of_fish(copying, variable, true), to = n_of_fish(copying, variable, false);
    const size_t n_fish = result_table_has(variable, FISH) ? copying->target->length[FISH] : 1;
    const bool drop = source->drop_last_wake && row == source->n_rows - 1 && result_table_has(variable, VORTEX);
    TRY(read_row(copying, variable, row));
    for (size_t k = 0; k < n_fish * to; k++) copying->target->buffer[k] = NAN;
    for (size_t f = 0; f < n_fish && !drop; f++) {
        memcpy(copying->target->buffer + f * to, copying->read + f * from, (from < to ? from : to) * sizeof(double));
    }
    write_row(copying, i, row);
    return STATUS_OK;
}

static enum status copy_all(struct copying *copying) {
    const struct result_target *const target = copying->target;
    TRY(netcdf_read_length(&copying->reader, result_table_dimension(VORTEX), 1, SIZE_MAX / 64, &copying->n_vortices));
    size_t most = 1;

    for (int i = 0; i < result_table_n; i++) {
        const size_t n = n_of_fish(copying, &result_table[i], true) * target->length[FISH];
        if (n > most) most = n;
    }

    copying->read = calloc(most, sizeof *copying->read);
    if (!copying->read) return status_fail(STATUS_MEMORY, "%s: out of memory while reading", copying->source->path);

    for (long row = 0; row < copying->source->n_rows; row++) {
        for (int i = 0; i < result_table_n; i++) {
            const struct result_variable *const variable = &result_table[i];
            if (variable->forces > target->forces || !result_table_has(variable, TIME)) continue;
            TRY(copy_row(copying, i, row));
        }
    }

    return STATUS_OK;
}

enum status result_copy_rows(const struct result_source *source, const struct result_target *target) {
    struct copying copying = {.source = source, .target = target};
    TRY(netcdf_open(&copying.reader, source->path));
    const enum status status = copy_all(&copying);
    netcdf_close(&copying.reader);
    free(copying.read);
    return status;
}
