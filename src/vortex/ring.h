/* ring.h: the velocity of the vortex rings of a strip of finite depth in the middle plane of the strip, and the
 * divergence of this velocity. doc/model.md, section 18. Tested by tests/vortex/test_ring.c.
 *
 * A source has a spanwise part of circulation q and two legs along the line d = C dx. With r from the source
 * to the target, B = (b_t^2 + b_n^2)/2 of the half spans, s of the legs and e the smoothing of the spanwise part:
 *
 *     R = r^2 + e^2      T = r^2 + B + s_t + s_n
 *     u     = b ( q E3 r/(2 pi R sqrt(T)) + E3 d/(2 pi T^(3/2)) )
 *     div u = -(3 b/(2 pi)) r.(E3 d)/T^(5/2)                        the spanwise part has no divergence
 *     a     = -(3 b/(4 pi)) d/T^(5/2)                               edge force of a body of variable depth
 *
 * The `half` of a position is b^2/2; for targets outside the strip b is twice as large, and `half` four times as large.
 *
 * The sum at a target runs over the sources in array order, and every operation is rounded as written, with explicit
 * fused products: the same bits on all processors of a family, as in kernel.h. Targets i and i + 8 of a block of 16
 * share a division: the last bits of one target depend on the other target. */
#ifndef RING_H
#define RING_H

#include "base/parallel.h"
#include "base/status.h"

/* All arrays (n), owned. */
struct rings {
    int n, capacity;
    double *x, *y;   /* m */
    double *q;       /* m2 s-1 */
    double *dx, *dy; /* C dx, m3 s-1 */
    double *half;    /* b^2/2 with b a quarter of the depth, m2 */
    double *leg;     /* s, m2 */
    double *square;  /* contribution of the source to e^2, m2 */
};

void ring_free(struct rings *rings);

/* Append n sources, all values 0. On STATUS_MEMORY nothing is changed. */
enum status ring_append(struct rings *rings, int n);

/* Targets; all arrays (n). Values are added to arrays that are not NULL: u and v always; of the gradient either no
 * array, or all arrays (the edge arrays are optional). v_y = div - u_x. */
struct ring_targets {
    int n;
    const double *x, *y;               /* m */
    const double *half, *leg, *square; /* as of sources; NULL: 0 */
    double *u, *v;                     /* m s-1 */
    double *leg_u, *leg_v;             /* the part of the legs, m s-1 */
    double *div;                       /* s-1 */
    double *u_x, *u_y, *v_x;           /* s-1 */
    double *div_x, *div_y;             /* m-1 s-1 */
    double *edge;                      /* a in x and y, each an array of edge_stride numbers, m-1 s-1 */
    double *edge_gradient;             /* da_x/dx, da_x/dy, da_y/dx, da_y/dy, likewise, m-2 s-1 */
    int edge_stride;
};
struct ring_targets ring_targets_part(const struct ring_targets *all, struct range which);

/* Constants of all pairs of a sum: span: b in front of the kernel, m; factor: of both `half`, 1 in the own strip, 4
 * outside; square: addend of e^2, m2. */
struct ring_pair {
    double span, factor, square;
};

/* Add the velocity of a range of sources to the targets. The spanwise part of a source at a target is 0. */
void ring_induce(const struct ring_pair *pair, const struct rings *rings, struct range which,
                 const struct ring_targets *at);

/* Add the velocities of all rings to the rings themselves: ring_induce with the places, half and leg of the rings as
 * targets, without gradients; a pair of rings has one square root. `square` of the rings is 0. */
void ring_induce_mutual(const struct ring_pair *pair, const struct rings *rings, const struct ring_targets *at);

/* An image of every ring: at (x, sign y + shift), with the fraction `weight` of the strength. sign = -1: mirrored in a
 * wall, with reversed circulation and reversed legs along the wall. */
struct ring_image {
    double sign, shift, weight;
};

/* Write all images of the rings, image after image, to *images, which is overwritten. Fails with STATUS_MEMORY. */
enum status ring_write_images(const struct rings *rings, int n_images, const struct ring_image *image,
                              struct rings *images);

/* One source for a Jacobian at n targets of one chunk. */
enum { RING_CHUNK = 64 };
struct ring_source {
    double x, y, q, dx, dy, half, leg, square;
};
struct ring_values {
    double unit_u[RING_CHUNK], unit_v[RING_CHUNK]; /* of the spanwise part, per q */
    double leg[RING_CHUNK];                        /* g: legs d cause the velocity g E3 d */
    double div_by_dx[RING_CHUNK], div_by_dy[RING_CHUNK];
    double edge[RING_CHUNK]; /* legs d cause a = edge d */
    /* derivatives by the target position, with q and d of the source */
    double u_x[RING_CHUNK], u_y[RING_CHUNK], v_x[RING_CHUNK], v_y[RING_CHUNK], div_x[RING_CHUNK], div_y[RING_CHUNK];
    double edge_x[RING_CHUNK], edge_y[RING_CHUNK]; /* of the factor of d in a */
};
void ring_unit(const struct ring_pair *pair, const struct ring_source *source, int n, const double *x, const double *y,
               const double *half, struct ring_values *values);

/* Add a factor times the values of another source at the same n targets. */
void ring_values_add(const struct ring_values *one, double factor, int n, struct ring_values *sum);

/* A block of targets, with sums. */
enum { RING_BLOCK = 16 };
struct ring_block {
    double x[RING_BLOCK], y[RING_BLOCK], half[RING_BLOCK], square[RING_BLOCK];
    double u[RING_BLOCK], v[RING_BLOCK], leg_u[RING_BLOCK], leg_v[RING_BLOCK], div[RING_BLOCK];
    double u_x[RING_BLOCK], u_y[RING_BLOCK], v_x[RING_BLOCK], div_x[RING_BLOCK], div_y[RING_BLOCK];
    double edge[2][RING_BLOCK], edge_gradient[4][RING_BLOCK];
};

/* The sources of a sum, with the constants of the pairs. */
struct ring_sources {
    int n;
    const double *x, *y, *q, *dx, *dy, *half, *leg, *square;
    double span, factor, add;
};

/* Strengths of the rings of a block; sums at a source, one number per lane. */
struct ring_mates {
    double q[RING_BLOCK], dx[RING_BLOCK], dy[RING_BLOCK];
};
struct ring_lanes {
    double u[RING_BLOCK / 2], v[RING_BLOCK / 2], leg_u[RING_BLOCK / 2], leg_v[RING_BLOCK / 2], div[RING_BLOCK / 2];
};

/* The loops of ring_induce and ring_induce_mutual for one vector width: u, v, leg_u, leg_v and a third of div. Variant
 * i of this processor, the fastest first; NULL after the last variant. */
struct ring_loops {
    void (*velocity)(struct ring_block *at, const struct ring_sources *from);
    void (*mutual)(struct ring_block *at, const struct ring_mates *mates, const struct ring_sources *from,
                   struct ring_lanes *sums);
};
const struct ring_loops *ring_variant(int i);

#endif
