/* explicit.h: explicit Runge-Kutta methods by ARKStep of ARKODE on the same equations, for comparison: the algebraic
 * unknowns are solved for directly at every evaluation (direct.h). doc/numerics.md. Tested by tests/test_explicit.c. */
#ifndef EXPLICIT_H
#define EXPLICIT_H

#include "integrator.h"

/* The method and its step are those of the options. A solution that grows beyond all numbers, or steps that vanish, end
 * in STATUS_SOLVER with a message that says "unstable" and the time. */
extern const struct integrator explicit_runge_kutta;

#endif
