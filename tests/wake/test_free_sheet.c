/* test_free_sheet.c: markers, stretches, and sources for the own body. doc/model.md, section 8. */
#include <string.h>

#include "base/mathematics.h"
#include "school.h"
#include "wake/free_sheet.h"

#define SHEET "wake: {shedding: sheet, smoothing: 0.1, taper: 0.4, taper_beside: 0.1}\n"
#define TIME "time: {end: 1, shedding_interval: 0.02, output_interval: 0.02}\n"

static void the_panel_integrates_the_inverse_square_root(void **state) {
    (void)state;

    // integral of xi^(-1/2) xi^k over [0, 1]: 1/(k + 1/2); four points are exact up to k = 3
    for (int k = 0; k < 4; k++) {
        double sum = 0;
        for (int i = 0; i < FREE_SHEET_PANEL; i++) sum += free_sheet_part[i] * pow(free_sheet_xi[i], k - 0.5);
        NEAR(sum, 1 / (k + 0.5), 1e-15, 1e-14);
    }
}

static void a_marker_is_born_at_the_tail_at_every_event(void **state) {
    (void)state;
    struct simulation *const simulation = school_simulation(TIME SHEET "fish: [{start: {speed: 1}}]\n");
    const struct fish *fish = simulation->school->fish;
    const struct wake *wake = &simulation->state->wake[0];
    const double *const y = simulation->state->y;

    // marker 0, without shed circulation
    assert_int_equal(wake->n_vortex, 1);
    NEAR(wake->circulation[0], 0, 0, 0);
    for (int n = 1; n <= 20; n++) {
        school_ok(simulate_step(simulation));
        assert_int_equal(wake->n_vortex, n + 1);
        NEAR(wake->circulation[n], y[fish->at.circulation], 0, 0);
        NEAR(wake->x[n], y[fish->at.x + fish->n_nodes - 1], 0, 0);
        NEAR(wake->y[n], y[fish->at.y + fish->n_nodes - 1], 0, 0);
        NEAR(wake->birth[n], 0.02 * n, 1e-15, 0);

        // the marker does not move forwards along the body
        const struct direction tail = fish_direction(fish, &fish->tail_tangent, y);
        const double relative[2] = {wake->u[n] - y[fish->at.vx + fish->n_nodes - 1],
                                    wake->v[n] - y[fish->at.vy + fish->n_nodes - 1]};
        assert_true(relative[0] * tail.t[0] + relative[1] * tail.t[1] > -1e-12);
    }

    simulate_free(simulation);
}

static void a_marker_of_a_tail_that_moves_backwards_stays_at_the_tail(void **state) {
    (void)state;
    struct simulation *const simulation = school_simulation(TIME SHEET "fish: [{start: {speed: -1}}]\n");
    const struct fish *fish = simulation->school->fish;
    const struct wake *wake = &simulation->state->wake[0];
    const double *const y = simulation->state->y;
    for (int n = 1; n <= 3; n++) {
        school_ok(simulate_step(simulation));
        const struct direction tail = fish_direction(fish, &fish->tail_tangent, y);
        const double relative[2] = {wake->u[n] - y[fish->at.vx + fish->n_nodes - 1],
                                    wake->v[n] - y[fish->at.vy + fish->n_nodes - 1]};
        assert_true(wake->slip[0] * tail.t[0] + wake->slip[1] * tail.t[1] < -0.5);
        NEAR(relative[0] * tail.t[0] + relative[1] * tail.t[1], 0, 1e-12, 0);
        // across the body the marker moves with the fluid
        NEAR(relative[1] * tail.t[0] - relative[0] * tail.t[1], wake->slip[1] * tail.t[0] - wake->slip[0] * tail.t[1],
             1e-12, 0);
    }
    simulate_free(simulation);
}

static void stretches_lie_between_markers_and_markers_have_half_of_both(void **state) {
    (void)state;
    struct setup setup;
    school_build(&setup, TIME SHEET "fish: [{}]\n");
    school_stir(&setup);
    struct wake *const wake = &setup.state->wake[0];
    struct wake middles = {0};
    school_ok(free_sheet_middles(wake, &middles));
    assert_int_equal(middles.n_vortex, wake->n_vortex - 1);
    double strength[8], sum = 0, all = 0;
    free_sheet_strengths(wake, setup.school, setup.state->t, 0.25, strength);
    for (int i = 0; i < middles.n_vortex; i++) {
        NEAR(middles.x[i], (wake->x[i] + wake->x[i + 1]) / 2, 1e-15, 0);
        NEAR(middles.circulation[i], wake->circulation[i + 1] - wake->circulation[i], 1e-15, 0);
        all += middles.circulation[i] * wake_strength(setup.school, setup.state->t - middles.birth[i]);
    }

    for (int i = 0; i < wake->n_vortex; i++) sum += strength[i];
    NEAR(sum, all + 0.25, 1e-14, 0);
    wake_free(&middles);
    school_clear(&setup);
}

static void the_own_body_sees_the_same_circulation_as_others(void **state) {
    (void)state;
    struct setup setup;
    school_build(&setup, TIME SHEET "fish: [{}]\n");
    school_stir(&setup);
    school_flow(&setup, setup.state->y);
    const struct free_sheet *const sheet = setup.residual->flow->free_sheet;

    // the sources of the newest stretches and the subtracted middles sum to zero circulation
    double sum = 0, size = 0;
    for (int i = sheet->n_tapered; i < sheet->n; i++) {
        sum += sheet->circulation[i];
        size += fabs(sheet->circulation[i]);
    }

    assert_true(size > 0.1);
    NEAR(sum, 0, 1e-14, 0);
    school_clear(&setup);
}

static void the_smoothing_tapers_to_nothing_at_the_tail(void **state) {
    (void)state;
    struct simulation *const simulation = school_simulation(TIME SHEET "fish: [{start: {speed: 1}}]\n");
    school_run(simulation, 0.8);
    const struct free_sheet *const sheet = simulation->residual->flow->free_sheet;
    const struct fish *fish = simulation->school->fish;
    const double *const y = simulation->state->y;
    const int last = fish->n_nodes - 1;
    int n = 0;
    for (int i = 0; i < sheet->n - FREE_SHEET_PANEL - 1; i++) {
        if (sheet->part[i] < 0) continue;
        const double dx = sheet->x[i] - y[fish->at.x + last], dy = sheet->y[i] - y[fish->at.y + last];
        const double want = 0.1 * (1 - exp(-pow(hypot(dx, dy) / 0.4, 4)));

        // a wake behind the body; tolerance: rounding of a difference near the tail
        NEAR(sqrt(sheet->square[i]), want, 1e-12, 1e-9);
        n++;
    }

    assert_true(n > 20);
    simulate_free(simulation);
}

// beside the body the taper length falls from the length behind the tail, at right angles, to that beside the body, at
// an angle of 30 degrees with the normal and beyond
static void the_taper_is_shorter_beside_the_body(void **state) {
    (void)state;
    struct setup setup;
    school_build(&setup, TIME SHEET "fish: [{}]\n");
    const struct fish *const fish = setup.school->fish;
    const double tangent[] = {0.6, 0.8}, pi = acos(-1);
    for (int degrees = -180; degrees <= 180; degrees += 5) {
        const double angle = degrees * pi / 180, r = 0.15;
        // cosine of the angle between place and tangent
        const double along = cos(angle),
                     from[] = {r * (along * 0.6 - sin(angle) * 0.8), r * (along * 0.8 + sin(angle) * 0.6)};
        const double q = along >= 0 ? 1 : fmax(0, 1 + 2 * along), length = 0.1 + 0.3 * ramp_step(q);
        NEAR(free_sheet_smoothing(fish, from, tangent), 0.1 * (1 - exp(-pow(r / length, 4))), 1e-14, 1e-11);
    }
    school_clear(&setup);
}

static void a_tail_that_overtakes_its_newest_marker_keeps_the_nascent_stretch_beside_it(void **state) {
    (void)state;
    struct setup setup;
    school_build(&setup, TIME SHEET "fish: [{}]\n");
    school_stir(&setup);
    const struct fish *const fish = setup.school->fish;
    struct wake *const wake = &setup.state->wake[0];
    double *const y = setup.state->y, marker[2];
    wake_marker(wake, wake->n_vortex - 1, 0.02, setup.t - setup.state->t, marker);
    const struct direction at = fish_direction(fish, &fish->tail_tangent, y);
    const int tail = fish->n_nodes - 1;
    for (int is_behind = 0; is_behind < 2; is_behind++) {
        // move the whole body
        double shift[2], place[2];
        for (int k = 0; k < 2; k++) {
            place[k] = marker[k] + (is_behind ? -0.03 : 0.03) * at.t[k] - 0.01 * at.n[k];
            shift[k] = place[k] - y[(k == 0 ? fish->at.x : fish->at.y) + tail];
        }

        for (int m = 0; m < fish->n_nodes; m++) {
            y[fish->at.x + m] += shift[0];
            y[fish->at.y + m] += shift[1];
        }

        school_flow(&setup, y);
        const struct free_sheet *const sheet = setup.residual->flow->free_sheet;
        const int first = sheet->n - (FREE_SHEET_PANEL + 1);
        assert_int_equal(sheet->end.is_overtaken, !is_behind);
        for (int i = 0; i < FREE_SHEET_PANEL; i++) {
            // a marker ahead of the tail: end beside the tail; else the end is the marker
            const double along = is_behind ? 0.03 : 0, xi = free_sheet_xi[i];
            NEAR(sheet->x[first + i], place[0] + xi * (0.01 * at.n[0] + along * at.t[0]), 1e-15, 1e-14);
            NEAR(sheet->y[first + i], place[1] + xi * (0.01 * at.n[1] + along * at.t[1]), 1e-15, 1e-14);
        }

        // subtracted source: the middle between tail and marker
        NEAR(sheet->x[first + FREE_SHEET_PANEL], (place[0] + marker[0]) / 2, 1e-15, 1e-14);
        NEAR(sheet->y[first + FREE_SHEET_PANEL], (place[1] + marker[1]) / 2, 1e-15, 1e-14);
        NEAR(sheet->circulation[first + FREE_SHEET_PANEL], -setup.residual->flow->nascent.circulation[0], 0, 0);
        NEAR(setup.residual->flow->nascent.x[0], (place[0] + marker[0]) / 2, 1e-15, 1e-14);
    }

    school_clear(&setup);
}

// beyond 2.36 times the longer taper the taper is negligible in any direction; slightly closer the taper is finite
static void far_from_the_tail_the_smoothing_is_full(void **state) {
    (void)state;
    struct setup setup;
    school_build(&setup, TIME SHEET "fish: [{length: 2}]\n");
    const struct fish *const fish = setup.school->fish;
    const double along[2] = {1, 0};
    for (double angle = 0; angle < 6.3; angle += 0.3) {
        const double direction[2] = {cos(angle), sin(angle)};
        for (int i = 0; i < 2; i++) {
            const double distance = 2 * 0.4 * (i == 0 ? 2.355 : 2.365);
            const double at[2] = {distance * direction[0], distance * direction[1]};
            assert_int_equal(free_sheet_is_far(fish, at), i);
            NEAR(free_sheet_smoothing(fish, at, along), 0.2, 0, i == 0 ? 1e-12 : 1e-13);
        }
    }

    // one spacing of the bound sheet beside the body: with the defaults 0.023 L at 0.05 L
    NEAR(free_sheet_smoothing(fish, (const double[]){-0.1, 0.02}, along), 0.2 * (1 - exp(-pow(0.10198 / 0.2, 4))), 1e-6,
         0);
    NEAR(free_sheet_smoothing(fish, (const double[]){0, 0}, along), 0, 0, 0);
    school_clear(&setup);
}

static void total_circulation_vanishes(void **state) {
    (void)state;
    struct simulation *const simulation = school_simulation(
        TIME "wake: {shedding: sheet, lifetime: 0.3}\nfish: [{start: {speed: 1}}, {start: {position: [0.2, 0.6]}}]\n");
    for (int n = 0; n < 30; n++) {
        school_ok(simulate_step(simulation));
        simulate_measure(simulation);
        NEAR(simulation->diagnostics->total_circulation, 0, 1e-12, 0);
    }

    assert_int_equal(simulation->state->wake[0].n_vortex, 16);
    simulate_free(simulation);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_panel_integrates_the_inverse_square_root),
        cmocka_unit_test(a_marker_is_born_at_the_tail_at_every_event),
        cmocka_unit_test(a_marker_of_a_tail_that_moves_backwards_stays_at_the_tail),
        cmocka_unit_test(stretches_lie_between_markers_and_markers_have_half_of_both),
        cmocka_unit_test(the_own_body_sees_the_same_circulation_as_others),
        cmocka_unit_test(the_smoothing_tapers_to_nothing_at_the_tail),
        cmocka_unit_test(the_taper_is_shorter_beside_the_body),
        cmocka_unit_test(a_tail_that_overtakes_its_newest_marker_keeps_the_nascent_stretch_beside_it),
        cmocka_unit_test(far_from_the_tail_the_smoothing_is_full),
        cmocka_unit_test(total_circulation_vanishes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
