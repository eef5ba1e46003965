/* test_steady_formation.c: Tests the search for the places at which fish form a stable formation (doc/steady.md). */
#include "steady/steady_search.h"
#include "steady_setup.h"

// two heaving plates, from this initial place of the follower
#define PLATES                                                                                                   \
    "time: {end: 1, shedding_interval: 0.05, output_interval: 0.05}\n"                                           \
    "fluid: {density: 1, viscosity: 2e-3}\nwake: {lifetime: 3, decay: 2.25, smoothing: 0.2}\n"                   \
    "steady: {formation: true, tolerance: 3e-3}\n"                                                               \
    "defaults: {fish: {nodes: 5, sheet_points: 13, force: pressure, pressure: {span: infinite}, start: {speed: " \
    "4.1},\n"                                                                                                    \
    "  wave: {amplitude: 0, frequency: 0}, motion: {prescribed: all, surge: free, heave: 0.15, frequency: 1},\n" \
    "  body: {profile: uniform, thickness: 0.05, depth: 1, density: 20}}}\n"

// gap between tail and nose, over the distance travelled per beat
static double spacing(const struct steady_setup *setup) {
    const struct steady_beat *const last = setup->problem.map.last;
    return (-last[1].place[0] - 1) / last[0].speed;
}

TEST(a_follower_finds_the_place_where_it_is_as_fast_as_its_leader) {
    struct steady_setup setup;
    steady_setup_find(&setup, PLATES "fish: [{}, {start: {position: [5.2, 0]}}]\n");
    // two speeds and a distance
    assert_int_equal(setup.problem.n_unknowns, 3);
    const struct steady_beat *const last = setup.problem.map.last;
    // lengths per beat; the last two beats changed by at most the tolerance; the follower has a beat of 1 s
    NEAR(last[1].speed, last[0].speed, 2 * 3e-3, 0);
    // about one wavelength, as in experiments: doc/verification.md
    NEAR(spacing(&setup), 1, 0.1, 0);
    NEAR(last[1].place[1], 0, 1e-12, 0);
    BELOW(hypot(setup.multipliers.real[0], setup.multipliers.imaginary[0]), 1);
    // a run from this start needs more than 100 beats; five beats for each unknown and Jacobian took 60
    AT_MOST(setup.problem.map.n_beats, 40);
    // the formation is stable: beats without a search keep the places
    steady_setup_beats(&setup, 5);
    BELOW(steady_map_residual(&setup.problem.map), 3e-3);
}

TEST(between_two_stable_places_is_one_that_the_follower_leaves) {
    struct steady_setup setup;
    steady_setup_find(&setup, PLATES "fish: [{}, {start: {position: [7.4, 0]}}]\n");
    // half a wavelength beyond the first stable place
    NEAR(spacing(&setup), 1.57, 0.1, 0);
    ABOVE(setup.multipliers.real[0], 1.5);
    NEAR(setup.multipliers.imaginary[0], 0, 0, 0);
    // after a displacement to either side the follower moves to the next stable place, by at least one length
    struct state *kept = NULL;
    steady_map_save(setup.simulation->arena, setup.simulation, &kept);
    const double place = setup.problem.map.last[1].end_place[0];
    for (int side = -1; side <= 1; side += 2) {
        const struct steady_unknown ahead = {1, STEADY_AHEAD};
        const double add = side * 0.1;
        school_ok(steady_map_return(setup.simulation, kept));
        school_ok(steady_map_add(&setup.problem.map, 1, &ahead, &add));
        steady_setup_beats(&setup, 5);
        ABOVE(side * (setup.problem.map.last[1].end_place[0] - place), 1);
    }
}

// two coarse fish, the second of which holds a place beside the first
#define HELD                                                                    \
    "time: {end: 1, shedding_interval: 0.1, output_interval: 0.1}\n"            \
    "steady: {formation: true, tolerance: 1e-4}\n"                              \
    "defaults: {fish: {nodes: 7, sheet_points: 13, force: reactive,\n"          \
    "  wave: {amplitude: 0.3}, start: {speed: 0.8}, control: {law: course}}}\n" \
    "fish:\n  - {name: one}\n"                                                  \
    "  - {start: {position: [0.5, 0.6]}, control: {law: place, of: one, offset: [0.5, 0.6]}}\n"

TEST(a_place_that_is_held_is_one_steady_state) {
    struct steady_setup setup;
    steady_setup_find(&setup, HELD);
    // of the follower also the integrals of its law
    assert_int_equal(setup.problem.n_unknowns, 4 + 6 + 2);
    BELOW(hypot(setup.multipliers.real[0], setup.multipliers.imaginary[0]), 0.95);
    // the beats of the multipliers were others
    steady_setup_beats(&setup, 2);
    NEAR(setup.problem.map.last[1].speed, setup.problem.map.last[0].speed, 2e-4, 0);
    BELOW(steady_map_residual(&setup.problem.map), 1e-4);

    // the mean place is the offset, to the tolerance of the integrals, which grow by 1/3 and 1/36 of a length in a beat
    const struct school *const school = setup.simulation->school;
    double away[2], change[2], heading;
    diagnostics_leader(&setup.simulation->state->history[1], away, change, &heading);
    const double turn = heading - acos(-1), c = cos(turn), s = sin(turn);
    NEAR(-away[0], 0.5 * c - 0.6 * s, 1e-3, 0);
    NEAR(-away[1], 0.5 * s + 0.6 * c, 4e-3, 0);
    ABOVE(fabs(setup.simulation->state->control[1].drive), 1e-3);

    // so is that of the result, whatever the yaw of the leader at the end of the beat
    const struct steady_beat *const last = &setup.problem.map.last[1];
    NEAR_ARRAY(2, last->place, ((double[]){-0.5, -0.6}), 4e-3, 0);
    NEAR(hypot(last->place[0], last->place[1]), hypot(away[0], away[1]), 1e-5, 0);
    ABOVE(fabs(last->end_place[1] - last->place[1]), 0.005);

    // a change by the search moves what the law has seen of the leader too: the school turns about the first fish, and
    // the second one moves along the old heading of the first
    const struct steady_unknown unknown[] = {{0, STEADY_HEADING}, {1, STEADY_AHEAD}};
    const double add[] = {0.3, 0.05}, h = control_heading(school->fish, setup.simulation->state->y);
    double later[2], turned;
    school_ok(steady_map_add(&setup.problem.map, 2, unknown, add));
    diagnostics_leader(&setup.simulation->state->history[1], later, change, &turned);
    NEAR(turned, heading + 0.3, 1e-12, 0);
    NEAR(later[0], cos(0.3) * away[0] - sin(0.3) * away[1] - 0.05 * cos(h), 1e-12, 0);
    NEAR(later[1], sin(0.3) * away[0] + cos(0.3) * away[1] - 0.05 * sin(h), 1e-12, 0);
}

TEST(fish_that_swim_freely_keep_the_place_that_is_found) {
    struct steady_setup setup;
    steady_setup_open(&setup, COARSE "steady: {formation: true, tolerance: 1e-3}\ndefaults: {fish: {" FISH
                                     ", start: {speed: 0.75}, control: {law: heading, desired_heading: 180}}}\n"
                                     "fish: [{}, {start: {position: [1.4, 0]}}]\n");
    // speed, slip and turn of both, heading of the first, place and heading of the second relative to the first
    assert_int_equal(setup.problem.n_unknowns, 10);
    school_ok(steady_search_run(&setup.problem));
    const struct steady_beat found = setup.problem.map.last[1];
    NEAR(found.place[0], -1.4, 0.1, 0);
    // the wake of the first fish reaches the second one in three beats; the multipliers need three more of all 41
    // series
    steady_setup_multipliers(&setup);
    assert_int_equal(setup.multipliers.n_beats, 41 * (6 + 3));
    BELOW(setup.multipliers.error[0], 0.01);
    AT_MOST(setup.problem.map.n_beats, 60);
    // the released follower keeps the place for some beats; an initial error of 0.1 lengths would drift by 0.05
    steady_setup_beats(&setup, 4);
    for (int i = 0; i < 2; i++) NEAR(setup.problem.map.last[1].place[i], found.place[i], 0.02, 0);
}

TEST(a_diamond_of_plates_is_found_and_stable) {
    struct steady_setup setup;
    steady_setup_open(&setup, PLATES
                      "fish: [{}, {start: {position: [5.3, 0.5]}}, {start: {position: [5.3, -0.5]}},\n"
                      "  {start: {position: [10.6, 0]}}]\n");
    assert_int_equal(setup.problem.n_unknowns, 7);
    school_ok(steady_search_run(&setup.problem));
    AT_MOST(setup.problem.map.n_beats, 60);
    const struct steady_beat *const last = setup.problem.map.last;
    double place[4];
    for (int f = 0; f < 4; f++) place[f] = last[f].place[0];
    // mirror symmetry: a place to the right of the leader half a beat later corresponds to a place to the left now
    NEAR(place[1], place[2], 0.02, 0);
    // a displaced follower returns, as in a run from the same place
    const struct steady_unknown ahead = {3, STEADY_AHEAD};
    const double add = 0.1;
    school_ok(steady_map_add(&setup.problem.map, 1, &ahead, &add));
    steady_setup_beats(&setup, 20);
    for (int f = 1; f < 4; f++) NEAR(setup.problem.map.last[f].place[0], place[f], 0.02, 0);
}

TEST(a_follower_of_a_held_leader_takes_its_speed) {
    struct steady_setup setup;
    steady_setup_find(&setup, PLATES "fish: [{motion: {surge: given, speed: 4}}, {start: {position: [5.2, 0]}}]\n");
    // speed and distance of the follower
    assert_int_equal(setup.problem.n_unknowns, 2);
    // place and speed of the follower change by at most the tolerance per beat
    NEAR(setup.problem.map.last[1].speed, 4, 2 * 3e-3, 0);
    NEAR(spacing(&setup), 1, 0.15, 0);
    BELOW(hypot(setup.multipliers.real[0], setup.multipliers.imaginary[0]), 1);
}

TEST(from_between_two_places_it_goes_where_the_fish_would) {
    struct steady_setup setup;
    // the thrust is largest near this place: Newton's method alone moves the fish apart until the interaction vanishes
    steady_setup_open(
        &setup,
        "time: {end: 1, shedding_interval: 0.025, output_interval: 0.025}\n"
        "solver: {rtol: 1e-5}\nsteady: {formation: true, tolerance: 3e-4}\nwake: {lifetime: 2, decay: 0.2}\n"
        "defaults: {fish: {force: reactive, nodes: 13, sheet_points: 25, body: {thickness: 0.2, depth: 0.25, modulus: "
        "1e6}, start: {speed: 0.75},\n"
        "  control: {law: heading, desired_heading: 180}}}\n"
        "fish: [{}, {start: {position: [1.75, 0.1]}}]\n");
    school_ok(steady_search_run(&setup.problem));
    const double *const place = setup.problem.map.last[1].place;
    NEAR(place[0], -1.55, 0.05, 0);
    NEAR(place[1], 0, 0.1, 0);
}

/* Two fish and a search of at most 20 beats. */
#define SCHOOL COARSE "steady: {formation: true, beats: 20}\ndefaults: {fish: {" FISH ", start: {speed: 0.8}}}\n"

TEST(where_no_formation_is_found_the_reason_is_what_the_fish_do) {
    // across the path of the first fish
    steady_setup_fails(SCHOOL "fish: [{name: a}, {name: b, start: {position: [0.4, 0.8], heading: 210}}]\n",
                       STATUS_SOLVER, "in 20 beats (steady.beats): collision: after release, a and b approach to");
    steady_setup_fails(SCHOOL "fish: [{name: a}, {name: b, wave: {amplitude: 0.05}, start: {position: [3, 0]}}]\n",
                       STATUS_SOLVER,
                       "in 20 beats (steady.beats): drift: after release, b drifts back relative to a by 0.");
    // the search leaves the start, returns and fails before steady.beats
    steady_setup_fails(COARSE
                       "steady: {formation: true, tolerance: 1e-3}\n"
                       "solver: {rtol: 1e-5}\nwake: {lifetime: 2, decay: 0.2}\ndefaults: {fish: {" FISH
                       ", body: {thickness: 0.2, depth: 0.25, modulus: 1e6}, start: {speed: 0.75}, control: {law: "
                       "heading, desired_heading: 180}}}\n"
                       "fish: [{name: a}, {name: b, start: {position: [1, 0.3]}}]\n",
                       STATUS_SOLVER, "beats near the start: collision: after release, a and b approach to");
    // fish side by side separate
    steady_setup_fails(PLATES "fish: [{}, {start: {position: [0, 40]}}]\n", STATUS_SOLVER,
                       "no equilibrium: the fish hardly interact");
}
