/* test_durable.c: a file is replaced as a whole, and the one before it is kept. */
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "near.h"
#include "result/durable.h"

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
    assert_int_equal(durable_read(name, &bytes, &n), STATUS_OK);
    assert_int_equal(n, strlen(want));
    assert_memory_equal(bytes, want, n);
    free(bytes);
}

static void the_last_two_are_kept(void **state) {
    (void)state;
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

static void a_part_is_new_locked_and_becomes_the_target_as_a_whole(void **state) {
    (void)state;
    struct durable_part part;
    put(path, "old");
    assert_int_equal(durable_begin(&part, path, 0666), 0);
    assert_int_equal(durable_write(part.descriptor, "new", 3), 0);
    assert_int_equal(n_files(), 2);
    const int again = open(part.name, O_RDWR);
    assert_int_equal(durable_lock(again, 0, 0), EAGAIN);
    close(again);
    holds(path, "old");
    assert_int_equal(durable_publish(&part, false), EEXIST);
    holds(path, "old");
    assert_int_equal(durable_publish(&part, true), 0);
    holds(path, "new");
    durable_end(&part);
    assert_int_equal(n_files(), 1);
    unlink(path);
}

static void a_part_that_is_given_up_leaves_what_was_there(void **state) {
    (void)state;
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
    assert_null(part.name);
    durable_end(&part);
}

static void a_link_under_the_name_of_a_part_is_not_followed(void **state) {
    (void)state;
    struct durable_part part;
    char name[128], target[64];
    unsigned long first;
    snprintf(target, sizeof target, "%s/target", folder);
    put(target, "mine");
    assert_int_equal(durable_begin(&part, path, 0666), 0);
    assert_int_equal(sscanf(strrchr(part.name, '-'), "-%lu", &first), 1);
    durable_end(&part);
    for (unsigned long i = 1; i <= 3; i++) {
        snprintf(name, sizeof name, "%s.%ld-%lu.part", path, (long)getpid(), first + i);
        assert_int_equal(symlink(target, name), 0);
    }
    assert_int_equal(durable_replace(path, previous, "new", 3), STATUS_OK);
    holds(path, "new");
    holds(target, "mine");
    // nothing is swept away but files of our own
    durable_sweep(path);
    assert_int_equal(n_files(), 5);
    for (unsigned long i = 1; i <= 3; i++) {
        snprintf(name, sizeof name, "%s.%ld-%lu.part", path, (long)getpid(), first + i);
        unlink(name);
    }
    unlink(path);
    unlink(target);
}

static void only_parts_that_nobody_makes_any_more_are_swept_away(void **state) {
    (void)state;
    // a part with the name of this process, locked; one of a process that died; files that are none of ours
    struct durable_part part;
    const char *const foreign[] = {"a.1-2.part", "a.part", "a.1-2.parts", "a.x-2.part", "b.1-2.part"};
    const char *const texts[] = {"mine", "", "", "", ""};
    char name[5][64], stale[3][64];
    assert_int_equal(durable_begin(&part, path, 0666), 0);
    for (int i = 0; i < 5; i++) {
        snprintf(name[i], sizeof name[i], "%s/%s", folder, foreign[i]);
        put(name[i], texts[i]);
    }
    for (int i = 0; i < 3; i++) {
        snprintf(stale[i], sizeof stale[i], "%s/a%s.123-%d.part", folder, i == 2 ? ".previous" : "", i);
        put(stale[i], i == 0 ? "CDF\1" : i == 1 ? "" : "SHOAL\r\n\x1a...");
    }
    assert_int_equal(n_files(), 9);
    durable_sweep(path);
    assert_int_equal(n_files(), 6);
    for (int i = 0; i < 3; i++) assert_int_not_equal(access(stale[i], F_OK), 0);
    assert_int_equal(access(part.name, F_OK), 0);
    durable_end(&part);
    for (int i = 0; i < 5; i++) assert_int_equal(unlink(name[i]), 0);
}

static void a_lock_belongs_to_an_open_file_and_not_to_the_process(void **state) {
    (void)state;
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

static void a_failure_leaves_what_was_there(void **state) {
    (void)state;
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

static void only_ordinary_files_are_read_and_a_pipe_is_not_waited_for(void **state) {
    (void)state;
    unsigned char *bytes;
    size_t n;
    assert_int_equal(mkfifo(path, 0666), 0);
    const char *const wrong[] = {path, folder, "/dev/zero", previous};
    for (int i = 0; i < 4; i++) {
        assert_int_equal(durable_read(wrong[i], &bytes, &n), STATUS_FILE);
        assert_null(bytes);
    }
    unlink(path);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_last_two_are_kept),
        cmocka_unit_test(a_part_is_new_locked_and_becomes_the_target_as_a_whole),
        cmocka_unit_test(a_part_that_is_given_up_leaves_what_was_there),
        cmocka_unit_test(a_link_under_the_name_of_a_part_is_not_followed),
        cmocka_unit_test(only_parts_that_nobody_makes_any_more_are_swept_away),
        cmocka_unit_test(a_lock_belongs_to_an_open_file_and_not_to_the_process),
        cmocka_unit_test(a_failure_leaves_what_was_there),
        cmocka_unit_test(only_ordinary_files_are_read_and_a_pipe_is_not_waited_for),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
