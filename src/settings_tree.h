/* settings_tree.h: one tree from a case file, its includes and the assignments of the command line; and paths into it.
 * Tested by tests/test_settings.c.
 *
 * The tree keeps what is strongest: assignments, then the case file, then its includes (the last one first). Defaults
 * are not merged into the fish but looked up after them, so that no value is ever copied. */
#ifndef SETTINGS_TREE_H
#define SETTINGS_TREE_H

#include "settings_table.h"
#include "yaml_tree.h"

enum { SETTINGS_MOST_FISH = 10000 };

struct settings_tree {
    struct yaml_node *root; /* a map; NULL if something could not be read */
    int n_sources;
    struct yaml_source **source; /* the case file first */
};

/* Read a case from a file, or from a text of which origin is the name and folder ("" or NULL: the working directory)
 * the place where includes are looked up. Zero the tree before. What is wrong with the case is added to errors, and
 * tree->root is then NULL. Fails with STATUS_FILE (the case file cannot be read) or STATUS_MEMORY only. */
enum status settings_tree_read_file(struct settings_tree *tree, const char *path, struct yaml_errors *errors);
enum status settings_tree_read_text(struct settings_tree *tree, const char *text, size_t length, const char *origin,
                                    const char *folder, struct yaml_errors *errors);

/* Apply an assignment "fish[0].nodes=9" to the tree. Fails with STATUS_MEMORY only. */
enum status settings_tree_assign(struct settings_tree *tree, const char *assignment, struct yaml_errors *errors);

/* Release all that the tree owns and zero it. */
void settings_tree_free(struct settings_tree *tree);

/* The number of fish, and what is written at a path ("time.end", "fish.nodes") for one fish (ignored for other paths):
 * among its own keys or, with *is_default, under defaults.fish; NULL if nowhere. */
int settings_tree_n_fish(const struct settings_tree *tree);
const struct yaml_node *settings_tree_value(const struct settings_tree *tree, const char *path, int fish,
                                            bool *is_default);

/* Where a message about a path should point: at its value, or at the nearest that is written around it. */
struct yaml_mark settings_tree_mark(const struct settings_tree *tree, const char *path, int fish);

/* ---- paths as --set and sweep take them */

enum { SETTINGS_NO_FISH = -1, SETTINGS_EVERY_FISH = -2 };

struct settings_path {
    char pattern[80];  /* "fish.wave.frequency" for fish[2].wave.frequency; a row or a section of the table */
    int fish;          /* index, SETTINGS_EVERY_FISH or SETTINGS_NO_FISH */
    const char *below; /* "wave.frequency": points into the text that was parsed */
};

/* Parse a path and check that it exists; false after adding what is wrong to errors. */
bool settings_path_parse(struct settings_path *path, const char *text, int n_fish, struct yaml_mark mark,
                         struct yaml_errors *errors);

/* Add the error "path: unknown key; did you mean ...?" for a word under a section of the table (see
 * settings_table_suggest for section and owner). */
void settings_path_unknown(struct yaml_errors *errors, struct yaml_mark mark, const char *path, const char *section,
                           const char *word, const char *owner);

#endif
