/* sweep_refine.h: an axis of resolutions: reference values, and expected orders of convergence. Tested by
 * tests/case/test_sweep.c. */
#ifndef SWEEP_REFINE_H
#define SWEEP_REFINE_H

#include "base/status.h"
#include "case/case_table.h"
#include "case/sweep_members.h"
#include "case/yaml_tree.h"

/* Read refine, reference and expect of an axis after the values. key: the row of the first key, NULL after an error;
 * name: "sweep[1]"; node: the axis. Fails with STATUS_MEMORY only. */
enum status sweep_refine_read(const struct case_values *values, struct sweep_axis *into, const struct key *key,
                              const char *name, const struct yaml_node *node, struct yaml_errors *errors);

/* After reading a sweep: set the default of expected orders without `of`, and refuse quantities of runs if members are
 * steady states, and quantities of steady states if members are runs. sweep: the list of axes. */
void sweep_refine_check(struct case_values *values, const struct yaml_node *sweep, struct yaml_errors *errors);

/* The quantities whose orders a study observes, as a set: bit q is set for quantity q. */
uint64_t sweep_refine_orders(const struct case_values *study);

/* The reference value of a quantity (one with orders) for errors along a refined axis; NaN if the case has none. xy is
 * 0 for quantities other than points. */
double sweep_reference(const struct case_values *study, int axis, int quantity, int fish, int xy);

#endif
