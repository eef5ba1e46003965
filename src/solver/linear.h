/* linear.h: solves linear systems with the Jacobian of the school. By default it treats the fish one by one: the
 * diagonal block of each is factorised (fish_factors.h), and GMRES, preconditioned with these factors, accounts for the
 * fish that are coupled. With solver.linear: klu the blocks and the couplings become one sparse matrix, which KLU
 * factorises as a whole. doc/numerics.md, section 6. Tested by tests/solver/test_linear.c.
 *
 *     linear_setup after each new Jacobian -> linear_solve, linear_update_shed, linear_solve, ... */
#ifndef LINEAR_H
#define LINEAR_H

#include "base/status.h"
#include "school/jacobian.h"
#include "solver/fish_factors.h"
#include "solver/sundials.h"

struct linear;

/* Totals so far. */
struct linear_counts {
    struct klu_counts klu;   /* over all fish */
    long solves, iterations; /* iterations: of GMRES */
    /* at the last set-up, 0 before it: entries of the Jacobian with its couplings, and of all factors */
    long jacobian_non_zeros, factor_non_zeros;
};

/* When GMRES stops. Its norm is the root mean square of the preconditioned residual over all unknowns, each in units of
 * its scale; it is close to the error of the solution. */
struct linear_tolerance {
    double relative; /* norm as a fraction of the initial norm */
    double absolute; /* norm; GMRES stops at the larger one */
};

/* Create a solver for a Jacobian, which must outlive it; scale (n_unknowns) is copied. */
struct linear *linear_create(struct arena *arena, const struct jacobian *jacobian, const double *scale,
                             struct linear_tolerance tolerance);

/* Factorise the diagonal blocks, or the whole matrix, with their present values. A singular matrix fails with
 * STATUS_SOLVER at the first factorisation, later with STATUS_RETRY. */
enum status linear_setup(struct linear *linear);

/* Replace, until the next linear_setup, the derivatives by the circulation that the same fish sheds: those of
 * impermeability and, with force: pressure, of the law of motion. value (n_unknowns) holds the new ones in the rows of
 * these equations. The factors stay; a matrix of rank one for each fish corrects the solutions (Sherman and Morrison;
 * for the whole matrix Woodbury). If the corrected matrix is singular, the solutions are not finite. Requires
 * linear_setup. */
void linear_update_shed(struct linear *linear, const double *value);

/* Solve J x = b. Both arrays are (n_unknowns) and may be identical. Fails with STATUS_RETRY if x is not finite. */
enum status linear_solve(struct linear *linear, const double *b, double *x);

struct linear_counts linear_count(const struct linear *linear);

/* The same solver dressed as a matrix and a linear solver of SUNDIALS, for IDA and KINSOL. Tested by
 * tests/solver/test_initial_conditions.c and tests/solver/test_ida.c. */
struct linear_sundials {
    struct linear *linear;
    SUNMatrix matrix; /* empty: the callback for the Jacobian fills a struct jacobian instead */
    SUNLinearSolver solver;
};

/* Create the solver for a Jacobian; scale and tolerance as in linear_create. The solver declares itself as direct, so
 * IDA scales the solutions if the step has changed since the evaluation of the Jacobian. context->failure receives the
 * status of each set-up and each solution. The arena of the context owns the solver; the Jacobian must outlive it. */
struct linear_sundials linear_sundials_create(struct sundials_context *context, const struct jacobian *jacobian,
                                              const double *scale, struct linear_tolerance tolerance);

#endif
