/* newton.h: Newton's iteration for IDA, with a Jacobian that serves many steps. doc/numerics.md, section 3. Tested by
 * tests/test_newton.c. */
#ifndef NEWTON_H
#define NEWTON_H

#include <sundials/sundials_nonlinearsolver.h>

#include "carry.h"
#include "status.h"

/* When an iteration ends, and when a Jacobian does. */
struct newton_rules {
    int most_iterations; /* of one solution */
    int jacobian_cost;   /* of a Jacobian and its factors, in iterations */
    /* d(dy/dt)/dy of IDA's present step, s-1: while it stays the same, so does nearly the correction */
    double (*leading_coefficient)(void *ida);
};

/* A solver for IDASetNonlinearSolver, to be freed by SUNNonlinSolFree. It holds the unknowns of the school, which must
 * outlive it. Fails with STATUS_MEMORY. */
enum status newton_create(SUNNonlinearSolver *solver, SUNContext context, N_Vector like, const struct school *school,
                          struct newton_rules rules);

#endif
