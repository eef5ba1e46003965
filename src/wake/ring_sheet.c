/* ring_sheet.c: points of stretches, and markers, with the legs of the rings. */
#include "wake/ring_sheet.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "wake/free_sheet.h"

// both ends of a stretch at one time
struct ends {
    double newer[2], older[2];
};
static struct ends stretch_ends(const struct wake *markers, int stretch, double interval, double tau) {
    struct ends ends;
    wake_marker(markers, stretch + 1, interval, tau, ends.newer);
    wake_marker(markers, stretch, interval, tau, ends.older);
    return ends;
}

// point at the fraction xi of the way from the newer to the older end
static void stretch_point(const struct ends *ends, double xi, double point[2]) {
    for (int i = 0; i < 2; i++) point[i] = (1 - xi) * ends->newer[i] + xi * ends->older[i];
}

double ring_sheet_leg(const struct fish *fish, double distance) {
    const double depth = fish->strip_depth, ratio = distance / (3 * depth), fourth = ratio * ratio * ratio * ratio;

    // exp(-40) is less than the rounding of 1
    return depth * depth / 8 * (fourth < 40 ? -expm1(-fourth) : 1);
}

static double stretch_length(const struct ends *ends) {
    const double x = ends->newer[0] - ends->older[0], y = ends->newer[1] - ends->older[1];
    return sqrt(x * x + y * y);
}

void ring_sheet_free(struct ring_sheet *sheet) {
    double *const owned[] = {sheet->xi,           sheet->part,   sheet->smoothing[0],
                             sheet->smoothing[1], sheet->leg[0], sheet->leg[1]};
    for (size_t i = 0; i < sizeof owned / sizeof *owned; i++) free(owned[i]);
    free(sheet->stretch);
    ring_free(&sheet->rings);
    *sheet = (struct ring_sheet){0};
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

static void ring_sheet_add(struct ring_sheet *sheet, enum ring_view view, const struct fish *fish,
                           const struct wake *markers, double interval, int stretch, const struct ends at[2],
                           const double distance[2], double xi, double part) {
    const int i = sheet->n_released++, newest = markers->n_vortex - 1;
    sheet->stretch[i] = stretch;
    sheet->xi[i] = xi;
    sheet->part[i] = part;

    for (int end = 0; end < 2; end++) {
        const double tau = end * interval;
        double point[2];
        stretch_point(&at[end], xi, point);
        const double from_tail[2] = {point[0] - markers->x[newest] - tau * markers->tail_velocity[0],
                                     point[1] - markers->y[newest] - tau * markers->tail_velocity[1]};

        // middles are sources for other targets, with the full smoothing of the pair
        sheet->smoothing[end][i] = 0;
        if (view == RING_GRADED) {
            sheet->smoothing[end][i] = free_sheet_is_far(fish, from_tail)
                                           ? fish->smoothing
                                           : free_sheet_smoothing(fish, from_tail, markers->tail_tangent);
        }
        sheet->leg[end][i] = ring_sheet_leg(fish, distance[end] + xi * stretch_length(&at[end]));
    }
}

// length of the sheet from the tail to the oldest marker, tau after the event; the tail keeps its velocity
static double ring_sheet_length(const struct wake *markers, double interval, double tau) {
    const int newest = markers->n_vortex - 1;
    if (newest < 0) return 0;
    struct ends ends = {.newer = {markers->x[newest] + tau * markers->tail_velocity[0],
                                  markers->y[newest] + tau * markers->tail_velocity[1]}};
    double length = 0;
    for (int i = newest; i >= 0; i--) {
        wake_marker(markers, i, interval, tau, ends.older);
        length += stretch_length(&ends);
        memcpy(ends.newer, ends.older, sizeof ends.newer);
    }

    return length;
}

enum status ring_sheet_build(struct ring_sheet *sheet, enum ring_view view, const struct fish *fish,
                             const struct school *school, const struct wake *markers) {
    const int n_stretches = markers->n_vortex > 0 ? markers->n_vortex - 1 : 0;
    const int graded = view == RING_GRADED ? FREE_SHEET_GRADED : 0,
              paired = view == RING_GRADED ? FREE_SHEET_PAIRED : 0;

    TRY(ring_sheet_reserve(sheet, n_stretches + 2 * FREE_SHEET_PAIRED + 4 * FREE_SHEET_PANEL));

    sheet->n_released = 0;
    sheet->n_nascent = view == RING_GRADED ? FREE_SHEET_PANEL : 1;

    // distances of the stretches from the tail along the sheet
    double distance[2] = {ring_sheet_length(markers, school->interval, 0),
                          ring_sheet_length(markers, school->interval, school->interval)};
    for (int i = 0; i < n_stretches; i++) {
        const int age = n_stretches - i;
        const int n = age <= graded ? FREE_SHEET_PANEL : age <= paired ? 2 : 1;
        const struct ends at[2] = {stretch_ends(markers, i, school->interval, 0),
                                   stretch_ends(markers, i, school->interval, school->interval)};
        for (int end = 0; end < 2; end++) distance[end] -= stretch_length(&at[end]);

        for (int k = 0; k < n; k++) {
            const double xi = n == 1 ? 0.5 : n == 2 ? free_sheet_pair_xi[k] : free_sheet_xi[k];
            const double part = n <= 2 ? 1.0 / n : free_sheet_part[k];
            ring_sheet_add(sheet, view, fish, markers, school->interval, i, at, distance, xi, part);
        }
    }

    sheet->rings.n = 0;
    return ring_append(&sheet->rings, sheet->n_released + sheet->n_nascent);
}

// set ring i at the fraction xi of a stretch with the labels newer and older at its ends
static void ring_set(struct rings *rings, int i, const struct ends *ends, double xi, double part, double newer,
                     double older) {
    const double along = -(newer + xi * (older - newer)) * part;
    double point[2];
    stretch_point(ends, xi, point);

    rings->x[i] = point[0];
    rings->y[i] = point[1];
    rings->q[i] = part * (newer - older);
    rings->dx[i] = along * (ends->older[0] - ends->newer[0]);
    rings->dy[i] = along * (ends->older[1] - ends->newer[1]);
}

void ring_sheet_place(struct ring_sheet *sheet, const struct fish *fish, const struct school *school,
                      const struct wake *markers, double t, double tau) {
    const double q = tau / school->interval, half = fish->strip_depth * fish->strip_depth / 32;
    struct rings *const rings = &sheet->rings;
    struct ends ends = {{0}, {0}};
    int placed = -2;
    double newer = 0, older = 0;

    for (int i = 0; i < sheet->n_released; i++) {
        // labels and ends of a new stretch
        const int stretch = sheet->stretch[i];
        if (stretch != placed) {
            older = stretch == placed + 1 ? newer : wake_ring(markers, school, stretch, t, tau);
            newer = wake_ring(markers, school, stretch + 1, t, tau);
            ends = stretch_ends(markers, stretch, school->interval, tau);
            placed = stretch;
        }

        ring_set(rings, i, &ends, sheet->xi[i], sheet->part[i], newer, older);
        const double smoothing = (1 - q) * sheet->smoothing[0][i] + q * sheet->smoothing[1][i];
        rings->square[i] = smoothing * smoothing;
        rings->leg[i] = (1 - q) * sheet->leg[0][i] + q * sheet->leg[1][i];
        rings->half[i] = half;
    }
}

double ring_sheet_xi(const struct ring_sheet *sheet, int i) {
    return sheet->n_nascent == 1 ? 0.5 : free_sheet_xi[i];
}

double ring_sheet_part(const struct ring_sheet *sheet, int i) {
    return sheet->n_nascent == 1 ? 1 : free_sheet_part[i];
}

double ring_sheet_place_nascent(struct ring_sheet *sheet, const struct fish *fish, const struct school *school,
                                const struct wake *markers, double t, double tau, const double tail[2], double shed) {
    struct rings *const rings = &sheet->rings;
    const int newest = markers->n_vortex - 1;
    const double older = newest >= 0 ? wake_ring(markers, school, newest, t, tau) : markers->shed_before;
    struct ends ends = {.newer = {tail[0], tail[1]}, .older = {tail[0], tail[1]}};

    if (newest >= 0) wake_marker(markers, newest, school->interval, tau, ends.older);

    for (int k = 0; k < sheet->n_nascent; k++) {
        const int i = sheet->n_released + k;
        ring_set(rings, i, &ends, ring_sheet_xi(sheet, k), ring_sheet_part(sheet, k), shed, older);
        rings->half[i] = fish->strip_depth * fish->strip_depth / 32;
    }

    return shed - older;
}

enum status ring_sheet_markers(struct rings *rings, const struct fish *fish, const struct school *school,
                               const struct wake *markers, double t, double nascent) {
    const int n = markers->n_vortex, first = rings->n;
    TRY(ring_append(rings, n));
    const double *const x = markers->x, *const y = markers->y;
    double distance = ring_sheet_length(markers, school->interval, 0);
    for (int i = 0; i < n; i++) {
        const double label = wake_ring(markers, school, i, t, 0);
        const int newer = i + 1 < n ? i + 1 : i, older = i > 0 ? i - 1 : 0;

        struct rings *const to = rings;
        to->x[first + i] = x[i];
        to->y[first + i] = y[i];
        to->dx[first + i] = -label * (x[older] - x[newer]) / 2;
        to->dy[first + i] = -label * (y[older] - y[newer]) / 2;
        to->half[first + i] = fish->strip_depth * fish->strip_depth / 32;
        to->leg[first + i] = ring_sheet_leg(fish, distance);
        if (i + 1 < n) distance -= hypot(x[i] - x[i + 1], y[i] - y[i + 1]);

        if (i == 0) continue;
        const double stretch = label - wake_ring(markers, school, i - 1, t, 0);
        to->q[first + i] += stretch / 2;
        to->q[first + i - 1] += stretch / 2;
    }

    // the nascent stretch has length 0 at the event: both halves act at the newest marker
    if (n > 0) rings->q[first + n - 1] += nascent;
    return STATUS_OK;
}
