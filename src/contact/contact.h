/* contact.h: pushes bodies apart, from each other and from walls, once the gap is below contact.range. doc/model.md,
 * section 16. Tested by tests/contact/test_contact.c.
 *
 * Every edge of a body is a straight strip of constant thickness (fish_distance). The potential of two edges is the
 * mean of four point-edge potentials, one for each end of either edge above the other edge.
 *
 *          edge i of fish f     a ============= b          of point p above edge j: the distance to the nearest point,
 *                                     | gap                minus half of both thicknesses
 *                                     p ============= .
 *                                       edge j of fish g */
#ifndef CONTACT_H
#define CONTACT_H

#include "base/arena.h"
#include "base/status.h"
#include "flow/flow_derivative.h"
#include "state/state.h"

struct contact;

struct contact *contact_create(struct arena *arena, const struct school *school);

/* Find the bodies in contact at the positions in y; none unless contact.action is repel. Fails with STATUS_RETRY if two
 * bodies (not both prescribed) touch or cross at y, or on the straight paths to y from the end of the last step of the
 * integrator, or if a body touches a wall. */
enum status contact_find(struct contact *contact, const struct state *state, double t, const double *y);

/* The partners of fish f, in contact at the last contact_find: return the number, and set *other to the fish numbers in
 * ascending order. */
int contact_partners(const struct contact *contact, int f, const int **other);

/* Subtract the forces of all partners, and of the walls, on fish f from the rows ax, ay of fish f in value, N. */
void contact_residual(const struct contact *contact, int f, const double *y, double *value);

/* Add the derivatives of contact_residual by the positions of fish g, divided by the node masses, to rows; g is f or a
 * partner of f. */
void contact_jacobian(const struct contact *contact, int f, int g, const double *y, struct coupling_block *rows);

/* The sums over the contacts of a fish. */
struct contact_terms {
    double energy; /* half the energy of the contacts with partners, plus the full energy of the contacts with walls, J;
                        the sum over all fish is the potential */
    double power;  /* received for this share of the energy, W: half of the sum over partners of the power of the
                        contact force on the fish minus the power on the partner; the powers of all fish add up to 0 */
    double force[2]; /* of all partners and of the walls on the fish, N */
    double moment;   /* of this force about the origin, N m */
};
struct contact_terms contact_terms(const struct contact *contact, int f, const double *y);

#endif
