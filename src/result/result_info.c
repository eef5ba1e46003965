/* result_info.c: see result_info.h. */
#include "result/result_info.h"

#include <limits.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#include "base/table.h"
#include "base/text.h"
#include "case/case_table.h"
#include "result/result_reader.h"

struct info {
    const struct netcdf_reader *reader;
    size_t n_rows, n_fish;
    FILE *stream;
};

enum { NO_ROW = -1, NO_FISH = -1 };

/* Read a value of a row, of fish f; NO_ROW, NO_FISH: the variable has no rows, or no fish. */
static enum status info_read(const struct info *info, long row, long f, const char *name, double *value) {
    struct netcdf_slice slice[3] = {{NULL}};
    int n = 0;
    if (row != NO_ROW) slice[n++] = (struct netcdf_slice){"time", (size_t)row, 1};
    if (f != NO_FISH) slice[n++] = (struct netcdf_slice){"fish", (size_t)f, 1};
    return netcdf_read_doubles(info->reader, name, slice, value);
}

// ---- a run

/* The columns: constants, values of the last row, and values of files with a held body or with a cross-flow drag. */
static const struct column {
    const char *head, *unit, *variable, *format;
    enum { CONSTANT, LAST, LAST_OF_HELD, LAST_OF_CROSS_FLOW } kind;
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
    {"cross-flow", "W", "cross_flow_power", "%.3g", LAST_OF_CROSS_FLOW},
    {"energy", "J", "kinetic_energy", "%.4g", LAST},
    {"work", "J", "actuation_work", "%.4g", LAST},
    {"balance", "J", "energy_balance", "%.1e", LAST},
};
enum { N_COLUMNS = sizeof columns / sizeof *columns, N_CONSTANT_COLUMNS = 3 };

static enum status info_print_table(const struct info *info) {
    const int n_columns = info->n_rows > 0 ? N_COLUMNS : N_CONSTANT_COLUMNS;
    const long n_fish = (long)info->n_fish, last = (long)info->n_rows - 1;
    bool has_held = false, has_cross_flow = false;
    for (long f = 0; f < n_fish; f++) {
        double is_held, power = 0;
        TRY(info_read(info, NO_ROW, f, "is_held", &is_held));
        if (last >= 0) TRY(info_read(info, last, f, "cross_flow_power", &power));
        has_held |= is_held > 0;
        has_cross_flow |= fabs(power) > 0;
    }

    struct table *const table = table_create(info->reader->arena, 1);
    table_column(table, "fish", "");
    bool is_shown[N_COLUMNS];
    for (int i = 0; i < n_columns; i++) {
        is_shown[i] =
            (columns[i].kind != LAST_OF_HELD || has_held) && (columns[i].kind != LAST_OF_CROSS_FLOW || has_cross_flow);
        if (is_shown[i]) table_column(table, columns[i].head, columns[i].unit);
    }
    table_column(table, "", NULL);  // the last column is left-aligned

    for (long f = 0; f < n_fish; f++) {
        char *name;
        TRY(result_reader_name(info->reader, (size_t)f, &name));
        table_cell(table, "%s", name);
        for (int i = 0; i < n_columns; i++) {
            double value;
            if (!is_shown[i]) continue;
            TRY(info_read(info, columns[i].kind == CONSTANT ? NO_ROW : last, f, columns[i].variable, &value));
            table_number(table, columns[i].format, value);
        }
        table_row(table);
    }

    fprintf(info->stream, "\n");
    table_print(table, info->stream);
    return STATUS_OK;
}

/* The method with its orders, the size of the systems, and the totals of the solver. */
static enum status print_solver(const struct info *info) {
    static const char *const totals[] = {"steps",
                                         "residual_evaluations",
                                         "newton_iterations",
                                         "jacobian_evaluations",
                                         "klu_analyses",
                                         "klu_factorisations",
                                         "klu_refactorisations",
                                         "gmres_iterations",
                                         "error_test_failures",
                                         "convergence_failures",
                                         "initial_iterations"};
    FILE *const stream = info->stream;
    const long last = (long)info->n_rows - 1;
    double t, interval, wall, steps[METHODS_MAX_ORDER], unknowns[2] = {0}, non_zeros[2];
    char *method;
    TRY(info_read(info, last, NO_FISH, "time", &t));
    TRY(info_read(info, last, NO_FISH, "wall_time", &wall));
    TRY(info_read(info, NO_ROW, NO_FISH, "shedding_interval", &interval));
    const double n_events = t / interval;

    // the method, and the steps of each order
    TRY(netcdf_attribute(info->reader, "method", &method));
    const struct netcdf_slice orders[] = {{"time", (size_t)last, 1}, {"order_of_step", 0, METHODS_MAX_ORDER}, {NULL}};
    TRY(netcdf_read_doubles(info->reader, "steps_of_order", orders, steps));
    fprintf(stream, "\n  %-20s  %11s", "method", method);
    const char *before = "   steps of order ";
    for (int i = 0; i < METHODS_MAX_ORDER; i++) {
        if (!(steps[i] > 0)) continue;
        fprintf(stream, "%s%d: %.0f", before, i + 1, steps[i]);
        before = ", ";
    }

    // the size of the systems
    for (long f = 0; f < (long)info->n_fish; f++) {
        double n[2];
        TRY(info_read(info, NO_ROW, f, "differential_unknowns", &n[0]));
        TRY(info_read(info, NO_ROW, f, "algebraic_unknowns", &n[1]));
        for (int i = 0; i < 2; i++) unknowns[i] += n[i];
    }
    TRY(info_read(info, last, NO_FISH, "jacobian_non_zeros", &non_zeros[0]));
    TRY(info_read(info, last, NO_FISH, "factor_non_zeros", &non_zeros[1]));
    fprintf(stream, "\n  %-20s  %11.0f   differential, and %.0f algebraic\n", "unknowns", unknowns[0], unknowns[1]);
    if (non_zeros[0] > 0) {
        fprintf(stream, "  %-20s  %11.0f   of the Jacobian, and %.0f of its factors\n", "non-zeros", non_zeros[0],
                non_zeros[1]);
    }

    for (size_t i = 0; i < sizeof totals / sizeof *totals; i++) {
        double total;
        TRY(info_read(info, last, NO_FISH, totals[i], &total));
        fprintf(stream, "  %-20s  %11.0f", totals[i], total);
        if (n_events >= 1) fprintf(stream, "   %.2f per event", total / n_events);
        fprintf(stream, "\n");
    }
    fprintf(stream, "  %-20s  %11.2f s   %.3g times real time\n", "wall_time", wall, t / wall);
    return STATUS_OK;
}

/* The school, the steady state, and the effort of the solver. */
static enum status print_last_row(const struct info *info) {
    FILE *const stream = info->stream;
    const long last = (long)info->n_rows - 1;
    double circulation, distance, polarisation, balance[2];
    TRY(info_read(info, last, NO_FISH, "total_circulation", &circulation));
    TRY(info_read(info, last, NO_FISH, "least_distance", &distance));
    TRY(info_read(info, last, NO_FISH, "polarisation", &polarisation));
    const struct netcdf_slice row[] = {{"time", (size_t)last, 1}, {"xy", 0, 2}, {NULL}};
    TRY(netcdf_read_doubles(info->reader, "momentum_balance", row, balance));
    fprintf(stream, "\n  total circulation     %11.1e m2 s-1\n", circulation);
    if (!isnan(balance[0])) fprintf(stream, "  momentum balance      %11.1e N s\n", hypot(balance[0], balance[1]));
    if (info->n_fish > 1) {
        fprintf(stream, "  least distance        %11.4f m\n  polarisation          %11.4f\n", distance, polarisation);
    }

    TRY(result_info_steady(info->reader, stream));
    return print_solver(info);
}

enum status result_info(const struct netcdf_reader *reader, FILE *stream) {
    static const char *const notes[][2] = {{"closest_approach", "closest approach"}, {"warnings", "warning"}};
    struct info info = {.reader = reader, .stream = stream};
    char *text;
    TRY(netcdf_read_length(reader, "time", 0, SIZE_MAX, &info.n_rows));
    TRY(netcdf_read_length(reader, "fish", 1, CASE_MAX_FISH, &info.n_fish));
    TRY(netcdf_attribute(reader, "run_status", &text));
    fprintf(stream, "  status      %s\n", text);

    // the rows
    const size_t n_missing = reader->n_missing;
    if (n_missing > 0) {
        fprintf(stream, "  missing     %zu of %zu rows: the file was cut off\n", n_missing, info.n_rows + n_missing);
    }
    if (info.n_rows == 0) {
        fprintf(stream, "  rows        %s\n", n_missing > 0 ? "none is whole" : "none yet");
    } else {
        double first, last, interval;
        TRY(info_read(&info, 0, NO_FISH, "time", &first));
        TRY(info_read(&info, (long)info.n_rows - 1, NO_FISH, "time", &last));
        TRY(info_read(&info, NO_ROW, NO_FISH, "shedding_interval", &interval));
        fprintf(stream, "  rows        %zu, from t = %g s to %g s; a vortex every %g s\n", info.n_rows, first, last,
                interval);
    }

    TRY(info_print_table(&info));
    if (info.n_rows == 0) return STATUS_OK;
    TRY(print_last_row(&info));

    // each line of an attribute after a word
    for (size_t i = 0; i < sizeof notes / sizeof *notes; i++) {
        TRY(netcdf_attribute(reader, notes[i][0], &text));
        if (*text) fprintf(stream, "\n");
        for (char *line = strtok(text, "\n"); line; line = strtok(NULL, "\n"))
            fprintf(stream, "  %-20s  %s\n", notes[i][1], line);
    }
    return STATUS_OK;
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
    {"steady_towed_efficiency", "towed efficiency", "", "%.5f", false},
    {"steady_strouhal", "Strouhal number", "", "%.5f", false},
};

/* Read pair i of a variable over multipliers: false after the last one. */
static enum status read_pair(const struct netcdf_reader *reader, const char *name, size_t n, size_t i, double *pair,
                             bool *exists) {
    const struct netcdf_slice slice[] = {{"multiplier", i, 1}, {"xy", 0, 2}, {NULL}};
    *exists = false;
    if (i < n) TRY(netcdf_read_doubles(reader, name, slice, pair));
    *exists = i < n && !isnan(pair[0]);
    return STATUS_OK;
}

/* The most telling parts of the mode of multiplier i: "b ahead 1.00, b speed 0.86". */
static enum status print_mode(const struct netcdf_reader *reader, size_t i, size_t n_fish, FILE *stream) {
    static const char *const slow[STEADY_QUANTITIES] = {"speed", "slip",  "turn",      "heading",
                                                        "ahead", "aside", "amplitude", "course"};
    const double least = 0.2;
    enum { MOST_PARTS = 4 };
    const size_t n = n_fish * STEADY_QUANTITIES;
    double *mode;
    NEW(reader->arena, mode, 2 * n);
    const struct netcdf_slice slice[] = {
        {"multiplier", i, 1}, {"fish", 0, n_fish}, {"slow", 0, STEADY_QUANTITIES}, {"xy", 0, 2}, {NULL}};
    TRY(netcdf_read_doubles(reader, "steady_mode", slice, mode));

    for (int part = 0; part < MOST_PARTS; part++) {
        size_t largest = 0;
        double most = 0;
        for (size_t k = 0; k < n; k++) {
            const double size = hypot(mode[2 * k], mode[2 * k + 1]);
            if (size > most) largest = k, most = size;
        }
        if (most < least) break;
        mode[2 * largest] = 0, mode[2 * largest + 1] = 0;
        char *name = "";
        if (n_fish > 1) TRY(result_reader_name(reader, largest / (size_t)STEADY_QUANTITIES, &name));
        fprintf(stream, "%s%s%s%s %.2f", part > 0 ? ", " : "", name, n_fish > 1 ? " " : "",
                slow[largest % (size_t)STEADY_QUANTITIES], most);
    }
    return STATUS_OK;
}

/* Print the multipliers, of a pair the first only, and whether the state is stable. */
static enum status print_multipliers(const struct netcdf_reader *reader, double n_beats, size_t n, FILE *stream) {
    const struct info info = {.reader = reader};
    double pair[2], error, amplification, first[2] = {NAN, NAN};
    size_t n_fish;
    bool exists;
    TRY(netcdf_read_length(reader, "fish", 1, CASE_MAX_FISH, &n_fish));
    TRY(info_read(&info, NO_ROW, NO_FISH, "steady_amplification", &amplification));
    fprintf(stream, "  multipliers in %.0f more beats, and the largest parts of their modes:\n", n_beats);

    for (size_t i = 0;; i++) {
        TRY(read_pair(reader, "steady_multiplier", n, i, pair, &exists));
        if (!exists) break;
        const struct netcdf_slice slice[] = {{"multiplier", i, 1}, {NULL}};
        TRY(netcdf_read_doubles(reader, "steady_multiplier_error", slice, &error));
        const double size = hypot(pair[0], pair[1]);
        if (i == 0) first[0] = size, first[1] = error;
        if (!(size > 0) || pair[1] < 0) continue;
        fprintf(stream, "    %.4f +- %.4f", size, error);
        if (pair[1] > 0) fprintf(stream, ", period %.1f beats", 2 * M_PI / atan2(pair[1], pair[0]));
        if (pair[1] == 0 && pair[0] < 0) fprintf(stream, ", period 2 beats");
        fprintf(stream, ": ");
        TRY(print_mode(reader, i, n_fish, stream));
        fprintf(stream, "\n");
    }

    const char *const verdict = steady_verdict(first[0] - 1, first[1]);
    fprintf(stream, "  %s", verdict);
    if (strcmp(verdict, "undecided") == 0) fprintf(stream, ": 1 is within the error of the largest multiplier");
    if (strcmp(verdict, "unstable") != 0 && amplification > 1) {
        fprintf(stream, "; a disturbance may grow by the factor %.2g in %d beats", amplification,
                STEADY_AMPLIFIED_BEATS);
    }
    fprintf(stream, "\n");
    return STATUS_OK;
}

/* Print effort and stability: of bodies without a beat the growth rates of modes, else the multipliers. */
static enum status print_stability(const struct netcdf_reader *reader, FILE *stream) {
    const struct info info = {.reader = reader};
    const double still = 1e-5;  // growth rates below this, s-1, are rounding
    double beats, multiplier_beats, residual, error, stiffness, pair[2], first[2];
    bool exists;
    size_t n;
    TRY(info_read(&info, NO_ROW, NO_FISH, "steady_beats", &beats));
    TRY(info_read(&info, NO_ROW, NO_FISH, "steady_multiplier_beats", &multiplier_beats));
    TRY(info_read(&info, NO_ROW, NO_FISH, "steady_residual", &residual));
    TRY(info_read(&info, NO_ROW, NO_FISH, "steady_error", &error));
    TRY(netcdf_read_length(reader, "multiplier", 0, INT_MAX, &n));

    if (!(beats > 0)) {
        TRY(info_read(&info, NO_ROW, NO_FISH, "steady_stiffness", &stiffness));
        fprintf(stream, "\n  equilibrium: forces are in balance to %.1e\n", residual);
        if (!isnan(stiffness)) {
            fprintf(stream, "  static stiffness over that at rest: %.4f: %s\n", stiffness,
                    stiffness > 0 ? "does not diverge" : "diverges");
        }
        TRY(read_pair(reader, "steady_exponent", n, 0, pair, &exists));
        memcpy(first, pair, sizeof first);
        if (!exists) {
            fprintf(stream,
                    "  growth of disturbances: not computed: needs steady.multipliers, pressure.span infinite, and a\n"
                    "  stream that carries a wake away (wake.shedding other than impulsive)\n");
        }
        for (size_t i = 0; exists;) {
            fprintf(stream, "%s %+.4f s-1 at %.4g Hz", i == 0 ? "  growth of disturbances:" : ",",
                    fabs(pair[0]) < still ? 0 : pair[0], pair[1] / (2 * M_PI));
            TRY(read_pair(reader, "steady_exponent", n, ++i, pair, &exists));
            if (exists) continue;
            fprintf(stream, ": %s\n",
                    first[0] < still ? "stable"
                    : first[1] > 0   ? "unstable: flutters"
                                     : "unstable: diverges");
        }
    } else {
        fprintf(stream, "\n  steady state after %.0f beats: change from beat to beat %.1e", beats, residual);
        if (!isnan(error)) fprintf(stream, ", about %.1e from the fixed point", error);
        fprintf(stream, "\n");
        if (multiplier_beats > 0) return print_multipliers(reader, multiplier_beats, n, stream);
    }
    return STATUS_OK;
}

enum status result_info_steady(const struct netcdf_reader *reader, FILE *stream) {
    enum { N = sizeof quantities / sizeof *quantities };
    static const char *const along[] = {", ahead", ", aside"}, *const axis[] = {", x", ", y"};
    if (!netcdf_has(reader, "steady_speed")) return STATUS_OK;
    size_t n_fish;
    double *values;
    TRY(print_stability(reader, stream));
    TRY(netcdf_read_length(reader, "fish", 1, CASE_MAX_FISH, &n_fish));
    NEW(reader->arena, values, n_fish);

    struct table *const table = table_create(reader->arena, 1);
    table_column(table, "", NULL);
    for (size_t f = 0; f < n_fish; f++) {
        char *name;
        TRY(result_reader_name(reader, f, &name));
        table_column(table, name, NULL);
    }
    table_column(table, "", NULL);

    for (int i = 0; i < 2 * N; i++) {
        const struct quantity *const quantity = &quantities[i / 2];
        const bool is_place = strcmp(quantity->head, "place") == 0;
        if ((i % 2 == 1 && !quantity->of_xy) || (is_place && n_fish == 1)) continue;
        const struct netcdf_slice slice[] = {
            {"fish", 0, n_fish}, {quantity->of_xy ? "xy" : NULL, (size_t)(i % 2), 1}, {NULL}};
        TRY(netcdf_read_doubles(reader, quantity->variable, slice, values));

        // skip a row without values
        bool is_empty = true;
        for (size_t f = 0; f < n_fish; f++) is_empty &= isnan(values[f]);
        if (is_empty) continue;
        table_cell(table, "%s%s", quantity->head, quantity->of_xy ? (is_place ? along : axis)[i % 2] : "");
        for (size_t f = 0; f < n_fish; f++) table_number(table, quantity->format, values[f]);
        table_cell(table, "%s", quantity->unit);
        table_row(table);
    }

    fprintf(stream, "\n");
    table_print(table, stream);
    return STATUS_OK;
}

// ---- JSON

/* Lists of the values, the last index the fastest; JSON has no number that is not finite. */
static void print_json_list(const struct netcdf_slice *slice, const double **value, FILE *stream) {
    if (!slice->dimension) {
        char digits[TEXT_NUMBER_BYTES];
        text_of_number(digits, **value);
        fputs(isfinite(**value) ? digits : "null", stream);
        ++*value;
        return;
    }

    fputc('[', stream);
    for (size_t i = 0; i < slice->n; i++) {
        if (i > 0) fputs(", ", stream);
        print_json_list(slice + 1, value, stream);
    }

    fputc(']', stream);
}

/* A member of an object: the strings of a slice, whose last dimension holds the characters, as a list. */
static enum status print_json_strings(const struct netcdf_reader *reader, const char *name,
                                      const struct netcdf_slice *slice, FILE *stream) {
    size_t n = 1, length = 1;
    char *text, *string;
    for (const struct netcdf_slice *s = slice; s->dimension; s++) {
        n *= length;
        length = s->n;
    }
    NEW(reader->arena, text, n * length + 1);
    NEW(reader->arena, string, length + 1);
    TRY(netcdf_read_text(reader, name, slice, text));
    fprintf(stream, ",\n  \"%s\": [", name);
    for (size_t i = 0; i < n; i++) {
        memcpy(string, text + i * length, length);
        if (i > 0) fputs(", ", stream);
        text_print_json(stream, string);
    }
    fputc(']', stream);
    return STATUS_OK;
}

enum status result_json_steady(const struct netcdf_reader *reader, FILE *stream) {
    size_t n_fish, n_name;
    TRY(netcdf_read_length(reader, "fish", 1, INT_MAX, &n_fish));
    TRY(netcdf_read_length(reader, "name", 1, INT_MAX, &n_name));
    text_print_member(stream, "{", "file", reader->path);
    const struct netcdf_slice names[] = {{"fish", 0, n_fish}, {"name", 0, n_name}, {NULL}};
    TRY(print_json_strings(reader, "fish", names, stream));

    for (int i = 0; i < result_table_n; i++) {
        const struct result_variable *const variable = &result_table[i];
        if (!variable->of_steady || !netcdf_has(reader, variable->name)) continue;
        struct netcdf_slice slice[RESULT_MAX_DIMENSIONS + 1] = {{NULL, 0, 0}};
        size_t size = 1;
        double *values;
        for (int d = 0; variable->dimension[d] != NONE; d++) {
            slice[d].dimension = result_table_dimension(variable->dimension[d]);
            TRY(netcdf_read_length(reader, slice[d].dimension, 1, INT_MAX, &slice[d].n));
            size *= slice[d].n;
        }
        NEW(reader->arena, values, size);
        TRY(netcdf_read_doubles(reader, variable->name, slice, values));

        // omit unused multipliers
        const bool of_multipliers = variable->dimension[0] == MULTIPLIER;
        const size_t stride = of_multipliers ? size / slice[0].n : 0;  // a scalar has no slice
        while (of_multipliers && slice[0].n > 0) {
            size_t n_numbers = 0;
            for (size_t k = 0; k < stride; k++) {
                if (!isnan(values[stride * (slice[0].n - 1) + k])) n_numbers++;
            }
            if (n_numbers > 0) break;
            slice[0].n--;
        }
        const double *next = values;
        fprintf(stream, ",\n  \"%s\": ", variable->name);
        print_json_list(slice, &next, stream);
    }

    fputs("}\n", stream);
    return STATUS_OK;
}

enum { MAX_VALUES = 100000 /* of a variable in a summary */ };

/* A variable in a summary: the last row; nothing for a variable over many places. */
static enum status print_json_part(const struct netcdf_reader *reader, const struct netcdf_shape *shape, FILE *stream) {
    static const char *const detailed[] = {"node", "edge", "joint", "sheet", "control", "vortex", "x", "y"};
    struct netcdf_slice slice[NETCDF_MAX_DIMENSIONS + 1] = {{NULL, 0, 0}};
    size_t n = 1;
    if (*shape->name == '\0' || (shape->is_text && shape->n_dimensions == 0)) return STATUS_OK;
    for (int d = 0; d < shape->n_dimensions; d++) {
        const bool is_row = strcmp(shape->dimension[d], "time") == 0;
        if (is_row && shape->length[d] == 0) return STATUS_OK;
        slice[d] = (struct netcdf_slice){shape->dimension[d], is_row ? shape->length[d] - 1 : 0,
                                         is_row ? 1 : shape->length[d]};
        for (size_t i = 0; i < sizeof detailed / sizeof *detailed; i++) {
            if (strcmp(shape->dimension[d], detailed[i]) == 0) return STATUS_OK;
        }
        if (slice[d].n > MAX_VALUES / n) return STATUS_OK;
        n *= slice[d].n;
        if (n == 0) return STATUS_OK;
    }
    if (shape->is_text) return print_json_strings(reader, shape->name, slice, stream);

    double *values;
    NEW(reader->arena, values, n);
    fprintf(stream, ",\n  \"%s\": ", shape->name);
    TRY(netcdf_read_doubles(reader, shape->name, slice, values));
    const double *next = values;
    print_json_list(slice + (slice->dimension && strcmp(slice->dimension, "time") == 0), &next, stream);
    return STATUS_OK;
}

enum status result_json_summary(const struct netcdf_reader *reader, const char *kind, FILE *stream) {
    const bool is_run = strcmp(kind, "run") == 0;
    static const char *const members[][2] = {
        {"case", "title"}, {"program", "source"}, {"history", "history"}, {"status", "run_status"}};
    char *text;
    text_print_member(stream, "{", "file", reader->path);
    fprintf(stream, ",\n  \"kind\": \"%s\"", kind);
    for (int i = 0; i < (is_run ? 4 : 3); i++) {
        TRY(netcdf_attribute(reader, members[i][1], &text));
        text_print_member(stream, ",\n  ", members[i][0], text);
    }

    if (is_run) {
        TRY(netcdf_attribute(reader, "warnings", &text));
        fprintf(stream, ",\n  \"warnings\": [");
        const char *before = "";
        for (char *line = strtok(text, "\n"); line; line = strtok(NULL, "\n")) {
            fputs(before, stream);
            text_print_json(stream, line);
            before = ", ";
        }
        fprintf(stream, "],\n  \"rows\": %zu", reader->n_rows);
    }

    struct netcdf_shape shape;
    for (int i = 0; netcdf_read_shape(reader, i, &shape); i++) TRY(print_json_part(reader, &shape, stream));
    fputs("}\n", stream);
    return STATUS_OK;
}
