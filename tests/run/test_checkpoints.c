/* test_checkpoints.c: Tests the names of checkpoints, and at which events they are written. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "run/checkpoints.h"
#include "school.h"

#define SCHOOL "time: {end: 1, shedding_interval: 0.02, checkpoint_interval: 0.2}\nfish: [{nodes: 7}]\n"

// the checkpoints of a run with places to write them, and the result at a path that no file has
static enum status create(struct checkpoints *checkpoints, const struct case_values *values, const char *places) {
    return checkpoints_create(test_arena(), checkpoints, values, "/tmp/no-such-result.nc", places);
}

TEST(a_checkpoint_is_named_after_its_result) {
    const char *const names[][2] = {{"run.nc", "run.ckpt"},    {"a/b.nc", "a/b.ckpt"},
                                    {"run", "run.checkpoint"}, {"run.nc.old", "run.nc.old.checkpoint"},
                                    {".nc", ".nc.checkpoint"}, {"a/.nc", "a/.nc.checkpoint"}};
    for (int i = 0; i < 6; i++) assert_string_equal(checkpoints_path(test_arena(), names[i][0]), names[i][1]);
}

TEST(checkpoints_are_due_at_the_interval_and_where_they_are_asked_for) {
    struct checkpoints checkpoints;
    struct case_values values = school_values(SCHOOL);
    school_ok(create(&checkpoints, &values, "0,0.06,0.2,1"));
    for (long event = 0; event <= 50; event++) {
        const int want = (event > 0 && event % 10 == 0) || event == 0 || event == 3;
        assert_int_equal(checkpoints_are_due(&checkpoints, event), want);
    }
    school_ok(create(&checkpoints, &values, NULL));
    for (long event = 0; event <= 50; event++) {
        assert_int_equal(checkpoints_are_due(&checkpoints, event), event > 0 && event % 10 == 0);
    }
    values.time.checkpoint_interval = 0;
    school_ok(create(&checkpoints, &values, NULL));
    for (long event = 0; event <= 50; event++) assert_int_equal(checkpoints_are_due(&checkpoints, event), 0);
}

TEST(times_that_no_event_has_are_refused) {
    const char *const wrong[] = {"0.03", "0.02,x", "1.02", "-0.02", "0.02,,0.04", "nan", "0.02 0.04"};
    struct checkpoints checkpoints;
    struct case_values values = school_values(SCHOOL);
    for (int i = 0; i < 7; i++) {
        assert_int_equal(create(&checkpoints, &values, wrong[i]), STATUS_CASE);
        if (!strstr(status_message(), " of time.shedding_interval, 0.02 s, up to time.end, 1 s"))
            fail_msg("%s", status_message());
    }
}

TEST(times_may_be_rounded_but_not_wrong) {
    // an event at 0.06 s; the rounding error of a decimal time is far below 1e-9 of the time
    const char *const right[] = {"0.06", "0.06000000000001", "0.05999999999999"};
    const char *const wrong[] = {"0.0600001", "0.0599999", "0.0606"};
    struct checkpoints checkpoints;
    struct case_values values = school_values(SCHOOL);
    for (int i = 0; i < 3; i++) {
        school_ok(create(&checkpoints, &values, right[i]));
        assert_int_equal(checkpoints.n_at, 1);
        assert_int_equal(checkpoints.at[0], 3);
        assert_int_equal(create(&checkpoints, &values, wrong[i]), STATUS_CASE);
    }
}

TEST(a_run_that_is_resumed_keeps_its_places_and_writes_none_twice) {
    struct checkpoints checkpoints;
    struct checkpoint from = {.places = "0.06,0.1", .effective = "the case"};
    struct case_values values = school_values(SCHOOL);
    for (int with_other_end = 0; with_other_end < 2; with_other_end++) {
        school_ok(create(&checkpoints, &values, NULL));
        checkpoints_resume(&checkpoints, &from, 5, with_other_end);
        assert_string_equal(checkpoints.places, "0.06,0.1");
        assert_true(checkpoints.has_place);
        assert_int_equal(checkpoints.last_place, 5);
        assert_int_equal(checkpoints.has_last, !with_other_end);
        if (!with_other_end) assert_int_equal(checkpoints.last, 5);
        assert_int_equal(strcmp(checkpoints.effective, "the case") == 0, !with_other_end);
    }
}

TEST(the_files_of_an_earlier_run_are_removed) {
    struct checkpoints checkpoints;
    char folder[] = "/tmp/test_checkpoints_XXXXXX", result[64], part[64];
    assert_non_null(mkdtemp(folder));
    snprintf(result, sizeof result, "%s/run.nc", folder);
    snprintf(part, sizeof part, "%s/run.ckpt.part", folder);
    struct case_values values = school_values(SCHOOL);
    fclose(fopen(part, "w"));
    school_ok(checkpoints_create(test_arena(), &checkpoints, &values, result, NULL));
    fclose(fopen(checkpoints.path, "w"));
    FILE *const mine = fopen(checkpoints.previous, "w");
    fputs("mine", mine);
    fclose(mine);
    assert_int_equal(checkpoints_create(test_arena(), &checkpoints, &values, result, NULL), STATUS_FILE);
    checkpoints_remove(&checkpoints);
    assert_int_equal(rmdir(folder), 0);
}
