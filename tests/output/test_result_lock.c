/* test_result_lock.c: of two processes one gets the lock, and the other hears who has it. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "near.h"
#include "output/result_lock.h"

static char folder[] = "/tmp/test_result_lock_XXXXXX", result[64], lock_file[64];

static int set_up(void **state) {
    (void)state;
    if (!mkdtemp(folder)) return -1;
    snprintf(result, sizeof result, "%s/run.nc", folder);
    snprintf(lock_file, sizeof lock_file, "%s/run.nc.lock", folder);
    return 0;
}

static int tear_down(void **state) {
    (void)state;
    unlink(lock_file);
    return rmdir(folder);
}

// another process that takes the lock, says so on a pipe and waits to be killed; it releases first where told to
static pid_t start_other(int releases) {
    int ready[2];
    char byte = 0;
    assert_int_equal(pipe(ready), 0);
    const pid_t other = fork();
    if (other == 0) {
        struct result_lock lock;
        if (result_lock_take(&lock, result) != STATUS_OK) _exit(1);
        if (releases) result_lock_release(&lock);
        if (write(ready[1], "x", 1) != 1) _exit(1);
        pause();
        _exit(0);
    }
    close(ready[1]);
    assert_int_equal(read(ready[0], &byte, 1), 1);
    close(ready[0]);
    return other;
}

static void end(pid_t other) {
    kill(other, SIGKILL);
    waitpid(other, NULL, 0);
}

static void a_second_process_is_refused_and_hears_who_writes(void **state) {
    (void)state;
    struct result_lock lock;
    char process[64], host[256] = "";
    const pid_t other = start_other(0);
    gethostname(host, sizeof host - 1);
    snprintf(process, sizeof process, "process %ld on ", (long)other);
    assert_int_equal(result_lock_take(&lock, result), STATUS_FILE);
    assert_null(lock.path);
    if (!strstr(status_message(), process) || !strstr(status_message(), host)) fail_msg("%s", status_message());
    // the kernel frees it, whatever is left of the file
    end(other);
    assert_int_equal(access(lock_file, F_OK), 0);
    assert_int_equal(result_lock_take(&lock, result), STATUS_OK);
    result_lock_release(&lock);
    assert_int_not_equal(access(lock_file, F_OK), 0);
}

static void a_released_lock_is_free(void **state) {
    (void)state;
    struct result_lock lock;
    const pid_t other = start_other(1);
    assert_int_equal(result_lock_take(&lock, result), STATUS_OK);
    result_lock_release(&lock);
    result_lock_release(&lock);
    end(other);
}

static void links_are_not_followed(void **state) {
    (void)state;
    struct result_lock lock;
    assert_int_equal(symlink("/tmp/nothing", lock_file), 0);
    assert_int_equal(result_lock_take(&lock, result), STATUS_FILE);
    assert_int_not_equal(access("/tmp/nothing", F_OK), 0);
    unlink(lock_file);
}

// work that sees the lock of its result, and fails
static enum status work(void *data) {
    *(int *)data += access(lock_file, F_OK) == 0;
    return STATUS_SOLVER;
}

static void work_is_done_under_the_lock_and_only_then(void **state) {
    (void)state;
    int n_locked = 0;
    assert_int_equal(result_lock_hold(result, work, &n_locked), STATUS_SOLVER);
    assert_int_equal(n_locked, 1);
    assert_int_not_equal(access(lock_file, F_OK), 0);
    const pid_t other = start_other(0);
    assert_int_equal(result_lock_hold(result, work, &n_locked), STATUS_FILE);
    end(other);
    // nothing can be written to a folder
    assert_int_equal(result_lock_hold(folder, work, &n_locked), STATUS_FILE);
    assert_int_equal(n_locked, 1);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_second_process_is_refused_and_hears_who_writes),
        cmocka_unit_test(a_released_lock_is_free),
        cmocka_unit_test(links_are_not_followed),
        cmocka_unit_test(work_is_done_under_the_lock_and_only_then),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
