/* newton.h: small dense systems: Newton's method of KINSOL for a few expensive equations, such as the equations of a
 * steady state; fixed point and eigenvalues of a linear map. Tested by tests/solver/test_newton.c. */
#ifndef NEWTON_H
#define NEWTON_H

#include "base/arena.h"
#include "base/status.h"

/* n equations value(u) = 0. A failed callback ends newton_solve with its status. */
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

/* Solve from the initial guess u. u is then the last iterate, also after a failure. Fails with STATUS_SOLVER (no
 * solution after max_iterations, or a singular Jacobian), or with the status of a callback. arena: for scratch. */
enum status newton_solve(struct arena *arena, const struct newton *problem, double *u);

/* Eigenvalues of the linear map A of n dimensions that maps the columns of before to the columns of after best in the
 * sense of least squares; both (n, n_columns), column after column, n_columns >= n. Eigenvalues are sorted by falling
 * absolute value, in a complex pair positive imaginary part first; they are 0 in directions in which the columns of
 * before are below 3 % of the largest column. way (n): vector to the fixed point of x -> A x + b from the point at
 * which the map changes x by change, (I - A) way = change; 0 if 1 is an eigenvalue, when there is no fixed point. Fails
 * with STATUS_SOLVER if all columns are 0. arena: for scratch. */
enum status newton_multipliers(struct arena *arena, int n, int n_columns, const double *before, const double *after,
                               const double *change, double *real, double *imaginary, double *way);

#endif
