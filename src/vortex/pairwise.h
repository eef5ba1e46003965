/* pairwise.h: the velocity that smoothed point vortices induce at one another. If a pair has one smoothing in both
 * directions, K is odd: what one induces at the other is what the other induces at it with the opposite sign and the
 * strengths exchanged, and the pair takes one division. doc/model.md, first paragraph. Tested by
 * tests/vortex/test_pairwise.c.
 *
 * The vortices of one smoothing are sorted into tiles, and the pairs of tiles are distributed to shares, whose number
 * depends on the vortices only. Each share sums separately; the sums of the shares are added in their order. So the
 * bits do not depend on the number of threads.
 *
 *          tile  0   1   2   3
 *             0  a   a   b   b      a, b, c, d: the shares; on the diagonal a tile with itself,
 *             1      b   c   c      beside it two tiles with each other
 *             2          c   d
 *             3              d                                                                                       */
#ifndef PAIRWISE_H
#define PAIRWISE_H

#include "base/status.h"
#include "vortex/vortices.h"

/* Which smoothing two vortices with different ones have for each other. */
enum pairwise_smoothing {
    PAIRWISE_OF_SOURCE, /* that of the vortex that induces the velocity */
    PAIRWISE_OF_PAIR    /* vortices_pair_smoothing, in both directions */
};

/* Add to (u, v), m s-1, both (n), at every vortex the velocity of all others. Fails with STATUS_MEMORY, and then leaves
 * u and v as they are. */
enum status pairwise_add_velocity(const struct vortices *vortices, enum pairwise_smoothing smoothing, int threads,
                                  double *u, double *v);

#endif
