/* test_threshold.c: Tests the secants that find the value of a key at which an excess changes its sign. */
#include <math.h>
#include <string.h>

#include "near.h"
#include "study/threshold.h"

/* An excess along a line, and the error that is claimed for it. */
struct curve {
    double (*excess)(double at);
    double error;
    int calls;
};

static enum status find(void *data, struct threshold_point *point) {
    struct curve *const curve = data;
    curve->calls++;
    if (!curve->excess) return status_fail(STATUS_SOLVER, "a hole");
    point->excess = curve->excess(point->at);
    point->error = curve->error;
    return STATUS_OK;
}

static double bar(const struct threshold *found) {
    return found->by_error + found->by_secant;
}

/* Solve between two places. */
static enum status solve(struct arena *arena, struct curve *curve, double from, double to, struct threshold *found) {
    struct threshold_search search = {.shortest = 1e-4 * fabs(to - from), .find = find, .data = curve, .n = 2};
    NEW(arena, search.point, 2);
    search.point[0].at = from;
    search.point[1].at = to;
    for (int i = 0; i < 2; i++) assert_int_equal(find(curve, &search.point[i]), STATUS_OK);
    return threshold_solve(arena, &search, 0, 1, found);
}

/* cos x - x, whose zero is the Dottie number. */
static double dottie(double x) {
    return cos(x) - x;
}

static double steep(double x) {
    return exp(-10 * x) - 0.01;
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
    struct threshold found;
    struct curve curve = {.excess = dottie};
    const double dottie_number = 0.739085133215161;
    assert_int_equal(solve(arena, &curve, 0, 2, &found), STATUS_OK);
    NEAR(found.at, dottie_number, bar(&found), 0);
    assert_true(bar(&found) < 1e-3);
    assert_true(found.slope < 0);
    assert_int_equal(solve(arena, &curve, 2, 0, &found), STATUS_OK);
    NEAR(found.at, dottie_number, bar(&found), 0);
}

TEST(a_side_that_stays_does_not_slow_the_secants_down) {
    ARENA(arena, NULL, "a test");
    struct threshold found;
    struct curve curve = {.excess = steep};
    assert_int_equal(solve(arena, &curve, 0, 2, &found), STATUS_OK);
    NEAR(found.at, log(100) / 10, bar(&found), 0);
    assert_true(curve.calls < 16);  // regula falsi alone: hundreds
}

TEST(the_error_of_the_excess_gives_the_bar_and_ends_the_search) {
    ARENA(arena, NULL, "a test");
    struct threshold found;
    struct curve curve = {.excess = dottie, .error = 0.02};
    const double slope = -1 - sin(0.739085133215161);
    assert_int_equal(solve(arena, &curve, 0, 2, &found), STATUS_OK);
    NEAR(found.slope, slope, 0.2, 0);
    NEAR(found.by_error, 0.02 / fabs(found.slope), 1e-15, 0);
    NEAR(found.at, 0.739085133215161, bar(&found), 0);
    assert_true(curve.calls <= 6);
}

TEST(noise_within_its_error_leaves_the_zero_within_the_bar) {
    ARENA(arena, NULL, "a test");
    struct threshold found;
    struct curve curve = {.excess = noisy, .error = 0.01};
    assert_int_equal(solve(arena, &curve, 0, 1, &found), STATUS_OK);
    NEAR(found.at, 0.4, bar(&found), 0);
    NEAR(found.slope, 1, 0.3, 0);
}

TEST(a_failure_ends_the_search) {
    ARENA(arena, NULL, "a test");
    struct curve curve = {.excess = NULL};
    struct threshold_search search = {.shortest = 1e-4, .find = find, .data = &curve, .n = 2};
    struct threshold found;
    NEW(arena, search.point, 2);
    search.point[0] = (struct threshold_point){.at = 0, .excess = -1};
    search.point[1] = (struct threshold_point){.at = 1, .excess = 2};
    assert_int_equal(threshold_solve(arena, &search, 0, 1, &found), STATUS_SOLVER);
    assert_string_equal(status_message(), "a hole");
    assert_int_equal(curve.calls, 1);
}

TEST(a_jump_is_no_threshold) {
    ARENA(arena, NULL, "a test");
    struct threshold found;
    struct curve curve = {.excess = broken, .error = 0.01};
    assert_int_equal(solve(arena, &curve, 0, 1, &found), STATUS_SOLVER);
    assert_non_null(strstr(status_message(), "jumps there"));
    assert_true(curve.calls < 25);
    curve = (struct curve){.excess = broken_near, .error = 0.007};
    assert_int_equal(solve(arena, &curve, 0, 1, &found), STATUS_SOLVER);
    assert_non_null(strstr(status_message(), "jumps there"));
    assert_true(curve.calls < 25);
}

TEST(errors_larger_than_the_differences_leave_it_undecided) {
    ARENA(arena, NULL, "a test");
    struct threshold found;
    struct curve curve = {.excess = dottie, .error = 5};
    assert_int_equal(solve(arena, &curve, 0, 2, &found), STATUS_SOLVER);
    assert_non_null(strstr(status_message(), "undecided"));
}
