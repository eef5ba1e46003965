/* test_durable.c: a file is replaced as a whole, and the one before it is kept. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "near.h"
#include "output/durable.h"

static char folder[] = "/tmp/test_durable_XXXXXX", path[64], previous[64], part[64];

static int set_up(void **state) {
    (void)state;
    if (!mkdtemp(folder)) return -1;
    snprintf(path, sizeof path, "%s/a", folder);
    snprintf(previous, sizeof previous, "%s/a.previous", folder);
    snprintf(part, sizeof part, "%s/a.part", folder);
    return 0;
}

static int tear_down(void **state) {
    (void)state;
    return rmdir(folder);
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
        assert_int_not_equal(access(part, F_OK), 0);
    }
    unlink(path);
    unlink(previous);
}

static void what_was_left_half_made_is_replaced_and_a_link_not_followed(void **state) {
    (void)state;
    char target[64];
    snprintf(target, sizeof target, "%s/target", folder);
    FILE *const file = fopen(target, "w");
    fputs("mine", file);
    fclose(file);
    assert_int_equal(symlink(target, part), 0);
    assert_int_equal(durable_replace(path, previous, "new", 3), STATUS_OK);
    holds(path, "new");
    holds(target, "mine");
    unlink(path);
    unlink(target);
}

static void a_failure_leaves_what_was_there(void **state) {
    (void)state;
    assert_int_equal(durable_replace(path, previous, "good", 4), STATUS_OK);
    assert_int_equal(mkdir(part, 0777), 0);
    assert_int_equal(durable_replace(path, previous, "bad", 3), STATUS_FILE);
    if (!strstr(status_message(), path)) fail_msg("%s", status_message());
    holds(path, "good");
    rmdir(part);
    unlink(path);
    assert_int_equal(durable_replace("/no/folder/a", "/no/folder/b", "x", 1), STATUS_FILE);
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

static void the_folder_of_a_file(void **state) {
    (void)state;
    const char *const of[][2] = {{"a", "."}, {"b/a", "b"}, {"/a", "/"}, {"/b/c/a", "/b/c"}};
    for (int i = 0; i < 4; i++) {
        char found[PATH_MAX];
        durable_folder_of(of[i][0], found);
        assert_string_equal(found, of[i][1]);
        assert_int_equal(durable_sync_folder("/tmp/a"), 0);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_last_two_are_kept),
        cmocka_unit_test(what_was_left_half_made_is_replaced_and_a_link_not_followed),
        cmocka_unit_test(a_failure_leaves_what_was_there),
        cmocka_unit_test(only_ordinary_files_are_read_and_a_pipe_is_not_waited_for),
        cmocka_unit_test(the_folder_of_a_file),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
