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

/* Of a sweep that has been read: give expected orders without `of` their default, and complain about quantities of runs
 * where members are steady states, or of steady states where they are not. sweep: the list of axes. */
void sweep_refine_check(struct case_values *values, const struct yaml_node *sweep, struct yaml_errors *errors);

/* The quantities whose orders a study observes, as a set: bit q is set for quantity q. */
uint64_t sweep_refine_orders(const struct case_values *study);

/* The reference value of a quantity (one with orders) for errors along a refined axis; NaN if the case has none. xy is
 * 0 where the quantity is not a point. */
double sweep_reference(const struct case_values *study, int axis, int quantity, int fish, int xy);

#endif
