/* test_convergence.c: Tests the rule that finds the error of a value from its levels. The sequences are steady speeds
 * [m s-1] and costs of transport [m s-2] of the default fish, measured with several forms of the tail. */
#include <math.h>
#include <string.h>

#include "near.h"
#include "study/convergence.h"

enum { MOST = 6 };

/* A key with levels as numbers of points, from fine to coarse, or as sizes for numbers below 1. */
struct key {
    int n, base;
    double level[MOST], design;
    const char *objection;
};

/* Judge one quantity at the levels of a key; reason: (CONVERGENCE_BYTES) or NULL. */
static struct convergence_result judge_with(const struct key *key, const double *values, double noise, char *reason) {
    double size[MOST], value[MOST][2] = {{0}};
    for (int i = 0; i < key->n; i++) {
        size[i] = key->level[i] < 1 ? key->level[i] : 1 / (key->level[i] - 1);
        value[i][0] = values[i];
    }
    const struct convergence_levels levels = {.n = key->n,
                                              .n_judged = CONVERGENCE_LEVELS,
                                              .base = key->base,
                                              .size = size,
                                              .design_order = key->design,
                                              .objection = key->objection};
    const struct convergence_result result = convergence_judge(&levels, (const double(*)[2])value, noise);
    if (reason) convergence_reason(&levels, &result, key->level, reason);
    return result;
}

static struct convergence_result judge(const struct key *key, const double *values, double noise) {
    return judge_with(key, values, noise, NULL);
}

/* A cubic through (0, 2), with the derivative 3 there: d ln f/d ln p is 1.5. */
static double cubic(double x) {
    return 2 + 3 * x - 4 * x * x + 5 * x * x * x;
}

TEST(a_derivative_is_exact_for_a_cubic_and_its_error_is_the_third_order) {
    const double both[] = {-0.08, -0.04, 0, 0.04, 0.08}, below[] = {-0.16, -0.08, -0.04, 0};
    double value[5];
    for (int i = 0; i < 5; i++) value[i] = cubic(both[i]);
    struct convergence_slope slope = convergence_find_slope(5, both, value, 2, 0);
    NEAR(slope.value, 1.5, 0, 1e-12);
    NEAR(slope.error, 5 * 0.04 * 0.04 / 2, 0, 1e-12);  // the central difference of the smaller step
    for (int i = 0; i < 4; i++) value[i] = cubic(below[i]);
    slope = convergence_find_slope(4, below, value, 3, 0);
    NEAR(slope.value, 1.5, 0, 1e-12);
    NEAR(slope.error, 5 * 0.04 * 0.08 / 2, 0, 1e-12);  // the parabola through 0, h and 2 h
}

TEST(a_derivative_has_the_noise_of_its_values_over_the_step) {
    const double step[] = {-0.08, -0.04, 0, 0.04, 0.08}, line[] = {0.92, 0.96, 1, 1.04, 1.08};
    const struct convergence_slope slope = convergence_find_slope(5, step, line, 2, 1e-5);
    // the weights are 1/(12 h) and 8/(12 h)
    NEAR(slope.error, 1e-5 / (12 * 0.04) * sqrt(2 * (8 * 8 * (1 + 0.04 * 0.04) + 1 + 0.08 * 0.08)), 1e-9, 0);
    assert_true(isnan(convergence_find_slope(2, step, line, 1, 0).value));
    const double missing[] = {0.92, 0.96, 1, NAN, 1.08};
    assert_true(isnan(convergence_find_slope(5, step, missing, 2, 0).value));
}

static void verdict_is(enum convergence_verdict got, enum convergence_verdict want) {
    if (got != want) fail_msg("got '%s', want '%s'", convergence_words(got), convergence_words(want));
}

TEST(orders_of_powers_are_found) {
    const double halved[] = {0.05, 0.1, 0.2}, uneven[] = {0.07, 0.1, 0.25}, orders[] = {1, 2, 2.5, 4};
    for (int i = 0; i < 4; i++) {
        double one[3][2], other[3][2];
        for (int k = 0; k < 3; k++) {
            for (int xy = 0; xy < 2; xy++) {
                one[k][xy] = 3 + (0.7 - 0.9 * xy) * pow(halved[k], orders[i]);
                other[k][xy] = 3 + (0.7 - 0.9 * xy) * pow(uneven[k], orders[i]);
            }
        }
        // differences of 1e-6 of the values, at order 4, lose ten digits of sixteen
        NEAR(convergence_order(halved, (const double(*)[2])one), orders[i], 0, 1e-8);
        NEAR(convergence_order(uneven, (const double(*)[2])other), orders[i], 0, 1e-8);
    }
    // Celik et al., Journal of Fluids Engineering 130 (2008) 078001, table 1, first column: 1.53
    const double sizes[] = {1, 1.5, 1.5 * 4 / 3}, values[][2] = {{6.063, 0}, {5.972, 0}, {5.863, 0}};
    NEAR(convergence_order(sizes, values), 1.53, 0.01, 0);
    const double same[][2] = {{6.063, 0}, {6.063, 0}, {5.863, 0}};
    assert_true(isnan(convergence_order(sizes, same)));
}

/* f = 2 + 0.3 h^2: the finest error is 1.25 times the true error, and the base adds the distance from the finest
 * level. */
TEST(a_power_is_accepted_and_its_error_is_that_of_richardson) {
    const struct key key = {4, 1, {0.05, 0.1, 0.2, 0.4}, 2, NULL};
    double value[4];
    for (int i = 0; i < 4; i++) value[i] = 2 + 0.3 * key.level[i] * key.level[i];
    const struct convergence_result result = judge(&key, value, 1e-9);
    verdict_is(result.verdict, CONVERGENCE_ACCEPTED);
    NEAR(result.order, 2, 1e-9, 0);
    NEAR(result.coarse_order, 2, 1e-9, 0);
    NEAR(result.finest_error, 1.25 * 0.3 * 0.0025, 0, 1e-9);
    NEAR(result.error, 1.25 * 0.3 * 0.0025 + 0.3 * (0.01 - 0.0025), 0, 1e-9);
}

/* The stated value is coarser than all judged levels: the error is the distance from the limit of the finest four. */
TEST(a_stated_value_beyond_the_judged_levels_counts_with_its_distance) {
    const struct key key = {6, 5, {0.1, 0.2, 0.4, 0.8, 1.6, 3.2}, 2, NULL};
    double value[6], turning[6];
    for (int i = 0; i < 6; i++) value[i] = turning[i] = 2 + 0.3 * key.level[i] * key.level[i];
    const struct convergence_result result = judge(&key, value, 1e-9);
    verdict_is(result.verdict, CONVERGENCE_ACCEPTED);
    NEAR(result.error, 1.25 * 0.3 * 0.01 + 0.3 * (10.24 - 0.01), 0, 1e-9);

    // flagged levels: the distance from the finest one, and the larger of the two finest differences
    turning[1] = 1.9;
    verdict_is(judge(&key, turning, 1e-9).verdict, CONVERGENCE_TURNS);
    NEAR(judge(&key, turning, 1e-9).error, 0.3 * (10.24 - 0.01) + 0.3 * 0.16 + 0.1, 0, 1e-12);
}

/* Half an order above the design order is accepted, with the design order; more is an accident of the finest
 * difference: the larger of the two finest differences is the error. */
TEST(an_order_far_above_the_design_order_is_flagged) {
    char reason[CONVERGENCE_BYTES];
    const struct key near = {4, 1, {0.05, 0.1, 0.2, 0.4}, 2, NULL};
    const double accepted[] = {2, 2.01, 2.065, 2.35};  // orders 2.46 and 2.37
    NEAR(judge(&near, accepted, 1e-9).order, log2(5.5), 1e-9, 0);
    verdict_is(judge(&near, accepted, 1e-9).verdict, CONVERGENCE_ACCEPTED);
    NEAR(judge(&near, accepted, 1e-9).error, 1.25 * 0.01 / 3 + 0.01, 1e-12, 0);

    // 7, 13, 25 and 49 nodes of a run of 3 s: 193 nodes have 0.842587, 1.27e-4 from 49 nodes
    const struct key key = {4, 0, {49, 25, 13, 7}, 2, NULL}, coarse = {4, 3, {49, 25, 13, 7}, 2, NULL};
    const double speed[] = {0.842714, 0.842639, 0.835444, 0.794489};
    const struct convergence_result result = judge_with(&key, speed, 1e-7, reason);
    verdict_is(result.verdict, CONVERGENCE_HIGH);
    NEAR(result.order, 6.6, 0.05, 0);
    NEAR(result.error, 0.842639 - 0.835444, 1e-12, 0);
    assert_string_equal(reason, "the order is more than 0.5 above the design order, 2: 6.6 from 13 to 49");

    // a coarser stated value adds its distance from the finest level
    NEAR(judge(&coarse, speed, 1e-7).error, 0.842714 - 0.794489 + 0.842639 - 0.835444, 1e-9, 0);

    // equal finest levels have an infinite order
    const double equal[] = {1, 1, 1.1, 1.5};
    verdict_is(judge(&key, equal, 1e-7).verdict, CONVERGENCE_HIGH);
    NEAR(judge(&key, equal, 1e-7).error, 0.1, 1e-12, 0);
}

/* f = 2 + 0.3 h^2 + h^4, with a design order of 1: the orders stay above it. What remains beyond the finest level is
 * between nothing and Richardson's estimate with the design order. */
TEST(a_steady_order_above_the_design_order_bounds_what_remains) {
    for (int base = 2; base < 4; base++) {
        const struct key key = {4, base, {0.05, 0.1, 0.2, 0.4}, 1, NULL};
        double value[4];
        for (int i = 0; i < 4; i++) value[i] = 2 + 0.3 * pow(key.level[i], 2) + pow(key.level[i], 4);
        const struct convergence_result result = judge(&key, value, 1e-9);
        const double d_0 = value[1] - value[0], of_base = value[base] - value[0];
        verdict_is(result.verdict, CONVERGENCE_HIGH);
        NEAR(result.shift, -(of_base + d_0 / 2), 1e-12, 0);
        NEAR(result.spread, 0.75 * d_0, 1e-12, 0);
        NEAR(result.error, of_base + 1.25 * d_0, 1e-12, 0);
        NEAR(result.finest_error, 1.25 * d_0, 1e-12, 0);
        BELOW(fabs(value[base] + result.shift - 2), result.spread);
    }
}

/* A Strouhal number whose finest levels differ by 0.0016: Richardson with order 0.09 gave an error of 0.032. */
TEST(an_order_below_half_of_the_design_order_is_flagged) {
    char reason[CONVERGENCE_BYTES];
    const struct key key = {4, 0, {0.01, 0.02, 0.04, 0.08}, 1, NULL};
    const double strouhal[] = {0.2856, 0.2872, 0.2889, 0.2908};
    const struct convergence_result result = judge_with(&key, strouhal, 1e-7, reason);
    verdict_is(result.verdict, CONVERGENCE_LOW);
    NEAR(result.error, 0.2908 - 0.2856, 1e-12, 0);
    assert_string_equal(reason, "the order is below half of the design order, 1: 0.087 from 0.04 to 0.01");
}

TEST(three_levels_without_a_finer_one_have_wider_bounds) {
    const struct key key = {3, 0, {25, 17, 13}, 2, NULL};
    const double accepted[] = {0.9364, 0.9297, 0.9205}, low[] = {0.9364, 0.9297, 0.9240};
    const struct convergence_result result = judge(&key, accepted, 3e-5);
    verdict_is(result.verdict, CONVERGENCE_ACCEPTED);
    assert_true(isnan(result.coarse_order));
    NEAR(result.error, 1.25 * 0.0067 / (pow(1.5, fmin(2, result.order)) - 1), 1e-9, 0);
    verdict_is(judge(&key, low, 3e-5).verdict, CONVERGENCE_LOW);
    NEAR(judge(&key, low, 3e-5).error, 1.5 * (0.9364 - 0.9240), 1e-12, 0);
}

/* A tail that ends in a cusp: no limit. The grid convergence index of 9, 17 and 33 nodes was 0.005 m/s. */
TEST(a_sequence_that_goes_on_is_flagged) {
    char reason[CONVERGENCE_BYTES];
    const struct key four = {4, 0, {65, 33, 17, 9}, 2, NULL}, three = {3, 0, {33, 17, 9}, 2, NULL};
    const double from_rest[] = {0.3697, 0.7881, 0.8092, 0.9415}, cost[] = {0.152, 0.110, 0.157};
    const struct convergence_result result = judge_with(&four, from_rest, 3e-5, reason);
    verdict_is(result.verdict, CONVERGENCE_GROWS);
    NEAR(result.error, 0.57, 0.005, 0);
    assert_true(isnan(result.finest_error));
    assert_string_equal(reason, "differences do not fall from 17 over 33 to 65");
    verdict_is(judge_with(&three, cost, 3e-5, reason).verdict, CONVERGENCE_TURNS);
    assert_string_equal(reason, "differences change sign at 17");
}

TEST(what_is_known_before_flags_whatever_the_levels_say) {
    char reason[CONVERGENCE_BYTES];
    const struct key key = {3, 0, {33, 17, 9}, 2, "the tail ends in a cusp"};
    const double speed[] = {0.8142, 0.8731, 1.029};
    const struct convergence_result result = judge_with(&key, speed, 3e-5, reason);
    verdict_is(result.verdict, CONVERGENCE_OBJECTION);
    NEAR(result.error, 0.32, 0.005, 0);
    assert_string_equal(reason, key.objection);
}

/* Sheet points with `force: pressure`: the changes grow, -0.11 % and -0.13 %, towards a limit of about -0.4 %, which
 * the largest difference alone does not reach. */
TEST(differences_that_do_not_fall_are_flagged) {
    const struct key key = {3, 2, {97, 69, 49}, 1, NULL};
    const double speed[] = {1.0056 * (1 - 0.0024), 1.0056 * (1 - 0.0011), 1.0056};
    const struct convergence_result result = judge(&key, speed, 3e-5);
    verdict_is(result.verdict, CONVERGENCE_GROWS);
    NEAR(result.error, 2 * 0.0024, 0.0001, 0);
    ABOVE(result.error, 0.004 * 1.0056);
}

TEST(differences_below_the_noise_are_none) {
    const struct key key = {3, 1, {1e-6, 1e-5, 1e-4}, 1, NULL};
    const double speed[] = {0.93640, 0.93641, 0.93639};
    const struct convergence_result result = judge(&key, speed, 2.5e-5);
    verdict_is(result.verdict, CONVERGENCE_NONE);
    NEAR(result.shift, -1e-5, 0, 1e-6);  // to the finer level: the coarser one is no error of the stated one
    NEAR(result.spread, 1e-5, 0, 1e-6);
    NEAR(result.error, 2e-5, 0, 1e-6);
    verdict_is(judge(&key, speed, 1e-6).verdict, CONVERGENCE_TURNS);
    NEAR(judge(&key, speed, 1e-6).error, 2e-5, 0, 1e-6);  // a tenth of the tolerance, doubled
    // a difference of 2e-5 in 0.94 against three times the noise
    verdict_is(judge(&key, speed, 0.75e-5).verdict, CONVERGENCE_NONE);
    verdict_is(judge(&key, speed, 0.69e-5).verdict, CONVERGENCE_TURNS);
}

/* f = 2 + 0.3 h^2 leads to 2, from any stated level; Richardson's estimate has an uncertainty of a quarter. */
TEST(an_accepted_sequence_knows_where_it_leads) {
    for (int base = 0; base < 4; base++) {
        const struct key key = {4, base, {0.05, 0.1, 0.2, 0.4}, 2, NULL};
        double value[4];
        for (int i = 0; i < 4; i++) value[i] = 2 + 0.3 * key.level[i] * key.level[i];
        const struct convergence_result result = judge(&key, value, 1e-9);
        NEAR(value[base] + result.shift, 2, 1e-12, 0);
        NEAR(result.spread, 0.25 * 0.3 * 0.0025, 1e-12, 0);
        NEAR(fabs(result.shift) + result.spread, result.error, 1e-12, 0);
    }
}

/* Without an order the value is expected at the finest level, to the differences of the finest levels. */
TEST(a_flagged_sequence_leads_to_its_finest_level) {
    const double value[] = {1.03, 1.01, 1.04, 1.2};
    const struct key fine = {4, 2, {0.01, 0.02, 0.04, 0.08}, 1, NULL},
                     finest = {4, 0, {0.01, 0.02, 0.04, 0.08}, 1, NULL};
    struct convergence_result result = judge(&fine, value, 1e-9);
    verdict_is(result.verdict, CONVERGENCE_TURNS);
    NEAR(result.shift, -0.01, 1e-12, 0);
    NEAR(result.spread, 0.03, 1e-12, 0);
    NEAR(result.error, 0.04, 1e-12, 0);

    // without a finer level every level counts
    result = judge(&finest, value, 1e-9);
    NEAR(result.shift, 0, 0, 0);
    NEAR(result.error, 0.17, 1e-12, 0);
    NEAR(result.spread, 0.17, 1e-12, 0);
}

TEST(orders_decide) {
    // differences 1, 2, 4 and so on at halved spacings: orders p, p' by log2 of the ratios
    const struct {
        double differences[3], design;
        enum convergence_verdict verdict;
    } examples[] = {
        {{1, 4, 16}, 2, CONVERGENCE_ACCEPTED},       // 2, 2
        {{1, 2.01, 4.05}, 2, CONVERGENCE_ACCEPTED},  // 1.01, 1.01: at least half
        {{1, 1.9, 3.8}, 2, CONVERGENCE_LOW},         // 0.93, 1
        {{1, 4, 7.5}, 2, CONVERGENCE_LOW},           // 2, 0.91
        {{1, 1.42, 2.02}, 1, CONVERGENCE_ACCEPTED},  // 0.51, 0.51
        {{1, 1.41, 2.02}, 1, CONVERGENCE_LOW},       // 0.496, 0.52
        {{1, 4, 28}, 2, CONVERGENCE_CHANGES},        // 2, 2.81
        {{1, 4, 27}, 2, CONVERGENCE_ACCEPTED},       // 2, 2.75
        {{1, 5.65, 24}, 2, CONVERGENCE_ACCEPTED},    // 2.498, 2.09: at most 0.5 above
        {{1, 5.66, 24}, 2, CONVERGENCE_HIGH},        // 2.501
        {{1, 2.84, 6}, 1, CONVERGENCE_HIGH},         // 1.506
        {{0, 4, 16}, 2, CONVERGENCE_HIGH},           // equal to rounding
        {{1, 4, 16}, NAN, CONVERGENCE_NO_ORDER},    {{1, 1, 4}, 2, CONVERGENCE_GROWS},
        {{1, 4, 3}, 2, CONVERGENCE_GROWS},          {{1, 0, 3}, 2, CONVERGENCE_GROWS},
        {{1, -4, 16}, 2, CONVERGENCE_TURNS},        {{1, 4, -16}, 2, CONVERGENCE_TURNS},
        {{1, 4, NAN}, 2, CONVERGENCE_UNKNOWN},
    };
    for (size_t i = 0; i < sizeof examples / sizeof *examples; i++) {
        const struct key key = {4, 0, {0.1, 0.2, 0.4, 0.8}, examples[i].design, NULL};
        double value[4] = {100};
        for (int k = 0; k < 3; k++) value[k + 1] = value[k] + examples[i].differences[k];
        char reason[CONVERGENCE_BYTES];
        const struct convergence_result result = judge_with(&key, value, 1e-9, reason);
        if (result.verdict != examples[i].verdict) fail_msg("example %zu: %s", i, convergence_words(result.verdict));
        assert_int_equal(*reason != '\0', convergence_is_flagged(result.verdict));
        // the largest difference counts once with four levels
        if (convergence_is_flagged(result.verdict) && result.verdict < CONVERGENCE_HIGH) {
            NEAR(result.error, fabs(value[3] - value[0]), 0, 1e-12);
        }
    }
}

/* Levels of 9, 11, 17 and 24 nodes: the difference from 11 to 17 is larger than from 9 to 11, also at order 2. */
TEST(uneven_levels_are_judged_by_their_spacings) {
    const struct key key = {4, 1, {24, 17, 11, 9}, 2, NULL};
    double value[4];
    for (int i = 0; i < 4; i++) value[i] = 2 + 0.3 / pow(key.level[i] - 1, 2);
    ABOVE(value[2] - value[1], value[3] - value[2]);
    const struct convergence_result result = judge(&key, value, 1e-9);
    verdict_is(result.verdict, CONVERGENCE_ACCEPTED);
    NEAR(result.coarse_order, 2, 1e-9, 0);
}

TEST(a_missing_level_leaves_the_error_unknown) {
    const struct key key = {4, 1, {35, 25, 17, 13}, 2, "even where it is flagged before"};
    const double cost[] = {NAN, 0.0728, 0.0720, 0.0708};
    const struct convergence_result result = judge(&key, cost, 3e-5);
    verdict_is(result.verdict, CONVERGENCE_UNKNOWN);
    assert_true(isnan(result.error));
}

TEST(two_levels_give_the_difference_with_a_wide_bound) {
    const struct key base = {2, 0, {1e-5, 1e-4}, 1, NULL}, confirmed = {2, 1, {1e-6, 1e-5}, 1, NULL};
    const double speed[] = {1, 1.01};
    verdict_is(judge(&base, speed, 1e-5).verdict, CONVERGENCE_FEW);
    NEAR(judge(&base, speed, 1e-5).error, 0.015, 1e-12, 0);
    NEAR(judge(&confirmed, speed, 1e-5).error, 0.02, 1e-12, 0);
}

TEST(of_many_levels_the_finest_four_count) {
    const struct key key = {6, 0, {0.1, 0.2, 0.4, 0.8, 1.6, 3.2}, 2, NULL};
    const double value[] = {1.01, 1.04, 1.16, 1.64, 0.2, 70};
    const struct convergence_result result = judge(&key, value, 1e-9);
    verdict_is(result.verdict, CONVERGENCE_ACCEPTED);
    NEAR(result.error, 1.25 * 0.01, 0, 1e-9);
}

/* A point in the plane: the differences are vectors. */
TEST(points_are_judged_by_the_angle_between_differences) {
    const double size[] = {0.1, 0.2, 0.4};
    const double straight[][2] = {{1, 1}, {1, 1.3}, {0.5, 2.1}}, back[][2] = {{1, 1}, {1, 1.3}, {1.9, 1}};
    const struct convergence_levels levels = {
        .n = 3, .n_judged = CONVERGENCE_LEVELS, .size = size, .design_order = 1.5};
    const struct convergence_result result = convergence_judge(&levels, straight, 1e-9);
    verdict_is(result.verdict, CONVERGENCE_ACCEPTED);
    NEAR(result.order, log2(hypot(0.5, 0.8) / 0.3), 1e-9, 0);
    verdict_is(convergence_judge(&levels, back, 1e-9).verdict, CONVERGENCE_TURNS);
}

/* Steady speed and cost over the nodes, of fish with other moduli and tails; the limits come from 49 nodes and from
 * extrapolation. A stated error has to cover the distance from the limit. */
TEST(errors_cover_the_limits_of_tails_with_a_floor) {
    enum { N = 7 };
    static const double nodes[N] = {9, 13, 17, 21, 25, 33, 49};
    static const struct {
        double speed[N], cost[N], limit[2];
    } bodies[] = {
        {{.8695, .9155, .9297, .9347, .9364, .9372, .9372},
         {.0687, .0708, .0720, .0725, .0728, .0729, .0730},
         {.9372, .0730}},
        {{.852, .900, .915, .9205, .9231, .9252, .9263},
         {.0582, .0595, .0606, .0612, .0615, .0618, .0620},
         {.9272, .0622}},
        {{.757, .790, .815, .830, .837, .842, .842}, {.103, .0865, .0821, .0812, .0808, .0805, .0802}, {.843, .080}},
    };
    static const struct {
        int n, base, level[4];
    } plans[] = {{4, 1, {5, 4, 2, 1}}, {3, 0, {4, 2, 1}}, {4, 1, {6, 5, 4, 2}}};
    for (int b = 0; b < 3; b++) {
        for (int p = 0; p < 3; p++) {
            struct key key = {plans[p].n, plans[p].base, {0}, 2, NULL};
            double speed[4], cost[4];
            for (int i = 0; i < key.n; i++) {
                key.level[i] = nodes[plans[p].level[i]];
                speed[i] = bodies[b].speed[plans[p].level[i]];
                cost[i] = bodies[b].cost[plans[p].level[i]];
            }
            const double of_speed = fabs(speed[key.base] - bodies[b].limit[0]);
            const double of_cost = fabs(cost[key.base] - bodies[b].limit[1]);
            const double bars[] = {judge(&key, speed, 3e-5).error, judge(&key, cost, 3e-5).error};
            if (bars[0] < of_speed) fail_msg("body %d, plan %d: speed %g +- %g", b, p, of_speed, bars[0]);
            if (bars[1] < of_cost) fail_msg("body %d, plan %d: cost %g +- %g", b, p, of_cost, bars[1]);
        }
    }
}
