/* sheet.c: turns the queue of a wake into sources: points of stretches, or markers, with their legs. It also finds how
 * the smoothing tapers near the tail, and where the nascent stretch ends. */
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
static double sheet_leg(const struct fish *fish, double distance) {
    if (!(fish->strip_depth > 0)) return 0;
    const double ratio = distance / (3 * fish->strip_depth), fourth = ratio * ratio * ratio * ratio;

    // exp(-40) is less than the rounding of 1
    return fish->leg_length * (fourth < 40 ? -expm1(-fourth) : 1);
}

static void points_reserve(struct arena *arena, struct sheet_points *points, int n) {
    if (n <= points->capacity) return;
    double **const all[] = {&points->xi,     &points->part,   &points->smoothing[0], &points->smoothing[1],
                            &points->leg[0], &points->leg[1], &points->remains[0],   &points->remains[1]};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) GROW(arena, *all[i], n);
    GROW(arena, points->newer, n);
    GROW(arena, points->older, n);
    points->sources.arena = arena;
    points->sources.n = 0;
    sources_append(&points->sources, n);
    points->capacity = n;
}

void sheet_reserve(struct arena *arena, struct sheet *sheet, int n) {
    if (sheet->arena && n <= sheet->capacity) return;
    sheet->arena = arena;
    sheet->capacity = n + n / 2;
    double **const padded[] = {&sheet->x[0], &sheet->x[1], &sheet->y[0], &sheet->y[1], &sheet->label};
    double **const all[] = {&sheet->remains[0], &sheet->remains[1], &sheet->distance[0], &sheet->distance[1],
                            &sheet->birth};
    for (size_t i = 0; i < sizeof padded / sizeof *padded; i++) {
        GROW(arena, *padded[i], sheet->capacity + 2 * SHEET_PAD);
    }
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) GROW(arena, *all[i], sheet->capacity);
    for (int k = 0; k < SHEET_DIAGONALS; k++) GROW(arena, sheet->diagonal[k], sheet->capacity);
    const int most = sheet->capacity + STRETCH_MARKERS + 2 * SHEET_PAIRED + 4 * SHEET_PANEL;
    points_reserve(arena, &sheet->graded, most);
    points_reserve(arena, &sheet->middles, most);
}

// distances of the markers from the tail along the sheet
static void set_distances(const struct wake *wake, double tau, const double *x, const double *y,
                          double *restrict distance) {
    const int newest = wake->n_vortex - 1;
    if (newest < 0) return;

    // the tail keeps its velocity
    double before[2] = {wake->x[newest] + tau * wake->tail_velocity[0], wake->y[newest] + tau * wake->tail_velocity[1]};
    double sum = 0;
    for (int i = newest; i >= 0; i--) {
        const double along[2] = {before[0] - x[i], before[1] - y[i]};
        sum += sqrt(along[0] * along[0] + along[1] * along[1]);
        distance[i] = sum;
        before[0] = x[i];
        before[1] = y[i];
    }
}

// the markers at the start or at the end of the interval, with their distances and what remains of their labels
static void markers_at(struct sheet *sheet, const struct school *school, const struct wake *wake, double t, int end) {
    const double tau = end * school->interval;
    double *const x = sheet->x[end] + SHEET_PAD, *const y = sheet->y[end] + SHEET_PAD;
    wake_places(wake, school->interval, tau, x, y);
    set_distances(wake, tau, x, y, sheet->distance[end]);
    wake_parts_of_labels(wake, school, t, end, sheet->remains[end]);
}

// the smoothing of a point at the start or at the end of the interval
static void point_smooth(const struct sheet *sheet, const struct sheet_points *points, const struct fish *fish,
                         const struct school *school, const struct wake *wake, int i, int end) {
    // middles are sources for other targets, with the full smoothing of the pair
    points->smoothing[end][i] = 0;
    if (points != &sheet->graded) return;

    const int newest = wake->n_vortex - 1, newer = points->newer[i], older = points->older[i];
    const double tau = end * school->interval, xi = points->xi[i];
    const double *const x = sheet->x[end] + SHEET_PAD, *const y = sheet->y[end] + SHEET_PAD;
    const double from_tail[2] = {(1 - xi) * x[newer] + xi * x[older] - wake->x[newest] - tau * wake->tail_velocity[0],
                                 (1 - xi) * y[newer] + xi * y[older] - wake->y[newest] - tau * wake->tail_velocity[1]};

    // beyond this square of the distance the taper differs from 1 by exp(-ratio^2) = 3e-14, for any tangent
    const double taper = fmax(fish->taper, fish->taper_beside), far = 5.5677643628300219 * taper * taper;
    const bool is_far = from_tail[0] * from_tail[0] + from_tail[1] * from_tail[1] > far;
    points->smoothing[end][i] = is_far ? fish->smoothing : sheet_taper(fish, from_tail, wake->tail_tangent);
}

// the values of a point at the start or at the end of the interval
static void point_at(const struct sheet *sheet, const struct sheet_points *points, const struct fish *fish,
                     const struct school *school, const struct wake *wake, double t, int i, int end) {
    const int newer = points->newer[i], older = points->older[i];
    const double xi = points->xi[i], *const distance = sheet->distance[end];
    point_smooth(sheet, points, fish, school, wake, i, end);
    points->leg[end][i] = sheet_leg(fish, (1 - xi) * distance[newer] + xi * distance[older]);
    points->remains[end][i] = newer == older ? wake_part_of_marker(wake, school, t, end, newer)
                                             : wake_part_of_stretch(wake, school, t, end, older);
}

// add a point between two markers
static void points_add(const struct sheet *sheet, struct sheet_points *points, const struct fish *fish,
                       const struct school *school, const struct wake *wake, double t, int newer, int older, double xi,
                       double part) {
    const int i = points->n_released++;
    points->newer[i] = newer;
    points->older[i] = older;
    points->xi[i] = xi;
    points->part[i] = part;
    point_at(sheet, points, fish, school, wake, t, i, 0);
}

// the matrix of the forms of old stretches; an event, which builds a sheet twice, needs it once
static void find_diagonals(struct sheet *sheet, const struct school *school, const struct wake *wake) {
    const int n = wake->n_vortex;
    const size_t size = (size_t)n * sizeof *wake->birth;
    if (sheet->n_births == n && sheet->n_old == wake->n_old && memcmp(sheet->birth, wake->birth, size) == 0) return;
    sheet->n_births = n;
    sheet->n_old = wake->n_old;
    memcpy(sheet->birth, wake->birth, size);

    // the longest forms end with the newest marker of the newest old stretch, or with marker 5 of the oldest stretches
    const int half = STRETCH_MARKERS / 2, most = (wake->n_old > half ? wake->n_old : half) + half;
    sheet->n_markers = wake->n_old == 0 ? 0 : most < n ? most : n;
    for (int k = 0; k < SHEET_DIAGONALS; k++) {
        memset(sheet->diagonal[k], 0, (size_t)sheet->n_markers * sizeof(double));
    }
    struct stretch_form form;
    for (int j = 0; j < wake->n_old; j++) {
        stretch_set_form(&form, wake, school, j);
        for (int a = 0; a < form.n; a++) {
            for (int b = 0; b < form.n; b++) sheet->diagonal[b - a + SHEET_PAD][form.first + a] += form.part[a][b];
        }
    }
}

// select the old markers as the points of both views
static void build_old(struct sheet *sheet, const struct fish *fish, const struct school *school,
                      const struct wake *wake, double t) {
    find_diagonals(sheet, school, wake);
    for (int i = 0; i < sheet->n_markers; i++) {
        points_add(sheet, &sheet->graded, fish, school, wake, t, i, i, 0, 1);
        sheet->middles.n_released++;
    }
}

void sheet_build(struct sheet *sheet, const struct fish *fish, const struct school *school, const struct wake *wake,
                 double t) {
    const bool is_sheet = school->shedding == SHEDDING_SHEET;
    const int n = wake->n_vortex, n_stretches = is_sheet && n > 0 ? n - 1 : 0;
    struct sheet_points *const graded = &sheet->graded, *const middles = &sheet->middles;
    graded->n_released = middles->n_released = sheet->n_single = 0;
    sheet->has_end = false;
    graded->n_nascent = is_sheet ? SHEET_PANEL : 0;
    middles->n_nascent = 1;
    for (int i = 0; i < n && !is_sheet; i++) middles->newer[middles->n_released++] = i;

    if (is_sheet) {
        double *const padded[] = {sheet->x[0], sheet->y[0], sheet->label};
        for (size_t i = 0; i < sizeof padded / sizeof *padded; i++) {
            memset(padded[i], 0, SHEET_PAD * sizeof(double));
            memset(padded[i] + SHEET_PAD + n, 0, SHEET_PAD * sizeof(double));
        }
        markers_at(sheet, school, wake, t, 0);
        build_old(sheet, fish, school, wake, t);
    }

    // more points for newer stretches
    const int n_young = n_stretches - wake->n_old;
    sheet->n_single = n_young > SHEET_PAIRED ? n_young - SHEET_PAIRED : 0;
    for (int i = wake->n_old; i < n_stretches; i++) {
        const int age = n_stretches - i;
        const int n_points = age <= SHEET_GRADED ? SHEET_PANEL : age <= SHEET_PAIRED ? 2 : 1;
        for (int k = 0; k < n_points; k++) {
            const double xi = n_points == 1 ? 0.5 : n_points == 2 ? pair_xi[k] : panel_xi[k];
            const double part = n_points <= 2 ? 1.0 / n_points : panel_part[k];
            points_add(sheet, graded, fish, school, wake, t, i + 1, i, xi, part);
        }

        // single middles are the points of both views: sheet_place copies the points
        if (n_points == 1) {
            middles->n_released++;
        } else {
            points_add(sheet, middles, fish, school, wake, t, i + 1, i, 0.5, 1);
        }
    }
    const int n_shared = sheet->n_markers + sheet->n_single;
    if (n_shared > 0) {
        memcpy(middles->newer, graded->newer, (size_t)n_shared * sizeof *middles->newer);
        memcpy(middles->older, graded->older, (size_t)n_shared * sizeof *middles->older);
        memcpy(middles->xi, graded->xi, (size_t)n_shared * sizeof *middles->xi);
        memcpy(middles->part, graded->part, (size_t)n_shared * sizeof *middles->part);
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

void sheet_turn(struct sheet *sheet, const struct fish *fish, const struct school *school, const struct wake *wake) {
    sheet->has_end = false;
    for (int i = 0; i < sheet->graded.n_released; i++) point_smooth(sheet, &sheet->graded, fish, school, wake, i, 0);
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

// set the points of young stretches from point first on
static void points_place(const struct sheet *sheet, const struct sheet_points *points, int first) {
    const double *const x = sheet->x[0] + SHEET_PAD, *const y = sheet->y[0] + SHEET_PAD;
    const double *const label = sheet->label + SHEET_PAD;
    for (int i = first; i < points->n_released; i++) {
        const int newer = points->newer[i], older = points->older[i];
        point_set(points, i, (const double[]){x[newer], y[newer]}, (const double[]){x[older], y[older]}, label[newer],
                  label[older]);
    }
}

// set the values that are linear in time, from point first on, and reduce the circulations; end: where they are known
static void points_fade(const struct sheet_points *points, int first, double q, int end) {
    const struct sources *const sources = &points->sources;
    for (int i = first; i < points->n_released; i++) {
        const double smoothing = (1 - q) * points->smoothing[0][i] + q * points->smoothing[end][i];
        sources->square[i] = smoothing * smoothing;
        sources->leg[i] = (1 - q) * points->leg[0][i] + q * points->leg[end][i];
        sources->q[i] *= points->remains[0][i] + q * (points->remains[end][i] - points->remains[0][i]);
    }
}

// find the values at the end of the interval
static void find_end(struct sheet *sheet, const struct fish *fish, const struct school *school, const struct wake *wake,
                     double t) {
    if (sheet->has_end) return;
    sheet->has_end = true;
    markers_at(sheet, school, wake, t, 1);
    for (int i = 0; i < sheet->graded.n_released; i++) point_at(sheet, &sheet->graded, fish, school, wake, t, i, 1);
    for (int i = sheet->n_markers + sheet->n_single; i < sheet->middles.n_released; i++) {
        point_at(sheet, &sheet->middles, fish, school, wake, t, i, 1);
    }
}

// set the markers of old stretches: the matrix of the forms times labels and places
static void place_old(const struct sheet *sheet) {
    const struct sources *const to = &sheet->graded.sources;
    const double *const x = sheet->x[0], *const y = sheet->y[0], *const label = sheet->label;
    double *restrict const strength = to->q, *restrict const dx = to->dx, *restrict const dy = to->dy;
    const size_t size = (size_t)sheet->n_markers * sizeof(double);
    memcpy(to->x, x + SHEET_PAD, size);
    memcpy(to->y, y + SHEET_PAD, size);
    memset(strength, 0, size);
    memset(dx, 0, size);
    memset(dy, 0, size);
    for (int k = 0; k < SHEET_DIAGONALS; k++) {
        const double *const part = sheet->diagonal[k];
        for (int i = 0; i < sheet->n_markers; i++) {
            strength[i] += part[i] * label[i + k];
            dx[i] += part[i] * x[i + k];
            dy[i] += part[i] * y[i + k];
        }
    }
    for (int i = 0; i < sheet->n_markers; i++) {
        dx[i] *= label[i + SHEET_PAD];
        dy[i] *= label[i + SHEET_PAD];
    }
}

// set the middles of young stretches with one point
static void place_single(const struct sheet *sheet, const struct wake *wake) {
    const struct sources *const to = &sheet->graded.sources;
    const int stretch = SHEET_PAD + wake->n_old, point = sheet->n_markers;
    const double *const x = sheet->x[0] + stretch, *const y = sheet->y[0] + stretch;
    const double *const label = sheet->label + stretch;
    double *restrict const to_x = to->x + point, *restrict const to_y = to->y + point;
    double *restrict const strength = to->q + point;
    double *restrict const dx = to->dx + point, *restrict const dy = to->dy + point;
    for (int i = 0; i < sheet->n_single; i++) {
        const double along = -(label[i + 1] + 0.5 * (label[i] - label[i + 1]));
        to_x[i] = 0.5 * x[i + 1] + 0.5 * x[i];
        to_y[i] = 0.5 * y[i + 1] + 0.5 * y[i];
        strength[i] = label[i + 1] - label[i];
        dx[i] = along * (x[i] - x[i + 1]);
        dy[i] = along * (y[i] - y[i + 1]);
    }
}

void sheet_place(struct sheet *sheet, const struct fish *fish, const struct school *school, const struct wake *wake,
                 double t, double tau) {
    const double q = tau / school->interval;
    const struct sheet_points *const graded = &sheet->graded, *const middles = &sheet->middles;
    const struct sources *const from = &graded->sources, *const to = &middles->sources;
    if (school->shedding != SHEDDING_SHEET) {
        wake_places(wake, school->interval, tau, to->x, to->y);
        wake_strengths(wake, school, t, tau, to->q);
        return;
    }

    if (q > 0) find_end(sheet, fish, school, wake, t);
    const int end = sheet->has_end ? 1 : 0;
    double *const label = sheet->label + SHEET_PAD;
    wake_places(wake, school->interval, tau, sheet->x[0] + SHEET_PAD, sheet->y[0] + SHEET_PAD);
    wake_labels(wake, school->interval, tau, label);
    for (int i = 0; i < wake->n_vortex; i++) {
        label[i] *= sheet->remains[0][i] + q * (sheet->remains[end][i] - sheet->remains[0][i]);
    }

    const int n_shared = sheet->n_markers + sheet->n_single;
    place_old(sheet);
    place_single(sheet, wake);
    points_place(sheet, graded, n_shared);
    points_place(sheet, middles, n_shared);
    points_fade(graded, 0, q, end);
    points_fade(middles, n_shared, q, end);

    // the other view
    double *const copies[][2] = {{from->x, to->x},   {from->y, to->y},   {from->q, to->q},
                                 {from->dx, to->dx}, {from->dy, to->dy}, {from->leg, to->leg}};
    for (size_t i = 0; i < sizeof copies / sizeof *copies; i++) {
        memcpy(copies[i][1], copies[i][0], (size_t)n_shared * sizeof(double));
    }
}

void sheet_line(const struct sheet *sheet, const struct sheet_points *points, int i, double line[2]) {
    const double *const x = sheet->x[0] + SHEET_PAD, *const y = sheet->y[0] + SHEET_PAD;
    line[0] = line[1] = 0;
    if (i >= sheet->n_markers) {
        const int newer = points->newer[i], older = points->older[i];
        line[0] = points->part[i] * (x[newer] - x[older]);
        line[1] = points->part[i] * (y[newer] - y[older]);
        return;
    }
    for (int k = 0; k < SHEET_DIAGONALS; k++) {
        line[0] += sheet->diagonal[k][i] * sheet->x[0][i + k];
        line[1] += sheet->diagonal[k][i] * sheet->y[0][i + k];
    }
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

    const double older = newest >= 0 ? wake_strength_of(wake, school, t, tau, newest) : wake->shed_before;
    struct nascent_end *const end = &points->end;
    *end = (struct nascent_end){.is_overtaken = false};
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
        const int panel = i / NODES;
        const bool is_last = panel == n_panels;
        const double q = node[i % NODES], part = weight[i % NODES], first = depth * steady_end(panel);
        const double length = is_last ? first : depth * steady_end(panel + 1) - first;
        const double distance = is_last ? first / q : first + q * length;

        points->part[i] = part * length / (is_last ? q * q : 1);
        sources->x[i] = tail[0] + distance * along[0];
        sources->y[i] = tail[1] + distance * along[1];
        sources->dx[i] = -shed * points->part[i] * along[0];
        sources->dy[i] = -shed * points->part[i] * along[1];
        sources->half[i] = depth * depth / 32;
        sources->leg[i] = sheet_leg(fish, distance);
    }
}

void sheet_markers(struct sources *sources, const struct sheet *sheet, const struct fish *fish,
                   const struct school *school, const struct wake *wake, double t, double nascent) {
    const int n = wake->n_vortex, first = sources->n;
    sources_append(sources, n);
    if (n == 0) return;
    const double *const label = sheet->label + SHEET_PAD;
    const struct sources *const old = &sheet->middles.sources;
    double *const q = sources->q + first, *const dx = sources->dx + first, *const dy = sources->dy + first;
    memcpy(sources->x + first, wake->x, (size_t)n * sizeof *wake->x);
    memcpy(sources->y + first, wake->y, (size_t)n * sizeof *wake->y);
    for (int i = 0; i < n; i++) {
        sources->half[first + i] = fish->strip_depth * fish->strip_depth / 32;
        sources->leg[first + i] = sheet_leg(fish, sheet->distance[0][i]);
    }

    // the parts of old stretches, then half of every young stretch at both ends
    const size_t size = (size_t)sheet->n_markers * sizeof(double);
    memcpy(q, old->q, size);
    memcpy(dx, old->dx, size);
    memcpy(dy, old->dy, size);
    for (int j = wake->n_old; j + 1 < n; j++) {
        const double along[2] = {wake->x[j + 1] - wake->x[j], wake->y[j + 1] - wake->y[j]};
        const double half = wake_part_of_stretch(wake, school, t, 0, j) * (label[j + 1] - label[j]) / 2;
        for (int i = j; i <= j + 1; i++) {
            q[i] += half;
            dx[i] += label[i] * along[0] / 2;
            dy[i] += label[i] * along[1] / 2;
        }
    }

    // the nascent stretch has length 0 at the event: both halves act at the newest marker
    q[n - 1] += nascent;
}

double sheet_change(const struct sheet *sheet, const struct wake *wake, int i, const double *value) {
    const int n = wake->n_vortex;
    double sum = 0;
    for (int k = 0; k < SHEET_DIAGONALS && i < sheet->n_markers; k++) {
        const int b = i + k - SHEET_PAD;
        if (b >= 0 && b < n) sum += sheet->diagonal[k][i] * value[b];
    }
    if (i > wake->n_old) sum += (value[i] - value[i - 1]) / 2;
    if (i >= wake->n_old && i + 1 < n) sum += (value[i + 1] - value[i]) / 2;
    return sum;
}
