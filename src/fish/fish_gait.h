/* fish_gait.h: what the muscles of a fish ask of its joints: a travelling wave, or a table of curvatures over the
 * phase. doc/model.md, section 4. Tested by tests/body/test_actuation.c. */
#ifndef FISH_GAIT_H
#define FISH_GAIT_H

#include "base/status.h"
#include "fish/fish.h"

/* Set the wave or the table of the fish (n_joints, edge_length, length are known) from its parameters. Fails with
 * STATUS_MEMORY. */
enum status fish_gait_set(struct fish *fish, const struct fish_parameters *from);

/* Where in its gait a fish is: its amplitude over that of the case, which begins with a ramp, and the rate of that,
 * s-1; the angle of its beat, rad, and the rate of that, rad s-1. */
struct fish_gait {
    double amplitude, amplitude_rate;
    double angle, omega;
};

/* The gait of the case at time t; control_gait (control/control.h) has what has been set since. */
struct fish_gait fish_own_gait(const struct fish *fish, double t);

/* What the muscle asks of joint j at full amplitude and without steering bias: the sine of the wave, or an angle of the
 * table, rad; and their rates. */
struct fish_demand {
    double sine, sine_rate;
    double angle, angle_rate;
};
struct fish_demand fish_demand(const struct fish *fish, int j, const struct fish_gait *gait);

/* The natural turning angle of joint j for the bias phi0, rad. */
double fish_natural_angle(const struct fish *fish, int j, const struct fish_gait *gait, double phi0);

/* The largest natural turning angle, in absolute value, of any joint at this amplitude over that of the case and a bias
 * up to this one, rad. */
double fish_largest_turn(const struct fish *fish, double amplitude, double bias);

#endif
