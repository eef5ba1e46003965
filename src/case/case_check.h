/* case_check.h: what must hold between keys, each of which is good by itself. Tested by tests/case/test_case.c. */
#ifndef CASE_CHECK_H
#define CASE_CHECK_H

#include "case/case_merge.h"
#include "case/case_values.h"

/* Add an error for every inconsistency. Values that could not be read (see case_value.h) are skipped. */
void case_check(const struct case_values *values, const struct case_tree *tree, struct yaml_errors *errors);

#endif
