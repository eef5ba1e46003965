/* mutual.h: the velocity of smoothed point vortices at one another. The velocity that one of them causes at another is
 * that of the other at it with the opposite sign and the strengths exchanged, if they have one smoothing: a pair then
 * has one division for both. doc/model.md, first paragraph. Tested by tests/test_mutual.c.
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
#ifndef MUTUAL_H
#define MUTUAL_H

#include "status.h"

/* Vortices of one smoothing that follow each other. */
struct mutual_group {
    int n;
    double smoothing; /* length e of the kernel, m */
};

/* Add to (u, v), m s-1, at every vortex the velocity of all others; x, y, m, and circulation, m2 s-1, hold the groups
 * one after another. What a vortex causes is smoothed by its own length. Fails with STATUS_MEMORY, and then leaves u
 * and v as they are. */
enum status mutual_add_velocity(int n_groups, const struct mutual_group *group, const double *x, const double *y,
                                const double *circulation, int threads, double *u, double *v);

#endif
