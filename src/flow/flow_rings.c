/* flow_rings.c: direct sums, fish by fish. */
#include "flow/flow_rings.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "flow/flow.h"
#include "vortex/kernel.h"
#include "wake/free_sheet.h"

static const double two_pi = 6.28318530717958647692;

// ---- pairs of fish

// smoothing and span of the pairs within a fish, and of the pairs of a source and another target
static struct ring_pair ring_own_pair(const struct fish *fish, double square) {
    return (struct ring_pair){.span = fish->strip_depth / 4, .factor = 1, .square = square};
}

static struct ring_pair ring_other_pair(const struct fish *source, double square) {
    return (struct ring_pair){.span = source->strip_depth / 2, .factor = 4, .square = square};
}

static double mean_square(double one, double other) {
    return (one * one + other * other) / 2;
}

static void induce(const struct ring_pair *pair, const struct rings *rings, const struct ring_targets *at) {
    ring_induce(pair, rings, (struct range){0, rings->n}, at);
}

// sources from number first on
static void induce_from(const struct ring_pair *pair, const struct rings *rings, int first,
                        const struct ring_targets *at) {
    ring_induce(pair, rings, (struct range){first, rings->n - first}, at);
}

// ---- bodies

static struct ring_targets ring_body_targets(const struct flow *flow, int with_gradient) {
    const struct flow_rings *const rings = flow->rings;
    struct ring_targets all = {
        .n = flow->n_points, .x = flow->x, .y = flow->y, .u = flow->u, .v = flow->v, .div = rings->div};

    if (with_gradient) {
        all.u_x = flow->u_x;
        all.u_y = flow->u_y;
        all.v_x = flow->v_x;
        all.div_x = rings->div_x;
        all.div_y = rings->div_y;
    }

    return all;
}

void flow_rings_zero(const struct flow *flow, int with_gradient) {
    const struct flow_rings *const rings = flow->rings;
    const size_t size = (size_t)flow->n_points * sizeof(double);
    memset(rings->div, 0, size);
    memset(rings->edge, 0, 2 * size);
    if (!with_gradient) return;
    memset(rings->div_x, 0, size);
    memset(rings->div_y, 0, size);
    memset(rings->edge_gradient, 0, 4 * size);
}

static struct range range_overlap(struct range one, struct range other) {
    const int first = one.first > other.first ? one.first : other.first;
    const int end = one.first + one.n < other.first + other.n ? one.first + one.n : other.first + other.n;
    return (struct range){first, end > first ? end - first : 0};
}

// own body and own wake
static void flow_rings_induce_own(const struct flow *flow, const struct chunk *chunk, const struct ring_targets *all,
                                  const double *half, int with_gradient) {
    const struct fish *const fish = &flow->school->fish[chunk->fish];
    const struct fish_rings *const of = &flow->rings->fish[chunk->fish];
    const struct range points = flow->points[chunk->fish];
    const struct range control = range_overlap(chunk->at, (struct range){points.first, fish->n_control});
    const struct range others =
        range_overlap(chunk->at, (struct range){points.first + fish->n_control, points.n - fish->n_control});

    const int n_far = with_gradient ? 0 : of->n_far;

    // control points: all sources of the own body and the graded wake, with legs
    struct ring_targets at = ring_targets_part(all, control);

    at.half = half + control.first - points.first;
    if (fish->depth_varies) {
        at.edge = flow->rings->edge + control.first;
        at.edge_gradient = with_gradient ? flow->rings->edge_gradient + control.first : NULL;
        at.edge_stride = flow->n_points;
    }

    const struct ring_pair exact = ring_own_pair(fish, 0);
    induce(&exact, &of->own, &at);
    induce_from(&exact, &of->wake.graded.rings, n_far, &at);

    // edge midpoints and tail: middles of the wake
    if (!fish_feels_own_wake(fish) || others.n == 0) return;
    const struct ring_pair smooth = ring_own_pair(fish, fish->smoothing * fish->smoothing);
    at = ring_targets_part(all, others);
    at.half = half + others.first - points.first;
    induce_from(&smooth, &of->wake.middles.rings, n_far, &at);
}

void flow_rings_far(const struct flow *flow) {
    const struct school *const school = flow->school;
#pragma omp parallel for num_threads(fish_threads(school)) schedule(static)
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *const fish = &school->fish[f];
        struct fish_rings *const of = &flow->rings->fish[f];
        const struct range points = flow->points[f], far = {0, of->n_far};
        if (of->n_far == 0) continue;

        // all values of half are equal
        const struct ring_targets all = {.n = FISH_FAR,
                                         .x = of->far[0],
                                         .y = of->far[1],
                                         .half = fish->point_half,
                                         .u = of->far[2],
                                         .v = of->far[3],
                                         .div = of->far[4]};
        memset(of->far[2], 0, 3 * sizeof of->far[2]);
        const struct range control = {0, FISH_FAR_CONTROL}, others = {FISH_FAR_CONTROL, FISH_FAR - FISH_FAR_CONTROL};
        const struct ring_pair exact = ring_own_pair(fish, 0),
                               smooth = ring_own_pair(fish, fish->smoothing * fish->smoothing);
        struct ring_targets at = ring_targets_part(&all, control);
        ring_induce(&exact, &of->wake.graded.rings, far, &at);
        at = ring_targets_part(&all, others);
        if (fish_feels_own_wake(fish)) ring_induce(&smooth, &of->wake.middles.rings, far, &at);

        double *const to[] = {flow->u, flow->v, flow->rings->div};
        for (int i = 0; i < 3; i++) {
            kernel_multiply(points.n, FISH_FAR, fish->point_by_far, of->far[2 + i], to[i] + points.first);
        }
    }
}

// other fish, and all images
static void induce_others(const struct flow *flow, int f, const struct ring_targets *at) {
    const struct school *const school = flow->school;
    for (int g = 0; g < school->n_fish; g++) {
        const struct fish *const other = &school->fish[g];
        const struct fish_rings *const of = &flow->rings->fish[g];
        const double sheets = mean_square(school->fish[f].sheet_smoothing, other->sheet_smoothing);
        const struct ring_pair of_body = ring_other_pair(other, sheets);
        const struct ring_pair of_wake = ring_other_pair(other, other->smoothing * other->smoothing);

        if (g != f) induce(&of_body, &of->body, at);
        if (g != f) induce(&of_wake, &of->wake.middles.rings, at);

        if (school->walls.n == 0) continue;
        induce(&of_body, &of->body_image, at);
        induce(&of_wake, &of->middles_image, at);
    }
}

void flow_rings_at_chunk(const struct flow *flow, const struct chunk *chunk, int with_gradient) {
    const struct fish *const fish = &flow->school->fish[chunk->fish];
    const struct ring_targets all = ring_body_targets(flow, with_gradient);
    flow_rings_induce_own(flow, chunk, &all, fish->point_half, with_gradient);

    struct ring_targets at = ring_targets_part(&all, chunk->at);
    at.half = fish->point_half + chunk->at.first - flow->points[chunk->fish].first;
    induce_others(flow, chunk->fish, &at);
}

double flow_rings_work(const struct flow *flow) {
    // a ring costs about as much as six vortices
    const double of_vortices = 6 * (1.0 + flow->rings->n_images);
    double work = 0;
    for (int f = 0; f < flow->school->n_fish; f++) {
        const struct fish_rings *const of = &flow->rings->fish[f];
        work += of_vortices * flow->n_points * (of->body.n + of->wake.middles.rings.n);
    }

    return work;
}

void flow_rings_images(struct flow *flow) {
    const struct flow_rings *const rings = flow->rings;
    const struct school *const school = flow->school;
    const size_t size = (size_t)flow->n_points * sizeof(double);
    const struct ring_targets all = {.n = flow->n_points,
                                     .x = flow->x,
                                     .y = flow->y,
                                     .u = flow->image_u,
                                     .v = flow->image_v,
                                     .div = rings->image_div};

    memset(flow->image_u, 0, size);
    memset(flow->image_v, 0, size);
    memset(rings->image_div, 0, size);

    for (int f = 0; f < school->n_fish; f++) {
        struct ring_targets at = ring_targets_part(&all, flow->points[f]);
        at.half = school->fish[f].point_half;
        for (int g = 0; g < school->n_fish; g++) {
            const struct fish *const other = &school->fish[g];
            const struct ring_pair of_body =
                ring_other_pair(other, mean_square(school->fish[f].sheet_smoothing, other->sheet_smoothing));
            const struct ring_pair of_wake = ring_other_pair(other, other->smoothing * other->smoothing);
            induce(&of_body, &rings->fish[g].body_image, &at);
            induce(&of_wake, &rings->fish[g].middles_image, &at);
        }
    }
}

void flow_rings_at(const struct flow *flow, const struct induced *at) {
    const struct school *const school = flow->school;
    const struct ring_targets to = {
        .n = at->n, .x = at->x, .y = at->y, .u = at->u, .v = at->v, .u_x = at->u_x, .u_y = at->u_y, .v_x = at->v_x};

    for (int g = 0; g < school->n_fish; g++) {
        const struct fish *const fish = &school->fish[g];
        const struct fish_rings *const of = &flow->rings->fish[g];
        const struct ring_pair of_body = ring_other_pair(fish, fish->sheet_smoothing * fish->sheet_smoothing);
        const struct ring_pair of_wake = ring_other_pair(fish, fish->smoothing * fish->smoothing);
        induce(&of_body, &of->body, &to);
        induce(&of_wake, &of->wake.middles.rings, &to);
        if (school->walls.n == 0) continue;
        induce(&of_body, &of->body_image, &to);
        induce(&of_wake, &of->middles_image, &to);
    }
}

// ---- markers

static enum status rings_reserve_at_markers(struct flow *flow, int n) {
    struct flow_rings *const rings = flow->rings;
    if (n <= rings->wake_capacity) return STATUS_OK;
    const int capacity = n + n / 2;
    double **const all[] = {&rings->wake_div,   &rings->wake_rate,  &rings->wake_image_div,
                            &rings->wake_leg_u, &rings->wake_leg_v, &rings->wake_leg_div};
    rings->wake_capacity = 0;
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        free(*all[i]);
        TRY(MEMORY_NEW(*all[i], capacity, "velocities of markers"));
    }

    rings->wake_capacity = capacity;
    return STATUS_OK;
}

static enum status rings_place_markers(struct flow *flow, const struct state *state) {
    const struct school *const school = flow->school;
    flow->n_markers = 0;

    for (int f = 0; f < school->n_fish; f++) {
        struct fish_rings *const of = &flow->rings->fish[f];
        of->markers.n = 0;
        TRY(ring_sheet_markers(&of->markers, &school->fish[f], school, &state->wake[f], state->t,
                               flow->nascent.circulation[f]));
        flow->wake_range[f] = (struct range){flow->n_markers, of->markers.n};
        flow->n_markers += of->markers.n;
        TRY(ring_write_images(&of->markers, flow->rings->n_images, flow->rings->image, &of->markers_image));
    }

    return STATUS_OK;
}

// squares of the smoothing between markers and the own body; at the newborn marker the velocity of the own body is
// evaluated h/(2 pi) behind the tail
static void rings_taper(const struct flow *flow, const struct state *state, int f, struct range which, double *x,
                        double *y, double *square) {
    const struct fish *const fish = &flow->school->fish[f];
    const struct rings *const markers = &flow->rings->fish[f].markers;
    const struct wake *const wake = &state->wake[f];
    const struct direction body = fish_direction(fish, &fish->tail_tangent, state->y);
    const double tail[2] = {state->y[fish->at.x + fish->n_nodes - 1], state->y[fish->at.y + fish->n_nodes - 1]};

    for (int i = 0; i < which.n; i++) {
        const int m = which.first + i;
        const double from_tail[2] = {markers->x[m] - tail[0], markers->y[m] - tail[1]};
        const double smoothing = free_sheet_smoothing(fish, from_tail, body.t);

        x[i] = markers->x[m];
        y[i] = markers->y[m];
        square[i] = smoothing * smoothing;

        // newborn marker
        if (m < markers->n - 1 || fish->taper <= 0) continue;
        const double along = wake->slip[0] * body.t[0] + wake->slip[1] * body.t[1];
        const double behind = fmax(0, along) * flow->school->interval / two_pi;
        x[i] = tail[0] + behind * body.t[0];
        y[i] = tail[1] + behind * body.t[1];
        square[i] = 0;
    }
}

enum { MARKERS = 64 };  // markers of one fish that a thread evaluates at once

// set the velocity of the own sheet at all markers of a fish
static void induce_own_markers(const struct flow *flow, int f) {
    const struct flow_rings *const rings = flow->rings;
    const struct fish *const fish = &flow->school->fish[f];
    const struct rings *const markers = &rings->fish[f].markers;
    const int first = flow->wake_range[f].first;
    const struct ring_targets at = {.n = markers->n,
                                    .x = markers->x,
                                    .y = markers->y,
                                    .half = markers->half,
                                    .leg = markers->leg,
                                    .u = flow->wake_u + first,
                                    .v = flow->wake_v + first,
                                    .leg_u = rings->wake_leg_u + first,
                                    .leg_v = rings->wake_leg_v + first,
                                    .div = rings->wake_div + first};
    double *const sums[] = {at.u, at.v, at.leg_u, at.leg_v, at.div};
    for (size_t i = 0; i < sizeof sums / sizeof *sums; i++) memset(sums[i], 0, (size_t)at.n * sizeof **sums);
    const struct ring_pair smooth = ring_own_pair(fish, fish->smoothing * fish->smoothing);
    ring_induce_mutual(&smooth, markers, &at);
}

// add the velocity of all others
static void induce_at_markers(const struct flow *flow, const struct state *state, int f, struct range which) {
    const struct school *const school = flow->school;
    const struct flow_rings *const rings = flow->rings;
    const struct fish *const fish = &school->fish[f];
    const struct rings *const markers = &rings->fish[f].markers;
    const int first = flow->wake_range[f].first + which.first;
    double x[MARKERS], y[MARKERS], square[MARKERS];
    struct ring_targets at = {.n = which.n,
                              .x = markers->x + which.first,
                              .y = markers->y + which.first,
                              .half = markers->half + which.first,
                              .leg = markers->leg + which.first,
                              .u = flow->wake_u + first,
                              .v = flow->wake_v + first,
                              .leg_u = rings->wake_leg_u + first,
                              .leg_v = rings->wake_leg_v + first,
                              .div = rings->wake_div + first};

    for (int i = 0; i < which.n; i++) {
        double u, v;
        flow_external(school, flow->t, at.x[i], at.y[i], &u, &v);
        at.u[i] += u;
        at.v[i] += v;
    }

    // own body
    struct ring_targets near = at;
    const struct ring_pair exact = ring_own_pair(fish, 0);
    rings_taper(flow, state, f, which, x, y, square);
    near.x = x;
    near.y = y;
    near.square = square;
    induce(&exact, &rings->fish[f].body, &near);
    memcpy(rings->wake_leg_div + first, at.div, (size_t)which.n * sizeof *at.div);

    // others; images
    at.leg_u = at.leg_v = NULL;
    struct ring_targets image = at;
    for (int pass = 0; pass < (school->walls.n > 0 ? 2 : 1); pass++) {
        if (pass == 1) {
            image.u = flow->wake_image_u + first;
            image.v = flow->wake_image_v + first;
            image.div = rings->wake_image_div + first;
            for (int i = 0; i < which.n; i++) image.u[i] = image.v[i] = image.div[i] = 0;
        }

        for (int g = 0; g < school->n_fish; g++) {
            const struct fish *const other = &school->fish[g];
            const struct fish_rings *const of = &rings->fish[g];
            const struct ring_pair of_body = ring_other_pair(other, fish->smoothing * fish->smoothing);
            const struct ring_pair of_wake = ring_other_pair(other, mean_square(fish->smoothing, other->smoothing));
            if (pass == 0 && g == f) continue;
            induce(&of_body, pass == 0 ? &of->body : &of->body_image, &image);
            induce(&of_wake, pass == 0 ? &of->markers : &of->markers_image, &image);
        }

        for (int i = 0; i < which.n && pass == 1; i++) {
            at.u[i] += image.u[i];
            at.v[i] += image.v[i];
            at.div[i] += image.div[i];
        }
    }

    // [p] = 0 on the wake
    const double *const label = state->wake[f].circulation + which.first;
    for (int i = 0; i < which.n; i++) rings->wake_rate[first + i] = -label[i] * at.div[i];
}

enum status flow_rings_at_markers(struct flow *flow, const struct state *state) {
    TRY(rings_place_markers(flow, state));
    TRY(rings_reserve_at_markers(flow, flow->n_markers));
    const struct school *const school = flow->school;
    int n_chunks = 0;
    for (int f = 0; f < school->n_fish; f++) n_chunks += (flow->wake_range[f].n + MARKERS - 1) / MARKERS;
    const double work = 6.0 * flow->n_markers * flow->n_markers * (1 + flow->rings->n_images);
    const int threads = parallel_threads(school->threads, n_chunks, work, PARALLEL_INTERACTIONS);
#pragma omp parallel for num_threads(threads) schedule(dynamic)
    for (int f = 0; f < school->n_fish; f++) {
        if (flow->wake_range[f].n > 0) induce_own_markers(flow, f);
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

    return STATUS_OK;
}

// ---- momentum

// add the momentum rate of the rings of a fish in the velocity of legs: sum of q E3 u + div E3 d, and its moment
static void rings_add_rate(const struct rings *rings, const double *u, const double *v, const double *div,
                           double rate[3]) {
    for (int i = 0; i < rings->n; i++) {
        const double x = -rings->q[i] * v[i] - div[i] * rings->dy[i], y = rings->q[i] * u[i] + div[i] * rings->dx[i];
        rate[0] += x;
        rate[1] += y;
        rate[2] += rings->x[i] * y - rings->y[i] * x;
    }
}

void flow_rings_leg_rate(const struct flow *flow, int f, double rate[3]) {
    const struct flow_rings *const rings = flow->rings;
    const struct fish *const fish = &flow->school->fish[f];
    const struct fish_rings *const of = &rings->fish[f];
    const struct ring_pair exact = ring_own_pair(fish, 0);
    const int wake = flow->wake_range[f].first, n = fish->n_control;

    // u and v contain all parts; only the parts of the legs are used
    double *const *const sum = rings->legs;
    const struct ring_targets at = {.n = n,
                                    .x = of->body.x,
                                    .y = of->body.y,
                                    .half = of->body.half,
                                    .u = sum[0],
                                    .v = sum[1],
                                    .leg_u = sum[2],
                                    .leg_v = sum[3],
                                    .div = sum[4],
                                    .edge = fish->depth_varies ? sum[5] : NULL,
                                    .edge_stride = (int)(sum[6] - sum[5])};

    for (int i = 0; i < N_LEG_SUMS; i++) memset(sum[i], 0, (size_t)n * sizeof(double));
    induce(&exact, &of->body, &at);
    induce(&exact, &of->markers, &at);

    rate[0] = rate[1] = rate[2] = 0;
    rings_add_rate(&of->body, at.leg_u, at.leg_v, at.div, rate);
    rings_add_rate(&of->markers, rings->wake_leg_u + wake, rings->wake_leg_v + wake, rings->wake_leg_div + wake, rate);

    // exclude the force along the side edges, which acts on the body
    for (int c = 0; c < n && fish->depth_varies; c++) {
        const double square = of->line[0][c] * of->line[0][c] + of->line[1][c] * of->line[1][c];
        const double along = (of->body.dx[c] * of->line[0][c] + of->body.dy[c] * of->line[1][c]) / square;
        const double size = along * fish->control_widening[c] * fish->control_interval[c];
        rate[0] -= size * sum[5][c];
        rate[1] -= size * sum[6][c];
        rate[2] -= size * (of->body.x[c] * sum[6][c] - of->body.y[c] * sum[5][c]);
    }
}
