/* initial_conditions.h: make a state consistent: the algebraic unknowns from the algebraic equations, by KINSOL, the
 * differential ones being given. doc/model.md, section 10. Tested by tests/solver/test_initial_conditions.c. */
#ifndef INITIAL_CONDITIONS_H
#define INITIAL_CONDITIONS_H

#include "base/status.h"
#include "model/residual.h"

struct initial_conditions;

/* The residual must outlive it. Fails with STATUS_MEMORY or STATUS_SOLVER. */
enum status initial_conditions_create(struct initial_conditions **consistent, struct residual *residual);

/* Release it. Accepts NULL. */
void initial_conditions_free(struct initial_conditions *consistent);

/* Solve the algebraic equations for the algebraic unknowns of y, and set the rates yp of the differential ones, at time
 * t. What is algebraic is asked of the residual each time. Fails with STATUS_SOLVER; y and yp are then unchanged. */
enum status initial_conditions_solve(struct initial_conditions *consistent, double t, double *y, double *yp);

/* Newton iterations so far. */
long initial_conditions_iterations(const struct initial_conditions *consistent);

#endif
