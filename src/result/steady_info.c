/* steady_info.c: see steady_info.h. */
#include "result/steady_info.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "result/result_reader.h"

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
    if (!netcdf_has(reader, "steady_exponent")) return STATUS_OK;
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

static enum status print_cells(const struct netcdf_reader *reader, const struct quantity *quantity, size_t n_fish,
                               size_t xy, FILE *stream) {
    for (size_t f = 0; f < n_fish; f++) {
        double value;
        struct netcdf_slice slice[] = {{"fish", f, 1}, {NULL}, {NULL}};
        if (quantity->of_xy) slice[1] = (struct netcdf_slice){"xy", xy, 1};
        TRY(netcdf_read_doubles(reader, quantity->variable, slice, &value));
        char text[320];
        snprintf(text, sizeof text, quantity->format, value);
        fprintf(stream, "  %12s", isnan(value) ? "-" : text);
    }

    fprintf(stream, "  %s\n", quantity->unit);
    return STATUS_OK;
}

/* Whether a row has a value at all. */
static enum status is_empty(const struct netcdf_reader *reader, const struct quantity *quantity, size_t n_fish,
                            int *is_empty) {
    *is_empty = 1;
    for (size_t f = 0; f < n_fish; f++) {
        double value;
        const struct netcdf_slice slice[] = {{"fish", f, 1}, {quantity->of_xy ? "xy" : NULL, 0, 1}, {NULL}};
        TRY(netcdf_read_doubles(reader, quantity->variable, slice, &value));
        *is_empty &= isnan(value);
    }
    return STATUS_OK;
}

static enum status print_head(const struct netcdf_reader *reader, size_t n_fish, FILE *stream) {
    fprintf(stream, "\n  %-22s", "");
    for (size_t f = 0; f < n_fish; f++) {
        char *name;
        TRY(result_reader_name(reader, f, &name));
        fprintf(stream, "  %12s", name);
        free(name);
    }

    fprintf(stream, "\n");
    return STATUS_OK;
}

enum status steady_info(const struct netcdf_reader *reader, FILE *stream) {
    if (!netcdf_has(reader, "steady_speed")) return STATUS_OK;
    static const char *const along[] = {", ahead", ", aside"}, *const axis[] = {", x", ", y"};
    size_t n_fish;
    TRY(print_effort(reader, stream));
    TRY(print_multipliers(reader, stream));
    TRY(netcdf_read_length(reader, "fish", 1, INT_MAX, &n_fish));
    TRY(print_head(reader, n_fish, stream));

    for (size_t q = 0; q < sizeof quantities / sizeof *quantities; q++) {
        const struct quantity *const quantity = &quantities[q];
        const int is_place = strcmp(quantity->head, "place") == 0;
        int has_none;
        TRY(is_empty(reader, quantity, n_fish, &has_none));
        if ((is_place && n_fish == 1) || has_none) continue;
        for (size_t xy = 0; xy < (quantity->of_xy ? 2 : 1); xy++) {
            char head[64];
            snprintf(head, sizeof head, "%s%s", quantity->head, quantity->of_xy ? (is_place ? along : axis)[xy] : "");
            fprintf(stream, "  %-22s", head);
            TRY(print_cells(reader, quantity, n_fish, xy, stream));
        }
    }

    return STATUS_OK;
}

// ---- see steady_info.h

/* A number; JSON has none that is not finite. */
static void print_number(double value, FILE *stream) {
    struct text text = {0};
    text_add_number(&text, value);
    fputs(isfinite(value) && text.text ? text.text : "null", stream);
    text_free(&text);
}

/* Lists of the values, the last index the fastest. */
static void print_list(const struct netcdf_slice *slice, const double **value, FILE *stream) {
    if (!slice->dimension) {
        print_number(*(*value)++, stream);
        return;
    }

    fputc('[', stream);
    for (size_t i = 0; i < slice->n; i++) {
        if (i > 0) fputs(", ", stream);
        print_list(slice + 1, value, stream);
    }

    fputc(']', stream);
}

static size_t used_multipliers(size_t n, const double *value) {
    while (n > 0 && isnan(value[2 * n - 2])) n--;
    return n;
}

static enum status print_variable(const struct netcdf_reader *reader, const struct result_variable *variable,
                                  FILE *stream) {
    struct netcdf_slice slice[RESULT_MAX_DIMENSIONS + 1] = {{NULL, 0, 0}};
    size_t size = 1;

    for (int d = 0; variable->dimension[d] != NONE; d++) {
        slice[d].dimension = result_table_dimension(variable->dimension[d]);
        TRY(netcdf_read_length(reader, slice[d].dimension, 1, INT_MAX, &slice[d].n));
        size *= slice[d].n;
    }

    double *const values = calloc(size, sizeof *values);
    if (!values) return status_fail(STATUS_MEMORY, "%s: out of memory while reading", reader->path);
    const enum status status = netcdf_read_doubles(reader, variable->name, slice, values);

    if (status == STATUS_OK) {
        if (variable->dimension[0] == MULTIPLIER) slice[0].n = used_multipliers(slice[0].n, values);
        const double *next = values;
        fprintf(stream, ",\n  \"%s\": ", variable->name);
        print_list(slice, &next, stream);
    }

    free(values);
    return status;
}

static enum status print_names(const struct netcdf_reader *reader, FILE *stream) {
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

enum status steady_json(const struct netcdf_reader *reader, FILE *stream) {
    fputs("{\"file\": ", stream);
    text_print_json(stream, reader->path);
    TRY(print_names(reader, stream));

    for (int i = 0; i < result_table_n; i++) {
        const struct result_variable *const variable = &result_table[i];
        if (variable->of_steady && netcdf_has(reader, variable->name)) TRY(print_variable(reader, variable, stream));
    }

    fputs("}\n", stream);
    return STATUS_OK;
}
