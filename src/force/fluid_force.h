/* fluid_force.h: forces of the fluid on the nodes of a body: drag and reactive force, evaluated at the midpoint of
 * every edge. doc/model.md, section 9. Tested by tests/force/test_fluid_force.c. */
#ifndef FLUID_FORCE_H
#define FLUID_FORCE_H

#include "base/sparse.h"
#include "fish/fish.h"
#include "flow/flow_at_bodies.h"
#include "flow/flow_derivative.h"

/* Subtract the forces from the rows ax, ay of the residual [N]. */
void fluid_force_residual(const struct fish *fish, const struct flow_at_body *flow, const double *y, double *residual);

/* Add the derivatives of fluid_force_residual by the unknowns of the fish, each row divided by the mass of the node;
 * the velocity of the fluid is held constant. */
void fluid_force_jacobian(const struct fish *fish, const struct flow_at_body *flow, const double *y,
                          struct sparse *jacobian);

/* Add the derivatives of fluid_force_residual through the velocity of the fluid, each row divided by the mass of the
 * node. */
void fluid_force_flow_jacobian(const struct fish *fish, const struct flow_at_body *flow,
                               const struct influence_block *block, const double *y, struct coupling_block *rows);

/* Powers of the forces on the body, W: drag, friction (the tangential part of the drag), reactive forces of the edges,
 * tail flux. Negative power takes energy from the body. */
struct fluid_power {
    double drag, friction, added_mass, wake;
};
struct fluid_power fluid_force_power(const struct fish *fish, const struct flow_at_body *flow, const double *y);

/* Forces on a body or on an edge, N, and moments about a point, N m. Friction: tangential part of the resistive force.
 * Reactive: includes the tail flux and the pressure gradient of the external flow. */
struct fluid_forces {
    double resistive[2], friction[2], reactive[2];
    double resistive_moment, friction_moment, reactive_moment;
};
struct fluid_forces fluid_force_of_edge(const struct fish *fish, const struct flow_at_body *flow, int k,
                                        const double about[2], const double *y);
struct fluid_forces fluid_force_sum(const struct fish *fish, const struct flow_at_body *flow, const double about[2],
                                    const double *y);

/* Kinetic energy of the fluid accelerated by the body, summed over the edges, J. */
double fluid_force_added_mass_energy(const struct fish *fish, const struct flow_at_body *flow, const double *y);

#endif
