/* fish_sheet.h: the constants of every bound vortex and every control point of a fish. doc/model.md, sections 6, 15 and
 * 18. Tested by tests/fish/test_fish.c. */
#ifndef FISH_SHEET_H
#define FISH_SHEET_H

#include <stdbool.h>

#include "base/arena.h"
#include "base/status.h"
#include "fish/fish.h"

/* The least number of sheet points that resolves the smallest depth of a strip: 1 + 5 L/w; 0 for other sheets. */
int fish_sheet_least(const struct fish_parameters *from);

/* Where the points of the sheet are along the body, as a fraction of the length from the nose, at cosine spacing: the
 * bound vortices at j = 0, 1, ..., the control points halfway between them at j = c + 0.5. */
double fish_sheet_place(const struct fish *fish, double j);

/* The inverse: j of a place. */
double fish_sheet_index(const struct fish *fish, double place);

/* Set all data per vortex and per control point of fish f, an element of the array of all fish. The body of the fish is
 * set. is_strip: the school has sheets of finite span. Fails with STATUS_STOPPED. */
enum status fish_sheet_set(struct arena *arena, struct fish *fish, int f, const struct school_parameters *parameters,
                           bool is_strip);

#endif
