/* flow_at_wake.c: velocity of bodies and wakes at wakes of point vortices; by the tree for many vortices. */
#include "flow/flow_at_wake.h"

#include <stdlib.h>
#include <string.h>

#include "flow/flow_at_markers.h"
#include "flow/flow_external.h"
#include "flow/flow_rings.h"
#include "vortex/velocity_sum.h"

// external flow, nascent vortices, and direct sums of sheets and images at the free vortices
static void others_at_wake(const struct flow *flow, int sheets_by_tree, int images_by_cells,
                           const struct induced *all) {
    const struct walls *const walls = &flow->school->walls;
    const int n_chunks = parallel_n_chunks(all->n);
    const int threads =
        parallel_threads(flow->school->threads, n_chunks, (double)all->n * flow->sheet.n, PARALLEL_INTERACTIONS);
#pragma omp parallel for num_threads(threads) schedule(dynamic, 4)
    for (int chunk = 0; chunk < n_chunks; chunk++) {
        const struct induced at = vortices_targets(all, parallel_chunk(chunk, all->n));
        for (int i = 0; i < at.n; i++) flow_external(flow->school, flow->t, at.y[i], &at.u[i], &at.v[i]);
        vortices_induce(&flow->nascent, (struct range){0, flow->nascent.n}, &at);
        if (!sheets_by_tree) vortices_induce(&flow->sheet, (struct range){0, flow->sheet.n}, &at);
        images_induce(walls, &flow->nascent, (struct range){0, flow->nascent.n}, &at);
        if (!images_by_cells) images_induce(walls, &flow->sheet, (struct range){0, flow->sheet.n}, &at);
    }
}

static enum status reserve_at_wake(struct flow *flow, int n) {
    if (n <= flow->wake_capacity) return STATUS_OK;
    const int capacity = n + n / 2;
    double **const all[] = {&flow->wake_u, &flow->wake_v, &flow->wake_image_u, &flow->wake_image_v};
    const int has_images = flow->school->walls.n > 0 && flow_has_free_sheets(flow);

    flow->wake_capacity = 0;
    for (int i = 0; i < (has_images ? 4 : 2); i++) {
        free(*all[i]);
        *all[i] = calloc((size_t)capacity, sizeof **all[i]);
        if (!*all[i]) return status_fail(STATUS_MEMORY, "out of memory: velocities of %d vortices", n);
    }

    flow->wake_capacity = capacity;
    return STATUS_OK;
}

// mutual velocity of all free vortices, and velocity of sheets that are not summed directly; one tree sums both
static enum status induce_many(struct flow *flow, int sheets_too, const struct vortices *moving, int threads,
                               const struct induced *at) {
    const double tolerance = flow->school->wake_tolerance;
    const int by_tree = velocity_sum_by_tree(moving, moving->n, tolerance);
    struct velocity_sum *const sum = flow->velocity_sum;

    if (by_tree) {
        const struct vortices *const all[] = {moving, &flow->sheet};
        TRY(velocity_sum_induce_all(sum, sheets_too ? 2 : 1, all, tolerance, threads, at));
    } else if (sheets_too) {
        TRY(velocity_sum_induce(sum, &flow->sheet, tolerance, threads, at));
    }

    return by_tree ? STATUS_OK : velocity_sum_pairwise(moving, PAIRWISE_OF_SOURCE, threads, at->u, at->v);
}

static enum status flow_at_vortices(struct flow *flow) {
    const struct vortices *const moving = &flow->released;
    const struct walls *const walls = &flow->school->walls;
    const double tolerance = flow->school->wake_tolerance;
    const struct induced at = {.n = moving->n, .x = moving->x, .y = moving->y, .u = flow->wake_u, .v = flow->wake_v};
    const int sheets_by_tree = velocity_sum_by_tree(&flow->sheet, at.n, tolerance);
    const int by_cells = images_by_cells(walls, &flow->sheet, tolerance, &at);
    const int threads =
        parallel_threads(flow->school->threads, moving->n, (double)moving->n * moving->n, PARALLEL_INTERACTIONS);

    others_at_wake(flow, sheets_by_tree, by_cells, &at);
    if (by_cells) TRY(images_induce_many(walls, flow->velocity_sum, &flow->sheet, tolerance, threads, &at));
    TRY(images_induce_many(walls, flow->velocity_sum, moving, tolerance, threads, &at));
    return induce_many(flow, sheets_by_tree, moving, threads, &at);
}

enum status flow_at_wake(struct flow *flow, const struct state *state) {
    TRY(flow_place(flow, state, state->t, state->y));

    if (flow->rings) {
        int n = 0;
        for (int f = 0; f < flow->school->n_fish; f++) n += state->wake[f].n_vortex;
        TRY(reserve_at_wake(flow, n));
        return flow_rings_at_markers(flow, state);
    }

    if (flow_has_free_sheets(flow)) {
        TRY(flow_at_markers_place(flow, state));
        TRY(reserve_at_wake(flow, flow->n_markers));
        return flow_at_markers(flow, state);
    }

    TRY(flow_place_released(flow, state));
    memcpy(flow->wake_range, flow->released_range, (size_t)flow->school->n_fish * sizeof *flow->wake_range);
    TRY(reserve_at_wake(flow, flow->released.n));
    return flow_at_vortices(flow);
}
