/* tree_pairs.h: interaction lists of boxes of vortices and boxes of targets. Part of treecode.h; tested by
 * tests/vortex/test_treecode.c. */
#ifndef TREE_PAIRS_H
#define TREE_PAIRS_H

#include <stddef.h>

#include "base/status.h"
#include "vortex/expansions.h"
#include "vortex/tree_boxes.h"

/* Boxes of targets per unit of thread work in the far field. */
enum { TREE_PAIRS_CHUNK = 16 };

/* Boxes that interact by a direct sum. */
struct near_pair {
    int target, source;
};

/* The expansions of all boxes of a tree. */
struct tree_expansions {
    struct expansion *of; /* of each box    (capacity) */
    double *value;        /* of all   (value_capacity) */
    int capacity;
    size_t value_capacity;
};

/* Truncation limits of an expansion. Half of the tolerance bounds all terms above the harmonic degree p, the other half
 * bounds the mixed terms above the degree q. */
struct tree_limits {
    double tolerance;                                        /* of these limits */
    double theta[EXPANSION_HARMONIC + 1];                    /* largest theta for p */
    double eta[EXPANSION_HARMONIC + 1][EXPANSION_MIXED + 1]; /* largest e^2/S^2 for p and q */
};

/* Vortices of one smoothing, and the pairs with boxes of targets. */
struct tree_sources {
    struct tree_boxes boxes;
    double smoothing, tolerance;
    struct tree_limits limits;
    struct tree_expansions multipole;

    /* pairs in the order of the search, and sorted: near pairs by target, far pairs by chunks of targets and by degrees
     */
    struct expansions_pair *far, *far_sorted;
    struct near_pair *near, *near_sorted;
    int n_far, n_near, far_capacity, near_capacity;
    int *far_first, *near_first; /* first pair of each target box (n_boxes + 1 of the targets) */
    int first_capacity;
};

/* Find and sort the pairs of source boxes and target boxes, allocate the multipole expansions, and raise the degrees of
 * the local expansions to the degrees of the pairs. margin >= 0: relative increase of theta and e/S in the choice of
 * the degrees. Fails with STATUS_MEMORY. */
enum status tree_pairs_find(struct tree_sources *sources, const struct tree_boxes *targets, int with_gradient,
                            double margin, int threads, struct tree_expansions *local);

/* Change the degrees of all pairs: -1 from gradients to velocities alone, +1 back to gradients. */
void tree_pairs_raise(struct tree_sources *sources, int by);

/* Whether the degrees of all pairs meet the tolerance for the present boxes. */
int tree_pairs_fit(const struct tree_sources *sources, const struct tree_boxes *targets, int with_gradient,
                   int threads);

/* tree_expansions_reset removes the expansions of n_boxes boxes; tree_expansions_allocate allocates expansions of the
 * degrees in `of`. Both fail with STATUS_MEMORY. */
enum status tree_expansions_reset(struct tree_expansions *expansions, int n_boxes);
enum status tree_expansions_allocate(struct tree_expansions *expansions, int n_boxes);

/* Release the arrays, not the struct. */
void tree_expansions_clear(struct tree_expansions *expansions);
void tree_sources_clear(struct tree_sources *sources);

/* Resize an array to n elements of a size. On STATUS_MEMORY the array is unchanged. */
enum status tree_pairs_grow(void *array, size_t n, size_t size);

#endif
