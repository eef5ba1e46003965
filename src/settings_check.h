/* settings_check.h: what must hold between keys, each of which is good by itself. Tested by tests/test_settings.c. */
#ifndef SETTINGS_CHECK_H
#define SETTINGS_CHECK_H

#include "settings_tree.h"

/* Add what is inconsistent to errors. Values that could not be read (see settings_value.h) are passed over. */
void settings_check(const struct settings *settings, const struct settings_tree *tree, struct yaml_errors *errors);

/* Read the axes of the sweep, and check each value as the value of its key. Fails with STATUS_MEMORY only. */
enum status settings_sweep_read(struct settings *settings, const struct settings_tree *tree,
                                struct yaml_errors *errors);

/* Release the axes. */
void settings_sweep_free(struct settings *settings);

#endif
