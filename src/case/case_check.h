/* case_check.h: what must hold between keys, each of which is good by itself. Tested by tests/case/test_case.c. */
#ifndef CASE_CHECK_H
#define CASE_CHECK_H

#include "case/case_merge.h"

/* Add what is inconsistent to errors. Values that could not be read (see case_value.h) are passed over. */
void case_check(const struct case_values *values, const struct case_tree *tree, struct yaml_errors *errors);

/* Read the axes of the sweep, and check each value as the value of its key. Fails with STATUS_MEMORY only. */
enum status sweep_read(struct case_values *values, const struct case_tree *tree, struct yaml_errors *errors);

/* Release the axes. */
void sweep_free(struct case_values *values);

/* Read what is expected of the members; the sweep has been read. Fails with STATUS_MEMORY only. sweep_expect_free
 * releases it. */
enum status sweep_expect_read(struct case_values *values, const struct case_tree *tree, struct yaml_errors *errors);
void sweep_expect_free(struct case_values *values);

/* Read refine, reference and expect of an axis that has its values. key: the row of its first key, NULL if that is wrong;
 * name: "sweep[1]"; node: the axis. Fails with STATUS_MEMORY only. */
enum status sweep_refine_read(const struct case_values *values, struct sweep_axis *into, const struct key *key,
                              const char *name, const struct yaml_node *node, struct yaml_errors *errors);

/* The number of a quantity among the first n_known; -1 after adding to errors that path names none. */
int sweep_quantity_read(const char *name, struct yaml_mark mark, const char *path, int n_known,
                        struct yaml_errors *errors);

/* The same for a name or a list of names under path.of, as a set: bit q stands for quantity q. */
unsigned sweep_quantities_read(const struct yaml_node *of, const char *path, int n_known, struct yaml_errors *errors);

/* Complain of the keys of a map that are not among the known ones: "key, values". */
void sweep_words_check(const struct yaml_node *map, const char *path, const char *known, struct yaml_errors *errors);

#endif
