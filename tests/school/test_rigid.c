/* test_rigid.c: rigid_of returns the increments that rigid_change made, which leave the shape and the wake as they are.
 * */
#include <string.h>

#include "school.h"
#include "school/rigid.h"

static const char *const text =
    "time: {end: 1, shedding_interval: 0.02, output_interval: 0.02}\n"
    "defaults: {fish: {nodes: 7}}\nfish: [{}, {start: {position: [2, 1], heading: 70}}]\n";

static void set_up(struct setup *setup) {
    school_build(setup, text);
    school_stir(setup);
}

// lengths of all edges
static void lengths_of(const struct fish *fish, const double *y, double *length) {
    for (int k = 0; k < fish->n_edges; k++) {
        length[k] = hypot(y[fish->at.x + k + 1] - y[fish->at.x + k], y[fish->at.y + k + 1] - y[fish->at.y + k]);
    }
}

TEST(a_rigid_motion_is_read_exactly) {
    struct setup setup;
    set_up(&setup);
    const struct fish *const fish = &setup.school->fish[1];
    double *const y = setup.state->y;
    const struct rigid at = rigid_of(fish, y);
    for (int k = 0; k < fish->n_nodes; k++) {
        y[fish->at.vx + k] = 0.3 - 2 * (y[fish->at.y + k] - at.place[1]);
        y[fish->at.vy + k] = 0.4 + 2 * (y[fish->at.x + k] - at.place[0]);
    }
    const struct rigid rigid = rigid_of(fish, y);
    NEAR(rigid.turn, 2, 1e-13, 0);
    NEAR(rigid.velocity[0], 0.3 * cos(at.heading) + 0.4 * sin(at.heading), 1e-14, 0);
    NEAR(rigid.velocity[1], 0.4 * cos(at.heading) - 0.3 * sin(at.heading), 1e-14, 0);
}

TEST(a_place_is_seen_ahead_and_to_the_left) {
    const struct rigid one = {.place = {1, 2}, .heading = M_PI / 2}, other = {.place = {0.7, 4}, .heading = 3};
    double place[2];
    rigid_relative_place(&one, &other, place);
    NEAR(place[0], 2, 1e-15, 0);
    NEAR(place[1], 0.3, 1e-15, 0);
}

TEST(what_is_added_is_read_and_other_fish_stay) {
    struct setup setup;
    set_up(&setup);
    const struct fish *const other = &setup.school->fish[0], *const fish = &setup.school->fish[1];
    double before[64], after[64], others[512];
    memcpy(others, setup.state->y + other->at.x, (size_t)(other->at.end - other->at.x) * sizeof *others);
    lengths_of(fish, setup.state->y, before);
    const struct rigid old = rigid_of(fish, setup.state->y);
    const struct rigid change = {{0.1, -0.2}, 0.3, {0.5, -0.4}, 0.7};
    rigid_change(setup.school, setup.state, 1, &change);
    const struct rigid now = rigid_of(fish, setup.state->y);
    for (int i = 0; i < 2; i++) {
        NEAR(now.place[i], old.place[i] + change.place[i], 1e-14, 0);
        NEAR(now.velocity[i], old.velocity[i] + change.velocity[i], 1e-14, 0);
    }
    NEAR(remainder(now.heading - old.heading, 2 * M_PI), change.heading, 1e-14, 0);
    NEAR(now.turn, old.turn + change.turn, 1e-13, 0);
    lengths_of(fish, setup.state->y, after);
    NEAR_ARRAY(fish->n_edges, after, before, 1e-14, 0);
    assert_memory_equal(setup.state->y + other->at.x, others, (size_t)(other->at.end - other->at.x) * sizeof *others);
}

TEST(a_vortex_lies_where_the_faster_tail_would_have_left_it) {
    struct setup setup;
    set_up(&setup);
    const struct wake *const wake = &setup.state->wake[1];
    const struct rigid old = rigid_of(&setup.school->fish[1], setup.state->y);
    const double x = wake->x[0], y = wake->y[0], age = setup.state->t - wake->birth[0];
    const unsigned long version = wake->version;
    ABOVE(age, 0);
    rigid_change(setup.school, setup.state, 1, &(struct rigid){.velocity = {0.5, 0}});
    NEAR(wake->x[0], x - age * 0.5 * cos(old.heading), 1e-14, 0);
    NEAR(wake->y[0], y - age * 0.5 * sin(old.heading), 1e-14, 0);
    assert_true(wake->version != version);
}

TEST(a_vortex_lies_where_the_tail_of_a_turning_fish_would_have_left_it) {
    struct setup setup;
    set_up(&setup);
    const struct wake *const wake = &setup.state->wake[1];
    const struct rigid old = rigid_of(&setup.school->fish[1], setup.state->y);
    for (int i = 0; i < wake->n_vortex; i++) setup.state->wake[1].birth[i] = setup.state->t - 0.1 * (1 + i);
    const double x = wake->x[1] - old.place[0], y = wake->y[1] - old.place[1], angle = -0.2 * 0.7;
    rigid_change(setup.school, setup.state, 1, &(struct rigid){.turn = 0.7});
    NEAR(wake->x[1], old.place[0] + cos(angle) * x - sin(angle) * y, 1e-14, 0);
    NEAR(wake->y[1], old.place[1] + sin(angle) * x + cos(angle) * y, 1e-14, 0);
}

// places turn about the centre of mass and are displaced, all other vectors turn
TEST(every_vector_of_the_past_turns_with_the_fish) {
    struct simulation *const simulation = school_simulation(
        "time: {end: 3, shedding_interval: 0.05}\nfluid: {velocity: [0.4, -0.2], shear: 0.3}\n"
        "fish: [{force: reactive, nodes: 5, sheet_points: 17, start: {speed: 0.5}}]\n");
    school_run(simulation, 0.5);
    const struct history *const history = &simulation->state->history[0];
    struct sample before[16];
    const int n = history->n;
    assert_in_range(n, 5, 16);
    for (int age = 1; age < n; age++) before[age] = *state_recall(history, age);
    const struct wake *const wake = simulation->state->wake;
    double *const markers[][2] = {{wake->u, wake->v}, {wake->u_before, wake->v_before}}, velocity[2][2][16];
    assert_in_range(wake->n_vortex, 5, 16);
    for (int i = 0; i < 4; i++)
        memcpy(velocity[i / 2][i % 2], markers[i / 2][i % 2], (size_t)wake->n_vortex * sizeof(double));
    const struct rigid old = rigid_of(simulation->school->fish, simulation->state->y);
    const double c = cos(0.7), s = sin(0.7), way[] = {3, 1};
    rigid_change(simulation->school, simulation->state, 0, &(struct rigid){.place = {3, 1}, .heading = 0.7});
    for (int i = 0; i < 2 * wake->n_vortex; i++) {
        const int k = i % 2, at = i / 2;
        NEAR(markers[k][0][at], c * velocity[k][0][at] - s * velocity[k][1][at], 1e-14, 1e-13);
        NEAR(markers[k][1][at], s * velocity[k][0][at] + c * velocity[k][1][at], 1e-14, 1e-13);
    }
    for (int age = 1; age < n; age++) {
        const struct sample *const was = &before[age], *const is = state_recall(history, age);
        const double *const places[][2] = {{was->com, is->com}, {was->tail, is->tail}},
                            *const vectors[][2] = {{was->velocity, is->velocity},
                                                   {was->friction, is->friction},
                                                   {was->force, is->force},
                                                   {was->stream, is->stream},
                                                   {was->drifted, is->drifted}};
        for (size_t i = 0; i < 2; i++) {
            const double x = places[i][0][0] - old.place[0], y = places[i][0][1] - old.place[1];
            NEAR(places[i][1][0], old.place[0] + c * x - s * y + way[0], 1e-13, 0);
            NEAR(places[i][1][1], old.place[1] + s * x + c * y + way[1], 1e-13, 0);
        }
        for (size_t i = 0; i < 5; i++) {
            const double *const v = vectors[i][0];
            if (age + 1 < n) ABOVE(hypot(v[0], v[1]), 0);
            NEAR(vectors[i][1][0], c * v[0] - s * v[1], 1e-13, 1e-13);
            NEAR(vectors[i][1][1], s * v[0] + c * v[1], 1e-13, 1e-13);
        }
        NEAR(is->heading, was->heading + 0.7, 1e-14, 0);
    }
}

TEST(means_over_the_last_period_do_not_notice_a_displacement) {
    struct simulation *const simulation = school_simulation(text);
    school_measure(simulation, 0.5);
    const double speed = simulation->diagnostics->fish[1].speed, heading = simulation->diagnostics->fish[1].heading;
    rigid_change(simulation->school, simulation->state, 1, &(struct rigid){.place = {3, 1}, .heading = 0.2});
    simulate_measure(simulation);
    NEAR(simulation->diagnostics->fish[1].speed, speed, 1e-13, 0);
    NEAR(simulation->diagnostics->fish[1].heading, heading + 0.2 * 180 / M_PI, 1e-11, 0);
}

TEST(means_over_the_last_period_do_not_notice_a_turn_in_a_stream) {
    struct simulation *const simulation = school_simulation(
        "time: {end: 3, shedding_interval: 0.02, output_interval: 0.02}\nfluid: {velocity: [0.4, -0.2]}\n"
        "fish: [{start: {speed: 0.5}}]\n");
    school_measure(simulation, 1.5);
    const struct diagnostics_fish before = *simulation->diagnostics->fish;
    rigid_change(simulation->school, simulation->state, 0, &(struct rigid){.place = {3, 1}, .heading = 0.7});
    simulate_measure(simulation);
    const struct diagnostics_fish *const now = simulation->diagnostics->fish;
    // the path over ground is 0.3 to 0.5 of the path through the water: an old stream would change all values
    const double rounding = 1e-12;
    NEAR(now->speed, before.speed, 0, rounding);
    NEAR(now->ground_speed, before.ground_speed, 0, rounding);
    NEAR(now->mean_thrust, before.mean_thrust, 0, rounding);
    NEAR(now->mean_power, before.mean_power, 0, rounding);
    NEAR(now->efficiency, before.efficiency, 0, rounding);
    NEAR(now->strouhal, before.strouhal, 0, rounding);
    // the path through the water turns, the desired heading does not
    NEAR(now->heading_error, before.heading_error + 0.7 * 180 / M_PI, 1e-10, 0);
}

TEST(the_drift_of_a_stream_goes_on_with_the_stream_that_is_there) {
    struct simulation *const simulation = school_simulation(
        "time: {end: 1, shedding_interval: 0.02, output_interval: 0.02}\nfluid: {velocity: [0.4, 0], shear: 0.5}\n"
        "fish: [{nodes: 7}]\n");
    school_run(simulation, 0.2);
    rigid_change(simulation->school, simulation->state, 0, &(struct rigid){.place = {0, 2}, .heading = 1});
    const struct sample *const newest = state_recall(&simulation->state->history[0], 0);
    NEAR(newest->stream[0], 0.4 + 0.5 * newest->com[1], 1e-14, 0);
    NEAR(newest->stream[1], 0, 1e-14, 0);
}

TEST(the_tail_of_a_fish_that_turns_faster_goes_faster) {
    struct setup setup;
    set_up(&setup);
    const struct fish *const fish = &setup.school->fish[1];
    struct wake *const wake = &setup.state->wake[1];
    const double *const y = setup.state->y;
    const int at[2] = {fish->at.vx + fish->n_nodes - 1, fish->at.vy + fish->n_nodes - 1};
    double fluid[2];
    for (int i = 0; i < 2; i++) {
        wake->tail_velocity[i] = y[at[i]];
        fluid[i] = wake->slip[i] + y[at[i]];
    }
    // without rotation of the body, the tail velocity of the wake must equal the velocity of the tail node
    rigid_change(setup.school, setup.state, 1, &(struct rigid){.velocity = {0.2, 0.1}, .turn = 3});
    for (int i = 0; i < 2; i++) {
        NEAR(wake->tail_velocity[i], y[at[i]], 1e-14, 0);
        NEAR(wake->slip[i], fluid[i] - y[at[i]], 1e-14, 0);
    }
}

TEST(all_vectors_of_fish_and_wake_turn_together) {
    struct setup setup;
    set_up(&setup);
    struct history *const history = &setup.state->history[1];
    struct wake *const wake = &setup.state->wake[1];
    state_reserve(setup.state, setup.school);
    state_remember(history,
                   &(struct sample){.velocity = {1, 2}, .friction = {3, 4}, .force = {5, 6}, .drifted = {7, 8}});
    state_reserve(setup.state, setup.school);
    state_remember(history, &(struct sample){.heading = 1});
    wake_set_tail(wake, (const double[]){9, 10}, (const double[]){0.6, 0.8});
    wake->slip[0] = 11;
    wake->slip[1] = 12;
    // a quarter turn to the left makes (a, b) into (-b, a)
    rigid_change(setup.school, setup.state, 1, &(struct rigid){.heading = M_PI / 2});
    const struct sample *const sample = state_recall(history, 1);
    NEAR_ARRAY(2, sample->velocity, ((double[]){-2, 1}), 1e-14, 0);
    NEAR_ARRAY(2, sample->friction, ((double[]){-4, 3}), 1e-14, 0);
    NEAR_ARRAY(2, sample->force, ((double[]){-6, 5}), 1e-14, 0);
    NEAR_ARRAY(2, sample->drifted, ((double[]){-8, 7}), 1e-14, 0);
    NEAR_ARRAY(2, wake->tail_velocity, ((double[]){-10, 9}), 1e-14, 0);
    NEAR_ARRAY(2, wake->tail_tangent, ((double[]){-0.8, 0.6}), 1e-14, 0);
    NEAR_ARRAY(2, wake->slip, ((double[]){-12, 11}), 1e-14, 0);
    NEAR(state_recall(history, 0)->heading, 1 + M_PI / 2, 1e-15, 0);
}
