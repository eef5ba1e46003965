/* kernel.c: the two kernels. With finite span a pair takes one root and one division, which in mutual sums serve both
 * directions; with infinite span two pairs share a division. */
#include "flow/kernel.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>
#if defined(__x86_64__)
#include <immintrin.h>
#elif defined(__aarch64__)
#include <arm_neon.h>
#endif

#include "base/wide.h"

static const double inverse_two_pi = 0.159154943091895335769;

/* Avoids 0/0 in the spanwise part of a source at a target. It is so small that it changes no bit at distances that
 * matter. */
static const double no_square = 1e-150;

enum { HALF = KERNEL_BLOCK / 2 };

struct targets kernel_targets_part(const struct targets *all, struct range which) {
    struct targets part = *all;
    const double **const given[] = {&part.x, &part.y, &part.half, &part.leg, &part.square};
    double **const sums[] = {&part.u,   &part.v,   &part.leg_u, &part.leg_v, &part.div,  &part.u_x,
                             &part.u_y, &part.v_x, &part.div_x, &part.div_y, &part.edge, &part.edge_gradient};
    part.n = which.n;

    for (size_t i = 0; i < sizeof given / sizeof *given; i++) {
        if (*given[i]) *given[i] += which.first;
    }

    for (size_t i = 0; i < sizeof sums / sizeof *sums; i++) {
        if (*sums[i]) *sums[i] += which.first;
    }

    return part;
}

struct targets kernel_targets(int n, const double *x, const double *y, double *const sum[KERNEL_SUMS]) {
    return (struct targets){.n = n,
                            .x = x,
                            .y = y,
                            .u = sum[KERNEL_U],
                            .v = sum[KERNEL_V],
                            .div = sum[KERNEL_DIV],
                            .u_x = sum[KERNEL_U_X],
                            .u_y = sum[KERNEL_U_Y],
                            .v_x = sum[KERNEL_V_X],
                            .div_x = sum[KERNEL_DIV_X],
                            .div_y = sum[KERNEL_DIV_Y]};
}

// ---- velocity, divergence and gradients

#if defined(__x86_64__)

#define VARIANT(name) name##_avx512
#define TARGET __attribute__((target("avx512f")))
#define lanes __m512d
#define FUSED(a, b, c) _mm512_fmadd_pd(a, b, c)
#define ROOT(a) _mm512_sqrt_pd(a)
#include "flow/kernel_loops.h"

#define VARIANT(name) name##_avx2
#define TARGET __attribute__((target("avx2,fma")))
#define lanes __m256d
#define FUSED(a, b, c) _mm256_fmadd_pd(a, b, c)
#define ROOT(a) _mm256_sqrt_pd(a)
#include "flow/kernel_loops.h"

#elif defined(__aarch64__)

#define VARIANT(name) name##_neon
#define TARGET
#define lanes float64x2_t
#define FUSED(a, b, c) vfmaq_f64(c, a, b)
#define ROOT(a) vsqrtq_f64(a)
#include "flow/kernel_loops.h"

#endif

// any processor: vectors of two doubles, products without fusion
typedef double two __attribute__((vector_size(2 * sizeof(double))));
#define VARIANT(name) name##_baseline
#define TARGET
#define lanes two
#define FUSED(a, b, c) ((a) * (b) + (c))
#define ROOT(a) ((two){sqrt((a)[0]), sqrt((a)[1])})
#include "flow/kernel_loops.h"

static const struct kernel_loops *loops_finite(int i) {
    const struct kernel_loops *found[3];
    int n = 0;
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx512f")) found[n++] = &loops_avx512;
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) found[n++] = &loops_avx2;
#elif defined(__aarch64__)
    found[n++] = &loops_neon;
#endif
    found[n++] = &loops_baseline;
    return i < n ? found[i] : NULL;
}

static const struct kernel_loops *loops_infinite(int i) {
    const struct kernel_loops *found[3];
    int n = 0;
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx512f")) found[n++] = &loops_infinite_avx512;
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) found[n++] = &loops_infinite_avx2;
#elif defined(__aarch64__)
    found[n++] = &loops_infinite_neon;
#endif
    found[n++] = &loops_infinite_baseline;
    return i < n ? found[i] : NULL;
}

static WIDE(void, block_edge, (struct kernel_block * at, const struct block_sources *from, bool with_gradient),
            (at, from, with_gradient)) {
    const double scale = from->span * inverse_two_pi;
    for (int n = 0; n < from->n; n++) {
        const double x = from->x[n], y = from->y[n], dx = from->dx[n] * scale, dy = from->dy[n] * scale;
        const double half = from->factor * from->half[n] + from->leg[n];
        double factor[KERNEL_BLOCK];
        for (int i = 0; i < KERNEL_BLOCK; i++) {
            const double rx = at->x[i] - x, ry = at->y[i] - y, t = rx * rx + ry * ry + (at->half[i] + half);
            factor[i] = -1.5 / (t * t * sqrt(t));
            at->edge[0][i] += factor[i] * dx;
            at->edge[1][i] += factor[i] * dy;
        }
        if (!with_gradient) continue;

        for (int i = 0; i < KERNEL_BLOCK; i++) {
            const double rx = at->x[i] - x, ry = at->y[i] - y, t = rx * rx + ry * ry + (at->half[i] + half);
            const double slope = -5 * factor[i] / t;
            at->edge_gradient[0][i] += slope * rx * dx;
            at->edge_gradient[1][i] += slope * ry * dx;
            at->edge_gradient[2][i] += slope * rx * dy;
            at->edge_gradient[3][i] += slope * ry * dy;
        }
    }
}

static void fill_block(struct kernel_block *block, const struct kernel_pair *pair, const struct targets *at, int first,
                       int n) {
    if (at->edge) {
        memset(block->edge, 0, sizeof block->edge);
        memset(block->edge_gradient, 0, sizeof block->edge_gradient);
    }
    block->n = n;
    block->has_squares = at->square != NULL;
    for (int i = 0; i < KERNEL_BLOCK; i++) {
        // pad with a place beside the last target, so that no two targets of one division are at the same source
        const int p = first + (i < n ? i : n - 1);
        block->x[i] = at->x[p] + (i < n ? 0 : 1);
        block->y[i] = at->y[p];
        block->half[i] = (at->half ? pair->factor * at->half[p] : 0) + (at->leg ? at->leg[p] : 0);
        block->square[i] = (at->square ? at->square[p] : 0) + no_square;
    }
}

// add a factor times n sums to an array, if there is one
static void add_sum(int n, double factor, const double *from, double *to) {
    for (int i = 0; i < n && to; i++) to[i] += factor * from[i];
}

static void add_block(const struct kernel_block *block, const struct kernel_pair *pair, const struct targets *all,
                      int first, int n) {
    const struct targets at = kernel_targets_part(all, (struct range){first, n});
    const bool has_gradient = at.u_x != NULL;
    add_sum(n, 1, block->u, at.u);
    add_sum(n, 1, block->v, at.v);
    if (has_gradient) {
        add_sum(n, 1, block->u_x, at.u_x);
        add_sum(n, 1, block->u_y, at.u_y);
        add_sum(n, 1, block->v_x, at.v_x);
    }
    if (!pair->kernel->has_legs) return;

    // the loops sum only a third of the divergence
    add_sum(n, 1, block->leg_u, at.u);
    add_sum(n, 1, block->leg_v, at.v);
    add_sum(n, 1, block->leg_u, at.leg_u);
    add_sum(n, 1, block->leg_v, at.leg_v);
    add_sum(n, 3, block->div, at.div);
    if (has_gradient) {
        add_sum(n, 1, block->div_x, at.div_x);
        add_sum(n, 1, block->div_y, at.div_y);
    }
    for (int k = 0; k < 2 && at.edge; k++) add_sum(n, 1, block->edge[k], at.edge + k * at.edge_stride);
    for (int k = 0; k < 4 && at.edge_gradient; k++) {
        add_sum(n, 1, block->edge_gradient[k], at.edge_gradient + k * at.edge_stride);
    }
}

static struct block_sources block_sources_of(const struct kernel_pair *pair, const struct sources *sources,
                                             struct range which) {
    return (struct block_sources){.n = which.n,
                                  .x = sources->x + which.first,
                                  .y = sources->y + which.first,
                                  .q = sources->q + which.first,
                                  .dx = sources->dx + which.first,
                                  .dy = sources->dy + which.first,
                                  .half = sources->half + which.first,
                                  .leg = sources->leg + which.first,
                                  .square = sources->square + which.first,
                                  .span = pair->span,
                                  .factor = pair->factor,
                                  .add = pair->square};
}

void kernel_induce(const struct kernel_pair *pair, const struct sources *sources, struct range which,
                   const struct targets *at) {
    if (which.n <= 0) return;
    const struct block_sources from = block_sources_of(pair, sources, which);
    for (int first = 0; first < at->n; first += KERNEL_BLOCK) {
        const int n = at->n - first < KERNEL_BLOCK ? at->n - first : KERNEL_BLOCK;
        struct kernel_block block;
        fill_block(&block, pair, at, first, n);

        const struct kernel_loops *const loops = pair->kernel->loops(0);
        if (at->u) (at->u_x ? loops->gradient : loops->velocity)(&block, &from);
        if (at->edge && pair->kernel->edge) pair->kernel->edge(&block, &from, at->edge_gradient != NULL);
        add_block(&block, pair, at, first, n);
    }
}

// So many sources form a tile: their sums, five times HALF numbers for each, fit into the first cache.
enum { TILE = 2 * KERNEL_BLOCK };

// the sum of a block_lanes array, which adds one half to the other until one number is left
static double sum_of_lanes(const double value[HALF]) {
    double sum[HALF];
    memcpy(sum, value, sizeof sum);
    for (int n = HALF / 2; n > 0; n /= 2) {
        for (int i = 0; i < n; i++) sum[i] += sum[i + n];
    }
    return sum[0];
}

void kernel_induce_mutual(const struct kernel_pair *pair, const struct sources *one, const struct targets *at_one,
                          const struct sources *other, const struct targets *at_other) {
    if (!pair->kernel->loops(0)->mutual) {
        kernel_induce(pair, other, (struct range){0, other->n}, at_one);
        if (other != one) kernel_induce(pair, one, (struct range){0, one->n}, at_other);
        return;
    }

    const struct targets *const at = at_other;
    for (int first = 0; first < other->n; first += TILE) {
        const struct range tile = {first, other->n - first < TILE ? other->n - first : TILE};
        const struct block_sources from = block_sources_of(pair, other, tile);
        struct block_lanes sums[TILE];
        memset(sums, 0, sizeof sums);

        // the tile and the whole other set, or all sources before the tile; the padding of a block has no strength
        const int end = other == one ? first : one->n;
        for (int before = 0; before < end; before += KERNEL_BLOCK) {
            struct kernel_block block;
            struct block_mates mates;
            const int n = end - before < KERNEL_BLOCK ? end - before : KERNEL_BLOCK;
            fill_block(&block, pair, at_one, before, n);
            memset(&mates, 0, sizeof mates);
            memcpy(mates.q, one->q + before, (size_t)n * sizeof *mates.q);
            memcpy(mates.dx, one->dx + before, (size_t)n * sizeof *mates.dx);
            memcpy(mates.dy, one->dy + before, (size_t)n * sizeof *mates.dy);
            pair->kernel->loops(0)->mutual(&block, &mates, &from, sums);
            add_block(&block, pair, at_one, before, n);
        }
        for (int i = 0; i < tile.n; i++) {
            at->u[first + i] += sum_of_lanes(sums[i].u);
            at->v[first + i] -= sum_of_lanes(sums[i].v);
            if (!pair->kernel->has_legs) continue;
            const double leg_u = -sum_of_lanes(sums[i].leg_u), leg_v = sum_of_lanes(sums[i].leg_v);
            at->u[first + i] += leg_u;
            at->v[first + i] += leg_v;
            if (at->leg_u) at->leg_u[first + i] += leg_u;
            if (at->leg_v) at->leg_v[first + i] += leg_v;
            if (at->div) at->div[first + i] -= 3 * sum_of_lanes(sums[i].div);
        }

        // the sources of the tile on each other
        const struct targets own = kernel_targets_part(at, tile);
        if (other == one) kernel_induce(pair, one, tile, &own);
    }
}

static void unit_finite(const struct kernel_pair *pair, const struct source *source, int n, const double *x,
                        const double *y, const double *half, struct unit_values *values) {
    const double scale = pair->span * inverse_two_pi, add = source->square + pair->square + no_square;
    for (int i = 0; i < n; i++) {
        const double rx = x[i] - source->x, ry = y[i] - source->y, r2 = rx * rx + ry * ry;
        const double r = r2 + add, t = r2 + pair->factor * (source->half + half[i]) + source->leg, root = sqrt(t);
        const double f = scale / (r * root), g = scale / (t * root), h = -3 * g / t, k = -5 * h / t;
        const double by_f = -f * (2 / r + 1 / t) * source->q, across = ry * source->dx - rx * source->dy;
        values->unit_u[i] = -f * ry;
        values->unit_v[i] = f * rx;
        values->leg[i] = g;
        values->div_by_dx[i] = h * ry;
        values->div_by_dy[i] = -h * rx;
        values->edge[i] = h / 2;
        values->u_x[i] = -(ry * by_f + source->dy * h) * rx;
        values->u_y[i] = -(ry * by_f + source->dy * h) * ry - f * source->q;
        values->v_x[i] = (rx * by_f + source->dx * h) * rx + f * source->q;
        values->v_y[i] = (rx * by_f + source->dx * h) * ry;
        values->div_x[i] = k * across * rx - h * source->dy;
        values->div_y[i] = k * across * ry + h * source->dx;
        values->edge_x[i] = k / 2 * rx;
        values->edge_y[i] = k / 2 * ry;
    }
}

static void unit_infinite(const struct kernel_pair *pair, const struct source *source, int n, const double *x,
                          const double *y, const double *half, struct unit_values *values) {
    const double scale = pair->span * inverse_two_pi, add = source->square + pair->square + no_square;
    (void)half;
    for (int i = 0; i < n; i++) {
        const double rx = x[i] - source->x, ry = y[i] - source->y, inverse = 1 / (rx * rx + (ry * ry + add));
        const double f = scale * inverse, g = f * source->q, h = 2 * g * inverse;
        values->unit_u[i] = -f * ry;
        values->unit_v[i] = f * rx;
        values->u_x[i] = h * rx * ry;
        values->u_y[i] = h * ry * ry - g;
        values->v_x[i] = g - h * rx * rx;
        values->v_y[i] = -values->u_x[i];
    }
}

void kernel_unit(const struct kernel_pair *pair, const struct source *source, int n, const double *x, const double *y,
                 const double *half, struct unit_values *values) {
    pair->kernel->unit(pair, source, n, x, y, half, values);
}

static struct kernel_pair pair_infinite(double depth, double square) {
    (void)depth;
    return (struct kernel_pair){.kernel = &kernel_infinite, .span = 1, .square = square};
}

static struct kernel_pair pair_own(double depth, double square) {
    return (struct kernel_pair){.kernel = &kernel_finite, .span = depth / 4, .factor = 1, .square = square};
}

static struct kernel_pair pair_other(double depth, double square) {
    return (struct kernel_pair){.kernel = &kernel_finite, .span = depth / 2, .factor = 4, .square = square};
}

static double bound_infinite(const struct kernel_pair *pair, double r2, double low, double q, double d, double length) {
    (void)low, (void)d, (void)length;
    return fabs(pair->span) * inverse_two_pi * q / sqrt(r2 + pair->square);
}

static double bound_finite(const struct kernel_pair *pair, double r2, double low, double q, double d, double length) {
    const double t = r2 + low, root = sqrt(t);
    return fabs(pair->span) * inverse_two_pi / root * (q / sqrt(r2 + pair->square) + d / t * (1 + 3 * length / root));
}

const struct kernel kernel_infinite = {.cost = 1,
                                       .tree_sources = 5000,
                                       .far_sources = 2000,
                                       .tree_interactions = 3e7,
                                       .bound = bound_infinite,
                                       .own = pair_infinite,
                                       .other = pair_infinite,
                                       .loops = loops_infinite,
                                       .unit = unit_infinite};

const struct kernel kernel_finite = {.has_legs = true,
                                     .cost = 4,
                                     .tree_sources = 1000,
                                     .tree_interactions = 1e6,
                                     .bound = bound_finite,
                                     .own = pair_own,
                                     .other = pair_other,
                                     .loops = loops_finite,
                                     .edge = block_edge,
                                     .unit = unit_finite};

void kernel_values_add(const struct kernel_pair *pair, const struct unit_values *one, double factor, int n,
                       struct unit_values *sum) {
    add_sum(n, factor, one->unit_u, sum->unit_u);
    add_sum(n, factor, one->unit_v, sum->unit_v);
    add_sum(n, factor, one->u_x, sum->u_x);
    add_sum(n, factor, one->u_y, sum->u_y);
    add_sum(n, factor, one->v_x, sum->v_x);
    add_sum(n, factor, one->v_y, sum->v_y);
    if (!pair->kernel->has_legs) return;

    add_sum(n, factor, one->div_x, sum->div_x);
    add_sum(n, factor, one->div_y, sum->div_y);
    add_sum(n, factor, one->leg, sum->leg);
    add_sum(n, factor, one->div_by_dx, sum->div_by_dx);
    add_sum(n, factor, one->div_by_dy, sum->div_by_dy);
    add_sum(n, factor, one->edge, sum->edge);
    add_sum(n, factor, one->edge_x, sum->edge_x);
    add_sum(n, factor, one->edge_y, sum->edge_y);
}
