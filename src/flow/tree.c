/* tree.c: distant boxes act on each other through polynomials at Chebyshev nodes. */
#include "flow/tree.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "base/parallel.h"
#include "base/wide.h"
#include "flow/tree_boxes.h"

enum {
    AXES = 3,    /* x, y, h */
    NODES = 8,   /* the largest number of nodes in x and in y; rows of nodes are padded to this length */
    LENGTHS = 3, /* the largest number of nodes in h */
    ALL_NODES = NODES * NODES * LENGTHS,
    VALUES = 3, /* at most: q, dx, dy at the nodes of sources; u, v, div at the nodes of targets */
    LEAF = 128, /* the largest number of points in a leaf */
    /* the same for targets of gradients, which are the far points of a few bodies, each at some distance from the
     * next */
    LEAF_GRADIENT = 32,
    CONVERSION = 300 /* what it costs to change between the nodes of a box and those of a pair, in interactions */
};

/* How much of the tolerance the bound of one pair and axis may take. The bound assumes that all rings of a box are at
 * the nearest place with equal signs, but several pairs act on one target. With this factor the largest errors in
 * tests/flow/test_tree.c, relative to tolerance max(1, A), are 0.1 for wakes and 0.9 for rings of one sign. */
static const double bound_per_tolerance = 0.04;

/* A box of targets of gradients is at least twice this wide, in lengths, which bounds the error of a derivative. */
static const double smallest_box = 0.02;

/* The smallest box around the points, in place and h; its nodes per axis; the sums of the sizes of its strengths. */
struct node_box {
    double centre[AXES], half[AXES];
    int n[AXES];
    double q, d;   /* sums of |q| and |d| of the sources */
    double *value; /* VALUES arrays of values at the nodes; NULL: not used */
};

/* Boxes of sources or of targets, with their nodes. */
struct node_tree {
    struct tree_boxes boxes;
    struct node_box *box; /* (capacity) */
    double *value;        /* (value_capacity) */
    int capacity;
    size_t value_capacity;
};

/* Two boxes that act on each other, and the nodes of the pair in each of them; n = 0: points instead of nodes. A near
 * pair has points on both sides. */
struct node_pair {
    int target, source;
    int to[AXES], from[AXES];
};

/* For every number n of nodes: the nodes t_i in (-1, 1), and the factors of T_k(t) in the polynomial of node i. */
struct chebyshev {
    double node[NODES + 1][NODES], factor[NODES + 1][NODES][NODES];
};

struct tree {
    struct arena *arena;
    struct chebyshev chebyshev;
    struct node_tree from, to;
    struct sources rings;     /* sorted; leg holds h */
    double *x, *y, *h;        /* targets, sorted                     (target_capacity) */
    double *sum[KERNEL_SUMS]; /* u, v, div and gradients, sorted     (target_capacity) */
    int target_capacity;
    struct node_pair *pair, *sorted; /* (pair_capacity) */
    int n_pairs, pair_capacity;
    int *first; /* first pair of each box of targets (first_capacity) */
    int first_capacity;
    double interactions;
};

struct tree *tree_create(struct arena *arena) {
    struct tree *tree;
    NEW(arena, tree, 1);
    tree->arena = tree->from.boxes.arena = tree->to.boxes.arena = tree->rings.arena = arena;
    struct chebyshev *const chebyshev = &tree->chebyshev;
    for (int n = 1; n <= NODES; n++) {
        for (int i = 0; i < n; i++) {
            const double angle = M_PI * (2 * i + 1) / (2 * n);
            chebyshev->node[n][i] = cos(angle);
            for (int k = 0; k < n; k++) chebyshev->factor[n][k][i] = (k == 0 ? 1 : 2) * cos(k * angle) / n;
        }
    }

    return tree;
}

double tree_interactions(const struct tree *tree) {
    return tree->interactions;
}

bool tree_is_faster(const struct kernel *kernel, int n_rings, double n_interactions, double tolerance) {
    return tolerance > 0 && n_rings >= kernel->tree_sources && n_interactions >= kernel->tree_interactions;
}

// ---- polynomials

// The polynomials that are 1 at one of n Chebyshev nodes and 0 at the others, at t, and their derivatives (NULL: none);
// those beyond n are 0. L_i(t) = (T_0(t_i) T_0(t) + 2 sum over k = 1 .. n - 1 of T_k(t_i) T_k(t))/n.
static void lagrange(const struct chebyshev *chebyshev, int n, double t, double value[NODES], double *slope) {
    double before = 1, term = t, slope_before = 0, slope_term = 1;
    for (int i = 0; i < NODES; i++) value[i] = chebyshev->factor[n][0][i];
    for (int i = 0; i < NODES && slope; i++) slope[i] = 0;
    for (int k = 1; k < n; k++) {
        const double *const factor = chebyshev->factor[n][k];
        for (int i = 0; i < NODES; i++) value[i] += factor[i] * term;
        for (int i = 0; i < NODES && slope; i++) slope[i] += factor[i] * slope_term;
        const double next = 2 * t * term - before, slope_next = 2 * (term + t * slope_term) - slope_before;
        before = term;
        term = next;
        slope_before = slope_term;
        slope_term = slope_next;
    }
}

// where a place is in a box, from -1 to 1 on every axis
static double in_box(const struct node_box *box, int axis, double at) {
    return box->half[axis] > 0 ? (at - box->centre[axis]) / box->half[axis] : 0;
}

/* The polynomials of a coarse grid of nodes, evaluated at the nodes of a fine grid, for each axis. */
struct node_matrix {
    int coarse[AXES], fine[AXES];
    double value[AXES][NODES][NODES]; /* fine node, coarse node */
    double in_x[NODES][NODES];        /* value[0], coarse node, fine node */
};

static void matrix_fill(const struct chebyshev *chebyshev, const struct node_box *coarse, const int n_coarse[AXES],
                        const struct node_box *fine, const int n_fine[AXES], struct node_matrix *matrix) {
    for (int axis = 0; axis < AXES; axis++) {
        matrix->coarse[axis] = n_coarse[axis];
        matrix->fine[axis] = n_fine[axis];
        for (int i = 0; i < n_fine[axis]; i++) {
            const double at = fine->centre[axis] + fine->half[axis] * chebyshev->node[n_fine[axis]][i];
            lagrange(chebyshev, n_coarse[axis], in_box(coarse, axis, at), matrix->value[axis][i], NULL);
        }
    }

    memset(matrix->in_x, 0, sizeof matrix->in_x);
    for (int i = 0; i < n_fine[0]; i++) {
        for (int j = 0; j < n_coarse[0]; j++) matrix->in_x[j][i] = matrix->value[0][i][j];
    }
}

// Add the strengths at the fine nodes to the coarse nodes, one axis after the other. Nodes in x are lanes of vectors.
static WIDE(void, add_to_coarse, (const struct node_matrix *matrix, int n_values, const double *fine, double *coarse),
            (matrix, n_values, fine, coarse)) {
    const int *const n = matrix->fine, *const m = matrix->coarse;
    for (int value = 0; value < n_values; value++) {
        for (int lane = 0; lane < m[0]; lane += WIDE_LANES) {
            wide_lanes by_y[LENGTHS][NODES];
            for (int h = 0; h < n[2]; h++) {
                wide_lanes by_x[NODES];
                for (int y = 0; y < n[1]; y++) {
                    const double *const from = fine + value * ALL_NODES + (h * NODES + y) * NODES;
                    wide_lanes sum = {0};
                    for (int x = 0; x < n[0]; x++) sum += from[x] * *(const wide_lanes *)&matrix->value[0][x][lane];
                    by_x[y] = sum;
                }
                for (int j = 0; j < m[1]; j++) {
                    wide_lanes sum = {0};
                    for (int y = 0; y < n[1]; y++) sum += matrix->value[1][y][j] * by_x[y];
                    by_y[h][j] = sum;
                }
            }

            for (int k = 0; k < m[2]; k++) {
                for (int j = 0; j < m[1]; j++) {
                    wide_lanes *const to = (wide_lanes *)(coarse + value * ALL_NODES + (k * NODES + j) * NODES + lane);
                    wide_lanes sum = *to;
                    for (int h = 0; h < n[2]; h++) sum += matrix->value[2][h][k] * by_y[h][j];
                    *to = sum;
                }
            }
        }
    }
}

// Add the polynomial through the coarse nodes to the values at the fine nodes, one axis after the other.
static WIDE(void, add_to_fine, (const struct node_matrix *matrix, int n_values, const double *coarse, double *fine),
            (matrix, n_values, coarse, fine)) {
    const int *const n = matrix->fine, *const m = matrix->coarse;
    for (int value = 0; value < n_values; value++) {
        for (int h = 0; h < n[2]; h++) {
            double by_h[NODES][NODES];
            for (int j = 0; j < m[1]; j++) {
                for (int lane = 0; lane < m[0]; lane += WIDE_LANES) {
                    const double *const from = coarse + value * ALL_NODES + j * NODES + lane;
                    wide_lanes sum = {0};
                    for (int k = 0; k < m[2]; k++) {
                        sum += matrix->value[2][h][k] * *(const wide_lanes *)(from + k * NODES * NODES);
                    }
                    *(wide_lanes *)&by_h[j][lane] = sum;
                }
            }

            for (int y = 0; y < n[1]; y++) {
                double by_y[NODES];
                for (int lane = 0; lane < m[0]; lane += WIDE_LANES) {
                    wide_lanes sum = {0};
                    for (int j = 0; j < m[1]; j++) {
                        sum += matrix->value[1][y][j] * *(const wide_lanes *)&by_h[j][lane];
                    }
                    *(wide_lanes *)&by_y[lane] = sum;
                }
                for (int lane = 0; lane < n[0]; lane += WIDE_LANES) {
                    wide_lanes *const to = (wide_lanes *)(fine + value * ALL_NODES + (h * NODES + y) * NODES + lane);
                    wide_lanes sum = *to;
                    for (int i = 0; i < m[0]; i++) sum += by_y[i] * *(const wide_lanes *)&matrix->in_x[i][lane];
                    *to = sum;
                }
            }
        }
    }
}

// ---- boxes

// Find the smallest boxes, from the leaves up, in x and y at least twice `least` wide. rings: sorted, for the sums of
// their strengths; NULL: none.
static void node_tree_enclose(struct node_tree *nodes, double least, const struct sources *rings) {
    const struct tree_boxes *const boxes = &nodes->boxes;
    if (boxes->n_boxes > nodes->capacity) {
        nodes->capacity = boxes->n_boxes;
        GROW(boxes->arena, nodes->box, nodes->capacity);
    }

    for (int b = boxes->n_boxes - 1; b >= 0; b--) {
        const struct tree_box *const of = &boxes->box[b];
        const bool is_leaf = b >= tree_boxes_level(boxes->depth);
        const struct node_box *const halves = is_leaf ? NULL : &nodes->box[2 * b + 1];
        struct node_box *const box = &nodes->box[b];
        *box = (struct node_box){.n = {0}};
        for (int axis = 0; axis < AXES; axis++) {
            const double *const at = (axis == 0 ? boxes->x : axis == 1 ? boxes->y : boxes->weight) + of->first;
            double low = INFINITY, high = -INFINITY;
            for (int i = 0; is_leaf && i < of->n; i++) {
                low = at[i] < low ? at[i] : low;
                high = at[i] > high ? at[i] : high;
            }
            for (int i = 0; i < 2 && !is_leaf; i++) {
                low = fmin(low, halves[i].centre[axis] - halves[i].half[axis]);
                high = fmax(high, halves[i].centre[axis] + halves[i].half[axis]);
            }
            box->centre[axis] = low + (high - low) / 2;
            box->half[axis] = fmax((high - low) / 2, axis < 2 ? least : 0);
        }

        for (int i = 0; rings && is_leaf && i < of->n; i++) {
            const int j = of->first + i;
            box->q += fabs(rings->q[j]);
            box->d += sqrt(rings->dx[j] * rings->dx[j] + rings->dy[j] * rings->dy[j]);
        }
        for (int i = 0; rings && !is_leaf && i < 2; i++) {
            box->q += halves[i].q;
            box->d += halves[i].d;
        }
    }
}

// give halves at least as many nodes as the parent has, and assign memory to the boxes in use
static void node_tree_allocate(struct node_tree *nodes) {
    size_t n_used = 0;
    for (int b = 0; b < nodes->boxes.n_boxes; b++) {
        struct node_box *const box = &nodes->box[b];
        const struct node_box *const parent = &nodes->box[b > 0 ? (b - 1) / 2 : 0];
        for (int axis = 0; axis < AXES && parent->n[0] > 0; axis++) {
            const int n = box->half[axis] > 0 ? parent->n[axis] : 1;
            box->n[axis] = box->n[axis] > n ? box->n[axis] : n;
        }
        n_used += box->n[0] > 0;
    }

    const size_t size = VALUES * ALL_NODES;
    if (n_used * size > nodes->value_capacity) {
        nodes->value_capacity = (n_used + n_used / 4) * size;
        GROW(nodes->boxes.arena, nodes->value, nodes->value_capacity);
    }

    double *next = nodes->value;
    for (int b = 0; b < nodes->boxes.n_boxes; b++) {
        struct node_box *const box = &nodes->box[b];
        if (box->n[0] == 0) continue;
        box->value = next;
        next += size;
    }
}

// ---- pairs of boxes

/* What decides how many nodes a pair has. */
struct search {
    struct tree *tree;
    const struct kernel_pair *pair;
    double length, tolerance;
    int cost; /* of an interaction of points: 2 with gradients */
};

// The smallest number of nodes of an interval for which rho^-n times the bound is below 1, if the nearest singularity
// is at the distance (along, across) from the centre; 0: more than most.
static int nodes_for(double half, double along, double across, double bound, int most) {
    // rho of the Bernstein ellipse through the singularity
    const double near = along - half, far = along + half;
    const double sum = (sqrt(near * near + across * across) + sqrt(far * far + across * across)) / (2 * half);
    const double rho = sum + sqrt(fmax(0, sum * sum - 1));
    for (int n = 1; n <= most; n++) {
        bound /= rho;
        if (bound <= 1) return n;
    }
    return 0;
}

/* Find the nodes of one box of a pair. The kernel is analytic in each coordinate, with singularities at r^2 = -e^2 and
 * r^2 = -h_t - h_n, so interpolation at n nodes has an error of the order of rho^-n. */
static int box_nodes(const struct node_box *box, const struct node_box *other, const double gap[2], double least,
                     double low, double bound, int n[AXES]) {
    for (int axis = 0; axis < 2; axis++) {
        n[axis] = 1;
        if (box->half[axis] <= 0) continue;
        const double along = fmax(0, fabs(box->centre[axis] - other->centre[axis]) - other->half[axis]);
        const double across = sqrt(gap[1 - axis] * gap[1 - axis] + least);
        n[axis] = nodes_for(box->half[axis], along, across, bound, NODES);
        if (n[axis] == 0) return 0;
    }

    n[2] = 1;
    if (box->half[2] <= 0) return 1;
    n[2] = nodes_for(box->half[2], gap[0] * gap[0] + gap[1] * gap[1] + low + box->half[2], 0, bound, LENGTHS);
    return n[2] > 0;
}

// find the nodes of a pair; returns 0 if the pair is too near
static int pair_nodes(const struct search *search, struct node_pair *pair) {
    const struct node_box *const to = &search->tree->to.box[pair->target];
    const struct node_box *const from = &search->tree->from.box[pair->source];
    double gap[2];
    for (int axis = 0; axis < 2; axis++) {
        gap[axis] = fmax(0, fabs(to->centre[axis] - from->centre[axis]) - to->half[axis] - from->half[axis]);
    }

    // the kernel at the nearest places
    const double low = to->centre[2] - to->half[2] + from->centre[2] - from->half[2];
    const double r2 = gap[0] * gap[0] + gap[1] * gap[1], square = search->pair->square;
    if (r2 <= 0) return 0;
    const struct kernel *const kernel = search->pair->kernel;
    const double bound = kernel->bound(search->pair, r2, low, from->q, from->d, search->length) /
                         (bound_per_tolerance * search->tolerance);
    const double least = kernel->has_legs ? fmin(square, low) : square;
    return box_nodes(to, from, gap, least, low, bound, pair->to) &&
           box_nodes(from, to, gap, least, low, bound, pair->from);
}

static void pair_add(struct tree *tree, const struct node_pair *pair) {
    if (tree->n_pairs == tree->pair_capacity) {
        tree->pair_capacity = 2 * tree->n_pairs + 256;
        GROW(tree->arena, tree->pair, tree->pair_capacity);
        GROW(tree->arena, tree->sorted, tree->pair_capacity);
    }

    for (int axis = 0; axis < AXES; axis++) {
        int *const to = &tree->to.box[pair->target].n[axis], *const from = &tree->from.box[pair->source].n[axis];
        *to = pair->to[axis] > *to ? pair->to[axis] : *to;
        *from = pair->from[axis] > *from ? pair->from[axis] : *from;
    }
    tree->pair[tree->n_pairs++] = *pair;
}

static void boxes_pair_up(const struct search *search, int target, int source) {
    struct tree *const tree = search->tree;
    const struct node_tree *const to = &tree->to, *const from = &tree->from;
    const bool target_is_leaf = target >= tree_boxes_level(to->boxes.depth);
    const bool source_is_leaf = source >= tree_boxes_level(from->boxes.depth);
    const double n_targets = to->boxes.box[target].n, n_sources = from->boxes.box[source].n;
    struct node_pair pair = {.target = target, .source = source};

    if (pair_nodes(search, &pair)) {
        // use points where nodes would not be fewer
        double cost = 0, n_to = pair.to[0] * pair.to[1] * pair.to[2];
        double n_from = pair.from[0] * pair.from[1] * pair.from[2];
        if (target_is_leaf && search->cost * n_targets * fmin(n_sources, n_from) <= CONVERSION + n_to * n_from) {
            n_to = search->cost * n_targets;
            memset(pair.to, 0, sizeof pair.to);
        } else {
            cost += CONVERSION;
        }
        if (n_to * n_sources <= CONVERSION + n_to * n_from) {
            n_from = n_sources;
            memset(pair.from, 0, sizeof pair.from);
        } else {
            cost += CONVERSION;
        }
        cost += n_to * n_from;
        const bool both_leaves = target_is_leaf && source_is_leaf;
        if (both_leaves || cost < search->cost * n_targets * n_sources) {
            tree->interactions += cost;
            pair_add(tree, &pair);
            return;
        }
    }

    if (target_is_leaf && source_is_leaf) {
        memset(pair.to, 0, sizeof pair.to);
        memset(pair.from, 0, sizeof pair.from);
        tree->interactions += search->cost * n_targets * n_sources;
        pair_add(tree, &pair);
        return;
    }

    // halve the larger box
    const double size_to = to->boxes.box[target].radius, size_from = from->boxes.box[source].radius;
    const bool halve_target = source_is_leaf || (!target_is_leaf && size_to > size_from);
    for (int half = 1; half <= 2; half++) {
        boxes_pair_up(search, halve_target ? 2 * target + half : target, halve_target ? source : 2 * source + half);
    }
}

// ---- passes

// add a source to the nodes; by: values of the polynomials at the source
static WIDE(void, add_source,
            (const int n[AXES], int n_values, double by[AXES][NODES], const double strength[VALUES], double *value),
            (n, n_values, by, strength, value)) {
    for (int i = 0; i < n_values; i++) {
        for (int h = 0; h < n[2]; h++) {
            for (int y = 0; y < n[1]; y++) {
                double *const row = value + i * ALL_NODES + (h * NODES + y) * NODES;
                const double factor = by[2][h] * by[1][y] * strength[i];
                for (int lane = 0; lane < n[0]; lane += WIDE_LANES) {
                    *(wide_lanes *)(row + lane) += factor * *(const wide_lanes *)&by[0][lane];
                }
            }
        }
    }
}

// find the strengths at the nodes of a box, from the rings of a leaf or from the nodes of the halves
static void box_gather(const struct tree *tree, bool has_legs, int b) {
    const struct node_tree *const from = &tree->from;
    const struct tree_box *const points = &from->boxes.box[b];
    const struct node_box *const box = &from->box[b];
    const struct sources *const rings = &tree->rings;
    if (!box->value) return;
    memset(box->value, 0, VALUES * ALL_NODES * sizeof *box->value);

    if (b < tree_boxes_level(from->boxes.depth)) {
        for (int half = 2 * b + 1; half <= 2 * b + 2; half++) {
            struct node_matrix matrix;
            matrix_fill(&tree->chebyshev, box, box->n, &from->box[half], from->box[half].n, &matrix);
            add_to_coarse(&matrix, has_legs ? 3 : 1, from->box[half].value, box->value);
        }
        return;
    }

    for (int p = points->first; p < points->first + points->n; p++) {
        const double at[AXES] = {rings->x[p], rings->y[p], rings->leg[p]};
        const double strength[VALUES] = {rings->q[p], rings->dx[p], rings->dy[p]};
        double by[AXES][NODES];
        for (int axis = 0; axis < AXES; axis++) {
            lagrange(&tree->chebyshev, box->n[axis], in_box(box, axis, at[axis]), by[axis], NULL);
        }
        add_source(box->n, has_legs ? 3 : 1, by, strength, box->value);
    }
}

// The nodes of a pair in one box as arrays: places, and the values in the same order.
struct node_grid {
    int n;
    double x[ALL_NODES], y[ALL_NODES], h[ALL_NODES], zero[ALL_NODES], value[VALUES][ALL_NODES];
};

static void grid_place(const struct chebyshev *chebyshev, const struct node_box *box, const int n[AXES],
                       struct node_grid *grid) {
    grid->n = 0;
    for (int h = 0; h < n[2]; h++) {
        for (int y = 0; y < n[1]; y++) {
            for (int x = 0; x < n[0]; x++) {
                const int at = grid->n++;
                grid->x[at] = box->centre[0] + box->half[0] * chebyshev->node[n[0]][x];
                grid->y[at] = box->centre[1] + box->half[1] * chebyshev->node[n[1]][y];
                grid->h[at] = box->centre[2] + box->half[2] * chebyshev->node[n[2]][h];
                grid->zero[at] = 0;
            }
        }
    }
}

// add the values of a grid to padded values, or set them
static void grid_exchange(const int n[AXES], int n_values, bool is_padding, double *padded, struct node_grid *grid) {
    for (int value = 0; value < n_values; value++) {
        int at = 0;
        for (int h = 0; h < n[2]; h++) {
            for (int y = 0; y < n[1]; y++) {
                for (int x = 0; x < n[0]; x++, at++) {
                    double *const of = padded + value * ALL_NODES + (h * NODES + y) * NODES + x;
                    if (is_padding) {
                        *of = grid->value[value][at];
                    } else {
                        grid->value[value][at] = *of;
                    }
                }
            }
        }
    }
}

// velocity of the sources of a pair at its targets
static void pair_induce(const struct tree *tree, const struct kernel_pair *with, bool with_gradient,
                        const struct node_pair *pair) {
    const struct node_box *const to = &tree->to.box[pair->target], *const from = &tree->from.box[pair->source];
    const struct tree_box *const to_points = &tree->to.boxes.box[pair->target];
    const struct tree_box *const from_points = &tree->from.boxes.box[pair->source];
    const int n_strengths = with->kernel->has_legs ? 3 : 1, n_sums = with->kernel->has_legs ? 3 : 2;
    struct node_grid source, target;
    struct node_matrix matrix;
    double padded[VALUES * ALL_NODES];

    struct sources rings = tree->rings;
    struct range which = {from_points->first, from_points->n};
    if (pair->from[0] > 0) {
        memset(padded, 0, sizeof padded);
        matrix_fill(&tree->chebyshev, from, pair->from, from, from->n, &matrix);
        add_to_coarse(&matrix, n_strengths, from->value, padded);
        grid_place(&tree->chebyshev, from, pair->from, &source);
        grid_exchange(pair->from, n_strengths, 0, padded, &source);
        which = (struct range){0, source.n};
        rings = (struct sources){.x = source.x,
                                 .y = source.y,
                                 .q = source.value[0],
                                 .dx = source.value[1],
                                 .dy = source.value[2],
                                 .half = source.zero,
                                 .leg = source.h,
                                 .square = source.zero};
    }

    // points of a leaf
    if (pair->to[0] == 0) {
        const int first = to_points->first;
        double *sum[KERNEL_SUMS];
        for (int i = 0; i < KERNEL_SUMS; i++) {
            sum[i] = i < KERNEL_SUMS_WITHOUT_GRADIENT || with_gradient ? tree->sum[i] + first : NULL;
        }
        struct targets at = kernel_targets(to_points->n, tree->x + first, tree->y + first, sum);
        at.leg = tree->h + first;
        kernel_induce(with, &rings, which, &at);
        return;
    }

    grid_place(&tree->chebyshev, to, pair->to, &target);
    memset(target.value, 0, sizeof target.value);
    const struct targets at = {.n = target.n,
                               .x = target.x,
                               .y = target.y,
                               .leg = target.h,
                               .u = target.value[0],
                               .v = target.value[1],
                               .div = target.value[2]};
    kernel_induce(with, &rings, which, &at);
    memset(padded, 0, sizeof padded);
    grid_exchange(pair->to, n_sums, 1, padded, &target);
    matrix_fill(&tree->chebyshev, to, pair->to, to, to->n, &matrix);
    add_to_fine(&matrix, n_sums, padded, to->value);
}

// a polynomial at a point; by_x, by_y, by_h: values, or derivatives, of the polynomials of the nodes at the point
static WIDE(double, polynomial,
            (const int n[AXES], const double *value, const double *by_x, const double *by_y, const double *by_h),
            (n, value, by_x, by_y, by_h)) {
    double all = 0;
    for (int lane = 0; lane < n[0]; lane += WIDE_LANES) {
        wide_lanes sum = {0};
        for (int h = 0; h < n[2]; h++) {
            for (int y = 0; y < n[1]; y++) {
                sum += by_h[h] * by_y[y] * *(const wide_lanes *)(value + (h * NODES + y) * NODES + lane);
            }
        }
        sum *= *(const wide_lanes *)(by_x + lane);
        for (int i = 0; i < WIDE_LANES; i++) all += sum[i];
    }
    return all;
}

// carry the values at the nodes of a box to the nodes of its halves, or to the targets of a leaf
static void box_scatter(const struct tree *tree, bool has_legs, bool with_gradient, int b) {
    const struct node_tree *const to = &tree->to;
    const struct tree_box *const points = &to->boxes.box[b];
    const struct node_box *const box = &to->box[b];
    if (!box->value) return;

    if (b < tree_boxes_level(to->boxes.depth)) {
        for (int half = 2 * b + 1; half <= 2 * b + 2; half++) {
            struct node_matrix matrix;
            matrix_fill(&tree->chebyshev, box, box->n, &to->box[half], to->box[half].n, &matrix);
            add_to_fine(&matrix, has_legs ? 3 : 2, box->value, to->box[half].value);
        }
        return;
    }

    const double *const u = box->value, *const v = u + ALL_NODES, *const div = v + ALL_NODES;
    for (int p = points->first; p < points->first + points->n; p++) {
        const double at[AXES] = {tree->x[p], tree->y[p], tree->h[p]};
        double by[AXES][NODES], slope[AXES][NODES];
        for (int axis = 0; axis < AXES; axis++) {
            lagrange(&tree->chebyshev, box->n[axis], in_box(box, axis, at[axis]), by[axis],
                     with_gradient ? slope[axis] : NULL);
        }

        tree->sum[0][p] += polynomial(box->n, u, by[0], by[1], by[2]);
        tree->sum[1][p] += polynomial(box->n, v, by[0], by[1], by[2]);
        if (has_legs) tree->sum[2][p] += polynomial(box->n, div, by[0], by[1], by[2]);
        if (!with_gradient) continue;
        const double per_x = box->half[0] > 0 ? 1 / box->half[0] : 0, per_y = box->half[1] > 0 ? 1 / box->half[1] : 0;
        tree->sum[3][p] += per_x * polynomial(box->n, u, slope[0], by[1], by[2]);
        tree->sum[4][p] += per_y * polynomial(box->n, u, by[0], slope[1], by[2]);
        tree->sum[5][p] += per_x * polynomial(box->n, v, slope[0], by[1], by[2]);
        if (!has_legs) continue;
        tree->sum[6][p] += per_x * polynomial(box->n, div, slope[0], by[1], by[2]);
        tree->sum[7][p] += per_y * polynomial(box->n, div, by[0], slope[1], by[2]);
    }
}

// ---- the sum

// h of n points
static void lengths(double factor, int n, const double *half, const double *leg, double *h) {
    for (int i = 0; i < n; i++) h[i] = (half ? factor * half[i] : 0) + (leg ? leg[i] : 0);
}

static void sources_sort(struct tree *tree, const struct kernel_pair *pair, const struct sources *rings, int threads) {
    const int n = rings->n;
    struct sources *const sorted = &tree->rings;
    sorted->n = 0;
    sources_append(sorted, n);
    // h, in the place of the legs
    lengths(pair->factor, n, rings->half, rings->leg, sorted->leg);
    struct tree_boxes *const boxes = &tree->from.boxes;
    tree_boxes_fill(boxes, n, rings->x, rings->y, sorted->leg, LEAF, threads);
    memcpy(sorted->leg, boxes->weight, (size_t)n * sizeof *sorted->leg);
    for (int i = 0; i < n; i++) {
        const int from = boxes->index[i];
        sorted->x[i] = rings->x[from];
        sorted->y[i] = rings->y[from];
        sorted->q[i] = rings->q[from];
        sorted->dx[i] = rings->dx[from];
        sorted->dy[i] = rings->dy[from];
    }
    node_tree_enclose(&tree->from, 0, sorted);
}

static void targets_sort(struct tree *tree, const struct kernel_pair *pair, const struct targets *at, double length,
                         int threads) {
    const size_t size = (size_t)at->n * sizeof(double);
    if (at->n > tree->target_capacity) {
        tree->target_capacity = at->n + at->n / 2;
        GROW(tree->arena, tree->x, tree->target_capacity);
        GROW(tree->arena, tree->y, tree->target_capacity);
        GROW(tree->arena, tree->h, tree->target_capacity);
        for (int i = 0; i < KERNEL_SUMS; i++) GROW(tree->arena, tree->sum[i], tree->target_capacity);
    }
    lengths(pair->factor, at->n, at->half, at->leg, tree->h);
    tree_boxes_fill(&tree->to.boxes, at->n, at->x, at->y, tree->h, at->u_x ? LEAF_GRADIENT : LEAF, threads);
    memcpy(tree->x, tree->to.boxes.x, size);
    memcpy(tree->y, tree->to.boxes.y, size);
    memcpy(tree->h, tree->to.boxes.weight, size);
    for (int i = 0; i < KERNEL_SUMS; i++) memset(tree->sum[i], 0, size);
    node_tree_enclose(&tree->to, at->u_x ? smallest_box * length : 0, NULL);
}

void tree_induce(struct tree *tree, const struct kernel_pair *pair, const struct sources *rings, double length,
                 double tolerance, int threads, const struct targets *at) {
    const bool has_legs = pair->kernel->has_legs, with_gradient = at->u_x != NULL;
    tree->interactions = 0;
    tree->n_pairs = 0;
    if (rings->n == 0 || at->n == 0) return;
    sources_sort(tree, pair, rings, threads);
    targets_sort(tree, pair, at, length, threads);
    const struct search search = {
        .tree = tree, .pair = pair, .length = length, .tolerance = tolerance, .cost = with_gradient ? 2 : 1};
    boxes_pair_up(&search, 0, 0);

    // sort the pairs by target, in the order of the search
    const int n_boxes = tree->to.boxes.n_boxes;
    if (n_boxes + 1 > tree->first_capacity) {
        tree->first_capacity = n_boxes + 1;
        GROW(tree->arena, tree->first, n_boxes + 1);
    }
    memset(tree->first, 0, ((size_t)n_boxes + 1) * sizeof *tree->first);
    for (int i = 0; i < tree->n_pairs; i++) tree->first[tree->pair[i].target]++;
    for (int b = 1; b <= n_boxes; b++) tree->first[b] += tree->first[b - 1];
    for (int i = tree->n_pairs - 1; i >= 0; i--) tree->sorted[--tree->first[tree->pair[i].target]] = tree->pair[i];

    // upward pass, far and near field, downward pass
    node_tree_allocate(&tree->from);
    node_tree_allocate(&tree->to);
    for (int level = tree->from.boxes.depth; level >= 0; level--) {
        const int first = tree_boxes_level(level), end = tree_boxes_level(level + 1);
#pragma omp parallel for num_threads(threads) schedule(static)
        for (int b = first; b < end; b++) box_gather(tree, has_legs, b);
    }

#pragma omp parallel for num_threads(threads) schedule(dynamic, 4)
    for (int b = 0; b < n_boxes; b++) {
        if (tree->to.box[b].value) memset(tree->to.box[b].value, 0, VALUES * ALL_NODES * sizeof(double));
        for (int i = tree->first[b]; i < tree->first[b + 1]; i++) {
            pair_induce(tree, pair, with_gradient, &tree->sorted[i]);
        }
    }

    for (int level = 0; level <= tree->to.boxes.depth; level++) {
        const int first = tree_boxes_level(level), end = tree_boxes_level(level + 1);
#pragma omp parallel for num_threads(threads) schedule(static)
        for (int b = first; b < end; b++) box_scatter(tree, has_legs, with_gradient, b);
    }

    double *const to[] = {at->u, at->v, at->div, at->u_x, at->u_y, at->v_x, at->div_x, at->div_y};
    for (int k = 0; k < (with_gradient ? KERNEL_SUMS : KERNEL_SUMS_WITHOUT_GRADIENT); k++) {
        for (int i = 0; i < at->n && to[k]; i++) to[k][tree->to.boxes.index[i]] += tree->sum[k][i];
    }
}
