/* drag.h: the drag on the edges of a body, and the moment of that part of it that the flow causes, which a fish can
 * sense. doc/model.md, sections 9 and 11. Tested by tests/force/test_drag.c. */
#ifndef DRAG_H
#define DRAG_H

#include "body/rod.h"
#include "fish/fish.h"
#include "flow/flow.h"

/* The drag on edge k, N, and its component along the edge, the friction. w: velocity of the midpoint relative to the
 * fluid, m s-1. Half of the drag acts on each node. */
void drag_force(const struct fish *fish, int k, const struct edge *s, const double w[2], double force[2],
                double friction[2]);

/* How the drag changes with w, as [component][component of w], and with a rotation of the edge (dt = n, dn = -t). */
void drag_slope(const struct fish *fish, int k, const struct edge *s, const double w[2], double by_velocity[2][2],
                double by_turn[2]);

/* The drag of the straight body when it is towed along its axis, N: the friction of all edges, without the factor of
 * waving. */
double drag_towed(const struct fish *fish, double speed);

/* tau: the moment about the centre of mass of the drag that the flow causes, sum (x - x_cm) x (F(v - u) - F(v)), over
 * the torque scale; dimensionless. */
double drag_moment(const struct fish *fish, const double *u, const double *v, const double *y);

#endif
