/* fish_factors.h: the factors of the diagonal block of one fish: by KLU alone, or, where the sheet has many points, by
 * KLU for the rod and LAPACK for the sheet. doc/numerics.md, section 6. Tested by tests/solver/test_linear.c.
 *
 *              columns:  rod     sheet           A: sparse;  C, D: full, since every bound vortex and every node moves
 *        rows:  rod    |  A   |    B   |            the fluid at every control point;  B: a few columns, or full
 *               sheet  |  C   |    D   |
 *                                                  S = D - C A^-1 B is factorised by LAPACK
 *
 * KLU alone would fill A too, whose columns are as full as C, and a full matrix costs it several times what it costs
 * LAPACK. With momenta the law of motion is a part of the sheet's rows, and the places of its columns; where rows that
 * are masked then leave velocities open, and wherever A is singular or nearly so, KLU factorises the whole block.
 */
#ifndef FISH_FACTORS_H
#define FISH_FACTORS_H

#include "base/sparse.h"
#include "base/status.h"
#include "fish/fish.h"
#include "solver/sparse_factors.h"

struct fish_factors;

/* Factors of no values yet. The fish and its block of the Jacobian must outlive them. Fails with STATUS_MEMORY;
 * fish_factors_free accepts NULL. */
enum status fish_factors_create(struct fish_factors **factors, const struct fish *fish, const struct sparse *block);
void fish_factors_free(struct fish_factors *factors);

/* Factorise the block with its present values. Fails with STATUS_MEMORY; a singular block with STATUS_SOLVER if none
 * has been factorised before, else with STATUS_RETRY; without a message, since fish are factorised side by side. */
enum status fish_factors_set_up(struct fish_factors *factors);

/* x (unknowns of the fish) becomes the solution for the right-hand side x. After a set-up that has not failed. */
void fish_factors_solve(struct fish_factors *factors, double *x);

/* Of the factors by KLU. */
struct sparse_factors_counts fish_factors_count(const struct fish_factors *factors);

#endif
