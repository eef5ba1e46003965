/* wake.h: the free sheet of a fish: a queue of point vortices, oldest first, and the nascent vortex at its tail.
 * doc/model.md, sections 7 and 8. Tested by tests/wake/test_wake.c.
 *
 * One interval between two events t_n and t_n+1 = t_n + Dt:
 *
 *     t_n                                                    t_n+1
 *      |  a released vortex moves on a path that is known:     |
 *      |  x + tau W + tau^2/(2 Dt) (W - W_before)              |
 *      |  the nascent vortex grows as shed - shed_before       |   then: move, release, remove, new W and slip
 *      |  at x_tail(t) + tau slip/2                            |
 */
#ifndef WAKE_H
#define WAKE_H

#include "base/status.h"
#include "fish/fish.h"

struct wake {
    unsigned long
        version; /* counts the changes of the vortices below: what is made of them is kept with it, and compared */
    int n_vortex, capacity;
    double *x, *y;                            /* position at the last event, m                     (n_vortex) */
    double *u, *v;                            /* velocity W at the last event, m s-1               (n_vortex) */
    double *u_before, *v_before;              /* and at the event before; W on the first interval  (n_vortex) */
    double *circulation;                      /* m2 s-1, constant once released; of a marker: its label (n_vortex) */
    double *rate, *rate_before;               /* of labels, as u and u_before, m2 s-2; 0 without depth (n_vortex) */
    double *birth;                            /* time of release, s                                (n_vortex) */
    int has_markers;                          /* the queue holds markers of a sheet: free_sheet.h */
    int n_merged;                             /* how many have become one with a neighbour so far: wake_merge.h */
    int n_added;                              /* how many have been added from outside so far: at most wake_spare */
    double tail_velocity[2], tail_tangent[2]; /* at the last event, m s-1 and 1; with markers only */
    double removed;                           /* circulation of all vortices removed so far, m2 s-1 */
    double shed_before;                       /* circulation shed up to the last event, m2 s-1 */
    double slip[2];                           /* velocity of the fluid past the tail at the last event, m s-1 */
};

/* An empty wake. Fails with STATUS_MEMORY. */
enum status wake_create(struct wake *wake, int capacity);

/* Release what the wake owns. Accepts a zeroed wake. */
void wake_free(struct wake *wake);

/* The most vortices that one fish can own during n_events events. */
int wake_most(const struct school *school, long n_events);

/* Note how the tail moves and points as an interval begins: what the smoothing of a free sheet tapers towards. */
void wake_set_tail(struct wake *wake, const double velocity[2], const double tangent[2]);

/* Add a vortex at the end of the queue. The wake grows when full. Fails with STATUS_MEMORY; it is then unchanged. */
enum status wake_release(struct wake *wake, double x, double y, double circulation, double birth);

/* Where all vortices are at the time tau after the last event: positions and strengths as they count in velocity sums
 * (the circulation less what has faded); each array (n_vortex). t is the time of the last event. */
void wake_at(const struct wake *wake, const struct school *school, double t, double tau, double *x, double *y,
             double *strength);

/* The circulation that no longer acts, tau after the event at time t: of vortices removed, and what has decayed. */
double wake_lost(const struct wake *wake, const struct school *school, double t, double tau);

/* Move all vortices on to the next event. */
void wake_advance(struct wake *wake, double interval);

/* Make room for n vortices without values, in place of those it has. Fails with STATUS_MEMORY. */
enum status wake_resize(struct wake *wake, int n);

/* Where vortex or marker i is at the time tau after the last event. */
void wake_marker(const struct wake *wake, int i, double interval, double tau, double position[2]);

/* The label of marker i at the time tau after the last event, which was at time t; and the part of it that has not
 * decayed, m2 s-1. */
double wake_label(const struct wake *wake, int i, double interval, double tau);
double wake_ring(const struct wake *wake, const struct school *school, int i, double t, double tau);

/* The circulation that vortex i stands for: its own, or half of both stretches that meet in a marker. */
double wake_circulation(const struct wake *wake, int i);

/* The number of vortices, or of stretches between markers, and the circulation of one. */
int wake_n_sources(const struct wake *wake);
double wake_source(const struct wake *wake, int i);

/* The number of vortices that were released a lifetime or more before t; of markers, those whose stretch towards the
 * next one was. Except with impulsive shedding they have no strength left. */
int wake_n_old(const struct wake *wake, const struct school *school, double t);

/* Remove the old vortices. */
void wake_remove_old(struct wake *wake, const struct school *school, double t);

/* So much more circulation has been shed, m2 s-1, all of it infinitely long ago: no vortex changes. */
void wake_add_shed(struct wake *wake, double circulation);

/* Add a vortex from outside at the time t of an event. Its opposite is infinitely far away: the circulation of the body
 * does not change. It ages from t on with the vortices of the fish; in a queue of markers it is a stretch of length 0
 * behind the newest ones (so it is as old as these) with stretches without circulation before and behind it, three
 * markers in all:
 *
 *     before:  ... i ---- i+1 ... n        after:  ... i - - - A=B - - - i' ---- i+1 ... n     i' where i is
 *
 * Fails with STATUS_CASE where wake.spare_vortices has no room, or where circulation that is removed goes to the body
 * (wake.dissipated_circulation: dropped), and with STATUS_MEMORY; the wake is then unchanged. */
enum status wake_add_vortex(struct wake *wake, const struct school *school, double t, double x, double y,
                            double circulation);

/* A tail has been moved from outside: a queue of markers continues there, after a stretch without circulation. Fails as
 * wake_add_vortex. */
enum status wake_break(struct wake *wake, const struct school *school, double t, const double tail[2]);

/* There are no vortices any more: all the circulation that has been shed, m2 s-1, is infinitely far away. */
void wake_leave_behind(struct wake *wake, double shed);

/* Take new velocities, and rates of labels (NULL: 0); one of the n_new newest vortices, which had none before, moves on
 * its first interval with them alone. */
void wake_set_velocity(struct wake *wake, const double *u, const double *v, const double *rate, int n_new);

/* The part of its circulation that a vortex of this age counts with in velocity sums. */
double wake_strength(const struct school *school, double age);

/* The same for one whose age is this at an event, at the part q of the interval that follows: linear. */
double wake_strength_within(const struct school *school, double age, double q);

/* Where the nascent vortex is: the tail's position plus tau slip/2. */
void wake_nascent(const struct wake *wake, double tau, const double tail[2], double position[2]);

#endif
