/* test_thwaites.c: Thwaites' method agrees with flows whose boundary layers are known, and with the friction on the
 * sides of plates (doc/model.md, section 9). */
#include <math.h>
#include <stdio.h>

#include "force/thwaites.h"
#include "school.h"

static const double pi = 3.14159265358979323846;
static const double viscosity = 1e-5;

enum { N = 801 };
static double x[N], u[N], friction[N], lambda[N];

// the first point at which the layer separates, between two points
static double separation(void) {
    for (int i = 1; i < N; i++) {
        if (lambda[i] >= thwaites_separation) continue;
        const double part = (thwaites_separation - lambda[i - 1]) / (lambda[i] - lambda[i - 1]);
        return (1 - part) * x[i - 1] + part * x[i];
    }
    return NAN;
}

TEST(a_flat_plate_has_the_friction_of_blasius) {
    for (int i = 0; i < N; i++) {
        x[i] = (double)i / (N - 1);
        u[i] = 1;
    }
    thwaites_layers(N, x, u, viscosity, friction, lambda);
    for (int i = 1; i < N; i++) {
        // Thwaites: 0.335, Blasius: 0.332
        NEAR(friction[i], sqrt(viscosity / x[i]) * pow(0.09, 0.62) / sqrt(0.45), 0, 1e-12);
        NEAR(friction[i], 0.33206 * sqrt(viscosity / x[i]), 0, 0.01);
        NEAR(lambda[i], 0, 1e-15, 0);
    }
}

// u = x^m: f''(0) of Falkner and Skan by Hartree, times ((m + 1)/2)^(1/2)
TEST(wedges_have_the_friction_of_falkner_and_skan) {
    static const struct { double m, wall; } wedges[] = {{1, 1.2326}, {1.0 / 3, 0.7575}, {1.0 / 9, 0.5120}};
    for (int k = 0; k < 3; k++) {
        const double m = wedges[k].m;
        for (int i = 0; i < N; i++) {
            x[i] = (double)i / (N - 1);
            u[i] = pow(x[i], m);
        }
        thwaites_layers(N, x, u, viscosity, friction, lambda);
        for (int i = N / 2; i < N - 1; i += 50) {
            NEAR(lambda[i], 0.45 * m / (5 * m + 1), 1e-3, 0);
            NEAR(friction[i], u[i] * sqrt(viscosity * u[i] / x[i]) * wedges[k].wall, 0, 0.04);
        }
    }
}

// 103.1 degrees by Thwaites' method, 104.5 by the equations of the boundary layer; 0.123 and 0.120 in u = 1 - x
TEST(layers_separate_from_a_cylinder_and_in_a_decelerated_flow) {
    for (int i = 0; i < N; i++) {
        x[i] = pi * i / (N - 1);
        u[i] = 2 * sin(x[i]);
    }
    thwaites_layers(N, x, u, viscosity, friction, lambda);
    NEAR(separation() * 180 / pi, 103.1, 0.1, 0);
    for (int i = 0; i < N; i++) {
        x[i] = 0.2 * i / (N - 1);
        u[i] = 1 - x[i];
    }
    thwaites_layers(N, x, u, viscosity, friction, lambda);
    NEAR(separation(), 0.123, 1e-3, 0);
}

// a layer towards smaller x is the mirror image, and layers on both sides of a stagnation point are independent
TEST(layers_run_in_the_direction_of_the_flow) {
    for (int i = 0; i < N; i++) {
        x[i] = 2.0 * i / (N - 1) - 1;
        u[i] = tanh(4 * x[i]);
    }
    thwaites_layers(N, x, u, viscosity, friction, lambda);
    for (int i = 0; i < N; i++) {
        NEAR(friction[N - 1 - i], -friction[i], 1e-15, 1e-12);
        NEAR(lambda[N - 1 - i], lambda[i], 1e-15, 1e-12);
    }
    ABOVE(friction[3 * N / 4], 0);
}

static struct thwaites_friction friction_of(struct simulation *simulation) {
    simulate_measure(simulation);
    return thwaites_friction(simulation->residual->force[0].pressure, simulation->state->y, simulation->state->yp);
}

static struct simulation *plate(const char *stream, double thickness) {
    char text[600];
    snprintf(
        text, sizeof text,
        "time: {end: 2, shedding_interval: 0.02}\nfluid: {density: 1, viscosity: 1e-3, velocity: [%s]}\n"
        "fish: [{force: pressure, pressure: {span: infinite}, sheet_points: 65, wave: {amplitude: 0, frequency: 0},\n"
        "        body: {profile: uniform, thickness: %g, depth: 0.5}, motion: {prescribed: all}}]\n",
        stream, thickness);
    return school_simulation(text);
}

TEST(a_plate_has_half_of_blasius_friction_on_each_side) {
    struct simulation *const simulation = plate("1, 0", 1e-5);
    school_run(simulation, 0.2);
    const struct thwaites_friction sides = friction_of(simulation);
    for (int side = 0; side < 2; side++) {
        NEAR(sides.force[side][0], 0.5 * 0.664 * sqrt(1e-3), 0, 0.015);
        NEAR(sides.force[side][1], 0, 1e-12, 0);
        assert_true(isnan(sides.separation[side]));
    }
    NEAR(sides.along, sides.force[0][0] + sides.force[1][0], 0, 1e-12);
}

/* A parabolic nose a = r/2: u = k (s/(s + a))^(1/2) in the stream 1, dx = ((s + a)/s)^(1/2) ds; the integral of u^5 is
 * k^5 (s - 2 a ln(1 + s/a) + a s/(s + a)). An ellipse of the thickness h has k = 1 + h/L and a = h^2/(4 L). */
TEST(a_thick_plate_has_the_friction_of_the_flow_round_its_nose) {
    static const double thickness[] = {0.02, 0.1, 0.2};
    for (int i = 0; i < 3; i++) {
        struct simulation *const simulation = plate("1, 0", thickness[i]);
        school_run(simulation, 0.2);
        const struct thwaites_friction sides = friction_of(simulation);

        // midpoint rule in the root of s
        enum { M = 4000 };
        const double k = 1 + thickness[i], a = thickness[i] * thickness[i] / 4;
        double want = 0;
        for (int j = 0; j < M; j++) {
            const double root = (j + 0.5) / M, s = root * root, share = s / (s + a);
            const double integral = s - 2 * a * log1p(s / a) + a * share;
            const double gradient = 0.45 * integral * a * (s + a) / (2 * s * s * s);
            const double tau = share * share * pow(gradient + 0.09, 0.62) / sqrt(0.45 * integral);
            want += 0.5 * pow(k, 1.5) * sqrt(1e-3) * tau * 2 * root / M;
        }
        for (int side = 0; side < 2; side++) NEAR(sides.force[side][0], want, 0, 0.002);
    }
}

// at incidence the layer separates on the side away from the stream, and the mirrored plate exchanges the sides
TEST(incidence_separates_the_layer_on_one_side) {
    struct thwaites_friction sides[2];
    for (int i = 0; i < 2; i++) {
        struct simulation *const simulation = plate(i == 0 ? "1, 0.1" : "1, -0.1", 0.12);
        school_run(simulation, 2);
        sides[i] = friction_of(simulation);
    }
    // the plate points to -x, so that a stream with a positive y component comes from the left
    for (int side = 0; side < 2; side++) {
        NEAR(sides[1].force[1 - side][0], sides[0].force[side][0], 0, 1e-6);
        NEAR(sides[1].force[1 - side][1], -sides[0].force[side][1], 1e-12, 1e-6);
    }
    assert_true(isnan(sides[0].separation[0]));
    ABOVE(sides[0].separation[1], 0);
    BELOW(sides[0].separation[1], 0.3);
}

// the strength of a body of finite span counts per depth: half of the strength on half of the depth is the same sheet
TEST(a_sheet_is_as_strong_as_its_strength_over_its_depth) {
    struct simulation *const simulation = school_simulation(
        "time: {end: 2, shedding_interval: 0.02}\nwake: {shedding: sheet}\nsheet: {curve: smooth}\n"
        "fluid: {viscosity: 1e-3, velocity: [1, 0.1]}\n"
        "fish: [{nodes: 7, force: pressure, pressure: {span: finite}, sheet_points: 33, wave: {amplitude: 0}, motion: "
        "{prescribed: all},\n        drag: {skin: laminar}, body: {profile: uniform, depth: 0.25}}]\n");
    school_run(simulation, 0.2);
    struct fish *const fish = &simulation->school->fish[0];
    struct pressure *const pressure = simulation->residual->force[0].pressure;
    const double *const y = simulation->state->y;
    const struct thwaites_friction whole = friction_of(simulation);
    for (int c = 0; c < fish->n_control; c++) {
        const double around = pressure_sheet_at(pressure, c, y, simulation->state->yp).strength *
                              pressure->point[c].body.length * fish->control_interval[c];
        pressure->point[c].circulation -= around / 2;
        fish->point_half[c] /= 4;
    }
    const struct thwaites_friction half = thwaites_friction(pressure, y, simulation->state->yp);
    for (int side = 0; side < 2; side++) NEAR_ARRAY(2, half.force[side], whole.force[side], 0, 1e-10);
    ABOVE(fabs(whole.force[0][0] - whole.force[1][0]), 0.01 * fabs(whole.force[0][0]));
}
