/* study_file.h: what a study reads from the files of its members, and the file study.nc that it makes of them. Tested
 * by tests/study/test_study_file.c.
 *
 * A quantity is what a variable of a result file holds in its last row, or what is computed from the last rows. */
#ifndef STUDY_FILE_H
#define STUDY_FILE_H

#include "base/status.h"
#include "case/case.h"

struct member_file_quantity {
    const char *name, *unit, *long_name;
    int of_fish, of_xy; /* one value for every fish; for every direction */
    int is_computed;    /* not the last row of a variable of a result file */
};

/* Quantity number i, from 0; NULL beyond the last. */
const struct member_file_quantity *member_file_quantity(int i);

/* The number of a quantity of this name, which must exist. */
int member_file_quantity_number(const char *name);

/* The end of one member. */
struct member_file {
    int number;      /* of the member; -1: the file belongs to no study */
    char *status;    /* "complete", "failed: why", "stopped", "running", "missing"; never NULL */
    char *study;     /* merged text of the study, "" where there is none */
    char *effective; /* its complete case */
    int n_fish;
    char **fish_name; /* (n_fish) */
    double *value;    /* see member_file_value; NaN: unknown                       (n quantities, n_fish, xy) */
};

/* Read the file of a member. Fails with STATUS_FILE (missing, no NetCDF, cut off) or STATUS_MEMORY; *member then owns
 * nothing. */
enum status member_file_read(struct member_file *member, const char *path);

/* Release what a member owns and zero it. */
void member_file_free(struct member_file *member);

/* One value; NaN where the member has none. fish and xy are 0 where the quantity does not depend on them. */
double member_file_value(const struct member_file *member, int quantity, int fish, int xy);

/* What the levels of a refinement say of a quantity of a fish (a number, or a point in the plane). */
struct study_file_order {
    double order;        /* observed with the finest levels; NaN: they are equal */
    double order_before; /* with the levels before; NaN: there are none */
    double limit[2];     /* Richardson's extrapolation */
    double index;        /* Roache's grid convergence index, safety factor 1.25: the finest value is expected to be off
                              by less than this, in its own unit */
    const char *objection; /* why the levels are not in the asymptotic range, or NULL */
};

/* All along the refined axis of a study. A group: members that differ in that axis only. */
struct study_file_orders {
    int axis, n_groups, n_levels, n_fish; /* no groups: no axis is refined, and nothing below */
    int *level;                           /* number of a value of the axis, from coarse to fine  (n_levels) */
    double *size;                         /* what goes to zero                                   (n_levels) */
    int *first;                           /* the first member of each group                      (n_groups) */
    struct study_file_order *order;       /* (n_groups, SWEEP_N_ORDERS, n_fish) */
    double
        *error; /* distance from the finest level, or from the given value; NaN: that is itself (as order, n_levels) */
};

/* Room for all arrays; n_fish is set before. Fails with STATUS_MEMORY. study_file_orders_free releases and zeroes them. */
enum status study_file_orders_create(struct study_file_orders *orders, int n_groups, int n_levels);
void study_file_orders_free(struct study_file_orders *orders);

/* The index of a quantity of a fish of a group in order. */
int study_file_orders_place(const struct study_file_orders *orders, int group, int quantity, int fish);

/* Write study.nc: the members (as many as the study has), what each of them set, all quantities, and the orders. A file
 * that is there is replaced when the new one is complete. Fails with STATUS_FILE or STATUS_MEMORY. */
enum status study_file_write(const char *path, const struct case_values *study, const struct member_file *member,
                             const struct study_file_orders *orders, const char *command);

/* Read it back: the study, and its members as far as the file has them (effective is empty). The caller frees them with
 * case_free and, each, member_file_free. Fails with STATUS_FILE or STATUS_MEMORY; nothing is then owned. */
enum status study_file_read(const char *path, struct case_values *study, struct member_file **members);

/* Row i, from 0, of the reference of its variables; 0 beyond the last. */
struct result_listed;
int study_file_listed(int i, struct result_listed *listed);

/* ---- shared by the files of the store only */

enum { RESULT_STUDY_SCHEMA = 1 /* attribute shoal_study */ };

/* Define and write the variables of the orders in an open file; both return NetCDF's code. dimensions: those of fish, xy
 * and text; n_text: length of the last. */
int study_file_orders_define(int file, const struct case_values *study, const struct study_file_orders *orders,
                             const int dimensions[3]);
int study_file_orders_write(int file, const struct case_values *study, const struct study_file_orders *orders,
                            size_t n_text);

/* Their rows of the reference. */
int study_file_orders_listed(int i, struct result_listed *listed);

#endif
