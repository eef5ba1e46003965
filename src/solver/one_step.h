/* one_step.h: implicit one-step methods of fixed step, for comparison: implicit Euler, trapezoidal rule.
 * doc/numerics.md. Tested by tests/solver/test_one_step.c.
 *
 * With steps of h from y_n to y_n+1 the equations F(t, y, y') = 0 hold at the end of each step, with
 *
 *     implicit Euler      y'_n+1 = (y_n+1 - y_n) / h
 *     trapezoid           y'_n+1 = 2 (y_n+1 - y_n) / h - y'_n
 *
 * Newton's iteration finds y_n+1, with the Jacobian dF/dy + cj dF/dy', cj = 1/h or 2/h. */
#ifndef ONE_STEP_H
#define ONE_STEP_H

#include "solver/integrator.h"

/* The options select the method and its step. An iteration that does not converge is STATUS_SOLVER, with a message that
 * says when. */
extern const struct integrator one_step_integrator;

#endif
