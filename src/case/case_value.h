/* case_value.h: one value of a case, by its row of the table. Tested by tests/case/test_case.c.
 *
 * A field that has not been read holds NaN, -1 (word), 0 or an empty list: a comparison with it is false, so that a
 * check of several keys is silent about a value that has been complained about already. */
#ifndef CASE_VALUE_H
#define CASE_VALUE_H

#include "case/case_table.h"
#include "case/yaml_tree.h"

/* Mark a field as not read. */
void case_value_clear(const struct key *key, void *field);

/* Read a node into a cleared field. What is wrong is added to errors, in which path names the key; the field then stays
 * cleared. Fails with STATUS_MEMORY only. */
enum status case_value_read(const struct key *key, void *field, const struct yaml_node *node, const char *path,
                            struct yaml_errors *errors);

/* Release what a field owns and clear it. */
void case_value_free(const struct key *key, void *field);

/* Add the value as YAML. */
void case_value_write(struct text *text, const struct key *key, const void *field);

#endif
