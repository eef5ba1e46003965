/* test_runge_kutta.c: The explicit methods have their orders, agree with IDA, restart after a jump, and say when they
 * fail. */
#include <stdio.h>
#include <string.h>

#include "school.h"
#include "solver/integrator.h"
#include "solver/ode_rhs.h"

// without the nascent stretch, which begins anew at every event, and without drag: v|v| has a kink in its derivative,
// at which no method keeps an order above three
static const char soft[] =
    "time: {end: 0.4, shedding_interval: 0.02}\nwake: {shedding: continuous}\nsolver: {method: %s, step: %.9g, rtol: "
    "%.3g, order: 5}\n"
    "fish: [{nodes: 7, sheet_points: 13, body: {modulus: 1.0e+4},\n        drag: {normal: 0, tangential: 0}}]\n";

// y of the tail at the end
static double tail_at_end(const char *method, double step, double rtol) {
    struct simulation *const simulation = school_simulation_of(soft, method, step, rtol);
    school_run(simulation, 0.4);
    const struct fish *fish = &simulation->school->fish[0];
    const double tail = simulation->state->y[fish->at.y + fish->n_nodes - 1];
    return tail;
}

TEST(fixed_steps_converge_with_the_order_of_the_method) {
    const double exact = tail_at_end("dormand_prince", 0, 1e-12);
    // steps small enough to be stable and in the asymptotic range, large enough to stay above round-off
    static const struct {
        const char *name;
        double step, order;
    } methods[] = {{"euler", 0.00025, 1}, {"heun", 0.0005, 2}, {"rk4", 0.005, 4}, {"dormand_prince", 0.01, 5}};
    for (size_t i = 0; i < sizeof methods / sizeof *methods; i++) {
        const double coarse = tail_at_end(methods[i].name, methods[i].step, 1e-5) - exact;
        const double fine = tail_at_end(methods[i].name, methods[i].step / 2, 1e-5) - exact;
        const double order = log2(fabs(coarse / fine));
        NEAR(order, methods[i].order, 0.3, 0);
    }
}

// every method is exact where all rates are constant; a solution that lags behind its time would show
TEST(one_evaluation_serves_the_end_of_a_step_and_the_start_of_the_next) {
    static const struct {
        const char *method;
        int stages;
    } methods[] = {{"euler", 1}, {"heun", 2}, {"rk4", 4}};
    for (size_t i = 0; i < sizeof methods / sizeof *methods; i++) {
        struct simulation *const simulation = school_simulation_of(soft, methods[i].method, 1e-3, 1e-6);
        school_run(simulation, 0.4);
        // at each of the 20 events the wake gets a new vortex, so that the evaluation is done again
        const struct integrator_counts *const counts = &simulation->totals;
        assert_int_equal(counts->steps, 400);
        assert_in_range(counts->residual_evaluations, 400 * methods[i].stages + 19, 400 * methods[i].stages + 25);
    }
}

TEST(a_body_without_forces_coasts_as_far_as_its_speed_says) {
    static const char *const methods[] = {"euler", "heun", "rk4", "dormand_prince"};
    for (size_t i = 0; i < 2 * sizeof methods / sizeof *methods; i++) {
        struct simulation *const simulation = school_simulation_of(
            "time: {end: 0.4, shedding_interval: 0.02}\nfluid: {density: 0}\n"
            "solver: {method: %s, step: %s, rtol: 1.0e-6}\n"
            "fish: [{nodes: 7, sheet_points: 5, force: reactive, start: {speed: 0.5}, wave: {amplitude: 0}}]\n",
            methods[i / 2], i % 2 ? "0" : "0.0002");
        const double before = simulation->state->y[simulation->school->fish[0].at.x];
        school_run(simulation, 0.4);
        // rounding of 2000 steps; with steps of its own choice a method lets the stiff body tremble within rtol
        NEAR(fabs(simulation->state->y[simulation->school->fish[0].at.x] - before), 0.2, i % 2 ? 1e-6 : 1e-12, 0);
    }
}

TEST(explicit_and_implicit_solutions_agree) {
    // both within some hundred of their tolerances per second
    NEAR(tail_at_end("dormand_prince", 0, 1e-10), tail_at_end("ida", 0, 1e-10), 1e-7, 0);
    NEAR(tail_at_end("rk4", 0, 1e-10), tail_at_end("ida", 0, 1e-10), 1e-7, 0);
    NEAR(tail_at_end("heun", 0, 1e-8), tail_at_end("ida", 0, 1e-10), 1e-5, 0);
    NEAR(tail_at_end("euler", 0, 1e-6), tail_at_end("ida", 0, 1e-10), 1e-2, 0);
}

TEST(an_unstable_step_ends_with_a_message_that_tells_the_time) {
    struct simulation *const simulation = school_simulation(
        "time: {end: 1, shedding_interval: 0.02}\nsolver: {method: rk4, step: 0.02}\n"
        "fish: [{nodes: 7, body: {modulus: 1.0e+9}}]\n");
    school_fails(simulation, "unstable at t = ");
    assert_non_null(strstr(status_message(), "solver.method: ida"));
    // which one, and where
    assert_non_null(strstr(status_message(), "the largest velocity is v"));
    assert_non_null(strstr(status_message(), "] of fish fish1;"));
    assert_non_null(strstr(status_message(), "or a smaller solver.step"));
}

TEST(a_body_too_stiff_for_the_first_step_has_no_last_step) {
    struct simulation *const simulation = school_simulation(
        "time: {end: 1, shedding_interval: 0.02}\nsolver: {method: dormand_prince}\n"
        "fish: [{nodes: 9, body: {modulus: 1.0e+20}}]\n");
    school_fails(simulation, "even in the first step the body is too stiff for an explicit method");
    assert_null(strstr(status_message(), "solver.step"));
}

// twenty steps between two events
TEST(no_more_than_the_largest_number_of_steps_are_made) {
    for (int most = 19; most <= 20; most++) {
        struct simulation *const simulation = school_simulation_of(
            "time: {end: 1, shedding_interval: 0.02}\nsolver: {method: rk4, step: 0.001, "
            "max_steps: %d}\nfish: [{nodes: 7, body: {modulus: 1e4}}]\n",
            most);
        assert_int_equal(simulate_step(simulation), most == 20 ? STATUS_OK : STATUS_SOLVER);
    }
}

TEST(a_torn_body_is_no_result) {
    // in no fluid too long a step tears the body apart, and every number stays finite
    struct simulation *const simulation = school_simulation(
        "time: {end: 1, shedding_interval: 0.02}\nfluid: {density: 0}\nsolver: {method: rk4, step: 0.01}\n"
        "fish: [{nodes: 7, body: {modulus: 1.0e+7, bending_damping: 0,\n"
        "        stretching_damping: 0}}]\n");
    school_fails(simulation, "unstable at t = ");
}

TEST(impulses_restart_the_explicit_method_too) {
    double tail[2];
    for (int i = 0; i < 2; i++) {
        struct simulation *const simulation = school_simulation_of(
            "time: {end: 0.4, shedding_interval: 0.02}\nwake: {shedding: impulsive}\n"
            "solver: {method: %s, rtol: 1.0e-9, order: 5}\n"
            "fish: [{nodes: 7, sheet_points: 13, body: {modulus: 1.0e+4}}]\n",
            i == 0 ? "ida" : "dormand_prince");
        school_run(simulation, 0.4);
        const struct fish *fish = &simulation->school->fish[0];
        tail[i] = simulation->state->y[fish->at.y + fish->n_nodes - 1];
    }
    NEAR(tail[0], tail[1], 1e-6, 0);
}

// an evaluation that fails from some time on, and does not say why
static double silent_from = INFINITY;
enum status __real_ode_rhs_rates(struct ode_rhs *rhs, double t, double *y, double *yp);
enum status __wrap_ode_rhs_rates(struct ode_rhs *rhs, double t, double *y, double *yp);
enum status __wrap_ode_rhs_rates(struct ode_rhs *rhs, double t, double *y, double *yp) {
    return t > silent_from ? STATUS_RETRY : __real_ode_rhs_rates(rhs, t, y, yp);
}

TEST(a_failure_without_a_reason_is_not_explained_by_an_old_message) {
    static const char *const old[] = {"", "a message of something else"};
    for (int i = 0; i < 2; i++) {
        struct simulation *const simulation = school_simulation_of(soft, "rk4", 0.005, 1e-5);
        school_run(simulation, 0.04);
        status_fail(STATUS_FILE, "%s", old[i]);
        silent_from = 0.05;
        assert_int_equal(simulate_step(simulation), STATUS_SOLVER);
        silent_from = INFINITY;
        if (!strstr(status_message(), " s: the equations have no finite value; ")) fail_msg("%s", status_message());
    }
}

TEST(the_rate_of_the_shed_circulation_is_a_difference_of_events) {
    struct simulation *const simulation = school_simulation(
        "time: {end: 1, shedding_interval: 0.005}\nsolver: {method: rk4, step: 0.005}\n"
        "fish: [{nodes: 7, body: {modulus: 1.0e+4}, wave: {ramp: 0},\n"
        "        control: {law: heading, desired_heading: 150}}]\n");
    school_shed_event_by_event(simulation);
}
