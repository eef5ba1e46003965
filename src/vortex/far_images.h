/* far_images.h: what the far images of many vortices in a channel induce at many points. doc/model.md, section 17.
 * Tested by tests/vortex/test_images.c. Part of images.h.
 *
 * Of the images of a vortex the two that its walls mirror are near; all others are at least the width H of the channel
 * away from every point of the fluid:
 *
 *                x  mirrored image of an image             .
 *                o  image of the image                     .  far: their velocity is smooth in the place of the vortex
 *                x  mirrored by the upper wall             near
 *     ---------------------------------------------------- y = h + H
 *                o  the vortex, and the points
 *     ---------------------------------------------------- y = h
 *                x  mirrored by the lower wall             near
 *                o  image of the image                     far
 *
 * So the channel is cut into cells as long as it is wide. The vortices of a cell become Chebyshev moments; those are
 * vortices at the Chebyshev nodes of the cell, and of a few smoothings where there are several; these induce, by the
 * closed sums of image_rows.h, a velocity at the nodes of every cell; and between them it is a polynomial. That is work
 * in proportion to vortices, to points, and to pairs of cells. The number of nodes follows from the tolerance. */
#ifndef FAR_IMAGES_H
#define FAR_IMAGES_H

#include "base/status.h"
#include "vortex/image_rows.h"
#include "vortex/vortices.h"

struct far_images; /* what nodes induce at nodes, kept for the next sum */

/* Fails with STATUS_MEMORY; far_images_free accepts NULL. */
enum status far_images_create(struct far_images **far);
void far_images_free(struct far_images *far);

/* Whether this is faster than the direct sum over all images, which is the case from some hundred thousand interactions
 * on where the channel is not much longer than it is wide, and the tolerance is not 0. */
int far_images_pay(const struct walls *channel, const struct vortices *vortices, double tolerance,
                   const struct induced *at);

/* Add to the targets, inside of the channel, what the far images of all vortices induce. The error of the velocity is
 * at most a tenth of the tolerance, times the velocity sum |Gamma| / (2 pi sqrt(r^2 + e^2)) of velocity_sum.h; that of
 * the gradient 50 times as large over sqrt(r^2 + e^2). The same bits for any number of threads, and whatever was summed
 * before. Only where it pays: places are finite, and cells not too many. Fails with STATUS_MEMORY; nothing is added
 * then. */
enum status far_images_induce(struct far_images *far, const struct walls *channel, const struct vortices *vortices,
                              double tolerance, int threads, const struct induced *at);

#endif
