/* test_initial_conditions.c: The algebraic unknowns follow from the differential ones, which stay as they are
 * (doc/model.md, section 10). */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fish/fish_motion.h"
#include "school.h"

#define TIME "time: {end: 1, shedding_interval: 0.02, output_interval: 0.02}\n"
#define SMALL TIME "defaults: {fish: {nodes: 7}}\n"
#define FISH "fish: [{sheet_points: 13, body: {depth: 1}}]\n"

static const char *const texts[] = {
    SMALL FISH, SMALL "wake: {shedding: continuous}\nsheet: {kutta: rate}\n" FISH,
    SMALL "wake: {shedding: continuous}\nsheet: {kutta: rate, collocation: midpoint}\n" FISH,
    SMALL "wake: {shedding: continuous, removed_circulation: dropped, decay: 0}\nsheet: {collocation: midpoint}\n" FISH,
    SMALL "wake: {shedding: impulsive}\n" FISH, SMALL "sheet: {curve: polygon}\n" FISH,
    TIME "preset: published\nfish: [{sheet_points: 11}]\n",
    SMALL
    "fluid: {velocity: [0.3, -0.2], shear: 0.7, gust: {amplitude: 0.4, frequency: 1.3}}\n"
    "fish: [{control: {law: heading, desired_heading: 150}}]\n",
    SMALL "fish: [{control: {law: averaged_heading, waypoints: [[-3, 1]]}, wave: {ramp: 0}}]\n",
    SMALL "fish: [{motion: {prescribed: head, heave: 0.1, pitch: 10, frequency: 1}, load: {tip: [1, 2]}}]\n",
    SMALL "fish: [{motion: {prescribed: all, heave: 0.1, pitch: 10, frequency: 1}}]\n",
    SMALL "fluid: {density: 0}\nwake: {shedding: continuous}\n" FISH,
    // nothing depends on accelerations beside momenta, which keep the rounding of elastic forces
    SMALL "wake: {shedding: continuous}\nfish: [{body: {modulus: 1.0e+10}}]\n",
    TIME
    "wake: {shedding: sheet}\nsheet: {curve: smooth}\nfish:\n"
    "  - {nodes: 7, sheet_points: 13, force: pressure, pressure: {span: infinite}}\n"
    "  - {nodes: 6, sheet_points: 13, force: reactive, start: {position: [0, 0.7]}}\n"
    "  - {nodes: 5, sheet_points: 9, force: pressure, pressure: {span: infinite}, start: {position: [0, -0.7]},\n"
    "     motion: {prescribed: head, heave: 0.1, pitch: 10, frequency: 1}}\n",
    SMALL
    "contact: {action: warn}\nfish: [{}, {nodes: 5, length: 0.7, start: {position: [0.2, 0.5]}}, {nodes: 9, start: "
    "{position: [0, -0.6]}}]\n"};

/* Newton's iteration with a Jacobian without the blocks that couple these fish. */
static const char uncoupled[] =
    SMALL "solver: {coupling_distance: 0}\nfish: [{}, {nodes: 5, start: {position: [0.2, 0.5]}}]\n";

static void check_residual(struct setup *setup, double t, const char *text) {
    const int n = setup->school->n_unknowns;
    school_ok(residual_evaluate(setup->residual, &residual_run, t, setup->state->y, setup->state->yp, setup->value));
    double *const kind = test_array(n);
    residual_kinds(setup->residual, &residual_run, kind);
    for (int i = 0; i < n; i++) {
        const struct unknown_place place = residual_place(setup->school, i);
        // accelerations of stiff bodies are sums of large forces: relative to those
        const double size = place.kind == UNKNOWN_AX || place.kind == UNKNOWN_AY
                                ? fmax(1, setup->school->fish[place.fish].axial_stiffness[0] * 1e-6)
                                : 1;
        if (fabs(setup->value[i]) <= 1e-10 * size) continue;
        print_error("%s: row %s[%d] of fish %d has a residual of %g\n", text, place.name, place.index, place.fish,
                    setup->value[i]);
        fail();
    }
}

TEST(all_equations_hold_at_the_start_for_every_option) {
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        struct setup setup = setup_of(texts[i]);
        school_consistent(&setup, 0);
        check_residual(&setup, 0, texts[i]);
    }
}

TEST(blocks_left_out_of_the_jacobian_change_no_solution) {
    struct setup setup = setup_of(uncoupled);
    assert_int_equal(setup.residual->couplings.coupled[1], 0);
    school_consistent(&setup, 0);
    check_residual(&setup, 0, uncoupled);
}

TEST(klu_finds_the_same_state) {
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        struct setup setup = setup_stirred(texts[i]);
        double *const start = test_copy(setup.school->n_unknowns, setup.state->y);
        school_consistent(&setup, setup.t);
        double *const want = test_copy(setup.school->n_unknowns, setup.state->y);
        memcpy(setup.state->y, start, (size_t)setup.school->n_unknowns * sizeof *start);
        setup.school->linear = LINEAR_KLU;
        school_consistent(&setup, setup.t);
        for (int k = 0; k < setup.school->n_unknowns; k++) {
            // the last step of Newton's method is below 1e-14 of the scales, times the condition of the system
            NEAR(setup.state->y[k], want[k], 1e-9 * residual_scale(setup.school, k), 1e-9);
        }
    }
}

TEST(all_equations_hold_again_from_any_state) {
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        struct setup setup = setup_stirred(texts[i]);
        // the solver moves prescribed nodes to their given motion: their positions and velocities are algebraic
        school_consistent(&setup, setup.t);
        // rates of algebraic unknowns appear in no equation
        check_residual(&setup, setup.t, texts[i]);
    }
}

TEST(differential_unknowns_stay_as_they_are) {
    struct setup setup = setup_stirred(SMALL "wake: {shedding: continuous}\nsheet: {kutta: rate}\n" FISH);
    double *const kind = test_array(setup.school->n_unknowns);
    double *const before = test_copy(setup.school->n_unknowns, setup.state->y);
    residual_kinds(setup.residual, &residual_run, kind);
    struct initial_conditions *const solver = school_consistent(&setup, setup.t);
    int n_differential = 0;
    for (int i = 0; i < setup.school->n_unknowns; i++) {
        if (kind[i] > 0) NEAR(setup.state->y[i], before[i], 0, 0);
        n_differential += kind[i] > 0;
    }
    // x, v of seven nodes, and the circulation shed
    assert_int_equal(n_differential, 29);
    AT_LEAST(initial_conditions_iterations(solver), 1);
}

// places and velocities at the start, later places and momenta; the prescribed node has its motion at all times
TEST(momenta_follow_at_the_start_and_velocities_later) {
    struct setup setup =
        setup_stirred(TIME
                      "wake: {shedding: sheet}\nsheet: {curve: smooth}\n"
                      "fish: [{nodes: 7, sheet_points: 13, force: pressure, pressure: {span: infinite}, motion: "
                      "{prescribed: head, heave: 0.1, frequency: 1}}]\n");
    const struct layout *at = &setup.school->fish[0].at;
    double *const y = setup.state->y, before[128];
    struct initial_conditions *solver;
    school_ok(initial_conditions_create(test_arena(), &solver, setup.residual));
    for (int start = 1; start >= 0; start--) {
        const struct residual_mode mode = {.shed = start ? SHED_IS_GIVEN : SHED_BY_LAW, .velocities_are_given = start};
        for (int i = at->x; i < at->end; i++) before[i] = y[i];
        school_ok(initial_conditions_solve(solver, &mode, setup.t, y, setup.state->yp));
        for (int k = fish_n_prescribed(setup.school->fish); k < 7; k++) {
            NEAR(y[at->y + k], before[at->y + k], 0, 0);
            NEAR(y[(start ? at->vy : at->py) + k], before[(start ? at->vy : at->py) + k], 0, 0);
            ABOVE(fabs(y[(start ? at->py : at->vy) + k] - before[(start ? at->py : at->vy) + k]), 1e-6);
        }
        const double *const added = setup.residual->force[0].momentum;
        for (int i = 0; i < 14; i++) {
            NEAR(y[at->px + i], y[at->vx + i] + added[i] / setup.school->fish[0].mass[i % 7], 1e-10, 1e-10);
        }
    }
}

TEST(stiffness_takes_no_iterations_where_momenta_are_kept) {
    // the equations are linear but for the rounding of elastic forces in accelerations, on which nothing depends
    static const char *const moduli[] = {"1.0e+6", "1.0e+10", "1.0e+13"};
    for (int i = 0; i < 3; i++) {
        struct simulation *const simulation = school_simulation_of(
            "time: {end: 1, shedding_interval: 0.01}\n"
            "fish: [{force: pressure, pressure: {span: infinite}, body: {modulus: %s}, wave: "
            "{ramp: 0}, start: {speed: 1},\n        motion: {prescribed: head}}]\n",
            moduli[i]);
        assert_in_range(initial_conditions_iterations(simulation->consistent), 1, 2);
    }
}

TEST(light_bodies_take_no_iterations_either) {
    // the momentum over the mass is many times the velocity
    static const char *const densities[] = {"1.0e+3", "1.0e-1", "1.0e-5"};
    for (int i = 0; i < 3; i++) {
        struct simulation *const simulation = school_simulation_of(
            "time: {end: 1, shedding_interval: 0.01}\n"
            "fish: [{force: pressure, pressure: {span: infinite}, body: {density: %s}, wave: "
            "{ramp: 0}, start: {speed: 1},\n        motion: {prescribed: head}}]\n",
            densities[i]);
        assert_in_range(initial_conditions_iterations(simulation->consistent), 1, 2);
    }
}

TEST(a_second_solution_changes_nothing) {
    struct setup setup = setup_stirred(SMALL FISH);
    struct initial_conditions *const solver = school_consistent(&setup, setup.t);
    double *const before = test_copy(setup.school->n_unknowns, setup.state->y);
    school_ok(initial_conditions_solve(solver, &residual_run, setup.t, setup.state->y, setup.state->yp));
    // rounding of accelerations of a stiff body
    NEAR_ARRAY(setup.school->n_unknowns, setup.state->y, before, 1e-11, 1e-11);
}

TEST(a_state_that_is_not_a_number_is_refused_and_kept) {
    struct setup setup = setup_stirred(SMALL FISH);
    struct initial_conditions *solver;
    school_ok(initial_conditions_create(test_arena(), &solver, setup.residual));
    const struct fish *fish = setup.school->fish;
    setup.state->y[fish->at.x + 3] = NAN;
    const double before = setup.state->y[fish->at.ax];
    assert_int_equal(initial_conditions_solve(solver, &residual_run, setup.t, setup.state->y, setup.state->yp),
                     STATUS_SOLVER);
    NEAR(setup.state->y[fish->at.ax], before, 0, 0);
    // it says when, and which equation
    assert_non_null(strstr(status_message(), "t = 0.208"));
    assert_non_null(strstr(status_message(), "fish1"));
    // and the cause, not what KINSOL says about it
    assert_non_null(strstr(status_message(), "of fish fish1 has no finite value"));
}

TEST(a_singular_jacobian_is_named) {
    struct setup setup = setup_of(SMALL "fish: [{name: nemo, sheet_points: 13, body: {depth: 1}}]\n");
    // Kelvin's theorem without circulations, and its residual
    struct fish *fish = setup.school->fish;
    for (int j = 0; j < fish->n_sheet; j++) fish->sheet_weight[j] = 0;
    setup.school->kutta = KUTTA_RATE;
    setup.state->y[fish->at.circulation] = 1;
    struct initial_conditions *solver;
    school_ok(initial_conditions_create(test_arena(), &solver, setup.residual));
    assert_int_equal(initial_conditions_solve(solver, &residual_run, 0, setup.state->y, setup.state->yp),
                     STATUS_SOLVER);
    assert_non_null(strstr(status_message(), "the Jacobian of fish nemo is singular"));
}

TEST(a_rate_that_is_not_a_number_does_not_matter) {
    struct setup setup = setup_of(SMALL FISH);
    const struct fish *fish = setup.school->fish;
    setup.state->yp[fish->at.x + 1] = NAN;
    school_consistent(&setup, 0);
    NEAR(setup.state->yp[fish->at.x + 1], setup.state->y[fish->at.vx + 1], 0, 0);
}
