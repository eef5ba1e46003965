/* reactive.h: reactive force on the edges of a body (added mass), and momentum flux at the tail.
 * doc/model.md, section 9. Tested by tests/force/test_reactive.c.
 *
 * fish->force selects Lagrange's equations of the kinetic energy of the fluid (reactive) or the article's force, which
 * is only the added mass across the edge, without flux at the tail (published).
 *
 * w: velocity of the midpoint of the edge relative to the fluid; b: acceleration of the external flow. */
#ifndef REACTIVE_H
#define REACTIVE_H

#include "base/sparse.h"
#include "body/rod.h"
#include "fish/fish.h"
#include "flow/flow_at_bodies.h"
#include "flow/flow_derivative.h"

/* Momentum flux into the wake at the tail (Lighthill), as a force on the tail node. doc/model.md, section 9.
 *
 *     node N-4 -- edge N-4 -- node N-3 -- edge N-3 -- node N-2 -- edge N-2 -- node N-1
 *                  angle                   angle, u                angle, u    tail: angle and u by extrapolation */

/* The force on the tail node, N. Without tail flux (fish->tail_added_mass 0) this function and the functions below
 * return 0 and add nothing. */
void tail_flux_force(const struct fish *fish, const struct flow_at_body *flow, const double *y, double force[2]);

/* Add the derivatives of the rows ax, ay of the tail node, divided by the mass of the node: by the unknowns of the
 * fish, and through the velocity of the fluid. */
void tail_flux_jacobian(const struct fish *fish, const struct flow_at_body *flow, const double *y,
                        struct sparse *jacobian);
void tail_flux_flow_jacobian(const struct fish *fish, const struct flow_at_body *flow,
                             const struct influence_block *block, const double *y, struct coupling_block *rows);

/* Derivatives of the forces on the two nodes of an edge: first index node, second index component. */
struct reactive_slope {
    double by_velocity[2][2][2];  /* by w, with edge.rate constant */
    double by_rate[2][2][2];      /* by edge.rate, with w constant */
    double by_turn[2][2];         /* by a rotation of the edge (dt = n, dn = -t) */
    double by_length[2][2];       /* by the length of the edge */
    double by_acceleration[2][2]; /* of the force on each node, by the acceleration of the midpoint */
};

/* Reactive force of edge k on its two nodes, N. */
void reactive_force(const struct fish *fish, int k, const struct edge *edge, const double w[2], const double b[2],
                    double force[2][2]);

/* Derivatives of reactive_force. */
void reactive_slope(const struct fish *fish, int k, const struct edge *edge, const double w[2], const double b[2],
                    struct reactive_slope *slope);

#endif
