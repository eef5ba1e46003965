/* case_path.h: paths of --set and sweep, such as fish[2].wave.frequency, and suggestions for unknown keys.
 * Tested by tests/case/test_case.c. */
#ifndef CASE_PATH_H
#define CASE_PATH_H

#include <stdbool.h>

#include "case/yaml_tree.h"

enum { CASE_NO_FISH = -1, CASE_EVERY_FISH = -2 };

struct case_path {
    char pattern[80];  /* "fish.wave.frequency" for fish[2].wave.frequency; a row or a section of the table */
    int fish;          /* index, CASE_EVERY_FISH or CASE_NO_FISH */
    const char *below; /* "wave.frequency": points into the text that was parsed */
};

/* Whether a path addresses a fish by its name, so that case_path_parse needs the names. */
bool case_path_has_name(const char *text);

/* Parse a path and check the existence of the key; false after adding an error. name: the names of the fish, by
 * which a path may address them, as in fish[leader].wave.frequency; NULL without a name in the path.    (n_fish) */
bool case_path_parse(struct case_path *path, const char *text, int n_fish, const char *const *name,
                     struct yaml_mark mark, struct yaml_errors *errors);

/* Add the error "path: unknown key; did you mean 'modulus'?" for a word in a section of the table ("": the top;
 * "fish.body": the body of a fish). owner: the fish with the word, as named in messages ("fish[2]"), or NULL. */
void case_path_unknown(struct yaml_errors *errors, struct yaml_mark mark, const char *path, const char *section,
                       const char *word, const char *owner);

#endif
