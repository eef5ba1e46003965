/* test_error_plan.c: Tests the plan of an error study, and how it judges members whose values are given by formulas.
 * test_error.sh has real members. */
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/text.h"
#include "case/case_value.h"
#include "case_fixture.h"
#include "study/error_plan.h"
#include "study/study_file.h"
#include "study/study_print.h"

/* A fish without a cusp at the tail, and long waves: no key is flagged in advance. */
#define UNIFORM                                                           \
    "format: 1\nname: uniform\ntime: {end: 4, shedding_interval: 0.01}\n" \
    "solver: {rtol: 1e-5}\n"                                              \
    "fish: [{force: reactive, nodes: 25, sheet_points: 49,\n"             \
    "  body: {profile: uniform, thickness: 0.2, depth: 0.25, modulus: 1e8}}]\n"

/* The first point of the plan, which is the only one without a sweep. */
static struct error_study open_study(const char *text, const char *error) {
    char all[2048];
    struct error_sweep *sweep;
    snprintf(all, sizeof all, "%serror: %s\n", text, error);
    struct case_values values = parse(all);
    assert_int_equal(error_plan_create(test_arena(), &sweep, &values, NULL), STATUS_OK);
    case_free(&values);
    return sweep->point[0];
}

static const struct error_study_key *key_of(const struct error_study *study, const char *path) {
    for (int k = 0; k < study->n_keys; k++) {
        if (strcmp(study->key[k].row->path, path) == 0) return &study->key[k];
    }
    return NULL;
}

/* The value of a key of the first fish in a member, a duration without unit. */
static double setting(const struct error_study *study, int m, const char *path) {
    const struct sweep_axis *const axis = &study->study->sweep[0];
    double number = strcmp(path, "time.shedding_interval") == 0 ? study->values->school.shedding_interval
                    : strcmp(path, "fish.nodes") == 0           ? study->values->school.fish[0].nodes
                                                                : study->values->school.fish[0].sheet_points;
    for (int c = axis->n_keys - 1; c >= 0; c--) {
        if (strcmp(axis->key[c].row, path) == 0) number = strtod(axis->value[m * axis->n_keys + c], NULL);
    }
    return number;
}

static void levels_are(const struct error_study *study, const char *path, int n, const double *levels, double value) {
    const struct error_study_key *const key = key_of(study, path);
    assert_non_null(key);
    assert_int_equal(key->n_levels, n);
    NEAR_ARRAY(n, key->value, levels, 0, 1e-12);
    NEAR(key->value[key->stated], value, 0, 1e-12);
    for (int i = 0; i < n; i++) NEAR(setting(study, key->member[i], path), levels[i], 0, 1e-12);
}

// ---- the plan

TEST(the_keys_of_the_table_have_the_levels_of_the_table) {
    struct error_study study = open_study(UNIFORM, "{of: steady_speed}");
    levels_are(&study, "fish.nodes", 4, (double[]){49, 35, 25, 17}, 25);
    levels_are(&study, "fish.sheet_points", 4, (double[]){69, 49, 35, 25}, 49);
    levels_are(&study, "time.shedding_interval", 4, (double[]){0.005, 0.01, 0.02, 0.04}, 0.01);
    levels_are(&study, "solver.rtol", 3, (double[]){1e-6, 1e-5, 1e-4}, 1e-5);
    levels_are(&study, "wake.tolerance", 3, (double[]){1e-7, 1e-6, 1e-5}, 1e-6);
    levels_are(&study, "wake.lifetime", 4, (double[]){32, 16, 8, 4}, 8);
    assert_null(key_of(&study, "wake.smoothing"));
    assert_null(key_of(&study, "solver.step"));

    // each member changes one key and dependent keys; one sheet serves all nodes
    const struct error_study_key *const nodes = key_of(&study, "fish.nodes");
    for (int i = 0; i < 4; i++) NEAR(setting(&study, nodes->member[i], "fish.sheet_points"), 97, 0, 0);
    const int shorter = key_of(&study, "wake.lifetime")->member[3];
    NEAR(setting(&study, shorter, "wake.decay") / setting(&study, 0, "wake.decay"), 0.5, 0, 1e-12);
    NEAR(setting(&study, key_of(&study, "solver.rtol")->member[2], "wake.tolerance"), 1e-6, 0, 1e-12);

    // every member is a valid case, and the search starts from a neighbour; the case alone has multipliers
    const int n = sweep_n_members(study.study);
    assert_int_equal(n, 19);
    for (int m = 0; m < n; m++) {
        const struct case_values member = member_of(study.study, m);
        assert_int_equal(member.steady.multipliers, m == 0 ? YES : NO);
        assert_int_equal(member.n_axes, 0);
        assert_null(member.error);
        BELOW(sweep_member_before(study.study, m), m);
    }
    const struct error_study_key *const interval = key_of(&study, "time.shedding_interval");
    assert_int_equal(sweep_member_before(study.study, 0), -1);
    assert_int_equal(sweep_member_before(study.study, interval->member[2]), 0);
    assert_int_equal(sweep_member_before(study.study, interval->member[3]), interval->member[2]);

    // one member has the finest levels of all keys
    static const char *const paths[] = {"fish.nodes", "time.shedding_interval", "solver.rtol", "wake.tolerance"};
    assert_int_equal(study.finest, n - 1);
    for (int i = 0; i < 4; i++)
        NEAR(setting(&study, study.finest, paths[i]), key_of(&study, paths[i])->value[0], 0, 1e-12);
    NEAR(setting(&study, study.finest, "fish.sheet_points"), 97, 0, 0);  // that of the nodes is finer than 69
}

TEST(without_confirm_there_is_no_finer_level) {
    struct error_study study = open_study(UNIFORM, "{of: steady_speed, confirm: false}");
    levels_are(&study, "fish.nodes", 3, (double[]){25, 17, 13}, 25);
    levels_are(&study, "solver.rtol", 2, (double[]){1e-5, 1e-4}, 1e-5);
}

TEST(levels_that_are_no_valid_cases_are_replaced) {
    // with the pressure a sheet needs 2 nodes - 1 points
    struct error_study study = open_study(
        "format: 1\ntime: {end: 4}\nfish: [{nodes: 25, sheet_points: 49, force: pressure, pressure: {span: "
        "infinite}}]\n",
        "{of: steady_speed}");
    levels_are(&study, "fish.sheet_points", 4, (double[]){136, 97, 69, 49}, 49);
    levels_are(&study, "fish.nodes", 4, (double[]){49, 35, 25, 17}, 25);
    // the sheet of all nodes is a level of the sheet
    assert_int_equal(key_of(&study, "fish.nodes")->member[2], key_of(&study, "fish.sheet_points")->member[1]);
    // fewer points do not resolve the momentum of the nodes
    study = open_study("format: 1\ntime: {end: 4}\nfish: [{force: reactive, nodes: 25, sheet_points: 48}]\n",
                       "{of: steady_speed}");
    assert_non_null(strstr(key_of(&study, "fish.sheet_points")->objection, "fewer sheet_points than 2 nodes - 1"));
    // a table has a value for each edge
    study = open_study(
        "format: 1\ntime: {end: 4}\nfish: [{force: reactive, nodes: 5, sheet_points: 11, body: {profile: table, "
        "thickness_table: [0.1, "
        "0.1, 0.1, "
        "0.1],\n"
        "  depth_table: [0.2, 0.2, 0.2, 0.2]}}]\n",
        "{of: speed}");
    assert_int_equal(key_of(&study, "fish.nodes")->n_levels, 1);
    assert_non_null(
        strstr(key_of(&study, "fish.nodes")->objection,
               "no other level is a valid case: fish[0].body.thickness_table: 'profile: table' needs pairs"));
    // pairs hold for any number of nodes
    study = open_study(
        "format: 1\ntime: {end: 4}\nfish: [{force: reactive, nodes: 25, sheet_points: 49, body: {profile: table,\n"
        "  thickness_table: [[0, 0.02], [0.3, 0.1], [1, 0.02]], depth_table: [[0, 0.2], [1, 0.2]]}}]\n",
        "{of: speed}");
    levels_are(&study, "fish.nodes", 4, (double[]){49, 35, 25, 17}, 25);
}

TEST(an_interval_divides_the_beat_or_the_run) {
    static const char text[] =
        "format: 1\ntime: {end: 4, shedding_interval: 0.02, output_interval: 0.1, checkpoint_interval: 0.7}\n"
        "output: {wake_interval: 0.3}\nfish: [{}]\n";
    struct error_study study = open_study(text, "{of: steady_speed, keys: [shedding_interval]}");
    // 50 events in a beat; 12.5 would be few, and a finer level replaces them
    levels_are(&study, "time.shedding_interval", 4, (double[]){0.005, 0.01, 0.02, 0.04}, 0.02);
    // all times are multiples of it
    for (int m = 0; m < sweep_n_members(study.study); m++) {
        const struct case_values member = member_of(study.study, m);
        const double times[] = {member.time.end, member.time.output_interval, member.time.checkpoint_interval,
                                member.output.wake_interval};
        for (int i = 0; i < 4; i++) NEAR(remainder(times[i], member.school.shedding_interval), 0, 1e-12, 0);
    }
    // a search ends after whole beats, no earlier than the case
    study = open_study("format: 1\ntime: {end: 4.5, shedding_interval: 0.02, output_interval: 0.1}\nfish: [{}]\n",
                       "{of: steady_speed, keys: [shedding_interval]}");
    NEAR(setting(&study, key_of(&study, "time.shedding_interval")->member[3], "time.end"), 5, 0, 1e-12);
    study = open_study(text, "{of: speed, keys: [shedding_interval]}");
    levels_are(&study, "time.shedding_interval", 4, (double[]){0.005, 0.01, 0.02, 0.04}, 0.02);
    // fixed steps divide the interval
    study = open_study(
        "format: 1\ntime: {end: 1, shedding_interval: 0.02}\nsolver: {method: rk4, step: 0.005}\nfish: [{}]\n",
        "{of: speed}");
    levels_are(&study, "solver.step", 4, (double[]){0.0025, 0.005, 0.01, 0.02}, 0.005);
    assert_null(key_of(&study, "solver.rtol"));
    NEAR(setting(&study, key_of(&study, "time.shedding_interval")->member[2], "solver.step"), 0.005, 0, 1e-12);
    // and are none longer than that of the case: 0.01/0.003 = 3.3
    study = open_study(
        "format: 1\ntime: {end: 0.96, shedding_interval: 0.03}\nsolver: {method: rk4, step: 0.003}\n"
        "fish: [{}]\n",
        "{of: speed, keys: [shedding_interval]}");
    for (int m = 0; m < sweep_n_members(study.study); m++) {
        const struct case_values member = member_of(study.study, m);
        AT_MOST(member.solver.step, 0.003 * (1 + 1e-12));
        NEAR(remainder(member.school.shedding_interval, member.solver.step), 0, 1e-12, 0);
    }
}

TEST(the_interval_has_the_order_of_the_shedding) {
    static const char *const words[] = {"sheet", "impulsive", "continuous"};
    for (int i = 0; i < 3; i++) {
        struct case_values values = parse(arena_text(
            test_arena(), "format: 1\ntime: {end: 1}\nwake: {shedding: %s}\nfish: [{force: reactive}]\n", words[i]));
        NEAR(sweep_error_order(&values, sweep_error_find("time.shedding_interval")), i == 2 ? 2 : 1, 0, 0);
        NEAR(sweep_error_order(&values, sweep_error_find("fish.nodes")), 2, 0, 0);

        // a choice between words and an input have none
        assert_true(isnan(sweep_error_order(&values, sweep_error_find("fish.force"))));
        assert_true(isnan(sweep_error_order(&values, &sweep_inputs[0])));
        case_free(&values);
    }
}

TEST(a_duration_keeps_the_unit_of_the_case) {
    static const struct {
        const char *wake, *unit, *longest, *fade;
        double level[4];
    } examples[] = {
        {"", " beats", "32 beats", "8 beats", {32, 16, 8, 4}},
        {"wake: {lifetime: 4 beats, decay: 1}\n", " beats", "16 beats", "4", {16, 8, 4, 2}},
        {"wake: {lifetime: 1.5, decay: 1 beat}\n", "", "6", "4 beats", {6, 3, 1.5, 0.75}},
    };
    for (size_t i = 0; i < sizeof examples / sizeof *examples; i++) {
        char text[256];
        snprintf(text, sizeof text, "format: 1\ntime: {end: 20}\n%sfish: [{wave: {frequency: 2}}]\n", examples[i].wake);
        struct error_study study = open_study(text, "{of: steady_speed, keys: [lifetime]}");
        const struct error_study_key *const key = key_of(&study, "wake.lifetime");
        levels_are(&study, "wake.lifetime", 4, examples[i].level, examples[i].level[2]);
        assert_string_equal(key->unit, examples[i].unit);
        const struct sweep_axis *const axis = &study.study->sweep[0];
        char **const row = axis->value + key->member[0] * axis->n_keys;
        assert_string_equal(row[error_plan_column(&study, "wake.lifetime", 0)], examples[i].longest);
        assert_string_equal(row[error_plan_column(&study, "wake.decay", 0)], examples[i].fade);
        const struct case_values member = member_of(study.study, key->member[0]);
        NEAR(member.school.wake.lifetime, i == 0 ? 16 : i == 1 ? 8 : 6, 0, 1e-12);
    }
    // a run with an earlier end keeps the whole wake
    struct error_study study =
        open_study("format: 1\ntime: {end: 1}\nfish: [{}]\n", "{of: speed, keys: [lifetime, rtol]}");
    assert_null(key_of(&study, "wake.lifetime"));
}

TEST(levels_can_be_given) {
    struct error_study study =
        open_study(UNIFORM, "{of: steady_speed, keys: {nodes: [17, 33, 65], \"fish[*].sheet_points\": default}}");
    assert_int_equal(study.n_keys, 2);
    levels_are(&study, "fish.nodes", 4, (double[]){65, 33, 25, 17}, 25);
}

TEST(fish_of_different_resolution_change_in_proportion) {
    struct error_study study = open_study(
        "format: 1\ntime: {end: 4}\nfish: [{nodes: 13, sheet_points: 33}, {nodes: 25, sheet_points: 49, start: "
        "{position: [3, 0]}}]\n",
        "{of: steady_speed}");
    const struct sweep_axis *const axis = &study.study->sweep[0];
    const struct error_study_key *const nodes = key_of(&study, "fish.nodes");
    int c = 0;
    while (strcmp(axis->key[c].path, "fish[1].nodes") != 0) c++;
    NEAR(nodes->value[3], 9, 0, 0);
    assert_string_equal(axis->value[nodes->member[3] * axis->n_keys + c], "17");
    assert_string_equal(axis->value[nodes->member[3] * axis->n_keys + c - 1], "9");
}

#define FOIL                                                                                                          \
    "fluid: {velocity: [1, 0]}\nfish: [{nodes: 9, force: pressure, pressure: {span: infinite}, wave: {amplitude: 0, " \
    "frequency: 0}, motion: {prescribed: head, speed: 0}, body: {relaxation_time: 0.01}}]\n"

TEST(an_equilibrium_has_points_only) {
    struct error_study study = open_study("format: 1\ntime: {end: 4}\n" FOIL, "{of: steady_lift}");
    assert_true(study.is_static);
    assert_int_equal(study.n_keys, 2);
    // the modes shed wakes, and are computed for every member
    study = open_study("format: 1\ntime: {end: 4, shedding_interval: 0.02}\n" FOIL, "{of: steady_growth}");
    assert_int_equal(study.n_keys, 3);
    levels_are(&study, "time.shedding_interval", 4, (double[]){0.01, 0.02, 0.04, 0.08}, 0.02);
    for (int m = 0; m < sweep_n_members(study.study); m++) {
        const struct case_values member = member_of(study.study, m);
        assert_int_equal(member.steady.multipliers, YES);
        NEAR(member.time.end, 4, 0, 1e-12);
    }
}

TEST(only_keys_that_change_the_case_are_varied) {
    static const struct {
        const char *settings, *of, *key;
        bool is_varied;
    } examples[] = {
        {"fish: [{body: {relaxation_time: 0.01}}]\n", "speed", "fish.body.relaxation_time", true},
        {"fish: [{body: {relaxation_time: 0}}]\n", "speed", "fish.body.relaxation_time", false},
        {FOIL, "steady_lift", "fish.body.relaxation_time", false},
        {FOIL, "steady_lift", "fish.pressure.suction_limit", true},
        {"fish: [{force: reactive}]\n", "speed", "fish.pressure.span", false},
        {"fish: [{drag: {skin: boundary_layer, waving: 1.5}}]\n", "speed", "fish.drag.waving", true},
        {"fish: [{drag: {skin: boundary_layer, waving: 1}}]\n", "speed", "fish.drag.waving", false},
        {"fish: [{drag: {skin: quadratic}}]\n", "speed", "fish.drag.transition", false},
        {"solver: {method: rk4, step: 1e-3}\nfish: [{}]\n", "speed", "solver.step", true},
        {"solver: {method: rk4, step: 1e-3}\nfish: [{}]\n", "speed", "solver.rtol", false},
        {"wake: {tolerance: 0}\nfish: [{}]\n", "speed", "wake.tolerance", false},
        {"wake: {lifetime: 7.9}\nfish: [{}]\n", "speed", "wake.lifetime", true},
        {"wake: {lifetime: 8}\nfish: [{}]\n", "speed", "wake.lifetime", false},  // half of it is the run
        {"wake: {lifetime: 8}\nfish: [{}]\n", "steady_speed", "wake.lifetime", true},
        {"fluid: {density: 0}\nfish: [{}]\n", "speed", "fish.sheet_points", false},
        {"fluid: {density: 0}\nfish: [{}]\n", "speed", "solver.rtol", true},
    };
    for (size_t i = 0; i < sizeof examples / sizeof *examples; i++) {
        char text[512], error[96];
        snprintf(text, sizeof text, "format: 1\ntime: {end: 4}\n%s", examples[i].settings);
        snprintf(error, sizeof error, "{of: %s, models: true}", examples[i].of);
        const struct error_study study = open_study(text, error);
        if ((key_of(&study, examples[i].key) != NULL) != examples[i].is_varied) fail_msg("example %zu", i);
    }
}

TEST(quantities_that_are_not_known_are_refused) {
    static const struct {
        const char *error, *message;
    } examples[] = {
        {"{of: lift}", "'lift' is no number of a result"},
        {"{of: nose}", "'nose' is no number of a result"},
        {"{of: [speed, steady_speed]}", "speed is of a run and steady_speed of a steady state"},
        {"{of: [speed, speed]}", "speed is there twice"},
        {"{of: steady_speed, keys: [step, transition]}", "none of these keys changes anything"},
        {"{of: steady_speed, keys: {nodes: [2, 9]}}", "level 2"},
    };
    for (size_t i = 0; i < sizeof examples / sizeof *examples; i++) {
        char text[512];
        struct error_sweep *sweep;
        snprintf(text, sizeof text, UNIFORM "error: %s\n", examples[i].error);
        const struct case_values values = parse(text);
        assert_int_equal(error_plan_create(test_arena(), &sweep, &values, NULL), STATUS_CASE);
        if (!strstr(status_message(), examples[i].message)) fail_msg("%s", status_message());
    }
}

/* Five moduli: the ends and the middle vary all keys, the two others the nodes and the interval. */
static const char moduli[] = UNIFORM "sweep: [{key: \"fish[*].body.modulus\", values: [1e7, 3e7, 1e8, 3e8, 1e9]}]\n";

TEST(a_sweep_has_a_plan_at_every_point) {
    const struct error_study first = open_study(moduli, "{of: steady_speed, keys: [nodes, sheet_points, rtol]}");
    const struct error_sweep *const sweep = first.sweep;
    assert_int_equal(sweep->n_points, 5);
    assert_int_equal(sweep->n_swept, 1);
    for (int p = 0; p < 5; p++) {
        const struct error_study *const point = &sweep->point[p];
        assert_int_equal(point->is_full, p % 2 == 0);
        assert_int_equal(point->n_keys, p % 2 == 0 ? 3 : 1);
        assert_int_equal(point->base, p);
        assert_int_equal(sweep_member_before(point->study, p), p - 1);
        for (int k = 0; k < point->n_keys; k++) {
            for (int i = 0; i < point->key[k].n_levels; i++) {
                const struct case_values member = member_of(point->study, point->key[k].member[i]);
                NEAR(member.school.fish[0].body.modulus, point->values->school.fish[0].body.modulus, 0, 0);
                assert_int_equal(member.n_axes, 0);
                assert_null(member.error);
            }
        }
    }
}

TEST(a_key_of_the_sweep_is_not_varied) {
    const struct error_study first = open_study(UNIFORM "sweep: [{key: \"fish[*].nodes\", values: [13, 17]}]\n",
                                                "{of: steady_speed, keys: [nodes, rtol]}");
    assert_int_equal(first.sweep->n_points, 2);
    assert_int_equal(first.n_keys, 1);
    assert_string_equal(first.key[0].row->path, "solver.rtol");
}

/* The number of members whose time a plan estimates itself; in `like` the members whose estimates serve. */
static int choose_estimated(const struct error_study *study, int *like) {
    const int n = error_plan_choose_estimated(study->sweep, like);
    int n_own = 0;
    for (int m = 0; m < sweep_n_members(study->study); m++) {
        n_own += like[m] == m;
        assert_int_equal(like[like[m]], like[m]);
    }
    assert_int_equal(n_own, n);
    return n;
}

TEST(a_plan_estimates_points_that_cost_the_same_once) {
    int like[128];
    const struct error_study stiffness = open_study(moduli, "{of: steady_speed, keys: [nodes, shedding_interval]}");
    BELOW(sweep_n_members(stiffness.study), 128);
    // a point has 8 members: the case, 4 numbers of nodes with one sheet, 3 more intervals. A full point also has
    // the finest nodes at the finest interval. Points 1 and 3 do not vary all keys. They need an estimate only for
    // the case of point 1: it starts from a neighbour, unlike that of point 0
    assert_int_equal(choose_estimated(&stiffness, like), 3 * 9 + 1);
    assert_int_equal(like[3], 2);
    const struct error_study runs = open_study(moduli, "{of: speed, keys: [nodes, shedding_interval]}");
    assert_int_equal(error_plan_choose_estimated(runs.sweep, like), 3 * 9);
    assert_int_equal(choose_estimated(&stiffness, like), 3 * 9 + 1);
    const struct error_study_key *const first = key_of(&stiffness.sweep->point[0], "fish.nodes"),
                                        *const second = key_of(&stiffness.sweep->point[1], "fish.nodes");
    for (int i = 0; i < 4; i++) assert_int_equal(like[second->member[i]], like[first->member[i]]);

    // points of other resolution or frequency have times of their own
    const char *const axes[] = {"fish[*].sheet_points\", values: [49, 65, 97, 129, 161]",
                                "fish[*].wave.frequency\", values: [1, 1.1, 1.25, 1.6, 2]"};
    for (int a = 0; a < 2; a++) {
        char text[1024];
        snprintf(text, sizeof text, UNIFORM "sweep: [{key: \"%s}]\n", axes[a]);
        const struct error_study other = open_study(text, "{of: steady_speed, keys: [shedding_interval]}");
        BELOW(sweep_n_members(other.study), 128);
        assert_int_equal(choose_estimated(&other, like), 5 * 4);
    }
}

// ---- values of members

/* The values of members: speed and cost with errors of second order in the nodes, of first order in the sheet and in
 * the interval; an integrator without errors. */
static const double speed = 1.5, cost = 0.08, nodes_error = 0.9, sheet_error = 0.02, interval_error = 0.4;

static void set_value(struct member_file *member, const char *name, double value) {
    for (int f = 0; f < member->n_fish; f++) {
        *member_file_place(member, member_file_quantity_number(name), f, 0) = value;
    }
}

static struct member_file *make_members(const struct error_study *study) {
    const int n = sweep_n_members(study->study);
    struct member_file *members;
    NEW(study->sweep->arena, members, n);
    for (int m = 0; m < n; m++) {
        member_file_create_values(study->sweep->arena, &members[m], study->n_fish);
        members[m].status = "complete";
        const double nodes = setting(study, m, "fish.nodes"), sheet = setting(study, m, "fish.sheet_points"),
                     interval = setting(study, m, "time.shedding_interval");
        const double error = nodes_error / pow(nodes - 1, 2) + sheet_error / (sheet - 1) + interval_error * interval;
        set_value(&members[m], "steady_speed", speed + error);
        set_value(&members[m], "speed", speed + error);
        set_value(&members[m], "steady_cost_of_transport", cost * (1 + 2 * error));
        set_value(&members[m], "steady_residual", 2e-8);
        set_value(&members[m], "steady_error", m == 0 ? 1e-7 : NAN);
        set_value(&members[m], "beat_time", 1e-3 * nodes * nodes / interval);
    }
    return members;
}

TEST(the_error_is_the_sum_over_the_keys_and_covers_the_true_one) {
    struct error_study study = open_study(UNIFORM, "{of: [steady_speed, steady_cost_of_transport]}");
    struct member_file *const members = make_members(&study);
    convergence_study_judge(&study, members);
    assert_true(study.is_reached);
    // with Roache's factor of 1.25 on the finest level, which is known for each key
    const double of_nodes = nodes_error * (0.25 / (48.0 * 48) + 1 / (24.0 * 24));
    const double of_sheet = sheet_error * (1.25 / 68 + 1.0 / 48 - 1.0 / 68);
    const double of_interval = interval_error * (1.25 * 0.005 + 0.005);
    NEAR(key_of(&study, "fish.nodes")->part[0].error, of_nodes, 0, 1e-6);
    NEAR(key_of(&study, "fish.nodes")->part[0].order, 2, 1e-6, 0);
    NEAR(key_of(&study, "fish.sheet_points")->part[0].error, of_sheet, 0, 1e-6);
    NEAR(key_of(&study, "time.shedding_interval")->part[0].error, of_interval, 0, 1e-6);
    assert_int_equal(key_of(&study, "solver.rtol")->part[0].verdict, CONVERGENCE_NONE);
    // the shifts have one sign; the finest levels together have the sheet of the nodes, 97 points instead of 69. The
    // spreads are independent, and the value has its noise
    const double spread = sqrt(pow(0.25 * nodes_error / (48.0 * 48), 2) + pow(0.25 * sheet_error / 68, 2) +
                               pow(0.25 * interval_error * 0.005, 2));
    const double shift =
        nodes_error / (24.0 * 24) + sheet_error * (1.0 / 48 + 1.0 / 68 - 1.0 / 96) + interval_error * 0.01;
    NEAR(study.shift[0], -shift, 0, 1e-6);
    NEAR(study.of_noise[0], study.noise * study.value[0], 0, 1e-9);
    NEAR(study.error[0], shift + spread + study.of_noise[0], 0, 1e-6);
    NEAR(study.error[1], 2 * cost * (shift + spread) + study.of_noise[1], 0, 1e-6);
    ABOVE(study.error[0], study.value[0] - speed);
    NEAR(study.value[0], setting(&study, 0, "fish.nodes") > 0 ? members[0].value[2 * study.quantity[0]] : 0, 0, 0);
    // the distance of every search is 5 times the residual
    NEAR(study.noise, 1e-5 + 1e-7, 0, 1e-9);

    const struct error_study_next next = convergence_study_next(&study, members);
    assert_string_equal(study.key[next.key].row->path, "time.shedding_interval");
    assert_true(next.is_member);
    NEAR(next.value, 0.005, 0, 1e-12);
    NEAR(next.cost, 2, 0, 1e-3);  // but for the millisecond that every beat counts
    NEAR(next.part, 1.25 * interval_error * 0.005 * 2 * cost / study.value[1], 0, 1e-6);
}

/* The error of the sheet is largest at the middle of the sweep, where it is 3 % of the value. */
TEST(errors_of_other_keys_are_shared_along_a_sweep) {
    struct error_study first = open_study(moduli, "{of: steady_speed, keys: [nodes, sheet_points, shedding_interval]}");
    struct error_sweep *const sweep = first.sweep;
    struct member_file *const members = make_members(&first);
    const struct error_study_key *const sheet = key_of(&sweep->point[2], "fish.sheet_points");
    convergence_sweep_judge(sweep, members);
    const double value = sweep->point[2].value[0], before = sheet->part[0].error;
    ABOVE(before, 0);
    NEAR(sweep->point[1].shared[0], before / value * sweep->point[1].value[0], 0, 1e-9);
    // which have no member with all finest levels
    assert_int_equal(sweep->point[1].finest, -1);
    ABOVE(sweep->point[2].finest, 0);
    NEAR(sweep->point[1].error[0],
         nodes_error / (24.0 * 24) + interval_error * 0.01 +
             hypot(0.25 * nodes_error / (48.0 * 48), 0.25 * interval_error * 0.005) + sweep->point[1].of_noise[0] +
             sweep->point[1].shared[0],
         0, 1e-6);

    // the next coarser level is off: the levels turn, and the error is the largest difference
    set_value(&members[sheet->member[2]], "steady_speed", 1.03 * value);
    convergence_sweep_judge(sweep, members);
    NEAR(sheet->part[0].error, 0.03 * value, 0, 1e-9);
    for (int p = 1; p < 5; p += 2) NEAR(sweep->point[p].shared[0], 0.03 * sweep->point[p].value[0], 0, 1e-9);
    NEAR(sweep->point[0].shared[0], 0, 0, 0);

    // an unknown error at a full point is unknown at the points that share it
    members[sheet->member[3]].status = "failed: a test";
    convergence_sweep_judge(sweep, members);
    assert_true(isnan(sweep->point[1].error[0]));
    ABOVE(sweep->point[0].error[0], 0);
}

/* Five tolerances, the stated one the coarsest: four of them are judged. */
TEST(a_stated_level_beyond_the_judged_ones_has_its_own_value) {
    struct error_study study = open_study(UNIFORM, "{of: speed, keys: {rtol: [1e-5, 1e-6, 1e-7, 1e-8, 1e-9]}}");
    struct member_file *const members = make_members(&study);
    const struct error_study_key *const key = key_of(&study, "solver.rtol");
    assert_int_equal(key->n_levels, 5);
    assert_int_equal(key->stated, 4);
    for (int i = 0; i < 5; i++) set_value(&members[key->member[i]], "speed", speed + 40 * key->value[i]);
    convergence_study_judge(&study, members);
    assert_int_equal(key->part[0].verdict, CONVERGENCE_ACCEPTED);
    NEAR(study.value[0], speed + 40e-5, 1e-12, 0);
    NEAR(study.error[0], 40 * (1e-5 - 1e-9) + 1.25 * 40 * 1e-9 + 1e-5 * study.value[0], 1e-10, 0);
}

/* The report of a judged study, until the end of the test. */
static const char *report_of(struct error_study *study, const struct member_file *members) {
    char *text;
    size_t size;
    FILE *const stream = open_memstream(&text, &size);
    assert_int_equal(study_print_errors(study, members, stream), STATUS_OK);
    fclose(stream);
    arena_defer(test_arena(), free, text);
    return text;
}

/* The beginning of error.csv. */
static void read_csv(const struct error_study *study, size_t n, char *csv) {
    char path[] = "/tmp/test_error_XXXXXX";
    close(mkstemp(path));
    unlink(path);
    assert_int_equal(study_print_csv(study->sweep, path), STATUS_OK);
    FILE *const file = fopen(path, "r");
    csv[fread(csv, 1, n - 1, file)] = '\0';
    fclose(file);
    unlink(path);
}

static void contains(const char *text, const char *part) {
    if (!strstr(text, part)) fail_msg("no \"%s\" in\n%s", part, text);
}

/* Two keys with errors a and b that act together, by a b: each alone does not show it. */
TEST(what_two_keys_do_together_is_a_part_of_the_error) {
    struct error_study study = open_study(UNIFORM, "{of: steady_speed, keys: [sheet_points, shedding_interval]}");
    struct member_file *const members = make_members(&study);
    const double apart = 0.2 / 48 + 0.01, finest = 0.2 / 68 + 0.005, both = 400 * 0.2 / 48 * 0.01;
    for (int m = 0; m < sweep_n_members(study.study); m++) {
        const double a = 0.2 / (setting(&study, m, "fish.sheet_points") - 1),
                     b = setting(&study, m, "time.shedding_interval");
        set_value(&members[m], "steady_speed", speed + a + b - 400 * a * b);
    }
    convergence_study_judge(&study, members);
    NEAR(study.value[0], speed + apart - both, 0, 1e-12);

    // the finest levels lead to their values together, and from there each key to its own limit
    const struct convergence_result *const sheet = key_of(&study, "fish.sheet_points")->part,
                                           *const interval = key_of(&study, "time.shedding_interval")->part;
    const double of_sheet = 0.2 / 68 * (1 - 400 * 0.01), of_interval = 0.005 * (1 - 400 * 0.2 / 48);
    NEAR(study.value[0] + study.shift[0], speed + finest - 400 * 0.2 / 68 * 0.005 - of_sheet - of_interval, 0, 1e-9);
    NEAR(study.error[0], fabs(study.shift[0]) + hypot(sheet->spread, interval->spread) + study.of_noise[0], 0, 1e-9);
    NEAR(study.together[0], fabs(study.shift[0]) - fabs(sheet->shift + interval->shift), 1e-12, 0);
    AT_LEAST(study.error[0], fabs(study.value[0] - speed));
    contains(report_of(&study, members), "\ntogether ");

    // it is unknown without that run
    members[study.finest].status = "failed: a test";
    convergence_study_judge(&study, members);
    assert_true(isnan(study.error[0]));
}

/* The cost turns at 25 nodes, the differences of the speed fall. */
TEST(a_flag_belongs_to_one_quantity_and_names_its_levels) {
    struct error_study study = open_study(UNIFORM, "{of: [steady_speed, steady_cost_of_transport], keys: [nodes]}");
    struct member_file *const members = make_members(&study);
    const struct error_study_key *const key = key_of(&study, "fish.nodes");
    set_value(&members[key->member[2]], "steady_cost_of_transport", 0.09);
    convergence_study_judge(&study, members);
    assert_int_equal(key->part[0].verdict, CONVERGENCE_ACCEPTED);
    assert_int_equal(key->part[1].verdict, CONVERGENCE_TURNS);
    NEAR(key->part[0].error, nodes_error * (0.25 / (48.0 * 48) + 1 / (24.0 * 24)), 0, 1e-6);

    const char *const text = report_of(&study, members);
    contains(text, "fish.nodes  17 [25] 35 49   0.0017    2.0  0.11");
    contains(text, "flagged: fish.nodes: cost_of_transport of fish1: differences change sign at 25\n");
    assert_null(strstr(text, "speed of fish1: differences"));

    // the largest error is of the cost
    contains(text, "<- spend here: nodes 69, CPU x 7.4, to find an order of cost_of_transport\n");
}

/* The values differ by 2e-5, which is below the tolerance of the integrator. */
TEST(an_equilibrium_has_no_error_of_the_integrator) {
    struct error_study study =
        open_study("format: 1\ntime: {end: 4}\nsolver: {rtol: 3e-5}\n" FOIL, "{of: steady_lift, keys: [nodes]}");
    assert_true(study.is_static);
    struct member_file *const members = make_members(&study);
    const struct error_study_key *const key = key_of(&study, "fish.nodes");
    for (int i = 0; i < key->n_levels; i++) {
        set_value(&members[key->member[i]], "steady_lift", 1 + 1e-3 / pow(key->value[i] - 1, 2));
        set_value(&members[key->member[i]], "steady_residual", 1e-12);
        set_value(&members[key->member[i]], "steady_error", 1e-12);
    }
    convergence_study_judge(&study, members);
    assert_int_equal(key->part[0].verdict, CONVERGENCE_ACCEPTED);
    NEAR(key->part[0].order, 2, 1e-6, 0);
    // where the search itself is worse than the differences, they are noise
    for (int i = 0; i < key->n_levels; i++) set_value(&members[key->member[i]], "steady_error", 1e-3);
    convergence_study_judge(&study, members);
    assert_int_equal(key->part[0].verdict, CONVERGENCE_NONE);
}

/* A finer level cannot take less time: times of short runs are noisy. */
TEST(a_finer_level_is_never_cheaper) {
    struct error_study study = open_study(UNIFORM, "{of: steady_speed, keys: [shedding_interval]}");
    struct member_file *const members = make_members(&study);
    const struct error_study_key *const key = key_of(&study, "time.shedding_interval");
    set_value(&members[key->member[0]], "beat_time",
              0.5 * members[0].value[2 * member_file_quantity_number("beat_time")]);
    convergence_study_judge(&study, members);
    const struct error_study_next next = convergence_study_next(&study, members);
    NEAR(next.cost, 1, 0, 0);
    const char *const text = report_of(&study, members);
    contains(text, "<- spend here: shedding_interval 0.005, speed +-");
    assert_null(strstr(text, "CPU x"));
}

/* The members of a run count a tenth of a second each, below which times are noise. */
TEST(the_cost_of_a_finer_level_is_the_ratio_of_the_times) {
    struct error_study study = open_study(UNIFORM, "{of: speed, keys: [shedding_interval]}");
    struct member_file *const members = make_members(&study);
    const struct error_study_key *const key = key_of(&study, "time.shedding_interval");
    const double times[][3] = {{20, 60, 60.1 / 20.1}, {1e-4, 3e-4, 1.002}};
    assert_int_equal(key->stated, 1);
    for (int i = 0; i < 2; i++) {
        set_value(&members[key->member[1]], "wall_time", times[i][0]);
        set_value(&members[key->member[0]], "wall_time", times[i][1]);
        convergence_study_judge(&study, members);
        const struct error_study_next next = convergence_study_next(&study, members);
        assert_true(next.is_member);
        NEAR(next.cost, times[i][2], 0, 1e-5);
    }
}

/* Follow a study to the end, as a run does; and again, with the members at that time. */
static struct member_file *follow(struct error_study *study, int *n_rounds) {
    struct member_file *members = NULL;
    int n_new = 1;
    *n_rounds = 0;
    while (n_new > 0) {
        members = make_members(study);
        convergence_study_judge(study, members);
        const int n_before = sweep_n_members(study->study);
        n_new = convergence_study_refine(study, members, INT_MAX);
        assert_int_equal(n_new, sweep_n_members(study->study) - n_before);
        ++*n_rounds;
        assert_in_range(*n_rounds, 1, 30);
    }
    return members;
}

TEST(refinement_ends_where_the_error_is_within_the_bound) {
    static const char error[] = "{of: steady_speed, within: 2e-3, most: 1e4}";
    struct error_study study = open_study(UNIFORM, error), again = open_study(UNIFORM, error);
    const int n_planned = sweep_n_members(study.study);
    int n_rounds, n_new = 1;
    struct member_file *const members = follow(&study, &n_rounds);
    const int n = sweep_n_members(study.study);
    assert_true(study.is_reached);
    ABOVE(n, n_planned);
    ABOVE(n_rounds, 1);
    AT_MOST(study.error[0], 2e-3 * study.value[0]);
    AT_LEAST(study.error[0], study.value[0] - speed);
    // the stated value has all refined keys together; the errors add up here except that the levels of the nodes have a
    // sheet of 97 points
    BELOW(setting(&study, study.stated, "time.shedding_interval"), 0.01);
    NEAR(study.together[0], 0, sheet_error * (1.0 / 48 - 1.0 / 96) * (1 + 1e-6), 0);
    ABOVE(study.cost, 1);

    // the same members lead to the same study
    while (n_new > 0) {
        convergence_study_judge(&again, members);
        n_new = convergence_study_refine(&again, members, n);
    }
    assert_int_equal(sweep_n_members(again.study), n);
    assert_int_equal(again.stated, study.stated);
    NEAR(again.error[0], study.error[0], 0, 0);
}

TEST(without_the_members_of_a_step_it_is_not_taken) {
    struct error_study study = open_study(UNIFORM, "{of: steady_speed, within: 2e-3}");
    struct member_file *const members = make_members(&study);
    const int n = sweep_n_members(study.study);
    int n_new = 1;
    while (n_new > 0) {
        convergence_study_judge(&study, members);
        n_new = convergence_study_refine(&study, members, n);
    }
    assert_int_equal(sweep_n_members(study.study), n);
    assert_false(study.is_reached);
    // the levels that are known are taken: half of the interval
    NEAR(key_of(&study, "time.shedding_interval")->value[key_of(&study, "time.shedding_interval")->stated], 0.005, 0,
         1e-12);
}

TEST(a_bound_out_of_reach_adds_three_levels_to_a_key) {
    struct error_study study = open_study(UNIFORM, "{of: steady_speed, keys: [shedding_interval], within: 1e-9}");
    const int n_planned = study.key[0].n_levels;
    int n_rounds;
    study.study->error->most = 1e12;
    follow(&study, &n_rounds);
    assert_false(study.is_reached);
    assert_int_equal(study.key[0].n_levels, n_planned + 3);
}

TEST(what_is_too_dear_is_not_run_and_its_cost_is_said) {
    struct error_study study = open_study(UNIFORM, "{of: steady_speed, within: 2e-4, most: 3}");
    int n_rounds;
    follow(&study, &n_rounds);
    char words[CONVERGENCE_BYTES];
    assert_false(study.is_reached);
    AT_MOST(study.cost, 3);
    convergence_study_say_cost(&study, words);
    assert_non_null(strstr(words, "time.shedding_interval"));
    assert_non_null(strstr(words, "times the CPU time"));

    // one key of first order: the interval is divided by 1.1 until its error is within the bound
    study = open_study(UNIFORM, "{of: steady_speed, keys: [shedding_interval], within: 1e-4, most: 3}");
    follow(&study, &n_rounds);
    const struct error_study_key *const key = study.key;
    char want[CONVERGENCE_BYTES];
    const double ratio = pow(1.1, ceil(log(key->part[0].error / study.value[0] / 1e-4) / log(1.1)));
    snprintf(want, sizeof want, "time.shedding_interval %.3g: about %.2g times the CPU time",
             key->value[key->stated] / ratio, pow(ratio, key->cost_exponent));
    convergence_study_say_cost(&study, words);
    assert_string_equal(words, want);
}

TEST(a_member_that_failed_leaves_the_error_unknown) {
    struct error_study study = open_study(UNIFORM, "{of: steady_speed, within: 0.5}");
    struct member_file *const members = make_members(&study);
    int n_new;
    members[key_of(&study, "fish.nodes")->member[3]].status = "no match";
    convergence_study_judge(&study, members);
    assert_int_equal(key_of(&study, "fish.nodes")->part[0].verdict, CONVERGENCE_UNKNOWN);
    assert_true(isnan(study.error[0]) && !study.is_reached);
    n_new = convergence_study_refine(&study, members, INT_MAX);
    assert_int_equal(n_new, 0);
}

TEST(a_cusp_an_edge_and_a_sheet_are_objected_to) {
    struct error_study study = open_study(
        "format: 1\ntime: {end: 4}\nfish: [{force: reactive, sheet_points: 21, body: {tail_thickness: 0}}]\n",
        "{of: speed}");
    assert_non_null(strstr(key_of(&study, "fish.nodes")->objection, "cusp"));
    assert_non_null(strstr(key_of(&study, "fish.sheet_points")->objection, "2 nodes - 1"));
    study = open_study(
        "format: 1\ntime: {end: 4, shedding_interval: 1e-3}\n"
        "fish: [{force: reactive, nodes: 25, sheet_points: 49, body: {profile: uniform, modulus: 5e2}}]\n",
        "{of: steady_speed}");
    assert_non_null(strstr(key_of(&study, "fish.nodes")->objection, "longer than its tail bends over"));
    // 49 points are too few for steps of 1.5e-3 lengths
    struct member_file *const members = make_members(&study);
    convergence_study_judge(&study, members);
    assert_int_equal(key_of(&study, "time.shedding_interval")->part[0].verdict, CONVERGENCE_OBJECTION);
    assert_non_null(strstr(key_of(&study, "time.shedding_interval")->objection, "needs 84 sheet_points"));
}

// the report of a study whose shedding interval has this share of the error and a reason for a flag
static bool is_flagged_with_share(double share) {
    struct error_study study =
        open_study(UNIFORM, "{of: steady_speed, keys: {nodes: [13, 17], shedding_interval: [0.01, 0.02]}}");
    struct member_file *const members = make_members(&study);
    convergence_study_judge(&study, members);
    ABOVE(study.error[0], 0);
    for (int k = 0; k < study.n_keys; k++) {
        if (strcmp(study.key[k].row->path, "time.shedding_interval") != 0) continue;
        study.key[k].part[0].verdict = CONVERGENCE_OBJECTION;
        snprintf(study.key[k].objection, sizeof study.key[k].objection, "too long");
        study.key[k].part[0].error = share * study.error[0];
    }
    return strstr(report_of(&study, members), "flagged: time.shedding_interval: too long\n") != NULL;
}

TEST(a_flag_is_explained_from_a_hundredth_of_the_error_on) {
    assert_true(is_flagged_with_share(0.02));
    assert_false(is_flagged_with_share(0.005));
    assert_true(is_flagged_with_share(NAN));
}

TEST(choices_of_the_model_are_not_in_the_sum) {
    struct error_study study = open_study(UNIFORM, "{of: steady_speed, keys: [rtol, smoothing]}");
    struct member_file *const members = make_members(&study);
    set_value(&members[key_of(&study, "wake.smoothing")->member[0]], "steady_speed", 2.5);
    convergence_study_judge(&study, members);
    NEAR(key_of(&study, "wake.smoothing")->part[0].error, 2.5 - study.value[0], 0, 1e-12);
    NEAR(study.error[0], study.noise * study.value[0], 1e-12, 0);
    contains(report_of(&study, members), "choices, not in the sum: wake.smoothing ([0.1] 0.05) ");
}

/* The members of a comparison: the errors of the other case are 0.9 times those of the case. */
static const double share = 0.9;

static struct member_file *make_twins(const struct error_study *study) {
    struct member_file *const members = make_members(study);
    const struct sweep_axis *const axis = &study->study->sweep[0];
    for (int m = 0; m < sweep_n_members(study->study); m++) {
        const double own = *member_file_place(&members[m], member_file_quantity_number("speed"), 0, 0);
        if (axis->is_against[m]) set_value(&members[m], "speed", 0.5 * (speed + share * (own - speed)));
    }
    return members;
}

#define OTHER "against: {format: 1, name: other, time: {end: 4, shedding_interval: 0.01}, solver: {rtol: 1e-5}, "

TEST(errors_that_both_cases_share_cancel_in_their_ratio) {
    struct error_study study = open_study(
        UNIFORM,
        "{of: speed, keys: [nodes, sheet_points, shedding_interval], " OTHER
        "fish: [{force: reactive, nodes: 49, sheet_points: 97, body: {profile: uniform, thickness: 0.2, depth: "
        "0.25, modulus: 1e8}}]}}");
    struct error_sweep *const sweep = study.sweep;
    const struct error_study *const ratio = &sweep->ratio->point[0], *const change = &sweep->change->point[0];
    assert_int_equal(sweep->n_points, 1);
    assert_string_equal(error_plan_twin_name(ratio, 0), "other");

    // every level has a twin with the same part of the value of the other case: 49/25 times the nodes
    for (int k = 0; k < ratio->n_keys; k++) {
        const struct error_study_key *const key = &ratio->key[k];
        assert_int_equal(key->n_levels, 4);
        for (int i = 0; i < 4; i++) {
            const struct case_values own = member_of(study.study, key->member[i]),
                                     other = member_of(study.study, key->twin[i]);
            NEAR(other.school.fish[0].nodes, round(49 / 25.0 * own.school.fish[0].nodes), 0, 0);
            NEAR(other.school.shedding_interval, own.school.shedding_interval, 0, 1e-12);
            assert_string_equal(other.name, "other");
            assert_string_equal(own.name, "uniform");
        }
    }
    assert_int_equal(sweep_member_before(study.study, sweep->against->base), -1);

    // the bar of the ratio is near the sum of the parts of the errors that differ, and covers the true error
    struct member_file *const members = make_twins(&study);
    convergence_sweep_judge(sweep, members);
    const struct error_study *const point = &sweep->point[0];
    const double true_error = fabs(ratio->value[0] - 2),
                 apart = point->error[0] / point->value[0] + sweep->against->error[0] / sweep->against->value[0];
    ABOVE(ratio->error[0], true_error);
    BELOW(ratio->error[0], 0.2 * apart * ratio->value[0]);
    NEAR(change->value[0], point->value[0] - sweep->against->value[0], 0, 1e-12);
    ABOVE(change->error[0], fabs(change->value[0] - speed / 2));

    // a failed twin leaves the ratio unknown, not the value
    members[sweep->against->base].status = "failed: a test";
    convergence_sweep_judge(sweep, members);
    assert_true(isnan(ratio->error[0]) && isnan(ratio->value[0]));
    ABOVE(point->error[0], 0);
}

/* Multipliers of .6 +- .01 and .5 +- .02 that no key changes. */
TEST(a_comparison_of_multipliers_has_the_errors_of_both) {
    const struct error_study first =
        open_study(UNIFORM "sweep: [{key: \"fish[*].body.modulus\", values: [1e7, 3e7]}]\n",
                   "{of: steady_multiplier, keys: [nodes], against: first}");
    const struct error_sweep *const sweep = first.sweep;
    struct member_file *const members = make_members(&first);
    for (int m = 0; m < sweep_n_members(first.study); m++) {
        const bool is_first = setting(&first, m, "fish.body.modulus") < 2e7;
        set_value(&members[m], "steady_multiplier", is_first ? 0.5 : 0.6);
        set_value(&members[m], "steady_multiplier_error", is_first ? 0.02 : 0.01);
    }
    convergence_sweep_judge(first.sweep, members);
    NEAR(sweep->point[1].error[0], 0.01, 0, 1e-12);
    NEAR(sweep->ratio->point[1].value[0], 1.2, 0, 1e-12);
    NEAR(sweep->ratio->point[1].error[0], 1.2 * (0.01 / 0.6 + 0.02 / 0.5), 0, 1e-12);
    NEAR(sweep->change->point[1].error[0], 0.03, 0, 1e-12);
    // of a point with itself, where the change is 0
    NEAR(sweep->change->point[0].error[0], 0.04, 0, 1e-12);
}

TEST(a_point_of_a_sweep_or_another_fish_is_a_twin) {
    const struct error_study first = open_study(
        UNIFORM
        "sweep: [{key: \"fish[*].body.modulus\", values: [1e7, 3e7]}, {key: \"fish[*].wave.amplitude\", values: "
        "[0.1, 0.2, 0.3]}]\n",
        "{of: speed, keys: [nodes], against: 30000000}");
    const struct error_sweep *const sweep = first.sweep;
    for (int p = 0; p < 6; p++) assert_int_equal(sweep->twin[p], 3 + p % 3);
    struct member_file *const members = make_members(&first);
    convergence_sweep_judge(first.sweep, members);
    NEAR(sweep->ratio->point[4].value[0], 1, 0, 0);
    NEAR(sweep->ratio->point[4].error[0], 0, 0, 0);

    const struct error_study school =
        open_study("format: 1\ntime: {end: 4}\nfish: [{name: leader}, {name: follower, start: {position: [3, 0]}}]\n",
                   "{of: speed, keys: [nodes, rtol], against: follower=leader}");
    const struct error_study *const ratio = &school.sweep->ratio->point[0];
    assert_int_equal(error_plan_twin_fish(ratio, 0), -1);
    assert_int_equal(error_plan_twin_fish(ratio, 1), 0);
    assert_null(school.sweep->against);

    // the leader has a value, and none of the comparison, which is no reason for a flag
    convergence_sweep_judge(school.sweep, make_members(&school));
    assert_true(error_plan_has_value(&school, 0, 0));
    assert_false(error_plan_has_value(ratio, 0, 0));
    NEAR(ratio->value[error_plan_place(ratio, 0, 1)], 1, 0, 1e-12);
    for (int k = 0; k < ratio->n_keys; k++) {
        const struct convergence_result *const leader = &ratio->key[k].part[error_plan_place(ratio, 0, 0)];
        assert_true(isnan(leader->error));
        assert_false(convergence_is_flagged(leader->verdict));
    }
    for (int k = 0; k < ratio->n_keys; k++) {
        for (int i = 0; i < ratio->key[k].n_levels; i++)
            assert_int_equal(ratio->key[k].member[i], ratio->key[k].twin[i]);
    }
}

TEST(what_cannot_be_compared_is_refused) {
    static const struct {
        const char *error, *message;
    } examples[] = {
        {"{of: speed, against: first}", "expects the file of a case"},
        {"{of: speed, against: a=b}", "expects the names of two fish of this case"},
        {"{of: speed, against: missing.yaml}", "missing.yaml: cannot be read"},
        {"{of: speed, within: 0.1, " OTHER "fish: [{}]}}", "error.within: refines one case"},
        {"{of: speed, " OTHER "fish: [{}, {start: {position: [9, 0]}}]}}", "other has more fish than the case"},
        {"{of: steady_speed, " OTHER
         "fish: [{wave: {amplitude: 0, frequency: 0}, motion: {prescribed: all, speed: 1}}]}}",
         "other has no beat"},
        {"{of: speed, " OTHER "fish: [{nodes: 2}]}}", "fish[0].nodes: must be"},
    };
    for (size_t i = 0; i < sizeof examples / sizeof *examples; i++) {
        const char *const text = arena_text(test_arena(), UNIFORM "error: %s\n", examples[i].error);
        struct error_sweep *sweep;
        struct case_values values;
        enum status status = case_parse(&values, text, strlen(text), "x.yaml", NULL, 0, NULL);
        if (status == STATUS_OK) {
            arena_move(values.arena, test_arena());
            status = error_plan_create(test_arena(), &sweep, &values, NULL);
        }
        assert_int_equal(status, STATUS_CASE);
        if (!strstr(status_message(), examples[i].message)) fail_msg("%s: %s", examples[i].error, status_message());
    }
}

TEST(a_quantity_of_the_whole_case_is_not_compared_with_itself) {
    static const char text[] =
        "format: 1\ntime: {end: 1}\nfish: [{name: one}, {name: other, start: {position: [9, 0]}}]\n"
        "error: {of: steady_multiplier, against: one=other}\n";
    struct error_sweep *sweep;
    const struct case_values values = parse(text);
    assert_int_equal(error_plan_create(test_arena(), &sweep, &values, NULL), STATUS_CASE);
    contains(status_message(), "error.against: steady_multiplier is of the whole case");
}

TEST(other_models_bound_the_value) {
    struct error_study study = open_study("format: 1\nname: model\ntime: {end: 4}\nfish: [{name: fish}]\n",
                                          "{of: steady_speed, keys: [rtol], models: true}");
    const struct error_study_key *const force = key_of(&study, "fish.force"), *const form =
                                                                                  key_of(&study, "fish.drag.form");
    assert_int_equal(force->n_levels, 2);
    NEAR_ARRAY(2, force->value, ((double[]){FORCE_REACTIVE, FORCE_PRESSURE}), 0, 0);
    assert_int_equal(force->member[1], study.base);
    ABOVE(form->value[form->stated], 1.1);
    assert_int_equal(key_of(&study, "fish.pressure.suction_limit")->n_levels, 3);
    NEAR_ARRAY(3, key_of(&study, "fish.drag.transition")->value, ((double[]){0, 2e5, 1e8}), 0, 0);
    NEAR_ARRAY(3, key_of(&study, "fish.body.tail_thickness")->value, ((double[]){0.02, 0.04, 0.08}), 0, 1e-12);
    NEAR_ARRAY(3, key_of(&study, "wake.leg_length")->value, ((double[]){0.5, 1, 2}), 0, 1e-12);

    // a member has one other choice, and the defaults that do not follow from it
    for (int m = 0; m < sweep_n_members(study.study); m++) {
        const struct case_values member = member_of(study.study, m);
        const struct fish_parameters *const fish = &member.school.fish[0];
        assert_int_equal(fish->force, m == force->member[0] ? FORCE_REACTIVE : FORCE_PRESSURE);
        assert_int_equal(fish->drag.friction, FRICTION_BOUNDARY_LAYER);
        assert_int_equal(case_table_is_set(&member, "fish.drag.form", 0), m == form->member[0]);
    }

    // the lowest and the highest value, of any choice
    struct member_file *const members = make_members(&study);
    set_value(&members[force->member[0]], "steady_speed", 2.5);
    set_value(&members[key_of(&study, "fish.drag.transition")->member[0]], "steady_speed", 0.5);
    convergence_study_judge(&study, members);
    NEAR(study.error[0], study.noise * study.value[0], 1e-12, 0);
    NEAR(study.lowest[0].value, 0.5, 0, 1e-12);
    NEAR(study.highest[0].value, 2.5, 0, 1e-12);
    const char *const text = report_of(&study, members);
    assert_non_null(strstr(text, "other models: from 0.5 m s-1 (drag.transition 0) to 2.5 m s-1 (force reactive)\n"));
    assert_non_null(strstr(text, "fish.force ([pressure] reactive) "));
    char csv[16384], change[80];
    read_csv(&study, sizeof csv, csv);
    for (int i = 0; i < 2; i++) {
        snprintf(change, sizeof change,
                 i == 0 ? ",lowest,fish.drag.transition 0,nan,%.3g," : ",highest,fish.force reactive,nan,%.3g,",
                 i == 0 ? study.value[0] - 0.5 : 2.5 - study.value[0]);
        contains(csv, change);
    }

    // without a model that failed, and without another value
    set_value(&members[force->member[0]], "steady_speed", NAN);
    set_value(&members[key_of(&study, "fish.drag.transition")->member[0]], "steady_speed", study.value[0]);
    convergence_study_judge(&study, members);
    assert_int_equal(study.lowest[0].key, -1);
    NEAR(study.highest[0].value, study.value[0], 0, 0);
}

static void is_printed(const char *got, const char *want) {
    size_t i = 0;
    while (got[i] && got[i] == want[i]) i++;
    if (got[i] != want[i]) fail_msg("from \"%.60s\" on:\n%s", want + i, got);
}

// every number of a report, and the rows of its table
TEST(a_report_is_printed_whole) {
    struct error_study study = open_study(
        UNIFORM,
        "{of: [steady_speed, steady_cost_of_transport], keys: [nodes, shedding_interval, rtol, smoothing, taper]}");
    struct member_file *const members = make_members(&study);
    set_value(&members[key_of(&study, "wake.smoothing")->member[0]], "steady_speed", 1.6);
    set_value(&members[key_of(&study, "wake.taper")->member[0]], "steady_cost_of_transport", 0.0825);
    convergence_study_judge(&study, members);
    is_printed(
        report_of(&study, members),
        "steady_speed of fish1: 1.5060 +- 0.0061 m s-1 (0.4 %)\n"
        "steady_cost_of_transport of fish1: 0.08096 +- 0.00097 m s-2 (1.2 %)\n"
        "key                     levels                     speed  order      %  share  cost_of_transport  order      "
        "%  share        by  next\n"
        "fish.nodes              17 [25] 35 49             0.0017    2.0   0.11     27            0.00027    2.0   "
        "0.33     27  4 levels\n"
        "time.shedding_interval  0.04 0.02 [0.01] 0.005    0.0045    1.0   0.30     73            0.00072    1.0   "
        "0.89     73  4 levels  <- spend here: shedding_interval 0.005, CPU x 2, cost_of_transport +-0.81 %\n"
        "solver.rtol             0.0001 [1e-05] 1e-06     0.00000   none   0.00      0            0.00000   none   "
        "0.00      0  3 levels\n"
        "noise                                            0.00002          0.00                  0.000001          "
        "0.00\n"
        "cancelled                                       -0.00009         -0.01                 -0.000014         "
        "-0.02\n"
        "sum                                               0.0061          0.40                   0.00097          "
        "1.20\n"
        "noise of a value, of integrator and search: 1.0e-05\n"
        "choices, not in the sum: wake.smoothing ([0.1] 0.05) 6.2 %; wake.taper ([0.6] 0.3) 1.9 %\n");

    char csv[4096];
    read_csv(&study, sizeof csv, csv);
    static const char rows[] =
        "fish,quantity,unit,value,key,levels,order,error,percent,verdict\n"
        "\"fish1\",steady_speed,m s-1,1.50597917,sum,,nan,0.00609,0.404,\"\"\n"
        "\"fish1\",steady_speed,m s-1,1.50597917,fish.nodes,17 [25] 35 49,2,0.00166,0.11,\"accepted\"\n"
        "\"fish1\",steady_speed,m s-1,1.50597917,time.shedding_interval,0.04 0.02 [0.01] 0.005,1,0.0045,0.299,"
        "\"accepted\"\n"
        "\"fish1\",steady_speed,m s-1,1.50597917,solver.rtol,0.0001 [1e-05] 1e-06,nan,0,0,\"differences are below the "
        "noise\"\n"
        "\"fish1\",steady_speed,m s-1,1.50597917,wake.smoothing,[0.1] 0.05,nan,0.094,6.24,\"a choice of the model, not "
        "in the sum\"\n";
    csv[sizeof rows - 1] = '\0';
    is_printed(csv, rows);

    // a value of the other sign has the same error
    for (int m = 0; m < sweep_n_members(study.study); m++) {
        set_value(&members[m], "steady_speed", -member_file_number(&members[m], "steady_speed", 0));
    }
    convergence_study_judge(&study, members);
    contains(report_of(&study, members), "steady_speed of fish1: -1.5060 +- 0.0061 m s-1 (0.4 %)\n");
}
