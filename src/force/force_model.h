/* force_model.h: the force of the fluid on a body, as one struct of functions for each value of the key fish.force. The
 * equations of the school, the solvers and the diagnostics call these functions, and none of them knows which force
 * acts. doc/model.md, sections 9 and 15. Tested by tests/force/test_edge_force.c and tests/force/test_pressure.c.
 *
 *     published     drag and the article's added mass on every edge           reactive.h
 *     reactive      drag, added mass and the tail flux of Lighthill           reactive.h
 *     pressure      drag, and the jump of pressure across the bound sheet     pressure.h */
#ifndef FORCE_MODEL_H
#define FORCE_MODEL_H

#include <stdbool.h>

#include "base/arena.h"
#include "base/sparse.h"
#include "body/rod.h"
#include "fish/fish.h"
#include "flow/flow_at_bodies.h"
#include "flow/flow_derivative.h"
#include "force/pressure.h"
#include "state/impulse.h"
#include "state/state.h"

/* Forces on a body or on an edge, N, and moments about a point, N m. friction is the tangential part of the resistive
 * force. reactive includes the tail flux and the pressure gradient of the external flow. pressure is zero, with A_0
 * NaN, unless the force comes from the bound sheet. */
struct fluid_forces {
    double resistive[2], friction[2], reactive[2];
    double resistive_moment, friction_moment, reactive_moment;
    struct pressure_forces pressure;
};

/* Powers of the forces on the body, W: drag, friction (the tangential part of the drag), reactive forces of the edges,
 * tail flux, pressure and suction. A negative power takes energy from the body. */
struct fluid_power {
    double drag, friction, added_mass, wake, pressure, suction;
};

/* The force of the fluid on one fish: the model, and what it keeps. */
struct fluid_force {
    const struct force_model *model;
    const struct fish *fish;
    /* of the fluid that moves with the nodes, N s: x of all nodes, then y; 0 where the law of motion contains the rate
     * of this momentum as an added mass                                                            (2 n_nodes) */
    double *momentum;
    struct pressure *pressure; /* on the bound sheet; NULL unless the force comes from it */
};

/* How the forces on the two nodes of an edge change; the first index is the node, the second the component. */
struct reaction_slope {
    double by_velocity[2][2][2];  /* by w, with edge.rate constant */
    double by_rate[2][2][2];      /* by edge.rate, with w constant */
    double by_turn[2][2];         /* by a rotation of the edge (dt = n, dn = -t) */
    double by_length[2][2];       /* by the length of the edge */
    double by_acceleration[2][2]; /* of the force on each node, by the acceleration of the midpoint */
};

/* What the fluid that an edge accelerates does to the edge: the force on its two nodes, N, the derivatives, and the
 * power, W. w: velocity of the midpoint relative to the fluid; b: acceleration of the external flow. */
struct edge_reaction {
    void (*force)(const struct fish *fish, int k, const struct edge *edge, const double w[2], const double b[2],
                  double force[2][2]);
    void (*slope)(const struct fish *fish, int k, const struct edge *edge, const double w[2], const double b[2],
                  struct reaction_slope *slope);
    double (*power)(const struct fish *fish, int k, const struct edge *edge, const double w[2], const double b[2]);
};

/* A force model; another force is another struct of this kind. flow is the flow at the points of the body. Where a
 * function may be NULL, NULL means that there is nothing to do. */
struct force_model {
    const struct edge_reaction *reaction; /* NULL: the edges feel drag only */

    /* the body takes the momentum that its vortices give, so the momentum of the school is conserved */
    bool has_balance;
    bool is_for_comparison; /* it reproduces an article and is not to be recommended, so its warnings are suppressed */

    /* Create what the model keeps; may be NULL. */
    void (*create)(struct arena *arena, struct fluid_force *force);

    /* Evaluate what the functions below need at the unknowns y. Call it before them, with the same flow and y. yp are
     * the rates of the unknowns, which forces, power and add_impulse need too; otherwise NULL. May be NULL. */
    void (*update)(const struct fluid_force *force, const struct flow_at_body *flow, const double *y, const double *yp);

    /* Set the rows vx, vy of the components that are not prescribed, and all rows px, py if there are any.
     * velocities_are_given: the momenta follow from the velocities. The second function adds the derivatives, with cj
     * for the rates. */
    void (*motion_residual)(const struct fluid_force *force, bool velocities_are_given, const double *y,
                            const double *yp, double *residual);
    void (*motion_jacobian)(const struct fluid_force *force, bool velocities_are_given, double cj, const double *y,
                            struct sparse *jacobian);

    /* Subtract the forces from the rows ax, ay [N], and add the derivatives of these rows, divided by the mass of the
     * node. The derivatives come in three parts. The first two hold the velocity of the fluid constant: by unknowns of
     * the fish on which few rows depend, and by those on which all rows depend (the first columns of a coupling block
     * of the fish with itself; may be NULL). The third is through the velocity of the fluid. */
    void (*residual)(const struct fluid_force *force, const struct flow_at_body *flow, const double *y,
                     double *residual);
    void (*jacobian)(const struct fluid_force *force, const struct flow_at_body *flow, const double *y,
                     struct sparse *jacobian);
    void (*own_jacobian)(const struct fluid_force *force, const double *y, struct coupling_block *rows);
    void (*flow_jacobian)(const struct fluid_force *force, const struct flow_at_body *flow,
                          const struct influence_block *block, const double *y, struct coupling_block *rows);

    /* Add the rate of the momentum of the fluid to the rows ax, ay [N], which makes them the reactions of prescribed
     * nodes. May be NULL. */
    void (*add_momentum_rate)(const struct fluid_force *force, const double *y, const double *yp, double *residual);

    /* How the momentum of the fluid, kg m s-1, depends on the unknown of bound vortex j; x: x of all nodes, then y.
     * NULL if the momentum is 0. */
    void (*momentum_by_strength)(const struct fish *fish, int j, const double *x, double *momentum);

    /* Find the forces with their moments about a point, the powers, and the kinetic energy of the fluid that the edges
     * accelerate, J. */
    struct fluid_forces (*forces)(const struct fluid_force *force, const struct flow_at_body *flow,
                                  const double about[2], const double *y);
    struct fluid_power (*power)(const struct fluid_force *force, const struct flow_at_body *flow, const double *y);
    double (*energy)(const struct fluid_force *force, const struct flow_at_body *flow, const double *y);

    /* Add the impulse of the bound sheet, N s, and its moment about the origin, N m s. bound: the vortices of the
     * sheet; factor: density times depth, kg m-2. */
    void (*add_impulse)(const struct fluid_force *force, const struct sources *bound, double factor, const double *y,
                        double impulse[3]);

    /* Add the moments of the bound circulation at the control points, at x and y [m], where the external flow acts on
     * it. NULL without has_balance. */
    void (*add_moments)(const struct fluid_force *force, const double *x, const double *y, struct impulse_moments *sum);
};

extern const struct force_model edge_force_published, edge_force_reactive, pressure_model;

/* The force model of a fish. This is the only place that chooses. */
static inline const struct force_model *force_model_of(const struct fish *fish) {
    if (fish->force == FORCE_PRESSURE) return &pressure_model;
    return fish->force == FORCE_PUBLISHED ? &edge_force_published : &edge_force_reactive;
}

/* The force of the fluid on a fish, for which *force is set. */
static inline void force_model_create(struct arena *arena, const struct fish *fish, struct fluid_force *force) {
    *force = (struct fluid_force){.model = force_model_of(fish), .fish = fish};
    NEW(arena, force->momentum, 2 * fish->n_nodes);
    if (force->model->create) force->model->create(arena, force);
}

#endif
