/* test_threads.c: A run with several threads has the bits of a run with one thread, in the whole state and in the
 * totals. */
#include <stdio.h>
#include <string.h>

#include "base/parallel.h"
#include "school.h"

/* Pairs of fish that meet head on between two walls; every third fish has another force model, some fish have a
 * control law. The number of unknowns is large enough for parallel loops over fish. */
enum { N_PAIRS = 9 };
#define MEETING                                                            \
    "time: {end: 1, shedding_interval: 0.01}\nfluid: {walls: [-0.3, 4]}\n" \
    "contact: {range: 0.05}\ndefaults: {fish: {nodes: 7, sheet_points: 15, start: {speed: 0.5}}}\n"

static void meeting_text(size_t size, char *text, const char *settings, const char *force, int threads) {
    static const char *const law[] = {"none", "heading", "course, desired_heading: 170"};
    size_t used =
        (size_t)snprintf(text, size, "%s" MEETING "solver: {threads: %d, rtol: 1e-3}\nfish:\n", settings, threads);
    for (int f = 0; f < 2 * N_PAIRS; f++) {
        const int right = f % 2;
        used += (size_t)snprintf(text + used, size - used,
                                 "  - {force: %s, control: {law: %s}, wave: {phase: %d}, start: {position: [%g, %g], "
                                 "heading: %d}}\n",
                                 f % 3 == 0 ? force : "reactive", law[f % 4 % 3], 40 * f, right ? 0.05 : -0.05,
                                 0.4 * (f / 2) + 0.01 * right, right ? 180 : 0);
    }
    BELOW(used, size);
}

// a run of some events
static struct simulation *run_of(const char *settings, const char *force, int threads, int n_events) {
    char text[8192];
    meeting_text(sizeof text, text, settings, force, threads);
    struct simulation *const simulation = school_simulation(text);
    AT_LEAST(simulation->school->n_unknowns, PARALLEL_UNKNOWNS);
    for (int i = 0; i < n_events; i++) school_ok(simulate_step(simulation));
    return simulation;
}

static void compare_threads(const char *settings, const char *force, int n_events) {
    struct simulation *const one = run_of(settings, force, 1, n_events);
    const int *partner;
    int n_contacts = 0;
    for (int f = 0; f < one->school->n_fish; f++) n_contacts += contact_partners(one->residual->contact, f, &partner);
    ABOVE(n_contacts, 0);
    for (int threads = 2; threads <= 3; threads++) {
        struct simulation *const many = run_of(settings, force, threads, n_events);
        school_same_bits(many, one, settings);
    }
}

TEST(threads_change_no_bit_of_a_school_in_contact) {
    compare_threads("", "pressure, pressure: {span: infinite}", 2);
}

TEST(threads_change_no_bit_of_sheets_of_finite_span) {
    compare_threads("", "pressure, sheet_points: 26, pressure: {span: finite}", 2);
}

TEST(threads_change_no_bit_where_vortices_are_shed_at_once) {
    compare_threads("wake: {shedding: impulsive}\n", "published", 1);
}
