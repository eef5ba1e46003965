/* flow_field.c: velocity of all sources at any points, for pictures and evaluation of results. */
#include "flow/flow_field.h"

#include <math.h>
#include <stddef.h>

#include "flow/flow_external.h"
#include "flow/flow_rings.h"

// external flow, nascent vortices, and sources that are not summed by the tree, at any points
static void field_induce(const struct flow *flow, const int *by_tree, const struct induced *at) {
    for (int i = 0; i < at->n; i++) {
        flow_external(flow->school, flow->t, at->y[i], &at->u[i], &at->v[i]);
        at->u_y[i] = flow->school->shear;
    }

    vortices_induce(&flow->nascent, (struct range){0, flow->nascent.n}, at);
    images_induce(&flow->school->walls, &flow->nascent, (struct range){0, flow->nascent.n}, at);
    if (!by_tree[0]) vortices_induce(&flow->released, (struct range){0, flow->released.n}, at);
    if (!by_tree[1]) vortices_induce(&flow->sheet, (struct range){0, flow->sheet.n}, at);
}

// NaN beyond the walls
static void field_mask_solid(const struct flow *flow, const struct induced *at) {
    double *const values[] = {at->u, at->v, at->u_x, at->u_y, at->v_x};
    for (int i = 0; flow->school->walls.n > 0 && i < at->n; i++) {
        if (images_distance(&flow->school->walls, at->y[i]) >= 0) continue;
        for (size_t k = 0; k < sizeof values / sizeof *values; k++) values[k][i] = NAN;
    }
}

enum status flow_field(struct flow *flow, const struct state *state, const struct induced *all) {
    static const double tolerance = 1e-6;
    TRY(flow_place(flow, state, state->t, state->y));
    vortices_zero(all);
    if (flow->rings) {
        const int n_parts = parallel_n_chunks(all->n);
#pragma omp parallel for num_threads(flow->school->threads) schedule(static)
        for (int chunk = 0; chunk < n_parts; chunk++) {
            const struct induced at = vortices_targets(all, parallel_chunk(chunk, all->n));
            for (int i = 0; i < at.n; i++) {
                flow_external(flow->school, flow->t, at.y[i], &at.u[i], &at.v[i]);
                at.u_y[i] = flow->school->shear;
            }
            flow_rings_at(flow, &at);
        }

        field_mask_solid(flow, all);
        return STATUS_OK;
    }

    TRY(flow_place_released(flow, state));
    const struct vortices *const many[2] = {&flow->released, &flow->sheet};
    const int n_chunks = parallel_n_chunks(all->n);
    const int threads = parallel_threads(flow->school->threads, n_chunks, (double)all->n * (many[0]->n + many[1]->n),
                                         PARALLEL_INTERACTIONS);
    int by_tree[2];
    for (int i = 0; i < 2; i++) by_tree[i] = velocity_sum_by_tree(many[i], all->n, tolerance);
#pragma omp parallel for num_threads(threads) schedule(static)
    for (int chunk = 0; chunk < n_chunks; chunk++) {
        const struct induced at = vortices_targets(all, parallel_chunk(chunk, all->n));
        field_induce(flow, by_tree, &at);
    }

    for (int i = 0; i < 2; i++) {
        if (by_tree[i]) TRY(velocity_sum_induce(flow->velocity_sum, many[i], tolerance, threads, all));
        TRY(images_induce_many(&flow->school->walls, flow->velocity_sum, many[i], tolerance, threads, all));
    }

    field_mask_solid(flow, all);
    return STATUS_OK;
}
