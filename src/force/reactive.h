/* reactive.h: the force of the fluid that a body accelerates, edge by edge; what leaves at the tail is in tail_flux.h.
 * doc/model.md, section 9. Tested by tests/force/test_reactive.c.
 *
 * fish->force decides between the force that follows from the fluid's kinetic energy (reactive) and the article's
 * (published: the added mass across the edge alone, no flux at the tail).
 *
 * w is the velocity of the edge's midpoint relative to the fluid, b the acceleration of the external flow. */
#ifndef REACTIVE_H
#define REACTIVE_H

#include "body/edge.h"
#include "fish/fish.h"

/* Derivatives of the forces on the two nodes of an edge: first index the node, second the component. */
struct reactive_slope {
    double by_velocity[2][2][2];  /* by w, the edge's rate held */
    double by_rate[2][2][2];      /* by edge.rate, w held */
    double by_turn[2][2];         /* by a turn of the edge (dt = n, dn = -t) */
    double by_length[2][2];       /* by its length */
    double by_acceleration[2][2]; /* of either node's force, by that of the midpoint */
};

/* The force of edge k on its two nodes, N. */
void reactive_force(const struct fish *fish, int k, const struct edge *edge, const double w[2], const double b[2],
                    double force[2][2]);

/* The derivatives of reactive_force. */
void reactive_slope(const struct fish *fish, int k, const struct edge *edge, const double w[2], const double b[2],
                    struct reactive_slope *slope);

/* Power of reactive_force on edge k, W. */
double reactive_power(const struct fish *fish, int k, const struct edge *edge, const double w[2], const double b[2]);

/* Kinetic energy of the fluid that edge k accelerates, mu w_n^2/2, J. */
double reactive_energy(const struct fish *fish, int k, const struct edge *edge, const double w[2]);

#endif
