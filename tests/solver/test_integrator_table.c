/* test_integrator_table.c: every row of the table of methods can be integrated. */
#include <stdio.h>

#include "school.h"
#include "solver/ida.h"
#include "solver/integrator_table.h"
#include "solver/one_step.h"
#include "solver/runge_kutta.h"
#include "solver/verlet.h"

/* For every method, and for those of a rod alone. */
static const char soft[] = "fish: [{body: {modulus: 1.0e+4}, wave: {ramp: 0}}]\n";
static const char rod_alone[] =
    "fluid: {density: 0}\nwake: {tolerance: 0}\n"
    "fish: [{body: {modulus: 1.0e+4, relaxation_time: 0, bending_damping: 0, "
    "stretching_damping: 0}, wave: {ramp: 0.1}}]\n";

static void methods_have_their_integrators(void **state) {
    (void)state;
    assert_ptr_equal(integrator_of(METHOD_IDA), &ida_integrator);
    assert_ptr_equal(integrator_of(METHOD_IMPLICIT_EULER), &one_step_integrator);
    assert_ptr_equal(integrator_of(METHOD_TRAPEZOID), &one_step_integrator);
    for (int i = 0; i < methods_n; i++) {
        if (methods_table[i].is_implicit) continue;
        const enum method method = (enum method)i;
        const struct integrator *const want = method == METHOD_VERLET ? &verlet_integrator : &runge_kutta_integrator;
        assert_ptr_equal(integrator_of(method), want);
    }
}

// y of the tail after 0.1 s; *order: of the last step
static double tail_after(const char *word, const char *step, const char *fish_text, int *order) {
    char text[512];
    snprintf(text, sizeof text, "time: {end: 1, shedding_interval: 0.02}\nsolver: {method: %s, step: %s}\n%s", word,
             step, fish_text);
    struct simulation *const simulation = school_simulation(text);
    school_run(simulation, 0.1);
    struct integrator_counts counts;
    simulation->integrator->count(simulation->solver, &counts);
    *order = counts.order;
    const struct fish *fish = simulation->school->fish;
    const double tail = simulation->state->y[fish->at.y + fish->n_nodes - 1];
    simulate_free(simulation);
    return tail;
}

static void all_methods_agree_and_report_their_order(void **state) {
    (void)state;
    int order;
    const double of_soft = tail_after("ida", "0", soft, &order), of_rod = tail_after("ida", "0", rod_alone, &order);
    assert_true(fabs(of_soft) > 1e-2);
    assert_true(fabs(of_rod) > 1e-3);
    for (int i = 0; i < methods_n; i++) {
        const struct method_properties *method = &methods_table[i];
        const char *const text = i == METHOD_VERLET ? rod_alone : soft;
        const double want = i == METHOD_VERLET ? of_rod : of_soft;
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

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(methods_have_their_integrators),
        cmocka_unit_test(all_methods_agree_and_report_their_order),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
