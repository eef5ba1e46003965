/* test_counts.c: The number of steps, iterations and Jacobians of a shedding interval hardly depends on the stiffness
 * of the body (doc/numerics.md, section 4). */
#include <math.h>
#include <stdio.h>

#include "school.h"
#include "solver/dense_factors.h"
#include "solver/fish_factors.h"

struct cost {
    double steps, iterations, jacobians, failures; /* the last: convergence failures */
};

// blocks that were factorised in parts
static int n_divided;

int __real_dense_factors_set_up(struct dense_factors *factors);
int __wrap_dense_factors_set_up(struct dense_factors *factors);
int __wrap_dense_factors_set_up(struct dense_factors *factors) {
#pragma omp atomic
    n_divided++;
    return __real_dense_factors_set_up(factors);
}

// means per event of a case up to time.end, s
static struct cost cost_per_event(const char *text, double end) {
    struct simulation *const simulation = school_simulation(text);
    school_run(simulation, end);
    const struct integrator_counts counts = school_counts(simulation);
    const double n_events = (double)simulation->state->event;
    assert_int_equal(simulation->state->event, lround(end / simulation->school->interval));
    return (struct cost){(double)counts.steps / n_events, (double)counts.newton_iterations / n_events,
                         (double)counts.jacobian_evaluations / n_events,
                         (double)counts.convergence_failures / n_events};
}

static void print_cost(const char *name, double modulus, const struct cost *cost) {
    print_message("%s, E %.0e Pa: per event %.2f steps, %.2f iterations, %.2f Jacobians, %.3f failures\n", name,
                  modulus, cost->steps, cost->iterations, cost->jacobians, cost->failures);
}

// one fish with the published force; the wave starts from rest
static struct cost cost_of_article(int nodes, int sheet_points, const char *second_moment, double modulus) {
    char text[512], name[64];
    snprintf(text, sizeof text,
             "time: {end: 2, shedding_interval: 0.01}\nsolver: {rtol: 1.0e-5}\nwake: {shedding: continuous}\n"
             "fish: [{force: published, nodes: %d, sheet_points: %d, body: {second_moment: %s, modulus: %.1e}, wave: "
             "{ramp: 1}}]\n",
             nodes, sheet_points, second_moment, modulus);
    const struct cost cost = cost_per_event(text, 2);
    snprintf(name, sizeof name, "N %d, M %d, %s", nodes, sheet_points, second_moment);
    print_cost(name, modulus, &cost);
    return cost;
}

TEST(stiffness_costs_nothing) {
    const double moduli[] = {1e4, 1e6, 1e8, 1e10};
    for (size_t i = 0; i < sizeof moduli / sizeof *moduli; i++) {
        const struct cost cost = cost_of_article(7, 21, "published", moduli[i]);
        AT_MOST(cost.steps, 5);
        AT_MOST(cost.iterations, 13);
        AT_MOST(cost.jacobians, 1);
    }
}

TEST(a_fine_body_costs_few_steps) {
    const char *const moments[] = {"ellipse", "published"};
    for (int i = 0; i < 2; i++) {
        const struct cost cost = cost_of_article(41, 65, moments[i], 1e7);
        AT_MOST(cost.steps, 6);
        AT_MOST(cost.iterations, 16);
        AT_MOST(cost.jacobians, 1);
    }
}

TEST(a_default_fish_costs_as_little) {
    const double moduli[] = {1e4, 3e4, 1e5, 1e6, 1e8, 1e10};
    for (size_t i = 0; i < sizeof moduli / sizeof *moduli; i++) {
        const double end = 4;
        char text[256];
        snprintf(text, sizeof text, "time: {end: %g}\nfish: [{body: {modulus: %.1e}}]\n", end, moduli[i]);
        const struct cost cost = cost_per_event(text, end);
        print_cost("default fish", moduli[i], &cost);
        AT_MOST(cost.steps, 2.5);
        AT_MOST(cost.iterations, 6);
        AT_MOST(cost.jacobians, 0.5);  // most where the slowest mode beats with the muscle
        // stiff bodies: some convergence failures with old Jacobians that an age limit would have replaced, 34 in 400
        // events with 1e10 Pa
        AT_MOST(cost.failures, moduli[i] < 1e8 ? 0.01 : 0.1);
    }
}

// the rod of the first Jacobians, with steps of the initial size, is nearly singular; the later ones are not
TEST(blocks_are_factorised_in_parts_again_after_a_failure) {
    struct simulation *const simulation =
        school_simulation("time: {end: 2, shedding_interval: 0.02}\nfish: [{start: {speed: 0.79}}]\n");
    n_divided = 0;
    school_run(simulation, 2);
    const struct integrator_counts counts = school_counts(simulation);
    print_message("%d of %ld Jacobians in parts\n", n_divided, counts.jacobian_evaluations);
    NEAR(n_divided, (double)counts.jacobian_evaluations, 6, 0);
}

// counts are the same with the sanitizers, which make 16 fish take a quarter of an hour
#ifdef __SANITIZE_ADDRESS__
enum { N_SCHOOLS = 2 };
#else
enum { N_SCHOOLS = 3 };
#endif

/* Fish in a square lattice at their cruising speed, interval 0.02 s. IDA's default bounds of the step take 0.34, 0.49
 * and 0.64 Jacobians per event. */
TEST(a_step_keeps_its_size_and_its_jacobian) {
    const struct {
        int n;
        double end, jacobians;
    } schools[] = {{1, 5, 0.22}, {4, 3, 0.3}, {16, 2, 0.36}};
    for (int i = 0; i < N_SCHOOLS; i++) {
        const int n = schools[i].n, in_row = (int)lround(sqrt(n));
        char text[2048];
        int length = snprintf(text, sizeof text, "time: {end: %g, shedding_interval: 0.02}\nfish:\n", schools[i].end);
        for (int f = 0; f < n; f++) {
            length +=
                snprintf(text + length, sizeof text - (size_t)length,
                         "  - {start: {position: [%g, %g], speed: 0.79}}\n", 1.3 * (f % in_row), 0.4 * (f / in_row));
        }
        const struct cost cost = cost_per_event(text, schools[i].end);
        AT_MOST(cost.steps, 7);
        AT_MOST(cost.iterations, 14);
        AT_MOST(cost.jacobians, schools[i].jacobians);
    }
}

TEST(two_fish_beside_each_other_cost_as_little) {
    const struct cost cost = cost_per_event("time: {end: 2}\nfish: [{}, {start: {position: [0, 0.3]}}]\n", 2);
    print_cost("two default fish", 1e6, &cost);
    AT_MOST(cost.steps, 5);
    AT_MOST(cost.iterations, 13);
    AT_MOST(cost.jacobians, 1);
    AT_MOST(cost.failures, 0.01);
}

/* Nine fish 1.3 lengths from nose to nose and 0.4 beside each other: without coupling blocks, Newton's method takes
 * 17 iterations per event, mostly with one failure. The solver must detect the need for coupling blocks. */
TEST(a_dense_school_couples_what_it_needs) {
    char text[1024];
    int length = snprintf(text, sizeof text, "time: {end: 0.5}\nsolver: {coupling_distance: 0}\nfish:\n");
    for (int f = 0; f < 9; f++) {
        length += snprintf(text + length, sizeof text - (size_t)length, "  - {start: {position: [%g, %g]}}\n",
                           1.3 * (f % 3), 0.4 * (f / 3));
    }
    const struct cost cost = cost_per_event(text, 0.5);
    AT_MOST(cost.iterations, 7);
    AT_MOST(cost.jacobians, 1);
    AT_MOST(cost.failures, 0.1);
}

// the corners of E I/(rho f^2 L^5) = 0.05 to 1e6 and added mass over mass of 1 to 100, without damping. Interior
// points: cases/studies/added_mass.yaml
TEST(a_light_or_stiff_body_under_pressure_costs_as_little) {
    const double densities[] = {5.59017, 0.0559017}, moduli[] = {177.94, 3.5588e9};
    for (int i = 0; i < 4; i++) {
        char text[512];
        snprintf(text, sizeof text,
                 "time: {end: 1, shedding_interval: 0.01}\nfluid: {density: 1, viscosity: 1.0e-4}\n"
                 "fish: [{force: pressure, pressure: {span: infinite}, drag: {skin: laminar}, start: {speed: 0.65},\n"
                 "        wave: {amplitude: 0.83, constant: 0.2, linear: 0.8, quadratic: 0, number: -6.28, ramp: 1},\n"
                 "        body: {profile: uniform, thickness: 0.17888544, depth: 1, relaxation_time: 0,\n"
                 "               density: %g, modulus: %g}}]\n",
                 densities[i % 2], moduli[i / 2]);
        const struct cost cost = cost_per_event(text, 1);
        print_cost(i % 2 ? "light" : "heavy", moduli[i / 2], &cost);
        AT_MOST(cost.steps, 8);
        AT_MOST(cost.iterations, 20);
        AT_MOST(cost.jacobians, 1);
        AT_MOST(cost.failures, 0.02);
    }
}
