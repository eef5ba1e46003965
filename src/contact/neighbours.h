/* neighbours.h: overlapping pairs of boxes: boxes in a list sorted by x are compared in y if the x ranges overlap.
 * Boxes widened by half a distance find all bodies closer than this distance. Tested by
 * tests/contact/test_neighbours.c. */
#ifndef NEIGHBOURS_H
#define NEIGHBOURS_H

#include "base/mathematics.h"
#include "base/status.h"

struct neighbours {
    int n;
    struct box *box; /* set by the caller                                                        (n) */
    int *order;      /* boxes sorted by low x, from the last call                                    (n) */

    /* Each overlap is listed for both boxes: the boxes that overlap box i are other[first[i]] .. other[first[i + 1] -
     * 1], in ascending order. */
    int *first; /* (n + 1) */
    int *other; /* (first[n]) */
    int capacity;
    int *pair;   /* scratch: pairs in sweep order                                            (capacity) */
    int *filled; /* scratch: number of overlaps of each box entered so far; then free               (n) */
};

/* Allocate n boxes. Fails with STATUS_MEMORY; neighbours_free accepts NULL. */
enum status neighbours_create(struct neighbours **neighbours, int n);
void neighbours_free(struct neighbours *neighbours);

/* Find all overlaps of the present boxes. The cost is proportional to the overlaps in x, plus the changes of order
 * since the last call. Fails with STATUS_MEMORY; there are then no overlaps. */
enum status neighbours_find(struct neighbours *neighbours);

#endif
