/* flow.c: all sources onto all points. */
#include "model/flow.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "model/sheets_at_wake.h"
#include "vortex/kernel.h"
#include "vortex/pairwise.h"

int flow_midpoint(const struct fish *fish, int edge) {
    return fish->n_control + edge;
}

int flow_tail(const struct fish *fish) {
    return fish->n_control + fish->n_edges;
}

int flow_n_points(const struct fish *fish) {
    return flow_tail(fish) + 1;
}

int flow_column(const struct fish *other, int c) {
    const int n_places = 2 * other->n_nodes;
    return c < n_places ? other->at.x + c : other->at.gamma + (c - n_places);
}

int flow_n_rows(const struct fish *fish) {
    return fish->at.phi0 - fish->at.ax;
}

int flow_n_columns(const struct fish *other) {
    return 2 * other->n_nodes + other->n_sheet + 1;
}

static enum status doubles(double **values, int n) {
    *values = calloc((size_t)n, sizeof **values);
    return *values ? STATUS_OK : status_fail(STATUS_MEMORY, "out of memory: %d points of the flow", n);
}

static enum status make_chunks(struct flow *flow) {
    int n = 0;
    for (int f = 0; f < flow->school->n_fish; f++) n += parallel_n_chunks(flow->points[f].n);
    flow->chunk = calloc((size_t)n, sizeof *flow->chunk);
    if (!flow->chunk) return status_fail(STATUS_MEMORY, "out of memory: %d pieces of the flow", n);
    for (int f = 0; f < flow->school->n_fish; f++) {
        const struct range points = flow->points[f];
        for (int i = 0; i < parallel_n_chunks(points.n); i++) {
            const struct range part = parallel_chunk(i, points.n);
            flow->chunk[flow->n_chunks++] = (struct chunk){f, {points.first + part.first, part.n}};
        }
    }
    return STATUS_OK;
}

static enum status flow_fill(struct flow *flow) {
    const struct school *school = flow->school;
    const size_t n_fish = (size_t)school->n_fish;
    flow->points = calloc(n_fish, sizeof *flow->points);
    flow->released_range = calloc(n_fish, sizeof *flow->released_range);
    flow->sheet_range = calloc(n_fish, sizeof *flow->sheet_range);
    flow->by_interpolation = calloc(n_fish, sizeof *flow->by_interpolation);
    flow->wake_range = calloc(n_fish, sizeof *flow->wake_range);
    flow->middles = calloc(n_fish, sizeof *flow->middles);
    flow->free_sheet = calloc(n_fish, sizeof *flow->free_sheet);
    if (!flow->points || !flow->released_range || !flow->sheet_range || !flow->by_interpolation || !flow->wake_range ||
        !flow->middles || !flow->free_sheet) {
        return status_fail(STATUS_MEMORY, "out of memory: the flow around %d fish", school->n_fish);
    }
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *fish = &school->fish[f];
        flow->points[f] = (struct range){flow->n_points, flow_n_points(fish)};
        flow->n_points += flow->points[f].n;
        flow->sheet_range[f] = (struct range){flow->sheet.n, fish->n_sheet};
        TRY(vortices_append(&flow->sheet, fish->n_sheet, fish->sheet_smoothing));
        TRY(vortices_append(&flow->nascent, 1, fish->smoothing));
    }
    double **const at_points[] = {&flow->x,         &flow->y,         &flow->u,        &flow->v,
                                  &flow->u_x,       &flow->u_y,       &flow->v_x,      &flow->motion[0],
                                  &flow->motion[1], &flow->motion[2], &flow->motion[3]};
    for (size_t i = 0; i < sizeof at_points / sizeof *at_points; i++) TRY(doubles(at_points[i], flow->n_points));
    TRY(make_chunks(flow));
    TRY(doubles(&flow->opposite, flow->sheet.n));
    TRY(doubles(&flow->sheet_square, flow->sheet.n));
    for (int f = 0; f < school->n_fish; f++) {
        for (int j = 0; j < flow->sheet_range[f].n; j++) {
            const double smoothing = free_sheet_bound_smoothing(&school->fish[f], j);
            flow->sheet_square[flow->sheet_range[f].first + j] = smoothing * smoothing;
        }
    }
    TRY(velocity_sum_create(&flow->velocity_sum));
    if (school->wake_tolerance <= 0) return STATUS_OK;
    return wake_interpolation_create(&flow->interpolation, school, flow->points);
}

enum status flow_create(struct flow **flow, const struct school *school) {
    *flow = NULL;
    struct flow *const new = calloc(1, sizeof *new);
    if (!new) return status_fail(STATUS_MEMORY, "out of memory: a flow");
    new->school = school;
    const enum status status = flow_fill(new);
    if (status != STATUS_OK) {
        flow_free(new);
        return status;
    }
    *flow = new;
    return STATUS_OK;
}

void flow_free(struct flow *flow) {
    if (!flow) return;
    wake_interpolation_free(flow->interpolation);
    velocity_sum_free(flow->velocity_sum);
    for (int f = 0; f < flow->school->n_fish; f++) {
        if (flow->middles) wake_free(&flow->middles[f]);
        if (flow->free_sheet) free_sheet_free(&flow->free_sheet[f]);
    }
    void *const owned[] = {flow->points,
                           flow->chunk,
                           flow->x,
                           flow->y,
                           flow->u,
                           flow->v,
                           flow->u_x,
                           flow->u_y,
                           flow->v_x,
                           flow->motion[0],
                           flow->motion[1],
                           flow->motion[2],
                           flow->motion[3],
                           flow->middles,
                           flow->free_sheet,
                           flow->released_range,
                           flow->wake_range,
                           flow->sheet_range,
                           flow->by_interpolation,
                           flow->opposite,
                           flow->sheet_square,
                           flow->wake_u,
                           flow->wake_v};
    for (size_t i = 0; i < sizeof owned / sizeof *owned; i++) free(owned[i]);
    vortices_free(&flow->released);
    vortices_free(&flow->markers);
    vortices_free(&flow->nascent);
    vortices_free(&flow->sheet);
    free(flow);
}

void flow_external(const struct school *school, double t, double y, double *u, double *v) {
    const double gust = sin(school->gust_omega * t);
    *u = school->velocity[0] + school->shear * y + gust * school->gust[0];
    *v = school->velocity[1] + gust * school->gust[1];
}

void flow_external_acceleration(const struct school *school, double t, double acceleration[2]) {
    const double angle = school->gust_omega * t, rate = school->gust_omega * cos(angle);
    acceleration[0] = school->shear * (school->velocity[1] + sin(angle) * school->gust[1]) + rate * school->gust[0];
    acceleration[1] = rate * school->gust[1];
}

struct flow_at_body flow_at_body(const struct flow *flow, int f) {
    const int first = flow->points[f].first;
    struct flow_at_body at = {.u = flow->u + first, .v = flow->v + first};
    flow_external_acceleration(flow->school, flow->t, at.acceleration);
    return at;
}

void flow_relative_velocity(const struct fish *fish, int edge, const double velocity[2], const double *u,
                            const double *v, double w[2]) {
    w[0] = velocity[0] - u[flow_midpoint(fish, edge)];
    w[1] = velocity[1] - v[flow_midpoint(fish, edge)];
}

// what the points of a fish have of a quantity that its nodes have
static void at_points(const struct flow *flow, int f, const double *of_nodes, double *of_points) {
    const struct fish *fish = &flow->school->fish[f];
    double *const to = of_points + flow->points[f].first;
    for (int c = 0; c < fish->n_control; c++) to[c] = fish_mean(&fish->control_point[c], of_nodes);
    for (int k = 0; k < fish->n_edges; k++) to[flow_midpoint(fish, k)] = (of_nodes[k] + of_nodes[k + 1]) / 2;
    to[flow_tail(fish)] = of_nodes[fish->n_nodes - 1];
}

static void place_sheet(struct flow *flow, int f, const double *y) {
    const struct fish *fish = &flow->school->fish[f];
    const int first = flow->sheet_range[f].first;
    for (int j = 0; j < fish->n_sheet; j++) {
        flow->sheet.x[first + j] = fish_mean(&fish->sheet_point[j], y + fish->at.x);
        flow->sheet.y[first + j] = fish_mean(&fish->sheet_point[j], y + fish->at.y);
        flow->sheet.circulation[first + j] = fish->sheet_weight[j] * y[fish->at.gamma + j];
        flow->opposite[first + j] = -flow->sheet.circulation[first + j];
    }
}

static int has_free_sheets(const struct flow *flow) {
    return flow->school->shedding == SHEDDING_SHEET;
}

// the wakes as vortices that everybody sees: those in the queues, or the middles of the stretches between markers
static const struct wake *seen_wakes(const struct flow *flow, const struct state *state) {
    return has_free_sheets(flow) ? flow->middles : state->wake;
}

static void place_nascent(struct flow *flow, const struct state *state, int f, const double *y) {
    const struct fish *fish = &flow->school->fish[f];
    const struct wake *const wake = &state->wake[f];
    const double tail[2] = {y[fish->at.x + fish->n_nodes - 1], y[fish->at.y + fish->n_nodes - 1]};
    const double circulation = y[fish->at.circulation] - wake->shed_before, tau = flow->t - state->t;
    double position[2];
    if (has_free_sheets(flow)) {
        free_sheet_nascent_point(wake, flow->school->interval, tau, tail, 0.5, position);
        free_sheet_place_nascent(&flow->free_sheet[f], fish, wake, flow->school->interval, tau, tail, circulation);
    } else {
        wake_nascent(wake, tau, tail, position);
    }
    flow->nascent.x[f] = position[0];
    flow->nascent.y[f] = position[1];
    flow->nascent.circulation[f] = circulation;
}

// the released vortices where they are at the flow's time
static enum status place_released(struct flow *flow, const struct state *state) {
    if (flow->has_released) return STATUS_OK;
    TRY(wake_interpolation_released(flow->school, seen_wakes(flow, state), state->t, flow->t - state->t,
                                    &flow->released, flow->released_range));
    flow->has_released = 1;
    return STATUS_OK;
}

// the free sheets at the flow's time, made again where the wakes have changed
static enum status place_free_sheets(struct flow *flow, const struct state *state, int is_new) {
    const struct school *const school = flow->school;
    int n_placed = 0, n_failed = 0;
    // a stretch is made from its ends, both at the beginning and at the end of the interval
    for (int f = 0; f < school->n_fish; f++) n_placed += is_new ? 4 * state->wake[f].n_vortex : flow->free_sheet[f].n;
    const int threads = parallel_threads(school->threads, school->n_fish, n_placed, PARALLEL_VORTICES);
#pragma omp parallel for num_threads(threads) schedule(dynamic)
    for (int f = 0; f < school->n_fish; f++) {
        enum status status = STATUS_OK;
        if (is_new) status = free_sheet_middles(&state->wake[f], &flow->middles[f]);
        if (is_new && status == STATUS_OK) {
            status = free_sheet_build(&flow->free_sheet[f], &school->fish[f], school, &state->wake[f]);
        }
        if (status == STATUS_OK) {
            free_sheet_place(&flow->free_sheet[f], school, &state->wake[f], &flow->middles[f], state->t,
                             flow->t - state->t);
        } else {
#pragma omp atomic
            n_failed++;
        }
    }
    // a message stays with the thread that wrote it
    return n_failed == 0 ? STATUS_OK
                         : status_fail(STATUS_MEMORY, "out of memory: the free sheets of %d fish", n_failed);
}

// drop what was made for other wakes or another time: the released vortices move on known paths, so that at one time
// they are the same for every y
static enum status go_to(struct flow *flow, const struct state *state, double t) {
    const struct school *school = flow->school;
    const unsigned long version = state_wake_version(state, school);
    const int is_new = !flow->has_sources || flow->version != version;
    if (!is_new && flow->t == t) return STATUS_OK;
    flow->has_sources = 0;
    flow->has_released = 0;
    flow->version = version;
    flow->t = t;
    if (has_free_sheets(flow)) TRY(place_free_sheets(flow, state, is_new));
    if (flow->interpolated_version != version) flow->is_interpolated = 0;
    if (flow->is_interpolated) wake_interpolation_update(flow->interpolation, t);
    flow->has_sources = 1;
    return STATUS_OK;
}

static enum status update_sources(struct flow *flow, const struct state *state, double t, const double *y) {
    TRY(go_to(flow, state, t));
    const struct school *const school = flow->school;
    const int threads = parallel_threads(school->threads, school->n_fish, school->n_unknowns, PARALLEL_UNKNOWNS);
#pragma omp parallel for num_threads(threads) schedule(static)
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *fish = &flow->school->fish[f];
        at_points(flow, f, y + fish->at.x, flow->x);
        at_points(flow, f, y + fish->at.y, flow->y);
        place_sheet(flow, f, y);
        place_nascent(flow, state, f, y);
        const int first = flow->points[f].first;
        flow->by_interpolation[f] =
            flow->is_interpolated &&
            wake_interpolation_is_valid(flow->interpolation, f, flow->x + first, flow->y + first);
    }
    flow->all_interpolated = 1;
    for (int f = 0; f < school->n_fish; f++) flow->all_interpolated &= flow->by_interpolation[f];
    return STATUS_OK;
}

void flow_sum_exactly(struct flow *flow) {
    flow->is_interpolated = 0;
}

enum status flow_interpolate(struct flow *flow, const struct state *state) {
    if (!flow->interpolation) return STATUS_OK;
    TRY(update_sources(flow, state, state->t, state->y));
    for (int f = 0; f < flow->school->n_fish; f++) {
        const struct fish *const fish = &flow->school->fish[f];
        // where there are momenta, a is their rate
        const double *const acceleration = fish_has_momentum(fish) ? state->yp + fish->at.vx : state->y + fish->at.ax;
        for (int i = 0; i < 2; i++) {
            at_points(flow, f, state->y + fish->at.vx + i * fish->n_nodes, flow->motion[i]);
            at_points(flow, f, acceleration + i * fish->n_nodes, flow->motion[2 + i]);
        }
    }
    const struct wake_interpolation_points points = {flow->x,         flow->y,         flow->motion[0],
                                                     flow->motion[1], flow->motion[2], flow->motion[3]};
    TRY(wake_interpolation_build(flow->interpolation, seen_wakes(flow, state), state->t, &points));
    wake_interpolation_update(flow->interpolation, flow->t);
    flow->is_interpolated = 1;
    flow->interpolated_version = flow->version;
    return STATUS_OK;
}

// the part of a chunk that lies in a range of points
static struct range overlap(const struct chunk *chunk, struct range range) {
    const int first = chunk->at.first > range.first ? chunk->at.first : range.first;
    const int end = chunk->at.first + chunk->at.n, range_end = range.first + range.n;
    return (struct range){first, (end < range_end ? end : range_end) - first};
}

// add what the own bound sheet, with one smoothing and these circulations, causes at some points of its fish
static void induce_own(const struct flow *flow, const struct chunk *chunk, struct range points, double smoothing,
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

// the bound sheets at a chunk: those of other fish; the own one at control points with no smoothing, at the tail with
// some, not at the midpoints
static void induce_sheets(const struct flow *flow, const struct chunk *chunk, int by_tree, const struct induced *all) {
    const struct fish *fish = &flow->school->fish[chunk->fish];
    const struct range own = flow->sheet_range[chunk->fish], points = flow->points[chunk->fish];
    const struct range control = {points.first, fish->n_control}, tail = {points.first + flow_tail(fish), 1};
    induce_own(flow, chunk, control, 0, flow->sheet.circulation, all);
    if (by_tree) {
        // the tree has summed all of them at all points
        const struct range but_tail = {points.first, points.n - 1};
        induce_own(flow, chunk, but_tail, fish->sheet_smoothing, flow->opposite, all);
        return;
    }
    const struct induced at = vortices_targets(all, chunk->at);
    const int behind = own.first + own.n;
    vortices_induce(&flow->sheet, (struct range){0, own.first}, &at);
    vortices_induce(&flow->sheet, (struct range){behind, flow->sheet.n - behind}, &at);
    induce_own(flow, chunk, tail, fish->sheet_smoothing, flow->sheet.circulation, all);
}

// what the control points of a fish see of its own free sheet besides what everybody sees
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

// the images of all fish, with the smoothing that others see; those of the sheets unless the tree has summed them
static void induce_images(const struct flow *flow, const struct chunk *chunk, int by_tree, const struct induced *at) {
    const struct walls *const walls = &flow->school->walls;
    if (!flow->by_interpolation[chunk->fish]) {
        images_induce(walls, &flow->released, (struct range){0, flow->released.n}, at);
    }
    images_induce(walls, &flow->nascent, (struct range){0, flow->nascent.n}, at);
    if (!by_tree) images_induce(walls, &flow->sheet, (struct range){0, flow->sheet.n}, at);
}

static void evaluate_chunk(const struct flow *flow, const struct chunk *chunk, int by_tree, const struct induced *all) {
    const struct school *school = flow->school;
    const struct induced at = vortices_targets(all, chunk->at);
    for (int p = 0; p < at.n; p++) {
        double u, v;
        flow_external(school, flow->t, at.y[p], &u, &v);
        at.u[p] += u;
        at.v[p] += v;
    }
    for (int p = 0; at.u_x && p < at.n; p++) at.u_y[p] += school->shear;
    if (flow->by_interpolation[chunk->fish]) {
        wake_interpolation_induce(flow->interpolation, chunk->fish, chunk->at.first, &at);
    } else {
        vortices_induce(&flow->released, (struct range){0, flow->released.n}, &at);
    }
    vortices_induce(&flow->nascent, (struct range){0, flow->nascent.n}, &at);
    induce_sheets(flow, chunk, by_tree, all);
    if (has_free_sheets(flow)) induce_free_sheet(flow, chunk, all);
    if (school->walls.n > 0) induce_images(flow, chunk, by_tree, &at);
}

// all bound sheets and their images at all points, by the tree
static enum status sheets_by_tree(struct flow *flow, int threads, const struct induced *all) {
    const double tolerance = flow->school->wake_tolerance;
    TRY(velocity_sum_induce(flow->velocity_sum, &flow->sheet, tolerance, threads, all));
    return images_induce_many(&flow->school->walls, flow->velocity_sum, &flow->sheet, tolerance, threads, all);
}

// interactions of an evaluation that depend on the unknowns
static double work_of(const struct flow *flow) {
    const int n_sources = flow->sheet.n + flow->nascent.n + (flow->has_released ? flow->released.n : 0);
    double work = (double)flow->n_points * n_sources;
    for (int f = 0; has_free_sheets(flow) && f < flow->school->n_fish; f++) {
        // one with a smoothing of its own costs about two
        work += 2.0 * flow->school->fish[f].n_control * flow->free_sheet[f].n;
    }
    return work;
}

static void evaluate(struct flow *flow, int with_gradient) {
    struct induced all = {flow->n_points, flow->x, flow->y, flow->u, flow->v, NULL, NULL, NULL};
    if (with_gradient) {
        all.u_x = flow->u_x;
        all.u_y = flow->u_y;
        all.v_x = flow->v_x;
    }
    const int threads = parallel_threads(flow->school->threads, flow->n_chunks, work_of(flow), PARALLEL_INTERACTIONS);
    const double tolerance = flow->school->wake_tolerance;
    int by_tree = velocity_sum_by_tree(&flow->sheet, flow->n_points, tolerance);
    vortices_zero(&all);
    if (by_tree && sheets_by_tree(flow, threads, &all) != STATUS_OK) {
        // without memory for a tree there is still the direct sum
        by_tree = 0;
        vortices_zero(&all);
    }
#pragma omp parallel for num_threads(threads) schedule(dynamic)
    for (int c = 0; c < flow->n_chunks; c++) evaluate_chunk(flow, &flow->chunk[c], by_tree, &all);
}

static enum status sum(struct flow *flow, const struct state *state, double t, const double *y, int with_gradient) {
    TRY(update_sources(flow, state, t, y));
    if (!flow->all_interpolated) TRY(place_released(flow, state));
    evaluate(flow, with_gradient);
    return STATUS_OK;
}

enum status flow_velocity(struct flow *flow, const struct state *state, double t, const double *y) {
    return sum(flow, state, t, y, 0);
}

enum status flow_gradient(struct flow *flow, const struct state *state, double t, const double *y) {
    return sum(flow, state, t, y, 1);
}

// the derivatives at n points from first on: column c of both components
struct part {
    double *u, *v;
};
static struct part part_of(const struct influence_block *block, int c, int first) {
    const long at = (long)c * block->n_points + first;
    return (struct part){block->u + at, block->v + at};
}

/* As many sources that move with the same nodes are taken together. */
enum { MOST_TOGETHER = 8 };

// add factors times the derivatives with respect to the places of n_sources points that move with the same nodes of
// fish other; sign: of their motion in y, -1 for those that are mirrored
static void add_motion(const struct influence_block *block, const struct fish *other, const struct stencil *point,
                       int n_sources, int first, int n, const struct kernel_values *slope, const double *factor,
                       double sign) {
    for (int i = 0; i < point->n; i++) {
        const struct part by_x = part_of(block, point->node[i], first);
        const struct part by_y = part_of(block, other->n_nodes + point->node[i], first);
        double weighted[MOST_TOGETHER];
        for (int j = 0; j < n_sources; j++) weighted[j] = factor[j] * point[j].weight[i];
        kernel_add_motion(n, n_sources, weighted, sign, slope, by_x.u, by_x.v, by_y.u, by_y.v);
    }
}

// add the velocity per strength of one source to column c
static void add_strength(const struct influence_block *block, int c, int first, int n, const struct kernel_values *unit,
                         double weight) {
    const struct part to = part_of(block, c, first);
    for (int i = 0; i < n; i++) {
        to.u[i] += unit->u[i] * weight;
        to.v[i] += unit->v[i] * weight;
    }
}

// what column a source has, and whether its place moves with the unknowns too
struct target {
    const struct flow *flow;
    int f, g, with_places;
    const struct influence_block *block;
};

// one source of the nascent vortex, or stretch, of a fish: what part of its circulation it has, and of the motion of
// the tail
struct nascent_source {
    double x, y, smoothing, part, follows;
};

// a source at a range of the points of fish f
static void derive_nascent_source(const struct target *at, struct range points, const struct nascent_source *source) {
    const struct flow *flow = at->flow;
    const struct fish *other = &flow->school->fish[at->g];
    const struct stencil tail = {.n = 1, .node = (const int[]){other->n_nodes - 1}, .weight = (const double[]){1}};
    const int here = flow->points[at->f].first, end = points.first + points.n;
    for (int first = points.first; first < end; first += KERNEL_CHUNK) {
        const int n = end - first < KERNEL_CHUNK ? end - first : KERNEL_CHUNK;
        struct kernel_values unit;
        kernel_unit(n, flow->x + here + first, flow->y + here + first, source->x, source->y, source->smoothing, &unit);
        add_strength(at->block, at->block->n_columns - 1, first, n, &unit, source->part);
        if (at->with_places) {
            const double factor = -source->part * source->follows * flow->nascent.circulation[at->g];
            add_motion(at->block, other, &tail, 1, first, n, &unit, &factor, 1);
        }
    }
}

// the nascent vortex or stretch of fish g at all points of fish f
static void derive_nascent(const struct target *at) {
    const struct flow *flow = at->flow;
    const struct fish *other = &flow->school->fish[at->g];
    const int n_points = flow->points[at->f].n, is_sheet = has_free_sheets(flow);
    // the own control points see the stretch point by point, everybody else its middle
    const int n_own = is_sheet && at->f == at->g ? other->n_control : 0;
    const struct nascent_source whole = {flow->nascent.x[at->g], flow->nascent.y[at->g], other->smoothing, 1,
                                         is_sheet ? 0.5 : 1};
    derive_nascent_source(at, (struct range){n_own, n_points - n_own}, &whole);
    const struct free_sheet *const sheet = is_sheet ? &flow->free_sheet[at->g] : NULL;
    for (int i = 0; n_own > 0 && i < FREE_SHEET_PANEL; i++) {
        const int source = sheet->n - (FREE_SHEET_PANEL + 1) + i;
        const struct nascent_source point = {sheet->x[source], sheet->y[source], 0, free_sheet_part[i],
                                             1 - free_sheet_xi[i]};
        derive_nascent_source(at, (struct range){0, n_own}, &point);
    }
}

// how many bound vortices from j on move with the same nodes
static int together(const struct fish *fish, int j) {
    const struct stencil *const point = &fish->sheet_point[j];
    int n = 1;
    while (n < MOST_TOGETHER && j + n < fish->n_sheet && point[n].node == point->node && point[n].n == point->n) n++;
    return n;
}

// the bound vortices of fish g at a range of the points of fish f
static void derive_sheet(const struct target *at, struct range points, double smoothing) {
    const struct flow *flow = at->flow;
    const struct fish *other = &flow->school->fish[at->g];
    const int here = flow->points[at->f].first, sheet = flow->sheet_range[at->g].first;
    const int strength = at->block->n_columns - 1 - other->n_sheet, end = points.first + points.n;
    for (int first = points.first; first < end; first += KERNEL_CHUNK) {
        const int n = end - first < KERNEL_CHUNK ? end - first : KERNEL_CHUNK;
        for (int j = 0, n_together; j < other->n_sheet; j += n_together) {
            struct kernel_values unit[MOST_TOGETHER];
            double factor[MOST_TOGETHER];
            n_together = together(other, j);
            for (int i = 0; i < n_together; i++) {
                const int source = sheet + j + i;
                kernel_unit(n, flow->x + here + first, flow->y + here + first, flow->sheet.x[source],
                            flow->sheet.y[source], smoothing, &unit[i]);
                add_strength(at->block, strength + j + i, first, n, &unit[i], other->sheet_weight[j + i]);
                factor[i] = -flow->sheet.circulation[source];
            }
            if (at->with_places)
                add_motion(at->block, other, &other->sheet_point[j], n_together, first, n, unit, factor, 1);
        }
    }
}

// a source of fish g that everybody sees in the walls
struct mirrored_source {
    double x, y, smoothing;
    int column;                  // of its strength
    double weight, circulation;  // per unit of that unknown, and in all: m or 1, m2 s-1
    const struct stencil *point;
    double follows;  // the part of the motion of that point that it follows
};

// the images of a source at all points of fish f
static void derive_images_of(const struct target *at, const struct mirrored_source *source) {
    const struct flow *flow = at->flow;
    const struct fish *other = &flow->school->fish[at->g];
    const int here = flow->points[at->f].first, end = at->block->n_points;
    for (int first = 0; first < end; first += KERNEL_CHUNK) {
        const int n = end - first < KERNEL_CHUNK ? end - first : KERNEL_CHUNK;
        struct images_values unit;
        images_unit(&flow->school->walls, n, flow->x + here + first, flow->y + here + first, source->x, source->y,
                    source->smoothing, &unit);
        add_strength(at->block, source->column, first, n, &unit.shifted, source->weight);
        add_strength(at->block, source->column, first, n, &unit.mirrored, source->weight);
        if (!at->with_places) continue;
        const double factor = -source->follows * source->circulation;
        add_motion(at->block, other, source->point, 1, first, n, &unit.shifted, &factor, 1);
        add_motion(at->block, other, source->point, 1, first, n, &unit.mirrored, &factor, -1);
    }
}

static void derive_nascent_images(const struct target *at) {
    const struct flow *flow = at->flow;
    const struct fish *other = &flow->school->fish[at->g];
    if (flow->school->walls.n == 0) return;
    const struct stencil tail = {.n = 1, .node = (const int[]){other->n_nodes - 1}, .weight = (const double[]){1}};
    const struct mirrored_source nascent = {.x = flow->nascent.x[at->g],
                                            .y = flow->nascent.y[at->g],
                                            .smoothing = other->smoothing,
                                            .column = at->block->n_columns - 1,
                                            .weight = 1,
                                            .circulation = flow->nascent.circulation[at->g],
                                            .point = &tail,
                                            .follows = has_free_sheets(flow) ? 0.5 : 1};
    derive_images_of(at, &nascent);
}

static void derive_sheet_images(const struct target *at) {
    const struct flow *flow = at->flow;
    const struct fish *other = &flow->school->fish[at->g];
    const int strength = at->block->n_columns - 1 - other->n_sheet;
    for (int j = 0; flow->school->walls.n > 0 && j < other->n_sheet; j++) {
        const int bound = flow->sheet_range[at->g].first + j;
        const struct mirrored_source source = {.x = flow->sheet.x[bound],
                                               .y = flow->sheet.y[bound],
                                               .smoothing = other->sheet_smoothing,
                                               .column = strength + j,
                                               .weight = other->sheet_weight[j],
                                               .circulation = flow->sheet.circulation[bound],
                                               .point = &other->sheet_point[j],
                                               .follows = 1};
        derive_images_of(at, &source);
    }
}

// all that moves with fish g, at the points of fish f that feel it
static void derive_sources(const struct target *at) {
    const struct flow *flow = at->flow;
    const struct fish *fish = &flow->school->fish[at->f], *other = &flow->school->fish[at->g];
    const size_t size = (size_t)at->block->n_points * (size_t)at->block->n_columns;
    memset(at->block->u, 0, size * sizeof *at->block->u);
    memset(at->block->v, 0, size * sizeof *at->block->v);
    derive_nascent(at);
    derive_nascent_images(at);
    derive_sheet_images(at);
    if (at->f == at->g) {
        derive_sheet(at, (struct range){0, fish->n_control}, 0);
        derive_sheet(at, (struct range){flow_tail(fish), 1}, fish->sheet_smoothing);
    } else {
        derive_sheet(at, (struct range){0, flow->points[at->f].n}, other->sheet_smoothing);
    }
}

// the stencil of point p of a fish
static struct stencil point_stencil(const struct fish *fish, int p) {
    if (p < fish->n_control) return fish->control_point[p];
    if (p == flow_tail(fish)) return fish->sheet_point[fish->n_sheet - 1];
    return curve_edge_middle(fish->curve, p - fish->n_control);
}

void flow_derivative(const struct flow *flow, int f, int g, struct influence_block *block) {
    const struct fish *fish = &flow->school->fish[f];
    block->n_points = flow->points[f].n;
    block->n_columns = flow_n_columns(&flow->school->fish[g]);
    derive_sources(&(struct target){flow, f, g, 1, block});
    if (f != g) return;
    // the points of a fish move with its own nodes, in the field of all sources
    for (int p = 0; p < block->n_points; p++) {
        const int at = flow->points[f].first + p;
        const struct stencil point = point_stencil(fish, p);
        for (int i = 0; i < point.n; i++) {
            const double w = point.weight[i];
            const struct part by_x = part_of(block, point.node[i], p);
            const struct part by_y = part_of(block, fish->n_nodes + point.node[i], p);
            *by_x.u += w * flow->u_x[at];
            *by_x.v += w * flow->v_x[at];
            *by_y.u += w * flow->u_y[at];
            *by_y.v -= w * flow->u_x[at];
        }
    }
}

void flow_influence(const struct flow *flow, int f, int g, struct influence_block *block) {
    block->n_points = flow->points[f].n;
    block->n_columns = flow->school->fish[g].n_sheet + 1;
    derive_sources(&(struct target){flow, f, g, 0, block});
}

void flow_nascent_influence(const struct flow *flow, int f, struct influence_block *block) {
    block->n_points = flow->points[f].n;
    block->n_columns = 1;
    memset(block->u, 0, (size_t)block->n_points * sizeof *block->u);
    memset(block->v, 0, (size_t)block->n_points * sizeof *block->v);
    const struct target at = {flow, f, f, 0, block};
    derive_nascent(&at);
    derive_nascent_images(&at);
}

// the bound sheets at free vortices; markers see them with a smoothing that vanishes at the edges
static void sheets_at_wake(const struct flow *flow, const struct induced *at) {
    if (has_free_sheets(flow)) {
        kernel_add_velocity_each(at->n, at->x, at->y, flow->sheet.n, flow->sheet.x, flow->sheet.y,
                                 flow->sheet.circulation, flow->sheet_square, at->u, at->v);
    } else {
        vortices_induce(&flow->sheet, (struct range){0, flow->sheet.n}, at);
    }
}

// the images of the nascent vortices and of the sheets at free vortices
static void images_at_wake(const struct flow *flow, const struct induced *at) {
    const struct walls *const walls = &flow->school->walls;
    if (has_free_sheets(flow)) {
        images_induce_each(walls, flow->sheet.n, flow->sheet.x, flow->sheet.y, flow->sheet.circulation,
                           flow->sheet_square, at);
    } else {
        images_induce(walls, &flow->nascent, (struct range){0, flow->nascent.n}, at);
        images_induce(walls, &flow->sheet, (struct range){0, flow->sheet.n}, at);
    }
}

// the external flow, the nascent vortices and, where they are not summed by the tree, the sheets at the free vortices
static void others_at_wake(const struct flow *flow, int sheets_too, const struct induced *all) {
    const int n_chunks = parallel_n_chunks(all->n);
    const int threads =
        parallel_threads(flow->school->threads, n_chunks, (double)all->n * flow->sheet.n, PARALLEL_INTERACTIONS);
#pragma omp parallel for num_threads(threads) schedule(dynamic, 4)
    for (int chunk = 0; chunk < n_chunks; chunk++) {
        const struct induced at = vortices_targets(all, parallel_chunk(chunk, all->n));
        for (int i = 0; i < at.n; i++) flow_external(flow->school, flow->t, at.y[i], &at.u[i], &at.v[i]);
        // the newest markers have the nascent stretches
        if (!has_free_sheets(flow)) vortices_induce(&flow->nascent, (struct range){0, flow->nascent.n}, &at);
        if (sheets_too) sheets_at_wake(flow, &at);
        if (flow->school->walls.n > 0) images_at_wake(flow, &at);
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
    if (has_free_sheets(flow)) return place_markers(flow, state);
    TRY(place_released(flow, state));
    memcpy(flow->wake_range, flow->released_range, (size_t)flow->school->n_fish * sizeof *flow->wake_range);
    return STATUS_OK;
}

enum status flow_at_wake(struct flow *flow, const struct state *state) {
    TRY(update_sources(flow, state, state->t, state->y));
    TRY(place_moving(flow, state));
    const struct vortices *const moving = has_free_sheets(flow) ? &flow->markers : &flow->released;
    TRY(reserve_at_wake(flow, moving->n));
    const struct induced at = {.n = moving->n, .x = moving->x, .y = moving->y, .u = flow->wake_u, .v = flow->wake_v};
    const double tolerance = flow->school->wake_tolerance;
    const struct bound_vortices bound = {flow->school, &flow->sheet, flow->sheet_range, flow->sheet_square};
    const int by_tree = has_free_sheets(flow) ? sheets_at_wake_by_tree(&bound, moving->n, tolerance)
                                              : velocity_sum_by_tree(&flow->sheet, moving->n, tolerance);
    const int threads =
        parallel_threads(flow->school->threads, moving->n, (double)moving->n * moving->n, PARALLEL_INTERACTIONS);
    others_at_wake(flow, !by_tree, &at);
    if (by_tree && has_free_sheets(flow)) {
        TRY(sheets_at_wake_induce(&bound, flow->velocity_sum, tolerance, threads, &at));
    } else if (by_tree) {
        TRY(velocity_sum_induce(flow->velocity_sum, &flow->sheet, tolerance, threads, &at));
    }
    TRY(images_induce_many(&flow->school->walls, flow->velocity_sum, moving, tolerance, threads, &at));
    if (velocity_sum_by_tree(moving, moving->n, tolerance)) {
        return velocity_sum_induce(flow->velocity_sum, moving, tolerance, threads, &at);
    }
    return pairwise_add_velocity(moving, threads, flow->wake_u, flow->wake_v);
}

// the external flow, the nascent vortices and what is not summed by the tree, as another body would see them, at some
// points
static void induce_field(const struct flow *flow, const int *by_tree, const struct induced *at) {
    for (int i = 0; i < at->n; i++) {
        flow_external(flow->school, flow->t, at->y[i], &at->u[i], &at->v[i]);
        at->u_y[i] = flow->school->shear;
    }
    vortices_induce(&flow->nascent, (struct range){0, flow->nascent.n}, at);
    images_induce(&flow->school->walls, &flow->nascent, (struct range){0, flow->nascent.n}, at);
    if (!by_tree[0]) vortices_induce(&flow->released, (struct range){0, flow->released.n}, at);
    if (!by_tree[1]) vortices_induce(&flow->sheet, (struct range){0, flow->sheet.n}, at);
}

// beyond the walls there is no fluid
static void leave_out_solid(const struct flow *flow, const struct induced *at) {
    double *const values[] = {at->u, at->v, at->u_x, at->u_y, at->v_x};
    for (int i = 0; flow->school->walls.n > 0 && i < at->n; i++) {
        if (images_distance(&flow->school->walls, at->y[i]) >= 0) continue;
        for (size_t k = 0; k < sizeof values / sizeof *values; k++) values[k][i] = NAN;
    }
}

enum status flow_field(struct flow *flow, const struct state *state, const struct induced *all) {
    static const double tolerance = 1e-6;
    TRY(update_sources(flow, state, state->t, state->y));
    TRY(place_released(flow, state));
    vortices_zero(all);
    const struct vortices *const many[2] = {&flow->released, &flow->sheet};
    const int n_chunks = parallel_n_chunks(all->n);
    const int threads = parallel_threads(flow->school->threads, n_chunks, (double)all->n * (many[0]->n + many[1]->n),
                                         PARALLEL_INTERACTIONS);
    int by_tree[2];
    for (int i = 0; i < 2; i++) by_tree[i] = velocity_sum_by_tree(many[i], all->n, tolerance);
#pragma omp parallel for num_threads(threads) schedule(static)
    for (int chunk = 0; chunk < n_chunks; chunk++) {
        const struct induced at = vortices_targets(all, parallel_chunk(chunk, all->n));
        induce_field(flow, by_tree, &at);
    }
    for (int i = 0; i < 2; i++) {
        if (by_tree[i]) TRY(velocity_sum_induce(flow->velocity_sum, many[i], tolerance, threads, all));
        TRY(images_induce_many(&flow->school->walls, flow->velocity_sum, many[i], tolerance, threads, all));
    }
    leave_out_solid(flow, all);
    return STATUS_OK;
}

void flow_slip(const struct flow *flow, int f, const double *y, double slip[2]) {
    const struct fish *fish = &flow->school->fish[f];
    const int tail = flow->points[f].first + flow_tail(fish);
    slip[0] = flow->u[tail] - y[fish->at.vx + fish->n_nodes - 1];
    slip[1] = flow->v[tail] - y[fish->at.vy + fish->n_nodes - 1];
}
