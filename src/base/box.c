/* box.c: smallest and largest coordinates. */
#include "base/box.h"

#include <math.h>

// fmin and fmax are function calls, too slow here
static double box_smaller(double a, double b) {
    return b < a ? b : a;
}

static double box_larger(double a, double b) {
    return b > a ? b : a;
}

struct box box_around(int n, const double *x, const double *y) {
    struct box box = {{INFINITY, INFINITY}, {-INFINITY, -INFINITY}};
    for (int i = 0; i < n; i++) {
        box.low[0] = box_smaller(box.low[0], x[i]);
        box.low[1] = box_smaller(box.low[1], y[i]);
        box.high[0] = box_larger(box.high[0], x[i]);
        box.high[1] = box_larger(box.high[1], y[i]);
    }

    return box;
}

struct box box_union(struct box a, struct box b) {
    return (struct box){{box_smaller(a.low[0], b.low[0]), box_smaller(a.low[1], b.low[1])},
                        {box_larger(a.high[0], b.high[0]), box_larger(a.high[1], b.high[1])}};
}

struct box box_widen(struct box box, double margin) {
    return (struct box){{box.low[0] - margin, box.low[1] - margin}, {box.high[0] + margin, box.high[1] + margin}};
}

double box_gap(const struct box *a, const struct box *b) {
    double gap = -INFINITY;
    for (int i = 0; i < 2; i++) gap = box_larger(gap, box_larger(a->low[i] - b->high[i], b->low[i] - a->high[i]));
    return gap;
}
