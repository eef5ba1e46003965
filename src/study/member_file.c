/* member_file.c: reading status and final values of a member of a study. */
#include "study/member_file.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "case/sweep_quantity.h"
#include "result/netcdf.h"
#include "result/result_table.h"

enum { MAX_FISH = 1000000 };

// ---- the table of quantities: first the last rows of variables, then computed quantities

static const char *const computed[] = {"nose",       "tail",       "lateral_drift", "mean_heading",
                                       "nose_error", "tail_error", "power_error",   "beat_time"};
enum { NOSE, TAIL, DRIFT, MEAN_HEADING, NOSE_ERROR, TAIL_ERROR, POWER_ERROR, BEAT_TIME, N_COMPUTED };

/* True for (time), (time, fish) and (time, fish, xy). */
static int has_end(const struct result_variable *variable) {
    const enum result_dimension *const d = variable->dimension;
    if (d[0] != TIME || variable->type == RESULT_TEXT) return 0;
    return d[1] == NONE || (d[1] == FISH && (d[2] == NONE || d[2] == XY));
}

/* True for real numbers of a steady state, and of each fish; counts have the names of keys. */
static int is_of_steady(const struct result_variable *variable) {
    const enum result_dimension *const d = variable->dimension;
    if (!variable->of_steady || variable->type != RESULT_REAL) return 0;
    return d[0] == NONE || (d[0] == FISH && (d[1] == NONE || d[1] == XY));
}

const struct member_file_quantity *member_file_quantity(int i) {
    static struct member_file_quantity all[RESULT_TABLE_MAX + N_COMPUTED];
    static int n;
    if (n == 0) {
        for (int v = 0; v < result_table_n; v++) {
            const struct result_variable *const from = &result_table[v];
            if (!has_end(from) && !is_of_steady(from)) continue;
            all[n++] = (struct member_file_quantity){.name = from->name,
                                                     .unit = from->unit,
                                                     .long_name = from->long_name,
                                                     .of_fish = result_table_has(from, FISH),
                                                     .of_xy = result_table_has(from, XY),
                                                     .of_steady = from->of_steady};
        }
        for (int c = 0; c < N_COMPUTED; c++) {
            const struct sweep_quantity *const from =
                &sweep_quantities[sweep_quantity_find(computed[c], SWEEP_N_QUANTITIES)];
            all[n++] = (struct member_file_quantity){.name = from->name,
                                                     .unit = from->unit,
                                                     .long_name = from->meaning,
                                                     .of_fish = from->of_fish,
                                                     .of_xy = from->of_xy,
                                                     .is_computed = 1,
                                                     .of_comparison = c >= NOSE_ERROR && c <= POWER_ERROR,
                                                     .of_steady = c == BEAT_TIME};
        }
    }

    return i < n ? &all[i] : NULL;
}

int member_file_quantity_number(const char *name) {
    int i = 0;
    while (strcmp(member_file_quantity(i)->name, name) != 0) i++;
    return i;
}

int member_file_n_quantities(void) {
    int n = 0;
    while (member_file_quantity(n)) n++;
    return n;
}

// ---- values

double *member_file_place(const struct member_file *member, int quantity, int fish, int xy) {
    return &member->value[(quantity * member->n_fish + fish) * 2 + xy];
}

double member_file_value(const struct member_file *member, int quantity, int fish, int xy) {
    return member->value && fish < member->n_fish ? *member_file_place(member, quantity, fish, xy) : NAN;
}

enum status member_file_create_values(struct member_file *member, int n_fish) {
    const size_t n = (size_t)member_file_n_quantities() * (size_t)n_fish * 2;
    member->n_fish = n_fish;
    member->value = malloc((n + 1) * sizeof *member->value);
    if (!member->value) return status_fail(STATUS_MEMORY, "out of memory: a member of a study");
    for (size_t i = 0; i < n; i++) member->value[i] = NAN;
    return STATUS_OK;
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

/* Read the last row of the variable of a quantity, or the value of a steady state. */
static enum status read_quantity(const struct reading *reading, int q) {
    const struct member_file_quantity *const quantity = member_file_quantity(q);
    if (!netcdf_has(&reading->reader, quantity->name)) return STATUS_OK;
    const struct netcdf_slice slice[] = {{"time", reading->n_rows - 1, 1},
                                         {quantity->of_fish ? "fish" : NULL, 0, reading->n_fish},
                                         {quantity->of_xy ? "xy" : NULL, 0, 2},
                                         {NULL}};
    TRY(netcdf_read_doubles(&reading->reader, quantity->name, slice + quantity->of_steady, reading->values));
    const double *from = reading->values;
    for (int f = 0; f < (quantity->of_fish ? reading->member->n_fish : 1); f++) {
        for (int k = 0; k < 1 + quantity->of_xy; k++) *member_file_place(reading->member, q, f, k) = *from++;
    }

    return STATUS_OK;
}

/* Read a time-independent value of a fish, or values of one row of a variable over (time, fish, ...). */
static enum status read_constant(const struct reading *reading, const char *name, size_t f, double *value) {
    return netcdf_read_doubles(&reading->reader, name, (struct netcdf_slice[]){{"fish", f, 1}, {NULL}}, value);
}

static enum status read_number(const struct reading *reading, const char *name, size_t row, size_t f, double *value) {
    const struct netcdf_slice slice[] = {{"time", row, 1}, {"fish", f, 1}, {NULL}};
    return netcdf_read_doubles(&reading->reader, name, slice, value);
}

static enum status read_com(const struct reading *reading, size_t row, size_t f, double com[2]) {
    const struct netcdf_slice slice[] = {{"time", row, 1}, {"fish", f, 1}, {"xy", 0, 2}, {NULL}};
    return netcdf_read_doubles(&reading->reader, "com", slice, com);
}

static enum status read_node(const struct reading *reading, size_t f, size_t node, double x[2]) {
    const struct netcdf_slice slice[] = {
        {"time", reading->n_rows - 1, 1}, {"fish", f, 1}, {"node", node, 1}, {"xy", 0, 2}, {NULL}};
    return netcdf_read_doubles(&reading->reader, "x", slice, x);
}

/* Nose and tail of a fish at the end. */
static enum status compute_ends(const struct reading *reading, size_t f, double nose[2], double tail[2]) {
    double n_nodes;
    TRY(read_constant(reading, "n_nodes", f, &n_nodes));
    if (!(n_nodes >= 1 && n_nodes <= (double)reading->n_node)) {
        return status_fail(STATUS_FILE, "%s: fish %zu cannot have %g nodes", reading->reader.path, f, n_nodes);
    }
    TRY(read_node(reading, f, 0, nose));
    return read_node(reading, f, (size_t)n_nodes - 1, tail);
}

/* The displacement of the centre of mass to the left of the first heading. */
static enum status compute_drift(const struct reading *reading, size_t f, double *drift) {
    double heading, first[2], last[2];
    TRY(read_number(reading, "heading", 0, f, &heading));
    TRY(read_com(reading, 0, f, first));
    TRY(read_com(reading, reading->n_rows - 1, f, last));
    heading *= M_PI / 180;
    *drift = cos(heading) * (last[1] - first[1]) - sin(heading) * (last[0] - first[0]);
    return STATUS_OK;
}

/* The mean heading over the last period, or over a shorter run: trapezoidal rule. */
static enum status compute_mean_heading(const struct reading *reading, size_t f, double *mean) {
    const double *const time = reading->time, *const heading = reading->heading;
    const size_t last = reading->n_rows - 1;
    double frequency;

    TRY(read_constant(reading, "frequency", f, &frequency));
    const struct netcdf_slice slice[] = {{"time", 0, reading->n_rows}, {"fish", f, 1}, {NULL}};
    TRY(netcdf_read_doubles(&reading->reader, "heading", slice, reading->heading));
    const double end = time[last], start = end - (1 + 1e-9) / frequency;
    size_t row = 0;
    while (row < last && time[row] < start) row++;
    const double duration = end - time[row];
    double sum = 0;
    for (; row < last; row++) sum += (heading[row] + heading[row + 1]) / 2 * (time[row + 1] - time[row]);
    *mean = duration > 0 ? sum / duration : NAN;

    return STATUS_OK;
}

/* The wall time per beat of a steady search, including multipliers and rows; NaN without a beat. */
static enum status compute_beat_time(const struct reading *reading, double *time) {
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
    *time = beats > 0 ? wall_time / beats : NAN;

    return STATUS_OK;
}

/* Compute the computed quantities of one fish. */
static enum status compute(const struct reading *reading, int f) {
    const int first = member_file_n_quantities() - N_COMPUTED;
    const struct member_file *const member = reading->member;
    TRY(compute_ends(reading, (size_t)f, member_file_place(member, first + NOSE, f, 0),
                     member_file_place(member, first + TAIL, f, 0)));
    TRY(compute_drift(reading, (size_t)f, member_file_place(member, first + DRIFT, f, 0)));
    if (f == 0) TRY(compute_beat_time(reading, member_file_place(member, first + BEAT_TIME, 0, 0)));
    return compute_mean_heading(reading, (size_t)f, member_file_place(member, first + MEAN_HEADING, f, 0));
}

static enum status read_attributes(struct reading *reading) {
    struct member_file *const member = reading->member;
    const struct netcdf_reader *const reader = &reading->reader;
    int schema;

    TRY(netcdf_read_integer(reader, "shoal_schema", -1, &schema));
    if (schema != RESULT_SCHEMA) {
        return status_fail(STATUS_FILE, "%s: not a result of this version of shoal", reader->path);
    }

    TRY(netcdf_read_integer(reader, "study_member", -1, &member->number));
    TRY(netcdf_read_string(reader, "run_status", &member->status));
    TRY(netcdf_read_string(reader, "warnings", &member->warnings));
    TRY(netcdf_read_string(reader, "study_case", &member->study));

    return netcdf_read_string(reader, "case_effective", &member->effective);
}

static enum status read_values(struct reading *reading) {
    const struct netcdf_reader *const reader = &reading->reader;
    TRY(netcdf_read_length(reader, "time", 0, SIZE_MAX / sizeof(double), &reading->n_rows));
    TRY(netcdf_read_length(reader, "fish", 1, MAX_FISH, &reading->n_fish));
    TRY(netcdf_read_length(reader, "node", 1, SIZE_MAX, &reading->n_node));
    TRY(member_file_create_values(reading->member, (int)reading->n_fish));
    if (reading->n_rows == 0) return STATUS_OK;
    reading->time = calloc(reading->n_rows, sizeof *reading->time);
    reading->heading = calloc(reading->n_rows, sizeof *reading->heading);
    reading->values = calloc(reading->n_fish * 2, sizeof *reading->values);
    if (!reading->time || !reading->heading || !reading->values) {
        return status_fail(STATUS_MEMORY, "%s: out of memory while reading", reader->path);
    }

    const struct netcdf_slice all_rows[] = {{"time", 0, reading->n_rows}, {NULL}};
    TRY(netcdf_read_doubles(reader, "time", all_rows, reading->time));
    for (int q = 0; q < member_file_n_quantities() - N_COMPUTED; q++) TRY(read_quantity(reading, q));
    for (int f = 0; f < reading->member->n_fish; f++) TRY(compute(reading, f));

    return STATUS_OK;
}

enum status member_file_read(struct member_file *member, const char *path) {
    *member = (struct member_file){0};
    struct reading reading = {.member = member};
    TRY(netcdf_open(&reading.reader, path));
    enum status status = STATUS_OK;
    if (reading.reader.n_missing > 0) {
        status = status_fail(STATUS_FILE, "%s: the end of the file is missing: was it copied completely?", path);
    }

    if (status == STATUS_OK) status = read_attributes(&reading);
    if (status == STATUS_OK) status = read_values(&reading);
    netcdf_close(&reading.reader);
    free(reading.time);
    free(reading.heading);
    free(reading.values);
    if (status != STATUS_OK) member_file_free(member);

    return status;
}

void member_file_free(struct member_file *member) {
    free(member->status);
    free(member->warnings);
    free(member->study);
    free(member->effective);
    free(member->value);
    *member = (struct member_file){0};
}
