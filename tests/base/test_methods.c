/* test_methods.c: The table of integration methods is complete, and each Runge-Kutta method meets the order conditions
 * of its order. */
#include "base/methods.h"
#include "near.h"

// the conditions below are complete up to this order
enum { CHECKED_ORDER = 3 };

static double rounding(const struct butcher_tableau *t) {
    double largest = 1;
    for (int i = 0; i < t->n_stages * t->n_stages; i++) largest = fmax(largest, fabs(t->a[i]));
    return 1e-15 * t->n_stages * largest;
}

static void check_order(const struct butcher_tableau *t, const double *b, int order) {
    const double atol = rounding(t);
    double sum = 0, first = 0, square = 0, nested = 0;
    for (int i = 0; i < t->n_stages; i++) {
        sum += b[i];
        first += b[i] * t->c[i];
        square += b[i] * t->c[i] * t->c[i];
        for (int j = 0; j < i; j++) nested += b[i] * t->a[i * t->n_stages + j] * t->c[j];
    }
    NEAR(sum, 1, atol, 0);
    if (order >= 2) NEAR(first, 1.0 / 2, atol, 0);
    if (order < CHECKED_ORDER) return;
    NEAR(square, 1.0 / 3, atol, 0);
    NEAR(nested, 1.0 / 6, atol, 0);
}

// the weights are a quadrature formula: a formula of order q integrates c^(q - 1)
static void check_quadrature(const struct butcher_tableau *t, const double *b, int order) {
    double sum = 0;
    for (int i = 0; i < t->n_stages; i++) sum += b[i] * pow(t->c[i], order - 1);
    NEAR(sum, 1.0 / order, rounding(t), 0);
}

static void check_tableau(const struct butcher_tableau *t, int order) {
    assert_int_equal(t->order, order);
    for (int i = 0; i < t->n_stages; i++) {
        double row = 0;
        for (int j = 0; j < t->n_stages; j++) {
            row += t->a[i * t->n_stages + j];
            if (j >= i) NEAR(t->a[i * t->n_stages + j], 0, 0, 0);
        }
        NEAR(row, t->c[i], rounding(t), 0);
    }
    check_order(t, t->b, t->order);
    check_quadrature(t, t->b, t->order);
    assert_int_equal(t->embedded != NULL, t->embedded_order > 0);
    if (!t->embedded) return;
    check_order(t, t->embedded, t->embedded_order);
    check_quadrature(t, t->embedded, t->embedded_order);
}

TEST(tableaux_have_the_orders_of_their_methods) {
    for (int i = 0; i < methods_n; i++) {
        const struct method_properties *const method = &methods_table[i];
        assert_in_range(method->order, 1, METHODS_MAX_ORDER);
        if (method->fixed) check_tableau(method->fixed, method->order);
        if (method->adaptive) check_tableau(method->adaptive, method->order);
        if (method->adaptive) assert_non_null(method->adaptive->embedded);
    }
}

TEST(runge_kutta_methods_have_a_tableau_for_each_kind_of_steps) {
    for (int i = 0; i < methods_n; i++) {
        const struct method_properties *const method = &methods_table[i];
        assert_true(method->has_fixed_steps || method->has_adaptive_steps);
        const bool is_runge_kutta = !method->is_implicit && i != METHOD_VERLET;
        assert_int_equal(method->fixed != NULL, is_runge_kutta && method->has_fixed_steps);
        assert_int_equal(method->adaptive != NULL, is_runge_kutta && method->has_adaptive_steps);
    }
}

TEST(rows_are_in_the_order_of_their_names) {
    assert_string_equal(methods_table[METHOD_IDA].word, "ida");
    assert_string_equal(methods_table[METHOD_EULER].word, "euler");
    assert_string_equal(methods_table[METHOD_HEUN].word, "heun");
    assert_string_equal(methods_table[METHOD_RK4].word, "rk4");
    assert_string_equal(methods_table[METHOD_DORMAND_PRINCE].word, "dormand_prince");
    assert_string_equal(methods_table[METHOD_IMPLICIT_EULER].word, "implicit_euler");
    assert_string_equal(methods_table[METHOD_TRAPEZOID].word, "trapezoid");
    assert_string_equal(methods_table[METHOD_IMEX].word, "imex");
    assert_string_equal(methods_table[METHOD_VERLET].word, "verlet");
}
