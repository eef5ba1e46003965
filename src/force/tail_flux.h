/* tail_flux.h: momentum flux into the wake at the tail (Lighthill), as a force on the tail node. doc/model.md, section
 * 9. Tested by tests/force/test_tail_flux.c.
 *
 *     node N-4 -- edge N-4 -- node N-3 -- edge N-3 -- node N-2 -- edge N-2 -- node N-1
 *                  angle                   angle, u                angle, u    tail: angle and u by extrapolation */
#ifndef TAIL_FLUX_H
#define TAIL_FLUX_H

#include "base/sparse.h"
#include "fish/fish.h"
#include "flow/flow_at_bodies.h"
#include "flow/flow_derivative.h"

/* Whether the fish has a tail flux. Without tail flux the functions below return 0 and add nothing. */
int tail_flux_exists(const struct fish *fish);

/* The force on the tail node, N. */
void tail_flux_force(const struct fish *fish, const struct flow_at_body *flow, const double *y, double force[2]);

/* Add the derivatives of the rows ax, ay of the tail node, divided by the mass of the node: by the unknowns of the
 * fish, and through the velocity of the fluid. */
void tail_flux_jacobian(const struct fish *fish, const struct flow_at_body *flow, const double *y,
                        struct sparse *jacobian);
void tail_flux_flow_jacobian(const struct fish *fish, const struct flow_at_body *flow,
                             const struct influence_block *block, const double *y, struct coupling_block *rows);

/* Power of the force, W; never positive in still fluid. */
double tail_flux_power(const struct fish *fish, const struct flow_at_body *flow, const double *y);

#endif
