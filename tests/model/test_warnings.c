/* test_warnings.c: each warning where its cause is, and nowhere else. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "model/warnings.h"
#include "school.h"

#define TIME "time: {end: 3, shedding_interval: 0.01}\n"

// ---- which warnings a run has

// those of a run up to t, one character each: "contact" c, energy e, drift d, events v, sheet s, modes m,
// leading edge l
static void expect_warnings(const char *text, double t, const char *expected) {
    struct simulation *const simulation = school_simulation(text);
    school_run(simulation, t);
    simulate_measure(simulation);
    char line[WARNING_BYTES], found[N_WARNINGS + 1] = "";
    for (enum warning w = 0; w < N_WARNINGS; w++) {
        if (!warnings_line(w, simulation->school, simulation->state, simulation->diagnostics,
                           simulation->residual->scratch, line))
            continue;
        print_message("%s\n", line);
        assert_null(strchr(line, '\n'));
        strncat(found, &"cedvsml"[w], 1);
    }
    assert_string_equal(found, expected);
    simulate_free(simulation);
}

static void a_short_run_of_a_default_fish_has_none(void **state) {
    (void)state;
    expect_warnings(SCHOOL_SECOND TIME "fish: [{}]\n", 1, "");
}

static void a_fish_that_gathers_speed_drifts(void **state) {
    (void)state;
    expect_warnings(SCHOOL_SECOND TIME "fish: [{}]\n", 2.5, "d");
    // without a fluid nothing swims, and no mean speed is asked for
    expect_warnings(SCHOOL_SECOND TIME "fluid: {density: 0}\nfish: [{}]\n", 2.5, "");
}

static void few_events_in_a_beat_are_told(void **state) {
    (void)state;
    expect_warnings(SCHOOL_SECOND "time: {end: 3, shedding_interval: 0.0625}\nfish: [{}]\n", 0.5, "v");
    expect_warnings(SCHOOL_SECOND "time: {end: 3, shedding_interval: 0.05}\nfish: [{}]\n", 0.5, "");
}

static void a_soft_body_is_slower_than_its_beat(void **state) {
    (void)state;
    expect_warnings(SCHOOL_SECOND TIME "fish: [{body: {modulus: 1e5}}]\n", 0.1, "m");
    // a passive body may be as soft as it likes
    expect_warnings(SCHOOL_SECOND TIME "fish: [{body: {modulus: 1e5}, wave: {amplitude: 0}}]\n", 0.1, "");
}

static void few_sheet_points_for_a_short_stretch_are_told(void **state) {
    (void)state;
#define PLATE(n) \
    SCHOOL_SECOND TIME "fish: [{sheet_points: " n ", wave: {frequency: 0}, motion: {driven: all, speed: 1}}]\n"
    expect_warnings(PLATE("31"), 0.1, "");
    expect_warnings(PLATE("21"), 0.1, "s");
    // only a free sheet begins with the stretch of an interval
    expect_warnings(SCHOOL_SECOND TIME
                    "wake: {shedding: continuous}\nfish: [{sheet_points: 21, wave: {frequency: 0}, motion: {driven: "
                    "all, speed: 1}}]\n",
                    0.1, "");
}

static void an_open_energy_balance_is_told(void **state) {
    (void)state;
    // a plate that pitches once in two events: its power is not seen
    expect_warnings(SCHOOL_SECOND
                    "time: {end: 10, shedding_interval: 0.5, output_interval: 0.5}\nfish: [{wave: "
                    "{amplitude: 0}, motion: {driven: all, speed: 1, pitch: 10, frequency: 1}}]\n",
                    10, "ev");
}

static void separation_at_the_nose_is_told(void **state) {
    (void)state;
#define INCLINED(degrees, more)                                                            \
    SCHOOL_SECOND TIME "fish: [{force: pressure" more                                      \
                       ", wave: {amplitude: 0, frequency: 0}, start: {speed: 1}, motion: " \
                       "{driven: all, pitch: " degrees ", pitch_phase: 90}}]\n"
    // A_0 is about half of tan(alpha) after a tenth of a length
    expect_warnings(INCLINED("15", ""), 0.1, "");
    expect_warnings(INCLINED("30", ""), 0.1, "l");
    expect_warnings(INCLINED("30", ", pressure: {suction_limit: 0.35}"), 0.1, "");
    // there is no limit, or nothing that it limits
    expect_warnings(INCLINED("30", ", pressure: {suction_limit: 0}"), 0.1, "");
    expect_warnings(INCLINED("30", ", pressure: {suction: 0}"), 0.1, "");
}

static void bodies_that_pass_through_each_other_are_told(void **state) {
    (void)state;
    // between two rows, and between two steps: without a fluid a prescribed motion needs few
    expect_warnings(
        "time: {end: 3, shedding_interval: 0.05}\nfluid: {density: 0}\ndefaults: {fish: {wave: {amplitude: 0}, motion: "
        "{driven: all, "
        "speed: 15}}}\nfish: [{name: a}, {name: b, start: {position: [-6, 0], heading: 0}}]\n",
        1, "c");
    expect_warnings(
        "time: {end: 3, shedding_interval: 0.05}\nfluid: {density: 0}\ndefaults: {fish: {wave: {amplitude: 0}, motion: "
        "{driven: all, "
        "speed: 15}}}\nfish: [{name: a}, {name: b, start: {position: [-6, 1], heading: 0}}]\n",
        1, "");
    // bodies that could yield, and that the case lets pass: near each other, and through each other
    expect_warnings(TIME
                    "fluid: {density: 0}\ncontact: {action: warn}\ndefaults: {fish: {wave: {amplitude: 0}, body: "
                    "{profile: uniform, thickness: 0.1}}}\nfish: [{}, {start: {position: [0, 0.119]}}]\n",
                    0.05, "c");
    expect_warnings(TIME
                    "fluid: {density: 0}\ncontact: {action: warn}\ndefaults: {fish: {wave: {amplitude: 0}}}\nfish: "
                    "[{start: {speed: 10}}, {start: {position: [-0.5, 0.5], heading: 90, speed: -10}}]\n",
                    0.2, "c");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_short_run_of_a_default_fish_has_none),
        cmocka_unit_test(a_fish_that_gathers_speed_drifts),
        cmocka_unit_test(few_events_in_a_beat_are_told),
        cmocka_unit_test(a_soft_body_is_slower_than_its_beat),
        cmocka_unit_test(few_sheet_points_for_a_short_stretch_are_told),
        cmocka_unit_test(an_open_energy_balance_is_told),
        cmocka_unit_test(separation_at_the_nose_is_told),
        cmocka_unit_test(bodies_that_pass_through_each_other_are_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
