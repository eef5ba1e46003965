/* images.h: walls. A straight wall along x is impermeable because every source has an image behind it.
 * doc/model.md, section 17. Tested by tests/flow/test_images.c.
 *
 * A source of strength q, d at (x, y) has in the wall y = h an image of -q, (-dx, dy) at (x, 2h - y). In a channel, h <
 * y < h + H, each image is mirrored again, which gives images of the source itself at y + 2kH and of the mirrored
 * source at 2h - y + 2kH for every integer k. */
#ifndef IMAGES_H
#define IMAGES_H

#include "base/arena.h"
#include "fish/fish.h"
#include "wake/sources.h"

/* An image of every source, at (x, sign y + shift), with the fraction `weight` of its strength. sign = -1: mirrored in
 * a wall, so that circulation and the legs along the wall are reversed. */
struct image {
    double sign, shift, weight;
};

/* Set *image to the images of sources of at most this depth [m] (infinite span: 0) and return their number, which is 0
 * without walls.
 *
 * In a channel a Gauss rule replaces the infinite sums: the images k = 1 stay, and all further ones are represented by
 * weighted images at nodes between them. There are 36 images for depths up to 8 H, 32 more for each factor of 4, and at
 * most 272. The error is at most 1e-8 of the velocity of a vortex at the distance H if source and target are less than
 * 6 H apart. */
int images_find(struct arena *arena, const struct walls *walls, double depth, struct image **image);

/* Write all images of the sources, image after image, to *images, replacing what it holds. */
void images_write(const struct sources *sources, int n_images, const struct image *image, struct sources *images);

#endif
