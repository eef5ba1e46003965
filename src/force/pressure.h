/* pressure.h: the force of the fluid on a body from the jump of pressure across its bound sheet, and the suction at the
 * leading edge. doc/model.md, section 15. Tested by tests/force/test_pressure.c.
 *
 * The jump contains the rate at which the circulation between the nose and a point changes. To avoid this rate, which
 * is not among the unknowns, we use the unknown p: the velocity of a node plus the momentum of the fluid per mass of
 * the node.
 *
 *     rows v (p if v is given)      p - v - I/m = 0       I: added momentum, linear in positions and strengths
 *     rows p                        dp/dt - a = 0
 *     rows a                        (m a - F)/m = 0       F: includes rotation, convection and suction of this file
 *
 * The force model pressure_model (force_model.h) is defined here; the functions below serve results and tests. */
#ifndef PRESSURE_H
#define PRESSURE_H

#include "base/arena.h"
#include "fish/fish.h"
#include "flow/flow_at_bodies.h"
#include "state/state.h"

/* What a control point contributes. circulation: of the interval around the point, m2 s-1. strength: circulation times
 * density and depth, kg s-1. slip: velocity of the fluid relative to the body, m s-1. body: tangent and normal. The
 * others are used with rings. before: density times depth times the circulation between nose and point, kg s-1.
 * divergence: div u, s-1. edge: a of the edge force times b db/du du, m2 s-1. potential_rate: Phi of the sensors, m2
 * s-2, which sensor_pressure.c sets. */
struct pressure_point {
    double circulation, strength, slip[2];
    struct direction body;
    double before, divergence, edge[2];
    double potential_rate;
};

/* The matrix R that gives the added momentum: I = E3 R x for the nodes x. */
struct pressure_matrix {
    double *circulation; /* of the bound vortices, m2 s-1; for dR/dt their rates, m2 s-2 (n_sheet) */
    double *value;       /* by columns, kg s-1 or kg s-2                                   (n_nodes, n_nodes) */
};

/* The values that an update takes, of the last one and of the next one. */
struct pressure_input {
    bool exists; /* whether there was an update */
    size_t n;
    double *last, *next; /* (n) */
};

/* The pressure force on one fish as of the last pressure_update. Pairs are ordered as x of all nodes, then y. */
struct pressure {
    struct arena *arena;
    const struct fish *fish;
    struct pressure_input input;
    bool has_rate;                       /* whether momentum_rate belongs to the last update and to rate */
    struct pressure_matrix matrix, rate; /* R and dR/dt; the latter set by pressure_update_rate */
    double *momentum;      /* I, the added momentum of the nodes, N s                         (2 n_nodes) */
    double *momentum_rate; /* dI/dt, N: set by pressure_update_rate                             (2 n_nodes) */
    double *force;         /* rotation and convection: the force of the pressure plus dI/dt, N       (2 n_nodes) */
    double suction[2];     /* on the nose, N */
    double separation[2];  /* the suction that attached flow would have, less suction, N */
    struct direction nose; /* direction of the body at the nose */
    double by_strength;    /* how the size of the suction changes with the unknown at the nose, N s m-1 */
    double by_slip;        /* how the size of the suction changes with tau, N s m-1 */
    /* the part of a force at a control point that enters the row of a node, kg-1     (n_control, n_nodes) */
    double *share;
    struct pressure_point *point; /* (n_control) */
    /* workspace: a product with R; of sheet_integrals_matrix; values and forces at the control points */
    double *product, *parts, *at_points, *spread;
    double *wall; /* workspace of thwaites.h; NULL before the first use */
    /* pressure on the left and right side of the fish, Pa, which sensor_pressure.c sets (n_sensors) */
    double *sensor[2];
};

/* The suction at the nose over S pi rho_f w L, with its derivatives. full is qhat^2, the suction of attached flow;
 * bound is A_c^2 tau^2, the most that the flow past the nose allows; both are in m2 s-2 and not negative. The value is
 * a smooth minimum of full and bound, and 0 at rest, where both are 0. */
struct suction_law {
    double value, by_full, by_bound;
};
struct suction_law pressure_suction_law(double full, double bound);

/* Update matrix, momentum, force, suction and points for the unknowns y and the velocity of the fluid, unless both are
 * those of the last update, bit by bit: the books of a step and of an event ask several times. All functions below need
 * this update first, with the same y. */
void pressure_update(struct pressure *pressure, const struct flow_at_body *flow, const double *y);

/* An estimate of the ratio of p to v of node k: 1 plus the added mass of a plate over the mass of the node. */
double pressure_momentum_ratio(const struct fish *fish, int k);

/* The row that holds the relation of p, v and I for component i of node k. It is the row of v, or the row of p if v is
 * given, either by prescribed motion or, at the start, for all nodes. */
int pressure_momentum_row(const struct fish *fish, bool at_start, int i, int k);

/* Update momentum_rate from the rates yp of positions and strengths. */
void pressure_update_rate(struct pressure *pressure, const double *y, const double *yp);

/* After pressure_update_rate: the sheet at control point c, including the kink at the tail. rate: dC/dt, m2 s-2;
 * strength: gamma, m s-1; slip: velocity of the fluid along the body, relative to it, m s-1; spanwise: with rings C div
 * u, m2 s-2. With rings, rate, strength and spanwise are those of a strip of the depth w_L, that is times w_L over the
 * depth at the point, which is pressure_strip_depth_at, m. */
struct pressure_sheet {
    double rate, strength, slip, spanwise;
};
struct pressure_sheet pressure_sheet_at(const struct pressure *pressure, int c, const double *y, const double *yp);
double pressure_strip_depth_at(const struct fish *fish, int c);

/* After pressure_update_rate: the jump of pressure at control point c, left minus right, Pa. It includes the kink of
 * the sheet at the tail and vanishes there. */
double pressure_jump(const struct pressure *pressure, int c, const double *y, const double *yp);

/* After pressure_update_rate: the force of the pressure on an edge, N, summed over the control points on it, each with
 * its interval of the line. */
void pressure_of_edge(const struct pressure *pressure, int k, const double *y, const double *yp, double force[2]);

/* After pressure_update_rate: the forces of the pressure and of the suction on the body, N, their moments about a
 * point, N m, and their powers, W. separation is the suction that attached flow would have less the suction; it is not
 * applied to the body. momentum is the sum of the added momentum, N s, with its moment, N m s. leading_edge_a0 is A_0 =
 * qhat/tau, the leading-edge suction parameter, which for a flat plate is the tangent of the incidence; NaN without
 * flow past the nose. */
struct pressure_forces {
    double pressure[2], suction[2], separation[2], momentum[2];
    double pressure_moment, suction_moment, momentum_moment;
    double pressure_power, suction_power, separation_power;
    double leading_edge_a0;
};
struct pressure_forces pressure_sum(const struct pressure *pressure, const double about[2], const double *y);

#endif
