/* box.h: rectangles with sides along the axes. Tested by tests/base/test_box.c. */
#ifndef BOX_H
#define BOX_H

/* Corners, m; the box of no points has low INFINITY and high -INFINITY. */
struct box {
    double low[2], high[2];
};

/* The box around n points. */
struct box box_around(int n, const double *x, const double *y);

/* The box around two boxes. */
struct box box_union(struct box a, struct box b);

/* The box with a margin on every side, m. */
struct box box_widen(struct box box, double margin);

/* The larger of the gaps between two boxes along x and along y, m: at most 0 for boxes that touch or overlap. Lower
 * bound of the distance between points of both boxes. */
double box_gap(const struct box *a, const struct box *b);

#endif
