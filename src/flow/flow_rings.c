/* flow_rings.c: direct sums, fish by fish; the tree for the other fish of large schools. */
#include "flow/flow_rings.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "flow/flow.h"
#include "vortex/kernel.h"
#include "vortex/tolerance.h"
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

// ---- sums by the tree: all bodies, or all wakes, of one class at the targets of one class

enum { BODIES, WAKES };

static int *by_tree(const struct flow *flow, int kind, int of_images, int targets, int sources) {
    const int n = flow->n_classes;
    return &flow->rings->by_tree[((2 * kind + of_images) * n + targets) * n + sources];
}

// whether the rings of fish g at fish f are in a sum by the tree
static int is_by_tree(const struct flow *flow, int kind, int of_images, int f, int g) {
    return *by_tree(flow, kind, of_images, flow->class_of[f], flow->class_of[g]);
}

void flow_rings_direct(const struct flow *flow) {
    memset(flow->rings->by_tree, 0, 4 * (size_t)flow->n_classes * (size_t)flow->n_classes * sizeof(int));
}

// append rings with their span in the strengths
static enum status append_with_span(struct rings *many, const struct rings *rings, double span) {
    const int first = many->n;
    TRY(ring_append(many, rings->n));
    for (int i = 0; i < rings->n; i++) {
        many->x[first + i] = rings->x[i];
        many->y[first + i] = rings->y[i];
        many->q[first + i] = span * rings->q[i];
        many->dx[first + i] = span * rings->dx[i];
        many->dy[first + i] = span * rings->dy[i];
        many->half[first + i] = rings->half[i];
        many->leg[first + i] = rings->leg[i];
    }

    return STATUS_OK;
}

/* A sum at the targets of one class: which rings of each fish, with the square of the smoothing. Sum i of four has the
 * kind i / 2, of the images for an odd i. */
struct many {
    int kind;
    int targets, sources; /* classes */
    double square;
    int at_markers, of_images;
};

static const struct rings *many_of(const struct fish_rings *of, const struct many *which) {
    if (which->kind == BODIES) return which->of_images ? &of->body_image : &of->body;
    if (which->at_markers) return which->of_images ? &of->markers_image : &of->markers;
    return which->of_images ? &of->middles_image : &of->wake.middles.rings;
}

static enum status sum_by_tree(const struct flow *flow, const struct many *which, int threads,
                               const struct ring_targets *at) {
    const struct school *const school = flow->school;
    struct rings *const many = &flow->rings->many;
    const struct fish *fish = NULL; /* the first fish of the targets: all have one length */
    many->n = 0;
    for (int f = school->n_fish - 1; f >= 0; f--) {
        if (flow->class_of[f] == which->targets) fish = &school->fish[f];
    }
    for (int g = 0; g < school->n_fish; g++) {
        if (flow->class_of[g] != which->sources) continue;
        const double span = ring_other_pair(&school->fish[g], 0).span;
        TRY(append_with_span(many, many_of(&flow->rings->fish[g], which), span));
    }

    const struct ring_pair pair = {.span = 1, .factor = ring_other_pair(fish, 0).factor, .square = which->square};
    // bodies, wakes and images share the tolerance
    const int n_sums = school->walls.n > 0 ? 4 : 2;
    const double unit = fish->length * fish_rate(school, fish);
    const double tolerance = school->wake_tolerance * unit / (TOLERANCE_RINGS * n_sums);
    return ring_tree_induce(flow->rings->tree, &pair, many, fish->length, tolerance, threads, at);
}

// select the sums by the tree
static void select_by_tree(const struct flow *flow, int at_markers) {
    const struct school *const school = flow->school;
    for (int i = 0; i < 4; i++) {
        const struct many which = {.kind = i / 2, .of_images = i % 2, .at_markers = at_markers};
        for (int c = 0; c < flow->n_classes; c++) {
            for (int k = 0; k < flow->n_classes; k++) {
                // the tree includes the own rings of a fish, which are then subtracted
                int n_targets = 0, n_sources = 0;
                double own = 0;
                for (int f = 0; f < school->n_fish; f++) {
                    const int n = at_markers ? flow->wake_range[f].n : flow->points[f].n;
                    const int n_rings = many_of(&flow->rings->fish[f], &which)->n;
                    n_targets += flow->class_of[f] == c ? n : 0;
                    n_sources += flow->class_of[f] == k ? n_rings : 0;
                    if (flow->class_of[f] == c && c == k && !which.of_images) own += (double)n * n_rings;
                }
                *by_tree(flow, which.kind, which.of_images, c, k) =
                    ring_tree_is_faster(n_sources, (double)n_targets * n_sources - 2 * own, school->wake_tolerance);
            }
        }
    }
}

enum status flow_rings_many(const struct flow *flow, int threads, int with_gradient) {
    select_by_tree(flow, 0);
    const struct ring_targets all = ring_body_targets(flow, with_gradient);
    for (int c = 0; c < flow->n_classes; c++) {
        struct ring_targets at = ring_targets_part(&all, flow->class[c].points);
        struct rings *const places = &flow->rings->places;
        places->n = 0;
        TRY(ring_append(places, at.n));
        for (int f = 0; f < flow->school->n_fish; f++) {
            if (flow->class_of[f] != c) continue;
            memcpy(places->half + flow->points[f].first - flow->class[c].points.first, flow->school->fish[f].point_half,
                   (size_t)flow->points[f].n * sizeof(double));
        }
        at.half = places->half;

        for (int k = 0; k < flow->n_classes; k++) {
            const struct flow_class *const class = &flow->class[k];
            const double squares[] = {mean_square(flow->class[c].sheet_smoothing, class->sheet_smoothing),
                                      class->smoothing * class->smoothing};
            for (int i = 0; i < 4; i++) {
                const struct many which = {
                    .kind = i / 2, .of_images = i % 2, .targets = c, .sources = k, .square = squares[i / 2]};
                if (*by_tree(flow, which.kind, which.of_images, c, k)) TRY(sum_by_tree(flow, &which, threads, &at));
            }
        }
    }

    return STATUS_OK;
}

// Add the rings of another fish that are not in the sum by the tree; subtract the rings of the own fish from this sum.
static void induce_other(const struct ring_pair *pair, const struct rings *rings, int is_own, int is_in_tree,
                         const struct ring_targets *at) {
    if (is_own != is_in_tree) return;
    struct ring_pair with = *pair;
    if (is_own) with.span = -with.span;
    induce(&with, rings, at);
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

        induce_other(&of_body, &of->body, g == f, is_by_tree(flow, BODIES, 0, f, g), at);
        induce_other(&of_wake, &of->wake.middles.rings, g == f, is_by_tree(flow, WAKES, 0, f, g), at);

        if (school->walls.n == 0) continue;
        induce_other(&of_body, &of->body_image, 0, is_by_tree(flow, BODIES, 1, f, g), at);
        induce_other(&of_wake, &of->middles_image, 0, is_by_tree(flow, WAKES, 1, f, g), at);
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
            const int is_own = pass == 0 && g == f;
            induce_other(&of_body, pass == 0 ? &of->body : &of->body_image, is_own,
                         is_by_tree(flow, BODIES, pass, f, g), &image);
            induce_other(&of_wake, pass == 0 ? &of->markers : &of->markers_image, is_own,
                         is_by_tree(flow, WAKES, pass, f, g), &image);
        }

        for (int i = 0; i < which.n && pass == 1; i++) {
            at.u[i] += image.u[i];
            at.v[i] += image.v[i];
            at.div[i] += image.div[i];
        }
    }
}

// add the sums by the tree; markers of one class are not consecutive
static enum status add_many_at_markers(const struct flow *flow, int threads, const struct many *which) {
    const struct flow_rings *const rings = flow->rings;
    struct rings *const places = &flow->rings->places;
    const int n_fish = flow->school->n_fish;
    places->n = 0;
    for (int f = 0; f < n_fish; f++) {
        if (flow->class_of[f] == which->targets) TRY(append_with_span(places, &rings->fish[f].markers, 0));
    }

    // the sums replace the strengths
    const struct ring_targets at = {.n = places->n,
                                    .x = places->x,
                                    .y = places->y,
                                    .half = places->half,
                                    .leg = places->leg,
                                    .u = places->q,
                                    .v = places->dx,
                                    .div = places->dy};
    TRY(sum_by_tree(flow, which, threads, &at));
    for (int f = 0, p = 0; f < n_fish; f++) {
        if (flow->class_of[f] != which->targets) continue;
        for (int i = flow->wake_range[f].first; i < flow->wake_range[f].first + flow->wake_range[f].n; i++, p++) {
            flow->wake_u[i] += at.u[p];
            flow->wake_v[i] += at.v[p];
            rings->wake_div[i] += at.div[p];
            if (!which->of_images) continue;
            flow->wake_image_u[i] += at.u[p];
            flow->wake_image_v[i] += at.v[p];
            rings->wake_image_div[i] += at.div[p];
        }
    }

    return STATUS_OK;
}

static enum status flow_rings_many_at_markers(const struct flow *flow, int threads) {
    for (int c = 0; c < flow->n_classes; c++) {
        for (int k = 0; k < flow->n_classes; k++) {
            const double own = flow->class[c].smoothing;
            const double squares[] = {own * own, mean_square(own, flow->class[k].smoothing)};
            for (int i = 0; i < 4; i++) {
                const struct many which = {.kind = i / 2,
                                           .of_images = i % 2,
                                           .targets = c,
                                           .sources = k,
                                           .square = squares[i / 2],
                                           .at_markers = 1};
                if (*by_tree(flow, which.kind, which.of_images, c, k)) TRY(add_many_at_markers(flow, threads, &which));
            }
        }
    }

    return STATUS_OK;
}

enum status flow_rings_at_markers(struct flow *flow, const struct state *state) {
    TRY(rings_place_markers(flow, state));
    TRY(rings_reserve_at_markers(flow, flow->n_markers));
    const struct school *const school = flow->school;
    int n_chunks = 0;
    for (int f = 0; f < school->n_fish; f++) n_chunks += (flow->wake_range[f].n + MARKERS - 1) / MARKERS;
    const double work = 6.0 * flow->n_markers * flow->n_markers * (1 + flow->rings->n_images);
    const int threads = parallel_threads(school->threads, n_chunks, work, PARALLEL_INTERACTIONS);
    select_by_tree(flow, 1);
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

    TRY(flow_rings_many_at_markers(flow, threads));

    // [p] = 0 on the wake
    for (int f = 0; f < school->n_fish; f++) {
        const int first = flow->wake_range[f].first;
        const double *const label = state->wake[f].circulation;
        for (int i = 0; i < flow->wake_range[f].n; i++) {
            flow->rings->wake_rate[first + i] = -label[i] * flow->rings->wake_div[first + i];
        }
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
