/* test_result_lock.c: of two processes one gets the lock, and the other hears who has it. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "near.h"
#include "result/durable.h"
#include "result/result_lock.h"

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

static void two_runs_of_one_process_exclude_each_other(void **state) {
    (void)state;
    struct result_lock one, other;
    assert_int_equal(result_lock_take(&one, result), STATUS_OK);
    assert_int_equal(result_lock_take(&other, result), STATUS_FILE);
    result_lock_release(&other);
    // it still holds for another process
    const pid_t child = fork();
    if (child == 0) _exit(result_lock_take(&other, result) == STATUS_FILE ? 0 : 1);
    int outcome;
    waitpid(child, &outcome, 0);
    assert_int_equal(outcome, 0);
    result_lock_release(&one);
    assert_int_not_equal(access(lock_file, F_OK), 0);
}

static void a_fork_does_not_release_the_lock(void **state) {
    (void)state;
    struct result_lock lock, other;
    assert_int_equal(result_lock_take(&lock, result), STATUS_OK);
    const pid_t child = fork();
    if (child == 0) {
        result_lock_release(&lock);
        _exit(0);
    }
    waitpid(child, NULL, 0);
    assert_int_equal(access(lock_file, F_OK), 0);
    assert_int_equal(result_lock_take(&other, result), STATUS_FILE);
    result_lock_release(&lock);
    assert_int_not_equal(access(lock_file, F_OK), 0);
}

static void put(const char *text, size_t n) {
    FILE *const file = fopen(lock_file, "w");
    fwrite(text, 1, n, file);
    fclose(file);
}

static void a_file_that_is_no_lock_is_not_touched(void **state) {
    (void)state;
    struct result_lock lock;
    const char *const foreign[] = {"mine", "process x", "process 12 off host\n", "process 1 on h\nmine\n", "\nprocess"};
    for (int i = 0; i < 5; i++) {
        put(foreign[i], strlen(foreign[i]));
        assert_int_equal(result_lock_take(&lock, result), STATUS_FILE);
        if (!strstr(status_message(), "exists and is no lock of shoal")) fail_msg("%s", status_message());
        char text[64] = "";
        FILE *const file = fopen(lock_file, "r");
        assert_int_equal(fread(text, 1, sizeof text - 1, file), strlen(foreign[i]));
        fclose(file);
        assert_string_equal(text, foreign[i]);
    }
    unlink(lock_file);
}

static void what_a_power_cut_leaves_of_a_lock_is_removed_and_an_empty_file_stays(void **state) {
    (void)state;
    struct result_lock lock;
    const char left[] = "process 12 on a host\n", zeros[sizeof left] = "";
    for (size_t n = 0; n < sizeof left; n++) {
        for (int i = 0; i < 2; i++) {
            put(i == 0 ? left : zeros, n);
            assert_int_equal(result_lock_take(&lock, result), STATUS_OK);
            result_lock_release(&lock);
            struct stat facts;
            assert_int_equal(stat(lock_file, &facts), n == 0 ? 0 : -1);
            if (n == 0) assert_int_equal(facts.st_size, 0);
        }
    }
    unlink(lock_file);
}

// ---- two runs that race: a rival acts in the middle of the first one's result_lock_take

static enum { NOBODY, HOLDS, RELEASES } rival;
static enum { AT_LINK, AT_LOCK } rival_acts;
static struct result_lock rival_lock;
static enum status rival_status;
static bool without_links;

static void let_rival_act(void) {
    const bool releases = rival == RELEASES;
    rival = NOBODY;
    rival_status = result_lock_take(&rival_lock, result);
    if (releases) result_lock_release(&rival_lock);
}

int __real_link(const char *from, const char *to);
int __wrap_link(const char *from, const char *to);
int __wrap_link(const char *from, const char *to) {
    if (rival != NOBODY && rival_acts == AT_LINK) let_rival_act();
    if (!without_links) return __real_link(from, to);
    errno = EPERM;
    return -1;
}

int __real_durable_lock(int descriptor, uint64_t first, uint64_t n);
int __wrap_durable_lock(int descriptor, uint64_t first, uint64_t n);
int __wrap_durable_lock(int descriptor, uint64_t first, uint64_t n) {
    if (rival != NOBODY && rival_acts == AT_LOCK) let_rival_act();
    return __real_durable_lock(descriptor, first, n);
}

static void of_runs_that_race_one_has_the_lock_and_no_file_stays(void **state) {
    (void)state;
    char process[64];
    snprintf(process, sizeof process, "process %ld on ", (long)getpid());
    for (int i = 0; i < 8; i++) {
        const bool is_stale = i / 4, holds = i % 2;
        struct result_lock lock;
        if (is_stale) put("process 99999999 on a host\n", 27);
        rival_acts = i / 2 % 2 ? AT_LOCK : AT_LINK;
        rival = holds ? HOLDS : RELEASES;
        const enum status status = result_lock_take(&lock, result);
        const bool has_acted = rival == NOBODY;
        rival = NOBODY;

        // a file that exists is locked without a link, and a new file before anybody else can see it
        assert_int_equal(has_acted, is_stale == (rival_acts == AT_LOCK));
        if (has_acted) assert_int_equal(rival_status, STATUS_OK);
        assert_int_equal(status, has_acted && holds ? STATUS_FILE : STATUS_OK);
        if (status != STATUS_OK && !strstr(status_message(), process)) fail_msg("%s", status_message());

        result_lock_release(status == STATUS_OK ? &lock : &rival_lock);
        assert_int_not_equal(access(lock_file, F_OK), 0);
    }
}

static bool has_third;

ssize_t __real_pwrite(int descriptor, const void *bytes, size_t n, off_t at);
ssize_t __wrap_pwrite(int descriptor, const void *bytes, size_t n, off_t at);
ssize_t __wrap_pwrite(int descriptor, const void *bytes, size_t n, off_t at) {
    if (has_third) {
        has_third = false;
        rival_status = result_lock_members(&rival_lock, folder, 8, 2);
    }
    return __real_pwrite(descriptor, bytes, n, at);
}

static void a_study_that_joins_while_another_writes_its_name_sees_a_lock(void **state) {
    (void)state;
    struct result_lock one, other;
    char file[64];
    snprintf(file, sizeof file, "%s/study.lock", folder);
    assert_int_equal(result_lock_members(&one, folder, 0, 4), STATUS_OK);
    has_third = true;
    assert_int_equal(result_lock_members(&other, folder, 4, 4), STATUS_OK);
    assert_false(has_third);
    assert_int_equal(rival_status, STATUS_OK);

    // the last one removes the file
    result_lock_release(&one);
    result_lock_release(&other);
    assert_int_equal(access(file, F_OK), 0);
    result_lock_release(&rival_lock);
    assert_int_not_equal(access(file, F_OK), 0);
}

static void a_file_system_without_links_has_locks_too(void **state) {
    (void)state;
    struct result_lock lock, other;
    without_links = true;
    assert_int_equal(result_lock_take(&lock, result), STATUS_OK);
    assert_int_equal(result_lock_take(&other, result), STATUS_FILE);
    result_lock_release(&lock);
    without_links = false;
    assert_int_not_equal(access(lock_file, F_OK), 0);
}

static void the_remains_of_a_run_that_died_while_it_made_its_lock_are_removed(void **state) {
    (void)state;
    struct result_lock lock;
    char part[128];
    snprintf(part, sizeof part, "%s.99999999-0.part", lock_file);
    for (int has_linked = 0; has_linked < 2; has_linked++) {
        put("process 99999999 on a host\n", 27);
        assert_int_equal(has_linked ? link(lock_file, part) : rename(lock_file, part), 0);
        assert_int_equal(result_lock_take(&lock, result), STATUS_OK);
        result_lock_release(&lock);
        assert_int_not_equal(access(lock_file, F_OK), 0);
        assert_int_not_equal(access(part, F_OK), 0);
    }
}

static void studies_share_a_folder_but_not_its_members(void **state) {
    (void)state;
    struct result_lock one, other, all;
    char file[64];
    snprintf(file, sizeof file, "%s/study.lock", folder);
    assert_int_equal(result_lock_members(&one, folder, 0, 4), STATUS_OK);
    assert_int_equal(result_lock_members(&other, folder, 3, 2), STATUS_FILE);
    if (!strstr(status_message(), "another study runs some of the same members")) fail_msg("%s", status_message());
    assert_int_equal(result_lock_members(&other, folder, 4, 2), STATUS_OK);
    assert_int_equal(result_lock_members(&all, folder, 0, 0), STATUS_FILE);
    // the last one removes the file
    result_lock_release(&one);
    assert_int_equal(access(file, F_OK), 0);
    assert_int_equal(result_lock_members(&all, folder, 0, 0), STATUS_FILE);
    result_lock_release(&other);
    assert_int_not_equal(access(file, F_OK), 0);
    assert_int_equal(result_lock_members(&all, folder, 0, 0), STATUS_OK);
    assert_int_equal(result_lock_members(&one, folder, 7, 1), STATUS_FILE);
    result_lock_release(&all);
    assert_int_not_equal(access(file, F_OK), 0);
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
        cmocka_unit_test(two_runs_of_one_process_exclude_each_other),
        cmocka_unit_test(a_fork_does_not_release_the_lock),
        cmocka_unit_test(a_file_that_is_no_lock_is_not_touched),
        cmocka_unit_test(what_a_power_cut_leaves_of_a_lock_is_removed_and_an_empty_file_stays),
        cmocka_unit_test(of_runs_that_race_one_has_the_lock_and_no_file_stays),
        cmocka_unit_test(a_study_that_joins_while_another_writes_its_name_sees_a_lock),
        cmocka_unit_test(a_file_system_without_links_has_locks_too),
        cmocka_unit_test(the_remains_of_a_run_that_died_while_it_made_its_lock_are_removed),
        cmocka_unit_test(studies_share_a_folder_but_not_its_members),
        cmocka_unit_test(links_are_not_followed),
        cmocka_unit_test(work_is_done_under_the_lock_and_only_then),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
