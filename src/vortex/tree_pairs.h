/* tree_pairs.h: which boxes of vortices interact with which boxes of targets, and how. Part of treecode.h; tested by
 * tests/vortex/test_treecode.c. */
#ifndef TREE_PAIRS_H
#define TREE_PAIRS_H

#include <stddef.h>

#include "base/status.h"
#include "vortex/expansions.h"
#include "vortex/tree_boxes.h"

/* Boxes of targets whose far pairs one thread takes at once. */
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

/* Where an expansion may be truncated. Half of the tolerance is for all terms above the harmonic degree p, half for the
 * mixed ones above the degree q. */
struct tree_limits {
    double tolerance;                                        /* for which these are */
    double theta[EXPANSION_HARMONIC + 1];                    /* largest theta for p */
    double eta[EXPANSION_HARMONIC + 1][EXPANSION_MIXED + 1]; /* largest e^2/S^2 for p and q */
};

/* Vortices of one smoothing, and the boxes of targets that they interact with. */
struct tree_sources {
    struct tree_boxes boxes;
    double smoothing, tolerance;
    struct tree_limits limits;
    struct tree_expansions multipole;

    /* pairs as they are found, and sorted: near ones by target, far ones by chunks of targets and their degrees */
    struct expansions_pair *far, *far_sorted;
    struct near_pair *near, *near_sorted;
    int n_far, n_near, far_capacity, near_capacity;
    int *far_first, *near_first; /* where the pairs of each target box begin (n_boxes + 1 of the targets) */
    int first_capacity;
};

/* Find and sort the pairs of all boxes with those of the targets, allocate the multipole expansions, and raise the
 * degrees of the local expansions to what the pairs need. margin >= 0: the degrees are those that the pairs would need
 * if theta and e/S were larger by this part. Fails with STATUS_MEMORY. */
enum status tree_pairs_find(struct tree_sources *sources, const struct tree_boxes *targets, int with_gradient,
                            double margin, int threads, struct tree_expansions *local);

/* Change the degrees of all pairs: by -1 from those for gradients to those for velocities alone, or by 1 back. */
void tree_pairs_raise(struct tree_sources *sources, int by);

/* Whether the degrees of all pairs still keep the tolerance for the boxes as they are now. */
int tree_pairs_fit(const struct tree_sources *sources, const struct tree_boxes *targets, int with_gradient,
                   int threads);

/* Give each of n_boxes no expansion; then allocate those of the degrees that have been found since. Fail with
 * STATUS_MEMORY. */
enum status tree_expansions_reset(struct tree_expansions *expansions, int n_boxes);
enum status tree_expansions_allocate(struct tree_expansions *expansions, int n_boxes);

/* Release what they hold, not the structs themselves. */
void tree_expansions_clear(struct tree_expansions *expansions);
void tree_sources_clear(struct tree_sources *sources);

/* Resize an array of elements of some size. Fails with STATUS_MEMORY; the array is then as it was. */
enum status tree_pairs_grow(void *array, size_t n, size_t size);

#endif
