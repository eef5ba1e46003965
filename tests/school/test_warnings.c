/* test_warnings.c: each warning appears for cases with the defect, and only for these. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "school.h"
#include "school/warnings.h"

#define TIME "time: {end: 3, shedding_interval: 0.01}\n"

// ---- which warnings a run has

// the warnings of a simulation, one character each: contact c, a body crosses itself x, divergence i, energy e,
// momentum o, drift d, events v, sheet s, modes m, leading edge l, controller h, cusp u, few nodes at the
// tail t, published force p
static void expect_of(struct simulation *simulation, const char *expected) {
    simulate_measure(simulation);
    char line[WARNING_BYTES], found[N_WARNINGS + 1] = "";
    for (enum warning w = 0; w < N_WARNINGS; w++) {
        if (!warnings_line(w, simulation->school, simulation->state, simulation->diagnostics,
                           simulation->residual->scratch, line))
            continue;
        print_message("%s\n", line);
        assert_null(strchr(line, '\n'));
        strncat(found, &"cxieodvsmlhutp"[w], 1);
    }
    assert_string_equal(found, expected);
}

// the warnings of a run up to t
static void expect_warnings(const char *text, double t, const char *expected) {
    struct simulation *const simulation = school_simulation(text);
    school_run(simulation, t);
    expect_of(simulation, expected);
    simulate_free(simulation);
}

static void a_short_run_of_a_default_fish_has_none(void **state) {
    (void)state;
    expect_warnings(SCHOOL_DEFAULTS TIME "fish: [{}]\n", 1, "");
}

static void a_fish_that_gathers_speed_drifts(void **state) {
    (void)state;
    expect_warnings(SCHOOL_DEFAULTS TIME "fish: [{}]\n", 2.5, "d");
    // without fluid no fish swims, so a changing speed is no defect
    expect_warnings(SCHOOL_DEFAULTS TIME "fluid: {density: 0}\nfish: [{}]\n", 2.5, "");
}

static void a_tail_without_a_limit_is_told(void **state) {
    (void)state;
#define CUSP(keys) SCHOOL_DEFAULTS TIME "fish: [{body: {tail_thickness: 0}, " keys "}]\n"
    expect_warnings(CUSP("nodes: 25"), 0.1, "u");
    // for any number of nodes; not if the tail does not bend
    expect_warnings(CUSP("nodes: 61, sheet_points: 121"), 0.02, "u");
    expect_warnings(CUSP("motion: {prescribed: all}"), 0.1, "");
    expect_warnings(SCHOOL_DEFAULTS TIME "fluid: {density: 0}\nfish: [{body: {tail_thickness: 0}}]\n", 0.1, "");
}

static void few_nodes_at_the_tail_are_told(void **state) {
    (void)state;
    // (EI/(m_L omega^2))^(1/4) of a uniform body, 0.1 by 0.25, 1e7 Pa, 2 Hz
    const double pi = acos(-1), EI = 1e7 * pi * 0.25 * 1e-3 / 64, m = 1000 * pi * 0.0625 / 4, omega = 4 * pi;
    const double length = pow(EI / (m * omega * omega), 0.25);
    const int enough = (int)ceil(2 / length) + 1;
    for (int n = enough - 1; n <= enough; n++) {
        char text[256];
        snprintf(text, sizeof text,
                 SCHOOL_DEFAULTS TIME
                 "fish: [{nodes: %d, body: {profile: uniform, thickness: 0.1, modulus: 1e7}, wave: {frequency: 2}}]\n",
                 n);
        expect_warnings(text, 0.01, n < enough ? "t" : "");
    }
}

static void a_controller_that_chatters_is_told(void **state) {
    (void)state;
    // a stiff body under a large damping: each beat of the course has more than four reversals
#define STEERED(keys)                                                                 \
    SCHOOL_DEFAULTS                                                                   \
    "time: {end: 8, shedding_interval: 0.02}\n"                                       \
    "fish: [{start: {speed: 0.9}, wave: {amplitude: 0.7}, body: {modulus: 1.0e+7},\n" \
    "  control: {law: course, " keys "desired_heading: [[0, 180], [3, 180], [3.1, 120]]}}]\n"
    expect_warnings(STEERED("damping: 2, "), 7, "dh");
    // the defaults turn and hold the course without
    expect_warnings(STEERED(""), 4, "d");
    expect_warnings(STEERED(""), 7, "d");
}

static void the_published_force_is_told_and_nothing_else(void **state) {
    (void)state;
    // few events, energy balance, drift, cusp: all suppressed for the published force
    expect_warnings("time: {end: 3, shedding_interval: 0.0625}\npreset: published\nfish: [{}]\n", 2.5, "p");
    expect_warnings(SCHOOL_DEFAULTS TIME "fish: [{force: published}, {start: {position: [0, 2]}}]\n", 0.1, "p");
}

static void few_events_in_a_beat_are_told(void **state) {
    (void)state;
    expect_warnings(SCHOOL_DEFAULTS "time: {end: 3, shedding_interval: 0.0625}\nfish: [{}]\n", 0.5, "v");
    expect_warnings(SCHOOL_DEFAULTS "time: {end: 3, shedding_interval: 0.05}\nfish: [{}]\n", 0.5, "");
}

static void a_soft_body_is_slower_than_its_beat(void **state) {
    (void)state;
    expect_warnings(SCHOOL_DEFAULTS TIME "fish: [{nodes: 33, body: {modulus: 1e5}}]\n", 0.1, "m");
    // any stiffness of a passive body is allowed
    expect_warnings(SCHOOL_DEFAULTS TIME "fish: [{body: {modulus: 1e5}, wave: {amplitude: 0}}]\n", 0.1, "");
}

static void the_worst_fish_is_named(void **state) {
    (void)state;
    // beats of 10 and 5 events, then the other way round; the third one has enough
    static const char *const frequencies[][2] = {{"2", "4"}, {"4", "2"}};
    for (int i = 0; i < 2; i++) {
        char text[512], line[WARNING_BYTES];
        snprintf(text, sizeof text,
                 SCHOOL_DEFAULTS
                 "time: {end: 1, shedding_interval: 0.05}\nfish: [{name: a, wave: {frequency: %s}}, {name: b, wave: "
                 "{frequency: %s}, start: {position: [0, 2]}}, {name: c, start: {position: [0, 4]}}]\n",
                 frequencies[i][0], frequencies[i][1]);
        struct simulation *const simulation = school_simulation(text);
        simulate_measure(simulation);
        assert_true(warnings_line(WARNING_EVENTS, simulation->school, simulation->state, simulation->diagnostics,
                                  simulation->residual->scratch, line));
        assert_non_null(strstr(line, i == 0 ? "b (the worst of 2 fish)" : "a (the worst of 2 fish)"));
        assert_non_null(strstr(line, "only 5 events"));
        simulate_free(simulation);
    }
}

static void few_sheet_points_for_a_short_stretch_are_told(void **state) {
    (void)state;
#define PLATE(n) \
    SCHOOL_DEFAULTS TIME "fish: [{sheet_points: " n ", wave: {frequency: 0}, motion: {prescribed: all, speed: 1}}]\n"
    expect_warnings(PLATE("31"), 0.1, "");
    expect_warnings(PLATE("21"), 0.1, "s");
    // only a free sheet begins with the stretch of an interval
    expect_warnings(
        SCHOOL_DEFAULTS TIME
        "wake: {shedding: continuous}\nfish: [{sheet_points: 21, wave: {frequency: 0}, motion: {prescribed: "
        "all, speed: 1}}]\n",
        0.1, "");
}

static void an_open_energy_balance_is_told(void **state) {
    (void)state;
    // a plate that pitches once in two events: the events do not resolve the power
    expect_warnings(SCHOOL_DEFAULTS
                    "time: {end: 10, shedding_interval: 0.5, output_interval: 0.5}\nfish: [{wave: "
                    "{amplitude: 0}, motion: {prescribed: all, speed: 1, pitch: 10, frequency: 1}}]\n",
                    10, "ev");
}

static void an_open_energy_balance_is_told_within_the_first_beat(void **state) {
    (void)state;
    struct simulation *const simulation = school_simulation(SCHOOL_DEFAULTS TIME "fish: [{start: {speed: 1}}]\n");
    school_run(simulation, 0.5);
    const struct fish *const fish = simulation->school->fish;
    // a fish at 1 m/s, one length per beat: energy of one length per beat m, energy of the body m/2
    double *const work = &simulation->state->balance[0].work[WORK_ALL];
    const double closed = *work;
    *work = closed + 0.008 * fish->total_mass;
    expect_of(simulation, "");
    *work = closed + 0.012 * fish->total_mass;
    expect_of(simulation, "e");
    simulate_free(simulation);
}

// the first interval after a sudden transverse start of a plate; not in the first beat
static void an_open_momentum_balance_is_told(void **state) {
    (void)state;
#define HEAVE(phase)                                                                        \
    SCHOOL_DEFAULTS                                                                         \
    "time: {end: 3, shedding_interval: 0.01}\n"                                             \
    "fish: [{force: pressure, nodes: 9, sheet_points: 33, wave: {amplitude: 0}, "           \
    "body: {profile: uniform, thickness: 0.05}, drag: {skin: laminar}, start: {speed: 1}, " \
    "motion: {prescribed: all, heave: 0.1, frequency: 2, phase: " phase "}}]\n"
    expect_warnings(HEAVE("0"), 0.4, "");
    expect_warnings(HEAVE("0"), 0.6, "o");
    expect_warnings(HEAVE("90"), 0.6, "");
}

static void a_run_that_diverges_in_its_first_beat_says_so(void **state) {
    (void)state;
    struct simulation *const simulation =
        school_simulation(SCHOOL_DEFAULTS TIME "fish: [{}, {start: {position: [0, 2]}}]\n");
    school_run(simulation, 0.1);
    const struct layout *const at = &simulation->school->fish[1].at;
    const double limit = 100 * 2 * 3.14159265358979;  // a hundred times the circular speed of a length per beat
    double *const y = simulation->state->y;
    const double kept[] = {y[at->circulation], y[at->vy + 3]};
    y[at->circulation] = -0.99 * limit;
    expect_of(simulation, "");
    y[at->circulation] = -1.01 * limit;
    expect_of(simulation, "i");
    y[at->circulation] = kept[0];
    // the circulation shed is small again, but the wake contains a large circulation
    simulation->state->wake[1].circulation[2] = 3e5;
    expect_of(simulation, "i");
    simulation->state->wake[1].circulation[2] = 0;
    expect_of(simulation, "");
    y[at->vy + 3] = 1.01 * limit;
    char line[WARNING_BYTES];
    simulate_measure(simulation);
    assert_true(warnings_line(WARNING_DIVERGENCE, simulation->school, simulation->state, simulation->diagnostics,
                              simulation->residual->scratch, line));
    assert_non_null(strstr(line, "fish2 has diverged"));
    y[at->vy + 3] = kept[1];
    simulate_free(simulation);
}

static void speeds_that_the_case_gives_are_no_divergence(void **state) {
    (void)state;
    // a beat of 1 Hz alone would be exceeded a hundred times at 628 m/s, or m2/s
#define REST SCHOOL_DEFAULTS TIME "fluid: {density: 0%s}\nfish: [{wave: {amplitude: 0}, %s}]\n"
    static const struct {
        const char *fluid, *fish;
    } fast[] = {{", velocity: [0, 1e3]", "motion: {prescribed: all, speed: 0}"},
                {", shear: 1e3", "start: {position: [0, 1], heading: 90}, motion: {prescribed: all, speed: 0}"},
                {", gust: {amplitude: 1e3, frequency: 1}", "motion: {prescribed: all, speed: 0}"},
                {"", "start: {speed: 1e3}"},
                {"", "motion: {prescribed: all, heave: 200, frequency: 1}"},
                {"", "motion: {prescribed: all, speed: 1e3}"},
                {"", "load: {tip: [5e5, 0]}, body: {modulus: 1e12}"}};
    double least = INFINITY;
    for (size_t i = 0; i < sizeof fast / sizeof *fast; i++) {
        char text[1024];
        snprintf(text, sizeof text, REST, fast[i].fluid, fast[i].fish);
        struct simulation *const simulation = school_simulation(text);
        school_run(simulation, 0.1);
        simulate_measure(simulation);
        char line[WARNING_BYTES] = "";
        warnings_line(WARNING_DIVERGENCE, simulation->school, simulation->state, simulation->diagnostics,
                      simulation->residual->scratch, line);
        assert_string_equal(line, "");
        const struct layout *const at = &simulation->school->fish[0].at;
        const double *const y = simulation->state->y;
        least = fmin(least, fmax(fabs(y[at->circulation]), hypot(y[at->vx], y[at->vy])));
        simulate_free(simulation);
    }
    assert_true(least > 700);
}

static void a_body_that_crosses_itself_is_told_without_a_fluid_too(void **state) {
    (void)state;
    expect_warnings(SCHOOL_DEFAULTS TIME "fluid: {density: 0}\nfish: [{}]\n", 0.9, "");
    expect_warnings(SCHOOL_DEFAULTS TIME
                    "fluid: {density: 0}\nfish: [{wave: {amplitude: 0.4, constant: 3, linear: 0, quadratic: 0,"
                    " number: 0, ramp: 1}}]\n",
                    0.9, "x");
}

static void separation_at_the_nose_is_told(void **state) {
    (void)state;
#define INCLINED(degrees, more)                                                              \
    SCHOOL_DEFAULTS TIME "fish: [{force: pressure" more                                      \
                         ", wave: {amplitude: 0, frequency: 0}, start: {speed: 1}, motion: " \
                         "{prescribed: all, pitch: " degrees ", pitch_phase: 90}}]\n"
    // A_0 is about half of tan(alpha) after a tenth of a length
    expect_warnings(INCLINED("15", ""), 0.1, "");
    expect_warnings(INCLINED("30", ""), 0.1, "l");
    expect_warnings(INCLINED("30", ", pressure: {suction_limit: 0.35}"), 0.1, "");
    // without limit, or without suction
    expect_warnings(INCLINED("30", ", pressure: {suction_limit: 0}"), 0.1, "");
    expect_warnings(INCLINED("30", ", pressure: {suction: 0}"), 0.1, "");
}

static void bodies_that_pass_through_each_other_are_told(void **state) {
    (void)state;
    // between two rows, and between two steps: without a fluid a prescribed motion needs few
    expect_warnings(
        "time: {end: 3, shedding_interval: 0.05}\nfluid: {density: 0}\ndefaults: {fish: {wave: {amplitude: 0}, motion: "
        "{prescribed: all, "
        "speed: 15}}}\nfish: [{name: a}, {name: b, start: {position: [-6, 0], heading: 0}}]\n",
        1, "c");
    expect_warnings(
        "time: {end: 3, shedding_interval: 0.05}\nfluid: {density: 0}\ndefaults: {fish: {wave: {amplitude: 0}, motion: "
        "{prescribed: all, "
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
        cmocka_unit_test(a_tail_without_a_limit_is_told),
        cmocka_unit_test(few_nodes_at_the_tail_are_told),
        cmocka_unit_test(a_controller_that_chatters_is_told),
        cmocka_unit_test(the_published_force_is_told_and_nothing_else),
        cmocka_unit_test(few_events_in_a_beat_are_told),
        cmocka_unit_test(a_soft_body_is_slower_than_its_beat),
        cmocka_unit_test(the_worst_fish_is_named),
        cmocka_unit_test(few_sheet_points_for_a_short_stretch_are_told),
        cmocka_unit_test(an_open_energy_balance_is_told),
        cmocka_unit_test(an_open_energy_balance_is_told_within_the_first_beat),
        cmocka_unit_test(an_open_momentum_balance_is_told),
        cmocka_unit_test(a_run_that_diverges_in_its_first_beat_says_so),
        cmocka_unit_test(speeds_that_the_case_gives_are_no_divergence),
        cmocka_unit_test(a_body_that_crosses_itself_is_told_without_a_fluid_too),
        cmocka_unit_test(separation_at_the_nose_is_told),
        cmocka_unit_test(bodies_that_pass_through_each_other_are_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
