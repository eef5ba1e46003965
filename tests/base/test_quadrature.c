/* test_quadrature.c: Gauss-Legendre quadrature. */
#include <math.h>

#include "base/quadrature.h"
#include "near.h"

static void polynomials_of_degree_2n_less_1_are_integrated_exactly(void **state) {
    (void)state;
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

static void nodes_ascend_and_are_symmetric(void **state) {
    (void)state;
    double node[16], weight[16];
    quadrature_legendre(16, node, weight);
    for (int i = 0; i < 16; i++) {
        NEAR(node[i], 1 - node[15 - i], 1e-15, 0);
        NEAR(weight[i], weight[15 - i], 1e-15, 0);
        assert_true(i == 0 || node[i] > node[i - 1]);
    }
}

static void four_nodes_are_those_of_the_tables(void **state) {
    (void)state;
    // Abramowitz and Stegun, table 25.4
    const double x[] = {0.339981043584856, 0.861136311594053}, w[] = {0.652145154862546, 0.347854845137454};
    double node[4], weight[4];
    quadrature_legendre(4, node, weight);
    for (int i = 0; i < 2; i++) {
        NEAR(node[2 + i], (1 + x[i]) / 2, 1e-15, 0);
        NEAR(weight[2 + i], w[i] / 2, 1e-15, 0);
    }
}

static void the_newest_interval_of_a_parabola_is_exact(void **state) {
    (void)state;
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

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(polynomials_of_degree_2n_less_1_are_integrated_exactly),
        cmocka_unit_test(nodes_ascend_and_are_symmetric),
        cmocka_unit_test(four_nodes_are_those_of_the_tables),
        cmocka_unit_test(the_newest_interval_of_a_parabola_is_exact),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
