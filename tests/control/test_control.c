/* test_control.c: Tests the heading of a fish and every control law (doc/model.md, section 11). */
#include "base/mathematics.h"
#include "control/control.h"
#include "fish/fish_gait.h"
#include "fish/fish_motion.h"
#include "near.h"
#include "school.h"

#define TIME "time: {end: 1, shedding_interval: 0.02, output_interval: 0.02}\n"
#define SMALL TIME "defaults: {fish: {nodes: 7}}\n"

static const double pi = 3.14159265358979323846;

TEST(heading_points_from_a_third_of_the_length_to_the_nose) {
    struct setup setup = setup_of(SMALL "fish: [{start: {heading: 130}}]\n");
    const struct fish *fish = setup.school->fish;
    NEAR(control_heading(fish, setup.state->y), 130 * pi / 180, 1e-14, 0);
    // node 2 of 7 stands at a third
    setup.state->y[fish->at.x + 2] = setup.state->y[fish->at.x];
    setup.state->y[fish->at.y + 2] = setup.state->y[fish->at.y] + 0.3;
    NEAR(control_heading(fish, setup.state->y), -pi / 2, 1e-14, 0);
}

TEST(headings_in_time_are_linear_between_their_times) {
    struct setup setup =
        setup_of(SMALL "fish: [{control: {law: heading, desired_heading: [[1, 180], [2, 120], [4, 160]]}}]\n");
    const struct fish *fish = setup.school->fish;
    const double times[] = {0, 1, 1.5, 2, 3.5, 4, 9}, want[] = {180, 180, 150, 120, 150, 160, 160};
    for (int i = 0; i < 7; i++) {
        NEAR(control_desired_heading(fish, &setup.state->control[0], times[i], setup.state->y), want[i] * pi / 180,
             1e-14, 0);
    }
}

TEST(law_turns_towards_the_desired_heading_the_short_way) {
    struct setup setup =
        setup_of(SMALL "fish: [{control: {law: heading, desired_heading: 170, gain: 3, limit: 0.4}}]\n");
    const struct fish *fish = setup.school->fish;
    const struct control_memory *memory = &setup.state->control[0];
    // heading -175 = 185 degrees: 15 degrees too far left, so the bias is positive and turns right
    NEAR(control_law(fish, memory, 0, -175 * pi / 180, 0, setup.state->y), 0.4 * tanh(3 * 15 * pi / 180), 1e-14, 0);
    NEAR(control_law(fish, memory, 0, 170 * pi / 180, 0.2, setup.state->y), 0.4 * tanh(0.2), 1e-14, 0);
    AT_MOST(fabs(control_law(fish, memory, 0, 0, 1e3, setup.state->y)), 0.4);
}

TEST(without_a_law_the_bias_is_the_given_one) {
    struct setup setup = setup_of(SMALL "fish: [{control: {bias: 0.25}}]\n");
    const struct fish *fish = setup.school->fish;
    setup.state->y[fish->at.phi0] = 0.3;
    control_residual(fish, &setup.state->control[0], 1, 0.01, setup.state->y, setup.value);
    NEAR(setup.value[fish->at.phi0], 0.05, 1e-16, 0);
}

TEST(waypoints_are_visited_in_order_and_the_last_course_is_held) {
    struct setup setup =
        setup_of(SMALL "fish: [{control: {law: heading, waypoints: [[-2, 0], [-2, 3]], acceptance_radius: 0.4}}]\n");
    const struct fish *fish = setup.school->fish;
    struct control_memory *memory = &setup.state->control[0];
    double *const y = setup.state->y;
    NEAR(fabs(control_desired_heading(fish, memory, 0, y)), pi, 1e-14, 0);
    assert_int_equal(control_event(fish, memory, &(struct control_view){.t = 0.1, .interval = 0.02}, y), 0);
    // 0.41 away: not yet; 0.39: on to the next, which jumps
    y[fish->at.x] = -1.59;
    assert_int_equal(control_event(fish, memory, &(struct control_view){.t = 0.2, .interval = 0.02}, y), 0);
    assert_int_equal(memory->waypoint, 0);
    y[fish->at.x] = -1.61;
    assert_int_equal(control_event(fish, memory, &(struct control_view){.t = 0.3, .interval = 0.02}, y), 1);
    assert_int_equal(memory->waypoint, 1);
    NEAR(control_desired_heading(fish, memory, 0, y), atan2(3, -0.39), 1e-14, 0);
    y[fish->at.y] = 2.95;
    assert_int_equal(control_event(fish, memory, &(struct control_view){.t = 0.4, .interval = 0.02}, y), 1);
    assert_int_equal(memory->waypoint, 2);
    // from the first waypoint to the second, independent of the present position of the fish
    y[fish->at.x] = 7;
    NEAR(control_desired_heading(fish, memory, 0, y), pi / 2, 1e-14, 0);
    assert_int_equal(control_event(fish, memory, &(struct control_view){.t = 0.5, .interval = 0.02}, y), 0);
}

TEST(the_course_that_is_held_is_that_of_the_last_leg) {
    // from waypoint to waypoint, and from the start for a single waypoint
    const struct {
        const char *text;
        int waypoint; /* the last */
        double x, y, course;
    } examples[] = {
        {SMALL "fish: [{control: {law: heading, waypoints: [[-2, 1], [-3, 4]]}}]\n", 1, -3, 4, atan2(3, -1)},
        {SMALL "fish: [{start: {position: [1, 2]}, control: {law: heading, waypoints: [[-1, 5]]}}]\n", 0, -1, 5,
         atan2(3, -2)}};
    for (int i = 0; i < 2; i++) {
        struct setup setup = setup_of(examples[i].text);
        const struct fish *fish = setup.school->fish;
        struct control_memory *memory = &setup.state->control[0];
        memory->waypoint = examples[i].waypoint;
        setup.state->y[fish->at.x] = examples[i].x;
        setup.state->y[fish->at.y] = examples[i].y;
        control_event(fish, memory, &(struct control_view){.t = 0.1, .interval = 0.02}, setup.state->y);
        assert_int_equal(memory->waypoint, examples[i].waypoint + 1);
        NEAR(memory->held_heading, examples[i].course, 1e-14, 0);
    }
}

TEST(waypoints_close_together_are_passed_at_one_event) {
    struct setup setup =
        setup_of(SMALL "fish: [{control: {law: heading, waypoints: [[-0.1, 0], [-0.2, 0], [-3, 0]]}}]\n");
    const struct control_view view = {.t = 0.1, .interval = 0.02};
    assert_int_equal(control_event(setup.school->fish, &setup.state->control[0], &view, setup.state->y), 1);
    assert_int_equal(setup.state->control[0].waypoint, 2);
}

TEST(averaged_heading_moves_the_bias_with_bounded_rate) {
    struct setup setup =
        setup_of(SMALL "fish: [{control: {law: averaged_heading, desired_heading: 90, rate: 2, limit: 0.5}}]\n");
    const struct fish *fish = setup.school->fish;
    struct control_memory *memory = &setup.state->control[0];
    const double interval = 0.02, heading = pi, target = 0.5 * tanh(2 * pi / 2);
    double before = 0;
    int n_bounded = 0;
    for (int n = 0; n < 30; n++) {
        control_advance(memory, interval);
        const struct control_view view = {.t = n * interval, .interval = interval, .mean_heading = heading};
        control_event(fish, memory, &view, setup.state->y);
        NEAR(memory->phi0, before, 1e-15, 0);
        AT_MOST(fabs(memory->phi0_rate), 2);
        n_bounded += memory->phi0_rate == 2;
        before = memory->phi0 + interval * memory->phi0_rate;
        // between two events the bias is linear in time
        setup.state->y[fish->at.phi0] = memory->phi0 + 0.3 * interval * memory->phi0_rate;
        control_residual(fish, memory, (n + 0.3) * interval, 0.3 * interval, setup.state->y, setup.value);
        NEAR(setup.value[fish->at.phi0], 0, 1e-15, 0);
    }
    // 0.498 at 2 per second: 12 intervals in full and one in part
    assert_int_equal(n_bounded, 12);
    NEAR(memory->phi0, target, 1e-15, 0);
}

// ---- law place

#define PLACE                                                                                  \
    TIME "defaults: {fish: {nodes: 7}}\nfish: [{name: one}, {start: {position: [1.4, 0.3]},\n" \
         "  control: {law: place, of: one, offset: [1.4, 0.3], hold_time: 12, rate: 100}}]\n"

TEST(a_place_is_ahead_and_to_the_left_of_the_leader_and_turns_with_it) {
    // 0.2 behind the place and 0.1 to the right of it, for leaders that point west, as in the case, and north
    const double heading[] = {pi, pi / 2};
    for (int i = 0; i < 2; i++) {
        struct setup setup = setup_of(PLACE);
        const struct fish *const fish = &setup.school->fish[1];
        struct control_memory *const memory = &setup.state->control[1];
        const double c = cos(heading[i] - pi), s = sin(heading[i] - pi), way[] = {-1.4 - 0.2, -0.3 - 0.1};
        struct control_view view = {.t = 2, .interval = 0.02, .leader_heading = heading[i], .speed = 0.8};
        view.away[0] = c * way[0] - s * way[1];
        view.away[1] = s * way[0] + c * way[1];
        view.away_change[0] = 0.01 * cos(heading[i]);
        view.away_change[1] = 0.01 * sin(heading[i]);

        // nothing before a period has passed
        control_event(fish, memory, &view, setup.state->y);
        NEAR(memory->drive_rate, 0, 0, 0);
        view.has_course = true;
        view.course = heading[i];
        control_event(fish, memory, &view, setup.state->y);
        NEAR(0.02 * memory->drive_rate, 0.5 * tanh((4 * 0.2 + 6 * 0.01) / 0.5), 1e-13, 0);
        // west: right is north, +y, so the place lies to the left, at -y
        const double desired = heading[i] + atan(0.1 / 3);
        NEAR(control_desired_heading(fish, memory, 2, setup.state->y), desired, 1e-13, 0);
        const double weight = 0.8 * 0.8 / (0.8 * 0.8 + 0.1 * 0.1);
        NEAR(0.02 * memory->phi0_rate, 0.5 * tanh(weight * 2 * (heading[i] - desired)), 1e-13, 0);
    }
}

TEST(the_amplitude_of_a_place_is_linear_between_events_with_the_rate_of_the_gait) {
    struct setup setup = setup_of(PLACE);
    const struct fish *const fish = &setup.school->fish[1];
    struct control_memory *const memory = &setup.state->control[1];
    memory->drive = 0.2;
    memory->drive_rate = -0.5;
    control_set(fish, memory, CONTROL_SET_AMPLITUDE, 0.1, 0.5 * fish->amplitude);
    const double h = 1e-6, t = 0.3;
    const struct fish_gait gait = control_gait(fish, memory, t, 0.01);
    const double left = control_gait(fish, memory, t - h, 0.01 - h).amplitude;
    const double right = control_gait(fish, memory, t + h, 0.01 + h).amplitude;
    NEAR(gait.amplitude_rate, (right - left) / (2 * h), 1e-8, 0);
    control_advance(memory, 0.02);
    NEAR(memory->drive, 0.19, 1e-15, 0);
    // once the ramps have ended
    NEAR(control_gait(fish, memory, 5, 0).amplitude, 0.5 * 1.19, 1e-14, 0);
}

/* A fish whose speed, lengths per period, answers to its amplitude, and whose course to the desired one, with lags of
 * first order: doc/model.md, section 11. place: behind and across, lengths. */
struct lags {
    double gain, speed_time, course_time; /* K, T_u, T_c */
    double place[2], speed, course;
};

// n periods under the law of the case, in explicit Euler steps from event to event
static void follow_law(struct setup *setup, struct lags *lags, int n_periods) {
    const struct fish *const fish = &setup->school->fish[1];
    struct control_memory *const memory = &setup->state->control[1];
    const double step = 0.02;
    for (int n = 0; n < 50 * n_periods; n++) {
        control_advance(memory, step);
        // ahead is west, to the left is south
        const struct control_view view = {.t = n * step,
                                          .interval = step,
                                          .has_course = true,
                                          .leader_heading = pi,
                                          .away = {-1.4 - lags->place[0], -0.3 - lags->place[1]},
                                          .away_change = {lags->speed, 0}};
        control_event(fish, memory, &view, setup->state->y);
        const double desired = control_desired_heading(fish, memory, n * step, setup->state->y) - pi;
        lags->place[0] -= step * lags->speed;
        lags->place[1] -= step * 0.8 * lags->course;
        lags->speed += step * (lags->gain * memory->drive - lags->speed) / lags->speed_time;
        lags->course += step * (desired - lags->course) / lags->course_time;
    }
}

// the root of a s^3 + b s^2 + c s + d in an interval where it changes sign once
static double root_between(double low, double high, const double of[4]) {
    double s = 0;
    for (int i = 0; i < 60; i++) {
        s = (low + high) / 2;
        const double at_low = ((of[0] * low + of[1]) * low + of[2]) * low + of[3];
        const double here = ((of[0] * s + of[1]) * s + of[2]) * s + of[3];
        *(at_low * here > 0 ? &low : &high) = s;
    }
    return s;
}

TEST(a_place_is_reached_at_the_rate_of_the_slowest_root) {
    struct setup setup = setup_of(PLACE);
    struct lags lags = {.gain = 0.26, .speed_time = 2.8, .course_time = 1.5, .place = {0.01, 0.01}};
    const double K = lags.gain, per_length = 0.8 / 3;
    const double along = root_between(-0.2, -0.05, (const double[]){2.8, 1 + K * 6, K * 4, K * 4 / 12});
    const double across = root_between(-0.2, -0.05, (const double[]){1.5, 1, per_length, per_length / 12});
    // the other roots have decayed to less than a thousandth of the slowest one
    follow_law(&setup, &lags, 60);
    const double before[] = {lags.place[0], lags.place[1]};
    follow_law(&setup, &lags, 20);
    // steps of 0.02 periods change the rate of 0.1 per period by a thousandth
    NEAR(log(lags.place[0] / before[0]) / 20, along, 2e-3 * fabs(along), 0);
    NEAR(log(lags.place[1] / before[1]) / 20, across, 2e-3 * fabs(across), 0);
    AT_MOST(fabs(lags.place[0]) + fabs(lags.place[1]), 1e-6);
}

// a fish that needs another amplitude than its leader keeps its place exactly: the integral supplies it
TEST(a_place_is_held_without_a_standing_error) {
    struct setup setup = setup_of(PLACE);
    struct lags lags = {.gain = 0.26, .speed_time = 2.8, .course_time = 1.5};
    setup.state->control[1].hold[0] = 0.1;
    setup.state->control[1].hold[1] = -0.05;
    follow_law(&setup, &lags, 10);
    ABOVE(fabs(lags.place[0]), 1e-3);
    ABOVE(fabs(lags.place[1]), 1e-3);
    follow_law(&setup, &lags, 200);
    NEAR(lags.place[0], 0, 1e-9, 0);
    NEAR(lags.place[1], 0, 1e-9, 0);
}

// value of a law with feedforward 1 for the filtered moment alone: the fish has the desired heading
static double moment_seen(struct setup *setup, double since) {
    const struct fish *fish = setup->school->fish;
    setup->state->y[fish->at.phi0] = 0;
    control_residual(fish, &setup->state->control[0], 0, since, setup->state->y, setup->value);
    return atanh(-setup->value[fish->at.phi0] / fish->control.limit);
}

TEST(feedforward_acts_through_a_moving_mean) {
    struct setup setup =
        setup_of(SMALL "fish: [{force: reactive, control: {law: heading, feedforward: 1, filter: 0.4}}]\n");
    const struct fish *fish = setup.school->fish;
    struct control_memory *memory = &setup.state->control[0];
    const double interval = 0.02, share = 1 - exp(-interval / 0.4), tau[] = {0.3, -0.2, 0.5};
    double before = 0;  // no moment before t = 0; t = 0 is an event
    for (int n = 0; n < 3; n++) {
        control_advance(memory, interval);
        const struct control_view view = {.t = n * interval, .interval = interval, .moment = tau[n]};
        assert_int_equal(control_event(fish, memory, &view, setup.state->y), 0);
        const double after = before + share * (tau[n] - before);
        NEAR(moment_seen(&setup, 0), before, 1e-14, 0);
        NEAR(moment_seen(&setup, 0.3 * interval), before + 0.3 * (after - before), 1e-14, 0);
        NEAR(moment_seen(&setup, interval), after, 1e-14, 0);
        before = after;
    }
    // the default is one period; without time constant the mean is the newest value
    school_build(&setup,
                 SMALL "fish: [{force: reactive, wave: {frequency: 2}, control: {law: heading, feedforward: 1}}]\n");
    NEAR(setup.school->fish[0].control.filter_share, 1 - exp(-0.04), 1e-15, 0);
    school_build(&setup, SMALL "fish: [{force: reactive, control: {law: heading, feedforward: 1, filter: 0}}]\n");
    NEAR(setup.school->fish[0].control.filter_share, 1, 0, 0);
}

TEST(averaged_heading_takes_the_newest_mean_of_the_moment) {
    struct setup setup = setup_of(
        SMALL
        "fish: [{force: reactive, control: {law: averaged_heading, rate: 1.0e+9, feedforward: 0.7, filter: 0.4}}]\n");
    const struct fish *fish = setup.school->fish;
    struct control_memory *memory = &setup.state->control[0];
    const struct control_view view = {.interval = 0.02, .moment = 0.3, .mean_heading = pi};
    control_event(fish, memory, &view, setup.state->y);
    const double mean = 0.3 * (1 - exp(-0.05));
    NEAR(memory->phi0_rate, 0.5 * tanh(0.7 * mean) / 0.02, 1e-13, 0);
}

TEST(course_is_damped_and_waits_for_a_whole_period) {
    struct setup setup =
        setup_of(SMALL
                 "fish: [{wave: {frequency: 2}, control: {law: course, desired_heading: 90, gain: 0.7, damping: 1.5,\n"
                 "        rate: 1.0e+9, limit: 0.4, slow: 0, course_filter: 0}}]\n");
    const struct fish *fish = setup.school->fish;
    struct control_memory *memory = &setup.state->control[0];
    struct control_view view = {
        .t = 3, .interval = 0.02, .moment = 5, .mean_heading = 9, .course = 2, .course_rate = -3};
    assert_int_equal(control_event(fish, memory, &view, setup.state->y), 0);
    NEAR(memory->phi0_rate, 0, 0, 0);
    view.has_course = 1;
    view.speed = 1e-3;
    control_event(fish, memory, &view, setup.state->y);
    // the law depends neither on the moment nor on the heading; the period is half a second
    const double target = 0.4 * tanh(0.7 * (2 - pi / 2) + 1.5 * 0.5 * -3);
    NEAR(memory->phi0_rate, target / 0.02, 1e-12, 1e-14);
    control_advance(memory, 0.02);
    NEAR(memory->phi0, target, 1e-15, 0);
    control_residual(fish, memory, 3.03, 0.01, setup.state->y, setup.value);
    NEAR(setup.value[fish->at.phi0], setup.state->y[fish->at.phi0] - target - 0.01 * target / 0.02, 1e-14, 0);
    // at most rate per second
    setup.school->fish[0].control.rate = 2;
    const struct control_view far = {.interval = 0.02, .has_course = 1, .course = 2, .speed = 1};
    control_event(fish, memory, &far, setup.state->y);
    NEAR(memory->phi0_rate, 2, 0, 0);
}

// u_0 = slow L/T, e by a filter with the time constant T_c: first e, then phi0
TEST(course_weighs_slow_motion_and_filters_its_rate) {
    struct setup setup =
        setup_of(SMALL
                 "fish: [{length: 0.8, wave: {frequency: 2},\n"
                 "        control: {law: course, desired_heading: 90, gain: 0.7, damping: 1.5, limit: 0.4, rate: 1e9,\n"
                 "                  slow: 0.25, course_filter: 0.05}}]\n");
    const struct fish *const fish = setup.school->fish;
    struct control_memory *const memory = &setup.state->control[0];
    const double slow = 0.25 * 0.8 * 2, keep = exp(-0.02 / 0.05);
    double e = 0;
    for (int n = 0; n < 4; n++) {
        // no displacement at the third event: the course has no weight
        const double speed = n == 2 ? 0 : 0.3 + 0.2 * n, course = n == 2 ? 0 : 2 + 0.1 * n, rate = n == 2 ? 0 : 1 - n;
        const struct control_view view = {
            .t = 3, .interval = 0.02, .has_course = 1, .course = course, .course_rate = rate, .speed = speed};
        const double r = speed * speed / (speed * speed + slow * slow);
        e += (1 - keep) * (r * rate - e);
        assert_false(control_event(fish, memory, &view, setup.state->y));
        NEAR(memory->course_rate, e, 1e-15, 1e-14);
        control_advance(memory, 0.02);
        NEAR(memory->phi0, 0.4 * tanh(r * 0.7 * (course - pi / 2) + 1.5 * 0.5 * e), 1e-14, 1e-13);
    }

    // in the first period e and phi0 stay
    const double before = memory->phi0;
    assert_false(control_event(fish, memory, &(struct control_view){.interval = 0.02, .speed = 1}, setup.state->y));
    NEAR(memory->course_rate, e, 0, 0);
    NEAR(memory->phi0 + 0.02 * memory->phi0_rate, before, 1e-15, 0);
    school_clear(&setup);
}

TEST(rate_is_that_of_the_bias_of_a_moving_fish) {
    const char *const texts[] = {
        SMALL "fish: [{control: {bias: 0.2}}]\n",
        TIME "fish: [{nodes: 8, force: reactive, control: {law: heading, desired_heading: 150, feedforward: 2}}]\n",
        SMALL "fish: [{control: {law: heading, desired_heading: [[0, 180], [1, 120]]}}]\n",
        SMALL "fish: [{control: {law: heading, waypoints: [[-3, 1], [-4, 5]]}}]\n",
        SMALL "fish: [{control: {law: averaged_heading}}]\n",
    };
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        struct setup setup = setup_stirred(texts[i]);
        const struct fish *fish = setup.school->fish;
        const struct control_memory *memory = &setup.state->control[0];
        const double since = setup.t - setup.state->t, h = 1e-6;
        double *const y = setup.state->y, phi0[2];
        const double rate = control_rate(fish, memory, setup.t, since, y);
        for (int side = 0; side < 2; side++) {
            // every node moves with the velocity of the node
            for (int k = 0; k < 2 * fish->n_nodes; k++)
                y[fish->at.x + k] += (side == 0 ? -h : 2 * h) * y[fish->at.vx + k];
            y[fish->at.phi0] = 0;
            const double step = side == 0 ? -h : h;
            control_residual(fish, memory, setup.t + step, since + step, y, setup.value);
            phi0[side] = -setup.value[fish->at.phi0];
        }
        NEAR(rate, (phi0[1] - phi0[0]) / (2 * h), 1e-8, 1e-8);
    }
}

TEST(the_rate_of_a_table_is_that_of_what_follows) {
    struct setup setup = setup_of(SMALL
                                  "fish: [{start: {heading: 150}, control: {law: heading, "
                                  "desired_heading: [[1, 150], [2, 160], [4, 150]]}}]\n");
    const struct fish *const fish = setup.school->fish;
    const double times[] = {0.9, 1, 1.9, 2, 3.9, 4, 5}, degrees[] = {0, 10, 10, -5, -5, 0, 0};
    for (int i = 0; i < 7; i++) {
        const double *const y = setup.state->y;
        const double error = pi * 150 / 180 - control_desired_heading(fish, &setup.state->control[0], times[i], y);
        const double tangent = tanh(fish->control.gain * error);
        NEAR(control_rate(fish, &setup.state->control[0], times[i], 0, y),
             -fish->control.limit * (1 - tangent * tangent) * fish->control.gain * degrees[i] * pi / 180, 1e-13, 0);
    }
}

TEST(a_law_falls_as_fast_as_it_rises) {
    struct setup setup =
        setup_of(SMALL "fish: [{control: {law: averaged_heading, desired_heading: 90, rate: 2, limit: 0.5}}]\n");
    struct control_memory *const memory = &setup.state->control[0];
    for (int side = -1; side <= 1; side += 2) {
        memory->phi0 = 0;
        const struct control_view view = {.t = 0, .interval = 0.02, .mean_heading = pi / 2 + side};
        control_event(setup.school->fish, memory, &view, setup.state->y);
        NEAR(memory->phi0_rate, 2 * side, 0, 0);
    }
}

static void value_of_control(struct setup *setup, const double *y, const double *yp, double *value) {
    (void)yp;
    control_residual(setup->school->fish, &setup->state->control[0], setup->t, setup->t - setup->state->t, y, value);
}

static void jacobian_of_control(struct setup *setup, double cj, const double *y, struct sparse *jacobian) {
    (void)cj;
    control_jacobian(setup->school->fish, &setup->state->control[0], setup->t, setup->t - setup->state->t, y, jacobian);
}

TEST(derivatives_agree_with_differences) {
    const char *const texts[] = {SMALL "fish: [{control: {bias: 0.2}}]\n",
                                 TIME "fish: [{nodes: 8, control: {law: heading, desired_heading: 150}}]\n",
                                 SMALL "fish: [{control: {law: heading, desired_heading: [[0, 180], [1, 120]]}}]\n",
                                 SMALL "fish: [{control: {law: heading, waypoints: [[-3, 1], [-4, 5]]}}]\n",
                                 SMALL "fish: [{control: {law: averaged_heading, waypoints: [[-3, 1]]}}]\n"};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        struct setup setup = setup_stirred(texts[i]);
        school_compare(&setup, value_of_control, jacobian_of_control, texts[i]);
        // and when the last waypoint has been passed
        setup.state->control[0].waypoint = setup.school->fish[0].control.n_waypoints;
        school_compare(&setup, value_of_control, jacobian_of_control, texts[i]);
    }
}

// ---- values set from outside during a run

TEST(a_value_that_was_never_led_is_zero) {
    const struct lead lead = {.start = 0};
    for (double t = 0; t < 3; t += 0.7) {
        NEAR(lead_value(&lead, t), 0, 0, 0);
        NEAR(lead_rate(&lead, t), 0, 0, 0);
        NEAR(lead_integral(&lead, t), 0, 0, 0);
    }
}

TEST(a_change_from_rest_is_the_ramp) {
    struct lead lead = {.start = 0};
    lead_change(&lead, 0.5, 2, 3);
    for (double t = 0.5; t < 4; t += 0.1) {
        NEAR(lead_value(&lead, t), 3 * ramp_value(t - 0.5, 2), 3e-14, 0);
        NEAR(lead_rate(&lead, t), 3 * ramp_rate(t - 0.5, 2), 1e-12, 0);
    }
    NEAR(lead_value(&lead, 2.5), 3, 0, 0);
}

// value and the first three derivatives by one-sided differences, before (side -1) or after t
static void derivatives(const struct lead *lead, double t, int side, double h, double got[4]) {
    double f[5];
    for (int i = 0; i < 5; i++) f[i] = lead_value(lead, t + side * i * h);
    got[0] = f[0];
    got[1] = side * (-25 * f[0] + 48 * f[1] - 36 * f[2] + 16 * f[3] - 3 * f[4]) / (12 * h);
    got[2] = (35 * f[0] - 104 * f[1] + 114 * f[2] - 56 * f[3] + 11 * f[4]) / (12 * h * h);
    got[3] = side * (-5 * f[0] + 18 * f[1] - 24 * f[2] + 14 * f[3] - 3 * f[4]) / (2 * h * h * h);
}

TEST(a_change_of_a_change_has_three_continuous_derivatives) {
    struct lead before = {.start = 0};
    lead_change(&before, 0, 2, 1);
    struct lead after = before;
    lead_change(&after, 0.7, 0.5, -2);
    double left[4], right[4];
    derivatives(&before, 0.7, -1, 1e-4, left);
    derivatives(&after, 0.7, 1, 1e-4, right);
    // the differences are wrong by h^4, h^3, h^2 times derivatives of up to 1e5 after the change
    const double tolerance[4] = {1e-14, 1e-9, 1e-5, 0.05};
    for (int k = 0; k < 4; k++) NEAR(right[k], left[k], tolerance[k], 0);
    ABOVE(fabs(left[3]), 3);
    NEAR(lead_value(&after, 1.2), -2, 0, 0);
    NEAR(lead_rate(&after, 1.2), 0, 0, 0);
    NEAR(lead_value(&after, 1.2 - 1e-4), -2, 1e-12, 0);
}

TEST(rate_and_integral_belong_to_the_value) {
    struct lead lead = {.start = 0};
    double sum = 0;
    const double h = 1e-3;
    for (int i = 0; i < 3000; i++) {
        const double t = i * h;
        if (i == 200) lead_change(&lead, t, 0.9, 1.3);
        if (i == 700) lead_change(&lead, t, 0.9, -0.4);
        if (i == 900) lead_change(&lead, t, 0.3, 0.8);
        NEAR(lead_integral(&lead, t), sum, 1e-9, 0);
        const double a = lead_value(&lead, t), b = lead_value(&lead, t + h / 2), c = lead_value(&lead, t + h);
        if (i != 200 && i != 700 && i != 900) NEAR(lead_rate(&lead, t + h / 2), (c - a) / h, 1e-4, 0);
        sum += h / 6 * (a + 4 * b + c);
    }
}

TEST(the_same_target_again_changes_nothing) {
    struct lead lead = {.start = 0};
    lead_change(&lead, 0.1, 1, 2);
    const struct lead before = lead;
    lead_change(&lead, 0.4, 1, 2);
    assert_memory_equal(&lead, &before, sizeof lead);
}

TEST(changes_at_every_event_do_not_run_away) {
    struct lead lead = {.start = 0};
    double most = 0;
    unsigned seed = 1;
    for (int i = 0; i < 20000; i++) {
        // targets of -1 and 1 for 1 to 60 events each, 25 events per ramp
        seed = 1664525 * seed + 1013904223;
        if (seed >> 24 < 10) lead_change(&lead, i * 0.02, 0.5, -lead.target + (lead.target == 0));
        most = fmax(most, fabs(lead_value(&lead, i * 0.02)));
    }
    ABOVE(most, 0.99);
    BELOW(most, 1.25);
}

TEST(it_can_begin_with_a_value_and_a_rate) {
    struct lead lead = {.start = 0};
    lead_begin(&lead, 2, 0.5, (const double[]){0.3, -1.5 * 0.5, 0, 0}, 1);
    NEAR(lead_value(&lead, 2), 0.3, 1e-15, 0);
    NEAR(lead_rate(&lead, 2), -1.5, 1e-14, 0);
    NEAR(lead_value(&lead, 2.5), 1, 0, 0);
}

// ---- values set from outside

TEST(values_that_are_set_are_reached_after_the_ramp) {
    struct setup setup =
        setup_of(SMALL "fish: [{wave: {amplitude: 0.8, frequency: 1.5}, control: {bias: 0.2, ramp: 0.5}}]\n");
    const struct fish *const fish = setup.school->fish;
    struct control_memory *const memory = &setup.state->control[0];
    control_set(fish, memory, CONTROL_SET_AMPLITUDE, 3, 0.6);
    control_set(fish, memory, CONTROL_SET_FREQUENCY, 3, 2);
    control_set(fish, memory, CONTROL_SET_BIAS, 3, -0.1);
    const struct fish_gait before = control_gait(fish, memory, 3, 0), half = control_gait(fish, memory, 3.25, 0),
                           after = control_gait(fish, memory, 3.5, 0), later = control_gait(fish, memory, 3.7, 0);
    // parts of wave.amplitude
    NEAR(before.amplitude, 1, 1e-14, 0);
    NEAR(half.amplitude, 0.875, 1e-14, 0);
    NEAR(after.amplitude, 0.75, 1e-14, 0);
    NEAR(before.omega, 3 * pi, 1e-13, 0);
    NEAR(half.omega, 3.5 * pi, 1e-13, 0);
    NEAR(after.omega, 4 * pi, 1e-13, 0);
    // the phase: half of the change of the frequency during the ramp
    NEAR(after.angle - before.angle, 3.5 * pi * 0.5, 1e-12, 0);
    NEAR(later.angle - after.angle, 4 * pi * 0.2, 1e-12, 0);
    setup.state->y[fish->at.phi0] = 0;
    control_residual(fish, memory, 3.25, 0, setup.state->y, setup.value);
    NEAR(setup.value[fish->at.phi0], -0.05, 1e-14, 0);
    control_residual(fish, memory, 3.5, 0, setup.state->y, setup.value);
    NEAR(setup.value[fish->at.phi0], 0.1, 1e-14, 0);
    NEAR(control_largest_bias(fish, memory), 0.1, 1e-15, 0);
}

TEST(a_heave_that_is_set_has_the_accelerations_of_its_motion) {
    struct setup setup =
        setup_of(SMALL
                 "fish: [{wave: {amplitude: 0}, control: {ramp: 0.5}, motion: {prescribed: all, heave: "
                 "0.15, frequency: 1, phase: 30, speed: 0}}]\n");
    const struct fish *const fish = setup.school->fish;
    struct control_memory *const memory = &setup.state->control[0];
    control_set(fish, memory, CONTROL_SET_HEAVE, 3, 0.25);
    double heave[3];
    control_heave(fish, memory, 3.25, heave);
    NEAR(heave[0], 0.2, 1e-14, 0);
    control_heave(fish, memory, 3.5, heave);
    NEAR(heave[0], 0.25, 1e-14, 0);
    NEAR(heave[1], 0, 0, 0);

    // velocity and acceleration are the differences of the position, also within a second ramp that begins in the first
    control_set(fish, memory, CONTROL_SET_HEAVE, 3.2, 0.1);
    const double h = 1e-4;
    for (double t = 3.21; t < 3.8; t += 0.1) {
        double p[3][2], v[3][2], a[3][2];
        for (int i = 0; i < 3; i++) {
            control_heave(fish, memory, t + (i - 1) * h, heave);
            fish_prescribed_node(fish, heave, 0, t + (i - 1) * h, p[i], v[i], a[i]);
        }
        for (int d = 0; d < 2; d++) {
            NEAR(v[1][d], (p[2][d] - p[0][d]) / (2 * h), 1e-6, 0);
            NEAR(a[1][d], (v[2][d] - v[0][d]) / (2 * h), 1e-4, 0);
        }
    }
}

TEST(rates_of_a_gait_that_changes_are_those_of_its_values) {
    // during the ramp of the start, too
    struct setup setup = setup_of(SMALL "fish: [{wave: {amplitude: 0.8, ramp: 6}, control: {ramp: 0.5}}]\n");
    const struct fish *const fish = setup.school->fish;
    struct control_memory *const memory = &setup.state->control[0];
    control_set(fish, memory, CONTROL_SET_AMPLITUDE, 3, 0.4);
    control_set(fish, memory, CONTROL_SET_FREQUENCY, 3, 2);
    const double h = 1e-5;
    const struct fish_gait left = control_gait(fish, memory, 3.2 - h, 0),
                           right = control_gait(fish, memory, 3.2 + h, 0), gait = control_gait(fish, memory, 3.2, 0);
    BELOW(gait.amplitude, 0.7);
    BELOW(gait.amplitude_rate, -0.1);
    NEAR(gait.amplitude_rate, (right.amplitude - left.amplitude) / (2 * h), 1e-7, 0);
    NEAR(gait.omega, (right.angle - left.angle) / (2 * h), 1e-7, 0);
}

TEST(a_heading_that_is_set_is_reached_the_short_way) {
    struct setup setup = setup_of(SMALL
                                  "fish: [{control: {law: heading, ramp: 0.5, limit: 0.3, "
                                  "desired_heading: [[0, 100], [10, 200]]}}]\n");
    const struct fish *const fish = setup.school->fish;
    struct control_memory *const memory = &setup.state->control[0];
    const double *const y = setup.state->y, degree = pi / 180;
    // 120 degrees at 2 s, 10 degrees per second
    control_set(fish, memory, CONTROL_SET_HEADING, 2, -80 * degree);
    NEAR(control_desired_heading(fish, memory, 2, y), 120 * degree, 1e-13, 0);
    NEAR((control_desired_heading(fish, memory, 2 + 1e-6, y) - 120 * degree) / 1e-6, 10 * degree, 1e-4, 0);
    NEAR(control_desired_heading(fish, memory, 2.5, y), 280 * degree, 1e-13, 0);
    // from there to 30 degrees, over 360
    control_set(fish, memory, CONTROL_SET_HEADING, 3, 30 * degree);
    NEAR(control_desired_heading(fish, memory, 3.25, y), 335 * degree, 1e-13, 0);
    NEAR(control_desired_heading(fish, memory, 4, y), 390 * degree, 1e-13, 0);
    NEAR(control_largest_bias(fish, memory), 0.3, 0, 0);
}

TEST(waypoints_that_are_set_begin_where_the_fish_is) {
    struct setup setup =
        setup_of(SMALL "fish: [{control: {law: heading, waypoints: [[-2, 0], [-3, 0]], acceptance_radius: 0.4}}]\n");
    const struct fish *const fish = setup.school->fish;
    struct control_memory *const memory = &setup.state->control[0];
    double *const y = setup.state->y;
    memory->waypoint = 2;
    y[fish->at.x] = 1;
    y[fish->at.y] = -2;
    control_set_waypoints(fish, memory, 1, (const double[]){5, 1}, y);
    assert_int_equal(control_n_waypoints(fish, memory), 1);
    NEAR(control_desired_heading(fish, memory, 0, y), atan2(3, 4), 1e-14, 0);
    y[fish->at.x] = 5.1;
    y[fish->at.y] = 0.7;
    assert_int_equal(control_event(fish, memory, &(struct control_view){.t = 0.1, .interval = 0.02}, y), 1);
    // the course of the leg from the place of the fish at that time
    NEAR(control_desired_heading(fish, memory, 0, y), atan2(3, 4), 1e-14, 0);
}

/* From rest the direction of the path is ill-defined, and its rate closes a loop with the delay Dt: without the weight
 * of slow motion and the filter the work grows from 19 to 55 J. */
TEST(work_of_a_stiff_fish_from_rest_has_a_limit_in_the_interval) {
    double work[2];
    for (int i = 0; i < 2; i++) {
        struct simulation *const simulation = school_simulation_of(
            "time: {end: 6, shedding_interval: %g}\n"
            "fish: [{body: {modulus: 1e8}, control: {law: course}}]\n",
            i == 0 ? 0.02 : 0.01);
        school_measure(simulation, 6);
        work[i] = simulation->diagnostics->fish[0].actuation_work;
    }
    NEAR(work[0], work[1], 0, 0.02);
    BELOW(work[1], 12);
}
