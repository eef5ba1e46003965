/* test_dense_factors.c: Full systems are solved with pivots, and singular ones are found. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "school.h"
#include "solver/dense_factors.h"
#include "solver/fish_factors.h"

static unsigned seed = 1;
static double number(void) {
    seed = seed * 1103515245u + 12345u;
    return (double)(seed >> 8) / (1 << 24) - 0.5;
}

// largest error of the solution of a system with random entries; tiny_diagonal: elimination without row
// swaps would lose all digits
static double error_of_order(int n, int tiny_diagonal) {
    struct dense_factors factors = dense_factors_create(test_arena(), n);
    double *const x = test_array(2 * n), *const want = x + n;
    for (int k = 0; k < n; k++) {
        want[k] = number();
        for (int r = 0; r < n; r++) {
            factors.value[r + k * factors.stride] = tiny_diagonal && r == k ? 1e-14 : number();
            x[r] += factors.value[r + k * factors.stride] * want[k];
        }
    }

    assert_true(dense_factors_set_up(&factors));
    dense_factors_solve(&factors, x);
    double error = 0;
    for (int k = 0; k < n; k++) error = fmax(error, fabs(x[k] - want[k]));
    return error;
}

TEST(systems_of_any_order_are_solved) {
    // below, at and above the width of a panel, and with every remainder of a tile; the factor 1e-11 is the rounding
    // times the condition of random matrices
    for (int n = 1; n <= 72; n++) BELOW(error_of_order(n, 0), 1e-11);
    BELOW(error_of_order(200, 0), 1e-11);
    for (int n = 2; n <= 72; n += 7) BELOW(error_of_order(n, 1), 1e-11);
}

TEST(the_factors_are_those_of_elimination_by_hand) {
    // rows 1 2, 3 4: pivot 3, L = 1/3, U = 3 4, 0 2/3
    struct dense_factors factors = dense_factors_create(test_arena(), 2);
    memcpy(factors.value + 0 * factors.stride, (double[]){1, 3}, 2 * sizeof(double));
    memcpy(factors.value + 1 * factors.stride, (double[]){2, 4}, 2 * sizeof(double));
    assert_true(dense_factors_set_up(&factors));
    assert_int_equal(factors.pivot[0], 1);
    NEAR(factors.value[0 + 0 * factors.stride], 3, 0, 0);
    NEAR(factors.value[1 + 0 * factors.stride], 1.0 / 3, 0, 1e-15);
    NEAR(factors.value[0 + 1 * factors.stride], 4, 0, 0);
    NEAR(factors.value[1 + 1 * factors.stride], 2.0 / 3, 0, 1e-15);
}

TEST(a_singular_matrix_is_reported) {
    const double value[] = {0, NAN, INFINITY};
    for (int v = 0; v < 3; v++) {
        struct dense_factors factors = dense_factors_create(test_arena(), 40);
        for (int k = 0; k < 40; k++) factors.value[k + k * factors.stride] = k == 33 ? value[v] : 1;
        assert_false(dense_factors_set_up(&factors));
    }
}
