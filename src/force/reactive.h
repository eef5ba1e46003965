/* reactive.h: reactive force on the edges of a body (added mass). tail_flux.h: the momentum flux at the tail.
 * doc/model.md, section 9. Tested by tests/force/test_reactive.c.
 *
 * fish->force selects Lagrange's equations of the kinetic energy of the fluid (reactive) or the force of the article
 * (published: only the added mass across the edge, no flux at the tail).
 *
 * w: velocity of the midpoint of the edge relative to the fluid; b: acceleration of the external flow. */
#ifndef REACTIVE_H
#define REACTIVE_H

#include "body/edge.h"
#include "fish/fish.h"

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

/* Power of reactive_force on edge k, W. */
double reactive_power(const struct fish *fish, int k, const struct edge *edge, const double w[2], const double b[2]);

/* Kinetic energy of the fluid accelerated by edge k, mu w_n^2/2, J. */
double reactive_energy(const struct fish *fish, int k, const struct edge *edge, const double w[2]);

#endif
