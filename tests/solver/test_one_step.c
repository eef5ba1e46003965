/* test_one_step.c: The methods of fixed step have their orders, agree with IDA, and say when they fail. */

#include <stdio.h>
#include <string.h>

#include "school.h"
#include "solver/integrator.h"

// without the nascent stretch, which begins anew at every event, and without the kink of the drag
#define CONTINUOUS "time: {end: 0.4, shedding_interval: 0.02}\nwake: {shedding: continuous}\n"
#define FISH                                                                                                         \
    "fish: [{nodes: 7, sheet_points: 13, body: {modulus: 1.0e+4}, drag: {normal: 0, tangential: 0}, start: {speed: " \
    "1}}]\n"

// one fish; coupled fish; a prescribed head; circulation as a differential unknown; jumps
static const char *const cases[] = {
    CONTINUOUS FISH,
    CONTINUOUS
    "fluid: {velocity: [0.1, -0.05], shear: 0.2}\nfish:\n"
    "  - {nodes: 7, sheet_points: 13, control: {law: heading, desired_heading: 150}}\n"
    "  - {nodes: 9, length: 0.8, sheet_points: 11, start: {position: [0.2, 0.5]}}\n",
    CONTINUOUS
    "fluid: {velocity: [-1, 0]}\n"
    "fish: [{nodes: 8, sheet_points: 15, wave: {amplitude: 0}, start: {speed: 0},\n"
    "        motion: {prescribed: head, heave: 0.1, pitch: 10, frequency: 1, speed: 0}}]\n",
    CONTINUOUS "sheet: {kutta: rate}\n" FISH,
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
    return tail;
}

// with momenta: alone; coupled, under control
#define PRESSURE                                  \
    "time: {end: 0.4, shedding_interval: 0.02}\n" \
    "defaults: {fish: {start: {speed: 1}}}\n"
static const char *const with_pressure[] = {
    PRESSURE "fish: [{nodes: 7}]\n",
    PRESSURE
    "fluid: {gust: {amplitude: 0.01, frequency: 3}}\n"
    "fish:\n  - {nodes: 7, control: {law: heading, desired_heading: 150}}\n"
    "  - {nodes: 9, length: 0.8, start: {position: [0.2, 0.5]}}\n",
};

static double with_step(const char *text, const char *method, double step) {
    char solver[128];
    snprintf(solver, sizeof solver, "method: %s, step: %g, rtol: 1.0e-9", method, step);
    return tail_at_end(text, solver);
}

TEST(steps_converge_with_the_order_of_the_method) {
    static const char *const methods[] = {"implicit_euler", "trapezoid"};
    // the explicit reference solves the same equations to 1e-11
    const double exact = tail_at_end(cases[0], "method: dormand_prince, rtol: 1.0e-12");
    for (int order = 1; order <= 2; order++) {
        double error[2];
        for (int i = 0; i < 2; i++) error[i] = with_step(cases[0], methods[order - 1], 0.002 / (1 << i)) - exact;
        const double observed = log2(fabs(error[0] / error[1]));
        NEAR(observed, order, 0.1, 0);
    }
}

TEST(all_cases_agree_with_ida) {
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const double want = tail_at_end(cases[i], "rtol: 1.0e-9, order: 5");
        // second order: four times the steps, a sixteenth of the error
        const double coarse = with_step(cases[i], "trapezoid", 0.002) - want;
        const double fine = with_step(cases[i], "trapezoid", 0.0005) - want;
        NEAR(coarse, 0, 3e-5, 0);
        NEAR(fine, 0, fabs(coarse) / 8 + 2e-8, 0);
    }
}

// what the splitting adds to the error is of the same order, and less than half of it
TEST(a_splitting_adds_an_error_of_second_order) {
    for (size_t i = 0; i < sizeof with_pressure / sizeof *with_pressure; i++) {
        double error[2], splitting[2];
        const double want = tail_at_end(with_pressure[i], "rtol: 1.0e-9, order: 5");
        for (int k = 0; k < 2; k++) {
            const double imex = with_step(with_pressure[i], "imex", 0.001 / (1 << k));
            error[k] = imex - want;
            splitting[k] = imex - with_step(with_pressure[i], "trapezoid", 0.001 / (1 << k));
        }
        NEAR(log2(fabs(error[0] / error[1])), 2, 0.25, 0);
        NEAR(log2(fabs(splitting[0] / splitting[1])), 2, 0.25, 0);
        BELOW(fabs(splitting[0]), 0.5 * fabs(error[0]));
    }
}

#define STIFF "body: {modulus: 1.0e+9}}]\n"

TEST(a_very_stiff_body_needs_no_shorter_steps) {
    static const char reactive[] = CONTINUOUS "fish: [{nodes: 7, sheet_points: 13, " STIFF;
    static const char pressure[] = PRESSURE "fish: [{nodes: 7, " STIFF;
    const double exact = tail_at_end(reactive, "rtol: 1.0e-9, order: 5");
    // a quarter of the shedding interval; an explicit method needs thousands of steps per interval
    NEAR(tail_at_end(reactive, "method: trapezoid, step: 0.005"), exact, 1e-5, 0);
    NEAR(tail_at_end(reactive, "method: implicit_euler, step: 0.005"), exact, 2e-3, 0);
    NEAR(tail_at_end(pressure, "method: imex, step: 0.005"), tail_at_end(pressure, "rtol: 1.0e-9, order: 5"), 1e-4, 0);
}

TEST(soft_rods_of_many_nodes_converge_whatever_the_step) {
    // a base that heaves, in no fluid: pivots a thousandth of the largest would lose the digits that Newton's iteration
    // needs, the more so the smaller the step
    static const int nodes[] = {31, 41, 51};
    static const double steps[] = {0.003125, 0.0015625, 0.00078125};
    for (int i = 0; i < 9; i++) {
        struct simulation *const simulation = school_simulation_of(
            "time: {end: 1, shedding_interval: 0.0125, output_interval: 0.0125}\nfluid: {density: 0}\n"
            "solver: {method: trapezoid, step: %.8f}\n"
            "fish: [{nodes: %d, force: reactive, sheet_points: 5, body: {modulus: 1.0e+5}, wave: {amplitude: 0},\n"
            "        start: {speed: 0}, motion: {prescribed: head, heave: 0.05, frequency: 1, speed: 0}}]\n",
            steps[i % 3], nodes[i / 3]);
        school_run(simulation, 0.1);
    }
}

TEST(a_jacobian_is_kept_for_many_steps) {
    struct simulation *const simulation =
        school_simulation(CONTINUOUS FISH "solver: {method: trapezoid, step: 0.005}\n");
    school_run(simulation, 0.4);
    const struct integrator_counts counts = school_counts(simulation);
    assert_int_equal(counts.steps, 80);
    assert_int_equal(counts.order, 2);
    NEAR(counts.step_size, 0.005, 0, 0);
    // two in each step: the rate of convergence shows that the second correction is the last
    assert_int_equal(counts.newton_iterations, 160);
    assert_int_equal(counts.residual_evaluations, counts.newton_iterations);
    assert_in_range(counts.jacobian_evaluations, 1, 20);
}

TEST(the_rate_of_the_shed_circulation_is_a_difference_of_events) {
    static const char *const methods[] = {"implicit_euler", "trapezoid"};
    for (int i = 0; i < 2; i++) {
        struct simulation *const simulation = school_simulation_of(
            "time: {end: 1, shedding_interval: 0.005}\nsolver: {method: %s, step: 0.005}\n"
            "fish: [{nodes: 7, wave: {ramp: 0}, control: {law: heading, desired_heading: 150}}]\n",
            methods[i]);
        school_shed_event_by_event(simulation);
    }
}

TEST(a_splitting_does_not_extrapolate_across_a_jump) {
    // at a waypoint the steering bias jumps: what the integrator forgets there it cannot know when it is new there
    struct simulation *simulation[2];
    for (int i = 0; i < 2; i++) {
        simulation[i] = school_simulation(
            PRESSURE
            "solver: {method: imex, step: 0.005, rtol: 1.0e-9}\n"
            "fish: [{nodes: 7, start: {speed: 1}, control: {law: heading, waypoints: [[-1, 0], [-1, 1]], "
            "acceptance_radius: 0.97}}]\n");
    }
    const struct state *const one = simulation[0]->state, *const other = simulation[1]->state;
    int n_after = 0;
    while (n_after < 3 && one->event < 20) {
        const int before = one->control[0].waypoint;
        for (int i = 0; i < 2; i++) school_ok(simulate_step(simulation[i]));
        if (one->control[0].waypoint != before) school_ok(simulate_renew(simulation[1]));
        n_after += one->control[0].waypoint > 0;
        assert_memory_equal(one->y, other->y, (size_t)simulation[0]->school->n_unknowns * sizeof *one->y);
    }
    assert_int_equal(n_after, 3);
}

static void fails(const char *text, const char *message) {
    struct simulation *const simulation = school_simulation(text);
    school_fails(simulation, message);
}

// one evaluation throws the nodes far away, from where Newton's iteration does not return, and the next one fails
static int n_until_lost = -1;
__typeof__(residual_evaluate) __real_residual_evaluate, __wrap_residual_evaluate;
enum status __wrap_residual_evaluate(struct residual *residual, const struct residual_mode *mode, double t,
                                     const double *y, const double *yp, double *value) {
    TRY(__real_residual_evaluate(residual, mode, t, y, yp, value));
    const bool is_lost = n_until_lost-- == 0;
    if (n_until_lost == 0) {
        for (int i = 0; i < residual->school->n_unknowns; i++) value[i] = 1e13 * sin(i);
    }
    return is_lost ? STATUS_RETRY : STATUS_OK;
}

TEST(a_second_attempt_starts_where_the_step_starts) {
    const double want = tail_at_end(cases[0], "method: trapezoid, step: 0.002");
    // two evaluations in a step, and one at an event
    for (int i = 0; i < 3; i++) {
        n_until_lost = 101 + i;
        NEAR(tail_at_end(cases[0], "method: trapezoid, step: 0.002"), want, 1e-7, 0);
        BELOW(n_until_lost, 0);
    }
}

TEST(a_failure_tells_the_time) {
    // half a beat in one step
    fails(
        "time: {end: 50, shedding_interval: 0.5}\nsolver: {method: implicit_euler, step: 0.5}\n"
        "fish: [{nodes: 7, body: {modulus: 1.0e+9}}]\n",
        "integration failed at t = ");
    fails(
        "time: {end: 1, shedding_interval: 0.02}\nsolver: {method: trapezoid, step: 0.001, max_steps: 10}\n"
        "fish: [{nodes: 7}]\n",
        "limited by solver.max_steps at t = 0 s: more than 10 steps from one event to the next");
}

// ---- order, time reversal, energy, counts, failures of velocity Verlet on rods without fluid

// a rod that a muscle bends for half a second and that vibrates from then on, and another one that swims beside it
// no nascent stretch, which begins anew at an event
#define TIMES \
    "time: {end: 1, shedding_interval: 0.02}\nfluid: {density: 0}\nwake: {tolerance: 0, shedding: continuous}\n"
#define NO_DAMPING "relaxation_time: 0, bending_damping: 0, stretching_damping: 0"
#define RODS                                                                                  \
    TIMES                                                                                     \
    "fish:\n"                                                                                 \
    "  - {nodes: 7, wave: {frequency: 0, phase: 90, number: 0, ramp: 0.5, amplitude: 0.1},\n" \
    "     load: {tip: [0, 0.1]}, body: {modulus: 1.0e+5, " NO_DAMPING                         \
    "}}\n"                                                                                    \
    "  - {nodes: 9, start: {position: [0, 1]}, body: {modulus: 1.0e+4, " NO_DAMPING "}}\n"

// a case and how it is solved
static struct simulation *open_with(const char *text, const char *solver) {
    char whole[2048];
    snprintf(whole, sizeof whole, "%ssolver: {%s}\n", text, solver);
    return school_simulation(whole);
}

// y of the tails of both rods at the end, and the largest of the energy balances over the energy put in
static void ends_of(const char *solver, double tail[2], double *imbalance) {
    struct simulation *const simulation = open_with(RODS, solver);
    school_measure(simulation, 1);
    *imbalance = 0;
    for (int f = 0; f < 2; f++) {
        const struct fish *const fish = &simulation->school->fish[f];
        const struct diagnostics_fish *const of = &simulation->diagnostics->fish[f];
        tail[f] = simulation->state->y[fish->at.y + fish->n_nodes - 1];
        *imbalance = fmax(*imbalance, fabs(of->energy_balance / of->actuation_work));
    }
}

TEST(steps_converge_with_the_square_of_their_length) {
    double exact[2], coarse[2], fine[2], imbalance[3];
    ends_of("method: rk4, step: 0.001", exact, &imbalance[0]);
    ends_of("method: verlet, step: 0.001", coarse, &imbalance[1]);
    ends_of("method: verlet, step: 0.0005", fine, &imbalance[2]);
    for (int f = 0; f < 2; f++) {
        const double order = log2(fabs((coarse[f] - exact[f]) / (fine[f] - exact[f])));
        NEAR(order, 2, 0.1, 0);
    }
    NEAR(log2(imbalance[1] / imbalance[2]), 2, 0.3, 0);
}

// a nascent stretch begins anew at every event, which finds the velocities of a default fish from its momenta
TEST(verlet_keeps_the_velocities_at_events) {
    static const char text[] =
        "time: {end: 0.4, shedding_interval: 0.02}\nfluid: {density: 0}\nsheet: {kutta: edge}\n"
        "fish: [{nodes: 7, body: {modulus: 1.0e+5, " NO_DAMPING "}}]\n";
    double tail[2];
    for (int i = 0; i < 2; i++) {
        struct simulation *const simulation =
            open_with(text, i ? "method: verlet, step: 1.0e-4" : "method: rk4, step: 5.0e-4");
        school_measure(simulation, 0.4);
        const struct fish *const fish = &simulation->school->fish[0];
        tail[i] = simulation->state->y[fish->at.y + fish->n_nodes - 1];
    }
    BELOW(1e-3, fabs(tail[0]));
    // the error of verlet falls with the square of the step
    NEAR(tail[1], tail[0], 1e-6, 0);
}

TEST(steps_back_lead_to_the_start) {
    // without a muscle and with the signs of all velocities changed the method goes back the way it came
    struct simulation *const simulation =
        open_with(TIMES "fish: [{nodes: 7, wave: {amplitude: 0}, body: {modulus: 1.0e+5, " NO_DAMPING "}}]\n",
                  "method: verlet, step: 0.001");
    const struct layout at = simulation->school->fish[0].at;
    double *const y = simulation->state->y, start[14];
    for (int k = 0; k < 14; k++) y[at.vx + k] = 0.1 * sin(k * k);
    memcpy(start, y + at.x, sizeof start);
    school_run(simulation, 0.2);
    ABOVE(fabs(y[at.y + 3] - start[10]), 1e-3);
    for (int k = 0; k < 14; k++) y[at.vx + k] = -y[at.vx + k];
    school_run(simulation, 0.4);
    for (int k = 0; k < 14; k++) NEAR(y[at.x + k], start[k], 1e-12, 0);
}

TEST(all_equations_hold_at_events) {
    struct simulation *const simulation = open_with(RODS, "method: verlet, step: 0.001");
    school_run(simulation, 1);
    struct residual *const residual = simulation->residual;
    double value[256];
    assert_in_range(simulation->school->n_unknowns, 1, 256);
    school_ok(residual_evaluate(residual, &residual_run, 1, simulation->state->y, simulation->state->yp, value));
    // rounding of forces per mass of the order of 1e3 m s-2
    for (int i = 0; i < simulation->school->n_unknowns; i++) NEAR(value[i], 0, 1e-9, 0);
    const struct integrator_counts counts = school_counts(simulation);
    assert_int_equal(counts.steps, 1000);
    assert_int_equal(counts.residual_evaluations, 1000);
    assert_int_equal(counts.order, 2);
    NEAR(counts.step_size, 0.001, 0, 0);
}

TEST(verlet_has_the_rate_of_the_circulation_over_events) {
    struct simulation *const simulation =
        open_with(TIMES "fish: [{nodes: 7, start: {speed: 1}, body: {modulus: 1.0e+4, " NO_DAMPING "}}]\n",
                  "method: verlet, step: 0.001");
    school_shed_event_by_event(simulation);
}

static void verlet_fails(const char *solver, const char *message) {
    static const char stiff[] = TIMES "fish: [{nodes: 7, body: {modulus: 1.0e+7, " NO_DAMPING "}}]\n";
    struct simulation *const simulation = open_with(stiff, solver);
    school_fails(simulation, message);
}

TEST(a_failure_of_verlet_tells_the_time) {
    verlet_fails("method: verlet, step: 0.01", "unstable at t = ");
    verlet_fails("method: verlet, step: 0.001, max_steps: 10",
                 "limited by solver.max_steps at t = 0 s: more than 10 steps from one event to the next");
}
