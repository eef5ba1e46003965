/* flow_at_bodies.c: sums at bodies. Every fish is a target in chunks of points; the fish itself acts by direct sums,
 * and in large schools distant fish act by far points or by the tree. */
#include "flow/flow_at_bodies.h"

#include <math.h>
#include <string.h>

#include "base/mathematics.h"
#include "flow/flow.h"
#include "flow/flow_external.h"
#include "flow/others.h"

struct flow_at_body flow_at_body(const struct flow *flow, int f) {
    const int first = flow->points[f].first;
    struct flow_at_body at = {.u = flow->u + first, .v = flow->v + first};
    if (flow->kernel->has_legs) {
        at.div = flow->div + first;
        at.edge = flow->edge + first;
        at.edge_stride = flow->n_points;
    }

    flow_external_acceleration(flow->school, flow->t, at.acceleration);
    return at;
}

void flow_relative_velocity(const struct fish *fish, int edge, const double velocity[2], const double *u,
                            const double *v, double w[2]) {
    w[0] = velocity[0] - u[flow_midpoint(fish, edge)];
    w[1] = velocity[1] - v[flow_midpoint(fish, edge)];
}

void flow_slip(const struct flow *flow, int f, const double *y, double slip[2]) {
    const struct fish *fish = &flow->school->fish[f];
    const int tail = flow->points[f].first + flow_tail(fish);
    slip[0] = flow->u[tail] - y[fish->at.vx + fish->n_nodes - 1];
    slip[1] = flow->v[tail] - y[fish->at.vy + fish->n_nodes - 1];
}

// ---- other fish and images

static int *by_tree(const struct flow *flow, const struct flow_sum *sum, int targets, int sources) {
    const int n = flow->n_classes;
    const bool is_wake = sum->pair == WAKE_AT_BODY || sum->pair == WAKE_AT_WAKE;
    return &flow->by_tree[((2 * is_wake + sum->of_images) * n + targets) * n + sources];
}

bool flow_is_by_tree(const struct flow *flow, int f, int g, const struct flow_sum *sum) {
    return *by_tree(flow, sum, flow->class_of[f], flow->class_of[g]);
}

void flow_select_by_tree(struct flow *flow, bool at_wakes, const struct range *targets) {
    const struct school *const school = flow->school;
    for (int i = 0; i < 4; i++) {
        const struct flow_sum sum = {
            at_wakes ? (i < 2 ? BODY_AT_WAKE : WAKE_AT_WAKE) : (i < 2 ? BODY_AT_BODY : WAKE_AT_BODY), i % 2};
        for (int c = 0; c < flow->n_classes; c++) {
            for (int k = 0; k < flow->n_classes; k++) {
                // the tree includes a fish's own sources, which are then subtracted, except in wakes without legs
                const bool keeps_own = sum.of_images || (sum.pair == WAKE_AT_WAKE && !flow->kernel->has_legs);
                int n_targets = 0, n_sources = 0;
                double own = 0;
                for (int f = 0; f < school->n_fish; f++) {
                    const int n = targets[f].n, n_own = flow_sources(flow, f, &sum)->n;
                    n_targets += flow->class_of[f] == c ? n : 0;
                    n_sources += flow->class_of[f] == k ? n_own : 0;
                    if (flow->class_of[f] == c && c == k && !keeps_own) own += (double)n * n_own;
                }
                const bool is_by_others = !at_wakes && !sum.of_images && others_are_selected(flow);
                *by_tree(flow, &sum, c, k) =
                    !is_by_others && tree_is_faster(flow->kernel, n_sources, (double)n_targets * n_sources - 2 * own,
                                                    school->wake_tolerance);
            }
        }
    }
}

void flow_sum_by_tree(struct flow *flow, int c, int k, const struct flow_sum *sum, int threads,
                      const struct targets *at) {
    const struct school *const school = flow->school;
    int f = 0; /* the first fish of the targets; all have one length */
    while (flow->class_of[f] != c) f++;
    const struct fish *const fish = &school->fish[f];
    struct kernel_pair pair = {0};
    flow->many.n = 0;
    for (int g = 0; g < school->n_fish; g++) {
        if (flow->class_of[g] != k) continue;
        pair = flow_pair_of(flow, f, g, sum);
        const struct sources *const sources = flow_sources(flow, g, sum);
        flow_append_with_span(&flow->many, sources, (struct range){0, sources->n}, pair.span);
    }

    // half of wake.tolerance, in lengths per beat, is shared by the sums over bodies, wakes and images
    pair.span = 1;
    const int n_sums = school->walls.n > 0 ? 4 : 2;
    const double tolerance = school->wake_tolerance * fish->length * fish_rate(school, fish) / (2 * n_sums);
    tree_induce(flow->tree, &pair, &flow->many, fish->length, tolerance, threads, at);
}

void flow_induce_other(const struct flow *flow, int f, int g, const struct flow_sum *sum, bool is_excluded,
                       const struct targets *at) {
    if (is_excluded != flow_is_by_tree(flow, f, g, sum)) return;
    struct kernel_pair pair = flow_pair_of(flow, f, g, sum);
    if (is_excluded) pair.span = -pair.span;
    const struct sources *const sources = flow_sources(flow, g, sum);
    kernel_induce(&pair, sources, (struct range){0, sources->n}, at);
}

// ---- bodies

static struct targets flow_targets(const struct flow *flow, bool with_gradient) {
    struct targets all = {
        .n = flow->n_points, .x = flow->x, .y = flow->y, .u = flow->u, .v = flow->v, .div = flow->div};
    if (with_gradient) {
        all.u_x = flow->u_x;
        all.u_y = flow->u_y;
        all.v_x = flow->v_x;
        all.div_x = flow->div_x;
        all.div_y = flow->div_y;
    }
    return all;
}

// a range of the points of fish f
static struct targets points_of(const struct flow *flow, const struct targets *all, int f, struct range which) {
    struct targets at = kernel_targets_part(all, which);
    if (flow->kernel->has_legs) at.half = flow->school->fish[f].point_half + which.first - flow->points[f].first;
    return at;
}

static struct range range_overlap(struct range one, struct range other) {
    const int first = one.first > other.first ? one.first : other.first;
    const int end = one.first + one.n < other.first + other.n ? one.first + one.n : other.first + other.n;
    return (struct range){first, end > first ? end - first : 0};
}

// the velocity by its own body and its own wake
static void induce_own(const struct flow *flow, const struct chunk *chunk, const struct targets *all,
                       bool with_gradient) {
    const struct fish *const fish = &flow->school->fish[chunk->fish];
    const struct flow_fish *const of = &flow->fish[chunk->fish];
    const struct flow_class *const kind = &flow->classes[flow->class_of[chunk->fish]];
    const int first = flow->points[chunk->fish].first;
    const bool is_sheet = flow_has_free_sheets(flow);
    const struct range control = range_overlap(chunk->at, (struct range){first, fish->n_control});
    const struct range tail = range_overlap(chunk->at, (struct range){first + flow_tail(fish), 1});
    const double wake_square = flow_square(flow, WAKE_AT_BODY, kind, kind);
    const struct kernel_pair exact = flow->kernel->own(fish->strip_depth, 0);
    const struct kernel_pair smooth = flow->kernel->own(fish->strip_depth, wake_square);
    const struct sources *const seen = &of->wake.middles.sources;

    // control points feel all sources of this body and, if the wake is a sheet, the wake point by point, with legs
    struct targets at = points_of(flow, all, chunk->fish, control);
    if (fish->depth_varies && control.n > 0) {
        at.edge = flow->edge + control.first;
        at.edge_gradient = with_gradient ? flow->edge_gradient + control.first : NULL;
        at.edge_stride = flow->n_points;
    }
    const struct sources *const graded = &of->wake.graded.sources;
    kernel_induce(&exact, &of->own, (struct range){0, of->own.n}, &at);
    if (is_sheet) kernel_induce(&exact, graded, (struct range){0, graded->n}, &at);

    // The middles of a sheet act on the points behind the control points, and the queue acts on all points. Midpoints
    // of edges are left out if the fish does not feel its own wake.
    const int begin = is_sheet ? flow_midpoint(fish, 0) : 0, end = flow_midpoint(fish, 0), n = flow_n_points(fish);
    const bool is_felt = fish_feels_own_wake(fish);
    const struct range parts[2] = {{begin, (is_felt ? n : end) - begin}, {flow_tail(fish), is_felt ? 0 : 1}};
    for (int i = 0; i < 2; i++) {
        const struct range part = {first + parts[i].first, parts[i].n};
        at = points_of(flow, all, chunk->fish, range_overlap(chunk->at, part));
        kernel_induce(&smooth, seen, (struct range){0, seen->n}, &at);
    }
    if (is_sheet) return;

    // with point vortices, the slip at the tail includes the bound vortices
    at = points_of(flow, all, chunk->fish, tail);
    const struct kernel_pair bound = flow->kernel->own(fish->strip_depth, flow_square(flow, BODY_AT_WAKE, kind, kind));
    kernel_induce(&bound, &of->own, (struct range){0, fish->n_sheet}, &at);
}

// the near sources of other fish at points of fish f
static void induce_near(const struct flow *flow, int f, const struct targets *at) {
    int n_near;
    const struct near_sources *const near = others_near(flow, f, &n_near);
    for (int i = 0; i < n_near; i++) {
        const int g = near[i].fish;
        if (g == f) continue;
        const struct kernel_pair wake = flow_pair_of(flow, f, g, &(struct flow_sum){WAKE_AT_BODY, false});
        const struct sheet_points *const middles = &flow->fish[g].wake.middles;
        kernel_induce(&wake, &middles->sources, near[i].wake, at);
        if (!near[i].with_body) continue;
        const struct kernel_pair body = flow_pair_of(flow, f, g, &(struct flow_sum){BODY_AT_BODY, false});
        kernel_induce(&body, &flow->fish[g].body, (struct range){0, flow->fish[g].body.n}, at);
        kernel_induce(&wake, &middles->sources, (struct range){middles->n_released, 1}, at);
    }
}

static void evaluate_chunk(const struct flow *flow, const struct chunk *chunk, bool with_gradient) {
    if (with_gradient && flow->stop && *flow->stop) return;
    const struct school *school = flow->school;
    const struct targets all = flow_targets(flow, with_gradient);
    const struct targets at = points_of(flow, &all, chunk->fish, chunk->at);
    for (int p = 0; p < at.n; p++) {
        double u, v, gradient[3];
        flow_external(school, flow->t, at.x[p], at.y[p], &u, &v);
        at.u[p] += u;
        at.v[p] += v;
        if (!with_gradient) continue;
        flow_external_gradient(school, flow->t, at.x[p], at.y[p], gradient);
        at.u_x[p] += gradient[0];
        at.u_y[p] += gradient[1];
        at.v_x[p] += gradient[2];
    }

    induce_own(flow, chunk, &all, with_gradient);
    const int f = chunk->fish;
    const bool by_far_points = others_are_selected(flow);
    if (by_far_points) {
        others_add(flow, f, chunk->at, &at);
        induce_near(flow, f, &at);
    }
    // the pairs of kinds that remain: of bodies and wakes, then of their images
    const int first = by_far_points ? 2 : 0, end = school->walls.n > 0 ? 4 : 2;
    for (int g = 0; g < school->n_fish && first < end; g++) {
        for (int i = first; i < end; i++) {
            const struct flow_sum sum = {i % 2 == 0 ? BODY_AT_BODY : WAKE_AT_BODY, i >= 2};
            flow_induce_other(flow, f, g, &sum, g == f && !sum.of_images, &at);
        }
    }
}

static void flow_sum(struct flow *flow, const struct state *state, double t, const double *y, bool is_steady,
                     bool with_gradient) {
    flow->is_steady = is_steady;
    if (!flow->others) flow->others = others_create(flow->arena, flow);
    others_select(flow, state, t);
    flow_place(flow, state, t, y);
    double n_sources = 0;
    for (int f = 0; f < flow->school->n_fish; f++)
        n_sources += flow->fish[f].body.n + flow->fish[f].wake.middles.sources.n;
    const double work = flow->kernel->cost * (1.0 + flow->n_images) * flow->n_points * n_sources;
    const int threads = parallel_threads(flow->school->threads, flow->n_chunks, work, PARALLEL_INTERACTIONS);
    others_place(flow, state, y, threads);

    // sum bodies and wakes by the tree, then by far points, then one by one
    const size_t size = (size_t)flow->n_points * sizeof(double);
    double *const sums[KERNEL_SUMS] = {flow->u,   flow->v,   flow->div,   flow->u_x,
                                       flow->u_y, flow->v_x, flow->div_x, flow->div_y};
    const int n_sums = with_gradient ? KERNEL_SUMS : KERNEL_SUMS_WITHOUT_GRADIENT;
    for (int i = 0; i < n_sums; i++) memset(sums[i], 0, size);
    memset(flow->edge, 0, 2 * size);
    if (with_gradient) memset(flow->edge_gradient, 0, 4 * size);
    flow_select_by_tree(flow, false, flow->points);
    const struct targets all = flow_targets(flow, with_gradient);
    for (int c = 0; c < flow->n_classes; c++) {
        struct targets at = kernel_targets_part(&all, flow->classes[c].points);
        struct sources *const places = &flow->places;
        places->n = 0;
        sources_append(places, at.n);
        for (int f = 0; f < flow->school->n_fish && flow->kernel->has_legs; f++) {
            if (flow->class_of[f] != c) continue;
            memcpy(places->half + flow->points[f].first - flow->classes[c].points.first,
                   flow->school->fish[f].point_half, (size_t)flow->points[f].n * sizeof(double));
        }
        at.half = places->half;

        for (int k = 0; k < flow->n_classes; k++) {
            for (int i = 0; i < 4; i++) {
                const struct flow_sum sum = {i < 2 ? BODY_AT_BODY : WAKE_AT_BODY, i % 2};
                if (*by_tree(flow, &sum, c, k)) flow_sum_by_tree(flow, c, k, &sum, threads, &at);
            }
        }
    }
    if (others_are_selected(flow)) others_sum(flow, state, threads);

    if (threads == 1) {
        for (int c = 0; c < flow->n_chunks; c++) evaluate_chunk(flow, &flow->chunk[c], with_gradient);
    } else {
#pragma omp parallel for num_threads(threads) schedule(dynamic)
        for (int c = 0; c < flow->n_chunks; c++) evaluate_chunk(flow, &flow->chunk[c], with_gradient);
    }
}

void flow_velocity(struct flow *flow, const struct state *state, double t, const double *y, bool is_steady) {
    flow_sum(flow, state, t, y, is_steady, false);
}

void flow_gradient(struct flow *flow, const struct state *state, double t, const double *y, bool is_steady) {
    flow_sum(flow, state, t, y, is_steady, true);
}

// ---- images alone, and the velocity at any points

void flow_images(struct flow *flow, const struct state *state) {
    const int n_fish = flow->school->n_fish;
    const size_t size = (size_t)flow->n_points * sizeof(double);
    const struct targets all = {.n = flow->n_points,
                                .x = flow->x,
                                .y = flow->y,
                                .u = flow->image_u,
                                .v = flow->image_v,
                                .div = flow->image_div};
    flow_place(flow, state, state->t, state->y);
    memset(flow->image_u, 0, size);
    memset(flow->image_v, 0, size);
    memset(flow->image_div, 0, size);

    for (int f = 0; f < n_fish; f++) {
        const struct targets at = points_of(flow, &all, f, flow->points[f]);
        for (int i = 0; i < 2 * n_fish; i++) {
            const struct flow_sum sum = {i % 2 == 0 ? BODY_AT_BODY : WAKE_AT_BODY, true};
            const struct kernel_pair pair = flow_pair_of(flow, f, i / 2, &sum);
            const struct sources *const sources = flow_sources(flow, i / 2, &sum);
            kernel_induce(&pair, sources, (struct range){0, sources->n}, &at);
        }
    }
}

void flow_field(struct flow *flow, const struct state *state, const struct targets *all, bool is_steady) {
    const struct school *const school = flow->school;
    const int n_chunks = parallel_n_chunks(all->n);
    flow->is_steady = is_steady;
    flow_place(flow, state, state->t, state->y);
#pragma omp parallel for num_threads(school->threads) schedule(static)
    for (int chunk = 0; chunk < n_chunks; chunk++) {
        const struct targets at = kernel_targets_part(all, parallel_chunk(chunk, all->n));
        for (int i = 0; i < at.n; i++) {
            double gradient[3];
            flow_external(school, flow->t, at.x[i], at.y[i], &at.u[i], &at.v[i]);
            flow_external_gradient(school, flow->t, at.x[i], at.y[i], gradient);
            at.u_x[i] = gradient[0];
            at.u_y[i] = gradient[1];
            at.v_x[i] = gradient[2];
        }

        for (int g = 0; g < school->n_fish; g++) {
            for (int i = 0; i < (school->walls.n > 0 ? 4 : 2); i++) {
                const struct flow_sum sum = {i % 2 == 0 ? BODY_AT_BODY : WAKE_AT_BODY, i >= 2};
                const struct kernel_pair pair = flow_pair_of(flow, g, g, &sum);
                const struct sources *const sources = flow_sources(flow, g, &sum);
                kernel_induce(&pair, sources, (struct range){0, sources->n}, &at);
            }
        }

        double *const values[] = {at.u, at.v, at.u_x, at.u_y, at.v_x};
        for (int i = 0; i < at.n; i++) {
            if (fish_walls_distance(&school->walls, at.y[i]) >= 0) continue;
            for (size_t k = 0; k < sizeof values / sizeof *values; k++) values[k][i] = NAN;
        }
    }
}

// ---- what decay has taken from the wakes of others

// how many vortices or markers of a wake, the oldest ones, have lost some strength
static int count_decaying(const struct wake *wake, const struct school *school, double t) {
    int n = 0;
    while (n < wake->n_vortex && wake_strength(school, wake_age(wake, n, t)) < 1) n++;
    return n;
}

// whether one of n places is near one of the points
static bool is_near_any(const struct targets *points, int n, const double *x, const double *y, double distance) {
    const struct box around = box_widen(box_around(points->n, points->x, points->y), distance);
    for (int i = 0; i < n; i++) {
        if (x[i] < around.low[0] || x[i] > around.high[0] || y[i] < around.low[1] || y[i] > around.high[1]) continue;
        for (int p = 0; p < points->n; p++) {
            const double r[2] = {points->x[p] - x[i], points->y[p] - y[i]};
            if (r[0] * r[0] + r[1] * r[1] < distance * distance) return true;
        }
    }
    return false;
}

// make the sources of a wake (its middles) the difference between what they would be without decay and what they are
static void place_decayed(struct sheet *sheet, const struct flow *flow, const struct state *state, int g) {
    struct school whole = *flow->school;
    whole.lifetime = INFINITY;
    const struct fish *const fish = &flow->school->fish[g];
    const struct wake *const wake = &state->wake[g];
    double tail[2];
    fish_tail(fish, state->y, tail);
    sheet_build(sheet, fish, &whole, wake, state->t);
    sheet_place(sheet, fish, &whole, wake, state->t, 0);
    sheet_place_nascent(&sheet->middles, &whole, wake, state->t, 0, tail, NULL, state->y[fish->at.circulation]);

    const struct sources *const now = &flow->fish[g].wake.middles.sources, *const lost = &sheet->middles.sources;
    for (int i = 0; i < lost->n; i++) {
        lost->q[i] -= now->q[i];
        lost->dx[i] -= now->dx[i];
        lost->dy[i] -= now->dy[i];
    }
}

void flow_find_decayed(struct flow *flow, const struct state *state, double *part) {
    ARENA(arena, flow->arena, "lost velocities");
    const double near = 0.25, far = 1;  // in lengths; alternating vortices farther away hardly act
    const struct school *const school = flow->school;
    struct sheet sheet = {.arena = NULL};
    struct targets *at;
    double *values[4]; /* the velocity that is left, and the one that is lost */
    int *n_decaying, n_near = 0;
    NEW(arena, at, school->n_fish);
    NEW(arena, n_decaying, school->n_fish);
    for (int i = 0; i < 4; i++) NEW(arena, values[i], flow->n_points);
    memset(part, 0, (size_t)school->n_fish * sizeof *part);
    int n_all = 0;
    for (int g = 0; g < school->n_fish; g++) {
        n_decaying[g] = count_decaying(&state->wake[g], school, state->t);
        n_all += n_decaying[g];
    }
    if (school->n_fish == 1 || n_all == 0) return;

    // find the bodies in the decaying part of the wake of another fish
    flow_place(flow, state, state->t, state->y);
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *const fish = &school->fish[f];
        const int first = flow->points[f].first;
        struct targets points = {.n = fish->n_control, .x = flow->x + first, .y = flow->y + first};
        points.half = flow->kernel->has_legs ? fish->point_half : NULL;
        for (int g = 0; g < school->n_fish && at[f].n == 0; g++) {
            const struct wake *const wake = &state->wake[g];
            if (g == f || !is_near_any(&points, n_decaying[g], wake->x, wake->y, near * fish->length)) continue;
            at[f] = points;
            n_near++;
        }
    }

    // sum, wake after wake, its velocity at these bodies
    for (int g = 0; g < school->n_fish && n_near > 0; g++) {
        const struct wake *const wake = &state->wake[g];
        const struct box around = box_around(wake->n_vortex, wake->x, wake->y);
        if (n_decaying[g] > 0) {
            sheet_reserve(arena, &sheet, wake->n_vortex);
            place_decayed(&sheet, flow, state, g);
        }
        for (int f = 0; f < school->n_fish; f++) {
            struct targets points = at[f];
            const struct box body = box_around(points.n, points.x, points.y);
            if (f == g || points.n == 0 || box_gap(&body, &around) > far * school->fish[f].length) continue;
            const struct kernel_pair pair = flow_pair_of(flow, f, g, &(struct flow_sum){WAKE_AT_BODY, false});
            const struct sources *const of[] = {&flow->fish[g].wake.middles.sources, &sheet.middles.sources};
            for (int i = 0; i < (n_decaying[g] > 0 ? 2 : 1); i++) {
                points.u = values[2 * i] + flow->points[f].first;
                points.v = values[2 * i + 1] + flow->points[f].first;
                kernel_induce(&pair, of[i], (struct range){0, of[i]->n}, &points);
            }
        }
    }

    for (int f = 0; f < school->n_fish; f++) {
        double lost = 0, whole = 0;
        for (int i = flow->points[f].first; i < flow->points[f].first + at[f].n; i++) {
            const double u = values[0][i] + values[2][i], v = values[1][i] + values[3][i];
            lost += values[2][i] * values[2][i] + values[3][i] * values[3][i];
            whole += u * u + v * v;
        }
        part[f] = whole > 0 ? sqrt(lost / whole) : 0;
    }
}
