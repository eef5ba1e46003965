/* sheet.h: the wake of a fish as sources of the flow. With shedding: sheet it is a free sheet between markers,
 * otherwise a queue of point vortices. doc/model.md, sections 7, 8 and 18. Tested by tests/wake/test_sheet.c.
 *
 * The queue of a free sheet holds markers, which are points of the sheet. Each has a label Gamma_i, the circulation
 * that the fish had shed when the marker was born at the tail. Stretch i lies between the markers i and i + 1 and has
 * the circulation Gamma_i+1 - Gamma_i of the decayed labels. The nascent stretch lies between the newest marker n and
 * the tail and has Gamma(t) - Gamma_n.
 *
 *     marker 0 ---- 1 ---- ... ---- n-1 ---- n - - - - tail )=== body
 *      oldest                          stretch 1  nascent
 *
 * Old stretches (stretch.h) act from the markers around them, whoever looks. Young stretches are seen in three ways:
 *
 *     graded     by control points of the same fish: points of the newest stretches, graded towards the tail, and the
 *                middles of older ones, with a smoothing that tapers to 0 at the tail
 *     middles    by all other points of bodies: the middle of every stretch; or the queue and the nascent vortex
 *     markers    by markers: the markers, each with half of both adjacent stretches */
#ifndef SHEET_H
#define SHEET_H

#include <stdbool.h>

#include "base/status.h"
#include "fish/fish.h"
#include "wake/sources.h"
#include "wake/stretch.h"
#include "wake/wake.h"

/* Points of the nascent stretch for control points of the same fish: fraction xi of the way from the tail to the newest
 * marker, and fraction of the circulation. Gauss-Legendre in eta with xi = eta^2: exact for xi^(-1/2) times a
 * polynomial. */
enum { SHEET_PANEL = 4 };

/* Number of newest stretches with SHEET_PANEL points; age in stretches up to which a stretch has two points, each with
 * half of the circulation. Older young stretches have one point, the middle. */
enum { SHEET_GRADED = 1, SHEET_PAIRED = 4 };

/* The older end of the nascent stretch for control points of the same fish: the newest marker, or, if the tail has
 * overtaken the marker, a point beside the tail. This point moves with the tail along the tangent, and by by_turn per
 * displacement X'.n of the tangent vector along the normal. */
struct nascent_end {
    bool is_overtaken;
    double x[2]; /* m */
    double tangent[2], normal[2], by_turn[2];
};

/* Old markers and points of young stretches, oldest first, then the points of the nascent stretch. */
struct sheet_points {
    int n_released, n_nascent, capacity;
    /* fixed for an interval: source i lies at the fraction xi of the way from the newer to the older end of its stretch
     * (nascent point vortex: 0), with the fraction `part` of the circulation (legs of a steady wake: length of the
     * legs of the point, m)                                                             (n_released + n_nascent) */
    double *xi, *part;
    int *newer, *older; /* the markers at both ends of the stretch; an old marker twice            (n_released) */
    /* delta(d), m, s, m2, and the remaining part at the start and at the end of the interval      (n_released) */
    double *smoothing[2], *leg[2], *remains[2];
    struct sources sources; /* at one time */
    struct nascent_end end; /* of the nascent stretch */
    double way[2];          /* from the tail to this end, m */
};

/* Two views of the wake of a fish. The first n_markers points of both are the markers of old stretches, the next
 * n_single points the middles of young stretches from wake.n_old on; these points differ in the smoothing. Point
 * vortices are in middles only. */
enum { SHEET_PAD = STRETCH_MARKERS - 1, SHEET_DIAGONALS = 2 * SHEET_PAD + 1 };
struct sheet {
    struct arena *arena;
    struct sheet_points graded, middles;
    int n_markers, n_single, capacity;
    bool has_end; /* whether the values at the end of the interval are known */
    /* markers at both ends of the interval or at one time, and labels, behind SHEET_PAD zeros; remaining parts of
     * labels and distances from the tail along the sheet at both ends of the interval                 (n_vortex) */
    double *x[2], *y[2], *label, *remains[2], *distance[2];
    /* diagonals k of the matrix of all forms: old marker i has the part k of label i + k - SHEET_PAD  (n_markers); and
     * what it depends on, the times of birth                                                       (n_births) */
    double *diagonal[SHEET_DIAGONALS];
    double *birth;
    int n_births, n_old;
};

/* Make room for a wake of n vortices or markers. */
void sheet_reserve(struct arena *arena, struct sheet *sheet, int n);

/* Select the points of the interval that starts at the event at time t, after sheet_reserve. */
void sheet_build(struct sheet *sheet, const struct fish *fish, const struct school *school, const struct wake *wake,
                 double t);

/* The same, if the wake for which the sheet was built has got new velocities, which change the end of the interval, and
 * a new direction of the tail, on which the smoothing near the tail depends. */
void sheet_turn(struct sheet *sheet, const struct fish *fish, const struct school *school, const struct wake *wake);

/* Set the released points to the time tau after the event at time t. The values at the end of the interval are found
 * by the first call with tau > 0: a sheet that is built for the velocities at an event does not need them. */
void sheet_place(struct sheet *sheet, const struct fish *fish, const struct school *school, const struct wake *wake,
                 double t, double tau);

/* Set the nascent points to the time tau with the tail position at this time; shed: total circulation shed by the fish,
 * m2 s-1. The stretch ends at the newest marker (tangent NULL), or, for control points of the same fish, with the
 * direction of the body at the tail, beside the tail if the tail has overtaken the marker. Returns the circulation of
 * the nascent stretch or vortex. */
double sheet_place_nascent(struct sheet_points *points, const struct school *school, const struct wake *wake, double t,
                           double tau, const double tail[2], const struct direction *tangent, double shed);

/* The wake of an equilibrium (doc/steady.md): two legs of circulation `shed` from the tail to infinity along the unit
 * vector `along`, as nascent points in place of all points; targets beside the legs are valid up to the distance reach
 * from the tail, m. Infinite span: no point. */
void sheet_place_steady(struct sheet *sheet, struct sheet_points *points, const struct fish *fish, const double tail[2],
                        const double along[2], double shed, double reach);

/* Append the markers as sources at markers, at the event at time t at which the sheet is placed; nascent: circulation
 * of the nascent stretch, which has length 0. */
void sheet_markers(struct sources *sources, const struct sheet *sheet, const struct fish *fish,
                   const struct school *school, const struct wake *wake, double t, double nascent);

/* The change of a value at the markers (n_vortex), towards the newest one, that marker i has by the forms of old
 * stretches, and as half of both adjacent young ones. */
double sheet_change(const struct sheet *sheet, const struct wake *wake, int i, const double *value);

/* The vector dx along the sheet that belongs to released point i, without the circulation, m. */
void sheet_line(const struct sheet *sheet, const struct sheet_points *points, int i, double line[2]);

/* The newest marker tau after the event; the tail if there are no markers. */
void sheet_newest(const struct wake *wake, double interval, double tau, const double tail[2], double point[2]);

/* Smoothing of the velocity between a vortex of the wake and the body that shed it, m; from_tail: position of the
 * vortex relative to the tail, m; tangent: direction of the body at the tail. */
double sheet_taper(const struct fish *fish, const double from_tail[2], const double tangent[2]);

#endif
