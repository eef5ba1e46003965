/* case_merge.h: makes one tree of a case file, its includes and the assignments of the command line. Tested by
 * tests/case/test_case.c.
 *
 * For each key the tree holds the value with the highest precedence: assignments come first, then the case file, then
 * the includes, the last one before the others. defaults.fish is not merged into the fish. If a key is missing in a
 * fish, case_merge_value looks it up under defaults.fish. */
#ifndef CASE_MERGE_H
#define CASE_MERGE_H

#include <stdbool.h>

#include "case/yaml_tree.h"

struct case_tree {
    struct arena *arena;    /* of nodes and sources */
    struct yaml_node *root; /* a map; NULL if something could not be read */
    int n_sources;
    struct yaml_source **source; /* the case file first */
};

/* Read a case into a tree that has only an arena so far: from the text, or without one from the file origin. origin is
 * also the name of the text in messages; folder is the folder of the includes of a text (NULL or "": the working
 * directory). Defects of the case are added to errors, and tree->root is then NULL. Fails with STATUS_FILE if the case
 * file cannot be read. */
enum status case_merge_read(struct case_tree *tree, const char *origin, const char *text, size_t length,
                            const char *folder, struct yaml_errors *errors);

/* Apply an assignment "fish[0].nodes=9" to the tree. */
void case_merge_assign(struct case_tree *tree, const char *assignment, struct yaml_errors *errors);

/* Replace the name of a file under error.against by the case of the file, so that the merged text is complete. place:
 * the case file, or a folder with a slash at the end. */
void case_merge_against(struct case_tree *tree, const char *place, struct yaml_errors *errors);

/* The number of fish, and the node at a path ("time.end", "fish.nodes") for one fish (ignored for other paths): among
 * the keys of the fish or, with *is_default, under defaults.fish; NULL if absent. */
int case_merge_n_fish(const struct case_tree *tree);
const struct yaml_node *case_merge_value(const struct case_tree *tree, const char *path, int fish, bool *is_default);

/* The place of a path for messages: the value, or the innermost section present in the case. */
struct yaml_mark case_merge_mark(const struct case_tree *tree, const char *path, int fish);

#endif
