/* contact.h: bodies repel each other, and walls repel them, where their outlines come nearer than a range.
 * doc/model.md, section 16. Tested by tests/contact/test_contact.c.
 *
 * Every edge of a body is a straight strip of its own thickness (fish_distance). The potential of two edges is the mean
 * of four: each end of either edge above the other edge.
 *
 *          edge i of fish f     a ============= b          of point p above edge j: the distance to its nearest point,
 *                                     | gap                less half of both thicknesses
 *                                     p ============= .
 *                                       edge j of fish g
 */
#ifndef CONTACT_H
#define CONTACT_H

#include "base/status.h"
#include "flow/flow_derivative.h"
#include "state/state.h"

struct contact;

/* Fails with STATUS_MEMORY; contact_free accepts NULL. */
enum status contact_create(struct contact **contact, const struct school *school);
void contact_free(struct contact *contact);

/* Find the bodies in contact at the places in y; none where contact.action is not repel. Fails with STATUS_RETRY where
 * two bodies (except prescribed ones) touch or cross there, or on the straight way there from where the last step of
 * the integrator ended, or where a body touches a wall, and with STATUS_MEMORY. */
enum status contact_find(struct contact *contact, const struct state *state, double t, const double *y);

/* The fish in contact with fish f when last found: their number, and *other, in ascending order. */
int contact_partners(const struct contact *contact, int f, const int **other);

/* Take the forces of all partners of fish f, and of the walls, off its rows ax, ay of value, N. */
void contact_residual(const struct contact *contact, int f, const double *y, double *value);

/* Add to rows the derivatives of these, over the masses, by the places of fish g: f itself or a partner. */
void contact_jacobian(const struct contact *contact, int f, int g, const double *y, struct coupling_block *rows);

/* Half the energy of the contacts of fish f with others, and all of that with walls, J: the sum over all fish is the
 * potential. And what fish f is
 * given for it, W: for each partner half of what that pays less half of what f pays. Over all fish the powers add up to
 * nothing. */
double contact_energy(const struct contact *contact, int f, const double *y);
double contact_power(const struct contact *contact, int f, const double *y);

/* The force of all partners and of the walls on fish f, N, and its moment about the origin, N m. */
struct contact_forces {
    double force[2], moment;
};
struct contact_forces contact_forces(const struct contact *contact, int f, const double *y);

#endif
