/* pressure.h: the force of the fluid on a body from the pressure jump across its bound sheet, with the suction at the
 * leading edge. doc/model.md, section 15. Tested by tests/force/test_pressure.c.
 *
 * The jump has the rate at which the circulation between the nose and a point changes. Instead of that rate the
 * unknowns have p, velocity plus the momentum of the fluid per mass of a node:
 *
 *     rows v (p where v is given)   p - v - I/m = 0       I: added momentum, linear in places and strengths
 *     rows p                        dp/dt - a = 0
 *     rows a                        (m a - F)/m = 0       F: with turning, convection and suction of this file */
#ifndef PRESSURE_H
#define PRESSURE_H

#include "base/sparse.h"
#include "fish/fish.h"
#include "flow/flow_at_bodies.h"
#include "flow/flow_derivative.h"

/* A control point: the circulation of the interval around it, m2 s-1; that times density and depth, kg s-1; the
 * velocity of the fluid relative to the body, m s-1; the line of the body. With rings: density times depth times the
 * circulation before it, kg s-1; div u, s-1; a of the edge force times b db/du du, m2 s-1. */
struct pressure_point {
    double circulation, strength, slip[2];
    struct direction body;
    double before, divergence, edge[2];
};

/* Of one fish, as last updated. All pairs: x of all nodes, then y. */
struct pressure {
    const struct fish *fish;
    double *circulation;   /* of the bound vortices, m2 s-1                                     (n_sheet) */
    double *matrix;        /* R: I = E3 R x, kg s-1                                      (n_nodes, n_nodes) */
    double *momentum;      /* I, the added momentum of the nodes, N s                         (2 n_nodes) */
    double *momentum_rate; /* dI/dt, N: of pressure_update_rate                               (2 n_nodes) */
    double *force;         /* turning and convection: the force of the pressure and dI/dt, N  (2 n_nodes) */
    double suction[2];     /* on the nose, N */
    double separation[2];  /* what the suction of attached flow has more than that, N */
    struct direction nose; /* of the body at the nose */
    double by_strength;    /* of the size of the suction: by the unknown at the nose, N s m-1, */
    double by_slip;        /* and by tau, N s m-1 */
    double *share;         /* of a force at a control point in the row of a node, kg-1           (n_control, n_nodes) */
    struct pressure_point *point; /* (n_control) */
};

/* The suction that a nose holds, over S pi rho_f w L: full is that of attached flow, qhat^2, bound the most that the
 * flow past the nose allows, A_c^2 tau^2, both m2 s-2 and not negative. The value is about the smaller one of them, and
 * at rest, where both are 0, it is 0; with its derivatives by both. */
struct suction_law {
    double value, by_full, by_bound;
};
struct suction_law pressure_suction_law(double full, double bound);

/* For a fish with force: pressure. Fails with STATUS_MEMORY; pressure_free accepts NULL. */
enum status pressure_create(struct pressure **pressure, const struct fish *fish);
void pressure_free(struct pressure *pressure);

/* Take matrix, momentum, force, suction and points from the unknowns y and the velocity of the fluid. All functions
 * below read them, with the same y. */
void pressure_update(struct pressure *pressure, const struct flow_at_body *flow, const double *y);

/* The added momentum of node k, kg m s-1, by the unknown of vortex j; x: the places of all nodes, then their y. */
void pressure_momentum_by_strength(const struct fish *fish, int k, int j, const double *x, double momentum[2]);

/* About how much larger p of node k is than v: 1 and the added mass of its part of a plate over its mass. */
double pressure_momentum_ratio(const struct fish *fish, int k);

/* The row in which the relation of p, v and I stands for component i of node k: that of v, or that of p where v is
 * given (at the start, of all nodes). */
int pressure_momentum_row(const struct fish *fish, int at_start, int i, int k);

/* Set those rows, m s-1; take the forces off the rows ax, ay, N. */
void pressure_momentum_residual(const struct pressure *pressure, int at_start, const double *y, double *residual);
void pressure_residual(const struct pressure *pressure, double *residual);

/* Add the derivatives of the rows of the momentum, and those of the rows ax, ay, divided by the mass of the node, by
 * the velocities of the nodes. */
void pressure_momentum_jacobian(const struct pressure *pressure, int at_start, const double *y,
                                struct sparse *jacobian);
void pressure_jacobian(const struct pressure *pressure, struct sparse *jacobian);

/* Add the derivatives of the rows ax, ay, divided by the mass of the node: by the own places and strengths where the
 * velocity of the fluid stays as it is, and those that come through it. */
void pressure_own_jacobian(const struct pressure *pressure, const double *y, struct coupling_block *rows);
void pressure_flow_jacobian(const struct pressure *pressure, const struct influence_block *block,
                            struct coupling_block *rows);

/* Find momentum_rate for the rates yp of the places and strengths. */
void pressure_update_rate(struct pressure *pressure, const double *y, const double *yp);

/* After pressure_update_rate: the jump of the pressure at control point c, left less right, Pa. With the kink that the
 * sheet has at the tail, so that the jump vanishes there. */
double pressure_jump(const struct pressure *pressure, int c, const double *y, const double *yp);

/* After pressure_update_rate: the force of the pressure on an edge, N: of the control points there, each with its
 * interval of the line. */
void pressure_of_edge(const struct pressure *pressure, int k, const double *y, const double *yp, double force[2]);

/* After pressure_update_rate: the force of the pressure and the suction on the body, N, their moments about a point, N
 * m, and their powers, W; force and power of what the suction of attached flow has more (separation), which acts on
 * nothing; the sum of the added momentum, N s, and its moment, N m s; A_0 = qhat/tau, the leading-edge suction
 * parameter: the tangent of the incidence of a flat plate, NaN where no fluid moves past the nose. */
struct pressure_forces {
    double pressure[2], suction[2], separation[2], momentum[2];
    double pressure_moment, suction_moment, momentum_moment;
    double pressure_power, suction_power, separation_power;
    double leading_edge_a0;
};
struct pressure_forces pressure_sum(const struct pressure *pressure, const double about[2], const double *y);

#endif
