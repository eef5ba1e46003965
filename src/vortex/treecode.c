/* treecode.c: all passes of a sum. */
#include "vortex/treecode.h"

#include <stdlib.h>
#include <string.h>

#include "base/parallel.h"
#include "vortex/kernel.h"
#include "vortex/tree_pairs.h"

enum {
    LEAF = 128,         /* the largest number of points in a leaf */
    LEAF_GRADIENT = 64, /* the same for targets of a gradient: the direct sum costs twice as much */
    CHUNK = TREE_PAIRS_CHUNK
};

/* Relative increase of theta that a plan tolerates. */
static const double plan_margin = 0.02;

struct treecode {
    struct tree_sources *sources; /* of each set                       (capacity) */
    int n_sets, capacity;
    struct tree_boxes targets;
    int with_gradient;            /* whether the pairs have the degrees of gradients */
    struct tree_expansions local; /* of the targets, for all sets together */
    double *sum;                  /* u, v and the gradient at the sorted targets, one after another (5 n) */
    size_t sum_capacity;
};

enum status treecode_create(struct treecode **tree) {
    *tree = calloc(1, sizeof **tree);
    return *tree ? STATUS_OK : status_fail(STATUS_MEMORY, "out of memory: a tree");
}

void treecode_free(struct treecode *tree) {
    if (!tree) return;
    for (int s = 0; s < tree->capacity; s++) tree_sources_clear(&tree->sources[s]);
    tree_boxes_clear(&tree->targets);
    tree_expansions_clear(&tree->local);
    free(tree->sources);
    free(tree->sum);
    free(tree);
}

// sort points into boxes, or copy the boxes of a set with the same points
static enum status boxes_fill_or_copy(const struct treecode *tree, struct tree_boxes *boxes, int n, const double *x,
                                      const double *y, const double *weight, int leaf, int threads) {
    for (int s = 0; s < tree->n_sets; s++) {
        const struct tree_boxes *const other = &tree->sources[s].boxes;
        if (tree_boxes_hold(other, n, x, y, leaf)) return tree_boxes_copy(boxes, other, weight);
    }
    return tree_boxes_fill(boxes, n, x, y, weight, leaf, threads);
}

// sort the targets, and find the pairs of every set
static enum status targets_pair_up(struct treecode *tree, int n_targets, const double *x, const double *y,
                                   int with_gradient, double margin, int threads) {
    tree->with_gradient = with_gradient;
    TRY(boxes_fill_or_copy(tree, &tree->targets, n_targets, x, y, NULL, with_gradient ? LEAF_GRADIENT : LEAF, threads));
    const size_t n_sum = (with_gradient ? 5 : 2) * (size_t)n_targets;

    if (n_sum > tree->sum_capacity) {
        tree->sum_capacity = 0;
        TRY(tree_pairs_grow(&tree->sum, n_sum + n_sum / 2, sizeof *tree->sum));
        tree->sum_capacity = n_sum + n_sum / 2;
    }

    TRY(tree_expansions_reset(&tree->local, tree->targets.n_boxes));
    for (int s = 0; s < tree->n_sets; s++) {
        TRY(tree_pairs_find(&tree->sources[s], &tree->targets, with_gradient, margin, threads, &tree->local));
    }

    return tree_expansions_allocate(&tree->local, tree->targets.n_boxes);
}

// P2M and M2M
static void upward_pass(const struct tree_sources *sources, int threads) {
    const struct tree_boxes *const boxes = &sources->boxes;
    const struct expansion *const multipole = sources->multipole.of;
    const int first_leaf = tree_boxes_level(boxes->depth);

#pragma omp parallel for num_threads(threads) schedule(dynamic)
    for (int b = first_leaf; b < boxes->n_boxes; b++) {
        if (multipole[b].order.harmonic >= 0) expansions_p2m(boxes, b, &multipole[b]);
    }

    for (int level = boxes->depth - 1; level >= 0; level--) {
        const int first = tree_boxes_level(level), end = tree_boxes_level(level + 1);
#pragma omp parallel for num_threads(parallel_threads(threads, end - first, end - first, PARALLEL_BOXES)) \
    schedule(dynamic)
        for (int b = first; b < end; b += EXPANSION_LANES / 2) {
            expansions_m2m(boxes, b, end - b < EXPANSION_LANES / 2 ? end - b : EXPANSION_LANES / 2, multipole);
        }
    }
}

// M2L
static void far_field(const struct treecode *tree, int threads) {
    const struct tree_boxes *const boxes = &tree->targets;
#pragma omp parallel for num_threads(threads) schedule(dynamic)
    for (int b = 0; b < boxes->n_boxes; b += CHUNK) {
        const int end = b + CHUNK < boxes->n_boxes ? b + CHUNK : boxes->n_boxes;
        for (int i = b; i < end; i++) {
            const struct expansion *const local = &tree->local.of[i];
            if (local->order.harmonic < 0) continue;
            memset(local->value, 0, 2 * (size_t)expansions_size(local->order) * sizeof *local->value);
        }

        for (int s = 0; s < tree->n_sets; s++) {
            const struct tree_sources *const from = &tree->sources[s];
            const int first = from->far_first[b];
            expansions_m2l(boxes, &from->boxes, from->smoothing, from->far_first[end] - first, from->far_sorted + first,
                           from->multipole.of, tree->local.of);
        }
    }
}

// L2L
static void downward_pass(struct treecode *tree, int threads) {
    const struct tree_boxes *const boxes = &tree->targets;
    for (int level = 0; level < boxes->depth; level++) {
        const int first = tree_boxes_level(level), end = tree_boxes_level(level + 1);

#pragma omp parallel for num_threads(parallel_threads(threads, end - first, end - first, PARALLEL_BOXES)) \
    schedule(dynamic)
        for (int b = first; b < end; b += EXPANSION_LANES / 2) {
            expansions_l2l(boxes, b, end - b < EXPANSION_LANES / 2 ? end - b : EXPANSION_LANES / 2, tree->local.of);
        }
    }
}

// the direct sums at the points of a leaf over all boxes of a set near one box around the leaf
static void leaf_add_near_field(const struct treecode *tree, const struct tree_sources *from, int leaf, int box,
                                double *const sum[5]) {
    const struct tree_boxes *const targets = &tree->targets, *const sources = &from->boxes;
    const int t = targets->box[leaf].first, n = targets->box[leaf].n;
    for (int i = from->near_first[box]; i < from->near_first[box + 1];) {
        // merge source boxes of consecutive points
        const int s = sources->box[from->near_sorted[i].source].first;
        int end = s;

        while (i < from->near_first[box + 1] && sources->box[from->near_sorted[i].source].first == end) {
            end += sources->box[from->near_sorted[i++].source].n;
        }

        if (sum[2]) {
            kernel_add_gradient(n, targets->x + t, targets->y + t, end - s, sources->x + s, sources->y + s,
                                sources->weight + s, from->smoothing, sum[0] + t, sum[1] + t, sum[2] + t, sum[3] + t,
                                sum[4] + t);
        } else {
            kernel_add_velocity(n, targets->x + t, targets->y + t, end - s, sources->x + s, sources->y + s,
                                sources->weight + s, from->smoothing, sum[0] + t, sum[1] + t);
        }
    }
}

// L2P and the near field
static void leaves_evaluate(struct treecode *tree, int threads, double *const sum[5], double *const out[5]) {
    const struct tree_boxes *const boxes = &tree->targets;
#pragma omp parallel for num_threads(threads) schedule(dynamic)
    for (int leaf = tree_boxes_level(boxes->depth); leaf < boxes->n_boxes; leaf++) {
        const struct tree_box *const own = &boxes->box[leaf];
        const int end = own->first + own->n;
        for (int k = 0; k < 5 && sum[k]; k++) memset(sum[k] + own->first, 0, (size_t)own->n * sizeof *sum[k]);

        for (int s = 0; s < tree->n_sets; s++) {
            for (int box = leaf;; box = (box - 1) / 2) {
                leaf_add_near_field(tree, &tree->sources[s], leaf, box, sum);
                if (box == 0) break;
            }
        }

        if (tree->local.of[leaf].order.harmonic >= 0) {
            expansions_l2p(boxes, leaf, &tree->local.of[leaf], sum[0], sum[1], sum[2] ? sum + 2 : NULL);
        }

        for (int k = 0; k < 5 && sum[k]; k++) {
            for (int i = own->first; i < end; i++) out[k][boxes->index[i]] += sum[k][i];
        }
    }
}

// all passes for the present pairs
static void pairs_sum(struct treecode *tree, int threads, double *const out[5]) {
    double *sum[5] = {0};
    for (int k = 0; k < 5 && out[k]; k++) sum[k] = tree->sum + (size_t)k * (size_t)tree->targets.n;
    for (int s = 0; s < tree->n_sets; s++) upward_pass(&tree->sources[s], threads);
    far_field(tree, threads);
    downward_pass(tree, threads);
    leaves_evaluate(tree, threads, sum, out);
}

static enum status tree_add(struct treecode *tree, int n_targets, const double *x, const double *y, int threads,
                            double *const out[5]) {
    if (n_targets == 0 || tree->n_sets == 0) return STATUS_OK;
    TRY(targets_pair_up(tree, n_targets, x, y, out[2] != NULL, 0, threads));
    pairs_sum(tree, threads, out);
    return STATUS_OK;
}

// allocate one more set
static enum status set_reserve(struct treecode *tree) {
    if (tree->n_sets < tree->capacity) return STATUS_OK;
    TRY(tree_pairs_grow(&tree->sources, (size_t)tree->capacity + 1, sizeof *tree->sources));
    tree->sources[tree->capacity++] = (struct tree_sources){0};
    return STATUS_OK;
}

enum status treecode_build_more(struct treecode *tree, int n, const double *x, const double *y,
                                const double *circulation, double smoothing, double tolerance, int threads) {
    if (n == 0) return STATUS_OK;
    enum status status = set_reserve(tree);
    if (status == STATUS_OK) {
        struct tree_sources *const sources = &tree->sources[tree->n_sets];
        sources->smoothing = smoothing;
        sources->tolerance = tolerance;
        status = boxes_fill_or_copy(tree, &sources->boxes, n, x, y, circulation, LEAF, threads);
    }

    tree->n_sets = status == STATUS_OK ? tree->n_sets + 1 : 0;
    return status;
}

enum status treecode_build(struct treecode *tree, int n, const double *x, const double *y, const double *circulation,
                           double smoothing, double tolerance, int threads) {
    tree->n_sets = 0;
    return treecode_build_more(tree, n, x, y, circulation, smoothing, tolerance, threads);
}

enum status treecode_add_velocity(struct treecode *tree, int n_targets, const double *x, const double *y, int threads,
                                  double *u, double *v) {
    return tree_add(tree, n_targets, x, y, threads, (double *const[5]){u, v});
}

enum status treecode_add_gradient(struct treecode *tree, int n_targets, const double *x, const double *y, int threads,
                                  double *u, double *v, double *u_x, double *u_y, double *v_x) {
    return tree_add(tree, n_targets, x, y, threads, (double *const[5]){u, v, u_x, u_y, v_x});
}

enum status treecode_plan(struct treecode *tree, int n_targets, const double *x, const double *y, int with_gradient,
                          int threads) {
    return targets_pair_up(tree, n_targets, x, y, with_gradient, plan_margin, threads);
}

void treecode_move_vortices(struct treecode *tree, int set, const double *x, const double *y, const double *circulation,
                            int threads) {
    tree_boxes_move(&tree->sources[set].boxes, x, y, circulation, threads);
}

void treecode_move_targets(struct treecode *tree, const double *x, const double *y, int threads) {
    tree_boxes_move(&tree->targets, x, y, NULL, threads);
}

// Set the degrees of the pairs for this sum: a gradient needs one more degree. Expansions keep the allocated degrees.
static void pairs_set_degrees(struct treecode *tree, int with_gradient) {
    for (int s = 0; s < tree->n_sets && with_gradient != tree->with_gradient; s++) {
        tree_pairs_raise(&tree->sources[s], with_gradient - tree->with_gradient);
    }
    tree->with_gradient = with_gradient;
}

int treecode_fits(const struct treecode *tree, int threads) {
    int all = 1;
    for (int s = 0; s < tree->n_sets && all; s++) {
        all = tree_pairs_fit(&tree->sources[s], &tree->targets, tree->with_gradient, threads);
    }
    return all;
}

void treecode_add_planned(struct treecode *tree, int threads, double *u, double *v, double *u_x, double *u_y,
                          double *v_x) {
    pairs_set_degrees(tree, u_x != NULL);
    pairs_sum(tree, threads, (double *const[5]){u, v, u_x, u_y, v_x});
}
