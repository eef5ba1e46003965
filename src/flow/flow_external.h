/* flow_external.h: external flow: a stream with shear and gusts. doc/model.md, sections 8 and 9. Tested by
 * tests/flow/test_flow.c. */
#ifndef FLOW_EXTERNAL_H
#define FLOW_EXTERNAL_H

#include "fish/fish.h"

/* The external flow at height y at time t. */
void flow_external(const struct school *school, double t, double y, double *u, double *v);

/* Acceleration Du/Dt of a particle of the external flow at time t, uniform in space, m s-2. */
void flow_external_acceleration(const struct school *school, double t, double acceleration[2]);

#endif
