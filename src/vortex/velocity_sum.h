/* velocity_sum.h: the velocity that many vortices induce at many points, summed by the tree where that is faster than
 * the direct sum and a tolerance allows it. doc/performance.md, section "Fast multipole sums". Tested by
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

/* The workspace of images in a channel, which images.h needs; it belongs to the sum. */
struct far_images *velocity_sum_far_images(struct velocity_sum *sum);

/* Whether the tree is faster for so many vortices and targets, and the tolerance is not 0. */
int velocity_sum_by_tree(const struct vortices *vortices, int n_targets, double tolerance);

/* Add to the targets what all vortices induce, by the tree. The error of the velocity at a target is at most a tenth of
 * the tolerance, times the velocity that the vortices would induce there if nothing cancelled, sum |Gamma| / (2 pi
 * sqrt(r^2 + e^2)), which is up to some ten lengths per beat in a school. The same bits for any number of threads.
 * Fails with STATUS_MEMORY. */
enum status velocity_sum_induce(struct velocity_sum *sum, const struct vortices *vortices, double tolerance,
                                int threads, const struct induced *at);

/* The same for n arrays of vortices by one tree, which costs less than one after the other. The errors add up. */
enum status velocity_sum_induce_all(struct velocity_sum *sum, int n, const struct vortices *const *vortices,
                                    double tolerance, int threads, const struct induced *at);

/* Plan sums for vortices and targets that will move a little, with gradients where at->u_x is not NULL: they are sorted
 * for where they are now; the velocities are not touched. Fails with STATUS_MEMORY: there is no plan then. */
enum status velocity_sum_plan(struct velocity_sum *sum, const struct vortices *vortices, double tolerance, int threads,
                              const struct induced *at);

/* velocity_sum_induce without sorting, where nothing has moved too far for the last plan (treecode.h), which was for as
 * many vortices in the same groups, as many targets, and this tolerance; else velocity_sum_induce itself. Where
 * at->u_x is not NULL, the plan was one with gradients. It depends on the plan, and not on what was summed since. */
enum status velocity_sum_by_plan(struct velocity_sum *sum, const struct vortices *vortices, double tolerance,
                                 int threads, const struct induced *at);

#endif
