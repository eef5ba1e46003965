/* kernel.h: the velocity of sources at targets: of point vortices (infinite span), and of the vortex rings of a strip
 * of finite depth in the middle plane of the strip, with the divergence of this velocity. doc/model.md, first
 * paragraph and section 18. Tested by tests/flow/test_kernel.c.
 *
 * A source has a spanwise part of circulation q and two legs along the line d = C dx. With r from the source to the
 * target, B = (b_t^2 + b_n^2)/2 of the half spans, s of the legs and e the smoothing of the spanwise part:
 *
 *     R = r^2 + e^2      T = r^2 + B + s_t + s_n          e^2: sum of the squares of source, target and pair
 *     u     = b ( q E3 r/(2 pi R sqrt(T)) + E3 d/(2 pi T^(3/2)) )
 *     div u = -(3 b/(2 pi)) r.(E3 d)/T^(5/2)                        the spanwise part has no divergence
 *     a     = -(3 b/(4 pi)) d/T^(5/2)                               edge force of a body of variable depth
 *
 *     infinite span:   u = q E3 r/(2 pi R)
 *
 * The `half` of a position is b^2/2; for targets outside the strip b is twice as large, and `half` four times as large.
 *
 * The sum at a target runs over the sources in array order, and every operation is rounded as written, with explicit
 * fused products on x86-64 with AVX2 and on arm64: the same bits on all processors of a family, for any vector width.
 * Targets are processed in blocks of 16. With infinite span targets i and i + 8 of a block share a division: the last
 * bits of one target depend on the other target. */
#ifndef KERNEL_H
#define KERNEL_H

#include <stdbool.h>

#include "base/parallel.h"
#include "wake/sources.h"

/* Targets; all arrays (n). Values are added to arrays that are not NULL: u and v, or neither and then `edge` alone; of
 * the gradient either no array, or u_x, u_y, v_x and any others. v_y = div - u_x. Without legs the arrays of legs, div
 * and edge are unchanged. */
struct targets {
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
struct targets kernel_targets_part(const struct targets *all, struct range which);

/* n places with the sums u, v, div, u_x, u_y, v_x, div_x, div_y, in this order; without half, leg and square. */
enum { KERNEL_SUMS = 8 };
struct targets kernel_targets(int n, const double *x, const double *y, double *const sum[KERNEL_SUMS]);

/* Constants of all pairs of a sum: span: b in front of the kernel, m (infinite span: 1); factor: of both `half`, 1 in
 * the strip of the same fish, 4 outside; square: addend of e^2, m2. */
struct kernel;
struct kernel_pair {
    const struct kernel *kernel;
    double span, factor, square;
};

/* Add the velocity of a range of sources to the targets. The spanwise part of a source at a target is 0. */
void kernel_induce(const struct kernel_pair *pair, const struct sources *sources, struct range which,
                   const struct targets *at);

/* Add the velocities that two sets of sources cause at each other, or a set at itself (other: one): kernel_induce with
 * the places, half and leg of the sources as targets, without gradients; a pair of sources has one division and one
 * root. `square` of the sources is 0. */
void kernel_induce_mutual(const struct kernel_pair *pair, const struct sources *one, const struct targets *at_one,
                          const struct sources *other, const struct targets *at_other);

/* One source for a Jacobian at n targets of one chunk. */
enum { KERNEL_CHUNK = 64 };
struct source {
    double x, y, q, dx, dy, half, leg, square;
};
struct unit_values {
    double unit_u[KERNEL_CHUNK], unit_v[KERNEL_CHUNK]; /* of the spanwise part, per q */
    /* derivatives by the target position, with q and d of the source */
    double u_x[KERNEL_CHUNK], u_y[KERNEL_CHUNK], v_x[KERNEL_CHUNK], v_y[KERNEL_CHUNK];
    /* with legs only */
    double div_x[KERNEL_CHUNK], div_y[KERNEL_CHUNK];
    double leg[KERNEL_CHUNK]; /* g: legs d cause the velocity g E3 d */
    double div_by_dx[KERNEL_CHUNK], div_by_dy[KERNEL_CHUNK];
    double edge[KERNEL_CHUNK];                         /* legs d cause a = edge d */
    double edge_x[KERNEL_CHUNK], edge_y[KERNEL_CHUNK]; /* of the factor of d in a */
};
void kernel_unit(const struct kernel_pair *pair, const struct source *source, int n, const double *x, const double *y,
                 const double *half, struct unit_values *values);

/* Add a factor times the values of another source at the same n targets. */
void kernel_values_add(const struct kernel_pair *pair, const struct unit_values *one, double factor, int n,
                       struct unit_values *sum);

// ---- what a kernel is

/* A block of targets, with sums. */
enum { KERNEL_BLOCK = 16 };
struct kernel_block {
    int n;            /* targets */
    bool has_squares; /* whether they have squares of the smoothing */
    double x[KERNEL_BLOCK], y[KERNEL_BLOCK], half[KERNEL_BLOCK], square[KERNEL_BLOCK];
    double u[KERNEL_BLOCK], v[KERNEL_BLOCK], leg_u[KERNEL_BLOCK], leg_v[KERNEL_BLOCK], div[KERNEL_BLOCK];
    double u_x[KERNEL_BLOCK], u_y[KERNEL_BLOCK], v_x[KERNEL_BLOCK], div_x[KERNEL_BLOCK], div_y[KERNEL_BLOCK];
    double edge[2][KERNEL_BLOCK], edge_gradient[4][KERNEL_BLOCK];
};

/* The sources of a sum, with the constants of the pairs. */
struct block_sources {
    int n;
    const double *x, *y, *q, *dx, *dy, *half, *leg, *square;
    double span, factor, add;
};

/* Strengths of the sources of a block; sums at a source, one number per lane. */
struct block_mates {
    double q[KERNEL_BLOCK], dx[KERNEL_BLOCK], dy[KERNEL_BLOCK];
};
struct block_lanes {
    double u[KERNEL_BLOCK / 2], v[KERNEL_BLOCK / 2];
    double leg_u[KERNEL_BLOCK / 2], leg_v[KERNEL_BLOCK / 2], div[KERNEL_BLOCK / 2];
};

/* The loops of kernel_induce and kernel_induce_mutual for one vector width set u, v, with legs leg_u, leg_v and a third
 * of div, and the gradients. mutual NULL: pairs are no faster (infinite span: 7 against 8 interactions per ns). */
struct kernel_loops {
    void (*velocity)(struct kernel_block *at, const struct block_sources *from);
    void (*gradient)(struct kernel_block *at, const struct block_sources *from);
    void (*mutual)(struct kernel_block *at, const struct block_mates *mates, const struct block_sources *from,
                   struct block_lanes *sums);
};

/* Another kernel is another struct of this kind; no other module knows the formulas. */
struct kernel {
    bool has_legs; /* whether legs act; without legs: no divergence, no edge force, one strength per source */
    int cost;      /* of an interaction, in interactions of infinite span */
    /* below these numbers the direct sum is faster than the tree: measured by `make bench` */
    int tree_sources;
    int far_sources; /* below this number of sources the direct sum is faster than far points: others.h */
    double tree_interactions;
    /* the pairs of sources of a strip of this depth and targets in the same strip, or other targets; square: e^2, m2 */
    struct kernel_pair (*own)(double depth, double square);
    struct kernel_pair (*other)(double depth, double square);
    /* variant i of this processor, the fastest first; NULL after the last variant */
    const struct kernel_loops *(*loops)(int i);
    /* bound of the velocity, and of length times div u, of sources with the sums q and d of the sizes of the strengths,
     * for squares of distances of at least r2 and h = b^2/2 + s of at least low */
    double (*bound)(const struct kernel_pair *pair, double r2, double low, double q, double d, double length);
    /* add the edge force to a block (NULL without legs); one source */
    void (*edge)(struct kernel_block *at, const struct block_sources *from);
    void (*unit)(const struct kernel_pair *pair, const struct source *source, int n, const double *x, const double *y,
                 const double *half, struct unit_values *values);
};
extern const struct kernel kernel_infinite, kernel_finite;

#endif
