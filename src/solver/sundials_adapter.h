/* sundials_adapter.h: the objects of SUNDIALS that IDA, KINSOL and ARKODE need, made from ours: context, vectors, the
 * Jacobian of the school with its linear solver, error messages. Tested by tests/solver/test_initial_conditions.c and
 * tests/solver/test_ida.c. */
#ifndef SUNDIALS_ADAPTER_H
#define SUNDIALS_ADAPTER_H

#include "base/status.h"
#include "model/jacobian.h"
#include "solver/linear.h"
#include "solver/sundials.h"

/* The Jacobian as SUNDIALS sees it, and its linear solver. */
struct sundials_adapter_linear {
    struct linear *linear;
    enum status *failure; /* the status of the last callback; belongs to the owner */
    SUNMatrix matrix;     /* empty: the callback for the Jacobian fills ours */
    SUNLinearSolver solver;
};

/* Create a context, whose errors go to sundials_adapter_message with failure. Fails with STATUS_MEMORY, also where
 * there is none for what IDA, KINSOL or ARKODE allocate for n unknowns: they crash where they find none. */
enum status sundials_adapter_context(SUNContext *context, int n, enum status *failure);

/* Create a vector of n values that are not copied; it does not own them. Fails with STATUS_MEMORY. */
enum status sundials_adapter_vector(N_Vector *vector, SUNContext context, int n, double *values);

/* Create the solver for a Jacobian, which must outlive it; scale and tolerance as in linear_create. It declares itself
 * a direct solver, so that IDA scales its solutions when the step has changed since the Jacobian was evaluated.
 * *failure, which must outlive it too, receives the status of each set-up and each solution. The adapter must stay
 * where it is. Fails with STATUS_MEMORY; there is nothing to free then. sundials_adapter_linear_free accepts a
 * structure of zeros. */
enum status sundials_adapter_linear_create(struct sundials_adapter_linear *adapter, SUNContext context,
                                           const struct jacobian *jacobian, const double *scale,
                                           struct linear_tolerance tolerance, enum status *failure);
void sundials_adapter_linear_free(struct sundials_adapter_linear *adapter);

/* Error handler for SUNDIALS; data is the status of the last callback. If the callback failed, its message is the cause
 * and stays; else the text of SUNDIALS becomes this thread's message. */
void sundials_adapter_message(SUNDIALS_ERROR_ARGUMENTS);

#endif
