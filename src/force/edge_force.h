/* edge_force.h: the force of the fluid at the midpoint of every edge: drag, the reaction of the fluid that the edge
 * accelerates, and the tail flux. The models published and reactive consist of nothing else, and pressure takes its
 * drag from here. doc/model.md, section 9. Tested by tests/force/test_edge_force.c. */
#ifndef EDGE_FORCE_H
#define EDGE_FORCE_H

#include "force/force_model.h"

/* The functions of struct force_model for forces on edges; the reaction is the one of force->model. */
void edge_force_residual(const struct fluid_force *force, const struct flow_at_body *flow, const double *y,
                         double *residual);
void edge_force_jacobian(const struct fluid_force *force, const struct flow_at_body *flow, const double *y,
                         struct sparse *jacobian);
void edge_force_flow_jacobian(const struct fluid_force *force, const struct flow_at_body *flow,
                              const struct influence_block *block, const double *y, struct coupling_block *rows);
struct fluid_forces edge_force_sum(const struct fluid_force *force, const struct flow_at_body *flow,
                                   const double about[2], const double *y);
struct fluid_power edge_force_power(const struct fluid_force *force, const struct flow_at_body *flow, const double *y);
double edge_force_energy(const struct fluid_force *force, const struct flow_at_body *flow, const double *y);

/* The forces of edge k, with the tail flux on the last one. */
struct fluid_forces edge_force_of_edge(const struct fluid_force *force, const struct flow_at_body *flow, int k,
                                       const double about[2], const double *y);

#endif
