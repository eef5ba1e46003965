/* case_check.h: relations between keys whose separate values are valid. Tested by tests/case/test_case.c. */
#ifndef CASE_CHECK_H
#define CASE_CHECK_H

#include "case/case_merge.h"
#include "case/case_values.h"

/* Add an error for every inconsistency. Skips values that were not read (see case_value.h). */
void case_check(const struct case_values *values, const struct case_tree *tree, struct yaml_errors *errors);

#endif
