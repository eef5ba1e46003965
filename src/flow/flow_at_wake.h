/* flow_at_wake.h: the velocity of the fluid at the released vortices, or at the markers of free sheets, of all fish.
 * doc/model.md, sections 8 and 9. Tested by tests/flow/test_flow.c. */
#ifndef FLOW_AT_WAKE_H
#define FLOW_AT_WAKE_H

#include "flow/flow.h"

/* Velocity of the fluid at the markers of all free sheets. doc/model.md, section 8. Part of
 * flow_at_wake.h.
 *
 * The velocity at markers and the force on bodies have the same sources, with the same smoothing for the same pair, so
 * that the impulse of bodies and wakes is conserved:
 *
 *     markers of all fish     mean of squares of delta of both fish
 *     sheets of bodies        delta of the fish of the marker; own body: tapered delta(d), free_sheet.h
 *     images                  as above, never tapered
 *
 * Sources of a body with force: pressure: the control points with the circulations of section 15, which also determine
 * the force; of any other body: the bound vortices. */

/* The velocity of the fluid at the released vortices, or markers, of all fish at the event of the state: wake_u,
 * wake_v, of fish f from wake_range[f].first on. Fails with STATUS_MEMORY. */
enum status flow_at_wake(struct flow *flow, const struct state *state);

#endif
