/* sundials_linear.h: the Jacobian of the school and its linear solver (linear.h), as IDA and KINSOL take them. Tested
 * by tests/solver/test_initial_conditions.c and tests/solver/test_ida.c. */
#ifndef SUNDIALS_LINEAR_H
#define SUNDIALS_LINEAR_H

#include "base/status.h"
#include "school/jacobian.h"
#include "solver/linear.h"
#include "solver/sundials.h"

struct sundials_linear {
    struct linear *linear;
    enum status *failure; /* the status of the last callback; belongs to the owner */
    SUNMatrix matrix;     /* empty: the callback for the Jacobian fills ours */
    SUNLinearSolver solver;
};

/* Create the solver for a Jacobian, which must outlive it; scale and tolerance as in linear_create. It declares itself
 * a direct solver, so that IDA scales its solutions when the step has changed since the Jacobian was evaluated.
 * *failure, which must outlive it too, receives the status of each set-up and each solution. The solver must stay where
 * it is. Fails with STATUS_MEMORY; there is nothing to free then. sundials_linear_free accepts a structure of zeros. */
enum status sundials_linear_create(struct sundials_linear *linear, SUNContext context, const struct jacobian *jacobian,
                                   const double *scale, struct linear_tolerance tolerance, enum status *failure);
void sundials_linear_free(struct sundials_linear *linear);

#endif
