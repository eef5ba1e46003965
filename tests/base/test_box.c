/* test_box.c: boxes around points, and the gap between two. */
#include "base/box.h"
#include "near.h"

static void a_box_has_all_points_and_is_not_larger(void **state) {
    (void)state;
    const double x[] = {1, -2, 0.5}, y[] = {3, 4, -1};
    const struct box box = box_around(3, x, y), wide = box_widen(box, 0.25);
    NEAR_ARRAY(2, box.low, ((const double[]){-2, -1}), 0, 0);
    NEAR_ARRAY(2, box.high, ((const double[]){1, 4}), 0, 0);
    NEAR_ARRAY(2, wide.low, ((const double[]){-2.25, -1.25}), 0, 0);
    NEAR_ARRAY(2, wide.high, ((const double[]){1.25, 4.25}), 0, 0);
}

static void the_union_with_the_box_of_no_points_is_the_other(void **state) {
    (void)state;
    const double x[] = {1, 2}, y[] = {3, 5};
    const struct box none = box_around(0, x, y), one = box_around(2, x, y), both = box_union(none, one);
    NEAR_ARRAY(2, both.low, one.low, 0, 0);
    NEAR_ARRAY(2, both.high, one.high, 0, 0);
    const struct box far = box_around(1, (const double[]){-7}, (const double[]){4}), all = box_union(one, far);
    NEAR_ARRAY(2, all.low, ((const double[]){-7, 3}), 0, 0);
    NEAR_ARRAY(2, all.high, ((const double[]){2, 5}), 0, 0);
    NEAR(box_gap(&none, &one), INFINITY, 0, 0);
    NEAR(box_gap(&none, &none), INFINITY, 0, 0);
}

static void the_gap_is_that_of_the_axis_along_which_they_are_apart(void **state) {
    (void)state;
    const struct box a = {{0, 0}, {1, 1}};
    const struct {
        struct box other;
        double gap;
    } cases[] = {{{{3, 0}, {4, 1}}, 2},          {{{-4, 0.5}, {-3, 3}}, 3},
                 {{{0, 1.5}, {1, 2}}, 0.5},      {{{0.25, -8}, {0.5, -5}}, 5},
                 {{{2, 4}, {3, 5}}, 3},          {{{1, 0}, {2, 1}}, 0},
                 {{{0.5, 0.75}, {2, 2}}, -0.25}, {{{0.5, 0.5}, {0.75, 0.75}}, -0.5}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        NEAR(box_gap(&a, &cases[i].other), cases[i].gap, 0, 0);
        NEAR(box_gap(&cases[i].other, &a), cases[i].gap, 0, 0);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_box_has_all_points_and_is_not_larger),
        cmocka_unit_test(the_union_with_the_box_of_no_points_is_the_other),
        cmocka_unit_test(the_gap_is_that_of_the_axis_along_which_they_are_apart),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
