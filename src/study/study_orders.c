/* study_orders.c: orders, limits and errors; their table and their variables in study.nc. */
#include "study/study_orders.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "case/sweep.h"
#include "case/sweep_error.h"
#include "study/error_plan.h"
#include "study/study_print.h"

enum { NAME_BYTES = 64, MEANING_BYTES = 160 };

/* Error of a steady state without multipliers, over the residual change per beat (an estimate). */
static const double of_residual = 10;

static int is_observed(const struct case_values *study, int q) {
    return (int)(sweep_refine_orders(study) >> q & 1);
}

// ---- against a given value

// NaN if a level is exact to rounding
static double order_of_two(const double *size, const double (*f)[2], const double *exact) {
    const double fine = hypot(f[0][0] - exact[0], f[0][1] - exact[1]);
    const double coarse = hypot(f[1][0] - exact[0], f[1][1] - exact[1]);
    const double least = 1e-12 * fmax(1, hypot(exact[0], exact[1]));
    return fine > least && coarse > least ? log(coarse / fine) / log(size[1] / size[0]) : NAN;
}

struct error_budget_result study_order_of_errors(int n, const double *size, const double (*f)[2], const double *exact) {
    struct error_budget_result result = {.verdict = ERROR_BUDGET_ACCEPTED,
                                         .order = order_of_two(size, f, exact),
                                         .coarse_order = n > 2 ? order_of_two(size + 1, f + 1, exact) : NAN,
                                         .error = hypot(f[0][0] - exact[0], f[0][1] - exact[1]),
                                         .finest_error = NAN};
    for (int i = 0; i < n; i++) {
        if (isnan(f[i][0] + f[i][1])) result.verdict = ERROR_BUDGET_UNKNOWN;
    }

    return result;
}

// ---- all groups

// the index of a quantity of a fish of a group
static int place_of(const struct study_orders *orders, int group, int quantity, int fish) {
    return (group * SWEEP_N_ORDERS + quantity) * orders->n_fish + fish;
}

/* Arguments of the functions that fill the orders of a study. */
struct refinement {
    const struct case_values *study;
    const struct member_file *members;
    struct study_orders *orders;
    const struct sweep_error_key *key; /* refined key */
};

/* The number of a value of the refined key. */
static double orders_number_of(const struct refinement *refinement, int value) {
    const struct sweep_axis *const axis = &refinement->study->sweep[refinement->orders->axis];
    double number = NAN;
    text_number(axis->value[value * axis->n_keys], &number);
    return number;
}

/* The member at a level of a group. */
static const struct member_file *member_at(const struct refinement *refinement, int group, int level) {
    const struct study_orders *const orders = refinement->orders;
    int stride = 1;
    for (int a = orders->axis + 1; a < refinement->study->n_axes; a++) stride *= refinement->study->sweep[a].n_values;
    return &refinement->members[orders->first[group] + orders->level[level] * stride];
}

/* Read a quantity of a fish at a level of a group; NaN if the member is not complete. */
static void orders_read_value(const struct refinement *refinement, int group, int level, int q, int f,
                              double value[2]) {
    const struct member_file *const member = member_at(refinement, group, level);
    const int quantity = member_file_quantity_number(sweep_quantities[q].name);
    const int is_complete = member_file_is_complete(member);
    value[0] = is_complete ? member_file_value(member, quantity, f, 0) : NAN;
    value[1] = sweep_quantities[q].of_xy ? member_file_value(member, quantity, f, 1) : 0;
}

/* The error of the values of a member independent of the levels: error of the integrator and of the steady search. */
static double orders_noise_of(const struct refinement *refinement, const struct member_file *member) {
    const struct case_values *const study = refinement->study;
    double rtol = study->solver.step > 0 ? 0 : study->solver.rtol;
    for (int a = 0; a < study->n_axes; a++) {
        const struct sweep_axis *const axis = &study->sweep[a];
        const int value = sweep_member_value(study, (int)(member - refinement->members), a);
        for (int k = 0; k < axis->n_keys; k++) {
            if (strcmp(axis->key[k].path, "solver.rtol") != 0) continue;
            text_number(axis->value[value * axis->n_keys + k], &rtol);
        }
    }

    if (!sweep_is_steady(study)) return rtol;
    const double error = member_file_number(member, "steady_error", 0);
    const double residual = member_file_number(member, "steady_residual", 0);

    return rtol + (isnan(error) ? of_residual * residual : error);
}

/* Fill the order of one quantity of one fish of a group. */
static void fill_order(const struct refinement *refinement, int group, int q, int f) {
    struct study_orders *const orders = refinement->orders;
    const int n = orders->n_levels, of_xy = sweep_quantities[q].of_xy, place = place_of(orders, group, q, f);
    const double given[2] = {sweep_reference(refinement->study, orders->axis, q, f, 0),
                             of_xy ? sweep_reference(refinement->study, orders->axis, q, f, 1) : 0};
    const int is_given = !isnan(given[0]);

    // judge the finest levels, from fine to coarse
    struct study_order *const order = &orders->order[place];
    double size[ERROR_BUDGET_LEVELS], value[ERROR_BUDGET_LEVELS][2], number[ERROR_BUDGET_LEVELS];
    for (int i = 0; i < orders->n_judged; i++) {
        size[i] = orders->grid_spacing[n - 1 - i];
        number[i] = orders_number_of(refinement, orders->level[n - 1 - i]);
        orders_read_value(refinement, group, n - 1 - i, q, f, value[i]);
        order->is_known |= !isnan(value[i][0]);
    }

    if (is_given) {
        order->result = study_order_of_errors(orders->n_judged, size, (const double(*)[2])value, given);
    } else {
        const struct error_budget_levels levels = {
            .n = orders->n_judged,
            .n_judged = orders->n_judged,
            .size = size,
            .design_order = sweep_error_order(refinement->study, refinement->key)};
        const double noise = orders_noise_of(refinement, member_at(refinement, group, n - 1));
        order->result = error_budget_judge(&levels, (const double(*)[2])value, noise);
        error_budget_reason(&levels, &order->result, number, order->flag);
    }

    const double part = 1 / (pow(size[1] / size[0], order->result.order) - 1);
    for (int k = 0; k < 2; k++) {
        const double limit = value[0][k] + (value[0][k] - value[1][k]) * part;
        order->limit[k] = error_budget_is_flagged(order->result.verdict) ? NAN : limit;
    }

    for (int i = 0; i < n; i++) {
        double at[2];
        const double *const exact = is_given ? given : value[0];
        orders_read_value(refinement, group, i, q, f, at);
        orders->error[place * n + i] = i < n - 1 || is_given ? hypot(at[0] - exact[0], at[1] - exact[1]) : NAN;
    }
}

void study_orders_create(struct arena *arena, struct study_orders *orders, const struct case_values *study,
                         const struct member_file *members) {
    *orders = (struct study_orders){.n_fish = study->school.n_fish};
    while (orders->axis < study->n_axes && !study->sweep[orders->axis].refine) orders->axis++;
    if (orders->axis == study->n_axes) return;

    const struct sweep_axis *const axis = &study->sweep[orders->axis];
    const int n_levels = axis->n_values, n_groups = sweep_n_members(study) / n_levels;
    const int n = n_groups * SWEEP_N_ORDERS * orders->n_fish;
    NEW(arena, orders->level, n_levels);
    NEW(arena, orders->grid_spacing, n_levels);
    NEW(arena, orders->first, n_groups);
    NEW(arena, orders->order, n);
    NEW(arena, orders->error, n * n_levels);
    orders->n_groups = n_groups;
    orders->n_levels = n_levels;
    orders->n_judged = n_levels < ERROR_BUDGET_LEVELS ? n_levels : ERROR_BUDGET_LEVELS;

    // sort the levels from coarse to fine: insertion sort of few levels
    const struct refinement refinement = {study, members, orders, sweep_error_find(axis->key[0].row)};
    for (int i = 0; i < n_levels; i++) {
        const double size = error_plan_size(refinement.key, orders_number_of(&refinement, i));
        int j = i;
        for (; j > 0 && orders->grid_spacing[j - 1] < size; j--) {
            orders->grid_spacing[j] = orders->grid_spacing[j - 1];
            orders->level[j] = orders->level[j - 1];
        }
        orders->grid_spacing[j] = size;
        orders->level[j] = i;
    }

    // a group starts at each member with the first value of the refined axis
    for (int m = 0, g = 0; m < sweep_n_members(study); m++) {
        if (sweep_member_value(study, m, orders->axis) == 0) orders->first[g++] = m;
    }

    for (int g = 0; g < n_groups; g++) {
        for (int q = 0; q < SWEEP_N_ORDERS; q++) {
            for (int f = 0; f < study->school.n_fish && is_observed(study, q); f++) fill_order(&refinement, g, q, f);
        }
    }
}

// ---- the table

/* Print one line for each kind of flag with the flagged quantities; the table states their orders. */
static void print_flags(const struct case_values *study, const struct study_orders *orders, int group, FILE *stream) {
    for (int verdict = ERROR_BUDGET_OBJECTION; verdict <= ERROR_BUDGET_UNKNOWN; verdict++) {
        int n = 0;
        for (int place = 0; place < SWEEP_N_ORDERS * orders->n_fish; place++) {
            const int q = place / orders->n_fish, f = place % orders->n_fish;
            const struct study_order *const order = &orders->order[place_of(orders, group, q, f)];
            if (!order->is_known || (int)order->result.verdict != verdict || !*order->flag) continue;
            if (n == 0) fprintf(stream, "warning: %s: ", error_budget_words((enum error_budget_verdict)verdict));
            fprintf(stream, "%s%s of %s", n++ > 0 ? ", " : "", sweep_quantities[q].name, study->school.fish[f].name);
        }
        if (n > 0) fprintf(stream, "\n");
    }
}

/* Test the expected order; STATUS_MISSED for another order. */
static enum status test_order(const struct case_values *study, const struct study_orders *orders, int group, int q,
                              int f, FILE *stream) {
    const struct sweep_axis *const axis = &study->sweep[orders->axis];
    const struct study_order *const order = &orders->order[place_of(orders, group, q, f)];
    const char *const fish = study->school.fish[f].name, *const quantity = sweep_quantities[q].name;

    if (!(axis->order_of >> q & 1) || !(axis->order > 0)) return STATUS_OK;
    const int is_met = fabs(order->result.order - axis->order) <= axis->within;
    fprintf(stream, "%s: order of %s of %s is %.2f, expected %g +- %g\n", is_met ? "met" : "MISSED", quantity, fish,
            order->result.order, axis->order, axis->within);
    if (is_met) return STATUS_OK;

    return status_fail(STATUS_MISSED, "%s of %s: observed order %.2f in %s, expected %g +- %g", quantity, fish,
                       order->result.order, axis->key[0].path, axis->order, axis->within);
}

/* Print errors and orders of one group: members that differ in the refined axis only. */
static enum status print_group(const struct case_values *study, const struct study_orders *orders, int group,
                               FILE *stream) {
    static const char *const heads[] = {"coarse order", "order", "extrapolated", "", "error", "by"};
    const struct sweep_axis *const axis = &study->sweep[orders->axis];
    const int n = orders->n_levels;
    struct text_table table;
    TRY(text_table_create(&table, 1 + SWEEP_N_ORDERS * orders->n_fish, n + 9));

    // the values of the axis over the columns of errors
    text_table_set(&table, 0, 0, "difference of");
    text_table_set(&table, 0, 1, "fish");
    text_table_set(&table, 0, 2, "unit");
    for (int i = 0; i < n; i++) text_table_set(&table, 0, 3 + i, "%s", axis->value[orders->level[i] * axis->n_keys]);
    for (int i = 0; i < 6; i++) text_table_set(&table, 0, 3 + n + i, "%s", heads[i]);

    // a row for each quantity of each fish
    int row = 1;
    for (int place = 0; place < SWEEP_N_ORDERS * orders->n_fish; place++) {
        const int q = place / orders->n_fish, f = place % orders->n_fish;
        const struct study_order *const order = &orders->order[place_of(orders, group, q, f)];
        const double *const error = &orders->error[place_of(orders, group, q, f) * n];
        const struct sweep_quantity *const quantity = &sweep_quantities[q];
        const int is_given = !isnan(sweep_reference(study, orders->axis, q, f, 0));
        if (!order->is_known) continue;
        text_table_set(&table, row, 0, "%s%s", quantity->name, is_given ? "*" : "");
        text_table_set(&table, row, 1, "%s", study->school.fish[f].name);
        text_table_set(&table, row, 2, "%s", member_file_quantity(member_file_quantity_number(quantity->name))->unit);
        for (int i = 0; i < n; i++) text_table_number(&table, row, 3 + i, "%.2e", error[i]);
        text_table_number(&table, row, n + 3, "%.2f", order->result.coarse_order);
        text_table_number(&table, row, n + 4, "%.2f", order->result.order);
        text_table_number(&table, row, n + 5, "%.9g", order->limit[0]);
        if (quantity->of_xy) text_table_number(&table, row, n + 6, "%.9g", order->limit[1]);
        text_table_number(&table, row, n + 7, "%.1e", order->result.error);
        text_table_set(&table, row++, n + 8, "%s",
                       is_given                                         ? "reference"
                       : order->result.verdict == ERROR_BUDGET_NONE     ? "noise"
                       : error_budget_is_flagged(order->result.verdict) ? "flagged"
                       : orders->n_judged < ERROR_BUDGET_LEVELS         ? "3 levels"
                                                                        : "4 levels");
    }

    table.n_rows = row;
    text_table_print(&table, stream);
    text_table_free(&table);
    print_flags(study, orders, group, stream);
    enum status status = STATUS_OK;
    for (int place = 0; place < SWEEP_N_ORDERS * orders->n_fish; place++) {
        const enum status tested =
            test_order(study, orders, group, place / orders->n_fish, place % orders->n_fish, stream);
        if (status == STATUS_OK) status = tested;
    }

    return status;
}

enum status study_orders_print(const struct case_values *study, const struct study_orders *orders, FILE *stream) {
    enum status status = STATUS_OK;
    for (int g = 0; g < orders->n_groups; g++) {
        const struct sweep_axis *const axis = &study->sweep[orders->axis];
        char *text;
        TRY(sweep_member_text(study, orders->first[g], &text));
        fprintf(stream, "\nRefinement of ");
        for (int k = 0; k < axis->n_keys; k++) fprintf(stream, "%s%s", k > 0 ? " with " : "", axis->key[k].path);
        if (study->n_axes > 1) fprintf(stream, ", from member %d (%s) on", orders->first[g], text);
        fprintf(stream,
                ": differences from the finest level%s; observed order of the next coarser and of the\n"
                "finest levels, Richardson's extrapolation, and the error of the finest level (doc/studies.md)\n",
                axis->reference ? " (*: from the reference of the case)" : "");
        free(text);
        const enum status printed = print_group(study, orders, g, stream);
        if (status == STATUS_OK) status = printed;
    }

    return status;
}

// ---- study.nc

enum orders_dimension { GROUP, LEVEL, ORDERS_FISH, ORDERS_XY, ORDERS_TEXT, N_ORDERS_DIMENSIONS };

static const char *const dimension_names[] = {"group", "level", "fish", "xy", "text"};

/* Variables that exist once. */
enum { LEVEL_VALUE, LEVEL_SIZE, GROUP_MEMBER, DESIGN_ORDER, N_SINGLE };
static const struct single {
    const char *name, *meaning;
    enum orders_dimension dimension;
} singles[N_SINGLE] = {
    {"level_value", "value of the refined key, from coarse to fine", LEVEL},
    {"level_size", "grid spacing: the value, or 1/(n - 1) of n points", LEVEL},
    {"group_member", "first member of each group", GROUP},
    {"group_design_order", "order that the refined key has by design; NaN: none", GROUP},
};

/* Variables of each quantity: name and meaning include the name of the quantity. The dimensions begin with group,
 * fish. */
enum { DIFFERENCE, COARSE_ORDER, ORDER, LIMIT, ERROR, FLAG, N_KINDS };
static const struct kind {
    const char *name, *unit, *meaning; /* unit NULL: unit of the quantity */
    enum orders_dimension last;        /* a third dimension; GROUP: none */
} kinds[N_KINDS] = {
    {"difference_%s", NULL, "distance of %s from the finest level, or from the reference of the case", LEVEL},
    {"order_before_%s", "1", "observed order of %s of the next coarser levels", GROUP},
    {"order_%s", "1", "observed order of %s of the finest levels", GROUP},
    {"limit_%s", NULL, "%s extrapolated to zero spacing by Richardson's method (xy: positions only)", ORDERS_XY},
    {"error_%s", NULL, "error of %s at the finest level (doc/studies.md)", GROUP},
    {"objection_%s", "", "reason why the levels of %s have no order, and the error is a largest difference",
     ORDERS_TEXT},
};

int study_orders_listed(int i, struct result_listed *listed) {
    if (i < N_SINGLE) {
        *listed = (struct result_listed){.name = singles[i].name,
                                         .type = i == GROUP_MEMBER ? "int" : "double",
                                         .unit = singles[i].dimension == GROUP ? "1" : "of the key",
                                         .meaning = singles[i].meaning};
        snprintf(listed->dimensions, sizeof listed->dimensions, "%s", dimension_names[singles[i].dimension]);
        return 1;
    }

    static char name[N_KINDS][NAME_BYTES], meaning[N_KINDS][MEANING_BYTES];
    const int k = i - N_SINGLE;
    if (k >= N_KINDS) return 0;
    study_fill_name(name[k], NAME_BYTES, kinds[k].name, "Q");
    study_fill_name(meaning[k], MEANING_BYTES, kinds[k].meaning, "Q");
    *listed = (struct result_listed){.name = name[k],
                                     .type = k == FLAG ? "char" : "double",
                                     .unit = kinds[k].unit ? kinds[k].unit : "of Q",
                                     .meaning = meaning[k]};
    const char *const last = kinds[k].last == GROUP ? "" : dimension_names[kinds[k].last];
    snprintf(listed->dimensions, sizeof listed->dimensions, "group, fish%s%s", *last ? ", " : "", last);

    return 1;
}

static void define(struct netcdf_writer *writer, const char *name, enum netcdf_type type, int n, const int *dimensions,
                   const char *units, const char *meaning) {
    struct netcdf_variable variable = {.name = name,
                                       .long_name = meaning,
                                       .units = units,
                                       .type = type,
                                       .n_dimensions = n,
                                       .has_gaps = type == NETCDF_DOUBLE};
    memcpy(variable.dimension, dimensions, (size_t)n * sizeof *dimensions);
    netcdf_define_variable(writer, &variable);
}

void study_orders_define(struct netcdf_writer *writer, const struct case_values *study,
                         const struct study_orders *orders, const int dimensions[3]) {
    if (orders->n_groups == 0) return;
    int all[N_ORDERS_DIMENSIONS] = {0, 0, dimensions[0], dimensions[1], dimensions[2]};
    all[GROUP] = netcdf_define_dimension(writer, dimension_names[GROUP], (size_t)orders->n_groups);
    all[LEVEL] = netcdf_define_dimension(writer, dimension_names[LEVEL], (size_t)orders->n_levels);
    const char *const key_unit = study->sweep[orders->axis].key[0].unit;
    for (int i = 0; i < N_SINGLE; i++) {
        define(writer, singles[i].name, i == GROUP_MEMBER ? NETCDF_INT : NETCDF_DOUBLE, 1, &all[singles[i].dimension],
               singles[i].dimension == GROUP ? "1" : key_unit, singles[i].meaning);
    }

    for (int q = 0; q < SWEEP_N_ORDERS; q++) {
        const struct sweep_quantity *const quantity = &sweep_quantities[q];
        const char *const own_units = member_file_quantity(member_file_quantity_number(quantity->name))->unit;
        for (int k = 0; k < N_KINDS && is_observed(study, q); k++) {
            char name[NAME_BYTES], meaning[MEANING_BYTES];
            study_fill_name(name, sizeof name, kinds[k].name, quantity->name);
            study_fill_name(meaning, sizeof meaning, kinds[k].meaning, quantity->name);
            // an extrapolated value has directions only where the quantity has
            const enum orders_dimension last = kinds[k].last == ORDERS_XY && !quantity->of_xy ? GROUP : kinds[k].last;
            const int of_variable[] = {all[GROUP], all[ORDERS_FISH], all[last]};
            define(writer, name, k == FLAG ? NETCDF_TEXT : NETCDF_DOUBLE, last == GROUP ? 2 : 3, of_variable,
                   kinds[k].unit ? kinds[k].unit : own_units, meaning);
        }
    }
}

/* Write one quantity of one fish of a group. */
static void orders_write_order(struct netcdf_writer *writer, const struct study_orders *orders, int group, int q, int f,
                               size_t n_text, char *text) {
    const int place = place_of(orders, group, q, f);
    const struct study_order *const order = &orders->order[place];
    const double *const values[] = {[DIFFERENCE] = orders->error + (long)place * orders->n_levels,
                                    [COARSE_ORDER] = &order->result.coarse_order,
                                    [ORDER] = &order->result.order,
                                    [LIMIT] = order->limit,
                                    [ERROR] = &order->result.error};
    const size_t start[] = {(size_t)group, (size_t)f, 0};
    const struct sweep_quantity *const quantity = &sweep_quantities[q];
    char name[NAME_BYTES];

    for (int k = 0; k < FLAG; k++) {
        const size_t n_last = k == DIFFERENCE ? (size_t)orders->n_levels : k == LIMIT && quantity->of_xy ? 2 : 1;
        study_fill_name(name, sizeof name, kinds[k].name, quantity->name);
        netcdf_write_doubles(writer, netcdf_number(writer, name), start, (size_t[]){1, 1, n_last}, values[k]);
    }

    study_fill_name(name, sizeof name, kinds[FLAG].name, quantity->name);
    memset(text, 0, n_text);
    snprintf(text, n_text, "%s", order->flag);
    netcdf_write_text(writer, netcdf_number(writer, name), start, (size_t[]){1, 1, n_text}, text);
}

void study_orders_write(struct netcdf_writer *writer, const struct case_values *study,
                        const struct study_orders *orders, size_t n_text, char *text) {
    if (orders->n_groups == 0) return;
    const struct sweep_axis *const axis = &study->sweep[orders->axis];
    const int value_number = netcdf_number(writer, singles[LEVEL_VALUE].name);
    for (int i = 0; i < orders->n_levels; i++) {
        double value = NAN;
        text_number(axis->value[orders->level[i] * axis->n_keys], &value);
        netcdf_write_doubles(writer, value_number, (size_t[]){(size_t)i}, (size_t[]){1}, &value);
    }

    netcdf_write_doubles(writer, netcdf_number(writer, singles[LEVEL_SIZE].name), NULL, NULL, orders->grid_spacing);
    netcdf_write_ints(writer, netcdf_number(writer, singles[GROUP_MEMBER].name), NULL, NULL, orders->first);
    const double design_order = sweep_error_order(study, sweep_error_find(axis->key[0].row));
    const int design_number = netcdf_number(writer, singles[DESIGN_ORDER].name);
    for (int g = 0; g < orders->n_groups; g++) {
        netcdf_write_doubles(writer, design_number, (size_t[]){(size_t)g}, (size_t[]){1}, &design_order);
    }

    for (int g = 0; g < orders->n_groups; g++) {
        for (int q = 0; q < SWEEP_N_ORDERS; q++) {
            for (int f = 0; f < orders->n_fish && is_observed(study, q); f++) {
                orders_write_order(writer, orders, g, q, f, n_text, text);
            }
        }
    }
}
