/* test_tail_flux.c: Tests the force that the momentum leaving at the tail exerts (doc/model.md, section 9). */
#include <stdio.h>
#include <stdlib.h>

#include "body/rod.h"
#include "force/reactive.h"
#include "school.h"

#define TIME "time: {end: 4, shedding_interval: 0.02}\n"
#define SMALL TIME "defaults: {fish: {nodes: 7}}\n"
#define WIDE "body: {depth: 0.3}, added_mass: {extent: depth, coefficient: 1}"

static const double pi = 3.14159265358979323846;
static const double mass_per_length = 1000 * 3.14159265358979323846 * 0.09 / 4;

static void value_of_flux(struct setup *setup, const double *y, const double *yp, double *value) {
    (void)yp;
    school_flow(setup, y);
    for (int f = 0; f < setup->school->n_fish; f++) {
        const struct fish *fish = &setup->school->fish[f];
        const int tail = fish->n_nodes - 1;
        const struct flow_at_body flow = flow_at_body(setup->residual->flow, f);
        double force[2];
        tail_flux_force(fish, &flow, y, force);
        for (int i = 0; i < 2; i++) value[edge_acceleration(fish, i, tail)] = -force[i] / fish->mass[tail];
    }
}

static void jacobian_of_flux(struct setup *setup, double cj, const double *y, struct sparse *jacobian) {
    (void)cj;
    for (int f = 0; f < setup->school->n_fish; f++) {
        const struct fish *fish = &setup->school->fish[f];
        const struct flow_at_body flow = flow_at_body(setup->residual->flow, f);
        tail_flux_jacobian(fish, &flow, y, jacobian);
        for (int g = 0; g < setup->school->n_fish; g++) {
            struct jacobian_scratch *const through = school_influence(setup, f, g);
            tail_flux_flow_jacobian(fish, &flow, &through->block, y, &through->rows);
            school_add_rows(setup, f, g, jacobian);
        }
    }
}

TEST(derivatives_agree_with_differences) {
    const char *const texts[] = {
        TIME "fish: [{nodes: 4, sheet_points: 9, force: reactive, " WIDE "}]\n",
        TIME "fish: [{nodes: 6, sheet_points: 9, force: reactive, " WIDE ", start: {speed: 2}}]\n",

        // swimming backwards: no flux along a leading tail
        TIME "fish: [{nodes: 6, sheet_points: 9, force: reactive, " WIDE ", start: {speed: -2}}]\n",
        TIME
        "solver: {coupling_distance: 100}\ncontact: {action: warn}\nfluid: {velocity: [0.3, -0.2], shear: 0.7}\n"
        "fish: [{nodes: 6, sheet_points: 9, force: reactive, " WIDE "}, {nodes: 5, start: {position: [0.2, 0.5]}}]\n"};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        struct setup setup = setup_stirred(texts[i]);
        school_compare(&setup, value_of_flux, jacobian_of_flux, texts[i]);
    }
}

TEST(it_takes_from_the_body_what_it_leaves_in_the_wake) {
    struct setup setup = setup_of(TIME "fish: [{nodes: 6, force: reactive, " WIDE "}]\n");
    const struct fish *fish = setup.school->fish;
    const double still[64] = {0};
    const struct flow_at_body flow = {.u = still, .v = still};
    double *const y = setup.state->y;
    for (int trial = 0; trial < 20; trial++) {
        // edges of different lengths whose angles are a parabola in the edge number; the tail is half an edge behind
        // the last midpoint
        const double angle = 3 * school_random(&setup), slope = 0.3 * school_random(&setup),
                     bend = 0.1 * school_random(&setup);
        for (int k = 0; k < 5; k++) {
            const double s = k - 4.5, theta = angle + slope * s + bend * s * s, l = 0.2 + 0.02 * school_random(&setup);
            y[fish->at.x + k + 1] = y[fish->at.x + k] + l * cos(theta);
            y[fish->at.y + k + 1] = y[fish->at.y + k] + l * sin(theta);
        }

        for (int i = fish->at.vx; i < fish->at.ax; i++) y[i] = 2 * school_random(&setup);
        const double vx = y[fish->at.vx + 5], vy = y[fish->at.vy + 5];
        const double wt = vx * cos(angle) + vy * sin(angle), wn = vy * cos(angle) - vx * sin(angle);
        double force[2];
        tail_flux_force(fish, &flow, y, force);
        NEAR(force[0] * cos(angle) + force[1] * sin(angle), -mass_per_length * wn * wn / 2, 1e-12, 1e-12);
        NEAR(force[1] * cos(angle) - force[0] * sin(angle), mass_per_length * fmin(wt, 0) * wn, 1e-12, 1e-12);

        // the power is never positive, for a trailing and for a leading tail
        NEAR(force[0] * vx + force[1] * vy, -mass_per_length * wn * wn * fabs(wt) / 2, 1e-12, 1e-12);
    }
}

TEST(it_has_the_velocity_of_a_linear_flow_at_the_tail) {
    struct setup setup = setup_of(TIME "fish: [{nodes: 6, force: reactive, " WIDE "}]\n");
    const struct fish *fish = setup.school->fish;
    double u[64] = {0}, v[64] = {0}, force[2], want[2];

    // a straight body along x, nose at 0
    for (int k = 0; k < fish->n_edges; k++) {
        const double s = (k + 0.5) / 5;
        u[flow_midpoint(fish, k)] = 0.7 + 0.4 * s;
        v[flow_midpoint(fish, k)] = -0.2 + 0.9 * s;
    }

    const struct flow_at_body flow = {.u = u, .v = v};
    double *const y = setup.state->y;
    tail_flux_force(fish, &flow, y, force);

    // a body in still fluid with the velocity of the tail relative to the flow
    const double still[64] = {0};
    const struct flow_at_body none = {.u = still, .v = still};
    y[fish->at.vx + 5] -= 1.1;
    y[fish->at.vy + 5] -= 0.7;
    tail_flux_force(fish, &none, y, want);
    ABOVE(fabs(want[0]), 1);
    NEAR_ARRAY(2, force, want, 1e-12, 1e-12);
}

TEST(its_mass_is_that_of_the_extent_at_the_tail) {
    const struct {
        const char *keys;
        double mass;
    } cases[] = {{"force: reactive, body: {tail_thickness: 0}, added_mass: {extent: thickness}", 0},
                 {"force: reactive, added_mass: {extent: thickness}", 1000 * 0.04 * 0.04},
                 {"force: reactive", 1000 * 0.04},
                 {"force: reactive, body: {profile: uniform}, added_mass: {coefficient: 1.5, extent: thickness}",
                  1000 * 1.5 * 0.01},
                 {"force: published", 0},
                 {"force: pressure", 0}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct setup setup = setup_with(SMALL "fish: [{%s}]\n", cases[i].keys);
        NEAR(setup.school->fish[0].tail_added_mass, pi / 4 * cases[i].mass, 0, 1e-14);
    }
}

TEST(a_stiff_body_swims_at_a_speed_of_second_order_in_its_nodes) {
    // a uniform body without wake, so that only the resolution of the tail matters; from rest, speed after 4 s
    const int nodes[] = {17, 33, 65};
    double speed[3];
    for (int i = 0; i < 3; i++) {
        struct simulation *const simulation =
            school_simulation_of(TIME
                                 "wake: {smoothing: 1.0e+6}\nfish: [{force: reactive, nodes: %d, sheet_points: %d,\n"
                                 "        body: {profile: uniform, depth: 0.25, modulus: 1.0e+8, damping: curvature,\n"
                                 "               relaxation_time: 0.001}}]\n",
                                 nodes[i], nodes[i] > 17 ? 2 * nodes[i] - 1 : 33);
        school_measure(simulation, 4);
        speed[i] = simulation->diagnostics->fish[0].speed;
    }

    const double order = log2((speed[1] - speed[0]) / (speed[2] - speed[1]));
    ABOVE(order, 1.8);
    NEAR(speed[2], 0.4245, 1e-4, 0);
}
