/* tolerance.h: the parts of wake.tolerance. doc/numerics.md, section 12.
 *
 * wake.tolerance is a velocity in lengths per beat at a body. Interpolation of the wakes takes the tolerance, in parts
 * (wake/near_field.c):
 *
 *     1/2   far field on the predicted path:   1/8 whole wakes, divided among wakes and images,
 *                                              1/8 single vortices, divided among vortices and images,
 *                                              1/4 vortices moved from the near field to the far field
 *     1/2   drift of the body from the predicted path
 *
 * A fast sum has a relative tolerance of wake.tolerance/10 (vortex/velocity_sum.c, vortex/far_images.c), relative to
 * the velocity without cancellation, which is up to some ten lengths per beat in a school. In the tree
 * (vortex/treecode.c), half of the relative tolerance bounds the truncated harmonic terms, half the truncated mixed
 * terms.
 *
 * Vortex rings are not interpolated in time: a fast sum (vortex/ring_tree.c) takes half of wake.tolerance.
 *
 * Each constant is a divisor: part = tolerance / constant. */
#ifndef TOLERANCE_H
#define TOLERANCE_H

enum {
    TOLERANCE_SUM = 10,    /* fast sum over many vortices or images */
    TOLERANCE_RINGS = 2,   /* fast sum over many vortex rings, in lengths per beat */
    TOLERANCE_TERMS = 2,   /* of a fast sum: truncated terms of one kind, harmonic or mixed */
    TOLERANCE_DRIFT = 2,   /* drift from the predicted path */
    TOLERANCE_WAKES = 8,   /* whole wakes in the far field */
    TOLERANCE_SINGLES = 8, /* single vortices in the far field */
    TOLERANCE_MOVED = 4    /* vortices moved to the far field */
};

#endif
