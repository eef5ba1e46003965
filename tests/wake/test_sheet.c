/* test_sheet.c: Tests the markers and stretches of a free sheet, and the sources that bodies, markers and other fish
 * see of it (doc/model.md, sections 7, 8 and 18). */
#include <stdio.h>
#include <string.h>

#include "base/mathematics.h"
#include "school.h"
#include "wake/sheet.h"

#define SHEET "wake: {shedding: sheet, smoothing: 0.1, taper: 0.4, taper_beside: 0.1}\n"
#define TIME "time: {end: 1, shedding_interval: 0.02, output_interval: 0.02}\n"
#define LONG_LEGS "wake: {shedding: sheet, smoothing: 0.1, taper: 0.4, taper_beside: 0.1, leg_length: 1.5}\n"
#define SMALL TIME "defaults: {fish: {nodes: 7}}\n"

TEST(the_panel_integrates_the_inverse_square_root) {
    struct setup setup = setup_of(SMALL SHEET "fish: [{}]\n");
    struct sheet sheet = {.n_markers = 0};
    sheet_reserve(setup.arena, &sheet, 0);
    sheet_build(&sheet, setup.school->fish, setup.school, setup.state->wake, setup.state->t);
    const struct sheet_points *const panel = &sheet.graded;
    assert_int_equal(panel->n_released, 0);
    assert_int_equal(panel->n_nascent, SHEET_PANEL);

    // integral of xi^(-1/2) xi^k over [0, 1]: 1/(k + 1/2); four points are exact up to k = 3
    for (int k = 0; k < 4; k++) {
        double sum = 0;
        for (int i = 0; i < SHEET_PANEL; i++) sum += panel->part[i] * pow(panel->xi[i], k - 0.5);
        NEAR(sum, 1 / (k + 0.5), 1e-15, 1e-14);
    }
}

TEST(a_marker_is_born_at_the_tail_at_every_event) {
    struct simulation *const simulation = school_simulation(SMALL SHEET "fish: [{start: {speed: 1}}]\n");
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
        ABOVE(relative[0] * tail.t[0] + relative[1] * tail.t[1], -1e-12);
    }
}

TEST(a_marker_of_a_tail_that_moves_backwards_stays_at_the_tail) {
    struct simulation *const simulation = school_simulation(SMALL SHEET "fish: [{start: {speed: -1}}]\n");
    const struct fish *fish = simulation->school->fish;
    const struct wake *wake = &simulation->state->wake[0];
    const double *const y = simulation->state->y;
    for (int n = 1; n <= 3; n++) {
        school_ok(simulate_step(simulation));
        const struct direction tail = fish_direction(fish, &fish->tail_tangent, y);
        const double relative[2] = {wake->u[n] - y[fish->at.vx + fish->n_nodes - 1],
                                    wake->v[n] - y[fish->at.vy + fish->n_nodes - 1]};
        BELOW(wake->slip[0] * tail.t[0] + wake->slip[1] * tail.t[1], -0.5);
        NEAR(relative[0] * tail.t[0] + relative[1] * tail.t[1], 0, 1e-12, 0);
        // across the body the marker moves with the fluid
        NEAR(relative[1] * tail.t[0] - relative[0] * tail.t[1], wake->slip[1] * tail.t[0] - wake->slip[0] * tail.t[1],
             1e-12, 0);
    }
}

#define SPAN(word) "fish: [{nodes: 7, pressure: {span: " word "}}]\n"

// every view has the circulation of all stretches, the nascent one included; a middle has the whole stretch
TEST(every_view_has_the_same_circulation) {
    static const char *const fish[] = {SPAN("infinite"), SPAN("finite")};
    for (int k = 0; k < 2; k++) {
        struct setup setup = setup_with(TIME SHEET "%s", fish[k]);
        school_stir(&setup);
        setup.t = setup.state->t;
        school_flow(&setup, setup.state->y);
        const struct wake *const wake = &setup.state->wake[0];
        const struct flow_fish *const of = &setup.residual->flow->fish[0];
        const struct sheet *const sheet = &of->wake;
        const struct sources *const middles = &sheet->middles.sources;
        struct sources markers = {.arena = test_arena()};
        double label[16], sum[3] = {0, 0, 0}, stretches = 0;
        AT_MOST(wake->n_vortex, 16);
        wake_strengths(wake, setup.school, setup.t, 0, label);
        sheet_markers(&markers, sheet, setup.school->fish, setup.school, wake, setup.t, of->nascent);
        for (int i = 0; i < sheet->middles.n_released; i++) {
            NEAR(middles->x[i], (wake->x[i] + wake->x[i + 1]) / 2, 1e-15, 0);
            const double age = setup.t - wake->birth[i + 1], part = wake_strength_within(setup.school, age, 0);
            NEAR(middles->q[i], (k == 0 ? part : 1) * (label[i + 1] - label[i]), 1e-15, 0);
            stretches += middles->q[i];
        }
        for (int i = 0; i < sheet->graded.sources.n; i++) sum[0] += sheet->graded.sources.q[i];
        for (int i = 0; i < middles->n; i++) sum[1] += middles->q[i];
        for (int i = 0; i < markers.n; i++) sum[2] += markers.q[i];
        const double all = setup.state->y[setup.school->fish->at.circulation] - label[wake->n_vortex - 1] + stretches;
        ABOVE(fabs(all), 0.01);
        for (int i = 0; i < 3; i++) NEAR(sum[i], all, 1e-13, 0);
    }
}

// model.md, section 18: s(d) = c w^2/8 (1 - exp(-(d/(3 w))^4)) at the distance d from the tail along the sheet
TEST(legs_grow_along_the_sheet_and_old_stretches_have_fewer_points) {
    enum { N = 9 };
    struct setup setup = setup_of(SMALL LONG_LEGS SPAN("finite"));
    const struct fish *const fish = setup.school->fish;
    struct wake *const wake = &setup.state->wake[0];
    const double w = fish->strip_depth, spacing = 0.7 * w;
    for (int i = N - 1; i >= 0; i--) wake_release(wake, i * spacing, 0, 0.1 * i, setup.state->t - 0.02 * i);
    struct sheet sheet = {.n_markers = 0};
    sheet_reserve(setup.arena, &sheet, N);
    sheet_build(&sheet, fish, setup.school, wake, setup.state->t);

    // four points on the newest stretch, two on the next three, one on older ones
    int n_points[N] = {0};
    for (int i = 0; i < sheet.graded.n_released; i++) {
        const int age = N - 1 - sheet.graded.older[i];
        const double distance = (age - 1 + sheet.graded.xi[i]) * spacing;
        NEAR(sheet.graded.leg[0][i], 1.5 * w * w / 8 * (1 - exp(-pow(distance / (3 * w), 4))), 1e-15, 1e-12);
        n_points[age]++;
    }
    for (int age = 1; age < N; age++) assert_int_equal(n_points[age], age == 1 ? 4 : age <= 4 ? 2 : 1);
}

// The legs of a fish less deep than the smoothing of its wake are as long as those of a fish as deep as the smoothing.
// If they follow the depth, the wake of a start from rest stretches without end, and the fish diverges.
TEST(the_wake_of_a_slender_fish_from_rest_does_not_break_up) {
    struct simulation *const simulation = school_simulation(
        "time: {end: 8, shedding_interval: 0.02}\nfish: [{nodes: 9, sheet_points: 101, body: {depth: 0.05}}]\n");
    const struct fish *const fish = simulation->school->fish;
    NEAR(fish->leg_length, 0.1 * 0.1 / 8, 0, 1e-15);
    double label = 0, shed = 0;
    for (int i = 1; i <= 32; i++) {
        school_run(simulation, 0.25 * i);
        const struct wake *const wake = &simulation->state->wake[0];
        for (int k = 0; k < wake->n_vortex; k++) label = fmax(label, fabs(wake->circulation[k]));
        shed = fmax(shed, fabs(simulation->state->y[fish->at.circulation]));
    }
    ABOVE(1.5 * shed, label);
}

// with finite span labels decay; else the circulation of every young stretch decays with the age of the newer marker
TEST(stretches_decay_by_labels_only_if_rings_must_stay_closed) {
    static const char *const fish[] = {SPAN("infinite"), SPAN("finite")};
    for (int k = 0; k < 2; k++) {
        struct setup setup = setup_with(TIME "wake: {shedding: sheet, lifetime: 0.2, decay: 0.15}\n%s", fish[k]);
        struct wake *const wake = &setup.state->wake[0];
        for (int i = 0; i < 8; i++) wake_release(wake, i, sin(i), 0.1 * cos(i), setup.state->t - 0.02 * (8 - i));
        struct sheet sheet = {.n_markers = 0};
        sheet_reserve(setup.arena, &sheet, 8);
        sheet_build(&sheet, setup.school->fish, setup.school, wake, setup.state->t);
        sheet_place(&sheet, &setup.school->fish[0], setup.school, wake, setup.state->t, 0.3 * setup.school->interval);
        double part[8];
        for (int i = 0; i < 8; i++) part[i] = wake_strength_within(setup.school, 0.02 * (8 - i), 0.3);
        BELOW(part[0], 0.2);
        ABOVE(part[7], 0.9);
        for (int i = 0; i < 7; i++) {
            const double by_labels = part[i + 1] * wake->circulation[i + 1] - part[i] * wake->circulation[i];
            const double by_stretch = part[i + 1] * (wake->circulation[i + 1] - wake->circulation[i]);
            NEAR(sheet.middles.sources.q[i], k == 0 ? by_stretch : by_labels, 1e-15, 1e-13);
            ABOVE(fabs(by_labels - by_stretch), 1e-4);
        }
    }
}

TEST(the_smoothing_tapers_to_nothing_at_the_tail) {
    struct simulation *const simulation = school_simulation(SMALL SHEET "fish: [{start: {speed: 1}}]\n");
    school_run(simulation, 0.8);
    const struct sheet_points *const sheet = &simulation->residual->flow->fish[0].wake.graded;
    const struct sources *const sources = &sheet->sources;
    const struct fish *fish = simulation->school->fish;
    const double *const y = simulation->state->y;
    const int last = fish->n_nodes - 1;
    for (int i = 0; i < sheet->n_released; i++) {
        const double dx = sources->x[i] - y[fish->at.x + last], dy = sources->y[i] - y[fish->at.y + last];

        // a wake behind the body; tolerance: rounding of a difference near the tail
        NEAR(sqrt(sources->square[i]), 0.1 * (1 - exp(-pow(hypot(dx, dy) / 0.4, 4))), 1e-12, 1e-9);
    }

    ABOVE(sheet->n_released, 20);
}

// beside the body the taper length falls from the length behind the tail, at right angles, to that beside the body, at
// an angle of 30 degrees with the normal and beyond
TEST(the_taper_is_shorter_beside_the_body) {
    struct setup setup = setup_of(SMALL SHEET "fish: [{}]\n");
    const struct fish *const fish = setup.school->fish;
    const double tangent[] = {0.6, 0.8}, pi = acos(-1);
    for (int degrees = -180; degrees <= 180; degrees += 5) {
        const double angle = degrees * pi / 180, r = 0.15;
        // cosine of the angle between place and tangent
        const double along = cos(angle),
                     from[] = {r * (along * 0.6 - sin(angle) * 0.8), r * (along * 0.8 + sin(angle) * 0.6)};
        const double q = along >= 0 ? 1 : fmax(0, 1 + 2 * along), length = 0.1 + 0.3 * ramp_step(q);
        NEAR(sheet_taper(fish, from, tangent), 0.1 * (1 - exp(-pow(r / length, 4))), 1e-14, 1e-11);
    }
}

// beyond 2.36 times the longer taper the taper is negligible in any direction; slightly closer the taper is finite
TEST(far_from_the_tail_the_smoothing_is_full) {
    struct setup setup = setup_of(SMALL SHEET "fish: [{length: 2}]\n");
    const struct fish *const fish = setup.school->fish;
    const double along[2] = {1, 0};
    for (double angle = 0; angle < 6.3; angle += 0.3) {
        const double direction[2] = {cos(angle), sin(angle)};
        for (int i = 0; i < 2; i++) {
            const double distance = 2 * 0.4 * (i == 0 ? 2.355 : 2.365);
            const double at[2] = {distance * direction[0], distance * direction[1]};
            NEAR(sheet_taper(fish, at, along), 0.2, 0, i == 0 ? 1e-12 : 1e-13);
        }
    }

    // one spacing of the bound sheet beside the body: with the defaults 0.023 L at 0.05 L
    NEAR(sheet_taper(fish, (const double[]){-0.1, 0.02}, along), 0.2 * (1 - exp(-pow(0.10198 / 0.2, 4))), 1e-6, 0);
    NEAR(sheet_taper(fish, (const double[]){0, 0}, along), 0, 0, 0);
}

TEST(total_circulation_vanishes) {
    struct simulation *const simulation = school_simulation(
        SMALL "wake: {shedding: sheet, lifetime: 0.3}\nfish: [{start: {speed: 1}}, {start: {position: [0.2, 0.6]}}]\n");
    for (int n = 0; n < 30; n++) {
        school_ok(simulate_step(simulation));
        simulate_measure(simulation);
        NEAR(simulation->diagnostics->total_circulation, 0, 1e-12, 0);
    }

    assert_int_equal(simulation->state->wake[0].n_vortex, 16);
}
