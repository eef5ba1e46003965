/* flow_at_bodies.h: the velocity of the fluid at the points of all bodies, and its gradient: external flow, free
 * sheets, nascent vortices, bound sheets, and their images in walls. doc/model.md, sections 6 to 9, 17. Tested by
 * tests/flow/test_flow.c. */
#ifndef FLOW_AT_BODIES_H
#define FLOW_AT_BODIES_H

#include "flow/flow.h"

/* Place all sources where they are at time t (at or after the event of the state) for the unknowns y, and sum the
 * velocity at all points of all fish; or the velocity with its gradient. Fail with STATUS_MEMORY. */
enum status flow_velocity(struct flow *flow, const struct state *state, double t, const double *y);
enum status flow_gradient(struct flow *flow, const struct state *state, double t, const double *y);

/* Interpolate in time what the released vortices cause at the bodies until the next event: from now on, and until the
 * wakes change, they are summed no more for a fish that stays near the path that it has in the state. At an event, once
 * the vortices have their velocities. Fails with STATUS_MEMORY. */
enum status flow_interpolate(struct flow *flow, const struct state *state);

/* Sum every released vortex until the next flow_interpolate. */
void flow_sum_exactly(struct flow *flow);

/* Set image_u and image_v to what all images in walls cause at the points of all bodies, at the event of the state.
 * Fails with STATUS_MEMORY. */
enum status flow_images(struct flow *flow, const struct state *state);

/* What a body feels of the flow as it was last summed. */
struct flow_at_body {
    const double *u, *v; /* velocity at its points, m s-1 (flow_n_points) */
    const double *div;   /* its divergence in the plane, s-1 (flow_n_points); NULL without rings */
    const double *edge;  /* a of the edge force: x, then y edge_stride later, m-1 s-1; NULL without rings */
    int edge_stride;
    double acceleration[2]; /* of the external flow, m s-2 */
};
struct flow_at_body flow_at_body(const struct flow *flow, int f);

/* Velocity of the midpoint of an edge, which moves with the given one, relative to the fluid: w. */
void flow_relative_velocity(const struct fish *fish, int edge, const double velocity[2], const double *u,
                            const double *v, double w[2]);

/* The fluid's velocity past the tail of fish f, u - v_tail. After flow_velocity. */
void flow_slip(const struct flow *flow, int f, const double *y, double slip[2]);

#endif
