/* ring_sheet.h: the wake of a body of finite depth: a free sheet of vortex rings between markers. doc/model.md, section
 * 18. Tested by tests/flow/test_flow_rings.c. */
#ifndef RING_SHEET_H
#define RING_SHEET_H

#include "base/status.h"
#include "fish/fish.h"
#include "vortex/ring.h"
#include "wake/free_sheet.h"
#include "wake/wake.h"

/* Points of all stretches, oldest stretch first, then the points of the nascent stretch. */
struct ring_sheet {
    int n_released, n_nascent, capacity;
    /* fixed for an interval; source i lies at the fraction xi of the way from the newer to the older end of its stretch
     * (n_released) */
    int *stretch;
    double *xi, *part;
    double *smoothing[2], *leg[2]; /* delta(d) and s at the start and at the end of the interval, m, m2 */
    struct rings rings;            /* at one time */
    struct nascent_end end;        /* of the nascent stretch */
    double way[2];                 /* from the tail to this end, m */
};

/* Both views of the wake of a fish: graded points for the own control points, and the middle of every stretch for all
 * other targets. The oldest n_single stretches have the middle in both views; the points differ in the smoothing. */
struct ring_sheets {
    struct ring_sheet graded, middles;
    int n_single, capacity;
    /* workspace: markers at both ends of the interval or at one time, labels, lengths of stretches */
    double *x[2], *y[2], *label, *length[2];
};
void ring_sheets_free(struct ring_sheets *sheets);

/* Select the points of the interval that starts at the event. Fails with STATUS_MEMORY. */
enum status ring_sheets_build(struct ring_sheets *sheets, const struct fish *fish, const struct school *school,
                              const struct wake *markers);

/* Set the released points to the time tau after the event at time t. */
void ring_sheets_place(struct ring_sheets *sheets, const struct school *school, const struct wake *markers, double t,
                       double tau);

/* Set the nascent points to the time tau with the tail position at this time; shed: total circulation shed by the fish,
 * m2 s-1. The stretch ends at the newest marker (tangent NULL), or for the own control points, with the direction of
 * the body at the tail, where free_sheet_nascent_end ends it. Returns the circulation of the nascent stretch. */
double ring_sheet_place_nascent(struct ring_sheet *sheet, const struct school *school, const struct wake *markers,
                                double t, double tau, const double tail[2], const struct direction *tangent,
                                double shed);

/* Nascent point i: fraction of the way from the tail to the newest marker, and fraction of the stretch. */
double ring_sheet_xi(const struct ring_sheet *sheet, int i);
double ring_sheet_part(const struct ring_sheet *sheet, int i);

/* The wake of an equilibrium (doc/steady.md): two legs of circulation `shed` from the tail to infinity along the unit
 * vector `along`, as nascent points in place of all points; targets beside the legs are valid up to the distance reach
 * from the tail, m. Fails with STATUS_MEMORY. ring_sheet_steady_length: length of the legs of point i, m. */
enum status ring_sheet_place_steady(struct ring_sheet *sheet, const struct fish *fish, const double tail[2],
                                    const double along[2], double shed, double reach);
double ring_sheet_steady_length(const struct ring_sheet *sheet, int i);

/* Append the markers as sources at markers, at the event at time t, to rings; nascent: circulation of the nascent
 * stretch. Fails with STATUS_MEMORY. */
enum status ring_sheet_markers(struct rings *rings, const struct fish *fish, const struct school *school,
                               const struct wake *markers, double t, double nascent);

#endif
