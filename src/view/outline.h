/* outline.h: the outline of a body as a polygon around the smooth curve through the nodes, which carries the bound
 * sheet (doc/model.md, section 6). It is as thick as the edges are. Tested by tests/view/test_outline.c.
 *
 *            left side, from nose to tail
 *      .--------------------------.
 *     <  . . . points of the curve . >        the polygon goes along the left side and back along the right one
 *      '--------------------------' */
#ifndef OUTLINE_H
#define OUTLINE_H

#include <stdbool.h>

#include "base/arena.h"

enum { OUTLINE_POINTS = 48 /* of the curve, dense at nose and tail */, OUTLINE_SIDES = 2 * OUTLINE_POINTS - 2 };

/* The map from the nodes of a body to the outline. */
struct outline {
    int n_nodes;
    double *weight; /* points of the curve: weights of the nodes                  (OUTLINE_POINTS, n_nodes) */
    double *slope;  /* and of the derivative along the body                       (OUTLINE_POINTS, n_nodes) */
    double *half;   /* half thickness there, m; 0 at the ends                      (OUTLINE_POINTS) */
};

/* For a body of n_nodes (at least four) with the thickness of every edge [m] (n_nodes - 1): the mean over the edge if
 * is_mean, else the sum of the half thicknesses at the two nodes (fish.body.section). */
struct outline outline_create(struct arena *arena, int n_nodes, const double *thickness, bool is_mean);

/* Where along the curve point i of the polygon is, from 0 at the nose to 1 at the tail. The points are counted from the
 * nose along the left side. */
double outline_part(int i);

/* The polygon [m] (OUTLINE_SIDES, 2) of a body whose nodes are at these positions [m] (n_nodes, 2). */
void outline_polygon(const struct outline *outline, const double *nodes, double *polygon);

#endif
