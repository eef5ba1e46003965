/* equilibrium.h: bodies at rest in a stream: the places of the nodes at which no force is left on them, with the bound
 * sheets that belong to these. Nothing is shed: what was is infinitely far away, and the strength at the tail is 0.
 * doc/steady.md, "Without a beat". Tested by tests/solver/test_equilibrium.c. */
#ifndef EQUILIBRIUM_H
#define EQUILIBRIUM_H

#include "base/status.h"
#include "school/residual.h"

struct equilibrium;

/* The equilibrium of all bodies of a residual, each with the prescribed velocity of its first node; the state has no
 * wake from now on. Both must outlive it. Fails with STATUS_MEMORY; equilibrium_free accepts NULL, and leaves the
 * residual as that of a run. */
enum status equilibrium_create(struct equilibrium **equilibrium, struct residual *residual, struct state *state);
void equilibrium_free(struct equilibrium *equilibrium);

/* Newton's method from the places and sheets in state->y, where the solution then is, with its rates in state->yp; the
 * residual has been evaluated there. Fails with STATUS_SOLVER or STATUS_RETRY where it does not converge (state->y is
 * then the last iterate), or with STATUS_MEMORY. */
enum status equilibrium_solve(struct equilibrium *equilibrium);

/* The largest equation of the last solution: forces over those that bend the body by its length, or that the stream
 * has; velocities over that of the stream. */
double equilibrium_residual(const struct equilibrium *equilibrium);

/* The static stiffness at the solution over the masses of the nodes, s-2, where the sheets follow the bodies at once:
 * the logarithm of its determinant, and how many of its eigenvalues are real and below 0: from so many displacements
 * the bodies go on by themselves. 0 and 0 where no node is free. Fails with STATUS_MEMORY or STATUS_SOLVER. */
struct equilibrium_stiffness {
    double log_determinant;
    int n_negative;
};
enum status equilibrium_stiffness(struct equilibrium *equilibrium, struct equilibrium_stiffness *stiffness);

#endif
