/* test_diagnostics_momentum.c: Tests the impulse of the fluid, and that the balance of momentum closes with every
 * external force (doc/model.md, section 13). */
#include <stdio.h>

#include "run/event.h"
#include "run/simulate.h"
#include "school.h"
#include "school/diagnostics_energy.h"
#include "school/diagnostics_momentum.h"

#define TIME "time: {end: 2, shedding_interval: 0.02, output_interval: 0.02}\n"
#define SWIMMER \
    "force: pressure, nodes: 9, sheet_points: 33, wave: {ramp: 0.5}, drag: {skin: laminar}, start: {speed: 0.5}, "
#define FISH SWIMMER "pressure: {span: infinite}, body: {depth: 1}"
#define STRIP SWIMMER "pressure: {span: finite}, body: {depth: 0.25}"

/* The momentum balance after some time over the largest term; the largest angular balance. */
struct balance {
    double momentum, angular;
};

static int largest[2];  // events at which the momentum of the bodies, or of the fluid, is the largest term

static struct balance run(const char *text, double end) {
    struct simulation *const simulation = school_simulation(text);
    struct balance worst = {0, 0};
    double size = 0;
    while (simulation->state->t < end - 1e-9) {
        school_ok(simulate_step(simulation));
        simulate_measure(simulation);
        const struct diagnostics *const now = simulation->diagnostics;
        worst.momentum = fmax(worst.momentum, hypot(now->momentum_balance[0], now->momentum_balance[1]));
        worst.angular = fmax(worst.angular, fabs(now->momentum_balance[2]));
        size = fmax(size, now->momentum_size);
        AT_MOST(now->momentum_balance[0], size);

        // the size of the balance is its largest term, summed over the fish
        double body = 0, fluid = 0, external = 0;
        for (int f = 0; f < simulation->school->n_fish; f++) {
            const struct fish *const fish = &simulation->school->fish[f];
            const struct diagnostics_fish *const of = &now->fish[f];
            const double *const first = simulation->state->momentum[f].first_fluid;
            body += fish->total_mass * hypot(of->com_velocity[0], of->com_velocity[1]);
            fluid += hypot(of->fluid_impulse[0] - of->lost_impulse[0] - first[0],
                           of->fluid_impulse[1] - of->lost_impulse[1] - first[1]);
            external += hypot(of->external_impulse[0], of->external_impulse[1]);
        }
        NEAR(now->momentum_size, fmax(body, fmax(fluid, external)), 0, 1e-12);
        largest[0] += body > fmax(fluid, external);
        largest[1] += fluid > fmax(body, external);
    }
    worst.momentum /= size;
    worst.angular /= size;
    return worst;
}

/* Every force and every loss of circulation; the error is the discretisation error in the interval. */
TEST(the_balance_is_closed_with_every_external_force) {
    static const struct {
        const char *name, *text;
    } cases[] = {
        {"one fish", "wake: {lifetime: 0.8, decay: 0.6}\nfish: [{" FISH "}]\n"},
        {"no decay", "wake: {lifetime: 0.5, decay: 0}\nfish: [{" FISH "}]\n"},
        {"dropped", "wake: {lifetime: 0.5, removed_circulation: dropped}\nfish: [{" FISH "}]\n"},
        {"shear and gust",
         "fluid: {velocity: [0.2, 0], shear: 0.3, gust: {amplitude: 0.1, frequency: 1}}\n"
         "wake: {lifetime: 0.8, decay: 0.6}\nfish: [{" FISH "}]\n"},
        {"a sine gust",
         "fluid: {velocity: [0.2, 0], gust: {profile: sine, amplitude: 0.1, wavelength: 0.7}}\n"
         "wake: {lifetime: 0.8, decay: 0.6}\nfish: [{" FISH "}]\n"},
        {"finite span, a step gust",
         "fluid: {velocity: [0.2, 0], shear: 0.3, gust: {profile: step, amplitude: 0.1, position: 0, "
         "gradient_distance: 0.2}}\nwake: {lifetime: 0.8, decay: 0.6}\nfish: [{" STRIP "}]\n"},
        {"a wall", "fluid: {walls: [-0.3]}\nwake: {lifetime: 0.8, decay: 0.6}\nfish: [{" FISH "}]\n"},
        {"a channel, two lengths",
         "fluid: {walls: [-0.4, 0.8]}\nwake: {lifetime: 0.8, decay: 0.6}\n"
         "fish: [{" FISH "}, {force: pressure, pressure: {span: infinite}, nodes: 9, sheet_points: 33, length: 0.5, "
         "drag: {skin: laminar}, start: {position: [0.5, 0.4], speed: 0.5}, body: {depth: 2}}]\n"},
        {"a load at the tail", "fish: [{" FISH ", load: {tip: [2, -1]}}]\n"},
        {"a prescribed head",
         "fish: [{force: pressure, pressure: {span: infinite}, nodes: 9, sheet_points: 33, wave: {amplitude: 0}, "
         "body: {depth: 1, modulus: 1.0e+5}, drag: {skin: laminar}, start: {speed: 1}, "
         "motion: {prescribed: head, heave: 0.02, pitch: 3, frequency: 1, phase: 90}}]\n"},
        {"separation at the nose, half of the suction",
         "fish: [{" SWIMMER "body: {depth: 1}, pressure: {span: infinite, suction: 0.5, suction_limit: 0.01}}]\n"},
        {"dropped markers",
         "wake: {lifetime: 3}\n"
         "fish: [{force: pressure, pressure: {span: infinite}, nodes: 9, sheet_points: 33, wave: {amplitude: 0}, "
         "body: {depth: 1, profile: uniform, thickness: 0.1}, drag: {skin: laminar}, "
         "start: {speed: 4}, motion: {prescribed: all, heave: 0.02, frequency: 1, phase: 90}}]\n"},
        {"a plate that surges",
         "fish: [{force: pressure, pressure: {span: infinite}, nodes: 9, sheet_points: 33, wave: {amplitude: 0}, body: "
         "{depth: 1, profile: uniform, thickness: 0.1}, drag: {skin: laminar}, start: {speed: 1}, motion: {prescribed: "
         "all, surge: free, heave: 0.02, frequency: 1, phase: 90}}]\n"},
        {"finite span", "wake: {lifetime: 0.8, decay: 0.6}\nfish: [{" STRIP "}]\n"},
        {"finite span, no fade", "wake: {lifetime: 0.5, decay: 0}\nfish: [{" STRIP "}]\n"},
        {"finite span, dropped markers", "wake: {lifetime: 10}\nfish: [{" STRIP "}]\n"},
        {"finite span, shear and gust",
         "fluid: {velocity: [0.2, 0], shear: 0.3, gust: {amplitude: 0.1, frequency: 1}}\n"
         "wake: {lifetime: 0.8, decay: 0.6}\nfish: [{" STRIP "}]\n"},
        {"finite span, a wall, two lengths and depths",
         "fluid: {walls: [-0.3]}\nwake: {lifetime: 0.8, decay: 0.6}\n"
         "fish: [{" STRIP "}, {force: pressure, pressure: {span: finite}, nodes: 9, sheet_points: 33, length: 0.5, "
         "drag: {skin: laminar}, start: {position: [0.5, 0.4], speed: 0.5}, body: {depth: 0.4}}]\n"},
        {"finite span, a channel, two depths",
         "fluid: {walls: [-0.3, 0.8]}\nwake: {lifetime: 0.8, decay: 0.6}\n"
         "fish: [{" STRIP "}, {force: pressure, pressure: {span: finite}, nodes: 9, sheet_points: 33, length: 0.5, "
         "drag: {skin: laminar}, start: {position: [0.5, 0.4], speed: 0.5}, body: {depth: 0.4}}]\n"},
        {"finite span, a depth for every edge",
         "fish: [{force: pressure, pressure: {span: finite}, nodes: 9, sheet_points: 65, wave: {ramp: 0.5}, drag: "
         "{skin: laminar}, start: {speed: 0.5, position: [1, -2], heading: 140}, body: {profile: table, "
         "thickness_table: [0.05, 0.1, 0.1, 0.1, 0.08, "
         "0.06, 0.04, 0.02], depth_table: [0.12, 0.2, 0.24, 0.24, 0.2, 0.16, 0.18, 0.22]}}]\n"},
        {"finite span, a plate that surges",
         "fish: [{force: pressure, pressure: {span: finite}, nodes: 9, sheet_points: 33, wave: {amplitude: 0}, "
         "body: {depth: 0.25, profile: uniform, thickness: 0.1}, drag: {skin: laminar}, start: {speed: 1}, "
         "motion: {prescribed: all, surge: free, heave: 0.02, frequency: 1, phase: 90}}]\n"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[1024];
        snprintf(text, sizeof text, TIME "%s", cases[i].text);
        const struct balance worst = run(text, 1.5);
        BELOW(worst.momentum, 5e-3);
        BELOW(worst.angular, 5e-3);
    }
    ABOVE(largest[0], 0);
    ABOVE(largest[1], 0);
}

// bodies in contact without fluid, one body with a load: rounding, and the error of the integral of the load
TEST(without_a_fluid_it_is_closed_too) {
    const struct balance worst = run(TIME
                                     "fluid: {density: 0}\nsolver: {rtol: 1.0e-7}\n"
                                     "defaults: {fish: {nodes: 9, wave: {amplitude: 0}, start: {speed: 1}}}\n"
                                     "fish: [{load: {tip: [3, 5]}, start: {position: [-0.1, 0.05], heading: 0}},\n"
                                     "       {start: {position: [0.1, -0.05], heading: 180}}]\n",
                                     0.3);
    BELOW(worst.momentum, 1e-6);
    BELOW(worst.angular, 1e-6);
}

TEST(the_rate_of_legs_is_integrated_by_the_trapezoidal_rule) {
    struct simulation *const simulation = school_simulation(TIME "wake: {lifetime: 10}\nfish: [{" STRIP "}]\n");
    const struct momentum_balance *const now = simulation->state->momentum;
    const double interval = simulation->school->interval;
    school_run(simulation, 0.2);
    double change = 0, most = 0;
    for (int n = 0; n < 10; n++) {
        const struct momentum_balance before = *now;
        school_ok(simulate_step(simulation));
        for (int i = 0; i < 3; i++) {
            NEAR(now->legs[i] - before.legs[i], interval / 2 * (before.leg_rate[i] + now->leg_rate[i]), 1e-15, 1e-12);
            // nothing has decayed or been removed yet
            NEAR(now->lost[i], 0, 0, 0);
            change = fmax(change, fabs(now->leg_rate[i] - before.leg_rate[i]));
            most = fmax(most, fabs(now->leg_rate[i]));
        }
    }
    ABOVE(most, 0);
    ABOVE(change, 0.01 * most);
}

// doc/model.md, section 18: between fish R is 1e-2 of the exchange
TEST(legs_of_other_fish_are_booked) {
    const struct balance worst = run(
        TIME
        "wake: {lifetime: 3, decay: 2}\nsolver: {rtol: 1e-5}\n"
        "defaults: {fish: {force: pressure, pressure: {span: finite}, nodes: 9, sheet_points: 33, wave: {ramp: 0.5},\n"
        "                  drag: {skin: laminar}, body: {thickness: 0.2, depth: 0.25}, start: {speed: 0.5}}}\n"
        "fish: [{}, {start: {position: [0, 0.4]}, wave: {phase: 180}}]\n",
        2);
    BELOW(worst.momentum, 1e-3);
    BELOW(worst.angular, 1e-3);
}

// a wall without friction, the only external force, pushes across itself
TEST(a_wall_pushes_across_itself) {
    for (int walls = 1; walls <= 2; walls++) {
        struct simulation *const simulation = school_simulation_of(
            TIME
            "solver: {rtol: 1e-5}\nwake: {lifetime: 3, decay: 2}\nfluid: {viscosity: 0, walls: [-0.25%s]}\n"
            "defaults: {fish: {body: {thickness: 0.2, depth: 0.25}, drag: {normal: 0, skin: laminar}, pressure: {span: "
            "finite, "
            "suction_limit: 0}}}\nfish: [{nodes: 9, sheet_points: 33, start: {speed: 0.5}},\n"
            "       {nodes: 9, sheet_points: 33, start: {speed: 0.5, position: [0.4, 0.3]}}]\n",
            walls == 2 ? ", 0.6" : "");
        school_measure(simulation, 2);
        const struct diagnostics_fish *const of = simulation->diagnostics->fish;
        const double along = of[0].external_impulse[0] + of[1].external_impulse[0];
        const double across = fmax(fabs(of[0].external_impulse[1]), fabs(of[1].external_impulse[1]));
        AT_MOST(along, 1e-3 * across);
    }
}

TEST(forces_without_a_reaction_have_no_balance) {
    static const struct {
        const char *text;
        bool has_impulse, has_external, has_balance;
    } cases[] = {
        {"fish: [{force: reactive, nodes: 9, start: {speed: 1}}]\n", 1, 0, 0},
        {"preset: published\nfish: [{}]\n", 1, 0, 0},
        {"fish: [{force: pressure, pressure: {span: infinite}, nodes: 5, body: {profile: table, thickness_table: [0.1, "
         "0.2, 0.15, 0.05], depth_table: [0.2, 0.3, 0.25, 0.1]}}]\n",
         0, 0, 0},
        // two fish of different depth
        {"fish: [{" FISH "}, {force: pressure, pressure: {span: infinite}, start: {position: [0, 1]}}]\n", 1, 1, 0},
        {"fish: [{" FISH
         "}, {force: pressure, pressure: {span: infinite}, start: {position: [0, 1]}, body: {depth: 1}}]\n",
         1, 1, 1},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct simulation *const simulation = school_simulation_of(TIME "%s", cases[i].text);
        for (int n = 0; n < 3; n++) school_ok(simulate_step(simulation));
        simulate_measure(simulation);
        const struct diagnostics_fish *const of = simulation->diagnostics->fish;
        assert_int_equal(!isnan(of->fluid_impulse[0]), cases[i].has_impulse);
        assert_int_equal(!isnan(of->lost_impulse[2]), cases[i].has_impulse);
        assert_int_equal(!isnan(of->external_impulse[1]), cases[i].has_external);
        assert_int_equal(!isnan(simulation->diagnostics->momentum_balance[0]), cases[i].has_balance);
    }
}

// the same swim elsewhere, and in a stream
static void fill(const char *fluid, const char *start, struct diagnostics_fish *of, double imbalance[3]) {
    struct simulation *const simulation =
        school_simulation_of(TIME
                             "solver: {rtol: 1.0e-8}\n%swake: {lifetime: 0.5, decay: 0.3}\n"
                             "fish: [{force: pressure, pressure: {span: infinite}, nodes: 9, sheet_points: 33, wave: "
                             "{ramp: 0.5}, drag: {skin: laminar}, %s}]\n",
                             fluid, start);
    school_measure(simulation, 1.2);
    *of = *simulation->diagnostics->fish;
    for (int i = 0; i < 3; i++) imbalance[i] = simulation->diagnostics->momentum_balance[i];
}

TEST(impulses_do_not_depend_on_the_origin) {
    struct diagnostics_fish here, there;
    double imbalance[2][3];
    fill("", "start: {speed: 0.5}", &here, imbalance[0]);
    fill("", "start: {speed: 0.5, position: [1000, -500]}", &there, imbalance[1]);
    // the origin changes only the lost impulse
    ABOVE(fabs(here.lost_impulse[1] - there.lost_impulse[1]), 1);
    NEAR_ARRAY(2, there.fluid_impulse, here.fluid_impulse, 1e-6, 1e-6);
    NEAR_ARRAY(2, there.external_impulse, here.external_impulse, 1e-6, 1e-6);
    NEAR_ARRAY(2, imbalance[1], imbalance[0], 1e-6, 0);
    // the angular one is that about the other origin: L = L0 + x0 x P of bodies and fluid together, 0 for the balance
    NEAR(imbalance[1][2], imbalance[0][2] + 1000 * imbalance[0][1] + 500 * imbalance[0][0], 1e-3, 0);
}

TEST(a_stream_changes_no_balance) {
    struct diagnostics_fish still, moving;
    double imbalance[2][3];
    fill("", "start: {speed: 0.5}", &still, imbalance[0]);
    // heading 180 degrees: the fish drifts backwards over ground
    fill("fluid: {velocity: [0.9, 0]}\n", "start: {speed: -0.4}", &moving, imbalance[1]);
    ABOVE(fabs(moving.external_impulse[1] - still.external_impulse[1]), 0.1);
    // error of the integral of the force of the stream on the residual circulation
    NEAR_ARRAY(2, imbalance[1], imbalance[0], 2e-5, 0);
    ABOVE(hypot(imbalance[0][0], imbalance[0][1]), 1e-4);
}

TEST(a_restart_begins_the_balance_again) {
    struct simulation *const simulation = school_simulation(TIME "wake: {lifetime: 0.1}\nfish: [{" FISH "}]\n");
    school_measure(simulation, 0.3);
    ABOVE(fabs(simulation->diagnostics->fish->lost_impulse[1]), 0);
    ABOVE(fabs(simulation->diagnostics->fish->external_impulse[0]), 0);
    diagnostics_restart(simulation->residual, simulation->state);
    simulate_measure(simulation);
    for (int i = 0; i < 3; i++) {
        NEAR(simulation->diagnostics->fish->lost_impulse[i], 0, 0, 0);
        NEAR(simulation->diagnostics->fish->external_impulse[i], 0, 0, 0);
        NEAR(simulation->diagnostics->momentum_balance[i], 0, 0, 0);
    }
}

// ---- the tree code

enum { ADDED = 1000 }; /* vortices of each fish: three markers each */

/* A school whose wakes the tree sums where the tolerance is not 0: its balance, and whether it has been the tree. */
static void swim_among_many(const char *fluid, double tolerance, double balance[3], double *size, int *by_tree) {
    struct simulation *const simulation =
        school_simulation_of(TIME
                             "%swake: {lifetime: 0.8, decay: 0.6, spare_vortices: %d, tolerance: %g}\n"
                             "defaults: {fish: {" FISH "}}\nfish: [{}, {start: {position: [0.5, 0.6]}}]\n",
                             fluid, 3 * ADDED, tolerance);
    school_run(simulation, 0.1);
    struct setup random = {.seed = 7};
    for (int i = 0; i < 2 * ADDED; i++) {
        const double x = 1.5 * school_random(&random), y = 0.7 + 0.9 * school_random(&random);
        school_ok(wake_add_vortex(&simulation->state->wake[i % 2], simulation->school, simulation->state->t, x, y,
                                  2e-3 * school_random(&random)));
    }
    school_ok(event_change(simulation->state, simulation->residual, simulation->consistent, false));
    diagnostics_restart(simulation->residual, simulation->state);
    school_ok(simulate_renew(simulation));
    for (int n = 0; n < 15; n++) school_ok(simulate_step(simulation));
    simulate_measure(simulation);
    for (int i = 0; i < 3; i++) balance[i] = simulation->diagnostics->momentum_balance[i];
    *size = simulation->diagnostics->momentum_size;
    const struct flow *const flow = simulation->residual->flow;
    *by_tree = tree_interactions(flow->tree) > 0;
}

TEST(it_is_closed_where_the_tree_sums) {
    static const char *const fluids[] = {"", "fluid: {walls: [-1]}\n"};
    for (size_t w = 0; w < sizeof fluids / sizeof *fluids; w++) {
        double direct[3], summed[3], size, error = 0;
        int by_tree;
        swim_among_many(fluids[w], 0, direct, &size, &by_tree);
        assert_false(by_tree);
        swim_among_many(fluids[w], 1e-4, summed, &size, &by_tree);
        assert_true(by_tree);
        for (int i = 0; i < 3; i++) error = fmax(error, fabs(summed[i] - direct[i]) / size);
        BELOW(hypot(summed[0], summed[1]), 5e-3 * size);
        BELOW(fabs(summed[2]), 5e-3 * size);
        ABOVE(error, 0);
        BELOW(error, 1e-3);
    }
}
