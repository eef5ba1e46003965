/* sundials_context.h: what a solver of SUNDIALS needs besides its equations: a context, vectors over our arrays, and a
 * handler that turns messages into ours. Tested by tests/solver/test_sundials_context.c. */
#ifndef SUNDIALS_CONTEXT_H
#define SUNDIALS_CONTEXT_H

#include "base/status.h"
#include "solver/sundials.h"

/* The context of one solver, and what its vectors have in common. It stays where it is while there are vectors. */
struct sundials_context {
    SUNContext context;
    int n, threads;       /* of every vector: values, and threads that share an operation */
    enum status *failure; /* the status of the last callback; belongs to the owner */
    N_Vector spare;       /* stands in for a clone for which there was no memory */
    int lacked_memory;    /* for a clone */
};

/* Create a context for vectors of n values. Long vectors have their operations shared by these threads. Each value has
 * the bits that one thread computes, and norms are summed in the order of the values. Errors of SUNDIALS go to
 * sundials_context_message with failure. Fails with STATUS_MEMORY. sundials_context_free accepts a structure of zeros.
 */
enum status sundials_context_create(struct sundials_context *context, int n, int threads, enum status *failure);
void sundials_context_free(struct sundials_context *context);

/* Create a vector of values that are not copied; it does not own them. Fails with STATUS_MEMORY. */
enum status sundials_context_vector(struct sundials_context *context, N_Vector *vector, double *values);

/* SUNDIALS 6 crashes where a vector cannot be cloned, so a clone is never NULL: where there is no memory it is the
 * spare vector, and all results are worthless. Fails with STATUS_MEMORY once that has happened. To be called after
 * calls that may clone vectors: those that set up a solver, and the first step. */
enum status sundials_context_check(const struct sundials_context *context);

/* Error handler for SUNDIALS; data is the status of the last callback. If the callback failed, its message is the cause
 * and stays; else the text of SUNDIALS becomes this thread's message. */
void sundials_context_message(SUNDIALS_ERROR_ARGUMENTS);

#endif
