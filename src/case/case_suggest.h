/* case_suggest.h: suggestions for an unknown key. Tested by tests/case/test_case.c. */
#ifndef CASE_SUGGEST_H
#define CASE_SUGGEST_H

#include "base/text.h"

/* Add a suggestion for an unknown word in a section ("": the top; "fish.body": the body of a fish), such as "; did you
 * mean 'modulus'?". owner: the fish with the word, as named in messages ("fish[2]"), or NULL. */
void case_suggest(struct text *hint, const char *section, const char *word, const char *owner);

#endif
