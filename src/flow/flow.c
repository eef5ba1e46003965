/* flow.c: external flow; points and sources, and their positions at a time. */
#include "flow/flow.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/mathematics.h"
#include "base/memory.h"
#include "body/rod.h"
#include "fish/fish_motion.h"

// ---- external flow

// distance ahead of the point of the gust that was at gust_position at the start, along the direction of travel, m
static double gust_ahead(const struct school *school, double t, double x, double y) {
    const double along = school->gust_along[0] * x + school->gust_along[1] * y;
    return along - school->gust_position - school->gust_speed * t;
}

// velocity of a travelling gust over the amplitude
static double gust_shape(const struct school *school, double ahead) {
    switch (school->gust_profile) {
        case GUST_SINE: return sin(school->gust_number * ahead);
        case GUST_STEP: return ramp_step(0.5 - ahead / school->gust_gradient_distance);
        default: return 0;
    }
}

// derivative of gust_shape, m-1
static double gust_slope(const struct school *school, double ahead) {
    const double distance = school->gust_gradient_distance;
    switch (school->gust_profile) {
        case GUST_SINE: return school->gust_number * cos(school->gust_number * ahead);
        case GUST_STEP: return -ramp_step_rate(0.5 - ahead / distance) / distance;
        default: return 0;
    }
}

void flow_gust(const struct school *school, double t, double x, double y, double *u, double *v) {
    *u = *v = 0;
    if (school->gust_profile == GUST_UNIFORM) return;
    const double shape = gust_shape(school, gust_ahead(school, t, x, y));
    *u = shape * school->gust[0];
    *v = shape * school->gust[1];
}

void flow_external(const struct school *school, double t, double x, double y, double *u, double *v) {
    const double gust = sin(school->gust_omega * t);
    double travelling[2];
    flow_gust(school, t, x, y, &travelling[0], &travelling[1]);
    *u = school->velocity[0] + school->shear * y + gust * school->gust[0] + travelling[0];
    *v = school->velocity[1] + gust * school->gust[1] + travelling[1];
}

void flow_external_gradient(const struct school *school, double t, double x, double y, double gradient[3]) {
    gradient[0] = gradient[2] = 0;
    gradient[1] = school->shear;
    if (school->gust_profile == GUST_UNIFORM) return;
    const double slope = gust_slope(school, gust_ahead(school, t, x, y));
    gradient[0] += slope * school->gust_along[0] * school->gust[0];
    gradient[1] += slope * school->gust_along[1] * school->gust[0];
    gradient[2] += slope * school->gust_along[0] * school->gust[1];
}

void flow_external_acceleration(const struct school *school, double t, double acceleration[2]) {
    const double angle = school->gust_omega * t, rate = school->gust_omega * cos(angle);
    acceleration[0] = school->shear * (school->velocity[1] + sin(angle) * school->gust[1]) + rate * school->gust[0];
    acceleration[1] = rate * school->gust[1];
}

// ---- rings of bodies, and points of wakes

static enum status rings_create(struct flow_rings **rings, const struct school *school, int n_points, int n_classes) {
    *rings = NULL;
    struct flow_rings *new;
    TRY(MEMORY_NEW(new, 1, "the rings of fish"));
    *rings = new;
    TRY(MEMORY_NEW(new->fish, school->n_fish, "the rings of fish"));
    TRY(MEMORY_NEW(new->by_tree, 4 * n_classes * n_classes, "the rings of fish"));
    TRY(ring_tree_create(&new->tree));
    double **const at_points[] = {&new->div, &new->div_x, &new->div_y, &new->image_div};
    TRY(MEMORY_ARRAYS(at_points, n_points, "the points of the flow"));
    TRY(MEMORY_NEW(new->legs[0], N_LEG_SUMS * n_points, "the points of the flow"));
    for (int i = 1; i < N_LEG_SUMS; i++) new->legs[i] = new->legs[0] + (long)i *n_points;
    TRY(MEMORY_NEW(new->edge, 2 * n_points, "the points of the flow"));
    TRY(MEMORY_NEW(new->edge_gradient, 4 * n_points, "the points of the flow"));
    double depth = 0;
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *const fish = &school->fish[f];
        struct fish_rings *const of = &new->fish[f];
        depth = fmax(depth, fish->strip_depth);
        TRY(ring_append(&of->own, fish->n_sheet + fish->n_control));
        TRY(ring_append(&of->body, fish->n_control));
        for (int i = 0; i < 2; i++) TRY(MEMORY_NEW(of->line[i], fish->n_control, "the rings of a fish"));
        memcpy(of->own.half, fish->sheet_half, (size_t)fish->n_sheet * sizeof *of->own.half);
        memcpy(of->own.half + fish->n_sheet, fish->point_half, (size_t)fish->n_control * sizeof *of->own.half);
        memcpy(of->body.half, fish->point_half, (size_t)fish->n_control * sizeof *of->own.half);
    }

    return images_of_rings(&school->walls, depth, &new->image, &new->n_images);
}

static void rings_free(struct flow_rings *rings, int n_fish) {
    if (!rings) return;
    for (int f = 0; rings->fish && f < n_fish; f++) {
        struct fish_rings *const of = &rings->fish[f];
        struct rings *const all[] = {&of->own,        &of->body,          &of->markers,
                                     &of->body_image, &of->middles_image, &of->markers_image};
        for (size_t i = 0; i < sizeof all / sizeof *all; i++) ring_free(all[i]);
        ring_sheets_free(&of->wake);
        for (int i = 0; i < 2; i++) free(of->line[i]);
    }

    double *const owned[] = {rings->div,           rings->div_x,      rings->div_y,      rings->image_div,
                             rings->edge,          rings->wake_div,   rings->wake_rate,  rings->wake_image_div,
                             rings->edge_gradient, rings->wake_leg_u, rings->wake_leg_v, rings->wake_leg_div,
                             rings->legs[0]};
    for (size_t i = 0; i < sizeof owned / sizeof *owned; i++) free(owned[i]);
    ring_tree_free(rings->tree);
    ring_free(&rings->many);
    ring_free(&rings->places);
    free(rings->by_tree);
    free(rings->fish);
    free(rings->image);
    free(rings);
}

// The number of oldest stretches that are far from the body. A source with the sum of distances d from nose and tail is
// on an ellipse of Bernstein, d = (L/2)(rho + 1/rho), and the interpolation at n Chebyshev points of a straight body
// has an error of the order of rho^-n. d is reduced by the bend of the body and by its motion within the interval.
static int rings_far_stretches(const struct fish *fish, const struct school *school, const struct ring_sheets *sheets,
                               const double *y) {
    // below, the kinks of the third derivative of the curve limit the interpolation
    const double least_tolerance = 5e-8;
    if (!fish->point_by_far || school->wake_tolerance < least_tolerance) return 0;
    const int n = fish->n_nodes;
    const double *const x = y + fish->at.x, *const z = y + fish->at.y;
    const double chord[2] = {x[n - 1] - x[0], z[n - 1] - z[0]}, length = hypot(chord[0], chord[1]);
    double bend = 0, speed = 0;
    for (int k = 0; k < n; k++) {
        bend = fmax(bend, fabs(chord[0] * (z[k] - z[0]) - chord[1] * (x[k] - x[0])) / length);
        speed = fmax(speed, hypot(y[fish->at.vx + k], y[fish->at.vy + k]));
    }

    const double rho = fmax(2, pow(school->wake_tolerance, -1.0 / FISH_FAR_EDGES));
    const double least = fish->length / 2 * (rho + 1 / rho) + 2 * bend + 2 * speed * school->interval;
    int n_far = 0;
    for (; n_far < sheets->n_single; n_far++) {
        for (int end = 0; end < 2; end++) {
            const double at[2] = {(sheets->x[end][n_far] + sheets->x[end][n_far + 1]) / 2,
                                  (sheets->y[end][n_far] + sheets->y[end][n_far + 1]) / 2};
            const double nose[2] = {at[0] - x[0], at[1] - z[0]}, tail[2] = {at[0] - x[n - 1], at[1] - z[n - 1]};
            if (!(sqrt(edge_dot(nose, nose)) + sqrt(edge_dot(tail, tail)) >= least)) return n_far;
        }
    }
    return n_far;
}

static enum status rings_place_wakes(struct flow_rings *rings, const struct school *school, const struct state *state,
                                     double tau, int is_new) {
    int n_placed = 0, n_failed = 0;
    for (int f = 0; f < school->n_fish; f++) n_placed += (is_new ? 4 : 2) * state->wake[f].n_vortex;
    const int threads = parallel_threads(school->threads, school->n_fish, n_placed, PARALLEL_VORTICES);
#pragma omp parallel for num_threads(threads) schedule(dynamic)
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *const fish = &school->fish[f];
        const struct wake *const wake = &state->wake[f];
        struct ring_sheets *const sheets = &rings->fish[f].wake;
        const enum status status = is_new ? ring_sheets_build(sheets, fish, school, wake) : STATUS_OK;
        if (is_new && status == STATUS_OK) rings->fish[f].n_far = rings_far_stretches(fish, school, sheets, state->y);
        if (status == STATUS_OK) {
            ring_sheets_place(sheets, school, wake, state->t, tau);
        } else {
#pragma omp atomic
            n_failed++;
        }
    }

    // messages are per thread: write the message on the calling thread
    return n_failed == 0 ? STATUS_OK : memory_check(NULL, "the free sheets");
}

/* Positions and circulations of a body. */
struct ring_body {
    const double *point[2], *sheet[2], *circulation;
};

// bound vortices, legs and control points of a body
static void place_body(struct fish_rings *of, const struct fish *fish, const struct ring_body *body, const double *y) {
    const int n = fish->n_sheet;
    const size_t size = (size_t)n * sizeof(double);
    memcpy(of->own.x, body->sheet[0], size);
    memcpy(of->own.y, body->sheet[1], size);
    memcpy(of->own.q, body->circulation, size);
    sheet_integrals_around(fish->integrals, body->circulation, of->body.q);
    sheet_integrals_before(fish->integrals, body->circulation, of->body.dx);
    fish_of_nodes(fish->n_control, fish->n_nodes, fish->control_by_node[1], y + fish->at.x, of->line[0]);
    fish_of_nodes(fish->n_control, fish->n_nodes, fish->control_by_node[1], y + fish->at.y, of->line[1]);
    for (int c = 0; c < fish->n_control; c++) {
        const double before = of->body.dx[c];
        of->line[0][c] *= fish->control_interval[c];
        of->line[1][c] *= fish->control_interval[c];
        of->body.x[c] = of->own.x[n + c] = body->point[0][c];
        of->body.y[c] = of->own.y[n + c] = body->point[1][c];
        of->body.dx[c] = of->own.dx[n + c] = before * of->line[0][c];
        of->body.dy[c] = of->own.dy[n + c] = before * of->line[1][c];
    }
}

// the direction of the stream relative to a body that is held at the first node
static void rings_find_downstream(const struct school *school, const struct fish *fish, double t, double along[2]) {
    double place[2], velocity[2], acceleration[2], stream[2];
    fish_prescribed_node(fish, 0, t, place, velocity, acceleration);
    flow_external(school, t, place[0], place[1], &stream[0], &stream[1]);
    const double x = stream[0] - velocity[0], y = stream[1] - velocity[1], speed = hypot(x, y);
    along[0] = speed > 0 ? x / speed : 0;
    along[1] = speed > 0 ? y / speed : 0;
}

// the distance from the tail of a fish within which all other fish are
static double rings_steady_reach(const struct school *school, const struct fish *fish) {
    double reach = 0;
    for (int g = 0; g < school->n_fish; g++) {
        const struct fish *const other = &school->fish[g];
        const double x = other->start_position[0] - fish->start_position[0];
        const double y = other->start_position[1] - fish->start_position[1];
        reach = fmax(reach, hypot(x, y) + fish->length + 2 * other->length);
    }
    return reach;
}

// Place body, nascent stretch and images of fish f tau after the event for the unknowns y; ring_body: x, y of control
// points and of bound vortices, and circulations of bound vortices. *nascent: circulation of the nascent stretch. Fails
// with STATUS_MEMORY.
static enum status rings_place(struct flow_rings *rings, const struct school *school, const struct state *state, int f,
                               double tau, const double *y, const struct ring_body *body, double *nascent) {
    const struct fish *const fish = &school->fish[f];
    const struct wake *const wake = &state->wake[f];
    struct fish_rings *const of = &rings->fish[f];
    const double tail[2] = {y[fish->at.x + fish->n_nodes - 1], y[fish->at.y + fish->n_nodes - 1]};
    const double shed = y[fish->at.circulation];

    place_body(of, fish, body, y);
    for (int i = 0; i < 2 && of->n_far > 0; i++) {
        fish_of_nodes(FISH_FAR, fish->n_nodes, fish->far_by_node, y + (i == 0 ? fish->at.x : fish->at.y), of->far[i]);
    }
    if (rings->is_steady) {
        rings_find_downstream(school, fish, state->t + tau, of->downstream);
        const double reach = rings_steady_reach(school, fish);
        TRY(ring_sheet_place_steady(&of->wake.graded, fish, tail, of->downstream, shed, 0));
        TRY(ring_sheet_place_steady(&of->wake.middles, fish, tail, of->downstream, shed, reach));
        *nascent = 0;
    } else {
        const struct direction tangent = fish_direction(fish, &fish->tail_tangent, y);
        ring_sheet_place_nascent(&of->wake.graded, school, wake, state->t, tau, tail, &tangent, shed);
        *nascent = ring_sheet_place_nascent(&of->wake.middles, school, wake, state->t, tau, tail, NULL, shed);
    }
    of->newest = shed - *nascent;
    TRY(ring_write_images(&of->body, rings->n_images, rings->image, &of->body_image));
    return ring_write_images(&of->wake.middles.rings, rings->n_images, rings->image, &of->middles_image);
}

int flow_midpoint(const struct fish *fish, int edge) {
    return fish->n_control + edge;
}

int flow_tail(const struct fish *fish) {
    return fish->n_control + fish->n_edges;
}

int flow_n_points(const struct fish *fish) {
    return flow_tail(fish) + 1;
}

static enum status flow_make_chunks(struct flow *flow) {
    int n = 0;
    for (int f = 0; f < flow->school->n_fish; f++) n += parallel_n_chunks(flow->points[f].n);
    TRY(MEMORY_NEW(flow->chunk, n, "chunks of the flow"));
    for (int f = 0; f < flow->school->n_fish; f++) {
        const struct range points = flow->points[f];
        for (int i = 0; i < parallel_n_chunks(points.n); i++) {
            const struct range part = parallel_chunk(i, points.n);
            flow->chunk[flow->n_chunks++] = (struct chunk){f, {points.first + part.first, part.n}};
        }
    }

    return STATUS_OK;
}

// one class per length, in the order of the first fish of each length
static enum status flow_find_classes(struct flow *flow) {
    const struct school *const school = flow->school;
    const size_t n_fish = (size_t)school->n_fish;
    TRY(MEMORY_NEW(flow->class_of, n_fish, "classes of fish"));
    TRY(MEMORY_NEW(flow->class, n_fish, "classes of fish"));

    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *const fish = &school->fish[f];

        int c = 0;
        // both radii are multiples of the length
        while (flow_has_free_sheets(flow) && c < flow->n_classes &&
               fabs(flow->class[c].smoothing - fish->smoothing) > 0) {
            c++;
        }

        flow->class_of[f] = c;
        if (c < flow->n_classes) continue;
        flow->class[c] = (struct flow_class){.smoothing = fish->smoothing, .sheet_smoothing = fish->sheet_smoothing};
        flow->n_classes++;
    }

    // consecutive points for each class
    for (int c = 0; c < flow->n_classes; c++) {
        struct flow_class *const class = &flow->class[c];
        TRY(MEMORY_NEW(class->group, n_fish + (size_t)flow->n_classes + 1, "classes of fish"));
        class->points.first = flow->n_points;
        for (int f = 0; f < school->n_fish; f++) {
            const struct fish *const fish = &school->fish[f];
            if (flow->class_of[f] != c) continue;
            flow->points[f] = (struct range){flow->n_points, flow_n_points(fish)};
            if (!fish_feels_own_wake(fish)) {
                flow->without_own[f] = (struct range){flow->n_points + flow_midpoint(fish, 0), fish->n_edges};
            }
            flow->n_points += flow->points[f].n;
        }

        class->points.n = flow->n_points - class->points.first;
    }

    return STATUS_OK;
}

double flow_sheet_smoothing(const struct flow *flow, int f, int g) {
    const double of_other = flow->school->fish[g].sheet_smoothing;
    if (!flow_has_free_sheets(flow)) return of_other;
    return vortices_pair_smoothing(of_other, flow->school->fish[f].sheet_smoothing);
}

static enum status flow_fill(struct flow *flow) {
    const struct school *school = flow->school;
    const size_t n_fish = (size_t)school->n_fish;
    TRY(MEMORY_NEW(flow->points, n_fish, "the flow"));
    TRY(MEMORY_NEW(flow->without_own, n_fish, "the flow"));
    TRY(MEMORY_NEW(flow->released_range, n_fish, "the flow"));
    TRY(MEMORY_NEW(flow->sheet_range, n_fish, "the flow"));
    TRY(MEMORY_NEW(flow->by_interpolation, n_fish, "the flow"));
    TRY(MEMORY_NEW(flow->wake_range, n_fish, "the flow"));
    TRY(MEMORY_NEW(flow->body_range, n_fish, "the flow"));
    TRY(MEMORY_NEW(flow->middles, n_fish, "the flow"));
    TRY(MEMORY_NEW(flow->free_sheet, n_fish, "the flow"));

    TRY(flow_find_classes(flow));
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *fish = &school->fish[f];
        flow->sheet_range[f] = (struct range){flow->sheet.n, fish->n_sheet};
        TRY(vortices_append(&flow->sheet, fish->n_sheet, fish->sheet_smoothing));
        TRY(vortices_append(&flow->nascent, 1, fish->smoothing));
    }

    double **const at_points[] = {&flow->x,         &flow->y,         &flow->u,        &flow->v,
                                  &flow->u_x,       &flow->u_y,       &flow->v_x,      &flow->motion[0],
                                  &flow->motion[1], &flow->motion[2], &flow->motion[3]};
    TRY(MEMORY_ARRAYS(at_points, flow->n_points, "the points of the flow"));
    TRY(flow_make_chunks(flow));
    if (school->walls.n > 0) {
        TRY(MEMORY_NEW(flow->image_u, flow->n_points, "the points of the flow"));
        TRY(MEMORY_NEW(flow->image_v, flow->n_points, "the points of the flow"));
    }

    TRY(MEMORY_NEW(flow->opposite, flow->sheet.n, "the bound vortices"));

    // the bound sheets with the smoothing of each class
    for (int c = 0; c < flow->n_classes; c++) {
        struct flow_class *const class = &flow->class[c];
        class->sheet = flow->sheet;
        if (!flow_has_free_sheets(flow)) continue;
        class->sheet = vortices_felt_by(&flow->sheet, class->sheet_smoothing, class->group);
    }

    TRY(velocity_sum_create(&flow->velocity_sum));
    if (school->finite) return rings_create(&flow->rings, school, flow->n_points, flow->n_classes);
    if (school->wake_tolerance <= 0) return STATUS_OK;
    return wake_interpolation_create(&flow->interpolation, school, flow->points, flow->without_own);
}

enum status flow_create(struct flow **flow, const struct school *school) {
    *flow = NULL;
    struct flow *new;
    TRY(MEMORY_NEW(new, 1, "a flow"));
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
    rings_free(flow->rings, flow->school->n_fish);
    velocity_sum_free(flow->velocity_sum);
    for (int f = 0; f < flow->school->n_fish; f++) {
        if (flow->middles) wake_free(&flow->middles[f]);
        if (flow->free_sheet) free_sheet_free(&flow->free_sheet[f]);
    }

    for (int c = 0; flow->class && c < flow->n_classes; c++) free(flow->class[c].group);

    void *const owned[] = {flow->points,
                           flow->without_own,
                           flow->class,
                           flow->class_of,
                           flow->body_range,
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
                           flow->wake_u,
                           flow->wake_v,
                           flow->wake_image_u,
                           flow->wake_image_v,
                           flow->image_u,
                           flow->image_v};
    for (size_t i = 0; i < sizeof owned / sizeof *owned; i++) free(owned[i]);

    vortices_free(&flow->released);
    vortices_free(&flow->convecting);
    vortices_free(&flow->nascent);
    vortices_free(&flow->sheet);
    free(flow);
}

void flow_from_nodes(const struct flow *flow, int f, const double *of_nodes, double *of_points) {
    const struct fish *fish = &flow->school->fish[f];
    double *const to = of_points + flow->points[f].first;
    fish_of_nodes(fish->n_control, fish->n_nodes, fish->control_by_node[0], of_nodes, to);
    for (int k = 0; k < fish->n_edges; k++) to[flow_midpoint(fish, k)] = (of_nodes[k] + of_nodes[k + 1]) / 2;
    to[flow_tail(fish)] = of_nodes[fish->n_nodes - 1];
}

static void flow_place_sheet(struct flow *flow, int f, const double *y) {
    const struct fish *fish = &flow->school->fish[f];
    const int first = flow->sheet_range[f].first;
    fish_of_nodes(fish->n_sheet, fish->n_nodes, fish->sheet_by_node, y + fish->at.x, flow->sheet.x + first);
    fish_of_nodes(fish->n_sheet, fish->n_nodes, fish->sheet_by_node, y + fish->at.y, flow->sheet.y + first);
    for (int j = 0; j < fish->n_sheet; j++) {
        flow->sheet.circulation[first + j] = fish->sheet_weight[j] * y[fish->at.gamma + j];
        flow->opposite[first + j] = -flow->sheet.circulation[first + j];
    }
}

int flow_has_free_sheets(const struct flow *flow) {
    return flow->school->shedding == SHEDDING_SHEET;
}

const struct wake *flow_seen_wakes(const struct flow *flow, const struct state *state) {
    return flow_has_free_sheets(flow) ? flow->middles : state->wake;
}

static void flow_place_nascent(struct flow *flow, const struct state *state, int f, const double *y) {
    const struct fish *fish = &flow->school->fish[f];
    const struct wake *const wake = &state->wake[f];
    const double tail[2] = {y[fish->at.x + fish->n_nodes - 1], y[fish->at.y + fish->n_nodes - 1]};
    const double circulation = y[fish->at.circulation] - wake->shed_before, tau = flow->t - state->t;
    double position[2];

    if (flow->rings) return;
    if (flow_has_free_sheets(flow)) {
        free_sheet_nascent_point(wake, flow->school->interval, tau, tail, 0.5, position);
        const struct direction tangent = fish_direction(fish, &fish->tail_tangent, y);
        free_sheet_place_nascent(&flow->free_sheet[f], fish, wake, flow->school->interval, tau, tail, &tangent,
                                 circulation);
    } else {
        wake_nascent(wake, tau, tail, position);
    }

    flow->nascent.x[f] = position[0];
    flow->nascent.y[f] = position[1];
    flow->nascent.circulation[f] = circulation;
}

enum status flow_place_released(struct flow *flow, const struct state *state) {
    if (flow->has_released) return STATUS_OK;
    TRY(wake_interpolation_released(flow->school, flow_seen_wakes(flow, state), state->t, flow->t - state->t,
                                    &flow->released, flow->released_range));
    flow->has_released = 1;
    return STATUS_OK;
}

// free sheets at the time of the flow; build the sheets again if the wakes have changed
static enum status flow_place_free_sheets(struct flow *flow, const struct state *state, int is_new) {
    const struct school *const school = flow->school;
    int n_placed = 0, n_failed = 0;

    // building a stretch requires both ends at the start and at the end of the interval
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

    // messages are per thread: write the message on the calling thread
    return n_failed == 0 ? STATUS_OK : memory_check(NULL, "the free sheets");
}

// Set the time, and discard data of other wakes or another time. The released vortices move on known paths, so that
// their positions at one time are independent of y.
static enum status flow_set_time(struct flow *flow, const struct state *state, double t) {
    const struct school *school = flow->school;
    const unsigned long version = state_wake_version(state, school);
    const int is_new = !flow->has_sources || flow->version != version;

    if (!is_new && flow->t == t) return STATUS_OK;

    flow->has_sources = 0;
    flow->has_released = 0;
    flow->version = version;
    flow->t = t;

    if (flow->rings) {
        TRY(rings_place_wakes(flow->rings, school, state, t - state->t, is_new));
    } else if (flow_has_free_sheets(flow)) {
        TRY(flow_place_free_sheets(flow, state, is_new));
    }

    if (flow->interpolated_version != version) flow->is_interpolated = 0;
    if (flow->is_interpolated) wake_interpolation_update(flow->interpolation, t);
    flow->has_sources = 1;
    return STATUS_OK;
}

static enum status flow_place_rings(struct flow *flow, const struct state *state, const double *y) {
    for (int f = 0; f < flow->school->n_fish; f++) {
        const int point = flow->points[f].first, sheet = flow->sheet_range[f].first;
        const struct ring_body body = {.point = {flow->x + point, flow->y + point},
                                       .sheet = {flow->sheet.x + sheet, flow->sheet.y + sheet},
                                       .circulation = flow->sheet.circulation + sheet};
        TRY(rings_place(flow->rings, flow->school, state, f, flow->t - state->t, y, &body,
                        &flow->nascent.circulation[f]));
    }

    return STATUS_OK;
}

enum status flow_place(struct flow *flow, const struct state *state, double t, const double *y) {
    TRY(flow_set_time(flow, state, t));
    const struct school *const school = flow->school;
    const int threads = parallel_threads(school->threads, school->n_fish, school->n_unknowns, PARALLEL_UNKNOWNS);
#pragma omp parallel for num_threads(threads) schedule(static)
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *fish = &flow->school->fish[f];
        flow_from_nodes(flow, f, y + fish->at.x, flow->x);
        flow_from_nodes(flow, f, y + fish->at.y, flow->y);
        flow_place_sheet(flow, f, y);
        flow_place_nascent(flow, state, f, y);

        const int first = flow->points[f].first;
        flow->by_interpolation[f] =
            flow->is_interpolated &&
            wake_interpolation_is_valid(flow->interpolation, f, flow->x + first, flow->y + first);
    }

    flow->all_interpolated = 1;
    for (int f = 0; f < school->n_fish; f++) flow->all_interpolated &= flow->by_interpolation[f];
    return flow->rings ? flow_place_rings(flow, state, y) : STATUS_OK;
}
