/* clamp.h: the joint at the nose that holds the direction of edge 0 of a body with a prescribed head. doc/model.md,
 * section 2. Tested by tests/body/test_clamp.c.
 *
 *     given direction         edge 0
 *     - - - - - - - -  node 0 -------- node 1
 *                     angle phi_c
 *
 * For a fish without a clamp all functions do nothing or return zeros. */
#ifndef CLAMP_H
#define CLAMP_H

#include "base/sparse.h"
#include "fish/fish.h"

/* Subtract the forces of the clamp on the nodes 0 and 1 at time t from the rows ax, ay of the residual [N]. */
void clamp_residual(const struct fish *fish, double t, const double *y, double *residual);

/* Add the derivatives of clamp_residual, each row divided by the node mass. */
void clamp_jacobian(const struct fish *fish, double t, const double *y, struct sparse *jacobian);

/* Energy, powers and moment of the clamp; zeros without one. */
struct clamp_terms {
    double energy;        /* elastic, J */
    double damping_power; /* of the damping of the clamp, W: never positive */
    double driving_power; /* on the body, of the moment that turns the given direction, W */
    double moment;        /* on the body, N m */
};
struct clamp_terms clamp_terms(const struct fish *fish, double t, const double *y);

#endif
