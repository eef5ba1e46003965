/* fish_prescribed.h: the prescribed rigid motion of all nodes of a fish or of the head: straight, heaving and pitching.
 * doc/model.md, section 5. Tested by tests/fish/test_fish_prescribed.c. */
#ifndef FISH_PRESCRIBED_H
#define FISH_PRESCRIBED_H

#include "fish/fish.h"

/* The number of nodes, from the nose on, with prescribed motion, at least across the heading: 0, 1, 2 or all. */
int fish_n_prescribed(const struct fish *fish);

/* Whether component i (0: x, 1: y) of the motion of node k is prescribed. */
int fish_is_prescribed(const struct fish *fish, int k, int i);

/* The direction from nose to tail of the prescribed motion at time t, and the angular rate, rad s-1. */
void fish_prescribed_direction(const struct fish *fish, double t, double direction[2], double *rate);

/* Position, velocity, acceleration of prescribed node k at time t; each an array of x and y. */
void fish_prescribed_node(const struct fish *fish, int k, double t, double position[2], double velocity[2],
                          double acceleration[2]);

/* Write the positions and velocities of the prescribed motion at time t into the vector of all unknowns: prescribed
 * components only; at_start: all nodes. */
void fish_prescribe(const struct fish *fish, int at_start, double t, double *y);

#endif
