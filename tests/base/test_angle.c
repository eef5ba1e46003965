/* test_angle.c: angles in radians and degrees. */
#include "base/angle.h"
#include "near.h"

static void wrap_removes_full_turns(void **state) {
    (void)state;
    const double pi = acos(-1);
    for (int turns = -3; turns <= 3; turns++) {
        for (double angle = -3; angle <= 3; angle += 0.5) {
            // rounding of up to three turns
            NEAR(angle_wrap(angle + 2 * pi * turns), angle, 1e-14, 0);
        }
    }
    NEAR(fabs(angle_wrap(pi)), pi, 0, 1e-15);
}

static void degrees_and_radians_are_inverse(void **state) {
    (void)state;
    NEAR(angle_radians(180), acos(-1), 0, 1e-15);
    NEAR(angle_degrees(angle_radians(37.5)), 37.5, 0, 1e-15);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(wrap_removes_full_turns),
        cmocka_unit_test(degrees_and_radians_are_inverse),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
