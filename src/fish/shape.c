/* shape.c: weights of the nodes at a point of the line, two on a straight edge, or all of them on the interpolant of
 * Floater and Hormann. */
#include "fish/shape.h"

#include <assert.h>
#include <math.h>

#include "base/mathematics.h"

enum { MOST_OF_POLYGON = 4 }; /* nodes per stencil on the polygon */

struct curve {
    int n_nodes, n_lists;
    long n_weights, most_weights; /* used, and all */
    int *every;                   /* 0 .. n_nodes - 1                                     (n_nodes) */
    int *list;                    /* the nodes of middles                                 */
    double *weight;               /*                                                      (most_weights) */
    double *barycentric;          /* c_k of the smooth curve                              (n_nodes) */
};

struct curve *curve_create(struct arena *arena, int n_nodes, int n_polygon, int n_smooth) {
    struct curve *curve;
    NEW(arena, curve, 1);
    curve->n_nodes = n_nodes;
    curve->most_weights = (long)MOST_OF_POLYGON * n_polygon + (long)n_nodes * n_smooth;
    NEW(arena, curve->every, n_nodes);
    NEW(arena, curve->list, n_polygon * MOST_OF_POLYGON);
    NEW(arena, curve->weight, curve->most_weights);
    NEW(arena, curve->barycentric, n_nodes);
    for (int k = 0; k < n_nodes; k++) curve->every[k] = k;
    curve_smooth_factors(n_nodes, curve->barycentric);
    return curve;
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

/* b_k(u) = (c_k/(u - k))/sum over i of c_i/(u - i); on a node 0 or 1 */
static void smooth_weights(const struct curve *curve, double u, double *b) {
    const int node = (int)u;
    const bool is_node = node == u && node < curve->n_nodes;
    double sum = 0;
    for (int k = 0; k < curve->n_nodes; k++) {
        b[k] = is_node ? k == node : curve->barycentric[k] / (u - k);
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
    const int n = curve->n_nodes, node = (int)u;
    const bool is_node = node == u && node < n;
    const int nearest = u < n - 1 ? (int)(u + 0.5) : n - 1;
    double *const slope = new_weights(curve, n);
    smooth_weights(curve, u, slope);
    double mean = 0, sum = 0;
    for (int i = 0; !is_node && i < n; i++) mean += slope[i] / (u - i);

    for (int k = 0; k < n; k++) {
        if (k == nearest) continue;
        slope[k] =
            is_node ? curve->barycentric[k] / curve->barycentric[node] / (node - k) : slope[k] * (mean - 1 / (u - k));
        sum += slope[k];
    }

    slope[nearest] = -sum;
    return (struct stencil){.n = n, .node = curve->every, .weight = slope};
}

// ---- the Joukowski outline as a function of the circle angle, smooth up to both tips

/* zeta = r0 (exp(i theta) + d), z = zeta + c^2/zeta: the nose is at theta = pi, the tail at 0. */
struct joukowski {
    double r0, c, d, nose;
    double length, tail; /* thickness at the tail, m */
};

// the chord coordinate, decreasing from tail to nose
static double joukowski_chord(const struct joukowski *foil, double theta) {
    const double re = foil->r0 * (cos(theta) + foil->d), im = foil->r0 * sin(theta), c = foil->c;
    return re * (1 + c * c / (re * re + im * im));
}

// the angle of the point at arc coordinate s
static double joukowski_angle(const struct joukowski *foil, double s) {
    // from tail (theta = 0) to nose (theta = pi): bisect to adjacent floating-point numbers
    double low = 0, high = M_PI;
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

// Edge k: the means of h, h^2, h^3 between two arc coordinates by quadrature in theta, doubling the number of pieces
// until convergence; or the mean of both ends.
static struct profile_edge joukowski_edge(const struct fish_parameters *fish, int k) {
    enum { N = 16, MOST_PIECES = 4096 };
    const double d = fish->body.thickness, r0 = fish->length * (1 - d) / 4;
    const struct joukowski foil = {.r0 = r0,
                                   .c = r0 * (1 + d),
                                   .d = d,
                                   .nose = 2 * r0 * (1 + d * d) / (d - 1),
                                   .length = fish->length,
                                   .tail = fish->body.tail_thickness * fish->length};
    const int n_edges = fish->nodes - 1;
    const double edge_length = fish->length / n_edges, from = k * edge_length, end = (k + 1) * edge_length;
    struct profile_edge edge = {.w = fish->body.depth * fish->length, .square = 1, .cube = 1};
    if (fish->body.section == SECTION_NODES) {
        // the thickness of nose and tail is exact, independent of the rounding of the last arc coordinate
        edge.h = (k > 0 ? joukowski_half_thickness(&foil, joukowski_angle(&foil, from)) : 0) +
                 (k + 1 < n_edges ? joukowski_half_thickness(&foil, joukowski_angle(&foil, end)) : foil.tail / 2);
        return edge;
    }

    const double to = k + 1 < n_edges ? end : fish->length;
    const double first = from > 0 ? joukowski_angle(&foil, from) : M_PI, last = joukowski_angle(&foil, to);
    const double span = first - last;
    double node[N], weight[N], mean[3] = {0}, before[3] = {0}, change = INFINITY;
    quadrature_legendre(N, node, weight);
    // to the rounding of the arc coordinates behind the angles
    for (int pieces = 1; pieces <= MOST_PIECES && !(change < 1e-12); pieces *= 2) {
        for (int p = 0; p < 3; p++) mean[p] = 0;
        for (int i = 0; i < pieces * N; i++) {
            const double theta = last + span * (i / N + node[i % N]) / pieces;
            const double h = 2 * joukowski_half_thickness(&foil, theta);

            // -ds/dtheta
            const double re = r0 * (cos(theta) + d), im = r0 * sin(theta), square = re * re + im * im, c = foil.c;
            const double stretch = im * (1 + c * c / square) - re * c * c * 2 * r0 * d * im / (square * square);
            const double part = weight[i % N] * span / pieces * stretch / (to - from);
            mean[0] += part * h;
            mean[1] += part * h * h;
            mean[2] += part * h * h * h;
        }

        change = 0;
        for (int p = 0; p < 3; p++) {
            change = fmax(change, fabs(mean[p] - before[p]) / mean[p]);
            before[p] = mean[p];
        }
    }

    edge.h = mean[0];
    edge.square = mean[1] / (mean[0] * mean[0]);
    edge.cube = mean[2] / (mean[0] * mean[0] * mean[0]);
    return edge;
}

// The slope at pair i of a table: the weighted harmonic mean of both neighbouring secants, 0 at an extremum; at an end
// the parabola through three pairs, limited where it would not be monotone (Fritsch and Butland, SIAM Journal on
// Scientific and Statistical Computing 5, 1984).
static double table_slope(const struct number_list *table, int i) {
    const double(*const at)[2] = (const double(*)[2])table->value;
    const int last = table->n - 1;
    const bool is_end = i == 0 || i == last;
    if (table->n == 2) return (at[1][1] - at[0][1]) / (at[1][0] - at[0][0]);

    // the two intervals beside an inner pair, or next to the end
    const int from = i == 0 ? 0 : i == last ? last - 2 : i - 1;
    double length[2], secant[2];
    for (int j = 0; j < 2; j++) {
        length[j] = at[from + j + 1][0] - at[from + j][0];
        secant[j] = (at[from + j + 1][1] - at[from + j][1]) / length[j];
    }
    if (!is_end) {
        if (!(secant[0] * secant[1] > 0)) return 0;
        const double w0 = 2 * length[1] + length[0], w1 = length[1] + 2 * length[0];
        return (w0 + w1) / (w0 / secant[0] + w1 / secant[1]);
    }
    const int near = i == 0 ? 0 : 1, far = 1 - near;
    const double slope =
        ((2 * length[near] + length[far]) * secant[near] - length[near] * secant[far]) / (length[near] + length[far]);
    if (!(slope * secant[near] > 0)) return 0;
    const bool turns = secant[near] * secant[far] <= 0;
    return turns && fabs(slope) > 3 * fabs(secant[near]) ? 3 * secant[near] : slope;
}

// The value in interval i of a table at a distance over the length: the cubic with the slopes of both ends.
static double table_value(const struct number_list *table, int i, double distance) {
    const double(*const at)[2] = (const double(*)[2])table->value;
    const double length = at[i + 1][0] - at[i][0], x = (distance - at[i][0]) / length, y = 1 - x;
    return y * y * (1 + 2 * x) * at[i][1] + x * x * (1 + 2 * y) * at[i + 1][1] +
           x * y * length * (y * table_slope(table, i) - x * table_slope(table, i + 1));
}

// The means of the first, second and third power of a table over edge k of n, exact: five points for degree 9 in each
// interval of the table; or with section nodes the mean of both ends.
static void table_means(const struct number_list *table, int k, int n, enum section section, double mean[3]) {
    enum { N = 5 };
    const double from = (double)k / n, to = k + 1 < n ? (k + 1.0) / n : 1;
    double node[N], weight[N];
    quadrature_legendre(N, node, weight);
    mean[0] = mean[1] = mean[2] = 0;
    for (int i = 0; i + 1 < table->n; i++) {
        const double first = table->value[2 * i], last = table->value[2 * i + 2];
        const double start = fmax(from, first), end = fmin(to, last);
        if (section == SECTION_NODES) {
            // each end in the interval that it begins, the tail in the last one
            const bool is_last = i + 2 == table->n;
            if (from >= first && from < last) mean[0] += table_value(table, i, from) / 2;
            if (to >= first && (to < last || is_last)) mean[0] += table_value(table, i, to) / 2;
            continue;
        }
        for (int j = 0; j < N && end > start; j++) {
            const double value = table_value(table, i, start + (end - start) * node[j]);
            const double part = weight[j] * (end - start) / (to - from);
            mean[0] += part * value;
            mean[1] += part * value * value;
            mean[2] += part * value * value * value;
        }
    }
}

// Edge k of a table: given, or of pairs.
static struct profile_edge table_edge(const struct fish_parameters *fish, int k) {
    const struct number_list *const h = &fish->body.thickness_table, *const w = &fish->body.depth_table;
    const enum section section = fish->body.section;
    struct profile_edge edge = {.square = 1, .cube = 1};
    double mean[3];
    if (h->width == 2) {
        table_means(h, k, fish->nodes - 1, section, mean);
        edge.h = mean[0];
        if (section == SECTION_MEAN) edge.square = mean[1] / (mean[0] * mean[0]);
        if (section == SECTION_MEAN) edge.cube = mean[2] / (mean[0] * mean[0] * mean[0]);
    } else {
        edge.h = h->value[k];
    }
    if (w->width == 2) {
        table_means(w, k, fish->nodes - 1, section, mean);
        edge.w = mean[0];
    } else {
        edge.w = w->value[k];
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
        case PROFILE_TABLE: return table_edge(fish, k);
    }

    return edge;
}

double profile_tail_thickness(const struct fish_parameters *fish) {
    const struct number_list *const table = &fish->body.thickness_table;
    if (fish->body.profile == PROFILE_JOUKOWSKI) return fish->body.tail_thickness * fish->length;
    if (fish->body.profile == PROFILE_TABLE && table->width == 2) return table->value[2 * table->n - 1];
    return profile_edge(fish, fish->nodes - 2).h;
}
