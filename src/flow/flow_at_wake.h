/* flow_at_wake.h: the velocity of the fluid at the markers of free sheets, or at the released vortices, of all
 * fish. doc/model.md, sections 8, 9 and 18. Tested by tests/flow/test_flow.c, tests/flow/test_flow_at_markers.c.
 *
 * The velocity at markers comes from the same sources as the force on bodies, with the same smoothing for the same
 * pair. This is what conserves the impulse of bodies and wakes. The body that shed the markers acts on them with the
 * tapered smoothing delta(d) of sheet.h; images are never tapered. */
#ifndef FLOW_AT_WAKE_H
#define FLOW_AT_WAKE_H

#include "flow/flow.h"

/* Set wake_range, wake_u, wake_v and all other arrays at markers, for the event of the state. */
void flow_at_wake(struct flow *flow, const struct state *state);

#endif
