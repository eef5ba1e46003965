/* images.h: straight walls along x, through which no fluid goes, and the velocity that the images of vortices in them
 * induce. doc/model.md, section 17. Tested by tests/vortex/test_images.c.
 *
 * A vortex of circulation G at (x, y) has in the wall y = h an image of -G at (x, 2h - y). In a channel, h < y < h + H,
 * each image has images in turn: G at (x, y + 2kH) and -G at (x, 2h - y + 2kH) for every whole k. Their sums have a
 * closed form (image_rows.h). */
#ifndef IMAGES_H
#define IMAGES_H

#include "vortex/image_rows.h"
#include "vortex/kernel.h"
#include "vortex/velocity_sum.h"
#include "vortex/vortices.h"

/* The distance of a point at height y from the nearest wall, m: negative outside; INFINITY without walls. */
double images_distance(const struct walls *walls, double y);

/* Where the image of a vortex at height y is: sign y + shift. It has sign times its circulation. */
struct image {
    double sign, shift;
};

/* The images that are next to the vortex: their number; at most IMAGES_NEAREST are written. All others are further from
 * the fluid than the channel is wide. */
enum { IMAGES_NEAREST = 4 };
int images_nearest(const struct walls *walls, struct image image[IMAGES_NEAREST]);

/* Add to the targets what all images of a range of vortices induce. In a channel smoothings are above 0. */
void images_induce(const struct walls *walls, const struct vortices *vortices, struct range which,
                   const struct induced *at);

/* The same for all vortices at many targets, by several threads: what one wall mirrors by the tree where
 * velocity_sum_by_tree says so, and the far images in a channel by cells where images_by_cells does. The error is that
 * of velocity_sum_induce, once for a wall, three times for a channel. Fails with STATUS_MEMORY. */
enum status images_induce_many(const struct walls *walls, struct velocity_sum *sum, const struct vortices *vortices,
                               double tolerance, int threads, const struct induced *at);

/* Whether far images are summed by cells: far_images_pay in a channel, else not. */
int images_by_cells(const struct walls *walls, const struct vortices *vortices, double tolerance,
                    const struct induced *at);

/* What the images of one source of unit circulation induce at n <= KERNEL_CHUNK targets: those that move with the
 * source, and those that move against it in y. */
struct images_values {
    struct kernel_values shifted, mirrored;
};
void images_unit(const struct walls *walls, int n, const double *x, const double *y, double source_x, double source_y,
                 double smoothing, struct images_values *values);

#endif
