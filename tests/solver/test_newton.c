/* test_newton.c: Newton's method on a few equations that count what they cost. */
#include <string.h>

#include "near.h"
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

static void two_equations_are_solved_with_a_value_and_a_jacobian_for_each_step(void **state) {
    (void)state;
    struct pair pair = {.n_values = 0};
    const struct newton problem = problem_of(&pair);
    double u[2] = {2, 0};
    assert_int_equal(newton_solve(&problem, u), STATUS_OK);
    NEAR(u[0], 1, 1e-9, 0);
    NEAR(u[1], 2, 1e-9, 0);
    // from u0 = 2 the error is 1/5, 1/85, 4e-5, 6e-10: quadratic
    assert_int_equal(pair.n_jacobians, 5);
    assert_int_equal(pair.n_values, 6);
}

static void no_step_is_longer_than_the_longest(void **state) {
    (void)state;
    struct pair pair = {.n_values = 0};
    struct newton problem = problem_of(&pair);
    problem.max_step = 1.5;
    problem.max_iterations = 1;
    double u[2] = {20, 0};
    assert_int_equal(newton_solve(&problem, u), STATUS_SOLVER);
    NEAR(hypot(u[0] - 20, u[1]), 1.5, 1e-12, 0);
    assert_non_null(strstr(status_message(), "did not converge"));
}

static void a_value_that_fails_ends_it_with_its_own_reason(void **state) {
    (void)state;
    struct pair pair = {.fails_at = 3};
    const struct newton problem = problem_of(&pair);
    double u[2] = {2, 0};
    assert_int_equal(newton_solve(&problem, u), STATUS_CONTACT);
    assert_string_equal(status_message(), "they met");
    assert_int_equal(pair.n_values, 3);
}

static void a_singular_jacobian_is_named(void **state) {
    (void)state;
    struct pair pair = {.n_values = 0};
    struct newton problem = problem_of(&pair);
    problem.jacobian = singular;
    double u[2] = {2, 0};
    assert_int_equal(newton_solve(&problem, u), STATUS_SOLVER);
    assert_non_null(strstr(status_message(), "singular"));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(two_equations_are_solved_with_a_value_and_a_jacobian_for_each_step),
        cmocka_unit_test(no_step_is_longer_than_the_longest),
        cmocka_unit_test(a_value_that_fails_ends_it_with_its_own_reason),
        cmocka_unit_test(a_singular_jacobian_is_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
