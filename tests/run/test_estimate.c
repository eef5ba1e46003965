/* test_estimate.c: The time and the memory of a run are estimated from a few events and from wakes that are made up. */
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>
#include <time.h>

#include "run/estimate.h"
#include "run/simulate.h"
#include "school.h"

/* A clock of the thread by which an evaluation of the residual takes 1 ms, and 1 us more for each vortex, and an event
 * 1 ns for each pair of vortices of a fish; to read it takes 1 us. On a busy machine it goes as on any other. */
static long counted, n_evaluations;
__typeof__(residual_evaluate) __real_residual_evaluate, __wrap_residual_evaluate;
enum status __wrap_residual_evaluate(struct residual *residual, const struct residual_mode *mode, double t,
                                     const double *y, const double *yp, double *value) {
    counted += 1000;
    n_evaluations++;
    for (int f = 0; f < residual->school->n_fish; f++) counted += residual->state->wake[f].n_vortex;
    return __real_residual_evaluate(residual, mode, t, y, yp, value);
}

__typeof__(simulate_event) __real_simulate_event, __wrap_simulate_event;
enum status __wrap_simulate_event(struct simulation *simulation) {
    for (int f = 0; f < simulation->school->n_fish; f++) {
        const long n = simulation->state->wake[f].n_vortex;
        counted += n * n / 1000;
    }
    return __real_simulate_event(simulation);
}

int __real_clock_gettime(clockid_t clock, struct timespec *now);
int __wrap_clock_gettime(clockid_t clock, struct timespec *now);
int __wrap_clock_gettime(clockid_t clock, struct timespec *now) {
    if (clock != CLOCK_THREAD_CPUTIME_ID) return __real_clock_gettime(clock, now);
    counted++;
    *now = (struct timespec){counted / 1000000, counted % 1000000 * 1000};
    return 0;
}

#define FISH "fish: [{nodes: 5}, {nodes: 5, start: {position: [0, 3]}}]\n"

static double peak_memory(void) {
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    return 1024.0 * (double)usage.ru_maxrss;
}

static struct estimate estimate_of(const char *text, double patience) {
    struct simulation *const simulation = school_simulation(text);
    struct estimate estimate = {0};
    school_ok(estimate_run(simulation, patience, &estimate));
    return estimate;
}

TEST(a_run_that_is_done_whole_takes_what_it_took) {
    const long start = counted;
    const struct estimate estimate =
        estimate_of("time: {end: 2, shedding_interval: 0.02, output_interval: 0.02}\n" FISH, 1e6);
    const double all = 1e-6 * (double)(counted - start);
    assert_int_equal(estimate.n_events, 100);
    // the first event, with more evaluations, is taken to cost as much as the others
    NEAR(estimate.seconds, all, 0, 0.05);
}

TEST(a_wake_that_grows_costs_more_than_its_first_events) {
    const char long_run[] =
        "time: {end: 2000, shedding_interval: 0.02, output_interval: 0.02}\nwake: {lifetime: %d}\n" FISH;
    char text[sizeof long_run + 20];
    double seconds[2];
    for (int i = 0; i < 2; i++) {
        snprintf(text, sizeof text, long_run, i == 0 ? 1 : 1000);
        seconds[i] = estimate_of(text, 0.05).seconds;
    }
    ABOVE(seconds[1], 5 * seconds[0]);
}

TEST(every_event_is_as_costly_as_those_measured_after_the_first) {
    // the decay is too short for dropping
    static const char text[] = "time: {end: 8, shedding_interval: 0.02}\nwake: {lifetime: 6, decay: 0.2}\n" FISH;
    // time for a few events and for wakes that are made up
    const struct estimate estimate = estimate_of(text, 0.1);
    AT_LEAST(estimate.n_events, 3);
    AT_MOST(estimate.n_events, 12);  // in which the first, with more evaluations, would count

    struct simulation *const simulation = school_simulation(text);
    n_evaluations = 0;
    school_ok(simulate_step(simulation));
    const double first = (double)n_evaluations;
    n_evaluations = 0;
    for (long i = 1; i < estimate.n_events; i++) school_ok(simulate_step(simulation));
    const double each = (double)n_evaluations / (double)(estimate.n_events - 1);
    ABOVE(first, 1.3 * each);
    double want = 0;
    for (int i = 0; i < 400; i++) want += each * 1e-6 * (1000 + 2 * fmin(i, 300));
    NEAR(estimate.seconds, want, 0, 0.03);
}

TEST(a_long_wake_is_extrapolated_from_a_short_one) {
    // 200,000 vortices of a tree, and 10,000 of a direct sum, which grows with the square of the number; the decay is
    // too short for dropping
    static const char *const texts[] = {
        "time: {end: 4000, shedding_interval: 0.02}\nwake: {lifetime: 4000, decay: 0.2}\n"
        "fish: [{nodes: 5, pressure: {span: infinite}}]\n",
        "time: {end: 200, shedding_interval: 0.02}\nwake: {lifetime: 200, decay: 0.2, tolerance: 0}\n"
        "fish: [{nodes: 5}]\n"};
    for (int i = 0; i < 2; i++) {
        const long start = counted;
        const struct estimate quick = estimate_of(texts[i], 0.3);
        const double spent = 1e-6 * (double)(counted - start);
        const struct estimate slow = estimate_of(texts[i], 3);
        print_message("%.3g s and %.3g MB after %.2g s\n", quick.seconds, 1e-6 * quick.bytes, spent);
        print_message("%.3g s and %.3g MB from a longer one\n", slow.seconds, 1e-6 * slow.bytes);
        // far from the seconds of whole events
        BELOW(spent, 0.02 * slow.seconds);
#ifndef __SANITIZE_ADDRESS__  // which keeps memory that is freed
        NEAR(log(quick.bytes / slow.bytes), 0, log(1.5), 0);
#endif
        NEAR(log(quick.seconds / slow.seconds), 0, log(2), 0);
    }
}

static volatile sig_atomic_t stop_at_once;

TEST(a_first_event_that_is_stopped_is_estimated_from_its_part) {
    static const char text[] = "time: {end: 2, shedding_interval: 0.02, output_interval: 0.02}\n" FISH;
    struct simulation *const simulation = school_simulation(text);
    struct estimate part;
    stop_at_once = 1;
    simulation->stop = &stop_at_once;
    school_ok(estimate_run(simulation, 0.1, &part));
    assert_int_equal(part.n_events, 0);
    const struct estimate whole = estimate_of(text, 0.1);
    ABOVE(part.seconds, 0);
    BELOW(part.seconds, 20 * whole.seconds);
}

TEST(every_kind_of_wake_can_be_made_up) {
    const char *const kinds[] = {"sheet", "continuous", "impulsive"};
    for (int i = 0; i < 3; i++) {
        struct simulation *const simulation = school_simulation_of(
            "time: {end: 10, shedding_interval: 0.02, output_interval: 0.02}\n"
            "wake: {shedding: %s, lifetime: 10, decay: 0.2}\n" FISH,
            kinds[i]);
        struct estimate estimate;
        school_ok(estimate_run(simulation, 1, &estimate));
        ABOVE(estimate.seconds, 0);
        assert_true(isfinite(estimate.seconds));
        // the wakes of the end, less what is older than a lifetime
        AT_LEAST(simulation->state->wake[1].n_vortex, wake_most(simulation->school, 500) - 1);
        // a program without a run has some megabytes
        ABOVE(estimate.bytes, 4e6);
        BELOW(estimate.bytes, 1e10);
        // after the longest wakes no memory is missing but that of the file; the kernel counts pages only roughly, and
        // 1000 vortices too many would be 0.6 MB
        const double most = peak_memory() + 7e6 + 0.3e6;
        AT_MOST(estimate.bytes, most);
    }
}

TEST(a_run_that_fails_at_once_has_no_estimate) {
    struct simulation *const simulation =
        school_simulation("time: {end: 1, shedding_interval: 0.02}\nsolver: {max_steps: 1}\n" FISH);
    struct estimate estimate;
    assert_int_equal(estimate_run(simulation, 1, &estimate), STATUS_SOLVER);
    assert_non_null(strstr(status_message(), "solver.max_steps"));
}

TEST(the_samples_of_a_period_take_memory) {
    // a period of 2 events, and of a million: the history of one fish grows to the length of the period
    double bytes[2];
    for (int i = 0; i < 2; i++) {
        struct simulation *const simulation = school_simulation_of(
            "time: {end: 1000, shedding_interval: 0.001}\nwake: {lifetime: 0.01, tolerance: 0}\n"
            "fish: [{nodes: 5, wave: {frequency: %s}}]\n",
            i == 0 ? "500" : "0.001");
        struct estimate estimate;
        school_ok(estimate_run(simulation, 0.05, &estimate));
        bytes[i] = estimate.bytes;
    }
    NEAR(bytes[1] - bytes[0], 1e6 * sizeof(struct sample), 0, 0.1);
}

TEST(every_wake_takes_memory) {
    // 200,000 vortices take 370 MB (src/run/estimate.c): the wakes of two fish, of a million events each
    const char *const text = "time: {end: 10000, shedding_interval: 0.01}\nwake: {lifetime: 10000}\n" FISH;
    NEAR(estimate_of(text, 0).bytes - peak_memory(), 2e6 * 370e6 / 2e5, 0, 0.1);
}

TEST(members_that_fail_take_no_time) {
    NEAR(estimate_of_study(30, 15, 0, 15), 30, 0, 0);
    NEAR(estimate_of_study(2, 1, 14, 15), 2, 0, 0);
    // of 30 members, two have been examined: half of the others are expected to fail
    NEAR(estimate_of_study(2, 1, 1, 30), 30, 0, 0);
}
