/* images.h: impermeable straight walls along x, and the velocity of the images of vortices in these walls.
 * doc/model.md, section 17. Tested by tests/vortex/test_images.c.
 *
 * A vortex of circulation G at (x, y) has in the wall y = h an image of -G at (x, 2h - y). In a channel, h < y < h + H,
 * each image is mirrored again: G at (x, y + 2kH) and -G at (x, 2h - y + 2kH) for every integer k. The sums over k have
 * a closed form (far_images.h). Part of the tolerance: tolerance.h. */
#ifndef IMAGES_H
#define IMAGES_H

#include "vortex/far_images.h"
#include "vortex/kernel.h"
#include "vortex/ring.h"
#include "vortex/velocity_sum.h"
#include "vortex/vortices.h"

/* The distance of a point at height y from the nearest wall, m: negative outside; INFINITY without walls. */
double images_distance(const struct walls *walls, double y);

/* The image of a vortex of circulation G at height y: circulation sign G at height sign y + shift. */
struct image {
    double sign, shift;
};

/* Write the nearest images, at most IMAGES_NEAREST, and return the number. All other images are more than the channel
 * width away from the fluid. */
enum { IMAGES_NEAREST = 4 };
int images_nearest(const struct walls *walls, struct image image[IMAGES_NEAREST]);

/* The images of rings of at most this depth [m], in a new list that the caller frees; NULL without walls. In a channel
 * a Gauss rule replaces the infinite sums: the images k = 1, and all further images as weighted images at nodes between
 * the places of the images. There are 36 images for depths up to 8 H, 32 more for each factor of 4, and at most 272;
 * the error is at most 1e-8 of the velocity of a vortex at the distance H if source and target are less than 6 H apart.
 * doc/model.md, section 18. Fails with STATUS_MEMORY. */
enum status images_of_rings(const struct walls *walls, double depth, struct ring_image **image, int *n_images);

/* Add the velocity of all images of a range of vortices to the targets. In a channel smoothings are above 0. */
void images_induce(const struct walls *walls, const struct vortices *vortices, struct range which,
                   const struct induced *at);

/* The same for all vortices at many targets, by several threads: direct reflections by the tree if velocity_sum_by_tree
 * holds, far images in a channel by cells if images_by_cells holds. The error is at most the error of
 * velocity_sum_induce for a wall, three times that error for a channel. Fails with STATUS_MEMORY. */
enum status images_induce_many(const struct walls *walls, struct velocity_sum *sum, const struct vortices *vortices,
                               double tolerance, int threads, const struct induced *at);

/* Whether far images are summed by cells: far_images_pay in a channel, otherwise 0. */
int images_by_cells(const struct walls *walls, const struct vortices *vortices, double tolerance,
                    const struct induced *at);

/* The velocity of the images of one source of unit circulation at n <= KERNEL_CHUNK targets: shifted images move with
 * the source, mirrored images move in the opposite y direction. */
struct images_values {
    struct kernel_values shifted, mirrored;
};
void images_unit(const struct walls *walls, int n, const double *x, const double *y, double source_x, double source_y,
                 double smoothing, struct images_values *values);

#endif
