/* pairwise.h: the mutually induced velocities of smoothed point vortices. If a pair has one smoothing in both
 * directions, K is odd: both velocities of the pair share K up to the sign, and the pair takes one division.
 * doc/model.md, first paragraph. Tested by tests/vortex/test_pairwise.c.
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
#ifndef PAIRWISE_H
#define PAIRWISE_H

#include "base/status.h"
#include "vortex/vortices.h"

/* The smoothing of the velocity between two vortices of different smoothings. */
enum pairwise_smoothing {
    PAIRWISE_OF_SOURCE, /* the smoothing of the inducing vortex */
    PAIRWISE_OF_PAIR    /* vortices_pair_smoothing, in both directions */
};

/* Add to u and v, m s-1 (n), at every vortex the velocity of all other vortices. Unchanged on STATUS_MEMORY.
 */
enum status pairwise_add_velocity(const struct vortices *vortices, enum pairwise_smoothing smoothing, int threads,
                                  double *u, double *v);

#endif
