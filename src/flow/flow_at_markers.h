/* flow_at_markers.h: the velocity of the fluid at the markers of all free sheets. doc/model.md, section 8. Part of
 * flow_at_wake.h. Tested by tests/flow/test_flow.c.
 *
 * What convects markers is what pushes bodies, with the same smoothing for the same pair, so that the impulse of bodies
 * and wakes is conserved:
 *
 *     markers of all fish     mean of squares of delta of both fish
 *     the sheets of bodies    delta of the marker's fish; of the own body the tapered delta(d): free_sheet.h
 *     images of all of them   the same, never tapered
 *
 * A body with force: pressure acts from its control points with the circulations of section 15, which its force has
 * too; any other from its bound vortices. */
#ifndef FLOW_AT_MARKERS_H
#define FLOW_AT_MARKERS_H

#include "flow/flow.h"

/* Place the markers of all fish and their bodies at the event of the state, for which the flow has been placed: the
 * vortices `convecting`, wake_range and body_range. Fails with STATUS_MEMORY. */
enum status flow_at_markers_place(struct flow *flow, const struct state *state);

/* Set wake_u and wake_v to the velocity at these markers. Fails with STATUS_MEMORY. */
enum status flow_at_markers(struct flow *flow, const struct state *state);

#endif
