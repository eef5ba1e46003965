/* sweep_refine.h: an axis of resolutions, and what is known or expected of its errors. Tested by
 * tests/case/test_sweep.c. */
#ifndef SWEEP_REFINE_H
#define SWEEP_REFINE_H

#include "base/status.h"
#include "case/case_table.h"
#include "case/sweep_members.h"
#include "case/yaml_tree.h"

/* Read refine, reference and expect of an axis that has its values. key: the row of its first key, NULL if that is wrong;
 * name: "sweep[1]"; node: the axis. Fails with STATUS_MEMORY only. */
enum status sweep_refine_read(const struct case_values *values, struct sweep_axis *into, const struct key *key,
                              const char *name, const struct yaml_node *node, struct yaml_errors *errors);

/* The value of a quantity (one with orders) that errors along the refined axis are to be taken against; NaN where none is
 * given. xy is 0 where the quantity is no point. */
double sweep_reference(const struct case_values *study, int axis, int quantity, int fish, int xy);

#endif
