/* test_wake.c: Tests the queue of free vortices: how it grows, moves, decays and loses its oldest ones (doc/model.md,
 * sections 7 and 8). */
#include <string.h>

#include "base/mathematics.h"
#include "school.h"
#include "state/impulse.h"
#include "state/state.h"
#include "wake/wake.h"

#define SMALL "time: {end: 1, shedding_interval: 0.02, output_interval: 0.02}\ndefaults: {fish: {nodes: 7}}\n"

static void at_time(const struct wake *wake, const struct school *school, double t, double tau, double *x, double *y,
                    double *strength) {
    wake_places(wake, school->interval, tau, x, y);
    wake_strengths(wake, school, t, tau, strength);
}

TEST(release_keeps_what_is_there_while_it_grows) {
    struct wake wake;
    wake_create(test_arena(), &wake, 2);
    for (int i = 0; i < 100; i++) wake_release(&wake, i, 2 * i, 3 * i, 4 * i);
    assert_int_equal(wake.n_vortex, 100);
    AT_LEAST(wake.capacity, 100);
    for (int i = 0; i < 100; i++) {
        const double got[] = {wake.x[i], wake.y[i], wake.circulation[i], wake.birth[i], wake.u[i], wake.v_before[i]};
        const double want[] = {i, 2 * i, 3 * i, 4 * i, 0, 0};
        NEAR_ARRAY(6, got, want, 0, 0);
    }
}

TEST(path_follows_a_velocity_that_is_linear_in_time) {
    struct setup setup = setup_of(SMALL "fish: [{}]\n");
    const double interval = setup.school->interval;
    struct wake *wake = &setup.state->wake[0];
    wake_release(wake, 1, 2, 0.5, 0);

    // W(t) = 3 + 8 t and -1 + 2 t: the path 1 + 3 t + 4 t^2, 2 - t + t^2 is exact from the second interval on
    wake->u_before[0] = 3 - 8 * interval;
    wake->v_before[0] = -1 - 2 * interval;
    wake->u[0] = 3;
    wake->v[0] = -1;
    for (int i = 0; i <= 4; i++) {
        const double tau = i * interval / 4;
        double x, y, strength;
        at_time(wake, setup.school, 0, tau, &x, &y, &strength);
        NEAR(x, 1 + 3 * tau + 4 * tau * tau, 1e-15, 0);
        NEAR(y, 2 - tau + tau * tau, 1e-15, 0);
        NEAR(strength, 0.5, 0, 0);
    }

    wake_advance(wake, interval);
    NEAR(wake->x[0], 1 + 3 * interval + 4 * interval * interval, 1e-15, 0);
    NEAR(wake->y[0], 2 - interval + interval * interval, 1e-15, 0);
}

// error after one turn on a circle with n intervals
static double error_on_a_circle(int n) {
    const double interval = 2 * acos(-1) / n;
    struct wake wake;
    wake_create(test_arena(), &wake, 1);
    wake_release(&wake, 1, 0, 1, 0);
    for (int i = 0; i < n; i++) {
        const double u = -wake.y[0], v = wake.x[0];
        wake_set_velocity(&wake, &u, &v, NULL, i == 0 ? 1 : 0);
        wake_advance(&wake, interval);
    }

    const double error = hypot(wake.x[0] - 1, wake.y[0]);
    return error;
}

TEST(paths_are_second_order_in_the_interval) {
    const double order = log2(error_on_a_circle(200) / error_on_a_circle(400));
    // the first interval is of first order, but occurs only once: the global order is two
    NEAR(order, 2, 0.1, 0);
}

TEST(new_velocities_push_the_old_ones_back) {
    struct wake wake;
    wake_create(test_arena(), &wake, 4);
    for (int i = 0; i < 3; i++) wake_release(&wake, i, 0, 1, 0);
    const double u[] = {1, 2, 3}, v[] = {4, 5, 6}, more_u[] = {7, 8, 9}, more_v[] = {10, 11, 12};
    wake_set_velocity(&wake, u, v, NULL, 3);
    NEAR_ARRAY(3, wake.u_before, u, 0, 0);

    // the last vortex is new: the velocity also replaces the previous velocity
    wake_set_velocity(&wake, more_u, more_v, NULL, 1);
    const double want_u[] = {1, 2, 9}, want_v[] = {4, 5, 12};
    NEAR_ARRAY(3, wake.u_before, want_u, 0, 0);
    NEAR_ARRAY(3, wake.v_before, want_v, 0, 0);
    NEAR_ARRAY(3, wake.u, more_u, 0, 0);
    NEAR_ARRAY(3, wake.v, more_v, 0, 0);
}

TEST(strength_fades_as_the_ramp_over_the_last_part_of_life) {
    struct setup setup = setup_of(SMALL "wake: {lifetime: 1, decay: 0.4}\nfish: [{}]\n");
    for (int i = 0; i <= 4; i++) NEAR(wake_strength(setup.school, 0.59 + 0.1 * i), 1 - ramp_step(0.25 * i), 1e-14, 0);
    NEAR(wake_strength(setup.school, 0.5), 1, 0, 0);

    // linear within an interval
    struct wake *wake = &setup.state->wake[0];
    wake_release(wake, 0, 0, 2, 0);
    double x, y, at[3];
    for (int i = 0; i < 3; i++) at_time(wake, setup.school, 0.8, 0.01 * i, &x, &y, &at[i]);
    NEAR(at[0], 2 * (1 - ramp_step(0.525)), 1e-14, 0);
    NEAR(at[2], 2 * (1 - ramp_step(0.575)), 1e-14, 0);
    NEAR(at[1], (at[0] + at[2]) / 2, 1e-15, 0);
}

// between two events the strength is linear, also in the interval in which the decay begins
TEST(wake_of_a_shorter_lifetime_fades_alike_and_ends_earlier) {
    struct setup setup = setup_of(SMALL
                                  "wake: {lifetime: 1, decay: 0.4}\n"
                                  "fish: [{}, {wake_lifetime: 0.6, start: {position: [3, 0]}}]\n");
    for (int f = 0; f < 2; f++) {
        struct wake *const wake = &setup.state->wake[f];
        const double lifetime = f == 0 ? 1 : 0.6;
        for (int i = 0; i < 3; i++) wake_release(wake, 0, 0, i, 0.02 * i);
        for (double before = 0.02; before < lifetime; before += 0.02) {
            const double part = wake_part_of_label(wake, setup.school, lifetime - before, 0, 0);
            NEAR(part, wake_strength(setup.school, 1 - before), 1e-12, 0);
        }

        // a stretch goes with its newer marker, whose age is a lifetime
        wake_remove_old(wake, setup.school, lifetime);
        assert_int_equal(wake->n_vortex, 3);
        wake_remove_old(wake, setup.school, lifetime + 0.02);
        assert_int_equal(wake->n_vortex, 2);
    }
}

TEST(strength_within_an_interval_joins_the_strengths_at_its_ends) {
    static const char *const lives[] = {
        "shedding: continuous, lifetime: 1, decay: 0.4",   "shedding: continuous, lifetime: 1, decay: 0.1",
        "shedding: continuous, lifetime: 1, decay: 0.03",  "shedding: continuous, lifetime: 1, decay: 0.001",
        "shedding: continuous, lifetime: 1, decay: 0",     "shedding: continuous, lifetime: 1.013, decay: 0.405",
        "shedding: continuous, lifetime: 1.013, decay: 0", "shedding: impulsive, lifetime: 1, decay: 0"};
    for (size_t i = 0; i < sizeof lives / sizeof *lives; i++) {
        struct setup setup;
        char text[256];
        snprintf(text, sizeof text, SMALL "wake: {%s}\nfish: [{}]\n", lives[i]);
        school_build(&setup, text);
        struct wake *const wake = &setup.state->wake[0];
        wake_release(wake, 0, 0, 2, 0);
        for (double age = 0; age < 1; age += 0.0013) {
            const double ends[] = {wake_strength(setup.school, age), wake_strength(setup.school, age + 0.02)};
            for (int q = 0; q < 3; q++) {
                const double want = ends[0] + q / 2.0 * (ends[1] - ends[0]);
                double x, y, strength;
                NEAR(wake_strength_within(setup.school, age, q / 2.0), want, 1e-15, 0);
                at_time(wake, setup.school, age, q * 0.01, &x, &y, &strength);
                NEAR(strength, 2 * want, 1e-14, 0);
                NEAR(impulse_lost_circulation(wake, setup.school, age, q * 0.01), 2 * (1 - want), 1e-14, 0);
            }
        }
    }
}

TEST(labels_together_have_the_parts_of_each_alone) {
    static const char *const spans[] = {"finite", "infinite"};
    for (int k = 0; k < 2; k++) {
        struct setup setup = setup_with(
            SMALL "wake: {lifetime: 0.3, decay: 0.2}\nfish: [{force: pressure, pressure: {span: %s}}]\n", spans[k]);
        struct wake *const wake = &setup.state->wake[0];
        wake->has_markers = true;
        for (int i = 0; i < 17; i++) wake_release(wake, i, -i, i * i, 0.02 * i);
        double part[17];
        wake_parts_of_labels(wake, setup.school, 0.32, 0.4, part);
        for (int i = 0; i < 17; i++) NEAR(part[i], wake_part_of_label(wake, setup.school, 0.32, 0.4, i), 0, 0);
        if (k == 0) BELOW(part[1], 0.5);
        NEAR(part[16], 1, 0, 0);
    }
}

TEST(old_vortices_go_and_leave_their_circulation) {
    struct setup setup = setup_of(SMALL "wake: {shedding: continuous, lifetime: 0.1}\nfish: [{}]\n");
    struct wake *wake = &setup.state->wake[0];
    for (int i = 1; i <= 9; i++) wake_release(wake, i, -i, 0.1 * i, 0.02 * i);

    // at 0.16 the vortices of 0.02, 0.04 and 0.06 (exactly a lifetime old) are removed, without remaining strength
    NEAR(wake_strength(setup.school, 0.1), 0, 0, 0);
    wake_remove_old(wake, setup.school, 0.16);
    assert_int_equal(wake->n_vortex, 6);
    NEAR(wake->x[0], 4, 0, 0);
    NEAR(wake->y[5], -9, 0, 0);
    NEAR(wake->birth[0], 0.08, 1e-17, 0);
    NEAR(wake->removed, 0.6, 1e-15, 0);
    wake_remove_old(wake, setup.school, 0.16);
    assert_int_equal(wake->n_vortex, 6);
}

TEST(without_fade_a_vortex_vanishes_within_one_interval) {
    struct setup setup = setup_of(SMALL "wake: {shedding: continuous, lifetime: 0.105, decay: 0}\nfish: [{}]\n");
    struct wake *wake = &setup.state->wake[0];
    wake_release(wake, 0, 0, 2, 0);
    NEAR(wake_strength(setup.school, 0.08), 1, 0, 0);
    NEAR(wake_strength(setup.school, 0.1), 0.25, 1e-14, 0);

    // a vortex stays until its strength is 0; the lost circulation is counted meanwhile
    wake_remove_old(wake, setup.school, 0.1);
    assert_int_equal(wake->n_vortex, 1);
    NEAR(impulse_lost_circulation(wake, setup.school, 0.1, 0), 1.5, 1e-13, 0);
    NEAR(impulse_lost_circulation(wake, setup.school, 0.1, 0.01), 1.75, 1e-13, 0);
    NEAR(impulse_lost_circulation(wake, setup.school, 0.1, 0.02), 2, 1e-13, 0);
    wake_remove_old(wake, setup.school, 0.12);
    assert_int_equal(wake->n_vortex, 0);
    NEAR(impulse_lost_circulation(wake, setup.school, 0.12, 0), 2, 0, 0);
}

TEST(a_stretch_is_as_old_as_its_newer_marker) {
    struct setup setup = setup_of(SMALL "wake: {lifetime: 0.1, decay: 0.06}\nfish: [{pressure: {span: infinite}}]\n");
    struct wake *wake = &setup.state->wake[0];
    wake->has_markers = 1;
    for (int i = 0; i < 5; i++) wake_release(wake, i, 0, i * i, 0.02 * i);

    // the stretch between the labels i^2 and (i + 1)^2 has the circulation 2 i + 1
    for (int k = 0; k <= 2; k++) {
        const double tau = 0.01 * k;
        double lost = 0;
        for (int i = 0; i < 4; i++) {
            const double age = 0.08 - 0.02 * (i + 1);
            lost += (2 * i + 1) * (1 - wake_strength_within(setup.school, age, tau / 0.02));
        }
        ABOVE(lost, 0.1);
        NEAR(impulse_lost_circulation(wake, setup.school, 0.08, tau), lost, 1e-13, 0);
    }
}

TEST(what_was_shed_long_ago_changes_no_vortex) {
    // as vortices, and as markers, whose labels are the circulation shed before
    for (int has_markers = 0; has_markers <= 1; has_markers++) {
        struct wake wake;
        wake_create(test_arena(), &wake, 3);
        wake.has_markers = has_markers;
        wake.shed_before = 9;
        for (int i = 0; i < 3; i++) wake_release(&wake, i, 0, 1 << i, i);
        const unsigned long version = wake.version;
        wake_add_shed(&wake, 0.5);
        for (int i = 0; i < wake_n_sources(&wake); i++) NEAR(wake_source(&wake, i), 1 << i, 0, 0);
        NEAR(wake.circulation[2], has_markers ? 4.5 : 4, 0, 0);
        NEAR(wake.shed_before, 9.5, 0, 0);
        NEAR(wake.removed, 0.5, 0, 0);
        ABOVE(wake.version, version);
    }
}

// a queue of n markers with the labels i^2
static struct wake *queue(const struct setup *setup, int n) {
    struct wake *const wake = &setup->state->wake[0];
    wake->has_markers = 1;
    wake->n_vortex = 0;
    for (int i = 0; i < n; i++) wake_release(wake, i, -i, i * i, 0.02 * i);
    return wake;
}

TEST(a_vortex_from_outside_is_a_stretch_between_two_without_circulation) {
    struct setup setup = setup_of(SMALL "wake: {spare_vortices: 3}\nfish: [{pressure: {span: infinite}}]\n");
    struct wake *const wake = queue(&setup, 10);
    wake->removed = 0.5;
    const unsigned long version = wake->version;
    school_ok(wake_add_vortex(wake, setup.school, 0.2, 7, 8, 100));
    assert_int_equal(wake->n_vortex, 13);
    ABOVE(wake->version, version);
    // behind the five newest stretches: four stretches before, then nothing, the vortex, nothing
    const double circulation[] = {1, 3, 5, 7, 0, 100, 0, 9, 11, 13, 15, 17};
    const double x[] = {0, 1, 2, 3, 4, 7, 7, 4, 5, 6, 7, 8, 9}, y[] = {0, -1, -2, -3, -4, 8, 8, -4, -5, -6, -7, -8, -9};
    assert_int_equal(wake_n_sources(wake), 12);
    for (int i = 0; i < 12; i++) NEAR(wake_source(wake, i), circulation[i], 1e-13, 0);
    NEAR_ARRAY(13, wake->x, x, 0, 0);
    NEAR_ARRAY(13, wake->y, y, 0, 0);
    // the newest label is what was shed; the opposite circulation is at infinite distance
    NEAR(wake->circulation[12], 81, 0, 0);
    NEAR(wake->circulation[0], -100, 0, 0);
    NEAR(wake->removed, -99.5, 0, 0);
    for (int i = 4; i <= 7; i++) NEAR(wake->birth[i], 0.08, 1e-15, 0);

    // the spare vortices are used: nothing changes
    assert_int_equal(wake_add_vortex(wake, setup.school, 0.2, 7, 8, 1), STATUS_CASE);
    assert_non_null(strstr(status_message(), "wake.spare_vortices: 3, of which 3 are used; 3 more are required"));
    assert_int_equal(wake->n_vortex, 13);
    NEAR(wake->removed, -99.5, 0, 0);
}

TEST(a_vortex_from_outside_among_vortices_is_the_newest) {
    struct setup setup = setup_of(SMALL "wake: {shedding: continuous, spare_vortices: 1}\nfish: [{}]\n");
    struct wake *const wake = &setup.state->wake[0];
    for (int i = 0; i < 3; i++) wake_release(wake, i, -i, 1, 0.02 * i);
    school_ok(wake_add_vortex(wake, setup.school, 0.2, 7, 8, 100));
    assert_int_equal(wake->n_vortex, 4);
    const double got[] = {wake->x[3], wake->y[3], wake->circulation[3], wake->birth[3], wake->removed};
    NEAR_ARRAY(5, got, ((double[]){7, 8, 100, 0.2, -100}), 0, 0);
    assert_int_equal(wake_add_vortex(wake, setup.school, 0.2, 7, 8, 1), STATUS_CASE);
}

TEST(a_queue_goes_on_at_a_tail_that_was_moved) {
    struct setup setup = setup_of(SMALL "wake: {spare_vortices: 1}\nfish: [{}]\n");
    struct wake *const wake = queue(&setup, 4);
    // the tail is at the newest marker: no break
    school_ok(wake_break(wake, setup.school, 0.1, (const double[]){3, -3}));
    assert_int_equal(wake->n_vortex, 4);
    school_ok(wake_break(wake, setup.school, 0.1, (const double[]){3, 5}));
    assert_int_equal(wake->n_vortex, 5);
    const double got[] = {wake->x[4], wake->y[4], wake_source(wake, 3), wake->circulation[4], wake->birth[4]};
    NEAR_ARRAY(5, got, ((double[]){3, 5, 0, 9, 0.1}), 0, 0);
    assert_int_equal(wake_break(wake, setup.school, 0.1, (const double[]){4, 5}), STATUS_CASE);
}

TEST(markers_at_one_place_move_together) {
    struct wake wake;
    wake_create(test_arena(), &wake, 4);
    wake.has_markers = 1;
    const double x[] = {0, 1, 1, 2}, label[] = {0, 0, 5, 5}, u[] = {1, 2, 3, 4}, v[] = {5, 6, 7, 8};
    for (int i = 0; i < 4; i++) wake_release(&wake, x[i], 0, label[i], i);
    wake_set_velocity(&wake, u, v, NULL, 4);
    NEAR_ARRAY(4, wake.u, ((double[]){1, 2, 2, 4}), 0, 0);
    NEAR_ARRAY(4, wake.v, ((double[]){5, 6, 6, 8}), 0, 0);
    NEAR_ARRAY(4, wake.u_before, ((double[]){1, 2, 2, 4}), 0, 0);
}

TEST(the_oldest_label_is_what_was_removed) {
    struct wake wake;
    wake_create(test_arena(), &wake, 2);
    wake.has_markers = 1;
    wake.removed = 3;
    const double zero[] = {0, 0}, rate[] = {4, 6};
    for (int i = 0; i < 2; i++) wake_release(&wake, i, 0, 3 + i, i);
    wake_set_velocity(&wake, zero, zero, rate, 2);
    wake_advance(&wake, 0.5);
    NEAR(wake.circulation[0], 5, 1e-15, 0);
    NEAR(wake.circulation[1], 7, 1e-15, 0);
    NEAR(wake.removed, 5, 1e-15, 0);
}

TEST(most_is_enough_and_not_too_much) {
    struct setup setup = setup_of(SMALL "wake: {lifetime: 0.1}\nfish: [{}]\n");
    // markers at both ends of five stretches; a release at every event, and for impulses one at the start
    assert_int_equal(wake_most(setup.school, 1000), 6);
    assert_int_equal(wake_most(setup.school, 3), 4);
}

TEST(nascent_vortex_is_the_centroid_of_what_was_shed) {
    const struct wake wake = {.slip = {2, -4}};
    const double tail[2] = {1, 1};
    double position[2];
    wake_nascent(&wake, 0.1, tail, position);
    NEAR(position[0], 1.1, 1e-15, 0);
    NEAR(position[1], 0.8, 1e-15, 0);
}
