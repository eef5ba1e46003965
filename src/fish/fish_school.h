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

/* Build a school from checked parameters, in an arena of its own that is released with the parent (NULL: none) or by
 * fish_school_free. Fails with STATUS_CASE if fish overlap or are not between the walls at the start, or with
 * STATUS_STOPPED; *school is then NULL. */
enum status fish_school_create(struct arena *parent, struct school **school,
                               const struct school_parameters *parameters);

/* Fail with STATUS_CASE if two fish would overlap at the places that control laws hold, for offsets of the noses from
 * those of the leaders, or for those of the case if offset is NULL                                 (n_fish, 2), m */
enum status fish_school_places(const struct school *school, const double *offset);

/* Release the school with all data. Accepts NULL. */
void fish_school_free(struct school *school);

/* Fish that share a shape with one of the FISH_SHARED fish before them also share the cost of the shape. The search is
 * bounded, so that the set-up grows linearly with the number of fish. */
enum { FISH_SHARED = 64 };

#endif
