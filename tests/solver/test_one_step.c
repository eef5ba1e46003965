/* test_one_step.c: order, agreement with the other methods, counts, failures. */
#include <stdio.h>

#include "school.h"
#include "solver/one_step.h"

#define FISH "fish: [{nodes: 7, sheet_points: 13, body: {modulus: 1.0e+4}, drag: {normal: 0, tangential: 0}}]\n"

// one fish; coupled fish; a prescribed head; circulation as a differential unknown; jumps
static const char *const cases[] = {
    "time: {end: 0.4, shedding_interval: 0.02}\n" FISH,
    "time: {end: 0.4, shedding_interval: 0.02}\n"
    "fluid: {velocity: [0.1, -0.05], shear: 0.2}\n"
    "fish:\n"
    "  - {nodes: 7, sheet_points: 13, control: {law: heading, desired_heading: 150}}\n"
    "  - {nodes: 9, length: 0.8, sheet_points: 11, start: {position: [0.2, 0.5]}, drag: {law: linear_quadratic}}\n",
    "time: {end: 0.4, shedding_interval: 0.02}\n"
    "fluid: {velocity: [-1, 0]}\n"
    "fish: [{nodes: 8, sheet_points: 15, wave: {amplitude: 0}, start: {speed: 0},\n"
    "        motion: {prescribed: head, heave: 0.1, pitch: 10, frequency: 1, speed: 0}}]\n",
    "time: {end: 0.4, shedding_interval: 0.02}\nsheet: {kutta: rate}\n" FISH,
    "time: {end: 0.4, shedding_interval: 0.02}\nwake: {shedding: impulsive}\n" FISH,
};

// y of the tail of the last fish at the end
static double tail_at_end(const char *text, const char *solver) {
    char whole[1024];
    snprintf(whole, sizeof whole, "%ssolver: {%s}\n", text, solver);
    struct simulation *const simulation = school_simulation(whole);
    school_run(simulation, 0.4);
    const struct fish *fish = &simulation->school->fish[simulation->school->n_fish - 1];
    const double tail = simulation->state->y[fish->at.y + fish->n_nodes - 1];
    simulate_free(simulation);
    return tail;
}

static void steps_converge_with_the_order_of_the_method(void **state) {
    (void)state;
    static const char *const methods[] = {"implicit_euler", "trapezoid"};
    // the explicit reference solves the same equations to 1e-11
    const double exact = tail_at_end(cases[0], "method: dormand_prince, rtol: 1.0e-12");
    for (int order = 1; order <= 2; order++) {
        double error[2];
        for (int i = 0; i < 2; i++) {
            char solver[128];
            snprintf(solver, sizeof solver, "method: %s, step: %g, rtol: 1.0e-9", methods[order - 1], 0.002 / (1 << i));
            error[i] = tail_at_end(cases[0], solver) - exact;
        }
        const double observed = log2(fabs(error[0] / error[1]));
        print_message("%s: errors %.2e %.2e, order %.2f\n", methods[order - 1], error[0], error[1], observed);
        NEAR(observed, order, 0.1, 0);
    }
}

static void all_cases_agree_with_ida(void **state) {
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const double want = tail_at_end(cases[i], "rtol: 1.0e-9, order: 5");
        // second order: four times the steps, a sixteenth of the error
        const double coarse = tail_at_end(cases[i], "method: trapezoid, step: 0.002, rtol: 1.0e-8") - want;
        const double fine = tail_at_end(cases[i], "method: trapezoid, step: 0.0005, rtol: 1.0e-8") - want;
        print_message("case %zu: errors %.2e %.2e\n", i, coarse, fine);
        NEAR(coarse, 0, 3e-5, 0);
        NEAR(fine, 0, fabs(coarse) / 8 + 2e-8, 0);
    }
}

#define STIFF                                     \
    "time: {end: 0.4, shedding_interval: 0.02}\n" \
    "fish: [{nodes: 7, sheet_points: 13, body: {modulus: 1.0e+9}}]\n"

static void a_very_stiff_body_needs_no_shorter_steps(void **state) {
    (void)state;
    const double exact = tail_at_end(STIFF, "rtol: 1.0e-9, order: 5");
    // a quarter of the shedding interval; an explicit method needs thousands of steps per interval
    NEAR(tail_at_end(STIFF, "method: trapezoid, step: 0.005"), exact, 1e-5, 0);
    NEAR(tail_at_end(STIFF, "method: implicit_euler, step: 0.005"), exact, 2e-3, 0);
}

static void soft_rods_of_many_nodes_converge_whatever_the_step(void **state) {
    (void)state;
    // a base that heaves, in no fluid: pivots a thousandth of the largest would lose the digits that Newton's iteration
    // needs, the more so the smaller the step
    static const int nodes[] = {31, 41, 51};
    static const double steps[] = {0.003125, 0.0015625, 0.00078125};
    for (int i = 0; i < 9; i++) {
        char text[512];
        snprintf(text, sizeof text,
                 "time: {end: 1, shedding_interval: 0.0125, output_interval: 0.0125}\nfluid: {density: 0}\n"
                 "solver: {method: trapezoid, step: %.8f}\n"
                 "fish: [{nodes: %d, sheet_points: 5, body: {modulus: 1.0e+5}, wave: {amplitude: 0},\n"
                 "        start: {speed: 0}, motion: {prescribed: head, heave: 0.05, frequency: 1, speed: 0}}]\n",
                 steps[i % 3], nodes[i / 3]);
        struct simulation *const simulation = school_simulation(text);
        school_run(simulation, 0.1);
        simulate_free(simulation);
    }
}

static void a_jacobian_is_kept_for_many_steps(void **state) {
    (void)state;
    struct simulation *const simulation = school_simulation("time: {end: 0.4, shedding_interval: 0.02}\n" FISH
                                                            "solver: {method: trapezoid, step: 0.005}\n");
    school_run(simulation, 0.4);
    struct integrator_counts counts;
    simulation->integrator->count(simulation->solver, &counts);
    assert_int_equal(counts.steps, 80);
    assert_int_equal(counts.order, 2);
    NEAR(counts.step_size, 0.005, 0, 0);
    assert_in_range(counts.newton_iterations, 80, 400);
    assert_int_equal(counts.residual_evaluations, counts.newton_iterations);
    assert_in_range(counts.jacobian_evaluations, 1, 20);
    simulate_free(simulation);
}

static void rates_of_algebraic_unknowns_are_differences_over_the_step(void **state) {
    (void)state;
    static const char *const methods[] = {"implicit_euler", "trapezoid"};
    for (int i = 0; i < 2; i++) {
        char text[512];
        snprintf(text, sizeof text,
                 "time: {end: 1, shedding_interval: 0.005}\nsolver: {method: %s, step: 0.005}\n"
                 "fish: [{wave: {ramp: 0}, control: {law: heading, desired_heading: 150}}]\n",
                 methods[i]);
        struct simulation *const simulation = school_simulation(text);
        school_shed_step_by_step(simulation);
        simulate_free(simulation);
    }
}

static void fails(const char *text, const char *message) {
    struct simulation *const simulation = school_simulation(text);
    school_fails(simulation, message);
    simulate_free(simulation);
}

static void a_failure_tells_the_time(void **state) {
    (void)state;
    // half a beat in one step
    fails(
        "time: {end: 50, shedding_interval: 0.5}\nsolver: {method: implicit_euler, step: 0.5}\n"
        "fish: [{nodes: 7, sheet_points: 13, body: {modulus: 1.0e+9}}]\n",
        "integration failed at t = ");
    fails(
        "time: {end: 1, shedding_interval: 0.02}\nsolver: {method: trapezoid, step: 0.001, max_steps: 10}\n"
        "fish: [{nodes: 7, sheet_points: 13}]\n",
        "20 steps between two events are more than solver.max_steps");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(steps_converge_with_the_order_of_the_method),
        cmocka_unit_test(all_cases_agree_with_ida),
        cmocka_unit_test(a_very_stiff_body_needs_no_shorter_steps),
        cmocka_unit_test(soft_rods_of_many_nodes_converge_whatever_the_step),
        cmocka_unit_test(a_jacobian_is_kept_for_many_steps),
        cmocka_unit_test(rates_of_algebraic_unknowns_are_differences_over_the_step),
        cmocka_unit_test(a_failure_tells_the_time),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
