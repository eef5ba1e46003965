/* control.h: how a fish steers: a control law sets the bias phi0 of its wave of curvature, and law place its amplitude
 * too. doc/model.md, section 11. Tested by tests/control/test_control.c. */
#ifndef CONTROL_H
#define CONTROL_H

#include <stdbool.h>

#include "base/sparse.h"
#include "fish/fish.h"
#include "fish/fish_gait.h"

/* A value set from outside during a run: each change is a ramp to the new value with three continuous
 * derivatives, for any value and rate at the start of the change. doc/model.md, section 11. */

/* A polynomial in the time since the last change over the ramp, and the constant value after the ramp. All zeros: value
 * 0 at all times. The struct holds doubles only: state/state.c. */
enum { LEAD_TERMS = 8 };
struct lead {
    double start, ramp;        /* of the last change, s */
    double series[LEAD_TERMS]; /* of q = (t - start) / ramp, up to q = 1 */
    double target;             /* value after the ramp */
    double integral;           /* of the value from 0 to start */
};

/* Value, first and second derivative, and time integral since t = 0, at time t, at or after the last change. */
double lead_value(const struct lead *lead, double t);
double lead_rate(const struct lead *lead, double t);
double lead_change_of_rate(const struct lead *lead, double t);
double lead_integral(const struct lead *lead, double t);

/* Start a change to target at time t, within ramp seconds. From rest the change is value + (target - value) S(q) with S
 * of base/mathematics.h. No-op for the present target. */
void lead_change(struct lead *lead, double t, double ramp, double target);

/* The same from a given value and its first three derivatives by q of the ramp, for a quantity that the lead did not
 * describe before time t. */
enum { LEAD_GIVEN = 4 };
void lead_begin(struct lead *lead, double t, double ramp, const double given[LEAD_GIVEN], double target);

/* Largest number of waypoints that can be set during a run. */
enum { CONTROL_MAX_WAYPOINTS = 32 };

/* State of the control of one fish between events. */
struct control_memory {
    int waypoint;                    /* the next waypoint; the number of waypoints after the last waypoint */
    bool has_heading, has_waypoints; /* whether these are set from outside, below */
    int n_waypoints;
    double held_heading;        /* desired heading after the last waypoint, or of law place, rad */
    double phi0, phi0_rate;     /* event-based laws: value at the last event and rate until the next event, s-1 */
    double course_rate;         /* e of law course, rad s-1 */
    double moment, moment_rate; /* tau_f and rate, dimensionless and s-1 */
    double drive, drive_rate;   /* law place: relative change of the amplitude, and rate until the next event, s-1 */
    double hold[2];             /* law place: the integrals, h_a of the amplitude (1) and h_b of the course (1) */

    /* values set from outside; initially 0 */
    struct lead amplitude, frequency, bias;      /* offsets from the case: relative to the amplitude; Hz; 1 */
    struct lead heave;                           /* offset from motion.heave, m */
    struct lead heading;                         /* if has_heading, replaces the table of the case, rad */
    struct lead offset[2];                       /* change of the offset of law place, m */
    double waypoints[2 * CONTROL_MAX_WAYPOINTS]; /* if has_waypoints, replaces the waypoints of the case: (x, y), m */
    double set_out[2];                           /* position of the nose at that time, m */
};

/* Input of a law at an event. */
struct control_view {
    double t, interval;         /* time of the event, and from this event to the next, s */
    double moment;              /* tau, moment of the flow */
    double mean_heading;        /* over the last period, rad */
    bool has_course;            /* whether a full period has passed */
    double course, course_rate; /* direction of motion over this period, rad, and rate, rad s-1 */
    double speed;               /* mean over this period, m s-1; 0: course and course_rate are 0 */

    /* law place: course and speed are those through the water; of the vector from the centre of mass to that of the
     * leader, the mean over this period and the change within the period; mean heading of the leader over the period */
    double away[2], away_change[2]; /* m */
    double leader_heading;          /* rad */
};

/* Whether the law uses the moment of the flow. */
bool control_uses_moment(const struct fish *fish);

/* The direction from the body point at a third of the length to the nose, rad in (-pi, pi]. */
double control_heading(const struct fish *fish, const double *y);

/* The desired heading at time t, rad. */
double control_desired_heading(const struct fish *fish, const struct control_memory *memory, double t, const double *y);

/* limit tanh(gain wrap(direction - desired heading) + more): the value of the laws, for a heading or a course. */
double control_law(const struct fish *fish, const struct control_memory *memory, double t, double direction,
                   double more, const double *y);

/* The gait at time t, since seconds after the last event: the gait of the case with the values set from outside and the
 * amplitude of law place. */
struct fish_gait control_gait(const struct fish *fish, const struct control_memory *memory, double t, double since);

/* Amplitude of the heave of the prescribed motion at time t, m, with the value set from outside, and its first and
 * second derivative. */
void control_heave(const struct fish *fish, const struct control_memory *memory, double t, double heave[3]);

/* Set a value from outside, at the event at time t; the value changes within fish->control.ramp with three continuous
 * derivatives. Amplitude: in the unit of the case, the amplitude of the case is not 0; frequency: Hz; bias: of law
 * none; heave: m; desired heading: rad, by the shorter turn, without waypoints only; offset of law place: m. */
enum control_set {
    CONTROL_SET_AMPLITUDE,
    CONTROL_SET_FREQUENCY,
    CONTROL_SET_BIAS,
    CONTROL_SET_HEAVE,
    CONTROL_SET_HEADING,
    CONTROL_SET_OFFSET_X,
    CONTROL_SET_OFFSET_Y
};
void control_set(const struct fish *fish, struct control_memory *memory, enum control_set which, double t,
                 double value);

/* Set 1 to CONTROL_MAX_WAYPOINTS waypoints (n, 2), m, to replace all remaining waypoints; for event-based laws. */
void control_set_waypoints(const struct fish *fish, struct control_memory *memory, int n, const double *waypoints,
                           const double *y);

/* The offset of the nose from that of the leader after the end of a change, component d, m; law place. */
double control_offset(const struct fish *fish, const struct control_memory *memory, int d);

/* The largest relative amplitude after the end of a change, and the largest absolute value of the bias. */
double control_largest_amplitude(const struct fish *fish, const struct control_memory *memory);
double control_largest_bias(const struct fish *fish, const struct control_memory *memory);

/* The number of waypoints of the case, or of the waypoints set from outside. */
int control_n_waypoints(const struct fish *fish, const struct control_memory *memory);

/* The equation for phi0 at time t, since seconds after the last event. */
void control_residual(const struct fish *fish, const struct control_memory *memory, double t, double since,
                      const double *y, double *residual);

/* dphi0/dt between events, s-1. */
double control_rate(const struct fish *fish, const struct control_memory *memory, double t, double since,
                    const double *y);

/* Add factor[i] times the derivatives of control_rate by positions and velocities to the row first_row + i
 * (n_rows). */
void control_rate_jacobian(const struct fish *fish, const struct control_memory *memory, double t, double since,
                           const double *y, int first_row, int n_rows, const double *factor, struct sparse *jacobian);

/* Whether control_rate depends on positions and velocities: law heading. */
bool control_rate_varies(const struct fish *fish);

/* Add the derivatives of control_residual. */
void control_jacobian(const struct fish *fish, const struct control_memory *memory, double t, double since,
                      const double *y, struct sparse *jacobian);

/* Advance phi0, the filtered moment and the amplitude to an event, interval seconds after the last event. Call before
 * any solve at the event. */
void control_advance(struct control_memory *memory, double interval);

/* At an event, after control_advance: pass the waypoints within the acceptance radius, update the filtered moment, and
 * set the rate towards the value of an event-based law. Returns whether phi0 jumps. */
bool control_event(const struct fish *fish, struct control_memory *memory, const struct control_view *view,
                   const double *y);

#endif
