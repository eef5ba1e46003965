/* sweep.h: the axes of a study and its members, which are all combinations of the values. Tested by
 * tests/case/test_sweep.c. */
#ifndef SWEEP_H
#define SWEEP_H

#include <stdint.h>

#include "base/status.h"
#include "base/text.h"
#include "case/case_values.h"
#include "case/yaml_tree.h"

/* A key that an axis of a sweep changes. */
struct sweep_key {
    char *path;       /* as --set takes it */
    const char *row;  /* path of the row in the table of keys: fish.nodes */
    const char *unit; /* of the table of keys */
    bool is_number;   /* each value is one number */
};

/* Neighbours of a value: the search starts from the whole state of the value `before`, which is the first of them, with
 * the slow quantities that an extrapolation gives. */
enum { SWEEP_NEIGHBOURS = 3 };
struct sweep_neighbours {
    int n; /* 0: the search starts from the speeds and places of the value `before` alone */
    int value[SWEEP_NEIGHBOURS];
    double weight[SWEEP_NEIGHBOURS]; /* their sum is 1 */
};

/* One axis of a sweep: changes one key, or several keys together. */
struct sweep_axis {
    int n_keys;
    struct sweep_key *key; /* (n_keys) */
    int n_values;
    char **value; /* value i of key k is value[i * n_keys + k], as --set takes it, "": of the case
                             (n_values * n_keys) */
    bool refine;  /* the values are resolutions of the first key: a study of convergence */
    bool steady;  /* members are steady states; each search starts from the state of the previous value */
    int *before;  /* start from the state of this value instead, -1: start of the case; NULL     (n_values) */
    struct sweep_neighbours *neighbours; /* NULL: none                                                     (n_values) */
    bool *is_against;     /* run the case of error.against; NULL: no value does                            (n_values) */
    bool is_relative;     /* the results of all members are also divided by those of the members with one value: */
    int relative_to;      /* the number of that value */
    double order, within; /* the expected order of convergence: order +- within; 0: none */
    uint64_t order_of;    /* bit q: of quantity q */
    double *reference;    /* see sweep_reference; NULL: none */
};

/* Read the axes of the sweep, and check each value as a value of the key. After an error the case has no axes. */
void sweep_read(struct case_values *values, const struct yaml_node *root, struct yaml_errors *errors);

/* Fail with STATUS_CASE if the case is a study; the message says how to run the study. */
enum status sweep_refuse(const struct case_values *values);

/* The number of members of the study: the product of the axes; 1 without a sweep. */
int sweep_n_members(const struct case_values *study);

/* The value of an axis for a member. The last axis runs fastest. */
int sweep_member_value(const struct case_values *study, int member, int axis);

/* True if the members are steady states: an axis has `steady`. The search of a member starts from the result of the
 * member with the previous value of that axis; -1 for the first value, and for all values that are starts. */
bool sweep_is_steady(const struct case_values *study);
int sweep_member_before(const struct case_values *study, int member);

/* The neighbours of a member of a study with one axis; NULL: none. And whether the whole state of a member is the start
 * of others. */
const struct sweep_neighbours *sweep_member_neighbours(const struct case_values *study, int member);
bool sweep_member_is_start(const struct case_values *study, int member);

/* The number of a value of the first key of an axis: the value is "first", or an equal number, or the same text; -1:
 * there is none. */
int sweep_find_value(const struct sweep_axis *axis, const char *wanted);

/* The member whose results those of a member are divided by: it has another value on the axis with `relative_to`, and
 * the same values on all others. -1: no axis has it. */
int sweep_member_reference(const struct case_values *study, int member);

/* Add "solver.rtol=1e-5": the assignment of this value to key k of an axis; to a text that is not empty with a comma.
 * Returns false, and adds nothing, for a value that is that of the case. */
bool sweep_add_assignment(struct text *text, const struct sweep_axis *axis, int value, int k);

/* "solver.rtol=1e-5, fish[*].nodes=7": the assignments of one member, in an arena. Empty without a sweep. */
char *sweep_member_text(struct arena *arena, const struct case_values *study, int member);

/* The quantities with observed orders in a study, as a set: bit q is set for quantity q. */
uint64_t sweep_refine_orders(const struct case_values *study);

/* The reference value of a quantity (one with orders) for errors along a refined axis; NaN if the case has none. xy is
 * 0 for quantities other than points. */
double sweep_reference(const struct case_values *study, int axis, int quantity, int fish, int xy);

#endif
