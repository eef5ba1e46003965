/* linear.h: linear systems with the Jacobian of the school. Every fish's own block is factorised by KLU; fish that are
 * coupled are solved for together by GMRES with these factors as preconditioner. doc/numerics.md, section 7. Tested by
 * tests/solver/test_linear.c.
 *
 *     linear_setup after every new Jacobian -> linear_solve, linear_solve, ... */
#ifndef LINEAR_H
#define LINEAR_H

#include "base/status.h"
#include "model/jacobian.h"

struct linear;

/* What it has done so far. */
struct linear_counts {
    long analyses;       /* of patterns, over all fish */
    long factorisations; /* with pivots chosen anew */
    long refactorisations;
    long solves, iterations; /* iterations: of GMRES */
};

/* When GMRES ends. The norm of what it leaves of the right-hand side, through the preconditioner, is the root mean square
 * over all unknowns, each in units of its scale; what it leaves is near the error of the solution. */
struct linear_end {
    double relative; /* this part of what it began with */
    double enough;   /* or this norm, whichever is the larger */
};

/* A solver for a Jacobian that must outlive it; scale (n_unknowns) is copied. Fails with STATUS_MEMORY; linear_free
 * accepts NULL. */
enum status linear_create(struct linear **linear, const struct jacobian *jacobian, const double *scale,
                          struct linear_end end);
void linear_free(struct linear *linear);

/* Factorise the blocks as they are now. A block that is singular: STATUS_SOLVER where it has never been factorised,
 * STATUS_RETRY later. Fails with STATUS_MEMORY. */
enum status linear_setup(struct linear *linear);

/* Solve for x; both arrays (n_unknowns), and may be the same. Fails with STATUS_RETRY where x is not finite. */
enum status linear_solve(struct linear *linear, const double *b, double *x);

struct linear_counts linear_count(const struct linear *linear);

#endif
