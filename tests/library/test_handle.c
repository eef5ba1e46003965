/* test_handle.c: A program that uses the library sets the beat, the course and the place of a fish while it swims
 * (doc/python.md, section 2). */
#include <stdio.h>
#include <string.h>

#include "fish/fish_gait.h"
#include "library/handle.h"
#include "school.h"

#define TIME "time: {end: 2, shedding_interval: 0.02}\n"
#define SMALL TIME "defaults: {fish: {nodes: 7}}\n"

static void set(const struct simulation *simulation, const char *key, double value) {
    school_ok(handle_set_key(simulation, 0, key, 1, &value));
}

TEST(the_phase_of_the_beat_is_continuous) {
    struct simulation *const simulation = school_simulation(SMALL "fish: [{control: {ramp: 0.2}}]\n");
    school_run(simulation, 0.6);
    const struct fish *const fish = simulation->school->fish;
    const struct control_memory *const memory = simulation->state->control;
    const struct fish_gait before = control_gait(fish, memory, 0.6, 0);
    set(simulation, "wave.frequency", 2);
    const struct fish_gait after = control_gait(fish, memory, 0.6, 0), later = control_gait(fish, memory, 1, 0);
    const double pi = acos(-1);
    NEAR(after.angle, before.angle, 1e-14, 0);
    NEAR(after.omega, before.omega, 1e-14, 0);
    NEAR(later.omega, 2 * pi * 2, 1e-13, 0);
    // half of the ramp counts with the new frequency
    NEAR(later.angle, 2 * pi * (0.6 + 0.1 + 2 * 0.3), 1e-13, 0);
}

TEST(amplitude_and_bias_get_there_within_the_ramp) {
    struct simulation *const simulation =
        school_simulation(SMALL "fish: [{wave: {amplitude: 0.4, ramp: 0}, control: {ramp: 0.2, bias: 0.1}}]\n");
    school_run(simulation, 0.6);
    const struct fish *const fish = simulation->school->fish;
    set(simulation, "wave.amplitude", 0.2);
    set(simulation, "control.bias", -0.3);
    NEAR(control_gait(fish, simulation->state->control, 0.6, 0).amplitude, 1, 0, 0);
    NEAR(control_gait(fish, simulation->state->control, 0.7, 0).amplitude, 0.75, 1e-14, 0);
    NEAR(control_gait(fish, simulation->state->control, 0.8, 0).amplitude, 0.5, 0, 1e-15);
    school_run(simulation, 0.7);
    NEAR(simulation->state->y[fish->at.phi0], -0.1, 1e-12, 0);
    school_run(simulation, 0.8);
    NEAR(simulation->state->y[fish->at.phi0], -0.3, 1e-12, 0);
}

// the nose after a swim in which everything is set, three times within one ramp; or nothing
static double led_swim(const char *solver, bool is_led, long *steps) {
    struct simulation *const simulation = school_simulation_of(
        "%ssolver: %s\nfish: [{nodes: 7, sheet_points: 13, pressure: {span: infinite}, control: {ramp: 0.2}, body: "
        "{modulus: 1.0e+5}}]\n",
        TIME, solver);
    static const struct {
        double t;
        const char *key;
        double value;
    } changes[] = {{0.5, "wave.amplitude", 0.6},
                   {0.5, "wave.frequency", 1.5},
                   {0.56, "control.bias", 0.3},
                   {0.56, "wave.frequency", 0.8},
                   {0.62, "wave.amplitude", 0.3}};
    for (size_t i = 0; is_led && i < sizeof changes / sizeof *changes; i++) {
        school_run(simulation, changes[i].t);
        set(simulation, changes[i].key, changes[i].value);
    }
    school_run(simulation, 1.2);
    const struct integrator_counts counts = school_counts(simulation);
    *steps = counts.steps;
    return simulation->state->y[simulation->school->fish[0].at.x];
}

TEST(every_method_integrates_the_same_led_swim) {
    long steps, steps_alone;
    const double exact = led_swim("{method: rk4, step: 2.5e-4}", 1, &steps);
    const double tight = led_swim("{rtol: 1e-8}", 1, &steps), usual = led_swim("{rtol: 1e-5}", 1, &steps);
    led_swim("{rtol: 1e-5}", 0, &steps_alone);
    NEAR(tight, exact, 2e-7, 0);
    NEAR(usual, exact, 3e-4, 0);
    // the integrator does not start again, and a change costs a few steps
    BELOW(2 * steps, 3 * steps_alone);
}

TEST(a_desired_heading_is_taken_up_the_short_way) {
    struct simulation *const simulation = school_simulation(
        SMALL "fish: [{control: {law: heading, ramp: 0.2, desired_heading: [[0, 170], [2, 178]]}}]\n");
    school_run(simulation, 0.5);
    const struct fish *const fish = simulation->school->fish;
    const struct control_memory *const memory = simulation->state->control;
    const double degree = acos(-1) / 180;
    set(simulation, "control.desired_heading", -170);
    NEAR(control_desired_heading(fish, memory, 0.5, NULL), 172 * degree, 1e-14, 0);
    NEAR(control_desired_heading(fish, memory, 0.7, NULL), 190 * degree, 1e-14, 0);
    school_run(simulation, 0.6);
    set(simulation, "control.desired_heading", 150);
    NEAR(control_desired_heading(fish, memory, 0.9, NULL), 150 * degree, 1e-14, 0);
}

TEST(the_offset_of_a_place_is_taken_up) {
    struct simulation *const simulation =
        school_simulation(SMALL
                          "fish: [{name: one}, {name: two, start: {position: [0.3, 0.6]},\n"
                          "        control: {law: place, of: one, offset: [0.3, 0.6], ramp: 0.2}}]\n");
    school_run(simulation, 0.1);
    const struct fish *const fish = &simulation->school->fish[1];
    const struct control_memory *const memory = &simulation->state->control[1];
    school_ok(handle_set_key(simulation, 1, "control.offset", 2, (const double[]){0.5, -0.7}));
    NEAR(lead_value(&memory->offset[0], 0.2), 0.1, 1e-15, 0);
    NEAR(control_offset(fish, memory, 0), 0.5, 1e-15, 0);
    NEAR(control_offset(fish, memory, 1), -0.7, 1e-15, 0);

    // not two pairs, not on top of the leader, not for a fish without the law
    const struct {
        int fish, n;
        double x, y;
        const char *words;
    } bad[] = {{1, 4, 0.5, 0, "4 numbers: give two"},
               {1, 2, 0.3, 0.01, "fish[1] (two) would hold its place on top of fish[0] (one): change control.offset"},
               {0, 2, 0.5, 1, "one needs 'law: place'"}};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        const double values[] = {bad[i].x, bad[i].y, 1, 1};
        assert_int_equal(handle_set_key(simulation, bad[i].fish, "control.offset", bad[i].n, values), STATUS_CASE);
        if (!strstr(status_message(), bad[i].words)) fail_msg("'%s' is not in: %s", bad[i].words, status_message());
        NEAR(control_offset(fish, memory, 0), 0.5, 1e-15, 0);
    }
    const double west = 180;
    assert_int_equal(handle_set_key(simulation, 1, "control.desired_heading", 1, &west), STATUS_CASE);
}

TEST(waypoints_are_taken_up) {
    struct simulation *const simulation =
        school_simulation(SMALL "fish: [{control: {law: course, waypoints: [[-9, 0]], acceptance_radius: 0.3}}]\n");
    school_run(simulation, 0.1);
    const struct fish *const fish = simulation->school->fish;
    const double *const y = simulation->state->y;
    const struct control_memory *const memory = simulation->state->control;
    const double nose[2] = {y[fish->at.x], y[fish->at.y]};
    const double points[] = {nose[0], nose[1] + 0.1, nose[0], nose[1] + 2};
    school_ok(handle_set_key(simulation, 0, "control.waypoints", 4, points));
    assert_int_equal(control_n_waypoints(fish, memory), 2);
    NEAR(control_desired_heading(fish, memory, 0.1, y), acos(-1) / 2, 1e-12, 0);
    // the first one is near enough to be passed at once
    school_run(simulation, 0.12);
    assert_int_equal(memory->waypoint, 1);
}

static void refused(const struct simulation *simulation, const char *key, int n, double value, const char *words) {
    double values[66];
    for (int i = 0; i < 66; i++) values[i] = value;
    const struct control_memory before = simulation->state->control[0];
    assert_int_equal(handle_set_key(simulation, 0, key, n, values), STATUS_CASE);
    if (!strstr(status_message(), words)) fail_msg("'%s' is not in: %s", words, status_message());
    assert_memory_equal(&before, &simulation->state->control[0], sizeof before);
}

TEST(a_heave_that_is_set_moves_the_plate_without_a_restart) {
    struct simulation *const simulation =
        school_simulation(SMALL
                          "fish: [{wave: {amplitude: 0, frequency: 0}, control: {ramp: 0.3}, start: {speed: 0},\n"
                          "motion: {prescribed: all, heave: 0.1, frequency: 1, phase: 90, speed: 0}}]\n");
    const struct fish *const fish = simulation->school->fish;
    const double pi = acos(-1), *const y = simulation->state->y;
    school_run(simulation, 0.6);
    set(simulation, "motion.heave", 0.2);
    school_run(simulation, 0.7);
    // a third of the ramp; heave cos(2 pi t) across the heading
    double heave[3];
    control_heave(fish, simulation->state->control, 0.7, heave);
    ABOVE(heave[0], 0.11);
    BELOW(heave[0], 0.15);
    NEAR(fabs(y[fish->at.y]), fabs(heave[0] * cos(2 * pi * 0.7)), 1e-9, 0);
    school_run(simulation, 1);
    NEAR(fabs(y[fish->at.y]), 0.2, 1e-9, 0);
    NEAR(y[fish->at.vy], 0, 1e-9, 0);
}

TEST(what_has_no_use_is_refused) {
    struct simulation *simulation = school_simulation(SMALL "fish: [{}]\n");
    refused(simulation, "wave.number", 1, 1, "'wave.number' cannot be set");
    refused(simulation, "wave.amplitude", 1, NAN, "is not finite");
    refused(simulation, "wave.amplitude", 1, 40, "below 3.14");
    refused(simulation, "control.bias", 1, 40, "below 3.14");
    refused(simulation, "wave.amplitude", 2, 0.1, "2 numbers: give one");
    refused(simulation, "wave.frequency", 0, 0.1, "0 numbers: give one");
    refused(simulation, "wave.frequency", 1, -0.1, "cannot be negative");
    refused(simulation, "control.desired_heading", 1, 90, "has no control law");
    refused(simulation, "motion.heave", 1, 0.1, "is not prescribed, or has no frequency");
    refused(simulation, "control.waypoints", 2, 1, "needs 'law: course'");
    simulation = school_simulation(SMALL "fish: [{wave: {amplitude: 0}, control: {waypoints: [[-3, 0]]}}]\n");
    refused(simulation, "wave.amplitude", 1, 0.1, "in the case is 0: give an initial amplitude");
    refused(simulation, "control.bias", 1, 0.1, "sets the bias: use");
    refused(simulation, "control.desired_heading", 1, 90, "follows waypoints");
    refused(simulation, "control.waypoints", 3, 1, "3 numbers: give 1 to 32 pairs");
    refused(simulation, "control.waypoints", 66, 1, "66 numbers: give 1 to 32 pairs");
    refused(simulation, "control.waypoints", 0, 1, "0 numbers: give 1 to 32 pairs");
    // the numbers are counted before any is read
    refused(simulation, "control.waypoints", 1 << 30, 1, "1073741824 numbers: give 1 to 32 pairs");
    school_ok(handle_set_key(simulation, 0, "control.waypoints", 64, test_array(64)));
}
