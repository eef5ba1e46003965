/* test_take_up.c: A run that is created from state and totals alone continues with the bits of the run that was renewed
 * at the same event, for every method and every part of the state. */
#include <stdio.h>

#include "fish/fish_school.h"
#include "school.h"
#include "state/state.h"

/* A short lifetime, so that vortices decay and are removed too. */
#define TIME "time: {end: 1, shedding_interval: 0.02}\n"
#define SMALL TIME "defaults: {fish: {nodes: 7}}\n"
#define BOTH "fish: [{name: a}, {name: b, nodes: 6, length: 0.8, start: {position: [0.2, 0.5]}}]\n"
// so soft that explicit methods follow it
#define SOFT                                                                                          \
    "fish: [{name: a, body: {modulus: 2e3}}, {name: b, nodes: 6, length: 0.8, body: {modulus: 2e3}, " \
    "start: {position: [0.2, 0.5]}}]\n"
#define STEERED(law)                                                             \
    "fish: [{force: reactive, control: {law: " law                               \
    ", desired_heading: 160}, wave: {frequency: 20}}, {start: {position: [0.3, " \
    "0.6]}}]\n"

static const char *const cases[] = {
    // methods
    SMALL "wake: {lifetime: 0.1}\n" BOTH,
    SMALL "solver: {order: 5, rtol: 1e-6}\n" BOTH,
    SMALL "solver: {method: euler, step: 0.001}\n" SOFT,
    SMALL "solver: {method: euler}\n" SOFT,
    SMALL "solver: {method: heun}\n" SOFT,
    SMALL "solver: {method: rk4, step: 0.002}\n" SOFT,
    SMALL "solver: {method: rk4}\n" SOFT,
    SMALL "solver: {method: dormand_prince}\nwake: {lifetime: 0.1}\n" SOFT,
    SMALL "solver: {method: implicit_euler, step: 0.001}\n" BOTH,
    SMALL "solver: {method: trapezoid, step: 0.001}\nwake: {lifetime: 0.1}\n" BOTH,
    // shedding
    SMALL "wake: {shedding: impulsive, lifetime: 0.1}\n" BOTH,
    SMALL "wake: {shedding: impulsive}\nsheet: {kutta: rate}\n" BOTH,
    SMALL "wake: {shedding: continuous, lifetime: 0.1}\n" BOTH,
    SMALL "solver: {method: dormand_prince}\n" SOFT,
    SMALL
    "wake: {shedding: continuous, decay: 0.05, lifetime: 0.1, removed_circulation: dropped}\nsheet: {kutta: "
    "rate}\n" BOTH,
    TIME "preset: published\n" BOTH,
    // wake sums, variable coupling, threads
    SMALL "wake: {tolerance: 0}\n" BOTH,
    SMALL "wake: {tolerance: 1e-3}\nsolver: {threads: 2}\n" BOTH,
    SMALL
    "solver: {coupling_distance: 0.2}\nfish: [{start: {speed: 2}}, {start: {position: [-0.6, 0.2], heading: 0}}]\n",
    // control, prescribed motion, other forces and fluids
    SMALL STEERED("heading, feedforward: 1"),
    SMALL STEERED("averaged_heading"),
    SMALL STEERED("course"),
    SMALL "fish: [{control: {law: heading, waypoints: [[-0.1, 0], [-3, 1]]}, wave: {frequency: 20}}]\n",
    SMALL
    "fluid: {velocity: [0.1, 0], shear: 0.3, gust: {amplitude: 0.2, frequency: 3}}\n"
    "fish: [{motion: {prescribed: head, heave: 0.1, frequency: 2}, force: reactive, load: {tip: [0.1, 0]}}]\n",
    SMALL
    "fluid: {velocity: [0.1, 0], gust: {profile: sine, amplitude: 0.2, wavelength: 0.6}}\n"
    "wake: {street: {vortices: 5, spacing: 0.4, circulation: 0.1}}\n"
    "fish: [{pressure: {span: infinite}}]\n",
};
enum { N_CASES = sizeof cases / sizeof *cases, N_BEFORE = 8, N_AFTER = 6 };

static void steps(struct simulation *simulation, int n) {
    for (int i = 0; i < n; i++) school_ok(simulate_step(simulation));
}

// another simulation of the case, created from the contents of a checkpoint
static struct simulation *taken_up(const struct simulation *from, const char *text) {
    struct case_values values = school_values(text);
    struct school *school;
    struct simulation *simulation;
    school_ok(fish_school_create(NULL, &school, &values.school));
    struct state *const state = state_create(NULL, school);
    state_table_copy(state, from->state, school, true);
    school_ok(simulate_take_up(test_arena(), &simulation, &values, school, state, &from->totals));
    case_free(&values);
    return simulation;
}

TEST(a_run_goes_on_from_its_state_alone_with_the_same_bits) {
    for (int i = 0; i < N_CASES; i++) {
        struct simulation *const one = school_simulation(cases[i]);
        steps(one, N_BEFORE);
        school_ok(simulate_renew(one));
        struct simulation *const other = taken_up(one, cases[i]);
        steps(one, N_AFTER);
        steps(other, N_AFTER);
        school_same_bits(other, one, cases[i]);
    }
}

TEST(a_run_may_be_taken_up_at_its_first_event) {
    struct simulation *const one = school_simulation(cases[0]);
    school_ok(simulate_renew(one));
    struct simulation *const other = taken_up(one, cases[0]);
    steps(one, N_AFTER);
    steps(other, N_AFTER);
    school_same_bits(other, one, cases[0]);
}

// Sheets and wakes summed by the tree of the event, also with another number of threads.
TEST(a_large_school_goes_on_with_the_same_bits_on_other_threads) {
    enum { MANY = 20 };
    char text[2][4096];
    for (int k = 0; k < 2; k++) {
        int used = snprintf(text[k], sizeof text[k],
                            TIME
                            "solver: {threads: %d}\n"
                            "defaults: {fish: {nodes: 7, sheet_points: 120}}\nfish:\n",
                            k + 1);
        for (int f = 0; f < MANY; f++) {
            used += snprintf(text[k] + used, sizeof text[k] - (size_t)used,
                             "  - {start: {position: [%g, %g]}, wave: {phase: %d}}\n", 1.4 * (f % 5), 0.4 * (f / 5),
                             36 * f);
            BELOW((size_t)used, sizeof text[k]);
        }
    }
    struct simulation *const one = school_simulation(text[0]);
    steps(one, 1);
    school_ok(simulate_renew(one));
    struct simulation *const other = taken_up(one, text[1]);
    assert_int_equal(other->school->threads, 2);
    steps(one, 2);
    steps(other, 2);
    school_same_bits(other, one, text[1]);
}
