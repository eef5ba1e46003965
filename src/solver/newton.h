/* newton.h: Newton's method of KINSOL for a few expensive equations, such as those of a steady state, and the fixed
 * point and the eigenvalues of a linear map. All systems here are small and dense. Tested by
 * tests/solver/test_newton.c. */
#ifndef NEWTON_H
#define NEWTON_H

#include "base/arena.h"
#include "base/status.h"

/* n equations value(u) = 0. If a callback fails, newton_solve ends with its status. */
struct newton {
    int n;
    const double *scale; /* of unknown i and equation i, which have the same unit                       (n) */
    double tolerance;    /* largest accepted residual, in units of scale */
    double max_step;     /* largest norm of a step in units of scale, at least 1 */
    int reuse;           /* number of steps with one Jacobian */
    int max_iterations;
    enum status (*value)(void *data, const double *u, double *value);
    /* matrix[i + n j] = d value_i / d u_j at the last evaluation of value */
    enum status (*jacobian)(void *data, double *matrix);
    void *data;
};

/* Solve, starting from the guess in u, which becomes the last iterate even if the solution fails. Fails with
 * STATUS_SOLVER (no solution after max_iterations, or a singular Jacobian), or with the status of a callback. arena:
 * for scratch. */
enum status newton_solve(struct arena *arena, const struct newton *problem, double *u);

/* Find the eigenvalues of the linear map A of n dimensions that takes the columns of before to the columns of after as
 * well as possible in the sense of least squares. Both are (n, n_columns), column after column, with n_columns >= n.
 *
 * The eigenvalues are sorted by falling absolute value, and the one with positive imaginary part comes first in a
 * complex pair. They are 0 in directions in which the columns of before are below 3 % of the largest one.
 *
 * way (n) is the vector from the point at which the map changes x by change to the fixed point of x -> A x + b, that is
 * (I - A) way = change. It is 0 if 1 is an eigenvalue, because there is no fixed point then.
 *
 * Fails with STATUS_SOLVER if all columns are 0. arena: for scratch. */
enum status newton_multipliers(struct arena *arena, int n, int n_columns, const double *before, const double *after,
                               const double *change, double *real, double *imaginary, double *way);

#endif
