/* test_shoal.c: the public interface: every function of shoal.h, and that it is the simulation underneath. */
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/version.h"
#include "failing_malloc.h"
#include "school.h"
#include "shoal.h"

// two fish that differ in what a call could confuse
static const char case_text[] =
    "format: 1\n"
    "name: two\n"
    "time: {end: 0.1, shedding_interval: 0.02}\n"
    "wake: {shedding: continuous, taper: 0, taper_beside: 0}\n"
    "defaults: {fish: {start: {speed: 1}}}\n"
    "fish:\n"
    "  - {name: a, nodes: 5, sheet_points: 7}\n"
    "  - {name: b, nodes: 7, sheet_points: 9, start: {position: [0.2, 0.7]}, wave: {phase: 60}}\n";

static int write_case(void **state) {
    static char path[] = "/tmp/test_shoal_XXXXXX";
    const int descriptor = mkstemp(path);
    FILE *const file = descriptor < 0 ? NULL : fdopen(descriptor, "w");
    if (!file) return -1;
    fputs(case_text, file);
    *state = path;
    return fclose(file);
}

static int remove_case(void **state) {
    return unlink(*state);
}

static struct shoal *opened(const char *path, int n_assignments, const char *const *assignments) {
    struct shoal *run;
    if (shoal_open(&run, path, n_assignments, assignments) != 0) fail_msg("%s", shoal_message());
    assert_non_null(run);
    return run;
}

static void a_run_begins_with_the_start_of_its_case(void **state) {
    struct shoal *const run = opened(*state, 0, NULL);
    NEAR(shoal_time(run), 0, 0, 0);
    NEAR(shoal_end(run), 0.1, 0, 0);
    assert_int_equal(shoal_n_fish(run), 2);
    assert_int_equal(shoal_n_nodes(run, 0), 5);
    assert_int_equal(shoal_n_nodes(run, 1), 7);
    assert_int_equal(shoal_n_vortices(run, 0), 0);
    // the heading is 180 degrees: the body lies along +x from the nose
    double x[7], y[7];
    shoal_nodes(run, 1, x, y);
    for (int k = 0; k < 7; k++) {
        NEAR(x[k], 0.2 + k / 6.0, 1e-15, 0);
        NEAR(y[k], 0.7, 1e-15, 0);
    }
    shoal_close(run);
}

static void assignments_change_the_case(void **state) {
    const char *const assignments[] = {"time.end=0.06", "fish[0].nodes=9"};
    struct shoal *run = opened(*state, 1, assignments);
    NEAR(shoal_end(run), 0.06, 0, 0);
    assert_int_equal(shoal_n_nodes(run, 0), 5);
    shoal_close(run);
    run = opened(*state, 2, assignments);
    assert_int_equal(shoal_n_nodes(run, 0), 9);
    assert_int_equal(shoal_n_nodes(run, 1), 7);
    shoal_close(run);
}

static void a_step_goes_to_the_next_event_and_releases_a_vortex_of_each_fish(void **state) {
    struct shoal *const run = opened(*state, 0, NULL);
    int n_steps = 0;
    while (shoal_time(run) < shoal_end(run)) {
        assert_int_equal(shoal_step(run), 0);
        n_steps++;
        NEAR(shoal_time(run), n_steps * 0.02, 0, 0);
        assert_int_equal(shoal_n_vortices(run, 0), n_steps);
        assert_int_equal(shoal_n_vortices(run, 1), n_steps);
    }
    assert_int_equal(n_steps, 5);
    shoal_close(run);
}

static void bodies_and_wakes_are_those_of_the_simulation(void **state) {
    struct case_values values;
    struct simulation *simulation;
    school_ok(case_read(&values, *state, 0, NULL));
    school_ok(simulate_create(&simulation, &values));
    struct shoal *const run = opened(*state, 0, NULL);
    for (int i = 0; i < 5; i++) {
        school_ok(simulate_step(simulation));
        assert_int_equal(shoal_step(run), 0);
    }
    for (int f = 0; f < 2; f++) {
        const struct fish *const fish = &simulation->school->fish[f];
        const double *const unknown = simulation->state->y;
        const struct wake *const wake = &simulation->state->wake[f];
        double x[7], y[7], circulation[5];
        shoal_nodes(run, f, x, y);
        NEAR_ARRAY(fish->n_nodes, x, unknown + fish->at.x, 0, 0);
        NEAR_ARRAY(fish->n_nodes, y, unknown + fish->at.y, 0, 0);
        shoal_vortices(run, f, x, y, circulation);
        NEAR_ARRAY(5, x, wake->x, 0, 0);
        NEAR_ARRAY(5, y, wake->y, 0, 0);
        NEAR_ARRAY(5, circulation, wake->circulation, 0, 0);
        // no two of them are equal, so that an order or a fish taken for another shows
        for (int i = 0; i < 4; i++) assert_true(wake->x[i] > wake->x[i + 1] && fabs(circulation[i]) > 0);
    }
    shoal_close(run);
    simulate_free(simulation);
    case_free(&values);
}

static void two_runs_do_not_know_each_other(void **state) {
    struct shoal *const one = opened(*state, 0, NULL), *const other = opened(*state, 0, NULL);
    assert_int_equal(shoal_step(one), 0);
    assert_int_equal(shoal_step(one), 0);
    assert_int_equal(shoal_step(other), 0);
    NEAR(shoal_time(one), 0.04, 0, 0);
    NEAR(shoal_time(other), 0.02, 0, 0);
    shoal_close(one);
    assert_int_equal(shoal_step(other), 0);
    assert_int_equal(shoal_n_vortices(other, 1), 2);
    shoal_close(other);
}

// the message of a case that cannot be opened
static const char *refusal(const char *path, const char *assignment) {
    struct shoal *run = (struct shoal *)&run;  // not NULL
    assert_true(shoal_open(&run, path, assignment ? 1 : 0, &assignment) < 0);
    assert_null(run);
    return shoal_message();
}

static void what_cannot_be_opened_is_refused_with_the_words_of_the_program(void **state) {
    const char *const path = *state;
    assert_non_null(
        strstr(refusal("/no/such/case.yaml", NULL), "/no/such/case.yaml: error: the case file cannot be read"));
    assert_non_null(strstr(refusal(path, "fish[0].wave.amplitud=1"), "did you mean 'amplitude'?"));
    assert_non_null(strstr(refusal(path, "fish[1].start.position=[0.1, 0]"), "overlap"));
    assert_non_null(strstr(refusal(path, "sweep=[{key: solver.rtol, values: [1e-4]}]"), "shoal study"));
}

static void a_run_that_fails_can_be_read_and_closed(void **state) {
    const char *const assignments[] = {"solver.max_steps=1"};
    struct shoal *const run = opened(*state, 1, assignments);
    assert_true(shoal_step(run) < 0);
    assert_non_null(strstr(shoal_message(), "solver.max_steps"));
    double x[7], y[7];
    shoal_nodes(run, 1, x, y);
    assert_true(isfinite(x[6]) && isfinite(y[6]));
    assert_true(shoal_time(run) < shoal_end(run));
    shoal_close(run);
}

static void *fail_in_a_thread(void *message) {
    struct shoal *run;
    if (shoal_open(&run, "/no/such/thread.yaml", 0, NULL) != 0)
        *(int *)message = strstr(shoal_message(), "thread") != NULL;
    return NULL;
}

static void each_thread_has_its_own_message(void **state) {
    (void)state;
    refusal("/no/such/case.yaml", NULL);
    pthread_t thread;
    int has_message = 0;
    assert_int_equal(pthread_create(&thread, NULL, fail_in_a_thread, &has_message), 0);
    assert_int_equal(pthread_join(thread, NULL), 0);
    assert_true(has_message);
    assert_non_null(strstr(shoal_message(), "/no/such/case.yaml"));
}

static void closing_nothing_is_allowed(void **state) {
    (void)state;
    shoal_close(NULL);
}

static void opening_without_memory_fails_and_leaves_nothing(void **state) {
    int n_failed = 0, is_reached = 1;
    for (int n = 0; is_reached; n++) {
        const int n_before = n_live;
        struct shoal *run;
        n_until_failure = n;
        const int code = shoal_open(&run, *state, 0, NULL);
        is_reached = n_until_failure == -1;
        n_until_failure = -1;
        n_failed += code != 0;
        assert_true(code == 0 ? run != NULL : code < 0 && !run && shoal_message()[0] != '\0');
        shoal_close(run);
        assert_int_equal(n_live, n_before);
        assert_true(n < 10000);
    }
    print_message("%d failures\n", n_failed);
    assert_true(n_failed > 100);
}

static void the_version_is_that_of_the_program(void **state) {
    (void)state;
    assert_string_equal(shoal_version(), version_short());
    assert_memory_equal(shoal_version(), "shoal ", 6);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_run_begins_with_the_start_of_its_case),
        cmocka_unit_test(assignments_change_the_case),
        cmocka_unit_test(a_step_goes_to_the_next_event_and_releases_a_vortex_of_each_fish),
        cmocka_unit_test(bodies_and_wakes_are_those_of_the_simulation),
        cmocka_unit_test(two_runs_do_not_know_each_other),
        cmocka_unit_test(what_cannot_be_opened_is_refused_with_the_words_of_the_program),
        cmocka_unit_test(a_run_that_fails_can_be_read_and_closed),
        cmocka_unit_test(each_thread_has_its_own_message),
        cmocka_unit_test(closing_nothing_is_allowed),
        cmocka_unit_test(opening_without_memory_fails_and_leaves_nothing),
        cmocka_unit_test(the_version_is_that_of_the_program),
    };
    return cmocka_run_group_tests(tests, write_case, remove_case);
}
