/* test_parallel.c: chunks cover an array; only long loops use several threads. */
#include "base/parallel.h"
#include "near.h"

static void chunks_cover_every_element_once(void **state) {
    (void)state;
    for (int n = 0; n <= 100; n++) {
        int next = 0;
        for (int i = 0; i < parallel_n_chunks(n); i++) {
            const struct range chunk = parallel_chunk(i, n);
            assert_int_equal(chunk.first, next);
            assert_in_range(chunk.n, 1, 16);
            // full vectors, except in the last chunk
            assert_true(chunk.n == 16 || i == parallel_n_chunks(n) - 1);
            next += chunk.n;
        }
        assert_int_equal(next, n);
    }
}

static void short_loops_are_not_worth_threads(void **state) {
    (void)state;
    assert_int_equal(parallel_threads(4, 10, 100, 100), 4);
    assert_int_equal(parallel_threads(4, 10, 99, 100), 1);
    assert_int_equal(parallel_threads(1, 10, 100, 100), 1);
    // one iteration belongs to one thread, for any amount of work
    assert_int_equal(parallel_threads(4, 1, 1e9, 100), 1);
}

static void mark(void *data, int i) {
    int *const mark = data;
    mark[i] += i + 1;
}

static void a_loop_calls_its_body_once_for_each_number(void **state) {
    (void)state;
    for (int threads = 1; threads <= 3; threads++) {
        int marks[8] = {0};
        parallel_for(threads, 7, mark, marks);
        for (int i = 0; i < 8; i++) assert_int_equal(marks[i], i < 7 ? i + 1 : 0);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_loop_calls_its_body_once_for_each_number),
        cmocka_unit_test(chunks_cover_every_element_once),
        cmocka_unit_test(short_loops_are_not_worth_threads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
