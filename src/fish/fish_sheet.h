/* fish_sheet.h: positions of bound vortices and control points, and weights in the integrals of sheet and pressure.
 * doc/model.md, sections 6, 15 and 18. Tested by tests/fish/test_fish.c. */
#ifndef FISH_SHEET_H
#define FISH_SHEET_H

#include "base/status.h"
#include "fish/fish.h"

/* Set all data per vortex and per control point. Numbers of nodes and points, length and depth of the fish are set.
 * Fails with STATUS_MEMORY. */
enum status fish_sheet_set(struct fish *fish, const struct fish_parameters *from,
                           const struct school_parameters *parameters);

/* Whether the sheets of the fish consist of vortex rings: force: pressure with span: finite. */
int fish_is_strip(const struct fish_parameters *from);

/* The least number of sheet points that resolves the smallest depth of a strip: 1 + 5 L/w; 0 for other sheets. */
int fish_sheet_least(const struct fish_parameters *from);

#endif
