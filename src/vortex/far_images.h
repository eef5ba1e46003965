/* far_images.h: velocity of the far images of many vortices in a channel at many points. doc/model.md, section 17.
 * Tested by tests/vortex/test_images.c. Part of images.h.
 *
 * The two images of a vortex that the walls mirror directly are near. All other images are far: the distance from every
 * point of the fluid is at least the channel width H:
 *
 *                x  mirrored image of an image             .
 *                o  image of the image                     .  far: velocity smooth in the vortex position
 *                x  mirrored by the upper wall             near
 *     ---------------------------------------------------- y = h + H
 *                o  the vortex, and the points
 *     ---------------------------------------------------- y = h
 *                x  mirrored by the lower wall             near
 *                o  image of the image                     far
 *
 * The channel is divided into square cells of length H. Chebyshev interpolation replaces the vortices of a cell by
 * equivalent vortices at the Chebyshev nodes of the cell; vortices of several smoothings are also interpolated in the
 * square of the smoothing. The closed sums of image_rows.h give the velocity at the nodes of every cell, and a
 * polynomial gives the velocity between the nodes. The cost is proportional to vortices, points and pairs of cells. The
 * number of nodes follows from the tolerance. */
#ifndef FAR_IMAGES_H
#define FAR_IMAGES_H

#include "base/status.h"
#include "vortex/image_rows.h"
#include "vortex/vortices.h"

struct far_images; /* tables of node-to-node velocities, kept for the next sum */

/* Fails with STATUS_MEMORY; far_images_free accepts NULL. */
enum status far_images_create(struct far_images **far);
void far_images_free(struct far_images *far);

/* Whether the sum by cells is faster than the direct sum over all images. The sum by cells is faster from some hundred
 * thousand interactions on, if the tolerance is above 0 and the channel is not much longer than wide. */
int far_images_pay(const struct walls *channel, const struct vortices *vortices, double tolerance,
                   const struct induced *at);

/* Add the velocity of the far images of all vortices to the targets, all inside the channel. The error of the velocity
 * is at most tolerance/10 times the sum |Gamma| / (2 pi sqrt(r^2 + e^2)) of velocity_sum.h; the error of the gradient
 * is at most 5 tolerance times the sum |Gamma| / (2 pi (r^2 + e^2)). The bits depend neither on the number of threads
 * nor on earlier sums. Requires far_images_pay: finite positions, and a limited number of cells. Fails with
 * STATUS_MEMORY; nothing is added then. */
enum status far_images_induce(struct far_images *far, const struct walls *channel, const struct vortices *vortices,
                              double tolerance, int threads, const struct induced *at);

#endif
