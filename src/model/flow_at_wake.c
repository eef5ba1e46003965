/* flow_at_wake.c: bodies and wakes at wakes; by the tree where there are many. */
#include "model/flow_at_wake.h"

#include <stdlib.h>
#include <string.h>

#include "model/flow_external.h"
#include "model/sheets_at_wake.h"
#include "vortex/kernel.h"
#include "vortex/pairwise.h"

// the bound sheets at free vortices; markers see them with a smoothing that vanishes at the edges
static void sheets_at_wake(const struct flow *flow, const struct induced *at) {
    if (flow_has_free_sheets(flow)) {
        kernel_add_velocity_each(at->n, at->x, at->y, flow->sheet.n, flow->sheet.x, flow->sheet.y,
                                 flow->sheet.circulation, flow->sheet_square, at->u, at->v);
    } else {
        vortices_induce(&flow->sheet, (struct range){0, flow->sheet.n}, at);
    }
}

/* What of the sheets is summed for all free vortices at once: by the tree, or their images by cells. */
struct summed {
    int sheets, images;
};

// the images of the nascent vortices and of the sheets at free vortices
static void images_at_wake(const struct flow *flow, struct summed summed, const struct induced *at) {
    const struct walls *const walls = &flow->school->walls;
    if (!flow_has_free_sheets(flow)) {
        images_induce(walls, &flow->nascent, (struct range){0, flow->nascent.n}, at);
        if (!summed.images) images_induce(walls, &flow->sheet, (struct range){0, flow->sheet.n}, at);
    } else if (!summed.images) {
        images_induce_each(walls, flow->sheet.n, flow->sheet.x, flow->sheet.y, flow->sheet.circulation,
                           flow->sheet_square, at);
    }
}

// the external flow, the nascent vortices and what is not summed of the sheets at the free vortices
static void others_at_wake(const struct flow *flow, struct summed summed, const struct induced *all) {
    const int n_chunks = parallel_n_chunks(all->n);
    const int threads =
        parallel_threads(flow->school->threads, n_chunks, (double)all->n * flow->sheet.n, PARALLEL_INTERACTIONS);
#pragma omp parallel for num_threads(threads) schedule(dynamic, 4)
    for (int chunk = 0; chunk < n_chunks; chunk++) {
        const struct induced at = vortices_targets(all, parallel_chunk(chunk, all->n));
        for (int i = 0; i < at.n; i++) flow_external(flow->school, flow->t, at.y[i], &at.u[i], &at.v[i]);
        // the newest markers have the nascent stretches
        if (!flow_has_free_sheets(flow)) vortices_induce(&flow->nascent, (struct range){0, flow->nascent.n}, &at);
        if (!summed.sheets) sheets_at_wake(flow, &at);
        if (flow->school->walls.n > 0) images_at_wake(flow, summed, &at);
    }
}

static enum status reserve_at_wake(struct flow *flow, int n) {
    if (n <= flow->wake_capacity) return STATUS_OK;
    const int capacity = n + n / 2;
    double **const both[] = {&flow->wake_u, &flow->wake_v};
    flow->wake_capacity = 0;
    for (int i = 0; i < 2; i++) {
        free(*both[i]);
        *both[i] = calloc((size_t)capacity, sizeof **both[i]);
        if (!*both[i]) return status_fail(STATUS_MEMORY, "out of memory: the velocities of %d vortices", n);
    }
    flow->wake_capacity = capacity;
    return STATUS_OK;
}

// the markers of all fish where they are at the event
static enum status place_markers(struct flow *flow, const struct state *state) {
    struct vortices *const markers = &flow->markers;
    vortices_clear(markers);
    for (int f = 0; f < flow->school->n_fish; f++) {
        const struct wake *const wake = &state->wake[f];
        const int first = markers->n, n = wake->n_vortex;
        flow->wake_range[f] = (struct range){first, n};
        TRY(vortices_append(markers, n, flow->school->fish[f].smoothing));
        if (n == 0) continue;
        memcpy(markers->x + first, wake->x, (size_t)n * sizeof *markers->x);
        memcpy(markers->y + first, wake->y, (size_t)n * sizeof *markers->y);
        free_sheet_strengths(wake, flow->school, state->t, flow->nascent.circulation[f], markers->circulation + first);
    }
    return STATUS_OK;
}

// the free vortices that move: those of the queues, or markers
static enum status place_moving(struct flow *flow, const struct state *state) {
    if (flow_has_free_sheets(flow)) return place_markers(flow, state);
    TRY(flow_place_released(flow, state));
    memcpy(flow->wake_range, flow->released_range, (size_t)flow->school->n_fish * sizeof *flow->wake_range);
    return STATUS_OK;
}

// whether the tree sums the sheets, and cells their images
static struct summed summed_at_wake(const struct flow *flow, double tolerance, const struct induced *at) {
    const int has_free_sheets = flow_has_free_sheets(flow);
    return (struct summed){.sheets = has_free_sheets ? sheets_at_wake_by_tree(&flow->sheet, at->n, tolerance)
                                                     : velocity_sum_by_tree(&flow->sheet, at->n, tolerance),
                           .images = images_by_cells(&flow->school->walls, &flow->sheet,
                                                     has_free_sheets ? flow->sheet_square : NULL, tolerance, at)};
}

// the images of all free vortices, and those of the sheets that are summed by cells
static enum status induce_images(const struct flow *flow, int sheets_too, const struct vortices *moving, int threads,
                                 const struct induced *at) {
    const double tolerance = flow->school->wake_tolerance;
    const struct walls *const walls = &flow->school->walls;
    struct velocity_sum *const sum = flow->velocity_sum;
    if (sheets_too && flow_has_free_sheets(flow)) {
        TRY(images_induce_many_each(walls, sum, &flow->sheet, flow->sheet_square, tolerance, threads, at));
    } else if (sheets_too) {
        TRY(images_induce_many(walls, sum, &flow->sheet, tolerance, threads, at));
    }
    return images_induce_many(walls, sum, moving, tolerance, threads, at);
}

// what all free vortices induce at themselves, and the sheets that are not summed otherwise: those that the tree sums
// share it
static enum status induce_many(struct flow *flow, int sheets_too, const struct vortices *moving, int threads,
                               const struct induced *at) {
    const double tolerance = flow->school->wake_tolerance;
    const struct bound_vortices bound = {flow->school, &flow->sheet, flow->sheet_range, flow->sheet_square};
    const int by_tree = velocity_sum_by_tree(moving, moving->n, tolerance);
    struct velocity_sum *const sum = flow->velocity_sum;
    if (sheets_too && flow_has_free_sheets(flow)) {
        TRY(sheets_at_wake_induce(&bound, by_tree ? moving : NULL, sum, tolerance, threads, at));
    } else if (by_tree) {
        const struct vortices *const all[] = {moving, &flow->sheet};
        TRY(velocity_sum_induce_all(sum, sheets_too ? 2 : 1, all, tolerance, threads, at));
    } else if (sheets_too) {
        TRY(velocity_sum_induce(sum, &flow->sheet, tolerance, threads, at));
    }
    return by_tree ? STATUS_OK : pairwise_add_velocity(moving, threads, at->u, at->v);
}

enum status flow_at_wake(struct flow *flow, const struct state *state) {
    TRY(flow_place(flow, state, state->t, state->y));
    TRY(place_moving(flow, state));
    const struct vortices *const moving = flow_has_free_sheets(flow) ? &flow->markers : &flow->released;
    TRY(reserve_at_wake(flow, moving->n));
    const struct induced at = {.n = moving->n, .x = moving->x, .y = moving->y, .u = flow->wake_u, .v = flow->wake_v};
    const struct summed summed = summed_at_wake(flow, flow->school->wake_tolerance, &at);
    const int threads =
        parallel_threads(flow->school->threads, moving->n, (double)moving->n * moving->n, PARALLEL_INTERACTIONS);
    others_at_wake(flow, summed, &at);
    TRY(induce_images(flow, summed.images, moving, threads, &at));
    return induce_many(flow, summed.sheets, moving, threads, &at);
}
