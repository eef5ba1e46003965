/* test_drag.c: the drag on an edge, and the moment of what the flow adds: doc/model.md, sections 9 and 11. */
#include "model/drag.h"
#include "model/flow_at_bodies.h"
#include "school.h"

#define TIME "time: {end: 1, shedding_interval: 0.02, output_interval: 0.02}\n"

static const double *flow_u(const struct setup *setup, int f) {
    return setup->residual->flow->u + setup->residual->flow->points[f].first;
}
static const double *flow_v(const struct setup *setup, int f) {
    return setup->residual->flow->v + setup->residual->flow->points[f].first;
}

static void slope_of_the_force_agrees_with_differences(void **state) {
    (void)state;
    const char *const texts[] = {TIME "fish: [{drag: {tangential: 0.3}}]\n",
                                 TIME "fish: [{drag: {tangential: 0.3, law: linear_quadratic}}]\n",
                                 TIME "fluid: {viscosity: 0.1}\nfish: [{drag: {skin: laminar}}]\n"};
    for (int i = 0; i < 3; i++) {
        struct setup setup;
        school_build(&setup, texts[i]);
        const struct fish *fish = setup.school->fish;
        const double h = 1e-5, w[2] = {-0.4, 0.3}, angle = 0.7;
        const struct edge edge = {.t = {cos(angle), sin(angle)}, .n = {-sin(angle), cos(angle)}};
        double by_velocity[2][2], by_turn[2], force[2][2];
        drag_slope(fish, 2, &edge, w, by_velocity, by_turn);
        for (int j = 0; j < 3; j++) {
            for (int side = 0; side < 2; side++) {
                const double step = side == 0 ? -h : h, turned = angle + (j == 2 ? step : 0);
                const struct edge other = {.t = {cos(turned), sin(turned)}, .n = {-sin(turned), cos(turned)}};
                const double moved[2] = {w[0] + (j == 0 ? step : 0), w[1] + (j == 1 ? step : 0)};
                drag_force(fish, 2, &other, moved, force[side]);
            }
            // the force is quadratic in w and in cosine and sine: what is cut off is of size h^2
            for (int c = 0; c < 2; c++) {
                NEAR(j == 2 ? by_turn[c] : by_velocity[c][j], (force[1][c] - force[0][c]) / (2 * h), 1e-8, 1e-8);
            }
        }
        school_clear(&setup);
    }
}

// Blasius: 1.328 rho w sqrt(nu L) U^(3/2) for both sides
static void laminar_friction_of_a_plate_is_that_of_its_boundary_layer(void **state) {
    (void)state;
    struct setup setup;
    school_build(&setup, TIME
                 "fluid: {viscosity: 0.002, density: 3}\n"
                 "fish: [{length: 2, body: {width: 0.4}, wave: {frequency: 0}, start: {speed: 0.5},\n"
                 "        drag: {skin: laminar, normal: 0}}]\n");
    const struct fish *fish = setup.school->fish;
    const struct edge edge = {.t = {1, 0}, .n = {0, 1}};
    const double w[2] = {-0.7, 0.3}, slow[2] = {1e-9, 0};
    double total[2] = {0, 0}, across = 0, force[2], friction[2];
    for (int k = 0; k < fish->n_edges; k++) {
        drag_force(fish, k, &edge, w, force);
        drag_friction(fish, k, &edge, w, friction);
        total[0] += force[0];
        total[1] += friction[0];
        across += fabs(force[1]) + fabs(friction[1]);
    }
    const double blasius = 1.328 * 3 * 0.8 * sqrt(0.002 * 2) * pow(0.7, 1.5);
    for (int i = 0; i < 2; i++) NEAR(total[i], blasius, 0, 1e-8);  // u0 = 1e-4 * 0.5 m/s
    NEAR(across, 0, 0, 0);
    // near rest it is linear: (u0)^(1/2) u
    drag_force(fish, 0, &edge, slow, force);
    NEAR(force[0], -blasius / pow(0.7, 1.5) * sqrt(1.0 / 6) * sqrt(0.5e-4) * 1e-9, 0, 1e-8);
    school_clear(&setup);
}

static double moment_about(const struct fish *fish, const double *u, const double *v, const double *y,
                           const double com[2]) {
    double moment = 0;
    for (int k = 0; k < fish->n_edges; k++) {
        const struct edge edge = edge_at(fish, k, y);
        double w[2], force[2];
        flow_relative_velocity(fish, k, edge.velocity, u, v, w);
        drag_force(fish, k, &edge, w, force);
        moment += (edge.middle[0] - com[0]) * force[1] - (edge.middle[1] - com[1]) * force[0];
    }
    return moment;
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
    double com[2] = {0, 0};
    for (int k = 0; k < fish->n_nodes; k++) {
        com[0] += fish->mass[k] * y[fish->at.x + k] / fish->total_mass;
        com[1] += fish->mass[k] * y[fish->at.y + k] / fish->total_mass;
    }
    const double moment =
        moment_about(fish, flow_u(&setup, 0), flow_v(&setup, 0), y, com) - moment_about(fish, still, still, y, com);
    // rho w L^2 (L f)^2
    const double scale = 1000 * 0.25 * 1.1 * 1.1 * 1.1 * pow(1.1 * 1.2, 2);
    NEAR(drag_moment(fish, flow_u(&setup, 0), flow_v(&setup, 0), y), moment / scale, 1e-14, 1e-12);
    assert_true(fabs(moment / scale) > 1e-4);
    NEAR(drag_moment(fish, still, still, y), 0, 0, 0);
    school_clear(&setup);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(slope_of_the_force_agrees_with_differences),
        cmocka_unit_test(laminar_friction_of_a_plate_is_that_of_its_boundary_layer),
        cmocka_unit_test(moment_is_that_of_the_forces_that_the_flow_adds),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
