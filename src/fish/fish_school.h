/* fish_school.h: computes the constants of a school (fish.h) from its checked parameters (parameters.h). Tested by
 * tests/fish/test_fish.c. */
#ifndef FISH_SCHOOL_H
#define FISH_SCHOOL_H

#include <stdbool.h>

#include "base/arena.h"
#include "base/status.h"
#include "fish/fish.h"

/* Whether the sheets of the fish consist of vortex rings: force: pressure with span: finite. */
static inline bool fish_is_strip(const struct fish_parameters *from) {
    return from->force == FORCE_PRESSURE && from->span == SPAN_FINITE;
}

/* The least number of sheet points that resolves the smallest depth of a strip: 1 + 5 L/w; 0 for other sheets. */
int fish_sheet_least(const struct fish_parameters *from);

/* Build a school from checked parameters, in an arena of its own that is released with the parent (NULL: none) or by
 * fish_school_free. Fails with STATUS_CASE if fish overlap or are not between the walls at the start, or with
 * STATUS_STOPPED; *school is then NULL. */
enum status fish_school_create(struct arena *parent, struct school **school,
                               const struct school_parameters *parameters);

/* Release the school with all data. Accepts NULL. */
void fish_school_free(struct school *school);

// ---- parts of fish_school_create, for fish f of an array of fish

/* Fish that share a shape with one of the FISH_SHARED fish before them also share the cost of the shape. The search is
 * bounded, so that the set-up grows linearly with the number of fish. */
enum { FISH_SHARED = 64 };

/* fish_body.c: set all data per node, edge and joint except the gait. Numbers of nodes, length and edge_length of the
 * fish are set. */
void fish_body_set(struct arena *arena, struct fish *fish, int f, const struct fish_parameters *from,
                   const struct fluid_parameters *fluid);

/* fish_sheet.c: set all data per vortex and per control point. The body of the fish is set. is_strip: the school has
 * sheets of finite span. Fails with STATUS_STOPPED. */
enum status fish_sheet_set(struct arena *arena, struct fish *fish, int f, const struct school_parameters *parameters,
                           bool is_strip);

#endif
