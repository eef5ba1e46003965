/* flow_derivative.c: derivatives per source, by the strength and by the nodes that move the source. */
#include "flow/flow_derivative.h"

#include <stddef.h>
#include <string.h>

#include "vortex/kernel.h"

// ---- derivatives per source, by the strength, by the leg and by the nodes that move the source

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
    double image;                 // sign of the images that are summed (ring.h); 0: the source itself
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
static inline __attribute__((always_inline)) void add_leg_to(const struct column *to, int n,
                                                             const struct ring_values *values, double dx, double dy,
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

static KERNEL_WIDE(void, add_leg,
                   (const struct column *to, int n, const struct ring_values *values, double dx, double dy,
                    int has_edge),
                   (to, n, values, dx, dy, has_edge)) {
    add_leg_to(to, n, values, dx, dy, has_edge);
}

// add the change of velocity by a displacement of the source in x or y
static inline __attribute__((always_inline)) void add_displacement(const struct column *to, int n,
                                                                   const struct ring_values *values,
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

static KERNEL_WIDE(void, add_places,
                   (const struct influence_block *block, const struct fish *other, const struct source *source,
                    int first, int n, const struct ring_values *values),
                   (block, other, source, first, n, values)) {
    // a mirror image moves opposite to the source in y, and the leg of the image moves opposite in x
    const double sign = source->image < 0 ? -1 : 1;
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
        add_leg_to(&x, n, values, sign * by, 0, source->has_edge);
        add_leg_to(&y, n, values, 0, by, source->has_edge);
    }
}

// context of the functions below
struct pass {
    const struct flow *flow;
    int f, g, with_places;
    const struct influence_block *block;
};

// the values of a source, or the sum of the values of all its images of one sign
static void unit_of(const struct pass *pass, const struct source *source, int first, int n,
                    struct ring_values *values) {
    const struct flow *const flow = pass->flow;
    const double *const x = flow->x + flow->points[pass->f].first + first;
    const double *const y = flow->y + flow->points[pass->f].first + first;
    const double *const half = flow->school->fish[pass->f].point_half + first;
    if (source->image == 0) {
        ring_unit(&source->pair, &source->ring, n, x, y, half, values);
        return;
    }

    memset(values, 0, sizeof *values);
    for (int k = 0; k < flow->rings->n_images; k++) {
        const struct ring_image *const image = &flow->rings->image[k];
        if (image->sign != source->image) continue;
        struct ring_source ring = source->ring;
        ring.y = image->sign * ring.y + image->shift;
        ring.q *= image->sign;
        ring.dx *= image->sign;
        struct ring_values one;
        ring_unit(&source->pair, &ring, n, x, y, half, &one);
        ring_values_add(&one, image->weight, n, values);
    }
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
static void derive_body(const struct pass *pass, struct range points, const struct ring_pair *pair, double image) {
    const struct fish *const fish = &pass->flow->school->fish[pass->g];
    const struct fish_rings *const of = &pass->flow->rings->fish[pass->g];
    const int is_own = pass->f == pass->g && image == 0;
    const int strength = pass->block->n_columns - 1 - fish->n_sheet, end = points.first + points.n;

    for (int first = points.first; first < end; first += RING_CHUNK) {
        const int n = end - first < RING_CHUNK ? end - first : RING_CHUNK;
        for (int c = 0; c < fish->n_control; c++) {
            const double *const before = fish->integrals->circulation + c;
            const double *const around = fish->integrals->strength + c;
            double along = 0;
            for (int j = 0; j < fish->n_sheet; j++) along += before[j * fish->n_control] * of->own.q[j];

            const struct source source = {.ring = {.x = of->body.x[c],
                                                   .y = of->body.y[c],
                                                   .q = is_own ? 0 : of->body.q[c],
                                                   .dx = of->body.dx[c],
                                                   .dy = of->body.dy[c],
                                                   .half = of->body.half[c]},
                                          .pair = *pair,
                                          .image = image,
                                          .place = &fish->control_point[c],
                                          .follows = 1,
                                          .line = &fish->control_tangent[c].to,
                                          .along = along * fish->control_interval[c],
                                          .has_edge = is_own};

            struct ring_values values;
            unit_of(pass, &source, first, n, &values);

            // by the strengths of the bound vortices
            const double sign = image < 0 ? -1 : 1;
            for (int j = 0; j < fish->n_sheet; j++) {
                const struct column to = column_of(pass->block, strength + j, first);
                const double weight = fish->sheet_weight[j];
                if (!is_own) add_spanwise(&to, n, &values, sign * around[j * fish->n_control] * weight);
                add_leg(&to, n, &values, sign * before[j * fish->n_control] * weight * of->line[0][c],
                        before[j * fish->n_control] * weight * of->line[1][c], is_own);
            }
            if (pass->with_places) add_places(pass->block, fish, &source, first, n, &values);
        }
    }
}

// the legs of a steady wake, which move with the tail
static void derive_steady_legs(const struct pass *pass, const struct ring_sheet *sheet, struct range points,
                               const struct ring_pair *pair, double image) {
    const struct fish *const fish = &pass->flow->school->fish[pass->g];
    const struct fish_rings *const of = &pass->flow->rings->fish[pass->g];
    const struct rings *const rings = &sheet->rings;
    const struct stencil tail = {.n = 1, .node = (const int[]){fish->n_nodes - 1}, .weight = (const double[]){1}};
    const int end = points.first + points.n, has_edge = pass->f == pass->g && image == 0;
    const double sign = image < 0 ? -1 : 1;

    for (int first = points.first; first < end; first += RING_CHUNK) {
        const int n = end - first < RING_CHUNK ? end - first : RING_CHUNK;
        const struct column to = column_of(pass->block, pass->block->n_columns - 1, first);
        for (int i = 0; i < sheet->n_nascent; i++) {
            const struct source source = {.ring = {.x = rings->x[i],
                                                   .y = rings->y[i],
                                                   .dx = rings->dx[i],
                                                   .dy = rings->dy[i],
                                                   .half = rings->half[i],
                                                   .leg = rings->leg[i]},
                                          .pair = *pair,
                                          .image = image,
                                          .place = &tail,
                                          .follows = 1,
                                          .has_edge = has_edge};
            struct ring_values values;
            unit_of(pass, &source, first, n, &values);
            const double by_shed = -ring_sheet_steady_length(sheet, i);
            add_leg(&to, n, &values, sign * by_shed * of->downstream[0], by_shed * of->downstream[1], has_edge);
            if (pass->with_places) add_places(pass->block, fish, &source, first, n, &values);
        }
    }
}

// add the derivatives by one node of fish, for an end of a stretch that moves by the vector `moves` per displacement of
// the node along the vector `way`; the source follows the fraction xi of the motion, the leg -source->along times it
static void add_ring_push(const struct influence_block *block, const struct fish *fish, int node, const double moves[2],
                          const double way[2], double weight, const struct source *source, double xi, int first, int n,
                          const struct ring_values *values) {
    for (int i = 0; i < 2; i++) {
        const struct column to = column_of(block, i * fish->n_nodes + node, first);
        const double x = weight * way[i] * moves[0], y = weight * way[i] * moves[1];
        add_displacement(&to, n, values, source, 0, xi * x);
        add_displacement(&to, n, values, source, 1, xi * y);
        add_leg(&to, n, values, -source->along * x, -source->along * y, source->has_edge);
    }
}

// add the derivatives of a nascent point by the older end of an overtaken stretch: free_sheet.h
static void add_overtaken_ring(const struct influence_block *block, const struct fish *fish,
                               const struct nascent_end *end, const struct source *source, double xi, int first, int n,
                               const struct ring_values *values) {
    const struct stencil *const parts[2] = {&fish->tail_tangent.from, &fish->tail_tangent.to};
    add_ring_push(block, fish, fish->n_nodes - 1, end->tangent, end->tangent, 1, source, xi, first, n, values);
    for (int part = 0; part < 2; part++) {
        for (int i = 0; i < parts[part]->n; i++) {
            const double weight = (part == 0 ? -1 : 1) * parts[part]->weight[i];
            add_ring_push(block, fish, parts[part]->node[i], end->by_turn, end->normal, weight, source, xi, first, n,
                          values);
        }
    }
}

// the nascent points of one view of the wake of fish g at a range of the points of fish f
static void derive_ring_nascent(const struct pass *pass, const struct ring_sheet *sheet, struct range points,
                                const struct ring_pair *pair, double image) {
    const struct flow *const flow = pass->flow;
    if (flow->rings->is_steady) {
        derive_steady_legs(pass, sheet, points, pair, image);
        return;
    }

    const struct fish *const fish = &flow->school->fish[pass->g];
    const struct stencil tail = {.n = 1, .node = (const int[]){fish->n_nodes - 1}, .weight = (const double[]){1}};
    const int n_released = sheet->n_released, end = points.first + points.n;
    const int is_own = pass->f == pass->g && image == 0;
    const double shed = flow->nascent.circulation[pass->g] + flow->rings->fish[pass->g].newest;

    for (int first = points.first; first < end; first += RING_CHUNK) {
        const int n = end - first < RING_CHUNK ? end - first : RING_CHUNK;
        for (int k = 0; k < sheet->n_nascent; k++) {
            const struct rings *const rings = &sheet->rings;
            const int i = n_released + k;
            const double xi = ring_sheet_xi(sheet, k), part = ring_sheet_part(sheet, k);
            // C part; the circulation of the stretch is q/part
            const double along = -(shed - xi * rings->q[i] / part) * part;

            const struct source source = {.ring = {.x = rings->x[i],
                                                   .y = rings->y[i],
                                                   .q = rings->q[i],
                                                   .dx = rings->dx[i],
                                                   .dy = rings->dy[i],
                                                   .half = rings->half[i]},
                                          .pair = *pair,
                                          .image = image,
                                          .place = &tail,
                                          .follows = 1 - xi,
                                          .line = &tail,
                                          .along = -along,
                                          .has_edge = is_own};
            struct ring_values values;
            unit_of(pass, &source, first, n, &values);
            const double sign = image < 0 ? -1 : 1, by_shed = -(1 - xi) * part;
            const struct column to = column_of(pass->block, pass->block->n_columns - 1, first);
            add_spanwise(&to, n, &values, sign * part);
            add_leg(&to, n, &values, sign * by_shed * sheet->way[0], by_shed * sheet->way[1], is_own);
            if (!pass->with_places) continue;
            add_places(pass->block, fish, &source, first, n, &values);
            if (sheet->end.is_overtaken) {
                add_overtaken_ring(pass->block, fish, &sheet->end, &source, xi, first, n, &values);
            }
        }
    }
}

/* Add to an empty block the velocity of all rings of fish g at the points of fish f: by strengths, and with_places also
 * by positions and lines, with the points of f fixed. nascent != 0: only the nascent stretch. */
static void flow_ring_derivative(const struct flow *flow, int f, int g, int with_places, int nascent,
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
        derive_ring_nascent(&pass, &of->wake.graded, control, &exact, 0);
        if (fish_feels_own_wake(fish)) derive_ring_nascent(&pass, &of->wake.middles, behind, &own_wake, 0);
    } else {
        derive_body(&pass, all, &body, 0);
        derive_ring_nascent(&pass, &of->wake.middles, all, &wake, 0);
    }

    // images: mirrored in a wall, and in a channel shifted
    for (int i = 0; i < flow->school->walls.n; i++) {
        const double sign = i == 0 ? -1 : 1;
        if (!nascent) derive_body(&pass, all, &body, sign);
        derive_ring_nascent(&pass, &of->wake.middles, all, &wake, sign);
    }
}

/* Add the derivatives by the motion of the points of fish f in the field of all sources. After flow_gradient. */
static void flow_ring_motion(const struct flow *flow, int f, const struct influence_block *block) {
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

// the derivatives at n points from first on: column c of both components
struct part {
    double *u, *v;
};
static struct part part_of(const struct influence_block *block, int c, int first) {
    const long at = (long)c * block->n_points + first;
    return (struct part){block->u + at, block->v + at};
}

/* Maximum number of sources that move with the same nodes and are evaluated together. */
enum { MOST_TOGETHER = 8 };

// add factors times the derivatives with respect to the positions of n_sources points that move with the same nodes of
// fish other; sign of the motion in y: -1 for mirrored points
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

// add a factor times the derivatives by one node of fish other, for a source that moves by the vector `moves` per
// displacement of the node along the vector `along`
static void add_push(const struct influence_block *block, const struct fish *other, int node, const double moves[2],
                     const double along[2], int first, int n, const struct kernel_values *slope, double factor) {
    const struct part by_x = part_of(block, node, first), by_y = part_of(block, other->n_nodes + node, first);
    for (int i = 0; i < n; i++) {
        const double du = factor * (moves[0] * slope->u_x[i] + moves[1] * slope->u_y[i]);
        const double dv = factor * (moves[0] * slope->v_x[i] - moves[1] * slope->u_x[i]);
        by_x.u[i] += along[0] * du;
        by_x.v[i] += along[0] * dv;
        by_y.u[i] += along[1] * du;
        by_y.v[i] += along[1] * dv;
    }
}

// add the derivatives of a source that follows the older end of an overtaken nascent stretch: free_sheet.h
static void add_overtaken(const struct influence_block *block, const struct fish *fish, const struct nascent_end *end,
                          int first, int n, const struct kernel_values *slope, double factor) {
    const struct stencil *const parts[2] = {&fish->tail_tangent.from, &fish->tail_tangent.to};
    add_push(block, fish, fish->n_nodes - 1, end->tangent, end->tangent, first, n, slope, factor);
    for (int part = 0; part < 2; part++) {
        for (int i = 0; i < parts[part]->n; i++) {
            const double weight = (part == 0 ? -1 : 1) * parts[part]->weight[i] * factor;
            add_push(block, fish, parts[part]->node[i], end->by_turn, end->normal, first, n, slope, weight);
        }
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

// points of fish f, sources of fish g; with_places: derivatives by positions too
struct target {
    const struct flow *flow;
    int f, g, with_places;
    const struct influence_block *block;
};

// one source of the nascent vortex or stretch: fraction of the circulation, and fractions of the motion of the tail and
// of the older end of the stretch (if this end moves with the tail)
struct nascent_source {
    double x, y, smoothing, part, follows, follows_end;
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
            if (source->follows_end > 0) {
                add_overtaken(at->block, other, &flow->free_sheet[at->g].end, first, n, &unit,
                              -source->part * source->follows_end * flow->nascent.circulation[at->g]);
            }
        }
    }
}

// the nascent vortex or stretch of fish g at all points of fish f
static void derive_nascent(const struct target *at) {
    const struct flow *flow = at->flow;
    const struct fish *other = &flow->school->fish[at->g];
    const int n_points = flow->points[at->f].n, is_sheet = flow_has_free_sheets(flow), is_own = at->f == at->g;

    // sources: graded points at the own control points, the middle at all other points; omitted at the points of
    // without_own
    const int n_own = is_sheet && is_own ? other->n_control : 0;
    const int n_unfelt = is_own ? flow->without_own[at->f].n : 0, behind = other->n_control + n_unfelt;
    const struct nascent_source whole = {
        flow->nascent.x[at->g], flow->nascent.y[at->g], other->smoothing, 1, is_sheet ? 0.5 : 1, 0};
    if (n_unfelt == 0) {
        derive_nascent_source(at, (struct range){n_own, n_points - n_own}, &whole);
    } else {
        derive_nascent_source(at, (struct range){n_own, other->n_control - n_own}, &whole);
        derive_nascent_source(at, (struct range){behind, n_points - behind}, &whole);
    }

    const struct free_sheet *const sheet = is_sheet ? &flow->free_sheet[at->g] : NULL;
    for (int i = 0; n_own > 0 && i < FREE_SHEET_PANEL; i++) {
        const int source = sheet->n - (FREE_SHEET_PANEL + 1) + i;
        const struct nascent_source point = {
            sheet->x[source],   sheet->y[source],     0,
            free_sheet_part[i], 1 - free_sheet_xi[i], sheet->end.is_overtaken ? free_sheet_xi[i] : 0};
        derive_nascent_source(at, (struct range){0, n_own}, &point);
    }
}

// number of bound vortices from j on that move with the same nodes
static int n_moving_together(const struct fish *fish, int j) {
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
            n_together = n_moving_together(other, j);
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

// a source of fish g whose images act at all points
struct mirrored_source {
    double x, y, smoothing;
    int column;                  // column of the strength
    double weight, circulation;  // circulation per unit of the unknown, m or 1; circulation, m2 s-1
    const struct stencil *point;
    double follows;  // fraction of the motion of the point
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
                                            .follows = flow_has_free_sheets(flow) ? 0.5 : 1};
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
                                               .smoothing = flow_sheet_smoothing(flow, at->f, at->g),
                                               .column = strength + j,
                                               .weight = other->sheet_weight[j],
                                               .circulation = flow->sheet.circulation[bound],
                                               .point = &other->sheet_point[j],
                                               .follows = 1};
        derive_images_of(at, &source);
    }
}

static void influence_block_clear(const struct influence_block *block) {
    const size_t size = (size_t)block->n_points * (size_t)block->n_columns * sizeof *block->u;
    memset(block->u, 0, size);
    memset(block->v, 0, size);
    if (block->div) memset(block->div, 0, size);
    if (block->edge) memset(block->edge, 0, 2 * size);
}

// sources that move with fish g, at the points of fish f
static void derive_sources(const struct target *at) {
    const struct flow *flow = at->flow;
    const struct fish *fish = &flow->school->fish[at->f];
    influence_block_clear(at->block);
    if (flow->rings) {
        flow_ring_derivative(flow, at->f, at->g, at->with_places, 0, at->block);
        return;
    }

    derive_nascent(at);
    derive_nascent_images(at);
    derive_sheet_images(at);
    if (at->f == at->g) {
        derive_sheet(at, (struct range){0, fish->n_control}, 0);
        derive_sheet(at, (struct range){flow_tail(fish), 1}, fish->sheet_smoothing);
    } else {
        derive_sheet(at, (struct range){0, flow->points[at->f].n}, flow_sheet_smoothing(flow, at->f, at->g));
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

    // the points of a fish move with the own nodes in the field of all sources
    if (flow->rings) {
        flow_ring_motion(flow, f, block);
        return;
    }

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
    influence_block_clear(block);
    if (flow->rings) {
        flow_ring_derivative(flow, f, f, 0, 1, block);
        return;
    }

    const struct target at = {flow, f, f, 0, block};
    derive_nascent(&at);
    derive_nascent_images(&at);
}
