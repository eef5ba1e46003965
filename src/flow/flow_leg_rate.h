/* flow_leg_rate.h: the momentum that legs take because their lengths s change along a wake. doc/model.md, section
 * 18. Tested by tests/flow/test_flow_leg_rate.c. */
#ifndef FLOW_LEG_RATE_H
#define FLOW_LEG_RATE_H

#include "flow/flow.h"

/* Set the boxes of all legs, which flow_leg_rate needs; call it after flow_at_wake. */
void flow_leg_boxes(struct flow *flow);

/* The rate R at which fish f and its wake lose momentum because legs of different lengths s act on each other, over
 * density and depth, m4 s-2: x, y, and its moment about the origin, m5 s-2. rate counts the legs of all fish, image the
 * images of legs, along walls only. At the event of the state, after flow_at_wake. 0 without legs. */
void flow_leg_rate(const struct flow *flow, const struct state *state, int f, double rate[3], double image[3]);

#endif
