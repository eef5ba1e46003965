/* sweep.h: the sweep of a case file. Tested by tests/case/test_sweep.c. */
#ifndef SWEEP_H
#define SWEEP_H

#include "base/status.h"
#include "case/case_values.h"
#include "case/yaml_tree.h"

/* Read the axes of the sweep, and check each value as a value of the key. After an error the case has no axes. Fails
 * with STATUS_MEMORY only. */
enum status sweep_read(struct case_values *values, const struct yaml_node *root, struct yaml_errors *errors);

/* Release the axes. */
void sweep_free(struct case_values *values);

#endif
