/* treecode.h: the velocity of many smoothed vortices at many points in less than n^2 time, to a stated error.
 * doc/performance.md, section "Fast summation". Tested by tests/vortex/test_treecode.c.
 *
 * Vortices and targets are sorted into boxes (tree_boxes.h). Two boxes that are far from each other interact by series
 * (expansions.h), whose degrees are chosen for every pair so that they meet the tolerance; boxes near each other by
 * the direct sum of kernel.h. At every target x
 *
 *     |error of the velocity| <= tolerance A,      A = sum_j |Gamma_j| / (2 pi sqrt(|x - x_j|^2 + e^2)):
 *
 * A is about the velocity that the vortices would have if nothing cancelled. That is what tests hold it to; the bound
 * that the degrees are chosen by is 4 times more, errors in wakes are 100 times less. The error of a gradient is at
 * most 50 tolerance sum_j |Gamma_j| / (2 pi (|x - x_j|^2 + e^2)). Rounding adds some 1e-15 of the same sums.
 *
 * The sums are in an order that depends on the points only: same bits for any number of threads. */
#ifndef TREECODE_H
#define TREECODE_H

#include "base/status.h"

struct treecode;

/* An empty tree. Memory grows as needed and is kept for the next call. Fails with STATUS_MEMORY. treecode_free accepts
 * NULL. */
enum status treecode_create(struct treecode **tree);
void treecode_free(struct treecode *tree);

/* Put n vortices of one smoothing length into the tree, in place of those it had; the arrays are copied. tolerance:
 * see above; 1e-13 is the least that makes sense. Fails with STATUS_MEMORY: the tree is then empty. */
enum status treecode_build(struct treecode *tree, int n, const double *x, const double *y, const double *circulation,
                           double smoothing, double tolerance);

/* Add to (u, v) at each target the velocity of all vortices. A vortex at a target adds 0. Fails with STATUS_MEMORY:
 * nothing is then added. */
enum status treecode_add_velocity(struct treecode *tree, int n_targets, const double *x, const double *y, int threads,
                                  double *u, double *v);

/* The same, and add the gradient as kernel_add_gradient does. */
enum status treecode_add_gradient(struct treecode *tree, int n_targets, const double *x, const double *y, int threads,
                                  double *u, double *v, double *u_x, double *u_y, double *v_x);

#endif
