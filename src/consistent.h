/* consistent.h: make a state consistent: the algebraic unknowns from the algebraic equations, by KINSOL, the
 * differential ones being given. doc/model.md, section 10. Tested by tests/test_consistent.c. */
#ifndef CONSISTENT_H
#define CONSISTENT_H

#include "residual.h"
#include "status.h"

struct consistent;

/* The residual must outlive it. Fails with STATUS_MEMORY or STATUS_SOLVER. */
enum status consistent_create(struct consistent **consistent, struct residual *residual);

/* Release it. Accepts NULL. */
void consistent_free(struct consistent *consistent);

/* Solve the algebraic equations for the algebraic unknowns of y, and set the rates yp of the differential ones, at time
 * t. What is algebraic is asked of the residual each time. Fails with STATUS_SOLVER; y and yp are then unchanged. */
enum status consistent_solve(struct consistent *consistent, double t, double *y, double *yp);

/* Newton iterations so far. */
long consistent_iterations(const struct consistent *consistent);

#endif
