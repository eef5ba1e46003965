/* flow_external.c: a sine of time, a line across the stream. */
#include "flow/flow_external.h"

#include <math.h>

void flow_external(const struct school *school, double t, double y, double *u, double *v) {
    const double gust = sin(school->gust_omega * t);
    *u = school->velocity[0] + school->shear * y + gust * school->gust[0];
    *v = school->velocity[1] + gust * school->gust[1];
}

void flow_external_acceleration(const struct school *school, double t, double acceleration[2]) {
    const double angle = school->gust_omega * t, rate = school->gust_omega * cos(angle);
    acceleration[0] = school->shear * (school->velocity[1] + sin(angle) * school->gust[1]) + rate * school->gust[0];
    acceleration[1] = rate * school->gust[1];
}
