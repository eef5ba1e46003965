/* flow_ring_derivative.h: flow_derivative.h for vortex rings. doc/model.md, section 18. Tested by
 * tests/school/test_residual.c. */
#ifndef FLOW_RING_DERIVATIVE_H
#define FLOW_RING_DERIVATIVE_H

#include "flow/flow.h"

/* Add to an empty block what all rings of fish g cause at the points of fish f: by strengths, and with_places by places
 * and lines too, the points of f at rest. Where nascent is not 0, those of the nascent stretch alone. */
void flow_ring_derivative(const struct flow *flow, int f, int g, int with_places, int nascent,
                          const struct influence_block *block);

/* Add the derivatives by the motion of the points of fish f in the field of all sources. After flow_gradient. */
void flow_ring_motion(const struct flow *flow, int f, const struct influence_block *block);

#endif
