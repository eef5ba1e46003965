/* test_clearance.c: Bodies that touch, pass each other or would pass through each other between two steps are found,
 * with their distance. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/parallel.h"
#include "contact/clearance.h"
#include "school.h"

#define TIME "time: {end: 1, shedding_interval: 0.02, output_interval: 0.02}\n"
#define SMALL TIME "defaults: {fish: {nodes: 7}}\n"

// two straight bodies of thickness at most 0.2: one from x = 0 (nose) to 1 at y = 0, the other at a given position
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
    NEW(test_arena(), pair.between, pair.setup.school->n_unknowns);
    assert_non_null(pair.between);
    clearance_start(pair.setup.school, pair.setup.state, pair.setup.residual->neighbours, pair.between);
    return pair;
}

// one step that moves fish f by dx, dy and ends at t
static const struct closest *step(struct pair *pair, int f, double dx, double dy, double t) {
    const struct fish *const fish = &pair->setup.school->fish[f];
    for (int k = 0; k < fish->n_nodes; k++) {
        pair->setup.state->y[fish->at.x + k] += dx;
        pair->setup.state->y[fish->at.y + k] += dy;
    }
    clearance_step(pair->setup.school, pair->setup.state, t, pair->setup.state->y, pair->setup.residual->neighbours,
                   pair->between);
    return pair->setup.state->closest;
}

// many pairs at the same distance, and enough fish for several threads
TEST(of_pairs_at_the_same_distance_the_first_one_counts) {
    enum { N_FISH = 30 };
    char text[4096] = TIME "defaults: {fish: {nodes: 7, wave: {amplitude: 0}}}\nfish: [{}";
    for (int f = 1; f < N_FISH; f++) {
        snprintf(text + strlen(text), sizeof text - strlen(text), ", {start: {position: [0, %d]}}", f);
    }
    strcat(text, "]\n");
    struct pair pair = place(text);
    AT_LEAST(pair.setup.school->n_unknowns, PARALLEL_UNKNOWNS);
    double *const at_start = test_copy(pair.setup.school->n_unknowns, pair.setup.state->y);
    for (int threads = 1; threads <= 3; threads++) {
        pair.setup.school->threads = threads;
        // all fish but the first two halve the distance to a neighbour
        for (int f = 0; f < N_FISH; f++) {
            const struct fish *const fish = &pair.setup.school->fish[f];
            for (int k = 0; k < fish->n_nodes; k++) pair.setup.state->y[fish->at.y + k] = f < 2 ? 2 * f : 3 + 0.5 * f;
        }
        clearance_start(pair.setup.school, pair.setup.state, pair.setup.residual->neighbours, pair.between);
        const struct closest *const closest = pair.setup.state->closest;
        assert_int_equal(closest->fish[0], 2);
        assert_int_equal(closest->fish[1], 3);
        // another pair at the same distance does not replace the record
        step(&pair, 1, 0, 1.5, threads);
        assert_int_equal(closest->fish[0], 2);
        memcpy(pair.setup.state->y, at_start, (size_t)pair.setup.school->n_unknowns * sizeof *at_start);
    }
    // neighbours allocated by the residual
    pair.setup.school->threads = 1;
}

TEST(one_fish_is_close_to_none) {
    struct pair pair = place(SMALL "fish: [{}]\n");
    NEAR(step(&pair, 0, 1, 0, 0.1)->distance, INFINITY, 0, 0);
}

TEST(closest_approach_is_that_of_all_steps) {
    struct pair pair = place(PAIR("0", "0.5"));
    NEAR(pair.setup.state->closest->distance, 0.4, 1e-14, 0);
    NEAR(step(&pair, 1, 0, -0.2, 0.1)->distance, 0.2, 1e-14, 0);
    const struct closest *const closest = step(&pair, 1, 0, 3, 0.2);
    NEAR(closest->distance, 0.2, 1e-14, 0);
    NEAR(closest->t, 0.1, 0, 0);
    assert_int_equal(closest->fish[0], 0);
    assert_int_equal(closest->fish[1], 1);
}

TEST(bodies_that_cross_between_two_steps_have_touched) {
    // head on, at ten lengths per step; the bodies are lengths apart at both ends of the step
    struct pair pair = place(PAIR("5", "0"));
    const struct closest *const closest = step(&pair, 1, -10, 0, 0.5);
    NEAR(closest->distance, 0, 0, 0);
    // the gap is 4 of the 10 lengths of the step, minus two halves of the thickness
    NEAR(closest->t, 0.5 * 3.9 / 10, 1e-3, 0);
    // sideways
    pair = place(PAIR("0.5", "1"));
    NEAR(step(&pair, 1, 0, -2, 0.5)->distance, 0, 0, 0);
}

TEST(bodies_meet_within_the_step_in_which_they_touch) {
    struct pair pair = place(PAIR("5", "0"));
    step(&pair, 1, 0, 0, 0.5);
    // the gap is 4 of the 10 lengths of the step from 0.5 s to 0.7 s, minus two halves of the thickness
    NEAR(step(&pair, 1, -10, 0, 0.7)->t, 0.5 + 0.2 * 3.9 / 10, 1e-3, 0);
}

// two bodies swing about their noses at rest: their tails are 1.2 m apart at both ends of the step, and meet in between
TEST(two_bodies_that_turn_towards_each_other_have_touched) {
    struct pair pair = place(PAIR("0", "3"));
    double *const y = pair.setup.state->y;
    const double height[] = {0, 1.5};
    for (int end = 0; end < 2; end++) {
        for (int f = 0; f < 2; f++) {
            const struct fish *const fish = &pair.setup.school->fish[f];
            const double across = (f == 0 ? 1 : -1) * 0.8, side = end == 0 ? 1 : -1;
            for (int k = 0; k < fish->n_nodes; k++) {
                y[fish->at.x + k] = (f == 0 ? side : -side) * 0.6 * fish->arc[k];
                y[fish->at.y + k] = height[f] + across * fish->arc[k];
            }
        }
        if (end == 0)
            clearance_start(pair.setup.school, pair.setup.state, pair.setup.residual->neighbours, pair.between);
    }
    clearance_step(pair.setup.school, pair.setup.state, 1, y, pair.setup.residual->neighbours, pair.between);
    NEAR(pair.setup.state->closest->distance, 0, 0, 0);
}

// a body that turns about its nose at rest, through the nose of the other one
TEST(a_body_that_sweeps_over_another_has_touched_it) {
    for (int sweeper = 0; sweeper < 2; sweeper++) {
        struct setup setup = setup_of(PAIR("0", "3"));
        double *const between = test_array(setup.school->n_unknowns), *const y = setup.state->y;
        for (int end = 0; end < 2; end++) {
            for (int f = 0; f < 2; f++) {
                const struct fish *const fish = &setup.school->fish[f];
                for (int k = 0; k < fish->n_nodes; k++) {
                    const double arc = fish->arc[k], aside = f == sweeper ? 0.7 * arc : 0;
                    y[fish->at.x + k] = f == sweeper ? -0.5 + 0.7 * arc : arc;
                    y[fish->at.y + k] = end == 0 ? aside : -aside;
                }
            }
            if (end == 0) {
                clearance_start(setup.school, setup.state, setup.residual->neighbours, between);
                ABOVE(setup.state->closest->distance, 0.2);
            }
        }
        clearance_step(setup.school, setup.state, 1, y, setup.residual->neighbours, between);
        NEAR(setup.state->closest->distance, 0, 0, 0);
        ABOVE(setup.state->closest->t, 0.2);
        BELOW(setup.state->closest->t, 0.5);
    }
}

TEST(bodies_that_pass_each_other_have_not) {
    struct pair pair = place(PAIR("5", "0.15"));
    const struct closest *const closest = step(&pair, 1, -10, 0, 0.5);
    // 0.05 m side by side at the closest approach; the advances resolve this within that distance
    AT_LEAST(closest->distance, 0.05 - 1e-12);
    BELOW(closest->distance, 0.1);
    // a rigid translation of the school changes no distance
    pair = place(PAIR("0", "0.5"));
    const struct fish *const other = &pair.setup.school->fish[1];
    for (int k = 0; k < other->n_nodes; k++) pair.setup.state->y[other->at.x + k] += 100;
    NEAR(step(&pair, 0, 100, 0, 0.5)->distance, 0.4, 1e-12, 0);
}

TEST(bodies_that_have_touched_stay_so) {
    struct pair pair = place(PAIR("0", "0.5"));
    NEAR(step(&pair, 1, 0, -0.5, 0.1)->distance, 0, 0, 0);
    const struct closest *const closest = step(&pair, 1, 0, 5, 0.2);
    NEAR(closest->distance, 0, 0, 0);
    AT_MOST(closest->t, 0.1);
}

// the smallest distance of all pairs on the way from the old to the new positions
static double of_all_pairs(const struct pair *pair, const double *before) {
    const struct school *const school = pair->setup.school;
    double least = INFINITY;
    for (int f = 0; f < school->n_fish; f++) {
        for (int g = 0; g < f; g++) {
            const struct passage passage = clearance_passage(&school->fish[f], &school->fish[g], before,
                                                             pair->setup.state->y, INFINITY, pair->between);
            least = fmin(least, passage.least);
        }
    }
    return least;
}

TEST(the_record_of_a_school_is_that_of_all_pairs) {
    enum { FISH = 20, STEPS = 30 };
    char text[2048];
    int length = snprintf(text, sizeof text, TIME "defaults: {fish: {nodes: 7, body: {thickness: 0.05}}}\nfish:\n");
    for (int f = 0; f < FISH; f++) {
        length += snprintf(text + length, sizeof text - (size_t)length, "  - {start: {position: [%d, %d]}}\n",
                           2 * (f % 5), f / 5);
    }
    struct pair pair = place(text);
    const struct school *const school = pair.setup.school;
    const size_t size = (size_t)school->n_unknowns * sizeof(double);
    double *const before = test_array(school->n_unknowns), *const y = pair.setup.state->y;
    double least = of_all_pairs(&pair, y);
    NEAR(pair.setup.state->closest->distance, least, 0, 0);
    int n_records = 0;
    for (int i = 0; i < STEPS; i++) {
        memcpy(before, y, size);
        for (int f = 0; f < FISH; f++) {
            const struct layout *const at = &school->fish[f].at;
            const double dx = 0.1 * school_random(&pair.setup), dy = 0.1 * school_random(&pair.setup);
            for (int k = 0; k < school->fish[f].n_nodes; k++) {
                y[at->x + k] += dx;
                y[at->y + k] += dy;
            }
        }
        const double here = of_all_pairs(&pair, before);
        n_records += here < least;
        least = fmin(least, here);
        clearance_step(school, pair.setup.state, i + 1, y, pair.setup.residual->neighbours, pair.between);
        NEAR(pair.setup.state->closest->distance, least, 0, 0);
    }
    ABOVE(n_records, 3);
}
