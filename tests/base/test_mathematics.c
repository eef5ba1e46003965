/* test_mathematics.c: Tests the small functions of geometry and analysis (angles, smooth ramps, quadrature, boxes) and
 * the wide products of wide.h against closed forms. */
#include <math.h>

#include "base/mathematics.h"
#include "base/wide.h"
#include "near.h"

TEST(the_larger_and_the_smaller_number_keep_nan) {
    const double value[] = {-INFINITY, -2, 0, 3, INFINITY};
    for (int i = 0; i < 5; i++) {
        for (int k = 0; k < 5; k++) {
            NEAR(larger(value[i], value[k]), value[i > k ? i : k], 0, 0);
            NEAR(smaller(value[i], value[k]), value[i < k ? i : k], 0, 0);
        }
        assert_true(isnan(larger(NAN, value[i])) && isnan(larger(value[i], NAN)));
        assert_true(isnan(smaller(NAN, value[i])) && isnan(smaller(value[i], NAN)));
    }
}

TEST(wrap_removes_full_turns) {
    const double pi = acos(-1);
    for (int turns = -3; turns <= 3; turns++) {
        for (double angle = -3; angle <= 3; angle += 0.5) {
            // rounding of up to three turns
            NEAR(angle_wrap(angle + 2 * pi * turns), angle, 1e-14, 0);
        }
    }
    NEAR(fabs(angle_wrap(pi)), pi, 0, 1e-15);
}

TEST(degrees_and_radians_are_inverse) {
    NEAR(angle_radians(180), acos(-1), 0, 1e-15);
    NEAR(angle_degrees(angle_radians(37.5)), 37.5, 0, 1e-15);
}

// ---- the ramp of doc/model.md, section 4

TEST(step_goes_from_zero_to_one_symmetrically) {
    NEAR(ramp_step(-1), 0, 0, 0);
    NEAR(ramp_step(0), 0, 0, 0);
    NEAR(ramp_step(1), 1, 0, 0);
    NEAR(ramp_step(7), 1, 0, 0);
    // S(q) + S(1-q) = 1 up to rounding of coefficients of up to 84
    for (double q = 0; q <= 1; q += 0.0625) NEAR(ramp_step(q) + ramp_step(1 - q), 1, 1e-14, 0);
    // 0.25^4 (35 - 84/4 + 70/16 - 20/64) by hand
    NEAR(ramp_step(0.25), 18.0625 / 256, 1e-16, 0);
}

TEST(rate_is_the_derivative) {
    const double h = 1e-4;
    for (double q = -0.15; q < 1.2; q += 0.1) {
        // truncation h^2/6 |S'''| with |S'''| <= 53; rounding 1e-16/h is less
        NEAR(ramp_step_rate(q), (ramp_step(q + h) - ramp_step(q - h)) / (2 * h), 1e-7, 0);
        NEAR(ramp_rate(3 * q, 3), (ramp_value(3 * q + h, 3) - ramp_value(3 * q - h, 3)) / (2 * h), 1e-8, 0);
    }
}

TEST(three_derivatives_vanish_at_both_ends) {
    // S = 35 q^4 + ... at the start, 1 - 35 (1-q)^4 + ... at the end
    const double q = 1e-3;
    NEAR(ramp_step(q), 35 * q * q * q * q, 0, 3e-3);
    NEAR(1 - ramp_step(1 - q), 35 * q * q * q * q, 1e-15, 3e-3);
}

TEST(ramp_of_no_duration_is_one_at_all_times) {
    NEAR(ramp_value(0, 0), 1, 0, 0);
    NEAR(ramp_rate(0, 0), 0, 0, 0);
    NEAR(ramp_value(1, 2), 0.5, 1e-15, 0);
}

// ---- Gauss-Legendre quadrature

TEST(polynomials_of_degree_2n_less_1_are_integrated_exactly) {
    for (int n = 1; n <= 24; n++) {
        double node[24], weight[24];
        quadrature_legendre(n, node, weight);
        for (int degree = 0; degree < 2 * n; degree++) {
            double sum = 0;
            for (int i = 0; i < n; i++) sum += weight[i] * pow(node[i], degree);
            NEAR(sum, 1.0 / (degree + 1), 0, 1e-13);
        }
    }
}

// the terms of a sum with any weights; without freedom the nodes are the terms
TEST(the_gauss_rule_of_a_sum_is_exact_to_degree_2n_less_1) {
    enum { N = 40 };
    double x[N], weight[N], scratch[2 * N], node[8], of_node[8];
    for (int i = 0; i < N; i++) {
        x[i] = 1.0 / (i + 2);
        weight[i] = 1 + 0.5 * sin(i);
    }

    for (int n = 1; n <= 8; n++) {
        quadrature_of_sum(N, x, weight, scratch, n, node, of_node);
        for (int degree = 0; degree < 2 * n; degree++) {
            double sum = 0, rule = 0;
            for (int i = 0; i < N; i++) sum += weight[i] * pow(x[i], degree);
            for (int i = 0; i < n; i++) rule += of_node[i] * pow(node[i], degree);
            NEAR(rule, sum, 0, 1e-12);
        }
        for (int i = 1; i < n; i++) ABOVE(node[i], node[i - 1]);
    }

    quadrature_of_sum(3, x, weight, scratch, 3, node, of_node);
    for (int i = 0; i < 3; i++) {
        NEAR(node[i], x[2 - i], 0, 1e-13);
        NEAR(of_node[i], weight[2 - i], 0, 1e-12);
    }
}

TEST(nodes_ascend_and_are_symmetric) {
    double node[16], weight[16];
    quadrature_legendre(16, node, weight);
    for (int i = 0; i < 16; i++) {
        NEAR(node[i], 1 - node[15 - i], 1e-15, 0);
        NEAR(weight[i], weight[15 - i], 1e-15, 0);
        if (i > 0) ABOVE(node[i], node[i - 1]);
    }
}

TEST(four_nodes_are_those_of_the_tables) {
    // Abramowitz and Stegun, table 25.4
    const double x[] = {0.339981043584856, 0.861136311594053}, w[] = {0.652145154862546, 0.347854845137454};
    double node[4], weight[4];
    quadrature_legendre(4, node, weight);
    for (int i = 0; i < 2; i++) {
        NEAR(node[2 + i], (1 + x[i]) / 2, 1e-15, 0);
        NEAR(weight[2 + i], w[i] / 2, 1e-15, 0);
    }
}

TEST(the_newest_interval_of_a_parabola_is_exact) {
    const double t[3] = {0.9, 0.4, 0.1};
    double line[3], parabola[3];
    for (int i = 0; i < 3; i++) {
        line[i] = 2 - 3 * t[i];
        parabola[i] = 2 - 3 * t[i] + 6 * t[i] * t[i];
    }
    NEAR(quadrature_newest(2, t, line), 2 * 0.5 - 1.5 * (0.81 - 0.16), 1e-15, 0);
    NEAR(quadrature_newest(3, t, parabola), 2 * 0.5 - 1.5 * (0.81 - 0.16) + 2 * (0.729 - 0.064), 1e-15, 0);
    NEAR(quadrature_newest(2, t, parabola), 0.25 * (parabola[0] + parabola[1]), 1e-15, 0);
}

// ---- boxes around points, and the gap between two

TEST(a_box_has_all_points_and_is_not_larger) {
    const double x[] = {1, -2, 0.5}, y[] = {3, 4, -1};
    const struct box box = box_around(3, x, y), wide = box_widen(box, 0.25);
    NEAR_ARRAY(2, box.low, ((const double[]){-2, -1}), 0, 0);
    NEAR_ARRAY(2, box.high, ((const double[]){1, 4}), 0, 0);
    NEAR_ARRAY(2, wide.low, ((const double[]){-2.25, -1.25}), 0, 0);
    NEAR_ARRAY(2, wide.high, ((const double[]){1.25, 4.25}), 0, 0);
}

TEST(the_union_with_the_box_of_no_points_is_the_other) {
    const double x[] = {1, 2}, y[] = {3, 5};
    const struct box none = box_around(0, x, y), one = box_around(2, x, y), both = box_union(none, one);
    NEAR_ARRAY(2, both.low, one.low, 0, 0);
    NEAR_ARRAY(2, both.high, one.high, 0, 0);
    const struct box far = box_around(1, (const double[]){-7}, (const double[]){4}), all = box_union(one, far);
    NEAR_ARRAY(2, all.low, ((const double[]){-7, 3}), 0, 0);
    NEAR_ARRAY(2, all.high, ((const double[]){2, 5}), 0, 0);
    NEAR(box_gap(&none, &one), INFINITY, 0, 0);
    NEAR(box_gap(&none, &none), INFINITY, 0, 0);
}

TEST(the_gap_is_that_of_the_axis_along_which_they_are_apart) {
    const struct box a = {{0, 0}, {1, 1}};
    const struct {
        struct box other;
        double gap;
    } cases[] = {{{{3, 0}, {4, 1}}, 2},          {{{-4, 0.5}, {-3, 3}}, 3},
                 {{{0, 1.5}, {1, 2}}, 0.5},      {{{0.25, -8}, {0.5, -5}}, 5},
                 {{{2, 4}, {3, 5}}, 3},          {{{1, 0}, {2, 1}}, 0},
                 {{{0.5, 0.75}, {2, 2}}, -0.25}, {{{0.5, 0.5}, {0.75, 0.75}}, -0.5}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        NEAR(box_gap(&a, &cases[i].other), cases[i].gap, 0, 0);
        NEAR(box_gap(&cases[i].other, &a), cases[i].gap, 0, 0);
    }
}

// columns are added in order to every row, for any number of rows: the bits of plain sums
TEST(a_product_of_matrix_and_vector_is_the_sum_of_columns) {
    enum { ROWS = 70, COLUMNS = 9, BESIDE = 3 };
    double matrix[ROWS * COLUMNS], vector[COLUMNS], got[ROWS + BESIDE], want[ROWS + BESIDE];
    for (int i = 0; i < ROWS * COLUMNS; i++) matrix[i] = sin(i);
    for (int c = 0; c < COLUMNS; c++) vector[c] = cos(c);
    for (int n = 0; n <= ROWS; n++) {
        for (int n_columns = 0; n_columns <= COLUMNS; n_columns++) {
            for (int r = 0; r < ROWS + BESIDE; r++) got[r] = want[r] = r;
            for (int c = 0; c < n_columns; c++) {
                for (int r = 0; r < n; r++) want[r] += vector[c] * matrix[c * n + r];
            }
            wide_multiply(n, n_columns, matrix, vector, got);
            assert_memory_equal(got, want, sizeof got);
        }
    }
}
