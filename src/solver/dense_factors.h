/* dense_factors.h: factors of a full matrix by Gaussian elimination with row pivoting. Every operation is rounded
 * as written, so the bits are the same for any vector width. Tested by tests/solver/test_dense_factors.c.
 *
 * LAPACK without an optimised BLAS takes five times as long for the orders of one fish, 50 to 200, and its last bits
 * depend on the library. */
#ifndef DENSE_FACTORS_H
#define DENSE_FACTORS_H

#include "base/arena.h"

struct dense_factors {
    int n, stride; /* order; distance between columns, a multiple of the rows of a tile */
    double *value; /* by columns: the matrix, later L below the diagonal and U     (n, stride) */
    int *pivot;    /* the row that was swapped with each row                  (n) */
};

/* A matrix of zeros of order n. */
struct dense_factors dense_factors_create(struct arena *arena, int n);

/* Replace the matrix by the factors. Returns whether the matrix is regular. */
int dense_factors_set_up(struct dense_factors *factors);

/* Replace the right-hand side x (n) by the solution. */
void dense_factors_solve(const struct dense_factors *factors, double *x);

#endif
