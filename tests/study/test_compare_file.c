/* test_compare.c: the file of a comparison, and comparisons without memory. What processes do: test_compare.sh. */
#include <netcdf.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "failing_malloc.h"
#include "near.h"
#include "study/compare.h"
#include "study/compare_file.h"

static const char text[] =
    "format: 1\nname: small\ntime: {end: 0.02, shedding_interval: 0.02}\nfish: [{nodes: 4, sheet_points: 5}]\n";

static struct case_values parse(void) {
    struct case_values values;
    assert_int_equal(case_parse(&values, text, strlen(text), "small.yaml", NULL, 0, NULL), STATUS_OK);
    return values;
}

static const struct compare_file_reference some_reference = {1e-9, 2e-8, 3e-8};
static const struct compare_file_row some_rows[] = {
    {"ida2", "complete", 1e-3, NAN, 1e-4, 2e-4, 0.5, 10, 20, 15, 5, 15},
    {"rk4", "unstable at t = 0.3 s: too large a step", NAN, 0.01, NAN, NAN, 0.25, 100, 400, 0, 0, 400},
};

static void what_is_written_reads_back(void **state) {
    (void)state;
    struct case_values values = parse();
    char path[] = "/tmp/shoal-compare-XXXXXX";
    close(mkstemp(path));
    assert_int_equal(compare_file_write(path, &values, &some_reference, 2, some_rows, "test"), STATUS_OK);
    struct compare_file_reference reference;
    struct compare_file_row *row;
    int n;
    assert_int_equal(compare_file_read(path, &reference, &n, &row), STATUS_OK);
    assert_memory_equal(&reference, &some_reference, sizeof reference);
    assert_int_equal(n, 2);
    for (int i = 0; i < 2; i++) {
        assert_string_equal(row[i].method, some_rows[i].method);
        assert_string_equal(row[i].status, some_rows[i].status);
        // all numbers follow each other
        const double *const got = &row[i].rtol, *const want = &some_rows[i].rtol;
        for (int k = 0; k < 10; k++) assert_true(got[k] == want[k] || (isnan(got[k]) && isnan(want[k])));
    }
    free(row);

    int file, variable;
    assert_int_equal(nc_open(path, NC_WRITE, &file), NC_NOERR);
    assert_int_equal(nc_inq_varid(file, "steps", &variable), NC_NOERR);
    assert_int_equal(nc_redef(file), NC_NOERR);
    assert_int_equal(nc_rename_var(file, variable, "step5"), NC_NOERR);
    nc_close(file);
    assert_int_equal(compare_file_read(path, &reference, &n, &row), STATUS_FILE);
    assert_null(row);
    assert_non_null(strstr(status_message(), "it has no variable steps"));
    unlink(path);
    assert_int_equal(compare_file_read(path, &reference, &n, &row), STATUS_FILE);
    case_free(&values);
}

static void every_failing_allocation_is_reported_and_leaves_nothing(void **state) {
    (void)state;
    struct case_values values = parse();
    char path[] = "/tmp/shoal-compare-XXXXXX";
    close(mkstemp(path));
    FILE *const nowhere = fopen("/dev/null", "w");
    const struct compare_options options = {.methods = "ida2,rk4",
                                            .rtols = "1e-3",
                                            .repeats = 1,
                                            .reference_rtol = 1e-6,
                                            .limit = 60,
                                            .path = path,
                                            .command = "test",
                                            .quiet = 1};
    int n_failed = 0;
    // where the comparison itself has memory enough, its processes, which begin with what is left, may not
    for (int n = 0;; n += 1 + n / 30) {
        const int n_before = n_live;
        n_until_failure = n;
        enum status status = compare_run(&values, &options, nowhere);
        if (status == STATUS_OK) status = compare_info(path, nowhere);
        const int ran_out = n_until_failure == -1;
        n_until_failure = -1;
        assert_int_equal(n_live, n_before);
        if (status == STATUS_OK && !ran_out) break;
        n_failed++;
        if (status != STATUS_OK) {
            assert_true(status == STATUS_MEMORY || status == STATUS_SOLVER);
            assert_true(status_message()[0] != 0);
        }
        assert_in_range(n, 0, 100000);
    }
    assert_true(n_failed > 50);
    fclose(nowhere);
    unlink(path);
    case_free(&values);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_written_reads_back),
        cmocka_unit_test(every_failing_allocation_is_reported_and_leaves_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
