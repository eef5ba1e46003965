/* free_sheet.h: the wake of `shedding: sheet`: a vortex sheet between markers, and its discretisations for the own body
 * and for all other targets. doc/model.md, section 8. Tested by tests/wake/test_free_sheet.c.
 *
 * The queue of a wake holds markers: points of the sheet, each with the label Gamma_i, the circulation shed by the fish
 * until the birth of the marker at the tail. Stretch i lies between the markers i and i + 1 and has the circulation
 * Gamma_i+1 - Gamma_i; the nascent stretch lies between the newest marker n and the tail, with Gamma(t) - Gamma_n.
 *
 *     marker 0 ---- 1 ---- ... ---- n-1 ---- n - - - - tail )=== body
 *      oldest                          stretch 1  nascent
 *
 * Sources of the sheet per target:
 *   markers: the markers, each with half of the circulation of both adjacent stretches;
 *   other bodies, and edge midpoints of the own body: the middle of every stretch, with the smoothing of the wake;
 *   control points of the own body: points of the newest stretches, graded towards the tail, and the middles of older
 *   stretches, with a smoothing that tapers to 0 at the tail. The velocity of the own body at the markers has the same
 *   tapered smoothing (flow_at_wake.h). */
#ifndef FREE_SHEET_H
#define FREE_SHEET_H

#include "base/status.h"
#include "fish/fish.h"
#include "wake/wake.h"

/* Points of the nascent stretch for the own control points: fraction xi of the way from the tail to the newest marker,
 * and fraction of the circulation. Gauss-Legendre in eta with xi = eta^2: exact for xi^(-1/2) times a polynomial. */
enum { FREE_SHEET_PANEL = 4 };
extern const double free_sheet_xi[FREE_SHEET_PANEL], free_sheet_part[FREE_SHEET_PANEL];

/* Number of newest stretches with FREE_SHEET_PANEL points; age in stretches up to which a stretch has two points, each
 * with half of the circulation, at the fractions free_sheet_pair_xi. Older stretches have one point, the middle. */
enum { FREE_SHEET_GRADED = 1, FREE_SHEET_PAIRED = 4 };
extern const double free_sheet_pair_xi[2];

/* The older end of the nascent stretch for the own control points: the newest marker, or, if the tail has overtaken the
 * marker, a point beside the tail. This point moves with the tail along the tangent, and by by_turn per displacement
 * X'.n of the tangent vector along the normal. */
struct nascent_end {
    int is_overtaken;
    double x[2]; /* m */
    double tangent[2], normal[2], by_turn[2];
};
struct nascent_end free_sheet_nascent_end(const double marker[2], const double tail[2],
                                          const struct direction *tangent);

/* Correction for the own control points, added to the middles of all stretches. First the middles of old stretches,
 * with the tapered smoothing in place of the smoothing of the wake; then points in place of the middles of the newest
 * stretches. The last FREE_SHEET_PANEL + 1 sources are the nascent stretch in place of its middle; the other sources
 * are released. */
struct free_sheet {
    int n, capacity;
    int n_tapered; /* number of middles of old stretches */
    /* fixed for an interval; source i lies at xi of the way from the newer to the older end of its stretch (n) */
    int *stretch;
    double *xi, *part;    /* fraction of the circulation of the stretch; negative: a middle that is subtracted */
    double *smoothing[2]; /* at the start and at the end of the interval, m */
    /* at one time                                                                                     (n) */
    double *x, *y, *circulation; /* m, m2 s-1 */
    double *square;              /* of the smoothing, m2 */
    struct nascent_end end;
};

/* Free all memory of the sheet; accepts a zeroed sheet. */
void free_sheet_free(struct free_sheet *sheet);

/* Set middles to the stretches as vortices at the middles of the stretches: positions, velocities, circulations, births
 * (of the newer marker). Fails with STATUS_MEMORY. */
enum status free_sheet_middles(const struct wake *markers, struct wake *middles);

/* Strengths of the markers as sources at markers at the time t of the event: half of both adjacent stretches, less the
 * decayed circulation; nascent: circulation of the nascent stretch; strength (n_vortex of the markers). */
void free_sheet_strengths(const struct wake *markers, const struct school *school, double t, double nascent,
                          double *strength);

/* Select the sources of the interval that starts at the event. Without markers only the nascent sources exist. Fails
 * with STATUS_MEMORY. */
enum status free_sheet_build(struct free_sheet *sheet, const struct fish *fish, const struct school *school,
                             const struct wake *markers);

/* Set positions and strengths of the released sources to the time tau after the event at time t; middles as above. */
void free_sheet_place(struct free_sheet *sheet, const struct school *school, const struct wake *markers,
                      const struct wake *middles, double t, double tau);

/* The point at the fraction xi of the way from the tail to the newest marker, tau after the event; the tail if there
 * are no markers. */
void free_sheet_nascent_point(const struct wake *markers, double interval, double tau, const double tail[2], double xi,
                              double point[2]);

/* Set the nascent sources to the time tau, with tail position, direction of the body at the tail, and circulation of
 * the nascent stretch at this time. The stretch ends at the newest marker, or beside the tail if the tail has overtaken
 * the marker. */
void free_sheet_place_nascent(struct free_sheet *sheet, const struct fish *fish, const struct wake *markers,
                              double interval, double tau, const double tail[2], const struct direction *tangent,
                              double circulation);

/* Smoothing of the velocity between a vortex of the wake and the own body, m; from_tail: position of the vortex
 * relative to the tail, m; tangent: direction of the body at the tail. free_sheet_is_far: the smoothing is untapered
 * within rounding for any tangent. */
double free_sheet_smoothing(const struct fish *fish, const double from_tail[2], const double tangent[2]);
int free_sheet_is_far(const struct fish *fish, const double from_tail[2]);

#endif
