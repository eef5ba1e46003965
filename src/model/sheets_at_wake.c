/* sheets_at_wake.c: three vortices for one, and the markers that are too near for them. */
#include "model/sheets_at_wake.h"

#include <math.h>
#include <stdlib.h>

#include "base/box.h"
#include "vortex/kernel.h"

enum { NODES = 3 };

/* The cosines of Chebyshev's nodes. */
static const double node_of[NODES] = {0.86602540378443865, 0, -0.86602540378443865};

/* By the tree from this many times as many interactions on as for one sum. */
static const double times_slower = 3;

struct sheets {
    const struct bound_vortices *bound;
    struct vortices alike[NODES]; /* all bound vortices with the smoothing of each node */
    struct box *near;             /* of each fish: where markers are too near                   (n_fish) */
};

static void sheets_clear(struct sheets *sheets) {
    for (int m = 0; m < NODES; m++) vortices_free(&sheets->alike[m]);
    free(sheets->near);
}

// e^2 at node m
static double square_at(const struct fish *fish, int m) {
    return fish->sheet_smoothing * fish->sheet_smoothing / 2 * (1 + node_of[m]);
}

// Lagrange's polynomial of node m
static double lagrange(const struct fish *fish, int m, double square) {
    double value = 1;
    for (int k = 0; k < NODES; k++) {
        const double there = square_at(fish, k);
        if (k != m) value *= (square - there) / (square_at(fish, m) - there);
    }
    return value;
}

static enum status place(struct sheets *sheets, int f, double tolerance) {
    const struct bound_vortices *const bound = sheets->bound;
    const struct fish *const fish = &bound->school->fish[f];
    const int first = bound->range[f].first, n = bound->range[f].n;
    const double *const x = bound->vortices->x + first, *const y = bound->vortices->y + first;
    for (int m = 0; m < NODES; m++) {
        struct vortices *const to = &sheets->alike[m];
        TRY(vortices_append(to, n, sqrt(square_at(fish, m))));
        for (int j = 0; j < n; j++) {
            to->x[first + j] = x[j];
            to->y[first + j] = y[j];
            to->circulation[first + j] =
                bound->vortices->circulation[first + j] * lagrange(fish, m, bound->square[first + j]);
        }
    }
    sheets->near[f] = box_widen(box_around(n, x, y), fish->sheet_smoothing * pow(0.3125 / tolerance, 1.0 / 6));
    return STATUS_OK;
}

// at a chunk of markers, what the vortices of fish f induce in place of the three for each
static void correct(const struct sheets *sheets, int f, const struct induced *at) {
    const struct bound_vortices *const bound = sheets->bound;
    const int first = bound->range[f].first, n = bound->range[f].n;
    const double *const x = bound->vortices->x + first, *const y = bound->vortices->y + first;
    double u[KERNEL_CHUNK] = {0}, v[KERNEL_CHUNK] = {0};
    for (int m = 0; m < NODES; m++) {
        kernel_add_velocity(at->n, at->x, at->y, n, x, y, sheets->alike[m].circulation + first,
                            sqrt(square_at(&bound->school->fish[f], m)), u, v);
    }
    for (int i = 0; i < at->n; i++) {
        at->u[i] -= u[i];
        at->v[i] -= v[i];
    }
    kernel_add_velocity_each(at->n, at->x, at->y, n, x, y, bound->vortices->circulation + first, bound->square + first,
                             at->u, at->v);
}

static enum status induce(struct sheets *sheets, const struct vortices *others, struct velocity_sum *sum,
                          double tolerance, int threads, const struct induced *markers) {
    const int n_fish = sheets->bound->school->n_fish, n_chunks = parallel_n_chunks(markers->n);
    sheets->near = calloc((size_t)n_fish, sizeof *sheets->near);
    if (!sheets->near) return status_fail(STATUS_MEMORY, "out of memory: the sheets of %d fish", n_fish);
    for (int f = 0; f < n_fish; f++) TRY(place(sheets, f, tolerance));
    const struct vortices *all[NODES + 1];
    for (int m = 0; m < NODES; m++) all[m] = &sheets->alike[m];
    all[NODES] = others;
    TRY(velocity_sum_induce_all(sum, others ? NODES + 1 : NODES, all, tolerance, threads, markers));
#pragma omp parallel for num_threads(threads) schedule(dynamic, 4)
    for (int chunk = 0; chunk < n_chunks; chunk++) {
        const struct induced at = vortices_targets(markers, parallel_chunk(chunk, markers->n));
        const struct box box = box_around(at.n, at.x, at.y);
        for (int f = 0; f < n_fish; f++) {
            if (box_gap(&sheets->near[f], &box) <= 0) correct(sheets, f, &at);
        }
    }
    return STATUS_OK;
}

int sheets_at_wake_by_tree(const struct vortices *bound, int n_markers, double tolerance) {
    return velocity_sum_by_tree(bound, (int)(n_markers / times_slower), tolerance);
}

enum status sheets_at_wake_induce(const struct bound_vortices *bound, const struct vortices *others,
                                  struct velocity_sum *sum, double tolerance, int threads,
                                  const struct induced *markers) {
    struct sheets sheets = {.bound = bound};
    const enum status status = induce(&sheets, others, sum, tolerance, threads, markers);
    sheets_clear(&sheets);
    return status;
}
