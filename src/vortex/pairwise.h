/* pairwise.h: the velocity of smoothed point vortices at one another. The velocity that one of them causes at another is
 * that of the other at it with the opposite sign and the strengths exchanged, if they have one smoothing: a pair then
 * has one division for both. doc/model.md, first paragraph. Tested by tests/vortex/test_pairwise.c.
 *
 * The vortices of one smoothing are sorted into tiles, and the pairs of tiles dealt out to a number of shares that
 * depends on nothing but the vortices. Each share sums on its own; the sums of the shares are added in their order. So
 * the bits do not depend on the number of threads.
 *
 *          tile  0   1   2   3
 *             0  a   a   b   b      a, b, c: the shares; on the diagonal a tile feels itself,
 *             1      b   c   c      beside it two tiles feel each other
 *             2          c   d
 *             3              d                                                                                       */
#ifndef PAIRWISE_H
#define PAIRWISE_H

#include "base/status.h"
#include "vortex/vortices.h"

/* Add to (u, v), m s-1, both (n), at every vortex the velocity of all others. What a vortex causes is smoothed by its own
 * length. Fails with STATUS_MEMORY, and then leaves u and v as they are. */
enum status pairwise_add_velocity(const struct vortices *vortices, int threads, double *u, double *v);

#endif
