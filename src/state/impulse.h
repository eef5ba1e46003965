/* impulse.h: the impulse of vortices, and what of it the wakes lose where vortices decay, are removed or merged.
 * doc/model.md, section 13. Tested by tests/state/test_impulse.c.
 *
 * In the plane a vortex of circulation G at x has the impulse -rho w E3 x G and the angular impulse -rho w |x|^2 G/2
 * about the origin, w being the depth of its fish. */
#ifndef IMPULSE_H
#define IMPULSE_H

#include "state/state.h"

/* Sums over vortices of the circulation, m2 s-1, times 1, x, y, x^2 + y^2, x y. */
struct impulse_moments {
    double circulation, x, y, square, product;
};

void impulse_add(struct impulse_moments *sum, double circulation, double x, double y);

/* Half of a circulation at each end of a stretch. */
void impulse_add_stretch(struct impulse_moments *sum, double circulation, const double one[2], const double other[2]);

/* Those of the released vortices, or stretches between markers, of a wake, tau after the event at time t; with the
 * strengths that they have in velocity sums. */
struct impulse_moments impulse_of_wake(const struct wake *wake, const struct school *school, double t, double tau);

/* The impulse in x and y, N s, and the angular impulse, N m s, of vortices; factor: density times depth, kg m-2. */
void impulse_of(const struct impulse_moments *sum, double factor, double impulse[3]);

/* The depth of a fish, m; NaN where it varies along the body. */
double impulse_depth(const struct fish *fish);

/* Book what the wake of fish f loses from the event of the state until the next one, before it moves; and what the old
 * vortices still have, before they are removed at the event of the state. Where the circulation lost is given back to
 * the body (wake.removed_circulation: dropped), it goes to the tail. */
void impulse_fade(const struct school *school, struct state *state, int f);
void impulse_remove(const struct school *school, struct state *state, int f);

/* Book the difference of two sums for a wake that has changed at an event: before less after. */
void impulse_book(struct momentum_balance *momentum, const struct impulse_moments *before,
                  const struct impulse_moments *after);

#endif
