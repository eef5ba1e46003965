/* curve.c: two nodes of a straight edge, or all nodes of the interpolant of Floater and Hormann. */
#include "fish/curve.h"

#include <assert.h>
#include <stdlib.h>

enum { MOST_OF_POLYGON = 4 }; /* nodes per stencil on the polygon */

struct curve {
    int n_nodes, n_lists;
    long n_weights, most_weights; /* used, and all */
    int *every;                   /* 0 .. n_nodes - 1                                     (n_nodes) */
    int *list;                    /* the nodes of middles                                 */
    double *weight;               /*                                                      (most_weights) */
    double *barycentric;          /* c_k of the smooth curve                              (n_nodes) */
};

/* c_k = (-1)^k sum over j = max(0, k - 3) .. min(k, N - 4) of the binomial coefficients (3, k - j) */
static void find_barycentric(struct curve *curve) {
    static const double binomial[] = {1, 3, 3, 1};
    const int degree = 3, last = curve->n_nodes - 1 - degree;
    for (int k = 0; k < curve->n_nodes; k++) {
        double sum = 0;
        for (int j = k > degree ? k - degree : 0; j <= k && j <= last; j++) sum += binomial[k - j];
        curve->barycentric[k] = k % 2 == 0 ? sum : -sum;
    }
}

enum status curve_create(struct curve **curve, int n_nodes, int n_polygon, int n_smooth) {
    *curve = NULL;
    struct curve *const new = calloc(1, sizeof *new);
    if (!new) goto no_memory;
    new->n_nodes = n_nodes;
    new->most_weights = (long)MOST_OF_POLYGON *n_polygon + (long)n_nodes *n_smooth;
    new->every = calloc((size_t)n_nodes, sizeof *new->every);
    new->list = calloc((size_t)n_polygon * MOST_OF_POLYGON + 1, sizeof *new->list);
    new->weight = calloc((size_t) new->most_weights + 1, sizeof *new->weight);
    new->barycentric = calloc((size_t)n_nodes, sizeof *new->barycentric);
    if (!new->every || !new->list || !new->weight || !new->barycentric) goto no_memory;
    for (int k = 0; k < n_nodes; k++) new->every[k] = k;
    find_barycentric(new);
    *curve = new;
    return STATUS_OK;

no_memory:
    curve_free(new);
    return status_fail(STATUS_MEMORY, "out of memory for the line of a body of %d nodes", n_nodes);
}

void curve_free(struct curve *curve) {
    if (!curve) return;
    free(curve->every);
    free(curve->list);
    free(curve->weight);
    free(curve->barycentric);
    free(curve);
}

static double *new_weights(struct curve *curve, int n) {
    double *const weight = curve->weight + curve->n_weights;
    curve->n_weights += n;
    assert(curve->n_weights <= curve->most_weights);
    return weight;
}

struct stencil curve_polygon_point(struct curve *curve, double u) {
    const int last = curve->n_nodes - 2, edge = (int)u < last ? (int)u : last;
    double *const weight = new_weights(curve, 2);
    weight[1] = u - edge;
    weight[0] = 1 - weight[1];
    return (struct stencil){.n = 2, .node = curve->every + edge, .weight = weight};
}

struct stencil curve_polygon_middle(struct curve *curve, const struct stencil *a, const struct stencil *b) {
    const struct stencil *const parts[2] = {a, b};
    int *const node = curve->list + MOST_OF_POLYGON * curve->n_lists++;
    double *const weight = new_weights(curve, MOST_OF_POLYGON);
    int n = 0;

    for (int part = 0; part < 2; part++) {
        for (int i = 0; i < parts[part]->n; i++) {
            int at = 0;
            while (at < n && node[at] != parts[part]->node[i]) at++;
            if (at == n) node[n++] = parts[part]->node[i];
            weight[at] += parts[part]->weight[i] / 2;
        }
    }

    return (struct stencil){.n = n, .node = node, .weight = weight};
}

struct stencil curve_edge_middle(const struct curve *curve, int edge) {
    static const double half[2] = {0.5, 0.5};
    return (struct stencil){.n = 2, .node = curve->every + edge, .weight = half};
}

// the node at u, or -1
static int node_at(const struct curve *curve, double u) {
    const int node = (int)u;
    return node == u && node < curve->n_nodes ? node : -1;
}

/* b_k(u) = (c_k/(u - k))/sum over i of c_i/(u - i); on a node 0 or 1 */
static void smooth_weights(const struct curve *curve, double u, double *b) {
    const int node = node_at(curve, u);
    double sum = 0;
    for (int k = 0; k < curve->n_nodes; k++) {
        b[k] = node >= 0 ? k == node : curve->barycentric[k] / (u - k);
        sum += b[k];
    }

    for (int k = 0; k < curve->n_nodes; k++) b[k] /= sum;
}

struct stencil curve_smooth_point(struct curve *curve, double u) {
    double *const weight = new_weights(curve, curve->n_nodes);
    smooth_weights(curve, u, weight);
    return (struct stencil){.n = curve->n_nodes, .node = curve->every, .weight = weight};
}

/* b_k'(u) = b_k (sum over i of b_i/(u - i) - 1/(u - k)), on node m (c_k/c_m)/(m - k). The weight of the nearest node is
 * minus the sum of all other weights: exact, without cancellation. */
struct stencil curve_smooth_slope(struct curve *curve, double u) {
    const int n = curve->n_nodes, node = node_at(curve, u);
    const int nearest = u < n - 1 ? (int)(u + 0.5) : n - 1;
    double *const slope = new_weights(curve, n);
    smooth_weights(curve, u, slope);
    double mean = 0, sum = 0;
    for (int i = 0; node < 0 && i < n; i++) mean += slope[i] / (u - i);

    for (int k = 0; k < n; k++) {
        if (k == nearest) continue;
        slope[k] =
            node >= 0 ? curve->barycentric[k] / curve->barycentric[node] / (node - k) : slope[k] * (mean - 1 / (u - k));
        sum += slope[k];
    }

    slope[nearest] = -sum;
    return (struct stencil){.n = n, .node = curve->every, .weight = slope};
}
