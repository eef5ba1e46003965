/* test_drag.c: drag and added mass of the edges: doc/model.md, section 9. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "model/drag.h"
#include "school.h"

#define TIME "time: {end: 1, shedding_interval: 0.02, output_interval: 0.02}\n"
#define FAR "solver: {coupling_distance: 100}\n"

static const double *flow_u(const struct setup *setup, int f) {
    return setup->residual->flow->u + setup->residual->flow->points[f].first;
}
static const double *flow_v(const struct setup *setup, int f) {
    return setup->residual->flow->v + setup->residual->flow->points[f].first;
}

static void per_mass(const struct fish *fish, double *value) {
    for (int k = 0; k < fish->n_nodes; k++) {
        value[fish->at.ax + k] /= fish->mass[k];
        value[fish->at.ay + k] /= fish->mass[k];
    }
}

// the moment's row, with a factor, in the row of the bias
static const double factor = -0.7;

static void value_of_drag(struct setup *setup, const double *y, const double *yp, double *value) {
    (void)yp;
    school_flow(setup, y);
    for (int f = 0; f < setup->school->n_fish; f++) {
        const struct fish *fish = &setup->school->fish[f];
        drag_residual(fish, flow_u(setup, f), flow_v(setup, f), y, value);
        per_mass(fish, value);
        value[fish->at.phi0] = factor * drag_moment(fish, flow_u(setup, f), flow_v(setup, f), y);
    }
}

static void stamp_of_drag(struct setup *setup, double cj, const double *y, struct sparse *jacobian) {
    (void)cj;
    for (int f = 0; f < setup->school->n_fish; f++) {
        const struct fish *fish = &setup->school->fish[f];
        const double *const u = flow_u(setup, f), *const v = flow_v(setup, f);
        drag_jacobian(fish, u, v, y, jacobian);
        drag_moment_jacobian(fish, factor, u, v, y, jacobian);
        for (int g = 0; g < setup->school->n_fish; g++) {
            struct jacobian_scratch *const through = school_stamping(setup, f, g);
            drag_flow_jacobian(fish, u, v, &through->block, y, &through->rows);
            drag_moment_flow_jacobian(fish, factor, u, v, &through->block, y, &through->rows);
            school_add_rows(setup, f, g, jacobian);
        }
    }
}

static void stamps_agree_with_differences(void **state) {
    (void)state;
    const char *const texts[] = {
        TIME "fish: [{sheet_points: 9}]\n",
        TIME "fish: [{sheet_points: 9, drag: {law: linear_quadratic, tangential: 0.3}}]\n",
        TIME "fish: [{sheet_points: 9, drag: {extent: width, tangential: 0.3}}]\n",
        TIME
        "fluid: {velocity: [0.3, -0.2], shear: 0.7, gust: {amplitude: 0.4, frequency: 1.3}}\n"
        "fish: [{sheet_points: 9, drag: {law: linear_quadratic, extent: width}}]\n",
        TIME FAR
        "fish:\n"
        "  - {sheet_points: 9}\n"
        "  - {nodes: 5, sheet_points: 7, length: 0.7, start: {position: [0.2, 0.5], heading: 170},\n"
        "     drag: {law: linear_quadratic, extent: width}}\n"
        "  - {nodes: 9, sheet_points: 11, length: 1.2, start: {position: [0.1, -0.6], heading: 200}}\n"};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        struct setup setup;
        school_build(&setup, texts[i]);
        school_stir(&setup);
        school_compare(&setup, value_of_drag, stamp_of_drag, texts[i]);
        school_clear(&setup);
    }
}

// a plate along the heading 180 degrees that moves with (vx, vy) in still fluid: total force into (fx, fy)
static void force_on_plate(const char *law, double vx, double vy, double ay, double force[2]) {
    char text[256];
    snprintf(text, sizeof text,
             TIME "fish: [{body: {profile: uniform, thickness: 0.1}, drag: {law: %s, tangential: 0.02}}]\n", law);
    struct setup setup;
    school_build(&setup, text);
    const struct fish *fish = setup.school->fish;
    for (int k = 0; k < fish->n_nodes; k++) {
        setup.state->y[fish->at.vx + k] = vx;
        setup.state->y[fish->at.vy + k] = vy;
        setup.state->y[fish->at.ay + k] = ay;
    }
    const double still[64] = {0};
    drag_residual(fish, still, still, setup.state->y, setup.value);
    force[0] = force[1] = 0;
    for (int k = 0; k < fish->n_nodes; k++) {
        force[0] -= setup.value[fish->at.ax + k];
        force[1] -= setup.value[fish->at.ay + k];
    }
    school_clear(&setup);
}

static void forces_on_a_plate_are_the_formulas(void **state) {
    (void)state;
    // rho 1000, L 1, h 0.1, w 0.25, C_F 0.02, C_D 0.5, C_A 1.5
    const double ct = 1000 * acos(-1) * 0.02 * 0.35 / 8, cn = 1000 * 0.5 * 0.1 / 2,
                 mu = acos(-1) * 1000 * 1.5 * 0.01 / 4;
    double force[2];
    force_on_plate("quadratic", -2, 0, 0, force);
    NEAR(force[0], 4 * ct, 1e-12, 1e-13);
    NEAR(force[1], 0, 1e-12, 0);
    force_on_plate("quadratic", 0, 3, 0, force);
    NEAR(force[0], 0, 1e-12, 0);
    NEAR(force[1], -9 * cn, 0, 1e-13);
    force_on_plate("linear_quadratic", -2, 3, 0, force);
    NEAR(force[0], 6 * ct, 0, 1e-13);
    NEAR(force[1], -12 * cn, 0, 1e-13);
    force_on_plate("quadratic", 0, 0, 5, force);
    NEAR(force[1], -5 * mu, 0, 1e-13);
}

static void powers_are_those_of_the_forces(void **state) {
    (void)state;
    struct setup setup;
    school_build(&setup, TIME "fish: [{sheet_points: 9, drag: {tangential: 0.3}}]\n");
    school_stir(&setup);
    school_flow(&setup, setup.state->y);
    const struct fish *fish = setup.school->fish;
    const double *const u = flow_u(&setup, 0), *const v = flow_v(&setup, 0);
    double *const y = setup.state->y;
    double power[2] = {0, 0};
    for (int part = 0; part < 2; part++) {
        // the second time without drag's counterpart: accelerations zero leave the drag alone
        memset(setup.value, 0, (size_t)fish->at.end * sizeof *setup.value);
        drag_residual(fish, u, v, y, setup.value);
        for (int i = 0; i < 2 * fish->n_nodes; i++) power[part] -= setup.value[fish->at.ax + i] * y[fish->at.vx + i];
        if (part == 0) NEAR(drag_power(fish, u, v, y) + drag_added_mass_power(fish, y), power[0], 0, 1e-13);
        memset(y + fish->at.ax, 0, 2 * (size_t)fish->n_nodes * sizeof *y);
    }
    // half of an edge's force on each of its nodes works with the mean of their velocities
    NEAR(drag_power(fish, u, v, y), power[1], 0, 1e-13);
    NEAR(drag_added_mass_power(fish, y), 0, 0, 0);
    school_clear(&setup);
}

static void moment_is_that_of_the_forces_that_the_flow_adds(void **state) {
    (void)state;
    struct setup setup;
    school_build(
        &setup, TIME
        "fluid: {velocity: [0.3, -0.2], shear: 0.7}\nfish: [{sheet_points: 9, length: 1.1, wave: {frequency: 1.2}}]\n");
    school_stir(&setup);
    school_flow(&setup, setup.state->y);
    const struct fish *fish = setup.school->fish;
    const double *const y = setup.state->y, still[64] = {0};
    double *const without = calloc((size_t)fish->at.end, sizeof *without);
    assert_non_null(without);
    drag_residual(fish, flow_u(&setup, 0), flow_v(&setup, 0), y, setup.value);
    drag_residual(fish, still, still, y, without);
    double com[2] = {0, 0}, moment = 0;
    for (int k = 0; k < fish->n_nodes; k++) {
        com[0] += fish->mass[k] * y[fish->at.x + k] / fish->total_mass;
        com[1] += fish->mass[k] * y[fish->at.y + k] / fish->total_mass;
    }
    for (int k = 0; k < fish->n_nodes; k++) {
        moment += (y[fish->at.x + k] - com[0]) * (without[fish->at.ay + k] - setup.value[fish->at.ay + k]) -
                  (y[fish->at.y + k] - com[1]) * (without[fish->at.ax + k] - setup.value[fish->at.ax + k]);
    }
    // rho w L^2 (L f)^2
    const double scale = 1000 * 0.25 * 1.1 * 1.1 * 1.1 * pow(1.1 * 1.2, 2);
    NEAR(drag_moment(fish, flow_u(&setup, 0), flow_v(&setup, 0), y), moment / scale, 1e-14, 1e-12);
    assert_true(fabs(moment / scale) > 1e-4);
    NEAR(drag_moment(fish, still, still, y), 0, 0, 0);
    free(without);
    school_clear(&setup);
}

static void added_mass_takes_up_no_tangential_acceleration(void **state) {
    (void)state;
    struct setup setup;
    school_build(&setup, TIME "fish: [{start: {speed: 0}}]\n");
    const struct fish *fish = setup.school->fish;
    for (int k = 0; k < fish->n_nodes; k++) setup.state->y[fish->at.ax + k] = 3;
    const double still[64] = {0};
    drag_residual(fish, still, still, setup.state->y, setup.value);
    // the normal of a body along 180 degrees is (0, 1) up to rounding
    for (int i = fish->at.ax; i < fish->at.gamma; i++) NEAR(setup.value[i], 0, 1e-13, 0);
    school_clear(&setup);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(stamps_agree_with_differences),
        cmocka_unit_test(forces_on_a_plate_are_the_formulas),
        cmocka_unit_test(powers_are_those_of_the_forces),
        cmocka_unit_test(moment_is_that_of_the_forces_that_the_flow_adds),
        cmocka_unit_test(added_mass_takes_up_no_tangential_acceleration),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
