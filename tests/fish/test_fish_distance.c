/* test_fish_distance.c: distances between the outlines of bodies. */
#include <stdio.h>
#include <string.h>

#include "fish/fish_distance.h"
#include "fish/fish_school.h"
#include "school.h"

#define TIME "time: {end: 1, shedding_interval: 0.02, output_interval: 0.02}\n"

static void distance_is_that_of_the_outlines(void **state) {
    (void)state;
    struct setup setup;
    school_build(&setup, TIME
                 "defaults: {fish: {body: {profile: uniform, thickness: 0.1}}}\n"
                 "fish: [{}, {start: {position: [0, 0.5]}}, {start: {position: [1.5, 0]}}]\n");
    const struct fish *fish = setup.school->fish;
    NEAR(fish_distance(&fish[0], &fish[1], setup.state->y, INFINITY), 0.4, 1e-14, 0);
    // tail at x = 1 to nose at 1.5, minus half of both thicknesses
    NEAR(fish_distance(&fish[0], &fish[2], setup.state->y, INFINITY), 0.4, 1e-14, 0);
    NEAR(fish_distance(&fish[2], &fish[0], setup.state->y, INFINITY), 0.4, 1e-14, 0);
    // not computed if the gap of the boxes is above the limit
    NEAR(fish_distance(&fish[0], &fish[1], setup.state->y, 0.4 + 1e-12), 0.4, 1e-14, 0);
    NEAR(fish_distance(&fish[0], &fish[1], setup.state->y, 0.3), INFINITY, 0, 0);
    // crossing bodies touch
    for (int k = 0; k < 7; k++) {
        setup.state->y[fish[1].at.x + k] = 0.55;
        setup.state->y[fish[1].at.y + k] = -0.5 + k / 6.0;
    }
    NEAR(fish_distance(&fish[0], &fish[1], setup.state->y, INFINITY), 0, 0, 0);
    school_clear(&setup);
}

// the distance between two edges is the smallest of four
static int n_hypot;
double __real_hypot(double x, double y);
double __wrap_hypot(double x, double y);
double __wrap_hypot(double x, double y) {
    n_hypot++;
    return __real_hypot(x, y);
}

static void bodies_in_boxes_apart_are_not_compared_edge_by_edge(void **state) {
    (void)state;
    enum { ROWS = 6, COLUMNS = 5 };
    char text[4000] = TIME "fish:\n";
    for (int i = 0; i < ROWS * COLUMNS; i++) {
        const size_t used = strlen(text);
        snprintf(text + used, sizeof text - used, "  - {start: {position: [%g, %g]}}\n", 1.5 * (i % COLUMNS),
                 0.6 * (i / COLUMNS));
    }
    struct case_values values;
    struct school *school;
    school_settings(&values, text);
    n_hypot = 0;
    school_ok(fish_school_create(&school, &values.school));
    const int per_pair = 4 * school->fish->n_edges * school->fish->n_edges;
    assert_true(n_hypot < per_pair);
    fish_school_free(school);
    case_free(&values);
}

/* The same from points along the bodies, SAMPLES per edge; too large by less than the distance between two points. */
enum { SAMPLES = 200 };
static double sampled_distance(const struct fish *a, const struct fish *b, const double *y) {
    double least = INFINITY;
    for (int i = 0; i <= SAMPLES * a->n_edges; i++) {
        const int k = i < SAMPLES * a->n_edges ? i / SAMPLES : a->n_edges - 1;
        const double q = (double)i / SAMPLES - k, px = (1 - q) * y[a->at.x + k] + q * y[a->at.x + k + 1],
                     py = (1 - q) * y[a->at.y + k] + q * y[a->at.y + k + 1];
        for (int j = 0; j <= SAMPLES * b->n_edges; j++) {
            const int l = j < SAMPLES * b->n_edges ? j / SAMPLES : b->n_edges - 1;
            const double r = (double)j / SAMPLES - l;
            least = fmin(least, hypot((1 - r) * y[b->at.x + l] + r * y[b->at.x + l + 1] - px,
                                      (1 - r) * y[b->at.y + l] + r * y[b->at.y + l + 1] - py));
        }
    }
    return fmax(0, least - (a->thickness[0] + b->thickness[0]) / 2);
}

static void distance_of_bent_bodies_is_the_least_of_their_points(void **state) {
    (void)state;
    struct setup setup;
    school_build(&setup, TIME
                 "defaults: {fish: {nodes: 4, sheet_points: 5, body: {profile: uniform, thickness: 0.02}}}\n"
                 "fish: [{}, {length: 0.7, start: {position: [0, 0.5]}}]\n");
    const struct fish *a = &setup.school->fish[0], *b = &setup.school->fish[1];
    double *const y = setup.state->y;
    int n_touching = 0;
    for (int example = 0; example < 60; example++) {
        for (int k = 0; k < 4; k++) {
            y[a->at.x + k] = k / 3.0 + 0.1 * school_random(&setup);
            y[a->at.y + k] = 0.3 * school_random(&setup);
            y[b->at.x + k] = 0.5 + 0.6 * school_random(&setup);
            y[b->at.y + k] = 0.4 + 0.4 * school_random(&setup);
        }
        // edges are up to 1.4 long
        const double want = sampled_distance(a, b, y), spacing = 1.4 / SAMPLES;
        const double got = fish_distance(a, b, y, INFINITY);
        assert_true(got <= want + 1e-14 && got >= want - spacing);
        NEAR(fish_distance(b, a, y, INFINITY), got, 1e-15, 0);
        // boxes never exclude near bodies
        NEAR(fish_distance(a, b, y, got + 1e-12), got, 0, 0);
        n_touching += got <= 0;
    }
    print_message("%d of 60 pairs touch\n", n_touching);
    assert_in_range(n_touching, 10, 50);
    school_clear(&setup);
}

static void distance_from_a_wall_counts_the_thicker_edge_of_a_node(void **state) {
    (void)state;
    struct setup setup;
    school_build(&setup, TIME
                 "fluid: {walls: [-1]}\nfish: [{nodes: 5, wave: {amplitude: 0}, body: {profile: table, "
                 "thickness_table: [0.1, 0.2, 0.05, 0.3], depth_table: [0.2, 0.2, 0.2, 0.2]}}]\n");
    const struct fish *const fish = setup.school->fish;
    double *const y = setup.state->y;
    const double thickest[] = {0.1, 0.2, 0.2, 0.3, 0.3};
    for (int k = 0; k < 5; k++) {
        y[fish->at.y + k] -= 0.5;
        NEAR(fish_wall_distance(setup.school, fish, y, NULL), 0.5 - thickest[k] / 2, 1e-14, 0);
        y[fish->at.y + k] += 0.5;
    }
    school_clear(&setup);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(distance_is_that_of_the_outlines),
        cmocka_unit_test(distance_of_bent_bodies_is_the_least_of_their_points),
        cmocka_unit_test(distance_from_a_wall_counts_the_thicker_edge_of_a_node),
        cmocka_unit_test(bodies_in_boxes_apart_are_not_compared_edge_by_edge),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
