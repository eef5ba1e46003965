/* treecode.c: pairs of well-separated boxes, degrees of these pairs, and the passes of a sum. */
#include "vortex/treecode.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "vortex/expansions.h"
#include "vortex/kernel.h"
#include "vortex/tolerance.h"
#include "vortex/tree_boxes.h"

enum {
    CHUNK = 16,         /* boxes of targets per unit of thread work in the far field */
    LEAF = 128,         /* the largest number of points in a leaf */
    LEAF_GRADIENT = 64, /* the same for targets of a gradient: the direct sum costs twice as much */
};

/* Relative increase of theta that a plan tolerates. */
static const double plan_margin = 0.02;

/* The error bound of a pair over the tolerance. The bound assumes the smallest distance between the circles of both
 * boxes for all sources and targets, and equal signs of all errors. With this factor the largest error of a velocity in
 * tests/vortex/test_treecode.c is 0.28 tolerances, for a cluster of vortices of one sign at distances from 1 down to
 * 1e-9; 0.03 tolerances for all other distributions; the test fails if an error exceeds the tolerance. */
static const double bound_per_tolerance = 4;

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

// a search for pairs
struct search {
    struct tree_sources *sources;
    const struct tree_boxes *targets;
    struct tree_expansions *local;
    int with_gradient;
    double stretch; /* 1 + margin */
};

// ---- memory

static enum status tree_expansions_reset(struct tree_expansions *expansions, int n_boxes) {
    if (n_boxes > expansions->capacity) {
        expansions->capacity = 0;
        TRY(MEMORY_RESIZE(expansions->of, n_boxes, "the tree of vortices"));
        expansions->capacity = n_boxes;
    }

    for (int i = 0; i < n_boxes; i++) expansions->of[i].order = (struct expansion_order){-1, 0};
    return STATUS_OK;
}

// raise the degrees of halves to the degrees of the parent; then assign the values of every box
static enum status tree_expansions_allocate(struct tree_expansions *expansions, int n_boxes) {
    size_t n = 0;
    for (int i = 0; i < n_boxes; i++) {
        if (i > 0)
            expansions->of[i].order = expansion_order_max(expansions->of[i].order, expansions->of[(i - 1) / 2].order);
        n += 2 * (size_t)expansions_size(expansions->of[i].order);
    }

    if (n > expansions->value_capacity) {
        expansions->value_capacity = 0;
        TRY(MEMORY_RESIZE(expansions->value, n + n / 2, "the tree of vortices"));
        expansions->value_capacity = n + n / 2;
    }

    n = 0;
    for (int i = 0; i < n_boxes; i++) {
        expansions->of[i].value = expansions->value + n;
        n += 2 * (size_t)expansions_size(expansions->of[i].order);
    }

    return STATUS_OK;
}

static void tree_expansions_clear(struct tree_expansions *expansions) {
    free(expansions->of);
    free(expansions->value);
    *expansions = (struct tree_expansions){0};
}

static void tree_sources_clear(struct tree_sources *sources) {
    tree_boxes_clear(&sources->boxes);
    tree_expansions_clear(&sources->multipole);
    void *const owned[] = {sources->far,         sources->far_sorted, sources->near,
                           sources->near_sorted, sources->far_first,  sources->near_first};
    for (size_t i = 0; i < sizeof owned / sizeof *owned; i++) free(owned[i]);
    *sources = (struct tree_sources){0};
}

// ---- degrees of a pair

// whether an expansion may be truncated above a degree: (1 + theta) theta^p / (1 - theta) <= tolerance / 2
static int truncation_is_small(double theta, int degree, double tolerance) {
    double power = (1 + theta) / (1 - theta);
    for (int i = 0; i < degree; i++) power *= theta;
    return power <= tolerance / TOLERANCE_TERMS;
}

// The largest eta = e^2/S^2 for which the mixed terms above degree q may be truncated: (1 + theta) times the sum of
// n (n - 1)/2 eta theta^(n-1) over n > q, at most tolerance / 2. The ratio of successive terms decreases.
static double eta_limit(double theta, int q, double tolerance) {
    const double ratio = theta * (q + 2) / q;
    if (ratio >= 1) return 0;
    double first = (1 + theta) * q * (q + 1) / 2;
    for (int i = 0; i < q; i++) first *= theta;
    return first * TOLERANCE_TERMS > tolerance * (1 - ratio) ? tolerance / TOLERANCE_TERMS * (1 - ratio) / first : 1;
}

static void limits_find(struct tree_limits *limits, double tolerance) {
    if (limits->tolerance == tolerance) return;
    limits->tolerance = tolerance;
    limits->theta[0] = 0;

    for (int p = 1; p <= EXPANSION_HARMONIC; p++) {
        double low = 0, high = 1;
        for (int i = 0; i < 50; i++) {
            const double middle = (low + high) / 2;
            if (truncation_is_small(middle, p, tolerance)) {
                low = middle;
            } else {
                high = middle;
            }
        }

        limits->theta[p] = low;
        for (int q = 1; q <= EXPANSION_MIXED; q++) limits->eta[p][q] = q < p ? eta_limit(low, q, tolerance) : 1;
    }
}

// The degrees for theta and eta; returns 0 if the highest degrees are too low. The gradient loses one degree.
static int pair_order(const struct tree_limits *limits, int with_gradient, double theta, double eta,
                      struct expansion_order *order) {
    if (!(theta <= limits->theta[EXPANSION_HARMONIC - with_gradient])) return 0;
    int p = 1, q = 1;
    while (theta > limits->theta[p]) p++;
    while (q <= EXPANSION_MIXED && eta > limits->eta[p][q]) q++;
    *order = (struct expansion_order){p + with_gradient, q + with_gradient};
    return order->mixed <= EXPANSION_MIXED;
}

// cost of a pair by expansions, in interactions of the direct sum; fitted to measurements
static double far_cost(struct expansion_order order) {
    const double p = order.harmonic, q = order.mixed;
    return 100 + 0.7 * p * p + (4 + 0.1 * q) * q * q;
}

// ---- interaction lists

static enum status far_pair_add(const struct search *search, int target, int source, struct expansion_order order) {
    struct tree_sources *const sources = search->sources;
    if (sources->n_far == sources->far_capacity) {
        const int capacity = 2 * sources->n_far + 256;
        sources->far_capacity = 0;
        TRY(MEMORY_RESIZE(sources->far, capacity, "the tree of vortices"));
        TRY(MEMORY_RESIZE(sources->far_sorted, capacity, "the tree of vortices"));
        sources->far_capacity = capacity;
    }

    struct expansion_order *const from = &sources->multipole.of[source].order, *const to =
                                                                                   &search->local->of[target].order;
    sources->far[sources->n_far++] = (struct expansions_pair){target, source, order};
    *from = expansion_order_max(*from, order);
    *to = expansion_order_max(*to, order);

    return STATUS_OK;
}

static enum status near_pair_add(const struct search *search, int target, int source) {
    struct tree_sources *const sources = search->sources;
    if (sources->n_near == sources->near_capacity) {
        const int capacity = 2 * sources->n_near + 256;
        sources->near_capacity = 0;
        TRY(MEMORY_RESIZE(sources->near, capacity, "the tree of vortices"));
        TRY(MEMORY_RESIZE(sources->near_sorted, capacity, "the tree of vortices"));
        sources->near_capacity = capacity;
    }

    sources->near[sources->n_near++] = (struct near_pair){target, source};
    return STATUS_OK;
}

static enum status boxes_pair_up(const struct search *search, int target, int source) {
    const struct tree_sources *const sources = search->sources;
    const struct tree_box *const to = &search->targets->box[target], *const from = &sources->boxes.box[source];
    const double rx = to->x - from->x, ry = to->y - from->y, radius = to->radius + from->radius;
    const double square = sources->smoothing * sources->smoothing, scale = rx * rx + ry * ry + square;
    const double limit = sources->limits.theta[EXPANSION_HARMONIC], stretch = search->stretch;
    const double direct = (search->with_gradient ? 2.0 : 1.0) * to->n * from->n;

    if (radius * radius <= limit * limit * scale) {
        const double theta = stretch * radius / sqrt(scale), eta = stretch * stretch * square / scale;
        struct expansion_order order;
        if (pair_order(&sources->limits, search->with_gradient, theta, eta, &order)) {
            return far_cost(order) < direct ? far_pair_add(search, target, source, order)
                                            : near_pair_add(search, target, source);
        }
    }

    const int target_is_leaf = target >= tree_boxes_level(search->targets->depth);
    const int source_is_leaf = source >= tree_boxes_level(sources->boxes.depth);
    if (target_is_leaf && source_is_leaf) return near_pair_add(search, target, source);

    if (source_is_leaf || (!target_is_leaf && to->radius > from->radius)) {
        TRY(boxes_pair_up(search, 2 * target + 1, source));
        return boxes_pair_up(search, 2 * target + 2, source);
    }

    TRY(boxes_pair_up(search, target, 2 * source + 1));
    return boxes_pair_up(search, target, 2 * source + 2);
}

// Pairs of equal degrees are adjacent for the vector loops. No two pairs are equal, so the order is unique.
static int far_pair_compare(const void *left, const void *right) {
    const struct expansions_pair *const a = left, *const b = right;
    if (a->order.mixed != b->order.mixed) return b->order.mixed - a->order.mixed;
    if (a->order.harmonic != b->order.harmonic) return b->order.harmonic - a->order.harmonic;
    if (a->target != b->target) return a->target - b->target;
    return a->source - b->source;
}

// sort pairs by target
static void pairs_sort(struct tree_sources *sources, int n_boxes, int threads) {
    int *const far_first = sources->far_first, *const near_first = sources->near_first;
    memset(far_first, 0, ((size_t)n_boxes + 1) * sizeof *far_first);
    memset(near_first, 0, ((size_t)n_boxes + 1) * sizeof *near_first);
    for (int i = 0; i < sources->n_far; i++) far_first[sources->far[i].target]++;
    for (int i = 0; i < sources->n_near; i++) near_first[sources->near[i].target]++;

    for (int b = 1; b <= n_boxes; b++) {
        far_first[b] += far_first[b - 1];
        near_first[b] += near_first[b - 1];
    }

    for (int i = sources->n_far - 1; i >= 0; i--) {
        sources->far_sorted[--far_first[sources->far[i].target]] = sources->far[i];
    }

    threads = parallel_threads(threads, n_boxes, sources->n_far, PARALLEL_SORTED);
#pragma omp parallel for num_threads(threads) schedule(dynamic)
    for (int b = 0; b < n_boxes; b += CHUNK) {
        const int first = far_first[b], end = far_first[b + CHUNK < n_boxes ? b + CHUNK : n_boxes];
        if (first == end) continue;
        qsort(sources->far_sorted + first, (size_t)(end - first), sizeof *sources->far_sorted, far_pair_compare);
    }

    for (int i = sources->n_near - 1; i >= 0; i--) {
        sources->near_sorted[--near_first[sources->near[i].target]] = sources->near[i];
    }
}

// Find and sort the pairs of source boxes and target boxes, allocate the multipole expansions, and raise the degrees of
// the local expansions to the degrees of the pairs. margin >= 0: relative increase of theta and e/S in the choice of
// the degrees.
static enum status tree_pairs_find(struct tree_sources *sources, const struct tree_boxes *targets, int with_gradient,
                                   double margin, int threads, struct tree_expansions *local) {
    if (targets->n_boxes + 1 > sources->first_capacity) {
        const size_t n = (size_t)targets->n_boxes + 1;
        sources->first_capacity = 0;
        TRY(MEMORY_RESIZE(sources->far_first, n, "the tree of vortices"));
        TRY(MEMORY_RESIZE(sources->near_first, n, "the tree of vortices"));
        sources->first_capacity = (int)n;
    }

    limits_find(&sources->limits, bound_per_tolerance * sources->tolerance);
    TRY(tree_expansions_reset(&sources->multipole, sources->boxes.n_boxes));
    sources->n_far = sources->n_near = 0;
    const struct search search = {sources, targets, local, with_gradient, 1 + margin};
    TRY(boxes_pair_up(&search, 0, 0));
    pairs_sort(sources, targets->n_boxes, threads);

    return tree_expansions_allocate(&sources->multipole, sources->boxes.n_boxes);
}

// returns 0 for positions that are not finite: a comparison with NaN is false
static int pair_fits(const struct tree_limits *limits, int with_gradient, double smoothing, const struct tree_box *to,
                     const struct tree_box *from, struct expansion_order order) {
    const double rx = to->x - from->x, ry = to->y - from->y, radius = to->radius + from->radius;
    const double square = smoothing * smoothing, scale = rx * rx + ry * ry + square;
    const int p = order.harmonic - with_gradient, q = order.mixed - with_gradient;
    return radius * radius <= limits->theta[p] * limits->theta[p] * scale && square <= limits->eta[p][q] * scale;
}

// whether the degrees of all pairs meet the tolerance for the present boxes
static int tree_pairs_fit(const struct tree_sources *sources, const struct tree_boxes *targets, int with_gradient,
                          int threads) {
    int all = 1;
    threads = parallel_threads(threads, sources->n_far, sources->n_far, PARALLEL_SORTED);
#pragma omp parallel for num_threads(threads) schedule(static)
    for (int i = 0; i < sources->n_far; i++) {
        const struct expansions_pair *const pair = &sources->far_sorted[i];
        if (pair_fits(&sources->limits, with_gradient, sources->smoothing, &targets->box[pair->target],
                      &sources->boxes.box[pair->source], pair->order))
            continue;

#pragma omp atomic write
        all = 0;
    }

    return all;
}

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
    return MEMORY_NEW(*tree, 1, "the tree of vortices");
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
        TRY(MEMORY_RESIZE(tree->sum, n_sum + n_sum / 2, "the tree of vortices"));
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
    TRY(MEMORY_RESIZE(tree->sources, tree->capacity + 1, "the tree of vortices"));
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
        // -1 from gradients to velocities alone, +1 back to gradients
        const int by = with_gradient - tree->with_gradient;
        for (int i = 0; i < tree->sources[s].n_far; i++) {
            struct expansion_order *const order = &tree->sources[s].far_sorted[i].order;
            *order = (struct expansion_order){order->harmonic + by, order->mixed + by};
        }
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
