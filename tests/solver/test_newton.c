/* test_newton.c: Newton's method for steady states is run on a few equations that count how often they are evaluated.
 * */
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

// ---- multipliers of maps with memory

TEST(multipliers_come_by_size_with_their_modes_and_the_way_to_the_fixed_point) {
    // 0.9 along (1, 1, 0), a rotation by 30 degrees that shrinks by 0.8 in the plane of (0, 1, 0) and (0, 0, 1)
    const double c = 0.8 * cos(M_PI / 6), s = 0.8 * sin(M_PI / 6);
    const double matrix[9] = {0.9, 0.9 - c, -s, 0, c, s, 0, -s, c};
    const double want_way[3] = {3, -1, 2};
    double real[3], imaginary[3], mode[18], way[3], change[3];
    for (int i = 0; i < 3; i++) {
        change[i] = want_way[i];
        for (int j = 0; j < 3; j++) change[i] -= matrix[i + 3 * j] * want_way[j];
    }
    assert_int_equal(newton_multipliers(test_arena(), 3, 1, matrix, real, imaginary, mode), STATUS_OK);
    newton_way(test_arena(), 3, 1, matrix, change, way);
    NEAR_ARRAY(3, way, want_way, 1e-13, 0);
    const double want_real[3] = {0.9, c, c}, want_imaginary[3] = {0, s, -s};
    NEAR_ARRAY(3, real, want_real, 1e-14, 0);
    NEAR_ARRAY(3, imaginary, want_imaginary, 1e-14, 0);
    const double want_mode[6] = {1, 0, 1, 0, 0, 0};
    NEAR_ARRAY(6, mode, want_mode, 1e-13, 0);

    // each mode of the pair is an eigenvector: A x = lambda x
    for (int k = 1; k < 3; k++) {
        const double *const x = mode + 6 * k;
        for (int i = 0; i < 3; i++) {
            double image[2] = {0, 0};
            for (int j = 0; j < 3; j++) {
                for (int part = 0; part < 2; part++) image[part] += matrix[i + 3 * j] * x[2 * j + part];
            }
            NEAR(image[0], real[k] * x[2 * i] - imaginary[k] * x[2 * i + 1], 1e-13, 0);
            NEAR(image[1], real[k] * x[2 * i + 1] + imaginary[k] * x[2 * i], 1e-13, 0);
        }
    }
}

TEST(a_memory_adds_roots) {
    // x_k+1 = 0.5 x_k + 0.24 x_k-1 has the roots 0.8 and -0.3; two of them, uncoupled, give twice 0.8
    const double one[2] = {0.5, 0.24}, two[8] = {0.5, 0, 0, 0.5, 0.24, 0, 0, 0.24};
    double real[2], imaginary[2], way;
    assert_int_equal(newton_multipliers(test_arena(), 1, 2, one, real, imaginary, NULL), STATUS_OK);
    NEAR(real[0], 0.8, 1e-14, 0);
    assert_int_equal(newton_multipliers(test_arena(), 2, 2, two, real, imaginary, NULL), STATUS_OK);
    NEAR(real[0], 0.8, 1e-14, 0);
    NEAR(real[1], 0.8, 1e-14, 0);
    newton_way(test_arena(), 1, 2, one, &(double){0.26}, &way);
    NEAR(way, 1, 1e-14, 0);
}

TEST(a_response_that_is_not_finite_has_no_multipliers) {
    double real, imaginary;
    assert_int_equal(newton_multipliers(test_arena(), 1, 1, &(double){NAN}, &real, &imaginary, NULL), STATUS_SOLVER);
    assert_non_null(strstr(status_message(), "multipliers"));
}

TEST(a_map_that_keeps_what_it_gets_has_no_fixed_point) {
    const double keeps[4] = {1, 0, 0, 1}, change[2] = {1, 1};
    double way[2];
    newton_way(test_arena(), 2, 1, keeps, change, way);
    NEAR(way[0], 0, 0, 0);
    NEAR(way[1], 0, 0, 0);
}

TEST(a_tangent_passes_a_fold_on_the_side_that_it_came_from) {
    // the circle u^2 + p^2 = 1 with the Jacobian (2 u, 2 p): against the clock from (1, 0), where u has a fold in p at
    // (0, 1)
    double tangent[2] = {0, 1};
    for (int i = 0; i <= 8; i++) {
        const double angle = i * (M_PI / 8), jacobian[2] = {2 * cos(angle), 2 * sin(angle)};
        assert_int_equal(newton_tangent(test_arena(), 1, jacobian, tangent), STATUS_OK);
        NEAR(tangent[0], -sin(angle), 1e-14, 0);
        NEAR(tangent[1], cos(angle), 1e-14, 0);
    }

    // two lines that cross have no single tangent
    const double crossing[2] = {0, 0};
    assert_int_equal(newton_tangent(test_arena(), 1, crossing, tangent), STATUS_SOLVER);
    assert_non_null(strstr(status_message(), "tangent"));
}
