/* sparse_factors.h: factorises a sparse matrix by KLU. It keeps the analysis of a pattern, and the pivots for as long
 * as they are good. doc/numerics.md, section 6. Tested by tests/solver/test_linear.c. */
#ifndef SPARSE_FACTORS_H
#define SPARSE_FACTORS_H

#include <stdbool.h>
#include <stdint.h>

#include "base/arena.h"

/* If pivots grow by more than the inverse of this, a solution has too few digits for Newton's iteration. */
#define SPARSE_MIN_GROWTH 1e-6

/* A square matrix in compressed columns, as in base/sparse.h. */
struct sparse_columns {
    int n;
    unsigned version; /* of the pattern, not 0; a pattern with a new version is analysed again */
    int64_t *start;   /* (n + 1) */
    int64_t *row;     /* (start[n]) */
    double *value;    /* (start[n]) */
};

/* Totals of KLU so far. */
struct klu_counts {
    long analyses;         /* of sparsity patterns */
    long factorisations;   /* with new pivots */
    long refactorisations; /* with the pivots of the last factorisation */
};

struct sparse_factors;

/* Create factors without values; the arena frees what KLU allocates. */
struct sparse_factors *sparse_factors_create(struct arena *arena);

/* Factorise a matrix, with the last pivots if these are good. Returns whether the matrix is regular; the answer is also
 * false if KLU has run out of memory. */
bool sparse_factors_set_up(struct sparse_factors *factors, const struct sparse_columns *matrix);

/* Whether KLU ran out of memory in the last set-up. */
bool sparse_factors_lack_memory(const struct sparse_factors *factors);

/* Discard the pivots, so that the next set-up chooses new ones. */
void sparse_factors_forget(struct sparse_factors *factors);

/* Replace the right-hand sides x (n_sides, n), one after the other, by the solutions. Requires a successful set-up. */
void sparse_factors_solve(struct sparse_factors *factors, int n_sides, double *x);

/* Add the totals of KLU to counts. */
void sparse_factors_count(const struct sparse_factors *factors, struct klu_counts *counts);

/* Entries of the factors of the last set-up; 0: none. */
long sparse_factors_non_zeros(const struct sparse_factors *factors);

#endif
