/* actuation.h: the muscle: a travelling wave of natural curvature, or a table of it. doc/model.md, section 4. Tested by
 * tests/body/test_actuation.c. */
#ifndef ACTUATION_H
#define ACTUATION_H

#include "fish/fish.h"
#include "fish/fish_gait.h"

/* What the muscle asks of every joint; all arrays (n_joints). */
struct actuation {
    double *curvature;         /* kbar, dimensionless: 2 tan of half the natural turning angle */
    double *rate;              /* its rate, s-1 */
    double *curvature_by_phi0; /* their derivatives by the bias, at a given rate of the bias */
    double *rate_by_phi0;
};

/* Those from a joint on of arrays for the joints of all fish. */
struct actuation actuation_from(const struct actuation *all, int first);

/* Fill all four for the bias phi0 and its rate, s-1. */
void actuation_find(const struct fish *fish, struct fish_gait gait, double phi0, double phi0_rate,
                    const struct actuation *to);

#endif
