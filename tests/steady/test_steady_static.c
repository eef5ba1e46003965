/* test_steady_static.c: The equilibrium of a body without a beat agrees with a run, ends at the largest stream that has
 * one, and is refused with a reason where there is none (doc/steady.md, "Equilibria without a beat"). */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fish/fish_gait.h"
#include "flow/flow_at_bodies.h"
#include "school.h"
#include "steady/steady_modes.h"
#include "steady/steady_problem.h"
#include "steady/steady_static.h"

#define TIME "time: {end: 1, shedding_interval: 0.05, output_interval: 0.05}\n"
#define PLATE                              \
    "wave: {amplitude: 0, frequency: 0}, " \
    "body: {profile: uniform, thickness: 0.02, depth: 1, density: 63.66, modulus: 40000, relaxation_time: 0.2}"
#define BODY "nodes: 9, sheet_points: 17, " PLATE
#define SLENDER "force: reactive, " BODY
#define HEAD SLENDER ", motion: {prescribed: head, speed: 0}"

struct answer {
    struct simulation *simulation;
    struct steady_values values;
    struct steady_fish fish[2];
    enum status status;
};

static void answer(struct answer *answer, const char *text) {
    *answer = (struct answer){.simulation = school_simulation(text)};
    answer->values.fish = answer->fish;
    assert_true(steady_static_applies(answer->simulation->school));
    answer->status = steady_static_refuse(answer->simulation->school);
    if (answer->status == STATUS_OK) answer->status = steady_static_find(answer->simulation, NULL, &answer->values);
}

// node positions at the end of a run agree with the equilibrium
static void is_where_a_run_ends(const struct answer *answer, const char *text, double end, double within) {
    struct simulation *const run = school_simulation(text);
    const struct fish *const fish = &run->school->fish[0];
    school_run(run, end);
    for (int i = fish->at.x; i < fish->at.vx; i++) NEAR(answer->simulation->state->y[i], run->state->y[i], within, 0);
}

TEST(a_run_with_damping_comes_to_it) {
    static const char pressure[] = TIME
        "fluid: {density: 1, velocity: [0.3, 0], viscosity: 0}\nwake: {lifetime: 20}\nfish: [{" BODY
        ", motion: {prescribed: head, speed: 0}, force: pressure, pressure: {span: infinite}, start: {heading: 170, "
        "speed: 0}}]\n";
    // across the stream: the body bends by half of the length
    static const char across[] = TIME
        "fluid: {density: 1, velocity: [0.5, 0]}\nwake: {lifetime: 5}\n"
        "fish: [{" HEAD ", added_mass: {coefficient: 0}, start: {heading: 270, speed: 0}, load: {tip: [0, 0.002]}}]\n";
    struct answer found;
    answer(&found, pressure);
    school_ok(found.status);
    BELOW(found.values.residual, 1e-10);
    ABOVE(fabs(found.fish[0].deflection), 0.02);
    // the starting vortex is far downstream by now; the remaining transient decays slowly
    is_where_a_run_ends(&found, pressure, 60, 1e-4);
    answer(&found, across);
    school_ok(found.status);
    ABOVE(found.fish[0].deflection, 0.5);
    is_where_a_run_ends(&found, across, 70, 1e-4);
}

// Helmbold's lift at AR 1 is 0.236 of two dimensions; no modes
TEST(a_body_of_finite_span_has_legs_to_infinity) {
    struct answer found;
    answer(&found,
           TIME "fluid: {density: 1, velocity: [1, 0], viscosity: 0}\nfish: [{" BODY
                ", force: pressure, pressure: {span: finite, suction_limit: 0}, start: {heading: 179, speed: 0},"
                " motion: {prescribed: all, speed: 0}}]\n");
    school_ok(found.status);
    BELOW(found.values.residual, 1e-10);
    const double angle = 3.14159265358979323846 / 180;
    NEAR(found.fish[0].lift / (3.14159265358979323846 * angle), 0.236, 0, 0.02);

    // the wake leaves the body along the stream
    const struct flow_fish *const rings = &found.simulation->residual->flow->fish[0];
    NEAR(rings->downstream[0], 1, 1e-15, 0);
    NEAR(rings->downstream[1], 0, 1e-15, 0);

    // far behind, s = w^2/8, B = w^2/8 at a point of the fluid: two lines of the circulation C w/2, at T = w^2/4
    const struct fish *const fish = &found.simulation->school->fish[0];
    const double *const y = found.simulation->state->y;
    const double expected = -y[fish->at.circulation] * 0.5 / (2 * 3.14159265358979323846) * 2 / 0.25;
    double at[2][4], u[4] = {0}, v[4] = {0}, u_x[4], u_y[4], v_x[4];
    for (int i = 0; i < 4; i++) {
        at[0][i] = y[fish->at.x + fish->n_nodes - 1] + 15 + 1.3 * i;
        at[1][i] = y[fish->at.y + fish->n_nodes - 1];
    }
    flow_field(found.simulation->residual->flow, found.simulation->state,
               &(struct targets){.n = 4, .x = at[0], .y = at[1], .u = u, .v = v, .u_x = u_x, .u_y = u_y, .v_x = v_x},
               true);
    for (int i = 0; i < 4; i++) NEAR(v[i], expected, 0, 5e-3);

    school_ok(steady_modes_find(found.simulation, &found.values));
    assert_int_equal(found.values.n_exponents, 0);
}

TEST(forces_are_those_along_and_across_the_stream) {
    struct answer found;
    answer(&found,
           TIME "fluid: {density: 1, velocity: [0, 2], viscosity: 0}\nfish: [{" BODY
                ", force: pressure, pressure: {span: infinite, suction_limit: 0}, start: {heading: 260, speed: 0},"
                " motion: {prescribed: all, speed: 0}}]\n");
    school_ok(found.status);
    // 2 pi sin(alpha), to the left of the stream; no drag
    NEAR(found.fish[0].lift, 3.14159265358979 * 4 * sin(0.17453292519943295), 0, 4e-3);
    NEAR(found.fish[0].drag, 0, 1e-4, 0);
    NEAR(found.fish[0].force[0], -found.fish[0].lift, 1e-12, 0);
    NEAR(found.fish[0].speed, 2, 1e-12, 0);
    NEAR(found.values.stiffness, 1, 0, 0);
}

// a body of finite span that is held in a stream, and the same body that its drive carries through another stream
TEST(forces_on_a_carried_body_are_those_in_the_relative_stream) {
    struct answer found[2];
    static const double heading = 120, speed = 0.8;
    for (int i = 0; i < 2; i++) {
        const double angle = heading * 3.14159265358979323846 / 180, carried = i * speed;
        char text[800];
        snprintf(text, sizeof text,
                 TIME "fluid: {density: 1, velocity: [%.17g, %.17g], viscosity: 0}\nfish: [{" BODY
                      ", force: pressure, pressure: {span: finite, suction_limit: 0},"
                      " start: {heading: %g, speed: 0}, motion: {prescribed: all, speed: %g}}]\n",
                 1 + carried * cos(angle), -0.4 + carried * sin(angle), heading, carried);
        answer(&found[i], text);
        school_ok(found[i].status);
    }
    ABOVE(fabs(found[0].fish[0].force[1]), 0.1);
    for (int k = 0; k < 2; k++) NEAR(found[1].fish[0].force[k], found[0].fish[0].force[k], 1e-9, 1e-9);
    NEAR(found[1].fish[0].drag, found[0].fish[0].drag, 1e-9, 1e-9);
    NEAR(found[1].fish[0].lift, found[0].fish[0].lift, 1e-9, 1e-9);
    NEAR(found[1].fish[0].fluid_power, found[0].fish[0].fluid_power, 1e-9, 1e-9);
    const struct flow_fish *rings = &found[1].simulation->residual->flow->fish[0];
    NEAR(rings->downstream[0], 1 / hypot(1, 0.4), 1e-14, 0);
    NEAR(rings->downstream[1], -0.4 / hypot(1, 0.4), 1e-14, 0);
}

// a flag with the clamp downstream is a column under the load pi/4 rho U^2 of slender bodies: Euler buckling
#define REVERSED                                     \
    TIME "fluid: {density: 1, velocity: [-%g, 0]}\n" \
         "fish: [{" HEAD ", drag: {tangential: 0}, start: {heading: 180, speed: 0}}]\n"

TEST(it_diverges_where_a_column_does) {
    const double pi = 3.14159265358979323846, stiffness = 40000 * pi * 8e-6 / 64;
    const double critical = pi / 2 * sqrt(stiffness / (pi / 4));
    // beyond the third load the determinant is positive again, with two negative eigenvalues
    for (int i = 0; i < 4; i++) {
        const double part[] = {0.5, 0.9, 1.1, 3.3};
        char text[1024];
        snprintf(text, sizeof text, REVERSED, part[i] * critical);
        struct answer found;
        answer(&found, text);
        school_ok(found.status);
        NEAR(found.values.stiffness, (part[i] > 1 ? -1 : 1) * fabs(cos(pi / 2 * part[i])), i < 3 ? 0.01 : 0.1, 0);
        NEAR(found.fish[0].deflection, 0, 1e-12, 0);
    }
}

/* The stream exerts a force along the tail and none across it: E I d4w/ds4 + m U^2 d2w/ds2 = 0 with second and third
 * derivatives that vanish at the tail has no solution, whatever U, and the determinant stays 1. Beyond Beck's load,
 * m U^2 L^2 = 20 E I, pairs of eigenvalues are complex. */
TEST(a_plate_held_at_its_leading_edge_does_not_diverge) {
    double off[2];
    for (int i = 0; i < 2; i++) {
        struct answer found;
        answer(&found,
               arena_text(test_arena(),
                          TIME "fluid: {density: 1, velocity: [0.8, 0]}\nfish: [{" PLATE
                               ", force: reactive, nodes: %d, sheet_points: 17, motion: {prescribed: head, speed: 0},\n"
                               "drag: {tangential: 0}, start: {heading: 180, speed: 0}}]\n",
                          i == 0 ? 17 : 33));
        school_ok(found.status);
        off[i] = found.values.stiffness - 1;
    }
    BELOW(fabs(off[0]), 0.03);
    NEAR(off[0] / off[1], 4, 0, 0.3);  // or more: the mesh is of second order
}

TEST(natural_curvature_is_the_shape_at_rest) {
    struct answer found;
    answer(&found, TIME
           "fluid: {density: 0}\n"
           "fish: [{force: reactive, nodes: 9, sheet_points: 17, wave: {amplitude: 0.3, constant: 1,"
           " linear: 0, quadratic: 0, number: 0, frequency: 0, phase: 90},"
           " motion: {prescribed: head, speed: 0}, start: {speed: 0}}]\n");
    school_ok(found.status);
    const struct fish *const fish = &found.simulation->school->fish[0];
    const struct fish_gait gait = fish_own_gait(fish, 0);
    const double *const y = found.simulation->state->y;
    const double each = fish_natural_angle(fish, 0, &gait, 0);
    ABOVE(fabs(each), 0.1);
    const double last[2] = {y[fish->at.x + 8] - y[fish->at.x + 7], y[fish->at.y + 8] - y[fish->at.y + 7]};
    // the first edge points backwards from the nose; seven joints rotate the last edge
    NEAR(cos(atan2(last[1], last[0]) - (fish->start_heading - 3.14159265358979323846 + 7 * each)), 1, 1e-9, 0);
}

static void refused(const char *text, const char *words) {
    struct answer found;
    answer(&found, text);
    assert_int_equal(found.status, STATUS_CASE);
    if (!strstr(status_message(), words)) fail_msg("\"%s\" is not in \"%s\"", words, status_message());
}

TEST(what_can_have_no_equilibrium_is_refused_with_the_reason) {
    refused(TIME "fish: [{" SLENDER "}]\n", "neither beats nor is held");
    refused(TIME "fish: [{" SLENDER ", motion: {prescribed: head, surge: free}}]\n", "motion.surge: given");
    refused(TIME "fish: [{" HEAD "}, {" SLENDER ", start: {position: [3, 0]}, motion: {prescribed: head, speed: 1}}]\n",
            "move at different velocities");
    // along x at the same speed
    refused(TIME "fish: [{" BODY ", start: {heading: 170}, motion: {prescribed: head, speed: 1}},\n    {" BODY
                 ", start: {position: [3, 0], heading: 190}, motion: {prescribed: head, speed: 1}}]\n",
            "move at different velocities");
    refused(TIME "fluid: {gust: {amplitude: 0.1, frequency: 1}}\nfish: [{" HEAD "}]\n", "gust");
    refused(TIME "fluid: {shear: 0.1}\nfish: [{" SLENDER
                 ", start: {heading: 90}, motion: {prescribed: head, speed: 1}}]\n",
            "across a shear");
    refused(TIME "wake: {removed_circulation: dropped}\nfish: [{" HEAD "}]\n", "retained");
    refused(TIME
            "fish: [{force: reactive, nodes: 9, sheet_points: 17, wave: {amplitude: 0.1, frequency: 0, ramp: 1},"
            " motion: {prescribed: head, speed: 0}}]\n",
            "set wave.ramp to 0");
}

TEST(where_there_is_none_it_says_how_far_the_stream_can_grow) {
    // the largest axial force of an edge is E A = 628 N; the load reaches 628 N at sqrt(0.628) of the stream
    struct answer found;
    answer(&found, TIME
           "fluid: {density: 1, velocity: [0.01, 0]}\n"
           "fish: [{" HEAD ", load: {tip: [-1000, 0]}, start: {speed: 0, heading: 180}}]\n");
    assert_int_equal(found.status, STATUS_SOLVER);
    const char *const words = strstr(status_message(), "ends at ");
    assert_non_null(words);
    NEAR(strtod(words + strlen("ends at "), NULL), sqrt(0.62832), 2e-3, 0);
    // the search restores the stream and the loads of the case, also if only a part of the stream has an equilibrium
    const struct school *const school = found.simulation->school;
    NEAR(school->velocity[0], 0.01, 0, 0);
    NEAR(school->fish[0].load_tip[0], -1000, 0, 0);
}
