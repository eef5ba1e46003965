/* test_curve.c: points and tangents of the polygon and of the smooth curve: doc/model.md, section 6. */
#include "failing_malloc.h"
#include "fish/curve.h"
#include "near.h"

static const double pi = 3.14159265358979323846;

static struct curve *make(int n_nodes, int n) {
    struct curve *curve;
    assert_int_equal(curve_create(&curve, n_nodes, n, n), STATUS_OK);
    return curve;
}

static double sum(const struct stencil *stencil, const double *value) {
    double total = 0;
    for (int i = 0; i < stencil->n; i++) total += stencil->weight[i] * value[stencil->node[i]];
    return total;
}

static void polygon_is_straight_between_two_nodes(void **state) {
    (void)state;
    const double value[] = {2, 5, 3, -1};
    const double u[] = {0, 0.25, 1, 1.5, 2.75, 3}, want[] = {2, 2.75, 5, 4, 0, -1};
    struct curve *curve = make(4, 6);
    for (int i = 0; i < 6; i++) {
        const struct stencil point = curve_polygon_point(curve, u[i]);
        assert_int_equal(point.n, 2);
        NEAR(sum(&point, value), want[i], 0, 0);
    }
    curve_free(curve);
}

static void middles_of_the_polygon_hold_each_node_once(void **state) {
    (void)state;
    const double value[] = {2, 5, 3, -1};
    struct curve *curve = make(4, 6);
    const struct stencil a = curve_polygon_point(curve, 0.25), b = curve_polygon_point(curve, 0.75),
                         c = curve_polygon_point(curve, 1.5), d = curve_polygon_point(curve, 2.75);
    const struct stencil one_edge = curve_polygon_middle(curve, &a, &b), two = curve_polygon_middle(curve, &b, &c),
                         edge = curve_edge_middle(curve, 2);
    assert_int_equal(one_edge.n, 2);
    assert_int_equal(two.n, 3);
    NEAR(sum(&one_edge, value), 3.5, 0, 0);
    NEAR(sum(&two, value), 4.125, 0, 0);
    NEAR(sum(&edge, value), 1, 0, 0);
    const struct stencil far = curve_polygon_middle(curve, &a, &d);
    assert_int_equal(far.n, 4);
    NEAR(sum(&far, value), 1.375, 0, 0);
    curve_free(curve);
}

// positions between nodes, on nodes, and as close to nodes as rounding permits
static const double places[] = {0, 1e-300, 1e-12, 0.3, 0.5, 1 - 1e-15, 1, 1 + 1e-9, 1.7, 2.5, 3 - 4e-16, 3};
enum { N_PLACES = sizeof places / sizeof *places };

static void smooth_curve_reproduces_cubics_and_their_slopes(void **state) {
    (void)state;
    for (int n = 4; n <= 40; n += 3) {
        struct curve *curve = make(n, 2 * N_PLACES);
        for (int i = 0; i < N_PLACES; i++) {
            const double u = places[i] * (n - 1) / 3;
            const struct stencil point = curve_smooth_point(curve, u), slope = curve_smooth_slope(curve, u);
            double constant[40], cubic[40];
            const double s = u / (n - 1);
            for (int k = 0; k < n; k++) {
                const double q = (double)k / (n - 1);
                constant[k] = 1;
                cubic[k] = 0.3 - q * (1 + q * (0.7 - 2 * q));
            }
            NEAR(sum(&point, constant), 1, 1e-15, 0);
            // the rounding of a sum of n values, in a slope times n
            NEAR(sum(&point, cubic), 0.3 - s * (1 + s * (0.7 - 2 * s)), 1e-14, 0);
            NEAR(sum(&slope, constant), 0, 1e-14, 0);
            NEAR(sum(&slope, cubic) * (n - 1), -1 - s * (1.4 - 6 * s), 1e-13 * n, 0);
        }
        curve_free(curve);
    }
}

static void smooth_curve_goes_through_its_nodes(void **state) {
    (void)state;
    struct curve *curve = make(9, 9);
    for (int k = 0; k < 9; k++) {
        const struct stencil point = curve_smooth_point(curve, k);
        for (int i = 0; i < 9; i++) NEAR(point.weight[i], i == k, 0, 0);
    }
    curve_free(curve);
}

static void slope_is_the_derivative_of_the_point(void **state) {
    (void)state;
    const double h = 1e-3;
    for (int n = 4; n <= 13; n += 3) {
        struct curve *curve = make(n, 1000);
        for (double u = 0.05; u < n - 1; u += 0.19) {
            const struct stencil slope = curve_smooth_slope(curve, u);
            const struct stencil at[4] = {curve_smooth_point(curve, u - 2 * h), curve_smooth_point(curve, u - h),
                                          curve_smooth_point(curve, u + h), curve_smooth_point(curve, u + 2 * h)};
            for (int k = 0; k < n; k++) {
                const double difference =
                    (at[0].weight[k] - 8 * at[1].weight[k] + 8 * at[2].weight[k] - at[3].weight[k]) / (12 * h);
                // h^4/30 times the fifth derivative
                NEAR(slope.weight[k], difference, 1e-10, 0);
            }
        }
        curve_free(curve);
    }
}

// largest position error on the curve through n nodes on a half circle
static double error_of_arc(int n) {
    double x[200], y[200], largest = 0;
    for (int k = 0; k < n; k++) {
        x[k] = cos(pi * k / (n - 1));
        y[k] = sin(pi * k / (n - 1));
    }
    struct curve *curve = make(n, 10 * n);
    for (int i = 0; i < 10 * (n - 1); i++) {
        const double u = 0.1 * i + 0.05;
        const struct stencil point = curve_smooth_point(curve, u);
        largest = fmax(largest, hypot(sum(&point, x) - cos(pi * u / (n - 1)), sum(&point, y) - sin(pi * u / (n - 1))));
    }
    curve_free(curve);
    return largest;
}

static void smooth_curve_is_of_fourth_order(void **state) {
    (void)state;
    const double coarse = error_of_arc(41), fine = error_of_arc(81);
    assert_in_range((int)(100 * log2(coarse / fine)), 380, 420);
}

static void missing_memory_is_reported_and_leaks_nothing(void **state) {
    (void)state;
    const int before = n_live;
    int n_failures = 0;
    for (enum status status = STATUS_MEMORY; status != STATUS_OK; n_failures++) {
        struct curve *curve;
        n_until_failure = n_failures;
        status = curve_create(&curve, 7, 3, 3);
        n_until_failure = -1;
        if (status == STATUS_OK) {
            curve_free(curve);
            continue;
        }
        assert_int_equal(status, STATUS_MEMORY);
        assert_null(curve);
        assert_int_equal(n_live, before);
    }
    assert_true(n_failures > 1);
    curve_free(NULL);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(polygon_is_straight_between_two_nodes),
        cmocka_unit_test(middles_of_the_polygon_hold_each_node_once),
        cmocka_unit_test(smooth_curve_reproduces_cubics_and_their_slopes),
        cmocka_unit_test(smooth_curve_goes_through_its_nodes),
        cmocka_unit_test(slope_is_the_derivative_of_the_point),
        cmocka_unit_test(smooth_curve_is_of_fourth_order),
        cmocka_unit_test(missing_memory_is_reported_and_leaks_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
