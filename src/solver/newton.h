/* newton.h: small dense systems: Newton's method of KINSOL for a few expensive equations, such as the equations of a
 * steady state; fixed point and multipliers of a linear map with memory. Tested by tests/solver/test_newton.c. */
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

/* The n largest multipliers of a linear map with memory, x_k+1 = sum over m < n_memory of response_m x_k-m, in which
 * response_m has the elements response[i + n j + n n m]: solutions x_k = lambda^k x_0. Sorted by falling absolute
 * value, in a complex pair positive imaginary part first. mode (n, n, 2), or NULL: real and imaginary part of element k
 * of vector x_0 of multiplier i are at 2 (k + n i), over the largest element. Fails with STATUS_SOLVER if a response is
 * not finite. arena: for scratch. */
enum status newton_multipliers(struct arena *arena, int n, int n_memory, const double *response, double *real,
                               double *imaginary, double *mode);

/* The way to the fixed point of such a map from a point that the map changes by change (n): (I - sum of response_m) way
 * = change; 0 if 1 is a multiplier, when there is no fixed point. arena: for scratch. */
void newton_way(struct arena *arena, int n, int n_memory, const double *response, const double *change, double *way);

/* The unit tangent of the curve value(u) = 0 of n equations for n + 1 unknowns with this Jacobian (n, n + 1), by
 * columns: it is orthogonal to the rows, and its scalar product with the tangent given, which it replaces, is
 * positive (n + 1). Fails with STATUS_SOLVER if the curve branches. arena: for scratch. */
enum status newton_tangent(struct arena *arena, int n, const double *jacobian, double *tangent);

#endif
