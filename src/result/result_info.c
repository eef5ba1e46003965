/* result_info.c: see result_info.h. */
#include "result/result_info.h"

#include <limits.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/text.h"
#include "case/case_table.h"
#include "result/result_reader.h"

struct info {
    const struct netcdf_reader *reader;
    size_t n_rows, n_fish;
    FILE *stream;
};

// ---- reading

/* A value of a row, of the school or of fish f. */
static enum status of_school(const struct info *info, size_t row, const char *name, double *value) {
    return netcdf_read_doubles(info->reader, name, (struct netcdf_slice[]){{"time", row, 1}, {NULL}}, value);
}

static enum status info_of_fish(const struct info *info, size_t row, const char *name, size_t f, double *value) {
    return netcdf_read_doubles(info->reader, name, (struct netcdf_slice[]){{"time", row, 1}, {"fish", f, 1}, {NULL}},
                               value);
}

/* A value that does not change with time. */
static enum status constant_of_fish(const struct info *info, const char *name, size_t f, double *value) {
    return netcdf_read_doubles(info->reader, name, (struct netcdf_slice[]){{"fish", f, 1}, {NULL}}, value);
}

static enum status interval_of(const struct info *info, double *interval) {
    return netcdf_read_doubles(info->reader, "shedding_interval", (struct netcdf_slice[]){{NULL}}, interval);
}

// ---- the table of fish

/* Set the names of the fish: in the first row, or from a row on in the first column. */
static enum status set_names(const struct netcdf_reader *reader, const struct text_table *table, int n_fish, int row) {
    for (int f = 0; f < n_fish; f++) {
        char *name;
        TRY(result_reader_name(reader, (size_t)f, &name));
        text_table_set(table, row == 0 ? 0 : row + f, row == 0 ? 1 + f : 0, "%s", name);
        free(name);
    }
    return STATUS_OK;
}

/* The columns: constants, values of the last row, and those of files with a held body. */
static const struct column {
    const char *head, *unit, *variable, *format;
    enum { CONSTANT, LAST, LAST_OF_HELD } kind;
} columns[] = {
    {"nodes", "", "n_nodes", "%.0f", CONSTANT},
    {"sheet", "", "n_sheet", "%.0f", CONSTANT},
    {"length", "m", "body_length", "%.4g", CONSTANT},
    {"vortices", "", "wake_count", "%.0f", LAST},
    {"speed", "m s-1", "speed", "%.4f", LAST},
    {"heading", "degree", "heading", "%.2f", LAST},
    {"phi0", "", "phi0", "%.4f", LAST},
    {"shed", "m2 s-1", "shed_circulation", "%.3e", LAST},
    {"thrust", "N", "mean_thrust", "%.4g", LAST_OF_HELD},
    {"power", "W", "mean_power", "%.4g", LAST_OF_HELD},
    {"efficiency", "", "efficiency", "%.4f", LAST_OF_HELD},
    {"energy", "J", "kinetic_energy", "%.4g", LAST},
    {"work", "J", "actuation_work", "%.4g", LAST},
    {"balance", "J", "energy_balance", "%.1e", LAST},
};
enum { N_COLUMNS = sizeof columns / sizeof *columns, N_CONSTANT_COLUMNS = 3 };

static enum status info_print_table(const struct info *info) {
    const int n_columns = info->n_rows > 0 ? N_COLUMNS : N_CONSTANT_COLUMNS, n_fish = (int)info->n_fish;
    bool has_held = false;
    for (int f = 0; f < n_fish; f++) {
        double is_held;
        TRY(constant_of_fish(info, "is_held", (size_t)f, &is_held));
        has_held |= is_held > 0;
    }

    struct text_table table;
    TRY(text_table_create(&table, 2 + n_fish, 1 + N_COLUMNS));
    table.n_left = 1;
    text_table_set(&table, 0, 0, "fish");
    enum status status = set_names(info->reader, &table, n_fish, 2);

    for (int i = 0, c = 1; i < n_columns && status == STATUS_OK; i++) {
        const struct column *const column = &columns[i];
        if (column->kind == LAST_OF_HELD && !has_held) continue;
        text_table_set(&table, 0, c, "%s", column->head);
        text_table_set(&table, 1, c, "%s", column->unit);
        for (int f = 0; f < n_fish && status == STATUS_OK; f++) {
            double value = NAN;
            status = column->kind == CONSTANT
                         ? constant_of_fish(info, column->variable, (size_t)f, &value)
                         : info_of_fish(info, info->n_rows - 1, column->variable, (size_t)f, &value);
            text_table_number(&table, 2 + f, c, column->format, value);
        }
        c++;
    }

    fprintf(info->stream, "\n");
    if (status == STATUS_OK) text_table_print(&table, info->stream);
    text_table_free(&table);
    return status;
}

// ---- data of the school

static enum status print_rows(const struct info *info) {
    const size_t n_missing = info->reader->n_missing;
    if (n_missing > 0) {
        fprintf(info->stream, "  missing     %zu of %zu rows: the file was cut off\n", n_missing,
                info->n_rows + n_missing);
    }

    if (info->n_rows == 0) {
        fprintf(info->stream, "  rows        %s\n", n_missing > 0 ? "none is whole" : "none yet");
        return STATUS_OK;
    }

    double first, last, interval;
    TRY(of_school(info, 0, "time", &first));
    TRY(of_school(info, info->n_rows - 1, "time", &last));
    TRY(interval_of(info, &interval));
    fprintf(info->stream, "  rows        %zu, from t = %g s to %g s; a vortex every %g s\n", info->n_rows, first, last,
            interval);
    return STATUS_OK;
}

/* Print each line of an attribute after a word; nothing for an empty or missing attribute. */
static enum status print_lines(const struct info *info, const char *name, const char *word) {
    char *text;
    TRY(netcdf_read_string(info->reader, name, &text));
    if (*text) fprintf(info->stream, "\n");
    for (char *line = strtok(text, "\n"); line; line = strtok(NULL, "\n"))
        fprintf(info->stream, "  %-20s  %s\n", word, line);
    free(text);
    return STATUS_OK;
}

static enum status print_school(const struct info *info) {
    const size_t last = info->n_rows - 1;
    double circulation, distance, polarisation, balance[2];
    TRY(of_school(info, last, "total_circulation", &circulation));
    TRY(of_school(info, last, "least_distance", &distance));
    TRY(of_school(info, last, "polarisation", &polarisation));
    fprintf(info->stream, "\n  total circulation     %11.1e m2 s-1\n", circulation);

    const struct netcdf_slice row[] = {{"time", last, 1}, {"xy", 0, 2}, {NULL}};
    TRY(netcdf_read_doubles(info->reader, "momentum_balance", row, balance));
    if (!isnan(balance[0]))
        fprintf(info->stream, "  momentum balance      %11.1e N s\n", hypot(balance[0], balance[1]));
    if (info->n_fish > 1)
        fprintf(info->stream, "  least distance        %11.4f m\n  polarisation          %11.4f\n", distance,
                polarisation);
    return STATUS_OK;
}

static enum status print_solver(const struct info *info) {
    static const char *const totals[] = {"steps",
                                         "residual_evaluations",
                                         "newton_iterations",
                                         "jacobian_evaluations",
                                         "error_test_failures",
                                         "convergence_failures"};
    const size_t last = info->n_rows - 1;
    double t, interval, wall;
    TRY(of_school(info, last, "time", &t));
    TRY(of_school(info, last, "wall_time", &wall));
    TRY(interval_of(info, &interval));
    const double n_events = t / interval;
    fprintf(info->stream, "\n");

    for (size_t i = 0; i < sizeof totals / sizeof *totals; i++) {
        double total;
        TRY(of_school(info, last, totals[i], &total));
        fprintf(info->stream, "  %-20s  %11.0f", totals[i], total);
        if (n_events >= 1) fprintf(info->stream, "   %.2f per event", total / n_events);
        fprintf(info->stream, "\n");
    }

    fprintf(info->stream, "  %-20s  %11.2f s   %.3g times real time\n", "wall_time", wall, t / wall);
    return STATUS_OK;
}

static enum status info_print_all(const struct netcdf_reader *reader, FILE *stream) {
    struct info info = {.reader = reader, .stream = stream};
    TRY(netcdf_read_length(reader, "time", 0, SIZE_MAX, &info.n_rows));
    TRY(netcdf_read_length(reader, "fish", 1, CASE_MAX_FISH, &info.n_fish));
    char *run_status;
    TRY(netcdf_read_string(info.reader, "run_status", &run_status));
    fprintf(info.stream, "  status      %s\n", run_status);
    free(run_status);

    TRY(print_rows(&info));
    TRY(info_print_table(&info));
    if (info.n_rows == 0) return STATUS_OK;
    TRY(print_school(&info));
    TRY(result_info_steady(reader, stream));
    TRY(print_solver(&info));
    TRY(print_lines(&info, "closest_approach", "closest approach"));
    TRY(print_lines(&info, "merged_vortices", "merged vortices"));
    return print_lines(&info, "warnings", "warning");
}

enum status result_info(const char *path, FILE *stream) {
    return netcdf_print(path, info_print_all, stream);
}

// ---- steady states

/* The rows of the table; vector variables have two rows. */
static const struct quantity {
    const char *variable, *head, *unit, *format;
    bool of_xy;
} quantities[] = {
    {"steady_speed", "speed", "m s-1", "%.5f", false},
    {"steady_turn", "turn in a beat", "degree", "%.4f", false},
    {"steady_place", "place", "m", "%.5f", true},
    {"steady_force", "force of the fluid", "N", "%.5g", true},
    {"steady_thrust", "thrust", "N", "%.5g", false},
    {"steady_drag", "drag", "N", "%.5g", false},
    {"steady_lift", "lift", "N", "%.5g", false},
    {"steady_deflection", "deflection", "m", "%.5f", false},
    {"steady_actuation_power", "power of the muscle", "W", "%.5g", false},
    {"steady_constraint_power", "driving power", "W", "%.5g", false},
    {"steady_damping_power", "power of damping", "W", "%.5g", false},
    {"steady_fluid_power", "power to the fluid", "W", "%.5g", false},
    {"steady_power", "power of muscle and drive", "W", "%.5g", false},
    {"steady_cost_of_transport", "cost of transport", "m s-2", "%.5f", false},
    {"steady_efficiency", "efficiency", "", "%.5f", false},
    {"steady_strouhal", "Strouhal number", "", "%.5f", false},
};

/* Growth rates of the modes of bodies without a beat. */
static enum status print_modes(const struct netcdf_reader *reader, FILE *stream) {
    const double still = 1e-5, two_pi = 6.283185307179586;  // rates below this, s-1, are rounding
    size_t n, i = 0;
    double first[2] = {0};
    TRY(netcdf_read_length(reader, "multiplier", 0, INT_MAX, &n));

    for (; i < n; i++) {
        double value[2];
        TRY(netcdf_read_doubles(reader, "steady_exponent",
                                (struct netcdf_slice[]){{"multiplier", i, 1}, {"xy", 0, 2}, {NULL}}, value));
        if (isnan(value[0])) break;
        if (i == 0) memcpy(first, value, sizeof first);
        fprintf(stream, "%s %+.4f s-1 at %.4g Hz", i == 0 ? "  growth of disturbances:" : ",",
                fabs(value[0]) < still ? 0 : value[0], value[1] / two_pi);
    }

    if (i > 0) {
        fprintf(stream, ": %s\n",
                first[0] < still ? "stable"
                : first[1] > 0   ? "unstable: flutters"
                                 : "unstable: diverges");
    }

    return STATUS_OK;
}

/* Of bodies without a beat. */
static enum status print_equilibrium(const struct netcdf_reader *reader, double residual, FILE *stream) {
    double stiffness;
    TRY(netcdf_read_doubles(reader, "steady_stiffness", (struct netcdf_slice[]){{NULL}}, &stiffness));
    fprintf(stream, "\n  equilibrium: forces are in balance to %.1e\n", residual);
    if (!isnan(stiffness)) {
        fprintf(stream, "  static stiffness over that at rest: %.4f: %s\n", stiffness,
                stiffness > 0 ? "does not diverge" : "diverges");
    }
    return print_modes(reader, stream);
}

static enum status print_effort(const struct netcdf_reader *reader, FILE *stream) {
    const struct netcdf_slice all[] = {{NULL}};
    double beats, multiplier_beats, residual, error;
    TRY(netcdf_read_doubles(reader, "steady_beats", all, &beats));
    TRY(netcdf_read_doubles(reader, "steady_multiplier_beats", all, &multiplier_beats));
    TRY(netcdf_read_doubles(reader, "steady_residual", all, &residual));
    TRY(netcdf_read_doubles(reader, "steady_error", all, &error));
    if (!(beats > 0)) return print_equilibrium(reader, residual, stream);
    fprintf(stream, "\n  steady state after %.0f beats: change from beat to beat %.1e", beats, residual);
    if (!isnan(error)) fprintf(stream, ", about %.1e from the fixed point", error);
    fprintf(stream, "\n");
    if (multiplier_beats > 0) fprintf(stream, "  multipliers in %.0f more beats:", multiplier_beats);
    return STATUS_OK;
}

/* Of a pair only the first is printed. */
static enum status print_multipliers(const struct netcdf_reader *reader, FILE *stream) {
    size_t n;
    TRY(netcdf_read_length(reader, "multiplier", 0, INT_MAX, &n));
    double largest = NAN;

    for (size_t i = 0; i < n; i++) {
        double value[2];
        TRY(netcdf_read_doubles(reader, "steady_multiplier",
                                (struct netcdf_slice[]){{"multiplier", i, 1}, {"xy", 0, 2}, {NULL}}, value));
        if (isnan(value[0])) break;
        if (i == 0) largest = hypot(value[0], value[1]);
        if (value[1] < 0) continue;
        fprintf(stream, "%s %.4f", i > 0 ? "," : "", value[0]);
        if (value[1] > 0) fprintf(stream, " +- %.4f i", value[1]);
    }

    if (!isnan(largest)) fprintf(stream, ": %s\n", largest < 1 ? "stable" : "unstable");
    return STATUS_OK;
}

enum status result_info_steady(const struct netcdf_reader *reader, FILE *stream) {
    enum { N = sizeof quantities / sizeof *quantities };
    static const char *const along[] = {", ahead", ", aside"}, *const axis[] = {", x", ", y"};
    if (!netcdf_has(reader, "steady_speed")) return STATUS_OK;
    size_t n_fish;
    TRY(print_effort(reader, stream));
    TRY(print_multipliers(reader, stream));
    TRY(netcdf_read_length(reader, "fish", 1, CASE_MAX_FISH, &n_fish));

    struct text_table table;
    TRY(text_table_create(&table, 1 + 2 * N, 2 + (int)n_fish));
    table.n_left = 1;
    enum status status = set_names(reader, &table, (int)n_fish, 0);

    // one row after the other; the next quantity overwrites a row without values
    int row = 1;
    for (int i = 0; i < 2 * N && status == STATUS_OK; i++) {
        const struct quantity *const quantity = &quantities[i / 2];
        const bool is_place = strcmp(quantity->head, "place") == 0;
        bool is_empty = true;
        if ((i % 2 == 1 && !quantity->of_xy) || (is_place && n_fish == 1)) continue;

        text_table_set(&table, row, 0, "%s%s", quantity->head, quantity->of_xy ? (is_place ? along : axis)[i % 2] : "");
        text_table_set(&table, row, 1 + (int)n_fish, "%s", quantity->unit);
        for (size_t f = 0; f < n_fish && status == STATUS_OK; f++) {
            double value = NAN;
            const struct netcdf_slice slice[] = {
                {"fish", f, 1}, {quantity->of_xy ? "xy" : NULL, (size_t)(i % 2), 1}, {NULL}};
            status = netcdf_read_doubles(reader, quantity->variable, slice, &value);
            text_table_number(&table, row, 1 + (int)f, quantity->format, value);
            is_empty &= isnan(value);
        }
        if (!is_empty) row++;
    }

    table.n_rows = row;
    fprintf(stream, "\n");
    if (status == STATUS_OK) text_table_print(&table, stream);
    text_table_free(&table);
    return status;
}

// ---- JSON

/* A number; JSON has none that is not finite. */
static void print_json_number(double value, FILE *stream) {
    struct text text = {0};
    text_add_number(&text, value);
    fputs(isfinite(value) && text.text ? text.text : "null", stream);
    text_free(&text);
}

/* Lists of the values, the last index the fastest. */
static void print_json_list(const struct netcdf_slice *slice, const double **value, FILE *stream) {
    if (!slice->dimension) {
        print_json_number(*(*value)++, stream);
        return;
    }

    fputc('[', stream);
    for (size_t i = 0; i < slice->n; i++) {
        if (i > 0) fputs(", ", stream);
        print_json_list(slice + 1, value, stream);
    }

    fputc(']', stream);
}

static size_t used_multipliers(size_t n, const double *value) {
    while (n > 0 && isnan(value[2 * n - 2])) n--;
    return n;
}

static enum status print_json_variable(const struct netcdf_reader *reader, const struct result_variable *variable,
                                       FILE *stream) {
    struct netcdf_slice slice[RESULT_MAX_DIMENSIONS + 1] = {{NULL, 0, 0}};
    size_t size = 1;

    for (int d = 0; variable->dimension[d] != NONE; d++) {
        slice[d].dimension = result_table_dimension(variable->dimension[d]);
        TRY(netcdf_read_length(reader, slice[d].dimension, 1, INT_MAX, &slice[d].n));
        size *= slice[d].n;
    }

    double *values;
    TRY(MEMORY_NEW(values, size, variable->name));
    const enum status status = netcdf_read_doubles(reader, variable->name, slice, values);

    if (status == STATUS_OK) {
        if (variable->dimension[0] == MULTIPLIER) slice[0].n = used_multipliers(slice[0].n, values);
        const double *next = values;
        fprintf(stream, ",\n  \"%s\": ", variable->name);
        print_json_list(slice, &next, stream);
    }

    free(values);
    return status;
}

static enum status print_json_names(const struct netcdf_reader *reader, FILE *stream) {
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
    text_print_member(stream, "{", "file", reader->path);
    TRY(print_json_names(reader, stream));

    for (int i = 0; i < result_table_n; i++) {
        const struct result_variable *const variable = &result_table[i];
        if (variable->of_steady && netcdf_has(reader, variable->name))
            TRY(print_json_variable(reader, variable, stream));
    }

    fputs("}\n", stream);
    return STATUS_OK;
}

// ---- the summary of any file as JSON

enum { MAX_VALUES = 100000 /* of a variable in a summary */ };

/* A member of an object: an attribute of the file. */
static enum status print_json_attribute(const struct netcdf_reader *reader, const char *name, const char *attribute,
                                        FILE *stream) {
    char *text;
    TRY(netcdf_read_string(reader, attribute, &text));
    text_print_member(stream, ",\n  ", name, text);
    free(text);
    return STATUS_OK;
}

/* The lines of an attribute as a list. */
static enum status print_json_lines(const struct netcdf_reader *reader, const char *attribute, FILE *stream) {
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
static enum status print_json_strings(const struct netcdf_reader *reader, const struct netcdf_shape *shape,
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

static enum status print_json_part(const struct netcdf_reader *reader, const struct netcdf_shape *shape, FILE *stream) {
    struct netcdf_slice slice[NETCDF_MAX_DIMENSIONS + 1] = {{NULL, 0, 0}};
    const size_t n = choose_part(shape, slice);
    if (n == 0 || (shape->is_text && shape->n_dimensions == 0)) return STATUS_OK;
    fprintf(stream, ",\n  \"%s\": ", shape->name);
    if (shape->is_text) return print_json_strings(reader, shape, slice, n, stream);

    double *values;
    TRY(MEMORY_NEW(values, n, shape->name));
    const enum status status = netcdf_read_doubles(reader, shape->name, slice, values);
    if (status == STATUS_OK) {
        const double *next = values;
        print_json_list(slice + (slice->dimension && strcmp(slice->dimension, "time") == 0), &next, stream);
    }
    free(values);
    return status;
}

enum status result_json_summary(const struct netcdf_reader *reader, const char *kind, FILE *stream) {
    text_print_member(stream, "{", "file", reader->path);
    fprintf(stream, ",\n  \"kind\": \"%s\"", kind);
    TRY(print_json_attribute(reader, "case", "title", stream));
    TRY(print_json_attribute(reader, "program", "source", stream));
    TRY(print_json_attribute(reader, "history", "history", stream));
    if (strcmp(kind, "run") == 0) {
        TRY(print_json_attribute(reader, "status", "run_status", stream));
        TRY(print_json_lines(reader, "warnings", stream));
        fprintf(stream, ",\n  \"rows\": %zu", reader->n_rows);
    }

    struct netcdf_shape shape;
    for (int i = 0; netcdf_read_shape(reader, i, &shape); i++) TRY(print_json_part(reader, &shape, stream));
    fputs("}\n", stream);
    return STATUS_OK;
}
