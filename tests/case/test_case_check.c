/* test_case_check.c: implausible values are noted at their places, and no others; the default shedding interval, and
 * times that are rounded to it. */
#include <stdio.h>
#include <string.h>

#include "case_fixture.h"

/* The notes on the minimal case with one assignment are these words ("": there are none). */
static void notes_are(const char *assignment, const char *want) {
    struct case_values values = parse_with(minimal, assignment, NULL, NULL);
    const bool is_right = *want ? strstr(values.notes, want) != NULL : *values.notes == '\0';
    if (!is_right) fail_msg("the notes on %s are\n%s\nwithout %s", assignment, values.notes, want);
    case_free(&values);
}

static void a_usual_case_has_no_notes(void **state) {
    (void)state;
    notes_are("fish[0].wave.phase=90", "");
    notes_are("fish[0].start.heading=3", "");
    notes_are("fish[0].start.heading=0", "");
    notes_are("fish[0].body.modulus=1e4", "");
    notes_are("fish[0].length=30", "");
    notes_are("fish[0].wave={number: 6, frequency: 0}", "");  // a fish that is towed has no wave
}

static void an_angle_in_radians_is_noted(void **state) {
    (void)state;
    notes_are("fish[0].start.heading=3.14159",
              "--set fish[0].start.heading=3.14159: note: fish[0].start.heading: 3.14159 is in degrees; if radians are "
              "meant, write 180");
    notes_are("fish[0].start.heading=-1.571", "write -90");
    notes_are("fish[0].wave.phase=0.7854", "write 45");
    notes_are("fish[0].motion={prescribed: head, pitch: 0.5236, frequency: 1}",
              "fish[0].motion.pitch: 0.5236 is in degrees");
    notes_are("fish[0].motion.pitch_phase=1.5708", "write 90");
    notes_are("fish[0].motion.phase=6.2832", "write 360");
    notes_are("fish[0].control={law: course, desired_heading: [[0, 180], [1, 2.3562]]}", "write 135");
}

static void a_body_like_no_other_is_noted(void **state) {
    (void)state;
    notes_are("fish[0].length=50", "fish[0].length: 50 m is longer than any swimmer; the unit is metres");
    notes_are("fish[0].length=1e-4", "fish[0].length: 0.0001 m is shorter than any swimmer");
    notes_are("fish[0].body.modulus=1", "fish[0].body.modulus: 1 Pa is softer than jelly");
    notes_are("fish[0].body.modulus=1e13", "1e+13 Pa is stiffer than diamond");
}

static void few_nodes_under_pressure_are_noted(void **state) {
    (void)state;
    notes_are("fish[0]={nodes: 9, force: pressure}", "fish[0].nodes: 9: with force pressure, fewer than 17 nodes");
    notes_are("fish[0]={nodes: 17, force: pressure}", "");
    notes_are("fish[0]={nodes: 9, force: reactive}", "");
    // a rigid plate has no shape to resolve
    notes_are("fish[0]={nodes: 9, force: pressure, motion: {prescribed: all}}", "");
}

static void a_wave_that_travels_forwards_is_noted(void **state) {
    (void)state;
    notes_are("fish[0].wave.number=6", "fish[0].wave.number: 6: the wave travels from tail to head");
}

static void a_value_that_fish_share_is_noted_once(void **state) {
    (void)state;
    static const char text[] =
        "format: 1\ntime: {end: 3}\ndefaults: {fish: {length: 50, body: {modulus: 1}}}\nfish: [{}, {}, {}]\n";
    struct case_values values = parse(text);
    const char *const first = strstr(values.notes, ":3:27: note: fish[0].length");
    assert_non_null(first);
    assert_null(strstr(first, "fish[1]"));
    assert_non_null(strstr(first, ":3:47: note: fish[0].body.modulus"));
    case_free(&values);
}

// ---- the default shedding interval

// the values of a case with this text behind its format
static struct case_values read_case(const char *text) {
    char whole[1024];
    const int length = snprintf(whole, sizeof whole, "format: 1\n%s", text);
    struct case_values values;
    if (case_parse(&values, whole, (size_t)length, "test", ".", 0, NULL) != STATUS_OK) fail_msg("%s", status_message());
    return values;
}

static void interval_is(const char *text, double interval) {
    struct case_values values = read_case(text);
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
    struct case_values values = read_case(
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
    struct case_values values = read_case(
        "time: {end: 2, output_interval: 0.1}\nfish: [{wave: {frequency: 1.1, phase: 20}}, {name: b, start: {position: "
        "[0, 2]}, wave: {frequency: 4}}]\n");
    NEAR(values.time.end, 2, 0, 0);
    NEAR(values.time.output_interval, 0.1, 0, 0);
    assert_string_equal(values.notes, "");
    case_free(&values);
    // nothing is less than one interval
    values = read_case("time: {end: 0.001, output_interval: 1e-5}\nfish: [{}]\n");
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
        cmocka_unit_test(a_usual_case_has_no_notes),
        cmocka_unit_test(an_angle_in_radians_is_noted),
        cmocka_unit_test(a_body_like_no_other_is_noted),
        cmocka_unit_test(few_nodes_under_pressure_are_noted),
        cmocka_unit_test(a_wave_that_travels_forwards_is_noted),
        cmocka_unit_test(a_value_that_fish_share_is_noted_once),
        cmocka_unit_test(the_fastest_beat_has_a_hundred_events),
        cmocka_unit_test(times_that_do_not_fit_the_default_are_rounded_and_noted),
        cmocka_unit_test(times_that_fit_stay_to_the_bit),
        cmocka_unit_test(times_that_do_not_fit_a_given_interval_are_errors),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
