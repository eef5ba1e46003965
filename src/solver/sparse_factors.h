/* sparse_factors.h: the factors of a sparse matrix by KLU. Pivots that were chosen for one set of values are kept for
 * the next ones while they are good. doc/numerics.md, section 6. Tested by tests/solver/test_linear.c. */
#ifndef SPARSE_FACTORS_H
#define SPARSE_FACTORS_H

#include <stdint.h>

#include "base/status.h"

struct sparse_factors;

/* A square matrix in compressed columns, as in base/sparse.h. The arrays belong to the caller. */
struct sparse_columns {
    int n;
    unsigned version; /* of the pattern: another one is analysed again; not 0 */
    int64_t *start;   /* (n + 1) */
    int64_t *row;     /* (start[n]) */
    double *value;    /* (start[n]) */
};

/* How often, so far. */
struct sparse_factors_counts {
    long analyses;         /* of patterns */
    long factorisations;   /* with new pivots */
    long refactorisations; /* with the pivots of the last factorisation */
};

/* Factors of no matrix yet. Fails with STATUS_MEMORY; sparse_factors_free accepts NULL. */
enum status sparse_factors_create(struct sparse_factors **factors);
void sparse_factors_free(struct sparse_factors *factors);

/* Factorise. Fails with STATUS_MEMORY, or with STATUS_SOLVER if the matrix is singular; without a message. */
enum status sparse_factors_set_up(struct sparse_factors *factors, const struct sparse_columns *matrix);

/* x (n) becomes the solution for the right-hand side x. After a set-up that has not failed. */
void sparse_factors_solve(struct sparse_factors *factors, double *x);

struct sparse_factors_counts sparse_factors_count(const struct sparse_factors *factors);

#endif
