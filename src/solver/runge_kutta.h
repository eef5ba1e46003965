/* runge_kutta.h: explicit Runge-Kutta methods by ARKStep of ARKODE on the same equations, for comparison: the algebraic
 * unknowns are solved for directly at every evaluation (ode_rhs.h). doc/numerics.md. Tested by tests/solver/test_runge_kutta.c. */
#ifndef RUNGE_KUTTA_H
#define RUNGE_KUTTA_H

#include "solver/integrator.h"

/* The method and its step are those of the options. A solution that grows beyond all numbers, or steps that vanish, end
 * in STATUS_SOLVER with a message that says "unstable" and the time. */
extern const struct integrator runge_kutta_integrator;

#endif
