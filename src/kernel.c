/* kernel.c: blocks of targets in vectors, sources one after another. */
#include "kernel.h"

#include <string.h>

// Wide instructions are chosen when the program starts. The address sanitizer cannot follow that choice.
#if defined(__x86_64__) && !defined(__SANITIZE_ADDRESS__)
#define WIDE __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define WIDE
#endif

enum { LANES = 8 };
typedef double lanes __attribute__((vector_size(LANES * sizeof(double))));

static const double two_pi = 6.28318530717958647692;

// a block of targets; where fewer than LANES are left, the last target fills the rest
static inline void block_read(lanes *block, const double *value, int n) {
    if (n >= LANES) {
        memcpy(block, value, sizeof *block);
    } else {
        for (int i = 0; i < LANES; i++) (*block)[i] = value[i < n ? i : n - 1];
    }
}

// A source on a target has no velocity there: a number that is small, but whose square is not zero, keeps 0/0 away. At
// distances that matter it changes no bit.
static inline double square_of(double smoothing) {
    return smoothing * smoothing + 1e-150;
}

static inline void block_add(double *value, const lanes *block, int n) {
    for (int i = 0; i < LANES && i < n; i++) value[i] += (*block)[i] / two_pi;
}

WIDE void kernel_add_velocity(int n_targets, const double *x, const double *y, int n_sources, const double *source_x,
                              const double *source_y, const double *circulation, double smoothing, double *u,
                              double *v) {
    const double square = square_of(smoothing);
    for (int first = 0; first < n_targets; first += 2 * LANES) {
        const int n = n_targets - first;
        const int rest = n > LANES ? n - LANES : 0;
        const int second = rest > 0 ? first + LANES : first;
        lanes x0, y0, x1, y1;
        block_read(&x0, x + first, n);
        block_read(&y0, y + first, n);
        block_read(&x1, x + second, rest > 0 ? rest : n);
        block_read(&y1, y + second, rest > 0 ? rest : n);
        lanes u0 = {0}, v0 = {0}, u1 = {0}, v1 = {0};
        for (int j = 0; j < n_sources; j++) {
            const lanes rx0 = x0 - source_x[j], ry0 = y0 - source_y[j];
            const lanes rx1 = x1 - source_x[j], ry1 = y1 - source_y[j];
            const lanes d0 = rx0 * rx0 + ry0 * ry0 + square, d1 = rx1 * rx1 + ry1 * ry1 + square;
            const lanes g0 = circulation[j] / d0, g1 = circulation[j] / d1;
            u0 -= g0 * ry0;
            v0 += g0 * rx0;
            u1 -= g1 * ry1;
            v1 += g1 * rx1;
        }
        block_add(u + first, &u0, n);
        block_add(v + first, &v0, n);
        block_add(u + second, &u1, rest);
        block_add(v + second, &v1, rest);
    }
}

WIDE void kernel_add_gradient(int n_targets, const double *x, const double *y, int n_sources, const double *source_x,
                              const double *source_y, const double *circulation, double smoothing, double *u, double *v,
                              double *u_x, double *u_y, double *v_x) {
    const double square = square_of(smoothing);
    for (int first = 0; first < n_targets; first += LANES) {
        const int n = n_targets - first;
        lanes xs, ys;
        block_read(&xs, x + first, n);
        block_read(&ys, y + first, n);
        lanes us = {0}, vs = {0}, uxs = {0}, uys = {0}, vxs = {0};
        for (int j = 0; j < n_sources; j++) {
            const lanes rx = xs - source_x[j], ry = ys - source_y[j];
            const lanes inverse = 1 / (rx * rx + ry * ry + square);
            const lanes g = circulation[j] * inverse;
            const lanes twice = 2 * g * inverse;
            us -= g * ry;
            vs += g * rx;
            uxs += twice * rx * ry;
            uys += twice * ry * ry - g;
            vxs += g - twice * rx * rx;
        }
        block_add(u + first, &us, n);
        block_add(v + first, &vs, n);
        block_add(u_x + first, &uxs, n);
        block_add(u_y + first, &uys, n);
        block_add(v_x + first, &vxs, n);
    }
}

struct kernel_value kernel_unit(double rx, double ry, double smoothing) {
    const double inverse = 1 / (rx * rx + ry * ry + square_of(smoothing));
    const double g = inverse / two_pi;
    const double twice = 2 * g * inverse;
    return (struct kernel_value){
        .u = -g * ry, .v = g * rx, .u_x = twice * rx * ry, .u_y = twice * ry * ry - g, .v_x = g - twice * rx * rx};
}
