/* lead.h: a value set from outside during a run: each change is a ramp to the new value with three continuous
 * derivatives, for any value and rate at the start of the change. doc/model.md, section 11. Tested by
 * tests/control/test_lead.c. */
#ifndef LEAD_H
#define LEAD_H

/* A polynomial in the time since the last change over the ramp, and the constant value after the ramp. All zeros: value
 * 0 at all times. The struct holds doubles only: state/state.c. */
enum { LEAD_TERMS = 8 };
struct lead {
    double start, ramp;        /* of the last change, s */
    double series[LEAD_TERMS]; /* of q = (t - start) / ramp, up to q = 1 */
    double target;             /* value after the ramp */
    double integral;           /* of the value from 0 to start */
};

/* Value, rate, and time integral since t = 0, at time t, at or after the last change. */
double lead_value(const struct lead *lead, double t);
double lead_rate(const struct lead *lead, double t);
double lead_integral(const struct lead *lead, double t);

/* Start a change to target at time t, within ramp seconds. From rest the change is value + (target - value) S(q) with S
 * of base/mathematics.h. No-op for the present target. */
void lead_change(struct lead *lead, double t, double ramp, double target);

/* The same from a given value and rate, for a quantity that the lead did not describe before time t. */
void lead_begin(struct lead *lead, double t, double ramp, double value, double rate, double target);

#endif
