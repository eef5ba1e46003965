/* sundials_adapter.h: what IDA and KINSOL share: context, vectors, the Jacobian of the school with its linear solver. Tested by
 * tests/solver/test_initial_conditions.c and tests/solver/test_ida.c. */
#ifndef SUNDIALS_ADAPTER_H
#define SUNDIALS_ADAPTER_H

#include <sundials/sundials_linearsolver.h>
#include <sundials/sundials_matrix.h>
#include <sundials/sundials_nvector.h>

#include "base/status.h"
#include "model/jacobian.h"
#include "solver/linear.h"

/* A Jacobian as SUNDIALS holds it, and the solver of its systems. */
struct sundials_adapter_linear {
    struct linear *linear;
    SUNMatrix matrix; /* has nothing of its own: the callback of the solver fills the Jacobian */
    SUNLinearSolver solver;
};

/* Fails with STATUS_MEMORY. */
enum status sundials_adapter_context(SUNContext *context);

/* A vector around an array that it does not own. Fails with STATUS_MEMORY. */
enum status sundials_adapter_vector(N_Vector *vector, SUNContext context, long n, double *values);

/* The solver for a Jacobian that must outlive it; scale and end as in linear_create. To SUNDIALS it is a direct
 * one: IDA scales its solutions when the step has changed since the Jacobian. Fails with STATUS_MEMORY; there is
 * nothing to free then. */
enum status sundials_adapter_linear_create(struct sundials_adapter_linear *adapter, SUNContext context,
                                           const struct jacobian *jacobian, const double *scale, struct linear_end end);
void sundials_adapter_linear_free(struct sundials_adapter_linear *adapter);

/* Keep the text of an error of SUNDIALS as this thread's message; an error handler. */
void sundials_adapter_message(int code, const char *module, const char *function, char *text, void *data);

#endif
