/* edge.h: frame and motion of an edge of a body. doc/model.md, sections 2 and 9. Tested by
 * tests/body/test_edge.c. */
#ifndef EDGE_H
#define EDGE_H

#include "fish/fish.h"

/* From node k to node k+1. */
struct edge {
    double length, t[2], n[2];                      /* m; unit tangent and normal, n = E3 x t */
    double middle[2], velocity[2], acceleration[2]; /* of the midpoint: m, m s-1, m s-2 */
    double rate[2];                                 /* velocity of node k+1 minus velocity of node k, m s-1 */
};

/* Edge k of a fish for the unknowns y. */
struct edge edge_at(const struct fish *fish, int k, const double *y);

/* The rate at which the edge turns, rad s-1. */
double edge_turn_rate(const struct edge *edge);

double edge_dot(const double a[2], const double b[2]);

/* The curvature kappa = 2 tan(angle/2) of a joint between the unit vectors before and after, with first and second
 * derivative by the angle from before to after. */
struct bend {
    double curvature, slope, second;
};
struct bend edge_bend(const double before[2], const double after[2]);

/* Index of component i (0: x, 1: y) of the position, velocity or acceleration of a node among all unknowns. */
int edge_place(const struct fish *fish, int i, int node);
int edge_velocity(const struct fish *fish, int i, int node);
int edge_acceleration(const struct fish *fish, int i, int node);

#endif
