/* sheet.c: points of stretches, and markers, with the legs; smoothing near the tail; the end of the nascent stretch. */
#include "wake/sheet.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/mathematics.h"
#include "base/memory.h"
#include "body/rod.h"

/* Gauss-Legendre on [0, 1]: eta = 0.0694318, 0.3300095, 0.6699905, 0.9305682 with weights w; xi = eta^2, part = 2 eta
 * w. */
static const double panel_xi[SHEET_PANEL] = {0.004820780989426014, 0.10890625570683385, 0.44888729929169013,
                                             0.8659570925834785};
static const double panel_part[SHEET_PANEL] = {0.024152203412833233, 0.215214082271785, 0.4369310725907612,
                                               0.32370264172462043};
static const double pair_xi[2] = {0.21132486540518712, 0.78867513459481288};  // Gauss-Legendre

// ---- the tail

double sheet_taper(const struct fish *fish, const double from_tail[2], const double tangent[2]) {
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

// whether the smoothing is untapered for any tangent: the taper differs from 1 by exp(-ratio^2), 3e-14 for a ratio of
// 5.6
static int sheet_is_far(const struct fish *fish, const double from_tail[2]) {
    static const double far = 5.5677643628300219;
    const double length = fmax(fish->taper, fish->taper_beside);
    return from_tail[0] * from_tail[0] + from_tail[1] * from_tail[1] > far * length * length;
}

/* Beside the tail is x - s t with s = (x - x_tail) . t < 0. This point moves with the tail along t and, as the tangent
 * turns, dt = n (n.dX')/|X'|, by -((r.n) t + s n)/|X'| per n.dX'. */
static struct nascent_end sheet_nascent_end(const double marker[2], const double tail[2],
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

void sheet_newest(const struct wake *wake, double interval, double tau, const double tail[2], double point[2]) {
    memcpy(point, tail, 2 * sizeof *point);
    if (wake->n_vortex > 0) wake_marker(wake, wake->n_vortex - 1, interval, tau, point);
}

// ---- points of stretches

// both ends of a stretch at one time
struct ends {
    double newer[2], older[2];
};

static struct ends stretch_ends(const double *x, const double *y, int stretch) {
    return (struct ends){.newer = {x[stretch + 1], y[stretch + 1]}, .older = {x[stretch], y[stretch]}};
}

// point at the fraction xi of the way from the newer to the older end
static void stretch_point(const struct ends *ends, double xi, double point[2]) {
    for (int i = 0; i < 2; i++) point[i] = (1 - xi) * ends->newer[i] + xi * ends->older[i];
}

// s of a point of the wake at this distance from the own tail along the sheet, m2
static double sheet_leg(double depth, double distance) {
    if (!(depth > 0)) return 0;
    const double ratio = distance / (3 * depth), fourth = ratio * ratio * ratio * ratio;

    // exp(-40) is less than the rounding of 1
    return depth * depth / 8 * (fourth < 40 ? -expm1(-fourth) : 1);
}

static void points_free(struct sheet_points *points) {
    double *const owned[] = {points->xi,           points->part,   points->smoothing[0],
                             points->smoothing[1], points->leg[0], points->leg[1]};
    for (size_t i = 0; i < sizeof owned / sizeof *owned; i++) free(owned[i]);
    free(points->stretch);
    sources_free(&points->sources);
    *points = (struct sheet_points){0};
}

void sheet_free(struct sheet *sheet) {
    points_free(&sheet->graded);
    points_free(&sheet->middles);
    for (int end = 0; end < 2; end++) {
        double *const owned[] = {sheet->x[end], sheet->y[end], sheet->length[end]};
        for (size_t i = 0; i < sizeof owned / sizeof *owned; i++) free(owned[i]);
    }
    free(sheet->label);
    *sheet = (struct sheet){0};
}

static enum status points_reserve(struct sheet_points *points, int n) {
    if (n <= points->capacity) return STATUS_OK;
    const int capacity = n + n / 2;
    points_free(points);
    double **const all[] = {&points->xi,           &points->part,   &points->smoothing[0],
                            &points->smoothing[1], &points->leg[0], &points->leg[1]};

    TRY(MEMORY_NEW(points->stretch, capacity, "points of a free sheet"));
    TRY(MEMORY_ARRAYS(all, capacity, "the points of a free sheet"));
    points->capacity = capacity;
    return STATUS_OK;
}

static enum status sheet_reserve(struct sheet *sheet, int n) {
    if (n > sheet->capacity) {
        const int capacity = n + n / 2;
        sheet_free(sheet);
        double **const all[] = {&sheet->x[0],  &sheet->x[1],      &sheet->y[0],     &sheet->y[1],
                                &sheet->label, &sheet->length[0], &sheet->length[1]};
        TRY(MEMORY_ARRAYS(all, capacity, "the markers of a free sheet"));
        sheet->capacity = capacity;
    }
    TRY(points_reserve(&sheet->graded, n + 2 * SHEET_PAIRED + 4 * SHEET_PANEL));
    return points_reserve(&sheet->middles, n + 2 * SHEET_PAIRED + 4 * SHEET_PANEL);
}

static void points_add(const struct sheet *from, struct sheet_points *points, int is_graded, const struct fish *fish,
                       const struct wake *wake, double interval, int stretch, const double distance[2], double xi,
                       double part) {
    const int i = points->n_released++, newest = wake->n_vortex - 1;
    points->stretch[i] = stretch;
    points->xi[i] = xi;
    points->part[i] = part;

    for (int end = 0; end < 2; end++) {
        const double tau = end * interval;
        const struct ends at = stretch_ends(from->x[end], from->y[end], stretch);
        double point[2];
        stretch_point(&at, xi, point);
        const double from_tail[2] = {point[0] - wake->x[newest] - tau * wake->tail_velocity[0],
                                     point[1] - wake->y[newest] - tau * wake->tail_velocity[1]};

        // middles are sources for other targets, with the full smoothing of the pair
        points->smoothing[end][i] = 0;
        if (is_graded) {
            points->smoothing[end][i] =
                sheet_is_far(fish, from_tail) ? fish->smoothing : sheet_taper(fish, from_tail, wake->tail_tangent);
        }
        points->leg[end][i] = sheet_leg(fish->strip_depth, distance[end] + xi * from->length[end][stretch]);
    }
}

// lengths of the stretches; returns the length of the sheet from the tail to the oldest marker
static double stretch_lengths(const struct wake *wake, double tau, const double *x, const double *y,
                              double *restrict length) {
    const int newest = wake->n_vortex - 1;
    if (newest < 0) return 0;
    for (int i = 0; i < newest; i++) {
        const double along[2] = {x[i + 1] - x[i], y[i + 1] - y[i]};
        length[i] = sqrt(along[0] * along[0] + along[1] * along[1]);
    }

    // the tail keeps its velocity
    const double to_tail[2] = {wake->x[newest] + tau * wake->tail_velocity[0] - x[newest],
                               wake->y[newest] + tau * wake->tail_velocity[1] - y[newest]};
    double sum = sqrt(to_tail[0] * to_tail[0] + to_tail[1] * to_tail[1]);
    for (int i = newest - 1; i >= 0; i--) sum += length[i];
    return sum;
}

static enum status points_finish(struct sheet_points *points, const struct fish *fish) {
    points->sources.n = 0;
    TRY(sources_append(&points->sources, points->n_released + points->n_nascent));
    for (int i = 0; i < points->sources.n; i++) {
        points->sources.half[i] = fish->strip_depth * fish->strip_depth / 32;
    }
    return STATUS_OK;
}

enum status sheet_build(struct sheet *sheet, const struct fish *fish, const struct school *school,
                        const struct wake *wake) {
    const int n_stretches = wake->n_vortex > 0 ? wake->n_vortex - 1 : 0;
    struct sheet_points *const graded = &sheet->graded, *const middles = &sheet->middles;
    TRY(sheet_reserve(sheet, wake->n_vortex));
    graded->n_released = middles->n_released = 0;
    graded->n_nascent = SHEET_PANEL;
    middles->n_nascent = 1;

    if (school->shedding != SHEDDING_SHEET) {
        graded->n_nascent = 0;
        middles->n_released = wake->n_vortex;
        return points_finish(middles, fish);
    }

    // markers and stretches at both ends of the interval; distances from the tail along the sheet
    double distance[2];
    for (int end = 0; end < 2; end++) {
        const double tau = end * school->interval;
        wake_places(wake, school->interval, tau, sheet->x[end], sheet->y[end]);
        distance[end] = stretch_lengths(wake, tau, sheet->x[end], sheet->y[end], sheet->length[end]);
    }

    sheet->n_single = n_stretches > SHEET_PAIRED ? n_stretches - SHEET_PAIRED : 0;
    for (int i = 0; i < n_stretches; i++) {
        const int age = n_stretches - i;
        const int n = age <= SHEET_GRADED ? SHEET_PANEL : age <= SHEET_PAIRED ? 2 : 1;
        for (int end = 0; end < 2; end++) distance[end] -= sheet->length[end][i];

        for (int k = 0; k < n; k++) {
            const double xi = n == 1 ? 0.5 : n == 2 ? pair_xi[k] : panel_xi[k];
            const double part = n <= 2 ? 1.0 / n : panel_part[k];
            points_add(sheet, graded, 1, fish, wake, school->interval, i, distance, xi, part);
        }

        // the middles of old stretches are the points of both views: sheet_place copies the points
        if (i < sheet->n_single) {
            middles->n_released++;
        } else {
            points_add(sheet, middles, 0, fish, wake, school->interval, i, distance, 0.5, 1);
        }
    }

    TRY(points_finish(graded, fish));
    return points_finish(middles, fish);
}

// set source i at the fraction xi of a stretch with the labels newer and older at its ends
static void point_set(const struct sources *sources, int i, const struct ends *ends, double xi, double part,
                      double newer, double older) {
    const double along = -(newer + xi * (older - newer)) * part;
    double point[2];
    stretch_point(ends, xi, point);

    sources->x[i] = point[0];
    sources->y[i] = point[1];
    sources->q[i] = part * (newer - older);
    sources->dx[i] = along * (ends->older[0] - ends->newer[0]);
    sources->dy[i] = along * (ends->older[1] - ends->newer[1]);
}

// points of the stretches from point first on
static void points_place(const struct sheet *sheet, const struct sheet_points *points, int first, double q) {
    const struct sources *const sources = &points->sources;
    for (int i = first; i < points->n_released; i++) {
        const int stretch = points->stretch[i];
        const struct ends ends = stretch_ends(sheet->x[0], sheet->y[0], stretch);
        point_set(sources, i, &ends, points->xi[i], points->part[i], sheet->label[stretch + 1], sheet->label[stretch]);
    }

    for (int i = first; i < points->n_released; i++) {
        const double smoothing = (1 - q) * points->smoothing[0][i] + q * points->smoothing[1][i];
        sources->square[i] = smoothing * smoothing;
        sources->leg[i] = (1 - q) * points->leg[0][i] + q * points->leg[1][i];
    }
}

// point_set of the middles of the oldest stretches
static void place_middles(const struct sheet *sheet, const struct sources *sources) {
    const double *const x = sheet->x[0], *const y = sheet->y[0], *const label = sheet->label;
    double *restrict const to_x = sources->x, *restrict const to_y = sources->y, *restrict const q = sources->q;
    double *restrict const dx = sources->dx, *restrict const dy = sources->dy;
    for (int i = 0; i < sheet->n_single; i++) {
        const double along = -(label[i + 1] + 0.5 * (label[i] - label[i + 1]));
        to_x[i] = 0.5 * x[i + 1] + 0.5 * x[i];
        to_y[i] = 0.5 * y[i + 1] + 0.5 * y[i];
        q[i] = label[i + 1] - label[i];
        dx[i] = along * (x[i] - x[i + 1]);
        dy[i] = along * (y[i] - y[i + 1]);
    }
}

void sheet_place(struct sheet *sheet, const struct school *school, const struct wake *wake, double t, double tau) {
    const double q = tau / school->interval;
    const struct sheet_points *const graded = &sheet->graded;
    const struct sources *const from = &graded->sources, *const to = &sheet->middles.sources;
    if (school->shedding != SHEDDING_SHEET) {
        wake_places(wake, school->interval, tau, to->x, to->y);
        wake_strengths(wake, school, t, tau, q, to->q);
        return;
    }

    wake_places(wake, school->interval, tau, sheet->x[0], sheet->y[0]);
    wake_strengths(wake, school, t, tau, q, sheet->label);
    place_middles(sheet, from);
    for (int i = 0; i < sheet->n_single; i++) {
        const double smoothing = (1 - q) * graded->smoothing[0][i] + q * graded->smoothing[1][i];
        from->square[i] = smoothing * smoothing;
        from->leg[i] = (1 - q) * graded->leg[0][i] + q * graded->leg[1][i];
    }

    // the other view
    double *const copies[][2] = {{from->x, to->x},   {from->y, to->y},   {from->q, to->q},
                                 {from->dx, to->dx}, {from->dy, to->dy}, {from->leg, to->leg}};
    for (size_t i = 0; i < sizeof copies / sizeof *copies; i++) {
        memcpy(copies[i][1], copies[i][0], (size_t)sheet->n_single * sizeof(double));
    }

    points_place(sheet, graded, sheet->n_single, q);
    points_place(sheet, &sheet->middles, sheet->n_single, q);
}

double sheet_xi(const struct sheet_points *points, int i) {
    return points->n_nascent == 1 ? 0.5 : panel_xi[i];
}

double sheet_part(const struct sheet_points *points, int i) {
    return points->n_nascent == 1 ? 1 : panel_part[i];
}

double sheet_place_nascent(struct sheet_points *points, const struct school *school, const struct wake *wake, double t,
                           double tau, const double tail[2], const struct direction *tangent, double shed) {
    const int newest = wake->n_vortex - 1;
    if (school->shedding != SHEDDING_SHEET) {
        double at[2];
        wake_nascent(wake, tau, tail, at);
        points->sources.x[points->n_released] = at[0];
        points->sources.y[points->n_released] = at[1];
        points->sources.q[points->n_released] = shed - wake->shed_before;
        return shed - wake->shed_before;
    }

    const double older = newest >= 0 ? wake_newest(wake, school, t, tau) : wake->shed_before;
    double marker[2];
    sheet_newest(wake, school->interval, tau, tail, marker);
    points->end =
        tangent ? sheet_nascent_end(marker, tail, tangent) : (struct nascent_end){.x = {marker[0], marker[1]}};
    const struct ends ends = {.newer = {tail[0], tail[1]}, .older = {points->end.x[0], points->end.x[1]}};
    for (int i = 0; i < 2; i++) points->way[i] = ends.older[i] - tail[i];

    for (int k = 0; k < points->n_nascent; k++) {
        point_set(&points->sources, points->n_released + k, &ends, sheet_xi(points, k), sheet_part(points, k), shed,
                  older);
    }
    return shed - older;
}

// ends of the panels of a steady wake, in depths: 0, 1/4, 1/2, 1, 2, 3, ..
static double steady_end(int panel) {
    return panel < 3 ? panel / 4.0 : panel - 2;
}

enum status sheet_place_steady(struct sheet_points *points, const struct fish *fish, const double tail[2],
                               const double along[2], double shed, double reach) {
    enum { NODES = 8, LEAST = 30 };
    const double depth = fish->strip_depth, most = 1e5;
    if (depth > 0 && !(reach <= most * depth)) {
        return status_fail(STATUS_CASE,
                           "%s: fish are up to %.3g m apart, %.3g depths; a steady wake has at most %g: move the fish "
                           "closer together, or increase body.depth",
                           fish->name, reach, reach / depth, most);
    }
    const int n_panels = depth > 0 ? (int)fmax(LEAST, ceil(reach / depth)) + 2 : 0;
    const int n = depth > 0 ? (n_panels + 1) * NODES : 0;
    struct sources *const sources = &points->sources;
    double node[NODES], weight[NODES];
    quadrature_legendre(NODES, node, weight);
    TRY(points_reserve(points, n));
    points->n_released = 0;
    points->n_nascent = n;
    sources->n = 0;
    TRY(sources_append(sources, n));

    // behind the last end, where the legs act like 1/d^3, quadrature in 1/d
    for (int i = 0; i < n; i++) {
        const int panel = i / NODES, is_last = panel == n_panels;
        const double q = node[i % NODES], part = weight[i % NODES], first = depth * steady_end(panel);
        const double length = is_last ? first : depth * steady_end(panel + 1) - first;
        const double distance = is_last ? first / q : first + q * length;

        points->part[i] = part * length / (is_last ? q * q : 1);
        sources->x[i] = tail[0] + distance * along[0];
        sources->y[i] = tail[1] + distance * along[1];
        sources->dx[i] = -shed * points->part[i] * along[0];
        sources->dy[i] = -shed * points->part[i] * along[1];
        sources->half[i] = depth * depth / 32;
        sources->leg[i] = sheet_leg(depth, distance);
    }
    return STATUS_OK;
}

double sheet_steady_length(const struct sheet_points *points, int i) {
    return points->part[i];
}

enum status sheet_markers(struct sources *sources, const struct fish *fish, const struct school *school,
                          const struct wake *wake, double t, double nascent) {
    const int n = wake->n_vortex, first = sources->n;
    TRY(sources_append(sources, n));
    const struct sources *const to = sources;
    if (n == 0) return STATUS_OK;
    memcpy(to->x + first, wake->x, (size_t)n * sizeof *to->x);
    memcpy(to->y + first, wake->y, (size_t)n * sizeof *to->y);

    // labels in the place of s, and lengths of the stretches in the place of b^2/2
    double *const label = to->leg + first, *const length = to->half + first, before = 0;
    wake_strengths(wake, school, t, 0, 0, label);
    double distance = stretch_lengths(wake, 0, wake->x, wake->y, length);
    for (int i = 0; i < n; i++) {
        const double here = label[i], next = i + 1 < n ? length[i] : 0, stretch = i > 0 ? here - before : 0;
        const int newer = i + 1 < n ? i + 1 : i, older = i > 0 ? i - 1 : 0;
        to->dx[first + i] = -here * (wake->x[older] - wake->x[newer]) / 2;
        to->dy[first + i] = -here * (wake->y[older] - wake->y[newer]) / 2;
        to->half[first + i] = fish->strip_depth * fish->strip_depth / 32;
        to->leg[first + i] = sheet_leg(fish->strip_depth, distance);
        distance -= next;
        before = here;
        to->q[first + i] += stretch / 2;
        if (i > 0) to->q[first + i - 1] += stretch / 2;
    }

    // the nascent stretch has length 0 at the event: both halves act at the newest marker
    to->q[first + n - 1] += nascent;
    return STATUS_OK;
}
