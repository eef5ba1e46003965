/* flow_at_bodies.c: velocity of all sources at all points, in chunks of points. */
#include "flow/flow_at_bodies.h"

#include <math.h>
#include <stddef.h>

#include "flow/flow.h"
#include "flow/flow_rings.h"
#include "vortex/kernel.h"

struct flow_at_body flow_at_body(const struct flow *flow, int f) {
    const int first = flow->points[f].first;
    struct flow_at_body at = {.u = flow->u + first, .v = flow->v + first};
    if (flow->rings) {
        at.div = flow->rings->div + first;
        at.edge = flow->rings->edge + first;
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

void flow_sum_exactly(struct flow *flow) {
    flow->is_interpolated = 0;
}

// all points of all fish as targets
static struct induced flow_targets(const struct flow *flow, int with_gradient) {
    struct induced all = {.n = flow->n_points, .x = flow->x, .y = flow->y, .u = flow->u, .v = flow->v};
    if (with_gradient) {
        all.u_x = flow->u_x;
        all.u_y = flow->u_y;
        all.v_x = flow->v_x;
    }

    return all;
}

// plan the tree sum of the bound vortices at the points until the next event; the single plan requires a single class
static enum status flow_plan_sheets(struct flow *flow) {
    const struct induced at = flow_targets(flow, 0);
    const double tolerance = flow->school->wake_tolerance;
    if (flow->n_classes > 1 || !velocity_sum_by_tree(&flow->sheet, at.n, tolerance)) return STATUS_OK;
    return velocity_sum_plan(flow->velocity_sum, &flow->class[0].sheet, tolerance, flow->school->threads, &at);
}

enum status flow_interpolate(struct flow *flow, const struct state *state) {
    if (!flow->interpolation) return STATUS_OK;
    TRY(flow_place(flow, state, state->t, state->y));
    flow_sum_exactly(flow);

    const int threads = fish_threads(flow->school);
#pragma omp parallel for num_threads(threads) schedule(static)
    for (int f = 0; f < flow->school->n_fish; f++) {
        const struct fish *const fish = &flow->school->fish[f];

        // with momenta as unknowns, the acceleration is the rate of the velocity
        const double *const acceleration = fish_has_momentum(fish) ? state->yp + fish->at.vx : state->y + fish->at.ax;
        for (int i = 0; i < 2; i++) {
            flow_from_nodes(flow, f, state->y + fish->at.vx + i * fish->n_nodes, flow->motion[i]);
            flow_from_nodes(flow, f, acceleration + i * fish->n_nodes, flow->motion[2 + i]);
        }
    }

    const struct wake_interpolation_points points = {flow->x,         flow->y,         flow->motion[0],
                                                     flow->motion[1], flow->motion[2], flow->motion[3]};
    TRY(wake_interpolation_build(flow->interpolation, flow_seen_wakes(flow, state), state->t, &points));
    wake_interpolation_update(flow->interpolation, flow->t);
    TRY(flow_plan_sheets(flow));

    flow->is_interpolated = 1;
    flow->interpolated_version = flow->version;
    return STATUS_OK;
}

// overlap of a chunk and a range of points
static struct range overlap(const struct chunk *chunk, struct range range) {
    const int first = chunk->at.first > range.first ? chunk->at.first : range.first;
    const int end = chunk->at.first + chunk->at.n, range_end = range.first + range.n;
    return (struct range){first, (end < range_end ? end : range_end) - first};
}

// add the velocity of the own bound sheet, with one smoothing and the given circulations, at a range of points of the
// fish
static void bodies_induce_own(const struct flow *flow, const struct chunk *chunk, struct range points, double smoothing,
                              double *circulation, const struct induced *all) {
    const struct range which = overlap(chunk, points);
    if (which.n <= 0) return;
    const struct vortices sheet = {.n = flow->sheet.n,
                                   .x = flow->sheet.x,
                                   .y = flow->sheet.y,
                                   .circulation = circulation,
                                   .n_groups = 1,
                                   .group = &(struct vortex_group){{0, flow->sheet.n}, smoothing}};

    const struct induced at = vortices_targets(all, which);
    vortices_induce(&sheet, flow->sheet_range[chunk->fish], &at);
}

// bound sheets at a chunk: the sheets of other fish, and the own sheet at control points without smoothing, at the tail
// with smoothing, not at the midpoints
static void induce_sheets(const struct flow *flow, const struct chunk *chunk, const struct induced *all) {
    const struct fish *fish = &flow->school->fish[chunk->fish];
    const struct flow_class *const class = &flow->class[flow->class_of[chunk->fish]];
    const struct range own = flow->sheet_range[chunk->fish], points = flow->points[chunk->fish];
    const struct range control = {points.first, fish->n_control}, tail = {points.first + flow_tail(fish), 1};

    bodies_induce_own(flow, chunk, control, 0, flow->sheet.circulation, all);
    if (class->sheet_by_tree) {
        // the tree has summed all sheets at all points: subtract the own sheet
        const struct range but_tail = {points.first, points.n - 1};
        bodies_induce_own(flow, chunk, but_tail, fish->sheet_smoothing, flow->opposite, all);
        return;
    }

    const struct induced at = vortices_targets(all, chunk->at);
    const int behind = own.first + own.n;
    vortices_induce(&class->sheet, (struct range){0, own.first}, &at);
    vortices_induce(&class->sheet, (struct range){behind, flow->sheet.n - behind}, &at);
    bodies_induce_own(flow, chunk, tail, fish->sheet_smoothing, flow->sheet.circulation, all);
}

// correction of the own free sheet at the control points of a fish
static void induce_free_sheet(const struct flow *flow, const struct chunk *chunk, const struct induced *all) {
    const struct free_sheet *const sheet = &flow->free_sheet[chunk->fish];
    const struct range control = {flow->points[chunk->fish].first, flow->school->fish[chunk->fish].n_control};
    const struct range which = overlap(chunk, control);

    if (which.n <= 0) return;
    const struct induced at = vortices_targets(all, which);
    const double smoothing = flow->school->fish[chunk->fish].smoothing;
    const struct kernel_changes tapered = {sheet->n_tapered,      sheet->x,     sheet->y, sheet->circulation,
                                           smoothing * smoothing, sheet->square};
    const int first = sheet->n_tapered, n = sheet->n - first;
    const double *const x = sheet->x + first, *const y = sheet->y + first,
                        *const circulation = sheet->circulation + first, *const square = sheet->square + first;
    if (at.u_x) {
        kernel_add_gradient_change(at.n, at.x, at.y, &tapered, at.u, at.v, at.u_x, at.u_y, at.v_x);
        kernel_add_gradient_each(at.n, at.x, at.y, n, x, y, circulation, square, at.u, at.v, at.u_x, at.u_y, at.v_x);
    } else {
        kernel_add_velocity_change(at.n, at.x, at.y, &tapered, at.u, at.v);
        kernel_add_velocity_each(at.n, at.x, at.y, n, x, y, circulation, square, at.u, at.v);
    }
}

// wakes at a chunk; the own wake is omitted at the points of without_own
static void induce_wakes(const struct flow *flow, const struct chunk *chunk, const struct induced *at) {
    const struct range unfelt = {flow->without_own[chunk->fish].first - chunk->at.first,
                                 flow->without_own[chunk->fish].n};
    if (flow->by_interpolation[chunk->fish]) {
        wake_interpolation_induce(flow->interpolation, chunk->fish, chunk->at.first, at);
    } else {
        vortices_induce_without(&flow->released, flow->released_range[chunk->fish], unfelt, at);
    }

    vortices_induce_without(&flow->nascent, (struct range){chunk->fish, 1}, unfelt, at);
}

// images of all fish, with the smoothing of the class
static void induce_images(const struct flow *flow, const struct chunk *chunk, const struct induced *at) {
    const struct walls *const walls = &flow->school->walls;
    const struct flow_class *const class = &flow->class[flow->class_of[chunk->fish]];
    if (!flow->by_interpolation[chunk->fish]) {
        images_induce(walls, &flow->released, (struct range){0, flow->released.n}, at);
    }

    images_induce(walls, &flow->nascent, (struct range){0, flow->nascent.n}, at);
    if (!class->images_by_many) images_induce(walls, &class->sheet, (struct range){0, class->sheet.n}, at);
}

static void flow_evaluate_chunk(const struct flow *flow, const struct chunk *chunk, const struct induced *all) {
    const struct school *school = flow->school;
    const struct induced at = vortices_targets(all, chunk->at);

    // external flow
    for (int p = 0; p < at.n; p++) {
        double u, v;
        flow_external(school, flow->t, at.x[p], at.y[p], &u, &v);
        at.u[p] += u;
        at.v[p] += v;
    }

    for (int p = 0; at.u_x && p < at.n; p++) {
        double gradient[3];
        flow_external_gradient(school, flow->t, at.x[p], at.y[p], gradient);
        at.u_x[p] += gradient[0];
        at.u_y[p] += gradient[1];
        at.v_x[p] += gradient[2];
    }

    if (flow->rings) {
        flow_rings_at_chunk(flow, chunk, at.u_x != NULL);
        return;
    }

    induce_wakes(flow, chunk, &at);
    induce_sheets(flow, chunk, all);
    if (flow_has_free_sheets(flow)) induce_free_sheet(flow, chunk, all);
    if (school->walls.n > 0) induce_images(flow, chunk, &at);
}

// all bound sheets at all points of a class by the tree, and the images of the sheets by tree or cells
static enum status flow_sum_sheets(struct flow *flow, const struct flow_class *class, int threads,
                                   const struct induced *all) {
    const double tolerance = flow->school->wake_tolerance;
    const struct induced at = vortices_targets(all, class->points);
    if (class->sheet_by_tree) {
        const int is_planned = flow->is_interpolated && flow->n_classes == 1 && !at.u_x;
        TRY((is_planned ? velocity_sum_by_plan : velocity_sum_induce)(flow->velocity_sum, &class->sheet, tolerance,
                                                                      threads, &at));
    }

    if (!class->images_by_many) return STATUS_OK;
    return images_induce_many(&flow->school->walls, flow->velocity_sum, &class->sheet, tolerance, threads, &at);
}

// select the sums over all points of a class, and evaluate these sums
static enum status flow_sum_many(struct flow *flow, int threads, const struct induced *all) {
    const double tolerance = flow->school->wake_tolerance;
    for (int c = 0; c < flow->n_classes; c++) {
        struct flow_class *const class = &flow->class[c];
        const struct induced at = vortices_targets(all, class->points);
        const int by_cells = images_by_cells(&flow->school->walls, &class->sheet, tolerance, &at);

        class->sheet_by_tree = velocity_sum_by_tree(&class->sheet, at.n, tolerance);
        class->images_by_many = class->sheet_by_tree || by_cells;
        TRY(flow_sum_sheets(flow, class, threads, all));
    }

    return STATUS_OK;
}

// number of interactions of an evaluation that depend on the unknowns
static double flow_work(const struct flow *flow) {
    if (flow->rings) return flow_rings_work(flow);
    const int n_sources = flow->sheet.n + flow->nascent.n + (flow->has_released ? flow->released.n : 0);
    double work = (double)flow->n_points * n_sources;
    for (int f = 0; flow_has_free_sheets(flow) && f < flow->school->n_fish; f++) {
        // an interaction with individual smoothing costs about two
        work += 2.0 * flow->school->fish[f].n_control * flow->free_sheet[f].n;
    }

    return work;
}

static void flow_evaluate(struct flow *flow, int with_gradient) {
    const struct induced all = flow_targets(flow, with_gradient);
    const int threads = parallel_threads(flow->school->threads, flow->n_chunks, flow_work(flow), PARALLEL_INTERACTIONS);

    vortices_zero(&all);
    if (flow->rings) flow_rings_zero(flow, with_gradient);
    if (flow->rings && flow_rings_many(flow, threads, with_gradient) != STATUS_OK) {
        flow_rings_direct(flow);
        vortices_zero(&all);
        flow_rings_zero(flow, with_gradient);
    }
    if (flow->rings && !with_gradient) flow_rings_far(flow);
    if (!flow->rings && flow_sum_many(flow, threads, &all) != STATUS_OK) {
        // out of memory for a tree: use the direct sum
        for (int c = 0; c < flow->n_classes; c++) flow->class[c].sheet_by_tree = flow->class[c].images_by_many = 0;
        vortices_zero(&all);
    }

#pragma omp parallel for num_threads(threads) schedule(dynamic)
    for (int c = 0; c < flow->n_chunks; c++) flow_evaluate_chunk(flow, &flow->chunk[c], &all);
}

static enum status flow_sum(struct flow *flow, const struct state *state, double t, const double *y,
                            int with_gradient) {
    TRY(flow_place(flow, state, t, y));
    if (!flow->all_interpolated && !flow->rings) TRY(flow_place_released(flow, state));
    flow_evaluate(flow, with_gradient);
    return STATUS_OK;
}

enum status flow_velocity(struct flow *flow, const struct state *state, double t, const double *y) {
    return flow_sum(flow, state, t, y, 0);
}

enum status flow_gradient(struct flow *flow, const struct state *state, double t, const double *y) {
    return flow_sum(flow, state, t, y, 1);
}

enum status flow_images(struct flow *flow, const struct state *state) {
    const struct school *const school = flow->school;
    const struct induced all = {
        .n = flow->n_points, .x = flow->x, .y = flow->y, .u = flow->image_u, .v = flow->image_v};

    TRY(flow_place(flow, state, state->t, state->y));
    if (flow->rings) {
        flow_rings_images(flow);
        return STATUS_OK;
    }

    TRY(flow_place_released(flow, state));
    vortices_zero(&all);
    for (int c = 0; c < flow->n_classes; c++) {
        const struct induced at = vortices_targets(&all, flow->class[c].points);
        const struct vortices *const sources[] = {&flow->released, &flow->nascent, &flow->class[c].sheet};
        for (int i = 0; i < 3; i++) {
            TRY(images_induce_many(&school->walls, flow->velocity_sum, sources[i], school->wake_tolerance,
                                   school->threads, &at));
        }
    }

    return STATUS_OK;
}

// ---- velocity of all sources at any points, for pictures and evaluation of results

// set velocity and gradient to the external flow
static void field_external(const struct flow *flow, const struct induced *at) {
    for (int i = 0; i < at->n; i++) {
        double gradient[3];
        flow_external(flow->school, flow->t, at->x[i], at->y[i], &at->u[i], &at->v[i]);
        flow_external_gradient(flow->school, flow->t, at->x[i], at->y[i], gradient);
        at->u_x[i] = gradient[0];
        at->u_y[i] = gradient[1];
        at->v_x[i] = gradient[2];
    }
}

// external flow, nascent vortices, and sources that are not summed by the tree, at any points
static void field_induce(const struct flow *flow, const int *by_tree, const struct induced *at) {
    field_external(flow, at);
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
            field_external(flow, &at);
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
