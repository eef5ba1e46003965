/* member_file.c: reads the status and the final values of a member of a study. */
#include "study/member_file.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

#include "case/sweep.h"
#include "case/sweep_quantity.h"
#include "result/netcdf.h"
#include "result/result_table.h"

enum { MAX_FISH = 1000000 };

// ---- the table of quantities: first the last rows of variables, then computed quantities

static const char *const computed[] = {"nose",
                                       "tail",
                                       "lateral_drift",
                                       "mean_heading",
                                       "nose_error",
                                       "tail_error",
                                       "power_error",
                                       "evaluations_to_end",
                                       "wall_time_to_end",
                                       "beat_time",
                                       "steady_multiplier",
                                       "steady_multiplier_error"};
enum {
    NOSE,
    TAIL,
    DRIFT,
    MEAN_HEADING,
    NOSE_ERROR,
    TAIL_ERROR,
    POWER_ERROR,
    EVALUATIONS,
    WALL_TIME,
    BEAT_TIME,
    MULTIPLIER_SIZE,
    MULTIPLIER_ERROR,
    N_COMPUTED
};

const struct member_file_quantity *member_file_quantity(int i) {
    static struct member_file_quantity all[RESULT_TABLE_MAX + N_COMPUTED];
    static int n;
    if (n == 0) {
        for (int v = 0; v < result_table_n; v++) {
            // (time), (time, fish), (time, fish, xy), and the same without time for real numbers of a steady state;
            // the counts of a steady search have the names of keys
            const struct result_variable *const from = &result_table[v];
            const bool is_row = from->dimension[0] == TIME && from->type != RESULT_TEXT;
            const bool is_steady = from->of_steady && from->type == RESULT_REAL && from->dimension[0] != TIME;
            const enum result_dimension *const d = from->dimension + is_row;
            const bool is_number = d[0] == NONE || (d[0] == FISH && (d[1] == NONE || d[1] == XY));
            if (!(is_row || is_steady) || !is_number) continue;
            all[n++] = (struct member_file_quantity){.name = from->name,
                                                     .unit = from->unit,
                                                     .long_name = from->long_name,
                                                     .of_fish = result_table_has(from, FISH),
                                                     .of_xy = result_table_has(from, XY),
                                                     .of_steady = from->of_steady};
        }
        for (int c = 0; c < N_COMPUTED; c++) {
            const struct sweep_quantity *from = sweep_quantities;
            while (strcmp(from->name, computed[c]) != 0) from++;
            all[n++] = (struct member_file_quantity){.name = from->name,
                                                     .unit = from->unit,
                                                     .long_name = from->meaning,
                                                     .of_fish = from->of_fish,
                                                     .of_xy = from->of_xy,
                                                     .is_computed = true,
                                                     .of_comparison = c >= NOSE_ERROR && c <= WALL_TIME,
                                                     .of_steady = c >= BEAT_TIME};
        }
    }

    return i < n ? &all[i] : NULL;
}

int member_file_quantity_number(const char *name) {
    for (int q = 0; member_file_quantity(q); q++) {
        if (strcmp(member_file_quantity(q)->name, name) == 0) return q;
    }
    return -1;
}

static int member_file_n_quantities(void) {
    int n = 0;
    while (member_file_quantity(n)) n++;
    return n;
}

// ---- values

double *member_file_place(const struct member_file *member, int quantity, int fish, int xy) {
    return &member->value[(quantity * member->n_fish + fish) * 2 + xy];
}

double member_file_value(const struct member_file *member, int quantity, int fish, int xy) {
    const bool is_known = member->value && quantity >= 0 && fish < member->n_fish;
    return is_known ? *member_file_place(member, quantity, fish, xy) : NAN;
}

double member_file_number(const struct member_file *member, const char *name, int fish) {
    return member_file_value(member, member_file_quantity_number(name), fish, 0);
}

double member_file_ratio(const struct member_file *members, int m, int other, int quantity, int fish) {
    const double value = member_file_value(&members[m], quantity, fish, 0),
                 unit = member_file_value(&members[other], quantity, fish, 0);
    const bool are_complete = member_file_is_complete(&members[m]) && member_file_is_complete(&members[other]);
    return are_complete && fabs(unit) > 0 ? value / unit : NAN;
}

bool member_file_is_complete(const struct member_file *member) {
    return strcmp(member->status, "complete") == 0;
}

bool member_file_has_failed(const struct member_file *member, const char *words) {
    return strncmp(member->status, "failed", strlen("failed")) == 0 && strstr(member->status, words) != NULL;
}

void member_file_create_values(struct arena *arena, struct member_file *member, int n_fish) {
    const int n = member_file_n_quantities() * n_fish * 2;
    member->n_fish = n_fish;
    NEW(arena, member->value, n);
    for (int i = 0; i < n; i++) member->value[i] = NAN;
}

// ---- reading

/* An open file of a member. */
struct reading {
    struct netcdf_reader reader;
    size_t n_rows, n_fish, n_node; /* lengths of dimensions */
    double *time, *heading;        /* of one fish at a time                          (n_rows) */
    double *values;                /* one row of a variable                          (n_fish, xy) */
    struct member_file *member;
};

/* Read a time-independent value of a fish. */
static enum status read_constant(const struct reading *reading, const char *name, size_t f, double *value) {
    return netcdf_read_doubles(&reading->reader, name, (struct netcdf_slice[]){{"fish", f, 1}, {NULL}}, value);
}

/* Compute nose, tail, drift and mean heading of a fish. */
static enum status compute_fish(const struct reading *reading, int fish) {
    const int computed_first = member_file_n_quantities() - N_COMPUTED;
    const struct netcdf_reader *const reader = &reading->reader;
    const size_t f = (size_t)fish, last = reading->n_rows - 1;

    // nose and tail at the end
    double n_nodes;
    TRY(read_constant(reading, "n_nodes", f, &n_nodes));
    if (!(n_nodes >= 1 && n_nodes <= (double)reading->n_node)) {
        return status_fail(STATUS_FILE, "%s: fish %zu cannot have %g nodes", reader->path, f, n_nodes);
    }
    for (int i = 0; i < 2; i++) {
        const size_t node = i == 0 ? 0 : (size_t)n_nodes - 1;
        const struct netcdf_slice slice[] = {
            {"time", last, 1}, {"fish", f, 1}, {"node", node, 1}, {"xy", 0, 2}, {NULL}};
        double *const to = member_file_place(reading->member, computed_first + (i == 0 ? NOSE : TAIL), fish, 0);
        TRY(netcdf_read_doubles(reader, "x", slice, to));
    }

    // displacement of the centre of mass to the left of the first heading
    const struct netcdf_slice all_rows[] = {{"time", 0, reading->n_rows}, {"fish", f, 1}, {NULL}};
    double com[2][2], *const heading = reading->heading;
    TRY(netcdf_read_doubles(reader, "heading", all_rows, heading));
    for (int i = 0; i < 2; i++) {
        const struct netcdf_slice slice[] = {{"time", i == 0 ? 0 : last, 1}, {"fish", f, 1}, {"xy", 0, 2}, {NULL}};
        TRY(netcdf_read_doubles(reader, "com", slice, com[i]));
    }
    const double angle = heading[0] * (M_PI / 180);
    *member_file_place(reading->member, computed_first + DRIFT, fish, 0) =
        cos(angle) * (com[1][1] - com[0][1]) - sin(angle) * (com[1][0] - com[0][0]);

    // mean heading over the last period, or over a shorter run: trapezoidal rule
    const double *const time = reading->time;
    double frequency, sum = 0;
    TRY(read_constant(reading, "frequency", f, &frequency));
    const double end = time[last], start = end - (1 + 1e-9) / frequency;
    size_t row = 0;
    while (row < last && time[row] < start) row++;
    const double duration = end - time[row];
    for (; row < last; row++) sum += (heading[row] + heading[row + 1]) / 2 * (time[row + 1] - time[row]);
    *member_file_place(reading->member, computed_first + MEAN_HEADING, fish, 0) = duration > 0 ? sum / duration : NAN;

    return STATUS_OK;
}

/* Compute the wall time per beat of a steady search, including multipliers and rows; NaN without a beat. */
static enum status compute_beat_time(const struct reading *reading) {
    static const char *const names[] = {"steady_beats", "steady_multiplier_beats"};
    const struct netcdf_slice last[] = {{"time", reading->n_rows - 1, 1}, {NULL}};
    double count, beats = 0, wall_time, frequency;

    if (!netcdf_has(&reading->reader, names[0])) return STATUS_OK;
    for (int i = 0; i < 2; i++) {
        TRY(netcdf_read_doubles(&reading->reader, names[i], (struct netcdf_slice[]){{NULL}}, &count));
        beats += count;
    }

    TRY(read_constant(reading, "frequency", 0, &frequency));
    TRY(netcdf_read_doubles(&reading->reader, "wall_time", last, &wall_time));
    beats += frequency > 0 ? (reading->time[reading->n_rows - 1] - reading->time[0]) * frequency : 0;
    const int q = member_file_n_quantities() - N_COMPUTED + BEAT_TIME;
    *member_file_place(reading->member, q, 0, 0) = beats > 0 ? wall_time / beats : NAN;

    return STATUS_OK;
}

/* Absolute value and error of the largest multiplier; NaN: none. */
static enum status compute_multiplier(const struct reading *reading) {
    static const char name[] = "steady_multiplier", error[] = "steady_multiplier_error";
    const int first = member_file_n_quantities() - N_COMPUTED;
    double pair[2];
    if (!netcdf_has(&reading->reader, name) || !netcdf_has(&reading->reader, error)) return STATUS_OK;
    const struct netcdf_slice slice[] = {{"multiplier", 0, 1}, {"xy", 0, 2}, {NULL}};
    TRY(netcdf_read_doubles(&reading->reader, name, slice, pair));
    *member_file_place(reading->member, first + MULTIPLIER_SIZE, 0, 0) = hypot(pair[0], pair[1]);
    const struct netcdf_slice one[] = {{"multiplier", 0, 1}, {NULL}};
    return netcdf_read_doubles(&reading->reader, error, one,
                               member_file_place(reading->member, first + MULTIPLIER_ERROR, 0, 0));
}

/* Read attributes and values of an open file. scratch: memory until the file is closed. */
static enum status read_member(struct arena *arena, struct arena *scratch, struct reading *reading) {
    struct member_file *const member = reading->member;
    const struct netcdf_reader *const reader = &reading->reader;

    // attributes
    int schema;
    TRY(netcdf_read_integer(reader, "shoal_schema", -1, &schema));
    if (schema != RESULT_SCHEMA) {
        return status_fail(STATUS_FILE, "%s: not a result of this version of shoal", reader->path);
    }
    TRY(netcdf_read_integer(reader, "study_member", -1, &member->number));
    static const char *const names[] = {"run_status", "warnings", "study_case", "case_effective", "source"};
    const char **const texts[] = {&member->status, &member->warnings, &member->study, &member->effective,
                                  &member->source};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        char *text;
        TRY(netcdf_attribute(reader, names[i], &text));
        *texts[i] = arena_text(arena, "%s", text);
    }

    // dimensions
    TRY(netcdf_read_length(reader, "time", 0, SIZE_MAX / sizeof(double), &reading->n_rows));
    TRY(netcdf_read_length(reader, "fish", 1, MAX_FISH, &reading->n_fish));
    TRY(netcdf_read_length(reader, "node", 1, SIZE_MAX, &reading->n_node));
    member_file_create_values(arena, member, (int)reading->n_fish);
    if (reading->n_rows == 0) return STATUS_OK;
    NEW(scratch, reading->time, reading->n_rows);
    NEW(scratch, reading->heading, reading->n_rows);
    NEW(scratch, reading->values, reading->n_fish * 2);
    TRY(netcdf_read_doubles(reader, "time", (struct netcdf_slice[]){{"time", 0, reading->n_rows}, {NULL}},
                            reading->time));

    // the last row of each variable, or the value of a steady state
    for (int q = 0; q < member_file_n_quantities() - N_COMPUTED; q++) {
        const struct member_file_quantity *const quantity = member_file_quantity(q);
        if (!netcdf_has(reader, quantity->name)) continue;
        const struct netcdf_slice slice[] = {{"time", reading->n_rows - 1, 1},
                                             {quantity->of_fish ? "fish" : NULL, 0, reading->n_fish},
                                             {quantity->of_xy ? "xy" : NULL, 0, 2},
                                             {NULL}};
        TRY(netcdf_read_doubles(reader, quantity->name, slice + quantity->of_steady, reading->values));
        const double *from = reading->values;
        for (int f = 0; f < (quantity->of_fish ? member->n_fish : 1); f++) {
            for (int k = 0; k < 1 + quantity->of_xy; k++) *member_file_place(member, q, f, k) = *from++;
        }
    }

    for (int f = 0; f < member->n_fish; f++) TRY(compute_fish(reading, f));
    TRY(compute_beat_time(reading));
    return compute_multiplier(reading);
}

enum status member_file_read(struct arena *arena, struct member_file *member, const char *path) {
    struct arena *const scratch = arena_create(arena, path);
    struct reading *reading;
    *member = (struct member_file){0};
    NEW(scratch, reading, 1);
    reading->member = member;
    enum status status = netcdf_open(scratch, &reading->reader, path);
    if (status == STATUS_OK && reading->reader.n_missing > 0) {
        status = status_fail(STATUS_FILE, "%s: the end of the file is missing: was it copied completely?", path);
    }
    if (status == STATUS_OK) status = read_member(arena, scratch, reading);
    arena_free(scratch);
    if (status != STATUS_OK) *member = (struct member_file){0};
    return status;
}
