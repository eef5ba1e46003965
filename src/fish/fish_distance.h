/* fish_distance.h: distances of the outlines of bodies from points, walls and other bodies. The outline of a body is
 * the union of all edges, widened by half the edge thickness. Tested by tests/fish/test_fish_distance.c. */
#ifndef FISH_DISTANCE_H
#define FISH_DISTANCE_H

#include "fish/fish.h"

/* Distance of the point p from the outline of a body at the node positions in y, negative inside, m. */
double fish_point_distance(const struct fish *fish, const double *y, const double p[2]);

/* Distance of the outline of a body at the node positions in y from the nearest wall, negative beyond the wall, m;
 * INFINITY without walls. wall: index of the wall, or NULL. */
double fish_wall_distance(const struct school *school, const struct fish *fish, const double *y, int *wall);

/* Distance between the outlines of two bodies at the node positions in y, 0 at contact, m. A distance above the limit
 * may be returned as INFINITY: edges are compared only if the gap of the boxes of both bodies is below the limit. */
double fish_distance(const struct fish *a, const struct fish *b, const double *y, double limit);

#endif
