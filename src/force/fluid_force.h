/* fluid_force.h: the forces of the fluid on the nodes of a body: drag, and the reactive force, of every edge at its
 * midpoint. doc/model.md, section 9. Tested by tests/force/test_fluid_force.c. */
#ifndef FLUID_FORCE_H
#define FLUID_FORCE_H

#include "base/sparse.h"
#include "fish/fish.h"
#include "flow/flow_at_bodies.h"
#include "flow/flow_derivative.h"

/* Take the forces off the rows ax, ay of the residual [N]. */
void fluid_force_residual(const struct fish *fish, const struct flow_at_body *flow, const double *y, double *residual);

/* Add the derivatives of fluid_force_residual, each row divided by its node's mass: what depends on the body itself. */
void fluid_force_jacobian(const struct fish *fish, const struct flow_at_body *flow, const double *y,
                          struct sparse *jacobian);

/* Add those that come through the fluid's velocity. */
void fluid_force_flow_jacobian(const struct fish *fish, const struct flow_at_body *flow,
                               const struct influence_block *block, const double *y, struct coupling_block *rows);

/* Powers of the forces on the body, W: of drag, of its part along the edges, of the reactive forces of the edges, of
 * the flux at the tail. Negative where they take energy from it. */
struct fluid_power {
    double drag, friction, added_mass, wake;
};
struct fluid_power fluid_force_power(const struct fish *fish, const struct flow_at_body *flow, const double *y);

/* The forces on a body or an edge of it, N, and their moments about a point, N m. Friction: the part of the resistive
 * one along the edges. Reactive: with what leaves at the tail, and the pressure gradient of the external flow. */
struct fluid_forces {
    double resistive[2], friction[2], reactive[2];
    double resistive_moment, friction_moment, reactive_moment;
};
struct fluid_forces fluid_force_of_edge(const struct fish *fish, const struct flow_at_body *flow, int k,
                                        const double about[2], const double *y);
struct fluid_forces fluid_force_sum(const struct fish *fish, const struct flow_at_body *flow, const double about[2],
                                    const double *y);

/* Kinetic energy of the fluid that the body accelerates: of all edges, J. */
double fluid_force_added_mass_energy(const struct fish *fish, const struct flow_at_body *flow, const double *y);

#endif
