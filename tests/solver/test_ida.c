/* test_ida.c: Tests the steps of IDA: how they divide an interval, how they restart after a jump, and how they fail. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fish/fish_motion.h"
#include "school.h"
#include "solver/integrator.h"

#define TIME "time: {end: 1, shedding_interval: 0.02, output_interval: 0.02}\n"
#define SMALL TIME "defaults: {fish: {nodes: 7}}\n"

static struct integrator_counts counts_of(const struct simulation *simulation) {
    const struct integrator_counts counts = school_counts(simulation);
    return counts;
}

TEST(a_body_with_prescribed_nodes_follows_the_given_motion) {
    const char *const texts[] = {
        SMALL
        "fish: [{motion: {prescribed: head, heave: 0.1, pitch: 10, pitch_phase: 70, frequency: 1, pivot: 0.2}}]\n",
        SMALL "fish: [{motion: {prescribed: all, heave: 0.1, pitch: 10, frequency: 1}}]\n"};
    for (int i = 0; i < 2; i++) {
        struct simulation *const simulation = school_simulation(texts[i]);
        const struct fish *fish = simulation->school->fish;
        const double *const y = simulation->state->y;
        while (simulation->state->t < 0.5) {
            school_ok(simulate_step(simulation));
            for (int k = 0; k < fish_n_prescribed(fish); k++) {
                double x[2], v[2], a[2];
                fish_prescribed_node(fish, NULL, k, simulation->state->t, x, v, a);
                const double got[6] = {y[fish->at.x + k],  y[fish->at.y + k],  y[fish->at.vx + k],
                                       y[fish->at.vy + k], y[fish->at.ax + k], y[fish->at.ay + k]};
                const double want[6] = {x[0], x[1], v[0], v[1], a[0], a[1]};
                // linear equations: Newton's iteration ends far below the tolerance of 1e-5 with which it began
                NEAR_ARRAY(6, got, want, 1e-6, 1e-6);
            }
        }
    }
}

TEST(continuous_events_cost_no_restart) {
    // a restart begins at order 1 and with a new Jacobian: at continuous events the order stays
    struct simulation *simulation = school_simulation("time: {end: 1, shedding_interval: 0.01}\nfish: [{nodes: 7}]\n");
    school_run(simulation, 0.5);
    const int order = counts_of(simulation).order;
    ABOVE(order, 1);
    for (int n = 0; n < 50; n++) {
        school_ok(simulate_step(simulation));
        assert_int_equal(counts_of(simulation).order, order);
    }
    const struct integrator_counts continuous = counts_of(simulation);
    AT_MOST((double)continuous.steps / 100, 5);
    simulation =
        school_simulation("time: {end: 1, shedding_interval: 0.01}\nwake: {shedding: impulsive}\nfish: [{nodes: 7}]\n");
    school_run(simulation, 1);
    const struct integrator_counts impulsive = counts_of(simulation);
    ABOVE(impulsive.steps, continuous.steps);
    // every event evaluates the Jacobian again
    AT_LEAST(impulsive.jacobian_evaluations, 100);
}

TEST(the_totals_of_the_solver_fit_together) {
    // alone, and with a neighbour, which GMRES couples
    const char *const texts[] = {
        "time: {end: 1, shedding_interval: 0.02}\nfish: [{nodes: 7, start: {speed: 1}}]\n",
        "time: {end: 1, shedding_interval: 0.02}\ndefaults: {fish: {nodes: 7, start: {speed: 1}}}\nfish: [{}, "
        "{start: {position: [0, 0.3]}}]\n"};
    for (int i = 0; i < 2; i++) {
        struct simulation *const simulation = school_simulation(texts[i]);
        const int n_fish = simulation->school->n_fish;
        school_run(simulation, 0.4);
        const struct integrator_counts counts = counts_of(simulation);
        long steps = 0;
        for (int order = 1; order <= METHODS_MAX_ORDER; order++) {
            const long n = counts.steps_of_order[order - 1];
            if (order > simulation->options.order) assert_int_equal(n, 0);
            steps += n;
        }
        assert_int_equal(steps, counts.steps);

        // one pattern of each fish; every Jacobian is factorised once, fish by fish
        assert_int_equal(counts.klu_analyses, n_fish);
        assert_int_equal(counts.klu_factorisations + counts.klu_refactorisations, n_fish * counts.jacobian_evaluations);
        if (n_fish == 1) assert_int_equal(counts.gmres_iterations, 0);
        if (n_fish > 1) AT_LEAST(counts.gmres_iterations, counts.newton_iterations);

        // the start is one solution of KINSOL, which lasts
        AT_LEAST(counts.initial_iterations, 1);
        const double n = simulation->school->n_unknowns;
        assert_in_range(counts.jacobian_non_zeros, n, n * n);
        assert_in_range(counts.factor_non_zeros, n, n * n);
        school_ok(simulate_renew(simulation));
        const struct integrator_counts renewed = counts_of(simulation);
        assert_memory_equal(&renewed, &counts, offsetof(struct integrator_counts, step_size));
    }
}

TEST(errors_of_all_unknowns_make_smaller_steps) {
    double steps[2];
    for (int i = 0; i < 2; i++) {
        struct simulation *const simulation = school_simulation_of(
            "time: {end: 2, shedding_interval: 0.02}\nsolver: {error_test: %s}\nfish: [{body: {modulus: 1e9}}]\n",
            i == 0 ? "positions" : "all");
        school_run(simulation, 2);
        steps[i] = (double)counts_of(simulation).steps;
    }
    // about four times as many: doc/numerics.md, section 3
    AT_LEAST(steps[1], 2 * steps[0]);
}

TEST(klu_makes_the_same_run_as_the_blocks) {
    static const char text[] =
        "time: {end: 1, shedding_interval: 0.02}\nsolver: {linear: %s}\ndefaults: {fish: {nodes: 7, start: {speed: "
        "0.8}}}\n"
        "fish: [{}, {start: {position: [0, 0.3]}}, {start: {position: [0.4, -0.25]}, force: reactive}]\n";
    struct simulation *const blocks = school_simulation_of(text, "blocks");
    struct simulation *const klu = school_simulation_of(text, "klu");
    for (int n = 0; n < 20; n++) {
        school_ok(simulate_step(blocks));
        school_ok(simulate_step(klu));
    }
    // the linear systems differ in rounding and in the tolerance of GMRES, a tenth of that of Newton's iteration
    for (int i = 0; i < blocks->school->n_unknowns; i++) {
        const double tolerance = blocks->options.rtol * residual_scale(blocks->school, i);
        NEAR(klu->state->y[i], blocks->state->y[i], 0.1 * tolerance, 0);
    }
    const struct integrator_counts counts[] = {counts_of(blocks), counts_of(klu)};
    assert_int_equal(counts[1].steps, counts[0].steps);
    ABOVE(counts[0].gmres_iterations, 0);
    assert_int_equal(counts[1].gmres_iterations, 0);
    assert_int_equal(counts[1].klu_analyses, 1);
}

TEST(steps_divide_the_interval_and_keep_the_jacobian) {
    struct simulation *const simulation =
        school_simulation("time: {end: 1, shedding_interval: 0.01}\nfish: [{nodes: 7}]\n");
    school_run(simulation, 0.5);
    struct integrator_counts before = counts_of(simulation);
    int n_equal = 0;
    for (int n = 0; n < 50; n++) {
        school_ok(simulate_step(simulation));
        const struct integrator_counts now = counts_of(simulation);
        const double interval = (double)(now.steps - before.steps) * now.step_size;
        // rounding of times of the order of one
        n_equal += fabs(interval - 0.01) < 1e-13;
        before = now;
    }
    // except where IDA itself changed the step
    assert_in_range(n_equal, 40, 50);
    BELOW(before.jacobian_evaluations, 50);
}

TEST(a_very_stiff_body_keeps_its_course) {
    // the error of Newton's iteration in the equations of motion must have no moment: an angular acceleration of 5e-4
    // rad/s2 would move the tail by a thousandth of a length
    double tail[2][2];
    for (int i = 0; i < 2; i++) {
        struct simulation *const simulation =
            school_simulation(i == 0 ? SMALL "fish: [{body: {modulus: 1.0e+10}}]\n"
                                     : SMALL "solver: {rtol: 1.0e-8}\nfish: [{body: {modulus: 1.0e+10}}]\n");
        school_run(simulation, 2);
        const struct fish *fish = simulation->school->fish;
        tail[i][0] = simulation->state->y[fish->at.x + fish->n_nodes - 1];
        tail[i][1] = simulation->state->y[fish->at.y + fish->n_nodes - 1];
    }
    // a few times the default tolerance
    NEAR(tail[0][0], tail[1][0], 5e-5, 0);
    NEAR(tail[0][1], tail[1][1], 5e-5, 0);
}

TEST(counts_go_on_across_restarts) {
    struct simulation *const simulation = school_simulation(SMALL "wake: {shedding: impulsive}\nfish: [{}]\n");
    struct integrator_counts before = counts_of(simulation);
    for (int n = 0; n < 20; n++) {
        school_ok(simulate_step(simulation));
        const struct integrator_counts now = counts_of(simulation);
        ABOVE(now.steps, before.steps);
        ABOVE(now.residual_evaluations, before.residual_evaluations);
        ABOVE(now.newton_iterations, before.newton_iterations);
        ABOVE(now.jacobian_evaluations, before.jacobian_evaluations);
        // no more of them than iterations
        AT_MOST(now.jacobian_evaluations, now.newton_iterations);
        before = now;
    }
}

// the rates of algebraic unknowns are differences of the steps since; no count is lost, nor those of failures
TEST(a_restart_begins_like_a_new_solver) {
    struct simulation *run[2];
    for (int i = 0; i < 2; i++) {
        run[i] = school_simulation(TIME
                                   "solver: {rtol: 1e-2}\nfish: [{nodes: 9, sheet_points: 27, body: {modulus: 1e8}, "
                                   "motion: {prescribed: head, heave: 0.1, frequency: 1}, "
                                   "wave: {amplitude: 1, ramp: 0.02}}]\n");
        school_run(run[i], 0.2);
    }
    const struct integrator_counts before = counts_of(run[0]);
    ABOVE(before.error_test_failures, 0);
    ABOVE(before.convergence_failures, 0);
    ABOVE(before.convergence_failures, before.error_test_failures);  // stiff at a large tolerance
    school_ok(run[0]->integrator->restart(run[0]->solver));
    const struct integrator_counts after = counts_of(run[0]);
    assert_memory_equal(&after, &before, offsetof(struct integrator_counts, step_size));
    school_ok(simulate_renew(run[1]));
    for (int i = 0; i < 2; i++) school_ok(simulate_step(run[i]));
    // the iteration that makes a new solver consistent changes the rounding
    NEAR_ARRAY(run[0]->school->n_unknowns, run[0]->state->yp, run[1]->state->yp, 1e-9, 1e-9);
    NEAR_ARRAY(N_WORKS, run[0]->state->balance->work, run[1]->state->balance->work, 1e-9, 1e-9);
}

TEST(a_restart_without_a_jump_does_not_change_the_path) {
    double tail[2];
    for (int i = 0; i < 2; i++) {
        struct simulation *const simulation =
            school_simulation(SMALL "solver: {rtol: 1.0e-8}\nfish: [{body: {modulus: 1.0e+5}}]\n");
        school_run(simulation, 0.4);
        if (i == 1) school_ok(simulation->integrator->restart(simulation->solver));
        school_run(simulation, 0.6);
        const struct fish *fish = simulation->school->fish;
        tail[i] = simulation->state->y[fish->at.y + fish->n_nodes - 1];
    }
    // the error of a few hundred steps at 1e-8
    NEAR(tail[1], tail[0], 1e-6, 0);
    ABOVE(fabs(tail[0]), 1e-3);
}

TEST(too_many_steps_end_with_time_and_remedy) {
    struct simulation *const simulation = school_simulation(SMALL "solver: {max_steps: 1}\nfish: [{}]\n");
    enum status status = STATUS_OK;
    while (status == STATUS_OK && simulation->state->t < 1) status = simulate_step(simulation);
    assert_int_equal(status, STATUS_SOLVER);
    assert_non_null(strstr(status_message(), "solver.max_steps"));
    assert_non_null(strstr(status_message(), "t = "));
}

TEST(equations_without_a_finite_value_end_with_time_fish_and_reason) {
    struct simulation *const simulation = school_simulation(SMALL "fish: [{name: nemo}]\n");
    school_run(simulation, 0.1);
    // no smaller step can mend this
    simulation->school->fish[0].drag_normal[2] = NAN;
    assert_int_equal(simulate_step(simulation), STATUS_SOLVER);
    assert_non_null(strstr(status_message(), "t = 0.1"));
    assert_non_null(strstr(status_message(), "nemo"));
    // the cause, not what IDA says about it
    assert_non_null(strstr(status_message(), "of fish nemo has no finite value at t = 0.1"));
}

TEST(a_jacobian_that_is_singular_ends_with_a_remedy) {
    struct simulation *const simulation =
        school_simulation(SMALL "wake: {shedding: continuous}\nsheet: {kutta: rate}\nfish: [{name: nemo}]\n");
    // Kelvin's theorem without circulations
    struct fish *const fish = simulation->school->fish;
    for (int j = 0; j < fish->n_sheet; j++) fish->sheet_weight[j] = 0;
    simulation->school->kutta = KUTTA_RATE;
    assert_int_equal(simulate_step(simulation), STATUS_SOLVER);
    assert_non_null(strstr(status_message(), "the Jacobian is singular: check the units of the body"));
}

TEST(an_edge_that_is_pressed_to_nothing_is_named) {
    // far more than E A of the last edge
    struct simulation *const simulation =
        school_simulation(TIME
                          "fluid: {density: 0}\nfish: [{name: nemo, nodes: 7, wave: {amplitude: 0}, body: {modulus: "
                          "100}, load: {tip: [-50, 0]}}]\n");
    enum status status = STATUS_OK;
    for (int i = 0; i < 50 && status == STATUS_OK; i++) status = simulate_step(simulation);
    assert_int_equal(status, STATUS_SOLVER);
    assert_non_null(strstr(status_message(), "edge 5 of fish nemo is pressed to"));
    assert_non_null(strstr(status_message(), "body.modulus is too low"));
}

TEST(kinds_of_unknowns_are_the_same_in_all_intervals) {
    // IDA and the one-step methods look them up once
    const char *const texts[] = {SMALL "fish: [{}]\n", SMALL "wake: {shedding: impulsive}\nfish: [{}]\n",
                                 SMALL "wake: {shedding: continuous}\nsheet: {kutta: rate}\nfish: [{}]\n",
                                 SMALL "wake: {shedding: impulsive}\nsheet: {kutta: rate}\nfish: [{}]\n",
                                 SMALL "fish: [{motion: {prescribed: head, heave: 0.1, frequency: 1}}]\n"};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        struct simulation *const simulation = school_simulation(texts[i]);
        double first[91], now[91];
        const int n_unknowns = simulation->school->n_unknowns;
        assert_in_range(n_unknowns, 1, 91);
        residual_kinds(simulation->residual, &residual_run, first);
        for (int n = 0; n < 3; n++) {
            school_ok(simulate_step(simulation));
            residual_kinds(simulation->residual, &residual_run, now);
            NEAR_ARRAY(n_unknowns, now, first, 0, 0);
        }
    }
}

TEST(an_unreachable_tolerance_ends_with_a_message) {
    struct simulation *const simulation =
        school_simulation(SMALL "solver: {rtol: 1.0e-14, max_steps: 200}\nfish: [{body: {modulus: 1.0e+9}}]\n");
    enum status status = STATUS_OK;
    while (status == STATUS_OK && simulation->state->t < 0.2) status = simulate_step(simulation);
    assert_int_equal(status, STATUS_SOLVER);
    assert_non_null(strstr(status_message(), "t = "));
}

TEST(an_iteration_that_ignores_other_fish_ends_with_a_remedy) {
    // a column of fish of which each sees none of the others in its Jacobian; with a sheet as wake they converge alone
    char text[2000];
    int length = snprintf(text, sizeof text,
                          "time: {end: 1, shedding_interval: 0.02, output_interval: 0.02}\n"
                          "solver: {coupling_distance: 0}\ncontact: {action: warn}\nwake: {shedding: "
                          "continuous}\ndefaults: {fish: {nodes: 7, start: "
                          "{speed: 1}}}\nfish:\n");
    for (int f = 0; f < 16; f++)
        length += snprintf(text + length, sizeof text - (size_t)length, "  - {start: {position: [0, %g]}}\n", 0.3 * f);
    struct simulation *const simulation = school_simulation(text);
    simulation->residual->couplings.couples_most = 1;  // as where there is no memory for more
    enum status status = STATUS_OK;
    for (int i = 0; i < 5 && status == STATUS_OK; i++) status = simulate_step(simulation);
    assert_int_equal(status, STATUS_SOLVER);
    assert_non_null(strstr(status_message(), "no coupling of 120 of 120 pairs of fish, which are more than 0 m apart"));
    assert_non_null(strstr(status_message(), "increase solver.coupling_distance"));
}
