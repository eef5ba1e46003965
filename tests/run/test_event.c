/* test_event.c: Tests what happens at the events t_n = n Dt, in its order (doc/model.md, sections 7, 8 and 11). */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "flow/flow_at_bodies.h"
#include "force/bound_sheet.h"
#include "run/event.h"
#include "run/simulate.h"
#include "school.h"
#include "school/diagnostics_energy.h"

#define TIME "time: {end: 1, shedding_interval: 0.02, output_interval: 0.02}\n"
#define SMALL TIME "defaults: {fish: {nodes: 7}}\n"

TEST(events_are_at_the_multiples_that_a_decimal_names) {
    // 7 * 0.1 is not 0.7; the last interval is no short decimal, but a ratio
    static const struct {
        const char *interval;
        double p, q;
    } of[] = {{"0.01", 1, 100},
              {"0.02", 2, 100},
              {"0.07", 7, 100},
              {"0.0125", 125, 1e4},
              {"0.033333333333333333", 1, 30},
              {"0.0031415926535", 0.0031415926535, 1}};
    int n_rounded = 0;
    for (size_t i = 0; i < sizeof of / sizeof *of; i++) {
        struct simulation *const simulation = school_simulation_of(
            "time: {end: %.17g, shedding_interval: %s}\nfluid: {density: 0}\nfish: [{nodes: 7, wave: {amplitude: "
            "0}}]\n",
            100 * strtod(of[i].interval, NULL), of[i].interval);
        const struct school *const school = simulation->school;
        for (long n = 1; n <= 10000; n++) {
            // by the decimal text of an exact integer, which strtod rounds once
            char text[64];
            double time = (double)n * of[i].p / of[i].q;
            if (of[i].q == 100) {
                snprintf(text, sizeof text, "%ld.%02ld", n * (long)of[i].p / 100, n * (long)of[i].p % 100);
                time = strtod(text, NULL);
            }
            NEAR(fish_event_time(school, n), time, 0, 0);
            n_rounded += time != (double)n * school->interval;
        }
        for (long n = 1; n <= 10; n++) {
            school_ok(simulate_step(simulation));
            assert_int_equal(simulation->state->event, n);
            NEAR(simulation->state->t, fish_event_time(school, n), 0, 0);
        }
    }
    assert_in_range(n_rounded, 1000, 60000);
}

TEST(an_event_without_finite_velocities_is_final) {
    const char *const texts[] = {SMALL "wake: {shedding: continuous}\nfish: [{}]\n",
                                 SMALL "wake: {shedding: impulsive}\nsheet: {kutta: rate}\nfish: [{}]\n"};
    for (int i = 0; i < 2; i++) {
        struct simulation *const simulation = school_simulation(texts[i]);
        struct state *const s = simulation->state;
        school_run(simulation, 0.1);
        // continuous shedding releases at the nascent vortex, impulsive shedding at the tail
        s->wake[0].slip[0] = NAN;
        if (i == 1) s->y[simulation->school->fish[0].at.x + 6] = NAN;
        assert_int_equal(simulate_event(simulation), STATUS_SOLVER);
        assert_non_null(strstr(status_message(), "has no finite value at t = 0.12"));
    }
}

TEST(one_vortex_is_released_at_every_event_with_what_was_shed) {
    struct simulation *const simulation = school_simulation(SMALL "wake: {shedding: continuous}\nfish: [{}]\n");
    const struct fish *fish = simulation->school->fish;
    const struct wake *wake = &simulation->state->wake[0];
    const double *const y = simulation->state->y;
    assert_int_equal(wake->n_vortex, 0);
    double shed = y[fish->at.circulation];
    for (int n = 1; n <= 20; n++) {
        const double slip[2] = {wake->slip[0], wake->slip[1]};
        school_ok(simulate_step(simulation));
        assert_int_equal(wake->n_vortex, n);
        NEAR(wake->circulation[n - 1], y[fish->at.circulation] - shed, 1e-15, 0);
        NEAR(wake->birth[n - 1], 0.02 * n, 1e-15, 0);
        NEAR(wake->shed_before, y[fish->at.circulation], 0, 0);
        // position of the nascent vortex: half of the slip distance behind the tail
        NEAR(wake->x[n - 1], y[fish->at.x + 6] + 0.01 * slip[0], 1e-15, 0);
        NEAR(wake->y[n - 1], y[fish->at.y + 6] + 0.01 * slip[1], 1e-15, 0);
        shed = y[fish->at.circulation];
    }
}

// at an event with both release and removal
static void fields_are_continuous(const char *wake) {
    struct simulation *const simulation = school_simulation_of(
        SMALL "wake: {shedding: continuous, %s}\nfish: [{}, {start: {position: [0.2, 0.5]}}]\n", wake);
    school_run(simulation, 0.5);
    const double next = simulation->state->t + 0.02;
    school_ok(simulate_interval(simulation, next));
    struct residual *residual = simulation->residual;
    const int n = simulation->school->n_unknowns, n_points = residual->flow->n_points;
    double before[400], u[200], v[200];
    AT_MOST(n, 400);
    AT_MOST(n_points, 200);
    school_ok(residual_evaluate(residual, &residual_run, next, simulation->state->y, simulation->state->yp, before));
    memcpy(u, residual->flow->u, (size_t)n_points * sizeof *u);
    memcpy(v, residual->flow->v, (size_t)n_points * sizeof *v);
    school_ok(simulate_event(simulation));
    assert_false(simulation->event->jumps);
    double after[400];
    school_ok(residual_evaluate(residual, &residual_run, next, simulation->state->y, simulation->state->yp, after));
    // only rounding errors, from sums over sources in another order
    NEAR_ARRAY(n_points, residual->flow->u, u, 1e-12, 1e-12);
    NEAR_ARRAY(n_points, residual->flow->v, v, 1e-12, 1e-12);
    for (int f = 0; f < 2; f++) {
        const struct fish *fish = &simulation->school->fish[f];
        NEAR(after[fish->at.gamma + fish->n_control], before[fish->at.gamma + fish->n_control], 1e-13, 0);
    }
}

TEST(fields_are_continuous_across_a_continuous_event) {
    fields_are_continuous("lifetime: 0.2");
    fields_are_continuous("lifetime: 0.2, removed_circulation: dropped");
    // a decay shorter than an interval, no decay, and a lifetime that is not a multiple of the interval
    fields_are_continuous("lifetime: 0.2003, decay: 0.0004");
    fields_are_continuous("lifetime: 0.2, decay: 0");
    fields_are_continuous("lifetime: 0.213, decay: 0, removed_circulation: dropped");
}

TEST(wake_holds_one_lifetime) {
    struct simulation *const simulation = school_simulation(SMALL "wake: {lifetime: 0.2}\nfish: [{}]\n");
    for (int n = 1; n <= 30; n++) {
        school_ok(simulate_step(simulation));
        // lifetime of ten intervals: the marker released at the start is removed at 0.22
        assert_int_equal(simulation->state->wake[0].n_vortex, n <= 10 ? n + 1 : 11);
    }
}

// the slots of a result, in which every wake has room
TEST(the_largest_wake_of_a_run_is_known_before) {
    static const struct {
        const char *wake;
        int most;
    } wakes[] = {{"shedding: sheet, lifetime: 0.2", 11},
                 {"shedding: sheet, lifetime: 0.213, decay: 0", 12},
                 {"shedding: sheet, lifetime: 0.2, decay: 0.1, spare_vortices: 3", 11},
                 {"shedding: continuous, lifetime: 0.2", 10},
                 {"shedding: impulsive, lifetime: 0.2", 10}};
    for (size_t i = 0; i < sizeof wakes / sizeof *wakes; i++) {
        struct simulation *const simulation = school_simulation_of(
            TIME "solver: {rtol: 1e-2}\nwake: {%s}\nfish: [{nodes: 4, force: reactive, sheet_points: 5}]\n",
            wakes[i].wake);
        const int spare = simulation->school->wake_spare;
        int most = simulation->state->wake[0].n_vortex;
        for (int n = 1; n <= 16; n++) {
            school_ok(simulate_step(simulation));
            const int now = simulation->state->wake[0].n_vortex;
            AT_MOST(now, wake_most(simulation->school, n) - spare);
            most = now > most ? now : most;
        }
        assert_int_equal(most, wakes[i].most);
        // one slot more for a vortex that is released before the oldest is removed
        assert_in_range(wake_most(simulation->school, 1000) - spare - most, 0, i < 3 ? 0 : 1);
        assert_int_equal(wake_most(simulation->school, 3) - spare, 4);
    }
}

TEST(impulses_conserve_circulation_and_meet_kutta) {
    struct simulation *const simulation =
        school_simulation(SMALL "wake: {shedding: impulsive}\nfish: [{sheet_points: 11}]\n");
    const struct fish *fish = simulation->school->fish;
    const struct state *s = simulation->state;
    // the event at t = 0 sheds a vortex too
    assert_int_equal(s->wake[0].n_vortex, 1);
    for (int n = 1; n <= 20; n++) {
        const double shed = s->y[fish->at.circulation];
        school_ok(simulate_interval(simulation, 0.02 * n));
        // no shedding between events
        NEAR(s->y[fish->at.circulation], shed, 1e-12, 0);
        school_ok(simulate_event(simulation));
        assert_true(simulation->event->jumps);
        assert_int_equal(s->wake[0].n_vortex, n + 1);
        NEAR(s->wake[0].circulation[n], s->y[fish->at.circulation] - shed, 1e-15, 0);
        NEAR(bound_sheet_circulation(fish, s->y) + s->y[fish->at.circulation], 0, 1e-12, 0);
        // the new vortex at the edge makes the bound vortex at the edge vanish
        NEAR(s->y[fish->at.gamma + 10] * fish->sheet_weight[10], 0, 1e-12, 0);
        school_ok(simulation->integrator->restart(simulation->solver));
    }
    ABOVE(fabs(s->y[fish->at.circulation]), 1e-3);
}

TEST(impulses_by_rate_are_the_rate_times_the_interval) {
    struct simulation *const simulation =
        school_simulation(SMALL "wake: {shedding: impulsive}\nsheet: {kutta: rate}\nfish: [{sheet_points: 11}]\n");
    const struct fish *fish = simulation->school->fish;
    struct state *const s = simulation->state;
    for (int n = 1; n <= 10; n++) {
        school_ok(simulate_interval(simulation, 0.02 * n));
        const double shed = s->y[fish->at.circulation];
        // the wake as it will be moved, the unknowns as they are: t just at the event
        double value[100];
        school_ok(residual_evaluate(simulation->residual, &residual_run, 0.02 * n, s->y, s->yp, value));
        const double rate = residual_kutta_rate(simulation->residual, 0, s->y);
        school_ok(simulate_event(simulation));
        NEAR(s->y[fish->at.circulation] - shed, 0.02 * rate, 1e-12, 1e-12);
        school_ok(simulation->integrator->restart(simulation->solver));
    }
}

TEST(waypoints_advance_during_a_run) {
    struct simulation *const simulation =
        school_simulation(SMALL
                          "fish: [{start: {speed: 1}, control: {law: heading, waypoints: [[-0.6, 0], [-0.8, 0.3], [-2, "
                          "2]], acceptance_radius: 0.25}}]\n");
    int before = 0;
    for (int n = 1; n <= 40; n++) {
        school_ok(simulate_step(simulation));
        const int now = simulation->state->control[0].waypoint;
        assert_true(now == before || now == before + 1 || now == before + 2);
        before = now;
    }
    // the fish swims at about 1 m s-1
    AT_LEAST(before, 1);
    BELOW(before, 3);
}

TEST(averaged_heading_changes_the_bias_at_a_bounded_rate) {
    struct simulation *const simulation =
        school_simulation(SMALL "fish: [{control: {law: averaged_heading, desired_heading: 90, rate: 1.5}}]\n");
    const int phi0 = simulation->school->fish[0].at.phi0;
    double before = simulation->state->y[phi0], largest = 0;
    NEAR(before, 0, 0, 0);
    for (int n = 1; n <= 40; n++) {
        school_ok(simulate_step(simulation));
        const double rate = (simulation->state->y[phi0] - before) / 0.02;
        AT_MOST(fabs(rate), 1.5 * (1 + 1e-9));
        largest = fmax(largest, fabs(rate));
        before = simulation->state->y[phi0];
    }
    NEAR(largest, 1.5, 0, 1e-9);
    // heading too far left: the fish turns right
    ABOVE(before, 0.3);
}

// the powers of a muscle have a kink where the rate of its bias jumps: their integral begins again at such an event
TEST(samples_of_the_power_begin_again_where_the_bias_kinks) {
    static const char *const laws[] = {"none", "averaged_heading"};
    for (int i = 0; i < 2; i++) {
        struct simulation *const simulation =
            school_simulation_of(SMALL "fish: [{control: {law: %s}, start: {heading: 170}}]\n", laws[i]);
        for (int n = 1; n <= 5; n++) {
            school_ok(simulate_step(simulation));
            const struct state *const now = simulation->state;
            const struct energy_balance *const balance = &now->balance[0];
            assert_int_equal(balance->n, i == 0 ? 2 : 1);
            NEAR(balance->t[0], now->t, 1e-15, 0);
            const struct diagnostics_power power = diagnostics_power(simulation->residual, 0, now->t, now->y);
            if (i == 1) NEAR(balance->power[0][WORK_ACTUATION], power.actuation, 0, 1e-14);
        }
    }
}

// nodes and phi0 at the end of 0.3 s of a turn across a stream that shears, with a modulus and a method
static void turn_with_feedforward(const char *modulus, const char *solver, double place[14], double *phi0) {
    struct simulation *const simulation = school_simulation_of(
        "time: {end: 1, shedding_interval: 0.02}\nsolver: {%s}\nfluid: {velocity: [0.3, 0.2], shear: 2}\n"
        "fish: [{nodes: 7, force: reactive, body: {modulus: %s},\n"
        "        control: {law: heading, desired_heading: 160, filter: 0.1, feedforward: 200}}]\n",
        solver, modulus);
    school_run(simulation, 0.3);
    const struct fish *fish = simulation->school->fish;
    memcpy(place, simulation->state->y + fish->at.x, 14 * sizeof *place);
    *phi0 = simulation->state->y[fish->at.phi0];
    // the control law observes the mean moment
    ABOVE(200 * fabs(simulation->state->control[0].moment), 0.01);
}

TEST(feedforward_does_not_depend_on_the_integrator) {
    const char *const cases[][2] = {{"1.0e+4", "method: rk4, step: 5.0e-4"}, {"1.0e+6", "method: rk4, step: 1.0e-4"}};
    for (int i = 0; i < 2; i++) {
        double place[2][14], phi0[2];
        turn_with_feedforward(cases[i][0], "rtol: 1.0e-5", place[0], &phi0[0]);
        turn_with_feedforward(cases[i][0], cases[i][1], place[1], &phi0[1]);
        NEAR_ARRAY(14, place[0], place[1], 2e-5, 0);
        NEAR(phi0[0], phi0[1], 2e-5, 0);
    }
}

TEST(a_fish_reaches_its_waypoints) {
    struct simulation *const simulation = school_simulation(
        "time: {end: 30, shedding_interval: 0.02}\nfish: [{control: {waypoints: [[-4, 1], [-8, -1], [-12, 0]]}}]\n");
    const struct state *s = simulation->state;
    assert_int_equal(simulation->school->fish[0].control.law, CONTROL_COURSE);
    while (s->control[0].waypoint < 3 && s->t < 22) school_ok(simulate_step(simulation));
    assert_int_equal(s->control[0].waypoint, 3);
}

// The vortices of the case are in the fluid from the start: the sheet of a fish has a stretch for each vortex, and both
// ends of the stretch move together; the total circulation of fish and wake is the circulation of the vortices.
TEST(vortices_of_the_case_meet_the_fish) {
    static const char *const wakes[] = {"", "shedding: continuous, "};
    static const char *const fish[] = {"nodes: 9, force: pressure, pressure: {span: infinite}", "force: published"};
    for (int i = 0; i < 2; i++) {
        struct simulation *const simulation =
            school_simulation_of(SMALL
                                 "wake: {%slifetime: 10, decay: 0, vortices: [[-1, 0.5, 0.02], [-1, -0.5, -0.03]]}\n"
                                 "fish: [{%s}]\n",
                                 wakes[i], fish[i]);
        const struct wake *const wake = &simulation->state->wake[0];
        const double circulation[] = {0.02, -0.03};
        for (int n = 0; n < 20; n++) {
            int found = 0;
            for (int k = 0; k < wake_n_sources(wake); k++) {
                for (int v = 0; v < 2; v++) {
                    if (fabs(wake_source(wake, k) - circulation[v]) > 1e-15) continue;
                    found++;
                    if (n == 0) NEAR(wake->x[k], -1, 0, 0);
                    if (n == 0) NEAR(wake->y[k], v == 0 ? 0.5 : -0.5, 0, 0);
                    if (!wake->has_markers) continue;
                    NEAR(wake->x[k + 1], wake->x[k], 0, 0);
                    NEAR(wake->y[k + 1], wake->y[k], 0, 0);
                }
            }

            assert_int_equal(found, 2);
            school_ok(simulate_step(simulation));
        }

        simulate_measure(simulation);
        double sum = simulation->state->y[simulation->school->fish[0].at.circulation] - wake->shed_before;
        for (int k = 0; k < wake_n_sources(wake); k++) sum += wake_source(wake, k);
        sum += bound_sheet_circulation(&simulation->school->fish[0], simulation->state->y);
        NEAR(sum, -0.01, 0, 1e-12);
    }
}
