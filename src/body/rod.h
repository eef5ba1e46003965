/* rod.h: the elastic body: forces of bending, stretching and internal damping, their derivatives, energies and powers.
 * doc/model.md, sections 2 and 3. Tested by tests/body/test_rod.c.
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

/* Take the elastic and damping forces off the rows ax, ay of the residual [N]. */
void rod_residual(const struct fish *fish, const struct actuation *muscle, const double *y, double *residual);

/* Add the derivatives of rod_residual, each row divided by its node's mass; the rate of phi0 counts as given. */
void rod_jacobian(const struct fish *fish, const struct actuation *muscle, const double *y, struct sparse *jacobian);

/* What a rod stores, damps and works with: first of all joints, then of all edges; all arrays (rod_n_strains). */
struct rod_strains {
    double *strain; /* kappa - kbar, 1; l/lbar - 1 */
    double *rate;   /* of the strain that is damped, s-1; dl/dt, m s-1 */
    double *stress; /* the moment that the muscle works against, N m; tension, N */
};
int rod_n_strains(const struct fish *fish);

/* Fill all three from the places and velocities of the nodes. */
void rod_strains(const struct fish *fish, const struct actuation *muscle, const double *y,
                 const struct rod_strains *to);

/* Energies, J. */
double rod_bending_energy(const struct fish *fish, const double *strain);
double rod_stretching_energy(const struct fish *fish, const double *strain);

/* Whether an edge is ten times as long as it is by nature: what a step that is too long for the stiffness leads to. */
int rod_is_torn(const struct fish *fish, const double *y);

/* The edge that is compressed most, and its length over its natural one. */
int rod_shortest_edge(const struct fish *fish, const double *y, double *ratio);

/* The joint (an inner node, 1 .. n_nodes - 2) that turns most, and its turn, rad. */
int rod_sharpest_joint(const struct fish *fish, const double *y, double *turn);

/* Power of the muscle, which changes the natural curvature against the moments of the joints, W. */
double rod_actuation_power(const struct fish *fish, const struct actuation *muscle, const double *stress);

/* Power of the internal damping, W: never positive. */
double rod_damping_power(const struct fish *fish, const double *rate);

#endif
