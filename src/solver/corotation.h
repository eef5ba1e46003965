/* corotation.h: fields of vectors on the bodies (forces, velocities, accelerations of the nodes), carried from where the bodies
 * were to where they are. doc/numerics.md, section 3. Tested by tests/solver/test_corotation.c.
 *
 * An old Jacobian is that of bodies that have turned and bent since. In the directions of their own edges it still holds:
 * stretching is stiff along an edge wherever that points. So a residual is carried back to where the bodies were, the
 * system with the old matrix is solved, and the solution is carried forth. The map of one fish,
 *
 *     T = H P:   P turns the vector of each node by the mean of what its two edges have turned since,
 *                H is the smallest rotation that makes rigid motions of the body as it was those of the body as it is,
 *
 * is orthogonal in the inner product weighted with the masses of the nodes. The same T therefore carries velocities and
 * forces per mass, and it keeps net force and moment: an elastic force of the old matrix has none, nor has the carried one.
 * A fish with driven nodes is left alone: its rigid motion is given. */
#ifndef COROTATION_H
#define COROTATION_H

#include "base/status.h"
#include "model/fish.h"

struct corotation;

/* The school must outlive it. Fails with STATUS_MEMORY; corotation_free accepts NULL. */
enum status corotation_create(struct corotation **corotation, const struct school *school);
void corotation_free(struct corotation *corotation);

/* Where the bodies were, and where they are, from the positions in y (n_unknowns). After corotation_set_reference they are where they
 * were, and all is left as it is. */
void corotation_set_reference(struct corotation *corotation, const double *y);
void corotation_set_current(struct corotation *corotation, const double *y);

/* Carry the slices x y, vx vy and ax ay of all fish in a vector like y, or in one of residuals: from where the bodies
 * were to where they are, and back. Each undoes the other. */
void corotation_to_current(const struct corotation *corotation, double *vector);
void corotation_to_reference(const struct corotation *corotation, double *vector);

#endif
