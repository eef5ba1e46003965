/* test_rod.c: The forces of the rod are the gradient of its energy, its damping dissipates as much as the model says,
 * and all derivatives agree with differences (doc/model.md, sections 2 and 3). */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "body/rod.h"
#include "school.h"

#define TIME "time: {end: 1, shedding_interval: 0.02, output_interval: 0.02}\n"
#define SMALL TIME "defaults: {fish: {nodes: 7}}\n"
#define BODY "body: {modulus: 1.0e+5, damping: curvature, bending_damping: 0.7, stretching_damping: 30}"
#define STRAIN \
    "body: {modulus: 1.0e+5, damping: strain, bending_damping: 0.7, stretching_damping: 30, relaxation_time: 0.1}"

/* Natural curvature, rate of natural curvature, and derivatives of both by phi0. */
static double natural[] = {0.1, -0.2, 0.3, 0.05, -0.15}, natural_rate[] = {0.5, -1, 2, 0.3, 1};
static double by_phi0[] = {0.3, 0.2, 0.4, 0.1, 0.5}, rate_by_phi0[] = {-2, 1, 3, -1, 4};
static const struct actuation muscle = {natural, natural_rate, by_phi0, rate_by_phi0};
static double zero[64];
static const struct actuation no_muscle = {zero, zero, zero, zero};

/* Energies and powers from the node positions. */
static struct rod_energetics energetics_of(const struct fish *fish, const struct actuation *asked, const double *y) {
    double strain[128], rate[128], stress[128];
    const struct rod_strains strains = {strain, rate, stress};
    AT_MOST(rod_n_strains(fish), 128);
    rod_strains(fish, asked, y, &strains);
    return rod_energetics(fish, asked, &strains);
}

static double bending_energy(const struct fish *fish, const struct actuation *asked, const double *y) {
    return energetics_of(fish, asked, y).bending;
}

static double damping_power(const struct fish *fish, const struct actuation *asked, const double *y) {
    return energetics_of(fish, asked, y).damping;
}

static double stretching_energy(const struct fish *fish, const double *y) {
    return energetics_of(fish, &no_muscle, y).stretching;
}

static double actuation_power(const struct fish *fish, const double *y) {
    return energetics_of(fish, &muscle, y).actuation;
}

static void value_of_rod(struct setup *setup, const double *y, const double *yp, double *value) {
    (void)yp;
    const struct fish *fish = setup->school->fish;
    double curvature[5], rate[5];
    for (int j = 0; j < 5; j++) {
        const double more = y[fish->at.phi0] - setup->state->y[fish->at.phi0];
        curvature[j] = natural[j] + by_phi0[j] * more;
        rate[j] = natural_rate[j] + rate_by_phi0[j] * more;
    }
    rod_residual(fish, &(struct actuation){.curvature = curvature, .rate = rate}, y, value);
    for (int k = 0; k < fish->n_nodes; k++) {
        value[fish->at.ax + k] /= fish->mass[k];
        value[fish->at.ay + k] /= fish->mass[k];
    }
}

static void jacobian_of_rod(struct setup *setup, double cj, const double *y, struct sparse *jacobian) {
    (void)cj;
    rod_jacobian(setup->school->fish, &muscle, y, jacobian);
}

TEST(derivatives_agree_with_differences) {
    const char *const texts[] = {SMALL "fish: [{" BODY "}]\n", SMALL "fish: [{body: {second_moment: published}}]\n",
                                 SMALL "fish: [{body: {modulus: 1.0e+9}}]\n",
                                 SMALL "fish: [{body: {relaxation_time: 0.1, profile: uniform}}]\n",
                                 SMALL "fish: [{" STRAIN "}]\n"};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        struct setup setup = setup_stirred(texts[i]);
        school_compare(&setup, value_of_rod, jacobian_of_rod, texts[i]);
    }
}

static double elastic_energy(const struct fish *fish, const double *y) {
    return bending_energy(fish, &muscle, y) + stretching_energy(fish, y);
}

TEST(elastic_force_is_minus_the_gradient_of_the_energy) {
    struct setup setup = setup_stirred(SMALL "fish: [{" BODY "}]\n");
    const struct fish *fish = setup.school->fish;
    double *const y = setup.state->y;
    // nodes at rest: no damping
    for (int i = fish->at.vx; i < fish->at.ax; i++) y[i] = 0;
    rod_residual(fish, &muscle, y, setup.value);
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
}

TEST(internal_forces_have_no_sum_and_no_moment) {
    struct setup setup = setup_stirred(SMALL "fish: [{" BODY "}]\n");
    const struct fish *fish = setup.school->fish;
    const double *const y = setup.state->y;
    rod_residual(fish, &muscle, y, setup.value);
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
}

TEST(damping_power_is_that_of_the_damping_forces_and_never_positive) {
    struct setup setup = setup_stirred(SMALL "fish: [{" BODY "}]\n");
    const struct fish *fish = setup.school->fish;
    double *const y = setup.state->y;
    double *const elastic = test_array(fish->at.end);
    for (int trial = 0; trial < 10; trial++) {
        memset(elastic, 0, (size_t)fish->at.end * sizeof *elastic);
        memset(setup.value, 0, (size_t)fish->at.end * sizeof *setup.value);
        double velocity[14];
        for (int i = 0; i < 14; i++) velocity[i] = school_random(&setup);
        memset(y + fish->at.vx, 0, sizeof velocity);
        rod_residual(fish, &muscle, y, elastic);
        memcpy(y + fish->at.vx, velocity, sizeof velocity);
        rod_residual(fish, &muscle, y, setup.value);
        double power = 0, size = 0;
        for (int i = 0; i < 14; i++) {
            power -= (setup.value[fish->at.ax + i] - elastic[fish->at.ax + i]) * velocity[i];
            size += fabs(elastic[fish->at.ax + i]);
        }
        // rounding of the subtracted elastic forces
        NEAR(damping_power(fish, &muscle, y), power, 1e-14 * size, 1e-12);
        BELOW(damping_power(fish, &muscle, y), 0);
    }
}

TEST(rigid_motion_is_not_damped) {
    struct setup setup = setup_stirred(SMALL "fish: [{" BODY "}]\n");
    const struct fish *fish = setup.school->fish;
    double *const y = setup.state->y;
    for (int k = 0; k < fish->n_nodes; k++) {
        y[fish->at.vx + k] = 0.3 - 2 * y[fish->at.y + k];
        y[fish->at.vy + k] = -0.1 + 2 * y[fish->at.x + k];
    }
    NEAR(damping_power(fish, &muscle, y), 0, 1e-25, 0);
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

TEST(energies_of_a_regular_polygon_are_exact) {
    struct setup setup =
        setup_of(SMALL "fish: [{body: {profile: uniform, thickness: 0.1, depth: 0.25, modulus: 2.0e+5}}]\n");
    const struct fish *fish = setup.school->fish;
    const double angle = 0.3, stretch = 1.05, pi = acos(-1);
    bend(&setup, angle, stretch);
    const double EI = 2e5 * pi * 0.25 * 0.001 / 64, EA = 2e5 * pi * 0.1 * 0.25 / 4, kappa = 2 * tan(0.15), l = 1.0 / 6;
    double curvature[5];
    rod_curvature(fish, setup.state->y, curvature);
    for (int j = 0; j < 5; j++) NEAR(curvature[j], kappa / l, 1e-13, 0);
    // rounding of 1e-16 in positions a sixth apart
    NEAR(bending_energy(fish, &no_muscle, setup.state->y), 5 * EI * kappa * kappa / (2 * l), 0, 1e-13);
    NEAR(stretching_energy(fish, setup.state->y), EA * 0.05 * 0.05 / 2, 0, 1e-12);
}

TEST(energy_of_a_circular_arc_converges_to_that_of_the_continuum) {
    const char *const texts[] = {
        TIME "fish: [{nodes: 21, body: {profile: uniform, thickness: 0.1, depth: 0.25, modulus: 1e6}}]\n",
        TIME "fish: [{nodes: 41, body: {profile: uniform, thickness: 0.1, depth: 0.25, modulus: 1e6}}]\n"};
    double error[2];
    for (int i = 0; i < 2; i++) {
        struct setup setup = setup_of(texts[i]);
        const double R = 0.5, pi = acos(-1), EI = 1e6 * pi * 0.25 * 0.001 / 64;
        const struct fish *fish = setup.school->fish;
        bend(&setup, fish->edge_length / R, 1);
        // N - 2 joints bend, a closed ring has N - 1 joints: per joint EI lbar/(2 R^2)
        const double energy = bending_energy(fish, &no_muscle, setup.state->y) * fish->n_edges / fish->n_joints;
        error[i] = energy / (EI / (2 * R * R)) - 1;
    }
    // 2 tan(phi/2)/phi = 1 + phi^2/12: second order
    NEAR(log2(error[0] / error[1]), 2, 0.01, 0);
    NEAR(error[1], 0.05 * 0.05 / 6, 0, 0.01);
}

TEST(polygon_of_the_natural_curvature_is_at_rest) {
    struct setup setup = setup_of(SMALL "fish: [{" BODY "}]\n");
    const struct fish *fish = setup.school->fish;
    const double angle = 0.4, kappa = 2 * tan(0.2);
    double curvature[5] = {kappa, kappa, kappa, kappa, kappa};
    const struct actuation bent = {curvature, zero, zero, zero};
    bend(&setup, angle, 1);
    rod_residual(fish, &bent, setup.state->y, setup.value);
    // EA = 4e3 N times the rounding of the length
    for (int i = fish->at.ax; i < fish->at.gamma; i++) NEAR(setup.value[i], 0, 1e-10, 0);
    NEAR(bending_energy(fish, &bent, setup.state->y) + stretching_energy(fish, setup.state->y), 0, 1e-20, 0);
}

TEST(turning_angles_keep_their_sign_in_every_direction) {
    struct setup setup = setup_of(SMALL "fish: [{}]\n");
    double curvature[5];
    // the body turns by 1.2 rad at each of five joints: almost once round, through the cut of the arc tangent
    for (int sign = -1; sign <= 1; sign += 2) {
        bend(&setup, 1.2 * sign, 1);
        rod_curvature(setup.school->fish, setup.state->y, curvature);
        for (int j = 0; j < 5; j++) NEAR(curvature[j], sign * 2 * tan(0.6) * 6, 1e-12, 0);
    }
}

TEST(muscle_power_is_the_change_of_energy_at_a_fixed_shape) {
    struct setup setup = setup_stirred(SMALL "fish: [{" BODY "}]\n");
    const struct fish *fish = setup.school->fish;
    const double h = 1e-4;
    double low[5], high[5];
    for (int j = 0; j < 5; j++) {
        low[j] = natural[j] - h * natural_rate[j];
        high[j] = natural[j] + h * natural_rate[j];
    }
    const struct actuation before = {low, zero, zero, zero}, after = {high, zero, zero, zero};
    const double *const y = setup.state->y;
    // the energy is quadratic in the natural curvature: central differences are exact but for rounding, 1e-16 E/h
    NEAR(actuation_power(fish, y), (bending_energy(fish, &after, y) - bending_energy(fish, &before, y)) / (2 * h),
         1e-10, 1e-10);
    ABOVE(fabs(actuation_power(fish, y)), 1e-3);
}

// the rate of the energies for moving nodes and muscle, by differences of fourth order
static double rate_of_energy(struct setup *setup) {
    static const double node[4] = {-2, -1, 1, 2}, weight[4] = {1.0 / 12, -8.0 / 12, 8.0 / 12, -1.0 / 12};
    const struct fish *fish = setup->school->fish;
    const double h = 3e-4;
    double rate = 0, curvature[5];
    const struct actuation moved = {curvature, zero, zero, zero};
    double *const y = test_array(fish->at.end);
    for (int i = 0; i < 4; i++) {
        const double tau = node[i] * h;
        memcpy(y, setup->state->y, (size_t)fish->at.end * sizeof *y);
        for (int m = 0; m < 2 * fish->n_nodes; m++) y[fish->at.x + m] += tau * y[fish->at.vx + m];
        for (int j = 0; j < 5; j++) curvature[j] = natural[j] + tau * natural_rate[j];
        rate += weight[i] / h * (bending_energy(fish, &moved, y) + stretching_energy(fish, y));
    }
    return rate;
}

TEST(what_the_muscle_gives_is_stored_damped_or_work_on_the_nodes) {
    const char *const bodies[] = {BODY, STRAIN};
    for (int i = 0; i < 2; i++) {
        struct setup setup = setup_with(SMALL "fish: [{%s}]\n", bodies[i]);
        school_stir(&setup);
        const struct fish *fish = setup.school->fish;
        const double *const y = setup.state->y;
        rod_residual(fish, &muscle, y, setup.value);
        double work = 0;
        for (int m = 0; m < 2 * fish->n_nodes; m++) work -= setup.value[fish->at.ax + m] * y[fish->at.vx + m];
        const double power = actuation_power(fish, y) + damping_power(fish, &muscle, y);
        ABOVE(fabs(power), 1);
        // truncation and rounding of the differences of an energy of 10 J
        NEAR(power, work + rate_of_energy(&setup), 1e-9 * fabs(work), 1e-9);
    }
}

TEST(a_body_that_does_what_its_muscle_asks_is_not_damped) {
    struct setup setup = setup_stirred(SMALL "fish: [{" STRAIN "}]\n");
    const struct fish *fish = setup.school->fish;
    double *const y = setup.state->y;
    // edge lengths are constant; edge k turns at the sum of the rates of the joints before it
    double turn = 0.7, rate[5], damped[5];
    const struct actuation follows = {natural, rate, by_phi0, rate_by_phi0};
    for (int k = 0; k < fish->n_edges; k++) {
        const double ex = y[fish->at.x + k + 1] - y[fish->at.x + k], ey = y[fish->at.y + k + 1] - y[fish->at.y + k];
        y[fish->at.vx + k + 1] = y[fish->at.vx + k] - turn * ey;
        y[fish->at.vy + k + 1] = y[fish->at.vy + k] + turn * ex;
        if (k < fish->n_joints) turn += damped[k] = 0.3 * (k + 1);
    }
    // dkappa/dt = dphi/dt (1 + kappa^2/4)
    rod_curvature(fish, y, rate);
    for (int j = 0; j < 5; j++) rate[j] = damped[j] * (1 + pow(rate[j] * fish->edge_length, 2) / 4);
    NEAR(damping_power(fish, &follows, y), 0, 1e-24, 0);
    BELOW(damping_power(fish, &muscle, y), -0.1);
}

TEST(a_body_is_torn_at_ten_times_the_length_of_an_edge) {
    struct setup setup = setup_of("time: {end: 1}\nfish: [{nodes: 7}]\n");
    const struct fish *const fish = setup.school->fish;
    double *const tail = &setup.state->y[fish->at.x + 6];
    const double before = tail[-1], sign = *tail > before ? 1 : -1;
    *tail = before + 9.9 * sign * fish->edge_length;
    assert_false(rod_is_torn(fish, setup.state->y));
    *tail = before + 10.1 * sign * fish->edge_length;
    assert_true(rod_is_torn(fish, setup.state->y));
}

TEST(the_shortest_edge_is_the_one_compressed_most) {
    struct setup setup = setup_of("time: {end: 1}\nfish: [{nodes: 7, wave: {amplitude: 0}}]\n");
    const struct fish *const fish = setup.school->fish;
    double *const x = &setup.state->y[fish->at.x], ratio;
    rod_shortest_edge(fish, setup.state->y, &ratio);
    NEAR(ratio, 1, 1e-14, 0);
    x[3] += 0.7 * (x[4] - x[3]);
    assert_int_equal(rod_shortest_edge(fish, setup.state->y, &ratio), 3);
    NEAR(ratio, 0.3, 1e-14, 0);
}

TEST(the_sharpest_joint_is_the_one_that_turns_most) {
    struct setup setup = setup_of("time: {end: 1}\nfish: [{nodes: 7, wave: {amplitude: 0}}]\n");
    const struct fish *const fish = setup.school->fish;
    double *const x = &setup.state->y[fish->at.x], *const y = &setup.state->y[fish->at.y], turn;
    // turn the body behind node 3 to the right, behind node 5 back by less
    const double l = fish->edge_length, angle[] = {0, 0, 0, -1.1, -1.1, -0.3};
    for (int k = 0; k < 6; k++) {
        x[k + 1] = x[k] + l * cos(angle[k]);
        y[k + 1] = y[k] + l * sin(angle[k]);
    }
    assert_int_equal(rod_sharpest_joint(fish, setup.state->y, &turn), 3);
    NEAR(turn, 1.1, 1e-13, 0);
}
