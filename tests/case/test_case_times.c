/* test_case_times.c: the shedding interval that a case does not give, and the times that fit it. */
#include <stdio.h>
#include <string.h>

#include "case/case.h"
#include "near.h"

// the values of a case with this text behind its format
static struct case_values read(const char *text) {
    char whole[1024];
    const int length = snprintf(whole, sizeof whole, "format: 1\n%s", text);
    struct case_values values;
    if (case_parse(&values, whole, (size_t)length, "test", ".", 0, NULL) != STATUS_OK) fail_msg("%s", status_message());
    return values;
}

static void interval_is(const char *text, double interval) {
    struct case_values values = read(text);
    NEAR(values.school.shedding_interval, interval, 0, 1e-15);
    case_free(&values);
}

static void the_fastest_beat_has_a_hundred_events(void **state) {
    (void)state;
    interval_is("time: {end: 1}\nfish: [{}]\n", 0.01);
    interval_is("time: {end: 1}\nfish: [{wave: {frequency: 4}}]\n", 0.0025);
    interval_is("time: {end: 1}\nfish: [{wave: {frequency: 2}}, {wave: {frequency: 5}, start: {position: [0, 2]}}]\n",
                0.002);
    // the frequency of a prescribed motion, where there is one
    interval_is("time: {end: 1}\nfish: [{motion: {prescribed: head, heave: 0.1, frequency: 0.5}}]\n", 0.02);
    interval_is("time: {end: 1}\nfish: [{motion: {prescribed: all}, wave: {frequency: 2}}]\n", 0.005);
    interval_is("time: {end: 1}\nfish: [{wave: {frequency: 0}}]\n", 0.01);
    // given, or of the article
    interval_is("time: {end: 1, shedding_interval: 0.05}\nfish: [{wave: {frequency: 4}}]\n", 0.05);
    interval_is("preset: published\ntime: {end: 1}\nfish: [{wave: {frequency: 4}}]\n", 0.01);
}

static void times_that_do_not_fit_the_default_are_rounded_and_noted(void **state) {
    (void)state;
    // a period of 0.7 s: 2 s are 285.7 events
    struct case_values values = read(
        "time: {end: 2, output_interval: 0.1, checkpoint_interval: 0.352}\noutput: {wake_interval: 0.5}\n"
        "fish: [{wave: {frequency: 1.4285714285714286}}]\n");
    NEAR(values.school.shedding_interval, 0.007, 0, 1e-15);
    NEAR(values.time.end, 286 * 0.007, 0, 1e-14);
    NEAR(values.time.output_interval, 14 * 0.007, 0, 1e-14);
    NEAR(values.time.checkpoint_interval, 50 * 0.007, 0, 1e-14);
    NEAR(values.output.wake_interval, 5 * 14 * 0.007, 0, 1e-14);
    assert_non_null(strstr(values.notes, "time.end: 2 s is not an integer multiple"));
    assert_non_null(strstr(values.notes, "rounded to 2.002 s; the default of time.shedding_interval is 1/100 of the"));
    assert_non_null(strstr(values.notes, "rounded to 0.098 s"));
    assert_non_null(
        strstr(values.notes, "output.wake_interval: 0.5 s is not an integer multiple of time.output_interval"));
    case_free(&values);
}

static void times_that_fit_stay_to_the_bit(void **state) {
    (void)state;
    struct case_values values = read(
        "time: {end: 2, output_interval: 0.1}\nfish: [{wave: {frequency: 1.1, phase: 20}}, {name: b, start: {position: "
        "[0, 2]}, wave: {frequency: 4}}]\n");
    NEAR(values.time.end, 2, 0, 0);
    NEAR(values.time.output_interval, 0.1, 0, 0);
    assert_string_equal(values.notes, "");
    case_free(&values);
    // nothing is less than one interval
    values = read("time: {end: 0.001, output_interval: 1e-5}\nfish: [{}]\n");
    NEAR(values.time.end, 0.01, 0, 0);
    NEAR(values.time.output_interval, 0.01, 0, 0);
    NEAR(values.output.wake_interval, 0.01, 0, 0);
    case_free(&values);
}

static void times_that_do_not_fit_a_given_interval_are_errors(void **state) {
    (void)state;
    static const char text[] = "format: 1\ntime: {end: 2, shedding_interval: 0.007}\nfish: [{}]\n";
    struct case_values values;
    assert_int_equal(case_parse(&values, text, sizeof text - 1, "test", ".", 0, NULL), STATUS_CASE);
    assert_non_null(strstr(status_message(), "time.end: 2 s is not an integer multiple of time.shedding_interval"));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_fastest_beat_has_a_hundred_events),
        cmocka_unit_test(times_that_do_not_fit_the_default_are_rounded_and_noted),
        cmocka_unit_test(times_that_fit_stay_to_the_bit),
        cmocka_unit_test(times_that_do_not_fit_a_given_interval_are_errors),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
