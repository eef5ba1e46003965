/* case_suggest.h: what a user may have meant by an unknown key. Tested by tests/case/test_case.c. */
#ifndef CASE_SUGGEST_H
#define CASE_SUGGEST_H

#include "base/text.h"

/* Add what the user may have meant by an unknown word under a section ("" is the top, "fish.body" that of fish): "; did
 * you mean 'modulus'?". owner is how messages call the fish that the word belongs to ("fish[2]"), or NULL. */
void case_suggest(struct text *hint, const char *section, const char *word, const char *owner);

#endif
