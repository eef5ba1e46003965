/* methods.h: the integration methods: their words in solver.method, what each of them can do, and the coefficients of
 * the Runge-Kutta methods. The reader of cases, the integrators and the list for users all take them from this table.
 * Tested by tests/base/test_methods.c. */
#ifndef METHODS_H
#define METHODS_H

#include <stdbool.h>

/* The rows of the table that other code names. Another Runge-Kutta method is one more row, without a name here. */
enum method {
    METHOD_IDA,
    METHOD_EULER,
    METHOD_HEUN,
    METHOD_RK4,
    METHOD_DORMAND_PRINCE,
    METHOD_IMPLICIT_EULER,
    METHOD_TRAPEZOID,
    METHOD_IMEX,
    METHOD_VERLET
};

/* The unknowns whose errors decide about the steps of ida: the differential ones, whose tolerances leave that to the
 * positions, or the algebraic ones as well: accelerations, strengths of the sheets, velocities beside momenta. */
enum error_test { ERROR_TEST_POSITIONS, ERROR_TEST_ALL };

/* No method has a higher order. */
enum { METHODS_MAX_ORDER = 5 };

/* The Butcher tableau of an explicit Runge-Kutta method. The embedded method, of another order, gives the error of a
 * step; a tableau for fixed steps only has embedded NULL and embedded_order 0.
 *
 *     c | a
 *     --+---------
 *       | b
 *       | embedded
 */
struct butcher_tableau {
    int n_stages, order, embedded_order;
    const double *c;        /* (n_stages) */
    const double *a;        /* row-major, zero from the diagonal on    (n_stages * n_stages) */
    const double *b;        /* (n_stages) */
    const double *embedded; /* (n_stages) */
};

/* One method. A Runge-Kutta method has a tableau for fixed steps, for adaptive steps, or both. */
struct method_properties {
    const char *word; /* of solver.method */
    int order;        /* highest order of ida; reduced by solver.order */
    bool is_implicit;
    bool has_fixed_steps, has_adaptive_steps; /* with solver.step above 0; with 0 */
    const struct butcher_tableau *fixed, *adaptive;
    const char *help; /* short description */
};

/* In the order of enum method, and then the rows without a name. */
extern const struct method_properties methods_table[];
extern const int methods_n;

#endif
