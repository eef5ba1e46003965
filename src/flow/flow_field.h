/* flow_field.h: velocity of the fluid at any point. Tested by tests/flow/test_flow.c. */
#ifndef FLOW_FIELD_H
#define FLOW_FIELD_H

#include "flow/flow.h"

/* Velocity of the fluid and velocity gradient at any points, at the event of the state: every wake and every bound
 * sheet with the full smoothing, as for another body; NaN beyond the walls. Many points are summed by the tree, to 1e-7
 * (velocity_sum.h). No result of the run depends on this function. Fails with STATUS_MEMORY. */
enum status flow_field(struct flow *flow, const struct state *state, const struct induced *at);

#endif
