/* sources.h: a list of sources of the flow. doc/model.md, section 18. Tested by tests/wake/test_sheet.c.
 *
 * A source consists of a spanwise vortex of circulation q and of a leg d = C dx along the sheet; flow/kernel.h says
 * which velocity they cause. Without a leg a source is a point vortex. */
#ifndef SOURCES_H
#define SOURCES_H

#include "base/arena.h"

/* All arrays (n), of the arena of the owner. */
struct sources {
    struct arena *arena;
    int n, capacity;
    double *x, *y;   /* m */
    double *q;       /* m2 s-1 */
    double *dx, *dy; /* C dx, m3 s-1 */
    double *half;    /* b^2/2 with b a quarter of the depth, m2 */
    double *leg;     /* s, m2 */
    double *square;  /* contribution of the source to e^2, m2 */
};

/* Append n sources, all values 0. */
void sources_append(struct sources *sources, int n);

#endif
