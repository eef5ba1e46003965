/* tree.h: sums the velocity and divergence of many vortices or vortex rings (kernel.h) at many points, to a given
 * tolerance and cheaper than the direct sum. doc/performance.md, section 4. Tested by tests/flow/test_tree.c.
 *
 * Rings and targets are sorted into boxes (tree_boxes.h). Between distant boxes the kernel is smooth, in place and in
 * the lengths h = b^2/2 + s, so polynomials at Chebyshev nodes represent it on both sides:
 *
 *     upward pass      strengths of the rings -> strengths at the nodes of the leaves -> nodes of the parents
 *     far field        nodes of boxes of sources -> nodes of boxes of targets, by the kernel
 *     downward pass    values at the nodes of parents -> nodes of the halves -> targets
 *     leaves           the direct sums of the near field
 *
 * Every pair of boxes has its own number of nodes per axis. The order of the sums depends only on the points, so the
 * bits do not depend on the number of threads. */
#ifndef TREE_H
#define TREE_H

#include <stdbool.h>

#include "flow/kernel.h"

struct tree;

/* An empty tree; the memory is kept for the next sum. */
struct tree *tree_create(struct arena *arena);

/* Whether the tree is faster than this number of direct interactions. With the tolerance 0 it never is. */
bool tree_is_faster(const struct kernel *kernel, int n_rings, double n_interactions, double tolerance);

/* Like kernel_induce for all rings, except that neither rings nor targets have a `square`, and `edge` and `leg_u` of
 * the targets are not used. The errors of the velocity and of length div u are below tolerance, m s-1. For rings of one
 * sign they are below tolerance A if A > 1, where A is the velocity without cancellation over 1 m s-1. The tests check
 * these errors. Gradients are the derivatives of the same polynomials. */
void tree_induce(struct tree *tree, const struct kernel_pair *pair, const struct sources *rings, double length,
                 double tolerance, int threads, const struct targets *at);

/* How often the last sum evaluated the kernel. */
double tree_interactions(const struct tree *tree);

#endif
