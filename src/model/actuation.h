/* actuation.h: the muscle: a travelling wave of natural curvature, or a table of it. doc/model.md, section 4. Tested by
 * tests/model/test_actuation.c. */
#ifndef ACTUATION_H
#define ACTUATION_H

#include "model/fish.h"
#include "model/fish_gait.h"

/* Natural curvature kbar (dimensionless, 2 tan of half the natural turning angle) of every joint for the bias phi0, and
 * its derivative with respect to phi0; both (n_joints). */
void actuation_curvature(const struct fish *fish, struct fish_gait gait, double phi0, double *curvature,
                         double *by_phi0);

/* The rate of change of the natural curvature, s-1 (n_joints); phi0_rate in s-1. */
void actuation_rate(const struct fish *fish, struct fish_gait gait, double phi0, double phi0_rate, double *rate);

#endif
