/* test_integrator.c: The rates that an integrator computes from differences are exact for parabolas, and only fish that
 * need them have them. */
#include <stdio.h>

#include "school.h"
#include "solver/integrator.h"

static const char two_fish[] =
    "time: {end: 1}\nwake: {shedding: sheet}\nsheet: {curve: smooth}\n"
    "fish: [{nodes: 5, sheet_points: 9, force: pressure, pressure: {span: infinite}}, {nodes: 5, sheet_points: 9, "
    "force: reactive, start: {position: [0, 2]}}]\n";

static double parabola(int i, double t) {
    return i + 3 * t - (i % 5) * t * t;
}

static double slope(int i, double t) {
    return 3 - 2 * (i % 5) * t;
}

static void set(struct setup *setup, double t) {
    for (int i = 0; i < setup->school->n_unknowns; i++) {
        setup->state->y[i] = parabola(i, t);
        setup->state->yp[i] = -7;
    }
}

TEST(rates_of_parabolas_are_exact_from_the_second_step_on) {
    struct setup setup = setup_of(two_fish);
    const struct fish *fish = setup.school->fish;
    struct integrator_rates *const rates = integrator_rates_create(setup.arena, setup.school);
    const double times[] = {0, 0.1, 0.13, 0.2, 0.35};
    set(&setup, 0);
    integrator_rates_begin(rates, setup.state);
    for (int n = 1; n < 5; n++) {
        set(&setup, times[n]);
        integrator_rates_step(rates, times[n], setup.state);
        for (int i = 0; i < setup.school->n_unknowns; i++) {
            const bool is_strength = i >= fish->at.gamma && i < fish->at.circulation;
            const double line = (parabola(i, times[1]) - parabola(i, 0)) / times[1];
            const double want = !is_strength ? -7 : n == 1 ? line : slope(i, times[n]);
            NEAR(setup.state->yp[i], want, 1e-11, 0);  // rounding of values of 60 over a step of 0.03
        }
    }
    // what was before a jump does not count
    setup.state->t = 0.4;
    set(&setup, 0.4);
    integrator_rates_begin(rates, setup.state);
    set(&setup, 0.5);
    integrator_rates_step(rates, 0.5, setup.state);
    const int i = fish->at.gamma;
    NEAR(setup.state->yp[i], (parabola(i, 0.5) - parabola(i, 0.4)) / 0.1, 1e-11, 0);
}

// ---- every row of the table of methods can be integrated

/* For every method, for those of a rod alone, and for those with the added mass in momenta. */
static const char soft[] =
    "wake: {shedding: continuous}\nfish: [{nodes: 7, body: {modulus: 1.0e+4}, wave: {ramp: 0}, start: {speed: 1}}]\n";
static const char rod_alone[] =
    "fluid: {density: 0}\nwake: {tolerance: 0}\n"
    "fish: [{nodes: 7, force: reactive, body: {modulus: 1.0e+4, relaxation_time: 0, bending_damping: 0, "
    "stretching_damping: 0}, wave: {amplitude: 1, ramp: 0.1}}]\n";
static const char with_momenta[] = "fish: [{nodes: 9, wave: {amplitude: 1, ramp: 0}, start: {speed: 1}}]\n";

TEST(methods_have_their_integrators) {
    assert_ptr_equal(integrator_of(METHOD_IDA), &ida_integrator);
    assert_ptr_equal(integrator_of(METHOD_IMPLICIT_EULER), &one_step_integrator);
    assert_ptr_equal(integrator_of(METHOD_TRAPEZOID), &one_step_integrator);
    assert_ptr_equal(integrator_of(METHOD_IMEX), &one_step_integrator);
    for (int i = 0; i < methods_n; i++) {
        if (methods_table[i].is_implicit) continue;
        const enum method method = (enum method)i;
        const struct integrator *const want = method == METHOD_VERLET ? &one_step_verlet : &runge_kutta_integrator;
        assert_ptr_equal(integrator_of(method), want);
    }
}

// y of the tail after 0.1 s; *order: of the last step
static double tail_after(const char *word, const char *step, const char *fish_text, int *order) {
    struct simulation *const simulation = school_simulation_of(
        "time: {end: 1, shedding_interval: 0.02}\nsolver: {method: %s, step: %s}\n%s", word, step, fish_text);
    school_run(simulation, 0.1);
    const struct integrator_counts counts = school_counts(simulation);
    *order = counts.order;
    const struct fish *fish = simulation->school->fish;
    const double tail = simulation->state->y[fish->at.y + fish->n_nodes - 1];
    return tail;
}

TEST(all_methods_agree_and_report_their_order) {
    int order;
    for (int i = 0; i < methods_n; i++) {
        const struct method_properties *method = &methods_table[i];
        const char *const text = i == METHOD_VERLET ? rod_alone : i == METHOD_IMEX ? with_momenta : soft;
        const double want = tail_after("ida", "0", text, &order);
        ABOVE(fabs(want), 1e-3);
        if (method->has_adaptive_steps) {
            NEAR(tail_after(method->word, "0", text, &order), want, 1e-4, 0);
            if (i != METHOD_IDA) assert_int_equal(order, method->order);
        }
        if (method->has_fixed_steps) {
            // first order: the step times the rate of the error, which is of the order of one
            NEAR(tail_after(method->word, "0.0005", text, &order), want, method->order == 1 ? 1e-2 : 1e-4, 0);
            assert_int_equal(order, method->order);
        }
    }
}

// from event to event, over restarts by impulses too
TEST(counts_of_a_run_only_grow) {
    static const char *const methods[] = {"ida", "dormand_prince", "trapezoid"};
    for (int i = 0; i < 3; i++) {
        struct simulation *const simulation = school_simulation_of(
            "time: {end: 1, shedding_interval: 0.02}\nwake: {shedding: impulsive}\nsolver: {method: %s, rtol: 1e-6%s}\n"
            "fish: [{nodes: 25, body: {modulus: 1e4}}]\n",
            methods[i], i < 2 ? "" : ", step: 0.002");
        struct integrator_counts before = {0};
        for (int n = 0; n < 20; n++) {
            school_ok(simulate_step(simulation));
            const struct integrator_counts now = school_counts(simulation);
            ABOVE(now.steps, before.steps);
            ABOVE(now.residual_evaluations, before.residual_evaluations);
            AT_LEAST(now.newton_iterations, before.newton_iterations);
            AT_LEAST(now.jacobian_evaluations, before.jacobian_evaluations);
            AT_LEAST(now.error_test_failures, before.error_test_failures);
            AT_LEAST(now.convergence_failures, before.convergence_failures);
            before = now;
        }
        if (i < 2) ABOVE(before.error_test_failures, 0);
    }
}
