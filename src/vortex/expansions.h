/* expansions.h: multipole and local expansions of the velocity of boxes of vortices, series in z = x + i y and the
 * conjugate z'. Part of treecode.h.
 *
 * The potential of a smoothed vortex is Phi = log(z z' + e^2), the velocity is u - i v = -i/(2 pi) dPhi/dz. For a box s
 * of sources around c_s and a box t of targets around c_t let R = c_t - c_s and S = sqrt(|R|^2 + e^2). With the
 * displacements s = (c_s - x_j)/S and t = (x - c_t)/S, turned by -arg R, and c = |R|/S,
 *
 *     Phi = log S^2 + log(1 + 2 c Re(t + s) + |t + s|^2) = log S^2 + sum_kl d_kl (t + s)^k (t + s)'^l,
 *
 * where d_kl = d_lk is a real function of c alone. So the coefficients M_mn = sum_j Gamma_j s^m s'^n / (m! n!) of the
 * multipole expansion of the sources give the coefficients of the local expansion at the targets,
 *
 *     L_ab = 1/(a! b!) sum_mn D_(a+m)(b+n) M_mn,         D_kl = k! l! d_kl.
 *
 * Only M and L are complex. Exchanging the two indices of M or L gives the conjugate coefficient: only m >= n and a >=
 * b are kept. Without smoothing c = 1, and d_kl = 0 unless k = 0 or l = 0: the terms with k = 0 or l = 0 are harmonic,
 * the others mixed. Harmonic and mixed terms are truncated at separate degrees. With theta = |t| + |s|, the sum of all
 * terms of degree n - 1 in dPhi/dz is at most theta^(n-1)/S; the mixed part of this sum is at most min(2, n (n - 1)
 * e^2/(2 S^2)) theta^(n-1)/S. */
#ifndef EXPANSIONS_H
#define EXPANSIONS_H

#include "vortex/tree_boxes.h"

enum {
    EXPANSION_HARMONIC = 24, /* highest degree of harmonic terms */
    EXPANSION_MIXED = 14,    /* highest degree of mixed terms */
    EXPANSION_LANES = 8      /* boxes or points per call of a vector loop */
};

/* Highest degrees of an expansion: harmonic >= mixed; harmonic < 0: no expansion; mixed < 2: no mixed terms. */
struct expansion_order {
    int harmonic, mixed;
};

/* An expansion about the centre of a box; lengths are in units of the radius of the box. Row n holds the coefficients m
 * >= n: row 0 up to m = harmonic, row n up to m + n = mixed. A coefficient is a pair re, im. */
struct expansion {
    struct expansion_order order;
    double *value; /* (2 expansions_size) */
};

/* The higher of two degrees, harmonic and mixed separately. */
static inline struct expansion_order expansion_order_max(struct expansion_order a, struct expansion_order b) {
    return (struct expansion_order){a.harmonic > b.harmonic ? a.harmonic : b.harmonic,
                                    a.mixed > b.mixed ? a.mixed : b.mixed};
}

/* The number of complex coefficients. */
int expansions_size(struct expansion_order order);

/* P2M: set the multipole expansion of a box from the points of the box. */
void expansions_p2m(const struct tree_boxes *boxes, int box, const struct expansion *multipole);

/* M2M: set the multipole expansions of n_parents <= EXPANSION_LANES / 2 boxes, from parent on, from the multipole
 * expansions of the halves. Parents without an expansion are skipped; halves have at least the degrees of the parent.
 * multipole: of all boxes. */
void expansions_m2m(const struct tree_boxes *boxes, int parent, int n_parents, const struct expansion *multipole);

/* A box of sources in the far field of a box of targets. */
struct expansions_pair {
    int target, source;
    struct expansion_order order; /* of D */
};

/* M2L: add the multipole expansions of n boxes of sources to the local expansions of boxes of targets. The degrees of a
 * local expansion are at least the degrees of the pair. multipole, local: of all boxes. */
void expansions_m2l(const struct tree_boxes *targets, const struct tree_boxes *sources, double smoothing, int n,
                    const struct expansions_pair *pair, const struct expansion *multipole,
                    const struct expansion *local);

/* L2L: add the local expansions of n_parents <= EXPANSION_LANES / 2 boxes, from parent on, to the local expansions of
 * the halves. Halves have at least the degrees of the parent. local: of all boxes. */
void expansions_l2l(const struct tree_boxes *boxes, int parent, int n_parents, const struct expansion *local);

/* L2P: add the velocity of a local expansion at the sorted points of the box to u and v, indexed as the sorted points
 * of all boxes; gradient: NULL, or u_x, u_y, v_x with the same index. */
void expansions_l2p(const struct tree_boxes *boxes, int box, const struct expansion *local, double *u, double *v,
                    double *const gradient[3]);

#endif
