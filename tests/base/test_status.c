/* test_status.c: Each thread has its own error message, TRY passes an error on, and each status has the documented exit
 * code. */
#include <pthread.h>
#include <stdio.h>
#include <string.h>

#include "base/status.h"
#include "near.h"

TEST(message_is_empty_at_first) {
    assert_string_equal(status_message(), "");
}

TEST(fail_keeps_the_message_and_returns_the_status) {
    assert_int_equal(status_fail(STATUS_FILE, "%s: cannot be read at %g s", "run.nc", 0.5), STATUS_FILE);
    assert_string_equal(status_message(), "run.nc: cannot be read at 0.5 s");
    assert_int_equal(status_fail(STATUS_RETRY, "t = %d", 1), STATUS_RETRY);
    assert_string_equal(status_message(), "t = 1");
}

TEST(a_message_can_be_put_into_the_next_one) {
    status_fail(STATUS_CASE, "no such key");
    status_fail(STATUS_CASE, "a.yaml: %s", status_message());
    assert_string_equal(status_message(), "a.yaml: no such key");
}

TEST(clear_leaves_no_message) {
    status_fail(STATUS_CASE, "old");
    status_clear();
    assert_string_equal(status_message(), "");
}

TEST(a_long_message_is_cut) {
    static char text[100000];
    memset(text, 'x', sizeof text - 1);
    assert_int_equal(status_fail(STATUS_CASE, "%s", text), STATUS_CASE);
    assert_in_range(strlen(status_message()), 60000, sizeof text - 2);
    assert_memory_equal(status_message(), text, strlen(status_message()));
}

static void *fail_elsewhere(void *first_message) {
    snprintf(first_message, 8, "%s", status_message());
    status_fail(STATUS_SOLVER, "of the other thread");
    return NULL;
}

TEST(each_thread_has_its_own_message) {
    status_fail(STATUS_CASE, "of this thread");
    char first_message[8] = "unset";
    pthread_t thread;
    assert_int_equal(pthread_create(&thread, NULL, fail_elsewhere, first_message), 0);
    assert_int_equal(pthread_join(thread, NULL), 0);
    assert_string_equal(first_message, "");
    assert_string_equal(status_message(), "of this thread");
}

static enum status count_and_return(int *n_calls, enum status status) {
    ++*n_calls;
    return status;
}

static enum status three_tries(int *n_calls, enum status second) {
    TRY(count_and_return(n_calls, STATUS_OK));
    TRY(count_and_return(n_calls, second));
    TRY(count_and_return(n_calls, STATUS_OK));
    return STATUS_OK;
}

TEST(try_leaves_at_the_first_failure_and_evaluates_once) {
    int n_calls = 0;
    assert_int_equal(three_tries(&n_calls, STATUS_OK), STATUS_OK);
    assert_int_equal(n_calls, 3);
    n_calls = 0;
    assert_int_equal(three_tries(&n_calls, STATUS_RETRY), STATUS_RETRY);
    assert_int_equal(n_calls, 2);
    n_calls = 0;
    assert_int_equal(three_tries(&n_calls, STATUS_MEMORY), STATUS_MEMORY);
    assert_int_equal(n_calls, 2);
}

TEST(signs_are_those_of_solver_callbacks) {
    assert_int_equal(STATUS_OK, 0);
    ABOVE(STATUS_RETRY, 0);
    const enum status final[] = {STATUS_CASE,    STATUS_FILE,   STATUS_MEMORY, STATUS_SOLVER,
                                 STATUS_STOPPED, STATUS_MISSED, STATUS_CONTACT};
    for (size_t i = 0; i < sizeof final / sizeof *final; i++) BELOW(final[i], 0);
}

TEST(exit_codes_are_the_documented_ones) {
    assert_int_equal(status_exit_code(STATUS_OK), 0);
    assert_int_equal(status_exit_code(STATUS_RETRY), 1);
    assert_int_equal(status_exit_code(STATUS_SOLVER), 1);
    assert_int_equal(status_exit_code(STATUS_CASE), 2);
    assert_int_equal(status_exit_code(STATUS_MISSED), 3);
    assert_int_equal(status_exit_code(STATUS_CONTACT), 3);
    assert_int_equal(status_exit_code(STATUS_FILE), 4);
    assert_int_equal(status_exit_code(STATUS_MEMORY), 4);
    assert_int_equal(status_exit_code(STATUS_STOPPED), 75);
}
