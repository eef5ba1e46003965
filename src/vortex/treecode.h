/* treecode.h: the velocity of many smoothed vortices at many points in less than n^2 time, to a given tolerance.
 * doc/performance.md, section "Fast multipole sums". Tested by tests/vortex/test_treecode.c.
 *
 * Vortices and targets are sorted into boxes (tree_boxes.h). Boxes that are far from each other interact by multipole
 * and local expansions (expansions.h), whose degrees are chosen for every pair to meet the tolerance (tree_pairs.h);
 * boxes near each other by the direct sum of kernel.h:
 *
 *     upward pass      P2M in the leaves of the sources, M2M from halves to wholes
 *     far field        M2L from boxes of sources to boxes of targets
 *     downward pass    L2L from wholes to halves
 *     leaves           L2P, and the direct sums of the near field
 *
 * At every target x
 *
 *     |error of the velocity| <= tolerance A,      A = sum_j |Gamma_j| / (2 pi sqrt(|x - x_j|^2 + e^2)):
 *
 * A is about the velocity that the vortices would have if nothing cancelled. The tests check this error; the bound by
 * which the degrees are chosen is 4 times larger, errors in wakes are 100 times smaller. The error of a gradient is at
 * most 50 tolerance sum_j |Gamma_j| / (2 pi (|x - x_j|^2 + e^2)). Rounding adds some 1e-15 of the same sums.
 *
 * The order of the sums depends on the points only: the bits are the same for any number of threads. */
#ifndef TREECODE_H
#define TREECODE_H

#include "base/status.h"

struct treecode;

/* An empty tree. Memory grows as needed and is kept for the next call. Fails with STATUS_MEMORY; treecode_free accepts
 * NULL. */
enum status treecode_create(struct treecode **tree);
void treecode_free(struct treecode *tree);

/* Fill the tree with a set of n vortices of one smoothing length; those it had are removed. The arrays are copied.
 * tolerance: see above; below 1e-13 rounding is larger. Or add another set, which may have another smoothing: all sets
 * share the boxes of the targets, their local expansions, and the evaluation of these. Fail with STATUS_MEMORY: the
 * tree is then empty. */
enum status treecode_build(struct treecode *tree, int n, const double *x, const double *y, const double *circulation,
                           double smoothing, double tolerance, int threads);
enum status treecode_build_more(struct treecode *tree, int n, const double *x, const double *y,
                                const double *circulation, double smoothing, double tolerance, int threads);

/* Add to (u, v) at each target the velocity of all vortices. A vortex at a target adds 0. Fails with STATUS_MEMORY:
 * nothing is then added. */
enum status treecode_add_velocity(struct treecode *tree, int n_targets, const double *x, const double *y, int threads,
                                  double *u, double *v);

/* The same, and add the gradient as kernel_add_gradient does. */
enum status treecode_add_gradient(struct treecode *tree, int n_targets, const double *x, const double *y, int threads,
                                  double *u, double *v, double *u_x, double *u_y, double *v_x);

/* Plan sums for vortices and targets that will move a little: the vortices are those of the tree, the targets are
 * sorted into boxes and the pairs are found for where all of them are now; with_gradient: of sums with the gradient as
 * well. The degrees of the pairs are those for a theta that is 2 % larger: they last while vortices and targets move by
 * about a fiftieth of the distance between two boxes that are a pair. Fails with STATUS_MEMORY. */
enum status treecode_plan(struct treecode *tree, int n_targets, const double *x, const double *y, int with_gradient,
                          int threads);

/* Move the vortices of a set, number 0 .. in the order of treecode_build and treecode_build_more; or the targets. All
 * arrays are as long and in the order as when they were given; every point stays in its boxes. After treecode_plan. */
void treecode_move_vortices(struct treecode *tree, int set, const double *x, const double *y, const double *circulation,
                            int threads);
void treecode_move_targets(struct treecode *tree, const double *x, const double *y, int threads);

/* Whether the degrees of the plan are high enough for where all points are now: the errors of treecode_add_planned are
 * then below those bounds that hold for treecode_add_velocity. It depends on the plan and on the places, not on those
 * in between. */
int treecode_fits(const struct treecode *tree, int threads);

/* Add the velocity of all vortices at all targets of a plan that fits, and, where it is one with the gradient and u_x
 * is not NULL, the gradient. The sum is a continuous function of all places. */
void treecode_add_planned(struct treecode *tree, int threads, double *u, double *v, double *u_x, double *u_y,
                          double *v_x);

#endif
