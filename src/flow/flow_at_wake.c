/* flow_at_wake.c: velocity of bodies and wakes at wakes of point vortices; by the tree for many vortices. */
#include "flow/flow_at_wake.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "flow/flow.h"
#include "flow/flow_rings.h"
#include "vortex/kernel.h"
#include "vortex/velocity_sum.h"

// ---- velocity of all fish with the full smoothing, class after class; then corrections of the own
// bodies near the tails

static const double two_pi = 6.28318530717958647692;

// ---- positions and strengths

static enum status convecting_place_markers(struct flow *flow, const struct state *state, int f) {
    const struct wake *const wake = &state->wake[f];
    struct vortices *const to = &flow->convecting;
    const int first = to->n, n = wake->n_vortex;

    flow->wake_range[f] = (struct range){first, n};
    TRY(vortices_append(to, n, flow->school->fish[f].smoothing));
    if (n == 0) return STATUS_OK;
    memcpy(to->x + first, wake->x, (size_t)n * sizeof *to->x);
    memcpy(to->y + first, wake->y, (size_t)n * sizeof *to->y);
    free_sheet_strengths(wake, flow->school, state->t, flow->nascent.circulation[f], to->circulation + first);
    return STATUS_OK;
}

// the sheet of a body as a source at markers: control points with the circulations of the force, or bound vortices
static enum status convecting_place_body(struct flow *flow, int f) {
    const struct fish *const fish = &flow->school->fish[f];
    const int has_control = fish_has_momentum(fish), n = has_control ? fish->n_control : fish->n_sheet;
    struct vortices *const to = &flow->convecting;
    const int first = to->n, bound = flow->sheet_range[f].first;

    flow->body_range[f] = (struct range){first, n};

    // the smoothing depends on the marker: see convecting_for_class
    TRY(vortices_append(to, n, 0));
    const size_t size = (size_t)n * sizeof *to->x;
    memcpy(to->x + first, has_control ? flow->x + flow->points[f].first : flow->sheet.x + bound, size);
    memcpy(to->y + first, has_control ? flow->y + flow->points[f].first : flow->sheet.y + bound, size);

    const double *const circulation = flow->sheet.circulation + bound;
    if (has_control) {
        sheet_integrals_around(fish->integrals, circulation, to->circulation + first);
    } else {
        memcpy(to->circulation + first, circulation, size);
    }

    return STATUS_OK;
}

/* Set the vortices `convecting`, wake_range and body_range to markers and bodies of all fish at the event of the state,
 * after flow_place. Fails with STATUS_MEMORY. */
static enum status flow_at_markers_place(struct flow *flow, const struct state *state) {
    const int n_fish = flow->school->n_fish;
    vortices_clear(&flow->convecting);
    for (int c = 0; c < flow->n_classes; c++) {
        const int first = flow->convecting.n;
        for (int f = 0; f < n_fish; f++) {
            if (flow->class_of[f] == c) TRY(convecting_place_markers(flow, state, f));
        }
        flow->class[c].markers = (struct range){first, flow->convecting.n - first};
    }

    flow->n_markers = flow->convecting.n;
    for (int f = 0; f < n_fish; f++) TRY(convecting_place_body(flow, f));
    return STATUS_OK;
}

// ---- velocity of all fish, with the full smoothing

// the vortices that convect markers, with the smoothing of one class of markers
static struct vortices convecting_for_class(const struct flow *flow, const struct flow_class *class) {
    struct vortices felt = flow->convecting;
    felt.group = class->group + flow->school->n_fish;
    felt.n_groups = flow->n_classes + 1;

    for (int c = 0; c < flow->n_classes; c++) {
        const struct flow_class *const other = &flow->class[c];
        felt.group[c] =
            (struct vortex_group){other->markers, vortices_pair_smoothing(class->smoothing, other->smoothing)};
    }

    const struct range bodies = {flow->n_markers, felt.n - flow->n_markers};
    felt.group[flow->n_classes] = (struct vortex_group){bodies, class->smoothing};
    return felt;
}

// external flow, and direct sum over the vortices `which`: the bodies if markers are summed in pairs, else all or none
static void markers_induce_directly(const struct flow *flow, const struct vortices *felt, struct range which,
                                    const struct induced *all) {
    const int n_chunks = parallel_n_chunks(all->n);
    const int threads =
        parallel_threads(flow->school->threads, n_chunks, (double)all->n * which.n, PARALLEL_INTERACTIONS);
#pragma omp parallel for num_threads(threads) schedule(dynamic, 4)
    for (int chunk = 0; chunk < n_chunks; chunk++) {
        const struct induced at = vortices_targets(all, parallel_chunk(chunk, all->n));
        for (int i = 0; i < at.n; i++) {
            flow_external(flow->school, flow->t, at.x[i], at.y[i], &at.u[i], &at.v[i]);
        }
        if (which.n > 0) vortices_induce(felt, which, &at);
    }
}

// mutual velocity of all markers, each pair once
static enum status markers_induce_pairs(const struct flow *flow, int threads) {
    struct vortices markers = flow->convecting;
    markers.n = flow->n_markers;
    // remove the last group, the bodies
    markers.n_groups--;
    return velocity_sum_pairwise(&markers, PAIRWISE_OF_PAIR, threads, flow->wake_u, flow->wake_v);
}

// velocity of all images at the markers of a class, also stored in wake_image_u and wake_image_v
static enum status markers_induce_images(const struct flow *flow, const struct vortices *felt, int threads,
                                         const struct induced *at) {
    const long first = at->u - flow->wake_u;
    struct induced images = *at;
    images.u = flow->wake_image_u + first;
    images.v = flow->wake_image_v + first;
    vortices_zero(&images);
    TRY(images_induce_many(&flow->school->walls, flow->velocity_sum, felt, flow->school->wake_tolerance, threads,
                           &images));
    for (int i = 0; i < at->n; i++) {
        at->u[i] += images.u[i];
        at->v[i] += images.v[i];
    }

    return STATUS_OK;
}

static enum status markers_induce_all(const struct flow *flow, const struct induced *at) {
    const double tolerance = flow->school->wake_tolerance;
    const struct range bodies = {flow->n_markers, flow->convecting.n - flow->n_markers};
    const int threads =
        parallel_threads(flow->school->threads, at->n, (double)at->n * flow->convecting.n, PARALLEL_INTERACTIONS);
    int n_by_tree = 0;

    for (int c = 0; c < flow->n_classes; c++) {
        n_by_tree += velocity_sum_by_tree(&flow->convecting, flow->class[c].markers.n, tolerance);
    }

    for (int c = 0; c < flow->n_classes; c++) {
        const struct vortices felt = convecting_for_class(flow, &flow->class[c]);
        const struct induced part = vortices_targets(at, flow->class[c].markers);
        const int by_tree = velocity_sum_by_tree(&felt, part.n, tolerance);

        const struct range all = {0, felt.n}, none = {0, 0};
        markers_induce_directly(flow, &felt, by_tree ? none : n_by_tree > 0 ? all : bodies, &part);
        if (by_tree) TRY(velocity_sum_induce(flow->velocity_sum, &felt, tolerance, threads, &part));
        if (flow->school->walls.n > 0) TRY(markers_induce_images(flow, &felt, threads, &part));
    }

    return n_by_tree > 0 || at->n == 0 ? STATUS_OK : markers_induce_pairs(flow, threads);
}

// ---- own body: tapered smoothing near the tail

/* A chunk of markers of one fish. */
struct near_tail {
    int n, index[KERNEL_CHUNK];
    double x[KERNEL_CHUNK], y[KERNEL_CHUNK], square[KERNEL_CHUNK];
};

static void induce_near_tail(const struct flow *flow, int f, const struct near_tail *near) {
    const struct vortices *const body = &flow->convecting;
    const int first = flow->body_range[f].first;
    const double smoothing = flow->school->fish[f].smoothing;
    double u[KERNEL_CHUNK] = {0}, v[KERNEL_CHUNK] = {0};

    kernel_add_velocity_change_at(near->n, near->x, near->y, near->square, flow->body_range[f].n, body->x + first,
                                  body->y + first, body->circulation + first, smoothing * smoothing, u, v);

    for (int i = 0; i < near->n; i++) {
        flow->wake_u[near->index[i]] += u[i];
        flow->wake_v[near->index[i]] += v[i];
    }
}

// The velocity of the own body at a newborn marker is evaluated h/(2 pi) behind the tail, because the velocity of the
// sheet is singular at the tail; h: length of the stretch between the newborn marker and the tail after the interval.
// The first step then equals the step of steady shedding.
static void induce_at_newborn(const struct flow *flow, const struct wake *wake, int f, const double tail[2],
                              const double tangent[2]) {
    const struct vortices *const body = &flow->convecting;
    const int first = flow->body_range[f].first, n = flow->body_range[f].n;
    const int newborn = flow->wake_range[f].first + wake->n_vortex - 1;
    const double along = wake->slip[0] * tangent[0] + wake->slip[1] * tangent[1];
    const double behind = fmax(0, along) * flow->school->interval / two_pi;
    const double x = tail[0] + behind * tangent[0], y = tail[1] + behind * tangent[1];

    double u[2] = {0}, v[2] = {0};

    kernel_add_velocity(1, &tail[0], &tail[1], n, body->x + first, body->y + first, body->circulation + first,
                        flow->school->fish[f].smoothing, &u[0], &v[0]);
    kernel_add_velocity(1, &x, &y, n, body->x + first, body->y + first, body->circulation + first, 0, &u[1], &v[1]);
    flow->wake_u[newborn] += u[1] - u[0];
    flow->wake_v[newborn] += v[1] - v[0];
}

static void markers_taper_own(const struct flow *flow, const struct state *state, int f) {
    const struct fish *const fish = &flow->school->fish[f];
    const struct wake *const wake = &state->wake[f];
    if (wake->n_vortex == 0 || fish->taper <= 0) return;
    const int at_tail = flow->points[f].first + flow_tail(fish);
    const double tail[2] = {flow->x[at_tail], flow->y[at_tail]};
    const struct direction body = fish_direction(fish, &fish->tail_tangent, state->y);

    struct near_tail near = {.n = 0};
    for (int i = wake->n_vortex - 2; i >= 0; i--) {
        const double from_tail[2] = {wake->x[i] - tail[0], wake->y[i] - tail[1]};
        if (free_sheet_is_far(fish, from_tail)) continue;
        const double smoothing = free_sheet_smoothing(fish, from_tail, body.t);

        near.index[near.n] = flow->wake_range[f].first + i;
        near.x[near.n] = wake->x[i];
        near.y[near.n] = wake->y[i];
        near.square[near.n++] = smoothing * smoothing;

        if (near.n < KERNEL_CHUNK) continue;
        induce_near_tail(flow, f, &near);
        near.n = 0;
    }

    induce_near_tail(flow, f, &near);
    induce_at_newborn(flow, wake, f, tail, body.t);
}

/* Set wake_u and wake_v to the velocity at the markers. Fails with STATUS_MEMORY. */
static enum status flow_at_markers(struct flow *flow, const struct state *state) {
    const struct vortices *const markers = &flow->convecting;
    TRY(markers_induce_all(
        flow, &(struct induced){
                  .n = flow->n_markers, .x = markers->x, .y = markers->y, .u = flow->wake_u, .v = flow->wake_v}));
    const int threads = fish_threads(flow->school);
#pragma omp parallel for num_threads(threads) schedule(dynamic)
    for (int f = 0; f < flow->school->n_fish; f++) markers_taper_own(flow, state, f);
    return STATUS_OK;
}

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
        for (int i = 0; i < at.n; i++) {
            flow_external(flow->school, flow->t, at.x[i], at.y[i], &at.u[i], &at.v[i]);
        }
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
        TRY(MEMORY_NEW(*all[i], capacity, "velocities of vortices"));
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
