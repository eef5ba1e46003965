/* test_clamp.c: The joint that holds a prescribed head (doc/model.md, section 2) has the energy, the moment and the
 * derivatives of the model. */
#include <stdio.h>
#include <stdlib.h>

#include "body/rod.h"
#include "fish/fish_motion.h"
#include "school.h"
#include "school/residual.h"
#include "school/residual_jacobian.h"

#define TIME "time: {end: 2, shedding_interval: 0.01}\n"
#define SMALL TIME "defaults: {fish: {nodes: 7}}\n"
#define HEAD "motion: {prescribed: head, heave: 0.1, pitch: 20, pitch_phase: 70, frequency: 1.2}"

static const double pi = 3.14159265358979323846;

static void value_of_clamp(struct setup *setup, const double *y, const double *yp, double *value) {
    (void)yp;
    const struct fish *fish = setup->school->fish;
    rod_clamp_residual(fish, setup->t, y, value);
    for (int i = 0; i < 2; i++) {
        for (int node = 0; node < 2; node++) value[edge_acceleration(fish, i, node)] /= fish->mass[node];
    }
}

static void jacobian_of_clamp(struct setup *setup, double cj, const double *y, struct sparse *jacobian) {
    (void)cj;
    rod_clamp_jacobian(setup->school->fish, setup->t, y, jacobian);
}

TEST(jacobian_agrees_with_differences) {
    const char *const texts[] = {SMALL "fish: [{body: {section: mean}, " HEAD "}]\n",
                                 SMALL "fish: [{body: {section: mean, relaxation_time: 0.1, bending_damping: 2}, " HEAD
                                       "}]\n"};
    for (int i = 0; i < 2; i++) {
        struct setup setup = setup_stirred(texts[i]);
        school_compare(&setup, value_of_clamp, jacobian_of_clamp, texts[i]);
    }
}

TEST(force_is_minus_the_gradient_of_the_energy) {
    struct setup setup =
        setup_stirred(SMALL "fish: [{body: {section: mean, bending_damping: 0, relaxation_time: 0}, " HEAD "}]\n");
    const struct fish *fish = setup.school->fish;
    double *const y = setup.state->y;
    rod_clamp_residual(fish, setup.t, y, setup.value);
    const double h = 1e-5;
    for (int i = 0; i < 2 * fish->n_nodes; i++) {
        const double here = y[i];
        y[i] = here + h;
        const double high = rod_clamp_terms(fish, setup.t, y).energy;
        y[i] = here - h;
        const double low = rod_clamp_terms(fish, setup.t, y).energy;
        y[i] = here;
        // truncation and rounding of the differences
        NEAR(setup.value[fish->at.ax + i], (high - low) / (2 * h), 1e-5, 1e-6);
    }
    ABOVE(rod_clamp_terms(fish, setup.t, y).energy, 0.1);
}

TEST(powers_are_what_the_energy_and_the_nodes_do_not_take_up) {
    struct setup setup = setup_stirred(SMALL "fish: [{body: {section: mean, relaxation_time: 0.01}, " HEAD "}]\n");
    const struct fish *fish = setup.school->fish;
    const double *const y = setup.state->y, h = 1e-5;
    double moved[2][256], power = 0;
    for (int side = 0; side < 2; side++) {
        for (int i = 0; i < fish->at.end; i++) moved[side][i] = y[i];
        for (int i = 0; i < 2 * fish->n_nodes; i++) moved[side][i] += (side == 0 ? -h : h) * y[fish->at.vx + i];
    }
    const double rate =
        (rod_clamp_terms(fish, setup.t + h, moved[1]).energy - rod_clamp_terms(fish, setup.t - h, moved[0]).energy) /
        (2 * h);
    rod_clamp_residual(fish, setup.t, y, setup.value);
    for (int i = 0; i < 2 * fish->n_nodes; i++) power -= setup.value[fish->at.ax + i] * y[fish->at.vx + i];
    const double damping = rod_clamp_terms(fish, setup.t, y).damping_power,
                 driving = rod_clamp_terms(fish, setup.t, y).driving_power;
    BELOW(damping, 0);
    ABOVE(fabs(driving), 1e-3);
    NEAR(rate, -power + damping + driving, 1e-5, 1e-6);
}

TEST(energy_audit_of_a_clamped_fish_closes) {
    const char *const texts[] = {SMALL
                                 "solver: {rtol: 1e-5}\n"
                                 "fish: [{force: reactive, start: {speed: 1}, body: {section: mean, modulus: 1.0e+6}, "
                                 "wave: {amplitude: 0}, " HEAD "}]\n",
                                 SMALL
                                 "solver: {rtol: 1e-5}\n"
                                 "fish: [{force: reactive, start: {speed: 1}, body: {section: mean, modulus: 1.0e+6, "
                                 "relaxation_time: 0.01}, " HEAD "}]\n"};
    for (int i = 0; i < 2; i++) {
        struct simulation *const simulation = school_simulation(texts[i]);
        double worst = 0, most = 0;
        while (simulation->state->t < 2) {
            school_ok(simulate_step(simulation));
            simulate_measure(simulation);
            const struct diagnostics_fish *fish = &simulation->diagnostics->fish[0];
            worst = fmax(worst, fabs(fish->energy_balance));
            most = fmax(most, fish->kinetic_energy + fish->bending_energy);
        }
        // a motion that begins at once: thirty tolerances, as in test_diagnostics.c
        BELOW(worst, 30 * 1e-5 * most);
    }
}

TEST(head_has_one_prescribed_node_and_published_sections_two) {
    struct setup setup = setup_of(SMALL "fish: [{body: {section: mean}, " HEAD
                                        "}, {start: {position: [0, 2]}, body: {section: "
                                        "nodes}, " HEAD "}, {start: {position: [0, 4]}, body: {section: mean}}]\n");
    const struct fish *fish = setup.school->fish;
    const int n[] = {1, 2, 0}, has_clamp[] = {1, 0, 0};
    for (int f = 0; f < 3; f++) {
        assert_int_equal(fish_n_prescribed(&fish[f]), n[f]);
        assert_int_equal(fish[f].has_clamp, has_clamp[f]);
        NEAR(rod_clamp_terms(&fish[f], 0.1, setup.state->y).energy, 0, has_clamp[f] ? INFINITY : 0, 0);
    }
}

TEST(clamp_is_the_joint_of_half_a_cell) {
    struct setup setup = setup_of(
        TIME
        "fish: [{nodes: 9, body: {section: mean, profile: uniform, bending_damping: 2, relaxation_time: 0.1}, " HEAD
        "}]\n");
    const struct fish *fish = setup.school->fish;
    // the joints have the modulus times the second moment
    NEAR(fish->clamp_stiffness, 2 * fish->bending_stiffness[0] / fish->edge_length, 0, 1e-14);
    NEAR(fish->clamp_damping, 2 * fish->bending_damping[0], 0, 1e-14);
}

TEST(given_direction_is_that_of_the_prescribed_nodes) {
    struct setup setup = setup_of(SMALL "fish: [{start: {heading: 25}, " HEAD "}]\n");
    const struct fish *fish = setup.school->fish;
    const double h = 1e-5;
    double a[2], b[2], direction[3][2], rate, ignored[2];
    fish_prescribed_node(fish, NULL, 0, 0.3, a, ignored, ignored);
    fish_prescribed_node(fish, NULL, 6, 0.3, b, ignored, ignored);
    for (int i = 0; i < 3; i++) fish_prescribed_direction(fish, 0.3 + (i - 1) * h, direction[i], &rate);
    fish_prescribed_direction(fish, 0.3, direction[1], &rate);
    for (int i = 0; i < 2; i++) {
        NEAR(b[i] - a[i], direction[1][i], 1e-14, 0);
        const double across = i == 0 ? -direction[1][1] : direction[1][0];
        NEAR((direction[2][i] - direction[0][i]) / (2 * h), rate * across, 1e-7, 0);
    }
}

// solve a x = b by elimination; a is positive definite
static void eliminate(int n, double *a, double *b) {
    for (int p = 0; p < n; p++) {
        for (int row = p + 1; row < n; row++) {
            const double factor = a[row * n + p] / a[p * n + p];
            for (int column = p; column < n; column++) a[row * n + column] -= factor * a[p * n + column];
            b[row] -= factor * b[p];
        }
    }
    for (int p = n - 1; p >= 0; p--) {
        for (int column = p + 1; column < n; column++) b[p] -= a[p * n + column] * b[column];
        b[p] /= a[p * n + p];
    }
}

// beta L of the lowest mode of a uniform beam with EI/(rho A L^4) = 1 s-2, clamped at its nose: by inverse iteration
// with the Jacobian's matrix of lateral motion, K/m
static double lowest_mode(int nodes) {
    struct setup setup = setup_with(TIME
                                    "fluid: {density: 0}\nfish: [{nodes: %d, wave: {amplitude: 0},\n"
                                    "  body: {section: mean, profile: uniform, thickness: 0.001, modulus: 1.6e+10},\n"
                                    "  motion: {prescribed: head}}]\n",
                                    nodes);
    const struct fish *fish = setup.school->fish;
    school_ok(residual_jacobian(setup.residual, &residual_run, 0, 0, setup.state->y, setup.jacobian));
    double *const dense = school_dense_jacobian(test_arena(), setup.jacobian);
    const int n = nodes - 1, all = setup.school->n_unknowns;
    double *const matrix = test_array(n * n), shape[64], square = 0;
    for (int i = 0; i < n; i++) shape[i] = 1;
    for (int iteration = 0; iteration < 30; iteration++) {
        for (int i = 0; i < n; i++) {
            for (int j = 0; j < n; j++) matrix[i * n + j] = dense[(fish->at.ay + 1 + i) * all + fish->at.y + 1 + j];
        }
        eliminate(n, matrix, shape);
        square = 1 / shape[n - 1];
        for (int i = 0; i < n; i++) shape[i] *= square;
    }
    return pow(square, 0.25);
}

TEST(frequency_of_a_clamped_beam_is_of_second_order_in_its_whole_length) {
    const double exact = 1.8751040687;
    double error[3];
    for (int level = 0; level < 3; level++) error[level] = lowest_mode(10 * (1 << level) + 1) / exact - 1;
    for (int level = 0; level < 2; level++) NEAR(log2(error[level] / error[level + 1]), 2, 0.05, 0);
    // half of (lbar/L)^2
    NEAR(error[2], 0, 0.5 / 1600, 0);
}

TEST(moment_of_a_tilt_is_that_of_half_a_cell) {
    struct setup setup = setup_of(SMALL
                                  "fish: [{body: {section: mean, profile: uniform, thickness: 0.1, depth: 0.25, "
                                  "modulus: 1.0e+5, bending_damping: 0.5, relaxation_time: 0},\n"
                                  "        start: {heading: 180}, motion: {prescribed: head}}]\n");
    const struct fish *fish = setup.school->fish;
    const double stiffness = 2 * 1e5 * pi * 0.25 * 1e-3 / 64 * 6;
    NEAR(fish->clamp_stiffness, stiffness, 0, 1e-13);
    NEAR(fish->clamp_damping, 1, 0, 1e-13);
    double *const y = setup.state->y;
    for (int i = 0; i < fish->at.end; i++) y[i] = 0;
    const double angle = 0.1;
    y[fish->at.x + 1] = cos(angle) / 6;
    y[fish->at.y + 1] = sin(angle) / 6;
    NEAR(rod_clamp_terms(fish, 0, y).energy, stiffness / 2 * pow(2 * tan(angle / 2), 2), 0, 1e-12);
}
