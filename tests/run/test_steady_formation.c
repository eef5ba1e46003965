/* test_steady_formation.c: the places that fish keep behind one another. doc/steady.md. */
#include "run/steady_multipliers.h"
#include "run/steady_search.h"
#include "school.h"

// two plates that heave, the follower about a wavelength behind
static void a_follower_finds_the_place_where_it_is_as_fast_as_its_leader(void **state) {
    (void)state;
    static const char text[] = SCHOOL_SECOND
        "time: {end: 1, shedding_interval: 0.05, output_interval: 0.05}\nfluid: {density: 1, viscosity: 2e-3}\nwake: "
        "{lifetime: 3, smoothing: 0.2}\n"
        "steady: {formation: true, tolerance: 3e-3}\n"
        "defaults: {fish: {nodes: 5, sheet_points: 17, force: pressure, start: {speed: 3.8},\n"
        "  wave: {amplitude: 0, frequency: 0}, motion: {driven: all, surge: free, heave: 0.15, frequency: 1},\n"
        "  body: {profile: uniform, thickness: 0.05, width: 1, density: 20}}}\n"
        "fish: [{}, {start: {position: [4.8, 0]}}]\n";
    struct case_values values;
    school_settings(&values, text);
    struct simulation *const simulation = school_simulation(text);
    struct steady_problem problem;
    school_ok(steady_problem_create(&problem, &values.steady, simulation));
    // two speeds and a distance
    assert_int_equal(problem.n_unknowns, 3);
    school_ok(steady_search_run(&problem));
    const struct steady_beat *const last = problem.map.last;
    NEAR(last[1].speed, last[0].speed, 3e-3, 0);
    // from tail to nose about one wavelength, as in experiments: doc/verification.md
    NEAR((-last[1].place[0] - 1) / last[0].speed, 1, 0.1, 0);
    NEAR(last[1].place[1], 0, 1e-12, 0);
    double real[3], imaginary[3];
    int n_beats;
    school_ok(steady_multipliers_find(&problem, real, imaginary, &n_beats));
    assert_true(hypot(real[0], imaginary[0]) < 1);
    // it is stable, so beats without a search keep it
    for (int i = 0; i < 5; i++) school_ok(steady_map_beat(&problem.map, NULL, NULL));
    assert_true(steady_map_residual(&problem.map) < 3e-3);
    steady_problem_free(&problem);
    simulate_free(simulation);
    case_free(&values);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_follower_finds_the_place_where_it_is_as_fast_as_its_leader),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
