/* tree_boxes.h: sorts points into nested boxes, each of which is halved at the median point. Part of tree.h. Tested by
 * tests/flow/test_tree_boxes.c.
 *
 * Boxes are numbered from the largest down. 1 and 2 are the halves of 0, and box i has the halves 2 i + 1 and 2 i + 2:
 *
 *     level 0                  0
 *     level 1          1               2           all boxes of a level hold the same number of points, or one more
 *     level 2      3       4       5       6       depth = 2: the boxes 3 .. 6 are leaves
 *
 * The points of a box are consecutive in the sorted arrays. */
#ifndef TREE_BOXES_H
#define TREE_BOXES_H

#include "base/arena.h"

/* A circle around n consecutive sorted points. */
struct tree_box {
    int first, n;
    double x, y, radius; /* radius > 0 */
};

struct tree_boxes {
    struct arena *arena;
    int n, depth, n_boxes;   /* n_boxes = 2^(depth + 1) - 1; 0 if n = 0 */
    struct tree_box *box;    /*                                          (n_boxes) */
    int *index;              /* where each sorted point stands in the caller's arrays  (n) */
    double *x, *y, *weight;  /* sorted                                         (n) */
    struct tree_point *work; /*                                                (n) */
    int capacity, box_capacity;
};

/* The first box of a level. */
static inline int tree_boxes_level(int level) {
    return (1 << level) - 1;
}

/* Sort n points with weights (NULL: all 0) into boxes, until leaves hold at most leaf points. The memory is kept for
 * the next call. The boxes do not depend on the number of threads. */
void tree_boxes_fill(struct tree_boxes *boxes, int n, const double *x, const double *y, const double *weight, int leaf,
                     int threads);

#endif
