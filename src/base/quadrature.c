/* quadrature.c: the zeros of Legendre polynomials by Newton's method. */
#include "base/quadrature.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

// P_n and derivative of P_n at x, by the recurrence (i + 1) P_(i+1) = (2 i + 1) x P_i - i P_(i-1)
static double legendre(int n, double x, double *slope) {
    double before = 1, value = x;
    for (int i = 1; i < n; i++) {
        const double next = ((2 * i + 1) * x * value - i * before) / (i + 1);
        before = value;
        value = next;
    }

    *slope = n * (x * value - before) / (x * x - 1);
    return value;
}

void quadrature_legendre(int n, double *node, double *weight) {
    for (int i = 0; i < n; i++) {
        // Tricomi's estimate has at least three correct digits: five iterations converge to rounding
        double x = -cos(pi * (i + 0.75) / (n + 0.5)), slope = 1;
        for (int iteration = 0; iteration < 5; iteration++) x -= legendre(n, x, &slope) / slope;
        legendre(n, x, &slope);
        node[i] = (1 + x) / 2;
        weight[i] = 1 / ((1 - x * x) * slope * slope);
    }
}

double quadrature_newest(int n, const double t[3], const double value[3]) {
    const double h = t[0] - t[1], slope = (value[0] - value[1]) / h;
    double area = h * (value[0] + value[1]) / 2;
    if (n == 3) area -= h * h * h / 6 * (slope - (value[1] - value[2]) / (t[1] - t[2])) / (t[0] - t[2]);
    return area;
}
