/* equilibrium.h: finds bodies at rest in a stream, that is the positions of the nodes at which all forces balance, and
 * the bound sheets there. No circulation is shed: the starting vortices are infinitely far away, and the strength at
 * the tail is 0. doc/steady.md, "Equilibria without a beat". Tested by tests/solver/test_equilibrium.c. */
#ifndef EQUILIBRIUM_H
#define EQUILIBRIUM_H

#include "base/arena.h"
#include "base/status.h"
#include "school/residual.h"

struct equilibrium;

/* How the residual is evaluated in an equilibrium. */
extern const struct residual_mode equilibrium_mode;

/* Create the problem for all bodies of a school, each with the prescribed velocity of its first node. The wakes of the
 * state are discarded. School and state must outlive the problem. */
struct equilibrium *equilibrium_create(struct arena *arena, const struct school *school, struct state *state);

/* Solve by Newton's method from the positions and sheets in state->y. The solution replaces state->y, the rates replace
 * state->yp, and the residual is evaluated there. Without convergence it fails with STATUS_SOLVER or STATUS_RETRY, and
 * state->y is the last iterate. */
enum status equilibrium_solve(struct equilibrium *equilibrium);

/* The largest scaled residual of the last solution. The scale of a force is the force that bends the body by its
 * length, plus the force of the stream; the scale of a velocity is that of the stream. */
double equilibrium_residual(const struct equilibrium *equilibrium);

/* The static stiffness at the solution over the masses of the nodes, s-2, with sheets that follow the bodies without
 * delay. It is described by the logarithm of its determinant and by the number of its negative real eigenvalues, which
 * is the number of unstable displacements. Both are 0 without a free node. Fails with STATUS_SOLVER. */
struct equilibrium_stiffness {
    double log_determinant;
    int n_negative;
};
enum status equilibrium_stiffness(struct equilibrium *equilibrium, struct equilibrium_stiffness *stiffness);

#endif
