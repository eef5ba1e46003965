/* test_clearance.c: bodies that touch, that pass each other, and that pass through each other between two steps. */
#include <stdlib.h>

#include "model/clearance.h"
#include "school.h"

#define TIME "time: {end: 1, shedding_interval: 0.02, output_interval: 0.02}\n"

// two straight bodies, nose to tail from x = 0 to 1 at y = 0, and the other one where it is told; thickness 0.2 or less
#define PAIR(x, y)                                                                                                  \
    TIME "defaults: {fish: {wave: {amplitude: 0}, body: {profile: uniform, thickness: 0.1}}}\nfish: [{}, {start: {" \
         "position: [" x ", " y "]}}]\n"

struct pair {
    struct setup setup;
    double *between;
};

static struct pair place(const char *text) {
    struct pair pair;
    school_build(&pair.setup, text);
    pair.between = calloc((size_t)pair.setup.school->n_unknowns, sizeof *pair.between);
    assert_non_null(pair.between);
    clearance_start(pair.setup.school, pair.setup.state, pair.between);
    return pair;
}

static void clear(struct pair *pair) {
    free(pair->between);
    school_clear(&pair->setup);
}

// one step that moves fish f by dx, dy and ends at t
static const struct closest *step(struct pair *pair, int f, double dx, double dy, double t) {
    const struct fish *const fish = &pair->setup.school->fish[f];
    for (int k = 0; k < fish->n_nodes; k++) {
        pair->setup.state->y[fish->at.x + k] += dx;
        pair->setup.state->y[fish->at.y + k] += dy;
    }
    clearance_step(pair->setup.school, pair->setup.state, t, pair->setup.state->y, pair->between);
    return pair->setup.state->closest;
}

static void one_fish_is_close_to_none(void **state) {
    (void)state;
    struct pair pair = place(TIME "fish: [{}]\n");
    NEAR(step(&pair, 0, 1, 0, 0.1)->distance, INFINITY, 0, 0);
    clear(&pair);
}

static void closest_approach_is_that_of_all_steps(void **state) {
    (void)state;
    struct pair pair = place(PAIR("0", "0.5"));
    NEAR(pair.setup.state->closest->distance, 0.4, 1e-14, 0);
    NEAR(step(&pair, 1, 0, -0.2, 0.1)->distance, 0.2, 1e-14, 0);
    const struct closest *const closest = step(&pair, 1, 0, 3, 0.2);
    NEAR(closest->distance, 0.2, 1e-14, 0);
    NEAR(closest->t, 0.1, 0, 0);
    assert_int_equal(closest->fish[0], 0);
    assert_int_equal(closest->fish[1], 1);
    clear(&pair);
}

static void bodies_that_cross_between_two_steps_have_touched(void **state) {
    (void)state;
    // head on, at ten lengths a step; at both ends they are lengths apart
    struct pair pair = place(PAIR("5", "0"));
    const struct closest *const closest = step(&pair, 1, -10, 0, 0.5);
    NEAR(closest->distance, 0, 0, 0);
    // the gap is 4 lengths of the way of 10, less two halves of the thickness
    NEAR(closest->t, 0.5 * 3.9 / 10, 1e-3, 0);
    clear(&pair);
    // sideways
    pair = place(PAIR("0.5", "1"));
    NEAR(step(&pair, 1, 0, -2, 0.5)->distance, 0, 0, 0);
    clear(&pair);
}

static void bodies_that_pass_each_other_have_not(void **state) {
    (void)state;
    struct pair pair = place(PAIR("5", "0.15"));
    const struct closest *const closest = step(&pair, 1, -10, 0, 0.5);
    // 0.05 m beside each other when they are level; the advances see it within that distance
    assert_true(closest->distance >= 0.05 - 1e-12 && closest->distance < 0.1);
    clear(&pair);
    // a school that moves as one comes no closer, however far it goes
    pair = place(PAIR("0", "0.5"));
    const struct fish *const other = &pair.setup.school->fish[1];
    for (int k = 0; k < other->n_nodes; k++) pair.setup.state->y[other->at.x + k] += 100;
    NEAR(step(&pair, 0, 100, 0, 0.5)->distance, 0.4, 1e-12, 0);
    clear(&pair);
}

static void bodies_that_have_touched_stay_so(void **state) {
    (void)state;
    struct pair pair = place(PAIR("0", "0.5"));
    NEAR(step(&pair, 1, 0, -0.5, 0.1)->distance, 0, 0, 0);
    const struct closest *const closest = step(&pair, 1, 0, 5, 0.2);
    NEAR(closest->distance, 0, 0, 0);
    assert_true(closest->t <= 0.1);
    clear(&pair);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_fish_is_close_to_none),
        cmocka_unit_test(closest_approach_is_that_of_all_steps),
        cmocka_unit_test(bodies_that_cross_between_two_steps_have_touched),
        cmocka_unit_test(bodies_that_pass_each_other_have_not),
        cmocka_unit_test(bodies_that_have_touched_stay_so),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
