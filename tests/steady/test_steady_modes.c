/* test_steady_modes.c: The growth of small disturbances of bodies without a beat agrees with beams in vacuum and with a
 * run, and does not depend on the direction of the stream. `make verify`, section "elastic", has the thresholds of
 * flutter. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "school.h"
#include "steady/steady_modes.h"
#include "steady/steady_problem.h"
#include "steady/steady_static.h"

enum { MOST = 2 * STEADY_QUANTITIES };

struct found {
    struct simulation *simulation;
    struct steady_values values;
    struct steady_fish fish[2];
    double rate[MOST], omega[MOST];
};

/* The equilibrium of a case, and its exponents. */
static void find(struct found *found, const char *text) {
    *found = (struct found){.simulation = school_simulation(text)};
    found->values.fish = found->fish;
    found->values.rate = found->rate;
    found->values.omega = found->omega;
    school_ok(steady_static_find(found->simulation, NULL, &found->values));
    school_ok(steady_modes_find(found->simulation, &found->values));
}

/* The exponent with the frequency nearest to a given one. */
static int nearest(const struct found *found, double omega) {
    int best = 0;
    for (int i = 1; i < found->values.n_exponents; i++) {
        if (fabs(found->omega[i] - omega) < fabs(found->omega[best] - omega)) best = i;
    }
    ABOVE(found->values.n_exponents, 0);
    return best;
}

/* A plate of mass 1 and bending stiffness 1/64 per length and span, clamped at its nose. */
#define PLATE_OF(modulus) "body: {profile: uniform, thickness: 0.02, depth: 1, density: 63.662, modulus: " modulus ", "
#define PLATE PLATE_OF("39788")
#define CLAMPED \
    "force: pressure, pressure: {span: infinite}, wave: {amplitude: 0, frequency: 0}, motion: {prescribed: head}, "

TEST(without_water_they_are_those_of_a_clamped_beam) {
    static const char text[] =
        "time: {end: 1, shedding_interval: 0.01}\nfluid: {density: 1e-9, velocity: [1, 0], viscosity: 0}\n"
        "wake: {lifetime: 2}\n"
        "fish: [{nodes: 33, " CLAMPED PLATE "relaxation_time: 0.02}, start: {heading: 180, speed: 0}}]\n";
    struct found found;
    find(&found, text);
    // Kelvin and Voigt: lambda^2 + omega^2 (1 + tau lambda) = 0, so that the rate is -tau |lambda|^2/2
    const double number[] = {1.875104, 4.694091}, within[] = {2e-3, 6e-3};  // of second order in the edges
    for (int j = 0; j < 2; j++) {
        const double omega = number[j] * number[j] / 8;
        const int i = nearest(&found, omega);
        NEAR(found.omega[i], omega, 0, within[j]);
        NEAR(found.rate[i], -0.01 * (pow(found.rate[i], 2) + pow(found.omega[i], 2)), 0, 1e-5);
    }
}

// modes that decay alike, here not at all, differ by their frequencies
TEST(modes_without_damping_are_told_apart) {
    static const char text[] =
        "time: {end: 1, shedding_interval: 0.02}\nfluid: {density: 1e-9, velocity: [1, 0], viscosity: 0}\n"
        "wake: {lifetime: 1}\nfish: [{nodes: 17, sheet_points: 33, " CLAMPED PLATE
        "relaxation_time: 0}, start: {heading: 180, speed: 0}}]\n";
    struct found found;
    find(&found, text);
    const double number[] = {1.875104, 4.694091, 7.854757}, within[] = {8e-3, 2.4e-2, 5e-2};
    for (int j = 0; j < 3; j++) {
        const double omega = number[j] * number[j] / 8;
        const int i = nearest(&found, omega);
        NEAR(found.omega[i], omega, 0, within[j]);
        NEAR(found.rate[i], 0, 1e-6, 0);
    }
}

#define STREAM(velocity)                         \
    "time: {end: 40, shedding_interval: 0.04}\n" \
    "fluid: {density: 1, velocity: " velocity    \
    ", viscosity: 0}\n"                          \
    "solver: {rtol: 1e-7}\nwake: {lifetime: 12, decay: 9}\n"
#define FLAG "nodes: 9, sheet_points: 17, " CLAMPED PLATE "relaxation_time: 0}, "
#define SOFT_FLAG "nodes: 9, sheet_points: 17, " CLAMPED PLATE_OF("10000") "relaxation_time: 0}, "

/* A flag disturbed by 1e-5 rad: logarithmic decrement of the tail over three periods. */
TEST(a_run_grows_as_fast) {
    struct found found;
    find(&found, STREAM("[1, 0]") "fish: [{" FLAG "start: {heading: 180, speed: 0}}]\n");
    ABOVE(found.rate[0], 0.1);
    ABOVE(found.omega[0], 0);
    NEAR(found.values.growth, found.rate[0], 0, 0);
    NEAR(found.values.growth_frequency, found.omega[0] / (2 * 3.14159265358979), 0, 1e-12);
    const double rate = found.rate[0], period = 1 / found.values.growth_frequency;

    struct simulation *const run =
        school_simulation(STREAM("[1, 0]") "fish: [{" FLAG "start: {heading: 179.9994, speed: 0}}]\n");
    const struct fish *const fish = &run->school->fish[0];
    const int tail = fish->at.y + fish->n_nodes - 1;
    double least[2] = {INFINITY, INFINITY}, most[2] = {-INFINITY, -INFINITY};
    const double from[] = {12, 12 + 3 * period};
    while (run->state->t < from[1] + period) {
        school_ok(simulate_step(run));
        for (int i = 0; i < 2; i++) {
            if (run->state->t < from[i] || run->state->t > from[i] + period) continue;
            least[i] = fmin(least[i], run->state->y[tail]);
            most[i] = fmax(most[i], run->state->y[tail]);
        }
    }
    BELOW(most[1] - least[1], 0.05);
    // the mean over the interval leaves errors of the square of omega Dt
    NEAR(log((most[1] - least[1]) / (most[0] - least[0])) / (3 * period), rate, 0.004, 0);
}

TEST(they_do_not_depend_on_who_moves) {
    struct found still, moving;
    find(&still, STREAM("[1, 0]") "fish: [{" FLAG "start: {heading: 180, speed: 0}}]\n");
    find(&moving, STREAM("[0, 0]") "fish: [{" FLAG "start: {heading: 180, speed: 1}}]\n");
    assert_int_equal(still.values.n_exponents, moving.values.n_exponents);
    for (int i = 0; i < moving.values.n_exponents; i++) {
        NEAR(still.rate[i], moving.rate[i], 1e-6, 1e-5);
        NEAR(still.omega[i], moving.omega[i], 1e-6, 1e-5);
    }
}

/* The modes of a flag in a stream, with the keys of the wake. */
static void find_in_wake(struct found *found, const char *flag, const char *wake) {
    char text[1024];
    snprintf(text, sizeof text,
             "time: {end: 1, shedding_interval: 0.04}\n"
             "fluid: {density: 1, velocity: [1, 0], viscosity: 0}\nwake: {%s}\n"
             "fish: [{%sstart: {heading: 180, speed: 0}}]\n",
             wake, flag);
    find(found, text);
}

/* For a long vortex lifetime the modes include the newest part of the wake only, which must decay all the same. */
TEST(the_lifetime_of_a_long_wake_does_not_matter) {
    static const char *const wake[] = {"lifetime: 12, decay: 9", "lifetime: 1000", "lifetime: 1000, decay: 100"};
    struct found found[3];
    for (int k = 0; k < 3; k++) {
        find_in_wake(&found[k], FLAG, wake[k]);
        NEAR(found[k].rate[0], found[0].rate[0], 2e-4, 0);
        NEAR(found[k].omega[0], found[0].omega[0], 2e-4, 0);
    }
}

/* Growth has no limit: only modes that decay within the life of the wake are left out. */
// dropped markers leave gaps, so the place of a marker in the wake is not its age
TEST(dropped_markers_do_not_change_them) {
    static const char text[] =
        "time: {end: 1, shedding_interval: 0.02}\nfluid: {density: 1, velocity: [1, 0], viscosity: 0}\n"
        "wake: {lifetime: 5}\n"
        "fish: [{nodes: 9, sheet_points: 33, force: pressure, pressure: {span: infinite}, start: {heading: 180, speed: "
        "0},\n"
        "        wave: {amplitude: 0, frequency: 0}, motion: {prescribed: head},\n"
        "        body: {profile: uniform, thickness: 0.02, depth: 1, density: 63.662, modulus: 39788, relaxation_time: "
        "0}}]\n";
    struct found with, without = {.simulation = school_simulation(text)};
    find(&with, text);
    ((struct school *)without.simulation->school)->wake_spacing = 0;
    without.values = (struct steady_values){.fish = without.fish, .rate = without.rate, .omega = without.omega};
    school_ok(steady_static_find(without.simulation, NULL, &without.values));
    school_ok(steady_modes_find(without.simulation, &without.values));
    ABOVE(without.values.n_exponents, 1);
    for (int i = 0; i < 2; i++) {
        const int k = nearest(&with, without.omega[i]);
        NEAR(with.omega[k], without.omega[i], 0, 2e-4);
        NEAR(with.rate[k], without.rate[i], 0, 2e-4);
    }
}

TEST(a_mode_that_grows_fast_in_a_long_wake_is_found) {
    struct found brief, longer;
    find_in_wake(&brief, SOFT_FLAG, "lifetime: 4, decay: 3");
    find_in_wake(&longer, SOFT_FLAG, "lifetime: 24, decay: 18");
    ABOVE(longer.rate[0] * 24, 6);
    NEAR(longer.rate[0], brief.rate[0], 0, 1e-2);
    NEAR(longer.omega[0], brief.omega[0], 0, 1e-2);
}

TEST(bodies_far_apart_have_the_modes_of_one) {
    struct found one, two;
    find(&one, STREAM("[1, 0]") "fish: [{" FLAG "start: {heading: 180, speed: 0}}]\n");
    find(&two, STREAM("[1, 0]") "fish: [{" FLAG "start: {heading: 180, speed: 0}}, {" FLAG
                                "start: {position: [0, 1000], heading: 180, speed: 0}}]\n");
    for (int i = 0; i < one.values.n_exponents; i++) {
        const int j = nearest(&two, one.omega[i]);
        NEAR(two.rate[j], one.rate[i], 1e-5, 0);
        NEAR(two.omega[j], one.omega[i], 1e-5, 0);
    }
    // flags side by side interact
    struct found beside;
    find(&beside, STREAM("[1, 0]") "fish: [{" FLAG "start: {heading: 180, speed: 0}}, {" FLAG
                                   "start: {position: [0, 0.3], heading: 180, speed: 0}}]\n");
    ABOVE(fabs(beside.rate[0] - two.rate[0]) + fabs(beside.omega[0] - two.omega[0]), 0.02);
}

/* A flag with the clamp downstream is a column under the load pi/4 rho U^2 of slender bodies, which buckles. */
TEST(what_has_no_stiffness_left_diverges) {
    const double pi = 3.14159265358979, critical = pi / 2 * sqrt(1 / 64.0 / (pi / 4));
    const double part[] = {0.9, 1.1};
    for (int i = 0; i < 2; i++) {
        char text[1024];
        struct found found;
        snprintf(text, sizeof text,
                 "time: {end: 1, shedding_interval: 0.05}\nfluid: {density: 1, velocity: [-%g, 0]}\n"
                 "wake: {lifetime: 20}\nfish: [{force: reactive, nodes: 9, sheet_points: 17, wave: {amplitude: 0, "
                 "frequency: 0}, motion: {prescribed: head}, drag: {tangential: 0}, " PLATE
                 "relaxation_time: 0.2}, start: {heading: 180, speed: 0}}]\n",
                 part[i] * critical);
        find(&found, text);
        int n_diverging = 0;
        for (int k = 0; k < found.values.n_exponents; k++) n_diverging += found.rate[k] > 1e-3 && !(found.omega[k] > 0);
        assert_int_equal(n_diverging, i);
        assert_int_equal(found.values.stiffness < 0, i);
    }
}

TEST(the_simulation_stays_where_it_is) {
    struct found found = {.simulation =
                              school_simulation(STREAM("[1, 0]") "fish: [{" FLAG "start: {heading: 176, speed: "
                                                                 "0}}]\n")};
    found.values.fish = found.fish;
    found.values.rate = found.rate;
    found.values.omega = found.omega;
    school_ok(steady_static_find(found.simulation, NULL, &found.values));
    const int n = found.simulation->school->n_unknowns;
    double *const before = test_copy(n, found.simulation->state->y);
    const double reach = found.simulation->residual->couplings.reach;
    school_ok(steady_modes_find(found.simulation, &found.values));
    NEAR(found.simulation->residual->couplings.reach, reach, 0, 0);
    assert_memory_equal(before, found.simulation->state->y, (size_t)n * sizeof *before);
    assert_int_equal(found.simulation->state->event, 0);
    assert_int_equal(found.simulation->state->wake[0].n_vortex, 0);
}

TEST(multipliers_become_exponents) {
    double real[] = {0.6, 0.6, 0.5, 0}, imaginary[] = {0.8, -0.8, 0, 0}, rate[4], omega[4];
    struct steady_values values = {
        .n_multipliers = 4, .real = real, .imaginary = imaginary, .rate = rate, .omega = omega};
    steady_modes_of_multipliers(&values, 2);
    assert_int_equal(values.n_exponents, 2);
    NEAR(rate[0], 0, 1e-12, 0);
    NEAR(omega[0], atan2(0.8, 0.6) / 2, 0, 1e-12);
    NEAR(rate[1], log(0.5) / 2, 0, 1e-12);
    NEAR(values.growth_frequency, omega[0] / (2 * 3.14159265358979), 0, 1e-12);
}
