/* test_parallel.c: chunks cover an array; only long loops use several threads. */
#define _GNU_SOURCE
#include <omp.h>
#include <sched.h>
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

static void mark(void *data, int i) {
    int *const mark = data;
    mark[i] += i + 1;
}

TEST(a_loop_calls_its_body_once_for_each_number) {
    for (int threads = 1; threads <= 3; threads++) {
        int marks[8] = {0};
        parallel_for(threads, 7, mark, marks);
        for (int i = 0; i < 8; i++) assert_int_equal(marks[i], i < 7 ? i + 1 : 0);
    }
}

// ---- the number of threads of steps, from the times of steps on one thread and on all

/* A machine on which a step takes these times, s. */
struct machine {
    double all, one;
};

/* Total time of a run on a machine, s, and its share of steps on one thread. */
struct run {
    double time, share_of_one;
};

static struct run steps(struct parallel_choice *choice, struct machine machine, double duration) {
    struct run run = {0};
    bool is_one = choice->is_one != choice->is_trial;
    double done = 0;
    // the faster choice needs the duration
    const double step = fmin(machine.all, machine.one);
    for (; done < duration; done += step) {
        const double time = is_one ? machine.one : machine.all;
        run.time += time;
        run.share_of_one += is_one ? time : 0;
        is_one = parallel_choice_note(choice, time, time);
    }
    run.share_of_one /= run.time;
    return run;
}

static const struct machine idle = {.all = 0.001, .one = 0.0019}, shared = {.all = 0.0015, .one = 0.001};

TEST(an_idle_machine_keeps_all_threads) {
    struct parallel_choice choice = {0};
    const struct run run = steps(&choice, idle, 20);
    assert_false(choice.is_one);
    // trials of 20 ms, at first after 0.1, 0.2, 0.4 s, later after 5 s
    BELOW(run.time, 1.01 * 20);
    ABOVE(run.share_of_one, 0);
}

TEST(a_shared_core_leaves_one_thread_soon) {
    for (int i = 0; i < 2; i++) {
        struct parallel_choice choice = {0};
        // from the start, and after some time
        if (i == 1) steps(&choice, idle, 20);
        const struct run run = steps(&choice, shared, 20);
        assert_true(choice.is_one);
        BELOW(run.time, 1.1 * 20);
        // and back again once the core is free
        steps(&choice, idle, 20);
        assert_false(choice.is_one);
    }
}

TEST(long_steps_cost_few_trials) {
    struct parallel_choice choice = {0};
    const struct run run = steps(&choice, (struct machine){.all = 0.4, .one = 0.76}, 400);
    assert_false(choice.is_one);
    ABOVE(run.share_of_one, 0);
    BELOW(run.share_of_one, 0.06);
    BELOW(run.time, 1.04 * 400);
}

TEST(equal_times_change_nothing) {
    struct parallel_choice choice = {0};
    steps(&choice, (struct machine){.all = 0.001, .one = 0.00098}, 20);
    assert_false(choice.is_one);
}

TEST(a_trial_that_waits_for_its_processor_is_repeated_on_another_one) {
    struct parallel_choice choice = {.pause = 1};
    assert_true(parallel_choice_note(&choice, 1, 1) || parallel_choice_note(&choice, 1, 1) ||
                parallel_choice_note(&choice, 1, 1));
    // half of the time on the processor: repeat on the next part
    for (int i = 0; i < 3; i++) assert_true(parallel_choice_note(&choice, 1.2, 0.6));
    assert_int_equal(choice.part, 1);
    // not a third time
    for (int i = 0; i < 3; i++) assert_int_equal(parallel_choice_note(&choice, 1.2, 0.6), i < 2);
    assert_int_equal(choice.part, 1);
    assert_false(choice.is_one);
    ABOVE(choice.rest, 0);
}

static int team(void) {
    int n = 0;
#pragma omp parallel num_threads(2)
    {
#pragma omp atomic
        n++;
    }
    return n;
}

TEST(parallel_loops_take_the_threads_of_the_choice) {
    struct parallel_choice choice = {.is_one = true};
    const int all = team();
    for (int i = 0; i < 2; i++) {
        parallel_choice_begin(&choice, 2);
        assert_int_equal(team(), i == 0 ? 1 : all);
        parallel_choice_end(&choice, 2);
        assert_int_equal(team(), all);
        choice.is_one = false;
    }
    // a run with one thread counts no steps
    parallel_choice_begin(&choice, 1);
    parallel_choice_end(&choice, 1);
    assert_int_equal(choice.window.n_steps, 2);
}

static double processor_time(void) {
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

TEST(a_step_is_timed_by_the_wall_clock_and_the_processor) {
    struct parallel_choice choice = {0};
    parallel_choice_begin(&choice, 2);
    nanosleep(&(struct timespec){.tv_nsec = 20000000}, NULL);
    parallel_choice_end(&choice, 2);
    const double slept = choice.window.time, used = choice.window.processor_time;
    AT_LEAST(slept, 0.02);
    BELOW(slept, 60);
    AT_LEAST(used, 0);
    BELOW(used, slept / 2);

    parallel_choice_begin(&choice, 2);
    const double begin = processor_time();
    while (processor_time() - begin < 0.005) continue;
    parallel_choice_end(&choice, 2);
    assert_int_equal(choice.window.n_steps, 2);
    AT_LEAST(choice.window.processor_time - used, 0.005 - 1e-6);
    AT_LEAST(choice.window.time - slept, choice.window.processor_time - used - 1e-3);
}

static int n_processors(void) {
    cpu_set_t set;
    return sched_getaffinity(0, sizeof set, &set) == 0 ? CPU_COUNT(&set) : 0;
}

// one step that ends a window of this length and makes a choice
static void step(struct parallel_choice *choice, double mean_time) {
    choice->window = (struct parallel_window){.n_steps = 9, .time = 10 * mean_time, .processor_time = 10 * mean_time};
    parallel_choice_begin(choice, 2);
    parallel_choice_end(choice, 2);
}

TEST(one_thread_may_use_all_processors) {
    const int all = n_processors();
    if (all < 2) skip();
    parallel_choice_spread(2);
    const int part = n_processors();
    BELOW(part, all);
    struct parallel_choice choice = {.pause = 1};
    step(&choice, 1);  // a trial of one thread begins
    assert_true(choice.is_trial);
    assert_int_equal(n_processors(), all);
    step(&choice, 2);  // slower
    assert_false(choice.is_one);
    assert_int_equal(n_processors(), part);
    choice.rest = 0;
    step(&choice, 1);
    step(&choice, 0.5);  // faster
    assert_true(choice.is_one);
    assert_int_equal(n_processors(), all);
    choice.rest = 0;
    step(&choice, 0.5);  // a trial of all threads
    assert_int_equal(n_processors(), part);
    step(&choice, 0.4);
    assert_false(choice.is_one);
    assert_int_equal(n_processors(), part);
}
