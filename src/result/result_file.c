/* result_file.c: writing the file of a run, variable by variable of the table. */
#include "result/result_file.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>
#include <unistd.h>
#include <zlib.h>

#include "base/memory.h"
#include "result/netcdf.h"
#include "result/target.h"
#include "school/warnings.h"

// ---- copy values from the structs of a run to the slots of an array

void result_values_lengths(const struct school *school, int n_vortices, size_t length[RESULT_N_DIMENSIONS]) {
    for (int d = 0; d < RESULT_N_DIMENSIONS; d++) length[d] = 1;
    length[FISH] = (size_t)school->n_fish;
    length[VORTEX] = (size_t)n_vortices;
    length[XY] = 2;
    length[SENSOR] = 0;
    length[WALL] = (size_t)school->walls.n;
    length[MULTIPLIER] = STEADY_QUANTITIES * (size_t)school->n_fish;

    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *fish = &school->fish[f];
        for (enum result_dimension d = NODE; d <= CONTROL; d++) {
            const size_t of_fish = (size_t)result_table_length(fish, d);
            if (of_fish > length[d]) length[d] = of_fish;
        }
        if ((size_t)fish->n_sensors > length[SENSOR]) length[SENSOR] = (size_t)fish->n_sensors;
        const size_t n_name = strlen(fish->name);
        if (n_name > length[NAME]) length[NAME] = n_name;
    }
}

size_t result_values_n(const struct result_variable *variable, const size_t *length) {
    size_t n = 1;
    for (const enum result_dimension *d = variable->dimension; *d != NONE; d++) n *= length[*d];
    return n;
}

size_t result_values_size(enum result_type type) {
    switch (type) {
        case RESULT_INTEGER: return sizeof(int);
        case RESULT_COUNT: return sizeof(long);
        case RESULT_TEXT: return sizeof(char);
        default: return sizeof(double);
    }
}

/* Write the n_slots values of the school or of fish f. */
static void fill_slots(const struct result_variable *variable, const struct result_row *row, int f, size_t n_slots,
                       void *slots) {
    if (variable->gather) {
        variable->gather(row, f, slots);
        return;
    }

    const char *value = result_table_owner(row, variable->owner, f);
    if (!value) return;
    value += variable->offset;
    size_t n = n_slots;

    if (variable->is_pointer) {
        memcpy(&value, value, sizeof(const char *));
        const enum result_dimension last = variable->dimension[1];
        n = last == NAME ? strlen(value) : (size_t)result_table_length(&row->school->fish[f], last);
    }

    if (n > 0) memcpy(slots, value, n * result_values_size(variable->type));
}

void result_values_fill(const struct result_variable *variable, const size_t *length, const struct result_row *row,
                        void *buffer) {
    const size_t n = result_values_n(variable, length), size = result_values_size(variable->type);
    memset(buffer, 0, n * size);
    if (variable->type == RESULT_REAL || variable->type == RESULT_BULK) {
        for (size_t k = 0; k < n; k++) ((double *)buffer)[k] = NAN;
    }
    const size_t n_fish = result_table_has(variable, FISH) ? length[FISH] : 1;
    const size_t n_owners = variable->owner == OF_AXIS ? length[XY] : n_fish, n_slots = n / n_owners;
    for (size_t f = 0; f < n_owners; f++) {
        fill_slots(variable, row, (int)f, n_slots, (char *)buffer + f * n_slots * size);
    }
}

// ---- row by row, variable by variable

/* The target: for each variable of the table the number, presence in the file and lengths, and a buffer for one row of
 * any variable. */
struct result_target {
    struct netcdf_writer *writer;
    const int *number;
    enum output_forces forces;
    const size_t *length;
    double *buffer;
};

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

static enum status copy_row(const struct copying *copying, int i, long row) {
    const struct result_variable *const variable = &result_table[i];
    const struct result_source *const source = copying->source;
    const size_t from = n_of_fish(copying, variable, true), to = n_of_fish(copying, variable, false);
    const size_t n_fish = result_table_has(variable, FISH) ? copying->target->length[FISH] : 1;
    const bool drop = source->drop_last_wake && row == source->n_rows - 1 && result_table_has(variable, VORTEX);

    // read the row
    struct netcdf_slice slice[RESULT_MAX_DIMENSIONS + 1] = {0};
    for (int d = 0; variable->dimension[d] != NONE; d++) {
        const enum result_dimension dimension = variable->dimension[d];
        slice[d].dimension = result_table_dimension(dimension);
        slice[d].first = dimension == TIME ? (size_t)row : 0;
        slice[d].n = dimension == VORTEX ? copying->n_vortices : copying->target->length[dimension];
    }
    TRY(netcdf_read_doubles(&copying->reader, variable->name, slice, copying->read));

    for (size_t k = 0; k < n_fish * to; k++) copying->target->buffer[k] = NAN;
    for (size_t f = 0; f < n_fish && !drop; f++) {
        memcpy(copying->target->buffer + f * to, copying->read + f * from, (from < to ? from : to) * sizeof(double));
    }

    // write the row
    const struct result_target *const target = copying->target;
    size_t start[RESULT_MAX_DIMENSIONS] = {(size_t)row}, count[RESULT_MAX_DIMENSIONS];
    for (int d = 0; variable->dimension[d] != NONE; d++) count[d] = target->length[variable->dimension[d]];
    netcdf_write_doubles(target->writer, target->number[i], start, count, target->buffer);

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

    TRY(MEMORY_NEW(copying->read, most, copying->source->path));

    for (long row = 0; row < copying->source->n_rows; row++) {
        for (int i = 0; i < result_table_n; i++) {
            const struct result_variable *const variable = &result_table[i];
            if (variable->forces > target->forces || !result_table_has(variable, TIME)) continue;
            if (result_table_has(variable, SENSOR) && target->length[SENSOR] == 0) continue;
            TRY(copy_row(copying, i, row));
        }
    }

    return STATUS_OK;
}

/* Copy all rows. Fails with STATUS_FILE or STATUS_MEMORY if rows cannot be read; the writer stores failures of writing.
 * */
static enum status result_copy_rows(const struct result_source *source, const struct result_target *target) {
    struct copying copying = {.source = source, .target = target};
    TRY(netcdf_open(&copying.reader, source->path));
    const enum status status = copy_all(&copying);
    netcdf_close(&copying.reader);
    free(copying.read);
    return status;
}

// ---- the checksum of a result file's bytes, brought up to date as the file grows

enum { BLOCK = 1 << 16 };

// add the bytes of a file up to a place; errno or 0
static int add_bytes(int descriptor, uint64_t begin, uint64_t end, struct result_checksum *checksum) {
    unsigned char block[BLOCK];
    if (checksum->done == 0) *checksum = (struct result_checksum){begin, (uint32_t)crc32_z(0, NULL, 0)};

    while (checksum->done < end) {
        const uint64_t left = end - checksum->done;
        const ssize_t n = pread(descriptor, block, left < BLOCK ? (size_t)left : BLOCK, (off_t)checksum->done);
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) return n < 0 ? errno : EIO;
        checksum->value = (uint32_t)crc32_z(checksum->value, block, (size_t)n);
        checksum->done += (uint64_t)n;
    }

    return 0;
}

enum status result_mark_take(const char *path, long n_rows, struct result_checksum *checksum,
                             struct result_mark *mark) {
    struct netcdf_rows rows;
    TRY(netcdf_read_rows(path, &rows));

    if (rows.bytes == 0 || n_rows < 0 || rows.n < (uint64_t)n_rows) {
        return status_fail(STATUS_FILE, "%s: has %llu rows, but the checkpoint requires %ld", path,
                           (unsigned long long)rows.n, n_rows);
    }

    const int descriptor = open(path, O_RDONLY | O_CLOEXEC);
    int code = descriptor < 0 ? errno : 0;

    if (code == 0) {
        code = add_bytes(descriptor, rows.begin, rows.begin_of_rows + (uint64_t)n_rows * rows.bytes, checksum);
        close(descriptor);
    }

    *mark = (struct result_mark){n_rows, checksum->value};
    return code == 0 ? STATUS_OK : status_fail(STATUS_FILE, "%s: cannot be read: %s", path, strerror(code));
}

// Read the case and the run_status of a result.
static enum status check_attributes(const char *path, const char *effective, int *is_complete) {
    struct netcdf_reader reader;
    char *found = NULL, *run_status = NULL;
    TRY(netcdf_open(&reader, path));
    enum status status = netcdf_read_string(&reader, "case_effective", &found);
    if (status == STATUS_OK) status = netcdf_read_string(&reader, "run_status", &run_status);
    const size_t n_missing = reader.n_missing;
    netcdf_close(&reader);

    if (status == STATUS_OK) {
        *is_complete = strcmp(run_status, "complete") == 0 && n_missing == 0;
        if (strcmp(found, effective) != 0) {
            status = status_fail(STATUS_FILE, "%s is the result of another case than the checkpoint", path);
        }
    }

    free(found);
    free(run_status);
    return status;
}

enum status result_mark_check(const char *path, const struct result_mark *mark, const char *effective,
                              struct result_checksum *checksum, int *is_complete) {
    struct result_mark found;
    TRY(check_attributes(path, effective, is_complete));
    *checksum = (struct result_checksum){0};
    TRY(result_mark_take(path, mark->n_rows, checksum, &found));
    if (found.check == mark->check) return STATUS_OK;
    return status_fail(STATUS_FILE, "%s: the rows do not match the checkpoint: changed or damaged since", path);
}

/* Reserved bytes of attributes that are rewritten in place without moving the rest of the file. */
enum { STATUS_LENGTH = 256, MAX_NOTE_LENGTH = N_WARNINGS * WARNING_BYTES };

static const struct note {
    const char *name;
    size_t length;
} notes[] = {
    [RESULT_WARNINGS] = {"warnings", MAX_NOTE_LENGTH},
    [RESULT_CLOSEST_APPROACH] = {"closest_approach", 256},
    [RESULT_MERGED] = {"merged_vortices", 128},
    [RESULT_CHECKPOINT_AT] = {"checkpoint_at", 1024},
};
enum { N_NOTES = sizeof notes / sizeof *notes };

struct result_file {
    struct netcdf_writer writer;
    bool overwrite;                     /* when the file is published */
    size_t length[RESULT_N_DIMENSIONS]; /* of the dimensions; 1 for TIME, as one row is written at a time */
    int *number;                        /* of the variables in the file                (result_table_n) */
    enum output_forces forces;          /* variables of the table in the file */
    bool is_steady;                     /* the file has the variables of a steady state */
    size_t n_rows;
    struct result_checksum checksum; /* of the rows that were marked last */
    double *buffer;                  /* one row, or the whole, of the largest variable */
};

// ---- the header

/* True if a variable is in the file. */
static bool file_is_written(const struct result_file *result, const struct result_variable *variable) {
    if (result_table_has(variable, WALL) && result->length[WALL] == 0) return false;
    if (result_table_has(variable, SENSOR) && result->length[SENSOR] == 0) return false;
    return variable->forces <= result->forces && (result->is_steady || !variable->of_steady);
}

static enum netcdf_type type_in_file(enum result_type type, enum precision precision) {
    switch (type) {
        case RESULT_BULK: return precision == PRECISION_SINGLE ? NETCDF_FLOAT : NETCDF_DOUBLE;
        case RESULT_INTEGER: return NETCDF_INT;
        case RESULT_COUNT: return NETCDF_INT64;
        case RESULT_TEXT: return NETCDF_TEXT;
        default: return NETCDF_DOUBLE;
    }
}

/* Write an attribute into the reserved space; a longer string is cut. */
static void write_fixed(struct result_file *result, const char *name, size_t length, const char *text) {
    char bytes[MAX_NOTE_LENGTH] = {0};
    snprintf(bytes, length, "%s", text);
    netcdf_write_bytes(&result->writer, NETCDF_GLOBAL, name, length, bytes);
}

/* Set run_status to "running" in a file without a writer: a file with rows removed must never be marked complete. */
static enum status patch_run_status(const char *path) {
    const char bytes[STATUS_LENGTH] = "running";
    return netcdf_patch(path, "run_status", STATUS_LENGTH, bytes);
}

static void write_run_status(struct result_file *result, const char *run_status) {
    write_fixed(result, "run_status", STATUS_LENGTH, run_status);
}

void result_file_note(struct result_file *result, enum result_note note, const char *text) {
    write_fixed(result, notes[note].name, notes[note].length, text);
}

/* The variables that name the slots of another one. */
static const char *coordinates_of(const struct result_variable *variable) {
    if (result_table_has(variable, NODE) && strcmp(variable->name, "node_arc") != 0) return "fish_name node_arc";
    if (result_table_has(variable, SHEET) && strcmp(variable->name, "sheet_arc") != 0) return "fish_name sheet_arc";
    if (result_table_has(variable, CONTROL) && strcmp(variable->name, "control_arc") != 0) {
        return "fish_name control_arc";
    }
    if (result_table_has(variable, SENSOR) && strcmp(variable->name, "sensor_place") != 0) {
        return "fish_name sensor_place";
    }
    return "fish_name";
}

static void file_define_variable(struct result_file *result, int i, const int *dimension_number,
                                 enum precision precision) {
    const struct result_variable *const variable = &result_table[i];
    const bool of_fish = result_table_has(variable, FISH), is_text = variable->type == RESULT_TEXT;
    struct netcdf_variable to_define = {.name = variable->name,
                                        .long_name = variable->long_name,
                                        .units = variable->unit,
                                        .type = type_in_file(variable->type, precision)};
    for (const enum result_dimension *d = variable->dimension; *d != NONE; d++)
        to_define.dimension[to_define.n_dimensions++] = dimension_number[*d];
    to_define.has_gaps = of_fish && (to_define.type == NETCDF_DOUBLE || to_define.type == NETCDF_FLOAT);
    result->number[i] = netcdf_define_variable(&result->writer, &to_define);
    if (of_fish && !is_text)
        netcdf_write_string(&result->writer, result->number[i], "coordinates", coordinates_of(variable));
}

/* The attributes; the text of the case makes a result repeatable. */
static void write_attributes(struct result_file *result, const struct case_values *values, const char *effective) {
    struct netcdf_writer *const writer = &result->writer;
    netcdf_write_integer(writer, NETCDF_GLOBAL, "shoal_schema", RESULT_SCHEMA);
    write_run_status(result, "running");
    for (int i = 0; i < N_NOTES; i++) result_file_note(result, (enum result_note)i, "");
    netcdf_write_string(writer, NETCDF_GLOBAL, "case_text", values->text);

    if (values->study) {
        netcdf_write_string(writer, NETCDF_GLOBAL, "study_case", values->study);
        netcdf_write_integer(writer, NETCDF_GLOBAL, "study_member", values->member);
    }

    netcdf_write_string(writer, NETCDF_GLOBAL, "case_effective", effective);
}

static void file_define_all(struct result_file *result, const struct case_values *values, const char *effective) {
    int dimension_number[RESULT_N_DIMENSIONS] = {0};
    for (enum result_dimension d = TIME; d < RESULT_N_DIMENSIONS; d++) {
        if ((d == MULTIPLIER && !result->is_steady) || (d != TIME && result->length[d] == 0)) continue;
        dimension_number[d] =
            netcdf_define_dimension(&result->writer, result_table_dimension(d), d == TIME ? 0 : result->length[d]);
    }

    for (int i = 0; i < result_table_n; i++) {
        if (!file_is_written(result, &result_table[i])) continue;
        file_define_variable(result, i, dimension_number, values->output.precision);
    }

    write_attributes(result, values, effective);
    netcdf_end_definitions(&result->writer);
}

// ---- values

/* Write the whole of a constant, or the next row of a variable with time. */
static void write_variable(struct result_file *result, int i, const struct result_row *row) {
    const struct result_variable *variable = &result_table[i];
    result_values_fill(variable, result->length, row, result->buffer);
    size_t start[RESULT_MAX_DIMENSIONS] = {0}, count[RESULT_MAX_DIMENSIONS];
    for (int d = 0; variable->dimension[d] != NONE; d++) count[d] = result->length[variable->dimension[d]];
    if (result_table_has(variable, TIME)) start[0] = result->n_rows;
    struct netcdf_writer *const writer = &result->writer;
    const int number = result->number[i];
    const void *const values = result->buffer;

    switch (variable->type) {
        case RESULT_INTEGER: netcdf_write_ints(writer, number, start, count, values); break;
        case RESULT_COUNT: netcdf_write_longs(writer, number, start, count, values); break;
        case RESULT_TEXT: netcdf_write_text(writer, number, start, count, values); break;
        default: netcdf_write_doubles(writer, number, start, count, values);
    }
}

/* Write all constants, or all of a row. */
static void write_variables(struct result_file *result, bool with_time, const struct result_row *row) {
    for (int i = 0; i < result_table_n; i++) {
        const struct result_variable *const variable = &result_table[i];
        if (!file_is_written(result, variable) || result_table_has(variable, TIME) != with_time) continue;
        write_variable(result, i, row);
    }
}

// ---- the life of a result file

static void result_release(struct result_file *result) {
    if (!result) return;
    free(result->number);
    free(result->buffer);
    free(result);
}

/* A result without a file yet. */
static enum status result_allocate(struct result_file **new, const struct school *school, long n_events) {
    struct result_file *result;
    TRY(MEMORY_NEW(result, 1, "a result file"));
    result_values_lengths(school, wake_most(school, n_events), result->length);
    size_t max = 1;

    for (int i = 0; i < result_table_n; i++) {
        const size_t n = result_values_n(&result_table[i], result->length);
        if (n > max) max = n;
    }

    enum status status = MEMORY_NEW(result->number, result_table_n, "a result file");
    if (status == STATUS_OK) status = MEMORY_NEW(result->buffer, max, "a result file");
    if (status == STATUS_OK) {
        *new = result;
    } else {
        result_release(result);
    }
    return status;
}

/* The arguments of a new file. */
struct origin {
    const char *path;
    int overwrite;
    const struct case_values *values;
    const char *effective, *command;
    const struct school *school;
    const struct result_source *source; /* first rows of the file; NULL: none */
    bool is_steady;
};

static enum status copy_rows(struct result_file *result, const struct result_source *source) {
    const struct result_target target = {&result->writer, result->number, result->forces, result->length,
                                         result->buffer};
    TRY(result_copy_rows(source, &target));
    result->n_rows = (size_t)source->n_rows;
    return STATUS_OK;
}

static enum status write_new(struct result_file *result, const struct origin *origin) {
    TRY(netcdf_create(&result->writer, origin->path, origin->values->name, origin->command));
    file_define_all(result, origin->values, origin->effective);
    write_variables(result, false, &(struct result_row){.school = origin->school});
    netcdf_sync(&result->writer, true);
    const int code = result->writer.code;
    enum status status = STATUS_OK;
    if (code != 0) {
        status = target_failed(origin->path, code, netcdf_reason(code));
    } else if (origin->source) {
        status = copy_rows(result, origin->source);
    }
    if (status != STATUS_OK) netcdf_finish(&result->writer);
    return status;
}

static enum status result_create(struct result_file **result, const struct origin *origin, long n_events) {
    *result = NULL;
    TRY(target_check(origin->path, TARGET_NETCDF, origin->overwrite));
    struct result_file *new;
    TRY(result_allocate(&new, origin->school, n_events));
    new->forces = origin->values->output.forces;
    new->is_steady = origin->is_steady;
    new->overwrite = origin->overwrite;
    const enum status status = write_new(new, origin);
    if (status == STATUS_OK) {
        *result = new;
    } else {
        result_release(new);
    }
    return status;
}

enum status result_file_create(struct result_file **result, const char *path, int overwrite,
                               const struct case_values *values, const char *effective, const char *command,
                               const struct school *school, long n_events) {
    const struct origin origin = {path, overwrite, values, effective, command, school, NULL, false};
    return result_create(result, &origin, n_events);
}

enum status result_file_create_steady(struct result_file **result, const char *path, int overwrite,
                                      const struct case_values *values, const char *effective, const char *command,
                                      const struct school *school, long n_events) {
    const struct origin origin = {path, overwrite, values, effective, command, school, NULL, true};
    return result_create(result, &origin, n_events);
}

void result_file_steady(struct result_file *result, const struct school *school, const struct steady_values *steady) {
    const struct result_row row = {.school = school, .steady = steady};
    for (int i = 0; i < result_table_n; i++) {
        if (result_table[i].of_steady) write_variable(result, i, &row);
    }
}

enum status result_file_extend(struct result_file **result, const struct result_source *source,
                               const struct case_values *values, const char *effective, const char *command,
                               const struct school *school, long n_events) {
    const struct origin origin = {source->path, 1, values, effective, command, school, source, false};
    return result_create(result, &origin, n_events);
}

enum status result_file_publish(struct result_file *result, const char *run_status) {
    write_run_status(result, run_status);
    return netcdf_publish(&result->writer, result->overwrite);
}

/* Find all variables of a file that is there. */
static enum status find_all(struct result_file *result, const char *path) {
    TRY(netcdf_continue(&result->writer, path));
    for (int i = 0; i < result_table_n; i++) {
        if (file_is_written(result, &result_table[i]))
            result->number[i] = netcdf_number(&result->writer, result_table[i].name);
    }

    const int code = result->writer.code;
    if (code == 0) return STATUS_OK;
    netcdf_finish(&result->writer);
    return status_fail(STATUS_FILE, "%s: cannot be continued: %s", path, netcdf_reason(code));
}

enum status result_file_continue(struct result_file **result, const char *path, const struct result_mark *mark,
                                 const struct result_checksum *checksum, const struct case_values *values,
                                 const struct school *school, long n_events) {
    struct netcdf_rows rows;
    *result = NULL;
    TRY(netcdf_read_rows(path, &rows));
    TRY(patch_run_status(path));
    TRY(netcdf_cut_rows(path, &rows, (uint64_t)mark->n_rows));
    struct result_file *new;
    TRY(result_allocate(&new, school, n_events));
    new->forces = values->output.forces;
    new->n_rows = (size_t)mark->n_rows;
    new->checksum = *checksum;
    const enum status status = find_all(new, path);
    if (status == STATUS_OK) {
        *result = new;
    } else {
        result_release(new);
    }
    return status;
}

enum status result_file_row(struct result_file *result, const struct result_row *row) {
    const char *const path = result->writer.path;
    const double t = row->state->t;
    for (int f = 0; f < row->school->n_fish; f++)
        if ((size_t)row->state->wake[f].n_vortex > result->length[VORTEX])
            return status_fail(STATUS_FILE, "%s: %d vortices of %s at t = %g s, but the file has room for %zu", path,
                               row->state->wake[f].n_vortex, row->school->fish[f].name, t, result->length[VORTEX]);
    write_variables(result, true, row);
    result->n_rows++;
    netcdf_sync(&result->writer, false);
    if (result->writer.code == 0) return STATUS_OK;
    return status_fail(STATUS_FILE,
                       "%s: cannot be written at t = %g s (%s): make room or choose another place with -o; the rows "
                       "before are good",
                       path, t, netcdf_reason(result->writer.code));
}

enum status result_file_mark(struct result_file *result, struct result_mark *mark) {
    netcdf_sync(&result->writer, true);
    if (result->writer.code != 0) {
        return status_fail(STATUS_FILE, "%s: cannot be written (%s): make room or choose another place with -o",
                           result->writer.path, netcdf_reason(result->writer.code));
    }
    const char *const path = result->writer.part.name ? result->writer.part.name : result->writer.path;
    return result_mark_take(path, (long)result->n_rows, &result->checksum, mark);
}

enum status result_file_close(struct result_file *result, const char *run_status) {
    if (!result) return STATUS_OK;
    struct netcdf_writer *const writer = &result->writer;
    const bool is_published = !writer->part.name;

    // the rows are safe before the file says how the run has ended
    if (is_published) netcdf_sync(writer, true);

    // after a failed write the buffer of NetCDF cannot be written
    if (is_published && writer->code != 0) netcdf_reopen(writer);
    write_run_status(result, run_status);
    netcdf_sync(writer, true);
    enum status status = STATUS_OK;

    if (is_published && writer->code != 0) {
        status = status_fail(STATUS_FILE, "%s: cannot be closed (%s): the last rows may be missing", writer->path,
                             netcdf_reason(writer->code));
        netcdf_reopen(writer);
        write_run_status(result, "failed: the last rows could not be written");
    }

    const enum status finished = netcdf_finish(writer);
    result_release(result);
    return status == STATUS_OK ? finished : status;
}

void result_file_abandon(struct result_file *result) {
    netcdf_abandon(&result->writer);
    result_release(result);
}
