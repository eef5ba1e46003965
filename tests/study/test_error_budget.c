/* test_error_budget.c: errors of a value by levels of refinement. The sequences are steady speeds [m s-1] and costs of
 * transport [m s-2] of the default fish, measured with several forms of the tail. */
#include <string.h>

#include "near.h"
#include "study/error_budget.h"

enum { MOST = 6, SPEED = 0, COST = 1 };

/* A key with levels as numbers of points, from fine to coarse, or as sizes for numbers below 1. */
struct key {
    int n, base;
    double level[MOST];
    double design;
    const char *objection;
};

struct judged {
    enum error_budget_verdict verdict;
    int culprit;
    struct error_budget_result of[2];
};

/* Judge speed and, if given, cost at the levels of a key. */
static struct judged judge(const struct key *key, const double *speed, const double *cost, double noise) {
    double size[MOST], value[2][MOST][2] = {{{0}}};
    for (int i = 0; i < key->n; i++) {
        size[i] = key->level[i] < 1 ? key->level[i] : 1 / (key->level[i] - 1);
        value[SPEED][i][0] = speed[i];
        value[COST][i][0] = cost ? cost[i] : 0;
    }
    const struct error_budget_levels levels = {key->n, key->base, size, key->design, key->objection};
    const struct error_budget_sequence sequences[] = {{(const double(*)[2])value[SPEED], noise},
                                                      {(const double(*)[2])value[COST], noise}};
    struct judged judged;
    judged.verdict = error_budget_judge(&levels, cost ? 2 : 1, sequences, judged.of, &judged.culprit);
    return judged;
}

static void orders_of_powers_are_found(void **state) {
    (void)state;
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
        NEAR(error_budget_order(halved, (const double(*)[2])one), orders[i], 0, 1e-8);
        NEAR(error_budget_order(uneven, (const double(*)[2])other), orders[i], 0, 1e-8);
    }
    // Celik et al., Journal of Fluids Engineering 130 (2008) 078001, table 1, first column: 1.53
    const double sizes[] = {1, 1.5, 1.5 * 4 / 3}, values[][2] = {{6.063, 0}, {5.972, 0}, {5.863, 0}};
    NEAR(error_budget_order(sizes, values), 1.53, 0.01, 0);
    const double same[][2] = {{6.063, 0}, {6.063, 0}, {5.863, 0}};
    assert_true(isnan(error_budget_order(sizes, same)));
}

/* f = 2 + 0.3 h^2: the finest error is 1.25 times the true error, and the base adds the distance from the finest
 * level. */
static void a_power_is_accepted_and_its_error_is_that_of_richardson(void **state) {
    (void)state;
    const struct key key = {4, 1, {0.05, 0.1, 0.2, 0.4}, 2, NULL};
    double value[4];
    for (int i = 0; i < 4; i++) value[i] = 2 + 0.3 * key.level[i] * key.level[i];
    const struct judged judged = judge(&key, value, NULL, 1e-9);
    assert_int_equal(judged.verdict, ERROR_BUDGET_ACCEPTED);
    assert_int_equal(judged.culprit, -1);
    NEAR(judged.of[SPEED].order, 2, 1e-9, 0);
    NEAR(judged.of[SPEED].coarse_order, 2, 1e-9, 0);
    NEAR(judged.of[SPEED].finest_error, 1.25 * 0.3 * 0.0025, 0, 1e-9);
    NEAR(judged.of[SPEED].error, 1.25 * 0.3 * 0.0025 + 0.3 * (0.01 - 0.0025), 0, 1e-9);
}

static void an_order_above_the_design_order_is_not_used(void **state) {
    (void)state;
    // nodes 13, 17, 25, 35 of the default fish: order 5 in speed, where 2 is used
    const struct key key = {4, 1, {35, 25, 17, 13}, 2, NULL};
    const double speed[] = {0.93724, 0.9364, 0.9297, 0.9155}, cost[] = {0.072946, 0.07275, 0.07204, 0.07074};
    const struct judged judged = judge(&key, speed, cost, 3e-5);
    assert_int_equal(judged.verdict, ERROR_BUDGET_ACCEPTED);
    NEAR(judged.of[SPEED].order, 5, 0.2, 0);
    NEAR(judged.of[SPEED].error, 0.0019, 0.00005, 0);
    NEAR(judged.of[SPEED].finest_error, 0.0010, 0.00005, 0);
    NEAR(judged.of[COST].error, 0.00043, 0.00003, 0);
    // the limits, of 49 nodes and of Richardson's extrapolation from there
    assert_true(judged.of[SPEED].error > fabs(0.9364 - 0.9372) && judged.of[COST].error > fabs(0.07275 - 0.0730));
}

static void three_levels_without_a_finer_one_have_wider_bounds(void **state) {
    (void)state;
    const struct key key = {3, 0, {25, 17, 13}, 2, NULL};
    const double speed[] = {0.9364, 0.9297, 0.9155}, cost[] = {0.0728, 0.0720, 0.0708};
    const struct judged judged = judge(&key, speed, cost, 3e-5);
    assert_int_equal(judged.verdict, ERROR_BUDGET_ACCEPTED);
    NEAR(judged.of[SPEED].error, 0.007, 0.0005, 0);
    NEAR(judged.of[COST].error, 0.0008, 0.00005, 0);
    assert_true(isnan(judged.of[SPEED].coarse_order));
}

/* A tail that ends in a cusp: no limit. The grid convergence index of 9, 17 and 33 nodes was 0.005 m/s. */
static void a_sequence_that_goes_on_is_flagged(void **state) {
    (void)state;
    const struct key four = {4, 0, {65, 33, 17, 9}, 2, NULL}, three = {3, 0, {33, 17, 9}, 2, NULL};
    const double from_rest[] = {0.3697, 0.7881, 0.8092, 0.9415};
    const struct judged judged = judge(&four, from_rest, NULL, 3e-5);
    assert_int_equal(judged.verdict, ERROR_BUDGET_GROWS);
    NEAR(judged.of[SPEED].error, 0.57, 0.005, 0);
    assert_true(isnan(judged.of[SPEED].finest_error));

    // the speed alone would be accepted, with an order of 1.4; the cost turns
    const double speed[] = {0.8142, 0.8731, 1.029}, cost[] = {0.152, 0.110, 0.157};
    assert_int_equal(judge(&three, speed, NULL, 3e-5).verdict, ERROR_BUDGET_ACCEPTED);
    const struct judged both = judge(&three, speed, cost, 3e-5);
    assert_int_equal(both.verdict, ERROR_BUDGET_TURNS);
    assert_int_equal(both.culprit, COST);
    assert_int_equal(both.of[SPEED].verdict, ERROR_BUDGET_ACCEPTED);
    NEAR(both.of[SPEED].error, 0.32, 0.005, 0);
}

static void what_is_known_before_flags_whatever_the_levels_say(void **state) {
    (void)state;
    const struct key key = {3, 0, {33, 17, 9}, 2, "the tail ends in a cusp"};
    const double speed[] = {0.8142, 0.8731, 1.029};
    const struct judged judged = judge(&key, speed, NULL, 3e-5);
    assert_int_equal(judged.verdict, ERROR_BUDGET_OBJECTION);
    NEAR(judged.of[SPEED].error, 0.32, 0.005, 0);
}

/* Sheet points with `force: pressure`: the changes grow, -0.11 % and -0.13 %, towards a limit of about -0.4 %, which
 * the largest difference alone does not reach. */
static void differences_that_do_not_fall_are_flagged(void **state) {
    (void)state;
    const struct key key = {3, 2, {97, 69, 49}, 1, NULL};
    const double speed[] = {1.0056 * (1 - 0.0024), 1.0056 * (1 - 0.0011), 1.0056};
    const struct judged judged = judge(&key, speed, NULL, 3e-5);
    assert_int_equal(judged.verdict, ERROR_BUDGET_GROWS);
    NEAR(judged.of[SPEED].error, 2 * 0.0024, 0.0001, 0);
    assert_true(judged.of[SPEED].error > 0.004 * 1.0056);
}

static void differences_below_the_noise_are_none(void **state) {
    (void)state;
    const struct key key = {3, 1, {1e-6, 1e-5, 1e-4}, 1, NULL};
    const double speed[] = {0.93640, 0.93641, 0.93639}, cost[] = {0.0728, 0.0720, 0.0715};
    const struct judged judged = judge(&key, speed, NULL, 2.5e-5);
    assert_int_equal(judged.verdict, ERROR_BUDGET_NONE);
    NEAR(judged.of[SPEED].error, 2e-5, 0, 1e-6);
    // a quantity without information neither rejects another quantity nor is widened by the other quantity
    const struct judged both = judge(&key, speed, cost, 2.5e-5);
    assert_int_equal(both.verdict, ERROR_BUDGET_GROWS);
    assert_int_equal(both.culprit, COST);
    assert_int_equal(both.of[SPEED].verdict, ERROR_BUDGET_NONE);
    NEAR(both.of[SPEED].error, 2e-5, 0, 1e-6);
    assert_int_equal(judge(&key, speed, NULL, 1e-6).verdict, ERROR_BUDGET_TURNS);
    // a difference of 2e-5 in 0.94 against three times the noise
    assert_int_equal(judge(&key, speed, NULL, 0.75e-5).verdict, ERROR_BUDGET_NONE);
    assert_int_equal(judge(&key, speed, NULL, 0.69e-5).verdict, ERROR_BUDGET_TURNS);
}

static void orders_decide(void **state) {
    (void)state;
    // differences 1, 2, 4 and so on at halved spacings: orders p, p' by log2 of the ratios
    const struct {
        double differences[3], design;
        enum error_budget_verdict verdict;
    } examples[] = {
        {{1, 4, 16}, 2, ERROR_BUDGET_ACCEPTED},       // 2, 2
        {{1, 2.01, 4.05}, 2, ERROR_BUDGET_ACCEPTED},  // 1.01, 1.01: less than 1 below
        {{1, 1.9, 3.8}, 2, ERROR_BUDGET_LOW},         // 0.93, 1
        {{1, 4, 7.5}, 2, ERROR_BUDGET_LOW},           // 2, 0.91
        {{1, 4, 28}, 2, ERROR_BUDGET_CHANGES},        // 2, 2.81
        {{1, 4, 27}, 2, ERROR_BUDGET_ACCEPTED},       // 2, 2.75
        {{1, 9, 38}, 2, ERROR_BUDGET_ACCEPTED},       // 3.17, 2.08: rises above the design order
        {{1, 9, 35}, 2, ERROR_BUDGET_CHANGES},        // 3.17, 1.96
        {{1, 11.2, 23}, 2, ERROR_BUDGET_CHANGES},     // 3.49, 1.04
        {{1, 11.4, 23}, 2, ERROR_BUDGET_ACCEPTED},    // 3.51, 1.01: far above
        {{1, 1.5, 2.25}, 1, ERROR_BUDGET_ACCEPTED},  {{1, 4, 16}, NAN, ERROR_BUDGET_NO_ORDER},
        {{0, 4, 16}, 2, ERROR_BUDGET_ACCEPTED},  // equal to rounding: converged
        {{1, 1, 4}, 2, ERROR_BUDGET_GROWS},          {{1, 4, 3}, 2, ERROR_BUDGET_GROWS},
        {{1, 0, 3}, 2, ERROR_BUDGET_GROWS},          {{1, -4, 16}, 2, ERROR_BUDGET_TURNS},
        {{1, 4, -16}, 2, ERROR_BUDGET_TURNS},        {{1, 4, NAN}, 2, ERROR_BUDGET_UNKNOWN},
    };
    for (size_t i = 0; i < sizeof examples / sizeof *examples; i++) {
        const struct key key = {4, 0, {0.1, 0.2, 0.4, 0.8}, examples[i].design, NULL};
        double value[4] = {100};
        for (int k = 0; k < 3; k++) value[k + 1] = value[k] + examples[i].differences[k];
        const struct judged judged = judge(&key, value, NULL, 1e-9);
        if (judged.verdict != examples[i].verdict) fail_msg("example %zu: %s", i, error_budget_words(judged.verdict));
        // a flag names a quantity; the largest difference counts once with four levels
        assert_int_equal(judged.culprit, error_budget_is_flagged(judged.verdict) ? 0 : -1);
        if (judged.verdict > ERROR_BUDGET_ACCEPTED && judged.verdict < ERROR_BUDGET_UNKNOWN) {
            NEAR(judged.of[0].error, fabs(value[3] - value[0]), 0, 1e-12);
        }
    }
}

/* Levels of 9, 11, 17 and 24 nodes: the difference from 11 to 17 is larger than from 9 to 11, also at order 2. */
static void uneven_levels_are_judged_by_their_spacings(void **state) {
    (void)state;
    const struct key key = {4, 1, {24, 17, 11, 9}, 2, NULL};
    double value[4];
    for (int i = 0; i < 4; i++) value[i] = 2 + 0.3 / pow(key.level[i] - 1, 2);
    assert_true(value[2] - value[1] > value[3] - value[2]);
    const struct judged judged = judge(&key, value, NULL, 1e-9);
    assert_int_equal(judged.verdict, ERROR_BUDGET_ACCEPTED);
    NEAR(judged.of[0].coarse_order, 2, 1e-9, 0);
}

static void a_missing_level_leaves_the_error_unknown(void **state) {
    (void)state;
    const struct key key = {4, 1, {35, 25, 17, 13}, 2, "even where it is flagged before"};
    const double speed[] = {0.9372, 0.9364, 0.9297, 0.9155}, cost[] = {NAN, 0.0728, 0.0720, 0.0708};
    const struct judged judged = judge(&key, speed, cost, 3e-5);
    assert_int_equal(judged.verdict, ERROR_BUDGET_UNKNOWN);
    assert_int_equal(judged.culprit, COST);
    assert_true(isnan(judged.of[COST].error));
    NEAR(judged.of[SPEED].error, 0.9364 - 0.9155, 1e-12, 0);
}

static void two_levels_give_the_difference_with_a_wide_bound(void **state) {
    (void)state;
    const struct key base = {2, 0, {1e-5, 1e-4}, 1, NULL}, confirmed = {2, 1, {1e-6, 1e-5}, 1, NULL};
    const double speed[] = {1, 1.01};
    assert_int_equal(judge(&base, speed, NULL, 1e-5).verdict, ERROR_BUDGET_FEW);
    NEAR(judge(&base, speed, NULL, 1e-5).of[0].error, 0.015, 1e-12, 0);
    NEAR(judge(&confirmed, speed, NULL, 1e-5).of[0].error, 0.02, 1e-12, 0);
}

static void of_many_levels_the_finest_four_count(void **state) {
    (void)state;
    const struct key key = {6, 0, {0.1, 0.2, 0.4, 0.8, 1.6, 3.2}, 2, NULL};
    const double value[] = {1.01, 1.04, 1.16, 1.64, 0.2, 70};
    const struct judged judged = judge(&key, value, NULL, 1e-9);
    assert_int_equal(judged.verdict, ERROR_BUDGET_ACCEPTED);
    NEAR(judged.of[0].error, 1.25 * 0.01, 0, 1e-9);
}

/* A point in the plane: the differences are vectors. */
static void points_are_judged_by_the_angle_between_differences(void **state) {
    (void)state;
    const double size[] = {0.1, 0.2, 0.4};
    const double straight[][2] = {{1, 1}, {1, 1.3}, {0.5, 2.1}}, back[][2] = {{1, 1}, {1, 1.3}, {1.9, 1}};
    const struct error_budget_levels levels = {3, 0, size, 2, NULL};
    struct error_budget_result result;
    int culprit;
    struct error_budget_sequence sequence = {straight, 1e-9};
    assert_int_equal(error_budget_judge(&levels, 1, &sequence, &result, &culprit), ERROR_BUDGET_ACCEPTED);
    NEAR(result.order, log2(hypot(0.5, 0.8) / 0.3), 1e-9, 0);
    sequence.value = back;
    assert_int_equal(error_budget_judge(&levels, 1, &sequence, &result, &culprit), ERROR_BUDGET_TURNS);
}

/* Steady speed and cost over the nodes, of fish with other moduli and tails; the limits come from 49 nodes and from
 * extrapolation. A stated error has to cover the distance from the limit. */
static void errors_cover_the_limits_of_tails_with_a_floor(void **state) {
    (void)state;
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
            const struct judged judged = judge(&key, speed, cost, 3e-5);
            assert_true(judged.of[SPEED].error >= fabs(speed[key.base] - bodies[b].limit[SPEED]));
            assert_true(judged.of[COST].error >= fabs(cost[key.base] - bodies[b].limit[COST]));
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(orders_of_powers_are_found),
        cmocka_unit_test(a_power_is_accepted_and_its_error_is_that_of_richardson),
        cmocka_unit_test(an_order_above_the_design_order_is_not_used),
        cmocka_unit_test(three_levels_without_a_finer_one_have_wider_bounds),
        cmocka_unit_test(a_sequence_that_goes_on_is_flagged),
        cmocka_unit_test(what_is_known_before_flags_whatever_the_levels_say),
        cmocka_unit_test(differences_that_do_not_fall_are_flagged),
        cmocka_unit_test(differences_below_the_noise_are_none),
        cmocka_unit_test(orders_decide),
        cmocka_unit_test(uneven_levels_are_judged_by_their_spacings),
        cmocka_unit_test(a_missing_level_leaves_the_error_unknown),
        cmocka_unit_test(two_levels_give_the_difference_with_a_wide_bound),
        cmocka_unit_test(of_many_levels_the_finest_four_count),
        cmocka_unit_test(points_are_judged_by_the_angle_between_differences),
        cmocka_unit_test(errors_cover_the_limits_of_tails_with_a_floor),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
