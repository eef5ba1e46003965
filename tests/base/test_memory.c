/* test_memory.c: zeroed memory, resized memory, and the state after a failed allocation. */
#include <stdlib.h>

#include "base/memory.h"
#include "failing_malloc.h"
#include "near.h"

TEST(new_memory_is_zero_and_never_null) {
    double *values, *none;
    assert_int_equal(MEMORY_NEW(values, 3, "three"), STATUS_OK);
    NEAR_ARRAY(3, values, ((const double[]){0, 0, 0}), 0, 0);
    assert_int_equal(MEMORY_NEW(none, 0, "none"), STATUS_OK);
    assert_non_null(none);
    free(values);
    free(none);
}

TEST(resized_memory_keeps_its_values_also_when_the_resizing_fails) {
    double *values = NULL;
    assert_int_equal(MEMORY_RESIZE(values, 2, "values"), STATUS_OK);
    values[0] = 3;
    values[1] = 4;
    assert_int_equal(MEMORY_RESIZE(values, 1000, "values"), STATUS_OK);
    NEAR_ARRAY(2, values, ((const double[]){3, 4}), 0, 0);

    n_until_failure = 0;
    double *const before = values;
    assert_int_equal(MEMORY_RESIZE(values, 2000, "values"), STATUS_MEMORY);
    n_until_failure = -1;
    assert_string_equal(status_message(), "out of memory: values, 16000 bytes");
    assert_ptr_equal(values, before);

    // a size in bytes above the range of size_t
    assert_int_equal(MEMORY_RESIZE(values, (size_t)-1 / 2, "values"), STATUS_MEMORY);
    assert_ptr_equal(values, before);
    free(values);
}

TEST(without_memory_the_message_says_what_for) {
    double *a = NULL, *b = NULL, *c = NULL;
    double **const all[] = {&a, &b, &c};
    n_until_failure = 1;
    const enum status status = MEMORY_ARRAYS(all, 5, "the points");
    n_until_failure = -1;
    assert_int_equal(status, STATUS_MEMORY);
    assert_string_equal(status_message(), "out of memory: the points, 40 bytes");
    assert_non_null(a);
    assert_null(b);
    assert_null(c);
    free(a);
}

TEST(a_string_is_copied) {
    char *copy;
    assert_int_equal(memory_copy_string(&copy, "path", "a path"), STATUS_OK);
    assert_string_equal(copy, "path");
    free(copy);
    n_until_failure = 0;
    assert_int_equal(memory_copy_string(&copy, "path", "a path"), STATUS_MEMORY);
    n_until_failure = -1;
    assert_null(copy);
    assert_string_equal(status_message(), "out of memory: a path, 5 bytes");
}
