/* test_newton.c: Newton's method on a few equations that count what they cost. */
#include <string.h>

#include "school.h"
#include "solver/newton.h"

// u0^2 + u1 = 3, u0 - u1 = -1: solved by 1, 2
struct pair {
    double u[2];
    int n_values, n_jacobians, fails_at;
};

static enum status pair_value(void *data, const double *u, double *value) {
    struct pair *const pair = data;
    if (++pair->n_values == pair->fails_at) return status_fail(STATUS_CONTACT, "they met");
    pair->u[0] = u[0];
    pair->u[1] = u[1];
    value[0] = u[0] * u[0] + u[1] - 3;
    value[1] = u[0] - u[1] + 1;
    return STATUS_OK;
}

static enum status pair_jacobian(void *data, double *matrix) {
    struct pair *const pair = data;
    const double columns[4] = {2 * pair->u[0], 1, 1, -1};
    pair->n_jacobians++;
    for (int i = 0; i < 4; i++) matrix[i] = columns[i];
    return STATUS_OK;
}

static enum status singular(void *data, double *matrix) {
    (void)data;
    for (int i = 0; i < 4; i++) matrix[i] = 1;
    return STATUS_OK;
}

static struct newton problem_of(struct pair *pair) {
    static const double scale[2] = {1, 1};
    return (struct newton){.n = 2,
                           .scale = scale,
                           .tolerance = 1e-10,
                           .max_step = 10,
                           .reuse = 1,
                           .max_iterations = 20,
                           .value = pair_value,
                           .jacobian = pair_jacobian,
                           .data = pair};
}

TEST(two_equations_are_solved_with_a_value_and_a_jacobian_for_each_step) {
    struct pair pair = {.n_values = 0};
    const struct newton problem = problem_of(&pair);
    double u[2] = {2, 0};
    assert_int_equal(newton_solve(test_arena(), &problem, u), STATUS_OK);
    NEAR(u[0], 1, 1e-9, 0);
    NEAR(u[1], 2, 1e-9, 0);
    // from u0 = 2 the error is 1/5, 1/85, 4e-5, 6e-10: quadratic
    assert_int_equal(pair.n_jacobians, 5);
    assert_int_equal(pair.n_values, 6);
}

TEST(no_step_is_longer_than_the_longest) {
    struct pair pair = {.n_values = 0};
    struct newton problem = problem_of(&pair);
    problem.max_step = 1.5;
    problem.max_iterations = 1;
    double u[2] = {20, 0};
    assert_int_equal(newton_solve(test_arena(), &problem, u), STATUS_SOLVER);
    NEAR(hypot(u[0] - 20, u[1]), 1.5, 1e-12, 0);
    assert_non_null(strstr(status_message(), "did not converge"));
}

TEST(a_value_that_fails_ends_it_with_its_own_reason) {
    struct pair pair = {.fails_at = 3};
    const struct newton problem = problem_of(&pair);
    double u[2] = {2, 0};
    assert_int_equal(newton_solve(test_arena(), &problem, u), STATUS_CONTACT);
    assert_string_equal(status_message(), "they met");
    assert_int_equal(pair.n_values, 3);
}

TEST(a_singular_jacobian_is_named) {
    struct pair pair = {.n_values = 0};
    struct newton problem = problem_of(&pair);
    problem.jacobian = singular;
    double u[2] = {2, 0};
    assert_int_equal(newton_solve(test_arena(), &problem, u), STATUS_SOLVER);
    assert_non_null(strstr(status_message(), "singular"));
}

// ---- eigenvalues of maps of which images are known

// 0.9 along the first axis, a rotation by 30 degrees that shrinks by 0.8 in the plane of the others
static void image_of(const double *v, double *image) {
    const double c = 0.8 * cos(M_PI / 6), s = 0.8 * sin(M_PI / 6);
    image[0] = 0.9 * v[0];
    image[1] = c * v[1] - s * v[2];
    image[2] = s * v[1] + c * v[2];
}

enum { N = 3, COLUMNS = 5 };

TEST(eigenvalues_come_by_size_and_the_way_to_the_fixed_point_is_told) {
    // five vectors that span the space, mixed so that no column is an eigenvector
    const double before[N * COLUMNS] = {1, 2, -1, 0, 1, 3, 2, -1, 1, -2, 0, 1, 1, 1, 1};
    const double want_way[N] = {3, -1, 2};
    double after[N * COLUMNS], real[N], imaginary[N], way[N], change[N];
    image_of(want_way, change);
    for (int i = 0; i < N; i++) change[i] = want_way[i] - change[i];
    for (int k = 0; k < COLUMNS; k++) image_of(before + N * k, after + N * k);
    assert_int_equal(newton_multipliers(test_arena(), N, COLUMNS, before, after, change, real, imaginary, way),
                     STATUS_OK);
    NEAR_ARRAY(N, way, want_way, 1e-13, 0);
    const double want_real[N] = {0.9, 0.8 * cos(M_PI / 6), 0.8 * cos(M_PI / 6)}, want_imaginary[N] = {0, 0.4, -0.4};
    NEAR_ARRAY(N, real, want_real, 1e-14, 0);
    NEAR_ARRAY(N, imaginary, want_imaginary, 1e-14, 0);
}

TEST(errors_of_single_images_are_averaged) {
    // one dimension: images of 1, 2, -2 under 0.5, of which the first is wrong by 0.09: least squares have 0.5 + 0.09/9
    const double before[3] = {1, 2, -2}, after[3] = {0.59, 1, -1};
    const double change = 0.98;
    double real, imaginary, way;
    assert_int_equal(newton_multipliers(test_arena(), 1, 3, before, after, &change, &real, &imaginary, &way),
                     STATUS_OK);
    NEAR(real, 0.51, 1e-14, 0);
    NEAR(imaginary, 0, 0, 0);
    NEAR(way, 2, 1e-13, 0);
}

TEST(columns_that_do_not_span_the_space_tell_nothing) {
    const double before[4] = {0, 0, 0, 0}, after[4] = {1, 1, 2, 2};
    const double change[2] = {0, 0};
    double real[2], imaginary[2], way[2];
    assert_int_equal(newton_multipliers(test_arena(), 2, 2, before, after, change, real, imaginary, way),
                     STATUS_SOLVER);
    assert_non_null(strstr(status_message(), "multipliers"));
}

TEST(a_direction_that_has_died_has_a_multiplier_of_zero) {
    // 0.8 along the first axis; of the second only errors are left, which seem to grow
    const double before[8] = {1, 1e-3, 0.8, 2e-3, 0.64, -1e-3, 0.512, 3e-3};
    const double after[8] = {0.8, 2e-3, 0.64, -1e-3, 0.512, 3e-3, 0.4096, -5e-3}, change[2] = {0.2, 0};
    double real[2], imaginary[2], way[2];
    assert_int_equal(newton_multipliers(test_arena(), 2, 4, before, after, change, real, imaginary, way), STATUS_OK);
    NEAR(real[0], 0.8, 1e-5, 0);
    NEAR(real[1], 0, 0, 0);
    NEAR(imaginary[1], 0, 0, 0);
    NEAR(way[0], 1, 1e-4, 0);
}

TEST(a_map_that_keeps_what_it_gets_has_no_fixed_point) {
    const double before[4] = {1, 0, 0, 1}, change[2] = {1, 1};
    double real[2], imaginary[2], way[2];
    assert_int_equal(newton_multipliers(test_arena(), 2, 2, before, before, change, real, imaginary, way), STATUS_OK);
    NEAR(way[0], 0, 0, 0);
    NEAR(way[1], 0, 0, 0);
}
