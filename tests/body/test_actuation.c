/* test_actuation.c: The wave of natural curvature is the formula of doc/model.md, section 4, and its derivatives agree
 * with differences. */
#include <stdio.h>

#include "base/mathematics.h"
#include "body/rod.h"
#include "fish/fish_gait.h"
#include "school.h"

#define TIME "time: {end: 1, shedding_interval: 0.02, output_interval: 0.02}\n"
#define SMALL TIME "defaults: {fish: {nodes: 7}}\n"
#define WAVE                                                                                                         \
    "fish: [{wave: {frequency: 1.2, phase: 35, amplitude: 0.5, constant: 0.1, linear: 0.8, quadratic: 0.4, number: " \
    "-5}}]\n"

/* Natural curvature of the first fish at a time. */
enum { JOINTS = 300 };
struct asked {
    double curvature[JOINTS], rate[JOINTS], by_phi0[JOINTS], rate_by_phi0[JOINTS];
};

static void ask(const struct setup *setup, double t, double phi0, double phi0_rate, struct asked *asked) {
    const struct fish *const fish = setup->school->fish;
    AT_MOST(fish->n_joints, JOINTS);
    actuation_find(fish, fish_own_gait(fish, t), phi0, phi0_rate,
                   &(struct actuation){asked->curvature, asked->rate, asked->by_phi0, asked->rate_by_phi0});
}

TEST(curvature_is_the_formula_of_the_model) {
    struct setup setup = setup_of(SMALL WAVE);
    struct asked asked;
    for (double t = 0; t < 1.5; t += 0.3) {
        ask(&setup, t, 0.2, 0, &asked);
        for (int j = 0; j < 5; j++) {
            const double s = (j + 1) / 6.0, pi = acos(-1);
            const double angle = ramp_value(t, 1 / 1.2) * 0.5 * (0.1 + 0.8 * s + 0.4 * s * s) *
                                 (sin(-5 * s + 2 * pi * 1.2 * t + 35 * pi / 180) + 0.2);
            NEAR(asked.curvature[j], 2 * tan(angle / 2), 1e-14, 0);
        }
    }
}

static void derivatives_agree(const char *text) {
    struct setup setup = setup_of(text);
    const double h = 1e-4, rate = 0.7;
    for (double t = 0.1; t < 1.5; t += 0.3) {
        struct asked at, low, high;
        ask(&setup, t, 0.2, rate, &at);
        ask(&setup, t, 0.2 - h, rate, &low);
        ask(&setup, t, 0.2 + h, rate, &high);
        for (int j = 0; j < 5; j++) {
            // truncation h^2/6 times third derivatives of at most 0.1, and of the rate at most 10
            NEAR(at.by_phi0[j], (high.curvature[j] - low.curvature[j]) / (2 * h), 1e-9, 0);
            NEAR(at.rate_by_phi0[j], (high.rate[j] - low.rate[j]) / (2 * h), 1e-7, 0);
        }
        ask(&setup, t - h, 0.2 - rate * h, rate, &low);
        ask(&setup, t + h, 0.2 + rate * h, rate, &high);
        // the same with omega^3 = 430 and the ramp's 53/0.8^3
        for (int j = 0; j < 5; j++) NEAR(at.rate[j], (high.curvature[j] - low.curvature[j]) / (2 * h), 1e-6, 0);
    }
}

TEST(derivatives_agree_with_differences) {
    derivatives_agree(SMALL WAVE);
    derivatives_agree(SMALL
                      "fish: [{wave: {frequency: 1.2, phase: 35, constant: 0.3,\n"
                      "  table: [[0, 1, -1, 0.4], [2, -3, 1, 1], [1, 0, -2, 5]]}}]\n");
}

TEST(a_wavelength_is_another_word_for_the_number) {
    struct setup setup[2];
    school_build(&setup[0], SMALL "fish: [{wave: {wavelength: 0.8}}]\n");
    school_build(&setup[1], SMALL "fish: [{wave: {number: -7.853981633974483}}]\n");
    NEAR_ARRAY(5, setup[0].school->fish[0].wave_phase, setup[1].school->fish[0].wave_phase, 0, 1e-15);
}

TEST(a_table_of_a_wave_is_that_wave) {
    struct setup setup[2];
    // 0.5 (0.2 + 0.8 q) sin(2 pi t + phase), equal at all positions: linear in q like the table; six lengths of l_ref
    school_build(&setup[0],
                 SMALL "fish: [{wave: {amplitude: 0.5, constant: 0.2, linear: 0.8, quadratic: 0, number: 0}}]\n");
    school_build(&setup[1], SMALL
                 "fish: [{wave: {amplitude: 0.5, constant: 0.2, linear: 0.8, quadratic: 0,\n"
                 "  table: [[0, 0.6, 0, -0.6], [0, 3, 0, -3]]}}]\n");
    for (double t = 0.1; t < 2; t += 0.3) {
        struct asked asked[2];
        for (int i = 0; i < 2; i++) ask(&setup[i], t, 0.2, 0.3, &asked[i]);
        NEAR_ARRAY(5, asked[1].curvature, asked[0].curvature, 1e-14, 1e-13);
        NEAR_ARRAY(5, asked[1].by_phi0, asked[0].by_phi0, 1e-14, 1e-13);
        NEAR_ARRAY(5, asked[1].rate, asked[0].rate, 1e-13, 1e-13);
        NEAR_ARRAY(5, asked[1].rate_by_phi0, asked[0].rate_by_phi0, 1e-13, 1e-13);
    }
}

// the turn of a joint at all phases of a beat, under the bias that bends it most, comes near to the largest one
TEST(no_joint_turns_by_more_than_the_largest_turn) {
    static const char *const waves[] = {"amplitude: 0.3, ramp: 0",
                                        "amplitude: 0.3, ramp: 0, table: [[0, 0.6, 0, -0.6], [0, 3, 0, -3]]"};
    for (int i = 0; i < 2; i++) {
        struct setup setup = setup_with(TIME "fish: [{nodes: 9, wave: {%s}}]\n", waves[i]);
        const struct fish *const fish = setup.school->fish;
        const double largest = fish_largest_turn(fish, 1.5, 0.4);
        NEAR(fish_largest_turn(fish, 1.5, -0.4), largest, 0, 0);
        double most = 0;
        for (int n = 0; n < 1000; n++) {
            const struct fish_gait gait = {.amplitude = 1.5, .angle = 6.28318530717958647692 * n / 1000};
            for (int sign = -1; sign <= 1; sign += 2) {
                for (int j = 0; j < fish->n_joints; j++) {
                    most = fmax(most, fabs(fish_natural_angle(fish, j, &gait, sign * 0.4)));
                }
            }
        }
        NEAR(most, largest, 0, 1e-3);
        AT_MOST(most, largest * (1 + 1e-12));
    }
}

TEST(a_table_is_met_at_its_places_and_phases) {
    // odd and even numbers of phases; rows at quarters of the length, the positions of joints 1, 2, 3 of five nodes
    const char *const texts[] = {
        TIME "fish: [{nodes: 5, wave: {ramp: 0, table: [[9, 9, 9], [1, 2, -3], [2, 0, 4], [0, 1, 0], [9, 9, 9]]}}]\n",
        TIME
        "fish: [{nodes: 5, wave: {ramp: 0, table: [[9, 9, 9, 9], [1, 2, -3, 0], [2, 0, 4, 1], [0, 1, 0, 2], [9, 9, 9, "
        "9]]}}]\n"};
    const double want[2][3][4] = {{{1, 2, -3}, {2, 0, 4}, {0, 1, 0}}, {{1, 2, -3, 0}, {2, 0, 4, 1}, {0, 1, 0, 2}}};
    for (int i = 0; i < 2; i++) {
        struct setup setup = setup_of(texts[i]);
        for (int phase = 0; phase < 3 + i; phase++) {
            for (int j = 0; j < 3; j++) {
                // a quarter of the length turns by a quarter of curvature times length
                const struct fish_gait gait = fish_own_gait(setup.school->fish, phase / (3.0 + i));
                NEAR(fish_natural_angle(setup.school->fish, j, &gait, 0), want[i][j][phase] / 4, 1e-14, 0);
            }
        }
    }
}

TEST(wave_travels_from_head_to_tail) {
    struct setup setup = setup_of(TIME "fish: [{nodes: 31, wave: {ramp: 0}}]\n");
    // a crest stands where number s + omega t is constant: after 0.1 s it is 0.1 omega/6 lengths further back
    struct asked now, later;
    const double delay = 6.0 * 3 / 30 / (2 * acos(-1));
    ask(&setup, 0.5, 0, 0, &now);
    ask(&setup, 0.5 + delay, 0, 0, &later);
    for (int j = 0; j + 3 < 29; j++) {
        const double a = setup.school->fish[0].wave_amplitude[j], b = setup.school->fish[0].wave_amplitude[j + 3];
        NEAR(2 * atan(later.curvature[j + 3] / 2) / b, 2 * atan(now.curvature[j] / 2) / a, 1e-12, 0);
    }
}

TEST(ramp_starts_from_a_straight_body_and_no_ramp_does_not) {
    const char *const texts[] = {SMALL "fish: [{}]\n", SMALL "fish: [{wave: {ramp: 0}}]\n"};
    for (int i = 0; i < 2; i++) {
        struct setup setup = setup_of(texts[i]);
        struct asked asked;
        ask(&setup, 0, 0.3, 0, &asked);
        for (int j = 0; j < 5; j++) {
            assert_true((asked.curvature[j] == 0) == (i == 0));
            assert_true((asked.rate[j] == 0) == (i == 0));
        }
    }
}

TEST(turn_of_the_whole_body_does_not_depend_on_the_number_of_nodes) {
    double total[2];
    const char *const texts[] = {TIME "fish: [{nodes: 121, force: reactive, sheet_points: 33}]\n",
                                 TIME "fish: [{nodes: 241, force: reactive, sheet_points: 33}]\n"};
    for (int i = 0; i < 2; i++) {
        struct setup setup = setup_of(texts[i]);
        struct asked asked;
        ask(&setup, 1.3, 1, 0, &asked);
        total[i] = 0;
        for (int j = 0; j < setup.school->fish[0].n_joints; j++) total[i] += 2 * atan(asked.curvature[j] / 2);
    }
    // the sum is a Riemann sum without its end, of the size 1/N
    NEAR(total[1], total[0], 2e-2, 0);
    ABOVE(fabs(total[0]), 1);
}
