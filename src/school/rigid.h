/* rigid.h: a fish as a whole: where it is, how it goes and turns, and how to change that without touching its shape.
 * The search for a steady state (steady/steady.h) works with these few slow quantities. doc/steady.md. Tested
 * by tests/school/test_rigid.c. */
#ifndef RIGID_H
#define RIGID_H

#include "state/state.h"

/* Of the whole body; or what is added to each. */
struct rigid {
    double place[2];    /* of the centre of mass, m */
    double heading;     /* rad */
    double velocity[2]; /* of the centre of mass: along the heading and to its left, m s-1 */
    double turn;        /* angular momentum about the centre of mass over the moment of inertia, rad s-1 */
};

/* What the fish is at the unknowns y. place and velocity are those over ground. */
struct rigid rigid_of(const struct fish *fish, const double *y);

/* The place of another fish as one sees it: ahead of its centre of mass and to its left, m. */
void rigid_relative_place(const struct rigid *seen_from, const struct rigid *other, double place[2]);

/* Add to what fish f is: velocity and turn first, along the heading as it was; then the body turns about its centre of
 * mass and is displaced, with its wake and what is remembered of the last period.
 *
 * The wake becomes that of a fish which has always had the new velocity and turn: a vortex that is a seconds old is
 * where the tail would have left it, displaced by -a times the change of the velocity and turned by -a times that of
 * the turn. Of the unknowns only positions and velocities change: the others have to be made consistent
 * (initial_conditions_solve, as at a start). */
void rigid_change(const struct school *school, struct state *state, int f, const struct rigid *change);

#endif
