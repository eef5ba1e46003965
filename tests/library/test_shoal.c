/* test_shoal.c: Every function of shoal.h is called, and a run through the library has the same bits as the simulation
 * inside the program. */
#include <limits.h>
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/version.h"
#include "failing_malloc.h"
#include "library/handle.h"
#include "result/checkpoint.h"
#include "result/durable.h"
#include "result/netcdf.h"
#include "result/result_table.h"
#include "school.h"
#include "shoal.h"

// two fish with different sizes and positions
static const char case_text[] =
    "format: 1\nname: two\ntime: {end: 0.1, shedding_interval: 0.02}\n"
    "wake: {shedding: continuous, taper: 0, taper_beside: 0}\n"
    "defaults: {fish: {start: {speed: 1}, body: {thickness: 0.2, depth: 0.25, modulus: 1e6}}}\nfish:\n"
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

TEST_GROUP(write_case, remove_case)

// a run that the test closes
static struct shoal *open_run(const char *path, int n_assignments, const char *const *assignments) {
    struct shoal *run;
    assert_int_equal(shoal_open(&run, path, n_assignments, assignments), SHOAL_OK);
    assert_non_null(run);
    return run;
}

static void close_run(void *run) {
    shoal_close(run);
}

// a run until the end of the test
static struct shoal *kept(struct shoal *run) {
    arena_defer(test_arena(), close_run, run);
    return run;
}

static struct shoal *opened(const char *path, int n_assignments, const char *const *assignments) {
    return kept(open_run(path, n_assignments, assignments));
}

static struct shoal *copy_of(struct shoal *run) {
    struct shoal *copy;
    assert_int_equal(shoal_clone(&copy, run), SHOAL_OK);
    return kept(copy);
}

TEST(a_run_begins_with_the_start_of_its_case) {
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
}

TEST(assignments_change_the_case) {
    const char *const assignments[] = {"time.end=0.06", "fish[0].nodes=9"};
    struct shoal *run = opened(*state, 1, assignments);
    NEAR(shoal_end(run), 0.06, 0, 0);
    assert_int_equal(shoal_n_nodes(run, 0), 5);
    run = opened(*state, 2, assignments);
    assert_int_equal(shoal_n_nodes(run, 0), 9);
    assert_int_equal(shoal_n_nodes(run, 1), 7);
}

TEST(a_step_goes_to_the_next_event_and_releases_a_vortex_of_each_fish) {
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
}

// ---- stops

static volatile int stop;

static void set_stop(int number) {
    (void)number;
    stop = 1;
}

/* Set stop after this time, once. */
static void stop_after(int milliseconds) {
    stop = 0;
    signal(SIGALRM, set_stop);
    const struct itimerval once = {.it_value = {0, 1000 * milliseconds}};
    assert_int_equal(setitimer(ITIMER_REAL, &once, NULL), 0);
}

TEST(a_stopped_step_returns_to_the_last_event_and_the_run_continues) {
    // 100,000 steps for an event: seconds to minutes
    const char *const assignments[] = {"solver.method=rk4", "solver.step=2e-7", "solver.max_steps=1000000"};
    struct shoal *const run = opened(*state, 3, assignments);
    stop_after(30);
    shoal_listen(&stop);
    assert_int_equal(shoal_step(run), SHOAL_STOPPED);
    assert_non_null(strstr(shoal_message(), "shoal_step: stopped: the run is at the last event, t = 0 s"));
    stop_after(30);
    assert_int_equal(shoal_advance(run, shoal_end(run)), SHOAL_STOPPED);
    NEAR(shoal_time(run), 0, 0, 0);

    // a flag that is set already leaves the run as it is
    assert_int_equal(shoal_step(run), SHOAL_STOPPED);
    shoal_listen(NULL);

    // the same run with fewer steps
    struct shoal *const other = opened(*state, 2, (const char *[]){"solver.method=rk4", "solver.step=2e-5"});
    struct shoal *const copy = copy_of(other);
    stop_after(5);
    shoal_listen(&stop);
    const int status = shoal_step(other);
    shoal_listen(NULL);
    assert_int_equal(status, SHOAL_STOPPED);
    struct shoal_array time, again, steps;
    assert_int_equal(shoal_read(other, "time", &time), SHOAL_OK);
    assert_int_equal(shoal_read(other, "steps", &steps), SHOAL_OK);
    NEAR(*(const double *)time.values, 0, 0, 0);
    assert_int_equal(*(const long *)steps.values, 0);
    for (int i = 0; i < 2; i++) assert_int_equal(shoal_step(other), SHOAL_OK);
    for (int i = 0; i < 2; i++) assert_int_equal(shoal_step(copy), SHOAL_OK);
    assert_int_equal(shoal_read(other, "x", &time), SHOAL_OK);
    assert_int_equal(shoal_read(copy, "x", &again), SHOAL_OK);
    assert_memory_equal(time.values, again.values, 2 * 7 * 2 * sizeof(double));
    assert_int_equal(shoal_read(copy, "steps", &again), SHOAL_OK);
    assert_int_equal(shoal_read(other, "steps", &steps), SHOAL_OK);
    assert_int_equal(*(const long *)steps.values, *(const long *)again.values);
}

TEST(bodies_and_wakes_are_those_of_the_simulation) {
    struct case_values values;
    struct simulation *simulation;
    school_ok(case_read(&values, *state, 0, NULL));
    school_ok(simulate_start(test_arena(), &simulation, &values, NULL));
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
        // all values differ: a wrong order or a wrong fish changes the result
        for (int i = 0; i < 4; i++) {
            ABOVE(wake->x[i], wake->x[i + 1]);
            ABOVE(fabs(circulation[i]), 0);
        }
    }
    case_free(&values);
}

TEST(two_runs_do_not_know_each_other) {
    struct shoal *const one = open_run(*state, 0, NULL), *const other = opened(*state, 0, NULL);
    assert_int_equal(shoal_step(one), 0);
    assert_int_equal(shoal_step(one), 0);
    assert_int_equal(shoal_step(other), 0);
    NEAR(shoal_time(one), 0.04, 0, 0);
    NEAR(shoal_time(other), 0.02, 0, 0);
    shoal_close(one);
    assert_int_equal(shoal_step(other), 0);
    assert_int_equal(shoal_n_vortices(other, 1), 2);
}

// the message of a case that cannot be opened
static const char *refusal(const char *path, const char *assignment) {
    struct shoal *run = (struct shoal *)&run;  // not NULL
    BELOW(shoal_open(&run, path, assignment ? 1 : 0, &assignment), 0);
    assert_null(run);
    return shoal_message();
}

TEST(what_cannot_be_opened_is_refused_with_the_words_of_the_program) {
    const char *const path = *state;
    assert_non_null(
        strstr(refusal("/no/such/case.yaml", NULL), "/no/such/case.yaml: error: the case file cannot be read"));
    assert_non_null(strstr(refusal(path, "fish[0].wave.amplitud=1"), "did you mean 'amplitude'?"));
    assert_non_null(strstr(refusal(path, "fish[1].start.position=[0.1, 0]"), "overlap"));
    assert_non_null(strstr(refusal(path, "sweep=[{key: solver.rtol, values: [1e-4]}]"), "shoal study"));
}

TEST(a_run_that_fails_can_be_read_and_closed) {
    const char *const assignments[] = {"solver.max_steps=1"};
    struct shoal *const run = opened(*state, 1, assignments);
    BELOW(shoal_step(run), 0);
    assert_non_null(strstr(shoal_message(), "solver.max_steps"));
    double x[7], y[7];
    shoal_nodes(run, 1, x, y);
    assert_true(isfinite(x[6]) && isfinite(y[6]));
    BELOW(shoal_time(run), shoal_end(run));
}

static void *fail_in_a_thread(void *message) {
    struct shoal *run;
    if (shoal_open(&run, "/no/such/thread.yaml", 0, NULL) != 0)
        *(bool *)message = strstr(shoal_message(), "thread") != NULL;
    return NULL;
}

TEST(each_thread_has_its_own_message) {
    refusal("/no/such/case.yaml", NULL);
    pthread_t thread;
    bool has_message = false;
    assert_int_equal(pthread_create(&thread, NULL, fail_in_a_thread, &has_message), 0);
    assert_int_equal(pthread_join(thread, NULL), 0);
    assert_true(has_message);
    assert_non_null(strstr(shoal_message(), "/no/such/case.yaml"));
}

enum { N_THREADS = 6, N_ROUNDS = 2 };

/* One thread: own runs, and a copy of a run that all threads copy in turn. */
struct worker {
    int number;
    const char *path;
    struct shoal *origin;
    pthread_mutex_t *turn;
    double nose; /* final position of the nose, m */
    int failed;
};

static int swim_a_copy(struct worker *worker, struct shoal *run) {
    struct shoal *copy, *other;
    const double frequency = 1 + 0.1 * worker->number;
    double flow[2], vorticity;
    if (shoal_clone(&copy, run) != SHOAL_OK) return 1;
    int failed = shoal_set(copy, 0, "wave.frequency", 1, &frequency) != SHOAL_OK;
    failed |= shoal_advance(copy, 0.1) != SHOAL_OK || shoal_restore(copy, run) != SHOAL_OK;
    failed |= shoal_flow(copy, 1, (double[]){1, 0.5}, flow, &vorticity) != SHOAL_OK;
    pthread_mutex_lock(worker->turn);
    failed |= shoal_clone(&other, worker->origin) != SHOAL_OK;
    pthread_mutex_unlock(worker->turn);
    failed |= shoal_restore(other, copy) == SHOAL_OK;  // not copies of one another
    failed |= shoal_advance(other, 0.04) != SHOAL_OK;
    shoal_close(other);
    shoal_close(copy);
    return failed;
}

static void *swim_in_a_thread(void *data) {
    struct worker *const worker = data;
    char file[64];
    snprintf(file, sizeof file, "/tmp/test_shoal_%ld_%d.nc", (long)getpid(), worker->number);
    for (int round = 0; round < N_ROUNDS; round++) {
        struct shoal *run;
        struct shoal_array x;
        worker->failed |= shoal_open(&run, worker->path, 0, NULL) != SHOAL_OK;
        worker->failed |= shoal_write(run, file, 1) != SHOAL_OK || shoal_advance(run, 0.04) != SHOAL_OK;
        worker->failed |= swim_a_copy(worker, run);
        worker->failed |= shoal_advance(run, 0.1) != SHOAL_OK || shoal_read(run, "x", &x) != SHOAL_OK;
        if (!worker->failed) worker->nose = ((const double *)x.values)[0];
        worker->failed |= shoal_write_end(run) != SHOAL_OK;
        shoal_close(run);
        worker->failed |= shoal_open(&run, "/no/such/case.yaml", 0, NULL) != SHOAL_FILE;
    }
    worker->failed |= unlink(file) != 0;
    return NULL;
}

TEST(runs_in_many_threads_are_those_alone) {
    pthread_mutex_t turn = PTHREAD_MUTEX_INITIALIZER;
    struct shoal *const origin = opened(*state, 0, NULL);
    struct worker alone = {.path = *state, .origin = origin, .turn = &turn}, worker[N_THREADS];
    pthread_t thread[N_THREADS];
    swim_in_a_thread(&alone);
    assert_int_equal(alone.failed, 0);
    for (int i = 0; i < N_THREADS; i++) {
        worker[i] = (struct worker){.number = i, .path = *state, .origin = origin, .turn = &turn};
        assert_int_equal(pthread_create(&thread[i], NULL, swim_in_a_thread, &worker[i]), 0);
    }
    for (int i = 0; i < N_THREADS; i++) {
        assert_int_equal(pthread_join(thread[i], NULL), 0);
        assert_int_equal(worker[i].failed, 0);
        NEAR(worker[i].nose, alone.nose, 0, 0);
    }
}

TEST(closing_nothing_is_allowed) {
}

// ---- checked arguments

static void refuses(int code, const char *words) {
    assert_int_equal(code, SHOAL_USAGE);
    if (!strstr(shoal_message(), words)) fail_msg("'%s' is not in: %s", words, shoal_message());
}

TEST(a_run_that_is_not_there_is_refused_by_every_function) {
    double two[2] = {0, 0};
    struct shoal_array array;
    refuses(shoal_open(NULL, "x.yaml", 0, NULL), "run is NULL");
    refuses(shoal_open_text(NULL, "", NULL, 0, NULL), "run is NULL");
    refuses(shoal_step(NULL), "run is NULL");
    refuses(shoal_advance(NULL, 0), "run is NULL");
    refuses(shoal_read(NULL, "x", &array), "run is NULL");
    refuses(shoal_flow(NULL, 1, two, two, NULL), "run is NULL");
    refuses(shoal_n_fish(NULL), "run is NULL");
    refuses(shoal_n_nodes(NULL, 0), "run is NULL");
    refuses(shoal_n_vortices(NULL, 0), "run is NULL");
    refuses(shoal_nodes(NULL, 0, two, two), "run is NULL");
    refuses(shoal_vortices(NULL, 0, two, two, two), "run is NULL");
    refuses(shoal_write(NULL, "x.nc", 0), "run is NULL");
    refuses(shoal_write_end(NULL), "run is NULL");
    refuses(shoal_checkpoint(NULL), "run is NULL");
    assert_true(isnan(shoal_time(NULL)) && isnan(shoal_end(NULL)) && isnan(shoal_interval(NULL)));
    assert_non_null(strstr(shoal_message(), "shoal_interval: run is NULL"));
}

TEST(a_fish_that_is_not_there_is_refused) {
    struct shoal *const run = opened(*state, 0, NULL);
    double x[7], y[7];
    const int wrong[] = {-1, 2, 99, INT_MAX, INT_MIN};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        refuses(shoal_n_nodes(run, wrong[i]), "this run has 2 fish, numbered from 0");
        refuses(shoal_n_vortices(run, wrong[i]), "shoal_n_vortices: there is no fish");
        refuses(shoal_nodes(run, wrong[i], x, y), "there is no fish");
        refuses(shoal_vortices(run, wrong[i], x, y, x), "there is no fish");
    }
}

TEST(arrays_that_are_not_there_are_refused) {
    struct shoal *const run = opened(*state, 0, NULL);
    assert_int_equal(shoal_step(run), SHOAL_OK);
    double x[7];
    struct shoal_array array;
    refuses(shoal_nodes(run, 0, NULL, x), "x is NULL");
    refuses(shoal_nodes(run, 0, x, NULL), "y is NULL");
    refuses(shoal_vortices(run, 0, x, x, NULL), "circulation is NULL");
    refuses(shoal_read(run, "x", NULL), "array is NULL");
    refuses(shoal_read(run, NULL, &array), "name is NULL");
    refuses(shoal_flow(run, 1, NULL, x, x), "points is NULL");
    refuses(shoal_flow(run, 1, x, NULL, x), "velocity is NULL");
    refuses(shoal_flow(run, -1, x, x, x), "-1 points");
    refuses(shoal_flow(run, 2, (double[]){0, 1, 0.5, NAN}, x, x), "point 1, (0.5, nan), is not finite");
    refuses(shoal_write(run, NULL, 0), "path is NULL");
}

TEST(what_a_fish_is_set_to_is_checked) {
    struct shoal *const run = opened(*state, 0, NULL);
    const double value = 0.2;
    refuses(shoal_set(NULL, 0, "wave.amplitude", 1, &value), "run is NULL");
    refuses(shoal_set(run, 2, "wave.amplitude", 1, &value), "there is no fish 2");
    refuses(shoal_set(run, 0, NULL, 1, &value), "key is NULL");
    refuses(shoal_set(run, 0, "wave.amplitude", 1, NULL), "values is NULL");
    refuses(shoal_set(run, 0, "wave.amplitud", 1, &value), "'wave.amplitud' cannot be set");
    assert_int_equal(shoal_set(run, 1, "wave.amplitude", 1, &value), SHOAL_OK);
    assert_int_equal(shoal_advance(run, 0.1), SHOAL_OK);
}

static double of_fish(struct shoal *run, const char *name, int fish) {
    struct shoal_array array;
    if (shoal_read(run, name, &array) != SHOAL_OK) fail_msg("%s", shoal_message());
    return ((const double *)array.values)[fish];
}

// both values change by half within half of control.ramp
TEST(the_gait_in_force_can_be_read) {
    const char *const more[] = {"time.end=0.6", "fish[*].wave.ramp=0.1", "fish[*].control.ramp=0.2"};
    struct shoal *const run = opened(*state, 3, more);
    NEAR(of_fish(run, "wave_amplitude", 0), 0, 0, 0);
    assert_int_equal(shoal_advance(run, 0.2), SHOAL_OK);
    NEAR(of_fish(run, "wave_amplitude", 0), 0.4, 1e-15, 0);
    NEAR(of_fish(run, "wave_frequency", 0), 1, 1e-15, 0);
    const double amplitude = 0.3, frequency = 1.4, bias = 0.1;
    assert_int_equal(shoal_set(run, 0, "wave.amplitude", 1, &amplitude), SHOAL_OK);
    assert_int_equal(shoal_set(run, 0, "wave.frequency", 1, &frequency), SHOAL_OK);
    assert_int_equal(shoal_set(run, 0, "control.bias", 1, &bias), SHOAL_OK);
    assert_int_equal(shoal_advance(run, 0.3), SHOAL_OK);
    NEAR(of_fish(run, "wave_amplitude", 0), 0.35, 1e-12, 0);
    NEAR(of_fish(run, "wave_frequency", 0), 1.2, 1e-12, 0);
    NEAR(of_fish(run, "phi0", 0), 0.05, 1e-5, 0);  // an unknown, within the tolerance of the solver
    assert_int_equal(shoal_advance(run, 0.4), SHOAL_OK);
    NEAR(of_fish(run, "wave_amplitude", 0), 0.3, 1e-12, 0);
    NEAR(of_fish(run, "wave_frequency", 0), 1.4, 1e-12, 0);
    NEAR(of_fish(run, "wave_frequency", 1), 1, 0, 0);
    NEAR(of_fish(run, "frequency", 0), 1, 0, 0);  // frequency of the case, for means over a period
}

TEST(assignments_are_checked) {
    struct shoal *run;
    const char *const none = NULL;
    refuses(shoal_open(&run, *state, -1, NULL), "-1 assignments");
    refuses(shoal_open(&run, *state, 1, NULL), "assignments is NULL");
    refuses(shoal_open(&run, *state, 1, &none), "assignment 0 is NULL");
    refuses(shoal_open(&run, NULL, 0, NULL), "case_path is NULL");
    refuses(shoal_open_text(&run, NULL, NULL, 0, NULL), "text is NULL");
    assert_null(run);
}

TEST(a_step_past_the_end_is_refused) {
    struct shoal *const run = opened(*state, 0, NULL);
    assert_int_equal(shoal_advance(run, shoal_end(run)), SHOAL_OK);
    NEAR(shoal_time(run), 0.1, 1e-15, 0);
    refuses(shoal_step(run), "the run is at its end, t = 0.1 s");
    NEAR(shoal_time(run), 0.1, 1e-15, 0);
}

TEST(a_run_advances_to_the_event_at_or_after_a_time) {
    struct shoal *const run = opened(*state, 0, NULL);
    NEAR(shoal_interval(run), 0.02, 0, 0);
    assert_int_equal(shoal_advance(run, 0.03), SHOAL_OK);
    NEAR(shoal_time(run), 0.04, 0, 0);
    assert_int_equal(shoal_advance(run, 0.06 * (1 + 1e-15)), SHOAL_OK);  // 0.06 but for rounding
    NEAR(shoal_time(run), 0.06, 0, 0);
    assert_int_equal(shoal_advance(run, 0.05), SHOAL_OK);  // the present event
    NEAR(shoal_time(run), 0.06, 0, 0);
    refuses(shoal_advance(run, 0.04), "before the last event, at 0.06 s");
    refuses(shoal_advance(run, -1), "before the last event, at 0.06 s");
    refuses(shoal_advance(run, 0.11), "t = 0.11 s is after the end of the case, 0.1 s");
    refuses(shoal_advance(run, NAN), "not finite");
    NEAR(shoal_time(run), 0.06, 0, 0);
}

TEST(a_failed_run_makes_no_step_and_says_why) {
    const char *const assignments[] = {"solver.max_steps=1"};
    struct shoal *const run = opened(*state, 1, assignments);
    assert_int_equal(shoal_step(run), SHOAL_SOLVER);
    double two[2] = {0, 0};
    assert_int_equal(shoal_step(run), SHOAL_SOLVER);
    assert_non_null(strstr(shoal_message(), "the run has failed before: limited by solver.max_steps at t = "));
    assert_int_equal(shoal_advance(run, 0.1), SHOAL_SOLVER);
    assert_int_equal(shoal_flow(run, 1, two, two, two), SHOAL_SOLVER);
    assert_int_equal(shoal_write(run, "/tmp/never.nc", 0), SHOAL_SOLVER);
}

TEST(a_run_that_ends_in_contact_has_failed) {
    const char *const assignments[] = {"contact.action=stop", "fish[1].start.position=[0.2,0.25]",
                                       "fish[1].start.heading=225"};
    struct shoal *const run = opened(*state, 3, assignments);
    assert_int_equal(shoal_advance(run, shoal_end(run)), SHOAL_SOLVER);
    const char *const message = shoal_message();
    if (!strstr(message, "come within") && !strstr(message, "contact")) fail_msg("%s", message);
    assert_int_equal(shoal_step(run), SHOAL_SOLVER);
    assert_non_null(strstr(shoal_message(), "the run has failed before: "));
}

// ---- a case from text

TEST(the_text_of_a_case_is_a_case) {
    struct shoal *const by_path = opened(*state, 0, NULL), *by_text;
    assert_int_equal(shoal_open_text(&by_text, case_text, NULL, 0, NULL), SHOAL_OK);
    kept(by_text);
    double x[2][7], y[2][7];
    assert_int_equal(shoal_advance(by_path, 0.04), SHOAL_OK);
    assert_int_equal(shoal_advance(by_text, 0.04), SHOAL_OK);
    assert_int_equal(shoal_nodes(by_path, 1, x[0], y[0]), SHOAL_OK);
    assert_int_equal(shoal_nodes(by_text, 1, x[1], y[1]), SHOAL_OK);
    NEAR_ARRAY(7, x[0], x[1], 0, 0);
    NEAR_ARRAY(7, y[0], y[1], 0, 0);
}

TEST(an_error_in_a_text_has_its_line) {
    struct shoal *run;
    assert_int_equal(shoal_open_text(&run, "format: 1\nname: x\nfihs: []\n", NULL, 0, NULL), SHOAL_USAGE);
    assert_null(run);
    assert_non_null(strstr(shoal_message(), "case:3:"));
}

// ---- variables by name

static const double *read_doubles(struct shoal *run, const char *name, struct shoal_array *array) {
    if (shoal_read(run, name, array) != SHOAL_OK) fail_msg("%s", shoal_message());
    assert_int_equal(array->type, SHOAL_DOUBLE);
    return array->values;
}

TEST(a_variable_is_read_with_its_shape) {
    struct shoal *const run = opened(*state, 0, NULL);
    assert_int_equal(shoal_advance(run, 0.04), SHOAL_OK);
    struct shoal_array array;
    const double *const x = read_doubles(run, "x", &array);
    assert_int_equal(array.n_dimensions, 3);
    assert_int_equal(array.shape[0], 2);
    assert_int_equal(array.shape[1], 7);
    assert_int_equal(array.shape[2], 2);
    assert_string_equal(array.dimension[0], "fish");
    assert_string_equal(array.dimension[1], "node");
    assert_string_equal(array.dimension[2], "xy");
    assert_string_equal(array.unit, "m");
    double node_x[7], node_y[7];
    for (int f = 0; f < 2; f++) {
        const int n = shoal_n_nodes(run, f);
        assert_int_equal(shoal_nodes(run, f, node_x, node_y), SHOAL_OK);
        for (int k = 0; k < 7; k++) {
            const double *const node = x + (f * 7 + k) * 2;
            if (k >= n) {
                assert_true(isnan(node[0]) && isnan(node[1]));
                continue;
            }
            NEAR(node[0], node_x[k], 0, 0);
            NEAR(node[1], node_y[k], 0, 0);
        }
    }
    NEAR(*read_doubles(run, "time", &array), 0.04, 0, 0);
    assert_int_equal(array.n_dimensions, 0);
}

TEST(a_wake_is_read_without_empty_slots) {
    struct shoal *const run = opened(*state, 0, NULL);
    struct shoal_array array;
    read_doubles(run, "wake_x", &array);
    assert_int_equal(array.shape[1], 0);
    for (int n = 1; n <= 3; n++) {
        assert_int_equal(shoal_step(run), SHOAL_OK);
        const double *const wake = read_doubles(run, "wake_x", &array);
        assert_int_equal(array.shape[1], n);
        double x[3], y[3], circulation[3];
        for (int f = 0; f < 2; f++) {
            assert_int_equal(shoal_vortices(run, f, x, y, circulation), SHOAL_OK);
            for (int i = 0; i < n; i++) NEAR(wake[2 * (f * n + i)], x[i], 0, 0);
        }
    }
}

TEST(names_and_counts_are_read_too) {
    struct shoal *const run = opened(*state, 0, NULL);
    struct shoal_array array;
    assert_int_equal(shoal_read(run, "fish", &array), SHOAL_OK);
    assert_int_equal(array.type, SHOAL_CHAR);
    assert_memory_equal(array.values, "ab", 2);
    assert_int_equal(shoal_read(run, "n_nodes", &array), SHOAL_OK);
    assert_int_equal(array.type, SHOAL_INT);
    assert_int_equal(((const int *)array.values)[1], 7);
    assert_int_equal(shoal_step(run), SHOAL_OK);
    assert_int_equal(shoal_read(run, "steps", &array), SHOAL_OK);
    assert_int_equal(array.type, SHOAL_LONG);
    ABOVE(*(const long *)array.values, 0);
}

TEST(every_variable_of_the_table_can_be_read) {
    struct shoal *const run = opened(*state, 0, NULL);
    assert_int_equal(shoal_step(run), SHOAL_OK);
    int n = 0;
    for (; shoal_variable(n); n++) {
        struct shoal_array array;
        assert_int_equal(shoal_read(run, shoal_variable(n), &array), SHOAL_OK);
        assert_non_null(array.values);
    }
    assert_int_equal(n, result_table_n);
    assert_null(shoal_variable(-1));
    struct shoal_array array;
    refuses(shoal_read(run, "spede", &array), "there is no variable 'spede'");
    assert_null(array.values);
}

// the factor on a number with this unit in a system of units with other lengths and times, and the same density
static double factor_of(const char *unit, double length, double time) {
    const double force = pow(length, 4) / (time * time);
    const struct {
        const char *name;
        double factor;
    } units[] = {{"m", length}, {"s", time},           {"kg", pow(length, 3)},       {"Hz", 1 / time},
                 {"N", force},  {"J", force * length}, {"W", force * length / time}, {"Pa", force / (length * length)}};
    double factor = 1;
    char name[16];
    for (int n = 0; sscanf(unit, " %15[A-Za-z]%n", name, &n) == 1; unit += n) {
        int power = 1, n_power = 0;
        sscanf(unit + n, "%d%n", &power, &n_power);
        for (size_t i = 0; i < sizeof units / sizeof *units; i++) {
            if (strcmp(name, units[i].name) == 0) factor *= pow(units[i].factor, power);
        }
        n += n_power;
    }
    return factor;
}

static struct shoal *run_in_units(int i, double length, double time) {
    static const char *const fish[] = {
        "wave: {frequency: %.17g}}}\nfish:\n"
        "  - {nodes: 7, sheet_points: 27, sensors: [0.2, 0.7], load: {tip: [%.17g, %.17g]}, control: {law: course}}\n"
        "  - {nodes: 7, sheet_points: 15, force: reactive, start: {position: [%.17g, "
        "%.17g]}}\n  - {nodes: 9, sheet_points: 27, wave: {amplitude: 0}, start: {position: [%.17g, %.17g]},\n"
        "     motion: {prescribed: head, heave: %.17g, pitch: 10, frequency: %.17g, speed: %.17g}}\n",
        "wave: {frequency: %.17g}, sheet_points: 15, force: reactive, load: {tip: [%.17g, %.17g]}}}\n"
        "wake: {shedding: continuous, taper: 0, taper_beside: 0}\nsheet: {curve: polygon}\nfish:\n"
        "  - {drag: {skin: boundary_layer},\n"
        "     control: {law: averaged_heading, desired_heading: 150, feedforward: 1, rate: %.17g, filter: %.17g}}\n"
        "  - {start: {position: [%.17g, %.17g]},\n"
        "     motion: {prescribed: all, heave: %.17g, frequency: %.17g, speed: %.17g}}\n"};
    const double l = length, t = time, v = l / t, force = pow(l, 4) / (t * t);
    char text[4096], whole[2048];
    snprintf(whole, sizeof whole,
             "format: 1\nname: units\ntime: {end: %%.17g, shedding_interval: %%.17g}\n"
             "fluid: {viscosity: %%.17g, velocity: [%%.17g, 0], %s}\n"
             "defaults: {fish: {nodes: 7, length: %%.17g, start: {speed: %%.17g}, body: {modulus: %%.17g}, %s",
             i == 0 ? "walls: [%.17g, %.17g]" : "gust: {amplitude: %.17g, frequency: %.17g}", fish[i]);
    snprintf(text, sizeof text, whole, t, 0.02 * t, 1e-3 * l * v, 0.1 * v, i == 0 ? -0.9 * l : 0.1 * v,
             i == 0 ? 1.3 * l : 1.5 / t, l, 0.7 * v, 1e6 * v * v, 1 / t, 3 * force, -2 * force,
             i == 0 ? 0.1 * l : 2 / t, i == 0 ? 0.4 * l : 0.3 * t, -0.2 * l, -0.4 * l, 0.05 * l, 1.2 / t, 0.8 * v);
    struct shoal *run;
    if (shoal_open_text(&run, text, NULL, 0, NULL) != SHOAL_OK) fail_msg("%s", shoal_message());
    if (shoal_advance(run, 0.5 * t) != SHOAL_OK) fail_msg("%s", shoal_message());
    return kept(run);
}

// a case in other units is the same case, and every variable has the dimension of its unit; powers of two hardly round
TEST(every_variable_has_the_dimension_of_its_unit) {
    for (int i = 0; i < 2; i++) {
        struct shoal *const one = run_in_units(i, 1, 1), *const other = run_in_units(i, 4, 0.5);
        for (int n = 0; n < result_table_n; n++) {
            const struct result_variable *const of = &result_table[n];
            struct shoal_array want, got;
            if ((of->type != RESULT_REAL && of->type != RESULT_BULK) || strstr(of->name, "wall_time")) continue;
            const double *const a = read_doubles(one, of->name, &want), *const b = read_doubles(other, of->name, &got);
            const double factor = factor_of(of->unit, 4, 0.5);
            size_t size = 1;
            for (int d = 0; d < want.n_dimensions; d++) size *= (size_t)want.shape[d];
            double largest = 0;
            for (size_t k = 0; k < size; k++) largest = fmax(largest, isfinite(a[k]) ? fabs(a[k]) : 0);
            for (size_t k = 0; k < size; k++) {
                // what vanishes but for rounding is some 1e-16
                if (isfinite(a[k]) ? fabs(b[k] / factor - a[k]) <= 1e-6 * largest + 1e-15 : !isfinite(b[k])) continue;
                fail_msg("%s[%zu]: %g %s in other units, %g", of->name, k, b[k] / factor, of->unit, a[k]);
            }
        }
    }
}

TEST(what_has_been_read_holds_until_the_next_step) {
    struct shoal *const run = opened(*state, 0, NULL);
    struct shoal_array array;
    const double *const x = read_doubles(run, "x", &array), *const v = read_doubles(run, "v", &array);
    const double before = x[0];
    assert_ptr_equal(read_doubles(run, "x", &array), x);
    assert_int_equal(shoal_step(run), SHOAL_OK);
    assert_ptr_equal(read_doubles(run, "x", &array), x);
    assert_ptr_equal(read_doubles(run, "v", &array), v);
    ABOVE(fabs(x[0] - before), 0);
}

// ---- the flow

// both fish after a part of a beat that has begun at once
static struct shoal *swum(const char *path) {
    const char *const assignments[] = {"time.end=0.4", "fish[*].wave.ramp=0.1"};
    struct shoal *const run = opened(path, 2, assignments);
    assert_int_equal(shoal_advance(run, 0.4), SHOAL_OK);
    return run;
}

TEST(far_from_everything_the_flow_is_the_external_one) {
    const char *const assignments[] = {"fluid.velocity=[0.3, -0.1]", "fluid.shear=0.5"};
    struct shoal *const run = opened(*state, 2, assignments);
    assert_int_equal(shoal_advance(run, 0.1), SHOAL_OK);
    const double points[] = {1e6, 2, -1e6, -4};
    double velocity[4], vorticity[2];
    assert_int_equal(shoal_flow(run, 2, points, velocity, vorticity), SHOAL_OK);
    const double want[] = {0.3 + 0.5 * 2, -0.1, 0.3 - 0.5 * 4, -0.1};
    NEAR_ARRAY(4, velocity, want, 1e-6, 0);
    NEAR(vorticity[0], -0.5, 1e-9, 0);
}

TEST(the_circulation_around_all_of_it_is_zero_and_around_a_wake_its_own) {
    struct shoal *const run = swum(*state);
    enum { N = 4000 };
    static double points[2 * N], velocity[2 * N];
    const double pi = acos(-1), radius = 6;
    for (int i = 0; i < N; i++) {
        points[2 * i] = 0.7 + radius * cos(2 * pi * i / N);
        points[2 * i + 1] = 0.3 + radius * sin(2 * pi * i / N);
    }
    assert_int_equal(shoal_flow(run, N, points, velocity, NULL), SHOAL_OK);
    double circulation = 0, size = 0;
    for (int i = 0; i < N; i++) {
        const double along = -velocity[2 * i] * sin(2 * pi * i / N) + velocity[2 * i + 1] * cos(2 * pi * i / N);
        circulation += along * radius * 2 * pi / N;
        size += fabs(along) * radius * 2 * pi / N;
    }
    // all circulation is bound, free or nascent: together none; the smoothing leaves (delta/radius)^2 of each
    ABOVE(size, 1e-4);
    NEAR(circulation, 0, 3e-3 * size, 0);
}

TEST(vorticity_is_the_curl_of_the_velocity) {
    struct shoal *const run = swum(*state);
    const double h = 1e-4, x = 1.1, y = 0.02;
    const double points[] = {x, y, x + h, y, x - h, y, x, y + h, x, y - h};
    double velocity[10], vorticity[5];
    assert_int_equal(shoal_flow(run, 5, points, velocity, vorticity), SHOAL_OK);
    const double curl = (velocity[3] - velocity[5]) / (2 * h) - (velocity[6] - velocity[8]) / (2 * h);
    ABOVE(fabs(vorticity[0]), 1e-3);
    NEAR(vorticity[0], curl, 0, 1e-4);
}

TEST(looking_does_not_change_a_run) {
    // shoal_flow must not change the wake interpolation
    const char *const assignments[] = {"time.end=0.4", "wake.tolerance=1e-4"};
    struct shoal *const seen = opened(*state, 2, assignments), *const alone = opened(*state, 2, assignments);
    double point[2] = {1.1, 0.1}, velocity[2], vorticity;
    struct shoal_array array[2];
    for (int step = 0; step < 20; step++) {
        assert_int_equal(shoal_flow(seen, 1, point, velocity, &vorticity), SHOAL_OK);
        for (int i = 0; shoal_variable(i); i++) assert_int_equal(shoal_read(seen, shoal_variable(i), array), SHOAL_OK);
        assert_int_equal(shoal_step(seen), SHOAL_OK);
        assert_int_equal(shoal_step(alone), SHOAL_OK);
    }
    const char *const names[] = {"x", "v", "a", "sheet_strength", "wake_x", "speed", "energy_balance"};
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        size_t n = 1;
        const double *const one = read_doubles(seen, names[k], &array[0]);
        const double *const other = read_doubles(alone, names[k], &array[1]);
        for (int d = 0; d < array[0].n_dimensions; d++) n *= array[0].shape[d];
        assert_memory_equal(one, other, n * sizeof *one);
    }
}

// ---- result files

static size_t n_rows_of(const char *path) {
    struct netcdf_reader reader;
    size_t n_rows;
    struct arena *const arena = arena_create(NULL, "a test");
    school_ok(netcdf_open(arena, &reader, path));
    school_ok(netcdf_read_length(&reader, "time", 0, 100, &n_rows));
    arena_free(arena);
    return n_rows;
}

TEST(a_result_file_has_the_rows_that_are_due) {
    const char *const assignments[] = {"time.output_interval=0.04"};
    struct shoal *const run = opened(*state, 1, assignments), *const copy = copy_of(run);
    char path[] = "/tmp/test_shoal_result_XXXXXX";
    const int descriptor = mkstemp(path);
    AT_LEAST(descriptor, 0);
    assert_int_equal(close(descriptor), 0);
    assert_int_equal(shoal_write_end(run), SHOAL_OK);
    assert_int_equal(shoal_write(run, path, 0), SHOAL_FILE);  // it exists
    assert_int_equal(shoal_write(run, path, 1), SHOAL_OK);
    refuses(shoal_write(run, "/tmp/other.nc", 1), "call shoal_write_end first");
    assert_int_equal(shoal_advance(run, 0.1), SHOAL_OK);
    refuses(shoal_restore(run, copy), "call shoal_write_end first");
    assert_int_equal(shoal_write_end(run), SHOAL_OK);
    assert_int_equal(shoal_restore(run, copy), SHOAL_OK);
    assert_int_equal(n_rows_of(path), 4);  // 0, 0.04, 0.08 and the end
    assert_int_equal(unlink(path), 0);
}

TEST(a_checkpoint_stands_beside_the_result) {
    struct shoal *const run = open_run(*state, 0, NULL);
    char folder[] = "/tmp/test_shoal_folder_XXXXXX", path[64];
    assert_non_null(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/run.nc", folder);
    refuses(shoal_checkpoint(run), "call shoal_write first");
    assert_int_equal(shoal_write(run, path, 0), SHOAL_OK);
    assert_int_equal(shoal_advance(run, 0.06), SHOAL_OK);
    assert_int_equal(shoal_checkpoint(run), SHOAL_OK);
    assert_int_equal(shoal_step(run), SHOAL_OK);
    shoal_close(run);
    snprintf(path, sizeof path, "%s/run.ckpt", folder);
    struct checkpoint checkpoint;
    school_ok(checkpoint_read(test_arena(), &checkpoint, path));
    NEAR(checkpoint.t, 0.06, 1e-15, 0);
    assert_string_equal(checkpoint.result, "run.nc");
    assert_int_equal(unlink(path), 0);
    snprintf(path, sizeof path, "%s/run.nc", folder);
    assert_int_equal(unlink(path), 0);
    // the lock is gone too
    assert_int_equal(rmdir(folder), 0);
}

// a folder, and the path of a result in it
static char result_folder[32], result_path[64];
static const char *const every_event[] = {"time.output_interval=0.02"};

static void make_result_folder(void) {
    strcpy(result_folder, "/tmp/test_shoal_XXXXXX");
    assert_non_null(mkdtemp(result_folder));
    snprintf(result_path, sizeof result_path, "%s/run.nc", result_folder);
}

TEST(two_runs_of_one_process_do_not_write_the_same_result) {
    struct shoal *const one = open_run(*state, 1, every_event), *const other = opened(*state, 1, every_event);
    make_result_folder();
    assert_int_equal(shoal_write(one, result_path, 0), SHOAL_OK);
    assert_int_equal(shoal_step(one), SHOAL_OK);
    assert_int_equal(shoal_checkpoint(one), SHOAL_OK);
    for (int overwrite = 0; overwrite < 2; overwrite++) {
        assert_int_equal(shoal_write(other, result_path, overwrite), SHOAL_FILE);
    }
    assert_non_null(strstr(shoal_message(), "another run writes this result"));
    // the lock holds for other processes too
    const pid_t child = fork();
    if (child == 0) {
        struct durable_claim claim;
        _exit(durable_claim_take(&claim, result_path) == STATUS_FILE ? 0 : 1);
    }
    int outcome;
    assert_int_equal(waitpid(child, &outcome, 0), child);
    assert_int_equal(outcome, 0);
    assert_int_equal(shoal_advance(one, 0.1), SHOAL_OK);
    shoal_close(one);
    assert_int_equal(n_rows_of(result_path), 6);
    assert_int_equal(unlink(result_path), 0);
    snprintf(result_path, sizeof result_path, "%s/run.ckpt", result_folder);
    assert_int_equal(unlink(result_path), 0);
    assert_int_equal(rmdir(result_folder), 0);
}

/* Calls in a fork of the process that writes the result of a run; returns the exit code. */
static int use_in_a_fork(struct shoal *run, int how) {
    if (how == 0) shoal_close(run);
    if (how == 1 && shoal_step(run) != SHOAL_FILE) return 1;
    if (how == 2 && shoal_checkpoint(run) != SHOAL_FILE) return 2;
    if (how == 3 && shoal_write_end(run) != SHOAL_FILE) return 3;
    if (how == 0) return 0;
    // the run continues without a file
    if (!strstr(shoal_message(), "not by this fork")) return 4;
    if (shoal_step(run) != SHOAL_OK || shoal_write_end(run) != SHOAL_OK) return 5;
    shoal_close(run);
    return 0;
}

/* fork(). Under the thread sanitizer the child of a process with threads can neither start threads nor exit. */
static pid_t fork_of_all(void) {
#if defined(__has_feature)
#if __has_feature(thread_sanitizer)
    skip();
#endif
#endif
    return fork();
}

TEST(a_fork_leaves_the_result_and_its_lock_alone) {
    struct shoal *const run = open_run(*state, 1, every_event);
    make_result_folder();
    assert_int_equal(shoal_write(run, result_path, 0), SHOAL_OK);
    for (int how = 0; how < 4; how++) {
        assert_int_equal(shoal_step(run), SHOAL_OK);
        struct stat before, after;
        assert_int_equal(stat(result_path, &before), 0);
        const pid_t child = fork_of_all();
        if (child == 0) exit(use_in_a_fork(run, how));
        int outcome;
        assert_int_equal(waitpid(child, &outcome, 0), child);
        assert_int_equal(outcome, 0);
        assert_int_equal(stat(result_path, &after), 0);
        assert_memory_equal(&before.st_mtim, &after.st_mtim, sizeof before.st_mtim);
        struct durable_claim claim;
        assert_int_equal(durable_claim_take(&claim, result_path), STATUS_FILE);
    }
    assert_int_equal(shoal_advance(run, 0.1), SHOAL_OK);
    shoal_close(run);
    assert_int_equal(n_rows_of(result_path), 6);
    assert_int_equal(unlink(result_path), 0);
    // the lock is gone too
    assert_int_equal(rmdir(result_folder), 0);
}

TEST(a_result_file_that_cannot_be_written_is_said_so) {
    struct shoal *const run = opened(*state, 0, NULL);
    assert_int_equal(shoal_write(run, "/no/such/folder/x.nc", 0), SHOAL_FILE);
    assert_non_null(strstr(shoal_message(), "/no/such/folder"));
    assert_int_equal(shoal_step(run), SHOAL_OK);
}

// ---- copies

// one variable of two runs, bit for bit
static void same(struct shoal *one, struct shoal *other, const char *name) {
    struct shoal_array a, b;
    assert_int_equal(shoal_read(one, name, &a), SHOAL_OK);
    assert_int_equal(shoal_read(other, name, &b), SHOAL_OK);
    size_t n = a.type == SHOAL_CHAR ? 1 : a.type == SHOAL_INT ? sizeof(int) : sizeof(double);
    for (int d = 0; d < a.n_dimensions; d++) {
        assert_int_equal(a.shape[d], b.shape[d]);
        n *= a.shape[d];
    }
    if (memcmp(a.values, b.values, n) != 0) fail_msg("%s differs", name);
}

static void same_in_all(struct shoal *one, struct shoal *other) {
    for (int i = 0; shoal_variable(i); i++) {
        if (strcmp(shoal_variable(i), "wall_time") != 0) same(one, other, shoal_variable(i));
    }
}

static const char *const led[] = {"time.end=0.6", "fish[*].wave.ramp=0.1", "fish[1].control.law=course",
                                  "fish[1].control.waypoints=[[-3, 1], [-6, 0]]"};

TEST(a_copy_goes_on_with_the_bits_of_the_run) {
    struct shoal *const run = open_run(*state, 4, led);
    assert_int_equal(shoal_advance(run, 0.2), SHOAL_OK);
    const double amplitude = 0.3;
    assert_int_equal(shoal_set(run, 0, "wave.amplitude", 1, &amplitude), SHOAL_OK);
    assert_int_equal(shoal_advance(run, 0.3), SHOAL_OK);
    struct shoal *const copy = copy_of(run);
    same_in_all(run, copy);
    assert_int_equal(shoal_advance(run, 0.6), SHOAL_OK);
    NEAR(shoal_time(copy), 0.3, 1e-15, 0);
    assert_int_equal(shoal_advance(copy, 0.6), SHOAL_OK);
    same_in_all(run, copy);
    // a copy outlives the run
    shoal_close(run);
    same_in_all(copy, copy_of(copy));
}

TEST(a_copy_shows_what_the_run_shows) {
    struct shoal *const run = opened(*state, 4, led), *const alone = opened(*state, 4, led);
    assert_int_equal(shoal_advance(run, 0.4), SHOAL_OK);
    assert_int_equal(shoal_advance(alone, 0.4), SHOAL_OK);
    same_in_all(alone, copy_of(run));
    same_in_all(alone, run);
}

TEST(a_run_is_put_back_to_a_copy) {
    struct shoal *const run = opened(*state, 4, led), *const start = copy_of(run);
    assert_int_equal(shoal_advance(run, 0.4), SHOAL_OK);
    struct shoal *const first = copy_of(run);
    const double bias = 0.2;
    assert_int_equal(shoal_set(run, 0, "control.bias", 1, &bias), SHOAL_OK);
    assert_int_equal(shoal_advance(run, 0.6), SHOAL_OK);
    assert_int_equal(shoal_restore(run, start), SHOAL_OK);
    NEAR(shoal_time(run), 0, 0, 0);
    assert_int_equal(shoal_advance(run, 0.4), SHOAL_OK);
    same_in_all(run, first);
}

TEST(a_run_that_has_failed_is_whole_when_it_is_put_back) {
    const char *const assignments[] = {"solver.max_steps=9", "time.end=2", "fish[*].wave.ramp=0.01"};
    struct shoal *const run = opened(*state, 3, assignments), *const start = copy_of(run);
    assert_int_equal(shoal_advance(run, 2), SHOAL_SOLVER);
    const double reached = shoal_time(run);
    struct shoal *copy;
    assert_int_equal(shoal_clone(&copy, run), SHOAL_SOLVER);
    assert_null(copy);
    assert_int_equal(shoal_restore(start, run), SHOAL_SOLVER);
    assert_int_equal(shoal_restore(run, start), SHOAL_OK);
    copy_of(run);
    assert_int_equal(shoal_advance(run, 2), SHOAL_SOLVER);
    NEAR(shoal_time(run), reached, 0, 0);
}

TEST(only_copies_can_be_put_in_the_place_of_one_another) {
    struct shoal *const run = opened(*state, 0, NULL), *const other = opened(*state, 0, NULL), *copy;
    refuses(shoal_clone(NULL, run), "copy is NULL");
    refuses(shoal_clone(&copy, NULL), "run is NULL");
    refuses(shoal_restore(NULL, run), "run is NULL");
    refuses(shoal_restore(run, NULL), "from is NULL");
    refuses(shoal_restore(run, other), "not copies of one another");
    assert_int_equal(shoal_restore(run, run), SHOAL_OK);
}

// ---- changes from outside

static double one_of(struct shoal *run, const char *name, size_t i) {
    struct shoal_array array;
    if (shoal_read(run, name, &array) != SHOAL_OK) fail_msg("%s", shoal_message());
    return ((const double *)array.values)[i];
}

// two fish whose momentum balances, with the wake of the default; the last two may be replaced
static const char *const changed[] = {
    "time.end=0.6",           "fish[*].wave.ramp=0.1",         "fish[*].nodes=9",     "wake.taper=0.6",
    "wake.taper_beside=0.07", "fish[*].sheet_points=31",       "wake.shedding=sheet", "wake.spare_vortices=6",
    "fish[*].force=pressure", "fish[*].pressure.span=infinite"};
enum { N_CHANGED = sizeof changed / sizeof *changed };

static struct shoal *opened_to_change(void **state, double t) {
    struct shoal *const run = opened(*state, N_CHANGED, changed);
    assert_int_equal(shoal_advance(run, t), SHOAL_OK);
    return run;
}

TEST(a_body_is_where_it_was_put_with_its_velocity) {
    struct shoal *const run = opened_to_change(state, 0.2);
    double x[18], v[18], x_now[18], v_now[18], audit[3];
    struct shoal *const copy = copy_of(run);  // to read from: the balances of the run stay those of its last row
    const double moment = one_of(copy, "angular_momentum_balance", 0);
    const int n_before = shoal_n_vortices(run, 0);
    assert_int_equal(shoal_state(run, 0, x, v), SHOAL_OK);
    for (size_t i = 0; i < 3; i++)
        audit[i] = i < 2 ? one_of(copy, "momentum_balance", i) : one_of(copy, "energy_balance", 0);
    for (int k = 0; k < 9; k++) {
        x[2 * k] += 0.1;
        x[2 * k + 1] -= 0.2;
        v[2 * k] -= 0.3;
    }
    const double com = one_of(copy, "com", 0), velocity = one_of(copy, "com_velocity", 0);
    assert_int_equal(shoal_set_state(run, 0, x, v), SHOAL_OK);
    assert_int_equal(shoal_state(run, 0, x_now, v_now), SHOAL_OK);
    for (int i = 0; i < 18; i++) {
        NEAR(x_now[i], x[i], 0, 0);
        NEAR(v_now[i], v[i], 0, 0);
    }
    NEAR(one_of(run, "com", 0), com + 0.1, 1e-12, 0);
    NEAR(one_of(run, "com_velocity", 0), velocity - 0.3, 1e-12, 0);
    // the wake is unchanged and continues at the new tail
    assert_int_equal(shoal_n_vortices(run, 0), n_before + 1);
    double wake_x[64], wake_y[64], circulation[64];
    assert_int_equal(shoal_vortices(run, 0, wake_x, wake_y, circulation), SHOAL_OK);
    NEAR(wake_x[n_before], x[16], 0, 0);
    // the total circulation is 0, and the balances are unchanged
    NEAR(one_of(run, "total_circulation", 0), 0, 1e-10, 0);
    for (size_t i = 0; i < 2; i++) NEAR(one_of(run, "momentum_balance", i), audit[i], 1e-9, 0);
    NEAR(one_of(run, "angular_momentum_balance", 0), moment, 1e-9, 0);
    NEAR(one_of(run, "energy_balance", 0), audit[2], 1e-9, 0);
    assert_int_equal(shoal_advance(run, 0.3), SHOAL_OK);
    NEAR(one_of(run, "total_circulation", 0), 0, 1e-10, 0);
    BELOW(fabs(one_of(run, "energy_balance", 0) - audit[2]), 1e-3 * fabs(one_of(run, "kinetic_energy", 0)));
}

TEST(a_body_that_is_put_across_itself_is_remembered) {
    struct shoal *const run = opened_to_change(state, 0.1);
    double x[18];
    assert_int_equal(shoal_state(run, 0, x, NULL), SHOAL_OK);
    assert_false(run->simulation->state->has_crossed);
    // eight edges that turn by 1.1 rad each: more than a circle
    for (int k = 0; k < 8; k++) {
        x[2 * k + 2] = x[2 * k] + cos(1.1 * k) / 8;
        x[2 * k + 3] = x[2 * k + 1] + sin(1.1 * k) / 8;
    }
    assert_int_equal(shoal_set_state(run, 0, x, NULL), SHOAL_OK);
    assert_true(run->simulation->state->has_crossed);
    assert_int_equal(run->simulation->state->crossed, 0);
    NEAR(run->simulation->state->crossed_t, 0.1, 0, 1e-15);
}

TEST(a_state_that_is_set_to_itself_stays) {
    struct shoal *const run = opened_to_change(state, 0.2), *const copy = copy_of(run);
    double x[18], v[18];
    assert_int_equal(shoal_state(run, 1, x, v), SHOAL_OK);
    assert_int_equal(shoal_set_state(run, 1, NULL, NULL), SHOAL_OK);
    same_in_all(run, copy);
    // all samples of a period stay with a velocity, and those of other fish with a position
    static const char *const means[] = {"speed", "ground_speed", "mean_actuation_power", "mean_thrust", "strouhal"};
    for (int has_position = 0; has_position < 2; has_position++) {
        assert_int_equal(shoal_set_state(run, 1, has_position ? x : NULL, v), SHOAL_OK);
        for (int i = 0; i < 5; i++) {
            for (size_t f = 0; f < (has_position ? 1 : 2); f++) {
                NEAR(one_of(run, means[i], f), one_of(copy, means[i], f), 0, 1e-3);
            }
        }
    }
    assert_int_equal(shoal_n_vortices(run, 1), shoal_n_vortices(copy, 1));
    assert_int_equal(shoal_advance(run, 0.4), SHOAL_OK);
    assert_int_equal(shoal_advance(copy, 0.4), SHOAL_OK);
    // vortices begin a first interval again: an error of the second order in the interval, once
    for (size_t i = 0; i < 4; i++) NEAR(one_of(run, "com", i), one_of(copy, "com", i), 5e-5, 0);
}

TEST(a_fish_that_is_moved_does_not_swim_the_way) {
    struct shoal *const run = opened_to_change(state, 0.2);
    double x[18];
    assert_int_equal(shoal_state(run, 0, x, NULL), SHOAL_OK);
    for (int k = 0; k < 9; k++) x[2 * k] -= 3;
    assert_int_equal(shoal_set_state(run, 0, x, NULL), SHOAL_OK);
    for (int i = 0; i < 5; i++) {
        // the mean over the period is of the way since the move, or not a number yet
        assert_int_equal(shoal_step(run), SHOAL_OK);
        const double now = hypot(one_of(run, "com_velocity", 0), one_of(run, "com_velocity", 1));
        const double mean = one_of(run, "ground_speed", 0);
        if (isfinite(mean)) NEAR(mean, now, 0, 0.05);
    }
    ABOVE(one_of(run, "ground_speed", 0), 0.1);
}

TEST(a_state_that_no_body_can_have_is_refused) {
    struct shoal *const run = opened_to_change(state, 0.1), *const copy = copy_of(run);
    double x[18], v[18], wrong[18];
    assert_int_equal(shoal_state(run, 0, x, v), SHOAL_OK);
    memcpy(wrong, x, sizeof wrong);
    wrong[3] = NAN;
    assert_int_equal(shoal_set_state(run, 0, wrong, NULL), SHOAL_USAGE);
    assert_non_null(strstr(shoal_message(), "the position of node 1, nan, is not finite"));
    assert_int_equal(shoal_set_state(run, 0, NULL, wrong), SHOAL_USAGE);
    assert_non_null(strstr(shoal_message(), "the velocity of node 1, nan, is not finite"));
    // the last edge is shortened and lengthened to less and more than the limits, with 5 per cent for its strain
    static const double ratio[4] = {0.45, 0.55, 1.9, 2.1};
    for (int i = 0; i < 4; i++) {
        struct shoal *const other = copy_of(run);
        memcpy(wrong, x, sizeof wrong);
        for (int c = 14; c < 16; c++) wrong[c + 2] = x[c] + ratio[i] * (x[c + 2] - x[c]);
        const bool is_allowed = i == 1 || i == 2;
        assert_int_equal(shoal_set_state(other, 0, wrong, NULL), is_allowed ? SHOAL_OK : SHOAL_USAGE);
        if (!is_allowed) assert_non_null(strstr(shoal_message(), "edge 7 of a would be"));
    }
    for (int i = 0; i < 4; i++) wrong[14 + i] = x[14 + i];
    wrong[16] = x[12];
    wrong[17] = x[13];
    for (int side = 0; side < 2; side++) {
        assert_int_equal(shoal_set_state(run, 0, wrong, NULL), SHOAL_USAGE);
        assert_non_null(strstr(shoal_message(), "joint 6 of a would turn by"));
        for (int i = 1; i < 18; i += 2) wrong[i] = -wrong[i];
    }
    memcpy(wrong, x, sizeof wrong);
    wrong[0] = x[4];
    wrong[1] = x[5];
    assert_int_equal(shoal_set_state(run, 0, wrong, NULL), SHOAL_USAGE);
    assert_non_null(strstr(shoal_message(), "joint 0 of a would turn by"));
    // onto the other fish
    double other[18];
    assert_int_equal(shoal_state(run, 1, other, NULL), SHOAL_OK);
    assert_int_equal(shoal_set_state(run, 0, other, NULL), SHOAL_USAGE);
    assert_non_null(strstr(shoal_message(), "would overlap"));
    assert_int_equal(shoal_set_state(run, 2, x, v), SHOAL_USAGE);
    assert_int_equal(shoal_set_state(NULL, 0, x, v), SHOAL_USAGE);
    assert_int_equal(shoal_state(NULL, 0, x, v), SHOAL_USAGE);
    same_in_all(run, copy);
    assert_int_equal(shoal_advance(run, 0.2), SHOAL_OK);
    assert_int_equal(shoal_advance(copy, 0.2), SHOAL_OK);
    same_in_all(run, copy);
}

TEST(a_vortex_from_outside_keeps_momentum_and_circulation) {
    // without pressure there is no momentum balance
    static const char *const shedding[] = {"wake.shedding=sheet", "wake.shedding=continuous",
                                           "wake.shedding=impulsive"};
    for (int i = 0; i < 3; i++) {
        const char *assignments[N_CHANGED];
        memcpy(assignments, changed, sizeof assignments);
        if (i > 0) {
            assignments[3] = "wake.taper=0";
            assignments[4] = "wake.taper_beside=0";
            assignments[6] = shedding[i];
            assignments[8] = "fish[*].force=reactive";
        }
        struct shoal *const run = opened(*state, N_CHANGED, assignments);
        assert_int_equal(shoal_advance(run, 0.3), SHOAL_OK);
        const int n_before = shoal_n_vortices(run, 0);
        const double x = -1, y = 0.4, circulation = 0.05, r = 0.4;
        double before[3], lost[2], flow[4], far[4];
        const double points[4] = {x + r, y, x - r, y};
        for (size_t k = 0; k < 3; k++)
            before[k] = k < 2 ? one_of(run, "momentum_balance", k) : one_of(run, "energy_balance", 0);
        for (size_t k = 0; k < 2; k++) lost[k] = one_of(run, "lost_impulse", k);
        struct shoal *const copy = copy_of(run);
        assert_int_equal(shoal_flow(run, 2, points, far, NULL), SHOAL_OK);
        assert_int_equal(shoal_add_vortex(run, 0, x, y, circulation), SHOAL_OK);
        assert_int_equal(shoal_n_vortices(run, 0), n_before + (i == 0 ? 3 : 1));
        assert_int_equal(shoal_flow(run, 2, points, flow, NULL), SHOAL_OK);
        // the velocity on both sides of the vortex, except for smoothing and the response of the bodies
        NEAR(flow[1] - flow[3] - far[1] + far[3], circulation / (M_PI * r), 0, 0.2);
        // Newton's iteration stops at 0.003 rtol of L^2 f: 3e-8
        NEAR(one_of(run, "total_circulation", 0), 0, 3e-8, 0);
        // rho w (y, -x) G, of the depth 0.2 of the default
        const double impulse = lost[0] - one_of(run, "lost_impulse", 0);
        // the circulation of the sheets is solved for again: its error is small beside the impulse of 4 N s
        for (size_t k = 0; k < 2 && i == 0; k++)
            NEAR(one_of(run, "momentum_balance", k), before[k], 1e-7 * fabs(impulse), 0);
        NEAR(one_of(run, "energy_balance", 0), before[2], 1e-8, 0);
        NEAR(impulse / (lost[1] - one_of(run, "lost_impulse", 1)), -y / x, 0, 1e-9);
        // later errors of the balance are the same as without the vortex
        assert_int_equal(shoal_advance(run, 0.5), SHOAL_OK);
        assert_int_equal(shoal_advance(copy, 0.5), SHOAL_OK);
        // Newton's iteration stops at 0.003 rtol of L^2 f: 3e-8
        NEAR(one_of(run, "total_circulation", 0), 0, 3e-8, 0);
        for (size_t k = 0; k < 2 && i == 0; k++) {
            NEAR(one_of(run, "momentum_balance", k), one_of(copy, "momentum_balance", k), 5e-3 * fabs(impulse), 0);
        }
    }
}

TEST(a_changed_run_is_copied_and_saved_like_any_other) {
    struct shoal *const run = open_run(*state, N_CHANGED, changed), *loaded;
    double x[18];
    assert_int_equal(shoal_advance(run, 0.2), SHOAL_OK);
    assert_int_equal(shoal_add_vortex(run, 1, -1, 0, 0.02), SHOAL_OK);
    assert_int_equal(shoal_state(run, 0, x, NULL), SHOAL_OK);
    for (int k = 0; k < 9; k++) x[2 * k] -= 0.01;
    assert_int_equal(shoal_set_state(run, 0, x, NULL), SHOAL_OK);
    make_result_folder();
    assert_int_equal(shoal_write(run, result_path, 0), SHOAL_OK);
    struct shoal *const copy = copy_of(run);
    char path[80];
    snprintf(path, sizeof path, "%s/saved.ckpt", result_folder);
    assert_int_equal(shoal_save(run, path), SHOAL_OK);
    assert_int_equal(shoal_load(&loaded, path), SHOAL_OK);
    same_in_all(run, kept(loaded));
    struct shoal *const all[] = {run, copy, loaded};
    for (int i = 0; i < 3; i++) assert_int_equal(shoal_advance(all[i], 0.6), SHOAL_OK);
    same_in_all(run, copy);
    same_in_all(run, loaded);
    // the file has room until the end
    ABOVE(n_rows_of(result_path), 2);
    shoal_close(run);
    assert_int_equal(unlink(path), 0);
    assert_int_equal(unlink(result_path), 0);
    assert_int_equal(rmdir(result_folder), 0);
}

TEST(the_longest_wake_has_all_its_slots_and_the_other_ends_in_nan) {
    for (int f = 0; f < 2; f++) {
        struct shoal *const run = opened_to_change(state, 0.1);
        assert_int_equal(shoal_add_vortex(run, f, -1, 0.5, 0.01), SHOAL_OK);
        const int n = shoal_n_vortices(run, f), of_other = shoal_n_vortices(run, 1 - f);
        BELOW(of_other, n);
        struct shoal_array array;
        const double *const read = read_doubles(run, "wake_circulation", &array);
        assert_int_equal(array.shape[0], 2);
        assert_int_equal(array.shape[1], n);
        for (int g = 0; g < 2; g++) {
            double x[64], y[64], circulation[64];
            assert_int_equal(shoal_vortices(run, g, x, y, circulation), SHOAL_OK);
            for (int i = 0; i < n; i++) {
                if (g == f || i < of_other)
                    NEAR(read[g * n + i], circulation[i], 0, 0);
                else
                    assert_true(isnan(read[g * n + i]));
            }
        }
    }
}

TEST(a_vortex_without_room_is_refused) {
    struct shoal *const run = opened_to_change(state, 0.1);
    assert_int_equal(shoal_add_vortex(run, 2, 0, 0, 1), SHOAL_USAGE);
    assert_int_equal(shoal_add_vortex(NULL, 0, 0, 0, 1), SHOAL_USAGE);
    assert_int_equal(shoal_add_vortex(run, 0, NAN, 0, 1), SHOAL_USAGE);
    for (int i = 0; i < 2; i++) assert_int_equal(shoal_add_vortex(run, 0, -1, i, 0.01), SHOAL_OK);
    const int n = shoal_n_vortices(run, 0);
    assert_int_equal(shoal_add_vortex(run, 0, -1, 2, 0.01), SHOAL_USAGE);
    assert_non_null(strstr(shoal_message(), "wake.spare_vortices: 6, of which 6 are used"));
    assert_int_equal(shoal_n_vortices(run, 0), n);
    assert_int_equal(shoal_step(run), SHOAL_OK);
    const char *const dropped[] = {"wake.spare_vortices=6", "wake.removed_circulation=dropped"};
    struct shoal *const other = opened(*state, 2, dropped);
    assert_int_equal(shoal_add_vortex(other, 0, -1, 2, 0.01), SHOAL_USAGE);
    assert_non_null(strstr(shoal_message(), "choose 'retained'"));
}

// ---- checkpoints of their own

static char saved_path[] = "/tmp/test_shoal_saved.XXXXXX";

static void make_saved_path(void) {
    strcpy(saved_path + strlen(saved_path) - 6, "XXXXXX");
    const int descriptor = mkstemp(saved_path);
    AT_LEAST(descriptor, 0);
    close(descriptor);
    assert_int_equal(unlink(saved_path), 0);
}

TEST(saving_and_flow_leave_no_memory_and_wrong_points_take_none) {
    struct shoal *const run = swum(*state);
    make_saved_path();
    assert_int_equal(shoal_save(run, saved_path), SHOAL_OK);
    const int n_before = n_live;
    for (int i = 0; i < 3; i++) assert_int_equal(shoal_save(run, saved_path), SHOAL_OK);
    assert_int_equal(unlink(saved_path), 0);
    assert_int_equal(shoal_save(run, "/no/such/folder/x.ckpt"), SHOAL_FILE);
    assert_int_equal(n_live, n_before);

    // the last point is refused before memory is requested
    enum { N = 1 << 20 };
    double *const points = arena_new(test_arena(), 2 * N, sizeof *points), *const velocity = arena_new(
                                                                               test_arena(), 2 * N, sizeof *velocity);
    points[2 * N - 1] = NAN;
    const size_t n_bytes_before = n_bytes;
    assert_int_equal(shoal_flow(run, N, points, velocity, NULL), SHOAL_USAGE);
    BELOW(n_bytes - n_bytes_before, 4096);
}

TEST(a_saved_run_goes_on_with_the_bits_of_the_run) {
    struct shoal *const run = opened(*state, sizeof led / sizeof *led, led), *loaded;
    assert_int_equal(shoal_advance(run, 0.2), SHOAL_OK);
    assert_int_equal(shoal_set(run, 0, "wave.amplitude", 1, (const double[]){0.2}), SHOAL_OK);
    make_saved_path();
    for (int again = 0; again < 2; again++) assert_int_equal(shoal_save(run, saved_path), SHOAL_OK);
    assert_int_equal(shoal_load(&loaded, saved_path), SHOAL_OK);
    kept(loaded);
    NEAR(shoal_time(loaded), shoal_time(run), 0, 0);
    same_in_all(run, loaded);
    assert_int_equal(shoal_advance(run, 0.6), SHOAL_OK);
    assert_int_equal(shoal_advance(loaded, 0.6), SHOAL_OK);
    same_in_all(run, loaded);
    assert_int_equal(shoal_restore(loaded, run), SHOAL_USAGE);
    assert_int_equal(unlink(saved_path), 0);
}

TEST(only_a_checkpoint_is_replaced_or_loaded) {
    struct shoal *const run = opened(*state, 0, NULL), *loaded = run;
    assert_int_equal(shoal_save(run, *state), SHOAL_FILE);
    assert_int_equal(shoal_save(run, "/no/such/folder/x.ckpt"), SHOAL_FILE);
    assert_int_equal(shoal_load(&loaded, *state), SHOAL_FILE);
    assert_null(loaded);
    assert_int_equal(shoal_load(&loaded, "/no/such.ckpt"), SHOAL_FILE);
    assert_int_equal(shoal_load(NULL, *state), SHOAL_USAGE);
    assert_int_equal(shoal_load(&loaded, NULL), SHOAL_USAGE);
    assert_int_equal(shoal_save(NULL, "x.ckpt"), SHOAL_USAGE);
    assert_int_equal(shoal_save(run, NULL), SHOAL_USAGE);
    assert_int_equal(shoal_step(run), SHOAL_OK);
}

TEST(a_fork_of_a_run_with_threads_goes_on) {
    // steps of the velocity sums that threads share
    const char *const many[] = {"solver.threads=2", "fish[*].sheet_points=129", "fish[*].nodes=17"};
    struct shoal *const run = opened(*state, 3, many);
    assert_int_equal(shoal_advance(run, 0.04), SHOAL_OK);
    const pid_t child = fork_of_all();
    if (child == 0) {
        alarm(60);
        exit(shoal_advance(run, 0.1) == SHOAL_OK ? 0 : 1);
    }
    int outcome;
    assert_int_equal(waitpid(child, &outcome, 0), child);
    assert_int_equal(outcome, 0);
    assert_int_equal(shoal_advance(run, 0.1), SHOAL_OK);
}

TEST(the_end_is_the_time_of_an_event) {
    // 100 * 0.29 is less than 29 by a rounding error
    const char *const assignments[] = {"time.end=29", "time.shedding_interval=0.29", "fish[*].wave.amplitude=0"};
    struct shoal *const run = opened(*state, 3, assignments);
    assert_int_equal(shoal_advance(run, 29), SHOAL_OK);
    NEAR(shoal_time(run), shoal_end(run), 0, 0);
}

TEST(the_version_is_that_of_the_program) {
    assert_string_equal(shoal_version(), version_short());
    assert_memory_equal(shoal_version(), "shoal ", 6);
}

// ---- lack of memory

/* Call each function that requests memory, until one fails. */
static int live(const char *text, const char *path, struct shoal **run, struct shoal **other) {
    char checkpoint[sizeof result_path + 8];
    snprintf(checkpoint, sizeof checkpoint, "%s.ckpt", path);
    const double points[] = {5, 5, -1, 2};
    double position[2 * 7], velocity[4], vorticity[2];
    struct shoal_array array;
    TRY(shoal_open_text(run, text, NULL, 0, NULL));
    TRY(shoal_write(*run, path, 1));
    for (int i = 0; i < 3; i++) TRY(shoal_step(*run));
    TRY(shoal_read(*run, "wake_x", &array));
    TRY(shoal_flow(*run, 2, points, velocity, vorticity));
    TRY(shoal_checkpoint(*run));
    TRY(shoal_write_end(*run));
    TRY(shoal_clone(other, *run));
    if (strstr(text, "reactive")) TRY(shoal_add_vortex(*run, 0, -1, 1, 0.01));  // no ring for a vortex
    TRY(shoal_state(*run, 0, position, NULL));
    TRY(shoal_set_state(*run, 0, position, NULL));
    TRY(shoal_restore(*run, *other));
    shoal_close(*other);
    *other = NULL;
    TRY(shoal_save(*run, checkpoint));
    TRY(shoal_load(other, checkpoint));
    for (int i = 0; i < 12; i++) TRY(shoal_step(*other));
    return SHOAL_OK;
}

/* Let one allocation fail, the first ones one by one, later ones at growing distances: the call fails for memory, and a
 * run that a failed step has left between two events says so at each later call. */
static void sweep(const char *text, const char *path, int least) {
    int n = 0, code = SHOAL_MEMORY;
    while (code != SHOAL_OK) {
        const int n_before = n_live;
        struct shoal *run = NULL, *other = NULL;
        n_until_failure = n;
        code = live(text, path, &run, &other);
        n_until_failure = -1;
        if (code != SHOAL_OK) {
            assert_int_equal(code, SHOAL_MEMORY);
            assert_non_null(strstr(shoal_message(), "out of memory"));
            struct shoal *const last = other ? other : run;
            if (last && shoal_step(last) != SHOAL_OK) assert_non_null(strstr(shoal_message(), "out of memory"));
        }
        shoal_close(other);
        shoal_close(run);
        if (n_live != n_before) fail_msg("allocation %d leaves %d: %s", n, n_live - n_before, shoal_message());
        n += 1 + n / 20;
    }
    AT_LEAST(n, least);
}

TEST(a_change_that_lacks_memory_leaves_the_run_as_it_was) {
    struct shoal *const run = opened_to_change(state, 0.2);
    double x[18], v[18];
    int code = SHOAL_MEMORY, n = 0;
    assert_int_equal(shoal_state(run, 1, x, v), SHOAL_OK);
    for (int i = 0; i < 18; i++) x[i] += 0.01;
    for (; code != SHOAL_OK; n += 1 + n / 20) {  // as in sweep()
        struct shoal *copy;
        assert_int_equal(shoal_clone(&copy, run), SHOAL_OK);
        n_until_failure = n;
        code = shoal_set_state(copy, 1, x, v);
        n_until_failure = -1;
        if (code != SHOAL_OK) {
            assert_int_equal(code, SHOAL_MEMORY);
            same_in_all(copy, run);
        }
        shoal_close(copy);
    }
    AT_LEAST(n, 10);
}

#define MEMORY_CASE(solver, more)                                                                                    \
    "format: 1\ntime: {end: 1, shedding_interval: 0.02, output_interval: 0.02}\nwake: {spare_vortices: 9}\nsolver: " \
    "{" solver "}\n" more

TEST(without_memory_every_call_fails_and_leaves_nothing) {
    // control laws with lists; a wake that grows from its first size
    static const char plain[] =
        "defaults: {fish: {force: reactive}}\nfish:\n"
        "  - {nodes: 7, sheet_points: 9, control: {law: heading, waypoints: [[-3, 1]]}}\n"
        "  - {nodes: 4, sheet_points: 5, start: {position: [0, 2]}, control: {law: heading, desired_heading: [[0, "
        "180], [1, 90]]}}\n";
    // rings, and couplings that need GMRES
    static const char pressure[] =
        "fish:\n  - {nodes: 7, sheet_points: 26}\n  - {nodes: 7, sheet_points: 26, start: {position: [0, 0.4]}}\n";
    static const char *const methods[] = {"method: ida", "method: rk4", "method: trapezoid, step: 0.01"};
    make_result_folder();
    for (int i = 0; i < 4; i++) {
        char text[1500];
        snprintf(text, sizeof text, MEMORY_CASE("%s", "%s"), methods[i % 3], i < 3 ? plain : pressure);
        sweep(text, result_path, 300);
    }
    unlink(strcat(result_path, ".ckpt"));
}
