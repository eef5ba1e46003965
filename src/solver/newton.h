/* newton.h: Newton's method of KINSOL for a few equations, each of which is dear to evaluate: those of a steady state.
 * Tested by tests/solver/test_newton.c. */
#ifndef NEWTON_H
#define NEWTON_H

#include "base/status.h"

/* n equations value(u) = 0. A callback that fails ends newton_solve with its status. */
struct newton {
    int n;
    const double *scale; /* of unknown i and of equation i, which have the same unit                    (n) */
    double tolerance;    /* solved where no equation is above it, over its scale */
    double max_step;     /* in the norm of the unknowns over their scales; at least 1 */
    int reuse;           /* steps with one Jacobian */
    int max_iterations;
    enum status (*value)(void *data, const double *u, double *value);
    /* matrix[i + n j] = d value_i / d u_j where value was evaluated last */
    enum status (*jacobian)(void *data, double *matrix);
    void *data;
};

/* Solve from u, which holds the last iterate afterwards, also where this fails: with STATUS_SOLVER (no solution after
 * max_iterations, or a Jacobian that is singular), with STATUS_MEMORY, or as a callback. */
enum status newton_solve(const struct newton *problem, double *u);

#endif
