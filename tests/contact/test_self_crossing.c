/* test_self_crossing.c: A body that crosses itself by its centre line, its outline or a sharp bend is found, and a run
 * remembers the first time. */
#include <stdio.h>

#include "contact/clearance.h"
#include "school.h"

#define TIME "time: {end: 2, shedding_interval: 0.02}\n"

// A body of 41 nodes, 1 m long, of uniform thickness.
static void build(struct setup *setup, double thickness) {
    char text[256];
    snprintf(text, sizeof text, TIME "fish: [{nodes: 41, body: {profile: uniform, thickness: %g}}]\n", thickness);
    school_build(setup, text);
}

// from the nose, the body follows the direction angle(s)
static int crosses(double thickness, double (*angle)(double s)) {
    struct setup setup;
    build(&setup, thickness);
    const struct fish *const fish = setup.school->fish;
    double *const y = setup.state->y;
    for (int k = 0; k < fish->n_edges; k++) {
        const double along = angle((k + 0.5) / fish->n_edges);
        y[fish->at.x + k + 1] = y[fish->at.x + k] + fish->edge_length * cos(along);
        y[fish->at.y + k + 1] = y[fish->at.y + k] + fish->edge_length * sin(along);
    }
    const int found = self_crossing(fish, y, setup.residual->scratch);
    // mirrored, and from the other end
    for (int k = 0; k < fish->n_nodes; k++) y[fish->at.y + k] *= -1;
    assert_int_equal(self_crossing(fish, y, setup.residual->scratch), found);
    for (int k = 0; k < fish->n_nodes / 2; k++) {
        for (int i = 0; i < 2; i++) {
            double *const one = y + fish->at.x + i * fish->n_nodes + k, *const other = one + fish->n_nodes - 1 - 2 * k;
            const double kept = *one;
            *one = *other;
            *other = kept;
        }
    }
    assert_int_equal(self_crossing(fish, y, setup.residual->scratch), found);
    return found;
}

static double straight(double s) {
    return 0 * s;
}
// a circle of radius 1/(2 pi): open by a twentieth, closed, and overlapping by a twentieth
static double open_circle(double s) {
    return 0.95 * 2 * M_PI * s;
}
static double more_than_a_circle(double s) {
    return 1.05 * 2 * M_PI * s;
}
// two legs, 0.1 m apart
static double hairpin(double s) {
    const double arc = 0.05 * M_PI, from = 0.5 - arc / 2;
    return fmin(M_PI, fmax(0, (s - from) / arc * M_PI));
}
static double wave(double s) {
    return 1.4 * sin(4 * M_PI * s);
}
static double spiral(double s) {
    return 3.5 * M_PI * s * s;
}
// a loop of 1.4 half turns with two long legs that cross
static double loop(double s) {
    const double arc = 0.4, from = 0.3;
    return fmin(1.4 * M_PI, fmax(0, (s - from) / arc * 1.4 * M_PI));
}
static double sharp(double s) {
    return s < 0.5 ? 0 : 1;
}

TEST(bent_bodies_do_not_cross_themselves) {
    assert_false(crosses(0.02, straight));
    assert_false(crosses(0.2, straight));
    assert_false(crosses(0.02, wave));
    assert_false(crosses(0.02, spiral));
}

TEST(a_line_crosses_itself_beyond_a_circle) {
    assert_false(crosses(0.01, open_circle));
    assert_true(crosses(0.01, more_than_a_circle));
    assert_true(crosses(0.01, loop));
}

TEST(an_outline_crosses_itself_where_it_is_thicker_than_the_gap) {
    // the legs of the hairpin are 0.1 m apart; the radius of the bend, 0.05 m, is at least half the thickness
    assert_false(crosses(0.09, hairpin));
    assert_true(crosses(0.11, hairpin));
}

TEST(a_tail_that_enters_the_right_side_of_the_nose_crosses_the_outline) {
    // once around, then from below to the middle of the first edge, where the outline is 0.0034 m below the line;
    // only the closing segment of the outline, from the last point to the nose, is crossed
    const double x[] = {0, 0.2, 0.2, -0.1, -0.1, 0.1, 0.1}, y_of_tail[] = {-0.005, -0.002, 0.002};
    double y[] = {0, 0, 0.2, 0.2, -0.2, -0.2, 0};
    struct setup setup = setup_of(TIME "fish: [{nodes: 7, body: {profile: uniform, thickness: 0.02}}]\n");
    const struct fish *const fish = setup.school->fish;
    double *const to = setup.state->y;
    for (int i = 0; i < 3; i++) {
        y[6] = y_of_tail[i];
        for (int k = 0; k < 7; k++) {
            to[fish->at.x + k] = x[k];
            to[fish->at.y + k] = y[k];
        }
        assert_int_equal(self_crossing(fish, to, setup.residual->scratch), i > 0);
    }
}

TEST(a_bend_sharper_than_half_the_thickness_is_folded) {
    // one joint turns by 1 rad: edges of 0.025 m have the radius 0.025/(2 tan(1/2)) = 0.0229 m
    assert_false(crosses(0.045, sharp));
    assert_true(crosses(0.047, sharp));
}

TEST(a_run_remembers_the_first_fish_and_when) {
    // the second body is limp, and only the muscle bends the body: the body curls up
    struct simulation *const simulation = school_simulation(
        TIME
        "fluid: {density: 0}\nfish: [{}, {start: {position: [0, 3]}, wave: {amplitude: 0.4, constant: 3, linear: 0,"
        " quadratic: 0, number: 0, ramp: 1}, body: {modulus: 1e5}}]\n");
    const struct state *const now = simulation->state;
    assert_false(now->has_crossed);
    double last = 0;
    while (!now->has_crossed && now->t < 1.99) {
        last = now->t;
        school_ok(simulate_step(simulation));
    }
    assert_int_equal(now->crossed, 1);
    ABOVE(last, 0.1);
    NEAR(now->crossed_t, now->t, 0, 0);
    const double first = now->crossed_t;
    school_run(simulation, first + 0.1);
    NEAR(now->crossed_t, first, 0, 0);
}
