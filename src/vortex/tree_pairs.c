/* tree_pairs.c: search for pairs of well-separated boxes, and the degrees of these pairs. */
#include "vortex/tree_pairs.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/parallel.h"

// The error bound of a pair assumes the smallest distance between the circles of both boxes for all sources and
// targets. True errors are so much smaller (tests/vortex/test_treecode.c) that the bound may be this many tolerances.
static const double bound_per_tolerance = 4;

enum { CHUNK = TREE_PAIRS_CHUNK };

// a search for pairs
struct search {
    struct tree_sources *sources;
    const struct tree_boxes *targets;
    struct tree_expansions *local;
    int with_gradient;
    double stretch; /* 1 + margin */
};

// ---- memory ----

enum status tree_pairs_grow(void *array, size_t n, size_t size) {
    void **const pointer = array;
    void *const more = realloc(*pointer, n * size);
    if (!more) return status_fail(STATUS_MEMORY, "out of memory: %zu bytes of a tree", n * size);
    *pointer = more;
    return STATUS_OK;
}

enum status tree_expansions_reset(struct tree_expansions *expansions, int n_boxes) {
    if (n_boxes > expansions->capacity) {
        expansions->capacity = 0;
        TRY(tree_pairs_grow(&expansions->of, (size_t)n_boxes, sizeof *expansions->of));
        expansions->capacity = n_boxes;
    }

    for (int i = 0; i < n_boxes; i++) expansions->of[i].order = (struct expansion_order){-1, 0};
    return STATUS_OK;
}

// raise the degrees of halves to the degrees of the parent; then assign the values of every box
enum status tree_expansions_allocate(struct tree_expansions *expansions, int n_boxes) {
    size_t n = 0;
    for (int i = 0; i < n_boxes; i++) {
        if (i > 0)
            expansions->of[i].order = expansion_order_max(expansions->of[i].order, expansions->of[(i - 1) / 2].order);
        n += 2 * (size_t)expansions_size(expansions->of[i].order);
    }

    if (n > expansions->value_capacity) {
        expansions->value_capacity = 0;
        TRY(tree_pairs_grow(&expansions->value, n + n / 2, sizeof *expansions->value));
        expansions->value_capacity = n + n / 2;
    }

    n = 0;
    for (int i = 0; i < n_boxes; i++) {
        expansions->of[i].value = expansions->value + n;
        n += 2 * (size_t)expansions_size(expansions->of[i].order);
    }

    return STATUS_OK;
}

void tree_expansions_clear(struct tree_expansions *expansions) {
    free(expansions->of);
    free(expansions->value);
    *expansions = (struct tree_expansions){0};
}

void tree_sources_clear(struct tree_sources *sources) {
    tree_boxes_clear(&sources->boxes);
    tree_expansions_clear(&sources->multipole);
    void *const owned[] = {sources->far,         sources->far_sorted, sources->near,
                           sources->near_sorted, sources->far_first,  sources->near_first};
    for (size_t i = 0; i < sizeof owned / sizeof *owned; i++) free(owned[i]);
    *sources = (struct tree_sources){0};
}

// ---- degrees of a pair ----

// whether an expansion may be truncated above a degree: (1 + theta) theta^p / (1 - theta) <= tolerance / 2
static int truncation_is_small(double theta, int degree, double tolerance) {
    double power = (1 + theta) / (1 - theta);
    for (int i = 0; i < degree; i++) power *= theta;
    return power <= tolerance / 2;
}

// The largest eta = e^2/S^2 for which the mixed terms above degree q may be truncated: (1 + theta) times the sum of
// n (n - 1)/2 eta theta^(n-1) over n > q, at most tolerance / 2. The ratio of successive terms decreases.
static double eta_limit(double theta, int q, double tolerance) {
    const double ratio = theta * (q + 2) / q;
    if (ratio >= 1) return 0;
    double first = (1 + theta) * q * (q + 1) / 2;
    for (int i = 0; i < q; i++) first *= theta;
    return first * 2 > tolerance * (1 - ratio) ? tolerance / 2 * (1 - ratio) / first : 1;
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

// ---- interaction lists ----

static enum status far_pair_add(const struct search *search, int target, int source, struct expansion_order order) {
    struct tree_sources *const sources = search->sources;
    if (sources->n_far == sources->far_capacity) {
        const int capacity = 2 * sources->n_far + 256;
        sources->far_capacity = 0;
        TRY(tree_pairs_grow(&sources->far, (size_t)capacity, sizeof *sources->far));
        TRY(tree_pairs_grow(&sources->far_sorted, (size_t)capacity, sizeof *sources->far_sorted));
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
        TRY(tree_pairs_grow(&sources->near, (size_t)capacity, sizeof *sources->near));
        TRY(tree_pairs_grow(&sources->near_sorted, (size_t)capacity, sizeof *sources->near_sorted));
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

enum status tree_pairs_find(struct tree_sources *sources, const struct tree_boxes *targets, int with_gradient,
                            double margin, int threads, struct tree_expansions *local) {
    if (targets->n_boxes + 1 > sources->first_capacity) {
        const size_t n = (size_t)targets->n_boxes + 1;
        sources->first_capacity = 0;
        TRY(tree_pairs_grow(&sources->far_first, n, sizeof *sources->far_first));
        TRY(tree_pairs_grow(&sources->near_first, n, sizeof *sources->near_first));
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

void tree_pairs_raise(struct tree_sources *sources, int by) {
    for (int i = 0; i < sources->n_far; i++) {
        struct expansion_order *const order = &sources->far_sorted[i].order;
        *order = (struct expansion_order){order->harmonic + by, order->mixed + by};
    }
}

// returns 0 for positions that are not finite: a comparison with NaN is false
static int pair_fits(const struct tree_limits *limits, int with_gradient, double smoothing, const struct tree_box *to,
                     const struct tree_box *from, struct expansion_order order) {
    const double rx = to->x - from->x, ry = to->y - from->y, radius = to->radius + from->radius;
    const double square = smoothing * smoothing, scale = rx * rx + ry * ry + square;
    const int p = order.harmonic - with_gradient, q = order.mixed - with_gradient;
    return radius * radius <= limits->theta[p] * limits->theta[p] * scale && square <= limits->eta[p][q] * scale;
}

int tree_pairs_fit(const struct tree_sources *sources, const struct tree_boxes *targets, int with_gradient,
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
