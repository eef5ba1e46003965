/* fish_distance.h: distances of the outlines of bodies from points, from walls and from each other. The outline of a
 * body: each edge with its half thickness around it. Tested by tests/fish/test_fish_distance.c. */
#ifndef FISH_DISTANCE_H
#define FISH_DISTANCE_H

#include "fish/fish.h"

/* Distance of the point p from the outline of a body at the nodes given in y, negative inside of it, m. */
double fish_point_distance(const struct fish *fish, const double *y, const double p[2]);

/* Distance of the outline of a body at the nodes given in y from the nearest wall, negative beyond it, m; INFINITY
 * without walls. */
double fish_wall_distance(const struct school *school, const struct fish *fish, const double *y);

/* Distance between the outlines of two bodies at the nodes given in y, 0 where they touch, m. A distance above the
 * limit may be returned as INFINITY: bodies whose boxes are further apart than that are not compared edge by edge. */
double fish_distance(const struct fish *a, const struct fish *b, const double *y, double limit);

#endif
