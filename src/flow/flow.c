/* flow.c: classes of fish, and where points and sources are at a given time. */
#include "flow/flow.h"

#include <math.h>
#include <string.h>

#include "base/wide.h"
#include "body/rod.h"
#include "fish/fish_motion.h"
#include "flow/flow_external.h"
#include "flow/images.h"

int flow_midpoint(const struct fish *fish, int edge) {
    return fish->n_control + edge;
}

int flow_tail(const struct fish *fish) {
    return fish->n_control + fish->n_edges;
}

int flow_n_points(const struct fish *fish) {
    return flow_tail(fish) + 1;
}

bool flow_has_free_sheets(const struct flow *flow) {
    return flow->school->shedding == SHEDDING_SHEET;
}

double flow_square(const struct flow *flow, enum flow_pair pair, const struct flow_class *target,
                   const struct flow_class *source) {
    const double delta = source->smoothing, e = source->sheet_smoothing;
    const bool is_body = pair == BODY_AT_BODY || pair == BODY_AT_WAKE;
    if (!flow_has_free_sheets(flow)) return is_body ? e * e : delta * delta;
    switch (pair) {
        case BODY_AT_BODY: return (e * e + target->sheet_smoothing * target->sheet_smoothing) / 2;
        case BODY_AT_WAKE: return target->smoothing * target->smoothing;
        case WAKE_AT_WAKE: return (delta * delta + target->smoothing * target->smoothing) / 2;
        default: return delta * delta;
    }
}

const struct sources *flow_sources(const struct flow *flow, int g, const struct flow_sum *sum) {
    const struct flow_fish *const of = &flow->fish[g];
    switch (sum->pair) {
        case WAKE_AT_BODY: return sum->of_images ? &of->wake_image : &of->wake.middles.sources;
        case WAKE_AT_WAKE: return sum->of_images ? &of->markers_image : &of->markers;
        default: return sum->of_images ? &of->body_image : &of->body;
    }
}

struct kernel_pair flow_pair_of(const struct flow *flow, int f, int g, const struct flow_sum *sum) {
    const double square =
        flow_square(flow, sum->pair, &flow->classes[flow->class_of[f]], &flow->classes[flow->class_of[g]]);
    return flow->kernel->other(flow->school->fish[g].strip_depth, square);
}

void flow_append_with_span(struct sources *many, const struct sources *sources, struct range which, double span) {
    const int first = many->n;
    sources_append(many, which.n);
    for (int i = 0; i < which.n; i++) {
        const int from = which.first + i;
        many->x[first + i] = sources->x[from];
        many->y[first + i] = sources->y[from];
        many->q[first + i] = span * sources->q[from];
        many->dx[first + i] = span * sources->dx[from];
        many->dy[first + i] = span * sources->dy[from];
        many->half[first + i] = sources->half[from];
        many->leg[first + i] = sources->leg[from];
    }
}

// ---- creation

// Fish of one length form a class, because both smoothings are fractions of the length. Classes are in the order of
// their first fish, and the points of a class are consecutive.
static void flow_find_classes(struct flow *flow) {
    const struct school *const school = flow->school;
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *const fish = &school->fish[f];
        int c = 0;
        while (c < flow->n_classes && fabs(flow->classes[c].smoothing - fish->smoothing) > 0) c++;
        flow->class_of[f] = c;
        if (c < flow->n_classes) continue;
        flow->classes[c] = (struct flow_class){.smoothing = fish->smoothing, .sheet_smoothing = fish->sheet_smoothing};
        flow->n_classes++;
    }

    int n_chunks = 0;
    for (int c = 0; c < flow->n_classes; c++) {
        struct flow_class *const kind = &flow->classes[c];
        kind->points.first = flow->n_points;
        for (int f = 0; f < school->n_fish; f++) {
            if (flow->class_of[f] != c) continue;
            flow->points[f] = (struct range){flow->n_points, flow_n_points(&school->fish[f])};
            flow->n_points += flow->points[f].n;
            n_chunks += parallel_n_chunks(flow->points[f].n);
        }
        kind->points.n = flow->n_points - kind->points.first;
    }

    NEW(flow->arena, flow->chunk, n_chunks);
    for (int f = 0; f < school->n_fish; f++) {
        const struct range points = flow->points[f];
        for (int i = 0; i < parallel_n_chunks(points.n); i++) {
            const struct range part = parallel_chunk(i, points.n);
            flow->chunk[flow->n_chunks++] = (struct chunk){f, {points.first + part.first, part.n}};
        }
    }
}

struct flow *flow_create(struct arena *arena, const struct school *school) {
    struct flow *flow;
    NEW(arena, flow, 1);
    flow->arena = flow->many.arena = flow->places.arena = arena;
    flow->school = school;
    flow->kernel = school->finite ? &kernel_finite : &kernel_infinite;
    NEW(arena, flow->points, school->n_fish);
    NEW(arena, flow->wake_range, school->n_fish);
    NEW(arena, flow->fish, school->n_fish);
    NEW(arena, flow->class_of, school->n_fish);
    NEW(arena, flow->classes, school->n_fish);
    flow_find_classes(flow);
    NEW(arena, flow->by_tree, 4 * flow->n_classes * flow->n_classes);

    double **const at_points[] = {&flow->x,       &flow->y,       &flow->u,        &flow->v,     &flow->u_x,
                                  &flow->u_y,     &flow->v_x,     &flow->div,      &flow->div_x, &flow->div_y,
                                  &flow->image_u, &flow->image_v, &flow->image_div};
    for (size_t i = 0; i < sizeof at_points / sizeof *at_points; i++) NEW(arena, *at_points[i], flow->n_points);
    NEW(arena, flow->edge, 2 * flow->n_points);
    NEW(arena, flow->edge_gradient, 4 * flow->n_points);
    NEW(arena, flow->legs[0], N_LEG_SUMS * flow->n_points);
    for (int i = 1; i < N_LEG_SUMS; i++) flow->legs[i] = flow->legs[0] + (long)i * flow->n_points;

    double depth = 0;
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *const fish = &school->fish[f];
        struct flow_fish *const of = &flow->fish[f];
        const bool has_legs = flow->kernel->has_legs;
        struct sources *const all[] = {&of->own,        &of->body,       &of->markers,
                                       &of->body_image, &of->wake_image, &of->markers_image};
        for (size_t i = 0; i < sizeof all / sizeof *all; i++) all[i]->arena = arena;
        sources_append(&of->own, fish->n_sheet + (has_legs ? fish->n_control : 0));
        sources_append(&of->body, fish->integrals ? fish->n_control : fish->n_sheet);
        depth = fmax(depth, fish->strip_depth);
        if (!has_legs) continue;

        for (int i = 0; i < 2; i++) NEW(arena, of->line[i], fish->n_control);
        memcpy(of->own.half, fish->sheet_half, (size_t)fish->n_sheet * sizeof *of->own.half);
        memcpy(of->own.half + fish->n_sheet, fish->point_half, (size_t)fish->n_control * sizeof *of->own.half);
        memcpy(of->body.half, fish->point_half, (size_t)fish->n_control * sizeof *of->own.half);
    }
    flow->n_images = images_find(arena, &school->walls, depth, &flow->image);
    flow->tree = tree_create(arena);
    return flow;
}

// ---- placing

void flow_from_nodes(const struct flow *flow, int f, const double *of_nodes, double *of_points) {
    const struct fish *fish = &flow->school->fish[f];
    double *const to = of_points + flow->points[f].first;
    wide_product(fish->n_control, fish->n_nodes, fish->control_by_node[0], of_nodes, to);
    for (int k = 0; k < fish->n_edges; k++) to[flow_midpoint(fish, k)] = (of_nodes[k] + of_nodes[k + 1]) / 2;
    to[flow_tail(fish)] = of_nodes[fish->n_nodes - 1];
}

// what has happened to the wakes since their sources were built: nothing, new velocities, or anything
enum wake_change { WAKE_SAME, WAKE_TURNED, WAKE_ANEW };

static void flow_place_wake(const struct flow *flow, const struct state *state, int f, enum wake_change change) {
    const struct wake *const wake = &state->wake[f];
    struct sheet *const sheet = &flow->fish[f].wake;
    if (change == WAKE_ANEW) sheet_build(sheet, &flow->school->fish[f], flow->school, wake, state->t);
    if (change == WAKE_TURNED) sheet_turn(sheet, &flow->school->fish[f], flow->school, wake);
    sheet_place(sheet, &flow->school->fish[f], flow->school, wake, state->t, flow->t - state->t);
}

// place the points and bound vortices of a fish, and find legs and circulations at its control points
static void flow_place_body(struct flow *flow, int f, const double *y) {
    const struct fish *const fish = &flow->school->fish[f];
    struct flow_fish *const of = &flow->fish[f];
    const int n = fish->n_sheet, points = flow->points[f].first;
    const bool has_legs = flow->kernel->has_legs;
    const double *const node_x = y + fish->at.x, *const node_y = y + fish->at.y;
    flow_from_nodes(flow, f, node_x, flow->x);
    flow_from_nodes(flow, f, node_y, flow->y);
    wide_product(n, fish->n_nodes, fish->sheet_by_node, node_x, of->own.x);
    wide_product(n, fish->n_nodes, fish->sheet_by_node, node_y, of->own.y);
    for (int j = 0; j < n; j++) of->own.q[j] = fish->sheet_weight[j] * y[fish->at.gamma + j];

    const size_t size = (size_t)of->body.n * sizeof(double);
    memcpy(of->body.x, fish->integrals ? flow->x + points : of->own.x, size);
    memcpy(of->body.y, fish->integrals ? flow->y + points : of->own.y, size);
    if (fish->integrals) {
        wide_product(fish->n_control, n, fish->integrals->strength, of->own.q, of->body.q);
    } else {
        memcpy(of->body.q, of->own.q, size);
    }
    if (!has_legs) return;

    wide_product(fish->n_control, n, fish->integrals->circulation, of->own.q, of->body.dx);
    wide_product(fish->n_control, fish->n_nodes, fish->control_by_node[1], node_x, of->line[0]);
    wide_product(fish->n_control, fish->n_nodes, fish->control_by_node[1], node_y, of->line[1]);
    for (int c = 0; c < fish->n_control; c++) {
        const double before = of->body.dx[c];
        of->line[0][c] *= fish->control_interval[c];
        of->line[1][c] *= fish->control_interval[c];
        of->body.dx[c] = before * of->line[0][c];
        of->body.dy[c] = before * of->line[1][c];
    }
    memcpy(of->own.x + n, of->body.x, size);
    memcpy(of->own.y + n, of->body.y, size);
    memcpy(of->own.dx + n, of->body.dx, size);
    memcpy(of->own.dy + n, of->body.dy, size);
}

// the distance from the tail of a fish within which all other fish are
static double flow_steady_reach(const struct school *school, const struct fish *fish) {
    double reach = 0;
    for (int g = 0; g < school->n_fish; g++) {
        const struct fish *const other = &school->fish[g];
        const double x = other->start_position[0] - fish->start_position[0];
        const double y = other->start_position[1] - fish->start_position[1];
        reach = fmax(reach, hypot(x, y) + fish->length + 2 * other->length);
    }
    return reach;
}

enum status flow_check_steady(const struct school *school) {
    const double most = 1e5;
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *const fish = &school->fish[f];
        const double reach = flow_steady_reach(school, fish), depth = fish->strip_depth;
        if (!(depth > 0) || reach <= most * depth) continue;
        return status_fail(STATUS_CASE,
                           "%s: fish are up to %.3g m apart, %.3g depths; a steady wake has at most %g: move the fish "
                           "closer together, or increase body.depth",
                           fish->name, reach, reach / depth, most);
    }
    return STATUS_OK;
}

void flow_place_released(struct flow *flow, const struct state *state, double t) {
    const struct school *const school = flow->school;
    const unsigned long version = state_wake_version(state, school), n_turns = state_wake_turns(state, school);
    enum wake_change change = WAKE_SAME;
    if (!flow->has_sources || flow->version - flow->n_turns != version - n_turns) {
        change = WAKE_ANEW;
    } else if (flow->version != version) {
        change = WAKE_TURNED;
    }

    // released points move on known paths, so their positions at one time do not depend on y
    if (change == WAKE_SAME && flow->t == t) return;
    flow->has_sources = false;
    flow->version = version;
    flow->n_turns = n_turns;
    flow->t = t;

    // if the wakes have changed, choose the points that represent them again
    int n_placed = 0;
    for (int f = 0; f < school->n_fish; f++) {
        n_placed += (change == WAKE_ANEW ? 4 : 2) * state->wake[f].n_vortex;
        if (change == WAKE_ANEW) sheet_reserve(flow->arena, &flow->fish[f].wake, state->wake[f].n_vortex);
    }
    const int threads = parallel_threads(school->threads, school->n_fish, n_placed, PARALLEL_VORTICES);
    if (threads == 1) {
        for (int f = 0; f < school->n_fish; f++) flow_place_wake(flow, state, f, change);
    } else {
#pragma omp parallel for num_threads(threads) schedule(dynamic)
        for (int f = 0; f < school->n_fish; f++) flow_place_wake(flow, state, f, change);
    }
    flow->has_sources = !flow->is_steady;
}

void flow_place(struct flow *flow, const struct state *state, double t, const double *y) {
    const struct school *const school = flow->school;
    flow_place_released(flow, state, t);
    const int threads = parallel_threads(school->threads, school->n_fish, school->n_unknowns, PARALLEL_UNKNOWNS);
    if (threads == 1) {
        for (int f = 0; f < school->n_fish; f++) flow_place_body(flow, f, y);
    } else {
#pragma omp parallel for num_threads(threads) schedule(static)
        for (int f = 0; f < school->n_fish; f++) flow_place_body(flow, f, y);
    }

    // the nascent points, and the images of everything
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *const fish = &school->fish[f];
        const struct wake *const wake = &state->wake[f];
        struct flow_fish *const of = &flow->fish[f];
        struct sheet *const sheet = &of->wake;
        const double shed = y[fish->at.circulation], tau = t - state->t;
        double tail[2];
        fish_tail(fish, y, tail);
        if (flow->is_steady) {
            // the wake leaves in the direction of the stream relative to the body, which is held at the first node
            double place[2], velocity[2], acceleration[2], stream[2];
            fish_prescribed_node(fish, NULL, 0, t, place, velocity, acceleration);
            flow_external(school, t, place[0], place[1], &stream[0], &stream[1]);
            for (int i = 0; i < 2; i++) stream[i] -= velocity[i];
            const double speed = hypot(stream[0], stream[1]), reach = flow_steady_reach(school, fish);
            for (int i = 0; i < 2; i++) of->downstream[i] = speed > 0 ? stream[i] / speed : 0;
            sheet_place_steady(sheet, &sheet->graded, fish, tail, of->downstream, shed, 0);
            sheet_place_steady(sheet, &sheet->middles, fish, tail, of->downstream, shed, reach);
            of->nascent = 0;
        } else {
            const struct direction tangent = fish_direction(fish, &fish->tail_tangent, y);
            if (flow_has_free_sheets(flow)) {
                sheet_place_nascent(&sheet->graded, school, wake, state->t, tau, tail, &tangent, shed);
            }
            of->nascent = sheet_place_nascent(&sheet->middles, school, wake, state->t, tau, tail, NULL, shed);
        }
        of->newest = shed - of->nascent;
        images_write(&of->body, flow->n_images, flow->image, &of->body_image);
        images_write(&sheet->middles.sources, flow->n_images, flow->image, &of->wake_image);
    }
}
