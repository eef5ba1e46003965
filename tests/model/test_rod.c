/* test_rod.c: energies, forces, damping and their derivatives: doc/model.md, sections 2 and 3. */
#include <stdlib.h>
#include <string.h>

#include "model/rod.h"
#include "school.h"

#define TIME "time: {end: 1, shedding_interval: 0.02, output_interval: 0.02}\n"
#define BODY "body: {modulus: 1.0e+5, bending_damping: 0.7, stretching_damping: 30}"

/* The natural curvature that the tests take, and its derivative by phi0. */
static const double natural[] = {0.1, -0.2, 0.3, 0.05, -0.15};
static const double by_phi0[] = {0.3, 0.2, 0.4, 0.1, 0.5};

static void value_of_rod(struct setup *setup, const double *y, const double *yp, double *value) {
    (void)yp;
    const struct fish *fish = setup->school->fish;
    double curvature[5];
    for (int j = 0; j < 5; j++)
        curvature[j] = natural[j] + by_phi0[j] * (y[fish->at.phi0] - setup->state->y[fish->at.phi0]);
    rod_residual(fish, curvature, y, value);
    for (int k = 0; k < fish->n_nodes; k++) {
        value[fish->at.ax + k] /= fish->mass[k];
        value[fish->at.ay + k] /= fish->mass[k];
    }
}

static void jacobian_of_rod(struct setup *setup, double cj, const double *y, struct sparse *jacobian) {
    (void)cj;
    rod_jacobian(setup->school->fish, natural, by_phi0, y, jacobian);
}

static void derivatives_agree_with_differences(void **state) {
    (void)state;
    const char *const texts[] = {TIME "fish: [{" BODY "}]\n", TIME "fish: [{body: {second_moment: published}}]\n",
                                 TIME "fish: [{body: {modulus: 1.0e+9}}]\n",
                                 TIME "fish: [{body: {relaxation_time: 0.1, profile: uniform}}]\n"};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        struct setup setup;
        school_build(&setup, texts[i]);
        school_stir(&setup);
        school_compare(&setup, value_of_rod, jacobian_of_rod, texts[i]);
        school_clear(&setup);
    }
}

static double elastic_energy(const struct fish *fish, const double *y) {
    return rod_bending_energy(fish, natural, y) + rod_stretching_energy(fish, y);
}

static void elastic_force_is_minus_the_gradient_of_the_energy(void **state) {
    (void)state;
    struct setup setup;
    school_build(&setup, TIME "fish: [{" BODY "}]\n");
    school_stir(&setup);
    const struct fish *fish = setup.school->fish;
    double *const y = setup.state->y;
    // nodes at rest: no damping
    for (int i = fish->at.vx; i < fish->at.ax; i++) y[i] = 0;
    rod_residual(fish, natural, y, setup.value);
    const double h = 1e-5;
    for (int i = 0; i < 2 * fish->n_nodes; i++) {
        const double here = y[i];
        y[i] = here + h;
        const double high = elastic_energy(fish, y);
        y[i] = here - h;
        const double low = elastic_energy(fish, y);
        y[i] = here;
        // truncation h^2/6 (EA/l^2 in the third derivative, 1e6); rounding 1e-15/h
        NEAR(setup.value[fish->at.ax + i], (high - low) / (2 * h), 1e-4, 0);
    }
    school_clear(&setup);
}

static void internal_forces_have_no_sum_and_no_moment(void **state) {
    (void)state;
    struct setup setup;
    school_build(&setup, TIME "fish: [{" BODY "}]\n");
    school_stir(&setup);
    const struct fish *fish = setup.school->fish;
    const double *const y = setup.state->y;
    rod_residual(fish, natural, y, setup.value);
    double sum[2] = {0, 0}, moment = 0, size = 0;
    for (int k = 0; k < fish->n_nodes; k++) {
        const double fx = setup.value[fish->at.ax + k], fy = setup.value[fish->at.ay + k];
        sum[0] += fx;
        sum[1] += fy;
        moment += y[fish->at.x + k] * fy - y[fish->at.y + k] * fx;
        size += hypot(fx, fy);
    }
    // rounding of the forces themselves
    NEAR(sum[0] / size, 0, 1e-15, 0);
    NEAR(sum[1] / size, 0, 1e-15, 0);
    NEAR(moment / size, 0, 1e-14, 0);
    school_clear(&setup);
}

static void damping_power_is_that_of_the_damping_forces_and_never_positive(void **state) {
    (void)state;
    struct setup setup;
    school_build(&setup, TIME "fish: [{" BODY "}]\n");
    school_stir(&setup);
    const struct fish *fish = setup.school->fish;
    double *const y = setup.state->y;
    double *const elastic = calloc((size_t)fish->at.end, sizeof *elastic);
    assert_non_null(elastic);
    for (int trial = 0; trial < 10; trial++) {
        memset(elastic, 0, (size_t)fish->at.end * sizeof *elastic);
        memset(setup.value, 0, (size_t)fish->at.end * sizeof *setup.value);
        double velocity[14];
        for (int i = 0; i < 14; i++) velocity[i] = school_random(&setup);
        memset(y + fish->at.vx, 0, sizeof velocity);
        rod_residual(fish, natural, y, elastic);
        memcpy(y + fish->at.vx, velocity, sizeof velocity);
        rod_residual(fish, natural, y, setup.value);
        double power = 0, size = 0;
        for (int i = 0; i < 14; i++) {
            power -= (setup.value[fish->at.ax + i] - elastic[fish->at.ax + i]) * velocity[i];
            size += fabs(elastic[fish->at.ax + i]);
        }
        // rounding of the elastic forces that are taken off
        NEAR(rod_damping_power(fish, y), power, 1e-14 * size, 1e-12);
        assert_true(rod_damping_power(fish, y) < 0);
    }
    free(elastic);
    school_clear(&setup);
}

static void rigid_motion_is_not_damped(void **state) {
    (void)state;
    struct setup setup;
    school_build(&setup, TIME "fish: [{" BODY "}]\n");
    school_stir(&setup);
    const struct fish *fish = setup.school->fish;
    double *const y = setup.state->y;
    for (int k = 0; k < fish->n_nodes; k++) {
        y[fish->at.vx + k] = 0.3 - 2 * y[fish->at.y + k];
        y[fish->at.vy + k] = -0.1 + 2 * y[fish->at.x + k];
    }
    NEAR(rod_damping_power(fish, y), 0, 1e-25, 0);
    school_clear(&setup);
}

// nodes on a regular polygon: every joint turned by the angle, edges of natural length times stretch
static void bend(struct setup *setup, double angle, double stretch) {
    const struct fish *fish = setup->school->fish;
    double *const y = setup->state->y;
    double direction = 0.4;
    for (int k = 0; k < fish->n_edges; k++) {
        y[fish->at.x + k + 1] = y[fish->at.x + k] + stretch * fish->edge_length * cos(direction);
        y[fish->at.y + k + 1] = y[fish->at.y + k] + stretch * fish->edge_length * sin(direction);
        direction += angle;
    }
    for (int i = fish->at.vx; i < fish->at.ax; i++) y[i] = 0;
}

static void energies_of_a_regular_polygon_are_exact(void **state) {
    (void)state;
    struct setup setup;
    school_build(&setup, TIME "fish: [{body: {profile: uniform, thickness: 0.1, modulus: 2.0e+5}}]\n");
    const struct fish *fish = setup.school->fish;
    const double straight[5] = {0}, angle = 0.3, stretch = 1.05, pi = acos(-1);
    bend(&setup, angle, stretch);
    const double EI = 2e5 * pi * 0.25 * 0.001 / 64, EA = 2e5 * pi * 0.1 * 0.25 / 4, kappa = 2 * tan(0.15), l = 1.0 / 6;
    double curvature[5];
    rod_curvature(fish, setup.state->y, curvature);
    for (int j = 0; j < 5; j++) NEAR(curvature[j], kappa, 1e-14, 0);
    // rounding of 1e-16 in places a sixth apart
    NEAR(rod_bending_energy(fish, straight, setup.state->y), 5 * EI * kappa * kappa / (2 * l), 0, 1e-13);
    NEAR(rod_stretching_energy(fish, setup.state->y), EA * 0.05 * 0.05 / 2, 0, 1e-12);
    school_clear(&setup);
}

static void energy_of_a_circular_arc_converges_to_that_of_the_continuum(void **state) {
    (void)state;
    const char *const texts[] = {TIME "fish: [{nodes: 21, body: {profile: uniform, thickness: 0.1}}]\n",
                                 TIME "fish: [{nodes: 41, body: {profile: uniform, thickness: 0.1}}]\n"};
    double error[2];
    for (int i = 0; i < 2; i++) {
        struct setup setup;
        school_build(&setup, texts[i]);
        const double straight[64] = {0}, R = 0.5, pi = acos(-1), EI = 1e6 * pi * 0.25 * 0.001 / 64;
        const struct fish *fish = setup.school->fish;
        bend(&setup, fish->edge_length / R, 1);
        // N - 2 joints bend, of N - 1 that a closed ring would have: per joint EI lbar/(2 R^2)
        const double energy = rod_bending_energy(fish, straight, setup.state->y) * fish->n_edges / fish->n_joints;
        error[i] = energy / (EI / (2 * R * R)) - 1;
        school_clear(&setup);
    }
    // 2 tan(phi/2)/phi = 1 + phi^2/12: second order
    NEAR(log2(error[0] / error[1]), 2, 0.01, 0);
    NEAR(error[1], 0.05 * 0.05 / 6, 0, 0.01);
}

static void polygon_of_the_natural_curvature_is_at_rest(void **state) {
    (void)state;
    struct setup setup;
    school_build(&setup, TIME "fish: [{" BODY "}]\n");
    const struct fish *fish = setup.school->fish;
    const double angle = 0.4, kappa = 2 * tan(0.2), curvature[5] = {kappa, kappa, kappa, kappa, kappa};
    bend(&setup, angle, 1);
    rod_residual(fish, curvature, setup.state->y, setup.value);
    // EA = 4e3 N times the rounding of the length
    for (int i = fish->at.ax; i < fish->at.gamma; i++) NEAR(setup.value[i], 0, 1e-10, 0);
    NEAR(rod_bending_energy(fish, curvature, setup.state->y) + rod_stretching_energy(fish, setup.state->y), 0, 1e-20,
         0);
    school_clear(&setup);
}

static void turning_angles_keep_their_sign_in_every_direction(void **state) {
    (void)state;
    struct setup setup;
    school_build(&setup, TIME "fish: [{}]\n");
    double curvature[5];
    // the body turns by 1.2 rad at each of five joints: almost once round, through the cut of the arc tangent
    for (int sign = -1; sign <= 1; sign += 2) {
        bend(&setup, 1.2 * sign, 1);
        rod_curvature(setup.school->fish, setup.state->y, curvature);
        for (int j = 0; j < 5; j++) NEAR(curvature[j], sign * 2 * tan(0.6), 1e-13, 0);
    }
    school_clear(&setup);
}

static void muscle_power_is_the_change_of_energy_at_a_fixed_shape(void **state) {
    (void)state;
    struct setup setup;
    school_build(&setup, TIME "fish: [{" BODY "}]\n");
    school_stir(&setup);
    const struct fish *fish = setup.school->fish;
    const double rate[5] = {0.5, -1, 2, 0.3, 1}, h = 1e-4;
    double low[5], high[5];
    for (int j = 0; j < 5; j++) {
        low[j] = natural[j] - h * rate[j];
        high[j] = natural[j] + h * rate[j];
    }
    const double *const y = setup.state->y;
    // the energy is quadratic in the natural curvature: central differences are exact but for rounding, 1e-16 E/h
    NEAR(rod_actuation_power(fish, natural, rate, y),
         (rod_bending_energy(fish, high, y) - rod_bending_energy(fish, low, y)) / (2 * h), 1e-10, 1e-10);
    assert_true(fabs(rod_actuation_power(fish, natural, rate, y)) > 1e-3);
    school_clear(&setup);
}

static void a_body_is_torn_at_ten_times_the_length_of_an_edge(void **state) {
    (void)state;
    struct setup setup;
    school_build(&setup, "time: {end: 1}\nfish: [{nodes: 7}]\n");
    const struct fish *const fish = setup.school->fish;
    double *const tail = &setup.state->y[fish->at.x + 6];
    const double before = tail[-1], sign = *tail > before ? 1 : -1;
    *tail = before + 9.9 * sign * fish->edge_length;
    assert_false(rod_is_torn(fish, setup.state->y));
    *tail = before + 10.1 * sign * fish->edge_length;
    assert_true(rod_is_torn(fish, setup.state->y));
    school_clear(&setup);
}

static void the_shortest_edge_is_the_one_compressed_most(void **state) {
    (void)state;
    struct setup setup;
    school_build(&setup, "time: {end: 1}\nfish: [{nodes: 7, wave: {amplitude: 0}}]\n");
    const struct fish *const fish = setup.school->fish;
    double *const x = &setup.state->y[fish->at.x], ratio;
    rod_shortest_edge(fish, setup.state->y, &ratio);
    NEAR(ratio, 1, 1e-14, 0);
    x[3] += 0.7 * (x[4] - x[3]);
    assert_int_equal(rod_shortest_edge(fish, setup.state->y, &ratio), 3);
    NEAR(ratio, 0.3, 1e-14, 0);
    school_clear(&setup);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(derivatives_agree_with_differences),
        cmocka_unit_test(elastic_force_is_minus_the_gradient_of_the_energy),
        cmocka_unit_test(internal_forces_have_no_sum_and_no_moment),
        cmocka_unit_test(damping_power_is_that_of_the_damping_forces_and_never_positive),
        cmocka_unit_test(rigid_motion_is_not_damped),
        cmocka_unit_test(energies_of_a_regular_polygon_are_exact),
        cmocka_unit_test(energy_of_a_circular_arc_converges_to_that_of_the_continuum),
        cmocka_unit_test(polygon_of_the_natural_curvature_is_at_rest),
        cmocka_unit_test(turning_angles_keep_their_sign_in_every_direction),
        cmocka_unit_test(the_shortest_edge_is_the_one_compressed_most),
        cmocka_unit_test(a_body_is_torn_at_ten_times_the_length_of_an_edge),
        cmocka_unit_test(muscle_power_is_the_change_of_energy_at_a_fixed_shape),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
