/* free_sheet.c: middles of stretches, strengths of markers, and sources for the own control points. */
#include "wake/free_sheet.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/mathematics.h"
#include "base/memory.h"
#include "body/rod.h"

/* Gauss-Legendre on [0, 1]: eta = 0.0694318, 0.3300095, 0.6699905, 0.9305682 with weights w; xi = eta^2, part = 2 eta
 * w. */
const double free_sheet_xi[FREE_SHEET_PANEL] = {0.004820780989426014, 0.10890625570683385, 0.44888729929169013,
                                                0.8659570925834785};
const double free_sheet_part[FREE_SHEET_PANEL] = {0.024152203412833233, 0.215214082271785, 0.4369310725907612,
                                                  0.32370264172462043};

const double free_sheet_pair_xi[2] = {0.21132486540518712, 0.78867513459481288};  // Gauss-Legendre

void free_sheet_free(struct free_sheet *sheet) {
    double *const owned[] = {sheet->xi, sheet->part, sheet->smoothing[0], sheet->smoothing[1],
                             sheet->x,  sheet->y,    sheet->circulation,  sheet->square};
    for (size_t i = 0; i < sizeof owned / sizeof *owned; i++) free(owned[i]);
    free(sheet->stretch);
    *sheet = (struct free_sheet){0};
}

static enum status free_sheet_reserve(struct free_sheet *sheet, int n) {
    if (n <= sheet->capacity) return STATUS_OK;
    const int capacity = n + n / 2;
    free_sheet_free(sheet);
    double **const all[] = {&sheet->xi, &sheet->part, &sheet->smoothing[0], &sheet->smoothing[1],
                            &sheet->x,  &sheet->y,    &sheet->circulation,  &sheet->square};

    TRY(MEMORY_NEW(sheet->stretch, capacity, "points of a free sheet"));
    TRY(MEMORY_ARRAYS(all, capacity, "the points of a free sheet"));
    sheet->capacity = capacity;
    return STATUS_OK;
}

enum status free_sheet_middles(const struct wake *markers, struct wake *middles) {
    const int n = wake_n_sources(markers);
    TRY(wake_resize(middles, n));
    const double *const from[] = {markers->x, markers->y, markers->u, markers->v, markers->u_before, markers->v_before};
    double *const to[] = {middles->x, middles->y, middles->u, middles->v, middles->u_before, middles->v_before};
    for (int k = 0; k < 6; k++) {
        for (int i = 0; i < n; i++) to[k][i] = (from[k][i] + from[k][i + 1]) / 2;
    }

    for (int i = 0; i < n; i++) {
        middles->circulation[i] = wake_source(markers, i);
        middles->birth[i] = markers->birth[i + 1];
    }

    return STATUS_OK;
}

void free_sheet_strengths(const struct wake *markers, const struct school *school, double t, double nascent,
                          double *strength) {
    const int n = markers->n_vortex;
    for (int i = 0; i < n; i++) strength[i] = 0;
    for (int i = 0; i + 1 < n; i++) {
        const double stretch =
            (markers->circulation[i + 1] - markers->circulation[i]) * wake_strength(school, t - markers->birth[i + 1]);
        strength[i] += stretch / 2;
        strength[i + 1] += stretch / 2;
    }

    // the nascent stretch has length 0 at the event: both halves act at the newest marker
    if (n > 0) strength[n - 1] += nascent;
}

double free_sheet_smoothing(const struct fish *fish, const double from_tail[2], const double tangent[2]) {
    if (fish->taper <= 0) return fish->smoothing;
    const double square = from_tail[0] * from_tail[0] + from_tail[1] * from_tail[1];
    if (square <= 0) return 0;

    // taper length: behind the tail, or beside the body
    const double along = from_tail[0] * tangent[0] + from_tail[1] * tangent[1];
    const double behind = along >= 0 ? 1 : ramp_step(1 + 2 * along / sqrt(square));
    const double length = fish->taper * behind + fish->taper_beside * (1 - behind);
    if (length <= 0) return fish->smoothing;

    const double ratio = square / (length * length) * (square / (length * length));

    // without cancellation exp is as accurate as expm1, and faster
    return fish->smoothing * (ratio > 1 ? 1 - exp(-ratio) : -expm1(-ratio));
}

// both ends of a stretch at one time
struct ends {
    int stretch;  // -2: unset
    double newer[2], older[2];
};

// ends of a stretch, tau after the event; the previous older end is reused if the previous stretch is the next newer
// stretch
static void stretch_find_ends(struct ends *ends, const struct wake *markers, int stretch, double interval, double tau) {
    if (ends->stretch == stretch) return;
    if (ends->stretch == stretch + 1) {
        memcpy(ends->newer, ends->older, sizeof ends->newer);
    } else {
        wake_marker(markers, stretch + 1, interval, tau, ends->newer);
    }

    wake_marker(markers, stretch, interval, tau, ends->older);
    ends->stretch = stretch;
}

// point at the fraction xi of the way from the newer to the older end
static void sheet_stretch_point(const struct ends *ends, double xi, double point[2]) {
    for (int i = 0; i < 2; i++) point[i] = (1 - xi) * ends->newer[i] + xi * ends->older[i];
}

// add a source; at[0], at[1]: ends of the stretch at the start and at the end of the interval
static void free_sheet_add(struct free_sheet *sheet, const struct fish *fish, const struct wake *markers,
                           double interval, const struct ends at[2], double xi, double part) {
    const int i = sheet->n++;
    sheet->stretch[i] = at[0].stretch;
    sheet->xi[i] = xi;
    sheet->part[i] = part;
    if (part < 0) {
        sheet->smoothing[0][i] = sheet->smoothing[1][i] = fish->smoothing;
        return;
    }

    // the tail starts at the newest marker and keeps its velocity during the interval
    const int newest = markers->n_vortex - 1;
    for (int end = 0; end < 2; end++) {
        const double tau = end * interval;
        const double tail[2] = {markers->x[newest] + tau * markers->tail_velocity[0],
                                markers->y[newest] + tau * markers->tail_velocity[1]};
        double point[2];
        sheet_stretch_point(&at[end], xi, point);
        const double from_tail[2] = {point[0] - tail[0], point[1] - tail[1]};
        sheet->smoothing[end][i] = free_sheet_smoothing(fish, from_tail, markers->tail_tangent);
    }
}

// whether the smoothing of a source is untapered within rounding, so that no correction is required
static int free_sheet_is_untapered(const struct free_sheet *sheet, const struct fish *fish, int i) {
    const double rounding = 1e-13;
    return fish->smoothing - sheet->smoothing[0][i] <= rounding * fish->smoothing &&
           fish->smoothing - sheet->smoothing[1][i] <= rounding * fish->smoothing;
}

// the taper differs from 1 by exp(-ratio^2), which is below the rounding above for a square ratio of 31
int free_sheet_is_far(const struct fish *fish, const double from_tail[2]) {
    static const double far = 5.5677643628300219;
    const double length = fmax(fish->taper, fish->taper_beside);
    return from_tail[0] * from_tail[0] + from_tail[1] * from_tail[1] > far * length * length;
}

// whether the middle of a stretch is far from the tail at the start (ends at[0]) and at the end (at[1]) of the interval
static int stretch_is_far(const struct fish *fish, const struct wake *markers, double interval,
                          const struct ends at[2]) {
    const int newest = markers->n_vortex - 1;
    int is_far = 1;
    for (int end = 0; end < 2; end++) {
        const double tau = end * interval;
        const double from_tail[2] = {
            (at[end].newer[0] + at[end].older[0]) / 2 - markers->x[newest] - tau * markers->tail_velocity[0],
            (at[end].newer[1] + at[end].older[1]) / 2 - markers->y[newest] - tau * markers->tail_velocity[1]};
        is_far &= free_sheet_is_far(fish, from_tail);
    }

    return is_far;
}

enum status free_sheet_build(struct free_sheet *sheet, const struct fish *fish, const struct school *school,
                             const struct wake *markers) {
    const int n_stretches = markers->n_vortex - 1;
    TRY(free_sheet_reserve(sheet, 2 * (n_stretches > 0 ? n_stretches : 0) + 4 * FREE_SHEET_PANEL + 1));
    sheet->n = 0;
    const double interval = school->interval;
    struct ends at[2] = {{.stretch = -2}, {.stretch = -2}};

    // middles of old stretches, with tapered smoothing
    for (int i = n_stretches - FREE_SHEET_PAIRED - 1; i >= 0; i--) {
        for (int end = 0; end < 2; end++) stretch_find_ends(&at[end], markers, i, interval, end * interval);
        if (stretch_is_far(fish, markers, interval, at)) continue;
        free_sheet_add(sheet, fish, markers, interval, at, 0.5, 1);
        if (free_sheet_is_untapered(sheet, fish, sheet->n - 1)) sheet->n--;
    }

    sheet->n_tapered = sheet->n;

    // points of the newest stretches, in place of the middles
    for (int age = 1; age <= FREE_SHEET_PAIRED && age <= n_stretches; age++) {
        for (int end = 0; end < 2; end++)
            stretch_find_ends(&at[end], markers, n_stretches - age, interval, end * interval);
        for (int k = 0; age <= FREE_SHEET_GRADED && k < FREE_SHEET_PANEL; k++) {
            free_sheet_add(sheet, fish, markers, interval, at, free_sheet_xi[k], free_sheet_part[k]);
        }

        for (int k = 0; age > FREE_SHEET_GRADED && k < 2; k++)
            free_sheet_add(sheet, fish, markers, interval, at, free_sheet_pair_xi[k], 0.5);
        free_sheet_add(sheet, fish, markers, interval, at, 0.5, -1);
    }

    sheet->n += FREE_SHEET_PANEL + 1;
    return STATUS_OK;
}

void free_sheet_place(struct free_sheet *sheet, const struct school *school, const struct wake *markers,
                      const struct wake *middles, double t, double tau) {
    const double q = tau / school->interval;
    struct ends ends = {.stretch = -2};
    double strength = 1;

    for (int i = 0; i < sheet->n - (FREE_SHEET_PANEL + 1); i++) {
        const int stretch = sheet->stretch[i];
        if (stretch != ends.stretch) {
            stretch_find_ends(&ends, markers, stretch, school->interval, tau);
            strength = wake_strength_within(school, t - middles->birth[stretch], q);
        }

        double point[2];
        sheet_stretch_point(&ends, sheet->xi[i], point);
        const double smoothing = (1 - q) * sheet->smoothing[0][i] + q * sheet->smoothing[1][i];
        sheet->x[i] = point[0];
        sheet->y[i] = point[1];
        sheet->circulation[i] = sheet->part[i] * middles->circulation[stretch] * strength;
        sheet->square[i] = smoothing * smoothing;
    }
}

void free_sheet_nascent_point(const struct wake *markers, double interval, double tau, const double tail[2], double xi,
                              double point[2]) {
    double newest[2] = {tail[0], tail[1]};
    if (markers->n_vortex > 0) wake_marker(markers, markers->n_vortex - 1, interval, tau, newest);
    for (int k = 0; k < 2; k++) point[k] = (1 - xi) * tail[k] + xi * newest[k];
}

/* Beside the tail is x - s t with s = (x - x_tail) . t < 0. This point moves with the tail along t and, as the tangent
 * turns, dt = n (n.dX')/|X'|, by -((r.n) t + s n)/|X'| per n.dX'. */
struct nascent_end free_sheet_nascent_end(const double marker[2], const double tail[2],
                                          const struct direction *tangent) {
    struct nascent_end end;
    const double r[2] = {marker[0] - tail[0], marker[1] - tail[1]};
    const double s = fmin(0, edge_dot(r, tangent->t)), across = edge_dot(r, tangent->n);
    end.is_overtaken = s < 0;
    for (int k = 0; k < 2; k++) {
        end.x[k] = marker[k] - s * tangent->t[k];
        end.by_turn[k] = -(across * tangent->t[k] + s * tangent->n[k]) / tangent->length;
        end.tangent[k] = tangent->t[k];
        end.normal[k] = tangent->n[k];
    }

    return end;
}

void free_sheet_place_nascent(struct free_sheet *sheet, const struct fish *fish, const struct wake *markers,
                              double interval, double tau, const double tail[2], const struct direction *tangent,
                              double circulation) {
    const int first = sheet->n - (FREE_SHEET_PANEL + 1);
    double marker[2];
    free_sheet_nascent_point(markers, interval, tau, tail, 1, marker);
    sheet->end = free_sheet_nascent_end(marker, tail, tangent);
    const double *const end = sheet->end.x;

    for (int i = 0; i < FREE_SHEET_PANEL; i++) {
        const double xi = free_sheet_xi[i];
        sheet->x[first + i] = (1 - xi) * tail[0] + xi * end[0];
        sheet->y[first + i] = (1 - xi) * tail[1] + xi * end[1];
        sheet->circulation[first + i] = free_sheet_part[i] * circulation;
        sheet->square[first + i] = 0;
    }

    // subtract the middle, which is a source for all other targets
    const int middle = first + FREE_SHEET_PANEL;
    sheet->x[middle] = (tail[0] + marker[0]) / 2;
    sheet->y[middle] = (tail[1] + marker[1]) / 2;
    sheet->circulation[middle] = -circulation;
    sheet->square[middle] = fish->smoothing * fish->smoothing;
}
