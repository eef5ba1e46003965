/* bridge.h: what IDA and KINSOL share: context, vectors, the Jacobian of the school with its linear solver. Tested by
 * tests/test_consistent.c and tests/test_implicit.c. */
#ifndef BRIDGE_H
#define BRIDGE_H

#include <sundials/sundials_linearsolver.h>
#include <sundials/sundials_matrix.h>
#include <sundials/sundials_nvector.h>

#include "jacobian.h"
#include "linear.h"
#include "status.h"

/* A Jacobian as SUNDIALS holds it, and the solver of its systems. */
struct bridge_linear {
    struct linear *linear;
    SUNMatrix matrix; /* has nothing of its own: the callback of the solver fills the Jacobian */
    SUNLinearSolver solver;
};

/* Fails with STATUS_MEMORY. */
enum status bridge_context(SUNContext *context);

/* A vector around an array that it does not own. Fails with STATUS_MEMORY. */
enum status bridge_vector(N_Vector *vector, SUNContext context, long n, double *values);

/* The solver for a Jacobian that must outlive it; scale and end as in linear_create. To SUNDIALS it is a direct
 * one: IDA scales its solutions when the step has changed since the Jacobian. Fails with STATUS_MEMORY; there is
 * nothing to free then. */
enum status bridge_linear_create(struct bridge_linear *bridge, SUNContext context, const struct jacobian *jacobian,
                                 const double *scale, struct linear_end end);
void bridge_linear_free(struct bridge_linear *bridge);

/* Keep the text of an error of SUNDIALS as this thread's message; an error handler. */
void bridge_message(int code, const char *module, const char *function, char *text, void *data);

#endif
