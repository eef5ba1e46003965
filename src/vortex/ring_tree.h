/* ring_tree.h: the velocity and divergence of many vortex rings (ring.h) at many points to a given tolerance, cheaper
 * than the direct sum. doc/performance.md, section "Fast multipole sums". Tested by tests/vortex/test_ring_tree.c.
 *
 * Rings and targets are sorted into boxes (tree_boxes.h). In place, and in the lengths h = b^2/2 + s, the kernel is
 * smooth between distant boxes, and polynomials at Chebyshev nodes represent it on both sides:
 *
 *     upward pass      strengths of the rings -> strengths at the nodes of the leaves -> nodes of the parents
 *     far field        nodes of boxes of sources -> nodes of boxes of targets, by the kernel of ring.h
 *     downward pass    values at the nodes of parents -> nodes of the halves -> targets
 *     leaves           the direct sums of the near field
 *
 * A pair of boxes has its own number of nodes per axis. The order of the sums depends on the points only: the bits do
 * not depend on the number of threads. */
#ifndef RING_TREE_H
#define RING_TREE_H

#include "base/status.h"
#include "vortex/ring.h"

struct ring_tree;

/* An empty tree; the memory is kept for the next sum. Fails with STATUS_MEMORY; ring_tree_free accepts NULL. */
enum status ring_tree_create(struct ring_tree **tree);
void ring_tree_free(struct ring_tree *tree);

/* Whether the tree is faster than this number of direct interactions; never for the tolerance 0. */
int ring_tree_is_faster(int n_rings, double n_interactions, double tolerance);

/* ring_induce for all rings; neither rings nor targets have a `square`, and `edge` and `leg_u` of the targets are not
 * used. The errors of the velocity and of length div u are below tolerance, m s-1, and for rings of one sign below
 * tolerance A, with A the velocity without cancellation over 1 m s-1, where A > 1: the tests check these errors.
 * Gradients are the derivatives of the same polynomials. Fails with STATUS_MEMORY: nothing is then added. */
enum status ring_tree_induce(struct ring_tree *tree, const struct ring_pair *pair, const struct rings *rings,
                             double length, double tolerance, int threads, const struct ring_targets *at);

/* Number of evaluations of the kernel in the last sum. */
double ring_tree_interactions(const struct ring_tree *tree);

#endif
