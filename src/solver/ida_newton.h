/* ida_newton.h: Newton's iteration for IDA, with a Jacobian that serves many steps. doc/numerics.md, section 3. Tested
 * by tests/solver/test_ida_newton.c. */
#ifndef IDA_NEWTON_H
#define IDA_NEWTON_H

#include "solver/corotation.h"
#include "solver/sundials.h"
#include "solver/trace.h"

/* End of an iteration, and re-evaluation of the Jacobian. */
struct ida_newton_rules {
    int max_iterations; /* per solution with an old Jacobian */
    /* per solution with a Jacobian of this solution: a smaller step does not replace missing couplings of far fish */
    int max_with_new;
    int jacobian_cost; /* evaluation and factorisation, in units of iterations */
    /* 1 for differential unknowns, 0 for algebraic unknowns; outlives the solver. With kinds, the norm of the
     * differential unknowns must converge as well as the norm of all unknowns; NULL: only the latter. */
    N_Vector kinds;
    /* whether total corrections have the period of an interval between events; else the start is the last one */
    int is_periodic;
    void *data; /* argument of the functions below */
    /* d(dy/dt)/dy of IDA's present step, s-1: while it is constant, corrections hardly change */
    double (*leading_coefficient)(void *data);
    /* update an old Jacobian at low cost after an evaluation of the residual; NULL: no update */
    void (*update)(void *data);
    /* complete the Jacobian if a new Jacobian needs more than max_iterations; returns whether the next evaluation is
     * more complete. NULL: the Jacobian is complete */
    int (*complete)(void *data);
    /* called at the start of each solution: where to record its corrections, or NULL: nobody wants to know them; then
     * at the end of a recorded solution with its result. Both NULL: no solution is recorded */
    struct trace_attempt *(*attempt)(void *data);
    void (*attempted)(void *data, int code);
};

/* Create a solver for IDASetNonlinearSolver. The arena of the context owns the solver; the school must outlive it. */
SUNNonlinearSolver ida_newton_create(struct sundials_context *context, const struct school *school,
                                     struct ida_newton_rules rules);

#endif
