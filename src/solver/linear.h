/* linear.h: linear systems with the Jacobian of the school. The diagonal block of each fish is factorised
 * (fish_factors.h); GMRES, preconditioned with these factors, solves for fish that are coupled. doc/numerics.md,
 * section 6. Tested by tests/solver/test_linear.c.
 *
 *     linear_setup after each new Jacobian -> linear_solve, linear_update_shed, linear_solve, ... */
#ifndef LINEAR_H
#define LINEAR_H

#include "base/status.h"
#include "school/jacobian.h"

struct linear;

/* Totals so far. */
struct linear_counts {
    long analyses;           /* of sparsity patterns, over all fish */
    long factorisations;     /* with new pivots */
    long refactorisations;   /* with the pivots of the last factorisation */
    long solves, iterations; /* iterations: of GMRES */
};

/* When GMRES has converged. The norm of the preconditioned residual is the root mean square over all unknowns, each in
 * units of its scale; it is close to the error of the solution. */
struct linear_tolerance {
    double relative; /* norm, as a fraction of the initial one */
    double absolute; /* norm; the larger of both counts */
};

/* Create a solver for a Jacobian, which must outlive it; scale (n_unknowns) is copied. Fails with STATUS_MEMORY.
 * linear_free accepts NULL. */
enum status linear_create(struct linear **linear, const struct jacobian *jacobian, const double *scale,
                          struct linear_tolerance tolerance);
void linear_free(struct linear *linear);

/* Factorise the diagonal blocks with their present values. Fails with STATUS_MEMORY, and for a singular block with
 * STATUS_SOLVER if it has never been factorised, else with STATUS_RETRY. */
enum status linear_setup(struct linear *linear);

/* From now on, until the next linear_setup, solve with other derivatives of impermeability, and with force: pressure of
 * the law of motion, by the circulation that the same fish has shed: those in the rows of these equations of value
 * (n_unknowns). The factors stay: the solutions are
 * corrected by a matrix of rank one for each fish (Sherman and Morrison). Where that matrix is singular, they are not
 * finite. After linear_setup. */
void linear_update_shed(struct linear *linear, const double *value);

/* Solve J x = b. Both arrays are (n_unknowns) and may be the same one. Fails with STATUS_RETRY if x is not finite, or
 * with STATUS_MEMORY. */
enum status linear_solve(struct linear *linear, const double *b, double *x);

struct linear_counts linear_count(const struct linear *linear);

#endif
