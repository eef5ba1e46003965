/* reactive.h: the reactive force, by which water that an edge accelerates resists (added mass), and the momentum that
 * leaves at the tail. doc/model.md, section 9. Tested by tests/force/test_reactive.c. */
#ifndef REACTIVE_H
#define REACTIVE_H

#include "force/force_model.h"

/* The momentum flux into the wake at the tail (Lighthill) is a force on the tail node. Direction and velocity of the
 * fluid there are extrapolated from the last edges:
 *
 *     node N-4 -- edge N-4 -- node N-3 -- edge N-3 -- node N-2 -- edge N-2 -- node N-1
 *                  angle                   angle, u                angle, u    tail: angle and u by extrapolation */

/* The force on the tail node, N. Without tail flux (fish->tail_added_mass 0) this function returns 0, and the functions
 * below add nothing. */
void tail_flux_force(const struct fish *fish, const struct flow_at_body *flow, const double *y, double force[2]);

/* Add the derivatives of the rows ax, ay of the tail node, divided by its mass: by the unknowns of the fish, and
 * through the velocity of the fluid. */
void tail_flux_jacobian(const struct fish *fish, const struct flow_at_body *flow, const double *y,
                        struct sparse *jacobian);
void tail_flux_flow_jacobian(const struct fish *fish, const struct flow_at_body *flow,
                             const struct influence_block *block, const double *y, struct coupling_block *rows);

/* The two reactions of an edge: Lagrange's equations of the kinetic energy of the fluid, and the article's force, which
 * is the added mass across the edge alone. */
extern const struct edge_reaction reactive_of_lagrange, reactive_published;

#endif
