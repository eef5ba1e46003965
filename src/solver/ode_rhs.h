/* ode_rhs.h: the same equations as an ordinary differential equation dy/dt = f(t, y), which explicit methods need.
 * Every evaluation solves for the algebraic unknowns one group after the other, without iteration. doc/model.md,
 * section 10. Tested by tests/solver/test_ode_rhs.c.
 *
 * Given positions and velocities, the sequence is
 *
 *     bound sheets (and, with kutta: edge, the circulation shed) -> velocity of the fluid -> phi0 -> accelerations
 *     dense in the school                                                                     banded, fish by fish
 *
 * With force: pressure, momenta are given instead of velocities, and the velocities follow together with the sheets. */
#ifndef ODE_RHS_H
#define ODE_RHS_H

#include "base/arena.h"
#include "base/status.h"
#include "school/residual.h"

struct ode_rhs;

/* Create the right-hand side for a residual, which must outlive it. */
struct ode_rhs *ode_rhs_create(struct arena *arena, struct residual *residual);

/* Compute the algebraic unknowns of y at time t [s], set prescribed nodes to their paths, and set the rates yp of the
 * differential unknowns; rates of algebraic unknowns become 0. Both arrays are (n_unknowns). Fails with STATUS_RETRY if
 * a value is not finite, a body is torn or a system has no solution. */
enum status ode_rhs_rates(struct ode_rhs *rhs, double t, double *y, double *yp);

#endif
