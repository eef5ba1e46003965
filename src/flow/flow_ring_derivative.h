/* flow_ring_derivative.h: flow_derivative.h for vortex rings. doc/model.md, section 18. Tested by
 * tests/school/test_residual.c. */
#ifndef FLOW_RING_DERIVATIVE_H
#define FLOW_RING_DERIVATIVE_H

#include "flow/flow.h"

/* Add to an empty block the velocity of all rings of fish g at the points of fish f: by strengths, and with_places also
 * by positions and lines, with the points of f fixed. nascent != 0: only the nascent stretch. */
void flow_ring_derivative(const struct flow *flow, int f, int g, int with_places, int nascent,
                          const struct influence_block *block);

/* Add the derivatives by the motion of the points of fish f in the field of all sources. After flow_gradient. */
void flow_ring_motion(const struct flow *flow, int f, const struct influence_block *block);

#endif
