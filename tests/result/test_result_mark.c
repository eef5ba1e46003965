/* test_result_mark.c: The rows of a result are marked, so that a run that is resumed finds them, cuts what comes after
 * them and continues. Other rows are refused. */
#include "result/netcdf.h"
#include "result/result_file.h"
#include "result_fixture.h"

static void are_equal(const struct result_mark *got, const struct result_mark *want) {
    assert_int_equal(got->n_rows, want->n_rows);
    assert_int_equal(got->check, want->check);
}

TEST_WITH(a_growing_file_has_the_marks_of_a_whole_one, set_up, tear_down) {
    struct fixture *const f = *state;
    struct result_file *const result = create(f);
    struct result_mark mark[3], again;
    for (int i = 0; i < 3; i++) {
        assert_int_equal(append(f, result, 0.1 * i, 1), STATUS_OK);
        assert_int_equal(result_file_mark(result, &mark[i]), STATUS_OK);
        assert_int_equal(mark[i].n_rows, i + 1);
    }
    assert_int_equal(result_file_close(result, "stopped"), STATUS_OK);
    for (int i = 0; i < 3; i++) {
        struct result_checksum checksum = {0};
        assert_int_equal(result_mark_take(f->path, i + 1, &checksum, &again), STATUS_OK);
        are_equal(&again, &mark[i]);
        bool is_complete;
        assert_int_equal(result_mark_check(f->arena, f->path, &mark[i], EFFECTIVE, &checksum, &is_complete), STATUS_OK);
        assert_false(is_complete);
    }
    assert_true(mark[0].check != mark[1].check && mark[1].check != mark[2].check);
    struct result_checksum checksum = {0};
    assert_int_equal(result_mark_take(f->path, 4, &checksum, &again), STATUS_FILE);
    assert_message("has 3 rows, but the checkpoint requires 4");
}

TEST_WITH(other_rows_and_other_cases_are_refused, set_up, tear_down) {
    struct fixture *const f = *state;
    struct result_checksum checksum = {0};
    struct result_mark mark;
    bool is_complete;
    write_file(f, 3);
    assert_int_equal(result_mark_take(f->path, 2, &checksum, &mark), STATUS_OK);
    assert_int_equal(result_mark_check(f->arena, f->path, &mark, EFFECTIVE, &checksum, &is_complete), STATUS_OK);
    assert_true(is_complete);
    assert_int_equal(result_mark_check(f->arena, f->path, &mark, "another", &checksum, &is_complete), STATUS_FILE);
    assert_message("is the result of another case");
    struct netcdf_rows rows;
    assert_int_equal(netcdf_read_rows(f->path, &rows), STATUS_OK);
    assert_int_equal(rows.n, 3);
    // a byte of the last row that counts, one of the row that does not
    const uint64_t places[] = {rows.begin_of_rows + 2 * rows.bytes - 1, rows.begin_of_rows + 2 * rows.bytes};
    const enum status want[] = {STATUS_FILE, STATUS_OK};
    for (int i = 0; i < 2; i++) {
        FILE *const file = fopen(f->path, "r+");
        fseek(file, (long)places[i], SEEK_SET);
        const int byte = fgetc(file);
        fseek(file, (long)places[i], SEEK_SET);
        fputc(byte ^ 1, file);
        fclose(file);
        assert_int_equal(result_mark_check(f->arena, f->path, &mark, EFFECTIVE, &checksum, &is_complete), want[i]);
        FILE *const back = fopen(f->path, "r+");
        fseek(back, (long)places[i], SEEK_SET);
        fputc(byte, back);
        fclose(back);
    }
}

/* After a power cut the header may count rows that have not reached the disk; or these end in the middle of one. */
TEST_WITH(only_the_rows_of_a_mark_have_to_be_there, set_up, tear_down) {
    struct fixture *const f = *state;
    struct netcdf_rows rows;
    struct result_mark mark;
    bool is_complete;
    struct result_origin origin = origin_of(f);
    origin.mark = &mark;
    for (int n_bytes = 0; n_bytes < 3; n_bytes++) {
        struct result_checksum checksum = {0}, found = {0};
        struct result_file *result;
        origin.checksum = &found;
        write_file(f, 4);
        assert_int_equal(result_mark_take(f->path, 2, &checksum, &mark), STATUS_OK);
        assert_int_equal(netcdf_read_rows(f->path, &rows), STATUS_OK);
        const uint64_t left[] = {0, rows.bytes / 2, rows.bytes + 1};
        assert_int_equal(truncate(f->path, (off_t)(rows.begin_of_rows + 2 * rows.bytes + left[n_bytes])), 0);
        assert_int_equal(netcdf_read_rows(f->path, &rows), STATUS_OK);
        assert_int_equal(rows.n, n_bytes < 2 ? 2 : 3);
        assert_int_equal(rows.n_counted, 4);
        assert_int_equal(result_mark_check(f->arena, f->path, &mark, EFFECTIVE, &found, &is_complete), STATUS_OK);
        assert_false(is_complete);  // whatever the file says
        assert_int_equal(result_file_continue(f->arena, &result, &origin), STATUS_OK);
        assert_int_equal(append(f, result, 7, 1), STATUS_OK);
        assert_int_equal(result_file_close(result, "complete"), STATUS_OK);
        const int file = open_to_read(f);
        assert_int_equal(length_of(file, "time"), 3);
        NEAR(value_at(file, "time", 1, 0, 0, 0), 0.5, 0, 0);
        NEAR(value_at(file, "time", 2, 0, 0, 0), 7, 0, 0);
        // one row less than the mark counts is too little
        unlink(f->path);
        write_file(f, 4);
        assert_int_equal(truncate(f->path, (off_t)(rows.begin_of_rows + 2 * rows.bytes - 1)), 0);
        assert_int_equal(result_mark_check(f->arena, f->path, &mark, EFFECTIVE, &found, &is_complete), STATUS_FILE);
        assert_message("has 1 rows, but the checkpoint requires 2");
        unlink(f->path);
    }
}

TEST_WITH(a_file_goes_on_behind_a_mark, set_up, tear_down) {
    struct fixture *const f = *state;
    struct result_checksum checksum = {0};
    struct result_mark mark;
    struct result_file *result;
    struct result_origin origin = origin_of(f);
    origin.mark = &mark;
    origin.checksum = &checksum;
    bool is_complete;
    write_file(f, 4);
    assert_int_equal(result_mark_take(f->path, 2, &checksum, &mark), STATUS_OK);
    assert_int_equal(result_file_continue(f->arena, &result, &origin), STATUS_OK);
    struct netcdf_rows rows;
    assert_int_equal(netcdf_read_rows(f->path, &rows), STATUS_OK);
    assert_int_equal(rows.n, 2);
    assert_int_equal(append(f, result, 7, 1), STATUS_OK);
    struct result_mark whole, later;
    assert_int_equal(result_file_mark(result, &later), STATUS_OK);
    assert_int_equal(result_file_close(result, "complete"), STATUS_OK);
    struct result_checksum fresh = {0};
    assert_int_equal(result_mark_take(f->path, 3, &fresh, &whole), STATUS_OK);
    are_equal(&whole, &later);
    assert_int_equal(result_mark_check(f->arena, f->path, &mark, EFFECTIVE, &checksum, &is_complete), STATUS_OK);
    const int file = open_to_read(f);
    assert_int_equal(length_of(file, "time"), 3);
    NEAR(value_at(file, "time", 1, 0, 0, 0), 0.5, 0, 0);
    NEAR(value_at(file, "time", 2, 0, 0, 0), 7, 0, 0);
}

static void extend_and_compare(struct fixture *f, bool drop) {
    struct result_file *result;
    const int before = open_new(f, 3);
    const size_t n_vortices = length_of(before, "vortex");
    double circulation[2];
    for (size_t g = 0; g < 2; g++) circulation[g] = value_at(before, "wake_circulation", 0, g, 0, 0);
    NEAR_ARRAY(2, circulation, ((double[]){3, 4}), 0, 0);
    const double bending = value_at(before, "bending_energy", 1, 1, 0, 0);
    const struct result_source source = {f->path, 2, drop};
    struct result_origin origin = origin_of(f);
    origin.overwrite = true;
    origin.n_events = 17;
    origin.source = &source;
    assert_int_equal(result_file_create(f->arena, &result, &origin), STATUS_OK);
    const int still = open_to_read(f);
    assert_int_equal(length_of(still, "time"), 3);
    assert_int_equal(result_file_publish(result, "running"), STATUS_OK);
    assert_int_equal(append(f, result, 9, 1), STATUS_OK);
    assert_int_equal(result_file_close(result, "complete"), STATUS_OK);
    const int file = open_to_read(f);
    assert_int_equal(length_of(file, "time"), 3);
    ABOVE(length_of(file, "vortex"), n_vortices);
    NEAR(value_at(file, "time", 1, 0, 0, 0), 0.5, 0, 0);
    NEAR(value_at(file, "time", 2, 0, 0, 0), 9, 0, 0);
    NEAR(value_at(file, "bending_energy", 1, 1, 0, 0), bending, 0, 0);

    // the wakes of all fish are in the rows that are copied, but for the last one where it is dropped
    for (size_t row = 0; row < 2; row++) {
        for (size_t g = 0; g < 2; g++) {
            const double got = value_at(file, "wake_circulation", row, g, 0, 0);
            if (drop && row == 1) {
                assert_true(isnan(got));
            } else {
                NEAR(got, circulation[g], 0, 0);
            }
        }
    }
}

TEST_WITH(a_longer_run_begins_with_the_rows, set_up, tear_down) {
    struct fixture *const f = *state;
    for (int g = 0; g < 2; g++) wake_release(&f->state->wake[g], 1, 2, 3 + g, 0);
    extend_and_compare(f, true);
    unlink(f->path);
    extend_and_compare(f, false);
}
