/* fish_gait.h: the gait says how far the muscle wants to turn each joint, by a travelling wave or by a table of
 * curvatures over the phase. doc/model.md, section 4. Tested by tests/body/test_actuation.c. */
#ifndef FISH_GAIT_H
#define FISH_GAIT_H

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

#endif
