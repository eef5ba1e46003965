/* settings_value.h: one value of a case, by its row of the table. Tested by tests/test_settings.c.
 *
 * A field that has not been read holds NaN, -1 (word), 0 or an empty list: a comparison with it is false, so that a
 * check of several keys is silent about a value that has been complained about already. */
#ifndef SETTINGS_VALUE_H
#define SETTINGS_VALUE_H

#include "settings_table.h"
#include "yaml_tree.h"

/* Mark a field as not read. */
void settings_value_clear(const struct key *key, void *field);

/* Read a node into a cleared field. What is wrong is added to errors, in which path names the key; the field then stays
 * cleared. Fails with STATUS_MEMORY only. */
enum status settings_value_read(const struct key *key, void *field, const struct yaml_node *node, const char *path,
                                struct yaml_errors *errors);

/* Release what a field owns and clear it. */
void settings_value_free(const struct key *key, void *field);

/* Add the value as YAML. */
void settings_value_write(struct yaml_text *text, const struct key *key, const void *field);

#endif
