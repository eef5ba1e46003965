/* stretch.h: what a stretch of a free sheet contributes to the markers around it, and which markers the old part of
 * a sheet needs. doc/model.md, section 7; doc/numerics.md, section 13. Tested by tests/wake/test_stretch.c.
 *
 * Stretch j lies between the markers j and j + 1. A young stretch acts at its two ends, an old one at six markers:
 *
 *     marker    j-2 --- j-1 --- j ===== j+1 --- j+2 --- j+3        the parts B_ab of labels b at markers a
 *     a, b       0       1      2        3       4       5
 *
 * For the two oldest stretches these are the markers 0 to 5; with fewer markers, or where durations jump, four or two
 * markers. */
#ifndef STRETCH_H
#define STRETCH_H

#include "fish/fish.h"
#include "wake/wake.h"

enum { STRETCH_MARKERS = 6 };

/* The integrals of l_a dl_b over a stretch, for a polynomial l_a of each marker. */
struct stretch_form {
    int first, n; /* the oldest of the markers; their number, 2, 4 or 6 */
    const double (*part)[STRETCH_MARKERS];
    double other[STRETCH_MARKERS][STRETCH_MARKERS]; /* part, if the durations are not on dyadic levels */
};

/* The forms of all dyadic levels, for wakes. */
const struct stretch_forms *stretch_forms_create(struct arena *arena);

/* Set the form of stretch j. */
void stretch_set_form(struct stretch_form *form, const struct wake *wake, const struct school *school, int j);

/* At an event, with the newest marker at the tail: count the stretches that have become old; drop markers of the old
 * part; put a marker back into the middle of every stretch there that has grown too long without it, the sooner if a
 * body is near. y: the unknowns. */
void stretch_find_old(struct wake *wake, const struct fish *fish, const struct school *school);
void stretch_drop(struct wake *wake, const struct fish *fish, const struct school *school);
void stretch_restore(struct wake *wake, const struct fish *fish, const struct school *school, const double *y);

#endif
