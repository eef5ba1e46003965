/* sweep_expect.h: expectations of a study on the final states of the members. */
#ifndef SWEEP_EXPECT_H
#define SWEEP_EXPECT_H

#include <stdbool.h>
#include <stdint.h>

#include "case/yaml_tree.h"

struct case_values;

/* The condition that a key of the sweep has a value. */
struct sweep_condition {
    int axis, key;
    char *value;
};

/* An expectation of how members end: of all of them, or of those that have the values of where. */
struct sweep_expectation {
    char *fails; /* expected words of the message of failed members, then the only expectation; NULL: must not fail */
    uint64_t of; /* bit q: of quantity q */
    int fish;    /* -1: of all */
    int n_where;
    struct sweep_condition *where; /* one of each key must hold                (n_where) */
    double min, max;               /* of each value; without a bound infinite, as below */
    double spread;                 /* of the values; for points, the diagonal of the bounding box */
    double ratio; /* of the largest to the smallest absolute value; values of both signs, or 0, have none */
};

/* Read the expectations of a case, after the sweep. */
void sweep_expect_read(struct case_values *values, const struct yaml_node *root, struct yaml_errors *errors);

/* Whether an expectation is about a member. */
bool sweep_expects_of(const struct case_values *study, const struct sweep_expectation *one, int member);

#endif
