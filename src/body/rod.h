/* rod.h: the elastic body: forces of bending, stretching and internal damping, derivatives of the forces, energies and
 * powers. doc/model.md, sections 2 and 3. Tested by tests/body/test_rod.c.
 *
 * Joint j stands at node j+1 between the edges j and j+1 and depends on the nodes j, j+1, j+2:
 *
 *     node j ---- edge j ---- node j+1 ---- edge j+1 ---- node j+2
 *                          turning angle phi
 */
#ifndef ROD_H
#define ROD_H

#include "base/sparse.h"
#include "body/actuation.h"
#include "fish/fish.h"

/* Curvature kappa = 2 tan(phi/2) of every joint, dimensionless (n_joints). */
void rod_curvature(const struct fish *fish, const double *y, double *curvature);

/* Subtract the elastic and damping forces from the rows ax, ay of the residual [N]. */
void rod_residual(const struct fish *fish, const struct actuation *muscle, const double *y, double *residual);

/* Add the derivatives of rod_residual, each row divided by the node mass, at a constant rate of phi0. */
void rod_jacobian(const struct fish *fish, const struct actuation *muscle, const double *y, struct sparse *jacobian);

/* Strains, damped rates and stresses: all joints, then all edges; all arrays (rod_n_strains). */
struct rod_strains {
    double *strain; /* kappa - kbar, 1; l/lbar - 1 */
    double *rate;   /* rate in the damping law, s-1; dl/dt, m s-1 */
    double *stress; /* moment against the muscle, N m; tension, N */
};
int rod_n_strains(const struct fish *fish);

/* Fill all three arrays from the positions and velocities of the nodes. */
void rod_strains(const struct fish *fish, const struct actuation *muscle, const double *y,
                 const struct rod_strains *to);

/* Energies, J. */
double rod_bending_energy(const struct fish *fish, const double *strain);
double rod_stretching_energy(const struct fish *fish, const double *strain);

/* Whether an edge is longer than ten times the natural length: the sign of a step too long for the stiffness. */
int rod_is_torn(const struct fish *fish, const double *y);

/* The most compressed edge; *ratio: length over natural length. */
int rod_shortest_edge(const struct fish *fish, const double *y, double *ratio);

/* The joint (an inner node, 1 .. n_nodes - 2) of the largest turning angle; *turn: this angle, rad. */
int rod_sharpest_joint(const struct fish *fish, const double *y, double *turn);

/* Power of the muscle, W: rate of the natural curvature times the moments of the joints. */
double rod_actuation_power(const struct fish *fish, const struct actuation *muscle, const double *stress);

/* Power of the internal damping, W: never positive. */
double rod_damping_power(const struct fish *fish, const double *rate);

#endif
