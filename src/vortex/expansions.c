/* expansions.c: M2M, M2L and L2L for eight boxes or pairs of boxes at a time, one per vector lane. Declared in
 * expansions.h. */
#include "vortex/expansions.h"

#include <math.h>
#include <string.h>

#include "vortex/kernel.h"

// ---- the coefficients of eight expansions, one per vector lane; inlined into every vector variant of a caller

#define INLINE static inline __attribute__((always_inline))

enum {
    LANES = EXPANSION_LANES,
    DEGREES = EXPANSION_HARMONIC + 1,
    MIXED = EXPANSION_MIXED + 1,
    DEPTH = EXPANSION_MIXED / 2 + 1
};
typedef double lanes __attribute__((vector_size(LANES * sizeof(double))));

/* The number of coefficients with m - n = k. */
INLINE int depth(struct expansion_order order, int k) {
    return order.mixed - k >= 2 ? (order.mixed - k) / 2 + 1 : 1;
}

/* Coefficient (m, n) of each lane at [m - n][n]; coefficients above the degrees in use are not touched. */
struct block {
    lanes re[DEGREES][DEPTH], im[DEGREES][DEPTH];
};

INLINE void block_clear(struct block *block, struct expansion_order order) {
    for (int k = 0; k <= order.harmonic; k++) {
        for (int n = 0; n < depth(order, k); n++) block->re[k][n] = block->im[k][n] = (lanes){0};
    }
}

// 1/k!
static const double inverse_factorial[DEGREES] = {
    1.0,
    1.0,
    0.5,
    0.16666666666666666,
    0.041666666666666664,
    0.0083333333333333332,
    0.0013888888888888889,
    0.00019841269841269841,
    2.4801587301587302e-05,
    2.7557319223985893e-06,
    2.7557319223985888e-07,
    2.505210838544172e-08,
    2.08767569878681e-09,
    1.6059043836821613e-10,
    1.1470745597729725e-11,
    7.6471637318198164e-13,
    4.7794773323873853e-14,
    2.8114572543455206e-15,
    1.5619206968586225e-16,
    8.2206352466243295e-18,
    4.1103176233121648e-19,
    1.9572941063391263e-20,
    8.8967913924505741e-22,
    3.8681701706306841e-23,
    1.6117375710961184e-24,
};

// ---- expansions of several boxes, one in each lane ----

// put n coefficients into one lane; memcpy, because an indexed assignment rewrites the whole vector
INLINE void lane_read(lanes *re, lanes *im, int lane, const double *from, int n) {
    const size_t offset = (size_t)lane * sizeof(double);
    for (int i = 0; i < n; i++) {
        memcpy((char *)&re[i] + offset, from + 2 * i, sizeof(double));
        memcpy((char *)&im[i] + offset, from + 2 * i + 1, sizeof(double));
    }
}

// put an expansion into one lane; degrees above the expansion are 0
INLINE void block_read(struct block *block, struct expansion_order order, int lane, const struct expansion *expansion) {
    static const double zero[2 * DEPTH];
    const struct expansion_order own = expansion->order;
    const double *from = expansion->value;

    for (int k = 0; k <= order.harmonic; k++) {
        const int n = depth(order, k), all = k <= own.harmonic ? depth(own, k) : 0, end = n < all ? n : all;
        lane_read(block->re[k], block->im[k], lane, from, end);
        lane_read(block->re[k] + end, block->im[k] + end, lane, zero, n - end);
        from += 2 * all;
    }
}

// add the coefficients of one lane to an expansion of at least the degrees of order
INLINE void block_add(const struct expansion *expansion, struct expansion_order order, const struct block *block,
                      int lane) {
    double *to = expansion->value;
    for (int k = 0; k <= order.harmonic; k++) {
        const double *const re = (const double *)block->re[k] + lane, *const im = (const double *)block->im[k] + lane;
        for (int n = 0; n < depth(order, k); n++) {
            to[2 * n] += re[n * LANES];
            to[2 * n + 1] += im[n * LANES];
        }
        to += 2 * depth(expansion->order, k);
    }
}

// multiply coefficient (m, n) by g^m g'^n; divide: also by 1/(m! n!)
INLINE void block_scale(struct block *block, struct expansion_order order, const lanes *re, const lanes *im,
                        int divide) {
    const lanes square = *re * *re + *im * *im;
    lanes power_re = {0}, power_im = {0};
    power_re += 1;

    for (int k = 0; k <= order.harmonic; k++) {
        lanes a = power_re, b = power_im;
        for (int n = 0; n < depth(order, k); n++) {
            const double factor = divide ? inverse_factorial[n + k] * inverse_factorial[n] : 1;
            const lanes c = block->re[k][n] * factor, d = block->im[k][n] * factor;
            block->re[k][n] = a * c - b * d;
            block->im[k][n] = a * d + b * c;
            a *= square;
            b *= square;
        }

        const lanes next = power_re * *re - power_im * *im;
        power_im = power_re * *im + power_im * *re;
        power_re = next;
    }
}

// ---- M2M and L2L: shift of the centre of an expansion ----

// all terms (m, n) up to the mixed degree; a block holds the half m >= n
struct square {
    lanes re[MIXED][MIXED], im[MIXED][MIXED];  // [n][m]
};

INLINE void square_read(struct square *square, const struct block *block, int mixed) {
    for (int n = 0; 2 * n <= mixed; n++) {
        square->re[n][n] = block->re[0][n];
        square->im[n][n] = block->im[0][n];
        for (int m = n + 1; m + n <= mixed; m++) {
            square->re[n][m] = square->re[m][n] = block->re[m - n][n];
            square->im[n][m] = block->im[m - n][n];
            square->im[m][n] = -block->im[m - n][n];
        }
    }
}

// value += d other
INLINE void add_product(lanes *re, lanes *im, const lanes *other_re, const lanes *other_im, const lanes *d_re,
                        const lanes *d_im) {
    const lanes a = *other_re, b = *other_im;
    *re += *d_re * a - *d_im * b;
    *im += *d_re * b + *d_im * a;
}

// Multipole coefficients about a centre moved by d: M_m = sum_i binomial(m, i) d^(m-i) M_i, as repeated sums. stride:
// from one degree to the next.
INLINE void multipole_shift(lanes *re, lanes *im, int stride, int degree, const lanes *d_re, const lanes *d_im) {
    for (int s = degree - 1; s >= 0; s--) {
        for (int i = s; i < degree; i++) {
            const int from = i * stride, to = from + stride;
            add_product(&re[to], &im[to], &re[from], &im[from], d_re, d_im);
        }
    }
}

// Local coefficients a <= last about a centre moved by d: L_a = sum_i binomial(i, a) d^(i-a) L_i.
INLINE void local_shift(lanes *re, lanes *im, int stride, int degree, int last, const lanes *d_re, const lanes *d_im) {
    for (int s = 0; s < degree && s <= last; s++) {
        for (int i = degree - 1; i >= s; i--) {
            const int to = i * stride, from = to + stride;
            add_product(&re[to], &im[to], &re[from], &im[from], d_re, d_im);
        }
    }
}

KERNEL_WIDE(void, expansions_m2m,
            (const struct tree_boxes *boxes, int parent, int n_parents, const struct expansion *multipole),
            (boxes, parent, n_parents, multipole)) {
    struct expansion_order order = {-1, 0};
    for (int i = 0; i < n_parents; i++) order = expansion_order_max(order, multipole[parent + i].order);
    if (order.harmonic < 0) return;
    struct block block;
    block_clear(&block, order);
    lanes d_re = {0}, d_im = {0}, scale = {0}, zero = {0};

    for (int i = 0; i < 2 * n_parents; i++) {
        const int child = 2 * parent + 1 + i;
        if (multipole[parent + i / 2].order.harmonic < 0) continue;
        block_read(&block, order, i, &multipole[child]);
        const struct tree_box *const from = &boxes->box[child], *const to = &boxes->box[parent + i / 2];
        d_re[i] = (to->x - from->x) / to->radius;
        d_im[i] = (to->y - from->y) / to->radius;
        scale[i] = from->radius / to->radius;
    }

    block_scale(&block, order, &scale, &zero, 0);
    struct square square;
    square_read(&square, &block, order.mixed);
    const lanes back = -d_im;

    // shift by d' in z', for every m; then by d in z, for every n
    for (int m = 0; m <= order.mixed; m++) {
        multipole_shift(&square.re[0][m], &square.im[0][m], MIXED, order.mixed - m, &d_re, &back);
    }

    for (int n = 1; 2 * n <= order.mixed; n++) {
        multipole_shift(square.re[n], square.im[n], 1, order.mixed - n, &d_re, &d_im);
    }

    multipole_shift(block.re[0], block.im[0], DEPTH, order.harmonic, &d_re, &d_im);

    // back to blocks
    for (int n = 1; 2 * n <= order.mixed; n++) {
        for (int m = n; m + n <= order.mixed; m++) {
            block.re[m - n][n] = square.re[n][m];
            block.im[m - n][n] = square.im[n][m];
        }
    }

    // add both halves of every parent
    for (int i = 0; i < n_parents; i++) {
        const struct expansion_order own = multipole[parent + i].order;
        if (own.harmonic < 0) continue;
        double *to = multipole[parent + i].value;

        for (int k = 0; k <= own.harmonic; k++) {
            for (int n = 0; n < depth(own, k); n++) {
                *to++ = block.re[k][n][2 * i] + block.re[k][n][2 * i + 1];
                *to++ = block.im[k][n][2 * i] + block.im[k][n][2 * i + 1];
            }
        }
    }
}

KERNEL_WIDE(void, expansions_l2l,
            (const struct tree_boxes *boxes, int parent, int n_parents, const struct expansion *local),
            (boxes, parent, n_parents, local)) {
    struct expansion_order order = {-1, 0};
    for (int i = 0; i < n_parents; i++) order = expansion_order_max(order, local[parent + i].order);
    if (order.harmonic < 0) return;
    struct block block;
    block_clear(&block, order);
    lanes d_re = {0}, d_im = {0}, scale = {0}, zero = {0};

    for (int i = 0; i < 2 * n_parents; i++) {
        if (local[parent + i / 2].order.harmonic < 0) continue;
        block_read(&block, order, i, &local[parent + i / 2]);
        const struct tree_box *const from = &boxes->box[parent + i / 2], *const to = &boxes->box[2 * parent + 1 + i];
        d_re[i] = (to->x - from->x) / from->radius;
        d_im[i] = (to->y - from->y) / from->radius;
        scale[i] = to->radius / from->radius;
    }

    struct square square;
    square_read(&square, &block, order.mixed);
    const lanes back = -d_im;

    // shift by d in z, for every b; then by d' in z', for every a >= b
    local_shift(block.re[0], block.im[0], DEPTH, order.harmonic, order.harmonic, &d_re, &d_im);
    for (int b = 1; b <= order.mixed; b++) {
        local_shift(square.re[b], square.im[b], 1, order.mixed - b, order.mixed, &d_re, &d_im);
    }

    for (int a = 1; a <= order.mixed; a++) {
        square.re[0][a] = block.re[a][0];
        square.im[0][a] = block.im[a][0];
        local_shift(&square.re[0][a], &square.im[0][a], MIXED, order.mixed - a, a, &d_re, &back);

        for (int b = 0; b <= a && a + b <= order.mixed; b++) {
            block.re[a - b][b] = square.re[b][a];
            block.im[a - b][b] = square.im[b][a];
        }
    }

    block_scale(&block, order, &scale, &zero, 0);
    for (int i = 0; i < 2 * n_parents; i++) {
        const struct expansion_order from = local[parent + i / 2].order;
        if (from.harmonic >= 0) block_add(&local[2 * parent + 1 + i], from, &block, i);
    }
}

// ---- M2L: multipole to local expansions ----

// D_kl = D_lk = k! l! d_kl at [k - l][l]
struct derivatives {
    lanes d[DEGREES][DEPTH];
};

// H_kl is the same derivative of 1/(1 + 2 c Re z + z z'). The product with the denominator gives H_kl = -(c (k H_(k-1)l
// + l H_k(l-1)) + k l H_(k-1)(l-1)), and D_kl = c H_(k-1)l + l H_(k-1)(l-1), from dPhi/dz = (c + z')/(1 + 2 c Re z + z
// z').
INLINE void phi_derivatives(struct derivatives *out, struct expansion_order order, const lanes *c) {
    lanes h[MIXED][MIXED];  // [l][k], k >= l
    lanes harmonic = {0};
    harmonic += 1;
    out->d[0][0] = (lanes){0};

    for (int k = 1; k <= order.harmonic; k++) {
        out->d[k][0] = *c * harmonic;
        if (k <= MIXED) h[0][k - 1] = harmonic;
        harmonic *= *c * -(double)k;
    }

    for (int l = 1; 2 * l <= order.mixed; l++) {
        for (int k = l; k + l <= order.mixed; k++) {
            const lanes left = k > l ? h[l][k - 1] : h[l - 1][k];
            h[l][k] = -(*c * ((double)k * left + (double)l * h[l - 1][k]) + (double)(k * l) * h[l - 1][k - 1]);
            out->d[k - l][l] = *c * left + (double)l * h[l - 1][k - 1];
        }
    }
}

// sum[i] += sum_j d[i + j] m[j], i + j < n
INLINE void correlate(int n, const lanes *d_re, const lanes *d_im, const lanes *m_re, const lanes *m_im, lanes *sum_re,
                      lanes *sum_im) {
#pragma GCC unroll 16
    for (int i = 0; i < n; i++) {
        lanes re = sum_re[i], im = sum_im[i];

#pragma GCC unroll 16
        for (int j = 0; i + j < n; j++) {
            re += d_re[i + j] * m_re[j];
            im += d_im[i + j] * m_im[j];
        }
        sum_re[i] = re;
        sum_im[i] = im;
    }
}

// All local coefficients with a - b = alpha: the sum over all multipole coefficients. The coefficients with m - n = mu
// are multiplied by D with k - l = alpha + mu, the conjugate coefficients by D with k - l = alpha - mu. Each factor D
// depends on b + n only.
INLINE void m2l_sums(const struct derivatives *derivatives, const struct block *multipole, struct expansion_order order,
                     int alpha, struct block *result) {
    lanes *const re = result->re[alpha], *const im = result->im[alpha];
    for (int b = 0; b < depth(order, alpha); b++) re[b] = im[b] = (lanes){0};

    // harmonic terms above the mixed degree
    const int rest = order.mixed - alpha;
    for (int mu = rest < 0 ? 0 : rest + 1; mu <= order.harmonic - alpha; mu++) {
        correlate(1, derivatives->d[alpha + mu], derivatives->d[alpha + mu], multipole->re[mu], multipole->im[mu], re,
                  im);
    }

    if (rest >= 0)
        correlate(rest / 2 + 1, derivatives->d[alpha], derivatives->d[alpha], multipole->re[0], multipole->im[0], re,
                  im);

    for (int mu = 1; mu <= rest; mu++) {
        const int n = (rest - mu) / 2 + 1, min = alpha < mu ? alpha : mu;
        const lanes *const d = derivatives->d[alpha + mu], *const other = derivatives->d[alpha + mu - 2 * min] + min;
        lanes d_re[DEPTH], d_im[DEPTH];

        for (int i = 0; i < n; i++) {
            d_re[i] = d[i] + other[i];
            d_im[i] = d[i] - other[i];
        }

        const lanes *const from_re = multipole->re[mu], *const from_im = multipole->im[mu];
        // the compiler unrolls sums of constant length
        _Static_assert(DEPTH == 8, "n is at most 7");

        switch (n) {
            case 1: correlate(1, d_re, d_im, from_re, from_im, re, im); break;
            case 2: correlate(2, d_re, d_im, from_re, from_im, re, im); break;
            case 3: correlate(3, d_re, d_im, from_re, from_im, re, im); break;
            case 4: correlate(4, d_re, d_im, from_re, from_im, re, im); break;
            case 5: correlate(5, d_re, d_im, from_re, from_im, re, im); break;
            case 6: correlate(6, d_re, d_im, from_re, from_im, re, im); break;
            default: correlate(DEPTH - 1, d_re, d_im, from_re, from_im, re, im); break;
        }
    }
}

// M2L of n <= LANES pairs
INLINE void m2l(const struct tree_boxes *targets, const struct tree_boxes *sources, double smoothing, int n,
                const struct expansions_pair *pair, const struct expansion *multipole, const struct expansion *local) {
    struct expansion_order order = pair[0].order;
    for (int i = 1; i < n; i++) order = expansion_order_max(order, pair[i].order);
    struct block block;
    lanes c = {0}, source_re = {0}, source_im = {0}, target_re = {0}, target_im = {0};

    for (int i = 0; i < n; i++) {
        const struct tree_box *const to = &targets->box[pair[i].target], *const from = &sources->box[pair[i].source];
        block_read(&block, order, i, &multipole[pair[i].source]);
        const double rx = to->x - from->x, ry = to->y - from->y;
        const double distance = sqrt(rx * rx + ry * ry);
        const double scale = sqrt(rx * rx + ry * ry + smoothing * smoothing);
        const double turn_re = distance > 0 ? rx / distance : 1, turn_im = distance > 0 ? -ry / distance : 0;
        c[i] = distance / scale;
        source_re[i] = turn_re * from->radius / scale;
        source_im[i] = turn_im * from->radius / scale;
        target_re[i] = turn_re * to->radius / scale;
        target_im[i] = turn_im * to->radius / scale;
    }

    // scale to the units of the pair, multiply by the derivatives, scale to the units of the target
    const struct expansion none = {.order = {-1, 0}};
    for (int i = n; i < LANES; i++) block_read(&block, order, i, &none);
    block_scale(&block, order, &source_re, &source_im, 1);
    struct derivatives derivatives;
    phi_derivatives(&derivatives, order, &c);
    struct block result;
    for (int alpha = 0; alpha <= order.harmonic; alpha++) m2l_sums(&derivatives, &block, order, alpha, &result);
    block_scale(&result, order, &target_re, &target_im, 1);
    for (int i = 0; i < n; i++) block_add(&local[pair[i].target], pair[i].order, &result, i);
}

KERNEL_WIDE(void, expansions_m2l,
            (const struct tree_boxes *targets, const struct tree_boxes *sources, double smoothing, int n,
             const struct expansions_pair *pair, const struct expansion *multipole, const struct expansion *local),
            (targets, sources, smoothing, n, pair, multipole, local)) {
    for (int i = 0; i < n; i += LANES) {
        m2l(targets, sources, smoothing, n - i < LANES ? n - i : LANES, pair + i, multipole, local);
    }
}

// ---- P2M and L2P for eight points at a time, one per vector lane. Declared in expansions.h

static const double two_pi = 6.28318530717958647692;

int expansions_size(struct expansion_order order) {
    int n = 0;
    for (int k = 0; k <= order.harmonic; k++) n += depth(order, k);
    return n;
}

// ---- P2M: points to multipole expansions ----

// sum of all lanes, in a fixed order
INLINE double lanes_sum(const lanes *value) {
    const lanes a = *value;
    return ((a[0] + a[1]) + (a[2] + a[3])) + ((a[4] + a[5]) + (a[6] + a[7]));
}

// read n points; the other lanes hold the last point with weight 0
INLINE void points_read(lanes *block, const double *value, int n, int is_weight) {
    if (n >= LANES) {
        memcpy(block, value, sizeof *block);
    } else {
        for (int i = 0; i < LANES; i++) (*block)[i] = i < n ? value[i] : (is_weight ? 0 : value[n - 1]);
    }
}

KERNEL_WIDE(void, expansions_p2m, (const struct tree_boxes *boxes, int box, const struct expansion *multipole),
            (boxes, box, multipole)) {
    const struct tree_box *const own = &boxes->box[box];
    const struct expansion_order order = multipole->order;
    struct block block;
    block_clear(&block, order);
    const double inverse = 1 / own->radius;

    for (int i = 0; i < own->n; i += 2 * LANES) {
        const int n0 = own->n - i, n1 = n0 > LANES ? n0 - LANES : 0;
        const int first = own->first + i, second = n1 > 0 ? first + LANES : first;
        lanes x0, y0, w0, x1, y1, w1 = {0};
        points_read(&x0, boxes->x + first, n0, 0);
        points_read(&y0, boxes->y + first, n0, 0);
        points_read(&w0, boxes->weight + first, n0, 1);
        points_read(&x1, boxes->x + second, n1 > 0 ? n1 : n0, 0);
        points_read(&y1, boxes->y + second, n1 > 0 ? n1 : n0, 0);
        if (n1 > 0) points_read(&w1, boxes->weight + second, n1, 1);
        x0 = (own->x - x0) * inverse;
        y0 = (own->y - y0) * inverse;
        x1 = (own->x - x1) * inverse;
        y1 = (own->y - y1) * inverse;
        const lanes square0 = x0 * x0 + y0 * y0, square1 = x1 * x1 + y1 * y1;

        // (m, n) = |s|^2n s^(m-n)
        lanes re0 = w0, im0 = {0}, re1 = w1, im1 = {0};
        for (int k = 0; k <= order.harmonic; k++) {
            lanes a0 = re0, b0 = im0, a1 = re1, b1 = im1;
            for (int n = 0; n < depth(order, k); n++) {
                block.re[k][n] += a0 + a1;
                block.im[k][n] += b0 + b1;
                a0 *= square0;
                b0 *= square0;
                a1 *= square1;
                b1 *= square1;
            }

            const lanes next0 = re0 * x0 - im0 * y0, next1 = re1 * x1 - im1 * y1;
            im0 = re0 * y0 + im0 * x0;
            im1 = re1 * y1 + im1 * x1;
            re0 = next0;
            re1 = next1;
        }
    }

    double *to = multipole->value;
    for (int k = 0; k <= order.harmonic; k++) {
        for (int n = 0; n < depth(order, k); n++) {
            *to++ = lanes_sum(&block.re[k][n]);
            *to++ = lanes_sum(&block.im[k][n]);
        }
    }
}

// ---- L2P: local expansions to points ----

// With t the position and q = t t': Phi = A_0(q) + 2 Re sum_k t^k A_k(q). Evaluate A_k and the derivatives of A_k at q;
// the second derivative is halved.
INLINE void row_sums(int n, const double *value, const lanes *square, lanes re[3], lanes im[3], int n_derivatives) {
    for (int i = 0; i <= n_derivatives; i++) re[i] = im[i] = (lanes){0};
    while (n-- > 0) {
        for (int i = n_derivatives; i > 0; i--) {
            re[i] = re[i] * *square + re[i - 1];
            im[i] = im[i] * *square + im[i - 1];
        }
        re[0] = re[0] * *square + value[2 * n];
        im[0] = im[0] * *square + value[2 * n + 1];
    }
}

// sum = sum t + factor term
INLINE void horner(lanes sum_of[2], const lanes *x, const lanes *y, double factor, const lanes *re, const lanes *im) {
    const lanes next = sum_of[0] * *x - sum_of[1] * *y + factor * *re;
    sum_of[1] = sum_of[0] * *y + sum_of[1] * *x + factor * *im;
    sum_of[0] = next;
}

// dPhi/dz at points (x, y) in units of the radius
INLINE void local_field(const struct expansion *local, const lanes *x, const lanes *y, lanes f[2]) {
    const lanes square = *x * *x + *y * *y;
    lanes p[2] = {{0}, {0}}, q[2] = {{0}, {0}};  // sum_k k t^(k-1) A_k, sum_k t^k A_k'
    lanes re[3], im[3];
    const double *value = local->value + 2 * expansions_size(local->order);

    for (int k = local->order.harmonic; k > 0; k--) {
        const int n = depth(local->order, k);
        value -= 2 * n;
        row_sums(n, value, &square, re, im, 1);
        horner(p, x, y, k, &re[0], &im[0]);
        horner(q, x, y, 1, &re[1], &im[1]);
    }

    row_sums(depth(local->order, 0), local->value, &square, re, im, 1);
    const lanes slope = re[1] + 2 * (q[0] * *x - q[1] * *y);
    f[0] = p[0] + *x * slope;
    f[1] = p[1] - *y * slope;
}

// f = dPhi/dz and the derivatives f_z by z and f_c by z'; f_c is real
INLINE void local_field_gradient(const struct expansion *local, const lanes *x, const lanes *y, lanes f[2],
                                 lanes f_z[2], lanes *f_c) {
    const lanes square = *x * *x + *y * *y;
    // sums over k of k t^(k-1) A_k, k (k-1) t^(k-2) A_k, k t^(k-1) A_k', t^k A_k', t^k A_k''/2
    lanes p[2] = {{0}, {0}}, pp[2] = {{0}, {0}}, pq[2] = {{0}, {0}}, q[2] = {{0}, {0}}, qq[2] = {{0}, {0}};
    lanes re[3], im[3];
    const double *value = local->value + 2 * expansions_size(local->order);

    for (int k = local->order.harmonic; k > 0; k--) {
        const int n = depth(local->order, k);
        value -= 2 * n;
        row_sums(n, value, &square, re, im, 2);
        if (k > 1) horner(pp, x, y, k * (k - 1), &re[0], &im[0]);
        horner(p, x, y, k, &re[0], &im[0]);
        horner(pq, x, y, k, &re[1], &im[1]);
        horner(q, x, y, 1, &re[1], &im[1]);
        horner(qq, x, y, 1, &re[2], &im[2]);
    }

    row_sums(depth(local->order, 0), local->value, &square, re, im, 2);
    const lanes slope = re[1] + 2 * (q[0] * *x - q[1] * *y);
    const lanes bend = 2 * (re[2] + 2 * (qq[0] * *x - qq[1] * *y));
    f[0] = p[0] + *x * slope;
    f[1] = p[1] - *y * slope;
    f_z[0] = pp[0] + 2 * (pq[0] * *x + pq[1] * *y) + (*x * *x - *y * *y) * bend;
    f_z[1] = pp[1] + 2 * (pq[1] * *x - pq[0] * *y) - 2 * *x * *y * bend;
    *f_c = slope + 2 * (pq[0] * *x - pq[1] * *y) + square * bend;
}

INLINE void points_add(double *value, const lanes *block, int n) {
    for (int i = 0; i < LANES && i < n; i++) value[i] += (*block)[i];
}

KERNEL_WIDE(void, expansions_l2p,
            (const struct tree_boxes *boxes, int box, const struct expansion *local, double *u, double *v,
             double *const gradient[3]),
            (boxes, box, local, u, v, gradient)) {
    const struct tree_box *const own = &boxes->box[box];
    const double inverse = 1 / own->radius, unit = inverse / two_pi;
    for (int i = 0; i < own->n; i += LANES) {
        const int first = own->first + i, n = own->n - i;
        lanes x, y, f[2], f_z[2], f_c;
        points_read(&x, boxes->x + first, n, 0);
        points_read(&y, boxes->y + first, n, 0);
        x = (x - own->x) * inverse;
        y = (y - own->y) * inverse;

        if (gradient) {
            local_field_gradient(local, &x, &y, f, f_z, &f_c);
            const lanes u_x = f_z[1] * unit * inverse;
            const lanes u_y = (f_z[0] - f_c) * unit * inverse, v_x = (f_z[0] + f_c) * unit * inverse;
            points_add(gradient[0] + first, &u_x, n);
            points_add(gradient[1] + first, &u_y, n);
            points_add(gradient[2] + first, &v_x, n);
        } else {
            local_field(local, &x, &y, f);
        }

        const lanes to_u = f[1] * unit, to_v = f[0] * unit;
        points_add(u + first, &to_u, n);
        points_add(v + first, &to_v, n);
    }
}
