/* test_durable.c: A file is replaced as a whole, and the file before it is kept until then. */
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "near.h"
#include "result/durable.h"

// fsync of a folder fails
static int folder_fails;
int __real_fsync(int descriptor);
int __wrap_fsync(int descriptor);
int __wrap_fsync(int descriptor) {
    struct stat facts;
    if (folder_fails && fstat(descriptor, &facts) == 0 && S_ISDIR(facts.st_mode)) {
        errno = EIO;
        return -1;
    }
    return __real_fsync(descriptor);
}

// a read is interrupted once, or ends too early
static int read_is_interrupted, read_is_short;
ssize_t __real_read(int descriptor, void *bytes, size_t n);
ssize_t __wrap_read(int descriptor, void *bytes, size_t n);
ssize_t __wrap_read(int descriptor, void *bytes, size_t n) {
    if (read_is_short) return 0;
    if (!read_is_interrupted) return __real_read(descriptor, bytes, n);
    read_is_interrupted = 0;
    errno = EINTR;
    return -1;
}

static char folder[] = "/tmp/test_durable_XXXXXX", path[64], previous[64];

static int set_up(void **state) {
    (void)state;
    if (!mkdtemp(folder)) return -1;
    snprintf(path, sizeof path, "%s/a", folder);
    snprintf(previous, sizeof previous, "%s/a.previous", folder);
    return 0;
}

static int tear_down(void **state) {
    (void)state;
    return rmdir(folder);
}

TEST_GROUP(set_up, tear_down)

static void put(const char *name, const char *text) {
    FILE *const file = fopen(name, "w");
    fputs(text, file);
    fclose(file);
}

static int n_files(void) {
    int n = 0;
    DIR *const entries = opendir(folder);
    for (const struct dirent *entry; (entry = readdir(entries));) n += entry->d_name[0] != '.';
    closedir(entries);
    return n;
}

static void holds(const char *name, const char *want) {
    unsigned char *bytes;
    size_t n;
    struct arena *const arena = arena_create(NULL, "a test");
    assert_int_equal(durable_read(arena, name, &bytes, &n), STATUS_OK);
    assert_int_equal(n, strlen(want));
    assert_memory_equal(bytes, want, n);
    arena_free(arena);
}

static void ok(enum status status) {
    if (status != STATUS_OK) fail_msg("%s", status_message());
}

TEST(the_last_two_are_kept) {
    const char *const texts[] = {"first", "second one", "third"};
    for (int i = 0; i < 3; i++) {
        assert_int_equal(durable_replace(path, previous, texts[i], strlen(texts[i])), STATUS_OK);
        holds(path, texts[i]);
        if (i > 0) holds(previous, texts[i - 1]);
        assert_int_equal(n_files(), i > 0 ? 2 : 1);
    }
    unlink(path);
    unlink(previous);
}

// ---- files in the making

TEST(a_part_is_new_locked_and_becomes_the_target_as_a_whole) {
    struct durable_part part;
    put(path, "old");
    assert_int_equal(durable_begin(&part, path, 0666), 0);
    assert_int_equal(durable_write(part.descriptor, "new", 3), 0);
    assert_int_equal(n_files(), 2);
    // one name, and one process that makes the file
    struct durable_part again;
    char name[128];
    snprintf(name, sizeof name, "%s.part", path);
    assert_string_equal(part.name, name);
    assert_int_equal(durable_begin(&again, path, 0666), EAGAIN);
    durable_end(&again);
    holds(name, "new");
    holds(path, "old");
    assert_int_equal(durable_publish(&part, false), EEXIST);
    holds(path, "old");
    assert_int_equal(durable_publish(&part, true), 0);
    holds(path, "new");
    durable_end(&part);
    assert_int_equal(n_files(), 1);
    unlink(path);
}

TEST(a_part_that_is_given_up_leaves_what_was_there) {
    struct durable_part part;
    put(path, "old");
    assert_int_equal(durable_begin(&part, path, 0666), 0);
    durable_end(&part);
    durable_end(&part);
    holds(path, "old");
    assert_int_equal(n_files(), 1);
    unlink(path);
    // where nothing can be created nothing is removed
    assert_int_equal(durable_begin(&part, "/no/folder/a", 0666), ENOENT);
    assert_string_equal(part.name, "");
    durable_end(&part);
}

TEST(a_part_is_no_file_of_another_program_and_no_link) {
    char name[128], target[64];
    snprintf(target, sizeof target, "%s/target", folder);
    snprintf(name, sizeof name, "%s.part", path);
    put(target, "CDF mine");
    for (int i = 0; i < 5; i++) {
        struct durable_part part;
        struct durable_claim claim;
        if (i == 0) assert_int_equal(symlink(target, name), 0);
        if (i == 1) assert_int_equal(link(target, name), 0);
        if (i == 2) put(name, "mine");
        if (i == 3) assert_int_equal(mkfifo(name, 0666), 0);
        if (i == 4) assert_int_equal(mkdir(name, 0777), 0);
        assert_int_equal(durable_begin(&part, path, 0666), ENOTUNIQ);
        durable_end(&part);
        assert_int_equal(durable_claim_take(&claim, path), STATUS_FILE);
        assert_non_null(strstr(status_message(), "a.part exists and is no file of shoal"));
        durable_discard(path);
        holds(target, "CDF mine");
        if (i == 2) holds(name, "mine");
        assert_int_equal(n_files(), 2);
        assert_int_equal(remove(name), 0);
    }
    unlink(target);
}

TEST(the_part_of_a_process_that_died_is_used_again) {
    char name[128];
    snprintf(name, sizeof name, "%s.part", path);
    static const char *const left[] = {"", "CDF\1 of a run that died", "SHOAL\r\n\x1a...", "<!DOCTYPE html>..."};
    for (int i = 0; i < 4; i++) {
        put(name, left[i]);
        assert_int_equal(durable_replace(path, NULL, "new", 3), STATUS_OK);
        holds(path, "new");
        assert_int_equal(n_files(), 1);
        unlink(path);
        put(name, left[i]);
        durable_discard(path);
        assert_int_equal(n_files(), 0);
    }
}

static void end_by_signal(int number) {
    durable_remove_parts();
    _exit(number);
}

TEST(an_end_by_a_signal_leaves_no_part_of_its_own) {
    struct durable_part of_parent, part;
    assert_int_equal(durable_begin(&of_parent, path, 0666), 0);
    const pid_t child = fork();
    if (child == 0) {
        // more parts than are noted, of which some are published and some ended
        char name[80];
        for (int i = 0; i < 20; i++) {
            snprintf(name, sizeof name, "%s/of_child_%d", folder, i);
            if (durable_begin(&part, name, 0666) != 0) _exit(1);
            if (i == 10 && durable_publish(&part, false) != 0) _exit(1);
            if (i < 18) durable_end(&part);
        }
        signal(SIGTERM, end_by_signal);
        raise(SIGTERM);
    }
    int outcome;
    assert_int_equal(waitpid(child, &outcome, 0), child);
    assert_true(WIFEXITED(outcome) && WEXITSTATUS(outcome) == SIGTERM);

    // the part of the parent, and the file that is published
    assert_int_equal(n_files(), 2);
    durable_end(&of_parent);
    char published[80];
    snprintf(published, sizeof published, "%s/of_child_10", folder);
    assert_int_equal(unlink(published), 0);
    assert_int_equal(n_files(), 0);
}

// ---- claims

TEST(a_claim_excludes_runs_of_this_and_of_other_processes) {
    struct durable_claim one, other;
    for (int exists = 0; exists < 2; exists++) {
        if (exists) put(path, "CDF");
        ok(durable_claim_take(&one, path));
        assert_int_equal(durable_claim_take(&other, path), STATUS_FILE);
        assert_non_null(strstr(status_message(), "another run writes this result"));
        assert_string_equal(other.part, "");
        const pid_t child = fork();
        if (child == 0) _exit(durable_claim_take(&other, path) == STATUS_FILE ? 0 : 1);
        int outcome;
        assert_int_equal(waitpid(child, &outcome, 0), child);
        assert_int_equal(outcome, 0);
        assert_int_equal(n_files(), 1 + exists);
        durable_claim_release(&one);
        durable_claim_release(&one);
        assert_int_equal(n_files(), exists);
        ok(durable_claim_take(&other, path));
        durable_claim_release(&other);
    }
    unlink(path);
}

TEST(a_claim_goes_with_the_file_to_its_name_and_to_all_others) {
    struct durable_claim one, other;
    struct durable_part part;
    char second[64];
    snprintf(second, sizeof second, "%s/second", folder);

    // the claim of a run covers the part that the run makes
    ok(durable_claim_take(&one, path));
    assert_int_equal(durable_begin(&part, path, 0666), 0);
    assert_int_equal(durable_write(part.descriptor, "CDF", 3), 0);
    assert_int_equal(durable_publish(&part, false), 0);
    durable_end(&part);
    assert_int_equal(n_files(), 1);
    assert_int_equal(durable_claim_take(&other, path), STATUS_FILE);
    assert_int_equal(n_files(), 1);
    assert_int_equal(link(path, second), 0);
    assert_int_equal(durable_claim_take(&other, second), STATUS_FILE);
    assert_int_equal(n_files(), 2);
    durable_claim_release(&one);
    holds(path, "CDF");
    ok(durable_claim_take(&other, second));
    assert_int_equal(durable_claim_take(&one, path), STATUS_FILE);
    durable_claim_release(&other);
    unlink(second);
    unlink(path);
}

TEST(a_fork_does_not_release_a_claim) {
    struct durable_claim one, other;
    ok(durable_claim_take(&one, path));
    const pid_t child = fork();
    if (child == 0) {
        durable_claim_release(&one);
        _exit(*one.part == '\0' ? 0 : 1);
    }
    int outcome;
    assert_int_equal(waitpid(child, &outcome, 0), child);
    assert_int_equal(outcome, 0);
    assert_int_equal(n_files(), 1);
    assert_int_equal(durable_claim_take(&other, path), STATUS_FILE);
    durable_claim_release(&one);
    assert_int_equal(n_files(), 0);
}

TEST(a_fork_that_lives_on_does_not_keep_a_released_claim) {
    struct durable_claim one, other;
    struct durable_part part;

    // a new result, then one that replaces it: the claim covers both files
    for (int exists = 0; exists < 2; exists++) {
        int end[2];
        ok(durable_claim_take(&one, path));
        assert_int_equal(durable_begin(&part, path, 0666), 0);
        assert_int_equal(durable_write(part.descriptor, "CDF", 3), 0);
        assert_int_equal(durable_publish(&part, true), 0);
        durable_end(&part);
        assert_int_equal(pipe(end), 0);
        const pid_t child = fork();
        if (child == 0) {
            // until the parent closes the pipe
            char byte;
            close(end[1]);
            _exit(read(end[0], &byte, 1) == 0 ? 0 : 1);
        }
        durable_claim_release(&one);
        ok(durable_claim_take(&other, path));
        durable_claim_release(&other);
        close(end[0]);
        close(end[1]);
        int outcome;
        assert_int_equal(waitpid(child, &outcome, 0), child);
        assert_int_equal(outcome, 0);
    }
    unlink(path);
}

TEST(a_process_that_ends_without_releasing_its_claim_leaves_no_part) {
    struct durable_claim one, other;
    ok(durable_claim_take(&one, path));
    const pid_t child = fork();
    if (child == 0) {
        // the claim of the parent stays
        durable_remove_parts();
        if (n_files() != 1) _exit(1);
        char place[PATH_MAX];
        snprintf(place, sizeof place, "%s.other", path);
        if (durable_claim_take(&other, place) != STATUS_OK || n_files() != 2) _exit(2);
        durable_remove_parts();
        _exit(n_files() == 1 ? 0 : 3);
    }
    int outcome;
    assert_int_equal(waitpid(child, &outcome, 0), child);
    assert_int_equal(outcome, 0);
    durable_claim_release(&one);
    assert_int_equal(n_files(), 0);
}

TEST(of_runs_that_race_one_has_the_claim_and_no_part_stays) {
    // each process takes the claim, publishes its file, and removes it again, as fast as it can
    enum { RIVALS = 4, ROUNDS = 300 };
    pid_t child[RIVALS];
    for (int r = 0; r < RIVALS; r++) {
        child[r] = fork();
        if (child[r] > 0) continue;
        int n_taken = 0, is_bad = 0;
        for (int i = 0; i < ROUNDS || n_taken == 0; i++) {
            struct durable_claim claim;
            struct durable_part part;
            if (durable_claim_take(&claim, path) != STATUS_OK) continue;
            n_taken++;
            // nobody else makes, publishes or removes the file meanwhile
            is_bad |= durable_begin(&part, path, 0666) != 0;
            is_bad |= durable_publish(&part, n_taken % 2 == 0) != 0;
            is_bad |= !durable_has_name(part.descriptor, path);
            is_bad |= unlink(path) != 0;
            durable_end(&part);
            durable_claim_release(&claim);
        }
        _exit(is_bad);
    }
    for (int r = 0; r < RIVALS; r++) {
        int outcome;
        assert_int_equal(waitpid(child[r], &outcome, 0), child[r]);
        assert_int_equal(outcome, 0);
    }
    assert_int_equal(n_files(), 0);
}

TEST(a_lock_belongs_to_an_open_file_and_not_to_the_process) {
    put(path, "");
    const int one = open(path, O_RDWR), two = open(path, O_RDWR);
    assert_int_equal(durable_lock(one, 0, 4), 0);
    assert_int_equal(durable_lock(two, 3, 2), EAGAIN);
    assert_int_equal(durable_lock(two, 4, 2), 0);
    assert_int_equal(durable_lock(one, 0, 0), EAGAIN);
    // another descriptor of the same file frees nothing when it is closed
    close(open(path, O_RDWR));
    assert_int_equal(durable_lock(two, 3, 2), EAGAIN);
    assert_true(durable_has_name(one, path));
    unlink(path);
    assert_false(durable_has_name(one, path));
    close(one);
    close(two);
}

TEST(a_failure_leaves_what_was_there) {
    assert_int_equal(durable_replace(path, previous, "good", 4), STATUS_OK);
    assert_int_equal(mkdir(previous, 0777), 0);
    assert_int_equal(durable_replace(path, previous, "bad", 3), STATUS_FILE);
    if (!strstr(status_message(), path)) fail_msg("%s", status_message());
    holds(path, "good");
    assert_int_equal(n_files(), 2);
    rmdir(previous);
    unlink(path);
    assert_int_equal(durable_replace("/no/folder/a", "/no/folder/b", "x", 1), STATUS_FILE);
    assert_int_equal(durable_sync_folder("/tmp/a"), 0);
}

TEST(a_name_that_is_not_on_the_disk_is_an_error) {
    struct durable_part part;
    assert_int_equal(durable_begin(&part, path, 0666), 0);
    folder_fails = 1;
    assert_int_equal(durable_sync_folder(path), EIO);
    assert_int_equal(durable_publish(&part, false), EIO);
    durable_end(&part);
    assert_int_equal(durable_replace(path, previous, "x", 1), STATUS_FILE);
    folder_fails = 0;
    unlink(path);
    unlink(previous);
}

TEST(a_read_is_repeated_and_complete) {
    put(path, "sound");
    read_is_interrupted = 1;
    holds(path, "sound");
    assert_int_equal(read_is_interrupted, 0);
    unsigned char *bytes;
    size_t n;
    struct arena *const arena = arena_create(NULL, "a test");
    read_is_short = 1;
    assert_int_equal(durable_read(arena, path, &bytes, &n), STATUS_FILE);
    read_is_short = 0;
    arena_free(arena);
    unlink(path);
}

TEST(only_ordinary_files_are_read_and_a_pipe_is_not_waited_for) {
    unsigned char *bytes;
    size_t n;
    assert_int_equal(mkfifo(path, 0666), 0);
    const char *const wrong[] = {path, folder, "/dev/zero", previous};
    for (int i = 0; i < 4; i++) {
        struct arena *const arena = arena_create(NULL, "a test");
        assert_int_equal(durable_read(arena, wrong[i], &bytes, &n), STATUS_FILE);
        arena_free(arena);
    }
    unlink(path);
}
