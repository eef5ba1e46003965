/* study_file_orders.h: what the levels of a refinement say, and its part of study.nc. Tested by
 * tests/study/test_study_file.c. */
#ifndef STUDY_FILE_ORDERS_H
#define STUDY_FILE_ORDERS_H

#include "base/status.h"
#include "case/case.h"
#include "output/netcdf.h"
#include "output/result_kind.h"

/* What the levels of a refinement say of a quantity of a fish (a number, or a point in the plane). */
struct study_file_order {
    double order;           /* observed with the finest levels; NaN: they are equal */
    double coarse_order;    /* with the next coarser levels; NaN: there are none */
    double extrapolated[2]; /* Richardson's extrapolation */
    double gci;       /* Roache's grid convergence index, safety factor 1.25: the finest value is expected to be off
                               by less than this, in its own unit */
    const char *flag; /* why the levels are not in the asymptotic range, or NULL */
};

/* All along the refined axis of a study. A group: members that differ in that axis only. */
struct study_file_orders {
    int axis, n_groups, n_levels, n_fish; /* no groups: no axis is refined, and nothing below */
    int *level;                           /* number of a value of the axis, from coarse to fine  (n_levels) */
    double *grid_spacing;                 /* the value of the axis, or 1/(n - 1) of n points      (n_levels) */
    int *first;                           /* the first member of each group                      (n_groups) */
    struct study_file_order *order;       /* (n_groups, SWEEP_N_ORDERS, n_fish) */
    double
        *error; /* distance from the finest level, or from the given value; NaN: that is itself (as order, n_levels) */
};

/* Make room for all arrays; n_fish is set before. Fails with STATUS_MEMORY. study_file_orders_free releases and zeroes
 * them. */
enum status study_file_orders_create(struct study_file_orders *orders, int n_groups, int n_levels);
void study_file_orders_free(struct study_file_orders *orders);

/* The index of a quantity of a fish of a group in order. */
int study_file_orders_place(const struct study_file_orders *orders, int group, int quantity, int fish);

/* Define and write the variables in a file that is being written. dimensions: those of fish, xy and text, of which the
 * last has the length n_text; text: room for so much. */
void study_file_orders_define(struct netcdf_writer *writer, const struct case_values *study,
                              const struct study_file_orders *orders, const int dimensions[3]);
void study_file_orders_write(struct netcdf_writer *writer, const struct case_values *study,
                             const struct study_file_orders *orders, size_t n_text, char *text);

/* Row i, from 0, of the list of its variables; 0 beyond the last. */
int study_file_orders_listed(int i, struct result_listed *listed);

#endif
