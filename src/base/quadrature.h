/* quadrature.h: Gauss-Legendre quadrature. Tested by tests/base/test_quadrature.c. */
#ifndef QUADRATURE_H
#define QUADRATURE_H

/* The n nodes, in ascending order, and weights of Gauss-Legendre quadrature on [0, 1]: exact for polynomials of degree
 * 2 n - 1. Each array (n). */
void quadrature_legendre(int n, double *node, double *weight);

#endif
