/* bridge.h: what IDA and KINSOL share: context, vectors, the sparse matrix with its KLU solver. Tested by
 * tests/test_consistent.c and tests/test_implicit.c. */
#ifndef BRIDGE_H
#define BRIDGE_H

#include <sundials/sundials_linearsolver.h>
#include <sundials/sundials_matrix.h>
#include <sundials/sundials_nvector.h>

#include "sparse.h"
#include "status.h"

/* A sparse matrix as SUNDIALS holds it, and KLU for it. */
struct bridge_klu {
    SUNContext context;
    N_Vector like; /* any vector of the right length */
    SUNMatrix matrix;
    SUNLinearSolver solver;
    unsigned version; /* of the pattern that the matrix has; 0: none yet */
};

/* Fails with STATUS_MEMORY. */
enum status bridge_context(SUNContext *context);

/* A vector around an array that it does not own. Fails with STATUS_MEMORY. */
enum status bridge_vector(N_Vector *vector, SUNContext context, long n, double *values);

/* A matrix of order n and its solver. Fails with STATUS_MEMORY; klu then owns nothing. */
enum status bridge_klu_create(struct bridge_klu *klu, SUNContext context, N_Vector like, long n);
void bridge_klu_free(struct bridge_klu *klu);

/* Copy pattern and values into the matrix: SUNDIALS wipes both before every Jacobian. A new pattern makes KLU analyse
 * anew; an old one keeps its symbolic factors. Fails with STATUS_MEMORY. */
enum status bridge_klu_copy(struct bridge_klu *klu, const struct sparse *from);

/* Keep the text of an error of SUNDIALS as this thread's message; an error handler. */
void bridge_message(int code, const char *module, const char *function, char *text, void *data);

#endif
