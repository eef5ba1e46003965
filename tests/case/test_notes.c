/* test_notes.c: values that are hardly ever meant are noted at their places, and no others. */
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

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_usual_case_has_no_notes),
        cmocka_unit_test(an_angle_in_radians_is_noted),
        cmocka_unit_test(a_body_like_no_other_is_noted),
        cmocka_unit_test(few_nodes_under_pressure_are_noted),
        cmocka_unit_test(a_wave_that_travels_forwards_is_noted),
        cmocka_unit_test(a_value_that_fish_share_is_noted_once),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
