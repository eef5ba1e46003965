/* case_notes.h: values that are allowed but implausible: an angle in radians, a length in centimetres, a body
 * softer than jelly, a wave that travels forwards. Tested by tests/case/test_notes.c. */
#ifndef CASE_NOTES_H
#define CASE_NOTES_H

#include "case/case_merge.h"
#include "case/case_values.h"

/* Add a note for every implausible value of a case without errors, once per place in the sources. */
void case_notes(const struct case_values *values, const struct case_tree *tree, struct yaml_errors *notes);

#endif
