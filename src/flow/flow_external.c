/* flow_external.c: the stream with its shear, and gusts. */
#include "flow/flow_external.h"

#include <math.h>

#include "base/mathematics.h"
#include "flow/flow.h"

// the velocity of a travelling gust over its amplitude, and the derivative of this along the direction of travel, m-1
static double gust_shape(const struct school *school, double t, double x, double y, double *slope) {
    // how far ahead of the point of the gust that was at gust_position at the start
    const double along = school->gust_along[0] * x + school->gust_along[1] * y;
    const double ahead = along - school->gust_position - school->gust_speed * t;
    const double number = school->gust_number, distance = school->gust_gradient_distance;
    if (school->gust_profile == GUST_SINE) {
        *slope = number * cos(number * ahead);
        return sin(number * ahead);
    }
    *slope = -ramp_step_rate(0.5 - ahead / distance) / distance;
    return ramp_step(0.5 - ahead / distance);
}

void flow_external_gust(const struct school *school, double t, double x, double y, double *u, double *v) {
    *u = *v = 0;
    if (school->gust_profile == GUST_UNIFORM) return;
    double slope;
    const double shape = gust_shape(school, t, x, y, &slope);
    *u = shape * school->gust[0];
    *v = shape * school->gust[1];
}

void flow_external(const struct school *school, double t, double x, double y, double *u, double *v) {
    const double gust = fabs(school->gust[0]) + fabs(school->gust[1]) > 0 ? sin(school->gust_omega * t) : 0;
    double travelling[2];
    flow_external_gust(school, t, x, y, &travelling[0], &travelling[1]);
    *u = school->velocity[0] + school->shear * y + gust * school->gust[0] + travelling[0];
    *v = school->velocity[1] + gust * school->gust[1] + travelling[1];
}

void flow_external_gradient(const struct school *school, double t, double x, double y, double gradient[3]) {
    gradient[0] = gradient[2] = 0;
    gradient[1] = school->shear;
    if (school->gust_profile == GUST_UNIFORM) return;
    double slope;
    gust_shape(school, t, x, y, &slope);
    gradient[0] += slope * school->gust_along[0] * school->gust[0];
    gradient[1] += slope * school->gust_along[1] * school->gust[0];
    gradient[2] += slope * school->gust_along[0] * school->gust[1];
}

void flow_external_acceleration(const struct school *school, double t, double acceleration[2]) {
    const double angle = school->gust_omega * t, rate = school->gust_omega * cos(angle);
    acceleration[0] = school->shear * (school->velocity[1] + sin(angle) * school->gust[1]) + rate * school->gust[0];
    acceleration[1] = rate * school->gust[1];
}
