/* corotation.h: vector fields on the bodies (forces, velocities, accelerations of the nodes) mapped between a reference
 * configuration and the current one. doc/numerics.md, section 3. Tested by tests/solver/test_corotation.c.
 *
 * An old Jacobian belongs to the reference configuration: the bodies as they were when it was evaluated. They have
 * turned and bent since, but relative to the directions of the edges the Jacobian still holds: stretching is stiff
 * along an edge wherever that points. So a residual is mapped to the reference configuration, the system with the old
 * matrix is solved, and the solution is mapped to the current configuration. The map of one fish, from reference to
 * current,
 *
 *     T = H P:   P rotates the vector of each node by the mean rotation of its two edges,
 *                H is the smallest rotation that maps rigid motions of the reference body to those of the current body,
 *
 * is orthogonal in the inner product weighted with the masses of the nodes. The same T therefore maps velocities and
 * forces per mass, and it preserves net force and moment: an elastic force of the old matrix has neither, nor has
 * its image. For a fish with prescribed nodes T is P alone: its rigid motion is given. */
#ifndef COROTATION_H
#define COROTATION_H

#include "base/status.h"
#include "fish/fish.h"

struct corotation;

/* Create the maps of a school, which must outlive them. Fails with STATUS_MEMORY. corotation_free accepts NULL. */
enum status corotation_create(struct corotation **corotation, const struct school *school);
void corotation_free(struct corotation *corotation);

/* Take the reference and the current configuration from the positions in y (n_unknowns). After corotation_set_reference
 * both are the same: every map is the identity. */
void corotation_set_reference(struct corotation *corotation, const double *y);
void corotation_set_current(struct corotation *corotation, const double *y);

/* Map the slices x y, vx vy, px py and ax ay of all fish, in a vector of unknowns or of residuals (n_unknowns), from
 * the reference to the current configuration, and back. Each is the inverse of the other. */
void corotation_to_current(const struct corotation *corotation, double *vector);
void corotation_to_reference(const struct corotation *corotation, double *vector);

#endif
