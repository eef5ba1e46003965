/* study_orders.h: convergence study: orders, limits and errors along the refined axis, and the corresponding variables
 * of study.nc. Tested by tests/study/test_study_file.c. */
#ifndef STUDY_ORDERS_H
#define STUDY_ORDERS_H

#include <stdio.h>

#include "base/arena.h"
#include "base/status.h"
#include "case/case_values.h"
#include "result/netcdf.h"
#include "result/result_kind.h"
#include "study/error_budget.h"
#include "study/member_file.h"

/* Convergence of a quantity of a fish (a number, or a point in the plane) over the levels of a refinement. */
struct study_order {
    struct error_budget_result result; /* error of the finest level by error_budget.h, or from a given value */
    double limit[2];                   /* Richardson extrapolation with the observed order; NaN: flagged levels */
    int is_known;                      /* some level has a value */
    char flag[ERROR_BUDGET_BYTES];     /* reason of a flag, or "" */
};

/* Convergence along the refined axis of a study. A group: members that differ in the refined axis only. */
struct study_orders {
    int axis, n_groups, n_levels, n_fish; /* n_groups 0: no refined axis, all fields below are empty */
    int n_judged;                         /* the finest levels, which determine the error */
    int *level;                           /* number of a value of the axis, from coarse to fine  (n_levels) */
    double *grid_spacing;                 /* the value of the axis, or 1/(n - 1) of n points      (n_levels) */
    int *first;                           /* the first member of each group                      (n_groups) */
    struct study_order *order;            /* (n_groups, SWEEP_N_ORDERS, n_fish) */
    double *error; /* distance from the finest level or the given value; NaN: finest level (as order, n_levels) */
};

/* Convergence to a given exact value: sizes and values from fine to coarse; each order follows from two levels,
 * log(e_2/e_1)/log(h_2/h_1). */
struct error_budget_result study_order_of_errors(int n, const double *size, const double (*value)[2],
                                                 const double *exact);

/* Compute errors and orders along the refined axis; without a refined axis there are no groups. */
void study_orders_create(struct arena *arena, struct study_orders *orders, const struct case_values *study,
                         const struct member_file *members);

/* Print errors and orders. Fails with STATUS_MISSED if the order of a quantity differs from the order that the axis
 * expects, or with STATUS_MEMORY. */
enum status study_orders_print(const struct case_values *study, const struct study_orders *orders, FILE *stream);

/* Define and write the variables in an open file. dimensions: numbers of the dimensions fish, xy and text; n_text:
 * length of the dimension text; text: scratch of n_text bytes. */
void study_orders_define(struct netcdf_writer *writer, const struct case_values *study,
                         const struct study_orders *orders, const int dimensions[3]);
void study_orders_write(struct netcdf_writer *writer, const struct case_values *study,
                        const struct study_orders *orders, size_t n_text, char *text);

/* Row i, from 0, of the list of variables; 0 beyond the last row. */
int study_orders_listed(int i, struct result_listed *listed);

#endif
