/* fish_factors.h: factorises the diagonal block of one fish. Usually KLU does this alone. With momenta, or for sheets
 * of many points, the block is divided: KLU factorises the rod, which is sparse, and Gaussian elimination the sheet,
 * which is full. doc/numerics.md, section 6. Tested by tests/solver/test_linear.c.
 *
 *              columns:  rod     sheet           A: sparse;  C, D: full, because every bound vortex and every node
 *        rows:  rod    |  A   |    B   |         changes the velocity at every control point;  B: few columns, or full
 *               sheet  |  C   |    D   |
 *                                                S = D - C A^-1 B is factorised as a full matrix
 *
 * KLU alone would also fill A, because the columns of A are as full as C, and for a full matrix it takes several times
 * as long. With momenta the law of motion counts among the rows of the sheet and the positions among its columns, so
 * that A has only two entries in a row. KLU factorises the whole block after all if masked rows leave velocities
 * undetermined, or while A is singular or nearly so. */
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

/* Request the memory for a new pattern of the block. Call it before fish_factors_set_up and outside parallel
 * regions. */
void fish_factors_prepare(struct fish_factors *factors);

/* Factorise the block with its present values; several threads may do so for different fish. */
void fish_factors_set_up(struct fish_factors *factors);

/* The status of the last set-up, without a message. Call it outside parallel regions, because KLU may have run out of
 * memory. A singular block is STATUS_SOLVER at the first factorisation, later STATUS_RETRY. */
enum status fish_factors_status(const struct fish_factors *factors);

/* Replace the right-hand side x (unknowns of the fish) by the solution. Requires a successful set-up. */
void fish_factors_solve(struct fish_factors *factors, double *x);

/* Add the totals of KLU to counts. */
void fish_factors_count(const struct fish_factors *factors, struct klu_counts *counts);

/* Stored entries of the factors of the last set-up, those of KLU and those of the full matrix; 0: there are no
 * factors. */
long fish_factors_non_zeros(const struct fish_factors *factors);

#endif
