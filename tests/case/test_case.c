/* test_case.c: A case takes its values from defaults, presets, included files and assignments, and what is shown of it
 * reads back as the same case. test_sweep.c tests sweeps, test_bad_cases.c wrong cases. */
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "case/case.h"
#include "case/case_table.h"
#include "case_fixture.h"
#include "near.h"

// ---- the fixture

/* Parse a case that must be refused with a message that contains these words. */
static void is_refused(const char *text, const char *want) {
    struct case_values values;
    assert_int_equal(case_parse(&values, text, strlen(text), "cases/x.yaml", NULL, 0, NULL), STATUS_CASE);
    if (!strstr(status_message(), want)) fail_msg("the message is\n%.600s\nwithout %s", status_message(), want);
    assert_null(values.school.fish);
}

/* A folder for files, made by the setup of a test. */
static int make_folder(void **state) {
    char *const folder = strdup("/tmp/shoal-case-XXXXXX");
    *state = folder;
    return folder && mkdtemp(folder) && chdir(folder) == 0 ? 0 : -1;
}

static int remove_folder(void **state) {
    static const char *const files[] = {"case.yaml", "water.yaml", "below/more.yaml", "below"};
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) remove(files[i]);
    const int failed = chdir("/") != 0 || rmdir(*state) != 0;
    free(*state);
    return failed;
}

static void write_file(const char *path, const char *text) {
    FILE *const file = fopen(path, "w");
    assert_non_null(file);
    AT_LEAST(fputs(text, file), 0);
    assert_int_equal(fclose(file), 0);
}

// ---- defaults

TEST(the_defaults_are_those_of_the_reference) {
    struct case_values s = parse(minimal);
    NEAR(s.time.end, 3, 0, 0);
    NEAR(s.school.shedding_interval, 0.01, 0, 0);
    NEAR(s.school.fluid.density, 1000, 0, 0);
    NEAR(s.school.wake.smoothing, 0.1, 0, 0);
    NEAR(s.school.wake.taper, 0.6, 0, 0);
    NEAR(s.school.wake.taper_beside, 0.07, 0, 0);
    assert_int_equal(s.school.sheet.curve, BODY_LINE_SMOOTH);
    NEAR(s.school.sheet.smoothing, 0.05, 0, 0);
    NEAR(s.school.wake.lifetime, 8, 0, 0);
    NEAR(s.school.wake.decay, 2, 0, 0);
    assert_int_equal(s.school.wake.shedding, SHEDDING_SHEET);
    assert_int_equal(s.school.sheet.kutta, KUTTA_EDGE);
    assert_int_equal(s.school.sheet.collocation, COLLOCATION_CHEBYSHEV);
    assert_int_equal(s.school.wake.removed_circulation, REMOVED_RETAINED);
    assert_int_equal(s.solver.method, METHOD_IDA);
    NEAR(s.solver.rtol, 3e-5, 0, 0);
    assert_int_equal(s.solver.order, 0);  // chosen by the simulation
    assert_int_equal(s.school.threads, 1);
    assert_int_equal(s.output.precision, PRECISION_DOUBLE);
    assert_null(s.output.file);
    const struct fish_parameters *const fish = s.school.fish;
    assert_int_equal(fish->nodes, 25);
    assert_int_equal(fish->reference_nodes, 7);
    assert_int_equal(fish->sheet_points, 49);
    assert_int_equal(fish->force, FORCE_PRESSURE);
    assert_int_equal(fish->span, SPAN_FINITE);
    assert_int_equal(fish->body.section, SECTION_MEAN);
    assert_int_equal(fish->body.profile, PROFILE_JOUKOWSKI);
    assert_int_equal(fish->body.second_moment, SECOND_MOMENT_ELLIPSE);
    NEAR(fish->body.density, 1000, 0, 0);
    NEAR(fish->body.relaxation_time, 0.02, 0, 0);
    assert_int_equal(fish->body.damping, DAMPING_STRAIN);
    NEAR(fish->body.bending_damping, 0, 0, 0);
    NEAR(fish->body.stretching_damping, 0, 0, 0);
    NEAR(fish->body.thickness, 0.1, 0, 0);
    NEAR(fish->body.depth, 0.2, 0, 0);
    NEAR(fish->body.modulus, 1.5e6, 0, 0);
    NEAR(fish->wave.number, -6, 0, 0);
    NEAR(fish->drag.tangential, 4e-3, 0, 0);
    NEAR(fish->drag.normal, 1, 0, 0);
    assert_int_equal(fish->drag.friction, FRICTION_BOUNDARY_LAYER);
    NEAR(fish->added_mass.coefficient, 1, 0, 0);
    assert_int_equal(fish->added_mass.extent, EXTENT_DEPTH);
    assert_int_equal(fish->drag.law, DRAG_QUADRATIC);
    NEAR(fish->start_heading, 180, 0, 0);
    NEAR(fish->start_speed, 0, 0, 0);
    assert_int_equal(fish->motion.prescribed, PRESCRIBED_NONE);
    assert_int_equal(fish->control.law, CONTROL_NONE);
    assert_int_equal(fish->control.waypoints.n, 0);
    NEAR(fish->control.gain, 2, 0, 0);
}

// of the fish that beats most slowly; of a prescribed one the beat is that of its motion
TEST(lifetime_and_fade_may_be_in_beats) {
    static const struct {
        const char *wake, *fish;
        double lifetime, decay;
    } cases[] = {
        {"", "{wave: {frequency: 4}}, {wave: {frequency: 0.5}}, {wave: {frequency: 0}}", 16, 4},
        {"wake: {lifetime: 5 beats}\n", "{wave: {frequency: 2}}", 2.5, 0.625},
        {"wake: {lifetime: 0.5 beats, decay: 0 beats}\n", "{}", 0.5, 0},
        {"wake: {lifetime: 7, decay: 1 beat}\n", "{wave: {frequency: 0.2}}", 7, 5},
        {"wake: {decay: 3}\n", "{}", 8, 3},
        {"", "{wave: {frequency: 3}, motion: {prescribed: all, frequency: 0.5, heave: 0.1}}", 16, 4},
        {"", "{wave: {frequency: 0}}", 2, 1.5},
        {"preset: published\nwake: {lifetime: 4 beats}\n", "{wave: {frequency: 2}}", 2, 0},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[512];
        snprintf(text, sizeof text, "format: 1\ntime: {end: 1}\n%sfish: [%s]\n", cases[i].wake, cases[i].fish);
        struct case_values s = parse(text);
        NEAR(s.school.wake.lifetime, cases[i].lifetime, 0, 1e-15);
        NEAR(s.school.wake.decay, cases[i].decay, 0, 1e-15);
    }
}

// a key of a fish counts the beats of this fish, a key of the case those of all
TEST(every_time_may_be_in_beats) {
    struct case_values s = parse(
        "format: 1\ntime: {end: 20 beats, shedding_interval: 1/50 beat, output_interval: 1/5 beat,\n"
        "  checkpoint_interval: 2 beats}\noutput: {wake_interval: 1 beat}\n"
        "fish: [{wave: {frequency: 2, ramp: 3 beats}, body: {relaxation_time: 1/40 beat}},\n"
        "  {wave: {frequency: 2, ramp: 4}, control: {law: course, ramp: 0.5 beats, course_filter: 1/8 beat}}]\n");
    NEAR(s.time.end, 10, 0, 0);
    NEAR(s.school.shedding_interval, 0.01, 0, 0);
    NEAR(s.time.output_interval, 0.1, 0, 0);
    NEAR(s.time.checkpoint_interval, 1, 0, 0);
    NEAR(s.output.wake_interval, 0.5, 0, 0);
    NEAR(s.school.fish[0].wave.ramp, 1.5, 0, 0);
    NEAR(s.school.fish[0].body.relaxation_time, 0.0125, 0, 0);
    NEAR(s.school.fish[1].wave.ramp, 4, 0, 0);
    NEAR(s.school.fish[1].control.ramp, 0.25, 0, 0);
    NEAR(s.school.fish[1].control.course_filter, 0.0625, 0, 0);
}

TEST(times_are_rounded_to_an_interval_in_beats_with_a_note) {
    struct case_values s =
        parse("format: 1\ntime: {end: 3.001, shedding_interval: 1/50 beat, output_interval: 0.211}\nfish: [{}]\n");
    NEAR(s.time.end, 3.02, 0, 1e-15);
    NEAR(s.time.output_interval, 0.22, 0, 1e-15);
    assert_non_null(strstr(s.notes, "time.end: 3.001 s is not an integer multiple"));
    assert_non_null(strstr(s.notes, "time.output_interval: 0.211 s is not an integer multiple"));
}

// of two beats of a school neither is meant more than the other
TEST(beats_of_no_fish_or_of_unlike_fish_are_refused) {
    is_refused("format: 1\ntime: {end: 5 beats}\nfish: [{wave: {frequency: 0}}]\n",
               "time.end: is in beats, but no fish beats: give seconds");
    is_refused("format: 1\ntime: {end: 5 beats}\nfish: [{}, {wave: {frequency: 2}}]\n",
               "time.end: is in beats, but fish[0] beats with 1 Hz and fish[1] with 2 Hz: give seconds");
    is_refused("format: 1\ntime: {end: 5}\nfish: [{}, {wave: {frequency: 0, ramp: 1 beat}}]\n",
               "fish[1].wave.ramp: is in beats, but the fish does not beat: give seconds");
    is_refused("format: 1\ntime: {end: 5, shedding_interval: 1/0 beat}\nfish: [{}]\n", "got '1/0 beat'");
    is_refused("format: 1\ntime: {end: 5, checkpoint_wall: 3 beats}\nfish: [{}]\n", "expects a number in s");
}

TEST(derived_defaults_follow_what_they_derive_from) {
    struct case_values s = parse(
        "format: 1\ntime: {end: 1, shedding_interval: 0.02}\nwake: {lifetime: 3}\n"
        "fish: [{start: {heading: 30, speed: 2}, wave: {frequency: 4}}, {wave: {frequency: 0}},\n"
        "  {control: {waypoints: [[1, 2]]}}]\n");
    NEAR(s.time.output_interval, 0.2, 0, 1e-15);
    NEAR(s.output.wake_interval, 0.2, 0, 1e-15);
    NEAR(s.school.wake.decay, 0.75, 0, 1e-15);
    assert_string_equal(s.name, "x");
    assert_string_equal(s.school.fish[0].name, "fish1");
    assert_string_equal(s.school.fish[1].name, "fish2");
    NEAR(s.school.fish[0].wave.ramp, 0.25, 0, 0);
    NEAR(s.school.fish[1].wave.ramp, 0, 0, 0);
    NEAR(s.school.fish[0].motion.speed, 2, 0, 0);
    NEAR(s.school.fish[0].control.filter, 0.25, 0, 0);
    NEAR(s.school.fish[1].control.filter, 0, 0, 0);
    assert_int_equal(s.school.fish[2].control.law, CONTROL_COURSE);
    assert_int_equal(s.school.fish[1].control.law, CONTROL_NONE);
    assert_int_equal(s.school.fish[0].control.desired_heading.n, 1);
    NEAR(s.school.fish[0].control.desired_heading.value[0], 0, 0, 0);
    NEAR(s.school.fish[0].control.desired_heading.value[1], 30, 0, 0);
}

TEST(defaults_of_a_gust_a_street_and_a_beat) {
    struct case_values s = parse(
        "format: 1\ntime: {end: 1}\nfluid: {velocity: [3, -4], gust: {profile: step, amplitude: 0.1}}\n"
        "wake: {street: {vortices: 2, spacing: 2, circulation: 1}}\ndefaults: {fish: {pressure: {span: infinite}}}\n"
        "fish: [{nodes: 18, wave: {frequency: 4, wavelength: 2}}, {nodes: 17, wave: {frequency: 0}},\n"
        "  {nodes: 25, length: 2, body: {depth: 1}, motion: {prescribed: all, frequency: 0.5}}]\n");
    NEAR(s.school.fluid.gust_speed, 5, 0, 1e-15);
    NEAR(s.school.fluid.gust_gradient_distance, 2.0 / 5, 0, 1e-15);
    NEAR(pow(cosh(M_PI * s.school.wake.street.row_distance / 2), 2), 2, 0, 1e-11);
    static const double want[][6] = {
        {35, 0.005, -M_PI, 0.25, 0.0625, 0.125}, {33, 0, 0, 0, 0, 1}, {49, 0.04, 0, 1, 0.25, 0.5}};
    for (int f = 0; f < 3; f++) {
        const struct fish_parameters *const fish = &s.school.fish[f];
        const double got[] = {fish->sheet_points, fish->body.relaxation_time,  f > 0 ? 0 : fish->wave.number,
                              fish->wave.ramp,    fish->control.course_filter, fish->control.ramp};
        for (int k = 0; k < 6; k++) NEAR(got[k], want[f][k], 0, 1e-15);
    }
}

TEST(a_case_is_named_after_its_file) {
    static const char *const names[][2] = {
        {"a.b/eel.v2.yaml", "eel.v2"}, {"a.b/eel", "eel"}, {".yaml", ".yaml"}, {"a.b/", "case"}};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        struct case_values s;
        assert_int_equal(case_parse(&s, minimal, strlen(minimal), names[i][0], ".", 0, NULL), STATUS_OK);
        assert_string_equal(s.name, names[i][1]);
        case_free(&s);
    }
}

// 170 events a second: other intervals are rounded to the nearest multiple, that of the wake to ten of them
TEST(intervals_are_rounded_to_events) {
    struct case_values s = parse(
        "format: 1\ntime: {end: 10, checkpoint_interval: 0.102}\noutput: {wake_interval: 0.15}\n"
        "fish: [{wave: {frequency: 1.7}}]\n");
    NEAR(s.time.checkpoint_interval, 17 / 170.0, 0, 1e-14);
    NEAR(s.output.wake_interval, 30 / 170.0, 0, 1e-14);
}

TEST(every_default_of_the_table_is_a_value_of_its_key) {
    parse(minimal);
    parse_with(minimal, "preset=published", NULL, NULL);
    for (int k = 0; k < case_table_n; k++) {
        const struct key *const key = &case_table[k];
        BELOW(strlen(key->path), 60);  // the buffers for paths hold more
        assert_true(*key->meaning && !strchr(key->meaning, '\n'));
        assert_ptr_equal(case_table_row(key->path), key);
        assert_true(!key->initial || !key->derived);
        assert_int_equal(key->type == CHOICE, key->words != NULL);
    }
}

TEST(defaults_reach_every_fish_below_its_own_keys) {
    struct case_values s = parse(
        "format: 1\ntime: {end: 1}\ndefaults: {fish: {nodes: 9, body: {modulus: 1e4, density: 900}}}\n"
        "fish: [{body: {modulus: 1e5}}, {nodes: 5}]\n");
    assert_int_equal(s.school.fish[0].nodes, 9);
    assert_int_equal(s.school.fish[1].nodes, 5);
    NEAR(s.school.fish[0].body.modulus, 1e5, 0, 0);
    NEAR(s.school.fish[1].body.modulus, 1e4, 0, 0);
    NEAR(s.school.fish[0].body.density, 900, 0, 0);
}

TEST(a_wrong_default_is_reported_once_even_if_unused) {
    is_refused("format: 1\ntime: {end: 1}\ndefaults: {fish: {nodes: 2}}\nfish: [{}, {nodes: 7}, {}]\n",
               "cases/x.yaml:3:26: error: defaults.fish.nodes: must be from 4 to 10000, got 2\n"
               "defaults: {fish: {nodes: 2}}\n                         ^");
    assert_null(strstr(status_message(), "fish[0]"));
    is_refused("format: 1\ntime: {end: 1}\ndefaults: {fish: {nodes: 2}}\nfish: [{nodes: 7}]\n", "defaults.fish.nodes");
}

// ---- preset

TEST(preset_published_sets_the_options_of_the_article) {
    struct case_values s = parse("format: 1\npreset: published\ntime: {end: 1}\nfish: [{}]\n");
    assert_int_equal(s.preset, PRESET_PUBLISHED);
    assert_int_equal(s.school.fish->body.second_moment, SECOND_MOMENT_PUBLISHED);
    assert_int_equal(s.school.fish->body.section, SECTION_NODES);
    NEAR(s.school.fish->wave.ramp, 1, 0, 0);
    assert_int_equal(s.school.sheet.collocation, COLLOCATION_MIDPOINT);
    assert_int_equal(s.school.sheet.kutta, KUTTA_RATE);
    assert_int_equal(s.school.wake.shedding, SHEDDING_IMPULSIVE);
    NEAR(s.school.sheet.smoothing, 0.01, 0, 0);
    NEAR(s.school.wake.lifetime, 2, 0, 0);
    NEAR(s.school.wake.decay, 0, 0, 0);
    assert_int_equal(s.school.wake.removed_circulation, REMOVED_RETAINED);
    assert_int_equal(s.school.fish->drag.law, DRAG_QUADRATIC);
    NEAR(s.school.fish->drag.normal, 4, 0, 0);
    NEAR(s.school.fish->control.filter, 0, 0, 0);
    assert_int_equal(s.school.fish->added_mass.extent, EXTENT_THICKNESS);
}

TEST(keys_in_the_case_override_the_preset) {
    struct case_values s = parse(
        "format: 1\npreset: published\ntime: {end: 1}\nsheet: {kutta: edge}\n"
        "defaults: {fish: {wave: {ramp: 2}}}\nfish: [{body: {second_moment: ellipse}}]\n");
    assert_int_equal(s.school.sheet.kutta, KUTTA_EDGE);
    assert_int_equal(s.school.sheet.collocation, COLLOCATION_MIDPOINT);
    NEAR(s.school.fish->wave.ramp, 2, 0, 0);
    assert_int_equal(s.school.fish->body.second_moment, SECOND_MOMENT_ELLIPSE);
}

// ---- values

TEST(every_type_of_value_is_read) {
    struct case_values s = parse(
        "format: 1\nname: no\ntime: {end: 2.0E0}\nfluid: {velocity: [-1, .5], gust: {amplitude: 1, frequency: 2}}\n"
        "fish:\n"
        "  - nodes: 5\n"
        "    body: {profile: table, thickness_table: [0.1, 0.2, 0.2, 0.1], depth_table: [1, 2, 3, 4]}\n"
        "    control: {law: heading, desired_heading: [[0, 180], [5, 135]]}\n"
        "  - {name: 'a: b', control: {law: heading, desired_heading: -90}}\n"
        "  - {control: {waypoints: [[1, 2], [3, 4], [5, 6]]}}\n");
    assert_string_equal(s.name, "no");
    NEAR(s.time.end, 2, 0, 0);
    NEAR_ARRAY(2, s.school.fluid.velocity, ((const double[]){-1, 0.5}), 0, 0);
    NEAR(s.school.fluid.gust_frequency, 2, 0, 0);
    assert_int_equal(s.school.fish[0].body.thickness_table.n, 4);
    NEAR_ARRAY(4, s.school.fish[0].body.depth_table.value, ((const double[]){1, 2, 3, 4}), 0, 0);
    assert_int_equal(s.school.fish[0].control.desired_heading.n, 2);
    NEAR_ARRAY(4, s.school.fish[0].control.desired_heading.value, ((const double[]){0, 180, 5, 135}), 0, 0);
    assert_int_equal(s.school.fish[2].control.waypoints.n, 3);
    NEAR_ARRAY(6, s.school.fish[2].control.waypoints.value, ((const double[]){1, 2, 3, 4, 5, 6}), 0, 0);
    assert_string_equal(s.school.fish[1].name, "a: b");
    NEAR(s.school.fish[1].control.desired_heading.value[1], -90, 0, 0);
}

TEST(multiples_are_recognised_despite_rounding) {
    // 0.3/0.1, 25/0.005 and 4.35/0.01 are no integers in double precision
    static const char *const times[] = {"{end: 0.3, shedding_interval: 0.1}", "{end: 25, shedding_interval: 0.005}",
                                        "{end: 4.35}", "{end: 1, output_interval: 0.07}"};
    for (size_t i = 0; i < sizeof times / sizeof *times; i++) {
        char text[200];
        snprintf(text, sizeof text, "format: 1\ntime: %s\nfish: [{}]\n", times[i]);
        parse(text);
    }
}

TEST(errors_of_all_stages_are_listed_together) {
    is_refused("format: 1\ntime: {end: 1.005, shedding_interval: 0.01}\nfish: [{length: x}, {nodes: 1}]\n",
               "time.end: 1.005 s is not an integer");
    assert_non_null(strstr(status_message(), "fish[0].length: expects a number in m, got 'x'"));
    assert_non_null(strstr(status_message(), "fish[1].nodes: must be from 4"));
}

TEST(what_stands_in_for_a_value_with_an_error_causes_no_error) {
    // the points are too few for the default number of nodes, and the table for the default profile
    is_refused(
        "format: 1\ntime: {end: 1}\nfish: [{nodes: x, sheet_points: 12, body: {profile: x, depth_table: [1]}}]\n",
        "fish[0].nodes: expects an integer");
    assert_non_null(strstr(status_message(), "fish[0].body.profile: expects one of"));
    assert_null(strstr(status_message(), "fish[0].sheet_points"));
    assert_null(strstr(status_message(), "fish[0].body.depth_table"));
    is_refused("format: 1\ntime: {end: 1}\nfish: [{motion: {prescribed: head, heave: 0.1, frequency: x}}]\n",
               "fish[0].motion.frequency: expects a number");
    assert_null(strstr(status_message(), "fish[0].motion.heave"));
    // times of two sections
    is_refused("format: 1\ntime: {end: 1, output_interval: x}\noutput: {wake_interval: 0.025}\nfish: [{}]\n",
               "time.output_interval: expects a number in s");
    assert_null(strstr(status_message(), "output.wake_interval"));
}

TEST(characters_that_end_a_line_are_refused_in_strings) {
    // next line, line separator, paragraph separator, escape, delete
    static const char *const escapes[] = {"N", "L", "P", "e", "x7F"};
    for (int i = 0; i < 5; i++) {
        char text[80];
        snprintf(text, sizeof text, "format: 1\nname: \"a\\%sb\"\ntime: {end: 1}\nfish: [{}]\n", escapes[i]);
        is_refused(text, "name: must be one line without control characters");
    }
}

TEST(turns_of_a_fine_body_are_those_of_its_reference) {
    const char *const format =
        "format: 1\ntime: {end: 1}\nfish: [{nodes: 13, reference_nodes: 7, wave: {linear: 1, quadratic: 0, "
        "amplitude: %g}}]\n";
    char text[256];
    // the last joint, at 11/12 of the length, has half of the turn that it would have on the reference body
    const double folds = acos(-1) * 2 * 12 / 11;
    snprintf(text, sizeof text, format, 1.01 * folds);
    is_refused(text, "fish[0].wave.amplitude: the wave turns a joint by up to 3.17 rad");
    snprintf(text, sizeof text, format, 0.99 * folds);
    parse(text);
}

TEST(a_suggestion_differs_by_a_third_of_the_word_at_most) {
    static const struct {
        const char *text, *suggested;
    } cases[] = {
        {"format: 1\ntime: {ent: 1}\nfish: [{}]\n", "did you mean 'end'?"},
        {"format: 1\ntime: {ond: 1}\nfish: [{}]\n", "did you mean 'end'?"},
        {"format: 1\ntime: {eno: 1}\nfish: [{}]\n", "did you mean 'end'?"},
        {"format: 1\ntime: {xnx: 1}\nfish: [{}]\n", NULL},
        {"format: 1\ntime: {end: 1, sheddinx_intexval: 1}\nfish: [{}]\n", "did you mean 'shedding_interval'?"},
        {"format: 1\ntime: {end: 1, shxddinx_intxrvxl: 1}\nfish: [{}]\n", NULL},
        {"format: 1\ntime: {end: 1}\nfluid: {densxxy: 1}\nfish: [{}]\n", "did you mean 'density'?"},
        {"format: 1\ntime: {end: 1}\nfluid: {dexxxty: 1}\nfish: [{}]\n", NULL},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        is_refused(cases[i].text, cases[i].suggested ? cases[i].suggested : "unknown key");
        if (!cases[i].suggested) assert_null(strstr(status_message(), "did you mean"));
    }
}

TEST(a_misspelt_key_brings_no_second_error) {
    is_refused("format: 1\ntime: {end: 1.005, shedding_intervall: 0.005}\nfish: [{}]\n",
               "did you mean 'shedding_interval'?");
    assert_null(strstr(status_message(), "multiple"));
}

// ---- includes

TEST_WITH(an_include_is_weaker_than_the_file_that_includes_it, make_folder, remove_folder) {
    write_file("water.yaml", "fluid: {density: 1025, velocity: [1, 2]}\nwake: {lifetime: 4}\nfish: [{nodes: 9}, {}]\n");
    write_file("case.yaml",
               "include: [water.yaml]\nformat: 1\ntime: {end: 1}\nfluid: {velocity: [3, 4]}\nfish: [{}]\n");
    struct case_values s = read_file("case.yaml");
    NEAR(s.school.fluid.density, 1025, 0, 0);
    NEAR(s.school.fluid.velocity[0], 3, 0, 0);
    NEAR(s.school.wake.lifetime, 4, 0, 0);
    assert_int_equal(s.school.n_fish, 1);  // lists replace
    assert_int_equal(s.school.fish->nodes, 25);
    assert_string_equal(s.name, "case");
    assert_non_null(strstr(s.text, "include: [water.yaml]"));
}

TEST_WITH(includes_are_relative_to_their_file_and_the_last_is_strongest, make_folder, remove_folder) {
    assert_int_equal(system("mkdir below"), 0);
    write_file("below/more.yaml", "include: ../water.yaml\nname: more\nwake: {lifetime: 3}\n");
    write_file("water.yaml", "name: water\nwake: {lifetime: 4, smoothing: 0.4}\n");
    write_file("case.yaml", "include: [below/more.yaml]\nformat: 1\ntime: {end: 1}\nfish: [{}]\n");
    struct case_values s = read_file("case.yaml");
    NEAR(s.school.wake.lifetime, 3, 0, 0);
    NEAR(s.school.wake.smoothing, 0.4, 0, 0);
    assert_string_equal(s.name, "case");  // of no include, however deep and at any place of the list
    // an absolute path is relative to nothing
    char absolute[PATH_MAX + 100], folder[PATH_MAX];
    assert_non_null(getcwd(folder, sizeof folder));
    snprintf(absolute, sizeof absolute, "include: [%s/water.yaml]\nformat: 1\ntime: {end: 1}\nfish: [{}]\n", folder);
    write_file("below/.yaml", absolute);
    s = read_file("below/.yaml");
    NEAR(s.school.wake.lifetime, 4, 0, 0);
    assert_string_equal(s.name, ".yaml");  // a hidden file has a name and no ending
    assert_int_equal(unlink("below/.yaml"), 0);
    static const char text[] = "include: [below/more.yaml, water.yaml]\nformat: 1\ntime: {end: 1}\nfish: [{}]\n";
    write_file("case.yaml", text);
    s = read_file("case.yaml");
    assert_string_equal(s.name, "case");
    assert_int_equal(case_parse(&s, text, strlen(text), "memory", *state, 0, NULL), STATUS_OK);
    NEAR(s.school.wake.lifetime, 4, 0, 0);
    case_free(&s);
}

TEST_WITH(an_error_in_an_include_names_the_include, make_folder, remove_folder) {
    write_file("water.yaml", "fluid:\n  densty: 1025\n");
    write_file("case.yaml", "include: [water.yaml]\nformat: 1\ntime: {end: 1}\nfish: [{}]\n");
    struct case_values s;
    assert_int_equal(case_read(&s, "case.yaml", 0, NULL), STATUS_CASE);
    assert_string_equal(
        status_message(),
        "water.yaml:2:3: error: fluid.densty: unknown key; did you mean 'density'?\n  densty: 1025\n  ^");
}

TEST_WITH(a_case_that_cannot_be_read_is_a_file_error, make_folder, remove_folder) {
    struct case_values s;
    assert_int_equal(case_read(&s, "no_such_file.yaml", 0, NULL), STATUS_FILE);
    assert_int_equal(case_read(&s, ".", 0, NULL), STATUS_FILE);
    case_free(&s);
}

// ---- assignments

TEST(assignments_are_strongest_and_the_last_counts) {
    struct case_values s = parse_with(minimal, "time.end=5", "fish[0].start.position=[1, 2]", "time.end=6");
    NEAR(s.time.end, 6, 0, 0);
    NEAR_ARRAY(2, s.school.fish->start_position, ((const double[]){1, 2}), 0, 0);
}

TEST(a_star_assigns_to_every_fish) {
    static const char text[] =
        "format: 1\ntime: {end: 1}\ndefaults: {fish: {nodes: 8}}\nfish: [{nodes: 5}, {}, {wave: {phase: 3}}]\n";
    struct case_values s =
        parse_with(text, "fish[*].nodes=13", "fish[2].wave={frequency: 2}", "fish[*].wave.linear=0.5");
    for (int i = 0; i < 3; i++) {
        assert_int_equal(s.school.fish[i].nodes, 13);
        NEAR(s.school.fish[i].wave.linear, 0.5, 0, 0);
    }
    NEAR(s.school.fish[2].wave.phase, 3, 0, 0);  // a map is merged
    NEAR(s.school.fish[2].wave.frequency, 2, 0, 0);
    // each fish has its own map, which later assignments change
    s = parse_with(text, "fish[*].body={modulus: 2e5}", "fish[1].body.modulus=3e5", "fish[2].body.modulus=4e5");
    for (int i = 0; i < 3; i++) NEAR(s.school.fish[i].body.modulus, 2e5 + i * 1e5, 0, 0);
}

TEST(a_name_assigns_to_its_fish) {
    const char *const text = "format: 1\ntime: {end: 1}\nfish: [{name: leader}, {name: \"a: b.c\"}, {}]\n";
    struct case_values s = parse_with(text, "fish[leader].nodes=9", "fish[a: b.c].nodes=11", "fish[fish3].nodes=13");
    for (int f = 0; f < 3; f++) assert_int_equal(s.school.fish[f].nodes, 9 + 2 * f);
    // the last name counts
    s = parse_with(text, "fish[leader].name=first", "fish[first].nodes=7", "fish[2].nodes=15");
    assert_int_equal(s.school.fish[0].nodes, 7);
    assert_int_equal(s.school.fish[2].nodes, 15);
}

TEST(assignments_reach_defaults_preset_and_sections) {
    struct case_values s = parse_with(minimal, "defaults.fish.nodes=9", "preset=published", "sheet={kutta: edge}");
    assert_int_equal(s.school.fish->nodes, 9);
    assert_int_equal(s.school.wake.shedding, SHEDDING_IMPULSIVE);
    assert_int_equal(s.school.sheet.kutta, KUTTA_EDGE);
    s = parse_with(minimal, "fish=[{name: a}, {name: 'b = c'}]", "fish[1].length=2", "name=x=y");
    assert_int_equal(s.school.n_fish, 2);
    assert_string_equal(s.school.fish[1].name, "b = c");
    NEAR(s.school.fish[1].length, 2, 0, 0);
    assert_string_equal(s.name, "x=y");
}

// ---- showing

TEST(a_case_shown_reads_back_bit_for_bit) {
    static const char *const cases[] = {
        minimal,
        swept,
        zipped,
        refined,
        stated,
        "format: 1\nname: 'odd: \"name\"'\npreset: published\ntime: {end: 0.9, shedding_interval: 0.3}\n"
        "output: {file: 'a b.nc', precision: single}\nwake: {lifetime: 0.1e1, smoothing: 0.30000000000000004}\n"
        "defaults: {fish: {length: 0.1, start: {position: [-0.0, 1e-320]}}}\n"
        "fish:\n"
        "  - {nodes: 4, body: {profile: table, thickness_table: [0.1, 0.2, 0.3], depth_table: [1e-7, 1e7, "
        "12345.678901234567]}}\n"
        "  - {body: {profile: table, thickness_table: [[0, 0.1], [0.3, 0.2], [1, 0.1]], depth_table: [[0, 1], [1, "
        "2]]}}\n"
        "  - {name: '#2', control: {law: averaged_heading, desired_heading: [[0, 1], [0.1, 2]], filter: 3}}\n"
        "  - {control: {waypoints: [[1, 2]], damping: 0.3}}\n",
        // without the preset, whose feedforward is 1; one fish for each law, some with their own frequency
        "format: 1\ntime: {end: 1}\nfish: [{wave: {frequency: 0}, control: {bias: 0.1}},\n"
        "  {wave: {frequency: 3}, force: reactive, control: {law: heading, feedforward: 0.2}},\n"
        "  {start: {heading: 20}, control: {law: averaged_heading}}, {control: {law: course}}]\n",
        "format: 1\ntime: {end: 1}\nfish: [{wave: {wavelength: 0.7, constant: 0.1}},\n"
        "  {wave: {table: [[0, 1.5, 2], [3, 4, -0.1]]}}]\n",
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct case_values first = parse(cases[i]);
        const char *const shown = case_show(first.arena, &first);
        struct case_values second = parse(shown);
        are_equal(&first, &second);
        assert_string_equal(shown, case_show(second.arena, &second));
    }
}

// as given, unless it was rounded
TEST(a_time_in_beats_is_shown_as_given_and_reads_back_bit_for_bit) {
    struct case_values first = parse(
        "format: 1\ntime: {end: 7 beats, shedding_interval: 1/30 beat, output_interval: 1/7 beat}\n"
        "wake: {lifetime: 3 beats}\nfish: [{wave: {frequency: 0.7, ramp: 1 beat}}]\n");
    const char *const shown = case_show(first.arena, &first);
    assert_non_null(strstr(shown, "end: 7 beats "));
    assert_non_null(strstr(shown, "lifetime: 3 beats "));
    assert_non_null(strstr(shown, "ramp: 1 beat "));
    assert_null(strstr(shown, "output_interval: 0.14"));
    struct case_values second = parse(shown);
    NEAR(second.time.end, first.time.end, 0, 0);
    NEAR(second.school.shedding_interval, first.school.shedding_interval, 0, 0);
    NEAR(second.time.output_interval, first.time.output_interval, 0, 0);
    NEAR(second.school.fish->wave.ramp, first.school.fish->wave.ramp, 0, 0);
    assert_string_equal(shown, case_show(second.arena, &second));
}

TEST(a_shown_case_has_neither_preset_nor_defaults) {
    struct case_values s = parse_with(minimal, "preset=published", "defaults.fish.nodes=9", NULL);
    const char *const shown = case_show(s.arena, &s);
    assert_null(strstr(shown, "preset"));
    assert_null(strstr(shown, "defaults"));
    assert_non_null(strstr(shown, "    nodes: 9\n"));
    assert_non_null(strstr(shown, "  end: 3                                # s\n"));
}

TEST(the_table_of_keys_is_valid_text_and_json) {
    static char text[100000];
    for (int as_json = 0; as_json <= 1; as_json++) {
        memset(text, 0, sizeof text);
        FILE *const stream = fmemopen(text, sizeof text - 1, "w");
        assert_non_null(stream);
        assert_int_equal(case_keys(test_arena(), stream, as_json, NULL), case_table_n);
        assert_int_equal(fclose(stream), 0);
        int n = 0;
        const char *const mark = as_json ? "{\"path\": \"" : "default: ";
        for (const char *c = text; (c = strstr(c, mark)); c++) n++;
        assert_int_equal(n, case_table_n);
    }
    assert_int_equal(text[0], '[');
    assert_string_equal(text + strlen(text) - 3, "}]\n");
}

// ---- memory

TEST(freeing_twice_is_harmless) {
    struct case_values s = parse(swept);
    case_free(&s);
    case_free(&s);
    struct case_values zero = {0};
    case_free(&zero);
}
