/* fish_school.h: from the checked parameters of a school to the constants. Tested by tests/fish/test_fish.c. */
#ifndef FISH_SCHOOL_H
#define FISH_SCHOOL_H

#include "base/status.h"
#include "fish/fish.h"

/* The least number of sheet points that resolves the smallest depth of a strip: 1 + 5 L/w; 0 for other sheets. */
int fish_sheet_least(const struct fish_parameters *from);

/* Build a school from checked parameters. Fails with STATUS_MEMORY, or with STATUS_CASE if fish overlap or are not
 * between the walls at the start. */
enum status fish_school_create(struct school **school, const struct school_parameters *parameters);

/* Release the school with all data. Accepts NULL. */
void fish_school_free(struct school *school);

#endif
