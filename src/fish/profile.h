/* profile.h: the outline of a body: thickness h across it in the plane of motion, depth w out of that plane.
 * doc/model.md, section 1. Tested by tests/fish/test_profile.c.
 *
 *     nose  <------- s ------->               half thickness r(s), h = 2 r
 *        ___-----------___
 *     <_____________________==========>  tail
 */
#ifndef PROFILE_H
#define PROFILE_H

#include "fish/parameters.h"

/* The section that one edge has along its length. */
struct profile_edge {
    double h, w;         /* thickness and depth, m */
    double square, cube; /* the mean of h^2 over h^2, and that of h^3 over h^3 */
};

/* Edge k of a fish. body.section mean: means over the edge; nodes: the mean of both ends, square and cube are 1. */
struct profile_edge profile_edge(const struct fish_parameters *fish, int k);

/* Thickness at the tail, m: that of the last edge; of a joukowski outline body.tail_thickness. */
double profile_tail_thickness(const struct fish_parameters *fish);

#endif
