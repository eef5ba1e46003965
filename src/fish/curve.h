/* curve.h: points on the line of a body and the direction of that line, as weighted sums over its nodes. doc/model.md,
 * section 6. Tested by tests/fish/test_curve.c.
 *
 * u = 0 is the nose, u = k node k, u = n_nodes - 1 the tail. Two lines lead through the nodes: the polygon of straight
 * edges, and a smooth curve. */
#ifndef CURVE_H
#define CURVE_H

#include "base/status.h"

/* A weighted sum over nodes. A point that moves with the body: the weights add to 1. A vector along it: they add to
 * 0. */
struct stencil {
    int n;
    const int *node;      /* (n) */
    const double *weight; /* (n) */
};

/* A vector along the body: the sum of to less that of from. */
struct tangent {
    struct stencil from, to;
};

/* Owns the nodes and weights of all stencils that are made with it. */
struct curve;

/* For at most this many stencils on the polygon and on the smooth curve; the latter needs at least four nodes. Fails
 * with STATUS_MEMORY; curve_free accepts NULL. */
enum status curve_create(struct curve **curve, int n_nodes, int n_polygon, int n_smooth);
void curve_free(struct curve *curve);

/* The point u of the polygon: two nodes. */
struct stencil curve_polygon_point(struct curve *curve, double u);

/* The middle of two points of the polygon: at most four nodes, each once. */
struct stencil curve_polygon_middle(struct curve *curve, const struct stencil *a, const struct stencil *b);

/* The middle of an edge: two nodes. Makes no new stencil. */
struct stencil curve_edge_middle(const struct curve *curve, int edge);

/* The point u of the smooth curve, and the derivative of its place by u: all nodes. */
struct stencil curve_smooth_point(struct curve *curve, double u);
struct stencil curve_smooth_slope(struct curve *curve, double u);

#endif
