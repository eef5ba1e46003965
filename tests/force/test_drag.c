/* test_drag.c: Tests the drag on an edge, and the moment of that part of the drag which the flow causes (doc/model.md,
 * sections 9 and 11). */
#include <stdio.h>

#include "flow/flow_at_bodies.h"
#include "force/drag.h"
#include "school.h"

#define TIME "time: {end: 1, shedding_interval: 0.02, output_interval: 0.02}\n"
#define SMALL TIME "defaults: {fish: {nodes: 7}}\n"

static const double *flow_u(const struct setup *setup, int f) {
    return setup->residual->flow->u + setup->residual->flow->points[f].first;
}
static const double *flow_v(const struct setup *setup, int f) {
    return setup->residual->flow->v + setup->residual->flow->points[f].first;
}

// the part of the drag along the edge
static void friction_of(const struct fish *fish, int k, const struct edge *edge, const double w[2],
                        double friction[2]) {
    double force[2];
    drag_force(fish, k, edge, w, force, friction);
}

// derivatives of the drag on an edge against differences, at a velocity; tolerance relative to the largest derivative
static void compare_slope(const struct fish *fish, int k, const double w[2], double rtol) {
    const double size = hypot(w[0], w[1]), h = 1e-5, angle = 0.7;
    const struct edge edge = {.t = {cos(angle), sin(angle)}, .n = {-sin(angle), cos(angle)}};
    double by_velocity[2][2], by_turn[2], force[2][2], friction[2];

    drag_slope(fish, k, &edge, w, by_velocity, by_turn);
    for (int j = 0; j < 3; j++) {
        const double step = j == 2 ? h : h * size;
        for (int side = 0; side < 2; side++) {
            const double moved_by = side == 0 ? -step : step, turned = angle + (j == 2 ? moved_by : 0);
            const struct edge other = {.t = {cos(turned), sin(turned)}, .n = {-sin(turned), cos(turned)}};
            const double moved[2] = {w[0] + (j == 0 ? moved_by : 0), w[1] + (j == 1 ? moved_by : 0)};
            drag_force(fish, k, &other, moved, force[side], friction);
        }

        const double scale = hypot(by_turn[0], by_turn[1]) + size * (fabs(by_velocity[0][0]) + fabs(by_velocity[1][1]));
        for (int c = 0; c < 2; c++) {
            NEAR(j == 2 ? by_turn[c] : by_velocity[c][j], (force[1][c] - force[0][c]) / (2 * step),
                 rtol * scale / (j == 2 ? 1 : size), 0);
        }
    }
}

TEST(slope_of_the_force_agrees_with_differences) {
    const char *const texts[] = {SMALL "fish: [{}]\n", SMALL "fish: [{force: reactive, drag: {tangential: 0.3}}]\n",
                                 SMALL "fish: [{force: reactive, drag: {tangential: 0.3, law: linear_quadratic}}]\n",
                                 SMALL "fluid: {viscosity: 0.1}\nfish: [{drag: {skin: laminar}}]\n"};
    for (int i = 0; i < 4; i++) {
        struct setup setup = setup_of(texts[i]);
        // the force is quadratic in w and in cosine and sine: truncation error of order h^2
        compare_slope(setup.school->fish, 2, (const double[]){-0.4, 0.3}, 1e-8);
    }
}

// ---- a boundary layer

#define PLATE(nodes, more)                                              \
    TIME "fluid: {viscosity: 1.0e-6, density: 3}\n"                     \
         "fish: [{length: 2, pressure: {span: infinite}, nodes: " nodes \
         ", body: {profile: uniform, thickness: 0.1, depth: 0.4},\n"    \
         "        wave: {frequency: 0}, start: {speed: 0.5}, drag: {skin: boundary_layer, normal: 0" more "}}]\n"
#define BARE ", form: 1, waving: 1"

// friction of a plate at this speed over friction of a laminar boundary layer
static double friction_over_blasius(const char *text, double speed) {
    struct setup setup = setup_of(text);
    const struct edge edge = {.t = {1, 0}, .n = {0, 1}};
    const double nu = setup.values.school.fluid.viscosity, w[2] = {-speed, 0.3};
    double total = 0;
    for (int k = 0; k < setup.school->fish->n_edges; k++) {
        double force[2];
        friction_of(setup.school->fish, k, &edge, w, force);
        NEAR(force[1], 0, 0, 0);
        total += force[0];
    }

    return total / (1.328 * 3 * 0.8 * sqrt(nu * 2) * pow(speed, 1.5));
}

// half of the drag coefficient 0.074 Re^(-1/5) of a side over Blasius' 0.664 Re^(-1/2)
static double turbulent_over_blasius(double reynolds) {
    return 0.074 * pow(reynolds, -0.2) / (1.328 * pow(reynolds, -0.5));
}

TEST(boundary_layer_of_a_plate_is_laminar_turbulent_or_between) {
    // u0 = 1e-4 * 0.5 m/s; far from the transition the error of the blend is (Re/Re_t)^4
    NEAR(friction_over_blasius(PLATE("9", BARE), 0.01), 1, 0, 1e-4);
    NEAR(friction_over_blasius(PLATE("9", BARE ", transition: 1.0e+9"), 1), 1, 0, 1e-6);
    NEAR(friction_over_blasius(PLATE("9", BARE ", transition: 0"), 1), turbulent_over_blasius(2e6), 0, 1e-6);

    // A sudden transition would switch the law at Re = 2e5; the blend is smooth, over a factor of 2 in Re.
    const double reynolds[] = {3e5, 9e5, 3e6, 1e7};
    for (int i = 0; i < 4; i++) {
        const double got = friction_over_blasius(PLATE("65", BARE), reynolds[i] * 1e-6 / 2);
        const double at = 2e5 / reynolds[i], ratio = turbulent_over_blasius(reynolds[i]);
        NEAR(got, sqrt(at) + ratio * (1 - pow(at, 0.8)), 0, 0.025);
    }
}

// at the transition Reynolds number of the middle of an edge, half of the friction of the edge is turbulent
TEST(transition_of_an_edge_is_that_of_its_middle) {
    struct setup setup = setup_of(PLATE("9", BARE));
    const struct fish *const fish = setup.school->fish;
    for (int k = 0; k < fish->n_edges; k++) {
        const double speed = 2e5 * 1e-6 / (2 * (k + 0.5) / 8), w[2] = {-speed, 0};
        const struct edge edge = {.t = {1, 0}, .n = {0, 1}};
        double force[2];
        friction_of(fish, k, &edge, w, force);

        // u0 is 5e-5 m s-1
        const double half = fish->drag_tangential[k] * pow(speed, 1.5) + fish->drag_turbulent[k] * pow(speed, 1.8);
        NEAR(force[0], half / 2, 0, 1e-5);
    }
}

TEST(factors_multiply_the_friction) {
    const double form = 1 + 2 * 0.1 + 60 * 1e-4;

    // laminar: form and waving; turbulent: form factor of the thickness only
    NEAR(friction_over_blasius(PLATE("9", ""), 0.01), form, 0, 1e-4);
    NEAR(friction_over_blasius(PLATE("9", ", waving: 1.7"), 0.01), 1.7 * form, 0, 1e-4);
    NEAR(friction_over_blasius(PLATE("9", ", waving: 1.7, form: 1.2"), 0.01), 1.7 * 1.2, 0, 1e-4);
    NEAR(friction_over_blasius(PLATE("9", ", waving: 1.7, form: 1.2, transition: 0"), 1),
         1.2 * turbulent_over_blasius(2e6), 0, 1e-6);
}

TEST(a_body_with_a_wave_has_the_factor_of_waving) {
    const struct {
        const char *fish;
        double waving;
    } cases[] = {{"wave: {amplitude: 0.1}", 1.5},
                 {"wave: {amplitude: 0, table: [[1, -1], [2, -2]]}", 1.5},
                 {"wave: {amplitude: 0}", 1},
                 {"wave: {frequency: 0}", 1},
                 {"motion: {prescribed: all, heave: 0.1, frequency: 1}", 1},
                 {"motion: {prescribed: head, heave: 0.1, frequency: 1}", 1.5},
                 {"wave: {amplitude: 0}, motion: {prescribed: head, heave: 0.1, frequency: 1}", 1},
                 {"drag: {waving: 1.2}", 1.2}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct setup setup = setup_with(
            TIME "defaults: {fish: {force: pressure, pressure: {span: infinite}}}\nfish: [{%s}]\n", cases[i].fish);
        assert_int_equal(setup.school->fish->friction, FRICTION_BOUNDARY_LAYER);
        NEAR(setup.school->fish->waving, cases[i].waving, 0, 0);
    }
}

// across transition, at rest and at high speed; friction takes energy from the body at any velocity
TEST(boundary_layer_is_smooth_and_takes_energy) {
    const char *const texts[] = {PLATE("9", ""), PLATE("9", ", waving: 1.7"), PLATE("9", ", waving: 0.6, form: 3"),
                                 PLATE("9", ", transition: 0"), PLATE("9", ", transition: 1.0e+4, waving: 2")};
    const double speeds[] = {1e-9, 2e-5, 1e-4, 1e-3, 0.03, 0.1, 0.3, 1, 3, 30};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        struct setup setup = setup_of(texts[i]);
        const struct fish *const fish = setup.school->fish;
        for (size_t s = 0; s < 2 * sizeof speeds / sizeof *speeds; s++) {
            const double speed = (s % 2 ? -1 : 1) * speeds[s / 2], w[2] = {0.8 * speed, -0.6 * speed};
            const struct edge edge = {.t = {0.96, 0.28}, .n = {-0.28, 0.96}};
            for (int k = 0; k < fish->n_edges; k++) {
                double force[2];
                friction_of(fish, k, &edge, w, force);
                BELOW(edge_dot(force, w), 0);
                // second differences of step h = 1e-5, and rounding over h
                compare_slope(fish, k, w, 2e-9);
            }
        }

        // at rest: zero force, and the finite slope (u0)^(1/2)
        double force[2], friction[2], by_velocity[2][2], by_turn[2];
        const struct edge edge = {.t = {1, 0}, .n = {0, 1}};
        drag_slope(fish, 0, &edge, (const double[]){0, 0}, by_velocity, by_turn);
        drag_force(fish, 0, &edge, (const double[]){1e-12, 0}, force, friction);
        NEAR(force[0], by_velocity[0][0] * 1e-12, 0, 1e-9);
        BELOW(by_velocity[0][0], 0);
    }
}

// Blasius: 1.328 rho w sqrt(nu L) U^(3/2) for both sides
TEST(laminar_friction_of_a_plate_is_that_of_its_boundary_layer) {
    struct setup setup = setup_of(SMALL
                                  "fluid: {viscosity: 0.002, density: 3}\n"
                                  "fish: [{length: 2, body: {depth: 0.4}, wave: {frequency: 0}, start: {speed: 0.5},\n"
                                  "        drag: {skin: laminar, normal: 0}}]\n");
    const struct fish *fish = setup.school->fish;
    const struct edge edge = {.t = {1, 0}, .n = {0, 1}};
    const double w[2] = {-0.7, 0.3}, slow[2] = {1e-9, 0};
    double total[2] = {0, 0}, across = 0, force[2], friction[2];
    for (int k = 0; k < fish->n_edges; k++) {
        drag_force(fish, k, &edge, w, force, friction);
        total[0] += force[0];
        total[1] += friction[0];
        across += fabs(force[1]) + fabs(friction[1]);
    }

    const double blasius = 1.328 * 3 * 0.8 * sqrt(0.002 * 2) * pow(0.7, 1.5);
    for (int i = 0; i < 2; i++) NEAR(total[i], blasius, 0, 1e-8);  // u0 = 1e-4 * 0.5 m/s
    NEAR(across, 0, 0, 0);

    // near rest the friction is linear: (u0)^(1/2) u
    drag_force(fish, 0, &edge, slow, force, friction);
    NEAR(force[0], -blasius / pow(0.7, 1.5) * sqrt(1.0 / 6) * sqrt(0.5e-4) * 1e-9, 0, 1e-8);
}

static double moment_about(const struct fish *fish, const double *u, const double *v, const double *y,
                           const double com[2]) {
    double moment = 0;
    for (int k = 0; k < fish->n_edges; k++) {
        const struct edge edge = edge_at(fish, k, y);
        double w[2], force[2], friction[2];
        flow_relative_velocity(fish, k, edge.velocity, u, v, w);
        drag_force(fish, k, &edge, w, force, friction);
        moment += (edge.middle[0] - com[0]) * force[1] - (edge.middle[1] - com[1]) * force[0];
    }

    return moment;
}

TEST(moment_is_that_of_the_forces_that_the_flow_adds) {
    struct setup setup = setup_stirred(
        SMALL "fluid: {velocity: [0.3, -0.2], shear: 0.7}\nfish: [{length: 1.1, wave: {frequency: 1.2}}]\n");
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
    const double scale = 1000 * 0.2 * 1.1 * 1.1 * 1.1 * pow(1.1 * 1.2, 2);
    NEAR(drag_moment(fish, flow_u(&setup, 0), flow_v(&setup, 0), y), moment / scale, 1e-14, 1e-12);
    ABOVE(fabs(moment / scale), 1e-4);
    NEAR(drag_moment(fish, still, still, y), 0, 0, 0);
}

/* c_n of an edge over rho w l/2 against the suction K_v,se/pi of both side edges of rectangular wings (Polhamus), from
 * a lattice of vortices with Jordan's lift slope. */
TEST(cross_flow_drag_of_a_strip_is_the_suction_of_its_side_edges) {
    static const double suction[][2] = {{0.05, 3.079}, {0.1, 3.018}, {0.25, 2.842}, {0.5, 2.574},
                                        {1, 2.136},    {2, 1.551},   {4, 0.967},    {8, 0.537}};
    for (size_t i = 0; i < sizeof suction / sizeof *suction; i++) {
        struct setup setup =
            setup_with(TIME
                       "wake: {shedding: sheet}\nsheet: {curve: smooth}\n"
                       "fish: [{length: 2, nodes: 9, sheet_points: 101, force: pressure, pressure: {span: finite},\n"
                       "        body: {depth: %g}, drag: {normal: 3}}]\n",
                       suction[i][0]);
        const struct fish *const fish = setup.school->fish;
        const double flat = 1000 * 3 * 2 * suction[i][0] * (2.0 / 8) / 2;
        for (int k = 0; k < fish->n_edges; k++) {
            NEAR(fish->drag_normal[k] / flat, suction[i][1] / acos(-1), 0, 0.012);
            const struct edge edge = {.t = {1, 0}, .n = {0, 1}};
            double force[2], friction[2];
            drag_force(fish, k, &edge, (const double[]){0, -0.2}, force, friction);
            NEAR(force[1], fish->drag_normal[k] * 0.04, 0, 1e-14);
        }
        school_clear(&setup);
    }
}

// edges of a table of depths: each has the aspect ratio of its own depth; without rings the factor is 1
TEST(cross_flow_drag_of_an_edge_has_the_depth_of_the_edge) {
    static const double depth[] = {0.5, 0.7, 0.6, 0.4};
    for (int is_finite = 0; is_finite < 2; is_finite++) {
        struct setup setup =
            setup_with(TIME
                       "wake: {shedding: sheet}\nsheet: {curve: smooth}\n"
                       "fish: [{nodes: 5, sheet_points: 21, force: pressure, pressure: {span: %s}, drag: {normal: 1},\n"
                       "        body: {profile: table, thickness_table: [0.1, 0.2, 0.15, 0.05],\n"
                       "               depth_table: [0.5, 0.7, 0.6, 0.4]}}]\n",
                       is_finite ? "finite" : "infinite");
        for (int k = 0; k < 4; k++) {
            const double a = depth[k], share = is_finite ? (3.4 + a) / (3.4 + 2.4 * a + 0.7 * a * a) : 1;
            NEAR(setup.school->fish->drag_normal[k], 1000 * share * a * 0.25 / 2, 0, 1e-14);
        }
        school_clear(&setup);
    }
}

// Blasius' friction of both sides, or the turbulent law, with the factor of the form and without the factor of waving
TEST(drag_of_a_towed_body_has_form_and_no_waving) {
    static const char *const keys[] = {"skin: laminar", "transition: 1.0e+9, waving: 1.7, form: 1.3",
                                       "transition: 0, waving: 1.7, form: 1.3"};
    const double speed = 0.7, reynolds = speed * 2 / 0.002, area = 3 * speed * speed * 2 * 0.8;
    const double blasius = 1.328 / sqrt(reynolds), want[] = {blasius, 1.3 * blasius, 1.3 * 0.074 / pow(reynolds, 0.2)};
    for (int i = 0; i < 3; i++) {
        struct setup setup = setup_with(SMALL
                                        "fluid: {viscosity: 0.002, density: 3}\n"
                                        "fish: [{length: 2, body: {depth: 0.4}, drag: {%s, normal: 2%s}}]\n",
                                        keys[i], i > 0 ? ", skin: boundary_layer" : "");
        NEAR(drag_towed(setup.school->fish, speed), area * want[i], 0, 1e-7);
        school_clear(&setup);
    }
}
