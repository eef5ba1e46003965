/* initial_conditions.h: makes the unknowns consistent, at the start and after every jump. The differential unknowns are
 * given, and KINSOL solves the algebraic equations for the algebraic ones. doc/model.md, section 10. Tested by
 * tests/solver/test_initial_conditions.c. */
#ifndef INITIAL_CONDITIONS_H
#define INITIAL_CONDITIONS_H

#include "base/status.h"
#include "school/residual.h"

struct initial_conditions;

/* Create a solver for a residual, which must outlive it. Fails with STATUS_SOLVER. */
enum status initial_conditions_create(struct arena *arena, struct initial_conditions **solver,
                                      struct residual *residual);

/* Solve for the algebraic unknowns of y at time t [s], and set the rates yp of the differential unknowns; both arrays
 * are (n_unknowns). The mode decides which unknowns are differential. Fails with STATUS_SOLVER, or with STATUS_STOPPED
 * once *residual->stop is not 0; y and yp are then unchanged. */
enum status initial_conditions_solve(struct initial_conditions *solver, const struct residual_mode *mode, double t,
                                     double *y, double *yp);

/* Newton iterations so far. */
long initial_conditions_iterations(const struct initial_conditions *solver);

#endif
