/* ode_rhs.h: the algebraic unknowns one after another by direct linear solves, with no iteration: what an explicit method
 * does at each of its evaluations. doc/model.md, section 10. Tested by tests/solver/test_ode_rhs.c.
 *
 * Positions and velocities given, each step needs only the ones before:
 *
 *     bound sheets (and, with kutta: edge, the circulation shed) -> velocity of the fluid -> phi0 -> accelerations
 *     dense in the school, KLU with one symbolic analysis                                     banded, fish by fish
 */
#ifndef ODE_RHS_H
#define ODE_RHS_H

#include "base/status.h"
#include "model/residual.h"

struct ode_rhs;

/* The residual must outlive it. Fails with STATUS_MEMORY. ode_rhs_free accepts NULL. */
enum status ode_rhs_create(struct ode_rhs **direct, struct residual *residual);
void ode_rhs_free(struct ode_rhs *direct);

/* Fill the algebraic unknowns of y at time t, bring driven nodes onto their given path, and set the rates yp of the
 * differential unknowns (those of the algebraic ones are 0). Returns STATUS_RETRY where a value is not finite. */
enum status ode_rhs_rates(struct ode_rhs *direct, double t, double *y, double *yp);

/* Linear systems of the sheets solved so far. */
long ode_rhs_solves(const struct ode_rhs *direct);

#endif
