/* fish_factors.h: factors of the diagonal block of one fish: by KLU alone, or, with momenta or for sheets of many
 * points, by KLU for the rod and a full matrix for the sheet. doc/numerics.md, section 6. Tested by
 * tests/solver/test_linear.c.
 *
 *              columns:  rod     sheet           A: sparse;  C, D: full, because every bound vortex and every node
 *        rows:  rod    |  A   |    B   |         changes the velocity at every control point;  B: few columns, or full
 *               sheet  |  C   |    D   |
 *                                                S = D - C A^-1 B is factorised as a full matrix
 *
 * KLU alone would also fill A, because the columns of A are as full as C, and KLU takes several times as long for a
 * full matrix. With momenta the law of motion belongs to the rows of the sheet, and the positions belong to the columns
 * of the sheet: A then has two entries in a row. KLU factorises the whole block if masked rows leave velocities
 * undetermined, or while A is singular or nearly singular. */
#ifndef FISH_FACTORS_H
#define FISH_FACTORS_H

#include "base/arena.h"
#include "base/sparse.h"
#include "base/status.h"
#include "fish/fish.h"
#include "solver/sparse_factors.h"

struct fish_factors;

/* Create factors without values. The fish and its block of the Jacobian must outlive the factors. */
struct fish_factors *fish_factors_create(struct arena *arena, const struct fish *fish, const struct sparse *block);

/* Request the memory for a new pattern of the block: before fish_factors_set_up, outside parallel regions. */
void fish_factors_prepare(struct fish_factors *factors);

/* Factorise the block with its present values; threads may factorise several fish. */
void fish_factors_set_up(struct fish_factors *factors);

/* The status of the last set-up, without a message; outside parallel regions, because KLU may have had no memory. A
 * singular block is STATUS_SOLVER at the first factorisation, later STATUS_RETRY. */
enum status fish_factors_status(const struct fish_factors *factors);

/* Replace the right-hand side x (unknowns of the fish) by the solution. Requires a successful set-up. */
void fish_factors_solve(struct fish_factors *factors, double *x);

/* Add the totals of KLU to counts. */
void fish_factors_count(const struct fish_factors *factors, struct klu_counts *counts);

/* Stored entries of the factors of the last set-up: those of KLU, and the full matrix of the sheet; 0: no factors. */
long fish_factors_non_zeros(const struct fish_factors *factors);

// ---- dense_factors.c: factors of a full matrix by Gaussian elimination with row pivoting. Every operation is rounded
// as written: the same bits for any vector width. Tested by tests/solver/test_dense_factors.c.
//
// LAPACK without an optimised BLAS takes five times as long for the orders of one fish, 50 to 200, and the last bits of
// LAPACK depend on the library.

struct dense_factors {
    int n, stride; /* order; distance of columns, a multiple of the rows of a tile */
    double *value; /* by columns: the matrix, later L below the diagonal and U     (n, stride) */
    int *pivot;    /* row that was swapped with each row                           (n) */
};

/* A matrix of zeros of order n. */
struct dense_factors dense_factors_create(struct arena *arena, int n);

/* Replace the matrix by the factors. Returns whether the matrix is regular. */
int dense_factors_set_up(struct dense_factors *factors);

/* Replace the right-hand side x (n) by the solution. */
void dense_factors_solve(const struct dense_factors *factors, double *x);

#endif
