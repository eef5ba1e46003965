/* residual_jacobian.h: the derivatives of the residual. doc/model.md, section 10; doc/numerics.md, section 6. Tested by
 * tests/school/test_residual.c. */
#ifndef RESIDUAL_JACOBIAN_H
#define RESIDUAL_JACOBIAN_H

#include "school/jacobian.h"
#include "school/residual.h"

/* jacobian = dF/dy + cj dF/dyp, with the blocks of the coupled fish; fish in contact couple from now on. Fails with
 * STATUS_MEMORY, and as residual_evaluate where bodies touch. */
enum status residual_jacobian(struct residual *residual, double t, double cj, const double *y,
                              struct jacobian *jacobian);

/* The derivatives of impermeability at the control points of every fish by the circulation that it has shed itself, in
 * the rows of those equations of value (n_unknowns), and with force: pressure those of the law of motion; the others
 * stay as they are. With the flow of the last evaluation, at the unknowns y. They are what changes most from step to
 * step where the nascent stretch of a free sheet grows. */
void residual_by_shed(struct residual *residual, const double *y, double *value);

/* Mask the rows of the Jacobian whose equation is a given motion, and no others. */
void residual_mask(const struct residual *residual, struct jacobian *jacobian);

#endif
