/* test_steady.c: the search for a steady state: what it finds is what a long run comes to, with how fast it comes; and
 * what can have none is refused with the reason. doc/steady.md. */
#include <string.h>

#include "run/steady_multipliers.h"
#include "run/steady_search.h"
#include "school.h"

// coarse, so that a beat takes some milliseconds: 20 events, 7 nodes, 13 points of the sheet
#define COARSE "time: {end: 1, shedding_interval: 0.05, output_interval: 0.05}\n"
#define FISH "nodes: 7, sheet_points: 13"

static void speed_and_multiplier_are_those_of_a_long_run(void **state) {
    (void)state;
    static const char text[] = SCHOOL_SECOND COARSE "steady: {tolerance: 5e-5}\nfish: [{" FISH "}]\n";
    struct case_values values;
    school_settings(&values, text);
    struct simulation *const simulation = school_simulation(text);
    struct steady_problem problem;
    school_ok(steady_problem_create(&problem, &values.steady, simulation));
    school_ok(steady_search_run(&problem));
    assert_true(problem.map.n_beats <= 20);
    double real[3], imaginary[3];
    int n_beats;
    school_ok(steady_multipliers_find(&problem, real, imaginary, &n_beats));

    struct simulation *const brute = school_simulation(text);
    double speed[51];
    for (int beat = 1; beat <= 50; beat++) {
        school_run(brute, beat);
        simulate_measure(brute);
        speed[beat] = brute->diagnostics->fish[0].speed;
    }
    // the bound that the search is made for
    NEAR(problem.map.last[0].speed, speed[50], 0, 1e-4);
    // over ten beats the error of the run falls by the tenth power of the largest multiplier: its own errors are 1 %
    NEAR(real[0], pow((speed[25] - speed[50]) / (speed[15] - speed[50]), 0.1), 0.01, 0);
    NEAR(imaginary[0], 0, 0, 0);
    simulate_free(brute);
    steady_problem_free(&problem);
    simulate_free(simulation);
    case_free(&values);
}

static void the_state_stays_where_its_multipliers_are_taken(void **state) {
    (void)state;
    static const char text[] = SCHOOL_SECOND COARSE "fish: [{" FISH ", start: {speed: 0.8}}]\n";
    struct case_values values;
    school_settings(&values, text);
    struct simulation *const simulation = school_simulation(text);
    struct steady_problem problem;
    school_ok(steady_problem_create(&problem, &values.steady, simulation));
    for (int i = 0; i < 3; i++) school_ok(steady_map_beat(&problem.map, NULL, NULL));
    const int n = simulation->school->n_unknowns, n_vortex = simulation->state->wake[0].n_vortex;
    double before[512], real[3], imaginary[3];
    memcpy(before, simulation->state->y, (size_t)n * sizeof *before);
    int n_beats;
    school_ok(steady_multipliers_find(&problem, real, imaginary, &n_beats));
    assert_memory_equal(simulation->state->y, before, (size_t)n * sizeof *before);
    assert_int_equal(simulation->state->wake[0].n_vortex, n_vortex);
    // of four runs, one without and three with something added, each six beats
    assert_int_equal(n_beats, 24);
    assert_int_equal(problem.map.n_beats, 3);
    steady_problem_free(&problem);
    simulate_free(simulation);
    case_free(&values);
}

static void a_held_fish_is_steady_when_its_forces_repeat(void **state) {
    (void)state;
    static const char text[] = SCHOOL_SECOND COARSE
        "fluid: {velocity: [1, 0]}\n"
        "fish: [{" FISH
        ", wave: {amplitude: 0}, body: {modulus: 3e6},"
        " motion: {driven: head, heave: 0.05, frequency: 1, phase: 90, speed: 0}}]\n";
    struct case_values values;
    school_settings(&values, text);
    struct simulation *const simulation = school_simulation(text);
    struct steady_problem problem;
    school_ok(steady_problem_create(&problem, &values.steady, simulation));
    assert_int_equal(problem.n_unknowns, 0);
    school_ok(steady_search_run(&problem));
    const double thrust = problem.map.last[0].thrust, power = problem.map.last[0].driving;
    for (int i = 0; i < 10; i++) school_ok(steady_map_beat(&problem.map, NULL, NULL));
    NEAR(problem.map.last[0].thrust, thrust, 0, 1e-3);
    NEAR(problem.map.last[0].driving, power, 0, 1e-4);
    steady_problem_free(&problem);
    simulate_free(simulation);
    case_free(&values);
}

// the search of a case is refused, or fails, with these words
static void fails_with(const char *text, enum status want, const char *words) {
    struct case_values values;
    school_settings(&values, text);
    struct simulation *const simulation = school_simulation(text);
    struct steady_problem problem;
    enum status status = steady_problem_create(&problem, &values.steady, simulation);
    if (status == STATUS_OK) status = steady_search_run(&problem);
    assert_int_equal(status, want);
    if (!strstr(status_message(), words)) fail_msg("\"%s\" is not in \"%s\"", words, status_message());
    steady_problem_free(&problem);
    simulate_free(simulation);
    case_free(&values);
}

static void what_can_have_no_steady_state_is_refused_with_the_reason(void **state) {
    (void)state;
    fails_with(SCHOOL_SECOND COARSE "fish: [{" FISH ", wave: {frequency: 1.01}}]\n", STATUS_CASE,
               "set time.shedding_interval to 0.0495049505, and");
    fails_with(SCHOOL_SECOND COARSE "fish: [{" FISH ", wave: {frequency: 0, amplitude: 0}}]\n", STATUS_CASE,
               "no fish beats");
    fails_with(SCHOOL_SECOND COARSE "defaults: {fish: {" FISH
                                    ", motion: {driven: all}}}\n"
                                    "fish: [{}, {start: {position: [3, 0]}, motion: {heave: 0.1, frequency: 2}}]\n",
               STATUS_CASE, "fish1 beats 1 times a second and fish2 2 times");
    fails_with(SCHOOL_SECOND COARSE "fluid: {gust: {amplitude: 0.1, frequency: 1.5}}\nfish: [{" FISH "}]\n",
               STATUS_CASE, "1.5 gusts");
    fails_with(SCHOOL_SECOND COARSE "fluid: {shear: 0.1}\nfish: [{" FISH "}]\n", STATUS_CASE, "shear");
    fails_with(SCHOOL_SECOND COARSE "fluid: {walls: [-1]}\nfish: [{" FISH "}]\n", STATUS_CASE, "beside a wall");
    fails_with(SCHOOL_SECOND COARSE "fish: [{" FISH ", control: {waypoints: [[9, 0]]}}]\n", STATUS_CASE, "waypoints");
    fails_with(SCHOOL_SECOND COARSE "defaults: {fish: {" FISH "}}\nfish: [{}, {start: {position: [3, 0]}}]\n",
               STATUS_CASE, "2 of 2 fish swim at speeds of their own");
}

static void a_search_that_takes_too_long_says_how_far_it_came(void **state) {
    (void)state;
    fails_with(SCHOOL_SECOND COARSE "steady: {beats: 5}\nfish: [{" FISH "}]\n", STATUS_SOLVER,
               "no steady state in 5 beats (steady.beats)");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(speed_and_multiplier_are_those_of_a_long_run),
        cmocka_unit_test(the_state_stays_where_its_multipliers_are_taken),
        cmocka_unit_test(a_held_fish_is_steady_when_its_forces_repeat),
        cmocka_unit_test(what_can_have_no_steady_state_is_refused_with_the_reason),
        cmocka_unit_test(a_search_that_takes_too_long_says_how_far_it_came),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
