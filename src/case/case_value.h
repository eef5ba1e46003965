/* case_value.h: reads and writes one value of a case. Tested by tests/case/test_case.c. */
#ifndef CASE_VALUE_H
#define CASE_VALUE_H

#include "case/case_table.h"

/* A time as the case has it. */
struct duration {
    double time;
    bool is_in_beats; /* else in seconds */
};

/* Read a node into a field; strings and lists belong to the arena. False if the node is no such value; an error is then
 * added to errors, with path as the name of the key. A time is read into a struct duration, because it takes the
 * frequencies of the fish to turn beats into seconds. */
bool case_value_read(struct arena *arena, const struct key *key, void *field, const struct yaml_node *node,
                     const char *path, struct yaml_errors *errors);

/* Add the value as YAML. */
void case_value_write(struct text *text, const struct key *key, const void *field);

#endif
