/* ring.c: one root in single precision per pair, one division for two pairs; in mutual sums both serve both
 * directions. */
#include "vortex/ring.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#if defined(__x86_64__)
#include <immintrin.h>
#elif defined(__aarch64__)
#include <arm_neon.h>
#endif

#include "base/memory.h"
#include "vortex/kernel.h"

static const double inverse_two_pi = 0.159154943091895335769;

/* Avoids 0/0 in the spanwise part of a source at a target, and changes no bit at relevant distances. */
static const double no_square = 1e-150;

enum { N_ARRAYS = 8, HALF = RING_BLOCK / 2 };

static void ring_arrays(struct rings *rings, double **array[N_ARRAYS]) {
    double **const all[N_ARRAYS] = {&rings->x,  &rings->y,    &rings->q,   &rings->dx,
                                    &rings->dy, &rings->half, &rings->leg, &rings->square};
    memcpy(array, all, sizeof all);
}

void ring_free(struct rings *rings) {
    double **array[N_ARRAYS];
    ring_arrays(rings, array);
    for (int i = 0; i < N_ARRAYS; i++) free(*array[i]);
    *rings = (struct rings){0};
}

enum status ring_append(struct rings *rings, int n) {
    double **array[N_ARRAYS];
    ring_arrays(rings, array);
    const int needed = rings->n + n;

    if (needed > rings->capacity) {
        const int capacity = needed + needed / 2;
        for (int i = 0; i < N_ARRAYS; i++) {
            TRY(MEMORY_RESIZE(*array[i], capacity, "vortex rings"));
        }

        rings->capacity = capacity;
    }

    for (int i = 0; i < N_ARRAYS && n > 0; i++) memset(*array[i] + rings->n, 0, (size_t)n * sizeof **array[i]);
    rings->n = needed;
    return STATUS_OK;
}

struct ring_targets ring_targets_part(const struct ring_targets *all, struct range which) {
    struct ring_targets part = *all;
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

// ---- velocity and divergence

#if defined(__x86_64__)

#define VARIANT(name) name##_avx512
#define TARGET __attribute__((target("avx512f")))
#define lanes __m512d
#define FUSED(a, b, c) _mm512_fmadd_pd(a, b, c)
#define ONE_OVER_ROOT(a) _mm512_cvtps_pd(_mm256_div_ps(_mm256_set1_ps(1), _mm256_sqrt_ps(_mm512_cvtpd_ps(a))))
#include "vortex/ring_loops.h"

#define VARIANT(name) name##_avx2
#define TARGET __attribute__((target("avx2,fma")))
#define lanes __m256d
#define FUSED(a, b, c) _mm256_fmadd_pd(a, b, c)
#define ONE_OVER_ROOT(a) _mm256_cvtps_pd(_mm_div_ps(_mm_set1_ps(1), _mm_sqrt_ps(_mm256_cvtpd_ps(a))))
#include "vortex/ring_loops.h"

#elif defined(__aarch64__)

#define VARIANT(name) name##_neon
#define TARGET
#define lanes float64x2_t
#define FUSED(a, b, c) vfmaq_f64(c, a, b)
#define ONE_OVER_ROOT(a) vcvt_f64_f32(vdiv_f32(vdup_n_f32(1), vsqrt_f32(vcvt_f32_f64(a))))
#include "vortex/ring_loops.h"

#endif

// any processor: vectors of two doubles, products without fusion
typedef double two __attribute__((vector_size(2 * sizeof(double))));
#define VARIANT(name) name##_baseline
#define TARGET
#define lanes two
#define FUSED(a, b, c) ((a) * (b) + (c))
#define ONE_OVER_ROOT(a) ((two){1 / sqrtf((float)(a)[0]), 1 / sqrtf((float)(a)[1])})
#include "vortex/ring_loops.h"

const struct ring_loops *ring_variant(int i) {
    const struct ring_loops *found[3];
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

// ---- with gradients

static KERNEL_WIDE(void, block_gradient, (struct ring_block * at, const struct ring_sources *from), (at, from)) {
    const double scale = from->span * inverse_two_pi;
    for (int n = 0; n < from->n; n++) {
        const double x = from->x[n], y = from->y[n], q = from->q[n] * scale, dx = from->dx[n] * scale;
        const double dy = from->dy[n] * scale, half = from->factor * from->half[n] + from->leg[n];
        const double square = from->square[n] + from->add;

        for (int i = 0; i < RING_BLOCK; i++) {
            const double rx = at->x[i] - x, ry = at->y[i] - y, r2 = rx * rx + ry * ry;
            const double r = r2 + (at->square[i] + square), t = r2 + (at->half[i] + half), root = sqrt(t);
            const double inverse = 1 / (r * t * root), f = q * (inverse * t), g = inverse * r;
            at->u[i] -= f * ry;
            at->v[i] += f * rx;
            at->leg_u[i] -= g * dy;
            at->leg_v[i] += g * dx;
            // 1/T^(5/2), and the slopes of f and g over r
            const double fifth = g * g * root, by_f = -f * (2 * inverse * t * root + g * root), by_g = -3 * fifth;
            const double across = ry * dx - rx * dy, h = by_g, k = 15 * fifth * g * root;
            at->div[i] += h / 3 * across;
            at->u_x[i] -= (ry * by_f + dy * by_g) * rx;
            at->u_y[i] -= (ry * by_f + dy * by_g) * ry + f;
            at->v_x[i] += (rx * by_f + dx * by_g) * rx + f;
            at->div_x[i] += k * across * rx - h * dy;
            at->div_y[i] += k * across * ry + h * dx;
        }
    }
}

static KERNEL_WIDE(void, block_edge, (struct ring_block * at, const struct ring_sources *from), (at, from)) {
    const double scale = from->span * inverse_two_pi;
    for (int n = 0; n < from->n; n++) {
        const double x = from->x[n], y = from->y[n], dx = from->dx[n] * scale, dy = from->dy[n] * scale;
        const double half = from->factor * from->half[n] + from->leg[n];
        for (int i = 0; i < RING_BLOCK; i++) {
            const double rx = at->x[i] - x, ry = at->y[i] - y, t = rx * rx + ry * ry + (at->half[i] + half);
            const double factor = -1.5 / (t * t * sqrt(t)), slope = -5 * factor / t;
            at->edge[0][i] += factor * dx;
            at->edge[1][i] += factor * dy;
            at->edge_gradient[0][i] += slope * rx * dx;
            at->edge_gradient[1][i] += slope * ry * dx;
            at->edge_gradient[2][i] += slope * rx * dy;
            at->edge_gradient[3][i] += slope * ry * dy;
        }
    }
}

static void fill_block(struct ring_block *block, const struct ring_pair *pair, const struct ring_targets *at, int first,
                       int n) {
    memset(block, 0, sizeof *block);
    for (int i = 0; i < RING_BLOCK; i++) {
        // the padding has another position than the last target, so that no two targets of a division are at one source
        const int p = first + (i < n ? i : n - 1);
        block->x[i] = at->x[p] + (i < n ? 0 : 1);
        block->y[i] = at->y[p];
        block->half[i] = (at->half ? pair->factor * at->half[p] : 0) + (at->leg ? at->leg[p] : 0);
        block->square[i] = (at->square ? at->square[p] : 0) + no_square;
    }
}

static void add_block(const struct ring_block *block, const struct ring_targets *at, int first, int n) {
    for (int i = 0; i < n; i++) {
        const int p = first + i;
        at->u[p] += block->u[i] + block->leg_u[i];
        at->v[p] += block->v[i] + block->leg_v[i];
        if (at->leg_u) at->leg_u[p] += block->leg_u[i];
        if (at->leg_v) at->leg_v[p] += block->leg_v[i];
        if (at->div) at->div[p] += 3 * block->div[i];
        if (!at->u_x) continue;
        at->u_x[p] += block->u_x[i];
        at->u_y[p] += block->u_y[i];
        at->v_x[p] += block->v_x[i];
        if (at->div_x) at->div_x[p] += block->div_x[i];
        if (at->div_y) at->div_y[p] += block->div_y[i];
    }

    for (int k = 0; k < 2 && at->edge; k++) {
        for (int i = 0; i < n; i++) at->edge[k * at->edge_stride + first + i] += block->edge[k][i];
    }

    for (int k = 0; k < 4 && at->edge_gradient; k++) {
        for (int i = 0; i < n; i++) at->edge_gradient[k * at->edge_stride + first + i] += block->edge_gradient[k][i];
    }
}

static struct ring_sources ring_sources_of(const struct ring_pair *pair, const struct rings *rings,
                                           struct range which) {
    return (struct ring_sources){.n = which.n,
                                 .x = rings->x + which.first,
                                 .y = rings->y + which.first,
                                 .q = rings->q + which.first,
                                 .dx = rings->dx + which.first,
                                 .dy = rings->dy + which.first,
                                 .half = rings->half + which.first,
                                 .leg = rings->leg + which.first,
                                 .square = rings->square + which.first,
                                 .span = pair->span,
                                 .factor = pair->factor,
                                 .add = pair->square};
}

void ring_induce(const struct ring_pair *pair, const struct rings *rings, struct range which,
                 const struct ring_targets *at) {
    if (which.n <= 0) return;
    const struct ring_sources from = ring_sources_of(pair, rings, which);
    for (int first = 0; first < at->n; first += RING_BLOCK) {
        const int n = at->n - first < RING_BLOCK ? at->n - first : RING_BLOCK;
        struct ring_block block;
        fill_block(&block, pair, at, first, n);

        if (at->u_x) {
            block_gradient(&block, &from);
        } else {
            ring_variant(0)->velocity(&block, &from);
        }

        if (at->edge) block_edge(&block, &from);
        add_block(&block, at, first, n);
    }
}

// sums of a tile of sources: five of HALF numbers for each fit in the first cache
enum { TILE = 2 * RING_BLOCK };

static double sum_of_lanes(const double *value) {
    return ((value[0] + value[4]) + (value[2] + value[6])) + ((value[1] + value[5]) + (value[3] + value[7]));
}

void ring_induce_mutual(const struct ring_pair *pair, const struct rings *rings, const struct ring_targets *at) {
    for (int first = 0; first < rings->n; first += TILE) {
        const struct range tile = {first, rings->n - first < TILE ? rings->n - first : TILE};
        const struct ring_sources from = ring_sources_of(pair, rings, tile);
        struct ring_lanes sums[TILE];
        memset(sums, 0, sizeof sums);

        // the tile and all rings before
        for (int before = 0; before < first; before += RING_BLOCK) {
            struct ring_block block;
            struct ring_mates mates;
            fill_block(&block, pair, at, before, RING_BLOCK);
            memcpy(mates.q, rings->q + before, sizeof mates.q);
            memcpy(mates.dx, rings->dx + before, sizeof mates.dx);
            memcpy(mates.dy, rings->dy + before, sizeof mates.dy);
            ring_variant(0)->mutual(&block, &mates, &from, sums);
            add_block(&block, at, before, RING_BLOCK);
        }
        for (int i = 0; i < tile.n; i++) {
            const double leg_u = -sum_of_lanes(sums[i].leg_u), leg_v = sum_of_lanes(sums[i].leg_v);
            at->u[first + i] += sum_of_lanes(sums[i].u) + leg_u;
            at->v[first + i] += leg_v - sum_of_lanes(sums[i].v);
            if (at->leg_u) at->leg_u[first + i] += leg_u;
            if (at->leg_v) at->leg_v[first + i] += leg_v;
            if (at->div) at->div[first + i] -= 3 * sum_of_lanes(sums[i].div);
        }

        // the rings of the tile
        const struct ring_targets own = ring_targets_part(at, tile);
        ring_induce(pair, rings, tile, &own);
    }
}

enum status ring_write_images(const struct rings *rings, int n_images, const struct ring_image *image,
                              struct rings *images) {
    images->n = 0;
    TRY(ring_append(images, n_images * rings->n));
    for (int k = 0; k < n_images; k++) {
        const double weight = image[k].weight, reversed = image[k].sign * weight;
        const int first = k * rings->n;
        for (int i = 0; i < rings->n; i++) {
            images->x[first + i] = rings->x[i];
            images->y[first + i] = image[k].sign * rings->y[i] + image[k].shift;
            images->q[first + i] = reversed * rings->q[i];
            images->dx[first + i] = reversed * rings->dx[i];
            images->dy[first + i] = weight * rings->dy[i];
        }

        const size_t size = (size_t)rings->n * sizeof(double);
        if (rings->n == 0) continue;
        memcpy(images->half + first, rings->half, size);
        memcpy(images->leg + first, rings->leg, size);
        memcpy(images->square + first, rings->square, size);
    }

    return STATUS_OK;
}

void ring_unit(const struct ring_pair *pair, const struct ring_source *source, int n, const double *x, const double *y,
               const double *half, struct ring_values *values) {
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

void ring_values_add(const struct ring_values *one, double factor, int n, struct ring_values *sum) {
    const double *const from[] = {one->unit_u, one->unit_v, one->leg,    one->div_by_dx, one->div_by_dy,
                                  one->edge,   one->u_x,    one->u_y,    one->v_x,       one->v_y,
                                  one->div_x,  one->div_y,  one->edge_x, one->edge_y};
    double *const to[] = {sum->unit_u, sum->unit_v, sum->leg, sum->div_by_dx, sum->div_by_dy, sum->edge,   sum->u_x,
                          sum->u_y,    sum->v_x,    sum->v_y, sum->div_x,     sum->div_y,     sum->edge_x, sum->edge_y};
    for (size_t k = 0; k < sizeof to / sizeof *to; k++) {
        for (int i = 0; i < n; i++) to[k][i] += factor * from[k][i];
    }
}
