/* test_case.c: defaults, presets, includes, assignments, sweeps; and that a case shown reads back the same. What is
 * wrong with a case is tested by test_bad.sh. */
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "case/case.h"
#include "case/case_keys.h"
#include "case/case_member.h"
#include "case/case_show.h"
#include "case/case_table.h"
#include "case/case_value.h"
#include "case/sweep_expect.h"
#include "case/sweep_members.h"
#include "case/sweep_quantity.h"
#include "case/sweep_refine.h"
#include "failing_malloc.h"
#include "near.h"

// ---- the fixture

static const char minimal[] = "format: 1\ntime: {end: 3}\nfish: [{}]\n";

/* Parse a case that must be good, with up to three assignments (NULL: none). */
static struct case_values parse_with(const char *text, const char *first, const char *second, const char *third) {
    const char *const assignments[] = {first, second, third};
    int n = 0;
    while (n < 3 && assignments[n]) n++;
    struct case_values values;
    const enum status status = case_parse(&values, text, strlen(text), "cases/x.yaml", NULL, n, assignments);
    if (status != STATUS_OK) fail_msg("%s", status_message());
    return values;
}

static struct case_values parse(const char *text) {
    return parse_with(text, NULL, NULL, NULL);
}

/* Parse a case that must be refused with a message that contains these words. */
static void is_refused(const char *text, const char *want) {
    struct case_values values;
    assert_int_equal(case_parse(&values, text, strlen(text), "cases/x.yaml", NULL, 0, NULL), STATUS_CASE);
    if (!strstr(status_message(), want)) fail_msg("the message is\n%.600s\nwithout %s", status_message(), want);
    assert_null(values.school.fish);
}

/* Every value of two cases is the same, bit for bit: written as text with all digits they are. */
static void are_equal(struct case_values *one, struct case_values *other) {
    assert_int_equal(one->school.n_fish, other->school.n_fish);
    for (int k = 0; k < case_table_n; k++) {
        const struct key *const key = &case_table[k];
        if (strcmp(key->path, "preset") == 0 || strcmp(key->path, "output.file") == 0) continue;
        for (int i = 0; i < (case_table_is_of_fish(key) ? one->school.n_fish : 1); i++) {
            struct text a = {0}, b = {0};
            text_add(&a, "%s: ", key->path);
            text_add(&b, "%s: ", key->path);
            case_value_write(&a, key, case_table_field(key, one, &one->school.fish[i]));
            case_value_write(&b, key, case_table_field(key, other, &other->school.fish[i]));
            assert_string_equal(a.text, b.text);
            text_free(&a);
            text_free(&b);
        }
    }
    assert_int_equal(one->n_axes, other->n_axes);
    for (int i = 0; i < one->n_axes; i++) {
        assert_int_equal(one->sweep[i].n_keys, other->sweep[i].n_keys);
        for (int k = 0; k < one->sweep[i].n_keys; k++) {
            assert_string_equal(one->sweep[i].key[k].path, other->sweep[i].key[k].path);
        }
        assert_int_equal(one->sweep[i].refine, other->sweep[i].refine);
        assert_memory_equal(&one->sweep[i].order, &other->sweep[i].order, sizeof(double));
        assert_memory_equal(&one->sweep[i].within, &other->sweep[i].within, sizeof(double));
        assert_int_equal(one->sweep[i].order_of, other->sweep[i].order_of);
        assert_int_equal(one->sweep[i].reference != NULL, other->sweep[i].reference != NULL);
        for (int k = 0; one->sweep[i].reference && k < SWEEP_N_ORDERS * one->school.n_fish * 2; k++) {
            const double a = one->sweep[i].reference[k], b = other->sweep[i].reference[k];
            assert_true(a == b || (isnan(a) && isnan(b)));
        }
        assert_int_equal(one->sweep[i].n_values, other->sweep[i].n_values);
        for (int j = 0; j < one->sweep[i].n_values * one->sweep[i].n_keys; j++) {
            assert_string_equal(one->sweep[i].value[j], other->sweep[i].value[j]);
        }
    }
    assert_int_equal(one->n_expectations, other->n_expectations);
    for (int i = 0; i < one->n_expectations; i++) {
        const struct sweep_expectation *const a = &one->expect[i], *const b = &other->expect[i];
        assert_int_equal(a->of, b->of);
        assert_int_equal(a->fails != NULL, b->fails != NULL);
        if (a->fails) assert_string_equal(a->fails, b->fails);
        assert_int_equal(a->fish, b->fish);
        assert_int_equal(a->n_where, b->n_where);
        for (int c = 0; c < a->n_where; c++) {
            assert_int_equal(a->where[c].axis, b->where[c].axis);
            assert_int_equal(a->where[c].key, b->where[c].key);
            assert_string_equal(a->where[c].value, b->where[c].value);
        }
        const double *const from = &a->min, *const to = &b->min;
        for (int k = 0; k < 4; k++) assert_true(from[k] == to[k] || (isnan(from[k]) && isnan(to[k])));
    }
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
    assert_true(fputs(text, file) >= 0);
    assert_int_equal(fclose(file), 0);
}

// ---- defaults

static void the_defaults_are_those_of_the_reference(void **state) {
    (void)state;
    struct case_values s = parse(minimal);
    NEAR(s.time.end, 3, 0, 0);
    NEAR(s.school.shedding_interval, 0.01, 0, 0);
    NEAR(s.school.fluid.density, 1000, 0, 0);
    NEAR(s.school.wake.smoothing, 0.1, 0, 0);
    NEAR(s.school.wake.taper, 0.4, 0, 0);
    NEAR(s.school.wake.taper_beside, 0.1, 0, 0);
    assert_int_equal(s.school.wake.curve, BODY_LINE_SMOOTH);
    NEAR(s.school.wake.sheet_smoothing, 0.05, 0, 0);
    NEAR(s.school.wake.lifetime, 2, 0, 0);
    assert_int_equal(s.school.wake.shedding, SHEDDING_SHEET);
    assert_int_equal(s.school.wake.kutta, KUTTA_EDGE);
    assert_int_equal(s.school.wake.collocation, COLLOCATION_CHEBYSHEV);
    assert_int_equal(s.school.wake.dissipated_circulation, REMOVED_RETAINED);
    assert_int_equal(s.solver.method, METHOD_IDA);
    NEAR(s.school.rtol, 1e-5, 0, 0);
    assert_int_equal(s.solver.order, 2);
    assert_int_equal(s.school.threads, 1);
    assert_int_equal(s.output.precision, PRECISION_DOUBLE);
    assert_null(s.output.file);
    const struct fish_parameters *const fish = s.school.fish;
    assert_int_equal(fish->nodes, 17);
    assert_int_equal(fish->reference_nodes, 7);
    assert_int_equal(fish->sheet_points, 33);
    assert_int_equal(fish->force, FORCE_REACTIVE);
    assert_int_equal(fish->body.section, SECTION_MEAN);
    assert_int_equal(fish->body.profile, PROFILE_JOUKOWSKI);
    assert_int_equal(fish->body.second_moment, SECOND_MOMENT_ELLIPSE);
    NEAR(fish->body.density, 1000, 0, 0);
    NEAR(fish->body.relaxation_time, 0.001, 0, 0);
    NEAR(fish->body.bending_damping, 0, 0, 0);
    NEAR(fish->body.stretching_damping, 0, 0, 0);
    NEAR(fish->body.modulus, 1e6, 0, 0);
    NEAR(fish->wave.number, -6, 0, 0);
    NEAR(fish->drag.tangential, 4e-3, 0, 0);
    NEAR(fish->drag.normal, 1, 0, 0);
    NEAR(fish->drag.added_mass, 1, 0, 0);
    assert_int_equal(fish->drag.extent, EXTENT_WIDTH);
    assert_int_equal(fish->drag.law, DRAG_QUADRATIC);
    NEAR(fish->start_heading, 180, 0, 0);
    NEAR(fish->start_speed, 0, 0, 0);
    assert_int_equal(fish->motion.prescribed, PRESCRIBED_NONE);
    assert_int_equal(fish->control.law, CONTROL_NONE);
    assert_int_equal(fish->control.waypoints.n, 0);
    NEAR(fish->control.gain, 2, 0, 0);
    case_free(&s);
}

static void derived_defaults_follow_what_they_derive_from(void **state) {
    (void)state;
    struct case_values s = parse(
        "format: 1\ntime: {end: 1, shedding_interval: 0.02}\nwake: {lifetime: 3}\n"
        "fish: [{start: {heading: 30, speed: 2}, wave: {frequency: 4}}, {wave: {frequency: 0}}]\n");
    NEAR(s.time.output_interval, 0.2, 0, 1e-15);
    NEAR(s.output.wake_interval, 0.2, 0, 1e-15);
    NEAR(s.school.wake.decay, 0.3, 0, 1e-15);
    assert_string_equal(s.name, "x");
    assert_string_equal(s.school.fish[0].name, "fish1");
    assert_string_equal(s.school.fish[1].name, "fish2");
    NEAR(s.school.fish[0].wave.ramp, 0.25, 0, 0);
    NEAR(s.school.fish[1].wave.ramp, 0, 0, 0);
    NEAR(s.school.fish[0].motion.speed, 2, 0, 0);
    assert_int_equal(s.school.fish[0].control.desired_heading.n, 1);
    NEAR(s.school.fish[0].control.desired_heading.value[0], 0, 0, 0);
    NEAR(s.school.fish[0].control.desired_heading.value[1], 30, 0, 0);
    case_free(&s);
}

static void every_default_of_the_table_is_a_value_of_its_key(void **state) {
    (void)state;
    struct case_values s = parse(minimal), published = parse_with(minimal, "preset=published", NULL, NULL);
    case_free(&s);
    case_free(&published);
    for (int k = 0; k < case_table_n; k++) {
        const struct key *const key = &case_table[k];
        assert_true(strlen(key->path) < 60);  // the buffers for paths hold more
        assert_true(*key->meaning && !strchr(key->meaning, '\n'));
        assert_ptr_equal(case_table_row(key->path), key);
        assert_true(!key->initial || !key->derived);
        assert_int_equal(key->type == CHOICE, key->words != NULL);
    }
}

static void defaults_reach_every_fish_below_its_own_keys(void **state) {
    (void)state;
    struct case_values s = parse(
        "format: 1\ntime: {end: 1}\ndefaults: {fish: {nodes: 9, body: {modulus: 1e4, density: 900}}}\n"
        "fish: [{body: {modulus: 1e5}}, {nodes: 5}]\n");
    assert_int_equal(s.school.fish[0].nodes, 9);
    assert_int_equal(s.school.fish[1].nodes, 5);
    NEAR(s.school.fish[0].body.modulus, 1e5, 0, 0);
    NEAR(s.school.fish[1].body.modulus, 1e4, 0, 0);
    NEAR(s.school.fish[0].body.density, 900, 0, 0);
    case_free(&s);
}

static void a_wrong_default_is_reported_once_even_if_unused(void **state) {
    (void)state;
    is_refused("format: 1\ntime: {end: 1}\ndefaults: {fish: {nodes: 2}}\nfish: [{}, {nodes: 7}, {}]\n",
               "cases/x.yaml:3:26: error: defaults.fish.nodes: must be from 4 to 10000, got 2\n"
               "defaults: {fish: {nodes: 2}}\n                         ^");
    assert_null(strstr(status_message(), "fish[0]"));
    is_refused("format: 1\ntime: {end: 1}\ndefaults: {fish: {nodes: 2}}\nfish: [{nodes: 7}]\n", "defaults.fish.nodes");
}

// ---- preset

static void preset_published_sets_the_options_of_the_article(void **state) {
    (void)state;
    struct case_values s = parse("format: 1\npreset: published\ntime: {end: 1}\nfish: [{}]\n");
    assert_int_equal(s.preset, PRESET_PUBLISHED);
    assert_int_equal(s.school.fish->body.second_moment, SECOND_MOMENT_PUBLISHED);
    assert_int_equal(s.school.fish->body.section, SECTION_NODES);
    NEAR(s.school.fish->wave.ramp, 0, 0, 0);
    assert_int_equal(s.school.wake.collocation, COLLOCATION_MIDPOINT);
    assert_int_equal(s.school.wake.kutta, KUTTA_RATE);
    NEAR(s.school.wake.kutta_ramp, 0.5, 0, 0);
    assert_int_equal(s.school.wake.shedding, SHEDDING_IMPULSIVE);
    NEAR(s.school.wake.sheet_smoothing, 0.01, 0, 0);
    NEAR(s.school.wake.decay, 0, 0, 0);
    assert_int_equal(s.school.wake.dissipated_circulation, REMOVED_DROPPED);
    assert_int_equal(s.school.fish->drag.law, DRAG_QUADRATIC);
    assert_int_equal(s.school.fish->drag.extent, EXTENT_THICKNESS);
    case_free(&s);
}

static void keys_in_the_case_override_the_preset(void **state) {
    (void)state;
    struct case_values s = parse(
        "format: 1\npreset: published\ntime: {end: 1}\nwake: {kutta: edge}\n"
        "defaults: {fish: {wave: {ramp: 2}}}\nfish: [{body: {second_moment: ellipse}}]\n");
    assert_int_equal(s.school.wake.kutta, KUTTA_EDGE);
    assert_int_equal(s.school.wake.collocation, COLLOCATION_MIDPOINT);
    NEAR(s.school.fish->wave.ramp, 2, 0, 0);
    assert_int_equal(s.school.fish->body.second_moment, SECOND_MOMENT_ELLIPSE);
    case_free(&s);
}

// ---- values

static void every_type_of_value_is_read(void **state) {
    (void)state;
    struct case_values s = parse(
        "format: 1\nname: no\ntime: {end: 2.0E0}\nfluid: {velocity: [-1, .5], gust: {amplitude: 1, frequency: 2}}\n"
        "fish:\n"
        "  - nodes: 5\n"
        "    body: {profile: table, h: [0.1, 0.2, 0.2, 0.1], w: [1, 2, 3, 4]}\n"
        "    control: {law: heading, desired_heading: [[0, 180], [5, 135]], waypoints: [[1, 2], [3, 4], [5, 6]]}\n"
        "  - {name: 'a: b', control: {desired_heading: -90}}\n");
    assert_string_equal(s.name, "no");
    NEAR(s.time.end, 2, 0, 0);
    NEAR_ARRAY(2, s.school.fluid.velocity, ((const double[]){-1, 0.5}), 0, 0);
    NEAR(s.school.fluid.gust_frequency, 2, 0, 0);
    assert_int_equal(s.school.fish[0].body.h.n, 4);
    NEAR_ARRAY(4, s.school.fish[0].body.w.value, ((const double[]){1, 2, 3, 4}), 0, 0);
    assert_int_equal(s.school.fish[0].control.desired_heading.n, 2);
    NEAR_ARRAY(4, s.school.fish[0].control.desired_heading.value, ((const double[]){0, 180, 5, 135}), 0, 0);
    assert_int_equal(s.school.fish[0].control.waypoints.n, 3);
    NEAR_ARRAY(6, s.school.fish[0].control.waypoints.value, ((const double[]){1, 2, 3, 4, 5, 6}), 0, 0);
    assert_string_equal(s.school.fish[1].name, "a: b");
    NEAR(s.school.fish[1].control.desired_heading.value[1], -90, 0, 0);
    case_free(&s);
}

static void multiples_are_recognised_despite_rounding(void **state) {
    (void)state;
    // 0.3/0.1, 25/0.005 and 4.35/0.01 are no integers in double precision
    static const char *const times[] = {"{end: 0.3, shedding_interval: 0.1}", "{end: 25, shedding_interval: 0.005}",
                                        "{end: 4.35}", "{end: 1, output_interval: 0.07}"};
    for (size_t i = 0; i < sizeof times / sizeof *times; i++) {
        char text[200];
        snprintf(text, sizeof text, "format: 1\ntime: %s\nfish: [{}]\n", times[i]);
        struct case_values s = parse(text);
        case_free(&s);
    }
}

static void errors_of_all_stages_are_listed_together(void **state) {
    (void)state;
    is_refused("format: 1\ntime: {end: 1.005}\nfish: [{length: x}, {nodes: 1}]\n",
               "time.end: 1.005 s is not an integer");
    assert_non_null(strstr(status_message(), "fish[0].length: expects a number in m, got 'x'"));
    assert_non_null(strstr(status_message(), "fish[1].nodes: must be from 4"));
}

static void a_misspelt_key_brings_no_second_error(void **state) {
    (void)state;
    is_refused("format: 1\ntime: {end: 1.005, shedding_intervall: 0.005}\nfish: [{}]\n",
               "did you mean 'shedding_interval'?");
    assert_null(strstr(status_message(), "multiple"));
}

// ---- includes

static void an_include_is_weaker_than_the_file_that_includes_it(void **state) {
    (void)state;
    write_file("water.yaml", "fluid: {density: 1025, velocity: [1, 2]}\nwake: {lifetime: 4}\nfish: [{nodes: 9}, {}]\n");
    write_file("case.yaml",
               "include: [water.yaml]\nformat: 1\ntime: {end: 1}\nfluid: {velocity: [3, 4]}\nfish: [{}]\n");
    struct case_values s;
    if (case_read(&s, "case.yaml", 0, NULL) != STATUS_OK) fail_msg("%s", status_message());
    NEAR(s.school.fluid.density, 1025, 0, 0);
    NEAR(s.school.fluid.velocity[0], 3, 0, 0);
    NEAR(s.school.wake.lifetime, 4, 0, 0);
    assert_int_equal(s.school.n_fish, 1);  // lists replace
    assert_int_equal(s.school.fish->nodes, 17);
    assert_string_equal(s.name, "case");
    assert_non_null(strstr(s.text, "include: [water.yaml]"));
    case_free(&s);
}

static void includes_are_relative_to_their_file_and_the_last_is_strongest(void **state) {
    (void)state;
    assert_int_equal(system("mkdir below"), 0);
    write_file("below/more.yaml", "include: ../water.yaml\nwake: {lifetime: 3}\n");
    write_file("water.yaml", "wake: {lifetime: 4, smoothing: 0.4}\n");
    write_file("case.yaml", "include: [below/more.yaml]\nformat: 1\ntime: {end: 1}\nfish: [{}]\n");
    struct case_values s;
    if (case_read(&s, "case.yaml", 0, NULL) != STATUS_OK) fail_msg("%s", status_message());
    NEAR(s.school.wake.lifetime, 3, 0, 0);
    NEAR(s.school.wake.smoothing, 0.4, 0, 0);
    case_free(&s);
    static const char text[] = "include: [below/more.yaml, water.yaml]\nformat: 1\ntime: {end: 1}\nfish: [{}]\n";
    if (case_parse(&s, text, strlen(text), "memory", *state, 0, NULL)) fail_msg("%s", status_message());
    NEAR(s.school.wake.lifetime, 4, 0, 0);
    case_free(&s);
}

static void an_error_in_an_include_names_the_include(void **state) {
    (void)state;
    write_file("water.yaml", "fluid:\n  densty: 1025\n");
    write_file("case.yaml", "include: [water.yaml]\nformat: 1\ntime: {end: 1}\nfish: [{}]\n");
    struct case_values s;
    assert_int_equal(case_read(&s, "case.yaml", 0, NULL), STATUS_CASE);
    assert_string_equal(
        status_message(),
        "water.yaml:2:3: error: fluid.densty: unknown key; did you mean 'density'?\n  densty: 1025\n  ^");
}

static void a_case_that_cannot_be_read_is_a_file_error(void **state) {
    (void)state;
    struct case_values s;
    assert_int_equal(case_read(&s, "no_such_file.yaml", 0, NULL), STATUS_FILE);
    assert_int_equal(case_read(&s, ".", 0, NULL), STATUS_FILE);
    case_free(&s);
}

// ---- assignments

static void assignments_are_strongest_and_the_last_counts(void **state) {
    (void)state;
    struct case_values s = parse_with(minimal, "time.end=5", "fish[0].start.position=[1, 2]", "time.end=6");
    NEAR(s.time.end, 6, 0, 0);
    NEAR_ARRAY(2, s.school.fish->start_position, ((const double[]){1, 2}), 0, 0);
    case_free(&s);
}

static void a_star_assigns_to_every_fish(void **state) {
    (void)state;
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
    case_free(&s);
}

static void assignments_reach_defaults_preset_and_sections(void **state) {
    (void)state;
    struct case_values s = parse_with(minimal, "defaults.fish.nodes=9", "preset=published", "wake={kutta: edge}");
    assert_int_equal(s.school.fish->nodes, 9);
    assert_int_equal(s.school.wake.shedding, SHEDDING_IMPULSIVE);
    assert_int_equal(s.school.wake.kutta, KUTTA_EDGE);
    case_free(&s);
    s = parse_with(minimal, "fish=[{name: a}, {name: 'b = c'}]", "fish[1].length=2", "name=x=y");
    assert_int_equal(s.school.n_fish, 2);
    assert_string_equal(s.school.fish[1].name, "b = c");
    NEAR(s.school.fish[1].length, 2, 0, 0);
    assert_string_equal(s.name, "x=y");
    case_free(&s);
}

// ---- sweeps and what runs

static const char swept[] =
    "format: 1\ntime: {end: 1}\nfish: [{}, {}]\n"
    "sweep:\n"
    "  - {key: 'fish[*].body.modulus', values: [1e4, 1e6, 1.0e+8]}\n"
    "  - {key: 'fish[1].start.position', values: [[0, 1], [0, 2]]}\n"
    "  - {key: wake.kutta, values: [edge, rate]}\n";

static void a_sweep_keeps_its_values_as_assignments_take_them(void **state) {
    (void)state;
    struct case_values s = parse(swept);
    assert_int_equal(s.n_axes, 3);
    assert_string_equal(s.sweep[0].key[0].path, "fish[*].body.modulus");
    assert_int_equal(s.sweep[0].n_values, 3);
    assert_string_equal(s.sweep[0].value[2], "1.0e+8");
    assert_string_equal(s.sweep[1].value[1], "[0, 2]");
    char assignment[100];
    snprintf(assignment, sizeof assignment, "%s=%s", s.sweep[1].key[0].path, s.sweep[1].value[1]);
    case_free(&s);
    s = parse_with(swept, assignment, NULL, NULL);
    NEAR(s.school.fish[1].start_position[1], 2, 0, 0);
    case_free(&s);
}

static const char zipped[] =
    "time: {end: 1, shedding_interval: 0.1}\nformat: 1\nfish: [{}, {}]\n"
    "sweep:\n"
    "  - {key: time.shedding_interval, values: [0.1, 0.05, 0.025], refine: true, expect: {order: 2, within: 0.2}}\n"
    "  - {keys: ['fish[*].nodes', 'fish[1].name'], values: [[7, thin], [9, 'a: b']]}\n";

static void members_are_numbered_with_the_last_axis_fastest(void **state) {
    (void)state;
    struct case_values study = parse(zipped);
    assert_int_equal(sweep_n_members(&study), 6);
    for (int m = 0; m < 6; m++) {
        struct case_values s;
        assert_int_equal(case_member(&s, &study, m), STATUS_OK);
        NEAR(s.school.shedding_interval, 0.1 / (1 << m / 2), 0, 1e-15);
        // what is derived follows what is swept
        NEAR(s.time.output_interval, 1.0 / (1 << m / 2), 0, 1e-15);
        assert_int_equal(s.school.fish[0].nodes, m % 2 ? 9 : 7);
        assert_string_equal(s.school.fish[1].name, m % 2 ? "a: b" : "thin");
        assert_int_equal(s.n_axes, 0);
        assert_int_equal(s.member, m);
        assert_string_equal(s.study, study.merged);
        assert_string_equal(s.text, study.text);
        case_free(&s);
    }
    char *text;
    assert_int_equal(sweep_member_text(&study, 3, &text), STATUS_OK);
    assert_string_equal(text, "time.shedding_interval=0.05, fish[*].nodes=9, fish[1].name=\"a: b\"");
    free(text);
    case_free(&study);
}

static void the_merged_text_is_the_complete_study(void **state) {
    (void)state;
    struct case_values study = parse_with(zipped, "fish[0].length=2", "wake.fade=0.1", NULL);
    struct case_values again;
    assert_int_equal(case_parse(&again, study.merged, strlen(study.merged), "other.yaml", NULL, 0, NULL), STATUS_OK);
    are_equal(&study, &again);
    assert_string_equal(again.merged, study.merged);
    case_free(&study);
    case_free(&again);
}

static const char refined[] =
    "time: {end: 1, shedding_interval: 0.1}\nformat: 1\nfish: [{}, {}]\n"
    "sweep:\n"
    "  - key: solver.rtol\n"
    "    values: [1e-3, 1e-4, 1e-5]\n"
    "    refine: true\n"
    "    reference: {speed: 1.25, nose: [[1, 2], [3, 4]], com: [5, 6], mean_heading: [7, 8]}\n"
    "    expect: {order: 0.8, within: 0.2, of: [speed, com]}\n";

static void a_reference_is_given_for_all_fish_or_for_each(void **state) {
    (void)state;
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
    case_free(&s);
    s = parse(zipped);
    assert_true(isnan(sweep_reference(&s, 0, 0, 0, 0)));
    assert_int_equal(s.sweep[0].order_of, 1 << SWEEP_NOSE | 1 << SWEEP_TAIL);
    case_free(&s);
}

static const char stated[] =
    "time: {end: 1, shedding_interval: 0.1}\nformat: 1\nfish: [{name: a}, {name: 'b: c'}]\n"
    "sweep:\n"
    "  - {keys: [solver.method, solver.rtol], values: [[ida, 1e-3], [rk4, 1e-4], [ida, 1e-4]]}\n"
    "  - {key: 'fish[1].start.position', values: [[0, 1], [0, 2]]}\n"
    "expect:\n"
    "  - {of: speed, fish: 'b: c', least: 1, most: 2, ratio: 3}\n"
    "  - {of: [nose, tail], spread: 0, where: ['solver.rtol=0.0001', 'fish[1].start.position=[0,2]']}\n"
    "  - {of: steps, least: -1, where: [solver.method=ida]}\n"
    "  - {fails: 'is: unstable', where: [solver.rtol=1e-3, 'fish[1].start.position=[0, 2]', solver.method=rk4,\n"
    "      solver.method=ida]}\n";

static void a_statement_is_about_the_members_with_its_values(void **state) {
    (void)state;
    struct case_values s = parse(stated);
    assert_int_equal(s.n_expectations, 4);
    assert_string_equal(s.expect[3].fails, "is: unstable");
    assert_null(s.expect[0].fails);
    assert_int_equal(s.expect[0].of, 1 << 3);
    assert_int_equal(s.expect[0].fish, 1);
    assert_int_equal(s.expect[1].fish, -1);
    assert_int_equal(s.expect[1].of, 1 << SWEEP_NOSE | 1 << SWEEP_TAIL);
    NEAR(s.expect[0].ratio, 3, 0, 0);
    assert_true(isnan(s.expect[0].spread));
    // members: (ida 1e-3, 1), (.., 2), (rk4 1e-4, 1), (.., 2), (ida 1e-4, 1), (.., 2)
    static const int are_meant[4][6] = {{1, 1, 1, 1, 1, 1}, {0, 0, 0, 1, 0, 1}, {1, 1, 0, 0, 1, 1}, {0, 1, 0, 0, 0, 0}};
    for (int i = 0; i < 4; i++) {
        for (int m = 0; m < 6; m++) assert_int_equal(sweep_expects_of(&s, &s.expect[i], m), are_meant[i][m]);
    }
    struct case_values member;
    assert_int_equal(case_member(&member, &s, 2), STATUS_OK);
    assert_int_equal(member.n_expectations, 0);
    case_free(&member);
    case_free(&s);
}

static void a_wrong_member_is_named(void **state) {
    (void)state;
    struct case_values study =
        parse("format: 1\ntime: {end: 1}\nfish: [{}]\nsweep: [{key: time.shedding_interval, values: [0.1, 0.3]}]\n");
    struct case_values s;
    assert_int_equal(case_member(&s, &study, 0), STATUS_OK);
    case_free(&s);
    assert_int_equal(case_member(&s, &study, 1), STATUS_CASE);
    assert_non_null(strstr(status_message(), "member 1 (time.shedding_interval=0.3):\n"));
    assert_non_null(
        strstr(status_message(), "time.end: 1 s is not an integer multiple of time.shedding_interval, 0.3 s"));
    case_free(&study);
}

static void a_sweep_is_refused_as_one_run_with_a_remedy(void **state) {
    (void)state;
    struct case_values s = parse(minimal);
    assert_int_equal(sweep_refuse(&s), STATUS_OK);
    case_free(&s);
    s = parse(swept);
    assert_int_equal(sweep_refuse(&s), STATUS_CASE);
    assert_non_null(strstr(status_message(), "`shoal run` runs one case; this case has a sweep of 3 axes"));
    case_free(&s);
}

// ---- showing

static void a_case_shown_reads_back_bit_for_bit(void **state) {
    (void)state;
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
        "  - {nodes: 4, body: {profile: table, h: [0.1, 0.2, 0.3], w: [1e-7, 1e7, 12345.678901234567]}}\n"
        "  - {name: '#2', control: {law: averaged_heading, desired_heading: [[0, 1], [0.1, 2]], waypoints: [[1, "
        "2]]}}\n",
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct case_values first = parse(cases[i]);
        char *shown, *again;
        assert_int_equal(case_show(&first, &shown), STATUS_OK);
        struct case_values second = parse(shown);
        are_equal(&first, &second);
        assert_int_equal(case_show(&second, &again), STATUS_OK);
        assert_string_equal(shown, again);
        free(shown);
        free(again);
        case_free(&first);
        case_free(&second);
    }
}

static void a_shown_case_has_neither_preset_nor_defaults(void **state) {
    (void)state;
    struct case_values s = parse_with(minimal, "preset=published", "defaults.fish.nodes=9", NULL);
    char *shown;
    assert_int_equal(case_show(&s, &shown), STATUS_OK);
    assert_null(strstr(shown, "preset"));
    assert_null(strstr(shown, "defaults"));
    assert_non_null(strstr(shown, "    nodes: 9\n"));
    assert_non_null(strstr(shown, "  end: 3                                # s\n"));
    free(shown);
    case_free(&s);
}

static void the_table_of_keys_is_valid_text_and_json(void **state) {
    (void)state;
    static char text[100000];
    for (int as_json = 0; as_json <= 1; as_json++) {
        memset(text, 0, sizeof text);
        FILE *const stream = fmemopen(text, sizeof text - 1, "w");
        assert_non_null(stream);
        case_keys(stream, as_json);
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

static void every_failing_allocation_is_reported_and_leaves_nothing(void **state) {
    (void)state;
    write_file("water.yaml", "fluid: {density: 1025}\n");
    write_file("case.yaml",
               "include: [water.yaml]\nformat: 1\ntime: {end: 1}\ndefaults: {fish: {name: a}}\n"
               "fish:\n  - {nodes: 4, body: {profile: table, h: [1, 2, 3], w: [1, 2, 3]}}\n"
               "  - {name: b, control: {desired_heading: 3}}\n"
               "sweep: [{keys: ['fish[*].nodes', solver.order], values: [[4, 1], [4, 2]]},\n"
               "  {key: solver.rtol, values: [0.1, 1e-3, 1e-4], refine: true, reference: {speed: 1}}]\n"
               "expect: [{of: speed, where: [solver.order=1], least: 0}, {fails: a}]\n");
    static const char *const assignments[] = {"fish[*].length=2", "wake.fade=0.1"};
    const int n_before = n_live;
    int n_failures = 0;
    for (;; n_failures++) {
        struct case_values s, member = {0};
        char *shown = NULL;
        n_until_failure = n_failures;
        enum status status = case_read(&s, "case.yaml", 2, assignments);
        if (status == STATUS_OK) status = case_show(&s, &shown);
        if (status == STATUS_OK) status = case_member(&member, &s, 1);
        const int ran_out = n_until_failure == -1;
        n_until_failure = -1;
        free(shown);
        case_free(&s);
        case_free(&member);
        assert_int_equal(n_live, n_before);
        if (!ran_out) {
            assert_int_equal(status, STATUS_OK);
            break;
        }
        // the one allocation that may fail gives back memory that is not needed
        if (status != STATUS_OK) assert_int_equal(status, STATUS_MEMORY);
    }
    assert_in_range(n_failures, 300, 5000);
}

static void without_memory_errors_are_still_memory_errors(void **state) {
    (void)state;
    static const char text[] = "format: 2\ntiem: {end: 3}\nwake: {kutta: no, fade: x}\nfish: [{nodes: 1}]\n";
    const int n_before = n_live;
    for (int i = 0;; i++) {
        struct case_values s;
        n_until_failure = i;
        const enum status status = case_parse(&s, text, strlen(text), "x.yaml", NULL, 0, NULL);
        const int ran_out = n_until_failure == -1;
        n_until_failure = -1;
        case_free(&s);
        assert_int_equal(n_live, n_before);
        assert_int_equal(status, ran_out ? STATUS_MEMORY : STATUS_CASE);
        if (!ran_out) break;
    }
}

static void freeing_twice_is_harmless(void **state) {
    (void)state;
    struct case_values s = parse(swept);
    case_free(&s);
    case_free(&s);
    struct case_values zero = {0};
    case_free(&zero);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_defaults_are_those_of_the_reference),
        cmocka_unit_test(derived_defaults_follow_what_they_derive_from),
        cmocka_unit_test(every_default_of_the_table_is_a_value_of_its_key),
        cmocka_unit_test(defaults_reach_every_fish_below_its_own_keys),
        cmocka_unit_test(a_wrong_default_is_reported_once_even_if_unused),
        cmocka_unit_test(preset_published_sets_the_options_of_the_article),
        cmocka_unit_test(keys_in_the_case_override_the_preset),
        cmocka_unit_test(every_type_of_value_is_read),
        cmocka_unit_test(multiples_are_recognised_despite_rounding),
        cmocka_unit_test(errors_of_all_stages_are_listed_together),
        cmocka_unit_test(a_misspelt_key_brings_no_second_error),
        cmocka_unit_test_setup_teardown(an_include_is_weaker_than_the_file_that_includes_it, make_folder,
                                        remove_folder),
        cmocka_unit_test_setup_teardown(includes_are_relative_to_their_file_and_the_last_is_strongest, make_folder,
                                        remove_folder),
        cmocka_unit_test_setup_teardown(an_error_in_an_include_names_the_include, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(a_case_that_cannot_be_read_is_a_file_error, make_folder, remove_folder),
        cmocka_unit_test(assignments_are_strongest_and_the_last_counts),
        cmocka_unit_test(a_star_assigns_to_every_fish),
        cmocka_unit_test(assignments_reach_defaults_preset_and_sections),
        cmocka_unit_test(a_sweep_keeps_its_values_as_assignments_take_them),
        cmocka_unit_test(members_are_numbered_with_the_last_axis_fastest),
        cmocka_unit_test(the_merged_text_is_the_complete_study),
        cmocka_unit_test(a_reference_is_given_for_all_fish_or_for_each),
        cmocka_unit_test(a_statement_is_about_the_members_with_its_values),
        cmocka_unit_test(a_wrong_member_is_named),
        cmocka_unit_test(a_sweep_is_refused_as_one_run_with_a_remedy),
        cmocka_unit_test(a_case_shown_reads_back_bit_for_bit),
        cmocka_unit_test(a_shown_case_has_neither_preset_nor_defaults),
        cmocka_unit_test(the_table_of_keys_is_valid_text_and_json),
        cmocka_unit_test_setup_teardown(every_failing_allocation_is_reported_and_leaves_nothing, make_folder,
                                        remove_folder),
        cmocka_unit_test(without_memory_errors_are_still_memory_errors),
        cmocka_unit_test(freeing_twice_is_harmless),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
