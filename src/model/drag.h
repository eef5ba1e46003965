/* drag.h: the forces of the fluid on the body: drag and added mass of every edge at its midpoint. doc/model.md, section
 * 9. Tested by tests/model/test_drag.c. */
#ifndef DRAG_H
#define DRAG_H

#include "base/sparse.h"
#include "model/fish.h"
#include "model/flow.h"

/* Take drag and the force of the added mass off the rows ax, ay of the residual [N]; u, v is the fluid's velocity at
 * the fish's points. */
void drag_residual(const struct fish *fish, const double *u, const double *v, const double *y, double *residual);

/* Add the derivatives of drag_residual, each row divided by its node's mass: what depends on the body itself. */
void drag_jacobian(const struct fish *fish, const double *u, const double *v, const double *y, struct sparse *jacobian);

/* Add those that come through the fluid's velocity. */
void drag_flow_jacobian(const struct fish *fish, const double *u, const double *v, const struct influence_block *block,
                        const double *y, struct coupling_block *rows);

/* tau: the moment about the centre of mass of the drag that the flow causes, sum (x - x_cm) x (F(v - u) - F(v)), over
 * its scale; dimensionless. */
double drag_moment(const struct fish *fish, const double *u, const double *v, const double *y);

/* Add factor times the derivative of drag_moment to the row phi0: as for the forces in two parts. */
void drag_moment_jacobian(const struct fish *fish, double factor, const double *u, const double *v, const double *y,
                          struct sparse *jacobian);
void drag_moment_flow_jacobian(const struct fish *fish, double factor, const double *u, const double *v,
                               const struct influence_block *block, const double *y, struct coupling_block *rows);

/* Powers of drag and added mass on the body, W: negative where they slow it. */
double drag_power(const struct fish *fish, const double *u, const double *v, const double *y);
double drag_added_mass_power(const struct fish *fish, const double *y);

#endif
