/* wake.h: the wake of a fish as it is stored: a queue of vortices (or of markers of a free sheet), oldest first, and
 * the nascent vortex at the tail. doc/model.md, sections 7 and 8. Tested by tests/wake/test_wake.c.
 *
 * One interval between two events t_n and t_n+1 = t_n + Dt:
 *
 *     t_n                                                    t_n+1
 *      |  a released vortex moves on a known path:             |
 *      |  x + tau W + tau^2/(2 Dt) (W - W_before)              |
 *      |  the nascent vortex grows as shed - shed_before       |   then: move, release, remove, new W and slip
 *      |  at x_tail(t) + tau slip/2                            | */
#ifndef WAKE_H
#define WAKE_H

#include <stdbool.h>

#include "base/arena.h"
#include "base/status.h"
#include "fish/fish.h"

struct stretch_forms;

struct wake {
    struct arena *arena;               /* of the owner: the state */
    const struct stretch_forms *forms; /* stretch.h; of all wakes */
    unsigned long version;             /* counter of changes of the vortices below; identifies derived data */
    unsigned long n_turns;             /* how many of these changes were of velocities and rates alone */
    int n_vortex, capacity;
    double *x, *y;               /* position at the last event, m                     (n_vortex) */
    double *u, *v;               /* velocity W at the last event, m s-1               (n_vortex) */
    double *u_before, *v_before; /* velocity at the event before; W on the first interval  (n_vortex) */
    double *circulation;         /* m2 s-1, constant after release; for a marker: the label (n_vortex) */
    double *rate, *rate_before;  /* rate of labels at the same events, m2 s-2; 0 without rings (n_vortex) */
    double *birth;               /* time of release, s                                (n_vortex) */
    double aged;                 /* by so much a vortex counts as older than it is, s: constant, see wake_age */
    bool has_markers;            /* the queue holds markers of a sheet: sheet.h */
    int n_old;                   /* number of old stretches, the oldest ones: stretch.h */
    int n_added;                 /* number of vortices added from outside so far: at most wake_spare */
    double tail_velocity[2], tail_tangent[2]; /* at the last event, m s-1 and 1; only with markers */
    double removed;                           /* circulation of all vortices removed so far, m2 s-1 */
    double shed_before;                       /* circulation shed up to the last event, m2 s-1 */
    double slip[2];                           /* velocity of the fluid relative to the tail at the last event, m s-1 */
};

/* Set to an empty wake. */
void wake_create(struct arena *arena, struct wake *wake, int capacity);

/* Maximum number of vortices of one fish during n_events events. */
int wake_most(const struct school *school, long n_events);

/* Set velocity and direction of the tail at the start of an interval, for the taper of the smoothing of a free
 * sheet. */
void wake_set_tail(struct wake *wake, const double velocity[2], const double tangent[2]);

/* Add a vortex at the end of the queue. A full wake grows. */
void wake_release(struct wake *wake, double x, double y, double circulation, double birth);

/* Positions of all vortices or markers at the time tau after the last event (n_vortex). */
void wake_places(const struct wake *wake, double interval, double tau, double *restrict x, double *restrict y);

/* The age of vortex or marker i at time t as its decay counts it: of a wake with a shorter lifetime than wake.lifetime
 * (fish.wake_lifetime) the time since the release and the difference of the lifetimes. */
double wake_age(const struct wake *wake, int i, double t);

/* That difference for a wake with this part of the lifetime, s. */
double wake_aged(const struct school *school, double part);

/* The label of marker i, or circulation of vortex i, without decay; of all (n_vortex). */
double wake_label(const struct wake *wake, int i, double interval, double tau);
void wake_labels(const struct wake *wake, double interval, double tau, double *restrict label);

/* What remains of the label of marker i, or of vortex i, at the fraction q of the interval after the event at time t;
 * of young stretch j; of the circulation of old marker i (stretch.h); of all labels (n_vortex). With span: finite the
 * labels decay, so that rings stay closed, else circulations. */
double wake_part_of_label(const struct wake *wake, const struct school *school, double t, double q, int i);
double wake_part_of_stretch(const struct wake *wake, const struct school *school, double t, double q, int j);
double wake_part_of_marker(const struct wake *wake, const struct school *school, double t, double q, int i);
void wake_parts_of_labels(const struct wake *wake, const struct school *school, double t, double q, double *part);

/* The label of marker i, or the circulation of vortex i, at the time tau after the event at time t, times what remains;
 * of all (n_vortex). */
double wake_strength_of(const struct wake *wake, const struct school *school, double t, double tau, int i);
void wake_strengths(const struct wake *wake, const struct school *school, double t, double tau, double *strength);

/* Advance all vortices to the next event. */
void wake_advance(struct wake *wake, double interval);

/* Make room for n vortices in all; not in parallel. */
void wake_reserve(struct wake *wake, int n);

/* Resize to n vortices; new ones have undefined values. */
void wake_resize(struct wake *wake, int n);

/* Position of vortex or marker i at the time tau after the last event. */
void wake_marker(const struct wake *wake, int i, double interval, double tau, double position[2]);

/* Circulation of vortex i; for a marker: half of both adjacent stretches. */
double wake_circulation(const struct wake *wake, int i);

/* Number of sources (vortices, or stretches between markers), and circulation of source i. */
int wake_n_sources(const struct wake *wake);
double wake_source(const struct wake *wake, int i);

/* Remove the vortices with an age (wake_age) of at least a lifetime at time t; of markers such stretches. These have no
 * strength, except with impulsive shedding. */
void wake_remove_old(struct wake *wake, const struct school *school, double t);

/* Remove marker i from the sheet: the stretches on both sides become one. */
void wake_drop(struct wake *wake, int i);

/* Insert a marker into the sheet after marker i, born in the middle of the times of i and i + 1, with all its other
 * values from the n markers from `first` on by these weights (n). */
void wake_insert(struct wake *wake, int i, int first, int n, const double *weight);

/* Add shed circulation, m2 s-1, at infinite distance: no vortex changes. */
void wake_add_shed(struct wake *wake, double circulation);

/* Add a vortex from outside at the time t of an event. The opposite circulation is at infinite distance: the
 * circulation of the body does not change. The vortex ages from t on with the vortices of the fish. In a queue of
 * markers the vortex becomes a stretch of length 0 behind the newest stretches (with the age of these stretches),
 * between two stretches without circulation; the queue gains three markers:
 *
 *     before:  ... i ---- i+1 ... n        after:  ... i - - - A=B - - - i' ---- i+1 ... n     i' = i
 *
 * Fails with STATUS_CASE if wake.spare_vortices is exhausted, or if removed circulation returns to the body
 * (wake.removed_circulation: dropped); after a failure the wake is unchanged. */
enum status wake_add_vortex(struct wake *wake, const struct school *school, double t, double x, double y,
                            double circulation);

/* Continue a queue of markers at a tail that has been moved from outside, after a stretch without circulation. Fails as
 * wake_add_vortex does. */
enum status wake_break(struct wake *wake, const struct school *school, double t, const double tail[2]);

/* Remove all vortices: all shed circulation, m2 s-1, is at infinite distance. */
void wake_leave_behind(struct wake *wake, double shed);

/* Set new velocities, and rates of labels (NULL: 0). The n_new newest vortices had no velocity before: on the first
 * interval these vortices move with the new velocity alone. */
void wake_set_velocity(struct wake *wake, const double *u, const double *v, const double *rate, int n_new);

/* Strength over circulation of a vortex of this age in velocity sums. */
double wake_strength(const struct school *school, double age);

/* wake_strength within an interval: linear between the events, at the fraction q after the event at which the vortex
 * has this age. */
double wake_strength_within(const struct school *school, double age, double q);

/* Position of the nascent vortex: tail + tau slip/2. */
void wake_nascent(const struct wake *wake, double tau, const double tail[2], double position[2]);

#endif
