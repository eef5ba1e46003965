/* test_sweep.c: The axes of a sweep give its members, and references and expectations find the members that they are
 * about. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "case/case.h"
#include "case/sweep.h"
#include "case/sweep_error.h"
#include "case/sweep_expect.h"
#include "case/sweep_quantity.h"
#include "case_fixture.h"

TEST(a_sweep_keeps_its_values_as_assignments_take_them) {
    struct case_values s = parse(swept);
    assert_int_equal(s.n_axes, 3);
    assert_string_equal(s.sweep[0].key[0].path, "fish[*].body.modulus");
    assert_int_equal(s.sweep[0].n_values, 3);
    assert_string_equal(s.sweep[0].value[2], "1.0e+8");
    assert_string_equal(s.sweep[1].value[1], "[0, 2]");
    char assignment[100];
    snprintf(assignment, sizeof assignment, "%s=%s", s.sweep[1].key[0].path, s.sweep[1].value[1]);
    s = parse_with(swept, assignment, NULL, NULL);
    NEAR(s.school.fish[1].start_position[1], 2, 0, 0);
}

TEST(values_in_beats_are_no_numbers) {
    struct case_values s = parse(
        "format: 1\ntime: {end: 1}\nfish: [{}]\n"
        "sweep: [{key: wake.lifetime, values: [3, 4]}, {key: wake.decay, values: [1 beat, 1]}]\n");
    assert_true(s.sweep[0].key[0].is_number);
    assert_false(s.sweep[1].key[0].is_number);
}

TEST(members_are_numbered_with_the_last_axis_fastest) {
    struct case_values study = parse(zipped);
    assert_int_equal(sweep_n_members(&study), 6);
    assert_null(strstr(study.common, "sweep"));  // the work for a member does not grow with the number of members
    for (int m = 0; m < 6; m++) {
        const struct case_values s = member_of(&study, m);
        NEAR(s.school.shedding_interval, 0.1 / (1 << m / 2), 0, 1e-15);
        // derived values follow swept ones
        NEAR(s.time.output_interval, 1.0 / (1 << m / 2), 0, 1e-15);
        assert_int_equal(s.school.fish[0].nodes, m % 2 ? 9 : 7);
        assert_string_equal(s.school.fish[1].name, m % 2 ? "a: b" : "thin");
        assert_int_equal(s.n_axes, 0);
        assert_int_equal(s.member, m);
        assert_string_equal(s.study, study.merged);
        assert_string_equal(s.text, study.text);
    }
    assert_string_equal(sweep_member_text(study.arena, &study, 3),
                        "time.shedding_interval=0.05, fish[*].nodes=9, fish[1].name=\"a: b\"");
}

/* A search that starts from the previous state would start from its places and speeds instead of the swept ones. */
TEST(swept_starts_of_free_fish_are_not_those_of_the_previous_state) {
    static const struct {
        const char *key, *values, *motion;
        int before;
    } axes[] = {
        {"fish[1].start.position", "[[2, 0], [3, 0]]", "", -1},
        {"fish[*].start.position", "[[2, 0], [3, 0]]", "prescribed: all, surge: free", -1},
        {"fish[*].start.speed", "[1, 2]", "", -1},
        {"fish[0].start.position", "[[2, 0], [3, 0]]", "", 0},  // the others follow it
        {"fish[1].start.position", "[[2, 0], [3, 0]]", "prescribed: all", 0},
        {"fish[*].start.speed", "[1, 2]", "prescribed: all", 0},
        {"fish[1].start.heading", "[0, 1]", "", 0},
        {"fish[1].wave.amplitude", "[0.1, 0.2]", "", 0},
    };
    for (size_t i = 0; i < sizeof axes / sizeof *axes; i++) {
        char text[500];
        snprintf(
            text, sizeof text,
            "format: 1\ntime: {end: 1}\ndefaults: {fish: {motion: {%s}}}\nfish: [{}, {start: {position: [0, 1]}}]\n"
            "sweep: [{key: \"%s\", values: %s, steady: true}]\n",
            axes[i].motion, axes[i].key, axes[i].values);
        const struct case_values s = parse(text);
        assert_int_equal(sweep_member_before(&s, 1), axes[i].before);
    }
}

TEST(the_merged_text_is_the_complete_study) {
    struct case_values study = parse_with(zipped, "fish[0].length=2", "wake.decay=0.1", NULL);
    struct case_values again = parse(study.merged);
    are_equal(&study, &again);
    assert_string_equal(again.merged, study.merged);
}

TEST(a_reference_has_the_value_of_relative_to_and_all_others_of_the_member) {
    struct case_values study = parse(
        "format: 1\ntime: {end: 1}\nfish: [{}]\nsweep:\n"
        "  - {key: solver.rtol, values: [1e-4, 1e-5, 1e-6], relative_to: 0.00001}\n"
        "  - {key: solver.order, values: [2, 3]}\n");
    for (int m = 0; m < 6; m++) assert_int_equal(sweep_member_reference(&study, m), 2 + m % 2);
    struct case_values again = parse(study.merged);
    are_equal(&study, &again);
    assert_non_null(strstr(case_show(test_arena(), &study), "    relative_to: 1e-5\n"));

    study = parse(
        "format: 1\ntime: {end: 1}\nfish: [{}]\nsweep:\n"
        "  - {key: solver.order, values: [2, 3]}\n"
        "  - {key: \"fish[0].start.position\", values: [[0, 0], [1, 0]], relative_to: [1, 0]}\n");
    for (int m = 0; m < 4; m++) assert_int_equal(sweep_member_reference(&study, m), 1 + m / 2 * 2);
    study = parse(zipped);
    assert_int_equal(sweep_member_reference(&study, 0), -1);
}

TEST(a_sweep_is_shown_as_it_is_written) {
    struct case_values study = parse(refined);
    const char *const text = case_show(test_arena(), &study);
    assert_non_null(strstr(text, "    expect: {order: 0.8, within: 0.2, of: [com, speed]}\n"));
    assert_non_null(strstr(text, "    values: [1e-3, 1e-4, 1e-5]\n"));
}

TEST(a_reference_is_given_for_all_fish_or_for_each) {
    struct case_values s = parse(refined);
    // quantities in the order of the table: nose, tail, com, speed, mean_heading
    for (int f = 0; f < 2; f++) {
        for (int k = 0; k < 2; k++) {
            NEAR(sweep_reference(&s, 0, 0, f, k), 1 + 2 * f + k, 0, 0);
            assert_true(isnan(sweep_reference(&s, 0, 1, f, k)));
            NEAR(sweep_reference(&s, 0, 2, f, k), 5 + k, 0, 0);
        }
        NEAR(sweep_reference(&s, 0, 3, f, 0), 1.25, 0, 0);
        NEAR(sweep_reference(&s, 0, 4, f, 0), 7 + f, 0, 0);
    }
    assert_int_equal(s.sweep[0].order_of, 1 << 3 | 1 << 2);
    s = parse(zipped);
    assert_true(isnan(sweep_reference(&s, 0, 0, 0, 0)));
    assert_int_equal(s.sweep[0].order_of, 1 << SWEEP_NOSE | 1 << SWEEP_TAIL);
}

TEST(an_expectation_is_about_the_members_with_its_values) {
    struct case_values s = parse(stated);
    assert_int_equal(s.n_expectations, 4);
    assert_string_equal(s.expect[3].fails, "is: unstable");
    assert_null(s.expect[0].fails);
    assert_int_equal(s.expect[0].of, 1 << 3);
    assert_int_equal(s.expect[0].fish, 1);
    assert_int_equal(s.expect[1].fish, -1);
    assert_int_equal(s.expect[1].of, 1 << SWEEP_NOSE | 1 << SWEEP_TAIL);
    NEAR(s.expect[0].ratio, 3, 0, 0);
    assert_true(isinf(s.expect[0].spread));
    // members: (ida 1e-3, 1), (.., 2), (rk4 1e-4, 1), (.., 2), (ida 1e-4, 1), (.., 2)
    static const bool are_meant[4][6] = {
        {1, 1, 1, 1, 1, 1}, {0, 0, 0, 1, 0, 1}, {1, 1, 0, 0, 1, 1}, {0, 1, 0, 0, 0, 0}};
    for (int i = 0; i < 4; i++) {
        for (int m = 0; m < 6; m++) assert_int_equal(sweep_expects_of(&s, &s.expect[i], m), are_meant[i][m]);
    }
    assert_int_equal(member_of(&s, 2).n_expectations, 0);
    // an expectation may be about the first member only
    s = parse(
        "time: {end: 1, shedding_interval: 0.1}\nformat: 1\nfish: [{}]\n"
        "sweep: [{key: solver.rtol, values: [1e-3, 1e-4]}]\n"
        "expect: [{of: speed, fish: fish1, least: 1, where: [solver.rtol=1e-3]}]\n");
    assert_int_equal(sweep_expects_of(&s, s.expect, 0), 1);
    assert_int_equal(sweep_expects_of(&s, s.expect, 1), 0);
    assert_non_null(strstr(case_show(s.arena, &s), "{of: [speed], fish: fish1, where: "));
}

TEST(a_wrong_member_is_named) {
    struct case_values study =
        parse("format: 1\ntime: {end: 1}\nfish: [{}]\nsweep: [{key: wake.lifetime, values: [1, 0.003]}]\n");
    struct case_values s = member_of(&study, 0);
    assert_int_equal(case_member(&s, &study, 1), STATUS_CASE);
    assert_non_null(strstr(status_message(), "member 1 (wake.lifetime=0.003):\n"));
    assert_non_null(strstr(status_message(), "wake.lifetime: 0.003 s is less than time.shedding_interval, 0.01 s"));
}

TEST(a_sweep_is_refused_as_one_run_with_a_remedy) {
    struct case_values s = parse(minimal);
    assert_int_equal(sweep_refuse(&s), STATUS_OK);
    s = parse(swept);
    assert_int_equal(sweep_refuse(&s), STATUS_CASE);
    assert_non_null(strstr(status_message(), "error: sweep: this case has a sweep of 3 axes: use `shoal study`"));
}

TEST(a_key_of_an_error_has_at_most_nine_levels) {
    static const char text[] = "format: 1\ntime: {end: 1}\nfish: [{}]\n";
    const char *const levels[] = {"error={of: speed, keys: {nodes: [9, 10, 11, 12, 13, 14, 15, 16, 17]}}",
                                  "error={of: speed, keys: {nodes: [9, 10, 11, 12, 13, 14, 15, 16, 17, 18]}}"};
    struct case_values s = parse_with(text, levels[0], NULL, NULL);
    assert_int_equal(s.error->levels[0].n, 9);
    assert_int_equal(case_parse(&s, text, strlen(text), "x.yaml", NULL, 1, &levels[1]), STATUS_CASE);
    assert_non_null(strstr(status_message(), "more than 9 levels of 'fish.nodes'"));
}

TEST(an_error_is_shown_as_it_is_written) {
    // a word that two keys share has its section
    static const char error[] =
        "error: {of: [speed, nose], within: 0.01, most: 5, confirm: false, models: true, keys: {nodes: [9, 13], rtol: "
        "default, sheet.smoothing: [0.1, 0.2]}}";
    char text[400];
    snprintf(text, sizeof text, "format: 1\ntime: {end: 1}\nfish: [{}]\n%s\n", error);
    struct case_values s = parse(text);
    assert_non_null(strstr(case_show(s.arena, &s), error));
    s = parse_with(minimal, "error={of: speed, keys: [smoothing]}", NULL, NULL);
    assert_non_null(strstr(case_show(s.arena, &s), "error: {of: [speed], keys: {smoothing: default}}"));
}

TEST(a_file_to_compare_with_ends_in_yaml) {
    assert_true(sweep_error_is_file("alone.yaml"));
    assert_true(sweep_error_is_file("../a.b/alone.yml"));
    assert_false(sweep_error_is_file("first"));
    assert_false(sweep_error_is_file("1.5e6"));
    assert_false(sweep_error_is_file("a.yaml=b"));
}
