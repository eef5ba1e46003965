/* control.h: what steers: the bias phi0 of the wave of curvature. doc/model.md, section 11. Tested by
 * tests/control/test_control.c. */
#ifndef CONTROL_H
#define CONTROL_H

#include "base/sparse.h"
#include "control/lead.h"
#include "fish/fish.h"
#include "fish/fish_gait.h"

/* At most so many waypoints can be set during a run. */
enum { CONTROL_MAX_WAYPOINTS = 32 };

/* What the control of one fish remembers from event to event. */
struct control_memory {
    int waypoint;                                /* the next one to visit; their number once all are visited */
    int has_heading, has_waypoints, n_waypoints; /* what has been set from outside: below */
    double held_heading;                         /* desired heading after the last waypoint, rad */
    double phi0, phi0_rate;     /* laws that decide at events: value at the last and its rate until the next, s-1 */
    double moment, moment_rate; /* tau_f, the same way; moment is dimensionless */

    /* what has been set from outside; all zero before */
    struct lead amplitude, frequency, bias; /* more than the case has: over its amplitude; Hz; 1 */
    struct lead heading;                    /* if has_heading, in place of the table of the case, rad */
    double
        waypoints[2 * CONTROL_MAX_WAYPOINTS]; /* if has_waypoints, in place of those of the case: x and y of each, m */
    double set_out[2];                        /* where the nose was then, m */
};

/* What a law sees at an event. */
struct control_view {
    double t, interval;         /* of the event, and from it to the next, s */
    double moment;              /* tau, that of the flow */
    double mean_heading;        /* over the last period, rad */
    int has_course;             /* whether the fish has moved for a whole period: */
    double course, course_rate; /* the direction in which it went in it, rad, and the rate of that, rad s-1 */
};

/* Whether the law takes a moment of the flow. */
int control_feels_moment(const struct fish *fish);

/* The direction from the body point at a third of the length to the nose, rad in (-pi, pi]. */
double control_heading(const struct fish *fish, const double *y);

/* The desired heading at time t, rad. */
double control_desired_heading(const struct fish *fish, const struct control_memory *memory, double t, const double *y);

/* limit tanh(gain wrap(direction - desired heading) + more): the value of the laws, for a heading or a course. */
double control_law(const struct fish *fish, const struct control_memory *memory, double t, double direction,
                   double more, const double *y);

/* The gait at time t: that of the case, and what has been set. */
struct fish_gait control_gait(const struct fish *fish, const struct control_memory *memory, double t);

/* Set from outside, at the event at time t; within fish->control.ramp all get there with three continuous derivatives.
 * Amplitude, in the unit of the case's, which is not 0; frequency, Hz; the bias of law none; the desired heading, rad,
 * by the shorter turn, where there are no waypoints. */
void control_set_amplitude(const struct fish *fish, struct control_memory *memory, double t, double amplitude);
void control_set_frequency(const struct fish *fish, struct control_memory *memory, double t, double frequency);
void control_set_bias(const struct fish *fish, struct control_memory *memory, double t, double bias);
void control_set_heading(const struct fish *fish, struct control_memory *memory, double t, double heading);

/* Set 1 to CONTROL_MAX_WAYPOINTS waypoints (n, 2), m, in place of all that are left; for laws that decide at events. */
void control_set_waypoints(const struct fish *fish, struct control_memory *memory, int n, const double *waypoints,
                           const double *y);

/* The largest bias, in absolute value, that the fish can steer with once a change is over. */
double control_largest_bias(const struct fish *fish, const struct control_memory *memory);

/* The number of waypoints of the case, or of those set since. */
int control_n_waypoints(const struct fish *fish, const struct control_memory *memory);

/* The equation for phi0 at time t, since seconds after the last event. */
void control_residual(const struct fish *fish, const struct control_memory *memory, double t, double since,
                      const double *y, double *residual);

/* dphi0/dt between events, s-1. */
double control_rate(const struct fish *fish, const struct control_memory *memory, double t, double since,
                    const double *y);

/* Add the derivatives of control_residual. */
void control_jacobian(const struct fish *fish, const struct control_memory *memory, double t, double since,
                      const double *y, struct sparse *jacobian);

/* At an event, interval seconds after the last one: what moves between events has arrived. Before anything is solved
 * for there. */
void control_advance(struct control_memory *memory, double interval);

/* At an event, after control_advance: pass waypoints that have been reached, take the moment of the flow into its mean,
 * and set out towards the value of a law that decides at events. Returns whether phi0 jumps. */
int control_event(const struct fish *fish, struct control_memory *memory, const struct control_view *view,
                  const double *y);

#endif
