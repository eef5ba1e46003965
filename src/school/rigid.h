/* rigid.h: position, heading, velocity and turning rate of a whole fish, and changes of these quantities at constant
 * shape. The search for a steady state (steady/steady.h) uses these slow quantities as unknowns. doc/steady.md. Tested
 * by tests/school/test_rigid.c. */
#ifndef RIGID_H
#define RIGID_H

#include "state/state.h"

/* Rigid-body quantities of a fish, or increments of these quantities. */
struct rigid {
    double place[2];    /* centre of mass, m */
    double heading;     /* rad */
    double velocity[2]; /* centre of mass: along the heading, and to the left, m s-1 */
    double turn;        /* angular momentum about the centre of mass / moment of inertia, rad s-1 */
};

/* The rigid-body quantities of a fish at the unknowns y; place and velocity are over ground. */
struct rigid rigid_of(const struct fish *fish, const double *y);

/* Place of another fish relative to the centre of mass of seen_from: ahead, and to the left, m. */
void rigid_relative_place(const struct rigid *seen_from, const struct rigid *other, double place[2]);

/* Add *change to fish f: first velocity and turn, along the old heading; then rotate the body about the centre of mass
 * and displace the body, the wake and the history of the last period.
 *
 * The new wake is the wake of a fish that has always had the new velocity and turn: a vortex of age a is displaced by
 * -a times the change of velocity, and rotated by -a times the change of turn. Only positions and velocities of the
 * unknowns change; initial_conditions_solve then makes the other unknowns consistent, as at a start. */
void rigid_change(const struct school *school, struct state *state, int f, const struct rigid *change);

#endif
