/* treecode.c: which boxes interact how, and all passes of a sum. */
#include "vortex/treecode.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/parallel.h"
#include "vortex/expansions.h"
#include "vortex/kernel.h"

enum {
    LEAF = 128,         /* the largest number of points in a box that is not halved */
    LEAF_GRADIENT = 64, /* the same for targets of a gradient, whose direct sum costs twice as much */
    CHUNK = 16          /* boxes of targets whose far pairs one thread takes at once */
};

// The bound on the error of a pair takes all sources and targets to be as near to each other as their boxes allow. True
// errors are so much smaller (tests/vortex/test_treecode.c) that the bound may be this many tolerances.
static const double bound_per_tolerance = 4;

// boxes that interact by a direct sum
struct near_pair {
    int target, source;
};

// the expansions of all boxes of a tree
struct expansions {
    struct expansion *of; /* of each box    (capacity) */
    double *value;        /* of all   (value_capacity) */
    int capacity;
    size_t value_capacity;
};

// Where an expansion may be truncated. Half of the tolerance is for all terms above the harmonic degree p, half for the
// mixed ones above the degree q.
struct limits {
    double tolerance;                                        /* for which these are */
    double theta[EXPANSION_HARMONIC + 1];                    /* largest theta for p */
    double eta[EXPANSION_HARMONIC + 1][EXPANSION_MIXED + 1]; /* largest e^2/S^2 for p and q */
};

struct treecode {
    struct tree_boxes sources, targets;
    double smoothing;
    struct expansions multipole, local; /* of the sources and the targets */

    // pairs as they are found, and sorted by their target
    struct expansions_pair *far, *far_sorted;
    struct near_pair *near, *near_sorted;
    int n_far, n_near, far_capacity, near_capacity;
    int *far_first, *near_first; /* where the pairs of each target box begin (n_boxes + 1 of the targets) */
    int first_capacity;

    double *sum; /* u, v and the gradient at the sorted targets, one after another (5 n) */
    size_t sum_capacity;

    struct limits limits;
};

// ---- memory ----

static enum status grow(void *memory, size_t n, size_t size) {
    void **const pointer = memory;
    void *const more = realloc(*pointer, n * size);
    if (!more) return status_fail(STATUS_MEMORY, "out of memory: %zu bytes of a tree", n * size);
    *pointer = more;
    return STATUS_OK;
}

enum status treecode_create(struct treecode **tree) {
    *tree = calloc(1, sizeof **tree);
    return *tree ? STATUS_OK : status_fail(STATUS_MEMORY, "out of memory: a tree");
}

void treecode_free(struct treecode *tree) {
    if (!tree) return;
    tree_boxes_clear(&tree->sources);
    tree_boxes_clear(&tree->targets);
    void *const owned[] = {tree->multipole.of, tree->multipole.value, tree->local.of, tree->local.value,
                           tree->far,          tree->far_sorted,      tree->near,     tree->near_sorted,
                           tree->far_first,    tree->near_first,      tree->sum};
    for (size_t i = 0; i < sizeof owned / sizeof *owned; i++) free(owned[i]);
    free(tree);
}

// ---- which degrees a pair needs ----

// whether an expansion may be truncated above a degree: (1 + theta) theta^p / (1 - theta) <= tolerance / 2
static int is_small(double theta, int degree, double tolerance) {
    double power = (1 + theta) / (1 - theta);
    for (int i = 0; i < degree; i++) power *= theta;
    return power <= tolerance / 2;
}

// The largest eta = e^2/S^2 for which the mixed terms above degree q may be left out: (1 + theta) times the sum of
// n (n - 1)/2 eta theta^(n-1) over n > q, at most tolerance / 2. The ratio of successive terms decreases.
static double eta_limit(double theta, int q, double tolerance) {
    const double ratio = theta * (q + 2) / q;
    if (ratio >= 1) return 0;
    double first = (1 + theta) * q * (q + 1) / 2;
    for (int i = 0; i < q; i++) first *= theta;
    return first * 2 > tolerance * (1 - ratio) ? tolerance / 2 * (1 - ratio) / first : 1;
}

static void find_limits(struct limits *limits, double tolerance) {
    if (limits->tolerance == tolerance) return;
    limits->tolerance = tolerance;
    limits->theta[0] = 0;
    for (int p = 1; p <= EXPANSION_HARMONIC; p++) {
        double low = 0, high = 1;
        for (int i = 0; i < 50; i++) {
            const double middle = (low + high) / 2;
            if (is_small(middle, p, tolerance)) {
                low = middle;
            } else {
                high = middle;
            }
        }
        limits->theta[p] = low;
        for (int q = 1; q <= EXPANSION_MIXED; q++) limits->eta[p][q] = q < p ? eta_limit(low, q, tolerance) : 1;
    }
}

// The degrees for theta and eta; returns 0 if the highest are too low. The gradient loses one degree.
static int find_order(const struct limits *limits, int with_gradient, double theta, double eta,
                      struct expansion_order *order) {
    if (!(theta <= limits->theta[EXPANSION_HARMONIC - with_gradient])) return 0;
    int p = 1, q = 1;
    while (theta > limits->theta[p]) p++;
    while (q <= EXPANSION_MIXED && eta > limits->eta[p][q]) q++;
    *order = (struct expansion_order){p + with_gradient, q + with_gradient};
    return order->mixed <= EXPANSION_MIXED;
}

// time of a pair by expansions, in interactions of the direct sum; fitted to measurements
static double far_cost(struct expansion_order order) {
    const double p = order.harmonic, q = order.mixed;
    return 100 + 0.7 * p * p + (4 + 0.1 * q) * q * q;
}

// ---- which boxes interact, and how ----

static enum status add_far(struct treecode *tree, int target, int source, struct expansion_order order) {
    if (tree->n_far == tree->far_capacity) {
        const int capacity = 2 * tree->n_far + 256;
        tree->far_capacity = 0;
        TRY(grow(&tree->far, (size_t)capacity, sizeof *tree->far));
        TRY(grow(&tree->far_sorted, (size_t)capacity, sizeof *tree->far_sorted));
        tree->far_capacity = capacity;
    }
    tree->far[tree->n_far++] = (struct expansions_pair){target, source, order};
    tree->multipole.of[source].order = expansion_order_max(tree->multipole.of[source].order, order);
    tree->local.of[target].order = expansion_order_max(tree->local.of[target].order, order);
    return STATUS_OK;
}

static enum status add_near(struct treecode *tree, int target, int source) {
    if (tree->n_near == tree->near_capacity) {
        const int capacity = 2 * tree->n_near + 256;
        tree->near_capacity = 0;
        TRY(grow(&tree->near, (size_t)capacity, sizeof *tree->near));
        TRY(grow(&tree->near_sorted, (size_t)capacity, sizeof *tree->near_sorted));
        tree->near_capacity = capacity;
    }
    tree->near[tree->n_near++] = (struct near_pair){target, source};
    return STATUS_OK;
}

static enum status pair_up(struct treecode *tree, int with_gradient, int target, int source) {
    const struct tree_box *const to = &tree->targets.box[target], *const from = &tree->sources.box[source];
    const double rx = to->x - from->x, ry = to->y - from->y, radius = to->radius + from->radius;
    const double square = tree->smoothing * tree->smoothing, scale = rx * rx + ry * ry + square;
    const double limit = tree->limits.theta[EXPANSION_HARMONIC];
    const double direct = (with_gradient ? 2.0 : 1.0) * to->n * from->n;
    if (radius * radius <= limit * limit * scale) {
        struct expansion_order order;
        if (find_order(&tree->limits, with_gradient, radius / sqrt(scale), square / scale, &order)) {
            return far_cost(order) < direct ? add_far(tree, target, source, order) : add_near(tree, target, source);
        }
    }
    const int target_is_leaf = target >= tree_boxes_level(tree->targets.depth);
    const int source_is_leaf = source >= tree_boxes_level(tree->sources.depth);
    if (target_is_leaf && source_is_leaf) return add_near(tree, target, source);
    if (source_is_leaf || (!target_is_leaf && to->radius > from->radius)) {
        TRY(pair_up(tree, with_gradient, 2 * target + 1, source));
        return pair_up(tree, with_gradient, 2 * target + 2, source);
    }
    TRY(pair_up(tree, with_gradient, target, 2 * source + 1));
    return pair_up(tree, with_gradient, target, 2 * source + 2);
}

// Pairs with the same degrees are best done together. No two pairs are the same, so the order is unique.
static int compare_far(const void *left, const void *right) {
    const struct expansions_pair *const a = left, *const b = right;
    if (a->order.mixed != b->order.mixed) return b->order.mixed - a->order.mixed;
    if (a->order.harmonic != b->order.harmonic) return b->order.harmonic - a->order.harmonic;
    if (a->target != b->target) return a->target - b->target;
    return a->source - b->source;
}

// sort pairs by their target
static void sort_pairs(struct treecode *tree) {
    const int n_boxes = tree->targets.n_boxes;
    memset(tree->far_first, 0, ((size_t)n_boxes + 1) * sizeof *tree->far_first);
    memset(tree->near_first, 0, ((size_t)n_boxes + 1) * sizeof *tree->near_first);
    for (int i = 0; i < tree->n_far; i++) tree->far_first[tree->far[i].target]++;
    for (int i = 0; i < tree->n_near; i++) tree->near_first[tree->near[i].target]++;
    for (int b = 1; b <= n_boxes; b++) {
        tree->far_first[b] += tree->far_first[b - 1];
        tree->near_first[b] += tree->near_first[b - 1];
    }
    for (int i = tree->n_far - 1; i >= 0; i--) tree->far_sorted[--tree->far_first[tree->far[i].target]] = tree->far[i];
    for (int b = 0; b < n_boxes; b += CHUNK) {
        const int first = tree->far_first[b], end = tree->far_first[b + CHUNK < n_boxes ? b + CHUNK : n_boxes];
        if (first < end) qsort(tree->far_sorted + first, (size_t)(end - first), sizeof *tree->far_sorted, compare_far);
    }
    for (int i = tree->n_near - 1; i >= 0; i--) {
        tree->near_sorted[--tree->near_first[tree->near[i].target]] = tree->near[i];
    }
}

static enum status reset_orders(struct expansions *expansions, int n_boxes) {
    if (n_boxes > expansions->capacity) {
        expansions->capacity = 0;
        TRY(grow(&expansions->of, (size_t)n_boxes, sizeof *expansions->of));
        expansions->capacity = n_boxes;
    }
    for (int i = 0; i < n_boxes; i++) expansions->of[i].order = (struct expansion_order){-1, 0};
    return STATUS_OK;
}

// halves need the degrees of the whole; then give every box its values
static enum status allocate_values(struct expansions *expansions, int n_boxes) {
    size_t n = 0;
    for (int i = 0; i < n_boxes; i++) {
        if (i > 0)
            expansions->of[i].order = expansion_order_max(expansions->of[i].order, expansions->of[(i - 1) / 2].order);
        n += 2 * (size_t)expansions_size(expansions->of[i].order);
    }
    if (n > expansions->value_capacity) {
        expansions->value_capacity = 0;
        TRY(grow(&expansions->value, n + n / 2, sizeof *expansions->value));
        expansions->value_capacity = n + n / 2;
    }
    n = 0;
    for (int i = 0; i < n_boxes; i++) {
        expansions->of[i].value = expansions->value + n;
        n += 2 * (size_t)expansions_size(expansions->of[i].order);
    }
    return STATUS_OK;
}

static enum status plan(struct treecode *tree, int n_targets, const double *x, const double *y, int with_gradient) {
    TRY(tree_boxes_fill(&tree->targets, n_targets, x, y, NULL, with_gradient ? LEAF_GRADIENT : LEAF));
    const int n_boxes = tree->targets.n_boxes;
    if (n_boxes + 1 > tree->first_capacity) {
        tree->first_capacity = 0;
        TRY(grow(&tree->far_first, (size_t)n_boxes + 1, sizeof *tree->far_first));
        TRY(grow(&tree->near_first, (size_t)n_boxes + 1, sizeof *tree->near_first));
        tree->first_capacity = n_boxes + 1;
    }
    const size_t n_sum = (with_gradient ? 5 : 2) * (size_t)n_targets;
    if (n_sum > tree->sum_capacity) {
        tree->sum_capacity = 0;
        TRY(grow(&tree->sum, n_sum + n_sum / 2, sizeof *tree->sum));
        tree->sum_capacity = n_sum + n_sum / 2;
    }
    TRY(reset_orders(&tree->multipole, tree->sources.n_boxes));
    TRY(reset_orders(&tree->local, n_boxes));
    tree->n_far = tree->n_near = 0;
    TRY(pair_up(tree, with_gradient, 0, 0));
    sort_pairs(tree);
    TRY(allocate_values(&tree->multipole, tree->sources.n_boxes));
    return allocate_values(&tree->local, n_boxes);
}

// ---- the sum ----

// P2M and M2M
static void upward_pass(struct treecode *tree, int threads) {
    const struct tree_boxes *const boxes = &tree->sources;
    const int first_leaf = tree_boxes_level(boxes->depth);
#pragma omp parallel for num_threads(threads) schedule(dynamic)
    for (int b = first_leaf; b < boxes->n_boxes; b++) {
        if (tree->multipole.of[b].order.harmonic >= 0) expansions_p2m(boxes, b, &tree->multipole.of[b]);
    }
    for (int level = boxes->depth - 1; level >= 0; level--) {
        const int first = tree_boxes_level(level), end = tree_boxes_level(level + 1);
#pragma omp parallel for num_threads(parallel_threads(threads, end - first, end - first, PARALLEL_BOXES)) \
    schedule(dynamic)
        for (int b = first; b < end; b += EXPANSION_LANES / 2) {
            expansions_m2m(boxes, b, end - b < EXPANSION_LANES / 2 ? end - b : EXPANSION_LANES / 2, tree->multipole.of);
        }
    }
}

// M2L
static void far_field(struct treecode *tree, int threads) {
    const struct tree_boxes *const boxes = &tree->targets;
#pragma omp parallel for num_threads(threads) schedule(dynamic)
    for (int b = 0; b < boxes->n_boxes; b += CHUNK) {
        const int end = b + CHUNK < boxes->n_boxes ? b + CHUNK : boxes->n_boxes;
        for (int i = b; i < end; i++) {
            const struct expansion *const local = &tree->local.of[i];
            if (local->order.harmonic < 0) continue;
            memset(local->value, 0, 2 * (size_t)expansions_size(local->order) * sizeof *local->value);
        }
        const int first = tree->far_first[b];
        expansions_m2l(boxes, &tree->sources, tree->smoothing, tree->far_first[end] - first, tree->far_sorted + first,
                       tree->multipole.of, tree->local.of);
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

// the direct sums at the points of a leaf over all boxes near one box that contains it
static void add_near_field(const struct treecode *tree, int leaf, int box, double *const sum[5]) {
    const struct tree_boxes *const targets = &tree->targets, *const sources = &tree->sources;
    const int t = targets->box[leaf].first, n = targets->box[leaf].n;
    for (int i = tree->near_first[box]; i < tree->near_first[box + 1];) {
        // boxes whose points are consecutive are one
        const int s = sources->box[tree->near_sorted[i].source].first;
        int end = s;
        while (i < tree->near_first[box + 1] && sources->box[tree->near_sorted[i].source].first == end) {
            end += sources->box[tree->near_sorted[i++].source].n;
        }
        if (sum[2]) {
            kernel_add_gradient(n, targets->x + t, targets->y + t, end - s, sources->x + s, sources->y + s,
                                sources->weight + s, tree->smoothing, sum[0] + t, sum[1] + t, sum[2] + t, sum[3] + t,
                                sum[4] + t);
        } else {
            kernel_add_velocity(n, targets->x + t, targets->y + t, end - s, sources->x + s, sources->y + s,
                                sources->weight + s, tree->smoothing, sum[0] + t, sum[1] + t);
        }
    }
}

// L2P and the near field
static void evaluate_leaves(struct treecode *tree, int threads, double *const sum[5], double *const out[5]) {
    const struct tree_boxes *const boxes = &tree->targets;
#pragma omp parallel for num_threads(threads) schedule(dynamic)
    for (int leaf = tree_boxes_level(boxes->depth); leaf < boxes->n_boxes; leaf++) {
        const struct tree_box *const own = &boxes->box[leaf];
        const int end = own->first + own->n;
        for (int k = 0; k < 5 && sum[k]; k++) memset(sum[k] + own->first, 0, (size_t)own->n * sizeof *sum[k]);
        for (int box = leaf;; box = (box - 1) / 2) {
            add_near_field(tree, leaf, box, sum);
            if (box == 0) break;
        }
        if (tree->local.of[leaf].order.harmonic >= 0) {
            expansions_l2p(boxes, leaf, &tree->local.of[leaf], sum[0], sum[1], sum[2] ? sum + 2 : NULL);
        }
        for (int k = 0; k < 5 && sum[k]; k++) {
            for (int i = own->first; i < end; i++) out[k][boxes->index[i]] += sum[k][i];
        }
    }
}

static enum status add(struct treecode *tree, int n_targets, const double *x, const double *y, int threads,
                       double *const out[5]) {
    if (n_targets == 0 || tree->sources.n == 0) return STATUS_OK;
    const int with_gradient = out[2] != NULL;
    TRY(plan(tree, n_targets, x, y, with_gradient));
    double *sum[5] = {0};
    for (int k = 0; k < 5 && out[k]; k++) sum[k] = tree->sum + (size_t)k * (size_t)n_targets;
    upward_pass(tree, threads);
    far_field(tree, threads);
    downward_pass(tree, threads);
    evaluate_leaves(tree, threads, sum, out);
    return STATUS_OK;
}

enum status treecode_build(struct treecode *tree, int n, const double *x, const double *y, const double *circulation,
                           double smoothing, double tolerance) {
    tree->smoothing = smoothing;
    find_limits(&tree->limits, bound_per_tolerance * tolerance);
    return tree_boxes_fill(&tree->sources, n, x, y, circulation, LEAF);
}

enum status treecode_add_velocity(struct treecode *tree, int n_targets, const double *x, const double *y, int threads,
                                  double *u, double *v) {
    return add(tree, n_targets, x, y, threads, (double *const[5]){u, v});
}

enum status treecode_add_gradient(struct treecode *tree, int n_targets, const double *x, const double *y, int threads,
                                  double *u, double *v, double *u_x, double *u_y, double *v_x) {
    return add(tree, n_targets, x, y, threads, (double *const[5]){u, v, u_x, u_y, v_x});
}
