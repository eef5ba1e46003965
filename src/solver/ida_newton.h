/* ida_newton.h: Newton's iteration for IDA, with a Jacobian that is kept for many steps. doc/numerics.md, section 3.
 * Tested by tests/solver/test_ida_newton.c. */
#ifndef IDA_NEWTON_H
#define IDA_NEWTON_H

#include "base/status.h"
#include "solver/corotation.h"
#include "solver/sundials.h"

/* When an iteration ends, and when the Jacobian is re-evaluated. */
struct ida_newton_rules {
    int max_iterations; /* per solution, with an old Jacobian */
    /* with one of this very solution: what it leaves out, far fish, a smaller step does not bring back */
    int max_with_new;
    int jacobian_cost; /* of an evaluation with its factorisation, in iterations */
    /* 1 where an unknown is differential, 0 where it is algebraic; outlives the solver. With it the iteration has
     * converged where the differential unknowns by themselves have too; NULL: where all together have. */
    N_Vector kinds;
    void *data; /* of the functions below */
    /* d(dy/dt)/dy of IDA's present step, s-1: while it is constant, corrections hardly change */
    double (*leading_coefficient)(void *data);
    /* bring an old Jacobian up to date where that is cheap, after an evaluation of the residual; NULL: nothing is */
    void (*update)(void *data);
    /* make the Jacobian more complete, where one that is new needs more iterations than an old one may; returns whether
     * it is from the next evaluation on. NULL: it is complete */
    int (*complete)(void *data);
};

/* Create a solver for IDASetNonlinearSolver; SUNNonlinSolFree releases it. Vectors are those of the school, which must
 * outlive it, and are cloned from like. Fails with STATUS_MEMORY. */
enum status ida_newton_create(SUNNonlinearSolver *solver, SUNContext context, N_Vector like,
                              const struct school *school, struct ida_newton_rules rules);

#endif
