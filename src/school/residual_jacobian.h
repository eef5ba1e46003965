/* residual_jacobian.h: the derivatives of the residual. doc/numerics.md, section 6. */
#ifndef RESIDUAL_JACOBIAN_H
#define RESIDUAL_JACOBIAN_H

#include "school/jacobian.h"
#include "school/residual.h"

/* Set jacobian = dF/dy + cj dF/dyp, with the blocks of the coupled fish; fish in contact couple from this call on.
 * Fails as residual_evaluate does if bodies touch. */
enum status residual_jacobian(struct residual *residual, const struct residual_mode *mode, double t, double cj,
                              const double *y, struct jacobian *jacobian);

/* Set how the equations of every fish depend on the circulation that the same fish sheds: in the rows of value
 * (n_unknowns) for impermeability and, where the sheet loads the body, for the equation of motion. All other rows are
 * unchanged. Uses the flow of the last evaluation, at the unknowns y. While the nascent stretch of a free sheet grows,
 * these derivatives change more from step to step than all others. */
void residual_by_shed(struct residual *residual, const double *y, double *value);

/* Mask the rows of prescribed motion in the Jacobian, and unmask all other rows. */
void residual_mask(const struct residual *residual, struct jacobian *jacobian);

#endif
