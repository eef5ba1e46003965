/* others.h: the velocity that distant wakes and bodies of other fish induce at the points of a body, by few far points.
 * doc/numerics.md, section 12. Tested by tests/flow/test_others.c.
 *
 *     far points     Chebyshev points along the body; polynomials carry velocity, divergence and the gradients of both
 *                    from the far points to the points of the body
 *     far wakes      summed at the start, in the middle and at the end of an interval, at far points that move with the
 *                    velocity of the last event; in between a parabola in time, and the gradient times the displacement
 *     far bodies     summed at every evaluation, with the nascent point of the wake; distant ones from their own far
 *                    points, whose strengths have the moments of the body along its curve; of many fish by the tree,
 *                    less the bodies that are not distant
 *     near sources   are left to the sum of flow_at_bodies.c
 *     reach          of a body: distance beyond which the strongest source of the school is far, and the largest body
 *                    distant; pairs of fish beyond it need no test of their sources, and no loop visits them
 *
 * Which sources are far is decided at each event, from the state alone: the bits do not depend on threads or on a
 * resumed run. Images, and the body and wake of the same fish, are never far. */
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

/* Before a sum: if the last event or a wake has changed, select the far sources and sum the far wakes; places the flow
 * at the event. Without wake.tolerance, with a steady wake, or before the start no source is far. */
void others_select(struct flow *flow, const struct state *state);

/* Whether sums over other fish are by this file: never by the tree. */
bool others_are_selected(const struct flow *flow);

/* Set the far points to the unknowns y, and sum all far sources there; after flow_place. */
void others_sum(struct flow *flow, const struct state *state, const double *y, int threads);

/* Add the far sources at a range of the points of fish f; at: the targets of this range. */
void others_add(const struct flow *flow, int f, struct range which, const struct targets *at);

/* The next fish after g, or the first one (g: -1), of which some source is near or the body does not act from few
 * points, or which is fish f; n_fish after the last one. Every fish, if is_every or if one has drifted. */
int others_next(const struct flow *flow, int f, int g, bool is_every);

/* The near sources of fish g at fish f: of the body, and with the body the nascent point; of the released wake. */
struct others_near {
    struct range body;
    const struct range *wake;
    int n_wake;
};
struct others_near others_near(const struct flow *flow, int f, int g);

#endif
