/* test_flow_leg_rate.c: Tests the momentum that legs take while their lengths change (doc/model.md, section 18). */
#include <stdio.h>
#include <string.h>

#include "flow/flow.h"
#include "flow/flow_at_bodies.h"
#include "flow/flow_at_wake.h"
#include "flow/flow_leg_rate.h"
#include "school.h"
#include "wake/stretch.h"

#define FISH "defaults: {fish: {nodes: 9, sheet_points: 129, body: {depth: 0.25}}}\n"

/* A smooth wake of n markers, `spacing` apart behind the tail, of which most are old, and a bound sheet with the
 * opposite circulation. */
static void make_wake(struct setup *setup, int f, int n, double spacing) {
    const struct fish *const fish = &setup->school->fish[f];
    double *const y = setup->state->y, tail[2];
    struct wake *const wake = school_wake(setup, f, n, tail);
    for (int i = 0; i < n; i++) {
        const double along = spacing * (n - 1 - i), angle = 7 * along + f;
        wake->x[i] = tail[0] + along;
        wake->y[i] = tail[1] + 0.08 * (sin(angle) - sin((double)f));
        wake->circulation[i] = (0.1 + 0.2 * cos(angle + 0.4)) * fmin(1, spacing * i);
    }
    school_shed(setup, f);
    stretch_find_old(wake, fish, setup->school);
    ABOVE(wake->n_old, n / 2.0);
    double length = 0;
    for (int j = 0; j < fish->n_sheet; j++) length += fish->sheet_weight[j];
    for (int j = 0; j < fish->n_sheet; j++) y[fish->at.gamma + j] = -wake->circulation[n - 1] / length;
}

// the labels decay over most of the wakes, from the oldest markers on
static struct setup with_wakes(const char *text, int n, double spacing, double tolerance) {
    struct setup setup = setup_with(
        "time: {end: 1, shedding_interval: %g}\n"
        "wake: {lifetime: 1.6, decay: 1, tolerance: %g}\n" FISH "%s",
        spacing / 2, tolerance, text);
    school_stir(&setup);
    for (int f = 0; f < setup.school->n_fish; f++) make_wake(&setup, f, n, spacing);
    flow_velocity(setup.residual->flow, setup.state, setup.state->t, setup.state->y, false);
    flow_at_wake(setup.residual->flow, setup.state);
    if (setup.school->walls.n > 0) flow_images(setup.residual->flow, setup.state);
    flow_leg_boxes(setup.residual->flow);
    return setup;
}

// the sum before the integration by parts: legs of fish g, or images of its legs, at control points and markers of f
static void sum_of_legs(const struct flow *flow, int f, int g, bool of_images, double rate[3]) {
    const struct sources *const at[] = {&flow->fish[f].body, &flow->fish[f].markers};
    const struct sources *const from[] = {of_images ? &flow->fish[g].body_image : &flow->fish[g].body,
                                          of_images ? &flow->fish[g].markers_image : &flow->fish[g].markers};
    const struct kernel_pair pair = flow->kernel->other(flow->school->fish[g].strip_depth, 0);
    for (int k = 0; k < 2; k++) {
        enum { MOST = 1024 };
        static double u[MOST], v[MOST], leg_u[MOST], leg_v[MOST], div[MOST];
        double *const sums[] = {u, v, leg_u, leg_v, div};
        AT_MOST(at[k]->n, MOST);
        for (int i = 0; i < 5; i++) memset(sums[i], 0, sizeof u);
        const struct targets targets = {.n = at[k]->n,
                                        .x = at[k]->x,
                                        .y = at[k]->y,
                                        .half = at[k]->half,
                                        .leg = at[k]->leg,
                                        .u = u,
                                        .v = v,
                                        .leg_u = leg_u,
                                        .leg_v = leg_v,
                                        .div = div};
        for (int i = 0; i < 2; i++) kernel_induce(&pair, from[i], (struct range){0, from[i]->n}, &targets);
        for (int i = 0; i < at[k]->n; i++) {
            const double x = -at[k]->q[i] * leg_v[i] - div[i] * at[k]->dy[i];
            const double y = of_images ? 0 : at[k]->q[i] * leg_u[i] + div[i] * at[k]->dx[i];
            rate[0] += x;
            rate[1] += y;
            rate[2] += at[k]->x[i] * y - at[k]->y[i] * x;
        }
    }
}

// both ways to compute the sum over two fish, the difference over the larger rate of one
static double error_between_fish(double spacing, const char *second) {
    char text[1024];
    snprintf(text, sizeof text, "fish: [{}, {start: {position: [0.1, 0.35]}, %s}]\n", second);
    struct setup setup = with_wakes(text, (int)lround(3 / spacing), spacing, 0);
    const struct flow *const flow = setup.residual->flow;
    double all[3] = {0}, exact[3] = {0}, size = 0;
    for (int f = 0; f < 2; f++) {
        double rate[3], image[3], own[3], no_image[3];
        flow_leg_rate(flow, setup.state, f, rate, image);
        NEAR_ARRAY(3, image, ((double[3]){0}), 0, 0);
        // the part of its own legs: the same fish without the other one
        struct school alone = *flow->school;
        struct flow without = *flow;
        alone.n_fish = 1;
        without.school = &alone;
        if (f > 0) {
            alone.fish = flow->school->fish + 1;
            without.fish = flow->fish + 1;
            without.points = flow->points + 1;
            without.wake_range = flow->wake_range + 1;
        }
        struct state of_one = *setup.state;
        of_one.wake = setup.state->wake + f;
        flow_leg_rate(&without, &of_one, 0, own, no_image);
        const double depth = flow->school->fish[f].strip_depth;
        double before[3] = {0};
        sum_of_legs(flow, f, 1 - f, false, before);
        for (int i = 0; i < 3; i++) {
            all[i] += depth * (rate[i] - own[i]);
            exact[i] += depth * before[i];
        }
        size = fmax(size, depth * hypot(rate[0] - own[0], rate[1] - own[1]));
    }
    double error = 0;
    for (int i = 0; i < 3; i++) error = fmax(error, fabs(all[i] - exact[i]) / size);
    school_clear(&setup);
    return error;
}

TEST(the_integral_by_parts_is_the_sum_over_all_legs) {
    static const char *const seconds[] = {
        "body: {depth: 0.25}", "length: 0.6, body: {depth: 0.3}",
        "body: {profile: table, thickness_table: [0.05, 0.1, 0.1, 0.1, 0.08, 0.06, 0.04, 0.02], "
        "depth_table: [0.12, 0.2, 0.24, 0.24, 0.2, 0.16, 0.18, 0.22]}"};
    for (size_t i = 0; i < sizeof seconds / sizeof *seconds; i++) {
        const double coarse = error_between_fish(0.02, seconds[i]), fine = error_between_fish(0.01, seconds[i]);
        // The young part is of second order in the spacing of the markers, and legs beyond the reach are left out. With
        // the shorter fish, half of the spacing takes the error from 0.091 to 0.007: 0.02 hardly resolves its wake, in
        // which forms of sixth order err by a little more than the cubic ones, whose bound was 0.09.
        BELOW(coarse, i == 1 ? 0.1 : 0.015);
        BELOW(fine, 0.3 * coarse);
    }
}

// a wall takes no momentum along itself, so both ways agree for the images of the legs of a fish
TEST(images_of_legs_take_momentum_along_the_wall) {
    double error[2];
    for (int i = 0; i < 2; i++) {
        const double spacing = i == 0 ? 0.02 : 0.01;
        struct setup setup = with_wakes("fluid: {walls: [-0.2]}\nfish: [{}]\n", (int)lround(3 / spacing), spacing, 0);
        double rate[3], image[3], exact[3] = {0};
        flow_leg_rate(setup.residual->flow, setup.state, 0, rate, image);
        sum_of_legs(setup.residual->flow, 0, 0, true, exact);
        NEAR(image[1], 0, 0, 0);
        error[i] = fabs(image[0] - exact[0]) / fabs(image[0]);
        school_clear(&setup);
    }
    BELOW(error[0], 0.07);
    BELOW(error[1], 0.32 * error[0]);
}

// three wakes long enough for the tree
TEST(the_tree_at_wakes_changes_no_rate) {
    double rate[2][3][6];
    for (int i = 0; i < 2; i++) {
        struct setup setup =
            with_wakes("fish: [{}, {start: {position: [0.1, 0.35]}}, {start: {position: [1.3, 0.15]}}]\n", 700, 0.005,
                       i == 0 ? 0 : 1e-4);
        assert_int_equal(setup.residual->flow->is_in_pairs, i == 0);
        for (int f = 0; f < 3; f++) {
            flow_leg_rate(setup.residual->flow, setup.state, f, rate[i][f], rate[i][f] + 3);
            ABOVE(hypot(rate[i][f][0], rate[i][f][1]), 0);
        }
        school_clear(&setup);
    }
    NEAR_ARRAY(18, rate[1][0], rate[0][0], 0, 1e-12);
}

// a fish far away changes nothing, one within five depths does
TEST(far_legs_are_left_out) {
    double with[2][3], image[3];
    for (int i = 0; i < 2; i++) {
        char text[1024];
        snprintf(text, sizeof text, "fish: [{}, {start: {position: [0, %g]}}]\n", i == 0 ? 3.0 : 0.5);
        struct setup setup = with_wakes(text, 300, 0.01, 0);
        flow_leg_rate(setup.residual->flow, setup.state, 0, with[i], image);
        school_clear(&setup);
    }
    struct setup alone = with_wakes("fish: [{}]\n", 300, 0.01, 0);
    double rate[3];
    flow_leg_rate(alone.residual->flow, alone.state, 0, rate, image);
    NEAR_ARRAY(3, with[0], rate, 0, 1e-12);
    ABOVE(fabs(with[1][0] - rate[0]), 1e-3 * fabs(rate[0]));
}
