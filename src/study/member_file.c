/* member_file.c: reading the end of a member of a study. Declared in study_file.h. */
#include <math.h>
#include <netcdf.h>
#include <stdlib.h>
#include <string.h>

#include "output/result_table.h"
#include "study/study_file.h"

// ---- the table of quantities: first what stands in the last row of a result file, then what is computed

static const struct member_file_quantity computed[] = {
    {"nose", "m", "position of the nose at the end", 1, 1, 1},
    {"tail", "m", "position of the tail at the end", 1, 1, 1},
    {"lateral_drift", "m", "way of the centre of mass across the first heading, to the left", 1, 0, 1},
    {"mean_heading", "degree", "mean of the heading over the last period", 1, 0, 1},
    {"mean_actuation_power", "W", "mean power of the muscle over the last period", 1, 0, 1},
};
enum { NOSE, TAIL, DRIFT, MEAN_HEADING, MEAN_POWER, N_COMPUTED, MOST_QUANTITIES = 96 };

/* True for (time), (time, fish) and (time, fish, xy). */
static int has_end(const struct result_variable *variable) {
    const enum result_dimension *const d = variable->dimension;
    if (d[0] != TIME || variable->type == RESULT_TEXT) return 0;
    return d[1] == NONE || (d[1] == FISH && (d[2] == NONE || d[2] == XY));
}

const struct member_file_quantity *member_file_quantity(int i) {
    static struct member_file_quantity all[MOST_QUANTITIES];
    static int n;
    if (n == 0) {
        for (int v = 0; v < result_table_n; v++) {
            const struct result_variable *const from = &result_table[v];
            if (!has_end(from)) continue;
            all[n++] = (struct member_file_quantity){
                from->name, from->unit, from->long_name, result_table_has(from, FISH), result_table_has(from, XY), 0};
        }
        for (int c = 0; c < N_COMPUTED; c++) all[n++] = computed[c];
    }
    return i < n ? &all[i] : NULL;
}

int member_file_quantity_number(const char *name) {
    int i = 0;
    while (strcmp(member_file_quantity(i)->name, name) != 0) i++;
    return i;
}

static int n_quantities(void) {
    int n = 0;
    while (member_file_quantity(n)) n++;
    return n;
}

// ---- reading

/* An open file of a member. */
struct reading {
    int file;
    size_t n_rows, n_fish;
    double *time; /* (n_rows) */
    struct member_file *member;
};

/* A text attribute of the file, "" if it is missing; NULL: out of memory. The caller frees it. */
static char *text_attribute(int file, const char *name) {
    size_t length;
    if (nc_inq_attlen(file, NC_GLOBAL, name, &length) != NC_NOERR) length = 0;
    char *const text = calloc(length + 1, 1);
    if (text && length > 0) nc_get_att_text(file, NC_GLOBAL, name, text);
    return text;
}

static size_t dimension_length(int file, const char *name) {
    int number;
    size_t length = 0;
    if (nc_inq_dimid(file, name, &number) == NC_NOERR) nc_inq_dimlen(file, number, &length);
    return length;
}

/* One value of a variable; NaN if there is none. */
static double read_value(const struct reading *reading, const char *name, size_t row, size_t fish, size_t node,
                         size_t xy) {
    int number;
    double value;
    if (nc_inq_varid(reading->file, name, &number) != NC_NOERR) return NAN;
    return nc_get_var1_double(reading->file, number, (size_t[]){row, fish, node, xy}, &value) == NC_NOERR ? value : NAN;
}

static double *place(struct member_file *member, int quantity, int fish, int xy) {
    return &member->value[(quantity * member->n_fish + fish) * 2 + xy];
}

double member_file_value(const struct member_file *member, int quantity, int fish, int xy) {
    return member->value ? member->value[(quantity * member->n_fish + fish) * 2 + xy] : NAN;
}

static void read_last_row(struct reading *reading) {
    for (int q = 0; q < n_quantities() - N_COMPUTED; q++) {
        const struct member_file_quantity *const quantity = member_file_quantity(q);
        for (int f = 0; f < (quantity->of_fish ? reading->member->n_fish : 1); f++) {
            for (int k = 0; k < 1 + quantity->of_xy; k++) {
                // the direction is the third index of these variables
                *place(reading->member, q, f, k) =
                    read_value(reading, quantity->name, reading->n_rows - 1, (size_t)f, (size_t)k, 0);
            }
        }
    }
}

/* A value that does not change with time. */
static double constant(const struct reading *reading, const char *name, size_t fish) {
    int number;
    double value;
    if (nc_inq_varid(reading->file, name, &number) != NC_NOERR) return NAN;
    return nc_get_var1_double(reading->file, number, &fish, &value) == NC_NOERR ? value : NAN;
}

/* The mean heading of a fish over its last period, or over the whole run where that is shorter: trapezoids. */
static double mean_heading(const struct reading *reading, size_t fish) {
    const size_t last = reading->n_rows - 1;
    const double end = reading->time[last], start = end - (1 + 1e-9) / constant(reading, "frequency", fish);
    size_t row = 0;
    while (row < last && reading->time[row] < start) row++;
    const double duration = end - reading->time[row];
    if (!(duration > 0)) return NAN;
    double sum = 0;
    for (; row < last; row++) {
        sum += (read_value(reading, "heading", row, fish, 0, 0) + read_value(reading, "heading", row + 1, fish, 0, 0)) /
               2 * (reading->time[row + 1] - reading->time[row]);
    }
    return sum / duration;
}

/* The quantities that are computed, of one fish. */
static void compute(struct reading *reading, int f) {
    const size_t last = reading->n_rows - 1, fish = (size_t)f;
    const int first_quantity = n_quantities() - N_COMPUTED;
    double *const to = place(reading->member, first_quantity, f, 0);
    const int stride = 2 * reading->member->n_fish;
    const double n_nodes = constant(reading, "n_nodes", fish);
    for (size_t k = 0; k < 2 && n_nodes > 0; k++) {
        to[NOSE * stride + (int)k] = read_value(reading, "x", last, fish, 0, k);
        to[TAIL * stride + (int)k] = read_value(reading, "x", last, fish, (size_t)n_nodes - 1, k);
    }
    const double heading = read_value(reading, "heading", 0, fish, 0, 0) * M_PI / 180;
    const double way_x = read_value(reading, "com", last, fish, 0, 0) - read_value(reading, "com", 0, fish, 0, 0);
    const double way_y = read_value(reading, "com", last, fish, 1, 0) - read_value(reading, "com", 0, fish, 1, 0);
    to[DRIFT * stride] = cos(heading) * way_y - sin(heading) * way_x;

    to[MEAN_HEADING * stride] = mean_heading(reading, fish);
    // the cost of transport is that power over mass and speed
    to[MEAN_POWER * stride] = read_value(reading, "cost_of_transport", last, fish, 0, 0) *
                              constant(reading, "body_mass", fish) * read_value(reading, "speed", last, fish, 0, 0);
}

static enum status no_memory(const char *path) {
    return status_fail(STATUS_MEMORY, "%s: out of memory while reading", path);
}

static enum status read_names(const struct reading *reading, const char *path) {
    struct member_file *const member = reading->member;
    const size_t length = dimension_length(reading->file, "name");
    int number = -1;
    nc_inq_varid(reading->file, "fish_name", &number);
    member->fish_name = calloc(reading->n_fish + 1, sizeof *member->fish_name);
    if (!member->fish_name) return no_memory(path);
    for (size_t f = 0; f < reading->n_fish; f++) {
        member->fish_name[f] = calloc(length + 1, 1);
        if (!member->fish_name[f]) return no_memory(path);
        nc_get_vara_text(reading->file, number, (size_t[]){f, 0}, (size_t[]){1, length}, member->fish_name[f]);
    }
    return STATUS_OK;
}

static enum status read_all(struct reading *reading, const char *path) {
    struct member_file *const member = reading->member;
    int schema;
    if (nc_get_att_int(reading->file, NC_GLOBAL, "shoal_schema", &schema) != NC_NOERR || schema != RESULT_SCHEMA) {
        return status_fail(STATUS_FILE, "%s: not a result of this version of shoal", path);
    }
    if (nc_get_att_int(reading->file, NC_GLOBAL, "study_member", &member->number) != NC_NOERR) member->number = -1;
    member->status = text_attribute(reading->file, "run_status");
    member->study = text_attribute(reading->file, "study_case");
    member->effective = text_attribute(reading->file, "case_effective");
    if (!member->status || !member->study || !member->effective) return no_memory(path);

    reading->n_rows = dimension_length(reading->file, "time");
    reading->n_fish = dimension_length(reading->file, "fish");
    member->n_fish = (int)reading->n_fish;
    const size_t n_values = (size_t)n_quantities() * reading->n_fish * 2;
    member->value = malloc((n_values + 1) * sizeof *member->value);
    reading->time = calloc(reading->n_rows + 1, sizeof *reading->time);
    if (!member->value || !reading->time) return no_memory(path);
    for (size_t i = 0; i < n_values; i++) member->value[i] = NAN;
    TRY(read_names(reading, path));
    if (reading->n_rows == 0) return STATUS_OK;

    int time_variable;
    if (nc_inq_varid(reading->file, "time", &time_variable) != NC_NOERR ||
        nc_get_var_double(reading->file, time_variable, reading->time) != NC_NOERR) {
        return status_fail(STATUS_FILE, "%s: its times cannot be read", path);
    }
    read_last_row(reading);
    for (int f = 0; f < member->n_fish; f++) compute(reading, f);
    return STATUS_OK;
}

enum status member_file_read(struct member_file *member, const char *path) {
    *member = (struct member_file){0};
    struct reading reading = {.member = member};
    const int code = nc_open(path, NC_NOWRITE, &reading.file);
    if (code == NC_ENOMEM) return no_memory(path);
    if (code != NC_NOERR) return status_fail(STATUS_FILE, "%s: cannot be read: %s", path, nc_strerror(code));
    const enum status status = read_all(&reading, path);
    nc_close(reading.file);
    free(reading.time);
    if (status != STATUS_OK) member_file_free(member);
    return status;
}

void member_file_free(struct member_file *member) {
    for (int f = 0; member->fish_name && f < member->n_fish; f++) free(member->fish_name[f]);
    free(member->fish_name);
    free(member->status);
    free(member->study);
    free(member->effective);
    free(member->value);
    *member = (struct member_file){0};
}
