/* flow_ring_derivative.c: derivatives per source, by the strength, by the leg and by the nodes that move the source. */
#include "flow/flow_ring_derivative.h"

#include <stddef.h>

// derivatives at n points from first on in one column; NULL: not in the block
struct column {
    double *u, *v, *div, *edge[2];
};
static struct column column_of(const struct influence_block *block, int c, int first) {
    const long at = (long)c * block->n_points + first, size = (long)block->n_columns * block->n_points;
    return (struct column){block->u + at,
                           block->v + at,
                           block->div ? block->div + at : NULL,
                           {block->edge ? block->edge + at : NULL, block->edge ? block->edge + size + at : NULL}};
}

// a source of fish g at the points of fish f
struct source {
    struct ring_source ring;
    struct ring_pair pair;
    int is_image;
    const struct stencil *place;  // nodes that move the source; follows: fraction of the motion
    double follows;
    const struct stencil *line;  // leg d = along times the vector along the body, or to the tail
    double along;
    int has_edge;  // whether the source is part of the edge force
};

static void add_spanwise(const struct column *to, int n, const struct ring_values *values, double factor) {
    for (int i = 0; i < n; i++) {
        to->u[i] += factor * values->unit_u[i];
        to->v[i] += factor * values->unit_v[i];
    }
}

// add the velocity of a leg, or of a change of a leg
static void add_leg(const struct column *to, int n, const struct ring_values *values, double dx, double dy,
                    int has_edge) {
    for (int i = 0; i < n; i++) {
        to->u[i] -= values->leg[i] * dy;
        to->v[i] += values->leg[i] * dx;
    }

    for (int i = 0; i < n && to->div; i++) {
        to->div[i] += values->div_by_dx[i] * dx + values->div_by_dy[i] * dy;
    }

    for (int i = 0; i < n && to->edge[0] && has_edge; i++) {
        to->edge[0][i] += values->edge[i] * dx;
        to->edge[1][i] += values->edge[i] * dy;
    }
}

// add the change of velocity by a displacement of the source in x or y
static void add_displacement(const struct column *to, int n, const struct ring_values *values,
                             const struct source *source, int in_y, double by) {
    const double *const u = in_y ? values->u_y : values->u_x, *const v = in_y ? values->v_y : values->v_x,
                        *const div = in_y ? values->div_y : values->div_x,
                        *const edge = in_y ? values->edge_y : values->edge_x;

    for (int i = 0; i < n; i++) {
        to->u[i] -= by * u[i];
        to->v[i] -= by * v[i];
    }

    for (int i = 0; i < n && to->div; i++) to->div[i] -= by * div[i];
    for (int i = 0; i < n && to->edge[0] && source->has_edge; i++) {
        to->edge[0][i] -= by * edge[i] * source->ring.dx;
        to->edge[1][i] -= by * edge[i] * source->ring.dy;
    }
}

static void add_places(const struct influence_block *block, const struct fish *other, const struct source *source,
                       int first, int n, const struct ring_values *values) {
    // the image moves opposite to the source in y, and the leg of the image moves opposite in x
    const double sign = source->is_image ? -1 : 1;
    for (int i = 0; source->place && i < source->place->n; i++) {
        const int k = source->place->node[i];
        const double by = source->follows * source->place->weight[i];
        const struct column x = column_of(block, k, first), y = column_of(block, other->n_nodes + k, first);
        add_displacement(&x, n, values, source, 0, by);
        add_displacement(&y, n, values, source, 1, sign * by);
    }

    for (int i = 0; source->line && i < source->line->n; i++) {
        const int k = source->line->node[i];
        const double by = source->along * source->line->weight[i];
        const struct column x = column_of(block, k, first), y = column_of(block, other->n_nodes + k, first);
        add_leg(&x, n, values, sign * by, 0, source->has_edge);
        add_leg(&y, n, values, 0, by, source->has_edge);
    }
}

// context of the functions below
struct pass {
    const struct flow *flow;
    int f, g, with_places;
    const struct influence_block *block;
};

static void unit_of(const struct pass *pass, const struct source *source, int first, int n,
                    struct ring_values *values) {
    const struct flow *const flow = pass->flow;
    const int at = flow->points[pass->f].first + first;
    ring_unit(&source->pair, &source->ring, n, flow->x + at, flow->y + at,
              flow->school->fish[pass->f].point_half + first, values);
}

// the image of a source in the wall
static void mirror(const struct flow *flow, struct ring_source *ring) {
    ring->y = ring_sources_mirror(flow->school) - ring->y;
    ring->q = -ring->q;
    ring->dx = -ring->dx;
}

// bound vortices of a fish at the own control points
static void derive_vortices(const struct pass *pass) {
    const struct fish *const fish = &pass->flow->school->fish[pass->g];
    const struct rings *const own = &pass->flow->rings->fish[pass->g].own;
    const int strength = pass->block->n_columns - 1 - fish->n_sheet, end = fish->n_control;

    for (int first = 0; first < end; first += RING_CHUNK) {
        const int n = end - first < RING_CHUNK ? end - first : RING_CHUNK;
        for (int j = 0; j < fish->n_sheet; j++) {
            const struct source source = {
                .ring = {.x = own->x[j], .y = own->y[j], .q = own->q[j], .half = own->half[j]},
                .pair = {.span = fish->strip_depth / 4, .factor = 1},
                .place = &fish->sheet_point[j],
                .follows = 1};

            struct ring_values values;
            unit_of(pass, &source, first, n, &values);
            const struct column to = column_of(pass->block, strength + j, first);
            add_spanwise(&to, n, &values, fish->sheet_weight[j]);
            if (pass->with_places) add_places(pass->block, fish, &source, first, n, &values);
        }
    }
}

// control points of fish g at a range of the points of fish f: only legs in the own strip, else the whole ring
static void derive_body(const struct pass *pass, struct range points, const struct ring_pair *pair, int is_image) {
    const struct fish *const fish = &pass->flow->school->fish[pass->g];
    const struct fish_rings *const of = &pass->flow->rings->fish[pass->g];
    const int is_own = pass->f == pass->g && !is_image;
    const int strength = pass->block->n_columns - 1 - fish->n_sheet, end = points.first + points.n;

    for (int first = points.first; first < end; first += RING_CHUNK) {
        const int n = end - first < RING_CHUNK ? end - first : RING_CHUNK;
        for (int c = 0; c < fish->n_control; c++) {
            const double *const before = fish->integrals->circulation + (long)c * fish->n_sheet;
            const double *const around = fish->integrals->strength + (long)c * fish->n_sheet;
            double along = 0;
            for (int j = 0; j < fish->n_sheet; j++) along += before[j] * of->own.q[j];

            struct source source = {.ring = {.x = of->body.x[c],
                                             .y = of->body.y[c],
                                             .q = is_own ? 0 : of->body.q[c],
                                             .dx = of->body.dx[c],
                                             .dy = of->body.dy[c],
                                             .half = of->body.half[c]},
                                    .pair = *pair,
                                    .is_image = is_image,
                                    .place = &fish->control_point[c],
                                    .follows = 1,
                                    .line = &fish->control_tangent[c].to,
                                    .along = along * fish->control_interval[c],
                                    .has_edge = is_own};

            if (is_image) mirror(pass->flow, &source.ring);
            struct ring_values values;
            unit_of(pass, &source, first, n, &values);

            // by the strengths of the bound vortices
            const double sign = is_image ? -1 : 1;
            for (int j = 0; j < fish->n_sheet; j++) {
                const struct column to = column_of(pass->block, strength + j, first);
                const double weight = fish->sheet_weight[j];
                if (!is_own) add_spanwise(&to, n, &values, sign * around[j] * weight);
                add_leg(&to, n, &values, sign * before[j] * weight * of->line[0][c],
                        before[j] * weight * of->line[1][c], is_own);
            }
            if (pass->with_places) add_places(pass->block, fish, &source, first, n, &values);
        }
    }
}

// the nascent points of one view of the wake of fish g at a range of the points of fish f
static void derive_nascent(const struct pass *pass, const struct ring_sheet *sheet, struct range points,
                           const struct ring_pair *pair, int is_image) {
    const struct flow *const flow = pass->flow;
    const struct fish *const fish = &flow->school->fish[pass->g];
    const struct stencil tail = {.n = 1, .node = (const int[]){fish->n_nodes - 1}, .weight = (const double[]){1}};
    const int n_released = sheet->n_released, end = points.first + points.n;
    const int is_own = pass->f == pass->g && !is_image;
    const double shed = flow->nascent.circulation[pass->g] + flow->rings->fish[pass->g].newest[0];

    for (int first = points.first; first < end; first += RING_CHUNK) {
        const int n = end - first < RING_CHUNK ? end - first : RING_CHUNK;
        for (int k = 0; k < sheet->n_nascent; k++) {
            const struct rings *const rings = &sheet->rings;
            const int i = n_released + k;
            const double xi = ring_sheet_xi(sheet, k), part = ring_sheet_part(sheet, k);
            // C part; the circulation of the stretch is q/part
            const double along = -(shed - xi * rings->q[i] / part) * part;

            struct source source = {.ring = {.x = rings->x[i],
                                             .y = rings->y[i],
                                             .q = rings->q[i],
                                             .dx = rings->dx[i],
                                             .dy = rings->dy[i],
                                             .half = rings->half[i]},
                                    .pair = *pair,
                                    .is_image = is_image,
                                    .place = &tail,
                                    .follows = 1 - xi,
                                    .line = &tail,
                                    .along = -along,
                                    .has_edge = is_own};
            if (is_image) mirror(flow, &source.ring);
            struct ring_values values;
            unit_of(pass, &source, first, n, &values);
            const double sign = is_image ? -1 : 1, by_shed = -(1 - xi) * part;
            const double *const way = flow->rings->fish[pass->g].newest + 1;
            const struct column to = column_of(pass->block, pass->block->n_columns - 1, first);
            add_spanwise(&to, n, &values, sign * part);
            add_leg(&to, n, &values, sign * by_shed * way[0], by_shed * way[1], is_own);
            if (pass->with_places) add_places(pass->block, fish, &source, first, n, &values);
        }
    }
}

void flow_ring_derivative(const struct flow *flow, int f, int g, int with_places, int nascent,
                          const struct influence_block *block) {
    const struct pass pass = {flow, f, g, with_places, block};
    const struct fish *const fish = &flow->school->fish[f], *const other = &flow->school->fish[g];
    const struct fish_rings *const of = &flow->rings->fish[g];
    const int n_points = flow->points[f].n, n_control = fish->n_control;
    const double square = other->smoothing * other->smoothing;
    const struct ring_pair exact = {.span = other->strip_depth / 4, .factor = 1};
    const struct ring_pair own_wake = {.span = other->strip_depth / 4, .factor = 1, .square = square};
    const struct ring_pair wake = {.span = other->strip_depth / 2, .factor = 4, .square = square};
    const struct ring_pair body = {
        .span = other->strip_depth / 2,
        .factor = 4,
        .square =
            (fish->sheet_smoothing * fish->sheet_smoothing + other->sheet_smoothing * other->sheet_smoothing) / 2};
    const struct range control = {0, n_control}, behind = {n_control, n_points - n_control}, all = {0, n_points};

    if (f == g) {
        if (!nascent) derive_vortices(&pass);
        if (!nascent) derive_body(&pass, control, &exact, 0);
        derive_nascent(&pass, &of->graded, control, &exact, 0);
        if (fish_feels_own_wake(fish)) derive_nascent(&pass, &of->middles, behind, &own_wake, 0);
    } else {
        derive_body(&pass, all, &body, 0);
        derive_nascent(&pass, &of->middles, all, &wake, 0);
    }

    if (flow->school->walls.n == 0) return;
    if (!nascent) derive_body(&pass, all, &body, 1);
    derive_nascent(&pass, &of->middles, all, &wake, 1);
}

void flow_ring_motion(const struct flow *flow, int f, const struct influence_block *block) {
    const struct fish *const fish = &flow->school->fish[f];
    const struct flow_rings *const rings = flow->rings;
    for (int p = 0; p < block->n_points; p++) {
        const int at = flow->points[f].first + p;
        const struct stencil point = p < fish->n_control        ? fish->control_point[p]
                                     : p == block->n_points - 1 ? fish->sheet_point[fish->n_sheet - 1]
                                                                : curve_edge_middle(fish->curve, p - fish->n_control);
        for (int i = 0; i < point.n; i++) {
            const double w = point.weight[i];
            const struct column x = column_of(block, point.node[i], p);
            const struct column y = column_of(block, fish->n_nodes + point.node[i], p);
            *x.u += w * flow->u_x[at];
            *x.v += w * flow->v_x[at];
            *y.u += w * flow->u_y[at];
            *y.v += w * (rings->div[at] - flow->u_x[at]);
            if (!block->div) continue;
            *x.div += w * rings->div_x[at];
            *y.div += w * rings->div_y[at];
            for (int k = 0; k < 2 && block->edge; k++) {
                const double *const gradient = rings->edge_gradient + (long)2 * k * flow->n_points + at;
                *x.edge[k] += w * gradient[0];
                *y.edge[k] += w * gradient[flow->n_points];
            }
        }
    }
}
