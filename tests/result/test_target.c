/* test_target.c: The program recognises its own files, and refuses places at which it must not write. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "near.h"
#include "result/target.h"

static char folder[] = "/tmp/test_target_XXXXXX", path[64], other[64];

static int set_up(void **state) {
    (void)state;
    if (!mkdtemp(folder)) return -1;
    snprintf(path, sizeof path, "%s/a", folder);
    snprintf(other, sizeof other, "%s/b", folder);
    return 0;
}

static int tear_down(void **state) {
    (void)state;
    unlink(path);
    return rmdir(folder);
}

TEST_GROUP(set_up, tear_down)

static void put(const char *name, const void *bytes, size_t n) {
    FILE *const file = fopen(name, "w");
    assert_int_equal(fwrite(bytes, 1, n, file), n);
    fclose(file);
}

static void refused(enum target_kind kind, bool overwrite, const char *reason) {
    assert_int_equal(target_check(path, kind, overwrite), STATUS_FILE);
    if (!strstr(status_message(), reason) || !strstr(status_message(), path)) fail_msg("%s", status_message());
}

#define SAMPLE(text) text, sizeof(text) - 1

/* The shortest beginning of a file of every kind. */
static const struct sample {
    enum target_kind kind;
    const char *text;
    size_t n;
} samples[] = {
    {TARGET_NETCDF, SAMPLE("CDF\5\0\0\0\0\0\0\0\0\0\0\0\14shoal_schema")},
    {TARGET_NETCDF, SAMPLE("CDF\1\0\0\0\0shoal_field")},
    {TARGET_PAGE, SAMPLE("<!DOCTYPE html>\n<!-- A run of shoal to look at.")},
    {TARGET_VTK, SAMPLE("<?xml version=\"1.0\"?>\n" TARGET_VTK_MARK)},
    {TARGET_CHECKPOINT, SAMPLE("SHOAL\r\n\x1a")},
    {TARGET_PICTURE, SAMPLE("\x89PNG\r\n\x1a\n....tEXtSource\0shoal plot.py")},
    {TARGET_SCRIPT, SAMPLE("#!/bin/sh\n" TARGET_SCRIPT_MARK)},
    {TARGET_TABLE, SAMPLE(TARGET_TABLE_MARK)},
};
enum { N_SAMPLES = sizeof samples / sizeof *samples };

TEST(a_file_replaces_only_one_of_its_kind) {
    for (int i = 0; i < N_SAMPLES; i++) {
        put(path, samples[i].text, samples[i].n);
        for (enum target_kind kind = TARGET_NETCDF; kind <= TARGET_TABLE; kind++) {
            const bool is_same = kind == samples[i].kind;
            assert_int_equal(target_is(path, kind), is_same);
            assert_int_equal(target_check(path, kind, true), is_same ? STATUS_OK : STATUS_FILE);
            refused(kind, false,
                    is_same ? "exists: choose another name with -o or replace it with --force" : "exists and is no ");
        }
    }
}

TEST(a_file_without_the_mark_is_foreign_and_an_empty_one_is_free) {
    for (int i = 0; i < N_SAMPLES; i++) {
        // all but the last byte of the mark
        put(path, samples[i].text, samples[i].n - 1);
        assert_false(target_is(path, samples[i].kind));
        refused(samples[i].kind, true,
                "so no option replaces the file: remove the file, or choose another name with -o");
        put(path, "", 0);
        assert_int_equal(target_check(path, samples[i].kind, true), STATUS_OK);
    }
}

TEST(links_folders_and_pipes_are_refused) {
    unlink(path);
    assert_int_equal(symlink(other, path), 0);
    refused(TARGET_NETCDF, true, "is a link");
    unlink(path);
    assert_int_equal(mkdir(path, 0777), 0);
    refused(TARGET_NETCDF, true, "is a folder");
    rmdir(path);
    assert_int_equal(mkfifo(path, 0666), 0);
    refused(TARGET_NETCDF, true, "is not an ordinary file");
    assert_false(target_is(path, TARGET_NETCDF));
    unlink(path);
}

TEST(an_input_is_no_output_under_any_of_its_names) {
    put(path, "x", 1);
    assert_int_equal(link(path, other), 0);
    assert_int_equal(target_refuse_input(path, path), STATUS_FILE);
    assert_int_equal(target_refuse_input(other, path), STATUS_FILE);
    unlink(other);
    assert_int_equal(target_refuse_input(other, path), STATUS_OK);
    put(other, "x", 1);
    assert_int_equal(target_refuse_input(other, path), STATUS_OK);
    unlink(other);
}

TEST(the_beginning_of_a_file_may_be_cut_or_zeros) {
    const unsigned char zeros[8] = {0};
    assert_true(target_may_begin(zeros, 0));
    assert_true(target_may_begin(zeros, 8));
    for (int i = 0; i < N_SAMPLES; i++) {
        for (size_t n = 0; n <= samples[i].n; n++) {
            assert_true(target_may_begin((const unsigned char *)samples[i].text, n));
        }
    }
    assert_false(target_may_begin((const unsigned char *)"mine", 4));
    assert_false(target_may_begin((const unsigned char *)"\0\0mine", 6));
}

TEST(the_folder_of_a_file) {
    const char *const of[][2] = {{"a", "."}, {"b/a", "b"}, {"/a", "/"}, {"/b/c/a", "/b/c"}};
    for (int i = 0; i < 4; i++) {
        char found[PATH_MAX];
        target_folder(of[i][0], found);
        assert_string_equal(found, of[i][1]);
    }
}
