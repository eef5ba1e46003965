/* result_reader.c: reads the file of a run, looping over the table of variables. */
#include "result/result_reader.h"

#include <math.h>
#include <string.h>

enum { MAX_LENGTH = 100000000 /* of a dimension */ };

static const struct result_variable *reader_find_variable(const char *name) {
    const struct result_variable *variable = result_table;
    while (strcmp(variable->name, name) != 0) variable++;
    return variable;
}

// ---- the file

/* The counts of a variable over the fish, each from min to max. */
static enum status read_counts(struct arena *arena, const struct result_reader *reader, const char *name, size_t min,
                               size_t max, int **counts) {
    const double *const values = reader->scratch;
    TRY(result_reader_row(reader, name, 0, reader->scratch));
    NEW(arena, *counts, reader->length[FISH]);

    for (size_t f = 0; f < reader->length[FISH]; f++) {
        if (!(values[f] >= (double)min && values[f] <= (double)max)) {
            return status_fail(STATUS_FILE, "%s: variable %s has an invalid value, %g, for a fish", reader->file.path,
                               name, values[f]);
        }
        (*counts)[f] = (int)values[f];
    }

    return STATUS_OK;
}

enum status result_reader_check(const struct netcdf_reader *file) {
    const char *const path = file->path;
    int schema, study;
    TRY(netcdf_read_integer(file, "shoal_schema", 0, &schema));
    TRY(netcdf_read_integer(file, "shoal_study", 0, &study));
    if (schema != RESULT_SCHEMA && schema != 0) {
        return status_fail(
            STATUS_FILE,
            "%s: written in schema %d, but this program reads schema %d: use the program that wrote the file", path,
            schema, RESULT_SCHEMA);
    }
    if (schema == 0 && study != 0) {
        return status_fail(STATUS_FILE, "%s: the file of a study: give the file of one run, such as member-0000.nc",
                           path);
    }
    return schema == 0 ? status_fail(STATUS_FILE, "%s: not the result of a run", path) : STATUS_OK;
}

enum status result_reader_open(struct arena *arena, struct result_reader **opened, const char *path) {
    struct result_reader *reader;
    NEW(arena, reader, 1);
    *opened = reader;
    TRY(netcdf_open(arena, &reader->file, path));
    TRY(result_reader_check(&reader->file));

    // the dimensions
    for (enum result_dimension d = TIME; d < MULTIPLIER; d++) {
        TRY(netcdf_read_length(&reader->file, result_table_dimension(d), d == XY ? 2 : 0, d == XY ? 2 : MAX_LENGTH,
                               &reader->length[d]));
    }
    const size_t n_missing = reader->file.n_missing;
    if (reader->length[TIME] == 0 || reader->length[FISH] == 0) {
        if (n_missing == 0) return status_fail(STATUS_FILE, "%s: the run has not written a row yet", path);
        return status_fail(STATUS_FILE, "%s: none of the %zu rows is complete: copy the file again", path, n_missing);
    }
    TRY(netcdf_attribute(&reader->file, "title", &reader->title));
    TRY(netcdf_attribute(&reader->file, "run_status", &reader->run_status));

    // most files have no walls
    if (netcdf_has(&reader->file, "wall_y")) {
        TRY(netcdf_read_length(&reader->file, result_table_dimension(WALL), 1, 2, &reader->length[WALL]));
        TRY(result_reader_row(reader, "wall_y", 0, reader->wall_y));
    }

    // name, fish.body.section and fish.force of each fish
    const size_t n_fish = reader->length[FISH];
    NEW(arena, reader->scratch, 2 * n_fish);
    NEW(arena, reader->name, n_fish);
    NEW(arena, reader->has_mean_section, n_fish);
    double *const section = reader->scratch, *const force = section + n_fish;
    TRY(result_reader_row(reader, "mean_section", 0, section));
    TRY(result_reader_row(reader, "fluid_force", 0, force));
    for (size_t f = 0; f < n_fish; f++) {
        TRY(result_reader_name(&reader->file, f, &reader->name[f]));
        reader->has_mean_section[f] = fabs(section[f] - 1) < 0.5;
        reader->has_pressure |= fabs(force[f] - FORCE_PRESSURE) < 0.5;
    }

    // earlier files have wakes of one lifetime
    NEW(arena, reader->wake_part, n_fish);
    for (size_t f = 0; f < n_fish; f++) reader->wake_part[f] = 1;
    if (netcdf_has(&reader->file, "wake_part")) TRY(result_reader_row(reader, "wake_part", 0, reader->wake_part));

    // an outline needs the edges between the nodes
    const size_t n_nodes = reader->length[NODE], n_edges = reader->length[EDGE];
    TRY(read_counts(arena, reader, "n_nodes", 4, n_edges < n_nodes ? n_edges + 1 : n_nodes, &reader->n_nodes));
    return read_counts(arena, reader, "n_sheet", 1, reader->length[SHEET], &reader->n_sheet);
}

// ---- values

enum status result_reader_name(const struct netcdf_reader *file, size_t f, char **name) {
    size_t n;
    TRY(netcdf_read_length(file, "name", 1, MAX_LENGTH, &n));
    NEW(file->arena, *name, n + 1);
    return netcdf_read_text(file, "fish", (struct netcdf_slice[]){{"fish", f, 1}, {"name", 0, n}, {NULL}}, *name);
}

size_t result_reader_n(const struct result_reader *reader, const char *name) {
    size_t n = 1;
    for (const enum result_dimension *d = reader_find_variable(name)->dimension; *d != NONE; d++)
        if (*d != TIME) n *= reader->length[*d];
    return n;
}

enum status result_reader_row(const struct result_reader *reader, const char *name, size_t row, double *values) {
    struct netcdf_slice slice[RESULT_MAX_DIMENSIONS + 1] = {0};
    const enum result_dimension *const dimension = reader_find_variable(name)->dimension;

    for (int d = 0; dimension[d] != NONE; d++) {
        slice[d] = (struct netcdf_slice){result_table_dimension(dimension[d]), 0, reader->length[dimension[d]]};
        if (dimension[d] != TIME) continue;
        slice[d].first = row;
        slice[d].n = 1;
    }

    return netcdf_read_doubles(&reader->file, name, slice, values);
}

enum status result_reader_new(struct arena *arena, const struct result_reader *reader, const char *name, size_t row,
                              double **values) {
    NEW(arena, *values, result_reader_n(reader, name) + 1);
    return result_reader_row(reader, name, row, *values);
}

enum status result_reader_has_wake(const struct result_reader *reader, size_t row, bool *has_wake) {
    const size_t n_fish = reader->length[FISH];
    double *const count = reader->scratch, *const first = count + n_fish;
    const struct netcdf_slice slice[] = {{"time", row, 1}, {"fish", 0, n_fish}, {"vortex", 0, 1}, {NULL}};
    TRY(result_reader_row(reader, "wake_count", row, count));
    TRY(netcdf_read_doubles(&reader->file, "wake_circulation", slice, first));
    *has_wake = true;
    for (size_t f = 0; *has_wake && f < n_fish; f++) *has_wake = count[f] == 0 || isfinite(first[f]);
    return STATUS_OK;
}
