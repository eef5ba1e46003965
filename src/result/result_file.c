/* result_file.c: writes the file of a run, looping over the table of variables. */
#include "result/result_file.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/types.h>
#include <unistd.h>
#include <zlib.h>

#include "result/netcdf.h"
#include "result/target.h"
#include "school/warnings.h"

// ---- copy values from the structs of a run to the slots of an array

void result_values_lengths(const struct school *school, int n_vortices, size_t length[RESULT_N_DIMENSIONS]) {
    for (int d = 0; d < RESULT_N_DIMENSIONS; d++) length[d] = 1;
    length[FISH] = (size_t)school->n_fish;
    length[VORTEX] = (size_t)n_vortices;
    length[XY] = 2;
    length[ORDER] = METHODS_MAX_ORDER;
    length[SENSOR] = 0;
    length[WALL] = (size_t)school->walls.n;
    length[MULTIPLIER] = STEADY_QUANTITIES * (size_t)school->n_fish;
    length[SLOW] = STEADY_QUANTITIES;

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

void result_values_fill(const struct result_variable *variable, const size_t *length, const struct result_row *row,
                        void *buffer) {
    const size_t n = result_values_n(variable, length), size = result_values_size(variable->type);
    memset(buffer, 0, n * size);
    if (variable->type == RESULT_REAL || variable->type == RESULT_BULK) {
        for (size_t k = 0; k < n; k++) ((double *)buffer)[k] = NAN;
    }

    // the slots of the school or of each fish; the multipliers are those of the school
    const bool is_of_fish = result_table_has(variable, FISH) && variable->dimension[0] != MULTIPLIER;
    const size_t n_fish = is_of_fish ? length[FISH] : 1;
    const size_t n_owners = variable->owner == OF_AXIS ? length[XY] : n_fish;
    for (size_t f = 0; f < n_owners; f++) {
        void *const slots = (char *)buffer + f * (n / n_owners) * size;
        if (variable->gather) {
            variable->gather(row, (int)f, variable->part, slots);
            continue;
        }

        const char *value = result_table_owner(row, variable->owner, (int)f);
        if (!value) continue;
        value += variable->offset;
        size_t n_used = n / n_owners;
        if (variable->is_pointer) {
            memcpy(&value, value, sizeof(const char *));
            const enum result_dimension last = variable->dimension[1];
            n_used = last == NAME ? strlen(value) : (size_t)result_table_length(&row->school->fish[f], last);
        }
        if (n_used > 0) memcpy(slots, value, n_used * size);
    }
}

// ---- the checksum of a result file's bytes, brought up to date as the file grows

enum status result_mark_take(const char *path, long n_rows, struct result_checksum *checksum,
                             struct result_mark *mark) {
    struct netcdf_rows rows;
    TRY(netcdf_read_rows(path, &rows));
    if (rows.bytes == 0 || n_rows < 0 || rows.n < (uint64_t)n_rows) {
        return status_fail(STATUS_FILE, "%s: has %llu rows, but the checkpoint requires %ld", path,
                           (unsigned long long)rows.n, n_rows);
    }

    unsigned char block[1 << 16];
    const uint64_t end = rows.begin_of_rows + (uint64_t)n_rows * rows.bytes;
    const int descriptor = open(path, O_RDONLY | O_CLOEXEC);
    int code = descriptor < 0 ? errno : 0;
    if (checksum->done == 0) checksum->done = rows.begin;

    while (code == 0 && checksum->done < end) {
        const uint64_t left = end - checksum->done;
        const ssize_t n =
            pread(descriptor, block, left < sizeof block ? (size_t)left : sizeof block, (off_t)checksum->done);
        if (n > 0) {
            checksum->value = (uint32_t)crc32_z(checksum->value, block, (size_t)n);
            checksum->done += (uint64_t)n;
        } else if (n == 0 || errno != EINTR) {
            code = n < 0 ? errno : EIO;
        }
    }

    if (descriptor >= 0) close(descriptor);
    *mark = (struct result_mark){n_rows, checksum->value};
    return code == 0 ? STATUS_OK : status_fail(STATUS_FILE, "%s: cannot be read: %s", path, strerror(code));
}

enum status result_mark_check(struct arena *arena, const char *path, const struct result_mark *mark,
                              const char *effective, struct result_checksum *checksum, bool *is_complete) {
    // the case and the run_status
    struct arena *const scratch = arena_create(arena, path);
    struct netcdf_reader *reader;
    char *case_effective, *run_status;
    NEW(scratch, reader, 1);
    TRY(netcdf_open(scratch, reader, path));
    TRY(netcdf_attribute(reader, "case_effective", &case_effective));
    TRY(netcdf_attribute(reader, "run_status", &run_status));
    *is_complete = strcmp(run_status, "complete") == 0 && reader->n_missing == 0;
    const bool is_same = strcmp(case_effective, effective) == 0;
    arena_free(scratch);
    if (!is_same) return status_fail(STATUS_FILE, "%s is the result of another case than the checkpoint", path);

    // the rows
    struct result_mark found;
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
    [RESULT_STATUS] = {"run_status", STATUS_LENGTH},
    [RESULT_WARNINGS] = {"warnings", MAX_NOTE_LENGTH},
    [RESULT_CLOSEST_APPROACH] = {"closest_approach", 256},
    [RESULT_CHECKPOINT_AT] = {"checkpoint_at", 1024},
};
enum { N_NOTES = sizeof notes / sizeof *notes };
static const char running[STATUS_LENGTH] = "running";

struct result_file {
    struct arena *arena;
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

void result_file_note(struct result_file *result, enum result_note note, const char *text) {
    char bytes[MAX_NOTE_LENGTH] = {0};
    snprintf(bytes, notes[note].length, "%s", text);
    netcdf_write_bytes(&result->writer, NETCDF_GLOBAL, notes[note].name, notes[note].length, bytes);
}

static void file_define_variable(struct result_file *result, int i, const int *dimension_number,
                                 enum precision precision) {
    static const enum netcdf_type types[] = {[RESULT_REAL] = NETCDF_DOUBLE,
                                             [RESULT_BULK] = NETCDF_DOUBLE,
                                             [RESULT_INTEGER] = NETCDF_INT,
                                             [RESULT_COUNT] = NETCDF_INT64,
                                             [RESULT_TEXT] = NETCDF_TEXT};
    const struct result_variable *const variable = &result_table[i];
    const bool of_fish = result_table_has(variable, FISH);
    const bool is_single = variable->type == RESULT_BULK && precision == PRECISION_SINGLE;
    struct netcdf_variable to_define = {.name = variable->name,
                                        .long_name = variable->long_name,
                                        .units = variable->unit,
                                        .axis = strcmp(variable->name, "time") == 0 ? "T" : NULL,
                                        .flags = variable->flags,
                                        .type = is_single ? NETCDF_FLOAT : types[variable->type]};
    for (const enum result_dimension *d = variable->dimension; *d != NONE; d++)
        to_define.dimension[to_define.n_dimensions++] = dimension_number[*d];
    result->number[i] = netcdf_define_variable(&result->writer, &to_define);

    // the place on the body of each slot of this variable
    static const struct {
        enum result_dimension dimension;
        const char *name;
    } coordinates[] = {{NODE, "node_arc"},   {EDGE, "edge_arc"},       {JOINT, "joint_arc"},
                       {SHEET, "sheet_arc"}, {CONTROL, "control_arc"}, {SENSOR, "sensor_place"}};
    for (size_t k = 0; k < sizeof coordinates / sizeof *coordinates && of_fish; k++) {
        const char *const name = coordinates[k].name;
        if (!result_table_has(variable, coordinates[k].dimension) || strcmp(variable->name, name) == 0) continue;
        netcdf_write_string(&result->writer, result->number[i], "coordinates", name);
    }
}

// ---- values

/* Which variables are written: the constants, the values of a row, or the values of a steady state. */
enum part_of_file { CONSTANTS, ROW, STEADY };

/* Write the whole of each constant, or the next row of each variable with time. */
static void write_variables(struct result_file *result, enum part_of_file part, const struct result_row *row) {
    for (int i = 0; i < result_table_n; i++) {
        const struct result_variable *const variable = &result_table[i];
        if (!file_is_written(result, variable) || result_table_has(variable, TIME) != (part == ROW)) continue;
        if (part == STEADY && !variable->of_steady) continue;
        result_values_fill(variable, result->length, row, result->buffer);
        size_t start[RESULT_MAX_DIMENSIONS] = {part == ROW ? result->n_rows : 0}, count[RESULT_MAX_DIMENSIONS];
        for (int d = 0; variable->dimension[d] != NONE; d++) count[d] = result->length[variable->dimension[d]];
        netcdf_write(&result->writer, result->number[i], start, count, result->buffer);
    }
}

// ---- rows of another file, with another number of vortices

/* Copy all rows. Fails with STATUS_FILE if rows cannot be read; the writer stores failures of writing. */
static enum status copy_rows(struct result_file *result, const struct result_source *source) {
    struct arena *const scratch = arena_create(result->arena, source->path);
    struct netcdf_reader *reader;
    double *values;
    size_t length[RESULT_N_DIMENSIONS], most = 1; /* of the source */
    NEW(scratch, reader, 1);
    TRY(netcdf_open(scratch, reader, source->path));
    memcpy(length, result->length, sizeof length);
    TRY(netcdf_read_length(reader, result_table_dimension(VORTEX), 1, SIZE_MAX / 64, &length[VORTEX]));
    for (int i = 0; i < result_table_n; i++) {
        const size_t n = result_values_n(&result_table[i], length);
        if (n > most) most = n;
    }
    NEW(scratch, values, most);

    for (; result->n_rows < (size_t)source->n_rows; result->n_rows++) {
        const size_t row = result->n_rows;
        for (int i = 0; i < result_table_n; i++) {
            // read the row of a variable
            const struct result_variable *const variable = &result_table[i];
            if (!file_is_written(result, variable) || !result_table_has(variable, TIME)) continue;
            struct netcdf_slice slice[RESULT_MAX_DIMENSIONS + 1] = {0};
            size_t start[RESULT_MAX_DIMENSIONS] = {row}, count[RESULT_MAX_DIMENSIONS];
            for (int d = 0; variable->dimension[d] != NONE; d++) {
                const enum result_dimension dimension = variable->dimension[d];
                const size_t first = dimension == TIME ? row : 0;
                slice[d] = (struct netcdf_slice){result_table_dimension(dimension), first, length[dimension]};
                count[d] = result->length[dimension];
            }
            TRY(netcdf_read_doubles(reader, variable->name, slice, values));

            // the slots of each fish; the last wake may be left out
            const bool is_last = row + 1 == (size_t)source->n_rows;
            const bool is_dropped = source->drop_last_wake && is_last && result_table_has(variable, VORTEX);
            const size_t n_fish = result_table_has(variable, FISH) ? length[FISH] : 1;
            const size_t from = result_values_n(variable, length) / n_fish;
            const size_t to = result_values_n(variable, result->length) / n_fish;
            for (size_t k = 0; k < n_fish * to; k++) result->buffer[k] = NAN;
            for (size_t f = 0; f < n_fish && !is_dropped; f++) {
                memcpy(result->buffer + f * to, values + f * from, (from < to ? from : to) * sizeof *values);
            }
            netcdf_write_doubles(&result->writer, result->number[i], start, count, result->buffer);
        }
    }

    arena_free(scratch);
    return STATUS_OK;
}

// ---- the life of a result file

static void result_release(void *result) {
    netcdf_finish(&((struct result_file *)result)->writer);
}

/* A result without a file yet. */
static struct result_file *result_allocate(struct arena *parent, const struct result_origin *origin) {
    struct arena *const arena = arena_create(parent, "a result file");
    struct result_file *result;
    size_t most = 1;
    NEW(arena, result, 1);
    result->arena = arena;
    result->writer = (struct netcdf_writer){.part.descriptor = -1, .file = -1};
    result->forces = origin->values->output.forces;
    result->is_steady = origin->is_steady;
    result->overwrite = origin->overwrite;
    result_values_lengths(origin->school, wake_most(origin->school, origin->n_events), result->length);
    for (int i = 0; i < result_table_n; i++) {
        const size_t n = result_values_n(&result_table[i], result->length);
        if (n > most) most = n;
    }
    NEW(arena, result->number, result_table_n);
    NEW(arena, result->buffer, most);
    arena_defer(arena, result_release, result);
    return result;
}

enum status result_file_create(struct arena *arena, struct result_file **result, const struct result_origin *origin) {
    *result = NULL;
    TRY(target_check(origin->path, TARGET_NETCDF, origin->overwrite));
    struct result_file *const file = result_allocate(arena, origin);
    enum status status = netcdf_create(&file->writer, origin->path, origin->values->name, origin->command);

    if (status == STATUS_OK) {
        // the dimensions and the variables
        struct netcdf_writer *const writer = &file->writer;
        int dimension_number[RESULT_N_DIMENSIONS] = {0};
        for (enum result_dimension d = TIME; d < RESULT_N_DIMENSIONS; d++) {
            if (((d == MULTIPLIER || d == SLOW) && !file->is_steady) || (d != TIME && file->length[d] == 0)) continue;
            dimension_number[d] =
                netcdf_define_dimension(writer, result_table_dimension(d), d == TIME ? 0 : file->length[d]);
        }
        for (int i = 0; i < result_table_n; i++) {
            if (!file_is_written(file, &result_table[i])) continue;
            file_define_variable(file, i, dimension_number, origin->values->output.precision);
        }

        // the attributes; the text of the case makes a result repeatable
        const struct case_values *const values = origin->values;
        netcdf_write_integer(writer, NETCDF_GLOBAL, "shoal_schema", RESULT_SCHEMA);
        for (int i = 0; i < N_NOTES; i++)
            result_file_note(file, (enum result_note)i, i == RESULT_STATUS ? running : "");
        netcdf_write_string(writer, NETCDF_GLOBAL, "case_text", values->text);
        if (values->study) {
            netcdf_write_string(writer, NETCDF_GLOBAL, "study_case", values->study);
            netcdf_write_integer(writer, NETCDF_GLOBAL, "study_member", values->member);
        }
        netcdf_write_string(writer, NETCDF_GLOBAL, "case_effective", origin->effective);
        netcdf_write_string(writer, NETCDF_GLOBAL, "method", methods_table[values->solver.method].word);
        netcdf_end_definitions(writer);

        // the constants
        write_variables(file, CONSTANTS, &(struct result_row){.school = origin->school});
        netcdf_sync(&file->writer, true);
        const int code = file->writer.code;
        if (code != 0) status = target_failed(origin->path, code, netcdf_reason(code));
    }
    if (status == STATUS_OK && origin->source) status = copy_rows(file, origin->source);

    if (status == STATUS_OK) {
        *result = file;
    } else {
        arena_free(file->arena);
    }
    return status;
}

void result_file_steady(struct result_file *result, const struct school *school, const struct steady_values *steady) {
    write_variables(result, STEADY, &(struct result_row){.school = school, .steady = steady});
}

enum status result_file_publish(struct result_file *result, const char *run_status) {
    result_file_note(result, RESULT_STATUS, run_status);
    return netcdf_publish(&result->writer, result->overwrite);
}

enum status result_file_continue(struct arena *arena, struct result_file **result, const struct result_origin *origin) {
    const struct result_mark *const mark = origin->mark;
    struct netcdf_rows rows;
    *result = NULL;
    TRY(netcdf_read_rows(origin->path, &rows));

    // a file with rows removed must never be marked complete
    TRY(netcdf_patch(origin->path, notes[RESULT_STATUS].name, sizeof running, running));
    TRY(netcdf_cut_rows(origin->path, &rows, (uint64_t)mark->n_rows));

    struct result_file *const file = result_allocate(arena, origin);
    file->n_rows = (size_t)mark->n_rows;
    file->checksum = *origin->checksum;
    enum status status = netcdf_continue(&file->writer, origin->path);

    if (status == STATUS_OK) {
        for (int i = 0; i < result_table_n; i++) {
            if (!file_is_written(file, &result_table[i])) continue;
            file->number[i] = netcdf_number(&file->writer, result_table[i].name);
        }
        const int code = file->writer.code;
        if (code != 0) {
            netcdf_finish(&file->writer);
            status = status_fail(STATUS_FILE, "%s: cannot be continued: %s", origin->path, netcdf_reason(code));
        }
    }

    if (status == STATUS_OK) {
        *result = file;
    } else {
        arena_free(file->arena);
    }
    return status;
}

/* Whether the name of the file belongs to another file by now, or to none: the rows are then in a file that nobody
 * finds. */
static bool file_has_lost_name(const struct result_file *result) {
    const struct durable_part *const part = &result->writer.part;
    return part->name[0] == '\0' && !durable_has_name(part->descriptor, part->target);
}

static enum status file_refuse_lost_name(const struct result_file *result) {
    if (!file_has_lost_name(result)) return STATUS_OK;
    return status_fail(STATUS_FILE, "%s: was removed or replaced during the run: run the case again",
                       result->writer.path);
}

enum status result_file_row(struct result_file *result, const struct result_row *row) {
    const char *const path = result->writer.path;
    const double t = row->state->t;
    for (int f = 0; f < row->school->n_fish; f++)
        if ((size_t)row->state->wake[f].n_vortex > result->length[VORTEX])
            return status_fail(STATUS_FILE, "%s: %d vortices of %s at t = %g s, but the file has room for %zu", path,
                               row->state->wake[f].n_vortex, row->school->fish[f].name, t, result->length[VORTEX]);
    write_variables(result, ROW, row);
    result->n_rows++;
    netcdf_sync(&result->writer, false);
    if (result->writer.code == 0) return file_refuse_lost_name(result);
    return status_fail(
        STATUS_FILE, "%s: cannot be written at t = %g s (%s): make room or choose another place with -o%s", path, t,
        netcdf_reason(result->writer.code), *result->writer.part.name ? "" : "; the rows before are good");
}

enum status result_file_mark(struct result_file *result, struct result_mark *mark) {
    netcdf_sync(&result->writer, true);
    if (result->writer.code != 0) {
        return status_fail(STATUS_FILE, "%s: cannot be written (%s): make room or choose another place with -o",
                           result->writer.path, netcdf_reason(result->writer.code));
    }
    TRY(file_refuse_lost_name(result));
    const char *const part = result->writer.part.name, *const path = *part ? part : result->writer.path;
    return result_mark_take(path, (long)result->n_rows, &result->checksum, mark);
}

enum status result_file_close(struct result_file *result, const char *run_status) {
    if (!result) return STATUS_OK;
    struct netcdf_writer *const writer = &result->writer;
    const bool is_published = writer->part.name[0] == '\0';

    // the rows are safe before the file says how the run has ended
    if (is_published) netcdf_sync(writer, true);

    // after a failed write the buffer of NetCDF cannot be written, and another file of the name is not ours
    const bool is_lost = file_has_lost_name(result);
    if (is_published && !is_lost && writer->code != 0) netcdf_reopen(writer);
    result_file_note(result, RESULT_STATUS, run_status);
    netcdf_sync(writer, true);
    enum status status = file_refuse_lost_name(result);

    if (is_published && !is_lost && writer->code != 0) {
        status = status_fail(STATUS_FILE, "%s: cannot be closed (%s): the last rows may be missing", writer->path,
                             netcdf_reason(writer->code));
        netcdf_reopen(writer);
        result_file_note(result, RESULT_STATUS, "failed: the last rows could not be written");
    }

    const enum status finished = netcdf_finish(writer);
    arena_free(result->arena);
    return status == STATUS_OK ? finished : status;
}

void result_file_abandon(struct result_file *result) {
    netcdf_abandon(&result->writer);
    arena_free(result->arena);
}
