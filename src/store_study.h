/* store_study.h: what a study reads from the files of its members, and the file study.nc that it makes of them. Tested
 * by tests/test_study.c.
 *
 * A quantity is what a variable of a result file holds in its last row, or what is computed from the last rows. */
#ifndef STORE_STUDY_H
#define STORE_STUDY_H

#include "settings.h"
#include "status.h"

struct store_quantity {
    const char *name, *unit, *long_name;
    int of_fish, of_xy; /* one value for every fish; for every direction */
    int is_computed;    /* not the last row of a variable of a result file */
};

/* Quantity number i, from 0; NULL beyond the last. */
const struct store_quantity *store_quantity(int i);

/* The number of a quantity of this name, which must exist. */
int store_quantity_number(const char *name);

/* The end of one member. */
struct store_member {
    int number;      /* of the member; -1: the file belongs to no study */
    char *status;    /* "complete", "failed: why", "stopped", "running", "missing"; never NULL */
    char *study;     /* merged text of the study, "" where there is none */
    char *effective; /* its complete case */
    int n_fish;
    char **fish_name; /* (n_fish) */
    double *value;    /* see store_member_value; NaN: unknown                       (n quantities, n_fish, xy) */
};

/* Read the file of a member. Fails with STATUS_FILE (missing, no NetCDF, cut off) or STATUS_MEMORY; *member then owns
 * nothing. */
enum status store_member_read(struct store_member *member, const char *path);

/* Release what a member owns and zero it. */
void store_member_free(struct store_member *member);

/* One value; NaN where the member has none. fish and xy are 0 where the quantity does not depend on them. */
double store_member_value(const struct store_member *member, int quantity, int fish, int xy);

/* What the levels of a refinement say of a quantity of a fish (a number, or a point in the plane). */
struct store_order {
    double order;        /* observed with the finest levels; NaN: they are equal */
    double order_before; /* with the levels before; NaN: there are none */
    double limit[2];     /* Richardson's extrapolation */
    double index;        /* Roache's grid convergence index, safety factor 1.25: the finest value is expected to be off
                              by less than this, in its own unit */
    const char *objection; /* why the levels are not in the asymptotic range, or NULL */
};

/* All along the refined axis of a study. A group: members that differ in that axis only. */
struct store_orders {
    int axis, n_groups, n_levels, n_fish; /* no groups: no axis is refined, and nothing below */
    int *level;                           /* number of a value of the axis, from coarse to fine  (n_levels) */
    double *size;                         /* what goes to zero                                   (n_levels) */
    int *first;                           /* the first member of each group                      (n_groups) */
    struct store_order *order;            /* (n_groups, SETTINGS_N_ORDERS, n_fish) */
    double
        *error; /* distance from the finest level, or from the given value; NaN: that is itself (as order, n_levels) */
};

/* Room for all arrays; n_fish is set before. Fails with STATUS_MEMORY. store_orders_free releases and zeroes them. */
enum status store_orders_create(struct store_orders *orders, int n_groups, int n_levels);
void store_orders_free(struct store_orders *orders);

/* The index of a quantity of a fish of a group in order. */
int store_orders_place(const struct store_orders *orders, int group, int quantity, int fish);

/* Write study.nc: the members (as many as the study has), what each of them set, all quantities, and the orders. A file
 * that is there is replaced when the new one is complete. Fails with STATUS_FILE or STATUS_MEMORY. */
enum status store_study_write(const char *path, const struct settings *study, const struct store_member *member,
                              const struct store_orders *orders, const char *command);

/* Read it back: the study, and its members as far as the file has them (effective is empty). The caller frees them with
 * settings_free and, each, store_member_free. Fails with STATUS_FILE or STATUS_MEMORY; nothing is then owned. */
enum status store_study_read(const char *path, struct settings *study, struct store_member **members);

/* Row i, from 0, of the reference of its variables; 0 beyond the last. */
struct store_listed;
int store_study_listed(int i, struct store_listed *listed);

/* ---- shared by the files of the store only */

enum { STORE_STUDY_SCHEMA = 1 /* attribute shoal_study */ };

/* Define and write the variables of the orders in an open file; both return NetCDF's code. dimensions: those of fish, xy
 * and text; n_text: length of the last. */
int store_orders_define(int file, const struct settings *study, const struct store_orders *orders,
                        const int dimensions[3]);
int store_orders_write(int file, const struct settings *study, const struct store_orders *orders, size_t n_text);

/* Their rows of the reference. */
int store_orders_listed(int i, struct store_listed *listed);

#endif
