/* smooth.h: ramps and angles. Tested by tests/test_smooth.c. */
#ifndef SMOOTH_H
#define SMOOTH_H

/* S(q) = q^4 (35 - 84 q + 70 q^2 - 20 q^3) on [0, 1], 0 before, 1 after: three continuous derivatives. */
double smooth_step(double q);

/* dS/dq. */
double smooth_step_rate(double q);

/* S(t / duration); 1 at all times where the duration is 0. */
double smooth_ramp(double t, double duration);

/* The derivative of smooth_ramp with respect to t. */
double smooth_ramp_rate(double t, double duration);

/* The angle less a whole number of turns, in [-pi, pi]. */
double smooth_wrap(double angle);

/* Radians of an angle in degrees, and back. */
double smooth_radians(double degrees);
double smooth_degrees(double radians);

#endif
