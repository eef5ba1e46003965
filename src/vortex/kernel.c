/* kernel.c: the loops for every vector instruction set, and the selection at run time. */
#include "vortex/kernel.h"

#include <stddef.h>
#include <string.h>
#if defined(__x86_64__)
#include <immintrin.h>
#elif defined(__aarch64__)
#include <arm_neon.h>
#endif

enum { BLOCK = 8 }; /* a multiple of the vector width of every variant */

static const double inverse_two_pi = 0.159154943091895335769;

/* A source induces no velocity at the position of the source: a tiny addend in the denominator, with a nonzero square,
 * avoids 0/0. The addend changes no bit at relevant distances. */
static const double no_square = 1e-150;

static inline double sum_of_block(const double *value) {
    return ((value[0] + value[4]) + (value[2] + value[6])) + ((value[1] + value[5]) + (value[3] + value[7]));
}

#if defined(__x86_64__)

#define VARIANT(name) name##_avx512
#define VARIANT_NAME "avx512"
#define TARGET __attribute__((target("avx512f")))
#define lanes __m512d
#define FUSED(a, b, c) _mm512_fmadd_pd(a, b, c)
#include "vortex/kernel_loops.h"

#define VARIANT(name) name##_avx2
#define VARIANT_NAME "avx2"
#define TARGET __attribute__((target("avx2,fma")))
#define lanes __m256d
#define FUSED(a, b, c) _mm256_fmadd_pd(a, b, c)
#include "vortex/kernel_loops.h"

#elif defined(__aarch64__)

#define VARIANT(name) name##_neon
#define VARIANT_NAME "neon"
#define TARGET
#define lanes float64x2_t
#define FUSED(a, b, c) vfmaq_f64(c, a, b)
#include "vortex/kernel_loops.h"

#endif

// any processor: vectors of two doubles, products without fusion
typedef double two __attribute__((vector_size(2 * sizeof(double))));
#define VARIANT(name) name##_baseline
#define VARIANT_NAME "baseline"
#define TARGET
#define lanes two
#define FUSED(a, b, c) ((a) * (b) + (c))
#include "vortex/kernel_loops.h"

// ---- selection of a variant

const struct kernel_variant *kernel_variant(int i) {
    const struct kernel_variant *found[3];
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

static double smoothing_square(double smoothing) {
    return smoothing * smoothing + no_square;
}

/* A sum at targets: to[0], to[1]: velocity; with_gradient: to[2] .. to[4]: u_x, u_y, v_x. The sources are changes, or
 * `sources` if changes is NULL. */
struct addition {
    const struct kernel_sources *sources;
    const struct kernel_changes *changes;
    int with_gradient;
};

// n: a multiple of BLOCK
static void targets_add_blocks(const struct addition *what, int n, const double *x, const double *y,
                               double *const to[5]) {
    const struct kernel_variant *const variant = kernel_variant(0);
    if (what->changes && what->with_gradient) {
        variant->gradient_change(n, x, y, what->changes, to[0], to[1], to[2], to[3], to[4]);
    } else if (what->changes) {
        variant->velocity_change(n, x, y, what->changes, to[0], to[1]);
    } else if (what->with_gradient) {
        variant->gradient(n, x, y, what->sources, to[0], to[1], to[2], to[3], to[4]);
    } else {
        variant->velocity(n, x, y, what->sources, to[0], to[1]);
    }
}

// The targets after the last full block of 16 are copied into a block of 8 or 16, padded with the last target.
static void targets_add_rest(const struct addition *what, int n, const double *x, const double *y,
                             double *const to[5]) {
    double rest_x[2 * BLOCK], rest_y[2 * BLOCK], sum[5][2 * BLOCK];
    const int n_filled = n <= BLOCK ? BLOCK : 2 * BLOCK, n_sums = what->with_gradient ? 5 : 2;
    for (int i = 0; i < n_filled; i++) {
        rest_x[i] = x[i < n ? i : n - 1];
        rest_y[i] = y[i < n ? i : n - 1];
    }

    memset(sum, 0, (size_t)n_sums * sizeof *sum);
    targets_add_blocks(what, n_filled, rest_x, rest_y, (double *const[5]){sum[0], sum[1], sum[2], sum[3], sum[4]});
    for (int k = 0; k < n_sums; k++) {
        for (int i = 0; i < n; i++) to[k][i] += sum[k][i];
    }
}

static void targets_add(const struct addition *what, int n, const double *x, const double *y, double *const to[5]) {
    const int whole = n - n % (2 * BLOCK), n_sums = what->with_gradient ? 5 : 2;
    targets_add_blocks(what, whole, x, y, to);
    if (whole == n) return;

    double *rest[5] = {NULL};
    for (int k = 0; k < n_sums; k++) rest[k] = to[k] + whole;
    targets_add_rest(what, n - whole, x + whole, y + whole, rest);
}

void kernel_add_velocity(int n_targets, const double *x, const double *y, int n_sources, const double *source_x,
                         const double *source_y, const double *circulation, double smoothing, double *u, double *v) {
    const struct kernel_sources sources = {n_sources, source_x, source_y, circulation, smoothing_square(smoothing)};
    targets_add(&(struct addition){.sources = &sources}, n_targets, x, y, (double *const[5]){u, v});
}

void kernel_add_gradient(int n_targets, const double *x, const double *y, int n_sources, const double *source_x,
                         const double *source_y, const double *circulation, double smoothing, double *u, double *v,
                         double *u_x, double *u_y, double *v_x) {
    const struct kernel_sources sources = {n_sources, source_x, source_y, circulation, smoothing_square(smoothing)};
    targets_add(&(struct addition){.sources = &sources, .with_gradient = 1}, n_targets, x, y,
                (double *const[5]){u, v, u_x, u_y, v_x});
}

void kernel_add_velocity_change(int n_targets, const double *x, const double *y, const struct kernel_changes *changes,
                                double *u, double *v) {
    targets_add(&(struct addition){.changes = changes}, n_targets, x, y, (double *const[5]){u, v});
}

void kernel_add_gradient_change(int n_targets, const double *x, const double *y, const struct kernel_changes *changes,
                                double *u, double *v, double *u_x, double *u_y, double *v_x) {
    targets_add(&(struct addition){.changes = changes, .with_gradient = 1}, n_targets, x, y,
                (double *const[5]){u, v, u_x, u_y, v_x});
}

void kernel_add_pairwise(const struct kernel_tile *a, const struct kernel_tile *b, double smoothing) {
    kernel_variant(0)->pairwise(a, b, smoothing_square(smoothing));
}

KERNEL_WIDE(void, kernel_add_velocity_each,
            (int n_targets, const double *restrict x, const double *restrict y, int n_sources,
             const double *restrict source_x, const double *restrict source_y, const double *restrict circulation,
             const double *restrict square, double *restrict u, double *restrict v),
            (n_targets, x, y, n_sources, source_x, source_y, circulation, square, u, v)) {
    for (int j = 0; j < n_sources; j++) {
        const double g = inverse_two_pi * circulation[j], e = square[j] + no_square;
        for (int i = 0; i < n_targets; i++) {
            const double rx = x[i] - source_x[j], ry = y[i] - source_y[j];
            const double h = g / (rx * rx + ry * ry + e);
            u[i] -= h * ry;
            v[i] += h * rx;
        }
    }
}

KERNEL_WIDE(void, kernel_add_gradient_each,
            (int n_targets, const double *restrict x, const double *restrict y, int n_sources,
             const double *restrict source_x, const double *restrict source_y, const double *restrict circulation,
             const double *restrict square, double *restrict u, double *restrict v, double *restrict u_x,
             double *restrict u_y, double *restrict v_x),
            (n_targets, x, y, n_sources, source_x, source_y, circulation, square, u, v, u_x, u_y, v_x)) {
    for (int j = 0; j < n_sources; j++) {
        const double g = inverse_two_pi * circulation[j], e = square[j] + no_square;
        for (int i = 0; i < n_targets; i++) {
            const double rx = x[i] - source_x[j], ry = y[i] - source_y[j];
            const double inverse = 1 / (rx * rx + ry * ry + e), h = g * inverse, twice = 2 * h * inverse;
            u[i] -= h * ry;
            v[i] += h * rx;
            u_x[i] += twice * rx * ry;
            u_y[i] += twice * ry * ry - h;
            v_x[i] += h - twice * rx * rx;
        }
    }
}

// 1/d_to - 1/d_from = (from - to)/(d_to d_from): no cancellation if `from` and `to` are nearly equal
KERNEL_WIDE(void, kernel_add_velocity_change_at,
            (int n_targets, const double *restrict x, const double *restrict y, const double *restrict square,
             int n_sources, const double *restrict source_x, const double *restrict source_y,
             const double *restrict circulation, double from, double *restrict u, double *restrict v),
            (n_targets, x, y, square, n_sources, source_x, source_y, circulation, from, u, v)) {
    for (int j = 0; j < n_sources; j++) {
        const double g = inverse_two_pi * circulation[j];
        for (int i = 0; i < n_targets; i++) {
            const double rx = x[i] - source_x[j], ry = y[i] - source_y[j], r_square = rx * rx + ry * ry;
            const double h = g * (from - square[i]) / ((r_square + (square[i] + no_square)) * (r_square + from));
            u[i] -= h * ry;
            v[i] += h * rx;
        }
    }
}

KERNEL_WIDE(void, kernel_unit,
            (int n, const double *x, const double *y, double source_x, double source_y, double smoothing,
             struct kernel_values *values),
            (n, x, y, source_x, source_y, smoothing, values)) {
    const double square = smoothing_square(smoothing);
    for (int i = 0; i < n; i++) {
        const double rx = x[i] - source_x, ry = y[i] - source_y;
        const double inverse = 1 / (rx * rx + ry * ry + square);
        const double g = inverse_two_pi * inverse;
        const double twice = 2 * g * inverse;
        values->u[i] = -g * ry;
        values->v[i] = g * rx;
        values->u_x[i] = twice * rx * ry;
        values->u_y[i] = twice * ry * ry - g;
        values->v_x[i] = g - twice * rx * rx;
    }
}

KERNEL_WIDE(void, kernel_add_motion,
            (int n, int n_sources, const double *factor, double sign, const struct kernel_values *values,
             double *restrict u_by_x, double *restrict v_by_x, double *restrict u_by_y, double *restrict v_by_y),
            (n, n_sources, factor, sign, values, u_by_x, v_by_x, u_by_y, v_by_y)) {
    int j = 0;
    // four sources at a time: each sum is read and written once per four sources
    for (; j + 4 <= n_sources; j += 4) {
        const struct kernel_values *const a = values + j, *const b = a + 1, *const c = a + 2, *const d = a + 3;
        const double f[4] = {factor[j], factor[j + 1], factor[j + 2], factor[j + 3]};
        const double g[4] = {sign * f[0], sign * f[1], sign * f[2], sign * f[3]};

        for (int i = 0; i < n; i++) {
            u_by_x[i] = u_by_x[i] + f[0] * a->u_x[i] + f[1] * b->u_x[i] + f[2] * c->u_x[i] + f[3] * d->u_x[i];
            v_by_x[i] = v_by_x[i] + f[0] * a->v_x[i] + f[1] * b->v_x[i] + f[2] * c->v_x[i] + f[3] * d->v_x[i];
            u_by_y[i] = u_by_y[i] + g[0] * a->u_y[i] + g[1] * b->u_y[i] + g[2] * c->u_y[i] + g[3] * d->u_y[i];
            v_by_y[i] = v_by_y[i] - g[0] * a->u_x[i] - g[1] * b->u_x[i] - g[2] * c->u_x[i] - g[3] * d->u_x[i];
        }
    }

    for (; j < n_sources; j++) {
        const double f = factor[j], g = sign * factor[j];
        for (int i = 0; i < n; i++) {
            u_by_x[i] += f * values[j].u_x[i];
            v_by_x[i] += f * values[j].v_x[i];
            u_by_y[i] += g * values[j].u_y[i];
            v_by_y[i] -= g * values[j].u_x[i];
        }
    }
}

KERNEL_WIDE(void, kernel_multiply,
            (int n_rows, int n_columns, const double *restrict matrix, const double *restrict vector,
             double *restrict product),
            (n_rows, n_columns, matrix, vector, product)) {
    int c = 0;
    // four columns at a time: each product is read and written once per four columns
    for (; c + 4 <= n_columns; c += 4) {
        const double *const column = matrix + (long)c * n_rows;
        const double f0 = vector[c], f1 = vector[c + 1], f2 = vector[c + 2], f3 = vector[c + 3];
        for (int r = 0; r < n_rows; r++) {
            product[r] = product[r] + f0 * column[r] + f1 * column[n_rows + r] + f2 * column[2 * n_rows + r] +
                         f3 * column[3 * n_rows + r];
        }
    }

    for (; c < n_columns; c++) {
        const double *const column = matrix + (long)c * n_rows;
        for (int r = 0; r < n_rows; r++) product[r] += vector[c] * column[r];
    }
}
