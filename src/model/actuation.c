/* actuation.c: phibar = a(t) A (lbar/l_ref) (c1 sigma + c2 sigma^2) (sin(beta sigma + omega t + phase) + phi0). */
#include "model/actuation.h"

#include <math.h>

#include "base/ramp.h"

void actuation_curvature(const struct fish *fish, double t, double phi0, double *curvature, double *by_phi0) {
    const double ramp = ramp_value(t, fish->ramp);
    for (int j = 0; j < fish->n_joints; j++) {
        const double amplitude = ramp * fish->wave_amplitude[j];
        const double half_tangent = tan(amplitude * (sin(fish->wave_phase[j] + fish->omega * t) + phi0) / 2);
        curvature[j] = 2 * half_tangent;
        by_phi0[j] = amplitude * (1 + half_tangent * half_tangent);
    }
}

void actuation_rate(const struct fish *fish, double t, double phi0, double phi0_rate, double *rate) {
    const double ramp = ramp_value(t, fish->ramp), rate_of_ramp = ramp_rate(t, fish->ramp);
    for (int j = 0; j < fish->n_joints; j++) {
        const double phase = fish->wave_phase[j] + fish->omega * t, wave = sin(phase) + phi0;
        const double angle = ramp * fish->wave_amplitude[j] * wave, half_tangent = tan(angle / 2);
        const double angle_rate =
            fish->wave_amplitude[j] * (rate_of_ramp * wave + ramp * (fish->omega * cos(phase) + phi0_rate));
        rate[j] = angle_rate * (1 + half_tangent * half_tangent);
    }
}
