/* free_sheet.h: the wake of `shedding: sheet`: a vortex sheet between markers, as others see it and as the own body
 * does. doc/model.md, section 8. Tested by tests/wake/test_free_sheet.c.
 *
 * The queue of a wake then holds markers: points of the sheet, each with the label Gamma_i, the circulation that the
 * fish had shed when it was born at the tail. Stretch i lies between the markers i and i + 1 and has the circulation
 * Gamma_i+1 - Gamma_i; the nascent one lies between the newest marker n and the tail, with Gamma(t) - Gamma_n.
 *
 *     marker 0 ---- 1 ---- ... ---- n-1 ---- n - - - - tail )=== body
 *      oldest                          stretch 1  nascent
 *
 * Markers see markers: each with half of both stretches that meet there. Other bodies, and the edge midpoints of the
 * own one, see the middle of every stretch with the smoothing of the wake. The control points of the own body see the
 * newest stretches as points graded towards the tail, and all of its wake with a smoothing that tapers to 0 there; with
 * the same smoothing the markers see the own body (flow_at_markers.h). */
#ifndef FREE_SHEET_H
#define FREE_SHEET_H

#include "base/status.h"
#include "fish/fish.h"
#include "wake/wake.h"

/* Points of the nascent stretch as the own body sees it: at xi of the way from the tail to the newest marker, with this
 * part of its circulation. Gauss-Legendre in eta with xi = eta^2: exact for xi^(-1/2) times a polynomial. */
enum { FREE_SHEET_PANEL = 4 };
extern const double free_sheet_xi[FREE_SHEET_PANEL], free_sheet_part[FREE_SHEET_PANEL];

/* Stretches with such points, the newest ones; stretches up to an age, of which the own body sees two points with half
 * of the circulation each, at these parts of the way; of older ones it sees the middle. */
enum { FREE_SHEET_GRADED = 1, FREE_SHEET_PAIRED = 4 };
extern const double free_sheet_pair_xi[2];

/* What the own control points see in place of what everybody sees: to be added to the middles of all stretches. First
 * the middles of old stretches, with their tapered smoothing in place of that of the wake; then points in place of the
 * middles of the newest stretches. The last FREE_SHEET_PANEL + 1 are the nascent stretch in place of its middle; the
 * others are released. */
struct free_sheet {
    int n, capacity;
    int n_tapered; /* the middles of old stretches */
    /* fixed for an interval; source i lies at xi of the way from the newer to the older end of its stretch (n) */
    int *stretch;
    double *xi, *part;    /* part of the circulation of the stretch; negative for its middle, which is taken away */
    double *smoothing[2]; /* at both ends of the interval, m */
    /* at one time                                                                                     (n) */
    double *x, *y, *circulation; /* m, m2 s-1 */
    double *square;              /* of the smoothing, m2 */
    /* whether the tail has overtaken the newest marker. The older end of the nascent stretch is beside the tail then:
     * it moves with the tail along the tangent, and by_turn per slope of the body there along the normal, (X'.n) */
    int is_overtaken;
    double tangent[2], normal[2], by_turn[2];
};

/* Release what it owns; accepts a zeroed one. */
void free_sheet_free(struct free_sheet *sheet);

/* The stretches as vortices at their middles: positions, velocities, circulations, births (of the newer marker). Fails
 * with STATUS_MEMORY. */
enum status free_sheet_middles(const struct wake *markers, struct wake *middles);

/* What the markers count with among themselves at the time t of the event: half of both stretches, less what has
 * decayed; nascent: the circulation of the nascent stretch; strength (n_vortex of the markers). */
void free_sheet_strengths(const struct wake *markers, const struct school *school, double t, double nascent,
                          double *strength);

/* Choose the sources for the interval that begins now. Without a marker there are the nascent ones only. Fails with
 * STATUS_MEMORY. */
enum status free_sheet_build(struct free_sheet *sheet, const struct fish *fish, const struct school *school,
                             const struct wake *markers);

/* Put the released sources where they are tau after the event at time t; middles as above. */
void free_sheet_place(struct free_sheet *sheet, const struct school *school, const struct wake *markers,
                      const struct wake *middles, double t, double tau);

/* The point at xi of the way from the tail to the newest marker, tau after the event; the tail where there is no
 * marker. */
void free_sheet_nascent_point(const struct wake *markers, double interval, double tau, const double tail[2], double xi,
                              double point[2]);

/* Put the nascent ones where they are then, with the tail there, the direction of the body at the tail and this
 * circulation of the nascent stretch. The stretch ends at the newest marker, or beside the tail where the tail has
 * overtaken the marker. */
void free_sheet_place_nascent(struct free_sheet *sheet, const struct fish *fish, const struct wake *markers,
                              double interval, double tau, const double tail[2], const struct direction *tangent,
                              double circulation);

/* The smoothing that a vortex of the wake and the own body have for each other, m; from_tail: the place of the vortex
 * less that of the tail, m, tangent: the direction of the body there. And whether it is untapered to rounding,
 * whatever its direction. */
double free_sheet_smoothing(const struct fish *fish, const double from_tail[2], const double tangent[2]);
int free_sheet_is_far(const struct fish *fish, const double from_tail[2]);

#endif
