/* flow_at_bodies.h: velocity of the fluid and velocity gradient at the points of all bodies: external flow, free
 * sheets, nascent vortices, bound sheets, and their images in walls. doc/model.md, sections 6 to 9, 17. Tested by
 * tests/flow/test_flow.c. */
#ifndef FLOW_AT_BODIES_H
#define FLOW_AT_BODIES_H

#include "flow/flow.h"

/* Place all sources at time t (at or after the event of the state) for the unknowns y, and sum the velocity
 * (flow_gradient: velocity and gradient) at all points of all fish. Fail with STATUS_MEMORY. */
enum status flow_velocity(struct flow *flow, const struct state *state, double t, const double *y);
enum status flow_gradient(struct flow *flow, const struct state *state, double t, const double *y);

/* Build the interpolation in time of the velocity of the released vortices at the bodies, until the next event. Until
 * the wakes change, the released vortices are not summed for a fish that stays near its predicted path. Call at an
 * event, after the vortices have their velocities. Fails with STATUS_MEMORY. */
enum status flow_interpolate(struct flow *flow, const struct state *state);

/* Sum every released vortex until the next flow_interpolate. */
void flow_sum_exactly(struct flow *flow);

/* Set image_u and image_v to the velocity of all images in walls at the points of all bodies, at the event of the
 * state. Fails with STATUS_MEMORY. */
enum status flow_images(struct flow *flow, const struct state *state);

/* The flow at one body, from the last sum. */
struct flow_at_body {
    const double *u, *v; /* velocity of the fluid at the points, m s-1 (flow_n_points) */
    const double *div;   /* divergence of the velocity in the plane, s-1 (flow_n_points); NULL without rings */
    const double *edge;  /* a of the edge force: x, then y edge_stride later, m-1 s-1; NULL without rings */
    int edge_stride;
    double acceleration[2]; /* of the external flow, m s-2 */
};
struct flow_at_body flow_at_body(const struct flow *flow, int f);

/* w: velocity of the midpoint of an edge relative to the fluid; velocity: absolute velocity of the midpoint. */
void flow_relative_velocity(const struct fish *fish, int edge, const double velocity[2], const double *u,
                            const double *v, double w[2]);

/* Velocity of the fluid relative to the tail of fish f, u - v_tail. After flow_velocity. */
void flow_slip(const struct flow *flow, int f, const double *y, double slip[2]);

/* Velocity of the fluid at any point. */

/* Velocity of the fluid and velocity gradient at any points, at the event of the state: every wake and every bound
 * sheet with the full smoothing, as for another body; NaN beyond the walls. Many points are summed by the tree, to 1e-7
 * (velocity_sum.h). No result of the run depends on this function. Fails with STATUS_MEMORY. */
enum status flow_field(struct flow *flow, const struct state *state, const struct induced *at);

#endif
