/* verlet.h: velocity Verlet, symplectic and of order 2, for rods that feel no force but the elastic one and a load: for
 * comparison. doc/numerics.md, section 4. Tested by tests/solver/test_verlet.c.
 *
 * With steps of h, and accelerations a that depend on places and time only:
 *
 *     v_n+1/2 = v_n + h/2 a(x_n, t_n)     x_n+1 = x_n + h v_n+1/2     v_n+1 = v_n+1/2 + h/2 a(x_n+1, t_n+1)
 *
 * Sheets and wakes are felt by nobody; they are solved for once in an interval, at its end. */
#ifndef VERLET_H
#define VERLET_H

#include "solver/integrator.h"

/* For cases without fluid, damping, prescribed motion and control law (case/case_check.c). The options give the step. A
 * step that is too long for the stiffness is STATUS_SOLVER, with a message that says when. */
extern const struct integrator verlet_integrator;

#endif
