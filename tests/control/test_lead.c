/* test_lead.c: values set from outside during a run. */
#include "base/mathematics.h"
#include "control/lead.h"
#include "near.h"

static void a_value_that_was_never_led_is_zero(void **state) {
    (void)state;
    const struct lead lead = {.start = 0};
    for (double t = 0; t < 3; t += 0.7) {
        NEAR(lead_value(&lead, t), 0, 0, 0);
        NEAR(lead_rate(&lead, t), 0, 0, 0);
        NEAR(lead_integral(&lead, t), 0, 0, 0);
    }
}

static void a_change_from_rest_is_the_ramp(void **state) {
    (void)state;
    struct lead lead = {.start = 0};
    lead_change(&lead, 0.5, 2, 3);
    for (double t = 0.5; t < 4; t += 0.1) {
        NEAR(lead_value(&lead, t), 3 * ramp_value(t - 0.5, 2), 3e-14, 0);
        NEAR(lead_rate(&lead, t), 3 * ramp_rate(t - 0.5, 2), 1e-12, 0);
    }
    NEAR(lead_value(&lead, 2.5), 3, 0, 0);
}

// value and the first three derivatives by one-sided differences, before (side -1) or after t
static void derivatives(const struct lead *lead, double t, int side, double h, double got[4]) {
    double f[5];
    for (int i = 0; i < 5; i++) f[i] = lead_value(lead, t + side * i * h);
    got[0] = f[0];
    got[1] = side * (-25 * f[0] + 48 * f[1] - 36 * f[2] + 16 * f[3] - 3 * f[4]) / (12 * h);
    got[2] = (35 * f[0] - 104 * f[1] + 114 * f[2] - 56 * f[3] + 11 * f[4]) / (12 * h * h);
    got[3] = side * (-5 * f[0] + 18 * f[1] - 24 * f[2] + 14 * f[3] - 3 * f[4]) / (2 * h * h * h);
}

static void a_change_of_a_change_has_three_continuous_derivatives(void **state) {
    (void)state;
    struct lead before = {.start = 0};
    lead_change(&before, 0, 2, 1);
    struct lead after = before;
    lead_change(&after, 0.7, 0.5, -2);
    double left[4], right[4];
    derivatives(&before, 0.7, -1, 1e-4, left);
    derivatives(&after, 0.7, 1, 1e-4, right);
    // the differences are wrong by h^4, h^3, h^2 times derivatives of up to 1e5 after the change
    const double tolerance[4] = {1e-14, 1e-9, 1e-5, 0.05};
    for (int k = 0; k < 4; k++) NEAR(right[k], left[k], tolerance[k], 0);
    assert_true(fabs(left[3]) > 3);
    NEAR(lead_value(&after, 1.2), -2, 0, 0);
    NEAR(lead_rate(&after, 1.2), 0, 0, 0);
    NEAR(lead_value(&after, 1.2 - 1e-4), -2, 1e-12, 0);
}

static void rate_and_integral_belong_to_the_value(void **state) {
    (void)state;
    struct lead lead = {.start = 0};
    double sum = 0;
    const double h = 1e-3;
    for (int i = 0; i < 3000; i++) {
        const double t = i * h;
        if (i == 200) lead_change(&lead, t, 0.9, 1.3);
        if (i == 700) lead_change(&lead, t, 0.9, -0.4);
        if (i == 900) lead_change(&lead, t, 0.3, 0.8);
        NEAR(lead_integral(&lead, t), sum, 1e-9, 0);
        const double a = lead_value(&lead, t), b = lead_value(&lead, t + h / 2), c = lead_value(&lead, t + h);
        if (i != 200 && i != 700 && i != 900) NEAR(lead_rate(&lead, t + h / 2), (c - a) / h, 1e-4, 0);
        sum += h / 6 * (a + 4 * b + c);
    }
}

static void the_same_target_again_changes_nothing(void **state) {
    (void)state;
    struct lead lead = {.start = 0};
    lead_change(&lead, 0.1, 1, 2);
    const struct lead before = lead;
    lead_change(&lead, 0.4, 1, 2);
    assert_memory_equal(&lead, &before, sizeof lead);
}

static void changes_at_every_event_do_not_run_away(void **state) {
    (void)state;
    struct lead lead = {.start = 0};
    double most = 0;
    unsigned seed = 1;
    for (int i = 0; i < 20000; i++) {
        // targets of -1 and 1 for 1 to 60 events each, 25 events per ramp
        seed = 1664525 * seed + 1013904223;
        if (seed >> 24 < 10) lead_change(&lead, i * 0.02, 0.5, -lead.target + (lead.target == 0));
        most = fmax(most, fabs(lead_value(&lead, i * 0.02)));
    }
    assert_true(most > 0.99 && most < 1.25);
}

static void it_can_begin_with_a_value_and_a_rate(void **state) {
    (void)state;
    struct lead lead = {.start = 0};
    lead_begin(&lead, 2, 0.5, 0.3, -1.5, 1);
    NEAR(lead_value(&lead, 2), 0.3, 1e-15, 0);
    NEAR(lead_rate(&lead, 2), -1.5, 1e-14, 0);
    NEAR(lead_value(&lead, 2.5), 1, 0, 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_value_that_was_never_led_is_zero),
        cmocka_unit_test(a_change_from_rest_is_the_ramp),
        cmocka_unit_test(a_change_of_a_change_has_three_continuous_derivatives),
        cmocka_unit_test(rate_and_integral_belong_to_the_value),
        cmocka_unit_test(the_same_target_again_changes_nothing),
        cmocka_unit_test(changes_at_every_event_do_not_run_away),
        cmocka_unit_test(it_can_begin_with_a_value_and_a_rate),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
