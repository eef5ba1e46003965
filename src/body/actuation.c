/* actuation.c: phibar = a(t) A (lbar/l_ref) (c0 + c1 sigma + c2 sigma^2) (sin(beta sigma + omega t + phase) + phi0), or
 * a table instead of the sine. */
#include "body/actuation.h"

#include <math.h>

#include "fish/fish_gait.h"

struct actuation actuation_from(const struct actuation *all, int first) {
    return (struct actuation){all->curvature + first, all->rate + first, all->curvature_by_phi0 + first,
                              all->rate_by_phi0 + first};
}

void actuation_find(const struct fish *fish, struct fish_gait gait, double phi0, double phi0_rate,
                    const struct actuation *to) {
    const double ramp = gait.amplitude, rate_of_ramp = gait.amplitude_rate;
    for (int j = 0; j < fish->n_joints; j++) {
        const double half_tangent = tan(fish_natural_angle(fish, j, &gait, phi0) / 2);
        const double slope = 1 + half_tangent * half_tangent;  // of the curvature by the angle
        to->curvature[j] = 2 * half_tangent;
        to->curvature_by_phi0[j] = ramp * fish->wave_amplitude[j] * slope;

        const struct fish_demand demand = fish_demand(fish, j, &gait);
        const double angle_rate =
            fish->wave_amplitude[j] * (rate_of_ramp * (demand.sine + phi0) + ramp * (demand.sine_rate + phi0_rate)) +
            rate_of_ramp * demand.angle + ramp * demand.angle_rate;
        to->rate[j] = angle_rate * slope;
        to->rate_by_phi0[j] =
            fish->wave_amplitude[j] * rate_of_ramp * slope + angle_rate * half_tangent * to->curvature_by_phi0[j];
    }
}
