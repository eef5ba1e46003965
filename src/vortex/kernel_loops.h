/* kernel_loops.h: the loops over targets and sources. kernel.c includes this text once for every vector width, with
 *
 *     VARIANT(name)   the name of a function of this variant
 *     TARGET          the instruction set of the functions
 *     lanes           a vector of doubles
 *     FUSED(a, b, c)  a * b + c of vectors, with one rounding
 *
 * BLOCK targets are one or more vectors. The operations on one target, and the order of operations, are the same for
 * every width. */

enum { VARIANT(width) = sizeof(lanes) / sizeof(double) };

static inline TARGET lanes VARIANT(get)(const double *value) {
    lanes vector;
    memcpy(&vector, value, sizeof vector);
    return vector;
}

static inline TARGET void VARIANT(put)(double *value, lanes vector) {
    memcpy(value, &vector, sizeof vector);
}

// the same number in all lanes
static inline TARGET lanes VARIANT(all)(double value) {
    return value - (lanes){0};
}

static inline TARGET void VARIANT(add)(double *value, double factor, lanes vector) {
    VARIANT(put)(value, VARIANT(get)(value) + factor * vector);
}

// targets i and i + BLOCK share a division
static inline TARGET void VARIANT(velocity_two)(const double *x, const double *y, const struct kernel_sources *sources,
                                                double *u, double *v) {
    const lanes x0 = VARIANT(get)(x), y0 = VARIANT(get)(y);
    const lanes x1 = VARIANT(get)(x + BLOCK), y1 = VARIANT(get)(y + BLOCK);
    const lanes square = VARIANT(all)(sources->square);
    lanes u0 = {0}, v0 = {0}, u1 = {0}, v1 = {0};
    for (int j = 0; j < sources->n; j++) {
        const lanes rx0 = x0 - sources->x[j], ry0 = y0 - sources->y[j];
        const lanes rx1 = x1 - sources->x[j], ry1 = y1 - sources->y[j];
        const lanes d0 = FUSED(rx0, rx0, FUSED(ry0, ry0, square)), d1 = FUSED(rx1, rx1, FUSED(ry1, ry1, square));

        // one division for both targets: 1/d0 = d1/(d0 d1)
        const lanes shared = sources->circulation[j] / (d0 * d1);
        const lanes g0 = shared * d1, g1 = shared * d0;
        u0 = FUSED(g0, ry0, u0);
        v0 = FUSED(g0, rx0, v0);
        u1 = FUSED(g1, ry1, u1);
        v1 = FUSED(g1, rx1, v1);
    }
    VARIANT(add)(u, -inverse_two_pi, u0);
    VARIANT(add)(v, inverse_two_pi, v0);
    VARIANT(add)(u + BLOCK, -inverse_two_pi, u1);
    VARIANT(add)(v + BLOCK, inverse_two_pi, v1);
}

static inline TARGET void VARIANT(velocity_one)(const double *x, const double *y, const struct kernel_sources *sources,
                                                double *u, double *v) {
    const lanes xs = VARIANT(get)(x), ys = VARIANT(get)(y), square = VARIANT(all)(sources->square);
    lanes us = {0}, vs = {0};
    for (int j = 0; j < sources->n; j++) {
        const lanes rx = xs - sources->x[j], ry = ys - sources->y[j];
        const lanes g = sources->circulation[j] / FUSED(rx, rx, FUSED(ry, ry, square));
        us = FUSED(g, ry, us);
        vs = FUSED(g, rx, vs);
    }
    VARIANT(add)(u, -inverse_two_pi, us);
    VARIANT(add)(v, inverse_two_pi, vs);
}

static TARGET void VARIANT(velocity)(int n, const double *x, const double *y, const struct kernel_sources *sources,
                                     double *u, double *v) {
    for (int first = 0; first < n; first += 2 * BLOCK) {
        for (int i = first; i < first + BLOCK; i += VARIANT(width)) {
            if (first + BLOCK < n) {
                VARIANT(velocity_two)(x + i, y + i, sources, u + i, v + i);
            } else {
                VARIANT(velocity_one)(x + i, y + i, sources, u + i, v + i);
            }
        }
    }
}

// With d = r^2 + e^2, g = circulation/d and h = g/d the sums are g r, h r_x r_y, h r_x^2, g and h. The gradient follows
// at the end: u_x = 2 h r_x r_y, v_x = g - 2 h r_x^2, u_y = 2 h r_y^2 - g = v_x - 2 h e^2.
static TARGET void VARIANT(gradient)(int n, const double *x, const double *y, const struct kernel_sources *sources,
                                     double *u, double *v, double *u_x, double *u_y, double *v_x) {
    const lanes square = VARIANT(all)(sources->square);
    for (int i = 0; i < n; i += VARIANT(width)) {
        const lanes xs = VARIANT(get)(x + i), ys = VARIANT(get)(y + i);
        lanes us = {0}, vs = {0}, products = {0}, squares = {0}, gs = {0}, hs = {0};
        for (int j = 0; j < sources->n; j++) {
            const lanes rx = xs - sources->x[j], ry = ys - sources->y[j], rx_square = rx * rx;
            const lanes inverse = 1 / FUSED(ry, ry, rx_square + square);
            const lanes g = sources->circulation[j] * inverse, h = g * inverse;

            us = FUSED(g, ry, us);
            vs = FUSED(g, rx, vs);
            products = FUSED(h, rx * ry, products);
            squares = FUSED(h, rx_square, squares);
            gs += g;
            hs += h;
        }

        const lanes across = gs - 2 * squares;
        VARIANT(add)(u + i, -inverse_two_pi, us);
        VARIANT(add)(v + i, inverse_two_pi, vs);
        VARIANT(add)(u_x + i, inverse_two_pi, 2 * products);
        VARIANT(add)(u_y + i, inverse_two_pi, across - 2 * sources->square * hs);
        VARIANT(add)(v_x + i, inverse_two_pi, across);
    }
}

// 1/d_to - 1/d_from = (from - to)/(d_to d_from): no digits are lost where both are nearly the same.
static TARGET void VARIANT(velocity_change)(int n, const double *x, const double *y,
                                            const struct kernel_changes *changes, double *u, double *v) {
    const double from = changes->from;
    for (int i = 0; i < n; i += VARIANT(width)) {
        const lanes xs = VARIANT(get)(x + i), ys = VARIANT(get)(y + i);
        lanes us = {0}, vs = {0};
        for (int j = 0; j < changes->n; j++) {
            const double to = changes->to[j] + no_square;
            const lanes rx = xs - changes->x[j], ry = ys - changes->y[j], square = FUSED(rx, rx, ry * ry);
            const lanes g = changes->circulation[j] * (from - to) / ((square + to) * (square + from));
            us = FUSED(g, ry, us);
            vs = FUSED(g, rx, vs);
        }
        VARIANT(add)(u + i, -inverse_two_pi, us);
        VARIANT(add)(v + i, inverse_two_pi, vs);
    }
}

// With g as above, dg/d(r^2) = -g (1/d_to + 1/d_from) = -h: u_x = 2 h r_x r_y, u_y = 2 h r_y^2 - g and
// v_x = g - 2 h r_x^2.
static TARGET void VARIANT(gradient_change)(int n, const double *x, const double *y,
                                            const struct kernel_changes *changes, double *u, double *v, double *u_x,
                                            double *u_y, double *v_x) {
    const double from = changes->from;
    for (int i = 0; i < n; i += VARIANT(width)) {
        const lanes xs = VARIANT(get)(x + i), ys = VARIANT(get)(y + i);
        lanes us = {0}, vs = {0}, products = {0}, along = {0}, across = {0};
        for (int j = 0; j < changes->n; j++) {
            const double to = changes->to[j] + no_square;
            const lanes rx = xs - changes->x[j], ry = ys - changes->y[j], square = FUSED(rx, rx, ry * ry);
            const lanes d0 = square + to, d1 = square + from, inverse = 1 / (d0 * d1);
            const lanes g = changes->circulation[j] * (from - to) * inverse, h = 2 * g * (d0 + d1) * inverse;

            us = FUSED(g, ry, us);
            vs = FUSED(g, rx, vs);
            products = FUSED(h, rx * ry, products);
            along += FUSED(h, ry * ry, -g);
            across += g - h * (rx * rx);
        }
        VARIANT(add)(u + i, -inverse_two_pi, us);
        VARIANT(add)(v + i, inverse_two_pi, vs);
        VARIANT(add)(u_x + i, inverse_two_pi, products);
        VARIANT(add)(u_y + i, inverse_two_pi, along);
        VARIANT(add)(v_x + i, inverse_two_pi, across);
    }
}

// Vortices i and i + BLOCK of a stay in vectors; the vortices of b are processed one at a time. The velocity at a
// vortex of b is summed over all blocks of a in BLOCK lanes, and over the lanes at the end.
static TARGET void VARIANT(pairwise)(const struct kernel_tile *a, const struct kernel_tile *b, double square_value) {
    double sum_u[KERNEL_TILE * BLOCK] __attribute__((aligned(64)));
    double sum_v[KERNEL_TILE * BLOCK] __attribute__((aligned(64)));
    memset(sum_u, 0, (size_t)b->n * BLOCK * sizeof *sum_u);
    memset(sum_v, 0, (size_t)b->n * BLOCK * sizeof *sum_v);

    const lanes square = VARIANT(all)(square_value);
    for (int first = 0; first < a->n; first += 2 * BLOCK) {
        for (int lane = 0; lane < BLOCK; lane += VARIANT(width)) {
            const int i = first + lane;
            const lanes x0 = VARIANT(get)(a->x + i), y0 = VARIANT(get)(a->y + i);
            const lanes x1 = VARIANT(get)(a->x + i + BLOCK), y1 = VARIANT(get)(a->y + i + BLOCK);
            const lanes ga0 = VARIANT(get)(a->circulation + i), ga1 = VARIANT(get)(a->circulation + i + BLOCK);
            lanes u0 = {0}, v0 = {0}, u1 = {0}, v1 = {0};
            for (int j = 0; j < b->n; j++) {
                const lanes rx0 = x0 - b->x[j], ry0 = y0 - b->y[j], rx1 = x1 - b->x[j], ry1 = y1 - b->y[j];
                const lanes d0 = FUSED(rx0, rx0, FUSED(ry0, ry0, square));
                const lanes d1 = FUSED(rx1, rx1, FUSED(ry1, ry1, square));
                const lanes shared = 1 / (d0 * d1), inverse0 = shared * d1, inverse1 = shared * d0;
                const lanes kx0 = rx0 * inverse0, ky0 = ry0 * inverse0, kx1 = rx1 * inverse1, ky1 = ry1 * inverse1;

                // velocity at a from b
                const lanes gb = VARIANT(all)(b->circulation[j]);
                u0 = FUSED(gb, ky0, u0);
                v0 = FUSED(gb, kx0, v0);
                u1 = FUSED(gb, ky1, u1);
                v1 = FUSED(gb, kx1, v1);

                // velocity at b from a, with the opposite sign
                double *const to_u = sum_u + BLOCK * j + lane, *const to_v = sum_v + BLOCK * j + lane;
                VARIANT(put)(to_u, FUSED(ga0, ky0, FUSED(ga1, ky1, VARIANT(get)(to_u))));
                VARIANT(put)(to_v, FUSED(ga0, kx0, FUSED(ga1, kx1, VARIANT(get)(to_v))));
            }
            VARIANT(add)(a->u + i, -inverse_two_pi, u0);
            VARIANT(add)(a->v + i, inverse_two_pi, v0);
            VARIANT(add)(a->u + i + BLOCK, -inverse_two_pi, u1);
            VARIANT(add)(a->v + i + BLOCK, inverse_two_pi, v1);
        }
    }

    for (int j = 0; j < b->n; j++) {
        b->u[j] += inverse_two_pi * sum_of_block(sum_u + BLOCK * j);
        b->v[j] -= inverse_two_pi * sum_of_block(sum_v + BLOCK * j);
    }
}

static const struct kernel_variant VARIANT(loops) = {.name = VARIANT_NAME,
                                                     .velocity = VARIANT(velocity),
                                                     .gradient = VARIANT(gradient),
                                                     .velocity_change = VARIANT(velocity_change),
                                                     .gradient_change = VARIANT(gradient_change),
                                                     .pairwise = VARIANT(pairwise)};

#undef VARIANT
#undef VARIANT_NAME
#undef TARGET
#undef lanes
#undef FUSED
