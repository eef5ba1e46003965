/* sheet.c: points of stretches, and markers, with the legs; smoothing near the tail; the end of the nascent stretch. */
#include "wake/sheet.h"

#include <math.h>
#include <string.h>

#include "base/mathematics.h"
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

void sheet_newest(const struct wake *wake, double interval, double tau, const double tail[2], double point[2]) {
    memcpy(point, tail, 2 * sizeof *point);
    if (wake->n_vortex > 0) wake_marker(wake, wake->n_vortex - 1, interval, tau, point);
}

// ---- points of stretches

// s of a point of the wake at this distance from its tail along the sheet, m2
static double sheet_leg(double depth, double distance) {
    if (!(depth > 0)) return 0;
    const double ratio = distance / (3 * depth), fourth = ratio * ratio * ratio * ratio;

    // exp(-40) is less than the rounding of 1
    return depth * depth / 8 * (fourth < 40 ? -expm1(-fourth) : 1);
}

static void points_reserve(struct arena *arena, struct sheet_points *points, int n) {
    if (n <= points->capacity) return;
    double **const all[] = {&points->xi,           &points->part,   &points->smoothing[0],
                            &points->smoothing[1], &points->leg[0], &points->leg[1]};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) GROW(arena, *all[i], n);
    GROW(arena, points->stretch, n);
    points->sources.arena = arena;
    points->sources.n = 0;
    sources_append(&points->sources, n);
    points->capacity = n;
}

void sheet_reserve(struct arena *arena, struct sheet *sheet, int n) {
    if (sheet->arena && n <= sheet->capacity) return;
    sheet->arena = arena;
    sheet->capacity = n + n / 2;
    double **const all[] = {&sheet->x[0],  &sheet->x[1],      &sheet->y[0],     &sheet->y[1],
                            &sheet->label, &sheet->length[0], &sheet->length[1]};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) GROW(arena, *all[i], sheet->capacity);
    points_reserve(arena, &sheet->graded, sheet->capacity + 2 * SHEET_PAIRED + 4 * SHEET_PANEL);
    points_reserve(arena, &sheet->middles, sheet->capacity + 2 * SHEET_PAIRED + 4 * SHEET_PANEL);
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

static void points_add(const struct sheet *from, struct sheet_points *points, bool is_graded, const struct fish *fish,
                       const struct wake *wake, double interval, int stretch, const double distance[2], double xi,
                       double part) {
    const int i = points->n_released++, newest = wake->n_vortex - 1;
    points->stretch[i] = stretch;
    points->xi[i] = xi;
    points->part[i] = part;

    for (int end = 0; end < 2; end++) {
        const double tau = end * interval, *const x = from->x[end] + stretch, *const y = from->y[end] + stretch;
        const double from_tail[2] = {(1 - xi) * x[1] + xi * x[0] - wake->x[newest] - tau * wake->tail_velocity[0],
                                     (1 - xi) * y[1] + xi * y[0] - wake->y[newest] - tau * wake->tail_velocity[1]};

        // beyond this square of the distance the taper differs from 1 by exp(-ratio^2) = 3e-14, for any tangent
        const double taper = fmax(fish->taper, fish->taper_beside), far = 5.5677643628300219 * taper * taper;
        const bool is_far = from_tail[0] * from_tail[0] + from_tail[1] * from_tail[1] > far;

        // middles are sources for other targets, with the full smoothing of the pair
        points->smoothing[end][i] = 0;
        if (is_graded) {
            points->smoothing[end][i] = is_far ? fish->smoothing : sheet_taper(fish, from_tail, wake->tail_tangent);
        }
        points->leg[end][i] = sheet_leg(fish->strip_depth, distance[end] + xi * from->length[end][stretch]);
    }
}

void sheet_build(struct sheet *sheet, const struct fish *fish, const struct school *school, const struct wake *wake) {
    const bool is_sheet = school->shedding == SHEDDING_SHEET;
    const int n_stretches = is_sheet && wake->n_vortex > 0 ? wake->n_vortex - 1 : 0;
    struct sheet_points *const graded = &sheet->graded, *const middles = &sheet->middles;
    graded->n_released = 0;
    middles->n_released = is_sheet ? 0 : wake->n_vortex;
    graded->n_nascent = is_sheet ? SHEET_PANEL : 0;
    middles->n_nascent = 1;

    // markers and stretches at both ends of the interval; distances from the tail along the sheet
    double distance[2] = {0, 0};
    for (int end = 0; end < 2 && is_sheet; end++) {
        const double tau = end * school->interval;
        wake_places(wake, school->interval, tau, sheet->x[end], sheet->y[end]);
        distance[end] = stretch_lengths(wake, tau, sheet->x[end], sheet->y[end], sheet->length[end]);
    }

    // more points for newer stretches
    sheet->n_single = n_stretches > SHEET_PAIRED ? n_stretches - SHEET_PAIRED : 0;
    for (int i = 0; i < n_stretches; i++) {
        const int age = n_stretches - i;
        const int n = age <= SHEET_GRADED ? SHEET_PANEL : age <= SHEET_PAIRED ? 2 : 1;
        for (int end = 0; end < 2; end++) distance[end] -= sheet->length[end][i];

        for (int k = 0; k < n; k++) {
            const double xi = n == 1 ? 0.5 : n == 2 ? pair_xi[k] : panel_xi[k];
            const double part = n <= 2 ? 1.0 / n : panel_part[k];
            points_add(sheet, graded, true, fish, wake, school->interval, i, distance, xi, part);
        }

        // the middles of old stretches are the points of both views: sheet_place copies the points
        if (i < sheet->n_single) {
            middles->n_released++;
        } else {
            points_add(sheet, middles, false, fish, wake, school->interval, i, distance, 0.5, 1);
        }
    }

    // the nascent stretch or vortex
    for (int k = 0; k < graded->n_nascent; k++) {
        graded->xi[graded->n_released + k] = panel_xi[k];
        graded->part[graded->n_released + k] = panel_part[k];
    }
    middles->xi[middles->n_released] = is_sheet ? 0.5 : 0;
    middles->part[middles->n_released] = 1;

    struct sheet_points *const both[2] = {graded, middles};
    for (int view = 0; view < 2; view++) {
        struct sources *const sources = &both[view]->sources;
        sources->n = 0;
        sources_append(sources, both[view]->n_released + both[view]->n_nascent);
        for (int i = 0; i < sources->n; i++) sources->half[i] = fish->strip_depth * fish->strip_depth / 32;
    }
}

// set source i of a stretch with the labels newer and older at these ends
static void point_set(const struct sheet_points *points, int i, const double newer_end[2], const double older_end[2],
                      double newer, double older) {
    const struct sources *const sources = &points->sources;
    const double xi = points->xi[i], part = points->part[i], along = -(newer + xi * (older - newer)) * part;
    sources->x[i] = (1 - xi) * newer_end[0] + xi * older_end[0];
    sources->y[i] = (1 - xi) * newer_end[1] + xi * older_end[1];
    sources->q[i] = part * (newer - older);
    sources->dx[i] = along * (older_end[0] - newer_end[0]);
    sources->dy[i] = along * (older_end[1] - newer_end[1]);
}

// set the points of the stretches from point first on
static void points_place(const struct sheet *sheet, const struct sheet_points *points, int first, double q) {
    const double *const x = sheet->x[0], *const y = sheet->y[0], *const label = sheet->label;
    for (int i = first; i < points->n_released; i++) {
        const int k = points->stretch[i];
        const double newer[2] = {x[k + 1], y[k + 1]}, older[2] = {x[k], y[k]};
        point_set(points, i, newer, older, label[k + 1], label[k]);
    }

    const struct sources *const sources = &points->sources;
    for (int i = first; i < points->n_released; i++) {
        const double smoothing = (1 - q) * points->smoothing[0][i] + q * points->smoothing[1][i];
        sources->square[i] = smoothing * smoothing;
        sources->leg[i] = (1 - q) * points->leg[0][i] + q * points->leg[1][i];
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

    // the middles of the oldest stretches
    const double *const x = sheet->x[0], *const y = sheet->y[0], *const label = sheet->label;
    double *restrict const to_x = from->x, *restrict const to_y = from->y, *restrict const strength = from->q;
    double *restrict const dx = from->dx, *restrict const dy = from->dy;
    for (int i = 0; i < sheet->n_single; i++) {
        const double along = -(label[i + 1] + 0.5 * (label[i] - label[i + 1]));
        to_x[i] = 0.5 * x[i + 1] + 0.5 * x[i];
        to_y[i] = 0.5 * y[i + 1] + 0.5 * y[i];
        strength[i] = label[i + 1] - label[i];
        dx[i] = along * (x[i] - x[i + 1]);
        dy[i] = along * (y[i] - y[i + 1]);
    }
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

double sheet_place_nascent(struct sheet_points *points, const struct school *school, const struct wake *wake, double t,
                           double tau, const double tail[2], const struct direction *tangent, double shed) {
    const int newest = wake->n_vortex - 1, first = points->n_released;
    if (school->shedding != SHEDDING_SHEET) {
        double at[2];
        wake_nascent(wake, tau, tail, at);
        points->sources.x[first] = at[0];
        points->sources.y[first] = at[1];
        points->sources.q[first] = shed - wake->shed_before;
        return shed - wake->shed_before;
    }

    struct wake_decay decay = {.wake = wake, .school = school, .t = t, .tau = tau, .q = tau / school->interval};
    const double older = newest >= 0 ? wake_next_strength(&decay, newest) : wake->shed_before;
    struct nascent_end *const end = &points->end;
    *end = (struct nascent_end){.is_overtaken = 0};
    sheet_newest(wake, school->interval, tau, tail, end->x);

    // beside the tail is x - s t with s = (x - x_tail) . t < 0; this point moves with the tail along t and, as the
    // tangent turns, dt = n (n.dX')/|X'|, by -((r.n) t + s n)/|X'| per n.dX'
    if (tangent) {
        const double r[2] = {end->x[0] - tail[0], end->x[1] - tail[1]};
        const double s = fmin(0, edge_dot(r, tangent->t)), across = edge_dot(r, tangent->n);
        end->is_overtaken = s < 0;
        for (int k = 0; k < 2; k++) {
            end->x[k] -= s * tangent->t[k];
            end->by_turn[k] = -(across * tangent->t[k] + s * tangent->n[k]) / tangent->length;
            end->tangent[k] = tangent->t[k];
            end->normal[k] = tangent->n[k];
        }
    }

    for (int k = 0; k < 2; k++) points->way[k] = end->x[k] - tail[k];
    for (int i = first; i < first + points->n_nascent; i++) point_set(points, i, tail, end->x, shed, older);
    return shed - older;
}

// ends of the panels of a steady wake, in depths: 0, 1/4, 1/2, 1, 2, 3, ..
static double steady_end(int panel) {
    return panel < 3 ? panel / 4.0 : panel - 2;
}

void sheet_place_steady(struct sheet *sheet, struct sheet_points *points, const struct fish *fish, const double tail[2],
                        const double along[2], double shed, double reach) {
    enum { NODES = 8, LEAST = 30 };
    const double depth = fish->strip_depth;
    const int n_panels = depth > 0 ? (int)fmax(LEAST, ceil(reach / depth)) + 2 : 0;
    const int n = depth > 0 ? (n_panels + 1) * NODES : 0;
    struct sources *const sources = &points->sources;
    double node[NODES], weight[NODES];
    quadrature_legendre(NODES, node, weight);
    points_reserve(sheet->arena, points, n);
    points->n_released = 0;
    points->n_nascent = n;
    sources->n = 0;
    sources_append(sources, n);

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
}

void sheet_markers(struct sources *sources, const struct fish *fish, const struct school *school,
                   const struct wake *wake, double t, double nascent) {
    const int n = wake->n_vortex, first = sources->n;
    sources_append(sources, n);
    const struct sources *const to = sources;
    if (n == 0) return;
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
}
