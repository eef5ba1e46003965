/* control.h: what steers: the bias phi0 of the wave of curvature. doc/model.md, section 11. Tested by
 * tests/model/test_control.c. */
#ifndef CONTROL_H
#define CONTROL_H

#include "base/sparse.h"
#include "model/fish.h"

/* What the control of one fish remembers from event to event. */
struct control_memory {
    int waypoint;               /* the next one to visit; the number of waypoints once all are visited */
    double held_heading;        /* desired heading after the last waypoint, rad */
    double phi0, phi0_rate;     /* averaged_heading: value at the last event and its rate until the next, s-1 */
    double moment, moment_rate; /* tau_f, the same way; moment is dimensionless */
};

/* Whether the law takes a moment of the flow. */
int control_feels_moment(const struct fish *fish);

/* The direction from the body point at a third of the length to the nose, rad in (-pi, pi]. */
double control_heading(const struct fish *fish, const double *y);

/* The desired heading at time t, rad. */
double control_desired_heading(const struct fish *fish, const struct control_memory *memory, double t, const double *y);

/* The value of the law for a heading, its error against the desired one wrapped, and the filtered moment tau_f. */
double control_law(const struct fish *fish, const struct control_memory *memory, double t, double moment,
                   double heading, const double *y);

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

/* At an event, after control_advance: pass waypoints that have been reached, take the moment tau of the flow into its
 * mean, and set out towards the law's value (averaged_heading: with the mean heading of the last period). interval is
 * the time to the next event. Returns whether phi0 jumps. */
int control_event(const struct fish *fish, struct control_memory *memory, double t, double interval, double tau,
                  double mean_heading, const double *y);

#endif
