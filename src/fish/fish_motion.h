/* fish_motion.h: all motion that the case gives. The gait says which angle each joint would like to have, by a
 * travelling wave or by a table of curvatures over the phase. Prescribed motion says where nodes are, and the start
 * where a fish begins. doc/model.md, sections 4 and 5. Tested by tests/body/test_rod.c,
 * tests/fish/test_fish_motion.c. */
#ifndef FISH_MOTION_H
#define FISH_MOTION_H

#include "base/arena.h"
#include "fish/fish.h"

/* Set the wave or the table of the fish from the parameters. n_joints, edge_length and length are set. */
void fish_gait_set(struct arena *arena, struct fish *fish, const struct fish_parameters *from);

/* State of the gait: amplitude relative to the amplitude of the case, with the initial ramp, and rate, s-1; phase angle
 * of the beat, rad, and angular frequency, rad s-1. */
struct fish_gait {
    double amplitude, amplitude_rate;
    double angle, omega;
};

/* The gait of the case at time t; control_gait (control/control.h) adds values set from outside. */
struct fish_gait fish_own_gait(const struct fish *fish, double t);

/* Gait of joint j at full amplitude without bias: the sine of the wave, or the angle of the table, rad; and rates, s-1
 * and rad s-1. */
struct fish_demand {
    double sine, sine_rate;
    double angle, angle_rate;
};
struct fish_demand fish_demand(const struct fish *fish, int j, const struct fish_gait *gait);

/* The natural turning angle of joint j for the bias phi0, rad. */
double fish_natural_angle(const struct fish *fish, int j, const struct fish_gait *gait, double phi0);

/* The largest absolute natural turning angle of any joint, rad; amplitude: relative to the case; bias: largest absolute
 * value. */
double fish_largest_turn(const struct fish *fish, double amplitude, double bias);

/* The prescribed rigid motion of all nodes of a fish or of the head: straight, heaving and pitching.
 * doc/model.md, section 5. heave: amplitude of the heave, m, and its first and second derivative in time, as
 * control_heave (control/control.h) gives them with a value set from outside; NULL: the amplitude of the case. */

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

/* The initial state of a fish: natural shape, or straight shape of a prescribed motion, and a uniform
 * velocity. doc/model.md, sections 4 and 5. */

/* Write the positions and velocities of the nodes at the start into the vector of all unknowns. */
void fish_start(const struct fish *fish, double *y);

#endif
