/* flow.c: all sources onto all points. */
#include "flow.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "kernel.h"

int flow_midpoint(const struct fish *fish, int edge) {
    return fish->n_control + edge;
}

int flow_tail(const struct fish *fish) {
    return fish->n_control + fish->n_edges;
}

int flow_column(const struct fish *other, int c) {
    const int n_places = 2 * other->n_nodes;
    return c < n_places ? other->at.x + c : other->at.sheet + (c - n_places);
}

int flow_midpoint_feels(const struct fish *fish, const struct fish *other, int edge, int c) {
    if (fish != other) return 1;
    const int n_places = 2 * fish->n_nodes;
    if (c >= n_places) return c == n_places + fish->n_sheet;
    const int node = c % fish->n_nodes;
    return node == edge || node == edge + 1 || node == fish->n_nodes - 1;
}

static enum status doubles(double **values, int n) {
    double *const more = realloc(*values, (size_t)(n > 0 ? n : 1) * sizeof *more);
    if (!more) return status_fail(STATUS_MEMORY, "no room for %d points of the flow", n);
    *values = more;
    return STATUS_OK;
}

static enum status flow_fill(struct flow *flow) {
    const struct school *school = flow->school;
    const size_t n_fish = (size_t)school->n_fish;
    flow->points = calloc(n_fish, sizeof *flow->points);
    flow->free_range = calloc(n_fish, sizeof *flow->free_range);
    flow->sheet_range = calloc(n_fish, sizeof *flow->sheet_range);
    if (!flow->points || !flow->free_range || !flow->sheet_range) {
        return status_fail(STATUS_MEMORY, "no room for the flow around %d fish", school->n_fish);
    }
    int n_sheet = 0;
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *fish = &school->fish[f];
        flow->points[f] = (struct range){flow->n_points, fish->n_control + fish->n_edges + 1};
        flow->n_points += flow->points[f].n;
        flow->sheet_range[f] = (struct range){n_sheet, fish->n_sheet};
        n_sheet += fish->n_sheet;
    }
    double **const at_points[] = {&flow->x, &flow->y, &flow->u, &flow->v, &flow->u_x, &flow->u_y, &flow->v_x};
    for (size_t i = 0; i < sizeof at_points / sizeof *at_points; i++) TRY(doubles(at_points[i], flow->n_points));
    TRY(doubles(&flow->sheet_x, n_sheet));
    TRY(doubles(&flow->sheet_y, n_sheet));
    return doubles(&flow->sheet_circulation, n_sheet);
}

enum status flow_create(struct flow **flow, const struct school *school) {
    *flow = NULL;
    struct flow *const new = calloc(1, sizeof *new);
    if (!new) return status_fail(STATUS_MEMORY, "no room for a flow");
    new->school = school;
    new->event = -1;
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
    void *const owned[] = {flow->points,      flow->x,       flow->y,       flow->u,
                           flow->v,           flow->u_x,     flow->u_y,     flow->v_x,
                           flow->free_range,  flow->free_x,  flow->free_y,  flow->free_circulation,
                           flow->sheet_range, flow->sheet_x, flow->sheet_y, flow->sheet_circulation};
    for (size_t i = 0; i < sizeof owned / sizeof *owned; i++) free(owned[i]);
    free(flow);
}

void flow_external(const struct school *school, double t, double y, double *u, double *v) {
    const double gust = sin(school->gust_omega * t);
    *u = school->velocity[0] + school->shear * y + gust * school->gust[0];
    *v = school->velocity[1] + gust * school->gust[1];
}

// the free vortices of all fish, each fish's nascent one behind its released ones
static enum status place_free(struct flow *flow, const struct state *state, double t) {
    const struct school *school = flow->school;
    int n = 0;
    for (int f = 0; f < school->n_fish; f++) {
        flow->free_range[f] = (struct range){n, state->wake[f].n_vortex + 1};
        n += state->wake[f].n_vortex + 1;
    }
    flow->n_free = n;
    if (n > flow->capacity) {
        const int capacity = n + n / 2;
        TRY(doubles(&flow->free_x, capacity));
        TRY(doubles(&flow->free_y, capacity));
        TRY(doubles(&flow->free_circulation, capacity));
        flow->capacity = capacity;
    }
    for (int f = 0; f < school->n_fish; f++) {
        const int first = flow->free_range[f].first;
        wake_at(&state->wake[f], school, state->t, t - state->t, flow->free_x + first, flow->free_y + first,
                flow->free_circulation + first);
    }
    return STATUS_OK;
}

static void place_points(struct flow *flow, int f, const double *y) {
    const struct fish *fish = &flow->school->fish[f];
    const double *const from[2] = {y + fish->at.x, y + fish->at.y};
    double *const to[2] = {flow->x + flow->points[f].first, flow->y + flow->points[f].first};
    double *const sheet[2] = {flow->sheet_x + flow->sheet_range[f].first, flow->sheet_y + flow->sheet_range[f].first};
    for (int i = 0; i < 2; i++) {
        for (int c = 0; c < fish->n_control; c++) to[i][c] = fish_mean(&fish->control_point[c], from[i]);
        for (int k = 0; k < fish->n_edges; k++) {
            to[i][flow_midpoint(fish, k)] = (from[i][k] + from[i][k + 1]) / 2;
        }
        for (int j = 0; j < fish->n_sheet; j++) sheet[i][j] = fish_mean(&fish->sheet_point[j], from[i]);
        to[i][flow_tail(fish)] = sheet[i][fish->n_sheet - 1];
    }
    double *const circulation = flow->sheet_circulation + flow->sheet_range[f].first;
    for (int j = 0; j < fish->n_sheet; j++) circulation[j] = fish->sheet_weight[j] * y[fish->at.sheet + j];
}

enum status flow_place(struct flow *flow, const struct state *state, double t, const double *y) {
    const struct school *school = flow->school;
    // the released vortices move on known paths: at one time they are the same for every y
    if (flow->event != state->event || flow->t != t) {
        flow->event = -1;
        TRY(place_free(flow, state, t));
        flow->t = t;
        flow->since = t - state->t;
        flow->event = state->event;
    }
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *fish = &school->fish[f];
        place_points(flow, f, y);
        const int nascent = flow->free_range[f].first + flow->free_range[f].n - 1;
        const double tail[2] = {y[fish->at.x + fish->n_nodes - 1], y[fish->at.y + fish->n_nodes - 1]};
        double position[2];
        wake_nascent(&state->wake[f], flow->since, tail, position);
        flow->free_x[nascent] = position[0];
        flow->free_y[nascent] = position[1];
        flow->free_circulation[nascent] = y[fish->at.shed] - state->wake[f].shed_before;
    }
    return STATUS_OK;
}

void flow_forget(struct flow *flow) {
    flow->event = -1;
}

// add the velocity of n sources at the points first .. first + n_points - 1, with the gradient where it is asked for
static void add_sources(struct flow *flow, int with_gradient, struct range points, struct range sources,
                        const double *x, const double *y, const double *circulation, double smoothing) {
    const int p = points.first, s = sources.first;
    if (with_gradient) {
        kernel_add_gradient(points.n, flow->x + p, flow->y + p, sources.n, x + s, y + s, circulation + s, smoothing,
                            flow->u + p, flow->v + p, flow->u_x + p, flow->u_y + p, flow->v_x + p);
    } else {
        kernel_add_velocity(points.n, flow->x + p, flow->y + p, sources.n, x + s, y + s, circulation + s, smoothing,
                            flow->u + p, flow->v + p);
    }
}

static void add_sheet(struct flow *flow, int with_gradient, struct range points, int g, double smoothing) {
    if (points.n == 0) return;
    add_sources(flow, with_gradient, points, flow->sheet_range[g], flow->sheet_x, flow->sheet_y,
                flow->sheet_circulation, smoothing);
}

// how many threads a sum is worth: below this many interactions starting them costs more than they save
static int n_threads(const struct school *school, double interactions) {
    return interactions > 30000 ? school->threads : 1;
}

// the free vortices of all fish: targets in chunks, so that threads share them; every target's sum is one thread's
enum { CHUNK = 16 };
static void add_free(struct flow *flow, int with_gradient) {
    const struct school *school = flow->school;
    const int n_chunks = (flow->n_points + CHUNK - 1) / CHUNK;
    const int threads = n_threads(school, (double)flow->n_points * flow->n_free);
#pragma omp parallel for num_threads(threads) schedule(static)
    for (int chunk = 0; chunk < n_chunks; chunk++) {
        const int first = chunk * CHUNK, rest = flow->n_points - first;
        for (int g = 0; g < school->n_fish; g++) {
            add_sources(flow, with_gradient, (struct range){first, rest < CHUNK ? rest : CHUNK}, flow->free_range[g],
                        flow->free_x, flow->free_y, flow->free_circulation, school->fish[g].smoothing);
        }
    }
}

static void evaluate(struct flow *flow, int with_gradient) {
    const struct school *school = flow->school;
    for (int p = 0; p < flow->n_points; p++) {
        flow_external(school, flow->t, flow->y[p], &flow->u[p], &flow->v[p]);
        flow->u_x[p] = flow->v_x[p] = 0;
        flow->u_y[p] = school->shear;
    }
    add_free(flow, with_gradient);
    for (int g = 0; g < school->n_fish; g++) {
        const struct fish *fish = &school->fish[g];
        // its bound sheet: at the points of the fish before and behind it in the list, and at its own
        const struct range own = flow->points[g];
        const int behind = own.first + own.n;
        add_sheet(flow, with_gradient, (struct range){0, own.first}, g, fish->sheet_smoothing);
        add_sheet(flow, with_gradient, (struct range){own.first, fish->n_control}, g, 0);
        add_sheet(flow, with_gradient, (struct range){own.first + flow_tail(fish), 1}, g, fish->sheet_smoothing);
        add_sheet(flow, with_gradient, (struct range){behind, flow->n_points - behind}, g, fish->sheet_smoothing);
    }
}

void flow_velocity(struct flow *flow) {
    evaluate(flow, 0);
}

void flow_gradient(struct flow *flow) {
    evaluate(flow, 1);
}

// add weight times the gradient to the columns of the nodes of a point that moves
static void add_motion(struct flow_block *block, int p, const struct stencil *point, int n_nodes,
                       const struct kernel_value *slope, double weight) {
    double *const u = block->u + (long)p * block->n_columns, *const v = block->v + (long)p * block->n_columns;
    for (int i = 0; i < point->n; i++) {
        const int node = point->node[i];
        const double w = weight * point->weight[i];
        u[node] += w * slope->u_x;
        u[n_nodes + node] += w * slope->u_y;
        v[node] += w * slope->v_x;
        v[n_nodes + node] -= w * slope->u_x;
    }
}

// the stencil of point p of a fish
static struct stencil point_stencil(const struct fish *fish, int p) {
    if (p < fish->n_control) return fish->control_point[p];
    if (p == flow_tail(fish)) return fish->sheet_point[fish->n_sheet - 1];
    const int k = p - fish->n_control;
    return (struct stencil){.n = 2, .node = {k, k + 1}, .weight = {0.5, 0.5}};
}

static void derive_nascent(const struct flow *flow, const struct fish *other, int g, int p, double x, double y,
                           struct flow_block *block) {
    const int source = flow->free_range[g].first + flow->free_range[g].n - 1;
    const int tail = other->n_nodes - 1;
    const struct kernel_value unit = kernel_unit(x - flow->free_x[source], y - flow->free_y[source], other->smoothing);
    const struct stencil end = {.n = 1, .node = {tail}, .weight = {1}};
    add_motion(block, p, &end, other->n_nodes, &unit, -flow->free_circulation[source]);
    const long shed = (long)p * block->n_columns + 2 * other->n_nodes + other->n_sheet;
    block->u[shed] += unit.u;
    block->v[shed] += unit.v;
}

static void derive_sheet(const struct flow *flow, const struct fish *other, int g, int p, double x, double y,
                         double smoothing, struct flow_block *block) {
    const int first = flow->sheet_range[g].first;
    const long strength = (long)p * block->n_columns + 2 * other->n_nodes;
    for (int j = 0; j < other->n_sheet; j++) {
        const struct kernel_value unit =
            kernel_unit(x - flow->sheet_x[first + j], y - flow->sheet_y[first + j], smoothing);
        block->u[strength + j] += unit.u * other->sheet_weight[j];
        block->v[strength + j] += unit.v * other->sheet_weight[j];
        add_motion(block, p, &other->sheet_point[j], other->n_nodes, &unit, -flow->sheet_circulation[first + j]);
    }
}

void flow_derivative(const struct flow *flow, int f, int g, struct flow_block *block) {
    const struct fish *fish = &flow->school->fish[f], *other = &flow->school->fish[g];
    block->n_points = flow->points[f].n;
    block->n_columns = 2 * other->n_nodes + other->n_sheet + 1;
    const size_t size = (size_t)block->n_points * (size_t)block->n_columns;
    memset(block->u, 0, size * sizeof *block->u);
    memset(block->v, 0, size * sizeof *block->v);
    for (int p = 0; p < block->n_points; p++) {
        const int at = flow->points[f].first + p;
        const double x = flow->x[at], y = flow->y[at];
        derive_nascent(flow, other, g, p, x, y, block);
        const int own = f == g, control = p < fish->n_control, tail = p == flow_tail(fish);
        if (!own || control || tail) {
            derive_sheet(flow, other, g, p, x, y, own && control ? 0 : other->sheet_smoothing, block);
        }
        if (own) {
            const struct kernel_value total = {.u_x = flow->u_x[at], .u_y = flow->u_y[at], .v_x = flow->v_x[at]};
            const struct stencil point = point_stencil(fish, p);
            add_motion(block, p, &point, fish->n_nodes, &total, 1);
        }
    }
}

void flow_response(const struct flow *flow, int f, int g, struct flow_block *block) {
    const struct fish *fish = &flow->school->fish[f], *other = &flow->school->fish[g];
    const int sheet = flow->sheet_range[g].first, nascent = flow->free_range[g].first + flow->free_range[g].n - 1;
    block->n_points = flow->points[f].n;
    block->n_columns = other->n_sheet + 1;
    for (int p = 0; p < block->n_points; p++) {
        const double x = flow->x[flow->points[f].first + p], y = flow->y[flow->points[f].first + p];
        const int own = f == g, control = p < fish->n_control, tail = p == flow_tail(fish);
        double *const u = block->u + (long)p * block->n_columns, *const v = block->v + (long)p * block->n_columns;
        for (int j = 0; j < other->n_sheet; j++) {
            u[j] = v[j] = 0;
            if (own && !control && !tail) continue;
            const struct kernel_value unit = kernel_unit(x - flow->sheet_x[sheet + j], y - flow->sheet_y[sheet + j],
                                                         own && control ? 0 : other->sheet_smoothing);
            u[j] = unit.u * other->sheet_weight[j];
            v[j] = unit.v * other->sheet_weight[j];
        }
        const struct kernel_value unit =
            kernel_unit(x - flow->free_x[nascent], y - flow->free_y[nascent], other->smoothing);
        u[other->n_sheet] = unit.u;
        v[other->n_sheet] = unit.v;
    }
}

void flow_at_wake(const struct flow *flow, int f, double *u, double *v) {
    const struct school *school = flow->school;
    const double *const x = flow->free_x + flow->free_range[f].first;
    const double *const y = flow->free_y + flow->free_range[f].first;
    const int n = flow->free_range[f].n - 1, n_chunks = (n + CHUNK - 1) / CHUNK;
    const int threads = n_threads(school, (double)n * flow->n_free);
#pragma omp parallel for num_threads(threads) schedule(static)
    for (int chunk = 0; chunk < n_chunks; chunk++) {
        const int first = chunk * CHUNK, m = n - first < CHUNK ? n - first : CHUNK;
        for (int i = first; i < first + m; i++) flow_external(school, flow->t, y[i], &u[i], &v[i]);
        for (int g = 0; g < school->n_fish; g++) {
            const struct fish *fish = &school->fish[g];
            const int free_first = flow->free_range[g].first, sheet_first = flow->sheet_range[g].first;
            kernel_add_velocity(m, x + first, y + first, flow->free_range[g].n, flow->free_x + free_first,
                                flow->free_y + free_first, flow->free_circulation + free_first, fish->smoothing,
                                u + first, v + first);
            kernel_add_velocity(m, x + first, y + first, flow->sheet_range[g].n, flow->sheet_x + sheet_first,
                                flow->sheet_y + sheet_first, flow->sheet_circulation + sheet_first,
                                fish->sheet_smoothing, u + first, v + first);
        }
    }
}

void flow_slip(const struct flow *flow, int f, const double *y, double slip[2]) {
    const struct fish *fish = &flow->school->fish[f];
    const int tail = flow->points[f].first + flow_tail(fish);
    slip[0] = flow->u[tail] - y[fish->at.vx + fish->n_nodes - 1];
    slip[1] = flow->v[tail] - y[fish->at.vy + fish->n_nodes - 1];
}
