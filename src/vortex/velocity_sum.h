/* velocity_sum.h: the velocity of many vortices at many points, summed by the tree if the tree is faster than the
 * direct sum and the tolerance is above 0. doc/performance.md, section "Fast multipole sums". Tested by
 * tests/vortex/test_velocity_sum.c. */
#ifndef VELOCITY_SUM_H
#define VELOCITY_SUM_H

#include "base/status.h"
#include "vortex/far_images.h"
#include "vortex/vortices.h"

struct velocity_sum; /* workspace, kept for the next sum */

/* Fails with STATUS_MEMORY; velocity_sum_free accepts NULL. */
enum status velocity_sum_create(struct velocity_sum **sum);
void velocity_sum_free(struct velocity_sum *sum);

/* The workspace of images.h for images in a channel, owned by the sum. */
struct far_images *velocity_sum_far_images(struct velocity_sum *sum);

/* Whether the tree is faster for these numbers of vortices and targets, and the tolerance is above 0. */
int velocity_sum_by_tree(const struct vortices *vortices, int n_targets, double tolerance);

/* Add the velocity of all vortices to the targets, by the tree. The error of the velocity at a target is at most
 * tolerance / TOLERANCE_SUM times the velocity without cancellation, sum |Gamma| / (2 pi sqrt(r^2 + e^2)). The bits do
 * not depend on the number of threads. Fails with STATUS_MEMORY. */
enum status velocity_sum_induce(struct velocity_sum *sum, const struct vortices *vortices, double tolerance,
                                int threads, const struct induced *at);

/* The same for n arrays of vortices in one tree, cheaper than separate sums. The errors add up. */
enum status velocity_sum_induce_all(struct velocity_sum *sum, int n, const struct vortices *const *vortices,
                                    double tolerance, int threads, const struct induced *at);

/* Plan sums for small displacements of vortices and targets, with gradients if at->u_x is not NULL: sort vortices and
 * targets at the present positions. The velocities are not touched. Fails with STATUS_MEMORY; there is then no plan. */
enum status velocity_sum_plan(struct velocity_sum *sum, const struct vortices *vortices, double tolerance, int threads,
                              const struct induced *at);

/* velocity_sum_induce by the last plan, without sorting; if the plan no longer fits the positions (treecode.h),
 * velocity_sum_induce is called. Requires a plan for the same groups and numbers of vortices, the same number of
 * targets and the same tolerance, with gradients if at->u_x is not NULL. The result depends on the plan, not on later
 * sums. */
enum status velocity_sum_by_plan(struct velocity_sum *sum, const struct vortices *vortices, double tolerance,
                                 int threads, const struct induced *at);

/* ---- the mutually induced velocities of smoothed point vortices, by the direct sum
 *
 * If a pair has one smoothing in both directions, K is odd: both velocities of the pair share K up to the sign, and the
 * pair takes one division. doc/model.md, first paragraph.
 *
 * The vortices of one smoothing are sorted into tiles, and the pairs of tiles are distributed to shares. The number of
 * shares depends on the vortices only. Each share has separate sums; the sums of the shares are added in a fixed order.
 * The bits do not depend on the number of threads.
 *
 *          tile  0   1   2   3
 *             0  a   a   b   b      a, b, c, d: shares; diagonal: pairs within one tile,
 *             1      b   c   c      off-diagonal: pairs of two tiles
 *             2          c   d
 *             3              d                                                                                       */

/* The smoothing of the velocity between two vortices of different smoothings. */
enum pairwise_smoothing {
    PAIRWISE_OF_SOURCE, /* the smoothing of the inducing vortex */
    PAIRWISE_OF_PAIR    /* vortices_pair_smoothing, in both directions */
};

/* Add to u and v, m s-1 (n), at every vortex the velocity of all other vortices. Unchanged on STATUS_MEMORY. */
enum status velocity_sum_pairwise(const struct vortices *vortices, enum pairwise_smoothing smoothing, int threads,
                                  double *u, double *v);

#endif
