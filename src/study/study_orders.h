/* study_orders.h: a study of convergence: orders, limits and errors along the axis that is refined, and their part of
 * study.nc. Tested by tests/study/test_study_file.c. */
#ifndef STUDY_ORDERS_H
#define STUDY_ORDERS_H

#include <stdio.h>

#include "base/status.h"
#include "case/case_values.h"
#include "result/netcdf.h"
#include "result/result_kind.h"
#include "study/error_budget.h"
#include "study/member_file.h"

/* What the levels of a refinement say of a quantity of a fish (a number, or a point in the plane). */
struct study_order {
    double order;        /* observed with the finest levels; NaN: they are equal */
    double coarse_order; /* with the next coarser levels; NaN: there are none */
    double limit[2];     /* Richardson's extrapolation with that order; NaN where the levels are flagged */
    double error;        /* of the finest level, in the unit of the quantity: error_budget.h, or given */
    int is_known;        /* whether any level has a value */
    enum error_budget_verdict verdict; /* on the quantity together with speed, cost and Strouhal number */
    int culprit;                       /* the quantity that flags it (sweep_quantity.h); -1: none */
};

/* All along the refined axis of a study. A group: members that differ in that axis only. */
struct study_orders {
    int axis, n_groups, n_levels, n_fish; /* no groups: no axis is refined, and nothing below */
    int n_judged;                         /* levels that state the error: the finest ones */
    int *level;                           /* number of a value of the axis, from coarse to fine  (n_levels) */
    double *grid_spacing;                 /* the value of the axis, or 1/(n - 1) of n points      (n_levels) */
    int *first;                           /* the first member of each group                      (n_groups) */
    struct study_order *order;            /* (n_groups, SWEEP_N_ORDERS, n_fish) */
    double
        *error; /* distance from the finest level, or from the given value; NaN: that is itself (as order, n_levels) */
};

/* What levels say where the exact value is given: sizes and values from fine to coarse; each order is that of two
 * levels, log(e_2/e_1)/log(h_2/h_1). */
struct study_order study_order_of_errors(int n, const double *size, const double (*value)[2], const double *exact);

/* Errors and orders along the axis that is refined; without such an axis there are no groups. study_orders_free
 * releases and zeroes them, also after a failure. Fails with STATUS_MEMORY. */
enum status study_orders_create(struct study_orders *orders, const struct case_values *study,
                                const struct member_file *members);
void study_orders_free(struct study_orders *orders);

/* Print them. Fails with STATUS_MISSED when a quantity of a fish has another order than the axis expects, or with
 * STATUS_MEMORY. */
enum status study_orders_print(const struct case_values *study, const struct study_orders *orders, FILE *stream);

/* Define and write the variables in a file that is being written. dimensions: those of fish, xy and text, of which the
 * last has the length n_text; text: room for so much. */
void study_orders_define(struct netcdf_writer *writer, const struct case_values *study,
                         const struct study_orders *orders, const int dimensions[3]);
void study_orders_write(struct netcdf_writer *writer, const struct case_values *study,
                        const struct study_orders *orders, size_t n_text, char *text);

/* Row i, from 0, of the list of its variables; 0 beyond the last. */
int study_orders_listed(int i, struct result_listed *listed);

#endif
