/* study_orders.c: a study of convergence: observed orders, extrapolated values and the grid convergence index (GCI).
 *
 * P. J. Roache, Annual Review of Fluid Mechanics 29 (1997) 123-160: with h1 < h2 < h3, r21 = h2/h1, r32 = h3/h2 and
 * values f1, f2, f3 the order p solves
 *
 *     |f3 - f2| / |f2 - f1| = r21^p (r32^p - 1) / (r21^p - 1),
 *
 * the extrapolated value is f1 + (f1 - f2) / (r21^p - 1), and the GCI 1.25 |f1 - f2| / (r21^p - 1). Where the exact
 * value f is given, p is log(|f2 - f| / |f1 - f|) / log r21 instead. */
#include "study/study_orders.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "case/sweep_members.h"
#include "case/sweep_quantity.h"
#include "case/sweep_refine.h"
#include "study/study_table.h"

static const double safety_factor = 1.25;

/* Values that differ by less than this part of their size are equal: rounding hides the order. */
static const double min_difference = 1e-12;

/* Orders outside of these, or that change by more than that from three levels to the next, are not asymptotic. */
static const double min_order = 0.5, max_order = 6, max_change = 0.5;

// ---- two or three levels

/* The ratio of differences that an order gives. */
static double ratio_of_order(double p, double r21, double r32) {
    if (fabs(p) < 1e-9) return log(r32) / log(r21);
    return pow(r21, p) * (pow(r32, p) - 1) / (pow(r21, p) - 1);
}

/* The order that gives a ratio of differences; that ratio grows with the order. */
static double order_of_ratio(double ratio, double r21, double r32) {
    double low = -20, high = 20;
    while (high - low > 1e-12) {
        const double middle = (low + high) / 2;
        if (ratio_of_order(middle, r21, r32) < ratio) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return (low + high) / 2;
}

/* Observed order of three levels, coarse to fine; NaN where two neighbours are equal. */
static double three_levels(const double *h, const double (*f)[2], int *is_oscillating) {
    const double fine[2] = {f[2][0] - f[1][0], f[2][1] - f[1][1]}, coarse[2] = {f[1][0] - f[0][0], f[1][1] - f[0][1]};
    const double d21 = hypot(fine[0], fine[1]), d32 = hypot(coarse[0], coarse[1]);
    const double lower_bound = min_difference * fmax(1, hypot(f[2][0], f[2][1]));
    *is_oscillating = fine[0] * coarse[0] + fine[1] * coarse[1] < 0;
    if (!(d21 > lower_bound) || !(d32 > lower_bound)) return NAN;
    return order_of_ratio(d32 / d21, h[1] / h[2], h[0] / h[1]);
}

/* The same of two levels and the exact value. */
static double two_levels(const double *h, const double (*f)[2], const double *exact, int *is_oscillating) {
    const double fine[2] = {f[1][0] - exact[0], f[1][1] - exact[1]},
                 coarse[2] = {f[0][0] - exact[0], f[0][1] - exact[1]};
    const double e1 = hypot(fine[0], fine[1]), e2 = hypot(coarse[0], coarse[1]);
    const double lower_bound = min_difference * fmax(1, hypot(exact[0], exact[1]));
    *is_oscillating = fine[0] * coarse[0] + fine[1] * coarse[1] < 0;
    if (!(e1 > lower_bound) || !(e2 > lower_bound)) return NAN;
    return log(e2 / e1) / log(h[0] / h[1]);
}

struct study_file_order study_order(int n, const double *sizes, const double (*values)[2], const double *reference) {
    struct study_file_order result = {.coarse_order = NAN};
    int is_oscillating, was_oscillating;
    if (reference) {
        result.order = two_levels(sizes + n - 2, values + n - 2, reference, &is_oscillating);
        result.coarse_order = two_levels(sizes + n - 3, values + n - 3, reference, &was_oscillating);
    } else {
        result.order = three_levels(sizes + n - 3, values + n - 3, &is_oscillating);
        if (n > 3) result.coarse_order = three_levels(sizes + n - 4, values + n - 4, &was_oscillating);
    }
    const double part = 1 / (pow(sizes[n - 2] / sizes[n - 1], result.order) - 1);
    const double *const f1 = values[n - 1], *const f2 = values[n - 2];
    for (int k = 0; k < 2; k++) result.extrapolated[k] = f1[k] + (f1[k] - f2[k]) * part;
    result.gci = safety_factor * hypot(f1[0] - f2[0], f1[1] - f2[1]) * fabs(part);
    double sum = 0;
    for (int i = 0; i < n; i++) sum += values[i][0] + values[i][1];
    if (isnan(sum)) {
        result.flag = "a level is missing";
    } else if (isnan(result.order)) {
        result.flag = "levels are equal to rounding";
    } else if (is_oscillating) {
        result.flag = "oscillates: not in the asymptotic range";
    } else if (result.order < min_order || result.order > max_order) {
        result.flag = "order out of range: not in the asymptotic range";
    } else if (fabs(result.order - result.coarse_order) > max_change) {
        result.flag = "order still changes: not in the asymptotic range";
    }
    return result;
}

// ---- all groups

/* What is needed to fill the orders of a study. */
struct refinement {
    const struct case_values *study;
    const struct member_file *members;
    struct study_file_orders *orders;
    double (*value)[2]; /* one quantity at each level                                   (n_levels) */
};

/* The grid spacing of a value: 1/(n - 1) of n points, else the value itself. */
static double size_of(const struct sweep_axis *axis, int value) {
    double number = NAN;
    text_number(axis->value[value * axis->n_keys], &number);
    const char *const dot = strrchr(axis->key[0].path, '.');
    const int are_points = dot && (strcmp(dot, ".nodes") == 0 || strcmp(dot, ".sheet_points") == 0);
    return are_points ? 1 / (number - 1) : number;
}

/* Sort the levels from coarse to fine: insertion, as there are few. */
static void sort_levels(const struct case_values *study, struct study_file_orders *orders) {
    for (int i = 0; i < orders->n_levels; i++) {
        const double size = size_of(&study->sweep[orders->axis], i);
        int j = i;
        for (; j > 0 && orders->grid_spacing[j - 1] < size; j--) {
            orders->grid_spacing[j] = orders->grid_spacing[j - 1];
            orders->level[j] = orders->level[j - 1];
        }
        orders->grid_spacing[j] = size;
        orders->level[j] = i;
    }
}

/* Each member with the first value of the refined axis begins a group. */
static void find_groups(const struct case_values *study, struct study_file_orders *orders) {
    int n = 0;
    for (int m = 0; m < sweep_n_members(study); m++) {
        if (sweep_member_value(study, m, orders->axis) == 0) orders->first[n++] = m;
    }
}

/* The member at a level of a group. */
static const struct member_file *member_at(const struct refinement *refinement, int group, int level) {
    const struct study_file_orders *const orders = refinement->orders;
    int stride = 1;
    for (int a = orders->axis + 1; a < refinement->study->n_axes; a++) stride *= refinement->study->sweep[a].n_values;
    return &refinement->members[orders->first[group] + orders->level[level] * stride];
}

/* One quantity of one fish of a group. */
static void fill_order(struct refinement *refinement, int group, int q, int f) {
    struct study_file_orders *const orders = refinement->orders;
    const int n = orders->n_levels, quantity = member_file_quantity_number(sweep_quantities[q].name);
    const int of_xy = sweep_quantities[q].of_xy;
    for (int i = 0; i < n; i++) {
        const struct member_file *const member = member_at(refinement, group, i);
        const int is_complete = strcmp(member->status, "complete") == 0;
        refinement->value[i][0] = is_complete ? member_file_value(member, quantity, f, 0) : NAN;
        refinement->value[i][1] = of_xy ? member_file_value(member, quantity, f, 1) : 0;
    }
    const double given[2] = {sweep_reference(refinement->study, orders->axis, q, f, 0),
                             of_xy ? sweep_reference(refinement->study, orders->axis, q, f, 1) : 0};
    const int is_given = !isnan(given[0]);
    const double *const exact = is_given ? given : refinement->value[n - 1];
    const int place = study_file_orders_place(orders, group, q, f);
    for (int i = 0; i < n; i++) {
        const double error = hypot(refinement->value[i][0] - exact[0], refinement->value[i][1] - exact[1]);
        orders->error[place * n + i] = i < n - 1 || is_given ? error : NAN;
    }
    orders->order[place] =
        study_order(n, orders->grid_spacing, (const double(*)[2])refinement->value, is_given ? given : NULL);
}

enum status study_orders_create(struct study_file_orders *orders, const struct case_values *study,
                                const struct member_file *members) {
    *orders = (struct study_file_orders){.n_fish = study->school.n_fish};
    while (orders->axis < study->n_axes && !study->sweep[orders->axis].refine) orders->axis++;
    if (orders->axis == study->n_axes) return STATUS_OK;
    const int n = study->sweep[orders->axis].n_values, n_groups = sweep_n_members(study) / n;
    struct refinement refinement = {study, members, orders, calloc((size_t)n, sizeof *refinement.value)};
    enum status status = refinement.value ? study_file_orders_create(orders, n_groups, n) : STATUS_MEMORY;
    if (status == STATUS_OK) {
        sort_levels(study, orders);
        find_groups(study, orders);
        for (int g = 0; g < n_groups; g++) {
            for (int q = 0; q < SWEEP_N_ORDERS; q++) {
                for (int f = 0; f < study->school.n_fish; f++) fill_order(&refinement, g, q, f);
            }
        }
    } else {
        status_fail(STATUS_MEMORY, "out of memory: the orders of %d levels", n);
    }
    free(refinement.value);
    return status;
}

// ---- the table

/* Head: the values of the axis over the columns of errors. */
static void fill_head(const struct study_table *table, const struct case_values *study,
                      const struct study_file_orders *orders) {
    static const char *const heads[] = {"coarse order", "order", "extrapolated", "", "GCI"};
    const struct sweep_axis *const axis = &study->sweep[orders->axis];
    study_table_set(table, 0, 0, "error of");
    study_table_set(table, 0, 1, "fish");
    study_table_set(table, 0, 2, "unit");
    for (int i = 0; i < orders->n_levels; i++) {
        study_table_set(table, 0, 3 + i, "%s", axis->value[orders->level[i] * axis->n_keys]);
    }
    for (int i = 0; i < 5; i++) study_table_set(table, 0, 3 + orders->n_levels + i, "%s", heads[i]);
}

/* One quantity of one fish. */
static void fill_row(const struct study_table *table, int row, const struct case_values *study,
                     const struct study_file_orders *orders, int group, int q, int f) {
    const int n = orders->n_levels, place = study_file_orders_place(orders, group, q, f);
    const int is_given = !isnan(sweep_reference(study, orders->axis, q, f, 0));
    const struct study_file_order *const order = &orders->order[place];
    study_table_set(table, row, 0, "%s%s", sweep_quantities[q].name, is_given ? "*" : "");
    study_table_set(table, row, 1, "%s", study->school.fish[f].name);
    study_table_set(table, row, 2, "%s",
                    member_file_quantity(member_file_quantity_number(sweep_quantities[q].name))->unit);
    for (int i = 0; i < n; i++) study_table_number(table, row, 3 + i, "%.2e", orders->error[place * n + i]);
    study_table_number(table, row, n + 3, "%.2f", order->coarse_order);
    study_table_number(table, row, n + 4, "%.2f", order->order);
    study_table_number(table, row, n + 5, "%.9g", order->extrapolated[0]);
    if (sweep_quantities[q].of_xy) study_table_number(table, row, n + 6, "%.9g", order->extrapolated[1]);
    study_table_number(table, row, n + 7, "%.1e", order->gci);
}

/* Print the flag of an order, and whether the order is as expected: STATUS_MISSED if it is not. */
static enum status test_order(const struct case_values *study, const struct study_file_orders *orders, int group, int q,
                              int f, FILE *stream) {
    const struct sweep_axis *const axis = &study->sweep[orders->axis];
    const struct study_file_order *const order = &orders->order[study_file_orders_place(orders, group, q, f)];
    const char *const fish = study->school.fish[f].name, *const quantity = sweep_quantities[q].name;
    if (order->flag) fprintf(stream, "warning: %s of %s: %s\n", quantity, fish, order->flag);
    if (!(axis->order_of >> q & 1) || !(axis->order > 0)) return STATUS_OK;
    const int is_met = fabs(order->order - axis->order) <= axis->within;
    fprintf(stream, "%s: order of %s of %s is %.2f, expected %g +- %g\n", is_met ? "met" : "MISSED", quantity, fish,
            order->order, axis->order, axis->within);
    if (is_met) return STATUS_OK;
    return status_fail(STATUS_MISSED, "%s of %s: observed order %.2f in %s, expected %g +- %g", quantity, fish,
                       order->order, axis->key[0].path, axis->order, axis->within);
}

/* Errors and orders of one group: the members that differ in the refined axis only. */
static enum status print_group(const struct case_values *study, const struct study_file_orders *orders, int group,
                               FILE *stream) {
    const int n_fish = study->school.n_fish, n_rows = SWEEP_N_ORDERS * n_fish;
    struct study_table table;
    TRY(study_table_create(&table, 1 + n_rows, orders->n_levels + 8));
    fill_head(&table, study, orders);
    for (int row = 0; row < n_rows; row++) fill_row(&table, 1 + row, study, orders, group, row / n_fish, row % n_fish);
    study_table_print(&table, stream);
    study_table_free(&table);
    enum status status = STATUS_OK;
    for (int row = 0; row < n_rows; row++) {
        const enum status tested = test_order(study, orders, group, row / n_fish, row % n_fish, stream);
        if (status == STATUS_OK) status = tested;
    }
    return status;
}

enum status study_orders_print(const struct case_values *study, const struct study_file_orders *orders, FILE *stream) {
    enum status status = STATUS_OK;
    for (int g = 0; g < orders->n_groups; g++) {
        const struct sweep_axis *const axis = &study->sweep[orders->axis];
        char *text;
        TRY(sweep_member_text(study, orders->first[g], &text));
        fprintf(stream, "\nRefinement of %s", axis->key[0].path);
        if (study->n_axes > 1) fprintf(stream, ", from member %d (%s) on", orders->first[g], text);
        fprintf(stream,
                ": errors against the finest level%s; observed order of the next coarser and of the finest\n"
                "levels, Richardson's extrapolation and the grid convergence index (GCI, safety factor %g)\n",
                axis->reference ? " (*: against the reference of the case)" : "", safety_factor);
        free(text);
        const enum status printed = print_group(study, orders, g, stream);
        if (status == STATUS_OK) status = printed;
    }
    return status;
}
