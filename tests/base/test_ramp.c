/* test_ramp.c: the ramp of doc/model.md, section 4. */
#include "base/ramp.h"
#include "near.h"

static void step_goes_from_zero_to_one_symmetrically(void **state) {
    (void)state;
    NEAR(ramp_step(-1), 0, 0, 0);
    NEAR(ramp_step(0), 0, 0, 0);
    NEAR(ramp_step(1), 1, 0, 0);
    NEAR(ramp_step(7), 1, 0, 0);
    // S(q) + S(1-q) = 1 up to rounding of coefficients of up to 84
    for (double q = 0; q <= 1; q += 0.0625) NEAR(ramp_step(q) + ramp_step(1 - q), 1, 1e-14, 0);
    // 0.25^4 (35 - 84/4 + 70/16 - 20/64) by hand
    NEAR(ramp_step(0.25), 18.0625 / 256, 1e-16, 0);
}

static void rate_is_the_derivative(void **state) {
    (void)state;
    const double h = 1e-4;
    for (double q = -0.15; q < 1.2; q += 0.1) {
        // truncation h^2/6 |S'''| with |S'''| <= 53; rounding 1e-16/h is less
        NEAR(ramp_step_rate(q), (ramp_step(q + h) - ramp_step(q - h)) / (2 * h), 1e-7, 0);
        NEAR(ramp_rate(3 * q, 3), (ramp_value(3 * q + h, 3) - ramp_value(3 * q - h, 3)) / (2 * h), 1e-8, 0);
    }
}

static void three_derivatives_vanish_at_both_ends(void **state) {
    (void)state;
    // S = 35 q^4 + ... at the start, 1 - 35 (1-q)^4 + ... at the end
    const double q = 1e-3;
    NEAR(ramp_step(q), 35 * q * q * q * q, 0, 3e-3);
    NEAR(1 - ramp_step(1 - q), 35 * q * q * q * q, 1e-15, 3e-3);
}

static void ramp_of_no_duration_is_one_at_all_times(void **state) {
    (void)state;
    NEAR(ramp_value(0, 0), 1, 0, 0);
    NEAR(ramp_rate(0, 0), 0, 0, 0);
    NEAR(ramp_value(1, 2), 0.5, 1e-15, 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(step_goes_from_zero_to_one_symmetrically),
        cmocka_unit_test(rate_is_the_derivative),
        cmocka_unit_test(three_derivatives_vanish_at_both_ends),
        cmocka_unit_test(ramp_of_no_duration_is_one_at_all_times),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
