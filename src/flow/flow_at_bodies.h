/* flow_at_bodies.h: the velocity of the water, and its gradient, at the points of all bodies and at any other points.
 * It sums the external flow, wakes, bodies, and the images of both in walls. doc/model.md, sections 6 to 9, 17, 18.
 * Tested by tests/flow/test_flow.c. */
#ifndef FLOW_AT_BODIES_H
#define FLOW_AT_BODIES_H

#include "flow/flow.h"

/* Place all sources at time t (at or after the event of the state) for the unknowns y, and sum the velocity at all
 * points of all fish; flow_gradient also sums its gradient. is_steady: all circulation was shed infinitely long ago, as
 * in an equilibrium. */
void flow_velocity(struct flow *flow, const struct state *state, double t, const double *y, bool is_steady);
void flow_gradient(struct flow *flow, const struct state *state, double t, const double *y, bool is_steady);

/* Set image_u, image_v and image_div, the velocity and div u of all images in walls alone, at the points of all bodies,
 * at the event of the state. */
void flow_images(struct flow *flow, const struct state *state);

/* The flow at one body, as the last sum left it. */
struct flow_at_body {
    const double *u, *v; /* velocity of the fluid at the points, m s-1 (flow_n_points) */
    const double *div;   /* divergence of the velocity in the plane, s-1 (flow_n_points); NULL without legs */
    const double *edge;  /* a of the edge force: x, then y edge_stride later, m-1 s-1; NULL without legs */
    int edge_stride;
    double acceleration[2]; /* of the external flow, m s-2 */
};
struct flow_at_body flow_at_body(const struct flow *flow, int f);

/* w: the velocity of the midpoint of an edge relative to the fluid; velocity: its absolute velocity. */
void flow_relative_velocity(const struct fish *fish, int edge, const double velocity[2], const double *u,
                            const double *v, double w[2]);

/* The velocity of the fluid relative to the tail of fish f, u - v_tail. After flow_velocity. */
void flow_slip(const struct flow *flow, int f, const double *y, double slip[2]);

/* Set the velocity and its gradient at any points, at the event of the state. Every wake and every body acts with the
 * full smoothing, as on another body; beyond the walls the values are NaN. This is for pictures: no result of a run
 * depends on it. */
void flow_field(struct flow *flow, const struct state *state, const struct targets *at, bool is_steady);

/* Find how much each fish misses because wakes decay: the part of the velocity of other fish's wakes at its control
 * points that decay has taken, by root mean squares, at the event of the state. It is 0 if no decaying vortex or marker
 * of another fish is within a quarter of the length of the body. part: (n_fish). */
void flow_find_decayed(struct flow *flow, const struct state *state, double *part);

// ---- sums of one kind of sources over many fish, which flow_at_wake.c needs too

/* Decide which sums at bodies, or at wakes, go through the tree; n_targets: of each fish. */
void flow_select_by_tree(struct flow *flow, bool at_wakes, const struct range *targets);

/* Whether the sources of fish g act on fish f in a sum by the tree; this is decided for their classes. */
bool flow_is_by_tree(const struct flow *flow, int f, int g, const struct flow_sum *sum);

/* Add the sum of the sources of class k at targets of class c by the tree. */
void flow_sum_by_tree(struct flow *flow, int c, int k, const struct flow_sum *sum, int threads,
                      const struct targets *at);

/* Add the sources of fish g at targets of fish f unless a sum by the tree has added them. is_excluded: they do not act
 * on these targets, so subtract them if the tree has added them. */
void flow_induce_other(const struct flow *flow, int f, int g, const struct flow_sum *sum, bool is_excluded,
                       const struct targets *at);

#endif
