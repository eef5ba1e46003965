/* kernel.h: the formulas for the velocity that sources induce at targets. A source is a point vortex (infinite span),
 * or a vortex ring of a strip of finite depth, whose velocity and divergence are those in the middle plane of the
 * strip. doc/model.md, first paragraph and section 18. Tested by tests/flow/test_kernel.c.
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
 * The `half` of a position is b^2/2. For targets outside the strip b is twice as large, and `half` four times as large.
 *
 * The sum at a target runs over the sources in array order. Every operation is rounded as written, with explicit fused
 * products on x86-64 with AVX2 and on arm64, so all processors of a family give the same bits, whatever their vector
 * width. Targets are processed in blocks of 16. With infinite span the targets i and i + 8 of a block share a division,
 * so the last bits of one depend on the other. */
#ifndef KERNEL_H
#define KERNEL_H

#include <stdbool.h>

#include "base/parallel.h"
#include "wake/sources.h"

/* Targets; all arrays (n). Values are added to those arrays that are not NULL. These are u and v, or neither and then
 * `edge` alone; of the gradient either none, or u_x, u_y, v_x and any others (v_y = div - u_x). Without legs the arrays
 * of legs, div and edge stay as they are. */
struct targets {
    int n;
    const double *x, *y;               /* m */
    const double *half, *leg, *square; /* as of sources; NULL: 0 */
    double *u, *v;                     /* m s-1 */
    double *leg_u, *leg_v;             /* what the legs contribute, m s-1 */
    double *div;                       /* s-1 */
    double *u_x, *u_y, *v_x;           /* s-1 */
    double *div_x, *div_y;             /* m-1 s-1 */
    double *edge;                      /* a in x and y, each an array of edge_stride numbers, m-1 s-1 */
    double *edge_gradient;             /* da_x/dx, da_x/dy, da_y/dx, da_y/dy, likewise, m-2 s-1 */
    int edge_stride;
};
struct targets kernel_targets_part(const struct targets *all, struct range which);

/* The sums at targets as a list of arrays: the velocity and its divergence, then the gradients of both. */
enum kernel_sum {
    KERNEL_U,
    KERNEL_V,
    KERNEL_DIV,
    KERNEL_U_X,
    KERNEL_U_Y,
    KERNEL_V_X,
    KERNEL_DIV_X,
    KERNEL_DIV_Y,
    KERNEL_SUMS,
    KERNEL_SUMS_WITHOUT_GRADIENT = KERNEL_U_X
};

/* Make targets of n places with these sums, and without half, leg and square. */
struct targets kernel_targets(int n, const double *x, const double *y, double *const sum[KERNEL_SUMS]);

/* What is constant over all pairs of a sum. span: b in front of the kernel, m (infinite span: 1); factor: of both
 * `half`, which is 1 in the strip of the same fish and 4 outside; square: addend of e^2, m2. */
struct kernel;
struct kernel_pair {
    const struct kernel *kernel;
    double span, factor, square;
};

/* Add the velocity of a range of sources to the targets. A source exactly at a target contributes no spanwise part. */
void kernel_induce(const struct kernel_pair *pair, const struct sources *sources, struct range which,
                   const struct targets *at);

/* Add the velocities that two sets of sources cause at each other, or that one set causes at itself (other: one). This
 * equals kernel_induce with the places, half and leg of the sources as targets, without gradients, but takes only one
 * division and one root for a pair of sources. `square` of the sources must be 0. */
void kernel_induce_mutual(const struct kernel_pair *pair, const struct sources *one, const struct targets *at_one,
                          const struct sources *other, const struct targets *at_other);

/* One source for a Jacobian, and what it causes at n targets of one chunk. */
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

/* The loops of kernel_induce and kernel_induce_mutual for one vector width. They set u, v and the gradients and, with
 * legs, leg_u, leg_v and a third of div. mutual NULL: pairs would be no faster (infinite span: 7 against 8 interactions
 * per ns). */
struct kernel_loops {
    void (*velocity)(struct kernel_block *at, const struct block_sources *from);
    void (*gradient)(struct kernel_block *at, const struct block_sources *from);
    void (*mutual)(struct kernel_block *at, const struct block_mates *mates, const struct block_sources *from,
                   struct block_lanes *sums);
};

/* A kernel; another one is another struct of this kind. No other file knows the formulas. */
struct kernel {
    bool has_legs; /* without legs there is no divergence, no edge force, and one strength per source */
    int cost;      /* of an interaction, in interactions of infinite span */
    /* with fewer sources or interactions the direct sum is faster than the tree: measured by `make bench` */
    int tree_sources;
    int far_sources; /* with fewer sources the direct sum is faster than far points: others.h */
    double tree_interactions;
    /* the constants for sources of a strip of this depth, at targets in the same strip or at others; square: e^2, m2 */
    struct kernel_pair (*own)(double depth, double square);
    struct kernel_pair (*other)(double depth, double square);
    /* the loops for this processor, the fastest ones first; NULL after the last */
    const struct kernel_loops *(*loops)(int i);
    /* A bound of the velocity, and of length times div u, of sources whose strengths have sizes that sum to q and d,
     * for squares of distances of at least r2 and h = b^2/2 + s of at least low. */
    double (*bound)(const struct kernel_pair *pair, double r2, double low, double q, double d, double length);
    /* add the edge force to a block (NULL without legs); then one source for a Jacobian */
    void (*edge)(struct kernel_block *at, const struct block_sources *from, bool with_gradient);
    void (*unit)(const struct kernel_pair *pair, const struct source *source, int n, const double *x, const double *y,
                 const double *half, struct unit_values *values);
};
extern const struct kernel kernel_infinite, kernel_finite;

#endif
