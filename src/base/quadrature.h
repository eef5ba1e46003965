/* quadrature.h: Gauss-Legendre quadrature, and quadrature over the steps of an integrator. Tested by
 * tests/base/test_quadrature.c. */
#ifndef QUADRATURE_H
#define QUADRATURE_H

/* The n nodes, in ascending order, and weights of Gauss-Legendre quadrature on [0, 1]: exact for polynomials of degree
 * 2 n - 1. Each array (n). */
void quadrature_legendre(int n, double *node, double *weight);

/* The integral over the newest interval, t[1] to t[0], of the parabola through the values at three times (n = 3), or of
 * the line through two (n = 2); the newest first. */
double quadrature_newest(int n, const double t[3], const double value[3]);

#endif
