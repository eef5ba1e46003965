/* flow_at_wake.c: sums at markers. Wakes act on themselves and on each other in pairs, or through the tree if they are
 * many; then bodies and images follow. */
#include "flow/flow_at_wake.h"

#include <math.h>
#include <string.h>

#include "flow/flow_at_bodies.h"
#include "flow/flow_external.h"
#include "flow/images.h"

static const double two_pi = 6.28318530717958647692;

enum { MARKERS = 64 };  // so many markers of one fish are evaluated by a thread at once

static void wakes_place(struct flow *flow, const struct state *state) {
    const struct school *const school = flow->school;
    flow->n_markers = 0;
    for (int f = 0; f < school->n_fish; f++) {
        struct flow_fish *const of = &flow->fish[f];
        of->markers.n = 0;
        if (flow_has_free_sheets(flow)) {
            sheet_markers(&of->markers, &of->wake, &school->fish[f], school, &state->wake[f], state->t, of->nascent);
        } else {
            const struct sources *const queue = &of->wake.middles.sources;
            sources_append(&of->markers, queue->n);
            memcpy(of->markers.x, queue->x, (size_t)queue->n * sizeof *queue->x);
            memcpy(of->markers.y, queue->y, (size_t)queue->n * sizeof *queue->y);
            memcpy(of->markers.q, queue->q, (size_t)queue->n * sizeof *queue->q);
        }
        flow->wake_range[f] = (struct range){flow->n_markers, of->markers.n};
        flow->n_markers += of->markers.n;
        images_write(&of->markers, flow->n_images, flow->image, &of->markers_image);
    }

    if (flow->n_markers <= flow->wake_capacity) return;
    flow->wake_capacity = flow->n_markers + flow->n_markers / 2;
    double **const all[] = {&flow->wake_u,         &flow->wake_v,     &flow->wake_div,   &flow->wake_image_u,
                            &flow->wake_image_v,   &flow->wake_leg_u, &flow->wake_leg_v, &flow->wake_leg_div,
                            &flow->wake_image_div, &flow->wake_rate};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) GROW(flow->arena, *all[i], flow->wake_capacity);
}

// a range of the markers of a fish as targets, with the arrays for the velocities of all sources
static struct targets markers_of(const struct flow *flow, int f, struct range which) {
    const struct sources *const markers = &flow->fish[f].markers;
    const int first = flow->wake_range[f].first + which.first;
    return (struct targets){.n = which.n,
                            .x = markers->x + which.first,
                            .y = markers->y + which.first,
                            .half = markers->half + which.first,
                            .leg = markers->leg + which.first,
                            .u = flow->wake_u + first,
                            .v = flow->wake_v + first,
                            .leg_u = flow->wake_leg_u + first,
                            .leg_v = flow->wake_leg_v + first,
                            .div = flow->wake_div + first};
}

// whether a wake acts on itself like on any other, that is with one pair of constants and in a sum by the tree
static bool own_is_in_tree(const struct flow *flow, int f) {
    const struct flow_sum sum = {WAKE_AT_WAKE, false};
    return !flow->kernel->has_legs && flow_is_by_tree(flow, f, f, &sum);
}

// Add the velocity induced by the body that shed the markers. Near the tail its smoothing is tapered, as that of the
// sheet. At the newborn marker the velocity is evaluated h/(2 pi) behind the tail.
static void induce_own_body(const struct flow *flow, const struct state *state, int f, struct range which,
                            const struct targets *markers) {
    const struct fish *const fish = &flow->school->fish[f];
    const struct flow_class *const kind = &flow->classes[flow->class_of[f]];
    const struct sources *const body = &flow->fish[f].body;
    const struct wake *const wake = &state->wake[f];
    const bool is_sheet = flow_has_free_sheets(flow);
    const struct kernel_pair pair =
        flow->kernel->own(fish->strip_depth, is_sheet ? 0 : flow_square(flow, BODY_AT_WAKE, kind, kind));
    const struct direction direction = fish_direction(fish, &fish->tail_tangent, state->y);
    const double tail[2] = {state->y[fish->at.x + fish->n_nodes - 1], state->y[fish->at.y + fish->n_nodes - 1]};
    double x[MARKERS], y[MARKERS], square[MARKERS];
    struct targets at = *markers;

    for (int i = 0; i < which.n && is_sheet; i++) {
        const double from_tail[2] = {markers->x[i] - tail[0], markers->y[i] - tail[1]};
        const double smoothing = sheet_taper(fish, from_tail, direction.t);
        x[i] = markers->x[i];
        y[i] = markers->y[i];
        square[i] = smoothing * smoothing;

        // the newborn marker
        if (which.first + i < wake->n_vortex - 1 || fish->taper <= 0) continue;
        const double along = wake->slip[0] * direction.t[0] + wake->slip[1] * direction.t[1];
        const double behind = fmax(0, along) * flow->school->interval / two_pi;
        x[i] = tail[0] + behind * direction.t[0];
        y[i] = tail[1] + behind * direction.t[1];
        square[i] = 0;
    }

    if (is_sheet) {
        at.x = x;
        at.y = y;
        at.square = square;
    }
    kernel_induce(&pair, body, (struct range){0, body->n}, &at);
}

static void induce_pair_of_wakes(const struct flow *flow, int f, int g) {
    const struct flow_sum wake = {WAKE_AT_WAKE, false};
    struct targets at_f = markers_of(flow, f, (struct range){0, flow->wake_range[f].n});
    struct targets at_g = markers_of(flow, g, (struct range){0, flow->wake_range[g].n});
    at_f.leg_u = at_f.leg_v = at_g.leg_u = at_g.leg_v = NULL;
    const struct kernel_pair pair = flow_pair_of(flow, f, g, &wake), back = flow_pair_of(flow, g, f, &wake);
    if (!(fabs(pair.span - back.span) + fabs(pair.square - back.square) > 0)) {
        kernel_induce_mutual(&pair, &flow->fish[f].markers, &at_f, &flow->fish[g].markers, &at_g);
    } else {
        flow_induce_other(flow, f, g, &wake, false, &at_f);
        flow_induce_other(flow, g, f, &wake, false, &at_g);
    }
}

// add the velocity of the external flow, of the body that shed the markers, and of everything else
static void induce_at_markers(const struct flow *flow, const struct state *state, int f, struct range which) {
    const struct school *const school = flow->school;
    const int first = flow->wake_range[f].first + which.first;
    struct targets at = markers_of(flow, f, which), own = at;
    for (int i = 0; i < which.n; i++) {
        double u, v;
        flow_external(school, flow->t, at.x[i], at.y[i], &u, &v);
        at.u[i] += u;
        at.v[i] += v;
    }

    own.div = flow->wake_leg_div + first;
    induce_own_body(flow, state, f, which, &own);
    for (int i = 0; i < which.n; i++) at.div[i] += own.div[i];
    at.leg_u = at.leg_v = NULL;

    for (int g = 0; g < school->n_fish; g++) {
        const struct flow_sum body = {BODY_AT_WAKE, false}, wake = {WAKE_AT_WAKE, false};
        flow_induce_other(flow, f, g, &body, g == f, &at);
        if (g != f && !flow->is_in_pairs) flow_induce_other(flow, f, g, &wake, false, &at);
    }
    if (school->walls.n == 0) return;

    struct targets image = at;
    image.u = flow->wake_image_u + first;
    image.v = flow->wake_image_v + first;
    image.div = flow->wake_image_div + first;
    for (int i = 0; i < which.n; i++) image.u[i] = image.v[i] = image.div[i] = 0;
    for (int g = 0; g < school->n_fish; g++) {
        flow_induce_other(flow, f, g, &(struct flow_sum){BODY_AT_WAKE, true}, false, &image);
        flow_induce_other(flow, f, g, &(struct flow_sum){WAKE_AT_WAKE, true}, false, &image);
    }
    for (int i = 0; i < which.n; i++) {
        at.u[i] += image.u[i];
        at.v[i] += image.v[i];
        at.div[i] += image.div[i];
    }
}

// add one sum by the tree at the markers of class c, which have to be gathered because they are not consecutive
static void add_by_tree(struct flow *flow, int c, int k, const struct flow_sum *sum, int threads) {
    struct sources *const places = &flow->places;
    const int n_fish = flow->school->n_fish;
    places->n = 0;
    for (int f = 0; f < n_fish; f++) {
        if (flow->class_of[f] != c) continue;
        const struct sources *const markers = &flow->fish[f].markers;
        const int first = places->n;
        sources_append(places, markers->n);
        const double *const from[] = {markers->x, markers->y, markers->half, markers->leg};
        double *const to[] = {places->x, places->y, places->half, places->leg};
        for (int i = 0; i < 4 && markers->n > 0; i++) {
            memcpy(to[i] + first, from[i], (size_t)markers->n * sizeof(double));
        }
    }

    // the sums overwrite the strengths of the gathered markers
    const struct targets at = {.n = places->n,
                               .x = places->x,
                               .y = places->y,
                               .half = places->half,
                               .leg = places->leg,
                               .u = places->q,
                               .v = places->dx,
                               .div = places->dy};
    flow_sum_by_tree(flow, c, k, sum, threads, &at);
    for (int f = 0, p = 0; f < n_fish; f++) {
        if (flow->class_of[f] != c) continue;
        for (int i = flow->wake_range[f].first; i < flow->wake_range[f].first + flow->wake_range[f].n; i++, p++) {
            flow->wake_u[i] += at.u[p];
            flow->wake_v[i] += at.v[p];
            flow->wake_div[i] += at.div[p];
            if (!sum->of_images) continue;
            flow->wake_image_u[i] += at.u[p];
            flow->wake_image_v[i] += at.v[p];
            flow->wake_image_div[i] += at.div[p];
        }
    }
}

void flow_at_wake(struct flow *flow, const struct state *state) {
    flow_place(flow, state, state->t, state->y);
    wakes_place(flow, state);
    const struct school *const school = flow->school;
    int n_chunks = 0;
    for (int f = 0; f < school->n_fish; f++) n_chunks += (flow->wake_range[f].n + MARKERS - 1) / MARKERS;
    const double work = (double)flow->kernel->cost * flow->n_markers * flow->n_markers * (1 + flow->n_images);
    const int threads = parallel_threads(school->threads, n_chunks, work, PARALLEL_INTERACTIONS);
    flow_select_by_tree(flow, true, flow->wake_range);
    flow->is_in_pairs = true;
    for (int i = 0; i < 4 * flow->n_classes * flow->n_classes; i++) flow->is_in_pairs &= !flow->by_tree[i];

#pragma omp parallel for num_threads(threads) schedule(dynamic)
    for (int f = 0; f < school->n_fish; f++) {
        // set the velocities at all markers of a fish to those of its own wake
        if (flow->wake_range[f].n == 0) continue;
        const struct flow_class *const kind = &flow->classes[flow->class_of[f]];
        const struct kernel_pair smooth =
            flow->kernel->own(school->fish[f].strip_depth, flow_square(flow, WAKE_AT_WAKE, kind, kind));
        struct targets at = markers_of(flow, f, (struct range){0, flow->wake_range[f].n});
        double *const sums[] = {at.u, at.v, at.leg_u, at.leg_v, at.div, flow->wake_leg_div + flow->wake_range[f].first};
        at.div = sums[5];
        for (size_t i = 0; i < sizeof sums / sizeof *sums; i++) memset(sums[i], 0, (size_t)at.n * sizeof **sums);
        const struct sources *const own = &flow->fish[f].markers;
        const struct flow_sum wake = {WAKE_AT_WAKE, false};
        if (own_is_in_tree(flow, f)) continue;
        kernel_induce_mutual(&smooth, own, &at, own, &at);
        if (!flow_is_by_tree(flow, f, f, &wake)) continue;

        // the tree adds the wake as that of another fish, so subtract this
        struct kernel_pair other = flow_pair_of(flow, f, f, &wake);
        other.span = -other.span;
        at.leg_u = at.leg_v = NULL;
        at.div = sums[4];
        kernel_induce_mutual(&other, own, &at, own, &at);
    }
    // Without a tree, wakes act on each other in pairs. The pairs are the rounds of a tournament, so that no fish is in
    // two pairs that threads evaluate at the same time.
    const int n_rounds = school->n_fish - 1 + school->n_fish % 2;
    for (int round = 0; round < n_rounds && flow->is_in_pairs; round++) {
#pragma omp parallel for num_threads(threads) schedule(dynamic)
        for (int i = 0; i <= n_rounds / 2; i++) {
            const int f = (round + i) % n_rounds, g = i == 0 ? n_rounds : (round + n_rounds - i) % n_rounds;
            if (g < school->n_fish) induce_pair_of_wakes(flow, f, g);
        }
    }
#pragma omp parallel for num_threads(threads) schedule(dynamic)
    for (int chunk = 0; chunk < n_chunks; chunk++) {
        int f = 0, before = 0, n = (flow->wake_range[0].n + MARKERS - 1) / MARKERS;
        while (chunk >= before + n) {
            before += n;
            f++;
            n = (flow->wake_range[f].n + MARKERS - 1) / MARKERS;
        }

        const int first = (chunk - before) * MARKERS, left = flow->wake_range[f].n - first;
        induce_at_markers(flow, state, f, (struct range){first, left < MARKERS ? left : MARKERS});
    }

    for (int c = 0; c < flow->n_classes; c++) {
        for (int k = 0; k < flow->n_classes; k++) {
            int f = 0, g = 0;
            while (flow->class_of[f] != c) f++;
            while (flow->class_of[g] != k) g++;
            for (int i = 0; i < 4; i++) {
                const struct flow_sum sum = {i < 2 ? BODY_AT_WAKE : WAKE_AT_WAKE, i % 2};
                if (flow_is_by_tree(flow, f, g, &sum)) add_by_tree(flow, c, k, &sum, threads);
            }
        }
    }

    // the label changes so that the pressure is continuous across the wake, [p] = 0
    for (int f = 0; f < school->n_fish; f++) {
        const int first = flow->wake_range[f].first;
        const double *const label = state->wake[f].circulation;
        for (int i = 0; i < state->wake[f].n_vortex; i++) {
            flow->wake_rate[first + i] = -label[i] * flow->wake_div[first + i];
        }
    }
}
