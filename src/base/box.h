/* box.h: rectangles with their sides along the axes. Tested by tests/base/test_box.c. */
#ifndef BOX_H
#define BOX_H

/* m; that of no points has low INFINITY and high -INFINITY. */
struct box {
    double low[2], high[2];
};

/* The box around n points. */
struct box box_around(int n, const double *x, const double *y);

/* The box around both. */
struct box box_union(struct box a, struct box b);

/* The box with a margin on every side, m. */
struct box box_widen(struct box box, double margin);

/* The gap between two boxes along x or along y, the wider one, m: at most 0 where they touch or overlap. No point of
 * one is nearer to a point of the other. */
double box_gap(const struct box *a, const struct box *b);

#endif
