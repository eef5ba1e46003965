/* ramp.h: a smooth step, and ramps in time. doc/model.md, section 4. Tested by tests/base/test_ramp.c. */
#ifndef RAMP_H
#define RAMP_H

/* S(q) = q^4 (35 - 84 q + 70 q^2 - 20 q^3) on [0, 1], 0 before, 1 after: three continuous derivatives. */
double ramp_step(double q);

/* dS/dq. */
double ramp_step_rate(double q);

/* S(t / duration); 1 at all times if the duration is 0. */
double ramp_value(double t, double duration);

/* The derivative of ramp_value with respect to t. */
double ramp_rate(double t, double duration);

#endif
