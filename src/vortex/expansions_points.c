/* expansions_points.c: P2M and L2P for eight points at a time, one per vector lane. Declared in expansions.h. */
#include <string.h>

#include "vortex/expansions_lanes.h"
#include "vortex/kernel.h"

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
