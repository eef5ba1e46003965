/* flow_derivative.c: each source contributes by its strength, by its leg, and by the nodes that move it. Most of the
 * code treats four sources at a time, because blocks are read and written once for all of them. */
#include "flow/flow_derivative.h"

#include <stddef.h>
#include <string.h>

#include "base/wide.h"
#include "flow/images.h"

// ---- what one source contributes

// one column of a block, from point `first` on; NULL: not in the block
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

// a source of fish g, as the points of fish f see it
struct moving {
    struct source at;
    struct kernel_pair pair;
    double image;                 // sign of the images that are summed (images.c); 0: the source itself
    const struct stencil *place;  // the nodes that move the source, of whose motion it follows this fraction
    double follows;
    const struct stencil *line;  // the leg is d = along times the vector along the body, or to the tail
    double along;
    bool has_edge;  // whether the source is part of the edge force
};

static void add_spanwise(const struct column *to, int n, const struct unit_values *values, double factor) {
    for (int i = 0; i < n; i++) {
        to->u[i] += factor * values->unit_u[i];
        to->v[i] += factor * values->unit_v[i];
    }
}

static inline __attribute__((always_inline)) void add_leg_to(const struct column *to, int n,
                                                             const struct unit_values *values, double dx, double dy,
                                                             bool has_edge) {
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

static WIDE(void, add_leg,
            (const struct column *to, int n, const struct unit_values *values, double dx, double dy, bool has_edge),
            (to, n, values, dx, dy, has_edge)) {
    add_leg_to(to, n, values, dx, dy, has_edge);
}

// add what a displacement of the source in x or y changes
static inline __attribute__((always_inline)) void add_displacement(const struct column *to, int n,
                                                                   const struct unit_values *values,
                                                                   const struct moving *source, int in_y, double by) {
    const double *const u = in_y ? values->u_y : values->u_x, *const v = in_y ? values->v_y : values->v_x,
                        *const div = in_y ? values->div_y : values->div_x,
                        *const edge = in_y ? values->edge_y : values->edge_x;

    for (int i = 0; i < n; i++) {
        to->u[i] -= by * u[i];
        to->v[i] -= by * v[i];
    }

    for (int i = 0; i < n && to->div; i++) to->div[i] -= by * div[i];
    for (int i = 0; i < n && to->edge[0] && source->has_edge; i++) {
        to->edge[0][i] -= by * edge[i] * source->at.dx;
        to->edge[1][i] -= by * edge[i] * source->at.dy;
    }
}

static WIDE(void, add_places,
            (const struct influence_block *block, const struct fish *other, const struct moving *source, int first,
             int n, const struct unit_values *values),
            (block, other, source, first, n, values)) {
    // a mirror image moves opposite to the source in y, and its leg is opposite in x
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

// what all functions below need to know
struct pass {
    const struct flow *flow;
    int f, g, with_places;
    const struct influence_block *block;
};

// the values of a source, or the sum over all its images of one sign
static void unit_of(const struct pass *pass, const struct moving *source, int first, int n,
                    struct unit_values *values) {
    const struct flow *const flow = pass->flow;
    const double *const x = flow->x + flow->points[pass->f].first + first;
    const double *const y = flow->y + flow->points[pass->f].first + first;
    const double *const half = flow->kernel->has_legs ? flow->school->fish[pass->f].point_half + first : NULL;
    if (source->image == 0) {
        kernel_unit(&source->pair, &source->at, n, x, y, half, values);
        return;
    }

    memset(values, 0, sizeof *values);
    for (int k = 0; k < flow->n_images; k++) {
        const struct image *const image = &flow->image[k];
        if (image->sign * source->image < 0) continue;
        struct source at = source->at;
        at.y = image->sign * at.y + image->shift;
        at.q *= image->sign;
        at.dx *= image->sign;
        struct unit_values one;
        kernel_unit(&source->pair, &at, n, x, y, half, &one);
        kernel_values_add(&source->pair, &one, image->weight, n, values);
    }
}

/* Up to four neighbouring sources of a body. The derivatives by a node or a strength are read and written once for all
 * four. Where a source is missing, values and weights are 0. */
enum { FOUR = 4 };
struct four {
    int n;
    struct moving source[FOUR];
    _Alignas(64) struct unit_values values[FOUR];
};

/* Some columns of a block, each at n_points points, and the weights of the four sources in each of them. */
enum { COLUMNS = 64 };
struct four_weights {
    int n_points, n_columns;
    const int *column; /* numbers of the columns; NULL: they are consecutive */
    long stride;       /* from one column to the next */
    double of[COLUMNS][FOUR];
};

// Groups of points, beginning at the points `begin`, stay in registers while all columns pass by; groups may overlap.
enum { MOST = 3 };
static inline __attribute__((always_inline)) void add_weighted_groups(const int n, const int begin[MOST],
                                                                      const struct four_weights *weights, double factor,
                                                                      const double *value, long apart, double *to) {
    wide_lanes v[FOUR][MOST];
#pragma GCC unroll 4
    for (int k = 0; k < FOUR; k++) {
#pragma GCC unroll 3
        for (int i = 0; i < n; i++) v[k][i] = *(const wide_lanes *)(value + k * apart + begin[i]);
    }
    for (int c = 0; c < weights->n_columns; c++) {
        double *const at = to + (weights->column ? weights->column[c] : c) * weights->stride, by[FOUR];
#pragma GCC unroll 4
        for (int k = 0; k < FOUR; k++) by[k] = factor * weights->of[c][k];
        wide_lanes sum[MOST];
#pragma GCC unroll 3
        for (int i = 0; i < n; i++) {
            sum[i] = *(const wide_lanes *)(at + begin[i]);
            sum[i] += by[0] * v[0][i] + by[1] * v[1][i] + by[2] * v[2][i] + by[3] * v[3][i];
        }
#pragma GCC unroll 3
        for (int i = 0; i < n; i++) *(wide_lanes *)(at + begin[i]) = sum[i];
    }
}

// Add to all columns `factor` times the weighted sum of the values of the four sources; apart: how far the values of
// two sources are apart, in numbers.
static WIDE(void, add_weighted,
            (const struct four_weights *weights, double factor, const double *value, long apart, double *to),
            (weights, factor, value, apart, to)) {
    const int n = weights->n_points;
    for (int c = 0; c < weights->n_columns && n < WIDE_LANES; c++) {
        double *const at = to + (weights->column ? weights->column[c] : c) * weights->stride, by[FOUR];
        for (int k = 0; k < FOUR; k++) by[k] = factor * weights->of[c][k];
        for (int p = 0; p < n; p++) {
            const double *const v = value + p;
            at[p] += by[0] * v[0] + by[1] * v[apart] + by[2] * v[2 * apart] + by[3] * v[3 * apart];
        }
    }

    // two groups at a time; the points that are left form a group that overlaps the last full one
    const int n_full = n / WIDE_LANES, has_rest = n % WIDE_LANES > 0;
    for (int done = 0; done < n_full;) {
        int begin[MOST], groups = 0;
        while (groups < MOST - 1 && done < n_full) begin[groups++] = WIDE_LANES * done++;
        if (done == n_full && has_rest) begin[groups++] = n - WIDE_LANES;
        switch (groups) {
            case 1: add_weighted_groups(1, begin, weights, factor, value, apart, to); break;
            case 2: add_weighted_groups(2, begin, weights, factor, value, apart, to); break;
            default: add_weighted_groups(3, begin, weights, factor, value, apart, to);
        }
    }
}

static void add_four_places(const struct influence_block *block, const struct fish *other, const struct four *four,
                            int first, int n) {
    const struct moving *const source = four->source;
    const struct stencil *const place = source[0].place;
    const struct unit_values *const v = four->values;
    const long apart = sizeof *v / sizeof(double);
    const double sign = source[0].image < 0 ? -1 : 1;
    const struct column x = column_of(block, 0, first), y = column_of(block, other->n_nodes, first);
    for (int begin = 0; begin < place->n; begin += COLUMNS) {
        struct four_weights by = {.n_points = n,
                                  .n_columns = place->n - begin < COLUMNS ? place->n - begin : COLUMNS,
                                  .column = place->node + begin,
                                  .stride = block->n_points};
        struct four_weights along = by;
        for (int i = 0; i < by.n_columns; i++) {
            for (int k = 0; k < four->n; k++) {
                by.of[i][k] = source[k].follows * source[k].place->weight[begin + i];
                along.of[i][k] = source[k].line ? source[k].along * source[k].line->weight[begin + i] : 0;
            }
        }

        add_weighted(&by, -1, v->u_x, apart, x.u);
        add_weighted(&by, -1, v->v_x, apart, x.v);
        add_weighted(&by, -sign, v->u_y, apart, y.u);
        add_weighted(&by, -sign, v->v_y, apart, y.v);
        if (!source[0].line) continue;

        // the legs; without them div is 0
        add_weighted(&along, sign, v->leg, apart, x.v);
        add_weighted(&along, -1, v->leg, apart, y.u);
        if (!block->div) continue;
        add_weighted(&along, 1, v->div_by_dy, apart, y.div);
        add_weighted(&by, -sign, v->div_y, apart, y.div);
        add_weighted(&along, sign, v->div_by_dx, apart, x.div);
        add_weighted(&by, -1, v->div_x, apart, x.div);
    }
}

// Add the velocity of four control points by the strengths of all bound vortices, from column `strength` on. Per
// circulation of a vortex, `around` is the circulation of the interval (NULL: none) and `before` the one before the
// point (NULL: there are no legs). line: of the four points.
static void add_four_strengths(const struct influence_block *block, const struct fish *fish, int strength, int first,
                               int n, const struct four *four, const double *around, const double *before,
                               double *const line[2], bool has_edge) {
    const double sign = four->source[0].image < 0 ? -1 : 1;
    const struct unit_values *const v = four->values;
    const long apart = sizeof *v / sizeof(double);

    // the legs of a unit circulation
    double u[FOUR][KERNEL_CHUNK] = {{0}}, w[FOUR][KERNEL_CHUNK] = {{0}}, div[FOUR][KERNEL_CHUNK] = {{0}};
    double dx[FOUR] = {0}, dy[FOUR] = {0};
    for (int k = 0; k < four->n && before; k++) {
        dx[k] = sign * line[0][k];
        dy[k] = line[1][k];
        for (int p = 0; p < n; p++) {
            u[k][p] = -v[k].leg[p] * dy[k];
            w[k][p] = v[k].leg[p] * dx[k];
            div[k][p] = v[k].div_by_dx[p] * dx[k] + v[k].div_by_dy[p] * dy[k];
        }
    }

    for (int begin = 0; begin < fish->n_sheet; begin += COLUMNS) {
        const struct column to = column_of(block, strength + begin, first);
        const int left = fish->n_sheet - begin;
        struct four_weights part = {
            .n_points = n, .n_columns = left < COLUMNS ? left : COLUMNS, .stride = block->n_points};
        for (int j = 0; j < part.n_columns && around; j++) {
            for (int k = 0; k < four->n; k++) {
                part.of[j][k] = sign * around[(begin + j) * fish->n_control + k] * fish->sheet_weight[begin + j];
            }
        }
        if (around) add_weighted(&part, 1, v->unit_u, apart, to.u);
        if (around) add_weighted(&part, 1, v->unit_v, apart, to.v);
        if (!before) continue;

        for (int j = 0; j < part.n_columns; j++) {
            for (int k = 0; k < four->n; k++) {
                part.of[j][k] = before[(begin + j) * fish->n_control + k] * fish->sheet_weight[begin + j];
            }
        }
        add_weighted(&part, 1, u[0], KERNEL_CHUNK, to.u);
        add_weighted(&part, 1, w[0], KERNEL_CHUNK, to.v);
        if (to.div) add_weighted(&part, 1, div[0], KERNEL_CHUNK, to.div);
        for (int j = 0; j < part.n_columns && block->edge && has_edge; j++) {
            const struct column edge = column_of(block, strength + begin + j, first);
            for (int k = 0; k < four->n; k++) {
                for (int p = 0; p < n; p++) {
                    edge.edge[0][p] += part.of[j][k] * dx[k] * v[k].edge[p];
                    edge.edge[1][p] += part.of[j][k] * dy[k] * v[k].edge[p];
                }
            }
        }
    }
}

// add the derivatives by places for the sources gathered so far
static void four_finish(struct four *four, const struct influence_block *block, const struct fish *other, int first,
                        int n) {
    // together: all of them move with the same nodes, and none is part of the edge force
    const struct stencil *const place = four->source[0].place, *const line = four->source[0].line;
    bool together = !(block->edge && four->source[0].has_edge);
    for (int k = 0; k < four->n; k++) {
        const struct moving *const source = &four->source[k];
        together &= source->place->node == place->node && source->place->n == place->n;
        together &= !line || (source->line->node == place->node && source->line->n == place->n);
    }
    if (together) add_four_places(block, other, four, first, n);
    for (int k = 0; k < four->n && !together; k++) {
        add_places(block, other, &four->source[k], first, n, &four->values[k]);
    }
}

static void derive_bound(const struct pass *pass, struct range points, const struct kernel_pair *pair) {
    const struct fish *const fish = &pass->flow->school->fish[pass->g];
    const struct sources *const own = &pass->flow->fish[pass->g].own;
    const int strength = pass->block->n_columns - 1 - fish->n_sheet, end = points.first + points.n;

    for (int first = points.first; first < end; first += KERNEL_CHUNK) {
        const int n = end - first < KERNEL_CHUNK ? end - first : KERNEL_CHUNK;
        struct four four;
        memset(&four, 0, sizeof four);
        for (int j = 0; j < fish->n_sheet; j++) {
            const int k = j % FOUR;
            four.source[k] =
                (struct moving){.at = {.x = own->x[j], .y = own->y[j], .q = own->q[j], .half = own->half[j]},
                                .pair = *pair,
                                .place = &fish->sheet_point[j],
                                .follows = 1};
            unit_of(pass, &four.source[k], first, n, &four.values[k]);
            const struct column to = column_of(pass->block, strength + j, first);
            add_spanwise(&to, n, &four.values[k], fish->sheet_weight[j]);
            four.n = k + 1;
            const bool is_full = four.n == FOUR || j == fish->n_sheet - 1;
            if (pass->with_places && is_full) four_finish(&four, pass->block, fish, first, n);
        }
    }
}

// the body of fish g at a range of the points of fish f; in its own strip only the legs, because derive_bound has the
// rest
static void derive_body(const struct pass *pass, struct range points, const struct kernel_pair *pair, double image) {
    const struct fish *const fish = &pass->flow->school->fish[pass->g];
    const struct flow_fish *const of = &pass->flow->fish[pass->g];
    const bool is_own = pass->f == pass->g && image == 0, has_legs = pass->flow->kernel->has_legs;
    const int strength = pass->block->n_columns - 1 - fish->n_sheet, end = points.first + points.n;
    const double sign = image < 0 ? -1 : 1;

    for (int first = points.first; first < end; first += KERNEL_CHUNK) {
        const int n = end - first < KERNEL_CHUNK ? end - first : KERNEL_CHUNK;
        struct four four;
        memset(&four, 0, sizeof four);
        for (int c = 0; c < of->body.n; c++) {
            const int k = c % FOUR;
            four.source[k] = (struct moving){.at = {.x = of->body.x[c],
                                                    .y = of->body.y[c],
                                                    .q = is_own ? 0 : of->body.q[c],
                                                    .dx = of->body.dx[c],
                                                    .dy = of->body.dy[c],
                                                    .half = of->body.half[c]},
                                             .pair = *pair,
                                             .image = image,
                                             .place = fish->integrals ? &fish->control_point[c] : &fish->sheet_point[c],
                                             .follows = 1,
                                             .has_edge = is_own};
            if (has_legs) {
                double along = 0;
                for (int j = 0; j < fish->n_sheet; j++) {
                    along += fish->integrals->circulation[j * fish->n_control + c] * of->own.q[j];
                }
                four.source[k].line = &fish->control_tangent[c].to;
                four.source[k].along = along * fish->control_interval[c];
            }
            unit_of(pass, &four.source[k], first, n, &four.values[k]);
            four.n = k + 1;
            if (!fish->integrals) {
                const struct column to = column_of(pass->block, strength + c, first);
                add_spanwise(&to, n, &four.values[k], sign * fish->sheet_weight[c]);
            }
            if (four.n < FOUR && c < of->body.n - 1) continue;

            const int begin = c - k;
            if (fish->integrals) {
                double *const line[2] = {has_legs ? of->line[0] + begin : NULL, has_legs ? of->line[1] + begin : NULL};
                add_four_strengths(pass->block, fish, strength, first, n, &four,
                                   is_own ? NULL : fish->integrals->strength + begin,
                                   has_legs ? fish->integrals->circulation + begin : NULL, line, is_own);
            }
            if (pass->with_places) four_finish(&four, pass->block, fish, first, n);
        }
    }
}

// the legs of a steady wake, which move with the tail
static void derive_steady_legs(const struct pass *pass, const struct sheet_points *sheet, struct range points,
                               const struct kernel_pair *pair, double image) {
    const struct fish *const fish = &pass->flow->school->fish[pass->g];
    const struct flow_fish *const of = &pass->flow->fish[pass->g];
    const struct sources *const sources = &sheet->sources;
    const struct stencil tail = {.n = 1, .node = (const int[]){fish->n_nodes - 1}, .weight = (const double[]){1}};
    const int end = points.first + points.n, has_edge = pass->f == pass->g && image == 0;
    const double sign = image < 0 ? -1 : 1;

    for (int first = points.first; first < end; first += KERNEL_CHUNK) {
        const int n = end - first < KERNEL_CHUNK ? end - first : KERNEL_CHUNK;
        const struct column to = column_of(pass->block, pass->block->n_columns - 1, first);
        for (int i = 0; i < sheet->n_nascent; i++) {
            const struct moving source = {.at = {.x = sources->x[i],
                                                 .y = sources->y[i],
                                                 .dx = sources->dx[i],
                                                 .dy = sources->dy[i],
                                                 .half = sources->half[i],
                                                 .leg = sources->leg[i]},
                                          .pair = *pair,
                                          .image = image,
                                          .place = &tail,
                                          .follows = 1,
                                          .has_edge = has_edge};
            struct unit_values values;
            unit_of(pass, &source, first, n, &values);
            const double by_shed = -sheet->part[i];
            add_leg(&to, n, &values, sign * by_shed * of->downstream[0], by_shed * of->downstream[1], has_edge);
            if (pass->with_places) add_places(pass->block, fish, &source, first, n, &values);
        }
    }
}

// Add the derivatives by one node of fish, for an end of a stretch that moves by the vector `moves` if the node moves
// by one along the vector `way`. The source follows the fraction xi of this motion, and its leg -source->along times
// it.
static void add_push(const struct influence_block *block, const struct fish *fish, int node, const double moves[2],
                     const double way[2], double weight, const struct moving *source, double xi, int first, int n,
                     const struct unit_values *values) {
    for (int i = 0; i < 2; i++) {
        const struct column to = column_of(block, i * fish->n_nodes + node, first);
        const double x = weight * way[i] * moves[0], y = weight * way[i] * moves[1];
        add_displacement(&to, n, values, source, 0, xi * x);
        add_displacement(&to, n, values, source, 1, xi * y);
        if (source->line) add_leg(&to, n, values, -source->along * x, -source->along * y, source->has_edge);
    }
}

// add the derivatives of a nascent point by the older end of a stretch that the tail has overtaken (wake/sheet.h)
static void add_overtaken(const struct influence_block *block, const struct fish *fish, const struct nascent_end *end,
                          const struct moving *source, double xi, int first, int n, const struct unit_values *values) {
    const struct stencil *const parts[2] = {&fish->tail_tangent.from, &fish->tail_tangent.to};
    add_push(block, fish, fish->n_nodes - 1, end->tangent, end->tangent, 1, source, xi, first, n, values);
    for (int part = 0; part < 2; part++) {
        for (int i = 0; i < parts[part]->n; i++) {
            const double weight = (part == 0 ? -1 : 1) * parts[part]->weight[i];
            add_push(block, fish, parts[part]->node[i], end->by_turn, end->normal, weight, source, xi, first, n,
                     values);
        }
    }
}

// the nascent points of one view of the wake of fish g, at a range of the points of fish f
static void derive_nascent(const struct pass *pass, const struct sheet_points *sheet, struct range points,
                           const struct kernel_pair *pair, double image) {
    const struct flow *const flow = pass->flow;
    if (flow->is_steady) {
        derive_steady_legs(pass, sheet, points, pair, image);
        return;
    }

    const struct fish *const fish = &flow->school->fish[pass->g];
    const struct stencil tail = {.n = 1, .node = (const int[]){fish->n_nodes - 1}, .weight = (const double[]){1}};
    const int n_released = sheet->n_released, end = points.first + points.n;
    const bool is_own = pass->f == pass->g && image == 0;
    const double shed = flow->fish[pass->g].nascent + flow->fish[pass->g].newest;
    const bool has_legs = flow->kernel->has_legs;

    for (int first = points.first; first < end; first += KERNEL_CHUNK) {
        const int n = end - first < KERNEL_CHUNK ? end - first : KERNEL_CHUNK;
        for (int k = 0; k < sheet->n_nascent; k++) {
            const struct sources *const sources = &sheet->sources;
            const int i = n_released + k;
            const double xi = sheet->xi[i], part = sheet->part[i];
            // C part, where the circulation of the stretch is q/part
            const double along = -(shed - xi * sources->q[i] / part) * part;

            const struct moving source = {.at = {.x = sources->x[i],
                                                 .y = sources->y[i],
                                                 .q = sources->q[i],
                                                 .dx = sources->dx[i],
                                                 .dy = sources->dy[i],
                                                 .half = sources->half[i]},
                                          .pair = *pair,
                                          .image = image,
                                          .place = &tail,
                                          .follows = 1 - xi,
                                          .line = has_legs ? &tail : NULL,
                                          .along = -along,
                                          .has_edge = is_own};
            struct unit_values values;
            unit_of(pass, &source, first, n, &values);
            const double sign = image < 0 ? -1 : 1, by_shed = -(1 - xi) * part;
            const struct column to = column_of(pass->block, pass->block->n_columns - 1, first);
            add_spanwise(&to, n, &values, sign * part);
            if (has_legs) add_leg(&to, n, &values, sign * by_shed * sheet->way[0], by_shed * sheet->way[1], is_own);
            if (!pass->with_places) continue;
            add_places(pass->block, fish, &source, first, n, &values);
            if (sheet->end.is_overtaken) {
                add_overtaken(pass->block, fish, &sheet->end, &source, xi, first, n, &values);
            }
        }
    }
}

// add what changes because the points of fish f move in the field of all sources
static void derive_points(const struct flow *flow, int f, const struct influence_block *block) {
    const struct fish *const fish = &flow->school->fish[f];
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
            *y.v += w * (flow->div[at] - flow->u_x[at]);
            if (!block->div) continue;
            *x.div += w * flow->div_x[at];
            *y.div += w * flow->div_y[at];
            for (int k = 0; k < 2 && block->edge; k++) {
                const double *const gradient = flow->edge_gradient + (long)2 * k * flow->n_points + at;
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

void flow_derivative(const struct flow *flow, int f, int g, enum flow_columns columns, struct influence_block *block) {
    const struct fish *const other = &flow->school->fish[g];
    const bool nascent = columns == COLUMN_OF_SHED, with_places = columns == COLUMNS_OF_ALL;
    block->n_points = flow->points[f].n;
    block->n_columns = nascent ? 1 : with_places ? flow_n_columns(other) : other->n_sheet + 1;
    const size_t size = (size_t)block->n_points * (size_t)block->n_columns * sizeof *block->u;
    memset(block->u, 0, size);
    memset(block->v, 0, size);
    if (block->div) memset(block->div, 0, size);
    if (block->edge) memset(block->edge, 0, 2 * size);

    const struct pass pass = {flow, f, g, with_places, block};
    const struct fish *const fish = &flow->school->fish[f];
    const struct sheet *const sheet = &flow->fish[g].wake;
    const struct flow_class *const target = &flow->classes[flow->class_of[f]];
    const struct flow_class *const source = &flow->classes[flow->class_of[g]];
    const int n_points = flow->points[f].n;
    const bool is_sheet = flow_has_free_sheets(flow), has_legs = flow->kernel->has_legs;
    const double depth = other->strip_depth, square = flow_square(flow, WAKE_AT_BODY, target, source);
    const struct kernel_pair exact = flow->kernel->own(depth, 0), own_wake = flow->kernel->own(depth, square);
    const struct kernel_pair wake = flow->kernel->other(depth, square);
    const struct kernel_pair body = flow->kernel->other(depth, flow_square(flow, BODY_AT_BODY, target, source));
    const struct range control = {0, fish->n_control}, middles = {flow_midpoint(fish, 0), fish->n_edges};
    const struct range tail = {flow_tail(fish), 1}, all = {0, n_points};

    if (f == g) {
        const struct kernel_pair bound = flow->kernel->own(depth, flow_square(flow, BODY_AT_WAKE, target, source));
        if (!nascent) derive_bound(&pass, control, &exact);
        if (!nascent && !is_sheet) derive_bound(&pass, tail, &bound);
        if (!nascent && has_legs) derive_body(&pass, control, &exact, 0);
        derive_nascent(&pass, is_sheet ? &sheet->graded : &sheet->middles, control, is_sheet ? &exact : &own_wake, 0);
        if (fish_feels_own_wake(fish)) derive_nascent(&pass, &sheet->middles, middles, &own_wake, 0);
        derive_nascent(&pass, &sheet->middles, tail, &own_wake, 0);
    } else {
        derive_body(&pass, all, &body, 0);
        derive_nascent(&pass, &sheet->middles, all, &wake, 0);
    }

    // images in each wall: mirrored ones, and in a channel also shifted ones
    for (int i = 0; i < flow->school->walls.n; i++) {
        const double sign = i == 0 ? -1 : 1;
        if (!nascent) derive_body(&pass, all, &body, sign);
        derive_nascent(&pass, &sheet->middles, all, &wake, sign);
    }

    if (with_places && f == g) derive_points(flow, f, block);
}
