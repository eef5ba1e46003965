/* test_state.c: the state before the start, and histories of samples. */
#include "school.h"

#define TIME "time: {end: 1, shedding_interval: 0.02, output_interval: 0.02}\n"

static void state_before_the_start_is_placed_and_empty(void **state) {
    (void)state;
    struct setup setup;
    school_build(&setup, TIME "fish: [{start: {heading: 90}}, {start: {position: [1, 2]}}]\n");
    const struct state *start = setup.state;
    NEAR(start->t, 0, 0, 0);
    assert_int_equal(start->event, 0);
    for (int f = 0; f < 2; f++) {
        const struct fish *fish = &setup.school->fish[f];
        assert_int_equal(start->wake[f].n_vortex, 0);
        NEAR(start->y[fish->at.x], fish->start_position[0], 0, 0);
        NEAR(start->y[fish->at.circulation], 0, 0, 0);
        NEAR(start->control[f].held_heading, fish->start_heading, 0, 0);
        assert_int_equal(start->history[f].n, 0);
        // one beat of 1 s and one more
        assert_int_equal(start->history[f].capacity, 51);
    }
    school_clear(&setup);
}

static void a_fish_without_a_beat_remembers_one_sample(void **state) {
    (void)state;
    struct setup setup;
    school_build(&setup, TIME "fish: [{wave: {frequency: 0}}]\n");
    assert_int_equal(setup.state->history[0].capacity, 1);
    for (int i = 1; i <= 3; i++) {
        const struct sample sample = {.heading = i};
        state_remember(&setup.state->history[0], &sample);
        NEAR(state_recall(&setup.state->history[0], 0)->heading, i, 0, 0);
        assert_int_equal(setup.state->history[0].n, 1);
    }
    school_clear(&setup);
}

static void history_recalls_the_newest_ones_in_order(void **state) {
    (void)state;
    struct sample samples[4];
    struct history history = {.capacity = 4, .last = -1, .sample = samples};
    for (int i = 0; i < 11; i++) {
        const struct sample sample = {.heading = i};
        state_remember(&history, &sample);
        assert_int_equal(history.n, i < 4 ? i + 1 : 4);
        for (int age = 0; age < history.n; age++) NEAR(state_recall(&history, age)->heading, i - age, 0, 0);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(state_before_the_start_is_placed_and_empty),
        cmocka_unit_test(a_fish_without_a_beat_remembers_one_sample),
        cmocka_unit_test(history_recalls_the_newest_ones_in_order),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
