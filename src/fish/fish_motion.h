/* fish_motion.h: the motion that a case prescribes to all nodes of a fish or to its head, and the positions and
 * velocities with which a fish starts. doc/model.md, sections 4 and 5. Tested by tests/fish/test_fish_motion.c. */
#ifndef FISH_MOTION_H
#define FISH_MOTION_H

#include "fish/fish.h"

/* Prescribed motion is rigid: straight, heaving and pitching. heave: amplitude of the heave, m, and its first and
 * second derivative in time, as control_heave (control/control.h) gives them with a value set from outside; NULL: the
 * amplitude of the case. */

/* The number of nodes, from the nose on, with prescribed motion, at least across the heading: 0, 1, 2 or all. */
int fish_n_prescribed(const struct fish *fish);

/* Whether component i (0: x, 1: y) of the motion of node k is prescribed. */
static inline bool fish_is_prescribed(const struct fish *fish, int k, int i) {
    return k < fish_n_prescribed(fish) && (i == 1 || fish->motion.surge == SURGE_GIVEN);
}

/* The direction from nose to tail of the prescribed motion at time t, and the angular rate, rad s-1. */
void fish_prescribed_direction(const struct fish *fish, double t, double direction[2], double *rate);

/* Position, velocity, acceleration of prescribed node k at time t; each an array of x and y. */
void fish_prescribed_node(const struct fish *fish, const double heave[3], int k, double t, double position[2],
                          double velocity[2], double acceleration[2]);

/* Write the positions and velocities of the prescribed motion at time t into the vector of all unknowns: prescribed
 * components only; at_start: all nodes. */
void fish_prescribe(const struct fish *fish, const double heave[3], bool at_start, double t, double *y);

/* Write the positions and velocities of the nodes at the start into the vector of all unknowns. A fish starts in its
 * natural shape, straight if its motion is prescribed, and with a uniform velocity. */
void fish_start(const struct fish *fish, double *y);

#endif
