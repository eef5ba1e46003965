/* case_value.h: one value of a case. A field that was not read is NaN, -1 (word), 0, NULL or an empty list. Comparisons
 * with such a field are false, so that a check of several keys does not report the error of one key again. Tested by
 * tests/case/test_case.c. */
#ifndef CASE_VALUE_H
#define CASE_VALUE_H

#include "case/case_table.h"

/* A time as the case has it: one of the two is NaN, both after an error. */
struct duration {
    double seconds, beats;
};

/* Mark a field as not read. */
void case_value_clear(const struct key *key, void *field);

/* Read a node into a cleared field; strings and lists belong to the arena. An error is added to errors with path as the
 * name of the key; the field then stays cleared. A time is read into a struct duration, because it takes the
 * frequencies of the fish to turn beats into seconds. */
void case_value_read(struct arena *arena, const struct key *key, void *field, const struct yaml_node *node,
                     const char *path, struct yaml_errors *errors);

/* Add the value as YAML. */
void case_value_write(struct text *text, const struct key *key, const void *field);

#endif
