/* study_file_orders.c: the orders of a study of convergence in study.nc. Declared in study_file.h. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "output/netcdf.h"
#include "output/result_table.h"
#include "study/study_file.h"

enum { NAME_BYTES = 64, MEANING_BYTES = 160, MOST_DIMENSIONS = 3 };

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
    {"level_size", "what goes to zero: the value, or 1/(n - 1) of n points", LEVEL},
    {"group_member", "the first member of each group: those that differ in the refined key only", GROUP},
};

/* What there is for each quantity: name and meaning take its name. The dimensions begin with group, fish. */
enum { ERROR, ORDER_BEFORE, ORDER, LIMIT, INDEX, OBJECTION, N_KINDS };
static const struct kind {
    const char *name, *unit, *meaning; /* unit NULL: that of the quantity */
    enum orders_dimension last;        /* a third dimension; GROUP: none */
} kinds[N_KINDS] = {
    {"error_%s", NULL, "distance of %s from the finest level, or from the reference that the case gives", LEVEL},
    {"order_before_%s", "1", "order of %s observed with the levels before the finest", GROUP},
    {"order_%s", "1", "order of %s observed with the finest levels", GROUP},
    {"limit_%s", NULL, "limit of %s by Richardson's extrapolation (xy: of positions only)", ORDERS_XY},
    {"index_%s", NULL, "grid convergence index: the finest %s is expected to be off by less", GROUP},
    {"objection_%s", "", "why the levels of %s are not in the asymptotic range; empty: they are", ORDERS_TEXT},
};

// the third dimension of a quantity's variable: a limit has directions only where the quantity has
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
                                     .type = k == OBJECTION ? "char" : "double",
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
    orders->size = calloc((size_t)n_levels, sizeof *orders->size);
    orders->first = calloc((size_t)n_groups, sizeof *orders->first);
    orders->order = calloc(n, sizeof *orders->order);
    orders->error = calloc(n * (size_t)n_levels, sizeof *orders->error);
    if (!orders->level || !orders->size || !orders->first || !orders->order || !orders->error) {
        return status_fail(STATUS_MEMORY, "out of memory: the orders of %d levels", n_levels);
    }
    orders->n_groups = n_groups;
    orders->n_levels = n_levels;
    return STATUS_OK;
}

void study_file_orders_free(struct study_file_orders *orders) {
    free(orders->level);
    free(orders->size);
    free(orders->first);
    free(orders->order);
    free(orders->error);
    *orders = (struct study_file_orders){0};
}

int study_file_orders_place(const struct study_file_orders *orders, int group, int quantity, int fish) {
    return (group * SWEEP_N_ORDERS + quantity) * orders->n_fish + fish;
}

// ---- definition

static int define(int file, const char *name, nc_type type, int n, const int *dimensions, const char *unit,
                  const char *meaning) {
    int variable;
    NETCDF(nc_def_var(file, name, type, n, dimensions, &variable));
    NETCDF(netcdf_text(file, variable, "long_name", meaning));
    if (type == NC_CHAR) return netcdf_text(file, variable, "_Encoding", "utf-8");
    NETCDF(netcdf_text(file, variable, "units", unit));
    const double fill = NAN;
    return type == NC_DOUBLE ? nc_put_att_double(file, variable, _FillValue, NC_DOUBLE, 1, &fill) : NC_NOERR;
}

static int define_quantity(int file, int q, const int dimensions[N_ORDERS_DIMENSIONS]) {
    const struct sweep_quantity *const quantity = &sweep_quantities[q];
    for (int k = 0; k < N_KINDS; k++) {
        char name[NAME_BYTES], meaning[MEANING_BYTES];
        fill_name(name, sizeof name, kinds[k].name, quantity->name);
        fill_name(meaning, sizeof meaning, kinds[k].meaning, quantity->name);
        const enum orders_dimension last = last_of(k, quantity->of_xy);
        const int of_variable[MOST_DIMENSIONS] = {dimensions[GROUP], dimensions[ORDERS_FISH], dimensions[last]};
        const char *const unit =
            kinds[k].unit ? kinds[k].unit : member_file_quantity(member_file_quantity_number(quantity->name))->unit;
        NETCDF(define(file, name, k == OBJECTION ? NC_CHAR : NC_DOUBLE, last == GROUP ? 2 : 3, of_variable, unit,
                      meaning));
    }
    return NC_NOERR;
}

int study_file_orders_define(int file, const struct case_values *study, const struct study_file_orders *orders,
                             const int dimensions[3]) {
    if (orders->n_groups == 0) return NC_NOERR;
    int all[N_ORDERS_DIMENSIONS] = {0, 0, dimensions[0], dimensions[1], dimensions[2]};
    NETCDF(nc_def_dim(file, dimension_names[GROUP], (size_t)orders->n_groups, &all[GROUP]));
    NETCDF(nc_def_dim(file, dimension_names[LEVEL], (size_t)orders->n_levels, &all[LEVEL]));
    const char *const key_unit = study->sweep[orders->axis].key[0].unit;
    for (int i = 0; i < N_SINGLE; i++) {
        NETCDF(define(file, singles[i].name, i == GROUP_MEMBER ? NC_INT : NC_DOUBLE, 1, &all[singles[i].dimension],
                      i == GROUP_MEMBER || !*key_unit ? "1" : key_unit, singles[i].meaning));
    }
    for (int q = 0; q < SWEEP_N_ORDERS; q++) NETCDF(define_quantity(file, q, all));
    return NC_NOERR;
}

// ---- writing

static int write_numbers(int file, const char *name, const size_t *start, const size_t *count, const double *value) {
    int variable;
    NETCDF(nc_inq_varid(file, name, &variable));
    return nc_put_vara_double(file, variable, start, count, value);
}

/* One quantity of one fish of a group. */
static int write_order(int file, const struct study_file_orders *orders, int group, int q, int f, size_t n_text) {
    const int place = study_file_orders_place(orders, group, q, f);
    const struct study_file_order *const order = &orders->order[place];
    const double *const values[] = {[ERROR] = orders->error + (long)place * orders->n_levels,
                                    [ORDER_BEFORE] = &order->order_before,
                                    [ORDER] = &order->order,
                                    [LIMIT] = order->limit,
                                    [INDEX] = &order->index};
    const size_t start[] = {(size_t)group, (size_t)f, 0};
    const struct sweep_quantity *const quantity = &sweep_quantities[q];
    char name[NAME_BYTES];
    for (int k = 0; k < OBJECTION; k++) {
        const size_t n_last = k == ERROR ? (size_t)orders->n_levels : k == LIMIT && quantity->of_xy ? 2 : 1;
        fill_name(name, sizeof name, kinds[k].name, quantity->name);
        NETCDF(write_numbers(file, name, start, (size_t[]){1, 1, n_last}, values[k]));
    }
    if (!order->objection) return NC_NOERR;
    int variable;
    fill_name(name, sizeof name, kinds[OBJECTION].name, quantity->name);
    NETCDF(nc_inq_varid(file, name, &variable));
    const size_t length = strlen(order->objection);
    return nc_put_vara_text(file, variable, start, (size_t[]){1, 1, length < n_text ? length : n_text},
                            order->objection);
}

int study_file_orders_write(int file, const struct case_values *study, const struct study_file_orders *orders,
                            size_t n_text) {
    if (orders->n_groups == 0) return NC_NOERR;
    for (int i = 0; i < orders->n_levels; i++) {
        const struct sweep_axis *const axis = &study->sweep[orders->axis];
        double value = NAN;
        text_number(axis->value[orders->level[i] * axis->n_keys], &value);
        const size_t start[] = {(size_t)i}, count[] = {1};
        NETCDF(write_numbers(file, singles[LEVEL_VALUE].name, start, count, &value));
        NETCDF(write_numbers(file, singles[LEVEL_SIZE].name, start, count, &orders->size[i]));
    }
    int variable;
    NETCDF(nc_inq_varid(file, singles[GROUP_MEMBER].name, &variable));
    NETCDF(nc_put_var_int(file, variable, orders->first));
    for (int g = 0; g < orders->n_groups; g++) {
        for (int q = 0; q < SWEEP_N_ORDERS; q++) {
            for (int f = 0; f < orders->n_fish; f++) NETCDF(write_order(file, orders, g, q, f, n_text));
        }
    }
    return NC_NOERR;
}
