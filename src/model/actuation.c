/* actuation.c: phibar = a(t) A (lbar/l_ref) (c0 + c1 sigma + c2 sigma^2) (sin(beta sigma + omega t + phase) + phi0), or
 * a table in the place of the sine. */
#include "model/actuation.h"

#include <math.h>

#include "model/fish_gait.h"

void actuation_curvature(const struct fish *fish, struct fish_gait gait, double phi0, double *curvature,
                         double *by_phi0) {
    for (int j = 0; j < fish->n_joints; j++) {
        const double half_tangent = tan(fish_natural_angle(fish, j, &gait, phi0) / 2);
        curvature[j] = 2 * half_tangent;
        by_phi0[j] = gait.amplitude * fish->wave_amplitude[j] * (1 + half_tangent * half_tangent);
    }
}

void actuation_rate(const struct fish *fish, struct fish_gait gait, double phi0, double phi0_rate, double *rate) {
    const double ramp = gait.amplitude, rate_of_ramp = gait.amplitude_rate;
    for (int j = 0; j < fish->n_joints; j++) {
        const struct fish_demand demand = fish_demand(fish, j, &gait);
        const double wave = demand.sine + phi0, half_tangent = tan(fish_natural_angle(fish, j, &gait, phi0) / 2);
        const double angle_rate =
            fish->wave_amplitude[j] * (rate_of_ramp * wave + ramp * (demand.sine_rate + phi0_rate)) +
            rate_of_ramp * demand.angle + ramp * demand.angle_rate;
        rate[j] = angle_rate * (1 + half_tangent * half_tangent);
    }
}
