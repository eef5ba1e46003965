/* test_diagnostics.c: Tests the quantities that are derived from a state, and the energy balances (doc/model.md,
 * section 13). */
#include <stdio.h>
#include <string.h>

#include "body/rod.h"
#include "flow/flow_at_bodies.h"
#include "force/drag.h"
#include "school.h"
#include "school/diagnostics.h"
#include "school/diagnostics_energy.h"

#define TIME "time: {end: 2, shedding_interval: 0.01}\n"
#define SMALL TIME "defaults: {fish: {nodes: 7}}\n"
// a thick body at speed, whose energies are large; and with the reactive force
#define THICK TIME "defaults: {fish: {nodes: 7, body: {thickness: 0.2, depth: 0.25}, start: {speed: 1}}}\n"
#define CONTINUOUS THICK "wake: {shedding: continuous}\n"

static double total_energy(const struct diagnostics_fish *fish) {
    return fish->kinetic_energy + fish->bending_energy + fish->stretching_energy;
}

struct audit_result {
    double worst, put_in;
};

// the largest residual of the energy balance at any event up to t, and the energy at the start plus the work
static struct audit_result audit_of(const char *text, double t) {
    struct simulation *const simulation = school_simulation(text);
    struct audit_result result = {0, 0};
    simulate_measure(simulation);
    const double initial = total_energy(&simulation->diagnostics->fish[0]);
    while (simulation->state->t < t - 1e-6) {
        school_ok(simulate_step(simulation));
        simulate_measure(simulation);
        const struct diagnostics_fish *fish = &simulation->diagnostics->fish[0];
        result.worst = fmax(result.worst, fabs(fish->energy_balance));
        result.put_in = fmax(result.put_in, initial + fabs(fish->actuation_work));
    }
    return result;
}

TEST(energy_audit_closes_within_some_tolerances) {
    // the energy is the energy at the start plus the work of the muscle; steps of order 3 and the smaller energy of a
    // thin body cost the default a factor
    static const struct {
        const char *text;
        double tolerances, least;
    } of[] = {{CONTINUOUS, 10, 10}, {SMALL, 100, 2}};
    const double moduli[] = {1e5, 1e6, 1e7};
    for (int i = 0; i < 6; i++) {
        char text[256];
        snprintf(text, sizeof text, "%ssolver: {rtol: 1.0e-5}\nfish: [{body: {modulus: %.1e}}]\n", of[i / 3].text,
                 moduli[i % 3]);
        const struct audit_result balance = audit_of(text, 2);
        // the muscle did work: the terms of the energy balance are not zero
        ABOVE(balance.put_in, of[i / 3].least);
    }
}

TEST(energy_audit_falls_with_the_tolerance) {
    // errors of BDF of order 2 are of the size rtol^(2/3) or less: a factor of 21 and more from 1e-5 to 1e-7
    double worst[2];
    for (int i = 0; i < 2; i++) {
        char text[256];
        snprintf(text, sizeof text, SMALL "solver: {rtol: %s}\nfish: [{}]\n", i == 0 ? "1.0e-5" : "1.0e-7");
        worst[i] = audit_of(text, 2).worst;
    }
    ABOVE(worst[0] / worst[1], 10);
}

TEST(powers_are_integrated_with_third_order) {
    // of a soft body that steps of the fourth order follow; drag across the body has a kink in its derivative
    double worst[2];
    for (int i = 0; i < 2; i++) {
        char text[512];
        snprintf(text, sizeof text,
                 TIME
                 "wake: {shedding: continuous}\nsolver: {method: rk4, step: %g}\n"
                 "fish: [{nodes: 7, body: {modulus: 1e4}, drag: {normal: 0}}]\n",
                 2e-3 / (1 << i));
        worst[i] = audit_of(text, 0.5).worst;
    }
    NEAR(log2(worst[0] / worst[1]), 3, 0.3, 0);
}

/* The integrated strains of a soft body with strain damping, whose places know the strains as well: largest difference
 * at events. Steps of the fourth order leave the error of the parabola through three stresses, of the third order. */
TEST(strains_are_integrated_with_third_order) {
    double worst[2] = {0, 0};
    for (int i = 0; i < 2; i++) {
        struct simulation *const simulation =
            school_simulation_of(TIME
                                 "solver: {method: rk4, step: %g}\nfish: [{nodes: 7,\n"
                                 "  body: {modulus: 1.0e+4, damping: strain, relaxation_time: 0.05}}]\n",
                                 2e-3 / (1 << i));
        const struct fish *const fish = &simulation->school->fish[0];
        const struct energy_balance *const balance = &simulation->state->balance[0];
        double strain[64], rate[64], stress[64];
        AT_MOST(rod_n_strains(fish), 64);
        while (simulation->state->t < 0.5 - 1e-6) {
            school_ok(simulate_step(simulation));
            const struct state *const now = simulation->state;
            const struct actuation muscle = residual_actuate(simulation->residual, 0, now->t, now->y);
            rod_strains(fish, &muscle, now->y, &(struct rod_strains){strain, rate, stress});
            for (int k = 0; k < fish->n_joints; k++) worst[i] = fmax(worst[i], fabs(balance->strain[k] - strain[k]));
        }
    }
    const double order = log2(worst[0] / worst[1]);
    NEAR(order, 3, 0.3, 0);
}

TEST(energy_audit_closes_with_every_kind_of_power) {
    const char *const texts[] = {
        // a bias that jumps at waypoints
        CONTINUOUS "fish: [{control: {law: heading, waypoints: [[-0.6, 0.1], [-3, 2]], acceptance_radius: 0.1}}]\n",
        // prescribed nodes and a load
        CONTINUOUS
        "fish: [{body: {modulus: 1.0e+5}, load: {tip: [2, 3]}, wave: {amplitude: 0},\n"
        "  motion: {prescribed: head, heave: 0.1, pitch: 10, frequency: 1}}]\n",
        // vortices without decay before the removal; impulses
        THICK "wake: {shedding: continuous, decay: 0, lifetime: 0.5}\nfish: [{body: {modulus: 1.0e+5}}]\n",
        THICK "wake: {shedding: impulsive}\nfish: [{body: {modulus: 1.0e+5}}]\n",
        // a bias rate with a jump at every event; a bias moved by an explicit method
        CONTINUOUS "fish: [{control: {law: averaged_heading, desired_heading: 150}}]\n",
        CONTINUOUS
        "solver: {method: rk4, step: 2.5e-4}\n"
        "fish: [{body: {modulus: 1.0e+5}, control: {law: heading, desired_heading: 150}}]\n",
        CONTINUOUS
        "fluid: {velocity: [0.3, 0.1], shear: 0.2}\nfish: [{body: {relaxation_time: 0.01}, wave: {ramp: 0.5}}]\n"};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        const struct audit_result balance = audit_of(texts[i], 2);
        // order 1 at restarts, a load and a motion that begin at once: thirty tolerances
        AT_MOST(balance.worst, 30 * 1e-5 * balance.put_in);
    }
}

TEST(a_bias_that_moves_across_impulses_keeps_the_balance) {
    // the state jumps at every event; the bias must be continuous: an earlier defect set the bias back by an interval
    const struct audit_result balance = audit_of(THICK
                                                 "wake: {shedding: impulsive}\nsolver: {rtol: 1.0e-6}\n"
                                                 "fish: [{control: {law: averaged_heading, desired_heading: 150}}]\n",
                                                 2);
    AT_MOST(balance.worst, 30 * 1e-6 * balance.put_in);
    // a sudden start of the muscle excites vibrations, resolved only by a small tolerance; the defect was 300 J
    const struct audit_result published =
        audit_of(TIME
                 "preset: published\nsolver: {rtol: 1.0e-5}\n"
                 "fish: [{wave: {ramp: 0}, control: {law: averaged_heading, desired_heading: 150}}]\n",
                 0.5);
    AT_MOST(published.worst, 0.01 * published.put_in);
    // a waypoint that is passed moves the bias in the same event
    const struct audit_result passing =
        audit_of(THICK
                 "wake: {shedding: impulsive}\nsolver: {rtol: 1.0e-6}\n"
                 "fish: [{start: {speed: 1}, control: {law: heading, waypoints: [[-1, 0.2], [-3, 0]],\n"
                 "        acceptance_radius: 0.5}}]\n",
                 2);
    AT_MOST(passing.worst, 30 * 1e-6 * passing.put_in);
}

TEST(after_a_jump_the_balance_goes_on_from_the_powers_of_then) {
    struct simulation *const simulation =
        school_simulation(SMALL "wake: {shedding: impulsive}\nfish: [{body: {modulus: 1.0e+5}, wave: {ramp: 0}}]\n");
    for (int n = 1; n <= 5; n++) {
        school_ok(simulate_step(simulation));
        simulate_measure(simulation);
        const struct diagnostics_fish *const fish = &simulation->diagnostics->fish[0];
        const struct energy_balance *const balance = &simulation->state->balance[0];
        const double total = fish->actuation_power + fish->damping_power + fish->drag_power + fish->added_mass_power +
                             fish->wake_power + fish->constraint_power + fish->contact_power;
        // every impulse is a jump
        assert_int_equal(balance->n, 1);
        NEAR(balance->t[0], simulation->state->t, 0, 0);
        NEAR(balance->power[0][WORK_ALL], total, 1e-9, 1e-9);
        NEAR(balance->power[0][WORK_ACTUATION], fish->actuation_power, 1e-9, 1e-9);

        // drag is friction along the edges and cross-flow drag
        const struct flow_at_body flow = flow_at_body(simulation->residual->flow, 0);
        double drag = 0, along = 0;
        for (int k = 0; k < simulation->school->fish->n_edges; k++) {
            const struct edge edge = edge_at(simulation->school->fish, k, simulation->state->y);
            double w[2], force[2], friction[2];
            flow_relative_velocity(simulation->school->fish, k, edge.velocity, flow.u, flow.v, w);
            drag_force(simulation->school->fish, k, &edge, w, force, friction);
            drag += edge_dot(force, edge.velocity);
            along += edge_dot(friction, edge.velocity);
        }
        NEAR(fish->drag_power, drag, 0, 1e-12);
        NEAR(fish->friction_power, along, 0, 1e-12);
        NEAR(fish->cross_flow_power, drag - along, 0, 1e-12);
    }
}

TEST(total_circulation_vanishes_at_every_event) {
    const char *const texts[] = {
        SMALL "wake: {lifetime: 0.3}\nfish: [{}, {start: {position: [0.3, 0.7]}, nodes: 9}]\n",
        SMALL "wake: {shedding: continuous, lifetime: 0.3}\nsheet: {kutta: rate, collocation: midpoint}\nfish: [{}]\n",
        SMALL "wake: {lifetime: 0.3, shedding: impulsive, decay: 0}\nfish: [{}]\n",
        TIME "preset: published\nwake: {lifetime: 0.3}\nfish: [{}]\n",
        // dropped: removed circulation counts neither before nor after the removal
        SMALL "wake: {lifetime: 0.3, removed_circulation: dropped}\nfish: [{pressure: {span: infinite}}]\n",
        TIME "preset: published\nwake: {lifetime: 0.3, removed_circulation: dropped}\nfish: [{}]\n"};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        struct simulation *const simulation = school_simulation(texts[i]);
        while (simulation->state->t < 0.8) {
            school_ok(simulate_step(simulation));
            simulate_measure(simulation);
            // Newton's iteration stops at 0.003 rtol of L^2 f: 3e-8
            NEAR(simulation->diagnostics->total_circulation, 0, 3e-8, 0);
        }
        // circulation has been shed and removed
        ABOVE(fabs(simulation->state->y[simulation->school->fish[0].at.circulation]), 1e-4);
        ABOVE(fabs(simulation->state->wake[0].removed), 1e-6);
    }
}

// the largest change of momentum (two) and angular momentum per mass of a bent fish that beats and turns, without fluid
static void change_of_momentum(const char *rtol, double change[3]) {
    struct simulation *const simulation =
        school_simulation_of(SMALL
                             "fluid: {density: 0}\nsolver: {rtol: %s}\n"
                             "fish: [{body: {modulus: 1.0e+5}, start: {speed: 0.5}, control: {bias: 0.3}}]\n",
                             rtol);
    const struct fish *fish = simulation->school->fish;
    double *const y = simulation->state->y;
    double first[3] = {0, 0, 0};
    change[0] = change[1] = change[2] = 0;
    for (int n = 0; n <= 200; n++) {
        double now[3] = {0, 0, 0};
        for (int k = 0; k < fish->n_nodes; k++) {
            const double px = fish->mass[k] * y[fish->at.vx + k], py = fish->mass[k] * y[fish->at.vy + k];
            now[0] += px / fish->total_mass;
            now[1] += py / fish->total_mass;
            now[2] += (y[fish->at.x + k] * py - y[fish->at.y + k] * px) / fish->total_mass;
        }
        for (int i = 0; i < 3; i++) {
            if (n == 0) first[i] = now[i];
            change[i] = fmax(change[i], fabs(now[i] - first[i]));
        }
        if (n < 200) school_ok(simulate_step(simulation));
    }
    NEAR(first[0], -0.5, 1e-12, 0);
    // it did move
    simulate_measure(simulation);
    ABOVE(simulation->diagnostics->fish[0].bending_energy, 1e-3);
}

TEST(momentum_is_constant_without_fluid) {
    double change[3];
    // a linear invariant: every step of BDF conserves linear invariants up to the residual of the Newton iteration
    change_of_momentum("1.0e-5", change);
    NEAR(change[0], 0, 1e-9, 0);
    NEAR(change[1], 0, 1e-9, 0);
    // a quadratic invariant: conserved up to the integration error, 1e-9 with a tolerance far below the default
    NEAR(change[2], 0, 1e-5, 0);
    change_of_momentum("1.0e-10", change);
    NEAR_ARRAY(3, change, ((const double[]){0, 0, 0}), 1e-9, 0);
}

TEST(a_body_that_does_not_travel_has_no_numbers_per_speed) {
    // its bias steps, and it vibrates about the centre of mass, which rounding moves
    struct simulation *const simulation =
        school_simulation(TIME
                          "fluid: {density: 0}\n"
                          "fish: [{nodes: 7, wave: {ramp: 0}, control: {bias: 0.3}, start: {speed: 0}}]\n");
    school_measure(simulation, 1);
    const struct diagnostics_fish *const fish = simulation->diagnostics->fish;
    BELOW(fish->speed, 1e-9);
    assert_true(isnan(fish->strouhal));
    assert_true(isnan(fish->cost_of_transport));
    assert_true(isfinite(fish->mean_actuation_power));
}

static double reversals(int n, const double *bias, double limit) {
    struct sample samples[9];
    struct history history = {.capacity = 8, .n_slots = 9, .last = -1, .sample = samples};
    const struct fish fish = {.control = {.law = CONTROL_COURSE, .limit = limit}};
    for (int i = 0; i < n; i++) {
        const struct sample sample = {.bias = bias[i], .com = {i, 0}};
        state_remember(&history, &sample);
    }
    struct diagnostics_fish to;
    diagnostics_period(&fish, &history, 0.1, &to);
    return to.bias_reversals;
}

// a hundredth of the limit, in either direction; small moves back count once they add up to that
TEST(a_bias_reverses_where_it_moves_back_by_a_hundredth_of_the_limit) {
    for (int sign = -1; sign <= 1; sign += 2) {
        const double small = 0.0199 * sign, large = 0.0201 * sign;
        NEAR(reversals(7, (double[]){0, small, 0, small, 0, small, 0}, 2), 0, 0, 0);
        NEAR(reversals(7, (double[]){0, large, 0, large, 0, large, 0}, 2), 5, 0, 0);
        NEAR(reversals(7, (double[]){0, large, 3 * large, 3 * large, 5 * large, 6 * large, 7 * large}, 2), 0, 0, 0);
        NEAR(reversals(6, (double[]){0, 4 * large, 4 * large - small, 5 * large, 5 * large, 6 * large}, 2), 0, 0, 0);
        NEAR(reversals(6, (double[]){0, 4 * large, 4 * large - small / 2, 4 * large - small, 3 * large - small, 0}, 2),
             1, 0, 0);
        NEAR(reversals(4, (double[]){5, 5 + large, 5, 5 + large}, 2), 2, 0, 0);
    }
}

TEST(mean_heading_is_the_trapezoidal_mean) {
    struct sample samples[6];
    struct history history = {.capacity = 5, .n_slots = 6, .last = -1, .sample = samples};
    const double headings[] = {9, 9, 1, 2, 4, 8, 5};
    for (int i = 0; i < 7; i++) {
        const struct sample sample = {.heading = headings[i]};
        state_remember(&history, &sample);
        if (i == 0) NEAR(diagnostics_mean_heading(&history), 9, 0, 0);
    }
    NEAR(diagnostics_mean_heading(&history), (0.5 + 2 + 4 + 8 + 2.5) / 4, 1e-15, 0);
}

TEST(separation_is_the_part_of_the_period_above_the_limit) {
    struct setup setup = setup_of(SMALL "fish: [{}]\n");
    struct fish fish = *setup.school->fish;
    fish.suction_limit = 0.5;
    struct sample samples[6];
    struct history history = {.capacity = 5, .n_slots = 6, .last = -1, .sample = samples};
    struct diagnostics_fish of = {.com_velocity = {1, 2}};
    state_remember(&history, &(struct sample){.leading_edge = -1, .stream = {0.25, 1}});
    diagnostics_period(&fish, &history, 0.1, &of);
    NEAR(of.separation_share, 1, 0, 0);
    // of a single sample the speeds at this time
    NEAR(of.ground_speed, hypot(1, 2), 1e-15, 0);
    NEAR(of.speed, hypot(0.75, 1), 1e-15, 0);
    for (int k = 1; k < 5; k++) state_remember(&history, &(struct sample){.leading_edge = k == 4 ? 0.4 : 0.6});
    diagnostics_period(&fish, &history, 0.1, &of);
    NEAR(of.separation_share, 3.5 / 4, 1e-15, 0);
}

/* Means of a force over five samples of a free fish that swims at the speed 1 towards -x: by the trapezoidal rule a
 * constant force is its own mean, and so is the middle of a force that grows at a constant rate. */
TEST(mean_forces_are_exact_for_forces_that_grow_evenly) {
    struct setup setup = setup_of(SMALL "fish: [{}]\n");
    for (int i = 0; i < 2; i++) {
        struct sample samples[6];
        struct history history = {.capacity = 5, .n_slots = 6, .last = -1, .sample = samples};
        for (int k = 0; k < 5; k++) {
            const struct sample sample = {.com = {-0.1 * k, 0},
                                          .force = {-3 - i * k, 7},
                                          .friction = {2 + i * k, 5},
                                          .work = {[WORK_FLUID] = -0.1 * k}};
            state_remember(&history, &sample);
        }
        struct diagnostics_fish of = {0};
        diagnostics_period(setup.school->fish, &history, 0.1, &of);
        NEAR(of.speed, 1, 1e-14, 0);
        NEAR(of.mean_thrust, -(-3 - 2 * i), 1e-13, 0);
        // friction times the distance 0.4 over the work 0.4 on the water
        NEAR(of.efficiency, 2 + 2 * i, 1e-13, 0);
        NEAR(of.towed_efficiency, drag_towed(setup.school->fish, 1), 0, 1e-13);
    }
}

TEST(course_is_the_direction_of_the_way_in_the_last_period) {
    struct sample sample[3] = {
        {.com = {1, 0}, .velocity = {0.2, 0.1}}, {.com = {5, 5}}, {.com = {-1, 2}, .velocity = {0.5, 0}}};
    struct history history = {.capacity = 3, .n = 2, .last = 1, .sample = sample};
    double course, rate, speed;
    // no course in the first period, nor without a period
    assert_false(diagnostics_course(&history, false, 0.1, &course, &rate, &speed));
    const struct history none = {.capacity = 1, .n = 1, .sample = sample};
    assert_false(diagnostics_course(&none, false, 0.1, &course, &rate, &speed));
    history.n = 3;
    history.last = 2;
    assert_true(diagnostics_course(&history, false, 0.1, &course, &rate, &speed));
    NEAR(speed, sqrt(8) / 0.2, 0, 1e-14);
    NEAR(course, acos(-1) * 3 / 4, 1e-15, 0);
    // (-2, 2) x (0.3, -0.1)/8
    NEAR(rate, (-2 * -0.1 - 2 * 0.3) / 8, 1e-16, 1e-14);
    // without displacement
    sample[2] = sample[0];
    assert_true(diagnostics_course(&history, false, 0.1, &course, &rate, &speed));
    NEAR(speed, 0, 0, 0);
    NEAR(rate, 0, 0, 0);
}

TEST(course_through_the_water_leaves_the_drift_out) {
    struct sample sample[3] = {{.velocity = {0.2, 0.1}, .stream = {0.1, 0}},
                               {.com = {5, 5}},
                               {.com = {-1, 2}, .velocity = {0.5, 0}, .stream = {0.2, 0.3}, .drifted = {1, 4}}};
    const struct history history = {.capacity = 3, .n = 3, .last = 2, .sample = sample};
    double course, rate, speed;
    assert_true(diagnostics_course(&history, true, 0.1, &course, &rate, &speed));
    NEAR(speed, sqrt(8) / 0.2, 0, 1e-14);
    NEAR(course, -acos(-1) * 3 / 4, 1e-15, 0);
    // (-2, -2) x (0.2, -0.4)/8
    NEAR(rate, (-2 * -0.4 - -2 * 0.2) / 8, 1e-16, 1e-14);
}

TEST(the_leader_is_seen_in_the_mean_over_the_last_period) {
    struct sample sample[4] = {{.leader = {7, 7}},
                               {.com = {1, 0}, .leader = {3, 1}, .leader_heading = 3},
                               {.com = {2, 0}, .leader = {3, 3}, .leader_heading = 3.2},
                               {.com = {0, 0}, .leader = {2, 5}, .leader_heading = 3.6}};
    const struct history history = {.capacity = 3, .n = 3, .last = 3, .sample = sample, .n_slots = 4};
    double away[2], change[2], heading;
    diagnostics_leader(&history, away, change, &heading);
    NEAR(away[0], (2 / 2.0 + 1 + 2 / 2.0) / 2, 1e-15, 0);
    NEAR(away[1], (1 / 2.0 + 3 + 5 / 2.0) / 2, 1e-15, 0);
    NEAR(change[0], 0, 1e-15, 0);
    NEAR(change[1], 4, 1e-15, 0);
    NEAR(heading, (1.5 + 3.2 + 1.8) / 2, 1e-15, 0);
}

TEST(speed_and_strouhal_number_are_those_of_a_driven_plate) {
    // an oblique heading: both coordinates of the tail count
    struct simulation *const simulation = school_simulation(
        SMALL "fish: [{start: {heading: 60}, motion: {prescribed: all, speed: 1.5, heave: 0.1, frequency: 2}}]\n");
    school_measure(simulation, 1);
    const struct diagnostics_fish *fish = &simulation->diagnostics->fish[0];
    NEAR(fish->speed, 1.5, 0, 1e-9);
    // samples every hundredth of a second, 50 in a period: parabolas through three of them miss crests by 1e-5
    NEAR(fish->strouhal, 2 * 0.2 / 1.5, 0, 2e-5);
    NEAR(fish->heading, 60, 1e-9, 0);
    const double pi = acos(-1), heave = 0.1 * 4 * pi;
    NEAR(fish->com_velocity[0], 1.5 * cos(pi / 3) - heave * sin(pi / 3), 1e-9, 0);
    NEAR(fish->com_velocity[1], 1.5 * sin(pi / 3) + heave * cos(pi / 3), 1e-9, 0);
    // heave is over at the end
    const struct fish *const body = simulation->school->fish;
    double behind = 0;
    for (int k = 0; k < body->n_nodes; k++) behind += body->mass[k] * body->arc[k] / body->total_mass;
    NEAR(fish->com[0], (1.5 - behind) * cos(pi / 3), 1e-9, 0);
    NEAR(fish->com[1], (1.5 - behind) * sin(pi / 3), 1e-9, 0);
}

// the mean over the last period does not depend on the frame: the same swim in still water and in a stream
TEST(means_are_those_of_the_way_through_the_water) {
    struct diagnostics_fish of[2];
    for (int i = 0; i < 2; i++) {
        // over ground the initial velocity of the nodes includes the stream
        struct simulation *const simulation = school_simulation_of(
            SMALL "fluid: {velocity: [%g, 0]}\nfish: [{body: {modulus: 1.0e+5}, start: {speed: %g}}]\n", 0.6 * i,
            1 - 0.6 * i);
        school_measure(simulation, 1.6);
        of[i] = simulation->diagnostics->fish[0];
    }
    NEAR(of[0].ground_speed, of[0].speed, 0, 1e-15);
    // swims to the left: the stream reduces the speed by 0.6
    BELOW(fabs(of[1].ground_speed - of[0].speed + 0.6), 0.01);
    const double still[] = {of[0].speed, of[0].strouhal, of[0].cost_of_transport, of[0].cost_of_transport_fluid,
                            of[0].cost_of_transport_body};
    const double moving[] = {of[1].speed, of[1].strouhal, of[1].cost_of_transport, of[1].cost_of_transport_fluid,
                             of[1].cost_of_transport_body};
    NEAR_ARRAY(5, moving, still, 0, 1e-4);
    NEAR(of[1].heading_error, of[0].heading_error, 0.02, 0);
}

TEST(stream_at_the_fish_is_integrated_by_trapezoids) {
    // a plate across a gust that grows from zero: at rest over ground
    struct simulation *const simulation = school_simulation(
        SMALL
        "fluid: {velocity: [0.2, 0], shear: 0.5, gust: {amplitude: 0.3, frequency: 0.4}}\n"
        "fish: [{start: {position: [0, 2], speed: 0}, motion: {prescribed: all, heave: 0, frequency: 2}}]\n");
    school_measure(simulation, 1);
    const struct diagnostics_fish *fish = &simulation->diagnostics->fish[0];
    const double omega = 0.8 * acos(-1);
    // over the last period, 0.5 s, [1.2, 0.3 sin(omega t)]
    const double across = 0.3 * (cos(omega * 0.5) - cos(omega)) / omega / 0.5;
    NEAR(fish->ground_speed, 0, 1e-15, 0);
    NEAR(fish->speed, hypot(1.2, across), 0, 1e-5);
    // the plate moves through the water against the stream
    NEAR(fish->heading_error, atan2(-across, -1.2) * 180 / acos(-1) + 180, 1e-3, 0);
}

TEST(drift_is_the_change_of_the_speed_in_a_period) {
    struct simulation *const simulation = school_simulation(SMALL "fish: [{wave: {frequency: 2}}]\n");
    double speed[2];
    for (int i = 1; i <= 3; i++) {
        school_measure(simulation, 0.5 * i);
        const struct diagnostics_fish *fish = &simulation->diagnostics->fish[0];
        if (i == 1) assert_true(isnan(fish->drift));
        if (i > 1) NEAR(fish->drift, (fish->speed - speed[0]) / fish->speed, 1e-13, 1e-12);
        speed[0] = fish->speed;
        // not before two complete periods
        school_measure(simulation, 0.5 * i + 0.49);
        if (i == 1) assert_true(isnan(fish->drift));
    }
}

TEST(cost_of_transport_is_what_fluid_and_damping_take) {
    // a muscle; a heaving plate at free speed; a pitching towed plate; a loaded plate
    const char *const fish[] = {
        "{force: reactive, added_mass: {extent: depth}, body: {modulus: 1.0e+5}}",
        "{force: pressure, pressure: {span: infinite}, wave: {amplitude: 0}, body: {profile: uniform},\n"
        "  motion: {prescribed: all, surge: free, heave: 0.05, frequency: 1}}",
        "{force: pressure, pressure: {span: infinite}, wave: {amplitude: 0}, body: {modulus: 1.0e+5},\n"
        "  motion: {prescribed: head, speed: 0.8, pitch: 10, frequency: 1}}",
        "{force: reactive, load: {tip: [0.2, 0]}}"};
    for (size_t i = 0; i < sizeof fish / sizeof *fish; i++) {
        struct simulation *const simulation =
            school_simulation_of(TIME "solver: {rtol: 1.0e-6}\nfish: [%s]\n", fish[i]);
        double energy[2], audit[2];
        for (int k = 0; k < 2; k++) {
            school_measure(simulation, 1 + k);
            energy[k] = total_energy(&simulation->diagnostics->fish[0]);
            audit[k] = simulation->diagnostics->fish[0].energy_balance;
        }
        const struct diagnostics_fish *of = &simulation->diagnostics->fish[0];
        const double scale = simulation->school->fish[0].total_mass * of->speed;
        NEAR(of->mean_actuation_power, i == 0 || i == 3 ? of->cost_of_transport * scale : 0, 1e-12,
             i == 3 ? 0.05 : 1e-9);
        // the rest of the supplied work is in the body
        const double kept = of->cost_of_transport - of->cost_of_transport_fluid - of->cost_of_transport_body;
        NEAR(kept * scale, energy[1] - energy[0] - (audit[1] - audit[0]), 1e-9, 1e-9);
        ABOVE(of->cost_of_transport, 0);
        ABOVE(of->cost_of_transport_fluid, 0);
        if (i != 1) ABOVE(of->cost_of_transport_body, 1e-6);
    }
}

TEST(cost_of_transport_of_a_towed_plate_is_the_same_in_a_stream) {
    double cost[2];
    for (int i = 0; i < 2; i++) {
        struct simulation *const simulation = school_simulation_of(
            TIME
            "fluid: {velocity: [%d, 0]}\n"
            "fish: [{force: pressure, pressure: {span: infinite}, wave: {amplitude: 0}, body: {profile: uniform},\n"
            "  motion: {prescribed: all, speed: %d, heave: 0.05, frequency: 1}}]\n",
            i, 1 - i);
        school_measure(simulation, 1);
        cost[i] = simulation->diagnostics->fish[0].cost_of_transport;
    }
    NEAR(cost[1], cost[0], 0, 1e-6);
    ABOVE(cost[0], 0);
}

TEST(thrust_and_power_of_a_held_plate_are_means_over_the_last_period) {
    enum { N = 100 };
    struct simulation *const simulation = school_simulation(
        "time: {end: 2, shedding_interval: 0.01}\nfluid: {density: 2, viscosity: 1.0e-5}\n"
        "fish: [{pressure: {span: infinite}, wave: {amplitude: 0}, start: {speed: 1},\n"
        "  body: {profile: uniform}, motion: {prescribed: all, heave: 0.05, frequency: 1}}]\n");
    const struct diagnostics_fish *of = simulation->diagnostics->fish;
    double thrust = 0, power = 0, edge = 0;
    for (int i = 0; i <= N; i++) {
        school_measure(simulation, 0.5 + i * 0.01);
        const double part = (i == 0 || i == N ? 0.5 : 1) / N, *const v = simulation->state->y;
        double force[2];
        for (int k = 0; k < 2; k++)
            force[k] = of->pressure.pressure[k] + of->pressure.suction[k] + of->resistive_force[k];
        thrust -= part * force[0];
        power -= part * force[1] * v[simulation->school->fish[0].at.vy];
        edge = fmax(edge, fabs(of->pressure.leading_edge_a0));
    }
    // the samples have the flow of the last iterate of a step, exact to the tolerance of Newton's iteration
    NEAR(of->mean_thrust, thrust, 0, 1e-7);
    // works are integrated over steps, the power here over events: 1.1e-3, of second order in the interval
    NEAR(of->mean_power, power, 0, 2e-3);
    NEAR(of->efficiency, of->mean_thrust * 1 / of->mean_power, 0, 1e-6);
    NEAR(of->leading_edge_most, edge, 0, 1e-4);
    ABOVE(thrust, 0);
    ABOVE(power, thrust);
}

// thrust of a held body: against the stream where its centre of mass is
TEST(thrust_of_a_held_body_is_along_the_stream_at_the_body) {
    struct simulation *const simulation =
        school_simulation(SMALL
                          "fluid: {velocity: [0.5, 0.2], shear: 0.3}\n"
                          "fish: [{start: {position: [0, 2], speed: 0}, motion: {prescribed: all, speed: 0}}]\n");
    school_measure(simulation, 0.1);
    const struct diagnostics_fish *const now = &simulation->diagnostics->fish[0];
    const double stream[] = {0.5 + 0.3 * now->com[1], 0.2};
    double force[2];
    diagnostics_fluid_force(now->resistive_force, now->reactive_force, &now->pressure, force);
    const double drag = (force[0] * stream[0] + force[1] * stream[1]) / hypot(stream[0], stream[1]);
    ABOVE(drag, 0);
    NEAR(now->thrust, -drag, 0, 1e-12);
}

/* A plate with damping and a muscle: the drive pays for both, and the power is the same in a stream. */
TEST(power_of_a_held_plate_is_the_work_of_muscle_and_drive) {
    double power[2];
    for (int i = 0; i < 2; i++) {
        struct simulation *const simulation = school_simulation_of(
            "time: {end: 4, shedding_interval: 0.02}\nfluid: {density: 1, velocity: [%d, 0]}\n"
            "fish: [{force: pressure, pressure: {span: infinite}, nodes: 13, wave: {amplitude: 0.1}, body: "
            "{profile: uniform, thickness: 0.05,\n  depth: 1, density: 25, modulus: 8.0e+5, relaxation_time: 0.02},\n"
            "  motion: {prescribed: head, speed: %d, heave: 0.05, frequency: 1}}]\n",
            i, 1 - i);
        school_run(simulation, 3);
        const double *const work = simulation->state->balance[0].work;
        double before[N_WORKS], of[N_WORKS];
        memcpy(before, work, sizeof before);
        school_measure(simulation, 4);
        for (int w = 0; w < N_WORKS; w++) of[w] = work[w] - before[w];

        const struct diagnostics_fish *const fish = simulation->diagnostics->fish;
        power[i] = fish->mean_power;
        NEAR(power[i], of[WORK_ACTUATION] + of[WORK_DRIVING_ON_WATER] + fish->mean_thrust * fish->speed, 0, 1e-9);
        NEAR(fish->efficiency, fish->mean_thrust * fish->speed / power[i], 0, 1e-12);
        // a beat that repeats: the power goes into fluid, thrust and damping, by 4 % of it from beat to beat
        NEAR(power[i], -of[WORK_FLUID] - of[WORK_DAMPING] + fish->mean_thrust * fish->speed, 0, 0.04);
        ABOVE(-of[WORK_DAMPING], 0.02 * power[i]);
        ABOVE(of[WORK_ACTUATION], 0.02 * power[i]);
    }
    NEAR(power[1], power[0], 0, 1e-4);
}

TEST(forces_by_name_make_up_momentum_and_angular_momentum) {
    const char *const texts[] = {SMALL
                                 "fluid: {velocity: [0.3, 0.1], shear: 0.4, gust: {amplitude: 0.3, frequency: 1}}\n"
                                 "fish: [{force: reactive}, {force: reactive, start: {position: [0.2, 0.6]}}]\n",
                                 SMALL
                                 "fish: [{force: reactive, body: {modulus: 1.0e+5}, wave: {amplitude: 0}, motion: "
                                 "{prescribed: head, heave: 0.1,\n"
                                 "        pitch: 10, frequency: 1}}, {force: reactive, start: {position: [0, 1]}, "
                                 "motion: {prescribed: all, pitch: 20, "
                                 "frequency: 2}}]\n"};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        struct simulation *const simulation = school_simulation(texts[i]);
        school_measure(simulation, 0.53);
        for (int f = 0; f < 2; f++) {
            const struct fish *fish = &simulation->school->fish[f];
            const struct diagnostics_fish *of = &simulation->diagnostics->fish[f];
            const double *const y = simulation->state->y;
            double rate[3] = {0, 0, 0};
            for (int k = 0; k < fish->n_nodes; k++) {
                const double ax = fish->mass[k] * y[fish->at.ax + k], ay = fish->mass[k] * y[fish->at.ay + k];
                rate[0] += ax;
                rate[1] += ay;
                rate[2] += (y[fish->at.x + k] - of->com[0]) * ay - (y[fish->at.y + k] - of->com[1]) * ax;
            }
            double fluid[2];
            diagnostics_fluid_force(of->resistive_force, of->reactive_force, &of->pressure, fluid);
            const double forces[] = {fluid[0] + of->constraint_force[0], fluid[1] + of->constraint_force[1],
                                     of->resistive_moment + of->reactive_moment + of->pressure.pressure_moment +
                                         of->pressure.suction_moment + of->constraint_moment};
            // tolerance: residual of the equation of motion after the Newton iteration
            NEAR_ARRAY(3, forces, rate, 2e-3, 1e-4);
            ABOVE(fabs(rate[2]), 0.01);
            // prescribed motion travels along its first heading, not along the pitching one
            const double heading = i == 0 ? of->heading * acos(-1) / 180 : fish->start_heading;
            NEAR(of->thrust, cos(heading) * fluid[0] + sin(heading) * fluid[1], 1e-12, 1e-12);
            assert_int_equal(fabs(of->constraint_force[0]) > 0, i == 1);
        }
    }
}

/* At an event: the force of the pressure, its power, the pressure at the middle control point, suction and friction,
 * and momentum, moment and angular momentum of the body about its centre of mass. */
enum { FORCE, POWER = 2, JUMP, REST, MOMENTUM = 6, MOMENT = 8, ANGULAR, N_OF_EVENT };

static void record_events(const char *text, int n_events, double *value) {
    struct simulation *const simulation = school_simulation(text);
    const struct fish *const fish = simulation->school->fish;
    const struct diagnostics_fish *const of = simulation->diagnostics->fish;
    struct residual *const residual = simulation->residual;
    double *const y = simulation->state->y, *const yp = simulation->state->yp;
    for (int n = 0; n < n_events; n++, value += N_OF_EVENT) {
        school_ok(simulate_step(simulation));
        simulate_measure(simulation);
        // with the flow of the event, not of the last iterate of the step
        struct diagnostics_fish again = *of;
        school_ok(residual_evaluate(residual, &residual_run, simulation->state->t, y, yp, residual->scratch));
        diagnostics_forces(residual, 0, simulation->state->t, y, &again);
        NEAR(of->friction_force[1], again.friction_force[1], 0, 0);
        NEAR(of->pressure.pressure[1], again.pressure.pressure[1], 0, 0);
        for (int i = 0; i < 2; i++) {
            value[FORCE + i] = of->pressure.pressure[i];
            value[REST + i] = of->pressure.suction[i] + of->resistive_force[i];
            value[MOMENTUM + i] = fish->total_mass * of->com_velocity[i];
        }
        value[MOMENT] = of->pressure.pressure_moment + of->pressure.suction_moment + of->resistive_moment;
        value[ANGULAR] = 0;
        for (int k = 0; k < fish->n_nodes; k++) {
            value[ANGULAR] += fish->mass[k] * ((y[fish->at.x + k] - of->com[0]) * y[fish->at.vy + k] -
                                               (y[fish->at.y + k] - of->com[1]) * y[fish->at.vx + k]);
        }
        value[POWER] = of->pressure.pressure_power;
        value[JUMP] = pressure_jump(residual->force[0].pressure, fish->n_control / 2, y, yp);
    }
}

// largest difference of a value over the events from the tenth on, and the largest value
static double largest_difference(int i, int n_events, const double *value, const double *want, double *largest) {
    double difference = 0;
    *largest = 0;
    for (int n = 10; n < n_events; n++) {
        difference = fmax(difference, fabs(value[n * N_OF_EVENT + i] - want[n * N_OF_EVENT + i]));
        *largest = fmax(*largest, fabs(want[n * N_OF_EVENT + i]));
    }
    return difference;
}

// errors relative to the largest value; with the slope at the end of an interval 1.5 %
TEST(pressure_at_events_has_the_accuracy_of_the_motion) {
    enum { N = 100 };
    static const char *const fish[] = {
        "time: {end: 1, shedding_interval: 0.01}\nfish: [{drag: {normal: 0}}]\n",
        "time: {end: 1, shedding_interval: 0.01}\nfish: [{nodes: 9, body: {modulus: 1.0e+5}}]\n"};
    // the trapezoidal rule does not damp the vibrations of the body; dormand_prince: 2e-5, and 7e-4 if the first stage
    // after an event takes the rates of the last stage before it
    static const struct {
        int fish;
        const char *solver;
        double tolerance;
    } runs[] = {{0, "{rtol: 5.0e-6}", 1e-3},
                {1, "{method: dormand_prince, rtol: 1.0e-6}", 1e-4},
                {1, "{method: trapezoid, step: 0.00125}", 3e-3}};
    static double value[N * N_OF_EVENT], want[N * N_OF_EVENT];

    for (size_t r = 0; r < sizeof runs / sizeof *runs; r++) {
        char text[512];
        if (r < 2) {
            snprintf(text, sizeof text, "%ssolver: {rtol: 1.0e-9, order: 5}\n", fish[runs[r].fish]);
            record_events(text, N, want);
        }

        snprintf(text, sizeof text, *runs[r].solver ? "%ssolver: %s\n" : "%s", fish[runs[r].fish], runs[r].solver);
        record_events(text, N, value);
        for (int i = FORCE; i < MOMENTUM; i++) {
            double largest;
            const double difference = largest_difference(i, N, value, want, &largest);
            NEAR(difference / largest, 0, runs[r].tolerance, 0);
        }
    }
}

// 0.2 % of the largest force, 7.9 N; central differences over five events, which use no rate
TEST(force_at_events_is_the_rate_of_the_momentum) {
    enum { N = 100 };
    static double value[N * N_OF_EVENT];
    record_events("time: {end: 1, shedding_interval: 0.01}\nfish: [{}]\n", N, value);
    for (int n = 10; n < N - 2; n++) {
        const double *const m = value + n * N_OF_EVENT + MOMENTUM;
        double rate[4];
        for (int i = 0; i <= ANGULAR - MOMENTUM; i++) {
            rate[i] =
                (m[i - 2 * N_OF_EVENT] - 8 * m[i - N_OF_EVENT] + 8 * m[i + N_OF_EVENT] - m[i + 2 * N_OF_EVENT]) / 0.12;
        }
        for (int i = 0; i < 2; i++) {
            NEAR(value[n * N_OF_EVENT + FORCE + i] + value[n * N_OF_EVENT + REST + i], rate[i], 0.015, 0);
        }
        NEAR(value[n * N_OF_EVENT + MOMENT], rate[ANGULAR - MOMENTUM], 0.01, 0);
    }
}

TEST(moments_follow_the_origin) {
    // M(a) = M(0) - a x F
    struct simulation *const simulation = school_simulation(TIME "fish: [{}]\n");
    school_measure(simulation, 0.8);
    const struct pressure *const pressure = simulation->residual->force[0].pressure;
    const double a[2] = {3, -2}, *const y = simulation->state->y;
    const struct pressure_forces at_zero = pressure_sum(pressure, (const double[]){0, 0}, y);
    const struct pressure_forces at_a = pressure_sum(pressure, a, y);
    const double change[] = {at_zero.pressure_moment - at_a.pressure_moment,
                             at_zero.suction_moment - at_a.suction_moment,
                             at_zero.momentum_moment - at_a.momentum_moment};
    const double *const force[] = {at_a.pressure, at_a.suction, at_a.momentum};
    for (int i = 0; i < 3; i++) NEAR(change[i], a[0] * force[i][1] - a[1] * force[i][0], 1e-12, 1e-10);
    ABOVE(fabs(change[1]), 1e-6);
}

TEST(vortices_inside_an_outline_are_counted) {
    struct setup setup;
    // two straight bodies of 0.1 m thickness from x = 0 to 1
    school_build(&setup, TIME
                 "wake: {shedding: continuous, taper: 0, taper_beside: 0}\ndefaults: {fish: {nodes: 7, wave: "
                 "{amplitude: 0}, body: "
                 "{profile: uniform, thickness: 0.1}}}\nfish: [{}, {start: {position: [0, 1]}}]\n");
    // the fourth: beside the round nose, but in the box of the body
    const double place[][2] = {{0.5, 0.049}, {0.5, 0.051}, {0.9, -0.049}, {-0.045, 0.045},
                               {-0.049, 0},  {-0.051, 0},  {0.2, 1}};
    struct wake *const wake = &setup.state->wake[1];
    for (size_t i = 0; i < sizeof place / sizeof *place; i++) wake_release(wake, place[i][0], place[i][1], 0.1, 0);
    diagnostics_start(setup.residual, setup.state);
    diagnostics_remember(setup.residual, setup.state);
    struct diagnostics *const diagnostics = diagnostics_create(test_arena(), setup.school);
    diagnostics_event(setup.residual, setup.state, diagnostics);
    NEAR(diagnostics->fish[0].swept_vortices, 3, 0, 0);
    // the newest own marker lies at the tail
    NEAR(diagnostics->fish[1].swept_vortices, 0, 0, 0);
}

TEST(a_body_that_sweeps_over_a_wake_loses_no_circulation) {
    // a prescribed plate crosses the wake of another plate
    struct simulation *const simulation = school_simulation(
        "time: {end: 1, shedding_interval: 0.02}\nwake: {shedding: sheet}\n"
        "defaults: {fish: {nodes: 7, wave: {amplitude: 0}, body: {profile: uniform, thickness: 0.1}}}\n"
        "fish: [{motion: {prescribed: all, speed: 2, heave: 0.1, frequency: 2}}, {start: {position: [0.5, -1.2], "
        "heading: 90}, motion: {prescribed: all, speed: 3}}]\n");
    double most = 0;
    while (simulation->state->t < 0.6) {
        school_ok(simulate_step(simulation));
        simulate_measure(simulation);
        most = fmax(most, simulation->diagnostics->fish[1].swept_vortices);
        NEAR(simulation->diagnostics->total_circulation, 0, 1e-11, 0);
    }
    AT_LEAST(most, 1);
}

TEST(heading_is_unwrapped) {
    struct setup setup = setup_of(SMALL "fish: [{start: {heading: 170}}]\n");
    const struct fish *fish = setup.school->fish;
    // turned round in steps of 50 degrees, two and a half times
    for (int i = 0; i < 19; i++) {
        const double angle = (170 + 50 * i) * acos(-1) / 180;
        for (int k = 0; k < fish->n_nodes; k++) {
            setup.state->y[fish->at.x + k] = -fish->arc[k] * cos(angle);
            setup.state->y[fish->at.y + k] = -fish->arc[k] * sin(angle);
        }
        diagnostics_remember(setup.residual, setup.state);
        NEAR(state_recall(&setup.state->history[0], 0)->heading, angle, 1e-12, 0);
    }
}

TEST(the_desired_heading_is_unwrapped_next_to_the_heading) {
    const double desired[] = {160, -150, 100}, want[] = {160, 210, 100};
    for (int i = 0; i < 3; i++) {
        struct simulation *const simulation = school_simulation_of(
            SMALL "fish: [{start: {heading: 170}, control: {law: heading, desired_heading: %g}}]\n", desired[i]);
        simulate_measure(simulation);
        NEAR(simulation->diagnostics->fish->heading, 170, 1e-10, 0);
        NEAR(simulation->diagnostics->fish->desired_heading, want[i], 1e-10, 0);
    }
}

TEST(polarisation_and_least_distance_are_those_of_the_school) {
    struct simulation *simulation =
        school_simulation(TIME
                          "defaults: {fish: {nodes: 7, body: {profile: uniform, thickness: 0.1}}}\n"
                          "fish: [{}, {start: {position: [0, 1]}}, {start: {position: [3, 0], heading: 90}}]\n");
    simulate_measure(simulation);
    // headings 180, 180, 90: (2, 1)/3
    NEAR(simulation->diagnostics->polarisation, sqrt(5) / 3, 1e-12, 0);
    NEAR(simulation->diagnostics->least_distance, 0.9, 1e-12, 0);
    simulation = school_simulation(SMALL "fish: [{}]\n");
    simulate_measure(simulation);
    NEAR(simulation->diagnostics->polarisation, 1, 1e-15, 0);
    assert_true(isnan(simulation->diagnostics->least_distance));
}

TEST(powers_on_the_water_are_seen_from_the_stream_at_the_centre_of_mass) {
    static const char *const forces[] = {"reactive", "pressure"};
    for (int i = 0; i < 2; i++) {
        struct simulation *const simulation = school_simulation_of(
            "time: {end: 1, shedding_interval: 0.02}\nfluid: {velocity: [0.5, 0.2], shear: 0.3}\n"
            "fish: [{force: %s, load: {tip: [3, 4]}, start: {position: [0, 2], speed: 1}}]\n",
            forces[i]);
        school_measure(simulation, 0.1);
        const struct fish *const fish = simulation->school->fish;
        const double *const y = simulation->state->y;
        const struct diagnostics_power power = diagnostics_power(simulation->residual, 0, simulation->state->t, y);
        const double stream[] = {0.5 + 0.3 * fish_mass_mean(fish, y + fish->at.y), 0.2};
        const int tail = fish->n_nodes - 1;
        NEAR(power.driving, 3 * y[fish->at.vx + tail] + 4 * y[fish->at.vy + tail], 1e-12, 1e-12);
        NEAR(power.driving_on_water, power.driving - 3 * stream[0] - 4 * stream[1], 1e-12, 1e-12);
        const struct diagnostics_fish *const now = &simulation->diagnostics->fish[0];
        double force[2];
        diagnostics_fluid_force(now->resistive_force, now->reactive_force, &now->pressure, force);
        ABOVE(fabs(force[0]), 0.1);
        ABOVE(fabs(force[1]), 0.1);
        const double all = power.drag + power.added_mass + power.wake + power.pressure + power.suction;
        NEAR(power.on_water, all - force[0] * stream[0] - force[1] * stream[1], 1e-9, 1e-9);
    }
}

TEST(powers_on_the_water_are_those_of_a_towed_body) {
    double want[2];
    for (int is_held = 0; is_held < 2; is_held++) {
        const double heading = 137 * acos(-1) / 180, speed = 0.8;
        struct simulation *const simulation = school_simulation_of(
            "time: {end: 1, shedding_interval: 0.02}\nsolver: {rtol: 1e-8}\nfluid: {velocity: [%.17g, %.17g]}\n"
            "fish: [{nodes: 7, start: {heading: 137, speed: %g}, motion: {prescribed: head, heave: "
            "0.1, frequency: 1, speed: %g}}]\n",
            is_held * -speed * cos(heading), is_held * -speed * sin(heading), speed * !is_held, speed * !is_held);
        school_measure(simulation, 0.2);
        const struct diagnostics_power power =
            diagnostics_power(simulation->residual, 0, simulation->state->t, simulation->state->y);
        if (!is_held) want[0] = power.on_water, want[1] = power.driving_on_water;
        NEAR(power.on_water, want[0], 0, 1e-5);
        NEAR(power.driving_on_water, want[1], 0, 1e-5);
    }
}

TEST(balances_that_begin_again_are_closed) {
    struct simulation *const simulation = school_simulation(
        "time: {end: 1, shedding_interval: 0.02}\ndefaults: {fish: {force: pressure, pressure: {span: infinite}}}\n"
        "fish: [{}, {start: {position: [0, 2]}}]\n");
    school_run(simulation, 0.1);
    struct state *const now = simulation->state;
    double work[2];
    now->has_crossed = true;
    for (int f = 0; f < 2; f++) {
        work[f] = now->balance[f].work[WORK_ALL] += 3 + f;
        now->balance[f].initial_energy += 1;
    }
    diagnostics_restart(simulation->residual, now);
    simulate_measure(simulation);
    for (int f = 0; f < 2; f++) {
        // the works go on
        NEAR(now->balance[f].work[WORK_ALL], work[f], 0, 0);
        NEAR(simulation->diagnostics->fish[f].energy_balance, 0, 1e-12, 0);
    }
    NEAR(simulation->diagnostics->momentum_balance[0], 0, 1e-12, 0);
    assert_false(now->has_crossed);
}
