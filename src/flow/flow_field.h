/* flow_field.h: the velocity of the fluid anywhere. Tested by tests/flow/test_flow.c. */
#ifndef FLOW_FIELD_H
#define FLOW_FIELD_H

#include "flow/flow.h"

/* The velocity of the fluid and its gradient at any points, at the event of the state, as another body would see them:
 * every wake and every bound sheet with its full smoothing; NaN beyond the walls. Where there are many it sums by the
 * tree, to 1e-7 (velocity_sum.h). Changes nothing that a run depends on. Fails with STATUS_MEMORY. */
enum status flow_field(struct flow *flow, const struct state *state, const struct induced *at);

#endif
