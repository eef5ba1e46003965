/* ida_newton.h: Newton's iteration for IDA. It differs from the one in SUNDIALS in that a single Jacobian serves many
 * steps: the bodies may have moved on since its evaluation (corotation.h), and a new one is evaluated only when the
 * extra iterations cost more. doc/numerics.md, section 3. Tested by tests/solver/test_ida_newton.c. */
#ifndef IDA_NEWTON_H
#define IDA_NEWTON_H

#include <stdbool.h>

#include "solver/corotation.h"
#include "solver/sundials.h"
#include "solver/trace.h"

/* When an iteration ends, and when the Jacobian is evaluated again. */
struct ida_newton_rules {
    int max_iterations; /* in one solution with an old Jacobian */
    /* in one solution with a new Jacobian. This allows more, because a smaller step would not make up for couplings of
     * distant fish that the Jacobian lacks. */
    int max_with_new;
    int jacobian_cost; /* of evaluation and factorisation, in units of iterations */
    /* 1 for differential unknowns, 0 for algebraic ones; outlives the solver. If given, the norm of the differential
     * unknowns has to converge as well as the norm of all unknowns; NULL: only the latter. */
    N_Vector kinds;
    /* whether the total corrections recur with a period of a few steps, so that the start is extrapolated from one
     * period before; else the start is the last correction */
    bool is_periodic;
    void *data; /* argument of the functions below */
    /* d(dy/dt)/dy in IDA's present step, s-1; while it is constant, corrections hardly change */
    double (*leading_coefficient)(void *data);
    /* improve an old Jacobian at low cost after an evaluation of the residual; NULL: leave it */
    void (*update)(void *data);
    /* called if a new Jacobian needs more than max_iterations, to make it more complete; returns whether the next one
     * will be. NULL: it is complete already */
    int (*complete)(void *data);
    /* For the trace. `attempt` is called at the start of each solution and returns where to record its corrections
     * (NULL: do not record them); `attempted` is called with the result at the end of a recorded solution. Both NULL:
     * record none. */
    struct trace_attempt *(*attempt)(void *data);
    void (*attempted)(void *data, int code);
};

/* Create a solver for IDASetNonlinearSolver. The arena of the context owns the solver; the school must outlive it. */
SUNNonlinearSolver ida_newton_create(struct sundials_context *context, const struct school *school,
                                     struct ida_newton_rules rules);

#endif
