/* test_study_print.c: Tests which bounds of the expectations are met by the results of members, and the text that says
 * so. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "case/case.h"
#include "case_fixture.h"
#include "near.h"
#include "study/member_file.h"
#include "study/study_print.h"

enum { N_MEMBERS = 3, N_FISH = 2 };

/* Three members, whose noses of the second fish are the corners of a triangle with sides of 3 and 4. */
static const double corner[N_MEMBERS][2] = {{1, 1}, {1, 5}, {4, 5}};
static const double speed[N_MEMBERS][N_FISH] = {{2, 3}, {4, 2.5}, {2, 2}};
static const double drift[N_MEMBERS][N_FISH] = {{-1, -1}, {-1.5, 0}, {-2, 1}};

static void set(struct member_file *member, const char *quantity, int fish, int xy, double value) {
    member->value[(member_file_quantity_number(quantity) * N_FISH + fish) * 2 + xy] = value;
}

/* Whether a statement holds; *printed, which the caller frees, is what it says. */
static enum status holds(const char *statement, const char *status_of_the_last, char **printed) {
    char text[512];
    snprintf(text, sizeof text,
             "format: 1\ntime: {end: 1}\nfish: [{name: a}, {name: b, start: {position: [0, 3]}}]\n"
             "sweep: [{key: solver.order, values: [1, 2, 3]}]\nexpect: [%s]\n",
             statement);
    struct case_values study;
    if (case_parse(&study, text, strlen(text), "stated.yaml", NULL, 0, NULL) != STATUS_OK) {
        fail_msg("%s", status_message());
    }
    int n = 0;
    while (member_file_quantity(n)) n++;
    struct member_file member[N_MEMBERS];
    for (int m = 0; m < N_MEMBERS; m++) {
        member[m] = (struct member_file){.number = m, .n_fish = N_FISH, .status = "complete"};
        member[m].value = calloc((size_t)n * N_FISH * 2, sizeof *member[m].value);
        for (int k = 0; k < 2; k++) set(&member[m], "nose", 1, k, corner[m][k]);
        for (int f = 0; f < N_FISH; f++) {
            set(&member[m], "speed", f, 0, speed[m][f]);
            set(&member[m], "lateral_drift", f, 0, drift[m][f]);
        }
    }
    member[N_MEMBERS - 1].status = status_of_the_last;

    size_t size;
    FILE *const stream = open_memstream(printed, &size);
    const enum status status = study_expect(&study, member, stream);
    fclose(stream);
    for (int m = 0; m < N_MEMBERS; m++) free(member[m].value);
    case_free(&study);
    return status;
}

static void check(const char *statement, const char *status_of_the_last, enum status want, const char *line) {
    char *printed;
    const enum status status = holds(statement, status_of_the_last, &printed);
    if (status != want || !strstr(printed, line) || strncmp(printed, "\nExpected:\n", 11) != 0) {
        fail_msg("%s: status %d, want %d; '%s' in:\n%s", statement, status, want, line, printed);
    }
    free(printed);
}

TEST(the_first_statement_that_is_missed_is_named_with_its_first_quantity) {
    static const char *const cases[][2] = {
        {"{of: speed, least: 2}, {of: nose, fish: b, spread: 5}, {of: [nose, tail], fish: b, spread: 4}",
         "expect[2]: nose: expectation not met: see the output"},
        {"{of: speed, least: 2}, {of: [lateral_drift, speed], least: 5}, {fails: unstable}, {of: speed, most: 4}",
         "expect[1]: speed: expectation not met, and others: see the output"},
        {"{of: speed, least: 2}, {fails: unstable}", "expect[1]: failures: expectation not met: see the output"},
    };
    for (int i = 0; i < 3; i++) {
        check(cases[i][0], "complete", STATUS_MISSED, "MISSED");
        assert_string_equal(status_message(), cases[i][1]);
    }
}

TEST(the_table_of_members_is_printed_whole) {
    static const char names[] =
        "time\0speed\0mean_heading\0cost_of_transport\0strouhal\0mean_thrust\0mean_power\0"
        "efficiency\0lateral_drift\0shed_circulation\0energy_balance\0steps\0wall_time\0"
        "residual_evaluations\0";
    static const char table[] =
        "member  [1]phase  length  fish  t    speed  heading   cost  Strouhal  thrust  power  efficiency"
        "   growth    drift      shed  balance  steps  evaluations   wall  power ratio  change  status\n"
        "          degree       m        s    m s-1   degree  m s-2                 N      W            "
        "      s-1        m    m2 s-1        J                          s                    W\n"
        "     0        10       2     a  1  2.00000    3.000      4    5.0000       6      7     8.00000"
        "        -  9.00000  10.00000  1.1e+01     12           14  13.00            -       -  complete\n"
        "     0        10       2     b  1  2.25000    3.250   4.25    5.2500    6.25   7.25     8.25000"
        "        -  9.25000  10.25000  1.1e+01     12           14  13.00       1.0357   +0.25  complete\n"
        "     1        20       3     a  -        -        -      -         -       -      -           -"
        "  +0.2500        -         -        -      -            -      -            -       -  failed\n"
        "     1        20       3     b  -        -        -      -         -       -      -           -"
        "  +0.2500        -         -        -      -            -      -            -       -  failed\nmember 1 "
        "failed: unstable: t = 1\n";
    for (int i = 0; i < 2; i++) {
        char text[512], *printed;
        snprintf(text, sizeof text,
                 "format: 1\ntime: {end: 1}\nfish: [{name: a}, {name: b, start: {position: [0, 3]}, motion: "
                 "{prescribed: head, surge: %s}}]\n"
                 "sweep: [{keys: [\"fish[1].wave.phase\", \"fish[*].length\"], values: [[10, 2], [20, 3]]}]\n",
                 i == 0 ? "given" : "free");
        const struct case_values study = parse(text);
        struct member_file member[] = {{.status = "complete"}, {.number = 1, .status = "failed: unstable: t = 1"}};
        for (int m = 0; m < 2; m++) member_file_create_values(test_arena(), &member[m], N_FISH);
        int k = 1;
        for (const char *name = names; *name; name += strlen(name) + 1, k++) {
            for (int f = 0; f < N_FISH; f++) set(&member[0], name, f, 0, k + 0.25 * f);
        }
        set(&member[1], "steady_growth", 0, 0, 0.25);
        size_t size;
        FILE *const stream = open_memstream(&printed, &size);
        study_print(test_arena(), &study, member, stream);
        fclose(stream);
        if (i == 0) assert_string_equal(printed, table);
        assert_true((!strstr(printed, "thrust") && !strstr(printed, "  power  ") && !strstr(printed, "eff")) == i);
        free(printed);
    }
}

TEST(warnings_that_differ_in_numbers_are_of_one_kind) {
    static const char *const warnings[] = {"a is 4e+03 m", "a is 27 m\nb is 27 m", "", "a is 2.7e-1 m", "b is 28 m",
                                           "a is 27 mm"};
    struct member_file member[6];
    for (int m = 0; m < 6; m++) member[m] = (struct member_file){.warnings = warnings[m]};
    char *printed;
    size_t size;
    FILE *const stream = open_memstream(&printed, &size);
    assert_int_equal(study_print_warnings(test_arena(), member, 6, stream), 6);
    fclose(stream);
    assert_string_equal(printed,
                        "members 0-1, 3: warning: a is 4e+03 m (numbers of member 0)\n"
                        "members 1, 4: warning: b is 27 m (numbers of member 1)\nmember 5: warning: a is 27 mm\n");
    free(printed);
}

TEST(bounds_hold_for_all_fish_of_all_members_the_bounds_included) {
    check("{of: speed, least: 2, most: 4}", "complete", STATUS_OK, "speed, 6 values\n");
    check("{of: speed, least: 2.01}", "complete", STATUS_MISSED, "MISSED   the smallest is 2, expected at least 2.01");
    check("{of: speed, most: 3.99}", "complete", STATUS_MISSED, "MISSED   the largest is 4, expected at most 3.99");
}

TEST(a_statement_may_be_about_one_fish_and_some_members) {
    check("{of: speed, fish: b, most: 3}", "complete", STATUS_OK, "speed of b, 3 values\n");
    check("{of: speed, where: [solver.order=2, solver.order=3], least: 2}", "complete", STATUS_OK, "speed, 4 values\n");
    check("{of: speed, fish: b, where: [solver.order=2], least: 2.5, most: 2.5}", "complete", STATUS_OK, "1 value\n");
}

TEST(a_spread_of_points_is_the_diagonal_of_the_box_around_them) {
    check("{of: nose, fish: b, spread: 5}", "complete", STATUS_OK, "met      the spread is 5, expected at most 5");
    check("{of: nose, fish: b, spread: 4.99}", "complete", STATUS_MISSED, "MISSED   the spread is 5");
    check("{of: speed, spread: 2}", "complete", STATUS_OK, "met      the spread is 2");
}

TEST(a_ratio_is_one_of_absolute_values) {
    check("{of: speed, ratio: 2}", "complete", STATUS_OK, "met      the ratio is 2");
    check("{of: speed, ratio: 1.99}", "complete", STATUS_MISSED, "MISSED   the ratio is 2");
    check("{of: lateral_drift, fish: a, ratio: 2}", "complete", STATUS_OK, "met      the ratio is 2");
    check("{of: lateral_drift, fish: a, ratio: 1.99}", "complete", STATUS_MISSED, "MISSED   the ratio is 2");
}

TEST(values_of_both_signs_or_zero_miss_every_ratio) {
    static const char missed[] = "MISSED   the ratio is inf";
    check("{of: lateral_drift, ratio: 1e9, fish: b, where: [solver.order=1, solver.order=3]}", "complete",
          STATUS_MISSED, missed);
    check("{of: lateral_drift, ratio: 1e9, fish: b, where: [solver.order=1, solver.order=2]}", "complete",
          STATUS_MISSED, missed);
    check("{of: lateral_drift, ratio: 1e9, fish: b, where: [solver.order=2, solver.order=3]}", "complete",
          STATUS_MISSED, missed);
}

TEST(a_member_that_is_not_complete_misses_whatever_its_values) {
    check("{of: speed, least: 0}", "stopped", STATUS_MISSED, "MISSED   member 2 is not complete");
    check("{of: speed, least: 0, where: [solver.order=1, solver.order=2]}", "stopped", STATUS_OK, "4 values");
}

TEST(of_many_kinds_of_warnings_the_first_are_printed_and_all_are_counted) {
    enum { N = 23, SHOWN = 20 };
    struct member_file member[N];
    char warning[N][24], *printed;
    for (int m = 0; m < N; m++) {
        snprintf(warning[m], sizeof warning[m], "%c is %d", 'a' + m, m);
        member[m] = (struct member_file){.number = m, .status = "complete", .warnings = warning[m]};
    }
    size_t size;
    FILE *const stream = open_memstream(&printed, &size);
    struct arena *const arena = arena_create(NULL, "a test");
    assert_int_equal(study_print_warnings(arena, member, N, stream), N);
    fclose(stream);
    arena_free(arena);
    for (int m = 0; m < N; m++) {
        char line[64];
        snprintf(line, sizeof line, "member %d: warning: %c is %d\n", m, 'a' + m, m);
        assert_int_equal(strstr(printed, line) != NULL, m < SHOWN);
    }
    assert_non_null(strstr(printed, "\nThe first 20 of 23 kinds of warnings; study.nc has all.\n"));
    free(printed);
}

TEST(failures_are_expected_by_a_part_of_their_words) {
    check("{fails: unstable, where: [solver.order=3]}", "failed: unstable at t = 1", STATUS_OK, "failures, 1 member\n");
    check("{fails: singular, where: [solver.order=3]}", "failed: unstable at t = 1", STATUS_MISSED,
          "MISSED   member 2 has not failed with 'singular'");
    check("{fails: unstable}", "failed: unstable at t = 1", STATUS_MISSED, "MISSED   member 1 has not failed");
}
