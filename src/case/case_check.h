/* case_check.h: checks how the values of several keys fit together, and notes values that are allowed but implausible:
 * an angle in radians, a length in centimetres, a body softer than jelly, a wave that travels forwards. Tested by
 * tests/case/test_case.c and tests/case/bad_cases.txt. */
#ifndef CASE_CHECK_H
#define CASE_CHECK_H

#include "case/case_merge.h"
#include "case/case_values.h"
#include "case/yaml_tree.h"

/* Add an error for every inconsistency. Skips values that were not read (see case_table.h). */
void case_check(const struct case_values *values, const struct case_tree *tree, struct yaml_errors *errors);

/* Add a note for every implausible value of a case without errors, and for every key whose value switches derived
 * defaults of other keys, once per place in the sources. initial: a case with one fish and the same preset, without
 * other keys. */
void case_notes(const struct case_values *values, const struct case_values *initial, const struct case_tree *tree,
                struct yaml_errors *notes);

#endif
