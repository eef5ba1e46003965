/* tree.h: the velocity and divergence of many vortices or vortex rings (kernel.h) at many points to a given tolerance,
 * cheaper than the direct sum. doc/performance.md, section 4. Tested by tests/flow/test_tree.c.
 *
 * Rings and targets are sorted into boxes (tree_boxes.h). In place, and in the lengths h = b^2/2 + s, the kernel is
 * smooth between distant boxes, and polynomials at Chebyshev nodes represent it on both sides:
 *
 *     upward pass      strengths of the rings -> strengths at the nodes of the leaves -> nodes of the parents
 *     far field        nodes of boxes of sources -> nodes of boxes of targets, by the kernel
 *     downward pass    values at the nodes of parents -> nodes of the halves -> targets
 *     leaves           the direct sums of the near field
 *
 * A pair of boxes has its own number of nodes per axis. The order of the sums depends on the points only: the bits do
 * not depend on the number of threads. */
#ifndef TREE_H
#define TREE_H

#include "flow/kernel.h"

struct tree;

/* An empty tree; the memory is kept for the next sum. */
struct tree *tree_create(struct arena *arena);

/* Whether the tree is faster than this number of direct interactions; never for the tolerance 0. */
int tree_is_faster(const struct kernel *kernel, int n_rings, double n_interactions, double tolerance);

/* kernel_induce for all rings; neither rings nor targets have a `square`, and `edge` and `leg_u` of the targets are not
 * used. The errors of the velocity and of length div u are below tolerance, m s-1, and for rings of one sign below
 * tolerance A, with A the velocity without cancellation over 1 m s-1, where A > 1: the tests check these errors.
 * Gradients are the derivatives of the same polynomials. */
void tree_induce(struct tree *tree, const struct kernel_pair *pair, const struct sources *rings, double length,
                 double tolerance, int threads, const struct targets *at);

/* Number of evaluations of the kernel in the last sum. */
double tree_interactions(const struct tree *tree);

#endif
