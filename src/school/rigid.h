/* rigid.h: a fish as a rigid body: its position, heading, velocity and turning rate, and how to change them without
 * changing its shape. The search for a steady state (steady/steady.h) has these slow quantities as unknowns.
 * doc/steady.md. Tested by tests/school/test_rigid.c. */
#ifndef RIGID_H
#define RIGID_H

#include "state/state.h"

/* The rigid-body quantities of a fish, or increments of them. */
struct rigid {
    double place[2];    /* centre of mass, m */
    double heading;     /* rad */
    double velocity[2]; /* of the centre of mass: along the heading, and to the left, m s-1 */
    double turn;        /* angular momentum about the centre of mass over moment of inertia, rad s-1 */
};

/* Find the rigid-body quantities of a fish at the unknowns y; place and velocity are over ground. */
struct rigid rigid_of(const struct fish *fish, const double *y);

/* Where another fish is, relative to the centre of mass of seen_from: ahead, and to the left, m. */
void rigid_relative_place(const struct rigid *seen_from, const struct rigid *other, double place[2]);

/* Add *change to fish f. First velocity and turn change, along the old heading; then the body rotates about its centre
 * of mass and moves, together with its wake and with the history of the last period.
 *
 * The new wake is the one of a fish that has always had the new velocity and turn: a vortex of age a is displaced by -a
 * times the change of velocity and rotated by -a times the change of turn. Of the unknowns only positions and
 * velocities change; initial_conditions_solve then makes the others consistent, as at a start. */
void rigid_change(const struct school *school, struct state *state, int f, const struct rigid *change);

#endif
