/* profile.h: the outline of a body: thickness h in the plane of motion, depth w normal to the plane of motion.
 * doc/model.md, section 1. Tested by tests/fish/test_profile.c.
 *
 *     nose  <------- s ------->               half thickness r(s), h = 2 r
 *        ___-----------___
 *     <_____________________==========>  tail
 */
#ifndef PROFILE_H
#define PROFILE_H

#include "fish/parameters.h"

/* The section of one edge. */
struct profile_edge {
    double h, w;         /* thickness and depth, m */
    double square, cube; /* mean of h^2 over h^2, mean of h^3 over h^3 */
};

/* Edge k of a fish. body.section mean: means over the edge; nodes: the mean of both ends, square and cube are 1. */
struct profile_edge profile_edge(const struct fish_parameters *fish, int k);

/* Thickness at the tail, m: body.tail_thickness for a joukowski outline, otherwise the thickness of the last edge. */
double profile_tail_thickness(const struct fish_parameters *fish);

#endif
