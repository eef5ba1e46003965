/* result_info.c: the summary of the file of a run. */
#include "result/result_info.h"

#include <limits.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "result/result_reader.h"
#include "result/steady_info.h"

struct info {
    const struct netcdf_reader *reader;
    size_t n_rows, n_fish, n_name;
    bool has_held;
    FILE *stream;
};

// ---- reading

/* A value of a row, of the school or of fish f. */
static enum status of_school(const struct info *info, size_t row, const char *name, double *value) {
    return netcdf_read_doubles(info->reader, name, (struct netcdf_slice[]){{"time", row, 1}, {NULL}}, value);
}

static enum status of_fish(const struct info *info, size_t row, const char *name, size_t f, double *value) {
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

static bool is_shown(const struct info *info, const struct column *column) {
    return column->kind != LAST_OF_HELD || info->has_held;
}

/* Whether a body is held. Files of earlier versions do not say so. */
static enum status find_held(struct info *info) {
    if (!netcdf_has(info->reader, "is_held")) return STATUS_OK;
    for (size_t f = 0; f < info->n_fish; f++) {
        double is_held;
        TRY(constant_of_fish(info, "is_held", f, &is_held));
        info->has_held |= is_held > 0;
    }
    return STATUS_OK;
}

/* Print a number of a table, or "-" for NaN. */
static void print_cell(const struct info *info, const char *format, double value) {
    char text[320];
    snprintf(text, sizeof text, format, value);
    fprintf(info->stream, "  %10s", isnan(value) ? "-" : text);
}

static enum status print_fish(const struct info *info, int n_columns, size_t f, int width) {
    char *name;
    TRY(result_reader_name(info->reader, f, &name));
    fprintf(info->stream, "  %-*s", width, name);
    free(name);

    for (int c = 0; c < n_columns; c++) {
        const struct column *const column = &columns[c];
        double value;
        if (!is_shown(info, column)) continue;
        if (column->kind != CONSTANT) {
            TRY(of_fish(info, info->n_rows - 1, column->variable, f, &value));
        } else {
            TRY(constant_of_fish(info, column->variable, f, &value));
        }
        print_cell(info, column->format, value);
    }

    fprintf(info->stream, "\n");
    return STATUS_OK;
}

static enum status print_table(const struct info *info) {
    const int width = info->n_name > 4 ? (int)info->n_name : 4;
    const int n_columns = info->n_rows > 0 ? N_COLUMNS : N_CONSTANT_COLUMNS;
    fprintf(info->stream, "\n  %-*s", width, "fish");
    for (int c = 0; c < n_columns; c++) {
        if (is_shown(info, &columns[c])) fprintf(info->stream, "  %10s", columns[c].head);
    }
    fprintf(info->stream, "\n  %-*s", width, "");
    for (int c = 0; c < n_columns; c++) {
        if (is_shown(info, &columns[c])) fprintf(info->stream, "  %10s", columns[c].unit);
    }
    fprintf(info->stream, "\n");
    for (size_t f = 0; f < info->n_fish; f++) TRY(print_fish(info, n_columns, f, width));
    return STATUS_OK;
}

// ---- data of the school

static enum status print_status(const struct info *info) {
    char *run_status;
    TRY(netcdf_read_string(info->reader, "run_status", &run_status));
    fprintf(info->stream, "  status      %s\n", run_status);
    free(run_status);
    return STATUS_OK;
}

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

    // files of earlier versions have no balance
    const struct netcdf_slice row[] = {{"time", last, 1}, {"xy", 0, 2}, {NULL}};
    if (netcdf_read_doubles(info->reader, "momentum_balance", row, balance) == STATUS_OK && !isnan(balance[0]))
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

static enum status print_all(const struct netcdf_reader *reader, FILE *stream) {
    struct info info = {.reader = reader, .stream = stream};
    TRY(netcdf_read_length(reader, "time", 0, SIZE_MAX, &info.n_rows));
    TRY(netcdf_read_length(reader, "fish", 1, INT_MAX, &info.n_fish));
    TRY(netcdf_read_length(reader, "name", 1, INT_MAX, &info.n_name));
    TRY(find_held(&info));
    TRY(print_status(&info));
    TRY(print_rows(&info));
    TRY(print_table(&info));
    if (info.n_rows == 0) return STATUS_OK;
    TRY(print_school(&info));
    TRY(steady_info(reader, stream));
    TRY(print_solver(&info));
    TRY(print_lines(&info, "closest_approach", "closest approach"));
    TRY(print_lines(&info, "merged_vortices", "merged vortices"));
    return print_lines(&info, "warnings", "warning");
}

enum status result_info(const char *path, FILE *stream) {
    return netcdf_print(path, print_all, stream);
}
