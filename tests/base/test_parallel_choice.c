/* test_parallel_choice.c: which choice the steps of a run take, by the times of steps with all threads and with one. */
#include <omp.h>

#include "base/parallel_choice.h"
#include "near.h"

/* A machine on which a step takes these times, s. */
struct machine {
    double all, one;
};

/* What a run on it came to: total time, s, and the share of the time with one thread. */
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
        is_one = parallel_choice_note(choice, time);
    }
    run.share_of_one /= run.time;
    return run;
}

static const struct machine idle = {.all = 0.001, .one = 0.0019}, shared = {.all = 0.0015, .one = 0.001};

static void an_idle_machine_keeps_all_threads(void **state) {
    (void)state;
    struct parallel_choice choice = {0};
    const struct run run = steps(&choice, idle, 20);
    assert_false(choice.is_one);
    // trials of 20 ms, at first after 0.1, 0.2, 0.4 s, later after 5 s
    assert_true(run.time < 1.01 * 20);
    assert_true(run.share_of_one > 0);
}

static void a_shared_core_leaves_one_thread_soon(void **state) {
    (void)state;
    for (int i = 0; i < 2; i++) {
        struct parallel_choice choice = {0};
        // from the start, and after some time
        if (i == 1) steps(&choice, idle, 20);
        const struct run run = steps(&choice, shared, 20);
        assert_true(choice.is_one);
        assert_true(run.time < 1.1 * 20);
        // and back again once the core is free
        steps(&choice, idle, 20);
        assert_false(choice.is_one);
    }
}

static void long_steps_cost_few_trials(void **state) {
    (void)state;
    struct parallel_choice choice = {0};
    const struct run run = steps(&choice, (struct machine){.all = 0.4, .one = 0.76}, 400);
    assert_false(choice.is_one);
    assert_true(run.share_of_one > 0 && run.share_of_one < 0.06);
    assert_true(run.time < 1.04 * 400);
}

static void equal_times_change_nothing(void **state) {
    (void)state;
    struct parallel_choice choice = {0};
    steps(&choice, (struct machine){.all = 0.001, .one = 0.00098}, 20);
    assert_false(choice.is_one);
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

static void parallel_loops_take_the_threads_of_the_choice(void **state) {
    (void)state;
    struct parallel_choice choice = {.is_one = true};
    const int all = team();
    for (int i = 0; i < 2; i++) {
        parallel_choice_begin(&choice, 2);
        assert_int_equal(team(), i == 0 ? 1 : all);
        parallel_choice_end(&choice, 2);
        assert_int_equal(team(), all);
        choice.is_one = false;
    }
    // a run on one thread has nothing to choose
    parallel_choice_begin(&choice, 1);
    parallel_choice_end(&choice, 1);
    assert_int_equal(choice.window.n_steps, 2);
    parallel_choice_clear(&choice);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_idle_machine_keeps_all_threads),
        cmocka_unit_test(a_shared_core_leaves_one_thread_soon),
        cmocka_unit_test(long_steps_cost_few_trials),
        cmocka_unit_test(equal_times_change_nothing),
        cmocka_unit_test(parallel_loops_take_the_threads_of_the_choice),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
