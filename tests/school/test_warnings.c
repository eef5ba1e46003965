/* test_warnings.c: Each warning appears for cases that have the defect, and for no others. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "body/bending_mode.h"
#include "body/rod.h"
#include "flow/flow_at_bodies.h"
#include "school.h"
#include "school/diagnostics_energy.h"
#include "school/warnings.h"

#define TIME "time: {end: 3, shedding_interval: 0.01}\n"

// ---- which warnings a run has

static int line_of(const struct simulation *simulation, enum warning warning, char line[WARNING_BYTES]) {
    *line = 0;
    return warnings_line(warning, simulation->residual, simulation->state, simulation->diagnostics, line);
}

static void expect_line(const struct simulation *simulation, enum warning warning, const char *part) {
    char line[WARNING_BYTES];
    assert_int_equal(line_of(simulation, warning, line), part != NULL);
    if (part && !strstr(line, part)) fail_msg("'%s' without '%s'", line, part);
}

// the warnings of a simulation, one character each: contact c, a body crosses itself x, divergence i, energy e,
// momentum o, drift d, events v, sheet s, modes m, leading edge l, controller h, place out of reach y, cusp u,
// few nodes at the tail t, published force p, fast pitch f, stalled foil a, a faded wake w; the runs are short,
// and the warning of few beats has its own test
static void expect_of(struct simulation *simulation, const char *expected) {
    simulate_measure(simulation);
    char line[WARNING_BYTES], found[N_WARNINGS + 1] = "";
    for (enum warning w = 0; w < N_WARNINGS; w++) {
        if (w == WARNING_BEATS || !line_of(simulation, w, line)) continue;
        print_message("%s\n", line);
        assert_null(strchr(line, '\n'));
        strncat(found, &"cxieo-dvsmlhyutpfaw"[w], 1);
    }
    assert_string_equal(found, expected);
}

// the warnings of a run up to t
static void expect_warnings(const char *text, double t, const char *expected) {
    struct simulation *const simulation = school_simulation(text);
    school_run(simulation, t);
    expect_of(simulation, expected);
}

TEST(a_short_run_of_a_default_fish_has_none) {
    expect_warnings(TIME "fish: [{}]\n", 1, "");
}

TEST(a_fish_that_gathers_speed_drifts) {
    expect_warnings(TIME "fish: [{}]\n", 2.5, "d");
    // without fluid no fish swims, so a changing speed is no defect
    expect_warnings(TIME "fluid: {density: 0}\nfish: [{}]\n", 2.5, "");
}

TEST(a_tail_without_a_limit_is_told) {
#define CUSP(keys) TIME "fish: [{force: reactive, body: {thickness: 0.2, tail_thickness: 0}, " keys "}]\n"
    expect_warnings(CUSP("nodes: 25"), 0.1, "u");
    // for any number of nodes; not if the tail does not bend
    expect_warnings(CUSP("nodes: 61, sheet_points: 121"), 0.02, "u");
    expect_warnings(CUSP("motion: {prescribed: all}"), 0.1, "");
    expect_warnings(TIME "fluid: {density: 0}\nfish: [{body: {tail_thickness: 0}}]\n", 0.1, "");
}

TEST(few_nodes_at_the_tail_are_told) {
    // (EI/(m_L omega^2))^(1/4) of a uniform body, 0.1 by 0.25, 1e7 Pa, 2 Hz
    const double pi = acos(-1), EI = 1e7 * pi * 0.25 * 1e-3 / 64, m = 1000 * pi * 0.0625 / 4, omega = 4 * pi;
    const double length = pow(EI / (m * omega * omega), 0.25);
    const int enough = (int)ceil(2 / length) + 1;
    for (int n = enough - 1; n <= enough; n++) {
        char text[256];
        snprintf(text, sizeof text,
                 TIME
                 "fish: [{force: reactive, nodes: %d, body: {profile: uniform, thickness: 0.1, modulus: 1e7}, wave: "
                 "{frequency: 2}}]\n",
                 n);
        expect_warnings(text, 0.01, n < enough ? "t" : "");
    }
}

TEST(a_controller_that_chatters_is_told) {
    // a stiff body under a large damping: each beat of the course has more than four reversals
#define STEERED(keys)                                                                                            \
    "time: {end: 8, shedding_interval: 0.02}\n"                                                                  \
    "fish: [{force: reactive, start: {speed: 0.9}, wave: {amplitude: 0.7}, body: {thickness: 0.2, depth: 0.25, " \
    "modulus: 1.0e+7},\n"                                                                                        \
    "  control: {law: course, " keys "desired_heading: [[0, 180], [3, 180], [3.1, 120]]}}]\n"
    expect_warnings(STEERED("slow: 0, course_filter: 0, damping: 2, "), 7, "dh");
    // the defaults turn and hold the course without
    expect_warnings(STEERED(""), 4, "d");
    expect_warnings(STEERED(""), 7, "d");
}

TEST(the_published_force_is_told_and_nothing_else) {
    // few events, energy balance, drift, cusp: all suppressed for the published force
    expect_warnings("time: {end: 3, shedding_interval: 0.0625}\npreset: published\nfish: [{}]\n", 2.5, "p");
    expect_warnings(TIME "fish: [{force: published}, {start: {position: [0, 2]}}]\n", 0.1, "p");
}

TEST(few_events_in_a_beat_are_told) {
    expect_warnings("time: {end: 3, shedding_interval: 0.0625}\nfish: [{}]\n", 0.5, "v");
    expect_warnings("time: {end: 3, shedding_interval: 0.05}\nfish: [{}]\n", 0.5, "");
}

TEST(a_soft_body_is_slower_than_its_beat) {
    expect_warnings(TIME "fish: [{nodes: 33, body: {modulus: 1e5}}]\n", 0.1, "m");
    // any stiffness of a passive body is allowed
    expect_warnings(TIME "fish: [{body: {modulus: 1e5}, wave: {amplitude: 0}}]\n", 0.1, "");
}

TEST(the_worst_fish_is_named) {
    // beats of 10 and 5 events, then the other way round; the third one has enough
    static const char *const frequencies[][2] = {{"2", "4"}, {"4", "2"}};
    for (int i = 0; i < 2; i++) {
        char line[WARNING_BYTES];
        struct simulation *const simulation = school_simulation_of(
            "time: {end: 1, shedding_interval: 0.05}\nfish: [{name: a, wave: {frequency: %s}}, {name: b, wave: "
            "{frequency: %s}, start: {position: [0, 2]}}, {name: c, start: {position: [0, 4]}}]\n",
            frequencies[i][0], frequencies[i][1]);
        simulate_measure(simulation);
        assert_true(line_of(simulation, WARNING_EVENTS, line));
        assert_non_null(strstr(line, i == 0 ? "b (the worst of 2 fish)" : "a (the worst of 2 fish)"));
        assert_non_null(strstr(line, "only 5 events"));
    }
}

TEST(few_sheet_points_for_a_short_stretch_are_told) {
#define PLATE(n) \
    TIME "fish: [{force: reactive, sheet_points: " n ", wave: {frequency: 0}, motion: {prescribed: all, speed: 1}}]\n"
    expect_warnings(PLATE("31"), 0.1, "");
    expect_warnings(PLATE("21"), 0.1, "s");
    // only a free sheet begins with the stretch of an interval
    expect_warnings(
        TIME
        "wake: {shedding: continuous}\nfish: [{sheet_points: 21, wave: {frequency: 0}, motion: {prescribed: "
        "all, speed: 1}}]\n",
        0.1, "");
}

TEST(an_open_energy_balance_is_told) {
    // a plate that pitches once in two events: the events do not resolve the power
    expect_warnings(
        "time: {end: 10, shedding_interval: 0.5, output_interval: 0.5}\nfish: [{force: reactive, wave: "
        "{amplitude: 0}, motion: {prescribed: all, speed: 1, pitch: 10, frequency: 1}}]\n",
        10, "evf");
}

TEST(an_open_energy_balance_is_told_within_the_first_beat) {
    struct simulation *const simulation = school_simulation(TIME "fish: [{start: {speed: 1}}]\n");
    school_run(simulation, 0.5);
    const struct fish *const fish = simulation->school->fish;
    // a fish at 1 m/s, one length per beat: energy of one length per beat m, energy of the body m/2
    double *const work = &simulation->state->balance[0].work[WORK_ALL];
    const double closed = *work;
    *work = closed + 0.008 * fish->total_mass;
    expect_of(simulation, "");
    *work = closed + 0.012 * fish->total_mass;
    expect_of(simulation, "e");
}

// the first interval after a sudden transverse start of a plate; 8 % of the exchange are no warning in the first beat
TEST(an_open_momentum_balance_is_told) {
#define HEAVE(phase)                                                                                          \
    "time: {end: 3, shedding_interval: 0.01}\n"                                                               \
    "fish: [{force: pressure, pressure: {span: infinite}, nodes: 9, sheet_points: 33, wave: {amplitude: 0}, " \
    "body: {profile: uniform, thickness: 0.05}, drag: {skin: laminar}, start: {speed: 1}, "                   \
    "motion: {prescribed: all, heave: 0.1, frequency: 2, phase: " phase "}}]\n"
    expect_warnings(HEAVE("0"), 0.4, "");
    expect_warnings(HEAVE("0"), 0.6, "o");
    expect_warnings(HEAVE("90"), 0.6, "");
}

TEST(a_run_that_diverges_in_its_first_beat_says_so) {
    struct simulation *const simulation = school_simulation(TIME "fish: [{}, {start: {position: [0, 2]}}]\n");
    school_run(simulation, 0.1);
    const struct layout *const at = &simulation->school->fish[1].at;
    const double limit = 100 * 2 * 3.14159265358979;  // a hundred times the circular speed of a length per beat
    double *const y = simulation->state->y;
    const double kept[] = {y[at->circulation], y[at->vy + 3]};
    // circulations from nowhere open the momentum balance too
    y[at->circulation] = -0.99 * limit;
    expect_of(simulation, "o");
    y[at->circulation] = -1.01 * limit;
    expect_of(simulation, "io");
    y[at->circulation] = kept[0];
    // the circulation shed is small again, but the wake contains a large circulation
    simulation->state->wake[1].circulation[2] = -3e5;
    expect_of(simulation, "io");
    simulation->state->wake[1].circulation[2] = 0;
    expect_of(simulation, "");
    y[at->vy + 3] = 1.01 * limit;
    simulate_measure(simulation);
    expect_line(simulation, WARNING_DIVERGENCE, "fish2 has diverged");
    y[at->vy + 3] = kept[1];
    // a vortex that flies away
    double *const u = &simulation->state->wake[1].u[1];
    *u = -0.99 * limit;
    expect_line(simulation, WARNING_DIVERGENCE, NULL);
    *u = -1.01 * limit;
    expect_line(simulation, WARNING_DIVERGENCE, "fish2 has diverged: at t = 0.1 s a node or vortex has 6.3e+02 m/s");
}

TEST(a_foil_with_two_events_a_beat_whose_vortices_fly_away_has_diverged) {
    struct simulation *const simulation = school_simulation(
        "time: {end: 1, shedding_interval: 0.02}\n"
        "fish: [{nodes: 9, force: pressure, motion: {prescribed: all, speed: 1, heave: 0.2, frequency: 25}}]\n");
    school_measure(simulation, 1);
    // impulses that only vortices outside of every picture have: the bodies move as the case says
    BELOW(1e9, fabs(simulation->diagnostics->fish[0].fluid_impulse[0]));
    expect_line(simulation, WARNING_DIVERGENCE, "fish1 has diverged");
}

TEST(speeds_that_the_case_gives_are_no_divergence) {
    // a beat of 1 Hz alone would be exceeded a hundred times at 628 m/s, or m2/s
#define REST TIME "fluid: {density: 0%s}\nfish: [{force: reactive, wave: {amplitude: 0}, %s}]\n"
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
        struct simulation *const simulation = school_simulation_of(REST, fast[i].fluid, fast[i].fish);
        school_measure(simulation, 0.1);
        expect_line(simulation, WARNING_DIVERGENCE, NULL);
        const struct layout *const at = &simulation->school->fish[0].at;
        const double *const y = simulation->state->y;
        least = fmin(least, fmax(fabs(y[at->circulation]), hypot(y[at->vx], y[at->vy])));
    }
    ABOVE(least, 700);
}

TEST(a_body_that_crosses_itself_is_told_without_a_fluid_too) {
    expect_warnings(TIME "fluid: {density: 0}\nfish: [{}]\n", 0.9, "");
    expect_warnings(TIME
                    "fluid: {density: 0}\nfish: [{wave: {amplitude: 0.4, constant: 3, linear: 0, quadratic: 0,"
                    " number: 0, ramp: 1}}]\n",
                    0.9, "x");
}

TEST(separation_at_the_nose_is_told) {
#define INCLINED(degrees, more)                                               \
    TIME "fish: [{force: pressure, pressure: {span: infinite" more            \
         "}, wave: {amplitude: 0, frequency: 0}, start: {speed: 1}, motion: " \
         "{prescribed: all, pitch: " degrees ", pitch_phase: 90}}]\n"
    // A_0 is about half of tan(alpha) after a tenth of a length
    expect_warnings(INCLINED("15", ""), 0.1, "");
    expect_warnings(INCLINED("30", ""), 0.1, "l");
    expect_warnings(INCLINED("30", ", suction_limit: 0.35"), 0.1, "");
    // without limit, or without suction
    expect_warnings(INCLINED("30", ", suction_limit: 0"), 0.1, "");
    expect_warnings(INCLINED("30", ", suction: 0"), 0.1, "");
}

TEST(bodies_that_pass_through_each_other_are_told) {
    // between two rows, and between two steps: without a fluid a prescribed motion needs few
    expect_warnings(
        "time: {end: 3, shedding_interval: 0.05}\nfluid: {density: 0}\ndefaults: {fish: {nodes: 7, wave: {amplitude: "
        "0}, motion: "
        "{prescribed: all, speed: 15}}}\nfish: [{name: a}, {name: b, start: {position: [-6, 0], heading: 0}}]\n",
        1, "c");
    expect_warnings(
        "time: {end: 3, shedding_interval: 0.05}\nfluid: {density: 0}\ndefaults: {fish: {nodes: 7, wave: {amplitude: "
        "0}, motion: "
        "{prescribed: all, speed: 15}}}\nfish: [{name: a}, {name: b, start: {position: [-6, 1], heading: 0}}]\n",
        1, "");
    // bodies that could yield, and that the case lets pass: near each other, and through each other
    expect_warnings(
        TIME
        "fluid: {density: 0}\ncontact: {action: warn}\ndefaults: {fish: {nodes: 7, wave: {amplitude: 0}, body: "
        "{profile: uniform, thickness: 0.1}}}\nfish: [{}, {start: {position: [0, 0.119]}}]\n",
        0.05, "c");
    expect_warnings(
        TIME
        "fluid: {density: 0}\ncontact: {action: warn}\ndefaults: {fish: {nodes: 7, wave: {amplitude: 0}}}\nfish: "
        "[{start: {speed: 10}}, {start: {position: [-0.5, 0.5], heading: 90, speed: -10}}]\n",
        0.2, "c");
}

// ---- the limits, with values of the diagnostics that no run gave

TEST(a_run_shorter_than_two_beats_has_no_means_of_a_cycle) {
    // the slowest fish decides
    struct simulation *simulation =
        school_simulation(TIME
                          "fish: [{force: reactive, wave: {frequency: 20}}, {force: reactive, wave: {frequency: 10}, "
                          "start: {position: [0, 2]}}]\n");
    expect_line(simulation, WARNING_BEATS, NULL);  // no run
    school_run(simulation, 0.15);
    expect_line(simulation, WARNING_BEATS,
                "the run has 1.5 beats of fish2: means and powers are not those of a cycle; "
                "increase time.end to at least 0.2 s");
    school_run(simulation, 0.2);
    expect_line(simulation, WARNING_BEATS, NULL);

    // a plate that does not oscillate has no cycle
    simulation = school_simulation(TIME "fish: [{force: reactive, motion: {prescribed: all, speed: 1}}]\n");
    school_run(simulation, 0.05);
    expect_line(simulation, WARNING_BEATS, NULL);
}

TEST(the_limits_are_those_of_the_manual) {
    struct simulation *const simulation =
        school_simulation(TIME
                          "fish: [{force: pressure, pressure: {span: infinite}, wave: {frequency: 0.5}}, {force: "
                          "reactive, start: {position: [0, 2]}}]\n");
    school_measure(simulation, 0.02);
    struct diagnostics_fish *const now = &simulation->diagnostics->fish[0];
    // 1 %, of a gain and of a loss
    static const double drift[] = {0.0099, -0.0099, 0.0101, -0.0101};
    for (int i = 0; i < 4; i++) {
        now->drift = drift[i];
        expect_line(simulation, WARNING_DRIFT, i < 2 ? NULL : "changes by");
    }
    // a tenth of a period, at a change of the speed below 10 %
    now->separation_share = 0.099;
    expect_line(simulation, WARNING_EDGE, NULL);
    now->separation_share = 0.101;
    expect_line(simulation, WARNING_EDGE, "for 10 % of the last period");
    now->drift = 0.099;
    expect_line(simulation, WARNING_EDGE, "for 10 % of the last period");
    now->drift = -0.101;
    expect_line(simulation, WARNING_EDGE, NULL);
    now->bias_reversals = 4;
    expect_line(simulation, WARNING_CHATTER, NULL);
    now->bias_reversals = 5;
    expect_line(simulation, WARNING_CHATTER, "reverses 5 times");
    // 98 % of the limit of the amplitude, of a fish that holds a place
    struct control_law_data *const control = &simulation->school->fish[0].control;
    simulation->state->control[0].drive = 0.395;
    expect_line(simulation, WARNING_PLACE, NULL);
    const enum control_law law = control->law;
    control->law = CONTROL_PLACE;
    control->amplitude_limit = 0.4;
    expect_line(simulation, WARNING_PLACE, "needs 1.4 times its amplitude");
    simulation->state->control[0].drive = -0.391;
    expect_line(simulation, WARNING_PLACE, NULL);
    control->law = law;
    // 1 % of the largest term, after a beat of the slowest fish, of 2 s
    struct diagnostics *const all = simulation->diagnostics;
    all->momentum_size = 3;
    all->momentum_balance[0] = all->momentum_balance[1] = 0.0301 / sqrt(2);
    simulation->state->t = 2.01;
    expect_line(simulation, WARNING_MOMENTUM, "0.03 N s for 3 N s");
    simulation->state->t = 1.99;
    expect_line(simulation, WARNING_MOMENTUM, NULL);

    // in the first beat 20 % of the largest term, or of the momentum at one length per beat
    const struct fish *const bodies = simulation->school->fish;
    const double usual = 0.5 * bodies[0].total_mass + 1 * bodies[1].total_mass;
    all->momentum_size = 2 * usual;
    all->momentum_balance[0] = all->momentum_balance[1] = 0.39 * usual / sqrt(2);
    expect_line(simulation, WARNING_MOMENTUM, NULL);
    all->momentum_balance[0] = all->momentum_balance[1] = 0.41 * usual / sqrt(2);
    expect_line(simulation, WARNING_MOMENTUM, "momentum balance: residual");
    all->momentum_size = 0;
    all->momentum_balance[0] = all->momentum_balance[1] = 0.19 * usual / sqrt(2);
    expect_line(simulation, WARNING_MOMENTUM, NULL);
    all->momentum_balance[0] = all->momentum_balance[1] = 0.21 * usual / sqrt(2);
    expect_line(simulation, WARNING_MOMENTUM, "for 0 N s");
    all->momentum_size = 3;
    simulation->state->t = 2.01;
    all->momentum_balance[0] = all->momentum_balance[1] = 0.0299 / sqrt(2);
    expect_line(simulation, WARNING_MOMENTUM, NULL);
}

TEST(the_energy_balance_is_compared_with_the_largest_work) {
    struct simulation *const simulation = school_simulation(TIME "fish: [{}]\n");
    simulate_measure(simulation);
    struct diagnostics_fish *const now = &simulation->diagnostics->fish[0];
    double *const work = simulation->state->balance[0].work;
    simulation->state->t = 1.5;
    now->kinetic_energy = 100;
    work[1] = 1;
    work[0] = -3;
    now->energy_balance = -0.0299;
    expect_line(simulation, WARNING_ENERGY, NULL);
    now->energy_balance = -0.0301;
    expect_line(simulation, WARNING_ENERGY, "-0.03 J for 3 J of work");
    // rounding of the energy of a body that does no work
    for (int i = 0; i < N_WORKS; i++) work[i] = 0;
    work[N_WORKS - 1] = 1e-9;
    now->energy_balance = 0.5e-10;
    expect_line(simulation, WARNING_ENERGY, NULL);
    now->energy_balance = 1.5e-10;
    expect_line(simulation, WARNING_ENERGY, "energy balance of fish1");
    work[N_WORKS - 1] = 0;
    // no part of nothing
    now->energy_balance = 1;
    expect_line(simulation, WARNING_ENERGY, NULL);
}

TEST(the_advice_is_enough) {
    // 3.2/sqrt(U Dt/L) = 32: 33 points are enough, 0.9 of 32 edges are allowed, and 29 edges are the first such number
    struct simulation *const simulation = school_simulation(TIME "fish: [{force: reactive, sheet_points: 29}]\n");
    school_measure(simulation, 0.02);
    struct fish *const fish = &simulation->school->fish[0];
    struct diagnostics_fish *const now = &simulation->diagnostics->fish[0];
    now->speed = 0.999999;
    now->drift = 0.099;
    expect_line(simulation, WARNING_SHEET, "use 34 sheet_points");
    now->drift = -0.101;
    expect_line(simulation, WARNING_SHEET, NULL);
    now->drift = 0;
    now->speed = 1.000001;
    expect_line(simulation, WARNING_SHEET, "use 33 sheet_points");
    fish->n_sheet = 30;
    expect_line(simulation, WARNING_SHEET, NULL);
    fish->n_sheet = 29;
    // a fish that needs more than 1000 points does not swim
    now->speed = 1e-3;
    expect_line(simulation, WARNING_SHEET, NULL);

    // edges of half the bending length, over 1 m
    const double length = warnings_bending_length(fish), enough = ceil(2 / length);
    char words[64];
    snprintf(words, sizeof words, "use at least %.0f nodes", enough + 1);
    fish->edge_length = 1 / (enough - 1);
    expect_line(simulation, WARNING_TAIL, words);
    fish->edge_length = 1 / enough;
    expect_line(simulation, WARNING_TAIL, NULL);

    // 16 events in a beat of 0.16 s, of which 20 take 0.008 s each
    fish->period = 0.16;
    expect_line(simulation, WARNING_EVENTS, "only 16 events: reduce time.shedding_interval to 0.008 s for 20 events");
}

TEST(a_mode_is_slow_below_the_frequency_of_the_beat) {
    struct simulation *const simulation = school_simulation(TIME "fish: [{}]\n");
    simulate_measure(simulation);
    struct fish *const fish = &simulation->school->fish[0];
    const double slowest = bending_mode_frequency(fish, simulation->residual->scratch);
    fish->frequency = 0.99 * slowest;
    expect_line(simulation, WARNING_MODES, NULL);
    fish->frequency = 1.01 * slowest;
    expect_line(simulation, WARNING_MODES, "the slowest bending mode of fish1");
}

TEST(a_small_gap_is_told_where_nothing_repels) {
    static const char *const actions[] = {"repel", "warn"};
    for (int warns = 0; warns < 2; warns++) {
        struct simulation *const simulation = school_simulation_of(
            TIME "contact: {action: %s}\nfish: [{name: a}, {start: {position: [0, 2]}, name: b}]\n", actions[warns]);
        struct closest *const closest = simulation->state->closest;
        closest->fish[0] = 1;
        closest->fish[1] = 0;
        closest->t = 0.7;
        closest->distance = 0.99 * simulation->school->contact_range;
        expect_line(simulation, WARNING_CONTACT, warns ? "b and a come within" : NULL);
        closest->distance = 1.01 * simulation->school->contact_range;
        expect_line(simulation, WARNING_CONTACT, NULL);
        closest->distance = 0;
        expect_line(simulation, WARNING_CONTACT,
                    warns ? "b and a touch or cross at t = 0.7 s: later results are invalid; set contact.action: repel"
                          : "b and a touch or cross at t = 0.7 s: later results are invalid");
    }
}

TEST(divergence_is_a_hundred_times_the_speeds_of_the_case) {
    // a length of 2 m: a pitch of 90 degrees at 3 Hz, and the free acceleration by a load of 50 N for 8 s
    static const char *const texts[] = {
        "fish: [{length: 2, wave: {amplitude: 0, frequency: 0}, motion: {prescribed: all, speed: 0, pitch: 90, "
        "frequency: 3}}]\n",
        "fish: [{length: 2, wave: {amplitude: 0, frequency: 0}, load: {tip: [30, 40]}}]\n"};
    for (int i = 0; i < 2; i++) {
        struct simulation *const simulation = school_simulation_of(TIME "fluid: {density: 0}\n%s", texts[i]);
        simulate_measure(simulation);
        simulation->state->t = 8;
        const struct fish *const fish = &simulation->school->fish[0];
        const double pi = acos(-1), beat = 2 * pi * 2 * fish_rate(simulation->school, fish);
        const double more = i == 0 ? 6 * pi * pi / 2 * 2 : 50 * 8 / fish->total_mass;
        double *const circulation = &simulation->state->y[fish->at.circulation];
        // over the length
        *circulation = -0.999 * 100 * (beat + more) * 2;
        expect_line(simulation, WARNING_DIVERGENCE, NULL);
        *circulation = -1.001 * 100 * (beat + more) * 2;
        expect_line(simulation, WARNING_DIVERGENCE, "fish1 has diverged");
    }
}

TEST(the_worst_divergence_of_all_events_is_kept) {
    struct simulation *const simulation = school_simulation(TIME "fish: [{}, {start: {position: [0, 2]}}]\n");
    school_measure(simulation, 0.1);
    struct state *const now = simulation->state;
    double *const shed = &now->y[simulation->school->fish[1].at.circulation], kept = *shed;
    const double limit = 100 * 2 * acos(-1);
    static const double share[] = {1.5, 3, 2};
    for (int i = 0; i < 3; i++) {
        *shed = -share[i] * limit;
        warnings_divergence(simulation->school, now, now->divergence, &now->diverged);
        now->t += 0.01;
    }
    *shed = kept;
    expect_line(simulation, WARNING_DIVERGENCE, "fish2 has diverged: at t = 0.11 s");
    expect_line(simulation, WARNING_DIVERGENCE, "circulation 1.9e+03 m2/s");

    // rows that begin later have their own divergence
    diagnostics_restart(simulation->residual, simulation->state);
    expect_line(simulation, WARNING_DIVERGENCE, NULL);
    *shed = INFINITY;
    expect_line(simulation, WARNING_DIVERGENCE, "fish2 has diverged");
    *shed = NAN;
    expect_line(simulation, WARNING_DIVERGENCE, "fish2 has diverged");
}

TEST(a_balance_that_is_not_finite_is_open_and_no_row) {
    static const double broken[] = {NAN, INFINITY, -INFINITY};
    struct simulation *const simulation = school_simulation(TIME "fish: [{}]\n");
    simulate_measure(simulation);
    simulation->state->t = 1.5;
    struct diagnostics *const all = simulation->diagnostics;
    const struct school *const school = simulation->school;
    simulation->state->event = 150;
    school_ok(warnings_refuse(school, simulation->state, all));
    for (int i = 0; i < 3; i++) {
        const double energy = all->fish[0].energy_balance, momentum = all->momentum_balance[i];
        all->fish[0].energy_balance = broken[i];
        expect_line(simulation, WARNING_ENERGY, "energy balance of fish1");
        assert_int_equal(warnings_refuse(school, simulation->state, all), STATUS_SOLVER);
        assert_non_null(strstr(status_message(), "diverged at t = 1.5 s: the energy balance of fish1 is "));
        all->fish[0].energy_balance = energy;

        all->momentum_balance[i] = broken[i];
        if (i < 2) expect_line(simulation, WARNING_MOMENTUM, "momentum balance");
        assert_int_equal(warnings_refuse(school, simulation->state, all), STATUS_SOLVER);
        assert_non_null(strstr(status_message(), "diverged at t = 1.5 s: the momentum balance is "));
        all->momentum_balance[i] = momentum;
    }
    double *const work = simulation->state->balance[0].work, kept = work[WORK_FLUID];
    work[WORK_FLUID] = NAN;
    expect_line(simulation, WARNING_ENERGY, "energy balance of fish1");
    assert_int_equal(warnings_refuse(school, simulation->state, all), STATUS_SOLVER);
    assert_non_null(strstr(status_message(), "of 'balance.work' is nan"));
    work[WORK_FLUID] = kept;

    // strips of different depths have no momentum balance
    struct simulation *const unequal =
        school_simulation(TIME "fish: [{force: reactive}, {force: reactive, start: {position: [0, 2]}}]\n");
    simulate_measure(unequal);
    assert_true(isnan(unequal->diagnostics->momentum_balance[0]));
    school_ok(warnings_refuse(unequal->school, unequal->state, unequal->diagnostics));
    unequal->state->t = 5;
    expect_line(unequal, WARNING_MOMENTUM, NULL);
}

// a plate with the motion of cases/foil_anderson.yaml and this largest speed of the tail by pitch, over its speed
// through the water: at rest, and in a stream that carries it along its way or back
static int warns_of_pitch_in(const char *stream, double heading, double speed, double ratio, const char *motion) {
    char line[WARNING_BYTES];
    // the pivot is two thirds of the chord before the tail
    const double pitch = ratio * 5.392165 / (2 * M_PI * 2 / 3) * 180 / M_PI;
    struct simulation *const simulation = school_simulation_of(
        "time: {end: 1, shedding_interval: 0.01}\nfluid: {density: 1, viscosity: 1.348e-4, velocity: %s}\n"
        "fish: [{force: pressure, pressure: {span: infinite}, start: {heading: %g, speed: %.8g}, wave: {amplitude: 0, "
        "frequency: 0},\n  body: {profile: uniform, thickness: 0.12}, motion: {%s, pitch: %.17g, "
        "pivot: 0.333333333, frequency: 1}}]\n",
        stream, heading, speed, motion, pitch);
    school_measure(simulation, 0.02);
    const int warns = line_of(simulation, WARNING_PITCH, line);
    if (warns) assert_non_null(strstr(line, "0.6"));
    return warns;
}

static int warns_of_pitch(double ratio, const char *motion) {
    const int warns = warns_of_pitch_in("[0, 0]", 180, 5.392165, ratio, motion);
    if (!strstr(motion, "surge")) assert_int_equal(warns_of_pitch_in("[0, 2]", 90, 7.392165, ratio, motion), warns);
    assert_int_equal(warns_of_pitch_in("[2, 0]", 180, 3.392165, ratio, motion), warns);
    return warns;
}

TEST(a_pitch_beyond_attached_flow_is_told) {
    const char *const prescribed = "prescribed: all, heave: 0.75, pitch_phase: 90";
    // foil_anderson, and the largest ratio with a power within 12 % of the experiments
    assert_false(warns_of_pitch(0.3546, prescribed));
    assert_false(warns_of_pitch(0.599, prescribed));
    // powers from 9 to 145 % too large
    assert_true(warns_of_pitch(0.65, prescribed));
    assert_true(warns_of_pitch(1.4, prescribed));
    // the tail of a bending body moves by itself
    assert_false(warns_of_pitch(0.65, "prescribed: head"));
    // free in surge: not before the speed is steady
    assert_false(warns_of_pitch(1.4, "prescribed: all, surge: free"));
}

TEST(a_stalled_foil_is_told) {
    struct simulation *const simulation =
        school_simulation(TIME "fish: [{motion: {prescribed: all, surge: free, heave: 0.1, frequency: 1}}]\n");
    school_run(simulation, 0.02);
    static const struct {
        double drift, share;
        int warns;
    } cases[] = {{0.2, 0.6, 1}, {-0.2, 0.6, 1}, {0.09, 0.9, 0}, {0.9, 0.45, 0}, {NAN, 0.9, 0}, {0.2, NAN, 0}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        simulate_measure(simulation);
        simulation->diagnostics->fish[0].drift = cases[i].drift;
        simulation->diagnostics->fish[0].separation_share = cases[i].share;
        expect_line(simulation, WARNING_STALL, cases[i].warns ? "60 %" : NULL);
    }
}

// ---- a follower in the decaying part of a wake

#define LEADER_AND_FOLLOWER                                                                                        \
    "time: {end: 3, shedding_interval: 0.02}\nwake: {%s}\ndefaults: {fish: {%s, nodes: 9, start: {speed: 0.8}}}\n" \
    "fish: [{name: leader}, {name: follower, start: {position: [%s]}}]\n"

TEST(a_follower_in_a_faded_wake_is_told) {
    static const char *const finite = "force: pressure", *const infinite = "pressure: {span: infinite}",
                             *const reactive = "force: reactive";
    static const struct {
        const char *wake, *fish, *place, *part;
    } cases[] = {
        {"lifetime: 3, decay: 2.25", finite, "1.5, 0", "follower lies in the decaying part"},
        {"lifetime: 3, decay: 2.25", infinite, "1.5, 0.05", "follower lies in the decaying part"},
        {"lifetime: 3, decay: 2.25", reactive, "1.5, 0", "follower lies in the decaying part"},
        // an older part decays; the wake lies beside; the whole wake
        {"lifetime: 2.5, decay: 0.5", finite, "1.3, 0", NULL},
        {"lifetime: 3, decay: 2.25", finite, "1.5, 0.9", NULL},
        {"lifetime: 8, decay: 2", finite, "1.5, 0", NULL},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct simulation *const simulation =
            school_simulation_of(LEADER_AND_FOLLOWER, cases[i].wake, cases[i].fish, cases[i].place);
        school_measure(simulation, 2.5);
        expect_line(simulation, WARNING_WAKE, cases[i].part);
    }
}

// a fish that crosses the wake of the first one, whose part older than .75 beats decays
#define LEADER_AND_CROSSING                                                       \
    "time: {end: 5, shedding_interval: 0.02}\nwake: {lifetime: 3, decay: 2.25}\n" \
    "defaults: {fish: {force: reactive, nodes: 9, start: {speed: 0.8}}}\n"        \
    "fish: [{name: leader}, {name: crossing, start: {position: [0.3, -1.5], heading: 90}}]\n"

TEST(a_faded_wake_in_the_middle_of_a_run_is_told_at_its_end) {
    struct simulation *const simulation = school_simulation(LEADER_AND_CROSSING);
    school_measure(simulation, 1);
    expect_line(simulation, WARNING_WAKE, NULL);

    // the fish crosses, and the run ends a length beside the wake
    school_measure(simulation, 4.6);
    expect_line(simulation, WARNING_WAKE, "crossing lies in the decaying part of another wake at t = ");
    assert_true(simulation->state->fading[FADING_T] < 4);

    // without what the run has remembered, the end alone says nothing, as in rows that begin later
    diagnostics_restart(simulation->residual, simulation->state);
    expect_line(simulation, WARNING_WAKE, NULL);
}

TEST(looking_for_faded_wakes_changes_no_bit) {
    struct simulation *const often = school_simulation(LEADER_AND_CROSSING), *const once =
                                                                                 school_simulation(LEADER_AND_CROSSING);
    struct state *const looked = often->state;
    for (int i = 0; i < 120; i++) {
        assert_int_equal(simulate_step(often), STATUS_OK);
        assert_int_equal(simulate_step(once), STATUS_OK);
        warnings_fading(often->residual, looked, looked->fading, &looked->faded);
    }
    assert_true(looked->fading[FADING_PART] > once->state->fading[FADING_PART]);
    const size_t bytes = (size_t)often->school->n_unknowns * sizeof(double);
    assert_memory_equal(looked->y, once->state->y, bytes);
    assert_memory_equal(looked->momentum, once->state->momentum, 2 * sizeof *looked->momentum);
}

TEST(the_lost_velocity_is_that_of_the_lost_circulation) {
    struct simulation *const simulation = school_simulation_of(LEADER_AND_FOLLOWER, "lifetime: 3, decay: 2.25",
                                                               "pressure: {span: infinite}", "1.5, 0.05");
    school_measure(simulation, 2.5);
    double part[2];
    flow_find_decayed(simulation->residual->flow, simulation->state, part);
    NEAR(part[0], 0, 0, 0);

    // every marker has half of both adjacent stretches, in place of the forms of old stretches; the sum at the nodes is
    // not that at the control points: within a tenth
    const struct school *const school = simulation->school;
    const struct fish *const fish = &school->fish[1];
    const struct wake *const wake = &simulation->state->wake[0];
    const double *const y = simulation->state->y, e = fish->smoothing;
    double lost_square = 0, square = 0;
    for (int k = 0; k < fish->n_nodes; k++) {
        double lost[2] = {0, 0}, whole[2] = {0, 0};
        for (int i = 0; i < wake->n_vortex; i++) {
            const double r[2] = {y[fish->at.x + k] - wake->x[i], y[fish->at.y + k] - wake->y[i]};
            const double q = wake_circulation(wake, i) / (2 * M_PI * (r[0] * r[0] + r[1] * r[1] + e * e));
            const double gone = 1 - wake_strength(school, simulation->state->t - wake->birth[i]);
            for (int j = 0; j < 2; j++) {
                whole[j] += q * r[j];
                lost[j] += gone * q * r[j];
            }
        }
        lost_square += lost[0] * lost[0] + lost[1] * lost[1];
        square += whole[0] * whole[0] + whole[1] * whole[1];
    }
    NEAR(part[1], sqrt(lost_square / square), 0.1, 0);
    assert_true(part[1] > 0.1);
}
