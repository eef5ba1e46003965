/* rod.h: the elastic body. It has a muscle (the actuation) and resists bending and stretching with internal damping;
 * this file gives the forces with their derivatives, energies and powers. doc/model.md, sections 2 and 3. Tested by
 * tests/body/test_rod.c.
 *
 * Joint j stands at node j+1 between the edges j and j+1 and depends on the nodes j, j+1, j+2:
 *
 *     node j ---- edge j ---- node j+1 ---- edge j+1 ---- node j+2
 *                          turning angle phi */
#ifndef ROD_H
#define ROD_H

#include "base/sparse.h"
#include "fish/fish.h"
#include "fish/fish_gait.h"

/* Frame and motion of an edge of a body. doc/model.md, sections 2 and 9. */

/* From node k to node k+1. */
struct edge {
    double length, t[2], n[2];                      /* m; unit tangent and normal, n = E3 x t */
    double middle[2], velocity[2], acceleration[2]; /* of the midpoint: m, m s-1, m s-2 */
    double rate[2];                                 /* velocity of node k+1 minus velocity of node k, m s-1 */
};

/* Edge k of a fish for the unknowns y. */
struct edge edge_at(const struct fish *fish, int k, const double *y);

static inline double edge_dot(const double a[2], const double b[2]) {
    return a[0] * b[0] + a[1] * b[1];
}
static inline double edge_cross(const double a[2], const double b[2]) {
    return a[0] * b[1] - a[1] * b[0];
}

/* The rate at which the edge turns, rad s-1. */
static inline double edge_turn_rate(const struct edge *edge) {
    return edge_dot(edge->n, edge->rate) / edge->length;
}

/* The curvature kappa = 2 tan(angle/2) of a joint between the unit vectors before and after, with first and second
 * derivative by the angle from before to after. */
struct bend {
    double curvature, slope, second;
};
struct bend edge_bend(const double before[2], const double after[2]);

/* Index of component i (0: x, 1: y) of the position, velocity or acceleration of a node among all unknowns. */
static inline int edge_place(const struct fish *fish, int i, int node) {
    return (i == 0 ? fish->at.x : fish->at.y) + node;
}
static inline int edge_velocity(const struct fish *fish, int i, int node) {
    return (i == 0 ? fish->at.vx : fish->at.vy) + node;
}
static inline int edge_acceleration(const struct fish *fish, int i, int node) {
    return (i == 0 ? fish->at.ax : fish->at.ay) + node;
}

/* The muscle: a travelling wave or a table of natural curvature. doc/model.md, section 4. */

/* Natural curvature of every joint; all arrays (n_joints). */
struct actuation {
    double *curvature;         /* kbar, dimensionless: 2 tan of half the natural turning angle */
    double *rate;              /* rate of kbar, s-1 */
    double *curvature_by_phi0; /* derivatives of both by the bias phi0, at a constant rate of the bias */
    double *rate_by_phi0;
};

/* The part of arrays for the joints of all fish that starts at joint `first`. */
static inline struct actuation actuation_from(const struct actuation *all, int first) {
    return (struct actuation){all->curvature + first, all->rate + first, all->curvature_by_phi0 + first,
                              all->rate_by_phi0 + first};
}

/* Fill all four arrays for the bias phi0 and the rate of the bias, s-1. */
void actuation_find(const struct fish *fish, struct fish_gait gait, double phi0, double phi0_rate,
                    const struct actuation *to);

/* Curvature kappa/l = 2 tan(phi/2)/l of every joint, l: rest length of an edge, m-1 (n_joints). */
void rod_curvature(const struct fish *fish, const double *y, double *curvature);

/* Subtract the elastic and damping forces from the rows ax, ay of the residual [N]. */
void rod_residual(const struct fish *fish, const struct actuation *muscle, const double *y, double *residual);

/* Add the derivatives of rod_residual, each row divided by the node mass, at a constant rate of phi0. */
void rod_jacobian(const struct fish *fish, const struct actuation *muscle, const double *y, struct sparse *jacobian);

/* Derivatives of rod_residual by the rate of phi0, each row divided by the node mass: rows ax, then ay (2 n_nodes).
 * Zeros with damping of the curvature, which does not contain the rate. */
void rod_by_phi0_rate(const struct fish *fish, const struct actuation *muscle, const double *y, double *value);

/* Strains, damped rates and stresses: all joints, then all edges; all arrays (rod_n_strains). */
struct rod_strains {
    double *strain; /* kappa - kbar, 1; l/lbar - 1 */
    double *rate;   /* rate in the damping law, s-1; dl/dt, m s-1 */
    double *stress; /* moment against the muscle, N m; tension, N */
};
static inline int rod_n_strains(const struct fish *fish) {
    return fish->n_joints + fish->n_edges;
}

/* Fill all three arrays from the positions and velocities of the nodes. */
void rod_strains(const struct fish *fish, const struct actuation *muscle, const double *y,
                 const struct rod_strains *to);

/* Energies of bending and stretching, J; powers of the muscle (rate of the natural curvature times the moments of the
 * joints) and of the internal damping, which is never positive, W. */
struct rod_energetics {
    double bending, stretching, actuation, damping;
};
struct rod_energetics rod_energetics(const struct fish *fish, const struct actuation *muscle,
                                     const struct rod_strains *of);

/* Whether an edge is longer than ten times the natural length: the sign of a step too long for the stiffness. */
bool rod_is_torn(const struct fish *fish, const double *y);

/* The most compressed edge; *ratio: length over natural length. */
int rod_shortest_edge(const struct fish *fish, const double *y, double *ratio);

/* The joint (an inner node, 1 .. n_nodes - 2) of the largest turning angle; *turn: this angle, rad. */
int rod_sharpest_joint(const struct fish *fish, const double *y, double *turn);

/* The stresses of a rod from the balance of momentum, and the strains from the material law, for the
 * powers and energies of section 13. doc/model.md, section 13; doc/numerics.md, section 9.
 *
 * In a stiff body strains are tiny, and stiffness times a position error gives a spurious moment. Accelerations do not
 * have this error. The momentum balance of the free part of the body behind a joint gives the moment of the joint:
 *
 *     node k ==M_k==> node k+1 ---- ... ---- node N-1        M_k dkappa/dphi = - sum over j > k: (x_j - x_k) x r_j
 *
 * with r_j = m_j a_j minus all forces on the node except the rod forces. */

/* Correct the stresses of rod_strains, computed from positions, to the stresses of the momentum balance; residue: m a
 * minus all forces including the rod forces, N, in the rows ax, ay. The stress of a joint or edge is unchanged if a
 * node behind has a prescribed motion. */
void rod_stress_balance(const struct fish *fish, const double *residue, const double *y, double *stress);

/* Advance the strains by a step of h seconds: stress = stiffness strain + damping dstrain/dt. The stress is the
 * parabola through oldest, before and now; the step from oldest to before took g seconds. g = 0: the line through
 * before and now. */
void rod_stress_creep(const struct fish *fish, double h, double g, const double *oldest, const double *before,
                      const double *now, double *strain);

/* The rates of the strains from strains and stresses, as in rod_strains. */
void rod_stress_rates(const struct fish *fish, const double *strain, const double *stress, double *rate);

// ---- the joint at the nose that holds the direction of edge 0 of a body with a prescribed head. doc/model.md, section
// 2. Tested by tests/body/test_clamp.c.
//
//     given direction         edge 0
//     - - - - - - - -  node 0 -------- node 1
//                     angle phi_c
//
// For a fish without a clamp all functions do nothing or return zeros.

/* Subtract the forces of the clamp on the nodes 0 and 1 at time t from the rows ax, ay of the residual [N]. */
void rod_clamp_residual(const struct fish *fish, double t, const double *y, double *residual);

/* Add the derivatives of rod_clamp_residual, each row divided by the node mass. */
void rod_clamp_jacobian(const struct fish *fish, double t, const double *y, struct sparse *jacobian);

/* Energy, powers and moment of the clamp; zeros without one. */
struct rod_clamp_terms {
    double energy;        /* elastic, J */
    double damping_power; /* of the damping of the clamp, W: never positive */
    double driving_power; /* on the body, of the moment that turns the given direction, W */
    double moment;        /* on the body, N m */
};
struct rod_clamp_terms rod_clamp_terms(const struct fish *fish, double t, const double *y);

#endif
