/* neighbours.h: which of many boxes overlap: those that overlap in x, from a list that is kept sorted, are compared in
 * y. Bodies that are nearer to each other than a distance are found by boxes that are larger than the bodies by half of
 * it. Tested by tests/contact/test_neighbours.c. */
#ifndef NEIGHBOURS_H
#define NEIGHBOURS_H

#include "base/box.h"
#include "base/status.h"

struct neighbours {
    int n;
    struct box *box; /* to be set by the caller                                                     (n) */
    int *order;      /* the boxes by their low x, as last sorted                                    (n) */

    /* Each overlap once for either box: the boxes that overlap box i are other[first[i]] .. other[first[i + 1] - 1], in
     * ascending order. */
    int *first; /* (n + 1) */
    int *other; /* (first[n]) */
    int capacity;
    int *pair;   /* scratch: pairs as they are found                                         (capacity) */
    int *filled; /* scratch: how many of the overlaps of each box are in their place; then free     (n) */
};

/* Make room for n boxes. Fails with STATUS_MEMORY; neighbours_free accepts NULL. */
enum status neighbours_create(struct neighbours **neighbours, int n);
void neighbours_free(struct neighbours *neighbours);

/* Find all overlaps of the boxes as they are now. The work is that of the overlaps in x, and of the changes of order
 * since the last time. Fails with STATUS_MEMORY; there are no overlaps then. */
enum status neighbours_find(struct neighbours *neighbours);

#endif
