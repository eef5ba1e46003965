/* fish_school.h: from the checked parameters of a school to the constants. Tested by tests/fish/test_fish.c. */
#ifndef FISH_SCHOOL_H
#define FISH_SCHOOL_H

#include "base/status.h"
#include "fish/fish.h"

/* From the parameters of a fish to the constants of edges and joints: shape, masses, stiffness,
 * damping, drag and added mass. doc/model.md, sections 1, 3 and 9. */

/* Set all data per node, edge and joint except the gait. Numbers of nodes, length and edge_length of the fish are set.
 * Fails with STATUS_MEMORY. */
enum status fish_body_set(struct fish *fish, const struct fish_parameters *from, const struct fluid_parameters *fluid);

/* Positions of bound vortices and control points, and weights in the integrals of sheet and pressure.
 * doc/model.md, sections 6, 15 and 18. */

/* Set all data per vortex and per control point. Numbers of nodes and points, length and depth of the fish are set.
 * Fails with STATUS_MEMORY. */
enum status fish_sheet_set(struct fish *fish, const struct fish_parameters *from,
                           const struct school_parameters *parameters);

/* Whether the sheets of the fish consist of vortex rings: force: pressure with span: finite. */
int fish_is_strip(const struct fish_parameters *from);

/* The least number of sheet points that resolves the smallest depth of a strip: 1 + 5 L/w; 0 for other sheets. */
int fish_sheet_least(const struct fish_parameters *from);

/* Build a school from checked parameters. Fails with STATUS_MEMORY, or with STATUS_CASE if fish overlap or are not
 * between the walls at the start. */
enum status fish_school_create(struct school **school, const struct school_parameters *parameters);

/* Release the school with all data. Accepts NULL. */
void fish_school_free(struct school *school);

#endif
