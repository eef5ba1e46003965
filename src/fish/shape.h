/* shape.h: the shape of a body. Points and directions on its line are weighted sums over the nodes, and profiles give
 * its thickness and depth. doc/model.md, section 6. Tested by tests/fish/test_shape.c.
 *
 * u = 0 is the nose, u = k node k, and u = n_nodes - 1 the tail. Two lines lead through the nodes: the polygon of
 * straight edges, and a smooth curve. */
#ifndef SHAPE_H
#define SHAPE_H

#include "base/arena.h"
#include "fish/parameters.h"

/* A weighted sum over nodes. Point of the body: the weights add to 1. Vector along the body: the weights add to 0. */
struct stencil {
    int n;
    const int *node;      /* (n) */
    const double *weight; /* (n) */
};

/* A vector along the body: point `to` minus point `from`. */
struct tangent {
    struct stencil from, to;
};

/* Owns the nodes and weights of all stencils of the functions below. */
struct curve;

/* n_polygon, n_smooth: largest number of stencils on the polygon and on the smooth curve; the smooth curve needs at
 * least four nodes. */
struct curve *curve_create(struct arena *arena, int n_nodes, int n_polygon, int n_smooth);

/* The point u of the polygon: two nodes. */
struct stencil curve_polygon_point(struct curve *curve, double u);

/* The middle of two points of the polygon: at most four nodes, each once. */
struct stencil curve_polygon_middle(struct curve *curve, const struct stencil *a, const struct stencil *b);

/* The middle of an edge: two nodes. Makes no new stencil. */
struct stencil curve_edge_middle(const struct curve *curve, int edge);

/* The point u of the smooth curve, and the derivative of the position by u: all nodes. */
struct stencil curve_smooth_point(struct curve *curve, double u);
struct stencil curve_smooth_slope(struct curve *curve, double u);

/* c_k of the smooth curve, b_k(u) = (c_k/(u - k))/sum over i of c_i/(u - i); factor: (n_nodes), at least four. */
void curve_smooth_factors(int n_nodes, double *factor);

/* The outline of a body: thickness h in the plane of motion, depth w normal to the plane of motion.
 * doc/model.md, section 1.
 *
 *     nose  <------- s ------->               half thickness r(s), h = 2 r
 *        ___-----------___
 *     <_____________________==========>  tail
 */

/* The section of one edge. */
struct profile_edge {
    double h, w;         /* thickness and depth, m */
    double square, cube; /* mean of h^2 over h^2, mean of h^3 over h^3 */
};

/* Edge k of a fish. body.section mean: means over the edge; nodes: the mean of both ends, square and cube are 1. */
struct profile_edge profile_edge(const struct fish_parameters *fish, int k);

/* Thickness at the tail, m: body.tail_thickness for a joukowski outline, the last pair of a table of pairs, otherwise
 * the thickness of the last edge. */
double profile_tail_thickness(const struct fish_parameters *fish);

#endif
