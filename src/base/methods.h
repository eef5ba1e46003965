/* methods.h: the integration methods: the words of solver.method, what each method can do, and the coefficients of the
 * Runge-Kutta methods. Who reads a case, integrates, or lists the methods looks here. Tested by
 * tests/base/test_methods.c. */
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
    METHOD_VERLET
};

/* The Butcher tableau of an explicit Runge-Kutta method. The embedded method, of another order, gives the error of a
 * step; it is NULL, and its order 0, in a tableau for fixed steps only.
 *
 *     c | a
 *     --+---------
 *       | b
 *       | embedded
 */
struct butcher_tableau {
    int n_stages, order, embedded_order;
    const double *c;        /* (n_stages) */
    const double *a;        /* row after row, zero from the diagonal on    (n_stages * n_stages) */
    const double *b;        /* (n_stages) */
    const double *embedded; /* (n_stages) */
};

/* One method. A Runge-Kutta method has a tableau for each kind of steps that it takes. */
struct method_properties {
    const char *word; /* of solver.method */
    int order;        /* of ida the highest: solver.order lowers it */
    bool is_implicit;
    bool has_fixed_steps, has_adaptive_steps; /* with solver.step above 0; with 0 */
    const struct butcher_tableau *fixed, *adaptive;
    const char *help; /* what it is, in a few words */
};

/* In the order of enum method, and then the rows without a name. */
extern const struct method_properties methods_table[];
extern const int methods_n;

#endif
