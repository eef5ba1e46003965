/* runge_kutta.h: explicit Runge-Kutta methods by ARKStep of ARKODE, for comparison. They see the equations as an
 * ordinary differential equation (ode_rhs.h). doc/numerics.md. Tested by tests/solver/test_runge_kutta.c. */
#ifndef RUNGE_KUTTA_H
#define RUNGE_KUTTA_H

#include "solver/integrator.h"

/* The options select the method and its step. A solution that overflows, and steps below the minimum, are STATUS_SOLVER
 * with a message that says "unstable" and the time. */
extern const struct integrator runge_kutta_integrator;

#endif
