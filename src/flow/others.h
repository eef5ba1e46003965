/* others.h: the velocity that distant wakes and bodies of other fish induce at the points of a body. doc/numerics.md,
 * section 12. Tested by tests/flow/test_others.c.
 *
 * A velocity that comes from afar is smooth along a body, so it is enough to know it at a few far points:
 *
 *     far points     Chebyshev points along the body; polynomials carry velocity, divergence and the gradients of both
 *                    from the far points to the points of the body
 *     far wakes      are summed at the end of the interval, at far points that move with the velocity and the
 *                    acceleration of the last event; for a time before the end also at the start and in the middle,
 *                    and a parabola in time gives the rest
 *     far bodies     act at every evaluation, from their own far points, whose strengths have the moments of the body
 *     near sources   are left to the sum of flow_at_bodies.c
 *
 * Each event decides from the state alone which sources are near, so the bits depend neither on threads nor on a
 * resumed run. Images, and the body and the wake of the same fish, are never far. */
#ifndef OTHERS_H
#define OTHERS_H

#include <stdbool.h>

#include "base/arena.h"
#include "base/parallel.h"
#include "state/state.h"

struct flow;
struct others;
struct targets;

/* Far points for all fish of the flow. */
struct others *others_create(struct arena *arena, const struct flow *flow);

/* Before a sum at time t: if the last event or a wake has changed, find the near sources, and sum the far wakes at the
 * times that t needs. This places the flow at other times. */
void others_select(struct flow *flow, const struct state *state, double t);

/* Set the far points to the unknowns y, after flow_place. */
void others_place(struct flow *flow, const struct state *state, const double *y, int threads);

/* Whether the sums over other fish are by this file. They are not without wake.tolerance, with a steady wake, before
 * the start, for few vortices, or when a body has left the path that the last event predicts for it. */
bool others_are_selected(const struct flow *flow);

/* Sum all far sources at the far points, after others_place. */
void others_sum(struct flow *flow, const struct state *state, int threads);

/* Add the far sources at a range of the points of fish f; at: the targets of this range. */
void others_add(const struct flow *flow, int f, struct range which, const struct targets *at);

/* Sources of one fish that are near another one: a range of its released wake, which may be empty, and possibly its
 * body with the nascent point of its wake. */
struct near_sources {
    int fish;
    struct range wake;
    bool with_body;
};

/* The near sources of fish f in the order of the fish, *n of them; the own body and wake are among them. */
const struct near_sources *others_near(const struct flow *flow, int f, int *n);

#endif
