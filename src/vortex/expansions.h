/* expansions.h: multipole and local expansions of the velocity of boxes of vortices, series in z = x + i y and its
 * conjugate z'. Part of treecode.h.
 *
 * The potential of a smoothed vortex is Phi = log(z z' + e^2), its velocity u - i v = -i/(2 pi) dPhi/dz. For a box s of
 * sources around c_s and a box t of targets around c_t let R = c_t - c_s and S = sqrt(|R|^2 + e^2). With the
 * displacements s = (c_s - x_j)/S and t = (x - c_t)/S, turned by -arg R, and c = |R|/S,
 *
 *     Phi = log S^2 + log(1 + 2 c Re(t + s) + |t + s|^2) = log S^2 + sum_kl d_kl (t + s)^k (t + s)'^l,
 *
 * where d_kl = d_lk is a real function of c alone. So the coefficients M_mn = sum_j Gamma_j s^m s'^n / (m! n!) of the
 * multipole expansion of the sources give those of the local expansion at the targets,
 *
 *     L_ab = 1/(a! b!) sum_mn D_(a+m)(b+n) M_mn,         D_kl = k! l! d_kl.
 *
 * Everything is real but for M and L, and those are conjugate to themselves with the indices exchanged: only m >= n and
 * a >= b are kept. Without smoothing c = 1, and d_kl = 0 unless k = 0 or l = 0: these terms are harmonic, the others
 * mixed. Both are cut at a degree of their own; the sum of all terms of dPhi/dz that have degree n - 1 is at most
 * theta^(n-1)/S, and its mixed part at most min(2, n (n - 1) e^2/(2 S^2)) times that, theta = |t| + |s|. */
#ifndef EXPANSIONS_H
#define EXPANSIONS_H

#include "vortex/tree_boxes.h"

enum {
    EXPANSION_HARMONIC = 24, /* highest degree of harmonic terms */
    EXPANSION_MIXED = 14,    /* highest degree of mixed terms */
    EXPANSION_LANES = 8      /* boxes or points that are handled together */
};

/* Highest degrees of an expansion: harmonic >= mixed; harmonic < 0: no expansion; mixed < 2: no mixed terms. */
struct expansion_order {
    int harmonic, mixed;
};

/* An expansion about the centre of a box; lengths are in units of the radius of the box. Row n holds the coefficients m
 * >= n: row 0 up to m = harmonic, row n up to m + n = mixed. Each is a pair re, im. */
struct expansion {
    struct expansion_order order;
    double *value; /* (2 expansions_size) */
};

/* The higher degrees of both. */
static inline struct expansion_order expansion_order_max(struct expansion_order a, struct expansion_order b) {
    return (struct expansion_order){a.harmonic > b.harmonic ? a.harmonic : b.harmonic,
                                    a.mixed > b.mixed ? a.mixed : b.mixed};
}

/* The number of complex coefficients. */
int expansions_size(struct expansion_order order);

/* P2M: set the multipole expansion of a box from its points. */
void expansions_p2m(const struct tree_boxes *boxes, int box, const struct expansion *multipole);

/* M2M: set the multipole expansions of n_parents <= EXPANSION_LANES / 2 boxes, from parent on, from those of their
 * halves. Parents without an expansion are left out; halves have the degrees of their parent or higher ones. multipole:
 * of all boxes. */
void expansions_m2m(const struct tree_boxes *boxes, int parent, int n_parents, const struct expansion *multipole);

/* A box of sources in the far field of a box of targets. */
struct expansions_pair {
    int target, source;
    struct expansion_order order; /* of D */
};

/* M2L: add the multipole expansions of n boxes of sources to the local expansions of boxes of targets, whose degrees
 * are at least those of their pairs. multipole, local: of all boxes. */
void expansions_m2l(const struct tree_boxes *targets, const struct tree_boxes *sources, double smoothing, int n,
                    const struct expansions_pair *pair, const struct expansion *multipole,
                    const struct expansion *local);

/* L2L: add to the local expansions of the halves of n_parents <= EXPANSION_LANES / 2 boxes, from parent on, those of
 * the parents, whose degrees are not higher. local: of all boxes. */
void expansions_l2l(const struct tree_boxes *boxes, int parent, int n_parents, const struct expansion *local);

/* L2P: add the velocity of a local expansion at the sorted points of its box to u, v, which begin with the first of all
 * points; gradient: NULL or u_x, u_y, v_x, the same. */
void expansions_l2p(const struct tree_boxes *boxes, int box, const struct expansion *local, double *u, double *v,
                    double *const gradient[3]);

#endif
