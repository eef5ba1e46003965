/* treecode.h: the velocity of many smoothed vortices at many points to a given tolerance, cheaper than the direct sum.
 * doc/performance.md, section "Fast multipole sums". Tested by tests/vortex/test_treecode.c.
 *
 * Vortices and targets are sorted into boxes (tree_boxes.h). Well-separated boxes interact by multipole and local
 * expansions (expansions.h); the degrees of every pair follow from the tolerance. Near boxes interact by
 * the direct sum of kernel.h:
 *
 *     upward pass      P2M in the leaves of the sources, M2M from halves to parents
 *     far field        M2L from boxes of sources to boxes of targets
 *     downward pass    L2L from parents to halves
 *     leaves           L2P, and the direct sums of the near field
 *
 * At every target x
 *
 *     |error of the velocity| <= tolerance A,      A = sum_j |Gamma_j| / (2 pi sqrt(|x - x_j|^2 + e^2)):
 *
 * A is about the velocity of the vortices without cancellation. The tests check this error. The error of a gradient is
 * at most 50 tolerance sum_j |Gamma_j| / (2 pi (|x - x_j|^2 + e^2)). Rounding adds some 1e-15 of the same sums.
 *
 * The order of the sums depends on the points only: the bits do not depend on the number of threads. */
#ifndef TREECODE_H
#define TREECODE_H

#include "base/status.h"

struct treecode;

/* An empty tree. Memory grows as needed and is kept for the next call. Fails with STATUS_MEMORY; treecode_free accepts
 * NULL. */
enum status treecode_create(struct treecode **tree);
void treecode_free(struct treecode *tree);

/* treecode_build replaces the vortices of the tree by a set of n vortices of one smoothing length; treecode_build_more
 * adds another set, of any smoothing. All sets share the boxes and local expansions of the targets. The arrays are
 * copied. tolerance: see above; below 1e-13 rounding is larger. On STATUS_MEMORY the tree is empty. */
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

/* Plan sums for small displacements of the vortices of the tree and of the targets: sort the targets into boxes, and
 * find the pairs at the present positions; with_gradient: for sums with the gradient as well. The degrees hold for a
 * theta up to 2 % larger: vortices and targets may move by about a fiftieth of the distance between the boxes of a
 * pair. Fails with STATUS_MEMORY. */
enum status treecode_plan(struct treecode *tree, int n_targets, const double *x, const double *y, int with_gradient,
                          int threads);

/* Move the vortices of a set, numbered from 0 in the order of treecode_build and treecode_build_more; or the targets.
 * Lengths and order of the arrays are unchanged; every point stays in the same boxes. After treecode_plan. */
void treecode_move_vortices(struct treecode *tree, int set, const double *x, const double *y, const double *circulation,
                            int threads);
void treecode_move_targets(struct treecode *tree, const double *x, const double *y, int threads);

/* Whether the degrees of the plan are high enough for the present positions: the errors of treecode_add_planned then
 * meet the bounds of treecode_add_velocity. The result depends on the plan and the present positions, not on
 * intermediate positions. */
int treecode_fits(const struct treecode *tree, int threads);

/* Add the velocity of all vortices at all targets of a plan that fits, and the gradient if u_x is not NULL (plan with
 * the gradient). The sum is a continuous function of all positions. */
void treecode_add_planned(struct treecode *tree, int threads, double *u, double *v, double *u_x, double *u_y,
                          double *v_x);

#endif
