/* direct.h: the algebraic unknowns one after another by direct linear solves, with no iteration: what an explicit method
 * does at each of its evaluations. doc/model.md, section 10. Tested by tests/test_direct.c.
 *
 * Positions and velocities given, each step needs only the ones before:
 *
 *     bound sheets (and, with kutta: edge, the circulation shed) -> velocity of the fluid -> phi0 -> accelerations
 *     dense in the school, KLU with one symbolic analysis                                     banded, fish by fish
 */
#ifndef DIRECT_H
#define DIRECT_H

#include "residual.h"
#include "status.h"

struct direct;

/* The residual must outlive it. Fails with STATUS_MEMORY. direct_free accepts NULL. */
enum status direct_create(struct direct **direct, struct residual *residual);
void direct_free(struct direct *direct);

/* Fill the algebraic unknowns of y at time t, bring driven nodes onto their given path, and set the rates yp of the
 * differential unknowns (those of the algebraic ones are 0). Returns STATUS_RETRY where a value is not finite. */
enum status direct_rates(struct direct *direct, double t, double *y, double *yp);

/* Linear systems of the sheets solved so far. */
long direct_solves(const struct direct *direct);

#endif
