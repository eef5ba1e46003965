/* drag.h: the drag on the edges of a body, and the moment of the drag that the flow causes. doc/model.md, sections 9
 * and
 * 11. Tested by tests/force/test_drag.c. */
#ifndef DRAG_H
#define DRAG_H

#include "body/edge.h"
#include "fish/fish.h"
#include "flow/flow.h"

/* The drag on edge k, N, where its midpoint moves with the velocity w relative to the fluid; half of it acts on each of
 * its nodes. */
void drag_force(const struct fish *fish, int k, const struct edge *s, const double w[2], double force[2]);

/* Its part along the edge: the friction. */
void drag_friction(const struct fish *fish, int k, const struct edge *s, const double w[2], double force[2]);

/* Its derivatives by w, [component][component of w], and by a turn of the edge (dt = n, dn = -t). */
void drag_slope(const struct fish *fish, int k, const struct edge *s, const double w[2], double by_velocity[2][2],
                double by_turn[2]);

/* tau: the moment about the centre of mass of the drag that the flow causes, sum (x - x_cm) x (F(v - u) - F(v)), over
 * its scale; dimensionless. */
double drag_moment(const struct fish *fish, const double *u, const double *v, const double *y);

#endif
