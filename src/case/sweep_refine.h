/* sweep_refine.h: an axis of resolutions: reference values, and expected orders of convergence. Tested by
 * tests/case/test_sweep.c. */
#ifndef SWEEP_REFINE_H
#define SWEEP_REFINE_H

#include "base/status.h"
#include "case/case_table.h"
#include "case/sweep_members.h"
#include "case/yaml_tree.h"

/* Read refine, reference and expect of an axis that has its values. key: the row of its first key, NULL if that is
 * wrong; name: "sweep[1]"; node: the axis. Fails with STATUS_MEMORY only. */
enum status sweep_refine_read(const struct case_values *values, struct sweep_axis *into, const struct key *key,
                              const char *name, const struct yaml_node *node, struct yaml_errors *errors);

/* The reference value of a quantity (one with orders) for errors along a refined axis; NaN if the case has none. xy is
 * 0 where the quantity is not a point. */
double sweep_reference(const struct case_values *study, int axis, int quantity, int fish, int xy);

#endif
