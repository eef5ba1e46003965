/* flow_at_wake.h: the velocity of the fluid at the markers of free sheets, or at the released vortices, of all fish.
 * doc/model.md, sections 8, 9 and 18. Tested by tests/flow/test_flow.c, tests/flow/test_flow_at_markers.c.
 *
 * The velocity at markers and the force on bodies have the same sources, with the same smoothing for the same pair, so
 * that the impulse of bodies and wakes is conserved. The body that shed the markers acts on them with the tapered
 * smoothing delta(d), sheet.h; images are never tapered. */
#ifndef FLOW_AT_WAKE_H
#define FLOW_AT_WAKE_H

#include "flow/flow.h"

/* Set wake_range, wake_u, wake_v and all arrays at markers for the event of the state. */
void flow_at_wake(struct flow *flow, const struct state *state);

/* Rate of momentum of a fish from the interaction of legs at different lengths s, over density and depth: x, y, about
 * the origin; of legs of its own, of other fish, and the part along walls of those of images. Of its own only where a
 * sum at wakes is by the tree. At the event of the state, after flow_at_wake, and with walls after flow_images. 0
 * without legs. */
void flow_leg_rate(const struct flow *flow, int f, double rate[3], double image[3]);

#endif
