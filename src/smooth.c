/* smooth.c: ramps and angles. */
#include "smooth.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

double smooth_step(double q) {
    if (q <= 0) return 0;
    if (q >= 1) return 1;
    return q * q * q * q * (35 + q * (-84 + q * (70 - 20 * q)));
}

double smooth_step_rate(double q) {
    if (q <= 0 || q >= 1) return 0;
    const double p = q * (1 - q);
    return 140 * p * p * p;
}

double smooth_ramp(double t, double duration) {
    return duration > 0 ? smooth_step(t / duration) : 1;
}

double smooth_ramp_rate(double t, double duration) {
    return duration > 0 ? smooth_step_rate(t / duration) / duration : 0;
}

double smooth_wrap(double angle) {
    return remainder(angle, 2 * pi);
}

double smooth_radians(double degrees) {
    return degrees * (pi / 180);
}

double smooth_degrees(double radians) {
    return radians * (180 / pi);
}
