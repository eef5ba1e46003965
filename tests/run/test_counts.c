/* test_counts.c: what a shedding interval costs, whatever the stiffness of the body: issue 2, doc/numerics.md. */
#include <stdio.h>

#include "school.h"

struct cost {
    double steps, iterations, jacobians;
};

// means per event over 2 s, of one fish at the default tolerances, from rest of its wave
static struct cost cost_per_event(int nodes, int sheet_points, const char *second_moment, double modulus) {
    char text[512];
    snprintf(text, sizeof text,
             "time: {end: 2, shedding_interval: 0.01}\n"
             "solver: {rtol: 1.0e-5}\n"
             "fish: [{nodes: %d, sheet_points: %d, body: {second_moment: %s, modulus: %.1e}, wave: {ramp: 1}}]\n",
             nodes, sheet_points, second_moment, modulus);
    struct simulation *const simulation = school_simulation(text);
    school_run(simulation, 2);
    struct integrator_counts counts;
    simulation->integrator->count(simulation->solver, &counts);
    const double n_events = (double)simulation->state->event;
    assert_int_equal(simulation->state->event, 200);
    simulate_free(simulation);
    const struct cost cost = {(double)counts.steps / n_events, (double)counts.newton_iterations / n_events,
                              (double)counts.jacobian_evaluations / n_events};
    print_message("N %d, M %d, %s, E %.0e Pa: per event %.2f steps, %.2f iterations, %.2f Jacobians\n", nodes,
                  sheet_points, second_moment, modulus, cost.steps, cost.iterations, cost.jacobians);
    return cost;
}

static void stiffness_costs_nothing(void **state) {
    (void)state;
    const double moduli[] = {1e4, 1e6, 1e8, 1e10};
    for (size_t i = 0; i < sizeof moduli / sizeof *moduli; i++) {
        const struct cost cost = cost_per_event(7, 21, "published", moduli[i]);
        assert_true(cost.steps <= 5);
        assert_true(cost.iterations <= 13);
        assert_true(cost.jacobians <= 1);
    }
}

static void a_fine_body_costs_few_steps(void **state) {
    (void)state;
    const char *const moments[] = {"ellipse", "published"};
    for (int i = 0; i < 2; i++) {
        const struct cost cost = cost_per_event(41, 65, moments[i], 1e7);
        assert_true(cost.steps <= 6);
        assert_true(cost.iterations <= 16);
        assert_true(cost.jacobians <= 1);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(stiffness_costs_nothing),
        cmocka_unit_test(a_fine_body_costs_few_steps),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
