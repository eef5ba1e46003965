/* sheets_at_wake.h: the bound sheets of a large school at the markers of all free sheets, by the tree.
 * doc/performance.md, section "Fast multipole sums". Tested by tests/model/test_sheets_at_wake.c.
 *
 * Markers see bound vortex j with a smoothing e_j of its own, from 0 at the edges to e (free_sheet_bound_smoothing),
 * and a tree has one smoothing. As a function of s = e_j^2 the kernel 1/(r^2 + s) is a parabola but for s^3/r^8: so
 * each vortex becomes three at its place, with the smoothings at which s is one of the three nodes of Chebyshev between
 * 0 and e^2, and its circulation times Lagrange's polynomials of these. One tree sums the three sets. Markers nearer
 * to a body than
 *
 *     R = e (0.3125/tolerance)^(1/6)
 *
 * have its own vortices in place of these; further away the error is at most a tenth of the tolerance, relative to the
 * velocity without cancellation. */
#ifndef SHEETS_AT_WAKE_H
#define SHEETS_AT_WAKE_H

#include "base/status.h"
#include "model/fish.h"
#include "vortex/velocity_sum.h"
#include "vortex/vortices.h"

/* The bound vortices of all fish. */
struct bound_vortices {
    const struct school *school;
    const struct vortices *vortices; /* their places and circulations */
    const struct range *range;       /* those of each fish                                   (n_fish) */
    const double *square;            /* of the smoothing with which markers see them, m2    (vortices->n) */
};

/* Whether this is faster than the direct sum for so many markers, and the tolerance is not 0. */
int sheets_at_wake_by_tree(const struct vortices *bound, int n_markers, double tolerance);

/* Add to the markers what all bound vortices induce, and other vortices too, by the same tree (NULL: none). The error
 * is that of velocity_sum_induce, times two for the bound vortices. The same bits for any number of threads. Fails with
 * STATUS_MEMORY. */
enum status sheets_at_wake_induce(const struct bound_vortices *bound, const struct vortices *others,
                                  struct velocity_sum *sum, double tolerance, int threads,
                                  const struct induced *markers);

#endif
