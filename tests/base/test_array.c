/* test_array.c: arrays of zeros, and the state after a failed allocation. */
#include <stdlib.h>

#include "base/array.h"
#include "failing_malloc.h"
#include "near.h"

static void an_array_is_zeros_and_never_null(void **state) {
    (void)state;
    double *values[2] = {NULL, NULL};
    assert_int_equal(array_doubles(&values[0], 3, "three"), STATUS_OK);
    NEAR_ARRAY(3, values[0], ((const double[]){0, 0, 0}), 0, 0);
    assert_int_equal(array_doubles(&values[1], 0, "none"), STATUS_OK);
    assert_non_null(values[1]);
    for (int i = 0; i < 2; i++) free(values[i]);
}

static void without_memory_the_message_says_what_for(void **state) {
    (void)state;
    double *a = NULL, *b = NULL, *c = NULL;
    double **const all[] = {&a, &b, &c};
    n_until_failure = 1;
    const enum status status = array_many_doubles(all, 3, 5, "the points");
    n_until_failure = -1;
    assert_int_equal(status, STATUS_MEMORY);
    assert_string_equal(status_message(), "out of memory: the points, 5 numbers");
    assert_non_null(a);
    assert_null(b);
    assert_null(c);
    free(a);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_array_is_zeros_and_never_null),
        cmocka_unit_test(without_memory_the_message_says_what_for),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
