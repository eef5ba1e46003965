/* mathematics.h: small functions on numbers that several folders share: angles, smooth ramps, quadrature, boxes. Tested
 * by tests/base/test_mathematics.c. */
#ifndef MATHEMATICS_H
#define MATHEMATICS_H

#include <math.h>
#include <stdbool.h>

/* The larger and the smaller of two numbers; NaN, unlike fmax and fmin, if one of the numbers is NaN. */
static inline double larger(double a, double b) {
    return a > b || isnan(a) ? a : b;
}
static inline double smaller(double a, double b) {
    return a < b || isnan(a) ? a : b;
}

/* The angle [rad] minus an integer number of turns, in [-pi, pi]. */
double angle_wrap(double angle);

/* Radians of an angle in degrees, and back. */
double angle_radians(double degrees);
double angle_degrees(double radians);

/* The smooth step S(q) = q^4 (35 - 84 q + 70 q^2 - 20 q^3) on [0, 1], 0 before, 1 after, with three continuous
 * derivatives, and dS/dq. doc/model.md, section 4. */
double ramp_step(double q);
double ramp_step_rate(double q);

/* S(t / duration), 1 at all times if the duration is 0, and its derivative with respect to t. */
double ramp_value(double t, double duration);
double ramp_rate(double t, double duration);

/* The n nodes, in ascending order, and weights of Gauss-Legendre quadrature on [0, 1]: exact for polynomials of degree
 * 2 n - 1. Each array (n). */
void quadrature_legendre(int n, double *node, double *weight);

/* The n nodes, in ascending order, and weights of the Gauss rule of a sum of n_terms >= n terms, sum_i weight_i f(x_i)
 * with all x different and all weights above 0: exact for polynomials f of degree 2 n - 1. scratch (2 n_terms), node
 * and node_weight (n). */
enum { QUADRATURE_MOST_NODES = 16 };
void quadrature_of_sum(int n_terms, const double *x, const double *weight, double *scratch, int n, double *node,
                       double *node_weight);

/* The integral over the newest interval, t[1] to t[0], of the parabola through the values at three times (n = 3), or of
 * the line through two (n = 2); the newest first. */
double quadrature_newest(int n, const double t[3], const double value[3]);

/* Twice the signed area of a triangle of points (x, y), positive for a left turn; whether the segments a b and c d
 * cross inside. */
static inline double triangle_area(const double *a, const double *b, const double *c) {
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}
static inline bool segments_cross(const double *a, const double *b, const double *c, const double *d) {
    return triangle_area(a, b, c) * triangle_area(a, b, d) < 0 && triangle_area(c, d, a) * triangle_area(c, d, b) < 0;
}

/* A rectangle with sides along the axes: corners, m; the box of no points has low INFINITY and high -INFINITY. */
struct box {
    double low[2], high[2];
};

/* The box around n points. */
struct box box_around(int n, const double *x, const double *y);

/* The box around two boxes. */
struct box box_union(struct box a, struct box b);

/* The box with a margin on every side, m. */
struct box box_widen(struct box box, double margin);

/* The larger of the gaps between two boxes along x and along y, m: at most 0 for boxes that touch or overlap. Lower
 * bound of the distance between points of both boxes. */
double box_gap(const struct box *a, const struct box *b);

#endif
