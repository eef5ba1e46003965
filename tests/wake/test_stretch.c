/* test_stretch.c: Tests the form of old stretches, and that dropping markers hardly changes a run (doc/model.md,
 * section 7; doc/numerics.md, section 13). */
#include <stdio.h>

#include "run/simulate.h"
#include "school.h"
#include "state/impulse.h"
#include "state/state.h"
#include "wake/sheet.h"
#include "wake/stretch.h"

#define TIME "time: {end: 4, shedding_interval: 0.02, output_interval: 0.02}\n"
#define FISH(span) "fish: [{nodes: 13, force: pressure, pressure: {span: " span "}}]\n"

// a polynomial of this degree and its slope
static double power(double t, int degree) {
    return 1 + 2 * t - pow(t - 0.3, degree);
}
static double power_slope(double t, int degree) {
    return 2 - degree * pow(t - 0.3, degree - 1);
}

// integral of f dg for f = power(t) and g = power(1 - t), by Simpson's rule in many steps
static double integral(double from, double to, int degree) {
    enum { STEPS = 1000 };
    double sum = 0;
    for (int k = 0; k < STEPS; k++) {
        const double h = (to - from) / STEPS, at[3] = {from + k * h, from + k * h + h / 2, from + k * h + h};
        double product[3];
        for (int m = 0; m < 3; m++) product[m] = power(at[m], degree) * power_slope(1 - at[m], degree);
        sum -= h / 6 * (product[0] + 4 * product[1] + product[2]);  // the rate of power(1 - t)
    }
    return sum;
}

TEST(forms_are_exact_for_polynomials_at_any_spacing) {
    struct setup setup = setup_of(TIME FISH("finite"));
    struct wake *const wake = &setup.state->wake[0];
    const double birth[] = {0, 0.2, 0.3, 0.4, 0.8, 0.9};
    const int want[] = {6, 6, 6, 4, 2};  // next to the newest marker are fewer
    for (int i = 0; i < 6; i++) wake_release(wake, i, 0, 0, birth[i]);
    wake->n_old = 5;
    struct stretch_form form;
    for (int j = 0; j < 5; j++) {
        stretch_set_form(&form, wake, setup.school, j);
        assert_int_equal(form.n, want[j]);
        const int degree = form.n - 1;
        double sum = 0;
        for (int a = 0; a < form.n; a++) {
            double of_column = 0;
            for (int b = 0; b < form.n; b++) {
                sum +=
                    form.part[a][b] * power(birth[form.first + a], degree) * power(1 - birth[form.first + b], degree);
                of_column += form.part[b][a];
            }
            // circulation goes from one end to the other, and no further
            const int i = form.first + a;
            NEAR(of_column, i == j + 1 ? 1 : i == j ? -1 : 0, 1e-13, 0);
        }
        NEAR(sum, integral(birth[j], birth[j + 1], degree), 1e-12, 0);
    }
}

TEST(forms_have_fewer_markers_near_a_jump_of_the_times) {
    struct setup setup = setup_of(TIME FISH("finite"));
    struct wake *const wake = &setup.state->wake[0];
    const double birth[] = {0, 0.1, 0.2, 0.3, 0.3, 0.4, 0.5, 0.6, 1.5, 1.6, 1.7, 1.8};
    const int want[] = {4, 4, 2, 2, 2, 4, 2, 2, 2, 4, 2};  // six only further away
    for (int i = 0; i < 12; i++) wake_release(wake, i, 0, i, birth[i]);
    wake->n_old = 10;
    struct stretch_form form;
    for (int j = 0; j < 11; j++) {
        stretch_set_form(&form, wake, setup.school, j);
        assert_int_equal(form.n, want[j]);
        if (form.n != 2) continue;
        assert_int_equal(form.first, j);
        for (int a = 0; a < 2; a++) NEAR_ARRAY(2, form.part[a], ((double[]){-0.5, 0.5}), 0, 0);
    }
}

/* A wavy wake of n markers behind the tail, all at rest. */
static struct setup wavy(const char *text, int n) {
    struct setup setup = setup_of(text);
    const struct fish *const fish = &setup.school->fish[0];
    struct wake *const wake = &setup.state->wake[0];
    const double *const y = setup.state->y;
    setup.state->event = n - 1;
    setup.state->t = fish_event_time(setup.school, n - 1);
    for (int i = 0; i < n; i++) {
        const double t = fish_event_time(setup.school, i), behind = 0.8 * (setup.state->t - t);
        wake_release(wake, y[fish->at.x + fish->n_nodes - 1] + behind, 0.05 * sin(6.28 * t), 0.1 * cos(6 * t) * t, t);
        wake->rate[i] = setup.school->finite ? 0.1 * sin(t) : 0;
        wake->rate_before[i] = wake->rate[i];
    }
    return setup;
}

// the place of the tail, x
static double wake_origin(const struct setup *setup) {
    const struct fish *const fish = &setup->school->fish[0];
    return setup->state->y[fish->at.x + fish->n_nodes - 1];
}

static double away(const struct wake *wake, int i) {
    const int newest = wake->n_vortex - 1;
    return hypot(wake->x[i] - wake->x[newest], wake->y[i] - wake->y[newest]);
}

TEST(dropped_markers_leave_the_others_and_the_spacing_below_the_smoothing) {
    enum { N = 150 };
    struct setup setup = wavy(TIME "wake: {shedding: sheet, smoothing: 0.1, lifetime: 3}\n" FISH("infinite"), N);
    const struct fish *const fish = &setup.school->fish[0];
    struct wake *const wake = &setup.state->wake[0];
    stretch_find_old(wake, fish, setup.school);
    ABOVE(away(wake, wake->n_old), 0.5 * fish->length);
    BELOW(away(wake, wake->n_old + 1), 0.5 * fish->length);
    const int n_young = N - wake->n_old;
    for (int before = 0; before != wake->n_vortex;) {
        before = wake->n_vortex;
        stretch_drop(wake, fish, setup.school);
    }
    assert_int_equal(wake->n_vortex - wake->n_old, n_young);
    BELOW(wake->n_vortex, 65 * N / 100);
    NEAR(wake->birth[0], 0, 0, 0);
    int n_wide = 0;
    for (int i = 0; i + 1 < wake->n_vortex; i++) {
        // the markers that stay are as they were
        const double t = wake->birth[i], gap = wake->birth[i + 1] - t;
        NEAR(wake->circulation[i], 0.1 * cos(6 * t) * t, 1e-15, 0);
        NEAR(wake->y[i], 0.05 * sin(6.28 * t), 1e-15, 0);

        // dyadic levels up to a twelfth of a beat
        const double level = log2(gap / 0.02);
        NEAR(level, round(level), 1e-9, 0);
        AT_MOST(gap, 1.0001 / 12);
        const double length = hypot(wake->x[i + 1] - wake->x[i], wake->y[i + 1] - wake->y[i]);
        AT_MOST(length, 0.06);
        n_wide += gap > 0.03;
        if (i >= wake->n_old) NEAR(gap, 0.02, 1e-12, 0);
    }
    ABOVE(n_wide, 10);

    // a pass drops no two neighbours: the first pass halves at most
    struct setup once = wavy(TIME "wake: {shedding: sheet, smoothing: 0.1, lifetime: 3}\n" FISH("infinite"), N);
    struct wake *const other = &once.state->wake[0];
    stretch_find_old(other, fish, once.school);
    stretch_drop(other, fish, once.school);
    for (int i = 0; i + 1 < other->n_vortex; i++) AT_MOST(other->birth[i + 1] - other->birth[i], 0.0401);
}

TEST(nothing_is_dropped_where_the_wake_is_sharp_slender_or_fades_fast) {
    static const struct {
        const char *text;
        double amplitude;
        int drops;
    } cases[] = {
        {TIME "wake: {shedding: sheet, lifetime: 3}\n" FISH("finite"), 0, 1},
        {TIME "wake: {shedding: sheet, lifetime: 3}\n" FISH("finite"), 0.006, 0},
        {TIME "wake: {shedding: sheet, lifetime: 3, decay: 0.3}\n" FISH("finite"), 0, 0},
        {TIME "wake: {shedding: sheet, lifetime: 3}\nfish: [{nodes: 13, force: pressure, sheet_points: 101, body: "
              "{depth: 0.05}, "
              "pressure: {span: finite}}]\n",
         0, 0},
    };
    for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
        struct setup setup = wavy(cases[c].text, 100);
        struct wake *const wake = &setup.state->wake[0];
        // a zigzag with angles of 40 degrees
        for (int i = 0; i < 100; i++) wake->y[i] = cases[c].amplitude * (i % 2);
        stretch_find_old(wake, &setup.school->fish[0], setup.school);
        stretch_drop(wake, &setup.school->fish[0], setup.school);
        assert_int_equal(wake->n_vortex < 100, cases[c].drops);
    }
}

TEST(markers_return_to_stretches_that_grow) {
    enum { N = 150 };
    struct setup setup = wavy(TIME "wake: {shedding: sheet, smoothing: 0.1, lifetime: 3}\n" FISH("finite"), N);
    const struct fish *const fish = &setup.school->fish[0];
    struct wake *const wake = &setup.state->wake[0];
    stretch_find_old(wake, fish, setup.school);
    const int n_young = N - wake->n_old;
    for (int before = 0; before != wake->n_vortex;) {
        before = wake->n_vortex;
        stretch_drop(wake, fish, setup.school);
    }
    const int n_dropped = N - wake->n_vortex;
    ABOVE(n_dropped, 40);

    // what has not grown stays as it is
    stretch_restore(wake, fish, setup.school, setup.state->y);
    assert_int_equal(wake->n_vortex, N - n_dropped);

    // the sheet becomes ten times as long: one pass divides a stretch at most once, the last leaves the first wake
    const double origin = wake->x[0], shift = 100;
    for (int i = 0; i < wake->n_vortex; i++) {
        wake->x[i] = shift + 10 * (wake->x[i] - origin);
        wake->u[i] = sin(wake->birth[i]);
        wake->v_before[i] = cos(wake->birth[i]);
    }
    int n_passes = 0;
    for (int before = 0; before != wake->n_vortex; n_passes++) {
        before = wake->n_vortex;
        stretch_restore(wake, fish, setup.school, setup.state->y);
        AT_MOST(wake->n_vortex, 2 * before);
    }
    ABOVE(n_passes, 1);
    assert_int_equal(wake->n_vortex - wake->n_old, n_young);

    // the oldest stretches have no marker before them, and keep theirs
    AT_MOST(wake->n_vortex, N);
    ABOVE(wake->n_vortex, N - 4);
    for (int i = 0; i < wake->n_vortex; i++) {
        const double t = wake->birth[i];
        NEAR(wake->circulation[i], 0.1 * cos(6 * t) * t, 2e-6, 0);
        NEAR(wake->y[i], 0.05 * sin(6.28 * t), 2e-6, 0);
        NEAR(wake->x[i], shift + 10 * (0.8 * (setup.state->t - t) + wake_origin(&setup) - origin), 1e-9, 0);
        NEAR(wake->u[i], sin(t), 1e-7, 0);
        NEAR(wake->v_before[i], cos(t), 1e-7, 0);
        NEAR(wake->rate[i], 0.1 * sin(t), 1e-7, 0);
        NEAR(wake->rate_before[i], 0.1 * sin(t), 1e-7, 0);
        if (i > 4 && i < wake->n_vortex) NEAR(t - wake->birth[i - 1], 0.02, 1e-12, 0);
    }
}

// near a body from 1.1 times the largest length at which a marker is dropped, elsewhere from 1.5 times
TEST(markers_return_sooner_near_a_body) {
    enum { N = 150 };
    for (int is_far = 0; is_far < 2; is_far++) {
        struct setup setup = wavy(TIME "wake: {shedding: sheet, smoothing: 0.1, lifetime: 3}\n" FISH("infinite"), N);
        const struct fish *const fish = &setup.school->fish[0];
        struct wake *const wake = &setup.state->wake[0];
        stretch_find_old(wake, fish, setup.school);
        for (int i = 0; i < 3; i++) stretch_drop(wake, fish, setup.school);
        const int n_before = wake->n_vortex;

        // the old part, which begins half a length behind the tail, begins there again
        const double tail = wake_origin(&setup), shift = is_far ? 100 : -0.6;
        for (int i = 0; i < n_before; i++) wake->x[i] = tail + shift + 2.2 * (wake->x[i] - tail);
        for (int i = 0; i < 3; i++) stretch_restore(wake, fish, setup.school, setup.state->y);
        if (is_far) {
            assert_int_equal(wake->n_vortex, n_before);
            continue;
        }

        // the body is as long as 1 and ends at the tail; the two oldest stretches keep their markers
        ABOVE(wake->n_vortex, n_before);
        int n_long = 0;
        for (int j = 2; j < wake->n_old; j++) {
            const double length = hypot(wake->x[j + 1] - wake->x[j], wake->y[j + 1] - wake->y[j]);
            BELOW(length, 1.5 * 0.06);
            if (length < 1.1 * 0.06) continue;
            ABOVE((wake->x[j] + wake->x[j + 1]) / 2, tail + 0.95);
            n_long++;
        }
        ABOVE(n_long, 10);
    }
}

// what thinning loses is summed over the sources that change, and equals the change of the whole wake
TEST(what_thinning_loses_is_the_change_of_the_wake) {
    enum { N = 160, EVENTS = 60 };
    static const char *const fish_of[] = {FISH("infinite"), FISH("finite")};
    for (int span = 0; span < 2; span++) {
        char text[512];
        snprintf(text, sizeof text, TIME "wake: {shedding: sheet, smoothing: 0.1, lifetime: 3, decay: 1}\n%s",
                 fish_of[span]);
        struct setup setup = wavy(text, N);
        const struct school *const school = setup.school;
        struct wake *const wake = &setup.state->wake[0];
        struct impulse_thinning thinning = {0};
        int n_dropped = 0, n_restored = 0;
        double largest = 0;
        for (int event = 0; event < EVENTS; event++) {
            // every event stretches the sheet a little, from its tail
            const double tail = wake->x[wake->n_vortex - 1];
            for (int i = 0; i < wake->n_vortex; i++) wake->x[i] = tail + 1.02 * (wake->x[i] - tail);
            setup.state->t += school->interval;
            wake_release(wake, tail - 0.016, 0.05 * sin(6.28 * setup.state->t), 0.1 * cos(6 * setup.state->t),
                         setup.state->t);
            wake_reserve(wake, wake->n_vortex + wake->n_old);
            impulse_thinning_reserve(test_arena(), &thinning, wake);
            const struct impulse_moments before = impulse_of_wake(wake, school, setup.state->t, 0);
            const int n_before = wake->n_vortex;
            const struct impulse_moments lost = impulse_thin_wake(school, setup.state, 0, &thinning);
            const struct impulse_moments after = impulse_of_wake(wake, school, setup.state->t, 0);
            NEAR(lost.circulation, before.circulation - after.circulation, 1e-14, 0);
            NEAR(lost.x, before.x - after.x, 1e-12, 0);
            NEAR(lost.y, before.y - after.y, 1e-13, 0);
            NEAR(lost.square, before.square - after.square, 1e-10, 0);
            largest = fmax(largest, fabs(lost.x));
            n_dropped += wake->n_vortex < n_before;
            n_restored += wake->n_vortex > n_before;
        }
        ABOVE(largest, 1e-9);
        ABOVE(n_dropped, 5);
        ABOVE(n_restored, 2);
    }
}

TEST(vortices_from_outside_stay) {
    struct setup setup = wavy(TIME "wake: {shedding: sheet, lifetime: 3, spare_vortices: 3}\n" FISH("infinite"), 100);
    struct wake *const wake = &setup.state->wake[0];
    const struct fish *const fish = &setup.school->fish[0];
    school_ok(wake_add_vortex(wake, setup.school, setup.state->t, 9, 1, 0.3));
    for (int i = 0; i < 60; i++) {
        wake_release(wake, wake->x[wake->n_vortex - 1] - 0.016, 0, 0, wake->birth[wake->n_vortex - 1] + 0.02);
        stretch_find_old(wake, fish, setup.school);
        stretch_drop(wake, fish, setup.school);
        stretch_restore(wake, fish, setup.school, setup.state->y);
    }
    ABOVE(wake->n_old, 30);
    int found = 0;
    for (int j = 0; j < wake->n_old; j++) {
        found +=
            fabs(wake_source(wake, j) - 0.3) < 1e-12 && !(fabs(wake->x[j] - 9) > 0) && !(fabs(wake->x[j + 1] - 9) > 0);
    }
    assert_int_equal(found, 1);
}

// doc/model.md, sections 7, 8 and 18: at a time within an interval, for both spans, with decay
TEST(old_stretches_act_from_their_markers_in_every_view) {
    static const char *const fish_of[] = {FISH("infinite"), FISH("finite")};
    for (int k = 0; k < 2; k++) {
        char text[512];
        snprintf(text, sizeof text, TIME "wake: {shedding: sheet, lifetime: 2.2, decay: 1.8}\n%s", fish_of[k]);
        struct setup setup = wavy(text, 100);
        const struct school *const school = setup.school;
        const struct fish *const fish = &school->fish[0];
        struct wake *const wake = &setup.state->wake[0];
        stretch_find_old(wake, fish, school);
        for (int i = 0; i < 3; i++) stretch_drop(wake, fish, school);
        const int n = wake->n_vortex;
        BELOW(n, 70);
        const double t = setup.state->t, tau = 0.3 * school->interval;
        struct sheet sheet = {.n_markers = 0};
        sheet_reserve(setup.arena, &sheet, n);
        sheet_build(&sheet, fish, school, wake, t);
        sheet_place(&sheet, fish, school, wake, t, tau);

        // the forms one by one
        double q[100] = {0}, line[2][100] = {{0}}, sum = 0;
        struct stretch_form form;
        for (int j = 0; j < wake->n_old; j++) {
            stretch_set_form(&form, wake, school, j);
            for (int a = 0; a < form.n; a++) {
                for (int b = 0; b < form.n; b++) {
                    const int i = form.first + b;
                    const double left = k == 1 ? wake_strength_within(school, t - wake->birth[i], 0.3) : 1;
                    q[form.first + a] += form.part[a][b] * left * wake_label(wake, i, school->interval, tau);
                    line[0][form.first + a] += form.part[a][b] * wake->x[i];
                    line[1][form.first + a] += form.part[a][b] * wake->y[i];
                }
            }
        }
        assert_int_equal(sheet.n_markers, wake->n_old + 3);
        for (int i = 0; i < sheet.n_markers; i++) {
            const double age = t - wake->birth[i];
            const double left = k == 0 ? wake_strength_within(school, age - school->interval / 2, 0.3) : 1;
            const double label = wake_strength_within(school, age, 0.3) * wake_label(wake, i, school->interval, tau);
            const struct sources *const views[] = {&sheet.graded.sources, &sheet.middles.sources};
            for (int view = 0; view < 2; view++) {
                NEAR(views[view]->x[i], wake->x[i], 0, 0);
                NEAR(views[view]->q[i], left * q[i], 1e-15, 1e-12);
                if (k == 1) NEAR(views[view]->dx[i], label * line[0][i], 1e-15, 1e-12);
                if (k == 1) NEAR(views[view]->dy[i], label * line[1][i], 1e-15, 1e-12);
            }
            double along[2];
            sheet_line(&sheet, &sheet.graded, i, along);
            NEAR_ARRAY(2, along, ((double[]){line[0][i], line[1][i]}), 1e-14, 0);
        }

        // markers as sources at markers: the same sum of circulations and moments
        struct sources markers = {.arena = setup.arena};
        sheet_place(&sheet, fish, school, wake, t, 0);
        sheet_markers(&markers, &sheet, fish, school, wake, t, 0);
        for (int i = 0; i < sheet.middles.n_released; i++) sum += sheet.middles.sources.q[i];
        const struct impulse_moments moments = impulse_of_wake(wake, school, t, 0);
        double all[3] = {0};
        for (int i = 0; i < n; i++) {
            all[0] += markers.q[i];
            all[1] += markers.q[i] * markers.x[i];
            all[2] += markers.q[i] * (markers.x[i] * markers.x[i] + markers.y[i] * markers.y[i]);
        }
        NEAR(all[0], sum, 1e-14, 0);
        NEAR(all[0], moments.circulation, 1e-14, 0);
        NEAR(all[1], moments.x, 1e-13, 0);
        NEAR(all[2], moments.square, 1e-13, 0);
    }
}

// ---- whole runs, with and without dropping

/* The largest distance of a node after a run from the run without dropping, m; *saved: part of the markers dropped. The
 * error of the energy balance is that of the integration, which dropping leaves alone. */
static double moved_by_dropping(const char *text, double end, double *saved) {
    double x[2][600], energy[2] = {0, 0}, kinetic = 0, most = 0;
    int n_markers[2];
    for (int drops = 0; drops < 2; drops++) {
        struct simulation *const simulation = school_simulation(text);
        struct school *const school = (struct school *)simulation->school;
        if (!drops) school->wake_spacing = 0;
        school_run(simulation, end);
        n_markers[drops] = 0;
        int n = 0;
        for (int f = 0; f < school->n_fish; f++) {
            const struct fish *const fish = &school->fish[f];
            for (int i = fish->at.x; i < fish->at.vx; i++) x[drops][n++] = simulation->state->y[i];
            AT_MOST(n, 600);
            n_markers[drops] += simulation->state->wake[f].n_vortex;
        }
        simulate_measure(simulation);
        kinetic = 0;
        for (int f = 0; f < school->n_fish; f++) {
            energy[drops] += simulation->diagnostics->fish[f].energy_balance;
            kinetic += simulation->diagnostics->fish[f].kinetic_energy;
        }
        for (int i = 0; i < n && drops; i++) most = fmax(most, fabs(x[1][i] - x[0][i]));
    }
    NEAR(energy[1], energy[0], 1e-5 * kinetic, 0);
    *saved = 1 - (double)n_markers[1] / n_markers[0];
    return most;
}

#define RUN "time: {end: 8, shedding_interval: 0.02}\nsolver: {rtol: 1.0e-6}\n"
#define SWIM(span) "defaults: {fish: {nodes: 13, start: {speed: 0.8}, pressure: {span: " span "}}}\n"

TEST(dropping_moves_bodies_by_less_than_other_errors) {
    static const struct {
        const char *name, *fish;
        double end, bound[2];  // finite, infinite span, m
    } cases[] = {
        {"one fish", "fish: [{}]\n", 3, {1e-7, 1e-7}},
        // in an undecayed wake
        {"a follower", "fish: [{}, {start: {position: [2.5, 0.1]}}]\n", 3.5, {2e-5, 2e-5}},
        {"in antiphase", "fish: [{}, {start: {position: [0, 0.4]}, wave: {phase: 180}}]\n", 3, {1e-7, 1e-7}},
        {"a wall", "fluid: {walls: [-0.3]}\nfish: [{}]\n", 3, {1e-7, 2e-7}},
        // meets its own wake, as a follower meets that of its leader
        {"a U-turn", "fish: [{control: {law: heading, desired_heading: 0}}]\n", 7, {1e-6, 5e-6}},
        // two rows 1.4 lengths apart, the second in the wakes of the first
        {"four dense fish",
         "fish: [{}, {start: {position: [0.2, 0.4]}}, {start: {position: [1.4, 0]}}, {start: {position: [1.6, "
         "0.4]}}]\n",
         3,
         {5e-5, 5e-5}},
    };
    for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
        for (int k = 0; k < 2; k++) {
            char text[1024];
            double saved;
            snprintf(text, sizeof text, RUN "%s%s", k == 0 ? SWIM("finite") : SWIM("infinite"), cases[c].fish);
            const double moved = moved_by_dropping(text, cases[c].end, &saved);
            print_message("%s, %s span: moved %.2g m, %.0f %% of the markers dropped\n", cases[c].name,
                          k == 0 ? "finite" : "infinite", moved, 100 * saved);
            BELOW(moved, cases[c].bound[k]);
            ABOVE(saved, 0.2);
        }
    }
}

/* The wakes of a diamond strain each other. Without the markers that return, the balance is 0.13 N s after 6.5 s,
 * whatever the interval. */
TEST(the_momentum_of_wakes_that_strain_each_other_is_balanced) {
    struct simulation *const simulation = school_simulation(
        "time: {end: 8, shedding_interval: 0.02}\nwake: {lifetime: 8}\ndefaults: {fish: {nodes: 13, start: {speed: "
        "0.81}}}\n"
        "fish: [{}, {start: {position: [1.4, -0.5]}}, {start: {position: [1.4, 0.5]}}, {start: {position: [2.8, "
        "0]}}]\n");
    school_run(simulation, 6.5);
    simulate_measure(simulation);
    const double *const balance = simulation->diagnostics->momentum_balance;
    print_message("balance %.2g N s\n", hypot(balance[0], balance[1]));
    BELOW(hypot(balance[0], balance[1]), 0.02);
    BELOW(simulation->state->wake[0].n_vortex, 270);  // of 326
}
