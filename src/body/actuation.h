/* actuation.h: the muscle: a travelling wave or a table of natural curvature. doc/model.md, section 4. Tested by
 * tests/body/test_actuation.c. */
#ifndef ACTUATION_H
#define ACTUATION_H

#include "fish/fish.h"
#include "fish/fish_gait.h"

/* Natural curvature of every joint; all arrays (n_joints). */
struct actuation {
    double *curvature;         /* kbar, dimensionless: 2 tan of half the natural turning angle */
    double *rate;              /* rate of kbar, s-1 */
    double *curvature_by_phi0; /* derivatives of both by the bias phi0, at a constant rate of the bias */
    double *rate_by_phi0;
};

/* The part of arrays for the joints of all fish that starts at joint `first`. */
struct actuation actuation_from(const struct actuation *all, int first);

/* Fill all four arrays for the bias phi0 and the rate of the bias, s-1. */
void actuation_find(const struct fish *fish, struct fish_gait gait, double phi0, double phi0_rate,
                    const struct actuation *to);

#endif
