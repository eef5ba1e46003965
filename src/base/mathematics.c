/* mathematics.c: small functions on numbers that several folders share. */
#include "base/mathematics.h"

#include <math.h>
#include <stddef.h>

double angle_wrap(double angle) {
    return remainder(angle, 2 * M_PI);
}

double angle_radians(double degrees) {
    return degrees * (M_PI / 180);
}

double angle_degrees(double radians) {
    return radians * (180 / M_PI);
}

// ---- the smooth step, and ramps in time

double ramp_step(double q) {
    if (q <= 0) return 0;
    if (q >= 1) return 1;
    return q * q * q * q * (35 + q * (-84 + q * (70 - 20 * q)));
}

double ramp_step_rate(double q) {
    if (q <= 0 || q >= 1) return 0;
    const double p = q * (1 - q);
    return 140 * p * p * p;
}

double ramp_value(double t, double duration) {
    return duration > 0 ? ramp_step(t / duration) : 1;
}

double ramp_rate(double t, double duration) {
    return duration > 0 ? ramp_step_rate(t / duration) / duration : 0;
}

// ---- the zeros of Legendre polynomials by Newton's method

void quadrature_legendre(int n, double *node, double *weight) {
    enum { ITERATIONS = 5 };
    for (int i = 0; i < n; i++) {
        // Tricomi's estimate has at least three correct digits: five iterations converge to rounding
        double x = -cos(M_PI * (i + 0.75) / (n + 0.5)), slope = 1;
        for (int iteration = 0; iteration <= ITERATIONS; iteration++) {
            // P_n and derivative of P_n at x, by the recurrence (k + 1) P_(k+1) = (2 k + 1) x P_k - k P_(k-1)
            double before = 1, value = x;
            for (int k = 1; k < n; k++) {
                const double next = ((2 * k + 1) * x * value - k * before) / (k + 1);
                before = value;
                value = next;
            }
            slope = n * (x * value - before) / (x * x - 1);
            if (iteration < ITERATIONS) x -= value / slope;
        }
        node[i] = (1 + x) / 2;
        weight[i] = 1 / ((1 - x * x) * slope * slope);
    }
}

// ---- Gauss rule of a sum: the zeros of the orthogonal polynomials of Stieltjes' recurrence
//      p_k+1 = (x - a_k) p_k - b_k p_k-1

struct recurrence {
    double a[QUADRATURE_MOST_NODES], b[QUADRATURE_MOST_NODES]; /* b_0: the sum of the weights */
};

// p_n at x; norm, if not NULL: the sum of p_k^2/(b_1 .. b_k) of all k below n
static double recurrence_value(const struct recurrence *of, int n, double x, double *norm) {
    double before = 0, value = 1, size = 1;
    if (norm) *norm = 0;
    for (int k = 0; k < n; k++) {
        if (k > 0) size *= of->b[k];
        if (norm) *norm += value * value / size;
        const double next = (x - of->a[k]) * value - (k > 0 ? of->b[k] * before : 0);
        before = value;
        value = next;
    }
    return value;
}

void quadrature_of_sum(int n_terms, const double *x, const double *weight, double *scratch, int n, double *node,
                       double *node_weight) {
    struct recurrence of;
    double *const value = scratch, *const before = scratch + n_terms;
    double low = INFINITY, high = -INFINITY, last = 1;
    for (int i = 0; i < n_terms; i++) {
        value[i] = 1;
        before[i] = 0;
        low = fmin(low, x[i]);
        high = fmax(high, x[i]);
    }

    for (int k = 0; k < n; k++) {
        double square = 0, moment = 0;
        for (int i = 0; i < n_terms; i++) {
            square += weight[i] * value[i] * value[i];
            moment += weight[i] * x[i] * value[i] * value[i];
        }

        of.a[k] = moment / square;
        of.b[k] = square / last;
        last = square;
        for (int i = 0; i < n_terms; i++) {
            const double next = (x[i] - of.a[k]) * value[i] - (k > 0 ? of.b[k] * before[i] : 0);
            before[i] = value[i];
            value[i] = next;
        }
    }

    // the zeros of p_k lie between the zeros of p_k-1: bisect
    double zero[QUADRATURE_MOST_NODES + 1];
    for (int k = 1; k <= n; k++) {
        for (int i = 0; i < k; i++) {
            double left = i > 0 ? node[i - 1] : low, right = i < k - 1 ? node[i] : high;
            const int rises = (k - i) % 2 == 1;
            for (int step = 0; step < 64; step++) {
                const double middle = (left + right) / 2;
                if ((recurrence_value(&of, k, middle, NULL) > 0) == rises) {
                    right = middle;
                } else {
                    left = middle;
                }
            }
            zero[i] = (left + right) / 2;
        }
        for (int i = 0; i < k; i++) node[i] = zero[i];
    }

    for (int i = 0; i < n; i++) {
        double norm;
        recurrence_value(&of, n, node[i], &norm);
        node_weight[i] = of.b[0] / norm;
    }
}

double quadrature_newest(int n, const double t[3], const double value[3]) {
    const double h = t[0] - t[1], slope = (value[0] - value[1]) / h;
    double area = h * (value[0] + value[1]) / 2;
    if (n == 3) area -= h * h * h / 6 * (slope - (value[1] - value[2]) / (t[1] - t[2])) / (t[0] - t[2]);
    return area;
}

// ---- smallest and largest coordinates

// fmin and fmax are function calls, too slow here
static double box_smaller(double a, double b) {
    return b < a ? b : a;
}

static double box_larger(double a, double b) {
    return b > a ? b : a;
}

struct box box_around(int n, const double *x, const double *y) {
    struct box box = {{INFINITY, INFINITY}, {-INFINITY, -INFINITY}};
    for (int i = 0; i < n; i++) {
        box.low[0] = box_smaller(box.low[0], x[i]);
        box.low[1] = box_smaller(box.low[1], y[i]);
        box.high[0] = box_larger(box.high[0], x[i]);
        box.high[1] = box_larger(box.high[1], y[i]);
    }

    return box;
}

struct box box_union(struct box a, struct box b) {
    return (struct box){{box_smaller(a.low[0], b.low[0]), box_smaller(a.low[1], b.low[1])},
                        {box_larger(a.high[0], b.high[0]), box_larger(a.high[1], b.high[1])}};
}

struct box box_widen(struct box box, double margin) {
    return (struct box){{box.low[0] - margin, box.low[1] - margin}, {box.high[0] + margin, box.high[1] + margin}};
}

double box_gap(const struct box *a, const struct box *b) {
    double gap = -INFINITY;
    for (int i = 0; i < 2; i++) gap = box_larger(gap, box_larger(a->low[i] - b->high[i], b->low[i] - a->high[i]));
    return gap;
}
