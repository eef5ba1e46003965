/* test_parallel.c: The chunks of a loop cover every element once, and only loops that are long enough use several
 * threads. */
#include <time.h>

#include "base/parallel.h"
#include "near.h"

TEST(chunks_cover_every_element_once) {
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

TEST(short_loops_are_not_worth_threads) {
    assert_int_equal(parallel_threads(4, 10, 100, 100), 4);
    assert_int_equal(parallel_threads(4, 10, 99, 100), 1);
    assert_int_equal(parallel_threads(1, 10, 100, 100), 1);
    // one iteration belongs to one thread, for any amount of work
    assert_int_equal(parallel_threads(4, 1, 1e9, 100), 1);
}

TEST(a_clock_counts_seconds) {
    const double wall = clock_seconds(CLOCK_MONOTONIC), used = clock_seconds(CLOCK_THREAD_CPUTIME_ID);
    nanosleep(&(struct timespec){.tv_nsec = 20000000}, NULL);
    AT_LEAST(clock_seconds(CLOCK_MONOTONIC) - wall, 0.02);
    BELOW(clock_seconds(CLOCK_MONOTONIC) - wall, 60);
    // a sleeping thread uses no processor
    AT_LEAST(clock_seconds(CLOCK_THREAD_CPUTIME_ID) - used, 0);
    BELOW(clock_seconds(CLOCK_THREAD_CPUTIME_ID) - used, 0.01);
}
