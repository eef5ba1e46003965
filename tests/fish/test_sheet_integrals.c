/* test_sheet_integrals.c: The circulation between the vortices and the added momentum are compared with sheets whose
 * integrals are known (doc/model.md, section 15). */
#include <stdlib.h>

#include "base/mathematics.h"
#include "base/wide.h"
#include "failing_malloc.h"
#include "fish/shape.h"
#include "fish/sheet_integrals.h"
#include "near.h"

static const double pi = 3.14159265358979323846;

enum { N_NODES = 7, N_SHEET = 13 };

// the circulations of a sheet with g = cos(m theta): the trapezoidal rule halves the circulations at the ends
static void cosine(int m, double *circulation) {
    for (int j = 0; j < N_SHEET; j++) {
        const bool is_end = j == 0 || j == N_SHEET - 1;
        circulation[j] = (is_end ? 0.5 : 1) * pi / (N_SHEET - 1) * cos(m * pi * j / (N_SHEET - 1));
    }
}

static struct sheet_integrals *make(double (*density)(int)) {
    double values[N_NODES - 1];
    for (int k = 0; k < N_NODES - 1; k++) values[k] = density(k);
    struct sheet_integrals *integrals;
    assert_int_equal(sheet_integrals_create(test_arena(), &integrals, N_NODES, N_SHEET, values, NULL), STATUS_OK);
    return integrals;
}

static double three(int edge) {
    (void)edge;
    return 3;
}

static double first_two_edges(int edge) {
    return edge < 2 ? 1 : 0;
}

TEST(control_points_have_the_circulation_of_their_intervals) {
    struct sheet_integrals *const integrals = make(three);
    for (int m = 0; m < N_SHEET - 1; m++) {
        double q[N_SHEET], around[N_SHEET - 1], before[N_SHEET - 1];
        cosine(m, q);
        wide_product(N_SHEET - 1, N_SHEET, integrals->strength, q, around);
        wide_product(N_SHEET - 1, N_SHEET, integrals->circulation, q, before);
        for (int c = 0; c < N_SHEET - 1; c++) {
            const double theta = pi * (c + 0.5) / (N_SHEET - 1);
            NEAR(around[c], pi / (N_SHEET - 1) * cos(m * theta), 1e-14, 0);
            NEAR(before[c], m == 0 ? theta : sin(m * theta) / m, 1e-13, 0);
        }
    }
}

TEST(a_kink_at_the_tail_is_what_the_series_lacks) {
    struct sheet_integrals *const integrals = make(three);
    const double h = pi / (N_SHEET - 1);
    for (int c = 0; c < N_SHEET - 1; c++) {
        // g = sin(theta) (1 - cos(theta)): a strength proportional to the position, finite at the tail
        const double theta = h * (c + 0.5), end = h * sin(pi - h) * (1 - cos(pi - h));
        double around = integrals->kink_strength[c] * end, before = integrals->kink_circulation[c] * end;
        for (int j = 0; j < N_SHEET; j++) {
            const double q = h * sin(j * h) * (1 - cos(j * h));
            around += integrals->strength[j * (N_SHEET - 1) + c] * q;
            before += integrals->circulation[j * (N_SHEET - 1) + c] * q;
        }
        NEAR(around, h * sin(theta) * (1 - cos(theta)), 1e-14, 0);
        NEAR(before, pow(1 - cos(theta), 2) / 2, 1e-13, 0);
    }
    // the kink is large at the tail
    ABOVE(fabs(integrals->kink_strength[N_SHEET - 2]), 0.1);
    BELOW(fabs(integrals->kink_strength[0]), 0.01);
}

// sum over nodes k, i and vortices j of weight_k P_kij x_i q_j
static double integral(const struct sheet_integrals *integrals, const double *weight, const double *x,
                       const double *q) {
    double sum = 0, parts[4 * N_NODES], matrix[N_NODES * N_NODES];
    sheet_integrals_matrix(integrals, q, parts, matrix);
    for (int k = 0; k < N_NODES; k++) {
        for (int i = 0; i < N_NODES; i++) sum += weight[k] * matrix[i * N_NODES + k] * x[i];
    }
    return sum;
}

static const double one[N_NODES] = {1, 1, 1, 1, 1, 1, 1}, place[N_NODES] = {0, 1, 2, 3, 4, 5, 6};

TEST(momentum_of_a_sheet_of_constant_g_is_the_exact_one) {
    double q[N_SHEET];
    cosine(0, q);
    // C = theta, and with u = (N-1)(1 - cos theta)/2: integral of theta du, and of theta u du
    const double half = (N_NODES - 1) / 2.0;
    struct sheet_integrals *const integrals = make(three);
    NEAR(integral(integrals, one, place, q), 3 * pi * half, 0, 1e-9);
    NEAR(integral(integrals, place, place, q), 3 * pi * half * half * 1.25, 0, 1e-9);
    // a sum over nodes of slopes of 1 vanishes
    NEAR(integral(integrals, place, one, q), 0, 1e-11, 0);
    // to the end of the second edge: (N-1)/2 (sin(theta) - theta cos(theta))
    struct sheet_integrals *const part = make(first_two_edges);
    const double end = acos(1 - 2 / half);
    NEAR(integral(part, one, place, q), half * (sin(end) - end * cos(end)), 0, 1e-9);
}

// g = cos(m theta) has C = sin(m theta)/m; its momentum to the end of the second edge
TEST(momentum_of_every_cosine_is_the_exact_one) {
    struct sheet_integrals *const part = make(first_two_edges);
    const double half = (N_NODES - 1) / 2.0, end = acos(1 - 2 / half);
    for (int m = 1; m < N_SHEET; m++) {
        double q[N_SHEET];
        cosine(m, q);
        const double less = m == 1 ? end : sin((m - 1) * end) / (m - 1), more = sin((m + 1) * end) / (m + 1);
        NEAR(integral(part, one, place, q), half * (less - more) / (2 * m), 1e-10, 0);
    }
}

// C_j(theta) of doc/model.md, section 15
static double circulation_before(int n_sheet, int j, double theta) {
    const int last = n_sheet - 1;
    double sum = theta / pi;
    for (int m = 1; m <= last; m++) sum += (m < last ? 2 : 1) / pi * cos(m * pi * j / last) * sin(m * theta) / m;
    return sum;
}

// P_kij of vortex j with density 1 by the same Gauss points, from the weights of points and slopes  (n_nodes, n_nodes)
static void momentum_by_weights(int n, int n_sheet, int j, double *matrix) {
    double node[6], gauss[6];
    quadrature_legendre(6, node, gauss);
    for (int edge = 0; edge < n - 1; edge++) {
        const double first = acos(1 - 2.0 * edge / (n - 1)), last = acos(1 - 2.0 * (edge + 1) / (n - 1));
        const int n_pieces = (int)fmax(2, ceil((last - first) / (pi / (n_sheet - 1))));
        const double piece = (last - first) / n_pieces;
        ARENA(arena, NULL, "a curve");
        struct curve *const curve = curve_create(arena, n, 0, 2 * 6 * n_pieces);
        for (int p = 0; p < 6 * n_pieces; p++) {
            const double theta = first + (p / 6 + node[p % 6]) * piece, u = (n - 1) * (1 - cos(theta)) / 2;
            const double weight = gauss[p % 6] * piece * (n - 1) * sin(theta) / 2;
            const double value = weight * circulation_before(n_sheet, j, theta);
            const struct stencil point = curve_smooth_point(curve, u), slope = curve_smooth_slope(curve, u);
            for (int i = 0; i < n; i++) {
                for (int k = 0; k < n; k++) matrix[i * n + k] += value * slope.weight[i] * point.weight[k];
            }
        }
    }
}

// partial fractions lose no digits, although each has poles at the nodes
TEST(partial_fractions_are_the_products_of_weights_and_slopes) {
    const struct {
        int n, n_sheet, vortex;
    } sizes[] = {{4, 7, 0}, {7, 13, 5}, {25, 49, 24}, {25, 49, 48}, {60, 119, 7}, {199, 397, 396}};
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++) {
        const int n = sizes[s].n, n_sheet = sizes[s].n_sheet;
        const size_t n_nodes = (size_t)n, n_entries = n_nodes * n_nodes;
        double *memory;
        NEW(test_arena(), memory, 2 * n_entries + 10 * n_nodes + (size_t)n_sheet);
        double *const want = memory, *const got = want + n_entries, *const parts = got + n_entries,
                      *const x = parts + 4 * n, *const product = x + 2 * n, *const sum = product + 2 * n,
                      *const density = sum + n, *const q = density + n;
        momentum_by_weights(n, n_sheet, sizes[s].vortex, want);

        struct sheet_integrals *integrals;
        for (int k = 0; k < n; k++) density[k] = 1;
        q[sizes[s].vortex] = 1;
        assert_int_equal(sheet_integrals_create(test_arena(), &integrals, n, n_sheet, density, NULL), STATUS_OK);
        sheet_integrals_matrix(integrals, q, parts, got);
        double largest = 0;
        for (int e = 0; e < n * n; e++) largest = fmax(largest, fabs(want[e]));
        NEAR_ARRAY(n * n, got, want, 1e-14 * largest, 0);

        // the products with the matrix of one vortex
        for (int i = 0; i < 2 * n; i++) x[i] = cos(i);
        sheet_integrals_product(integrals, sizes[s].vortex, x, x + n, product, product + n);
        for (int of_y = 0; of_y < 2; of_y++) {
            for (int k = 0; k < n; k++) sum[k] = 0;
            for (int e = 0; e < n * n; e++) sum[e % n] += want[e] * x[of_y * n + e / n];
            NEAR_ARRAY(n, product + of_y * n, sum, 1e-13 * largest, 0);
        }
    }
}

// four numbers for each vortex and node: 40 kB at 25 nodes
TEST(memory_is_the_product_of_nodes_and_vortices) {
    double density[199];
    for (int k = 0; k < 199; k++) density[k] = 1;
    for (int n = 25; n < 200; n = 2 * n + 49) {
        ARENA(arena, NULL, "integrals");
        struct sheet_integrals *integrals;
        n_bytes = 0;
        assert_int_equal(sheet_integrals_create(arena, &integrals, n, 2 * n - 1, density, NULL), STATUS_OK);
        // part, strength, circulation, and once the series
        NEAR((double)n_bytes, 8.0 * (4 * n * (2 * n - 1) + 3 * (2 * n - 1) * (2 * n - 2)), 0, 0.05);
    }
}
