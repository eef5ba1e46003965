/* test_impulse.c: Tests the impulse of the vortices, and that what they lose is booked (doc/model.md, section 13). */
#include <stdio.h>

#include "school.h"
#include "state/impulse.h"
#include "state/state.h"

#define TIME "time: {end: 1, shedding_interval: 0.02, output_interval: 0.02}\n"
#define SMALL TIME "defaults: {fish: {nodes: 7}}\n"

TEST(impulses_are_those_of_point_vortices) {
    struct impulse_moments sum = {0};
    impulse_add(&sum, 2, 3, -1);
    impulse_add_stretch(&sum, 4, (const double[]){1, 2}, (const double[]){3, 6});
    NEAR(sum.circulation, 6, 0, 0);
    NEAR(sum.x, 6 + 8, 0, 0);
    NEAR(sum.y, -2 + 16, 0, 0);
    NEAR(sum.square, 20 + 2 * 5 + 2 * 45, 0, 0);
    NEAR(sum.product, -6 + 2 * 2 + 2 * 18, 0, 0);
    // - rho w E3 x G, - rho w |x|^2 G/2
    double impulse[3];
    impulse_of(&sum, 10, impulse);
    NEAR(impulse[0], 140, 0, 0);
    NEAR(impulse[1], -140, 0, 0);
    NEAR(impulse[2], -600, 0, 0);
}

TEST(a_depth_that_varies_is_none) {
    struct setup setup = setup_of(
        TIME
        "defaults: {fish: {pressure: {span: infinite}}}\n"
        "fish:\n  - {length: 2, body: {depth: 0.3}}\n"
        "  - {nodes: 5, start: {position: [3, 3]}, body: {profile: table, thickness_table: [0.1, 0.2, 0.15, 0.05],\n"
        "     depth_table: [0.2, 0.3, 0.25, 0.1]}}\n");
    NEAR(impulse_depth(&setup.school->fish[0]), 0.6, 1e-15, 0);
    assert_true(isnan(impulse_depth(&setup.school->fish[1])));
}

// moments of all vortices shed by a fish: present moments plus booked losses
static void all_of(const struct setup *setup, double sum[3]) {
    const struct impulse_moments wake = impulse_of_wake(&setup->state->wake[0], setup->school, setup->state->t, 0);
    const double *const lost = setup->state->momentum[0].lost;
    sum[0] = wake.x + lost[0];
    sum[1] = wake.y + lost[1];
    sum[2] = wake.square + lost[2];
}

// A wake at rest from birth to removal: every event reduces the circulation, or removes a vortex. Returns the final
// loss in x.
static double wither(const char *text) {
    struct setup setup = setup_stirred(text);
    struct wake *const wake = &setup.state->wake[0];
    const double interval = setup.school->interval;
    double before[3], now[3];
    for (int i = 0; i < wake->n_vortex; i++) {
        wake->u[i] = wake->v[i] = wake->u_before[i] = wake->v_before[i] = 0;
        wake->rate[i] = wake->rate_before[i] = 0;
        wake->birth[i] = setup.state->t - (wake->n_vortex - 1 - i) * interval;
    }
    all_of(&setup, before);
    int n_events = 0;
    struct impulse_thinning thinning = {0};
    for (; wake_n_sources(wake) > 0; n_events++) {
        BELOW(n_events, 100);
        impulse_fade(setup.school, setup.state, 0);
        wake_advance(wake, interval);
        setup.state->t += interval;
        impulse_thinning_reserve(test_arena(), &thinning, wake);
        const struct impulse_moments before_thinning = impulse_of_wake(wake, setup.school, setup.state->t, 0);
        const struct impulse_moments lost = impulse_thin_wake(setup.school, setup.state, 0, &thinning);
        const struct impulse_moments after_thinning = impulse_of_wake(wake, setup.school, setup.state->t, 0);
        NEAR(lost.circulation, before_thinning.circulation - after_thinning.circulation, 1e-14, 0);
        NEAR(lost.x, before_thinning.x - after_thinning.x, 1e-13, 0);
        NEAR(lost.y, before_thinning.y - after_thinning.y, 1e-13, 0);
        NEAR(lost.square, before_thinning.square - after_thinning.square, 1e-12, 0);
        impulse_book_thinned(setup.school, setup.state, 0, &lost);
        all_of(&setup, now);
        if (setup.school->removed == REMOVED_RETAINED) NEAR_ARRAY(3, now, before, 1e-14, 1e-13);
    }
    ABOVE(n_events, 10);
    const double lost = setup.state->momentum[0].lost[0];
    return lost;
}

TEST(what_fades_or_is_removed_is_booked_where_it_is) {
    static const char *const wakes[] = {"shedding: sheet, decay: 0.2}\nsheet: {curve: smooth",
                                        "shedding: sheet, decay: 0", "shedding: continuous, decay: 0.15",
                                        "shedding: continuous, decay: 0", "shedding: impulsive, decay: 0"};
    for (size_t w = 0; w < sizeof wakes / sizeof *wakes; w++) {
        char text[256];
        snprintf(text, sizeof text, SMALL "wake: {lifetime: 0.3, %s}\nfish: [{force: reactive}]\n", wakes[w]);
        ABOVE(fabs(wither(text)), 1e-3);
    }

    // with finite span labels decay in place of circulations
    ABOVE(fabs(wither(SMALL "wake: {lifetime: 0.3, decay: 0.2}\nfish: [{sheet_points: 26}]\n")), 1e-3);
}

// dropped circulation returns to the body at the tail, of a sheet half-way along its path: the loss contains only the
// displacement to the tail
TEST(what_is_dropped_goes_to_the_tail) {
    static const char *const wakes[] = {"continuous", "sheet"};
    for (int w = 0; w < 2; w++) {
        char text[256];
        snprintf(text, sizeof text,
                 SMALL
                 "wake: {lifetime: 0.3, decay: 0.2, removed_circulation: dropped, shedding: %s}\nfish: [{force: "
                 "reactive, sheet_points: 21}]\n",
                 wakes[w]);
        struct setup setup = setup_stirred(text);
        const struct fish *const fish = &setup.school->fish[0];
        struct wake *const wake = &setup.state->wake[0];
        for (int i = 0; i < wake->n_vortex; i++) {
            wake->u[i] = wake->v[i] = wake->u_before[i] = wake->v_before[i] = 0;
            wake->birth[i] = setup.state->t - 0.2;
        }
        const struct impulse_moments before = impulse_of_wake(wake, setup.school, setup.state->t, 0);
        impulse_fade(setup.school, setup.state, 0);
        setup.state->t += setup.school->interval;
        const struct impulse_moments after = impulse_of_wake(wake, setup.school, setup.state->t, 0);
        const double lost = before.circulation - after.circulation, *const y = setup.state->y;
        const double end[2] = {y[fish->at.x + fish->n_nodes - 1], y[fish->at.y + fish->n_nodes - 1]};
        const double newest[2] = {wake->x[wake->n_vortex - 1], wake->y[wake->n_vortex - 1]};
        ABOVE(fabs(lost), 1e-3);
        if (w == 1) ABOVE(fabs(newest[0] - end[0]) + fabs(newest[1] - end[1]), 1e-3);
        const double tail[2] = {w == 1 ? (newest[0] + end[0]) / 2 : end[0], w == 1 ? (newest[1] + end[1]) / 2 : end[1]};
        const double *const booked = setup.state->momentum[0].lost;
        NEAR(booked[0], before.x - after.x - lost * tail[0], 1e-15, 1e-13);
        NEAR(booked[1], before.y - after.y - lost * tail[1], 1e-15, 1e-13);
    }
}
