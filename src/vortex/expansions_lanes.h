/* expansions_lanes.h: the coefficients of eight expansions, one per vector lane. Part of expansions_boxes.c and
 * expansions_points.c; the functions are inlined into every vector variant of a caller. */
#ifndef EXPANSIONS_LANES_H
#define EXPANSIONS_LANES_H

#include "vortex/expansions.h"

#define INLINE static inline __attribute__((always_inline))

enum {
    LANES = EXPANSION_LANES,
    DEGREES = EXPANSION_HARMONIC + 1,
    MIXED = EXPANSION_MIXED + 1,
    DEPTH = EXPANSION_MIXED / 2 + 1
};
typedef double lanes __attribute__((vector_size(LANES * sizeof(double))));

/* The number of coefficients with m - n = k. */
INLINE int depth(struct expansion_order order, int k) {
    return order.mixed - k >= 2 ? (order.mixed - k) / 2 + 1 : 1;
}

/* Coefficient (m, n) of each lane at [m - n][n]; coefficients above the degrees in use are not touched. */
struct block {
    lanes re[DEGREES][DEPTH], im[DEGREES][DEPTH];
};

INLINE void block_clear(struct block *block, struct expansion_order order) {
    for (int k = 0; k <= order.harmonic; k++) {
        for (int n = 0; n < depth(order, k); n++) block->re[k][n] = block->im[k][n] = (lanes){0};
    }
}

#endif
