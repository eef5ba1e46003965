/* flow_rings.h: sheets of finite depth: velocity of the vortex rings of bodies and wakes at bodies, at markers and at
 * any point. doc/model.md, section 18. Tested by tests/flow/test_flow_rings.c.
 *
 *     own control points        own bound vortices and legs; own wake point by point, tapered      b = w/4
 *     own edge midpoints        own wake, a point for every stretch, unless force: reactive        b = w/4
 *     own markers               own markers; own control points, tapered                           b = w/4
 *     bodies, markers of others control points; a point for every stretch, or markers              b = w/2
 *     images in walls           of all fish, including the own                                     b = w/2
 */
#ifndef FLOW_RINGS_H
#define FLOW_RINGS_H

#include "flow/flow.h"

/* Add velocity and div u of all rings at a chunk of points, with_gradient: and the gradients. */
void flow_rings_at_chunk(const struct flow *flow, const struct chunk *chunk, int with_gradient);
double flow_rings_work(const struct flow *flow);
void flow_rings_zero(const struct flow *flow, int with_gradient);

/* Set wake_range, wake_u, wake_v and all arrays at markers for the event of the state, after flow_place. Fails with
 * STATUS_MEMORY. */
enum status flow_rings_at_markers(struct flow *flow, const struct state *state);

/* Select the sums of other fish and of images at all points that are by the tree, and add these sums, which
 * flow_rings_at_chunk omits. Fails with STATUS_MEMORY: the sums are then incomplete. flow_rings_direct selects no sum.
 */
enum status flow_rings_many(const struct flow *flow, int threads, int with_gradient);
void flow_rings_direct(const struct flow *flow);

/* Add the far part of the own wakes to the velocity and div u at the points; flow_rings_at_chunk without gradients
 * omits this part. */
void flow_rings_far(const struct flow *flow);

/* Set image_u, image_v, image_div at the points of all bodies. */
void flow_rings_images(struct flow *flow);

/* Velocity, div u and gradients of all rings at any points, as for another body. */
void flow_rings_at(const struct flow *flow, const struct induced *at);

/* Rate of momentum from the interaction of the legs of a fish at different lengths s, over density and depth: x, y,
 * about the origin; at the event of the state, after flow_rings_at_markers. */
void flow_rings_leg_rate(const struct flow *flow, int f, double rate[3]);

#endif
