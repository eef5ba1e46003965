/* corotation.h: keeps an old Jacobian useful while the bodies move, by mapping vectors (forces, velocities,
 * accelerations of the nodes) between the configuration at its evaluation and the current one. doc/numerics.md, section
 * 3. Tested by tests/solver/test_corotation.c.
 *
 * An old Jacobian belongs to the reference configuration, that is to the bodies as they were when it was evaluated.
 * Since then they have turned and bent, but seen from the edges the Jacobian is still right: stretching, for example,
 * is stiff along an edge wherever the edge points. We therefore map a residual to the reference configuration, solve
 * the system with the old matrix there, and map the solution to the current configuration. The map of one fish, from
 * reference to current, is
 *
 *     T = H P:   P rotates the vector of each node by the mean rotation of its two edges,
 *                H is the smallest rotation that maps rigid motions of the reference body to those of the current body.
 *
 * T is orthogonal in the inner product that weights nodes with their masses. The same T therefore maps velocities and
 * forces per mass, and it preserves net force and moment: the elastic forces of the old matrix have none, and neither
 * have their images. If some nodes of a fish are prescribed, its rigid motion is known and T = P. */
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
