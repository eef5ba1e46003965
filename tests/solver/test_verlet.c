/* test_verlet.c: order, time reversal, energy, counts, failures of velocity Verlet on rods without fluid. */
#include <stdio.h>
#include <string.h>

#include "school.h"
#include "solver/verlet.h"

// a rod that a muscle bends for half a second and that vibrates from then on, and another one that swims beside it
#define TIMES "time: {end: 1, shedding_interval: 0.02}\nfluid: {density: 0}\nwake: {tolerance: 0}\n"
#define NO_DAMPING "relaxation_time: 0, bending_damping: 0, stretching_damping: 0"
#define RODS                                                                                                    \
    TIMES                                                                                                       \
    "fish:\n"                                                                                                   \
    "  - {nodes: 7, sheet_points: 13, wave: {frequency: 0, phase: 90, number: 0, ramp: 0.5, amplitude: 0.1},\n" \
    "     load: {tip: [0, 0.1]}, body: {modulus: 1.0e+5, " NO_DAMPING                                           \
    "}}\n"                                                                                                      \
    "  - {nodes: 9, sheet_points: 17, start: {position: [0, 1]}, body: {modulus: 1.0e+4, " NO_DAMPING "}}\n"

// a case and how it is solved
static struct simulation *open_with(const char *text, const char *solver) {
    char whole[2048];
    snprintf(whole, sizeof whole, "%ssolver: {%s}\n", text, solver);
    return school_simulation(whole);
}

// y of the tails of both rods at the end, and the largest of the energy balances over the energy put in
static void ends_of(const char *solver, double tail[2], double *imbalance) {
    struct simulation *const simulation = open_with(RODS, solver);
    school_run(simulation, 1);
    simulate_measure(simulation);
    *imbalance = 0;
    for (int f = 0; f < 2; f++) {
        const struct fish *const fish = &simulation->school->fish[f];
        const struct diagnostics_fish *const of = &simulation->diagnostics->fish[f];
        tail[f] = simulation->state->y[fish->at.y + fish->n_nodes - 1];
        *imbalance = fmax(*imbalance, fabs(of->energy_balance / of->actuation_work));
    }
    simulate_free(simulation);
}

static void steps_converge_with_the_square_of_their_length(void **state) {
    (void)state;
    double exact[2], coarse[2], fine[2], imbalance[3];
    ends_of("method: rk4, step: 0.001", exact, &imbalance[0]);
    ends_of("method: verlet, step: 0.001", coarse, &imbalance[1]);
    ends_of("method: verlet, step: 0.0005", fine, &imbalance[2]);
    for (int f = 0; f < 2; f++) {
        const double order = log2(fabs((coarse[f] - exact[f]) / (fine[f] - exact[f])));
        print_message("rod %d: errors %.2e %.2e, order %.2f\n", f, coarse[f] - exact[f], fine[f] - exact[f], order);
        NEAR(order, 2, 0.1, 0);
    }
    print_message("energy: %.1e %.1e\n", imbalance[1], imbalance[2]);
    NEAR(log2(imbalance[1] / imbalance[2]), 2, 0.3, 0);
}

static void steps_back_lead_to_the_start(void **state) {
    (void)state;
    // without a muscle and with the signs of all velocities changed the method goes back the way it came
    struct simulation *const simulation = open_with(
        TIMES "fish: [{nodes: 7, sheet_points: 13, wave: {amplitude: 0}, body: {modulus: 1.0e+5, " NO_DAMPING "}}]\n",
        "method: verlet, step: 0.001");
    const struct layout at = simulation->school->fish[0].at;
    double *const y = simulation->state->y, start[14];
    for (int k = 0; k < 14; k++) y[at.vx + k] = 0.1 * sin(k * k);
    memcpy(start, y + at.x, sizeof start);
    school_run(simulation, 0.2);
    assert_true(fabs(y[at.y + 3] - start[10]) > 1e-3);
    for (int k = 0; k < 14; k++) y[at.vx + k] = -y[at.vx + k];
    school_run(simulation, 0.4);
    for (int k = 0; k < 14; k++) NEAR(y[at.x + k], start[k], 1e-12, 0);
    simulate_free(simulation);
}

static void all_equations_hold_at_events(void **state) {
    (void)state;
    struct simulation *const simulation = open_with(RODS, "method: verlet, step: 0.001");
    school_run(simulation, 1);
    struct residual *const residual = simulation->residual;
    double value[256];
    assert_in_range(simulation->school->n_unknowns, 1, 256);
    school_ok(residual_evaluate(residual, 1, simulation->state->y, simulation->state->yp, value));
    // rounding of forces per mass of the order of 1e3 m s-2
    for (int i = 0; i < simulation->school->n_unknowns; i++) NEAR(value[i], 0, 1e-9, 0);
    struct integrator_counts counts;
    simulation->integrator->count(simulation->solver, &counts);
    assert_int_equal(counts.steps, 1000);
    assert_int_equal(counts.residual_evaluations, 1000);
    assert_int_equal(counts.order, 2);
    NEAR(counts.step_size, 0.001, 0, 0);
    simulate_free(simulation);
}

static void the_rate_of_the_circulation_is_its_change_over_the_interval(void **state) {
    (void)state;
    struct simulation *const simulation = open_with(RODS, "method: verlet, step: 0.001");
    school_run(simulation, 0.5);
    const double *const y = simulation->state->y, *const yp = simulation->state->yp;
    double before[2];
    for (int f = 0; f < 2; f++) before[f] = y[simulation->school->fish[f].at.circulation];
    school_ok(simulate_step(simulation));
    for (int f = 0; f < 2; f++) {
        const int shed = simulation->school->fish[f].at.circulation;
        NEAR(yp[shed], (y[shed] - before[f]) / 0.02, 1e-12, 1e-12);
        assert_true(fabs(yp[shed]) > 1e-4);
    }
    simulate_free(simulation);
}

static void fails(const char *solver, const char *message) {
    static const char stiff[] = TIMES "fish: [{nodes: 7, sheet_points: 13, body: {modulus: 1.0e+7, " NO_DAMPING "}}]\n";
    struct simulation *const simulation = open_with(stiff, solver);
    school_fails(simulation, message);
    simulate_free(simulation);
}

static void a_failure_tells_the_time(void **state) {
    (void)state;
    fails("method: verlet, step: 0.01", "unstable at t = ");
    fails("method: verlet, step: 0.001, max_steps: 10", "20 steps between two events are more than solver.max_steps");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(steps_converge_with_the_square_of_their_length),
        cmocka_unit_test(steps_back_lead_to_the_start),
        cmocka_unit_test(all_equations_hold_at_events),
        cmocka_unit_test(the_rate_of_the_circulation_is_its_change_over_the_interval),
        cmocka_unit_test(a_failure_tells_the_time),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
