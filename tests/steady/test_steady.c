/* test_steady.c: The search for a steady state agrees with a long run, converges at the expected rate, and refuses
 * cases without a steady state with the reason (doc/steady.md). */
#include <stdio.h>
#include <string.h>

#include "force/bound_sheet.h"
#include "school/diagnostics_energy.h"
#include "school/rigid.h"
#include "steady/steady_search.h"
#include "steady_setup.h"

// mean speed, and change of the heading, over the last of some beats of a run
struct brute {
    double speed, turn; /* m s-1, rad */
};

static void run_on(struct steady_map *map, int n_beats, struct brute *brute) {
    for (int i = 0; i < n_beats; i++) {
        school_ok(steady_map_beat(map, NULL, NULL));
        brute[i] = (struct brute){map->last[0].speed, map->last[0].turn};
    }
}

static void run_long(const char *text, int n_beats, struct brute *brute) {
    struct steady_setup setup;
    steady_setup_open(&setup, text);
    run_on(&setup.problem.map, n_beats, brute);
}

TEST(speed_and_multiplier_are_those_of_a_long_run) {
    static const char text[] = COARSE "steady: {tolerance: 5e-5}\nfish: [{" FISH "}]\n";
    struct steady_setup setup;
    struct brute brute[50];
    steady_setup_find(&setup, text);
    run_long(text, 50, brute);
    AT_MOST(setup.problem.map.n_beats, 20);
    // the required number of beats
    NEAR(setup.problem.map.last[0].speed, brute[49].speed, 0, 1e-4);
    // the error of the run decays in ten beats by the tenth power of the largest multiplier, to 1 %
    NEAR(setup.multipliers.real[0], pow((brute[24].speed - brute[49].speed) / (brute[14].speed - brute[49].speed), 0.1),
         0.01, 0);
    NEAR(setup.multipliers.imaginary[0], 0, 0, 0);
}

/* In two dimensions the circulation that a turning fish has shed acts on it until its wake ends, after 8 beats. */
TEST(the_long_memory_of_a_plane_wake_is_no_growth) {
    static const char text[] = COARSE
        "fish: [{nodes: 7, sheet_points: 13, force: pressure, pressure: {span: infinite}, body: {depth: 1}, "
        "start: {speed: 0.5}}]\n";
    struct steady_setup setup;
    struct brute brute[30];
    steady_setup_find(&setup, text);
    run_long(text, 30, brute);
    // the error of a run decays by the largest multiplier, to 3 %: the memory is cut after three beats
    const double decay = pow((brute[12].speed - brute[29].speed) / (brute[6].speed - brute[29].speed), 1 / 6.0);
    NEAR(setup.multipliers.real[0], decay, 0, 0.03);
    assert_int_equal(setup.problem.unknown[0].quantity, STEADY_SPEED);
    NEAR(setup.multipliers.mode[0], 1, 1e-12, 0);
}

/* The steps between two events are limited so that a beat fails after a large increment of the speed, but no beat of a
 * run. */
TEST(a_beat_that_fails_after_an_increment_is_repeated_after_a_smaller_one) {
#define LIMITED(max_steps)                                                    \
    "time: {end: 1, shedding_interval: 0.05}\nsolver: {max_steps: " max_steps \
    "}\nfish: [{force: reactive, nodes: "                                     \
    "9}]\n"
    struct steady_setup limited, free;
    steady_setup_open(&limited, LIMITED("19"));
    school_ok(steady_search_run(&limited.problem));
    steady_setup_open(&free, LIMITED("10000"));
    school_ok(steady_search_run(&free.problem));
    // the tolerance, 1e-5 lengths per beat, over the decay of the error in a beat, at least a tenth
    NEAR(limited.problem.map.last[0].speed, free.problem.map.last[0].speed, 1e-4, 0);
}

// a plate with a part of the leading-edge suction of attached flow; a slower plate loses more suction
TEST(a_plate_with_limited_suction_has_the_speed_of_a_long_run) {
    static const char text[] =
        "time: {end: 1, shedding_interval: 0.05, output_interval: 0.05}\n"
        "fluid: {density: 1, viscosity: 1.25e-3}\nsteady: {tolerance: 5e-5}\n"
        "fish: [{nodes: 5, sheet_points: 17, force: pressure, pressure: {span: infinite, suction_limit: 0.14}, start: "
        "{speed: 5},\n"
        "        wave: {amplitude: 0, frequency: 0}, body: {profile: uniform, thickness: 0.1, depth: 1, density: "
        "1.59},\n        motion: {prescribed: all, surge: free, heave: 0.175, frequency: 1}}]\n";
    struct steady_setup setup;
    struct brute brute[60];
    steady_setup_open(&setup, text);
    school_ok(steady_search_run(&setup.problem));
    run_long(text, 60, brute);
    NEAR(setup.problem.map.last[0].speed, brute[59].speed, 0, 1e-4);
    assert_in_range(setup.problem.map.n_beats, 1, 30);
    struct simulation *const simulation = setup.simulation;
    simulate_measure(simulation);
    // a tenth of the suction
    const struct pressure_forces *const forces = &simulation->diagnostics->fish[0].pressure;
    ABOVE(hypot(forces->separation[0], forces->separation[1]), 0.05 * hypot(forces->suction[0], forces->suction[1]));
}

// a run converges to 1e-4 in 25 to 45 beats
static void circle(const char *text, double least_turn, int most_beats) {
    struct steady_setup setup;
    struct brute brute[45];
    steady_setup_open(&setup, text);
    school_ok(steady_search_run(&setup.problem));
    run_long(text, 45, brute);
    const struct steady_beat *const last = setup.problem.map.last;
    BELOW(last[0].turn, -least_turn);
    NEAR(last[0].speed, brute[44].speed, 0, 1e-4);
    // the radius is speed over turn
    NEAR(last[0].turn, brute[44].turn, 0, 6e-4);
    assert_in_range(setup.problem.map.n_beats, 1, most_beats);
    steady_setup_multipliers(&setup);
    BELOW(setup.multipliers.real[0], 1);
}

TEST(a_fish_that_is_steered_to_one_side_goes_in_a_circle) {
    circle(COARSE "steady: {tolerance: 2e-5}\nfish: [{" FISH ", start: {speed: 0.6}, control: {bias: 0.02}}]\n", 0.02,
           30);
    circle(COARSE "steady: {tolerance: 2e-5}\nfish: [{" FISH ", start: {speed: 0.6}, control: {bias: 0.2}}]\n", 0.2,
           30);
    circle(COARSE
           "steady: {tolerance: 2e-5}\nfish: [{nodes: 7, sheet_points: 13,"
           " force: pressure, pressure: {span: infinite}, control: {bias: 0.2}}]\n",
           0.2, 30);
    // removed circulation is dropped: the circulation is not a separate quantity
    circle(COARSE
           "steady: {tolerance: 2e-5}\nwake: {removed_circulation: dropped}\n"
           "fish: [{" FISH ", start: {speed: 0.6}, control: {bias: 0.2}}]\n",
           0.2, 30);
}

// the influence of the initial state decays by 1 % per beat
TEST(a_fish_that_coasts_has_the_same_speed_from_two_starts) {
    double speed[2];
    for (int i = 0; i < 2; i++) {
        struct steady_setup setup;
        char text[512];
        snprintf(text, sizeof text,
                 "include: [cases/include/article.yaml]\n# preset:\n"
                 "time: {end: 1, shedding_interval: 0.05, output_interval: 0.05}\n"
                 "steady: {beats: 120}\nfish: [{nodes: 7, sheet_points: 13, start: {speed: %d}}]\n",
                 i);
        steady_setup_open(&setup, text);
        school_ok(steady_search_run(&setup.problem));
        speed[i] = setup.problem.map.last[0].speed;
        steady_setup_multipliers(&setup);
        ABOVE(setup.multipliers.real[0], 0.97);
        BELOW(setup.multipliers.real[0], 1);
    }
    NEAR(speed[0], speed[1], 0, 3e-3);
}

TEST(circulation_that_is_added_changes_nothing_else) {
    static const struct steady_unknown unknown[] = {
        {0, STEADY_SPEED}, {0, STEADY_SLIP}, {0, STEADY_TURN}, {0, STEADY_SHED}};
    const double add[] = {0, 0, 0, 0.1};
    double before[4], after[4];
    struct steady_setup setup;
    steady_setup_open(&setup, COARSE "fish: [{" FISH ", start: {speed: 0.8}}]\n");
    steady_setup_beats(&setup, 2);
    const struct state *const now = setup.simulation->state;
    const struct fish *const fish = &setup.simulation->school->fish[0];
    const double bound = bound_sheet_circulation(fish, now->y), source = wake_source(&now->wake[0], 3);
    steady_map_read(&setup.problem.map, 4, unknown, before);
    school_ok(steady_map_add(&setup.problem.map, 4, unknown, add));
    steady_map_read(&setup.problem.map, 4, unknown, after);
    for (int i = 0; i < 4; i++) NEAR(after[i] - before[i], add[i], 1e-12, 0);
    // Kelvin: the bound circulation is opposite to the shed circulation, less the circulation of the nascent stretch
    NEAR(bound_sheet_circulation(fish, now->y) - bound, -0.1, 0, 0.05);
    NEAR(wake_source(&now->wake[0], 3), source, 1e-14, 0);
}

TEST(a_law_of_control_brings_the_heading_to_where_a_run_has_it) {
    static const char text[] = COARSE
        "steady: {tolerance: 5e-5}\n"
        "fish: [{" FISH ", start: {speed: 0.7, heading: 170}, control: {law: heading, desired_heading: 180}}]\n";
    struct steady_setup setup, run;
    struct brute brute[50];
    steady_setup_find(&setup, text);
    // speed, slip, turn, and the heading, which the control law holds
    assert_int_equal(setup.problem.n_unknowns, 4);
    const struct steady_unknown heading = {0, STEADY_HEADING};
    double found, reached;
    steady_map_read(&setup.problem.map, 1, &heading, &found);
    steady_setup_open(&run, text);
    run_on(&run.problem.map, 50, brute);
    steady_map_read(&run.problem.map, 1, &heading, &reached);
    NEAR(found, reached, 1e-3, 0);
    // steady.tolerance is the change of one beat, of which the slowest multiplier, 0.7, leaves 1/(1 - 0.7)
    NEAR(setup.problem.map.last[0].speed, brute[49].speed, 0, 5e-5 / (1 - 0.7));
    NEAR(setup.multipliers.real[0], pow((brute[24].speed - brute[49].speed) / (brute[14].speed - brute[49].speed), 0.1),
         0.01, 0);
}

/* The course of the last period and a bias that moves slowly: this law remembers more than three beats. */
TEST(a_law_with_a_long_memory_has_a_multiplier_without_its_error) {
    struct steady_setup setup;
    steady_setup_find(&setup, COARSE
                      "steady: {tolerance: 1e-4}\n"
                      "fish: [{" FISH ", control: {law: course, gain: 4, desired_heading: 0}}]\n");
    ABOVE(setup.multipliers.imaginary[0], 0.1);
    // six beats without a halt between the third and the fourth have the same multiplier
    NEAR(hypot(setup.multipliers.real[0], setup.multipliers.imaginary[0]), 0.9536, 0, 0.002);
    // with three beats the error is above 0.1
    BELOW(setup.multipliers.error[0], 0.01);
    // 17 series of three beats, 8 with half of the size, and then three more beats of 17
    assert_int_equal(setup.multipliers.n_beats, 3 * 17 + 3 * 8 + 3 * 17);
}

TEST(the_state_stays_where_its_multipliers_are_taken) {
    struct steady_setup setup;
    steady_setup_open(&setup, COARSE "fish: [{" FISH ", start: {speed: 0.8}}]\n");
    steady_setup_beats(&setup, 3);
    const struct simulation *const simulation = setup.simulation;
    const size_t bytes = (size_t)simulation->school->n_unknowns * sizeof(double);
    const int n_vortex = simulation->state->wake[0].n_vortex;
    double before[512];
    memcpy(before, simulation->state->y, bytes);
    steady_setup_multipliers(&setup);
    assert_memory_equal(simulation->state->y, before, bytes);
    assert_int_equal(simulation->state->wake[0].n_vortex, n_vortex);
    // thirteen runs of three beats each: one undisturbed, three with increments of two sizes, three with decrements
    assert_int_equal(setup.multipliers.n_beats, 39);
    assert_int_equal(setup.problem.map.n_beats, 3);
}

// the change of the speed in a beat, over 1 minus the largest multiplier, that of the speed
TEST(the_step_of_the_multipliers_leads_to_the_fixed_point) {
    struct steady_setup setup;
    steady_setup_open(&setup, COARSE "fish: [{" FISH ", start: {speed: 0.8}}]\n");
    steady_setup_beats(&setup, 3);
    steady_setup_multipliers(&setup);
    assert_int_equal(setup.problem.unknown[0].quantity, STEADY_SPEED);
    double at[2][STEADY_QUANTITIES];
    steady_problem_read(&setup.problem, at[0]);
    steady_setup_beats(&setup, 40);
    steady_problem_read(&setup.problem, at[1]);
    NEAR(setup.multipliers.way[0], at[1][0] - at[0][0], 0, 0.3);
}

TEST(scales_are_lengths_and_beats) {
    struct steady_setup setup;
    steady_setup_open(&setup, COARSE "fish: [{" FISH ", length: 0.6}]\n");
    setup.problem.map.period = 0.8;
    const double want[] = {[STEADY_SPEED] = 0.6 / 0.8, [STEADY_SLIP] = 0.6 / 0.8, [STEADY_TURN] = 1 / 0.8,
                           [STEADY_HEADING] = 1,       [STEADY_AHEAD] = 0.6,      [STEADY_ASIDE] = 0.6,
                           [STEADY_SHED] = 0.36 / 0.8, [STEADY_HOLD_ALONG] = 1,   [STEADY_HOLD_ACROSS] = 1};
    for (int i = 0; i < (int)(sizeof want / sizeof *want); i++) {
        const struct steady_unknown unknown = {0, (enum steady_quantity)i};
        NEAR(steady_map_scale(&setup.problem.map, unknown), want[i], 0, 1e-15);
    }

    // what is read in these units is put in them
    double value[STEADY_QUANTITIES], now[STEADY_QUANTITIES];
    steady_problem_read(&setup.problem, value);
    for (int i = 0; i < setup.problem.n_unknowns; i++) value[i] += 0.01 * (i + 1);
    school_ok(steady_problem_put(&setup.problem, value));
    steady_problem_read(&setup.problem, now);
    NEAR_ARRAY(setup.problem.n_unknowns, now, value, 1e-9, 0);
}

TEST(a_held_fish_is_steady_when_its_forces_repeat) {
    struct steady_setup setup;
    steady_setup_open(&setup, COARSE "fluid: {velocity: [1, 0]}\nfish: [{" FISH
                                     ", wave: {amplitude: 0}, body: {modulus: 3e6},"
                                     " motion: {prescribed: head, heave: 0.05, frequency: 1, phase: 90, speed: 0}}]\n");
    assert_int_equal(setup.problem.n_unknowns, 0);
    school_ok(steady_search_run(&setup.problem));
    const double thrust = setup.problem.map.last[0].thrust, power = setup.problem.map.last[0].driving;
    steady_setup_beats(&setup, 10);
    NEAR(setup.problem.map.last[0].thrust, thrust, 0, 1e-3);
    NEAR(setup.problem.map.last[0].driving, power, 0, 1e-4);
}

TEST(a_beat_without_a_finite_value_is_not_steady) {
    struct steady_setup setup;
    steady_setup_open(&setup, COARSE "fluid: {velocity: [1, 0]}\nfish: [{" FISH
                                     ", wave: {amplitude: 0}, body: {modulus: 1e9},"
                                     " motion: {prescribed: all, heave: 0.001, frequency: 1, speed: 0}}]\n");
    steady_setup_beats(&setup, 3);
    struct steady_beat *const now = &setup.problem.map.last[0];
    double *const values[] = {&now->speed, &now->turn, &now->thrust, &now->driving, &now->rms_power};
    for (size_t i = 0; i < sizeof values / sizeof *values; i++) {
        const double kept = *values[i];
        *values[i] = NAN;
        if (!isnan(steady_map_residual(&setup.problem.map))) {
            fail_msg("value %zu: residual %g, want NaN", i, steady_map_residual(&setup.problem.map));
        }
        *values[i] = kept;
    }
    assert_true(isfinite(steady_map_residual(&setup.problem.map)));
}

TEST(two_beats_in_a_row_are_steady) {
    // a tolerance that every beat meets
    struct steady_setup setup;
    steady_setup_open(&setup, COARSE "fluid: {velocity: [1, 0]}\nsteady: {tolerance: 0.1}\nfish: [{" FISH
                                     ", wave: {amplitude: 0}, body: {modulus: 1e9},"
                                     " motion: {prescribed: all, heave: 0.001, frequency: 1, speed: 0}}]\n");
    assert_int_equal(setup.problem.n_unknowns, 0);
    school_ok(steady_search_run(&setup.problem));
    // the ramp, two more beats, and two that are steady
    const int ramp = (int)ceil(setup.simulation->school->fish[0].ramp / setup.problem.map.period * (1 - 1e-9));
    assert_int_equal(setup.problem.map.n_beats, ramp + 4);
}

TEST(mean_powers_are_the_works_of_a_beat) {
    static const char *const fish[] = {
        "fish: [{" FISH ", body: {modulus: 1e8}}]\n",
        "fluid: {velocity: [1, 0]}\n"
        "fish: [{" FISH ", wave: {amplitude: 0}, motion: {prescribed: head, heave: 0.05, frequency: 1, speed: 0}}]\n"};
    for (int i = 0; i < 2; i++) {
        char text[512];
        snprintf(text, sizeof text, COARSE "%s", fish[i]);
        struct steady_setup setup;
        steady_setup_open(&setup, text);
        steady_setup_beats(&setup, 2);
        const double *const work = setup.simulation->state->balance[0].work;
        double before[N_WORKS];
        memcpy(before, work, sizeof before);
        steady_setup_beats(&setup, 1);
        const struct steady_beat *const beat = &setup.problem.map.last[0];
        const struct diagnostics_fish *const now = &setup.simulation->diagnostics->fish[0];
        // a beat of 1 s
        NEAR(beat->actuation, work[WORK_ACTUATION] - before[WORK_ACTUATION], 1e-12, 1e-6);
        NEAR(beat->damping, work[WORK_DAMPING] - before[WORK_DAMPING], 1e-12, 1e-6);
        NEAR(beat->driving, work[WORK_DRIVING] - before[WORK_DRIVING], 1e-12, 1e-6);
        const double drive = work[WORK_DRIVING_ON_WATER] - before[WORK_DRIVING_ON_WATER];
        NEAR(beat->actuation + drive,
             now->cost_of_transport * setup.simulation->school->fish[0].total_mass * now->speed, 1e-12, 1e-6);
        ABOVE(fabs(i == 0 ? beat->actuation : beat->driving), 1e-3);
    }
}

// the thrust at the events of a beat
struct thrusts {
    const struct simulation *simulation;
    double value[21], power[21];
    int n;
};

static enum status note_thrust(void *data) {
    struct thrusts *const thrusts = data;
    const struct diagnostics_fish *const now = &thrusts->simulation->diagnostics->fish[0];
    thrusts->power[thrusts->n] = now->actuation_power + now->constraint_power;
    thrusts->value[thrusts->n++] = now->thrust;
    return STATUS_OK;
}

TEST(mean_forces_are_trapezoids_over_the_events_of_a_beat) {
    struct steady_setup setup;
    steady_setup_open(&setup, COARSE
                      "fluid: {velocity: [1, 0]}\nfish: [{" FISH
                      ", wave: {amplitude: 0}, motion: {prescribed: head, heave: 0.05, frequency: 1, speed: 0}}]\n");
    steady_setup_beats(&setup, 2);
    struct thrusts thrusts = {.simulation = setup.simulation};
    simulate_measure(setup.simulation);
    note_thrust(&thrusts);
    school_ok(steady_map_beat(&setup.problem.map, note_thrust, &thrusts));
    assert_int_equal(thrusts.n, 21);
    double mean = 0, square = 0, square_of_power = 0;
    for (int i = 0; i < 21; i++) {
        const double share = (i == 0 || i == 20 ? 0.5 : 1) / 20;
        mean += share * thrusts.value[i];
        square += share * thrusts.value[i] * thrusts.value[i];
        square_of_power += share * thrusts.power[i] * thrusts.power[i];
    }
    const struct steady_beat *const beat = &setup.problem.map.last[0];
    NEAR(beat->thrust, mean, 1e-12 * beat->rms_thrust, 0);
    NEAR(beat->rms_thrust, sqrt(square), 0, 1e-12);
    NEAR(beat->rms_power, sqrt(square_of_power), 0, 1e-12);
    ABOVE(beat->rms_power, 1e-3);
    ABOVE(fabs(thrusts.value[0]), 1e-6);
    ABOVE(fabs(thrusts.value[20]), 1e-6);
}

TEST(a_turn_counts_in_circles_with_a_bias_and_as_a_tenth_without) {
    for (int has_bias = 0; has_bias < 2; has_bias++) {
        struct steady_setup setup;
        steady_setup_open(
            &setup, has_bias ? COARSE "fish: [{" FISH ", control: {bias: 0.1}}]\n" : COARSE "fish: [{" FISH "}]\n");
        setup.problem.map.last[0] = (struct steady_beat){.speed = 1, .turn = 0.3};
        setup.problem.map.before[0] = (struct steady_beat){.speed = 1, .turn = 0.1};
        NEAR(steady_map_residual(&setup.problem.map), 0.2 / (2 * acos(-1)) / (has_bias ? 1 : 10), 0, 1e-12);
    }
}

TEST(of_a_held_fish_thrust_and_power_must_repeat) {
    struct steady_setup setup;
    steady_setup_open(&setup, COARSE
                      "fluid: {velocity: [1, 0]}\nfish: [{" FISH
                      ", length: 2, wave: {amplitude: 0}, motion: {prescribed: all, heave: 0.1, frequency: 1, speed: "
                      "0}}]\n");
    struct steady_map *const map = &setup.problem.map;
    const struct steady_beat before = {.thrust = 3, .rms_thrust = 7, .actuation = 5, .driving = 6, .rms_power = 70};
    const struct {
        double thrust, actuation, driving, speed, residual;
    } changes[] = {{0.5, 0, 0, 0, 0.05}, {-0.5, 0, 0, 0, 0.05}, {0, 3, 0, 0, 0.15},
                   {0, 0, -3, 0, 0.15},  {0, 3, -3, 0, 0},      {0, 0, 0, 0.4, 0.2}};
    for (size_t i = 0; i < sizeof changes / sizeof *changes; i++) {
        map->before[0] = before;
        map->last[0] = (struct steady_beat){.thrust = 3 + changes[i].thrust,
                                            .rms_thrust = 10,
                                            .actuation = 5 + changes[i].actuation,
                                            .driving = 6 + changes[i].driving,
                                            .rms_power = 20,
                                            .speed = changes[i].speed};
        // speeds in lengths per beat of 1 s
        NEAR(steady_map_residual(map), changes[i].residual, 1e-14, 0);
    }
}

TEST(headings_are_seen_from_the_first_fish_and_its_from_the_first_that_is_steered) {
    struct simulation *const simulation = school_simulation(
        COARSE "defaults: {fish: {" FISH
               "}}\nfish: [{start: {heading: 20}}, {start: {position: [0, 3], heading: 50}, control: {law: heading, "
               "desired_heading: 15}}, {start: {position: [0, 6], heading: -170}, control: {law: heading, "
               "desired_heading: 100}}]\n");
    struct steady_map map;
    school_ok(steady_map_create(&map, simulation));
    assert_true(map.is_steered);
    assert_int_equal(map.steered, 1);
    const struct steady_unknown unknown[] = {{0, STEADY_HEADING}, {1, STEADY_HEADING}, {2, STEADY_HEADING}};
    double heading[3], from[3];
    for (int f = 0; f < 3; f++) from[f] = rigid_of(&simulation->school->fish[f], simulation->state->y).heading;
    steady_map_read(&map, 3, unknown, heading);
    const double turn = 2 * acos(-1);
    NEAR(heading[0], remainder(from[0] - 15 * turn / 360, turn), 1e-12, 0);
    NEAR(heading[1], remainder(from[1] - from[0], turn), 1e-12, 0);
    NEAR(heading[2], remainder(from[2] - from[0], turn), 1e-12, 0);
    ABOVE(fabs(heading[0]), 0.05);
}

TEST(a_formation_turns_with_its_first_fish) {
    struct simulation *const simulation = school_simulation(
        COARSE "defaults: {fish: {" FISH "}}\nfish: [{}, {start: {position: [1, 2], heading: 150}}]\n");
    struct steady_map map;
    school_ok(steady_map_create(&map, simulation));
    const struct steady_unknown turned = {0, STEADY_HEADING},
                                seen[] = {{1, STEADY_HEADING}, {1, STEADY_AHEAD}, {1, STEADY_ASIDE}};
    double before[3], after[3];
    const double heading = rigid_of(&simulation->school->fish[0], simulation->state->y).heading;
    steady_map_read(&map, 3, seen, before);
    school_ok(steady_map_add(&map, 1, &turned, (const double[]){0.7}));
    steady_map_read(&map, 3, seen, after);
    NEAR_ARRAY(3, after, before, 1e-10, 0);
    const double now = rigid_of(&simulation->school->fish[0], simulation->state->y).heading;
    NEAR(remainder(now - heading, 2 * acos(-1)), 0.7, 1e-10, 0);
    // and a place is changed along the heading of the first fish
    school_ok(steady_map_add(&map, 2, seen + 1, (const double[]){0.3, -0.2}));
    steady_map_read(&map, 3, seen, after);
    NEAR_ARRAY(3, after, ((double[]){before[0], before[1] + 0.3, before[2] - 0.2}), 1e-10, 0);
}

TEST(a_fish_is_not_placed_on_another) {
    struct simulation *const simulation =
        school_simulation(COARSE "defaults: {fish: {" FISH
                                 "}}\nfish: [{name: a}, {name: b, start: {position: [1, 2]}}, "
                                 "{name: c, start: {position: [3, 1]}}]\n");
    struct steady_map map;
    school_ok(steady_map_create(&map, simulation));
    const struct steady_unknown place[] = {{2, STEADY_AHEAD}, {2, STEADY_ASIDE}, {1, STEADY_AHEAD}, {1, STEADY_ASIDE}};
    double value[4];
    steady_map_read(&map, 4, place, value);
    const double add[] = {value[2] - value[0] + 0.1, value[3] - value[1]};
    assert_int_equal(steady_map_add(&map, 2, place, add), STATUS_SOLVER);
    if (!strstr(status_message(), "makes b and c overlap")) fail_msg("%s", status_message());
}

TEST(speed_and_slip_are_those_through_the_water) {
    struct steady_setup setup;
    steady_setup_open(&setup,
                      COARSE "fluid: {velocity: [0.3, 0.1]}\nfish: [{" FISH ", start: {heading: 150, speed: 0}}]\n");
    const struct fish *const fish = setup.simulation->school->fish;
    const double *const y = setup.simulation->state->y;
    const double heading = rigid_of(fish, y).heading, c = cos(heading), s = sin(heading);
    const double u = fish_mass_mean(fish, y + fish->at.vx) - 0.3, v = fish_mass_mean(fish, y + fish->at.vy) - 0.1;
    const struct steady_unknown unknown[] = {{0, STEADY_SPEED}, {0, STEADY_SLIP}};
    double value[2];
    steady_map_read(&setup.problem.map, 2, unknown, value);
    NEAR(value[0], c * u + s * v, 1e-12, 0);
    NEAR(value[1], c * v - s * u, 1e-12, 0);
}

TEST(what_can_have_no_steady_state_is_refused_with_the_reason) {
    steady_setup_fails(COARSE "fish: [{" FISH ", wave: {frequency: 1.01}}]\n", STATUS_CASE,
                       "has 19.802 events, not an integer: set time.shedding_interval to 0.0495049505, and");
    steady_setup_fails(COARSE "fish: [{" FISH ", wave: {frequency: 0, amplitude: 0}}]\n", STATUS_CASE, "no fish beats");
    steady_setup_fails(COARSE "defaults: {fish: {" FISH
                              ", motion: {prescribed: all}}}\n"
                              "fish: [{}, {start: {position: [3, 0]}, motion: {heave: 0.1, frequency: 2}}]\n",
                       STATUS_CASE, "fish1 beats 1 times per second and fish2 beats 2 times");
    steady_setup_fails(COARSE "fluid: {gust: {amplitude: 0.1, frequency: 1.5}}\nfish: [{" FISH "}]\n", STATUS_CASE,
                       "1.5 gusts");
    steady_setup_fails(COARSE "fluid: {gust: {amplitude: 0.1, frequency: 1.001}}\nfish: [{" FISH "}]\n", STATUS_CASE,
                       "1.001 gusts");
    struct steady_setup rounded; /* a frequency that is an integer but for its rounding is taken */
    steady_setup_open(&rounded,
                      COARSE "fluid: {gust: {amplitude: 0.1, frequency: 1.000000000001}}\nfish: [{" FISH "}]\n");
    steady_setup_fails(COARSE "fluid: {shear: 0.1}\nfish: [{" FISH "}]\n", STATUS_CASE, "shear");
    steady_setup_fails(COARSE "fluid: {walls: [-1]}\nfish: [{" FISH "}]\n", STATUS_CASE, "beside a wall");
    steady_setup_fails(COARSE "fish: [{" FISH ", control: {waypoints: [[9, 0]]}}]\n", STATUS_CASE, "waypoints");
    steady_setup_fails(COARSE "defaults: {fish: {" FISH "}}\nfish: [{}, {start: {position: [3, 0]}}]\n", STATUS_CASE,
                       "2 of 2 fish swim at independent speeds");
}

TEST(fish_that_are_all_held_may_be_many) {
    struct steady_setup setup;
    steady_setup_open(&setup, COARSE "defaults: {fish: {" FISH
                                     ", motion: {prescribed: all, heave: 0.1, frequency: 1}}}\n"
                                     "fish: [{}, {start: {position: [3, 0]}}]\n");
    assert_int_equal(setup.problem.n_unknowns, 0);
}

// speeds of beats that repeat every three beats also repeat every six
TEST(the_least_period_of_the_last_beats_is_said) {
    static const int periods[] = {2, 3, 4};
    for (int k = 0; k < 3; k++) {
        struct steady_setup setup;
        char words[64];
        steady_setup_open(&setup, COARSE "steady: {beats: 40}\nfish: [{" FISH "}]\n");
        setup.problem.map.n_beats = 40;
        for (int i = 0; i < STEADY_RECENT; i++) {
            setup.problem.recent[(40 - i) % STEADY_RECENT] = 0.5 + 0.1 * (i % periods[k] == 0);
        }
        assert_int_equal(steady_problem_beat(&setup.problem), STATUS_SOLVER);
        snprintf(words, sizeof words, "the speed repeats every %d beats", periods[k]);
        if (!strstr(status_message(), words)) fail_msg("%s: without %s", status_message(), words);
    }
}

// the same fish in other units, on a circle: all slow quantities are searched together, in as many beats
TEST(a_small_fish_is_found_like_a_large_one) {
    double speed = 0;
    int n_beats = 0;
    for (int i = 0; i < 2; i++) {
        const double length = i == 0 ? 1 : 0.2;
        struct steady_setup setup;
        char text[512];
        snprintf(text, sizeof text,
                 COARSE "fish: [{" FISH
                        ", length: %g, body: {modulus: %g}, drag: {skin: quadratic}, start: {speed: %g},"
                        " control: {bias: 0.1}}]\n",
                 length, 3e6 * length * length, 0.5 * length);
        steady_setup_open(&setup, text);
        school_ok(steady_search_run(&setup.problem));
        const double found = setup.problem.map.last[0].speed / length;
        if (i == 1) NEAR(found, speed, 0, 1e-6);
        if (i == 1) assert_int_equal(setup.problem.map.n_beats, n_beats);
        speed = found;
        n_beats = setup.problem.map.n_beats;
    }
}

TEST(a_search_that_takes_too_long_says_how_far_it_came) {
    steady_setup_fails(COARSE "steady: {beats: 5}\nfish: [{" FISH "}]\n", STATUS_SOLVER,
                       "no steady state in 5 beats (steady.beats)");
}

// no search meets such a tolerance: the fish swims without increments at the end, as in a run
TEST(a_search_that_fails_says_what_the_last_beats_have_in_common) {
    steady_setup_fails(COARSE "steady: {tolerance: 1e-12, beats: 70}\nfish: [{" FISH "}]\n", STATUS_SOLVER,
                       " % between the last 16 beats; if the residual no longer falls from beat to beat, reduce "
                       "solver.rtol");
}

// the balance of a school after a beat, over the largest of its terms
static double beat_balance(struct steady_map *map, double balance[3]) {
    struct simulation *const simulation = map->simulation;
    school_ok(steady_map_beat(map, NULL, NULL));
    simulate_measure(simulation);
    memcpy(balance, simulation->diagnostics->momentum_balance, 3 * sizeof *balance);
    return hypot(balance[0], balance[1]) / simulation->diagnostics->momentum_size;
}

TEST(the_balance_of_momentum_begins_with_the_rows_and_is_kept) {
    struct steady_setup setup;
    struct state *kept = NULL;
    double searched[3], first[3], again[3];
    steady_setup_open(&setup, COARSE
                      "steady: {tolerance: 1e-3}\n"
                      "fish: [{nodes: 7, sheet_points: 13, pressure: {span: infinite}, body: {thickness: 0.2, depth: "
                      "0.25}, start: {speed: 0.3}}]\n");
    school_ok(steady_search_run(&setup.problem));
    struct steady_map *const map = &setup.problem.map;
    struct simulation *const simulation = map->simulation;
    // the search has added velocities to body and wake
    const double open = beat_balance(map, searched);
    diagnostics_restart(simulation->residual, simulation->state);
    const double closed = beat_balance(map, first);
    ABOVE(open, 0.1);
    BELOW(closed, 0.01);

    steady_map_save(simulation->arena, simulation, &kept);
    school_ok(steady_map_return(simulation, kept));
    beat_balance(map, first);
    school_ok(steady_map_return(simulation, kept));
    beat_balance(map, again);
    // to the tolerance of the solver
    NEAR_ARRAY(3, again, first, 1e-6, 0);
    // a search takes the memory of one state, however often it saves
    const struct state *const one = kept;
    steady_map_save(simulation->arena, simulation, &kept);
    assert_ptr_equal(kept, one);
}
