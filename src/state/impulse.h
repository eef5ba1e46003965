/* impulse.h: impulse of vortices, and impulse lost by wakes in decay and by the removal of vortices and markers.
 * doc/model.md, section 13. Tested by tests/state/test_impulse.c.
 *
 * In the plane a vortex of circulation G at x has the impulse -rho w E3 x G and the angular impulse -rho w |x|^2 G/2
 * about the origin, with the depth w of the fish. */
#ifndef IMPULSE_H
#define IMPULSE_H

#include "state/state.h"

/* Sums over vortices of circulation, m2 s-1, times 1, x, y, x^2 + y^2, x y. */
struct impulse_moments {
    double circulation, x, y, square, product;
};

/* Add a vortex to the sums. */
void impulse_add(struct impulse_moments *sum, double circulation, double x, double y);

/* Add a stretch of a vortex sheet: half of the circulation at each end. */
void impulse_add_stretch(struct impulse_moments *sum, double circulation, const double one[2], const double other[2]);

/* Sums over the released vortices of a wake, or over the stretches between markers, at time t + tau, t being the time
 * of the event; circulations include the decay, as in velocity sums. */
struct impulse_moments impulse_of_wake(const struct wake *wake, const struct school *school, double t, double tau);

/* Impulse in x and y, N s, and angular impulse, N m s, of vortices; factor: density times depth, kg m-2. */
void impulse_of(const struct impulse_moments *sum, double factor, double impulse[3]);

/* The depth of a fish, m; NaN if the depth varies along the body. */
double impulse_depth(const struct fish *fish);

/* Lost circulation of a wake, tau after the event at time t: removed vortices, and decayed circulation. */
double impulse_lost_circulation(const struct wake *wake, const struct school *school, double t, double tau);

/* Book the moments that decay in the wake of fish f between the event of the state and the next event; call it before
 * the wake moves. With wake.removed_circulation: dropped, the lost circulation returns to the body, and is booked at
 * the tail; likewise below. */
void impulse_fade(const struct school *school, struct state *state, int f);

/* Workspace of impulse_thin_wake: the vortices before, which of them is which afterwards (-1: none), and the sources
 * before and after that are the same. */
struct impulse_thinning {
    int capacity;
    double *x, *y, *circulation, *birth;
    int *after;
    bool *is_same[2];
};

/* Make room for a wake; not in parallel. */
void impulse_thinning_reserve(struct arena *arena, struct impulse_thinning *thinning, const struct wake *wake);

/* Remove old vortices, and drop and restore markers, at the event of the state after the release. Returns what the wake
 * lost, summed over the sources that change; product is 0. */
struct impulse_moments impulse_thin_wake(const struct school *school, struct state *state, int f,
                                         struct impulse_thinning *thinning);

/* Book what impulse_thin_wake returned. */
void impulse_book_thinned(const struct school *school, struct state *state, int f, const struct impulse_moments *lost);

/* Book the loss of a wake that has changed at an event: before minus after. */
void impulse_book(struct momentum_balance *momentum, const struct impulse_moments *before,
                  const struct impulse_moments *after);

#endif
