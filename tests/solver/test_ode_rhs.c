/* test_ode_rhs.c: With every option, the algebraic unknowns that an explicit method computes satisfy all equations. */
#include <string.h>

#include "school.h"
#include "solver/ode_rhs.h"

// one fish, and three different ones in an external flow; both Kutta conditions and lines of the sheet, a prescribed
// head, all control laws
static const char *const cases[] = {
    "time: {end: 1, shedding_interval: 0.02}\n"
    "fish: [{nodes: 7, control: {law: heading, desired_heading: 150}}]\n",
    "time: {end: 1, shedding_interval: 0.02}\n"
    "fluid: {velocity: [0.1, -0.05], shear: 0.2, gust: {amplitude: 0.1, frequency: 0.7}}\n"
    "wake: {shedding: continuous}\nsheet: {kutta: rate, collocation: midpoint, curve: polygon}\nfish:\n"
    "  - {nodes: 7, sheet_points: 13, control: {law: heading, desired_heading: 150}}\n"
    "  - {nodes: 9, length: 0.8, sheet_points: 11, start: {position: [0.2, 1.6]}}\n"
    "  - {nodes: 6, length: 1.2, sheet_points: 9, start: {position: [0.1, -1.7]}, control: {law: averaged_heading}}\n",
    "time: {end: 1, shedding_interval: 0.02}\nfluid: {velocity: [-1, 0]}\n"
    "fish: [{nodes: 8, wave: {amplitude: 0}, load: {tip: [1, 2]},\n"
    "        motion: {prescribed: head, heave: 0.1, pitch: 10, frequency: 1, speed: 0}}]\n",
    "time: {end: 1, shedding_interval: 0.02}\nwake: {shedding: impulsive, removed_circulation: dropped}\n"
    "fish: [{nodes: 7, sheet_points: 13}, {nodes: 7, sheet_points: 13, start: {position: [0, 1.6]}}]\n",
    "time: {end: 1, shedding_interval: 0.02}\n"
    "fish: [{nodes: 7}, {nodes: 9, start: {position: [0, 1.6]}}]\n",
    "time: {end: 1, shedding_interval: 0.02}\n"
    "fluid: {velocity: [0.1, -0.05], shear: 0.2, gust: {amplitude: 0.1, frequency: 0.7}}\nfish:\n"
    "  - {nodes: 7, sheet_points: 13, pressure: {span: infinite, suction_limit: 0.01}}\n"
    "  - {nodes: 6, sheet_points: 13, force: reactive, start: {position: [0, 2]}}\n"
    "  - {nodes: 5, sheet_points: 9, pressure: {span: infinite}, start: {position: [0, -2]},\n"
    "     motion: {prescribed: head, heave: 0.1, pitch: 10, frequency: 1}}\n"
    "  - {nodes: 5, sheet_points: 9, pressure: {span: infinite}, start: {position: [0, -4]},\n"
    "     motion: {prescribed: all, surge: free, heave: 0.1, pitch: 10, frequency: 1}}\n"
    "  - {nodes: 5, sheet_points: 9, force: published, start: {position: [0, -6]},\n"
    "     motion: {prescribed: head, surge: free, heave: 0.1, pitch: 10, frequency: 1}}\n",
    // rings: the divergence of the flow acts on bodies, and the suction along the edges on a body of variable depth
    "time: {end: 1, shedding_interval: 0.02}\nfish:\n"
    "  - {nodes: 5, sheet_points: 19, body: {profile: table, thickness_table: [0.1, 0.1, 0.1, 0.1],\n"
    "     depth_table: [0.3, 0.4, 0.5, 0.4]}}\n"
    "  - {nodes: 6, sheet_points: 23, force: reactive, start: {position: [0, 2]}}\n",
};

TEST(all_equations_hold_for_the_computed_unknowns) {
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct setup setup = setup_stirred(cases[i]);
        struct ode_rhs *rhs;
        rhs = ode_rhs_create(test_arena(), setup.residual);
        school_ok(ode_rhs_rates(rhs, setup.t, setup.state->y, setup.state->yp));
        school_ok(
            residual_evaluate(setup.residual, &residual_run, setup.t, setup.state->y, setup.state->yp, setup.value));
        // rounding of forces per mass of the order of 1e5 m s-2
        for (int k = 0; k < setup.school->n_unknowns; k++) NEAR(setup.value[k], 0, 1e-9, 0);
        // and algebraic unknowns have no rates
        for (int f = 0; f < setup.school->n_fish; f++) {
            const struct fish *const fish = &setup.school->fish[f];
            const double *const yp = setup.state->yp;
            for (int k = 0; k < 2 * fish->n_nodes; k++) NEAR(yp[fish->at.ax + k], 0, 0, 0);
            for (int j = 0; j < fish->n_sheet; j++) NEAR(yp[fish->at.gamma + j], 0, 0, 0);
            NEAR(yp[fish->at.phi0], 0, 0, 0);
        }
    }
}

TEST(what_is_not_finite_asks_for_a_smaller_step) {
    struct setup setup = setup_of(cases[0]);
    struct ode_rhs *rhs;
    rhs = ode_rhs_create(test_arena(), setup.residual);
    setup.state->y[setup.school->fish[0].at.x + 2] = NAN;
    assert_int_equal(ode_rhs_rates(rhs, 0, setup.state->y, setup.state->yp), STATUS_RETRY);
}

TEST(a_singular_system_asks_for_a_smaller_step) {
    for (int i = 0; i < 2; i++) {
        struct setup setup = setup_of(cases[1]);
        struct fish *fish = setup.school->fish;
        // Kelvin's theorem without circulations; a node without mass
        for (int j = 0; i == 0 && j < fish->n_sheet; j++) fish->sheet_weight[j] = 0;
        if (i == 1) fish->mass[3] = fish->added_mass[2] = fish->added_mass[3] = 0;
        struct ode_rhs *rhs;
        rhs = ode_rhs_create(test_arena(), setup.residual);
        assert_int_equal(ode_rhs_rates(rhs, 0, setup.state->y, setup.state->yp), STATUS_RETRY);
        assert_non_null(strstr(status_message(), i == 0 ? "the bound sheets" : "the accelerations of fish fish1"));
    }
}
