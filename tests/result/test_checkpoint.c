/* test_checkpoint.c: A checkpoint that was written is read back, and one that is damaged in any way is refused. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <zlib.h>

#include "base/version.h"
#include "result/checkpoint.h"
#include "result/durable.h"
#include "result/sections.h"
#include "school.h"
#include "state/state.h"

#define SCHOOL                                                                                                \
    "time: {end: 1, shedding_interval: 0.02}\nfish: [{name: a}, {nodes: 5, start: {position: [1, 2]}, wave: " \
    "{frequency: "                                                                                            \
    "2}}]\n"

static char folder[] = "/tmp/test_checkpoint_XXXXXX", path[64], previous[64];
static struct setup setup;
static struct arena *arena;
static unsigned char *whole;
static size_t n_whole;

static const struct checkpoint written = {.effective = "format: 1\n",
                                          .result = "run.nc",
                                          .places = "0.3,1.25",
                                          .rows = {12, 0xdeadbeef},
                                          .totals = {.steps = 1,
                                                     .steps_of_order = {10, 11, 12, 13, 14},
                                                     .residual_evaluations = 2,
                                                     .newton_iterations = 3,
                                                     .jacobian_evaluations = 4,
                                                     .klu_analyses = 15,
                                                     .klu_factorisations = 16,
                                                     .klu_refactorisations = 17,
                                                     .gmres_iterations = 18,
                                                     .error_test_failures = 5,
                                                     .convergence_failures = 6,
                                                     .initial_iterations = 19,
                                                     .jacobian_non_zeros = 20,
                                                     .factor_non_zeros = 21,
                                                     .step_size = 7.5,
                                                     .order = 2},
                                          .wall_time = 1e5};

static int set_up(void **state) {
    (void)state;
    if (!mkdtemp(folder)) return -1;
    snprintf(path, sizeof path, "%s/run.ckpt", folder);
    snprintf(previous, sizeof previous, "%s/run.ckpt.previous", folder);
    school_build(&setup, SCHOOL);
    arena = arena_create(NULL, "a test");
    for (int i = 0; i < 30; i++) wake_release(&setup.state->wake[1], i, i + 0.5, 1, 2);
    setup.state->t = 0.6;
    setup.state->event = 30;
    state_reserve(setup.state, setup.school);
    for (int f = 0; f < 2; f++) state_remember(&setup.state->history[f], &(struct sample){.speed = NAN, .heading = f});
    for (int i = 0; i < setup.school->n_unknowns; i++) setup.state->y[i] = 1.0 / (i + 1);
    school_ok(checkpoint_write(arena, path, previous, &written, setup.state, setup.school));
    school_ok(durable_read(arena, path, &whole, &n_whole));
    return 0;
}

static int tear_down(void **state) {
    (void)state;
    arena_free(arena);
    school_clear(&setup);
    unlink(path);
    unlink(previous);
    return rmdir(folder);
}

TEST_GROUP(set_up, tear_down)

TEST(all_that_is_written_is_read) {
    struct checkpoint read;
    school_ok(checkpoint_read(arena, &read, path));
    school_ok(checkpoint_check_program(&read));
    assert_string_equal(read.effective, written.effective);
    assert_string_equal(read.result, written.result);
    assert_string_equal(read.places, written.places);
    char processor[VERSION_LENGTH];
    version_processor(processor);
    assert_string_equal(read.processor, processor);
    assert_int_equal(read.rows.n_rows, written.rows.n_rows);
    assert_int_equal(read.rows.check, written.rows.check);
    assert_memory_equal(&read.totals, &written.totals, sizeof read.totals);
    NEAR(read.wall_time, 1e5, 0, 0);
    NEAR(read.t, 0.6, 0, 0);
    struct state *const fresh = state_create(NULL, setup.school);
    school_ok(checkpoint_set_state(&read, fresh, setup.school));
    for (int i = 0; i < state_table_n; i++) {
        const struct state_row *const row = &state_table[i];
        BELOW(strlen(row->name), SECTIONS_NAME);
        for (int f = 0; f < state_table_n_owners(row, setup.school) && row->type != STATE_UNKEPT; f++) {
            const size_t n = state_table_length(row, setup.state, setup.school, f);
            assert_int_equal(state_table_length(row, fresh, setup.school, f), n);
            if (n == 0) continue;
            assert_memory_equal(state_table_values(row, fresh, f), state_table_values(row, setup.state, f),
                                n * state_table_size(row));
        }
    }
    state_free(fresh);
}

TEST(info_sums_up_the_run) {
    char *text = NULL;
    size_t size = 0;
    FILE *const stream = open_memstream(&text, &size);
    school_ok(checkpoint_info(arena, path, CHECKPOINT_STATE, stream));
    fclose(stream);
    assert_non_null(strstr(text, ": a run at t = 0.6 s; the result is run.nc, with 12 rows up to this time\n"));
    assert_non_null(strstr(text, "\nplaces     --checkpoint-at 0.3,1.25\n"));
    assert_non_null(strstr(text, "so far     1 steps, 2 residuals, 4 Jacobians in 1e+05 s\n"));
    free(text);
}

TEST(every_bit_that_flips_is_noticed) {
    school_ok(sections_check(whole, n_whole));
    for (size_t byte = 0; byte < n_whole; byte++) {
        // all bits of the first ones, one of the others
        for (int bit = byte < 400 ? 0 : (int)(byte % 8); bit < (byte < 400 ? 8 : (int)(byte % 8) + 1); bit++) {
            whole[byte] ^= (unsigned char)(1 << bit);
            if (sections_check(whole, n_whole) != STATUS_FILE) fail_msg("bit %d of byte %zu", bit, byte);
            whole[byte] ^= (unsigned char)(1 << bit);
        }
    }
    school_ok(sections_check(whole, n_whole));
}

TEST(every_truncation_is_noticed_and_so_is_more) {
    for (size_t n = 0; n < n_whole; n++) {
        if (sections_check(whole, n) != STATUS_FILE) fail_msg("%zu of %zu bytes", n, n_whole);
    }
    unsigned char *const more = arena_new(test_arena(), n_whole + 1, 1);
    memcpy(more, whole, n_whole);
    assert_int_equal(sections_check(more, n_whole + 1), STATUS_FILE);
}

// write the bytes with another format or order of bytes, and a checksum that fits
static void other_format(size_t at, uint32_t number, const char *reason) {
    enum { CHECK_AT = 24 };
    unsigned char *const bytes = memcpy(arena_new(test_arena(), n_whole, 1), whole, n_whole);
    memcpy(bytes + at, &number, sizeof number);
    const uint32_t check = (uint32_t)crc32(0, bytes, CHECK_AT);
    memcpy(bytes + CHECK_AT, &check, sizeof check);
    assert_int_equal(sections_check(bytes, n_whole), STATUS_FILE);
    if (!strstr(status_message(), reason)) fail_msg("%s", status_message());
}

TEST(another_format_is_refused_by_name) {
    other_format(8, 2, "format 2, but this program reads format");
    other_format(12, 0x04030201, "format");
    assert_int_equal(sections_check((const unsigned char *)"CDF\5", 4), STATUS_FILE);
    assert_non_null(strstr(status_message(), "not a checkpoint of shoal"));
}

// a checkpoint of other strings and numbers, all of them with checksums that fit
static void crafted(const char *section, const void *bytes, size_t n, const char *reason) {
    struct sections_writer writer;
    struct checkpoint read;
    char name[SECTIONS_NAME];
    sections_start(arena, &writer);
    for (size_t at = 28; at < n_whole;) {
        uint64_t size;
        memcpy(name, whole + at, sizeof name);
        memcpy(&size, whole + at + SECTIONS_NAME, sizeof size);
        sections_open(&writer, name);
        if (strcmp(name, section) == 0) sections_add(&writer, bytes, n);
        if (strcmp(name, section) != 0) sections_add(&writer, whole + at + SECTIONS_NAME + 8, size);
        sections_close(&writer);
        at += SECTIONS_NAME + 8 + size + 4;
    }
    sections_finish(&writer);
    school_ok(durable_replace(path, previous, writer.bytes, writer.n));
    enum status status = checkpoint_read(arena, &read, path);
    if (status == STATUS_OK) {
        struct state *const fresh = state_create(NULL, setup.school);
        status = checkpoint_check_program(&read);
        if (status == STATUS_OK) status = checkpoint_set_state(&read, fresh, setup.school);
        state_free(fresh);
    }
    assert_int_equal(status, STATUS_FILE);
    if (!strstr(status_message(), reason)) fail_msg("%s instead of %s", status_message(), reason);
}

TEST(what_no_run_has_written_is_refused) {
    const int many[] = {0, 1 << 30}, negative[] = {0, -1}, few[] = {0, 29}, large = 1 << 20;
    crafted("program", "shoal 9", 7, "written by shoal 9, but this program is ");
    crafted("libraries", "SUNDIALS 1", 10, "written by SUNDIALS 1, but this program is ");
    crafted("result", "../run.nc", 9, "section 'result' is invalid");
    crafted("rows", "\xff\xff\xff\xff\xff\xff\xff\xff", 8, "section 'result' is invalid");
    crafted("steps", "1234567", 7, "section 'steps' is invalid");
    crafted("steps", "123456789", 9, "section 'steps' is invalid");
    crafted("t", "", 0, "section 't' is invalid");
    crafted("y", "12345678", 8, "section 'y' is invalid");
    crafted("wake.n_vortex", many, sizeof many, "section 'wake.n_vortex' is invalid");
    crafted("wake.n_vortex", negative, sizeof negative, "section 'wake.n_vortex' is invalid");
    crafted("history.n_slots", many, sizeof many, "section 'history.n_slots' is invalid");
    crafted("history.n_slots", negative, sizeof negative, "section 'history.n_slots' is invalid");
    crafted("wake.n_vortex", few, sizeof few, "section 'wake.x' is invalid");
    crafted("history.last", (const int[]){large, large}, 8, "the state does not fit this case");
    crafted("balance.n", (const int[]){3, 3}, 8, "the state does not fit this case");
    // a section that is missing
    crafted("wake.birth", NULL, 0, "section 'wake.birth' is invalid");
}

/* A value that is not finite, in a checkpoint whose checksums fit, is refused with the name of its field. */
TEST(values_that_are_not_finite_are_refused) {
    const double wrong[] = {NAN, INFINITY};
    int n_refused = 0;
    for (int i = 0; i < state_table_n; i++) {
        const struct state_row *const row = &state_table[i];
        const struct section_reader section = sections_find(whole, n_whole, row->name);
        if (row->type != STATE_REAL || section.left == 0) continue;
        unsigned char *const bytes = arena_new(test_arena(), section.left, 1);
        // the last value too: that of the last fish
        const size_t places[] = {0, section.left - sizeof(double)};
        for (int k = 0; k < 4; k++) {
            if (strcmp(row->name, "closest.distance") == 0) continue;  // infinite where a fish is alone
            memcpy(bytes, section.next, section.left);
            memcpy(bytes + places[k % 2], &wrong[k / 2], sizeof(double));
            crafted(row->name, bytes, section.left, strcmp(row->name, "t") == 0 ? "value 0 of 't' is" : row->name);
            n_refused++;
        }
    }
    ABOVE(n_refused, 100);
    crafted("wall_time", &wrong[0], sizeof wrong[0], "section 'wall_time' is invalid");
    crafted("step_size", &wrong[1], sizeof wrong[1], "section 'step_size' is invalid");
    crafted("t", &(double){0.62}, sizeof(double), "the state does not fit this case");
}

/* What a machine of the other order of bytes would write: all numbers the other way round. */
TEST(a_checkpoint_of_the_other_order_of_bytes_is_refused_by_name) {
    unsigned char *const other = arena_new(test_arena(), n_whole, 1);
    const size_t numbers[][2] = {{8, 4}, {12, 4}, {16, 8}};
    memcpy(other, whole, n_whole);
    for (int i = 0; i < 3; i++) {
        for (size_t k = 0; k < numbers[i][1]; k++)
            other[numbers[i][0] + k] = whole[numbers[i][0] + numbers[i][1] - 1 - k];
    }
    const uint32_t check = (uint32_t)crc32_z(crc32_z(0, NULL, 0), other, 24);
    for (int k = 0; k < 4; k++) other[24 + k] = (unsigned char)(check >> (24 - 8 * k));
    school_ok(durable_replace(path, previous, other, n_whole));
    struct checkpoint read;
    assert_int_equal(checkpoint_read(arena, &read, path), STATUS_FILE);
    if (!strstr(status_message(), "written on a machine with another byte order")) fail_msg("%s", status_message());
    school_ok(durable_replace(path, previous, whole, n_whole));
}

TEST(only_checkpoints_may_be_replaced) {
    char other[64];
    snprintf(other, sizeof other, "%s/other", folder);
    school_ok(checkpoint_check_target(arena, other, "run.nc"));
    school_ok(checkpoint_check_target(arena, path, "run.nc"));
    assert_int_equal(checkpoint_check_target(arena, path, "run"), STATUS_FILE);
    if (!strstr(status_message(), "is a checkpoint of run.nc")) fail_msg("%s", status_message());
    FILE *const file = fopen(other, "w");
    fputs("SHOAL is not enough", file);
    fclose(file);
    assert_int_equal(checkpoint_check_target(arena, other, "run.nc"), STATUS_FILE);
    assert_int_equal(checkpoint_check_target(arena, folder, "run.nc"), STATUS_FILE);
    unlink(other);
    assert_int_equal(symlink(path, other), 0);
    assert_int_equal(checkpoint_check_target(arena, other, "run.nc"), STATUS_FILE);
    unlink(other);
}
