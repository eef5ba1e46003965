/* images.c: one wall: the vortices at mirrored targets; a channel: the closed sums over all images. */
#include "vortex/images.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/mathematics.h"
#include "base/memory.h"

static const double pi = 3.14159265358979323846;

double images_distance(const struct walls *walls, double y) {
    double distance = INFINITY;
    for (int i = 0; i < walls->n; i++) distance = fmin(distance, walls->inward[i] * (y - walls->y[i]));
    return distance;
}

int images_nearest(const struct walls *walls, struct image image[IMAGES_NEAREST]) {
    for (int i = 0; i < walls->n; i++) image[i] = (struct image){-1, 2 * walls->y[i]};
    if (walls->n < 2) return walls->n;
    const double twice = 2 * (walls->y[1] - walls->y[0]);
    image[2] = (struct image){1, twice};
    image[3] = (struct image){1, -twice};
    return 4;
}

// ---- images of rings: sums over k = 1, 2, .. of a function that is analytic for Re k > 0 and decays like 1/k^2

enum {
    RULE_NODES = 8,   // of every Gauss rule
    RULE_PANELS = 8,  // at most; panel i has the terms 4^i < k <= 4^(i+1)
    RULE_REST = 4     // nodes of the integral beyond the last term
};

/* Nodes between the terms, and weights, of a sum over k. */
struct rule {
    int n;
    double node[(RULE_PANELS + 2) * RULE_NODES], weight[(RULE_PANELS + 2) * RULE_NODES];
};

// the terms first < k <= last, by the Gauss rule of the sum
static void rule_add_panel(struct rule *rule, int first, int last, double *scratch) {
    const int n = last - first;
    double *const k = scratch, *const weight = scratch + n;
    for (int i = 0; i < n; i++) {
        k[i] = first + 1 + i;
        weight[i] = 1;
    }

    if (n > RULE_NODES) {
        quadrature_of_sum(n, k, weight, scratch + 2 * n, RULE_NODES, rule->node + rule->n, rule->weight + rule->n);
    } else {
        memcpy(rule->node + rule->n, k, (size_t)n * sizeof *k);
        memcpy(rule->weight + rule->n, weight, (size_t)n * sizeof *k);
    }
    rule->n += n > RULE_NODES ? RULE_NODES : n;
}

// all terms k > first, by the Gauss rule of sum (first/k)^2 f(first/k); the terms beyond last by an integral
static void rule_add_rest(struct rule *rule, int first, int last, double *scratch) {
    const int n = last - first + RULE_REST;
    double *const t = scratch, *const weight = scratch + n, top = first / (last + 0.5);
    quadrature_legendre(RULE_REST, t, weight);
    for (int i = 0; i < RULE_REST; i++) {
        t[i] *= top;
        weight[i] *= first * top;
    }

    for (int i = RULE_REST; i < n; i++) {
        t[i] = first / (double)(first + 1 + i - RULE_REST);
        weight[i] = t[i] * t[i];
    }

    double *const node = rule->node + rule->n, *const of_node = rule->weight + rule->n;
    quadrature_of_sum(n, t, weight, scratch + 2 * n, RULE_NODES, node, of_node);
    for (int i = 0; i < RULE_NODES; i++) {
        of_node[i] /= node[i] * node[i];
        node[i] = first / node[i];
    }
    rule->n += RULE_NODES;
}

// depth: in channel widths. Between the distances H and w an image acts like a point vortex, beyond w like a ring
static enum status rule_find(struct rule *rule, double depth) {
    int n_panels = 0, first = 1;
    for (; n_panels < RULE_PANELS && first < depth / 8; n_panels++) first *= 4;
    const int last = first < 256 ? 1000 : 4 * first;
    double *scratch;
    TRY(MEMORY_NEW(scratch, 4 * (last + RULE_REST), "the images of a channel"));
    *rule = (struct rule){.n = 1, .node = {1}, .weight = {1}};
    for (int i = 0, from = 1; i < n_panels; i++, from *= 4) rule_add_panel(rule, from, 4 * from, scratch);
    rule_add_rest(rule, first, last, scratch);
    free(scratch);
    return STATUS_OK;
}

enum status images_of_rings(const struct walls *walls, double depth, struct ring_image **image, int *n_images) {
    *image = NULL;
    *n_images = 0;
    if (walls->n == 0) return STATUS_OK;
    struct rule rule = {.n = 0};
    const double width = walls->n == 2 ? image_rows_width(walls) : 0;
    if (walls->n == 2) TRY(rule_find(&rule, depth / width));
    *n_images = walls->n == 2 ? 4 * rule.n : walls->n;
    TRY(MEMORY_NEW(*image, *n_images, "the images in walls"));

    if (walls->n == 1) **image = (struct ring_image){-1, 2 * walls->y[0], 1};
    for (int i = 0; i < rule.n; i++) {
        // symmetric about the middle of the channel
        const double sum = walls->y[0] + walls->y[1], shift = 2 * rule.node[i] * width, weight = rule.weight[i];
        struct ring_image *const to = *image + 4L * i;
        to[0] = (struct ring_image){-1, sum - (shift - width), weight};
        to[1] = (struct ring_image){-1, sum + (shift - width), weight};
        to[2] = (struct ring_image){1, shift, weight};
        to[3] = (struct ring_image){1, -shift, weight};
    }
    return STATUS_OK;
}

/* The sources of one sum. */
struct sources {
    int n;
    const double *x, *y, *circulation;
    double smoothing;
};

// ---- one wall: the field of the vortices, mirrored

// add the velocity at n mirrored targets to the targets from first on
static void reflected_add(int n, const struct kernel_values *value, const struct induced *at, int first) {
    for (int i = 0; i < n; i++) {
        at->u[first + i] += value->u[i];
        at->v[first + i] -= value->v[i];
        if (!at->u_x) continue;
        at->u_x[first + i] += value->u_x[i];
        at->u_y[first + i] -= value->u_y[i];
        at->v_x[first + i] -= value->v_x[i];
    }
}

// set the velocity of the sources at n targets
static void sources_induce_directly(const struct sources *s, int n, const double *x, const double *y, int with_gradient,
                                    struct kernel_values *to) {
    memset(to, 0, sizeof *to);
    if (with_gradient) {
        kernel_add_gradient(n, x, y, s->n, s->x, s->y, s->circulation, s->smoothing, to->u, to->v, to->u_x, to->u_y,
                            to->v_x);
    } else {
        kernel_add_velocity(n, x, y, s->n, s->x, s->y, s->circulation, s->smoothing, to->u, to->v);
    }
}

static void wall_induce(double wall, const struct sources *sources, const struct induced *at) {
    double y[KERNEL_CHUNK];
    struct kernel_values there;
    for (int first = 0; first < at->n; first += KERNEL_CHUNK) {
        const int n = at->n - first < KERNEL_CHUNK ? at->n - first : KERNEL_CHUNK;
        for (int i = 0; i < n; i++) y[i] = 2 * wall - at->y[first + i];
        sources_induce_directly(sources, n, at->x + first, y, at->u_x != NULL, &there);
        reflected_add(n, &there, at, first);
    }
}

// ---- a channel: the sum over all images in closed form

static inline void image_rows_add(const struct image_rows *rows, double circulation, const struct induced *at, int i) {
    const struct image_velocity *const a = &rows->shifted, *const b = &rows->mirrored;
    at->u[i] += circulation * (a->u - b->u);
    at->v[i] += circulation * (a->v - b->v);
    if (!at->u_x) return;
    at->u_x[i] += circulation * (a->u_x - b->u_x);
    at->u_y[i] += circulation * (a->u_y - b->u_y);
    at->v_x[i] += circulation * (a->v_x - b->v_x);
}

static double channel_rate(const struct walls *walls) {
    return pi / image_rows_width(walls);
}

static void channel_induce(const struct walls *walls, const struct sources *s, const struct induced *at) {
    struct image_height target[KERNEL_CHUNK];
    const double rate = channel_rate(walls), square = s->smoothing * s->smoothing;
    for (int first = 0; first < at->n; first += KERNEL_CHUNK) {
        const int end = at->n - first < KERNEL_CHUNK ? at->n : first + KERNEL_CHUNK;
        for (int i = first; i < end; i++) target[i - first] = image_height_of(walls, at->y[i]);

        for (int j = 0; j < s->n; j++) {
            const struct image_height source = image_height_of(walls, s->y[j]);
            for (int i = first; i < end; i++) {
                const double r[2] = {at->x[i] - s->x[j], at->y[i] - s->y[j]};
                const struct image_column column = image_column_of(rate, r[0], square);
                const struct image_rows rows =
                    image_rows_of(&column, r, &target[i - first], &source, square, at->u_x != NULL);
                image_rows_add(&rows, s->circulation[j], at, i);
            }
        }
    }
}

// ---- one wall or a channel

static void sources_induce(const struct walls *walls, const struct sources *sources, const struct induced *at) {
    if (walls->n == 1) wall_induce(walls->y[0], sources, at);
    if (walls->n == 2) channel_induce(walls, sources, at);
}

void images_induce(const struct walls *walls, const struct vortices *vortices, struct range which,
                   const struct induced *at) {
    for (int g = 0; g < vortices->n_groups; g++) {
        const struct range of = vortices_of_group(vortices, g, which);
        if (of.n <= 0) continue;
        const struct sources sources = {.n = of.n,
                                        .x = vortices->x + of.first,
                                        .y = vortices->y + of.first,
                                        .circulation = vortices->circulation + of.first,
                                        .smoothing = vortices->group[g].smoothing};

        sources_induce(walls, &sources, at);
    }
}

// ---- all vortices at many targets

static void induce_all_directly(const struct walls *walls, const struct vortices *vortices, int threads,
                                const struct induced *at) {
    const int n_chunks = parallel_n_chunks(at->n);
#pragma omp parallel for num_threads(threads) schedule(static)
    for (int chunk = 0; chunk < n_chunks; chunk++) {
        const struct induced part = vortices_targets(at, parallel_chunk(chunk, at->n));
        images_induce(walls, vortices, (struct range){0, vortices->n}, &part);
    }
}

// add the velocity of all vortices at the mirrored targets, by the tree
static enum status induce_by_tree(double wall, struct velocity_sum *sum, const struct vortices *vortices,
                                  double tolerance, int threads, const struct induced *at) {
    const size_t n = (size_t)at->n;
    double *memory;
    TRY(MEMORY_NEW(memory, 6 * n, "images at points"));

    const struct induced there = {.n = at->n,
                                  .x = at->x,
                                  .y = memory,
                                  .u = memory + n,
                                  .v = memory + 2 * n,
                                  .u_x = at->u_x ? memory + 3 * n : NULL,
                                  .u_y = memory + 4 * n,
                                  .v_x = memory + 5 * n};

    for (size_t i = 0; i < n; i++) memory[i] = 2 * wall - at->y[i];
    const enum status status = velocity_sum_induce(sum, vortices, tolerance, threads, &there);
    for (size_t i = 0; status == STATUS_OK && i < n; i++) {
        at->u[i] += there.u[i];
        at->v[i] -= there.v[i];
        if (!at->u_x) continue;
        at->u_x[i] += there.u_x[i];
        at->u_y[i] -= there.u_y[i];
        at->v_x[i] -= there.v_x[i];
    }

    free(memory);
    return status;
}

int images_by_cells(const struct walls *walls, const struct vortices *vortices, double tolerance,
                    const struct induced *at) {
    return walls->n == 2 && far_images_pay(walls, vortices, tolerance, at);
}

// the images in one wall
static enum status induce_many_by_wall(double wall, struct velocity_sum *sum, const struct vortices *vortices,
                                       double tolerance, int threads, const struct induced *at) {
    if (velocity_sum_by_tree(vortices, at->n, tolerance)) {
        return induce_by_tree(wall, sum, vortices, tolerance, threads, at);
    }
    const struct walls one = {.n = 1, .y = {wall}};
    induce_all_directly(&one, vortices, threads, at);
    return STATUS_OK;
}

enum status images_induce_many(const struct walls *walls, struct velocity_sum *sum, const struct vortices *vortices,
                               double tolerance, int threads, const struct induced *at) {
    if (walls->n == 0 || vortices->n == 0) return STATUS_OK;
    if (walls->n == 1) return induce_many_by_wall(walls->y[0], sum, vortices, tolerance, threads, at);
    if (!images_by_cells(walls, vortices, tolerance, at)) {
        induce_all_directly(walls, vortices, threads, at);
        return STATUS_OK;
    }

    TRY(far_images_induce(velocity_sum_far_images(sum), walls, vortices, tolerance, threads, at));
    for (int i = 0; i < 2; i++) TRY(induce_many_by_wall(walls->y[i], sum, vortices, tolerance, threads, at));
    return STATUS_OK;
}

// ---- one source

static void image_values_put(const struct image_velocity *from, double sign, int i, struct kernel_values *to) {
    to->u[i] = sign * from->u;
    to->v[i] = sign * from->v;
    to->u_x[i] = sign * from->u_x;
    to->u_y[i] = sign * from->u_y;
    to->v_x[i] = sign * from->v_x;
}

void images_unit(const struct walls *walls, int n, const double *x, const double *y, double source_x, double source_y,
                 double smoothing, struct images_values *values) {
    if (walls->n == 1) {
        // the image itself is a source
        memset(&values->shifted, 0, sizeof values->shifted);
        struct kernel_values *const to = &values->mirrored;
        kernel_unit(n, x, y, source_x, 2 * walls->y[0] - source_y, smoothing, to);
        for (int i = 0; i < n; i++)
            image_values_put(&(struct image_velocity){to->u[i], to->v[i], to->u_x[i], to->u_y[i], to->v_x[i]}, -1, i,
                             to);

        return;
    }

    const double rate = channel_rate(walls);
    const struct image_height source = image_height_of(walls, source_y);
    for (int i = 0; i < n; i++) {
        const struct image_height target = image_height_of(walls, y[i]);
        const double r[2] = {x[i] - source_x, y[i] - source_y};
        const struct image_column column = image_column_of(rate, r[0], smoothing * smoothing);
        const struct image_rows rows = image_rows_of(&column, r, &target, &source, smoothing * smoothing, 1);
        image_values_put(&rows.shifted, 1, i, &values->shifted);
        image_values_put(&rows.mirrored, -1, i, &values->mirrored);
    }
}
