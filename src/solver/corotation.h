/* corotation.h: vector fields on the bodies (forces, velocities, accelerations of the nodes) mapped between a reference
 * configuration and the current one. doc/numerics.md, section 3. Tested by tests/solver/test_corotation.c.
 *
 * An old Jacobian belongs to the reference configuration, the configuration of the bodies at the evaluation of the
 * Jacobian. Since then the bodies have turned and bent, but relative to the directions of the edges the Jacobian is
 * still valid: stretching is stiff along an edge in any orientation of the edge. Therefore map a residual to the
 * reference configuration, solve the system with the old matrix, and map the solution to the current configuration. The
 * map of one fish, from reference to current,
 *
 *     T = H P:   P rotates the vector of each node by the mean rotation of its two edges,
 *                H is the smallest rotation that maps rigid motions of the reference body to those of the current body,
 *
 * is orthogonal in the inner product weighted with the masses of the nodes. Therefore the same T maps velocities and
 * forces per mass, and T preserves net force and moment: the elastic forces of the old matrix and their images have
 * zero net force and moment. For a fish with prescribed nodes, T = P: the rigid motion is prescribed. */
#ifndef COROTATION_H
#define COROTATION_H

#include <stdbool.h>

#include "base/arena.h"
#include "fish/fish.h"

struct corotation;

/* Create the maps of a school, which must outlive them. */
struct corotation *corotation_create(struct arena *arena, const struct school *school);

/* Set the reference and the current configuration from the positions in y (n_unknowns). corotation_set_reference sets
 * both, and every map becomes the identity. */
void corotation_set_reference(struct corotation *corotation, const double *y);
void corotation_set_current(struct corotation *corotation, const double *y);

/* Map the slices x y, vx vy, px py and ax ay of all fish in a vector of unknowns or of residuals (n_unknowns) from the
 * reference to the current configuration, or backwards. */
void corotation_map(const struct corotation *corotation, bool backwards, double *vector);

#endif
