/* lead.c: Hermite interpolation between value and three derivatives at the start and the target with zero derivatives
 * at the end. */
#include "control/lead.h"

enum { N_GIVEN = 4 }; /* value and three derivatives */

// value and derivatives by q, up to the third
static void lead_derivatives(const struct lead *lead, double q, double given[N_GIVEN]) {
    double series[LEAD_TERMS];
    for (int i = 0; i < LEAD_TERMS; i++) series[i] = lead->series[i];
    for (int k = 0; k < N_GIVEN; k++) {
        given[k] = 0;
        for (int i = LEAD_TERMS - 1; i >= 0; i--) given[k] = given[k] * q + series[i];
        for (int i = 0; i + 1 < LEAD_TERMS; i++) series[i] = (i + 1) * series[i + 1];
        series[LEAD_TERMS - 1] = 0;
    }
}

// fraction of the last change; 1 before any change
static double lead_progress(const struct lead *lead, double t) {
    return lead->ramp > 0 ? (t - lead->start) / lead->ramp : 1;
}

double lead_value(const struct lead *lead, double t) {
    const double q = lead_progress(lead, t);
    if (q >= 1) return lead->target;
    double given[N_GIVEN];
    lead_derivatives(lead, q, given);
    return given[0];
}

double lead_rate(const struct lead *lead, double t) {
    const double q = lead_progress(lead, t);
    if (q >= 1) return 0;
    double given[N_GIVEN];
    lead_derivatives(lead, q, given);
    return given[1] / lead->ramp;
}

double lead_integral(const struct lead *lead, double t) {
    const double q = lead_progress(lead, t), end = q < 1 ? q : 1;
    double integral = 0;
    for (int i = LEAD_TERMS - 1; i >= 0; i--) integral = (integral + lead->series[i] / (i + 1)) * end;
    integral *= lead->ramp;

    // constant value after the ramp
    if (q >= 1) integral += (t - lead->start - lead->ramp) * lead->target;
    return lead->integral + integral;
}

// The sum over k of given[k] q^k/k! (1 - q)^4 (1 + 4 q + 10 q^2 + 20 q^3, truncated at q^(3-k)): given derivatives at q
// = 0, zero derivatives at q = 1.
static void series_set(const double given[N_GIVEN], double series[LEAD_TERMS]) {
    static const double fall[] = {1, -4, 6, -4, 1}, rise[] = {1, 4, 10, 20}, factorial[] = {1, 1, 2, 6};
    for (int i = 0; i < LEAD_TERMS; i++) series[i] = 0;
    for (int k = 0; k < N_GIVEN; k++) {
        for (int j = 0; j + k < N_GIVEN; j++) {
            for (int i = 0; i < 5; i++) series[k + j + i] += given[k] / factorial[k] * rise[j] * fall[i];
        }
    }
}

// start a change from given derivatives by q, over a ramp
static void lead_start(struct lead *lead, double t, double ramp, const double given[N_GIVEN], double target) {
    lead->integral = lead_integral(lead, t);
    const double from_target[N_GIVEN] = {given[0] - target, given[1], given[2], given[3]};

    series_set(from_target, lead->series);
    lead->series[0] += target;
    lead->start = t;
    lead->ramp = ramp;
    lead->target = target;
}

void lead_change(struct lead *lead, double t, double ramp, double target) {
    if (lead->target == target) return;
    double given[N_GIVEN] = {lead->target, 0, 0, 0};
    const double q = lead_progress(lead, t);
    if (q < 1) lead_derivatives(lead, q, given);

    // derivatives by q of the new ramp
    double ratio = 1;
    for (int k = 1; k < N_GIVEN; k++) {
        if (q < 1) ratio *= ramp / lead->ramp;
        given[k] *= ratio;
    }

    lead_start(lead, t, ramp, given, target);
}

void lead_begin(struct lead *lead, double t, double ramp, double value, double rate, double target) {
    const double given[N_GIVEN] = {value, rate * ramp, 0, 0};
    lead_start(lead, t, ramp, given, target);
}
