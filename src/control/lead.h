/* lead.h: a value that is led from outside: each change goes to its new value within a ramp, with three continuous
 * derivatives, whatever the value does when the change begins. doc/model.md, section 11. Tested by
 * tests/control/test_lead.c. */
#ifndef LEAD_H
#define LEAD_H

/* A polynomial of the time since the last change over the ramp, and the constant that it ends in. All zeros: 0 at all
 * times. Nothing but doubles: state/state_table.c. */
enum { LEAD_TERMS = 8 };
struct lead {
    double start, ramp;        /* of the last change, s */
    double series[LEAD_TERMS]; /* of q = (t - start) / ramp, up to q = 1 */
    double target;             /* from then on */
    double integral;           /* of the value from 0 to start */
};

/* The value at time t, at or after the last change; its rate, and its integral over time since t = 0. */
double lead_value(const struct lead *lead, double t);
double lead_rate(const struct lead *lead, double t);
double lead_integral(const struct lead *lead, double t);

/* Go to target from time t on, within ramp seconds. Starting at rest this is value + (target - value) S(q) with the S
 * of base/ramp.h. Nothing changes where that is the target already. */
void lead_change(struct lead *lead, double t, double ramp, double target);

/* The same for what has been something else before: a value with this rate at time t. */
void lead_begin(struct lead *lead, double t, double ramp, double value, double rate, double target);

#endif
