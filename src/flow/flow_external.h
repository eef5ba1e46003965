/* flow_external.h: the external flow at time t, a stream with shear and gusts. doc/model.md, sections 8 and 9.
 * Tested by tests/flow/test_flow.c. */
#ifndef FLOW_EXTERNAL_H
#define FLOW_EXTERNAL_H

#include "fish/fish.h"

/* flow_external_gust gives only the travelling gust; flow_external_gradient gives u_x, u_y, v_x, s-1 (v_y = -u_x). */
void flow_external(const struct school *school, double t, double x, double y, double *u, double *v);
void flow_external_gust(const struct school *school, double t, double x, double y, double *u, double *v);
void flow_external_gradient(const struct school *school, double t, double x, double y, double gradient[3]);

/* The acceleration Du/Dt of a particle of the external flow at time t, m s-2. It is uniform in space; a travelling gust
 * is left out. */
void flow_external_acceleration(const struct school *school, double t, double acceleration[2]);

#endif
