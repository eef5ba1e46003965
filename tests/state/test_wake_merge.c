/* test_wake_merge.c: merging in old wakes: conserved moments, and velocity change at the bodies. */
#include <stdio.h>
#include <string.h>

#include "flow/kernel.h"
#include "school.h"
#include "state/state.h"
#include "wake/sheet.h"

#define SMALL "time: {end: 1, shedding_interval: 0.01, output_interval: 0.01}\ndefaults: {fish: {nodes: 7}}\n"
#define TWO "fish: [{}, {start: {position: [9, -3]}}]\n"

enum { N = 1600 };

/* A wake of 16 lengths behind the first fish, which swims to the left with the speed 1; the shed circulation changes
 * sign every quarter of a length. */
static void trail(struct setup *setup, const char *text) {
    school_build(setup, text);
    const struct school *const school = setup->school;
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *const fish = &school->fish[f];
        for (int k = 0; k < fish->n_nodes; k++) setup->state->y[fish->at.vx + k] = -1;
    }
    struct wake *const wake = &setup->state->wake[0];
    double label = 0;
    setup->state->t = 16;
    setup->state->event = 1600;
    for (int i = 0; i < N; i++) {
        const double age = 0.01 * (N - 1 - i), x = 1 + age;
        const double strength = 0.005 * sin(4 * acos(-1) * x) * (1 + 0.1 * school_random(setup));
        label += strength;
        wake_release(wake, x, 0.1 * sin(6 * x), wake->has_markers ? label : strength, 16 - age);
        wake->u[i] = 0.02 * sin(5 * x);
        wake->v[i] = 0.02 * cos(5 * x);
        wake->u_before[i] = 0.02 * sin(5 * x + 0.1);
        wake->v_before[i] = 0.02 * cos(5 * x + 0.1);
    }
}

/* The vortices of the first wake, or the midpoints between markers. */
static const struct wake *sources(const struct setup *setup, struct wake *middles) {
    const struct wake *const wake = &setup->state->wake[0];
    if (!wake->has_markers) return wake;
    const int n = wake_n_sources(wake);
    wake_resize(middles, n);
    const double *const from[] = {wake->x, wake->y, wake->u, wake->v, wake->u_before, wake->v_before};
    double *const to[] = {middles->x, middles->y, middles->u, middles->v, middles->u_before, middles->v_before};
    for (int k = 0; k < 6; k++) {
        for (int i = 0; i < n; i++) to[k][i] = (from[k][i] + from[k][i + 1]) / 2;
    }
    for (int i = 0; i < n; i++) middles->circulation[i] = wake_source(wake, i);
    return middles;
}

/* Circulation and first moments of a wake, rates of the moments with the velocities now and before, and sum of the
 * magnitudes of the circulations. */
struct moments {
    double circulation, first[6], size;
};
static struct moments moments_of(const struct setup *setup) {
    struct wake middles = {.arena = test_arena()};
    const struct wake *const wake = sources(setup, &middles);
    const double *const value[6] = {wake->x, wake->y, wake->u, wake->v, wake->u_before, wake->v_before};
    struct moments moments = {0};
    for (int i = 0; i < wake->n_vortex; i++) {
        moments.circulation += wake->circulation[i];
        moments.size += fabs(wake->circulation[i]);
        for (int k = 0; k < 6; k++) moments.first[k] += wake->circulation[i] * value[k][i];
    }
    return moments;
}

/* The velocity at all nodes of a fish, for two smoothings of the wake. */
enum { VELOCITIES = 2 * 2 * 64 };
static void velocity_at(const struct setup *setup, int f, double *velocity) {
    struct wake middles = {.arena = test_arena()};
    const struct wake *const wake = sources(setup, &middles);
    const struct fish *const fish = &setup->school->fish[f];
    const double *const y = setup->state->y;
    const double smoothing[] = {1e-3, 0.1};
    memset(velocity, 0, VELOCITIES * sizeof *velocity);
    for (int s = 0; s < 2; s++) {
        double *const u = velocity + 2 * s * fish->n_nodes;
        const struct targets at = {
            .n = fish->n_nodes, .x = y + fish->at.x, .y = y + fish->at.y, .u = u, .v = u + fish->n_nodes};
        struct sources all = {.arena = test_arena()};
        sources_append(&all, wake->n_vortex);
        memcpy(all.x, wake->x, sizeof(double) * (size_t)wake->n_vortex);
        memcpy(all.y, wake->y, sizeof(double) * (size_t)wake->n_vortex);
        memcpy(all.q, wake->circulation, sizeof(double) * (size_t)wake->n_vortex);
        const struct kernel_pair pair = kernel_infinite.other(0, smoothing[s] * smoothing[s]);
        kernel_induce(&pair, &all, (struct range){0, all.n}, &at);
    }
}

/* Merge until no pair merges; returns the number of merged pairs. */
static int merge_all(struct setup *setup) {
    struct wake *const wake = &setup->state->wake[0];
    for (int before = -1; before != wake->n_merged; setup->state->event += WAKE_MERGE_EVENTS) {
        before = wake->n_merged;
        wake_merge(setup->school, setup->state);
    }
    return wake->n_merged;
}

static void check_bound(const char *text) {
    struct setup setup;
    trail(&setup, text);
    double before[2][VELOCITIES], after[VELOCITIES];
    for (int f = 0; f < 2; f++) velocity_at(&setup, f, before[f]);
    const struct moments was = moments_of(&setup);
    const int n_merged = merge_all(&setup);
    ABOVE(n_merged, N / 4);
    assert_int_equal(setup.state->wake[0].n_vortex, N - n_merged);
    // a pair lives as long as its newer vortex, which is nearer to the tail; pairs of both signs lie beside themselves
    const struct wake *const wake = &setup.state->wake[0];
    int n_older = 0;
    for (int i = 0; i < wake->n_vortex; i++) n_older += wake->x[i] - 1 < setup.state->t - wake->birth[i] - 1e-9;
    BELOW(n_older, n_merged / 10);
    const struct moments is = moments_of(&setup);
    NEAR(is.circulation, was.circulation, 1e-15 * was.size, 0);
    // sixteen lengths, and rounding
    NEAR_ARRAY(6, is.first, was.first, 1e-14 * was.size, 0);
    // a beat takes a second, and a fish is one metre long
    for (int f = 0; f < 2; f++) {
        double largest = 0;
        velocity_at(&setup, f, after);
        for (int k = 0; k < VELOCITIES; k++) largest = fmax(largest, fabs(after[k] - before[f][k]));
        AT_MOST(largest, setup.school->wake_merge * n_merged / N);
        ABOVE(largest, 0);
    }
}

TEST(the_velocity_at_the_bodies_changes_by_less_than_the_bound) {
    check_bound(SMALL "wake: {lifetime: 16, shedding: continuous, merge: 1.0e-4}\n" TWO);
    check_bound(SMALL "wake: {lifetime: 16, shedding: continuous, merge: 1.0e-2}\n" TWO);
    check_bound(SMALL "wake: {lifetime: 16, shedding: sheet, merge: 1.0e-4}\n" TWO);
    check_bound(SMALL "wake: {lifetime: 16, shedding: sheet, merge: 1.0e-2}\n" TWO);
}

TEST(a_merged_marker_has_the_mean_rate_of_the_pair) {
    struct setup setup;
    trail(&setup, SMALL "wake: {lifetime: 16, shedding: sheet, merge: 1.0e-4}\n" TWO);
    struct wake *const wake = &setup.state->wake[0];
    for (int i = 0; i < N; i++) {
        wake->rate[i] = i % 2 ? 1 : -1;
        wake->rate_before[i] = 2 * wake->rate[i];
    }
    wake_merge(setup.school, setup.state);
    int n_means[2] = {0, 0};
    for (int i = 0; i < wake->n_vortex; i++) {
        n_means[0] += !(fabs(wake->rate[i]) > 0);
        n_means[1] += !(fabs(wake->rate_before[i]) > 0);
    }
    ABOVE(wake->n_merged, 10);
    for (int i = 0; i < 2; i++) assert_int_equal(n_means[i], wake->n_merged);
}

/* How many vortices between x = low and high the wake has. */
static int count_between(const struct wake *wake, double low, double high) {
    int n = 0;
    for (int i = 0; i < wake->n_vortex; i++) n += wake->x[i] > low && wake->x[i] < high;
    return n;
}

TEST(nothing_is_merged_near_a_body_or_where_one_will_be) {
    struct setup setup;
    trail(&setup, SMALL "wake: {lifetime: 16, shedding: sheet, merge: 0.1}\n" TWO);
    struct wake *const wake = &setup.state->wake[0];
    // the own body ends at 1, the other body lies 3 below 9 to 10
    assert_int_equal(count_between(wake, 1, 2.999), 199);
    const int n = merge_all(&setup);
    assert_int_equal(count_between(wake, 1, 2.999), 199);
    BELOW(count_between(wake, 8, 11), 250);

    // the other fish swims left below the wake, and passes most of the wake at a distance of 1
    trail(&setup,
          SMALL "wake: {lifetime: 16, shedding: sheet, merge: 0.1}\nfish: [{}, {start: {position: [9, -1]}}]\n");
    const int n_passed = merge_all(&setup);
    assert_int_equal(count_between(&setup.state->wake[0], 3.005, 8.995), 599);
    BELOW(n_passed, n);
}

TEST(the_newest_vortices_are_never_merged) {
    static const char *const kinds[] = {"sheet", "continuous"};
    // also without the newest vortex: the older ones then pair in the other way
    for (int i = 0; i < 4; i++) {
        struct setup setup;
        char text[256];
        snprintf(text, sizeof text, SMALL "wake: {lifetime: 16, shedding: %s, merge: 0.1}\nfish: [{}]\n", kinds[i % 2]);
        trail(&setup, text);
        struct wake *const wake = &setup.state->wake[0];
        wake->n_vortex -= i / 2;
        double newest[3][16];
        const double *const now[3] = {wake->x, wake->circulation, wake->birth};
        for (int k = 0; k < 3; k++) memcpy(newest[k], now[k] + wake->n_vortex - 16, sizeof newest[k]);
        // the body is far from all vortices, and swims away
        double *const y = setup.state->y;
        const struct fish *const fish = setup.school->fish;
        for (int k = 0; k < fish->n_nodes; k++) {
            y[fish->at.x + k] -= 100;
            y[fish->at.vx + k] = -5;
        }
        merge_all(&setup);
        // older ones are merged
        for (int k = 0; k < 3; k++) NEAR_ARRAY(16, now[k] + wake->n_vortex - 16, newest[k], 0, 0);
        BELOW(wake->n_vortex, N / 2);
    }
}

TEST(a_pair_that_dies_before_a_body_comes_is_merged) {
    // the second body is 100 away and comes near with 8 a second, in 12 s; the oldest vortices have some tenths of a
    // second to live, the newest ones 16 s
    struct setup setup;
    trail(&setup, SMALL
          "wake: {lifetime: 16, shedding: continuous, merge: 0.1}\nfish: [{}, {start: {position: [100, 0.2]}}]\n");
    double *const y = setup.state->y;
    const struct fish *const fish = setup.school->fish;
    for (int k = 0; k < fish[0].n_nodes; k++) y[fish[0].at.x + k] -= 100;
    for (int k = 0; k < fish[1].n_nodes; k++) y[fish[1].at.vx + k] = -8;
    merge_all(&setup);
    const struct wake *const wake = &setup.state->wake[0];
    // a vortex at x is x - 1 seconds old, and the body is within two lengths of it after (98 - x)/8 s:
    // the vortex is removed earlier if 17 - x < (98 - x)/8, x above 5.4
    int n_near = 0, n_far = 0;
    for (int i = 0; i < wake->n_vortex; i++) {
        n_near += wake->x[i] < 5;
        n_far += wake->x[i] > 7;
    }
    assert_int_equal(n_near, 400);
    BELOW(n_far, 500);
}

/* The distance of the body from which on the second and third of 19 markers are merged; reversed: the four markers in
 * the other order, which is the same sheet. */
static double merging_distance(int reversed) {
    static const double x[] = {0, 0.1, 0.4, 0.5}, y[] = {0, 0.2, -0.1, 0.3}, label[] = {0, 1, 1.5, 4.5};
    double distance[2] = {2, 200};
    while (distance[1] - distance[0] > 1e-9) {
        const double middle = (distance[0] + distance[1]) / 2;
        struct setup setup = setup_of(SMALL "wake: {lifetime: 16, shedding: sheet, merge: 0.1}\nfish: [{}]\n");
        const struct fish *const fish = setup.school->fish;
        for (int k = 0; k < fish->n_nodes; k++) setup.state->y[fish->at.vx + k] = setup.state->y[fish->at.vy + k] = 0;
        struct wake *const wake = &setup.state->wake[0];
        for (int i = 0; i < 19; i++) {
            const int k = reversed ? 3 - i : i;
            if (i < 4) wake_release(wake, x[k], middle + y[k], reversed ? -label[k] : label[k], 0.01 * i);
            if (i >= 4) wake_release(wake, 0.1 * i, middle, 5, 0.01 * i);
        }
        setup.state->event = WAKE_MERGE_EVENTS;
        wake_merge(setup.school, setup.state);
        distance[wake->n_merged > 0] = middle;
    }
    return distance[0];
}

TEST(the_distance_does_not_know_which_end_of_the_sheet_is_newer) {
    const double distance = merging_distance(0);
    // neither the least distance of all pairs nor the end of the search
    ABOVE(distance, 4);
    BELOW(distance, 190);
    NEAR(merging_distance(1), distance, 1e-8, 0);
}

TEST(wakes_take_turns) {
    struct setup setup;
    trail(&setup, SMALL "wake: {lifetime: 16, merge: 0.01}\n" TWO);
    setup.state->event = 1601;
    wake_merge(setup.school, setup.state);
    assert_int_equal(setup.state->wake[0].n_merged, 0);
    const unsigned long version = setup.state->wake[0].version;
    setup.state->event = 1608;
    wake_merge(setup.school, setup.state);
    ABOVE(setup.state->wake[0].n_merged, 0);
    ABOVE(setup.state->wake[0].version, version);
    // births stay in order
    const struct wake *const wake = &setup.state->wake[0];
    for (int i = 1; i < wake->n_vortex; i++) ABOVE(wake->birth[i], wake->birth[i - 1]);
}

TEST(without_the_key_nothing_is_merged) {
    struct setup setup;
    trail(&setup, SMALL "wake: {lifetime: 16}\n" TWO);
    assert_int_equal(merge_all(&setup), 0);
    assert_int_equal(setup.state->wake[0].n_vortex, N);
}
