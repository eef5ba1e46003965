/* study_file_orders.c: the orders of a study of convergence in study.nc. */
#include "study/study_file_orders.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "case/sweep_members.h"
#include "case/sweep_quantity.h"
#include "study/member_file.h"

enum { NAME_BYTES = 64, MEANING_BYTES = 160 };

// ---- the table

enum orders_dimension { GROUP, LEVEL, ORDERS_FISH, ORDERS_XY, ORDERS_TEXT, N_ORDERS_DIMENSIONS };

static const char *const dimension_names[] = {"group", "level", "fish", "xy", "text"};

/* What there is once. */
enum { LEVEL_VALUE, LEVEL_SIZE, GROUP_MEMBER, N_SINGLE };
static const struct single {
    const char *name, *meaning;
    enum orders_dimension dimension;
} singles[N_SINGLE] = {
    {"level_value", "value of the refined key, from coarse to fine", LEVEL},
    {"level_size", "grid spacing: the value, or 1/(n - 1) of n points", LEVEL},
    {"group_member", "first member of each group: members that differ in the refined key only", GROUP},
};

/* What there is for each quantity: name and meaning take its name. The dimensions begin with group, fish. */
enum { ERROR, COARSE_ORDER, ORDER, EXTRAPOLATED, GCI, FLAG, N_KINDS };
static const struct kind {
    const char *name, *unit, *meaning; /* unit NULL: that of the quantity */
    enum orders_dimension last;        /* a third dimension; GROUP: none */
} kinds[N_KINDS] = {
    {"error_%s", NULL, "error of %s: its distance from the finest level, or from the reference that the case gives",
     LEVEL},
    {"order_before_%s", "1", "observed order of %s of the next coarser levels", GROUP},
    {"order_%s", "1", "observed order of %s of the finest levels", GROUP},
    {"limit_%s", NULL, "%s extrapolated to zero spacing by Richardson's method (xy: of positions only)", ORDERS_XY},
    {"index_%s", NULL, "grid convergence index (GCI): bound of the error of %s at the finest level", GROUP},
    {"objection_%s", "", "why the levels of %s are not in the asymptotic range; empty where they are", ORDERS_TEXT},
};

// the third dimension of a quantity's variable: an extrapolated value has directions only where the quantity has
static enum orders_dimension last_of(int kind, int of_xy) {
    return kinds[kind].last == ORDERS_XY && !of_xy ? GROUP : kinds[kind].last;
}

// name or meaning of a kind for a quantity
static void fill_name(char *text, size_t size, const char *format, const char *quantity) {
    const int before = (int)(strstr(format, "%s") - format);
    snprintf(text, size, "%.*s%s%s", before, format, quantity, format + before + 2);
}

int study_file_orders_listed(int i, struct result_listed *listed) {
    if (i < N_SINGLE) {
        *listed = (struct result_listed){.name = singles[i].name,
                                         .type = i == GROUP_MEMBER ? "int" : "double",
                                         .unit = i == GROUP_MEMBER ? "1" : "of the key",
                                         .meaning = singles[i].meaning};
        snprintf(listed->dimensions, sizeof listed->dimensions, "%s", dimension_names[singles[i].dimension]);
        return 1;
    }
    static char name[N_KINDS][NAME_BYTES], meaning[N_KINDS][MEANING_BYTES];
    const int k = i - N_SINGLE;
    if (k >= N_KINDS) return 0;
    fill_name(name[k], NAME_BYTES, kinds[k].name, "Q");
    fill_name(meaning[k], MEANING_BYTES, kinds[k].meaning, "Q");
    *listed = (struct result_listed){.name = name[k],
                                     .type = k == FLAG ? "char" : "double",
                                     .unit = kinds[k].unit ? kinds[k].unit : "of Q",
                                     .meaning = meaning[k]};
    const char *const last = kinds[k].last == GROUP ? "" : dimension_names[kinds[k].last];
    snprintf(listed->dimensions, sizeof listed->dimensions, "group, fish%s%s", *last ? ", " : "", last);
    return 1;
}

// ---- memory

enum status study_file_orders_create(struct study_file_orders *orders, int n_groups, int n_levels) {
    const size_t n = (size_t)n_groups * SWEEP_N_ORDERS * (size_t)orders->n_fish;
    orders->level = calloc((size_t)n_levels, sizeof *orders->level);
    orders->grid_spacing = calloc((size_t)n_levels, sizeof *orders->grid_spacing);
    orders->first = calloc((size_t)n_groups, sizeof *orders->first);
    orders->order = calloc(n, sizeof *orders->order);
    orders->error = calloc(n * (size_t)n_levels, sizeof *orders->error);
    if (!orders->level || !orders->grid_spacing || !orders->first || !orders->order || !orders->error) {
        return status_fail(STATUS_MEMORY, "out of memory: the orders of %d levels", n_levels);
    }
    orders->n_groups = n_groups;
    orders->n_levels = n_levels;
    return STATUS_OK;
}

void study_file_orders_free(struct study_file_orders *orders) {
    free(orders->level);
    free(orders->grid_spacing);
    free(orders->first);
    free(orders->order);
    free(orders->error);
    *orders = (struct study_file_orders){0};
}

int study_file_orders_place(const struct study_file_orders *orders, int group, int quantity, int fish) {
    return (group * SWEEP_N_ORDERS + quantity) * orders->n_fish + fish;
}

// ---- definition

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

static void define_quantity(struct netcdf_writer *writer, int q, const int dimensions[N_ORDERS_DIMENSIONS]) {
    const struct sweep_quantity *const quantity = &sweep_quantities[q];
    const char *const own_units = member_file_quantity(member_file_quantity_number(quantity->name))->unit;
    for (int k = 0; k < N_KINDS; k++) {
        char name[NAME_BYTES], meaning[MEANING_BYTES];
        fill_name(name, sizeof name, kinds[k].name, quantity->name);
        fill_name(meaning, sizeof meaning, kinds[k].meaning, quantity->name);
        const enum orders_dimension last = last_of(k, quantity->of_xy);
        const int of_variable[] = {dimensions[GROUP], dimensions[ORDERS_FISH], dimensions[last]};
        define(writer, name, k == FLAG ? NETCDF_TEXT : NETCDF_DOUBLE, last == GROUP ? 2 : 3, of_variable,
               kinds[k].unit ? kinds[k].unit : own_units, meaning);
    }
}

void study_file_orders_define(struct netcdf_writer *writer, const struct case_values *study,
                              const struct study_file_orders *orders, const int dimensions[3]) {
    if (orders->n_groups == 0) return;
    int all[N_ORDERS_DIMENSIONS] = {0, 0, dimensions[0], dimensions[1], dimensions[2]};
    all[GROUP] = netcdf_define_dimension(writer, dimension_names[GROUP], (size_t)orders->n_groups);
    all[LEVEL] = netcdf_define_dimension(writer, dimension_names[LEVEL], (size_t)orders->n_levels);
    const char *const key_unit = study->sweep[orders->axis].key[0].unit;
    for (int i = 0; i < N_SINGLE; i++) {
        define(writer, singles[i].name, i == GROUP_MEMBER ? NETCDF_INT : NETCDF_DOUBLE, 1, &all[singles[i].dimension],
               i == GROUP_MEMBER ? "1" : key_unit, singles[i].meaning);
    }
    for (int q = 0; q < SWEEP_N_ORDERS; q++) define_quantity(writer, q, all);
}

// ---- writing

/* One quantity of one fish of a group. */
static void write_order(struct netcdf_writer *writer, const struct study_file_orders *orders, int group, int q, int f,
                        size_t n_text, char *text) {
    const int place = study_file_orders_place(orders, group, q, f);
    const struct study_file_order *const order = &orders->order[place];
    const double *const values[] = {[ERROR] = orders->error + (long)place * orders->n_levels,
                                    [COARSE_ORDER] = &order->coarse_order,
                                    [ORDER] = &order->order,
                                    [EXTRAPOLATED] = order->extrapolated,
                                    [GCI] = &order->gci};
    const size_t start[] = {(size_t)group, (size_t)f, 0};
    const struct sweep_quantity *const quantity = &sweep_quantities[q];
    char name[NAME_BYTES];
    for (int k = 0; k < FLAG; k++) {
        const size_t n_last = k == ERROR ? (size_t)orders->n_levels : k == EXTRAPOLATED && quantity->of_xy ? 2 : 1;
        fill_name(name, sizeof name, kinds[k].name, quantity->name);
        netcdf_write_doubles(writer, netcdf_number(writer, name), start, (size_t[]){1, 1, n_last}, values[k]);
    }
    fill_name(name, sizeof name, kinds[FLAG].name, quantity->name);
    memset(text, 0, n_text);
    snprintf(text, n_text, "%s", order->flag ? order->flag : "");
    netcdf_write_text(writer, netcdf_number(writer, name), start, (size_t[]){1, 1, n_text}, text);
}

void study_file_orders_write(struct netcdf_writer *writer, const struct case_values *study,
                             const struct study_file_orders *orders, size_t n_text, char *text) {
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
    for (int g = 0; g < orders->n_groups; g++) {
        for (int q = 0; q < SWEEP_N_ORDERS; q++) {
            for (int f = 0; f < orders->n_fish; f++) write_order(writer, orders, g, q, f, n_text, text);
        }
    }
}
