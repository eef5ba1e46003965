/* ring_sheet.c: points of stretches, and markers, with the legs of the rings. */
#include "wake/ring_sheet.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/mathematics.h"
#include "base/memory.h"

// both ends of a stretch at one time
struct ends {
    double newer[2], older[2];
};

static struct ends stretch_ends(const double *x, const double *y, int stretch) {
    return (struct ends){.newer = {x[stretch + 1], y[stretch + 1]}, .older = {x[stretch], y[stretch]}};
}

// point at the fraction xi of the way from the newer to the older end
static void ring_stretch_point(const struct ends *ends, double xi, double point[2]) {
    for (int i = 0; i < 2; i++) point[i] = (1 - xi) * ends->newer[i] + xi * ends->older[i];
}

/* s of a point of the wake at this distance from the own tail along the sheet, m2. */
static double ring_sheet_leg(const struct fish *fish, double distance) {
    const double depth = fish->strip_depth, ratio = distance / (3 * depth), fourth = ratio * ratio * ratio * ratio;

    // exp(-40) is less than the rounding of 1
    return depth * depth / 8 * (fourth < 40 ? -expm1(-fourth) : 1);
}

void ring_sheet_free(struct ring_sheet *sheet) {
    double *const owned[] = {sheet->xi,           sheet->part,   sheet->smoothing[0],
                             sheet->smoothing[1], sheet->leg[0], sheet->leg[1]};
    for (size_t i = 0; i < sizeof owned / sizeof *owned; i++) free(owned[i]);
    free(sheet->stretch);
    ring_free(&sheet->rings);
    *sheet = (struct ring_sheet){0};
}

void ring_sheets_free(struct ring_sheets *sheets) {
    ring_sheet_free(&sheets->graded);
    ring_sheet_free(&sheets->middles);
    for (int end = 0; end < 2; end++) {
        double *const owned[] = {sheets->x[end], sheets->y[end], sheets->length[end]};
        for (size_t i = 0; i < sizeof owned / sizeof *owned; i++) free(owned[i]);
    }
    free(sheets->label);
    *sheets = (struct ring_sheets){0};
}

static enum status ring_sheet_reserve(struct ring_sheet *sheet, int n) {
    if (n <= sheet->capacity) return STATUS_OK;
    const int capacity = n + n / 2;
    ring_sheet_free(sheet);
    double **const all[] = {&sheet->xi,           &sheet->part,   &sheet->smoothing[0],
                            &sheet->smoothing[1], &sheet->leg[0], &sheet->leg[1]};

    TRY(MEMORY_NEW(sheet->stretch, capacity, "points of a free sheet"));
    TRY(MEMORY_ARRAYS(all, capacity, "the points of a free sheet"));
    sheet->capacity = capacity;
    return STATUS_OK;
}

static enum status ring_sheets_reserve(struct ring_sheets *sheets, int n) {
    if (n > sheets->capacity) {
        const int capacity = n + n / 2;
        ring_sheets_free(sheets);
        double **const all[] = {&sheets->x[0],  &sheets->x[1],      &sheets->y[0],     &sheets->y[1],
                                &sheets->label, &sheets->length[0], &sheets->length[1]};
        TRY(MEMORY_ARRAYS(all, capacity, "the markers of a free sheet"));
        sheets->capacity = capacity;
    }
    TRY(ring_sheet_reserve(&sheets->graded, n + 2 * FREE_SHEET_PAIRED + 4 * FREE_SHEET_PANEL));
    return ring_sheet_reserve(&sheets->middles, n + 2 * FREE_SHEET_PAIRED + 4 * FREE_SHEET_PANEL);
}

static void ring_sheet_add(const struct ring_sheets *from, struct ring_sheet *sheet, int is_graded,
                           const struct fish *fish, const struct wake *markers, double interval, int stretch,
                           const double distance[2], double xi, double part) {
    const int i = sheet->n_released++, newest = markers->n_vortex - 1;
    sheet->stretch[i] = stretch;
    sheet->xi[i] = xi;
    sheet->part[i] = part;

    for (int end = 0; end < 2; end++) {
        const double tau = end * interval;
        const struct ends at = stretch_ends(from->x[end], from->y[end], stretch);
        double point[2];
        ring_stretch_point(&at, xi, point);
        const double from_tail[2] = {point[0] - markers->x[newest] - tau * markers->tail_velocity[0],
                                     point[1] - markers->y[newest] - tau * markers->tail_velocity[1]};

        // middles are sources for other targets, with the full smoothing of the pair
        sheet->smoothing[end][i] = 0;
        if (is_graded) {
            sheet->smoothing[end][i] = free_sheet_is_far(fish, from_tail)
                                           ? fish->smoothing
                                           : free_sheet_smoothing(fish, from_tail, markers->tail_tangent);
        }
        sheet->leg[end][i] = ring_sheet_leg(fish, distance[end] + xi * from->length[end][stretch]);
    }
}

// lengths of the stretches; returns the length of the sheet from the tail to the oldest marker
static double stretch_lengths(const struct wake *markers, double tau, const double *x, const double *y,
                              double *restrict length) {
    const int newest = markers->n_vortex - 1;
    if (newest < 0) return 0;
    for (int i = 0; i < newest; i++) {
        const double along[2] = {x[i + 1] - x[i], y[i + 1] - y[i]};
        length[i] = sqrt(along[0] * along[0] + along[1] * along[1]);
    }

    // the tail keeps its velocity
    const double to_tail[2] = {markers->x[newest] + tau * markers->tail_velocity[0] - x[newest],
                               markers->y[newest] + tau * markers->tail_velocity[1] - y[newest]};
    double sum = sqrt(to_tail[0] * to_tail[0] + to_tail[1] * to_tail[1]);
    for (int i = newest - 1; i >= 0; i--) sum += length[i];
    return sum;
}

static enum status ring_sheet_finish(struct ring_sheet *sheet, const struct fish *fish) {
    sheet->rings.n = 0;
    TRY(ring_append(&sheet->rings, sheet->n_released + sheet->n_nascent));
    for (int i = 0; i < sheet->rings.n; i++) sheet->rings.half[i] = fish->strip_depth * fish->strip_depth / 32;
    return STATUS_OK;
}

enum status ring_sheets_build(struct ring_sheets *sheets, const struct fish *fish, const struct school *school,
                              const struct wake *markers) {
    const int n_stretches = markers->n_vortex > 0 ? markers->n_vortex - 1 : 0;
    struct ring_sheet *const graded = &sheets->graded, *const middles = &sheets->middles;
    TRY(ring_sheets_reserve(sheets, markers->n_vortex));
    graded->n_released = middles->n_released = 0;
    graded->n_nascent = FREE_SHEET_PANEL;
    middles->n_nascent = 1;

    // markers and stretches at both ends of the interval; distances from the tail along the sheet
    double distance[2];
    for (int end = 0; end < 2; end++) {
        const double tau = end * school->interval;
        wake_markers_at(markers, school->interval, tau, sheets->x[end], sheets->y[end]);
        distance[end] = stretch_lengths(markers, tau, sheets->x[end], sheets->y[end], sheets->length[end]);
    }

    sheets->n_single = n_stretches > FREE_SHEET_PAIRED ? n_stretches - FREE_SHEET_PAIRED : 0;
    for (int i = 0; i < n_stretches; i++) {
        const int age = n_stretches - i;
        const int n = age <= FREE_SHEET_GRADED ? FREE_SHEET_PANEL : age <= FREE_SHEET_PAIRED ? 2 : 1;
        for (int end = 0; end < 2; end++) distance[end] -= sheets->length[end][i];

        for (int k = 0; k < n; k++) {
            const double xi = n == 1 ? 0.5 : n == 2 ? free_sheet_pair_xi[k] : free_sheet_xi[k];
            const double part = n <= 2 ? 1.0 / n : free_sheet_part[k];
            ring_sheet_add(sheets, graded, 1, fish, markers, school->interval, i, distance, xi, part);
        }

        // the middles of old stretches are the points of both views: ring_sheets_place copies the points
        if (i < sheets->n_single) {
            middles->n_released++;
        } else {
            ring_sheet_add(sheets, middles, 0, fish, markers, school->interval, i, distance, 0.5, 1);
        }
    }

    TRY(ring_sheet_finish(graded, fish));
    return ring_sheet_finish(middles, fish);
}

// set ring i at the fraction xi of a stretch with the labels newer and older at its ends
static void ring_set(const struct rings *rings, int i, const struct ends *ends, double xi, double part, double newer,
                     double older) {
    const double along = -(newer + xi * (older - newer)) * part;
    double point[2];
    ring_stretch_point(ends, xi, point);

    rings->x[i] = point[0];
    rings->y[i] = point[1];
    rings->q[i] = part * (newer - older);
    rings->dx[i] = along * (ends->older[0] - ends->newer[0]);
    rings->dy[i] = along * (ends->older[1] - ends->newer[1]);
}

// points of the stretches from point first on
static void place_points(const struct ring_sheets *sheets, const struct ring_sheet *sheet, int first, double q) {
    const struct rings *const rings = &sheet->rings;
    for (int i = first; i < sheet->n_released; i++) {
        const int stretch = sheet->stretch[i];
        const struct ends ends = stretch_ends(sheets->x[0], sheets->y[0], stretch);
        ring_set(rings, i, &ends, sheet->xi[i], sheet->part[i], sheets->label[stretch + 1], sheets->label[stretch]);
    }

    for (int i = first; i < sheet->n_released; i++) {
        const double smoothing = (1 - q) * sheet->smoothing[0][i] + q * sheet->smoothing[1][i];
        rings->square[i] = smoothing * smoothing;
        rings->leg[i] = (1 - q) * sheet->leg[0][i] + q * sheet->leg[1][i];
    }
}

// ring_set of the middles of the oldest stretches
static void place_middles(const struct ring_sheets *sheets, const struct rings *rings) {
    const double *const x = sheets->x[0], *const y = sheets->y[0], *const label = sheets->label;
    double *restrict const to_x = rings->x, *restrict const to_y = rings->y, *restrict const q = rings->q;
    double *restrict const dx = rings->dx, *restrict const dy = rings->dy;
    for (int i = 0; i < sheets->n_single; i++) {
        const double along = -(label[i + 1] + 0.5 * (label[i] - label[i + 1]));
        to_x[i] = 0.5 * x[i + 1] + 0.5 * x[i];
        to_y[i] = 0.5 * y[i + 1] + 0.5 * y[i];
        q[i] = label[i + 1] - label[i];
        dx[i] = along * (x[i] - x[i + 1]);
        dy[i] = along * (y[i] - y[i + 1]);
    }
}

void ring_sheets_place(struct ring_sheets *sheets, const struct school *school, const struct wake *markers, double t,
                       double tau) {
    const double q = tau / school->interval;
    const struct ring_sheet *const graded = &sheets->graded;
    const struct rings *const from = &graded->rings, *const to = &sheets->middles.rings;
    wake_rings_at(markers, school, t, tau, sheets->x[0], sheets->y[0], sheets->label);
    place_middles(sheets, from);
    for (int i = 0; i < sheets->n_single; i++) {
        const double smoothing = (1 - q) * graded->smoothing[0][i] + q * graded->smoothing[1][i];
        from->square[i] = smoothing * smoothing;
        from->leg[i] = (1 - q) * graded->leg[0][i] + q * graded->leg[1][i];
    }

    // the other view
    double *const copies[][2] = {{from->x, to->x},   {from->y, to->y},   {from->q, to->q},
                                 {from->dx, to->dx}, {from->dy, to->dy}, {from->leg, to->leg}};
    for (size_t i = 0; i < sizeof copies / sizeof *copies; i++) {
        memcpy(copies[i][1], copies[i][0], (size_t)sheets->n_single * sizeof(double));
    }

    place_points(sheets, graded, sheets->n_single, q);
    place_points(sheets, &sheets->middles, sheets->n_single, q);
}

double ring_sheet_xi(const struct ring_sheet *sheet, int i) {
    return sheet->n_nascent == 1 ? 0.5 : free_sheet_xi[i];
}

double ring_sheet_part(const struct ring_sheet *sheet, int i) {
    return sheet->n_nascent == 1 ? 1 : free_sheet_part[i];
}

double ring_sheet_place_nascent(struct ring_sheet *sheet, const struct school *school, const struct wake *markers,
                                double t, double tau, const double tail[2], const struct direction *tangent,
                                double shed) {
    struct rings *const rings = &sheet->rings;
    const int newest = markers->n_vortex - 1;
    const double older = newest >= 0 ? wake_ring(markers, school, newest, t, tau) : markers->shed_before;
    double marker[2] = {tail[0], tail[1]};
    if (newest >= 0) wake_marker(markers, newest, school->interval, tau, marker);
    sheet->end =
        tangent ? free_sheet_nascent_end(marker, tail, tangent) : (struct nascent_end){.x = {marker[0], marker[1]}};
    const struct ends ends = {.newer = {tail[0], tail[1]}, .older = {sheet->end.x[0], sheet->end.x[1]}};
    for (int i = 0; i < 2; i++) sheet->way[i] = ends.older[i] - tail[i];

    for (int k = 0; k < sheet->n_nascent; k++) {
        const int i = sheet->n_released + k;
        ring_set(rings, i, &ends, ring_sheet_xi(sheet, k), ring_sheet_part(sheet, k), shed, older);
    }

    return shed - older;
}

// ends of the panels of a steady wake, in depths: 0, 1/4, 1/2, 1, 2, 3, ..
static double steady_end(int panel) {
    return panel < 3 ? panel / 4.0 : panel - 2;
}

enum status ring_sheet_place_steady(struct ring_sheet *sheet, const struct fish *fish, const double tail[2],
                                    const double along[2], double shed, double reach) {
    enum { NODES = 8, LEAST = 30 };
    const double depth = fish->strip_depth;
    const int n_panels = (int)fmax(LEAST, ceil(reach / depth)) + 2, n = (n_panels + 1) * NODES;
    struct rings *const rings = &sheet->rings;
    double node[NODES], weight[NODES];
    quadrature_legendre(NODES, node, weight);
    TRY(ring_sheet_reserve(sheet, n));
    sheet->n_released = 0;
    sheet->n_nascent = n;
    rings->n = 0;
    TRY(ring_append(rings, n));

    // behind the last end, where the legs act like 1/d^3, quadrature in 1/d
    for (int i = 0; i < n; i++) {
        const int panel = i / NODES, is_last = panel == n_panels;
        const double q = node[i % NODES], part = weight[i % NODES], first = depth * steady_end(panel);
        const double length = is_last ? first : depth * steady_end(panel + 1) - first;
        const double distance = is_last ? first / q : first + q * length;

        sheet->part[i] = part * length / (is_last ? q * q : 1);
        rings->x[i] = tail[0] + distance * along[0];
        rings->y[i] = tail[1] + distance * along[1];
        rings->dx[i] = -shed * sheet->part[i] * along[0];
        rings->dy[i] = -shed * sheet->part[i] * along[1];
        rings->half[i] = depth * depth / 32;
        rings->leg[i] = ring_sheet_leg(fish, distance);
    }
    return STATUS_OK;
}

double ring_sheet_steady_length(const struct ring_sheet *sheet, int i) {
    return sheet->part[i];
}

enum status ring_sheet_markers(struct rings *rings, const struct fish *fish, const struct school *school,
                               const struct wake *markers, double t, double nascent) {
    const int n = markers->n_vortex, first = rings->n;
    TRY(ring_append(rings, n));
    const double *const x = markers->x, *const y = markers->y;
    struct rings *const to = rings;

    // labels, and for the moment the lengths of the stretches in the place of y
    double *const labels = to->leg + first, before = 0;
    for (int i = 0; i < n; i++) labels[i] = wake_ring(markers, school, i, t, 0);
    double distance = stretch_lengths(markers, 0, x, y, to->y + first);

    for (int i = 0; i < n; i++) {
        const double label = labels[i], length = i + 1 < n ? to->y[first + i] : 0;
        const int newer = i + 1 < n ? i + 1 : i, older = i > 0 ? i - 1 : 0;

        to->x[first + i] = x[i];
        to->y[first + i] = y[i];
        to->dx[first + i] = -label * (x[older] - x[newer]) / 2;
        to->dy[first + i] = -label * (y[older] - y[newer]) / 2;
        to->half[first + i] = fish->strip_depth * fish->strip_depth / 32;
        to->leg[first + i] = ring_sheet_leg(fish, distance);
        distance -= length;

        const double stretch = i > 0 ? label - before : 0;
        before = label;
        to->q[first + i] += stretch / 2;
        if (i > 0) to->q[first + i - 1] += stretch / 2;
    }

    // the nascent stretch has length 0 at the event: both halves act at the newest marker
    if (n > 0) rings->q[first + n - 1] += nascent;
    return STATUS_OK;
}
