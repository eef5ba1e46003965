/* ida_newton.h: Newton's iteration for IDA, with a Jacobian that serves many steps. doc/numerics.md, section 3. Tested by
 * tests/solver/test_ida_newton.c. */
#ifndef IDA_NEWTON_H
#define IDA_NEWTON_H

#include <sundials/sundials_nonlinearsolver.h>

#include "base/status.h"
#include "solver/corotation.h"

/* When an iteration ends, and when a Jacobian does. */
struct ida_newton_rules {
    int most_iterations; /* of one solution */
    int jacobian_cost;   /* of a Jacobian and its factors, in iterations */
    /* d(dy/dt)/dy of IDA's present step, s-1: while it stays the same, so does nearly the correction */
    double (*leading_coefficient)(void *ida);
};

/* A solver for IDASetNonlinearSolver, to be freed by SUNNonlinSolFree. It holds the unknowns of the school, which must
 * outlive it. Fails with STATUS_MEMORY. */
enum status ida_newton_create(SUNNonlinearSolver *solver, SUNContext context, N_Vector like,
                              const struct school *school, struct ida_newton_rules rules);

#endif
