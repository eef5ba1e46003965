/* test_threshold.c: Tests the secants that find the value of a key at which an excess changes its sign. */
#include <math.h>
#include <string.h>

#include "near.h"
#include "study/threshold.h"

/* An excess over a key, the error that is claimed for it, and the range without a steady state. */
struct curve {
    double (*excess)(double value);
    double error, hole[2];
    int calls;
};

static enum status find(void *data, struct threshold_point *point, const struct threshold_point *const nearest[2]) {
    struct curve *const curve = data;
    (void)nearest;
    curve->calls++;
    if (point->value > curve->hole[0] && point->value < curve->hole[1]) return status_fail(STATUS_SOLVER, "a hole");
    point->excess = curve->excess(point->value);
    point->error = curve->error;
    return STATUS_OK;
}

static enum status solve(struct arena *arena, struct curve *curve, double from, double to,
                         struct threshold_search *search, struct threshold *found) {
    *search = (struct threshold_search){.from = from, .to = to, .find = find, .data = curve};
    return threshold_solve(arena, search, found);
}

/* cos x - x, whose zero is the Dottie number. */
static double dottie(double x) {
    return cos(x) - x;
}

static double steep(double x) {
    return exp(-10 * x) - 0.01;
}

static double parabola(double x) {
    return 1 + x * x;
}

/* Two lines that do not meet at 0.6. */
static double broken(double x) {
    return x < 0.6 ? -0.1 - 0.1 * x : 1 + 0.1 * x;
}

/* The same with a side that is close to 0, as measured for three plates in line. */
static double broken_near(double x) {
    return x < 0.6 ? -0.064 - 0.007 * x : 0.748;
}

/* Deterministic noise of the given size around a line with the zero 0.4. */
static double noisy(double x) {
    return x - 0.4 + 0.01 * sin(1e5 * x);
}

TEST(secants_find_a_zero_from_both_sides) {
    ARENA(arena, NULL, "a test");
    struct threshold_search search;
    struct threshold found;
    struct curve curve = {.excess = dottie};
    const double dottie_number = 0.739085133215161;
    assert_int_equal(solve(arena, &curve, 0, 2, &search, &found), STATUS_OK);
    NEAR(found.value, dottie_number, found.bar, 0);
    assert_true(found.bar < 1e-3);
    assert_true(found.below_above[0].excess > 0 && found.below_above[1].excess < 0);
    assert_int_equal(solve(arena, &curve, 2, 0, &search, &found), STATUS_OK);
    NEAR(found.value, dottie_number, found.bar, 0);
    assert_true(found.below_above[0].value < found.below_above[1].value);
}

TEST(a_side_that_stays_does_not_slow_the_secants_down) {
    ARENA(arena, NULL, "a test");
    struct threshold_search search;
    struct threshold found;
    struct curve curve = {.excess = steep};
    assert_int_equal(solve(arena, &curve, 0, 2, &search, &found), STATUS_OK);
    NEAR(found.value, log(100) / 10, found.bar, 0);
    assert_true(curve.calls < 16);  // regula falsi alone: hundreds
}

TEST(the_error_of_the_excess_gives_the_bar_and_ends_the_search) {
    ARENA(arena, NULL, "a test");
    struct threshold_search search;
    struct threshold found;
    struct curve curve = {.excess = dottie, .error = 0.02};
    const double slope = -1 - sin(0.739085133215161);
    assert_int_equal(solve(arena, &curve, 0, 2, &search, &found), STATUS_OK);
    NEAR(found.slope, slope, 0.2, 0);
    NEAR(found.by_error, 0.02 / fabs(found.slope), 1e-15, 0);
    NEAR(found.bar, found.by_error + found.by_secant, 1e-15, 0);
    NEAR(found.value, 0.739085133215161, found.bar, 0);
    assert_true(curve.calls <= 6);
}

TEST(noise_within_its_error_leaves_the_zero_within_the_bar) {
    ARENA(arena, NULL, "a test");
    struct threshold_search search;
    struct threshold found;
    struct curve curve = {.excess = noisy, .error = 0.01};
    assert_int_equal(solve(arena, &curve, 0, 1, &search, &found), STATUS_OK);
    NEAR(found.value, 0.4, found.bar, 0);
    NEAR(found.slope, 1, 0.3, 0);
}

TEST(a_failed_step_is_halved_and_the_failure_is_kept) {
    ARENA(arena, NULL, "a test");
    struct threshold_search search;
    struct threshold found;
    struct curve curve = {.excess = dottie, .hole = {0.9, 3}};
    assert_int_equal(solve(arena, &curve, 0, 2, &search, &found), STATUS_OK);
    NEAR(found.value, 0.739085133215161, found.bar, 0);
    assert_true(search.point[2].is_failure && isnan(search.point[2].excess));

    // the way ends at the hole
    curve.hole[0] = 0.5;
    assert_int_equal(solve(arena, &curve, 0, 2, &search, &found), STATUS_SOLVER);
    assert_string_equal(status_message(), "a hole");
    assert_true(search.n > 2);
}

TEST(without_a_change_of_sign_there_is_no_threshold) {
    ARENA(arena, NULL, "a test");
    struct threshold_search search;
    struct threshold found;
    struct curve curve = {.excess = parabola};
    assert_int_equal(solve(arena, &curve, 0, 2, &search, &found), STATUS_SOLVER);
    assert_non_null(strstr(status_message(), "unstable at both"));
    assert_int_equal(solve(arena, &curve, -1, 1, &search, &found), STATUS_SOLVER);
    assert_non_null(strstr(status_message(), "no effect"));

    // an end within its error is no certain side
    curve = (struct curve){.excess = dottie, .error = 0.1};
    assert_int_equal(solve(arena, &curve, 0, 0.7, &search, &found), STATUS_SOLVER);
    assert_non_null(strstr(status_message(), "move this end outwards"));
}

TEST(a_jump_is_no_threshold) {
    ARENA(arena, NULL, "a test");
    struct threshold_search search;
    struct threshold found;
    struct curve curve = {.excess = broken, .error = 0.01};
    assert_int_equal(solve(arena, &curve, 0, 1, &search, &found), STATUS_SOLVER);
    assert_non_null(strstr(status_message(), "jumps between 0.5999"));
    assert_true(curve.calls < 25);
    curve = (struct curve){.excess = broken_near, .error = 0.007};
    assert_int_equal(solve(arena, &curve, 0, 1, &search, &found), STATUS_SOLVER);
    assert_non_null(strstr(status_message(), "jumps between 0.5999"));
    assert_true(curve.calls < 25);
}

TEST(errors_larger_than_the_differences_leave_it_undecided) {
    ARENA(arena, NULL, "a test");
    struct threshold_search search;
    struct threshold found;
    struct curve curve = {.excess = dottie, .error = 5};
    assert_int_equal(solve(arena, &curve, 0, 2, &search, &found), STATUS_SOLVER);
    assert_non_null(strstr(status_message(), "undecided"));
}
