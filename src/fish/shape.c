/* shape.c: two nodes of a straight edge, or all nodes of the interpolant of Floater and Hormann. */
#include "fish/shape.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

#include "base/mathematics.h"
#include "base/memory.h"

enum { MOST_OF_POLYGON = 4 }; /* nodes per stencil on the polygon */

struct curve {
    int n_nodes, n_lists;
    long n_weights, most_weights; /* used, and all */
    int *every;                   /* 0 .. n_nodes - 1                                     (n_nodes) */
    int *list;                    /* the nodes of middles                                 */
    double *weight;               /*                                                      (most_weights) */
    double *barycentric;          /* c_k of the smooth curve                              (n_nodes) */
};

enum status curve_create(struct curve **curve, int n_nodes, int n_polygon, int n_smooth) {
    *curve = NULL;
    struct curve *new;
    TRY(MEMORY_NEW(new, 1, "the line of a body"));
    new->n_nodes = n_nodes;
    new->most_weights = (long)MOST_OF_POLYGON *n_polygon + (long)n_nodes *n_smooth;
    enum status status = MEMORY_NEW(new->every, n_nodes, "the line of a body");
    if (status == STATUS_OK) status = MEMORY_NEW(new->list, n_polygon * MOST_OF_POLYGON + 1, "the line of a body");
    if (status == STATUS_OK) status = MEMORY_NEW(new->weight, new->most_weights + 1, "the line of a body");
    if (status == STATUS_OK) status = MEMORY_NEW(new->barycentric, n_nodes, "the line of a body");
    if (status != STATUS_OK) {
        curve_free(new);
        return status;
    }

    for (int k = 0; k < n_nodes; k++) new->every[k] = k;

    curve_smooth_factors(n_nodes, new->barycentric);
    *curve = new;
    return STATUS_OK;
}

void curve_free(struct curve *curve) {
    if (!curve) return;
    free(curve->every);
    free(curve->list);
    free(curve->weight);
    free(curve->barycentric);
    free(curve);
}

/* c_k = (-1)^k sum over j = max(0, k - 3) .. min(k, N - 4) of the binomial coefficients (3, k - j) */
void curve_smooth_factors(int n_nodes, double *factor) {
    static const double binomial[] = {1, 3, 3, 1};
    const int degree = 3, last = n_nodes - 1 - degree;
    for (int k = 0; k < n_nodes; k++) {
        double sum = 0;
        for (int j = k > degree ? k - degree : 0; j <= k && j <= last; j++) sum += binomial[k - j];
        factor[k] = k % 2 == 0 ? sum : -sum;
    }
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

// ---- the Joukowski outline as a function of the circle angle, smooth up to both tips

static const double pi = 3.14159265358979323846;

/* zeta = r0 (exp(i theta) + d), z = zeta + c^2/zeta: the nose is at theta = pi, the tail at 0. */
struct joukowski {
    double r0, c, d, nose;
    double length, tail; /* thickness at the tail, m */
};

static struct joukowski joukowski(const struct fish_parameters *fish) {
    const double length = fish->length, d = fish->body.thickness, r0 = length * (1 - d) / 4;
    return (struct joukowski){.r0 = r0,
                              .c = r0 * (1 + d),
                              .d = d,
                              .nose = 2 * r0 * (1 + d * d) / (d - 1),
                              .length = length,
                              .tail = fish->body.tail_thickness * length};
}

// the chord coordinate, decreasing from tail to nose
static double joukowski_chord(const struct joukowski *foil, double theta) {
    const double re = foil->r0 * (cos(theta) + foil->d), im = foil->r0 * sin(theta), c = foil->c;
    return re * (1 + c * c / (re * re + im * im));
}

// the angle of the point at arc coordinate s
static double joukowski_angle(const struct joukowski *foil, double s) {
    // from tail (theta = 0) to nose (theta = pi): bisect to adjacent floating-point numbers
    double low = 0, high = pi;
    for (;;) {
        const double theta = (low + high) / 2;
        if (theta <= low || theta >= high) break;
        if (joukowski_chord(foil, theta) > foil->nose + s) {
            low = theta;
        } else {
            high = theta;
        }
    }

    return (low + high) / 2;
}

// half of h: the cusped foil plus the wedge of the tail thickness
static double joukowski_half_thickness(const struct joukowski *foil, double theta) {
    const double re = foil->r0 * (cos(theta) + foil->d), im = foil->r0 * sin(theta), c = foil->c;
    const double sigma = (joukowski_chord(foil, theta) - foil->nose) / foil->length;
    const double cusp = im * (1 - c * c / (re * re + im * im)), wedge = foil->tail / 2 * sigma;
    return sqrt(cusp * cusp + wedge * wedge);
}

// minus ds/dtheta
static double joukowski_stretch(const struct joukowski *foil, double theta) {
    const double r0 = foil->r0, c = foil->c;
    const double re = r0 * (cos(theta) + foil->d), im = r0 * sin(theta), square = re * re + im * im;
    return im * (1 + c * c / square) - re * c * c * 2 * r0 * foil->d * im / (square * square);
}

// the means of h, h^2, h^3 between two arc coordinates: quadrature in theta, doubling the number of pieces until
// convergence
static void joukowski_means(const struct joukowski *foil, double from, double to, double mean[3]) {
    enum { N = 16, MOST_PIECES = 4096 };
    double node[N], weight[N];
    quadrature_legendre(N, node, weight);
    const double first = from > 0 ? joukowski_angle(foil, from) : pi, last = joukowski_angle(foil, to),
                 span = first - last;
    double before[3] = {0, 0, 0};

    for (int pieces = 1; pieces <= MOST_PIECES; pieces *= 2) {
        double change = 0;
        for (int p = 0; p < 3; p++) mean[p] = 0;
        for (int i = 0; i < pieces * N; i++) {
            const double theta = last + span * (i / N + node[i % N]) / pieces;
            const double h = 2 * joukowski_half_thickness(foil, theta);
            const double part = weight[i % N] * span / pieces * joukowski_stretch(foil, theta) / (to - from);
            mean[0] += part * h;
            mean[1] += part * h * h;
            mean[2] += part * h * h * h;
        }

        for (int p = 0; p < 3; p++) {
            change = fmax(change, fabs(mean[p] - before[p]) / mean[p]);
            before[p] = mean[p];
        }

        // rounding of the arc coordinates behind the angles
        if (change < 1e-12) return;
    }
}

static struct profile_edge joukowski_edge(const struct fish_parameters *fish, int k) {
    const int n_edges = fish->nodes - 1;
    const double edge_length = fish->length / n_edges, from = k * edge_length, to = (k + 1) * edge_length;
    const struct joukowski foil = joukowski(fish);
    struct profile_edge edge = {.w = fish->body.depth * fish->length, .square = 1, .cube = 1};

    if (fish->body.section == SECTION_MEAN) {
        double mean[3];
        joukowski_means(&foil, from, k + 1 < n_edges ? to : fish->length, mean);
        edge.h = mean[0];
        edge.square = mean[1] / (mean[0] * mean[0]);
        edge.cube = mean[2] / (mean[0] * mean[0] * mean[0]);
    } else {
        // the thickness of nose and tail is exact, independent of the rounding of the last arc coordinate
        edge.h = (k > 0 ? joukowski_half_thickness(&foil, joukowski_angle(&foil, from)) : 0) +
                 (k + 1 < n_edges ? joukowski_half_thickness(&foil, joukowski_angle(&foil, to)) : foil.tail / 2);
    }

    return edge;
}

struct profile_edge profile_edge(const struct fish_parameters *fish, int k) {
    const struct body_parameters *body = &fish->body;
    struct profile_edge edge = {.square = 1, .cube = 1};
    switch (body->profile) {
        case PROFILE_JOUKOWSKI: return joukowski_edge(fish, k);
        case PROFILE_UNIFORM:
            edge.h = body->thickness * fish->length;
            edge.w = body->depth * fish->length;
            break;
        case PROFILE_TABLE:
            edge.h = body->thickness_table.value[k];
            edge.w = body->depth_table.value[k];
            break;
    }

    return edge;
}

double profile_tail_thickness(const struct fish_parameters *fish) {
    return fish->body.profile == PROFILE_JOUKOWSKI ? fish->body.tail_thickness * fish->length
                                                   : profile_edge(fish, fish->nodes - 2).h;
}
