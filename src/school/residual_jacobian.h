/* residual_jacobian.h: the derivatives of the residual. doc/model.md, section 10; doc/numerics.md, section 6. Tested by
 * tests/school/test_residual.c. */
#ifndef RESIDUAL_JACOBIAN_H
#define RESIDUAL_JACOBIAN_H

#include "school/jacobian.h"
#include "school/residual.h"

/* jacobian = dF/dy + cj dF/dyp, with the blocks of the coupled fish; fish in contact couple from this call on. Fails
 * with STATUS_MEMORY, and as residual_evaluate if bodies touch. */
enum status residual_jacobian(struct residual *residual, double t, double cj, const double *y,
                              struct jacobian *jacobian);

/* Set the derivatives of impermeability at the control points of every fish by the circulation shed by the same fish,
 * in the impermeability rows of value (n_unknowns); with force: pressure also the derivatives of the equation of
 * motion. All other rows are unchanged. Uses the flow of the last evaluation, at the unknowns y. While the nascent
 * stretch of a free sheet grows, these derivatives change more from step to step than all others. */
void residual_by_shed(struct residual *residual, const double *y, double *value);

/* Mask the rows of prescribed motion in the Jacobian, and unmask all other rows. */
void residual_mask(const struct residual *residual, struct jacobian *jacobian);

#endif
