/* flow_at_wake.h: the velocity of the fluid at the released vortices, or at the markers of free sheets, of all fish.
 * doc/model.md, sections 8 and 9. Tested by tests/flow/test_flow.c. */
#ifndef FLOW_AT_WAKE_H
#define FLOW_AT_WAKE_H

#include "flow/flow.h"

/* The velocity of the fluid at the released vortices, or markers, of all fish at the event of the state: wake_u,
 * wake_v, of fish f from wake_range[f].first on. Fails with STATUS_MEMORY. */
enum status flow_at_wake(struct flow *flow, const struct state *state);

#endif
