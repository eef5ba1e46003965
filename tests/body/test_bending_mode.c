/* test_bending_mode.c: The slowest bending mode of a body is compared with the known modes of uniform beams. */
#include <lapacke.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "body/bending_mode.h"
#include "body/rod.h"
#include "school.h"

#define SMALL "time: {end: 3, shedding_interval: 0.01}\ndefaults: {fish: {nodes: 7}}\n"

static double slowest_mode(const char *fish) {
    struct setup setup = setup_with(SMALL "fish: [{%s}]\n", fish);
    return bending_mode_frequency(&setup.school->fish[0], test_array(setup.school->n_unknowns));
}

#define UNIFORM                                                                                                      \
    "nodes: 81, length: 2, force: reactive, added_mass: {coefficient: 0}, body: {profile: uniform, thickness: 0.1, " \
    "depth: 0.2, "                                                                                                   \
    "density: 800, "                                                                                                 \
    "modulus: 2e6, second_moment: ellipse}"

// of an elliptic section of 0.2 m by 0.4 m: the radius of gyration is a quarter of the thickness
static double analytic(double beta_length) {
    const double wave = sqrt(2e6 / 800.0) * 0.2 / 4;
    return beta_length * beta_length / 4 * wave / (2 * M_PI);
}

TEST(slowest_mode_of_a_uniform_body_is_that_of_the_beam) {
    // cosh b cos b = 1 and -1 (Timoshenko, Vibration problems in engineering); 81 nodes: errors of 1/N
    NEAR(slowest_mode(UNIFORM), analytic(4.730040745), 0, 0.01);
    NEAR(slowest_mode(UNIFORM ", motion: {prescribed: head}"), analytic(1.875104069), 0, 0.03);
}

TEST(slowest_mode_is_that_of_the_matrices) {
    // the turn of a joint is the second difference of the nodes over the edge; the first edge of a held body is fixed
    enum { N = 9 };
    static const char *const motions[] = {"none", "head"};
    for (int fixed = 0; fixed < 2; fixed++) {
        char fish[128];
        snprintf(fish, sizeof fish, "nodes: %d, force: reactive, motion: {prescribed: %s}", N, motions[fixed]);
        struct setup setup = setup_of(arena_text(test_arena(), SMALL "fish: [{%s}]\n", fish));
        const struct fish *const of = setup.school->fish;
        double stiffness[N][N] = {{0}}, mass[N][N] = {{0}}, square[N];
        static const double turn[] = {1, -2, 1};
        for (int i = 0; i < 9 * of->n_joints; i++) {
            const int joint = i / 9, a = i / 3 % 3, b = i % 3;
            stiffness[joint + a][joint + b] +=
                turn[a] * turn[b] * of->bending_stiffness[joint] / pow(of->edge_length, 3);
        }
        for (int k = 0; k < N; k++) mass[k][k] = of->mass[k];
        for (int i = 0; i < 2 * of->n_edges; i++) mass[(i + 1) / 2][(i + 1) / 2] += of->added_mass[i / 2] / 2;
        const int n = N - 2 * fixed, first = fixed ? 2 : 0;
        assert_int_equal(LAPACKE_dsygv(LAPACK_ROW_MAJOR, 1, 'N', 'U', n, &stiffness[first][first], N,
                                       &mass[first][first], N, square),
                         0);
        NEAR(slowest_mode(fish), sqrt(square[fixed ? 0 : 2]) / (2 * M_PI), 0, 1e-9);
    }
}

TEST(the_accelerated_fluid_makes_modes_slower) {
    // with added mass pi/4 rho w^2 per length on pi/4 rho_b h w: a factor sqrt(1 + 1000/800*0.4/0.2)
    const double dry = slowest_mode(UNIFORM);
    const double wet = slowest_mode(
        "nodes: 81, length: 2, force: reactive, added_mass: {coefficient: 1, extent: depth}, body: {profile: uniform, "
        "thickness: 0.1, depth: 0.2, density: 800, modulus: 2e6, second_moment: ellipse}");
    NEAR(dry / wet, sqrt(1 + 1000.0 / 800 * 2), 0, 0.02);
}

TEST(the_pressure_of_a_sheet_makes_the_mode_of_a_light_plate) {
    // Ritz's method with 14 polynomials, EI int w''^2 ds against the kinetic energy of the fluid around a plate of the
    // length 2, rho d (L^2/4) (pi/2) sum a_n^2/n with w sin(theta) = sum a_n sin(n theta): 8.9060824 sqrt(EI/(rho d))
    const double h = 0.2, d = 0.4, stiffness = 2e6 * M_PI * d * h * h * h / 64;
    const double found = slowest_mode(
        "nodes: 81, sheet_points: 161, length: 2, force: pressure, pressure: {span: infinite}, body: {profile: "
        "uniform, thickness: 0.1, depth: 0.2, density: 1e-3, modulus: 2e6, second_moment: ellipse}");
    NEAR(found, 8.9060824 * sqrt(stiffness / (1000 * d)) / (2 * M_PI), 0, 0.003);
}

TEST(a_body_and_its_mirror_image_have_the_same_modes) {
    // thickness and depth from the nose to the tail and back, alone and in the fluid
    static const char *const forces[] = {"reactive", "pressure, pressure: {span: infinite}, sheet_points: 21"};
    for (int i = 0; i < 2; i++) {
        double frequency[2];
        for (int back = 0; back < 2; back++) {
            frequency[back] = slowest_mode(arena_text(
                test_arena(), "nodes: 7, force: %s, body: {profile: table, thickness_table: %s, depth_table: %s}",
                forces[i], back ? "[.03, .05, .06, .07, .08, .06]" : "[.06, .08, .07, .06, .05, .03]",
                back ? "[.4, .35, .3, .2, .15, .1]" : "[.1, .15, .2, .3, .35, .4]"));
        }
        NEAR(frequency[1], frequency[0], 0, 1e-6);
    }
}

TEST(frequency_grows_with_the_root_of_the_modulus) {
    const double soft = slowest_mode("body: {modulus: 1e5}"), stiff = slowest_mode("body: {modulus: 9e5}");
    NEAR(stiff / soft, 3, 0, 1e-12);
}
