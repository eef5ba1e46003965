/* test_compare.c: Tests the table of a comparison of methods. test_compare_command.sh tests what its processes do. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "case_fixture.h"
#include "study/compare.h"
#include "study/study_file.h"
#include "study/study_folder.h"

#define CASE "format: 1\nname: small\ntime: {end: 0.02, shedding_interval: 0.02}\n"
#define ROW_A "[rk4, 4, 1e-5, 0.01]"
#define ROW_B "[ida, 2, 1e-3, 0]"

/* Two fish of lengths 2 and 0.5; a four times, b three times. */
static const char repeated[] = CASE
    "fish: [{length: 2}, {length: 0.5, start: {position: [0, 9]}}]\n"
    "sweep: [{keys: [solver.method, solver.order, solver.rtol, solver.step],\n"
    "    values: [[ida, 5, 1e-9, 0], [ida, 5, 1e-8, 0], " ROW_A ", " ROW_B ", " ROW_A ", " ROW_B ", " ROW_A ", " ROW_B
    ", " ROW_A "]}]\n";
static const double wall_times[] = {100, 90, 2, 3, 10, 1, 1, 20, 3};
enum { N_MEMBERS = sizeof wall_times / sizeof *wall_times };

static double *at(const struct member_file *member, const char *quantity, int fish, int xy) {
    return member_file_place(member, member_file_quantity_number(quantity), fish, xy);
}

/* Complete members with these wall times, and noses that are off by their numbers. */
static struct member_file *members_of(const struct case_values *study) {
    assert_int_equal(sweep_n_members(study), N_MEMBERS);
    struct member_file *members;
    NEW(test_arena(), members, N_MEMBERS);
    for (int m = 0; m < N_MEMBERS; m++) {
        members[m].status = "complete";
        member_file_create_values(test_arena(), &members[m], 2);
        *at(&members[m], "wall_time", 0, 0) = wall_times[m];
        for (int f = 0; f < 2; f++) {
            *at(&members[m], "nose", f, 0) = 7 + 3 * m;
            *at(&members[m], "nose", f, 1) = 5 + 4 * m;
            for (int k = 0; k < 2; k++) *at(&members[m], "tail", f, k) = f == 0 ? 1 + m : 1;
        }
    }
    return members;
}

static const char *print(const struct case_values *study, const struct member_file *members) {
    static char text[4096];
    memset(text, 0, sizeof text);
    FILE *const stream = fmemopen(text, sizeof text - 1, "w");
    compare_print(test_arena(), study, members, stream);
    fclose(stream);
    return text;
}

static void assert_has(const char *text, const char *part) {
    if (!strstr(text, part)) fail_msg("\"%s\" is not in\n%s", part, text);
}

TEST(errors_are_distances_from_the_first_member_in_lengths) {
    struct case_values study = parse(repeated);
    struct member_file *const members = members_of(&study);
    compare_fill(&study, members);
    NEAR(*at(&members[0], "nose_error", 1, 0), 0, 0, 0);
    NEAR(*at(&members[4], "nose_error", 0, 0), 5 * 4 / 2.0, 0, 1e-15);
    NEAR(*at(&members[4], "nose_error", 1, 0), 5 * 4 / 0.5, 0, 1e-15);
    NEAR(*at(&members[4], "tail_error", 0, 0), 4 * sqrt(2) / 2, 0, 1e-15);
    NEAR(*at(&members[4], "tail_error", 1, 0), 0, 0, 0);
    // the table shows the fish with the larger error
    assert_has(print(&study, members), "difference of ida5, rtol 1e-8: 1.0e+01 (nose) and 7.1e-01 (tail) lengths");
}

TEST(the_wall_time_is_the_median_of_the_repeats) {
    struct case_values study = parse(repeated);
    struct member_file *const members = members_of(&study);
    const char *text = print(&study, members);
    assert_has(text, "\n   rk4     -  0.01        -        -      -  2.500  4.500 ");  // 1, 2, 3, 10
    assert_has(text, "\n  ida2  1e-3     -        -        -      -  3.000  9.500 ");  // 1, 3, 20
    // what has failed has no time, and is said once
    for (int m = 2; m < N_MEMBERS; m += 2) members[m].status = "failed: too slow";
    text = print(&study, members);
    assert_has(text, "\n   rk4     -  0.01        -        -      -      -      - ");
    assert_has(text, "failed\n  ida2");
    assert_has(text, "complete\nrk4, step 0.01 failed: too slow\n");
    assert_null(strstr(strstr(text, "too slow") + 1, "too slow"));
}

/* A member beyond the limit has done a quarter of 0.02 s. */
TEST(a_run_beyond_the_limit_is_extrapolated_and_marked) {
    struct case_values study = parse(repeated);
    struct member_file *const members = members_of(&study);
    for (int m = 2; m < N_MEMBERS; m += 2) {
        members[m].status = "failed: too slow: at t = 0.005 s after 2 s";
        members[m].progress = "0.005 30 120 0 0 1.5";
    }
    // what an early row of the file has, and no progress at all
    *at(&members[2], "steps", 0, 0) = 0;
    members[3].status = "failed: too slow: at t = 0 s after 2 s";
    members[3].progress = "0 0 0 0 0 0";
    compare_fill(&study, members);
    NEAR(*at(&members[2], "time", 0, 0), 0.005, 0, 0);
    NEAR(*at(&members[2], "steps", 0, 0), 30, 0, 0);
    NEAR(*at(&members[2], "residual_evaluations", 0, 0), 120, 0, 0);
    NEAR(*at(&members[2], "evaluations_to_end", 0, 0), 480, 0, 1e-12);
    NEAR(*at(&members[2], "wall_time_to_end", 0, 0), 6, 0, 1e-12);
    NEAR(*at(&members[5], "wall_time_to_end", 0, 0), wall_times[5], 0, 0);
    assert_true(isnan(*at(&members[3], "wall_time_to_end", 0, 0)));
    assert_true(isnan(*at(&members[2], "nose_error", 0, 0)));
    const char *const text = print(&study, members);
    assert_has(text,
               "\n   rk4     -  0.01        -        -      -      ~6      -   ~120      ~480       0          0   "
               "12500.0  failed\n");
    // one of the repeats of ida has no progress
    assert_has(text,
               "\n  ida2  1e-3     -        -        -      -  10.500  9.500      -         -       -          -       "
               "  -  failed\n");
    assert_has(text, "~: extrapolated to the end, t = 0.02 s, from what was done within --limit.\n");
    assert_has(text, "rk4, step 0.01 failed: too slow: at t = 0.005 s after 2 s, 30 steps and 120 evaluations\n");
    assert_has(text, "ida2, rtol 1e-3 failed: too slow: at t = 0 s after 2 s\n");
}

/* Errors of 4e-5 and 4e-3 for 1000 and 100 evaluations, and of 2e-4 and 2e-2 for 800 and 80: at 1e-3 a power law gives
 * 200 and 357.8. A reference that is off by 1e-5 moves the first by 200 log(10)/log(100) 1e-2. */
TEST(the_cost_at_equal_error_is_that_of_a_power_law) {
    static const char text[] = CASE
        "fish: [{}]\nsweep: [{keys: [solver.method, solver.order, solver.rtol, solver.step],\n"
        "    values: [[ida, 5, 1e-9, 0], [ida, 5, 1e-8, 0], [ida, 2, 1e-5, 0], [ida, 2, 1e-3, 0],\n"
        "        [rk4, 4, 1e-5, 0.005], [rk4, 4, 1e-5, 0.01], [heun, 2, 1e-3, 0]]}]\n";
    static const double error[] = {0, 1e-5, 4e-5, 4e-3, 2e-4, 2e-2, 1e-4},
                        evaluations[] = {9e4, 8e4, 1000, 100, 800, 80, 70};
    struct case_values study = parse(text);
    enum { N = 7 };
    struct member_file *members;
    NEW(test_arena(), members, N);
    for (int m = 0; m < N; m++) {
        members[m].status = "complete";
        member_file_create_values(test_arena(), &members[m], 1);
        for (int k = 0; k < 2; k++) *at(&members[m], "tail", 0, k) = *at(&members[m], "nose", 0, k) = 3;
        // the nose is right where the power is wrong
        if (m % 2 == 0) *at(&members[m], "nose", 0, 0) += error[m];
        *at(&members[m], "actuation_work", 0, 0) = 5 * (1 - (m % 2 == 0 ? 0 : error[m]));
        *at(&members[m], "wall_time", 0, 0) = evaluations[m] / 100;
        *at(&members[m], "residual_evaluations", 0, 0) = evaluations[m];
    }
    compare_fill(&study, members);
    NEAR(*at(&members[3], "power_error", 0, 0), 4e-3, 0, 1e-9);
    NEAR(*at(&members[2], "power_error", 0, 0), 0, 0, 0);
    const char *const printed = print(&study, members);
    assert_has(printed, "relative difference of the power 1.0e-05.");
    assert_has(printed, "Cost at an error of 1e-03 in nose, tail (lengths) and power (part), known to 1.0e-05:");
    assert_has(printed, "\n  ida2       200   1    2.000  0.010  between rtol 1e-5 and rtol 1e-3\n");
    assert_has(printed, "\n   rk4       358   2    3.578  0.018  between step 0.005 and step 0.01\n");
    assert_has(printed, "\n  heun        70   0    0.700      -  at most: error 1.0e-04 with rtol 1e-3\n");
    // 10 ms for an evaluation
    assert_has(printed, " 10000.0  complete\n");
    // at ten times the error of the reference; where all settings are below, the cheapest is the bound
    *at(&members[1], "actuation_work", 0, 0) = 5 * (1 - 3e-4);
    compare_fill(&study, members);
    const char *const rough = print(&study, members);
    assert_has(rough, "Cost at an error of 1e-02 in nose, tail (lengths) and power (part), known to 3.0e-04:");
    assert_has(rough, "\n  ida2       100   0    1.000      -  at most: error 4.0e-03 with rtol 1e-3\n");
    // a setting has the common error, 1e-3: the reference, off by 1e-5, may make it cheaper by 1000 (1 - 1.01^-(1/2))
    *at(&members[1], "actuation_work", 0, 0) = 5 * (1 - 1e-5);
    *at(&members[2], "nose", 0, 0) = 3 + 1e-3;
    *at(&members[3], "actuation_work", 0, 0) = 5 * (1 - 0.1);
    compare_fill(&study, members);
    assert_has(print(&study, members), "\n  ida2      1000   5   10.000  0.050  between rtol 1e-5 and rtol 1e-3\n");
}

/* One method with fixed steps, twice, and with adaptive steps: two rows of costs. The bar of the wall time has half the
 * range of the repeats of the less repeatable setting. */
TEST(steps_of_a_kind_are_compared_and_their_spread_is_in_the_bar) {
    static const char text[] = CASE
        "fish: [{}]\nsweep: [{keys: [solver.method, solver.order, solver.rtol, solver.step],\n"
        "    values: [[ida, 5, 1e-9, 0], [ida, 5, 1e-8, 0], " ROW_A ", [rk4, 4, 1e-5, 0.005], [rk4, 4, 1e-4, 0], " ROW_A
        ", [rk4, 4, 1e-5, 0.005]]}]\n";
    static const double error[] = {0, 1e-9, 4e-3, 4e-5, 2e-4, 4e-3, 4e-5}, wall_time[] = {90, 80, 2, 10, 5, 2.4, 11};
    struct case_values study = parse(text);
    enum { N = 7 };
    struct member_file *members;
    NEW(test_arena(), members, N);
    for (int m = 0; m < N; m++) {
        members[m].status = "complete";
        member_file_create_values(test_arena(), &members[m], 1);
        for (int k = 0; k < 2; k++) *at(&members[m], "tail", 0, k) = *at(&members[m], "nose", 0, k) = 3;
        *at(&members[m], "tail", 0, 1) += error[m];
        *at(&members[m], "wall_time", 0, 0) = wall_time[m];
        *at(&members[m], "residual_evaluations", 0, 0) = 100 * wall_time[m];
    }
    compare_fill(&study, members);
    const char *const printed = print(&study, members);
    // at 1e-3 a power law between 10.5 s for 4e-5 and 2.2 s for 4e-3
    char row[128];
    snprintf(row, sizeof row, "  %.3f  0.500  between step 0.005 and step 0.01\n",
             10.5 * pow(2.2 / 10.5, log(25) / log(100)));
    assert_has(printed, row);
    assert_has(printed, "\n   rk4       500   0    5.000      -  at most: error 2.0e-04 with rtol 1e-4\n");
}

TEST(only_a_sweep_of_these_keys_is_a_comparison) {
    static const char *const sweeps[] = {
        "",
        "sweep: [{key: solver.rtol, values: [1e-3, 1e-4, 1e-5]}]\n",
        "sweep: [{keys: [solver.method, solver.order, solver.rtol, solver.step], values: [" ROW_B ", " ROW_B "]}]\n",
        "sweep: [{keys: [solver.order, solver.method, solver.rtol, solver.step],\n"
        "    values: [[5, ida, 1e-9, 0], [5, ida, 1e-8, 0], [2, ida, 1e-3, 0]]}]\n",
        "sweep: [{keys: [solver.method, solver.order, solver.rtol, solver.step], values: [" ROW_B ", " ROW_B ", " ROW_B
        "]}, {key: \"fish[*].nodes\", values: [7]}]\n",
    };
    for (size_t i = 0; i < sizeof sweeps / sizeof *sweeps; i++) {
        char text[1024];
        snprintf(text, sizeof text, CASE "fish: [{}]\n%s", sweeps[i]);
        struct case_values study = parse(text);
        assert_false(compare_is(&study));
    }
    struct case_values study = parse(repeated);
    assert_true(compare_is(&study));
}
