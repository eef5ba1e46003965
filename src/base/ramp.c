/* ramp.c: the smooth step, and ramps in time. */
#include "base/ramp.h"

double ramp_step(double q) {
    if (q <= 0) return 0;
    if (q >= 1) return 1;
    return q * q * q * q * (35 + q * (-84 + q * (70 - 20 * q)));
}

double ramp_step_rate(double q) {
    if (q <= 0 || q >= 1) return 0;
    const double p = q * (1 - q);
    return 140 * p * p * p;
}

double ramp_value(double t, double duration) {
    return duration > 0 ? ramp_step(t / duration) : 1;
}

double ramp_rate(double t, double duration) {
    return duration > 0 ? ramp_step_rate(t / duration) / duration : 0;
}
