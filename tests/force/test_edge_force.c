/* test_edge_force.c: The forces of the fluid on an edge arrive at its two nodes as doc/model.md, section 9, says. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "body/rod.h"
#include "flow/flow_at_bodies.h"
#include "force/edge_force.h"
#include "school.h"

#define TIME "time: {end: 1, shedding_interval: 0.02, output_interval: 0.02}\n"
#define SMALL TIME "defaults: {fish: {nodes: 7}}\n"
#define FAR "solver: {coupling_distance: 100}\n"

static void per_mass(const struct fish *fish, double *value) {
    for (int k = 0; k < fish->n_nodes; k++) {
        value[fish->at.ax + k] /= fish->mass[k];
        value[fish->at.ay + k] /= fish->mass[k];
    }
}

static void value_of_forces(struct setup *setup, const double *y, const double *yp, double *value) {
    (void)yp;
    school_flow(setup, y);
    for (int f = 0; f < setup->school->n_fish; f++) {
        const struct fish *fish = &setup->school->fish[f];
        const struct flow_at_body flow = flow_at_body(setup->residual->flow, f);
        edge_force_residual(&setup->residual->force[f], &flow, y, value);
        per_mass(fish, value);
    }
}

static void jacobian_of_forces(struct setup *setup, double cj, const double *y, struct sparse *jacobian) {
    (void)cj;
    for (int f = 0; f < setup->school->n_fish; f++) {
        const struct fluid_force *const force = &setup->residual->force[f];
        const struct flow_at_body flow = flow_at_body(setup->residual->flow, f);
        edge_force_jacobian(force, &flow, y, jacobian);
        for (int g = 0; g < setup->school->n_fish; g++) {
            struct jacobian_scratch *const through = school_influence(setup, f, g);
            edge_force_flow_jacobian(force, &flow, &through->block, y, &through->rows);
            school_add_rows(setup, f, g, jacobian);
        }
    }
}

TEST(jacobian_agrees_with_differences) {
    const char *const texts[] = {
        SMALL "fish: [{force: published, sheet_points: 9}]\n",
        SMALL "fish: [{force: published, sheet_points: 9, drag: {law: linear_quadratic, tangential: 0.3}}]\n",
        SMALL "fish: [{force: published, sheet_points: 9, drag: {tangential: 0.3}, added_mass: {extent: thickness}}]\n",
        SMALL
        "fluid: {velocity: [0.3, -0.2], shear: 0.7, gust: {amplitude: 0.4, frequency: 1.3}}\n"
        "fish: [{force: published, sheet_points: 9, drag: {law: linear_quadratic}}]\n",
        SMALL "fish: [{sheet_points: 9, force: reactive}]\n",
        SMALL
        "fish: [{sheet_points: 9, force: reactive, drag: {normal: 0, tangential: 0}, added_mass: {extent: depth}}]\n",

        // swimming backwards: no flux along a leading tail
        SMALL "fish: [{sheet_points: 9, force: reactive, start: {speed: -2}, added_mass: {extent: depth}}]\n",
        SMALL
        "fluid: {velocity: [0.3, -0.2], shear: 0.7, gust: {amplitude: 0.4, frequency: 1.3}}\n"
        "fish: [{sheet_points: 9, force: reactive, body: {section: mean}, \n"
        "        drag: {law: linear_quadratic, linear_speed: 0.7}, added_mass: {extent: depth}}]\n",
        TIME FAR
        "fish:\n  - {nodes: 7, force: published, sheet_points: 9}\n"
        "  - {nodes: 5, sheet_points: 7, length: 0.7, start: {position: [0.2, 0.5], heading: 170},\n"
        "     force: reactive, drag: {law: linear_quadratic}, added_mass: {extent: depth}}\n"
        "  - {nodes: 9, force: published, sheet_points: 11, length: 1.2, start: {position: [0.1, -0.6], heading: "
        "200}}\n"};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        struct setup setup = setup_stirred(texts[i]);
        school_compare(&setup, value_of_forces, jacobian_of_forces, texts[i]);
    }
}

// total force (fx, fy) on a plate along the heading 180 degrees that moves with (vx, vy) in still fluid
static void force_on_plate(const char *keys, double vx, double vy, double ay, double force[2]) {
    struct setup setup =
        setup_with(SMALL "fish: [{body: {profile: uniform, thickness: 0.1, depth: 0.25}, %s}]\n", keys);
    const struct fish *fish = setup.school->fish;
    for (int k = 0; k < fish->n_nodes; k++) {
        setup.state->y[fish->at.vx + k] = vx;
        setup.state->y[fish->at.vy + k] = vy;
        setup.state->y[fish->at.ay + k] = ay;
    }

    const double still[64] = {0};
    const struct flow_at_body flow = {.u = still, .v = still};
    edge_force_residual(setup.residual->force, &flow, setup.state->y, setup.value);
    force[0] = force[1] = 0;
    for (int k = 0; k < fish->n_nodes; k++) {
        force[0] -= setup.value[fish->at.ax + k];
        force[1] -= setup.value[fish->at.ay + k];
    }
}

#define ADDED "added_mass: {coefficient: 1.5, extent: thickness}"

TEST(forces_on_a_plate_are_the_formulas) {
    // rho 1000, L 1, h 0.1, w 0.25, C_F 0.02, C_D 0.5, C_A 1.5
    const double pi = acos(-1), ct = 1000 * pi * 0.02 * 0.35 / 8, cn = 1000 * 0.5 * 0.1 / 2,
                 mu = pi * 1000 * 1.5 * 0.01 / 4;
    double force[2];
    force_on_plate("force: published, " ADDED ", drag: {tangential: 0.02, normal: 0.5}", -2, 0, 0, force);
    NEAR(force[0], 4 * ct, 1e-12, 1e-13);
    NEAR(force[1], 0, 1e-12, 0);
    force_on_plate("force: published, " ADDED ", drag: {tangential: 0.02, normal: 0.5}", 0, 3, 0, force);
    NEAR(force[0], 0, 1e-12, 0);
    NEAR(force[1], -9 * cn, 0, 1e-13);
    force_on_plate("force: published, " ADDED ", drag: {tangential: 0.02, normal: 0.5, law: linear_quadratic}", -2, 3,
                   0, force);
    NEAR(force[0], 6 * ct, 0, 1e-13);
    NEAR(force[1], -12 * cn, 0, 1e-13);
    force_on_plate("force: published, " ADDED ", drag: {tangential: 0.02, normal: 0.5}", 0, 0, 5, force);
    NEAR(force[1], -5 * mu, 0, 1e-13);

    // whole wetted surface; linear speed of 0.4 lengths per beat at 1.5 beats per second
    force_on_plate("force: reactive, drag: {tangential: 0.02, normal: 0.5}, added_mass: {coefficient: 0}", -2, 0, 0,
                   force);
    NEAR(force[0], 8 * ct, 0, 1e-13);
    force_on_plate(
        "force: reactive, wave: {frequency: 1.5}, drag: {tangential: 0.02, normal: 0.5, "
        "law: linear_quadratic, linear_speed: 0.4}, added_mass: {coefficient: 0, extent: thickness}",
        -2, 3, 0, force);
    NEAR(force[0], 2 * 2 * 2.6 * ct, 0, 1e-13);
    NEAR(force[1], -3 * 3.6 * cn, 0, 1e-13);
    force_on_plate("force: reactive, " ADDED, 0, 0, 5, force);
    NEAR(force[1], -5 * mu, 0, 1e-13);
}

TEST(powers_are_those_of_the_forces) {
    const char *const forces[] = {"published", "reactive"};
    for (int i = 0; i < 2; i++) {
        struct setup setup =
            setup_with(SMALL
                       "fluid: {shear: 0.5, velocity: [0, 0.3]}\n"
                       "fish: [{sheet_points: 9, force: %s, drag: {tangential: 0.3}, added_mass: {extent: depth}}]\n",
                       forces[i]);
        school_stir(&setup);
        school_flow(&setup, setup.state->y);
        const struct fish *fish = setup.school->fish;
        const struct flow_at_body flow = flow_at_body(setup.residual->flow, 0);
        const double *const y = setup.state->y;
        edge_force_residual(setup.residual->force, &flow, y, setup.value);
        double power = 0;
        for (int k = 0; k < 2 * fish->n_nodes; k++) power -= setup.value[fish->at.ax + k] * y[fish->at.vx + k];
        const struct fluid_power got = edge_force_power(setup.residual->force, &flow, y);
        NEAR(got.drag + got.added_mass + got.wake, power, 0, 1e-13);
        ABOVE(fabs(got.drag), 1e-3);
        ABOVE(fabs(got.added_mass), 1e-3);
        if (i == 1) {
            ABOVE(fabs(got.wake), 1e-3);
        } else {
            AT_MOST(fabs(got.wake), 1e-3);
        }
    }
}

TEST(friction_is_the_tangential_part_of_the_drag) {
    const double about[2] = {0.3, -0.7};
    struct setup setup = setup_stirred(SMALL
                                       "fluid: {shear: 0.5, velocity: [0, 0.3]}\n"
                                       "fish: [{}]\n");
    school_flow(&setup, setup.state->y);
    const struct fish *fish = setup.school->fish;
    const struct flow_at_body flow = flow_at_body(setup.residual->flow, 0);
    const double *const y = setup.state->y;
    double power = 0, moment = 0, resistive_moment = 0;
    for (int k = 0; k < fish->n_edges; k++) {
        const struct edge edge = edge_at(fish, k, y);
        const struct fluid_forces on = edge_force_of_edge(setup.residual->force, &flow, k, about, y);
        NEAR(edge_dot(on.friction, edge.t), edge_dot(on.resistive, edge.t), 0, 1e-12);
        NEAR(edge_dot(on.friction, edge.n), 0, 1e-12, 0);
        power += edge_dot(on.friction, edge.velocity);
        const double arm[2] = {edge.middle[0] - about[0], edge.middle[1] - about[1]};
        moment += arm[0] * on.friction[1] - arm[1] * on.friction[0];
        resistive_moment += arm[0] * on.resistive[1] - arm[1] * on.resistive[0];
    }
    const struct fluid_forces sum = edge_force_sum(setup.residual->force, &flow, about, y);
    NEAR(edge_force_power(setup.residual->force, &flow, y).friction, power, 0, 1e-12);
    NEAR(sum.friction_moment, moment, 0, 1e-12);
    NEAR(sum.resistive_moment, resistive_moment, 0, 1e-12);
    ABOVE(fabs(moment), 1e-3);
    ABOVE(fabs(resistive_moment - moment), 1e-3);
}

TEST(added_mass_takes_up_no_tangential_acceleration) {
    struct setup setup = setup_of(SMALL "fish: [{start: {speed: 0}}]\n");
    const struct fish *fish = setup.school->fish;
    for (int k = 0; k < fish->n_nodes; k++) setup.state->y[fish->at.ax + k] = 3;
    const double still[64] = {0};
    const struct flow_at_body flow = {.u = still, .v = still};
    edge_force_residual(setup.residual->force, &flow, setup.state->y, setup.value);

    // the normal of a body along 180 degrees is (0, 1) within rounding
    for (int i = fish->at.ax; i < fish->at.gamma; i++) NEAR(setup.value[i], 0, 1e-13, 0);
}

TEST(the_reactive_force_does_not_feel_the_own_wake) {
    // displacement of the nose after 1 s, from rest; the smoothing of the wake changes the velocity at the body
    const struct {
        const char *force;
        double smoothing;
    } cases[] = {{"reactive", 0.05}, {"reactive", 0.1}, {"reactive", 0.4}, {"published", 0.05}, {"published", 0.4}};
    double nose[5][2];
    for (int i = 0; i < 5; i++) {
        struct simulation *const simulation = school_simulation_of(
            "time: {end: 1, shedding_interval: 0.02}\nwake: {smoothing: %g}\n"
            "fish: [{nodes: 9, sheet_points: 17, force: %s}]\n",
            cases[i].smoothing, cases[i].force);
        school_run(simulation, 1);
        const struct fish *const fish = simulation->school->fish;
        nose[i][0] = simulation->state->y[fish->at.x];
        nose[i][1] = simulation->state->y[fish->at.y];
    }

    // the tolerance of a step is 1e-7 m; Newton's iteration, which includes the sheets, stops at a fraction of this
    // tolerance
    NEAR_ARRAY(2, nose[0], nose[1], 1e-7, 0);
    NEAR_ARRAY(2, nose[2], nose[1], 1e-7, 0);
    ABOVE(hypot(nose[4][0] - nose[3][0], nose[4][1] - nose[3][1]), 1e-4);
}
