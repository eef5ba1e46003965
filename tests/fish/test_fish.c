/* test_fish.c: From its parameters a fish gets the shape, the masses, the stiffness, the points of its sheet and the
 * start of doc/model.md, sections 1, 3, 4, 5 and 6. */
#include <stdio.h>
#include <string.h>

#include "fish/fish.h"
#include "fish/fish_school.h"
#include "fish/fish_sheet.h"
#include "school.h"

#define TIME "time: {end: 1, shedding_interval: 0.02, output_interval: 0.02}\n"
#define SMALL TIME "defaults: {fish: {nodes: 7}}\n"

static const double pi = 3.14159265358979323846;

static double sum(int n, const double *value) {
    double total = 0;
    for (int i = 0; i < n; i++) total += value[i];
    return total;
}

#define FOIL "thickness: 0.2, tail_thickness: 0, depth: 0.25"

TEST(joukowski_body_has_the_mass_of_the_reference) {
    struct setup setup = setup_of(SMALL "fish: [{body: {" FOIL ", section: nodes, density: 2000}}]\n");
    const struct fish *fish = &setup.school->fish[0];
    // an independent program's mass of the same body
    NEAR(fish->total_mass, 57.50243756590633, 1e-10, 0);
    NEAR(sum(fish->n_nodes, fish->mass), fish->total_mass, 0, 1e-14);
}

TEST(mean_sections_give_the_mass_and_the_stiffness_of_the_foil) {
    struct setup setup = setup_of(TIME "fish: [{nodes: 17, body: {" FOIL ", modulus: 1}}]\n");
    const struct fish *fish = &setup.school->fish[0];
    // an independent program's mass of the same body
    NEAR(fish->total_mass, 30.842513753404223, 1e-9, 0);
    for (int k = 0; k < fish->n_edges; k++) {
        NEAR(fish->axial_stiffness[k], pi * fish->thickness[k] * 0.25 / 4, 0, 1e-14);
    }
    for (int j = 0; j < fish->n_joints; j++) {
        double moment = 0;
        for (int k = j; k <= j + 1; k++) moment += pi * 0.25 * pow(fish->thickness[k], 3) * fish->cube[k] / 64 / 2;
        NEAR(fish->bending_stiffness[j], moment, 0, 1e-14);
    }
}

TEST(added_mass_takes_the_mean_square_of_the_thickness) {
    struct setup setup =
        setup_of(TIME
                 "defaults: {fish: {nodes: 7, force: reactive, drag: {normal: 0.5}}}\n"
                 "fish: [{added_mass: {coefficient: 1.5, extent: thickness}}, {start: {position: [0, 2]}, "
                 "added_mass: {coefficient: 1.5, extent: depth}}]\n");
    const struct fish *thick = &setup.school->fish[0], *wide = &setup.school->fish[1];
    for (int k = 0; k < thick->n_edges; k++) {
        const double h = thick->thickness[k], l = 1.0 / 6;
        ABOVE(thick->square[k], 1);
        NEAR(thick->added_mass[k], pi * 1000 * 1.5 * h * h * thick->square[k] * l / 4, 0, 1e-14);
        NEAR(thick->drag_normal[k], 1000 * 0.5 * l * h / 2, 0, 1e-14);
        NEAR(wide->added_mass[k], pi * 1000 * 1.5 * 0.2 * 0.2 * l / 4, 0, 1e-14);
    }
}

TEST(the_outline_of_another_fish_serves_for_the_same_section) {
    struct setup setup =
        setup_of(SMALL
                 "fish: [{body: {section: mean}}, {start: {position: [0, 2]}, body: {section: nodes}}, "
                 "{start: {position: [0, 4]}, body: {section: mean}}]\n");
    const struct fish *const fish = setup.school->fish;
    double most = 0;
    for (int k = 0; k < fish->n_edges; k++) most = fmax(most, fabs(fish[0].thickness[k] - fish[1].thickness[k]));
    ABOVE(most, 1e-3 * fish->length);
    NEAR_ARRAY(fish->n_edges, fish[2].thickness, fish[0].thickness, 0, 0);
}

TEST(second_moments_are_the_two_formulas) {
    const char *const texts[] = {
        TIME
        "fish: [{nodes: 13, body: {profile: uniform, thickness: 0.1, depth: 0.25, density: 2000, modulus: 3.0e+5}}]\n",
        TIME
        "fish: [{nodes: 13, body: {profile: uniform, thickness: 0.1, depth: 0.25, density: 2000, modulus: 3.0e+5, "
        "second_moment: published}}]\n"};
    const double h = 0.1, w = 0.25, area = pi * h * w / 4;
    const double moment[] = {pi * w * h * h * h / 64, 2000 * area * w * w / 12 / 6};
    for (int i = 0; i < 2; i++) {
        struct setup setup = setup_of(texts[i]);
        const struct fish *fish = &setup.school->fish[0];
        for (int j = 0; j < fish->n_joints; j++) NEAR(fish->bending_stiffness[j], 3e5 * moment[i], 0, 1e-14);
        for (int k = 0; k < fish->n_edges; k++) NEAR(fish->axial_stiffness[k], 3e5 * area, 0, 1e-14);
        NEAR(fish->total_mass, 2000 * area, 0, 1e-14);
    }
}

TEST(damping_and_wave_scale_with_refinement) {
    struct setup setup =
        setup_of(TIME
                 "fish: [{nodes: 13, body: {bending_damping: 0.5, stretching_damping: 2, relaxation_time: "
                 "0.01, profile: uniform}, wave: {phase: 30, frequency: 1.5}}]\n");
    const struct fish *fish = &setup.school->fish[0];
    // 13 nodes: edges of half the reference length
    const double l = 1.0 / 12;
    for (int j = 0; j < fish->n_joints; j++) {
        NEAR(fish->bending_damping[j], 1 + 0.01 * fish->bending_stiffness[j] / l, 0, 1e-14);
        const double s = (j + 1) * l;
        NEAR(fish->wave_amplitude[j], 0.4 / 2 * (s + 0.2 * s * s), 0, 1e-14);
        NEAR(fish->wave_phase[j], -6 * s + pi / 6, 0, 1e-14);
    }
    for (int k = 0; k < fish->n_edges; k++)
        NEAR(fish->axial_damping[k], 4 + 0.01 * fish->axial_stiffness[k] / l, 0, 1e-14);
    NEAR(fish->omega, 3 * pi, 0, 1e-15);
    NEAR(fish->ramp, 1 / 1.5, 0, 1e-15);
}

TEST(table_of_heights_is_taken_as_it_is) {
    struct setup setup = setup_of(TIME
                                  "fish: [{nodes: 4, body: {profile: table, density: 2000, thickness_table: [0.1, 0.2, "
                                  "0.3], depth_table: [0.3, 0.2, 0.1]}}]\n");
    const struct fish *fish = &setup.school->fish[0];
    const double h[] = {0.1, 0.2, 0.3}, w[] = {0.3, 0.2, 0.1};
    NEAR_ARRAY(3, fish->thickness, h, 0, 0);
    NEAR_ARRAY(3, fish->depth, w, 0, 0);
    const double m = 2000 * pi / 4 / 3;
    const double mass[] = {m * 0.015, m * (0.015 + 0.02), m * (0.02 + 0.015), m * 0.015};
    NEAR_ARRAY(4, fish->mass, mass, 0, 1e-14);
}

TEST(drag_coefficients_follow_the_extent) {
    struct setup setup;
    for (int wide = 0; wide < 2; wide++) {
        setup =
            setup_with(TIME
                       "fish: [{nodes: 7, force: reactive, body: {profile: uniform, thickness: 0.1, depth: 0.25},\n"
                       "        drag: {tangential: 1e-3, normal: 0.5}, added_mass: {coefficient: 1.5, extent: %s}}]\n",
                       wide ? "depth" : "thickness");
        const struct fish *fish = &setup.school->fish[0];
        const double l = 1.0 / 6, h = 0.1, w = 0.25, across = wide ? w : h;
        NEAR(fish->drag_tangential[2], 1000 * pi * 1e-3 * l * (h + w) / 4, 0, 1e-14);
        NEAR(fish->drag_normal[2], 1000 * 0.5 * l * across / 2, 0, 1e-14);
        NEAR(fish->added_mass[2], pi * 1000 * 1.5 * across * across * l / 4, 0, 1e-14);
    }
}

// the arc coordinate of a point from the nodes of the stencil
static double arc_of(const struct fish *fish, const struct stencil *point) {
    return fish_mean(point, fish->arc);
}

TEST(sheet_points_are_cosine_points_and_weights_add_up_to_the_length) {
    struct setup setup =
        setup_of(SMALL "sheet: {curve: polygon}\nfish: [{force: reactive, sheet_points: 11, length: 1.2}]\n");
    const struct fish *fish = &setup.school->fish[0];
    NEAR(sum(11, fish->sheet_weight), 1.2, 0, 1e-14);
    for (int j = 0; j < 11; j++) {
        // the rounding of a body of six edges
        NEAR(arc_of(fish, &fish->sheet_point[j]), 1.2 * (1 - cos(pi * j / 10)) / 2, 1e-15, 0);
    }
    // on a smooth sheet the weights are Gauss-Lobatto weights, pi/(M-1) sin(theta) L/2, up to a factor
    NEAR(fish->sheet_weight[5] / fish->sheet_weight[3], 1 / sin(0.3 * pi), 0, 1e-13);
}

TEST(control_points_are_chebyshev_points_or_midpoints_of_chords) {
    struct setup setup = setup_of(SMALL "fish: [{force: reactive, sheet_points: 11}]\n");
    for (int c = 0; c < 10; c++) {
        const double place = (1 - cos(pi * (c + 0.5) / 10)) / 2;
        NEAR(arc_of(setup.school->fish, &setup.school->fish[0].control_point[c]), place, 1e-15, 0);
        NEAR(fish_sheet_index(setup.school->fish, place), c + 0.5, 1e-13, 0);
    }
    school_build(
        &setup, SMALL
        "wake: {shedding: continuous}\nsheet: {collocation: midpoint}\nfish: [{force: reactive, sheet_points: 11}]\n");
    const struct fish *fish = &setup.school->fish[0];
    for (int c = 0; c < 10; c++) {
        NEAR(arc_of(fish, &fish->control_point[c]),
             (arc_of(fish, &fish->sheet_point[c]) + arc_of(fish, &fish->sheet_point[c + 1])) / 2, 1e-15, 0);
        double total = 0;
        for (int i = 0; i < fish->control_point[c].n; i++) total += fish->control_point[c].weight[i];
        NEAR(total, 1, 1e-15, 0);
    }
}

TEST(smooth_curve_has_the_same_places_and_the_weights_of_the_quadrature) {
    struct setup smooth, polygon;
    for (int midpoint = 0; midpoint < 2; midpoint++) {
        char text[2][256];
        for (int i = 0; i < 2; i++) {
            snprintf(text[i], sizeof text[i],
                     SMALL
                     "wake: {shedding: continuous}\nsheet: {curve: %s, collocation: %s}\nfish: [{force: reactive, "
                     "sheet_points: 11, length: 1.2}]\n",
                     i == 0 ? "smooth" : "polygon", midpoint ? "midpoint" : "chebyshev");
        }
        school_build(&smooth, text[0]);
        school_build(&polygon, text[1]);
        const struct fish *a = smooth.school->fish, *b = polygon.school->fish;
        for (int j = 0; j < 11; j++) NEAR(arc_of(a, &a->sheet_point[j]), arc_of(b, &b->sheet_point[j]), 1e-14, 0);
        for (int c = 0; c < 10; c++) NEAR(arc_of(a, &a->control_point[c]), arc_of(b, &b->control_point[c]), 1e-14, 0);
        for (int j = 1; j < 10; j++) NEAR(a->sheet_weight[j], 0.06 * pi * sin(0.1 * pi * j), 0, 1e-14);
        NEAR(a->sheet_weight[0], b->sheet_weight[0], 0, 0);
        NEAR(a->sheet_weight[10], b->sheet_weight[10], 0, 0);
    }
}

TEST(start_is_straight_behind_the_nose_with_one_velocity) {
    struct setup setup = setup_of(SMALL "fish: [{start: {position: [2, 3], heading: 30, speed: 0.7}}]\n");
    const struct fish *fish = &setup.school->fish[0];
    const double *const y = setup.state->y;
    for (int k = 0; k < fish->n_nodes; k++) {
        NEAR(y[fish->at.x + k], 2 - fish->arc[k] * cos(pi / 6), 1e-14, 0);
        NEAR(y[fish->at.y + k], 3 - fish->arc[k] * sin(pi / 6), 1e-14, 0);
        NEAR(y[fish->at.vx + k], 0.7 * cos(pi / 6), 1e-15, 0);
        NEAR(y[fish->at.vy + k], 0.7 * sin(pi / 6), 1e-15, 0);
    }
}

TEST(start_without_ramp_has_the_natural_shape) {
    struct setup setup = setup_of(SMALL "fish: [{wave: {ramp: 0, phase: 40}, control: {bias: 0.3}}]\n");
    const struct fish *fish = &setup.school->fish[0];
    const double *const x = setup.state->y + fish->at.x, *const y = setup.state->y + fish->at.y;
    double before = atan2(y[1] - y[0], x[1] - x[0]);
    for (int j = 0; j < fish->n_joints; j++) {
        const double angle = atan2(y[j + 2] - y[j + 1], x[j + 2] - x[j + 1]), turn = angle - before;
        NEAR(remainder(turn, 2 * pi), fish->wave_amplitude[j] * (sin(fish->wave_phase[j]) + 0.3), 1e-14, 0);
        before = angle;
    }
}

TEST(overlapping_fish_are_refused) {
    // fish 1 and 4 overlap, and fish 3 overlaps 2 and 0: named is the first fish that overlaps one before, with the
    // first of those, in whatever order the fish lie
    for (int side = -1; side <= 1; side += 2) {
        char text[512];
        snprintf(text, sizeof text,
                 TIME
                 "defaults: {fish: {nodes: 7, start: {position: [0, 0]}}}\n"
                 "fish: [{start: {position: [%g, 0.04]}}, {start: {position: [%g, 0]}}, {}, "
                 "{start: {position: [%g, 0.02]}}, {start: {position: [%g, 0.02]}}]\n",
                 side * 1.2, side * 9.0, side * 0.6, side * 9.1);
        struct case_values values = school_values(text);
        struct school *school = (struct school *)&values;
        assert_int_equal(fish_school_create(NULL, &school, &values.school), STATUS_CASE);
        assert_null(school);
        assert_non_null(strstr(status_message(), "fish[0] (fish1) and fish[3] (fish4) overlap"));
    }
}

TEST(fish_that_begin_beyond_a_wall_are_refused) {
    // half of the body is 0.05 thick; with a single wall the first fish is on the side of the fluid
    static const struct {
        const char *walls, *fish;
        int status;
    } cases[] = {{"[-0.06]", "[{}]", STATUS_OK},
                 {"[0.06]", "[{}]", STATUS_OK},
                 {"[0.04]", "[{}]", STATUS_CASE},
                 {"[-0.5]", "[{}, {start: {position: [0, -1]}}]", STATUS_CASE},
                 {"[-0.5, 0.5]", "[{}, {start: {position: [0, 0.4]}}]", STATUS_OK},
                 {"[-0.5, 0.5]", "[{}, {start: {position: [0, 0.46]}}]", STATUS_CASE},
                 {"[1, 2]", "[{}]", STATUS_CASE}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[512];
        snprintf(
            text, sizeof text,
            TIME
            "fluid: {walls: %s}\ndefaults: {fish: {nodes: 7, wave: {amplitude: 0}, body: {profile: uniform, thickness: "
            "0.1}}}\nfish: %s\n",
            cases[i].walls, cases[i].fish);
        const struct case_values values = school_values(text);
        struct school *school;
        assert_int_equal(fish_school_create(test_arena(), &school, &values.school), cases[i].status);
        if (cases[i].status != STATUS_OK) assert_non_null(strstr(status_message(), "wall"));
    }
}

TEST(unknowns_stand_fish_after_fish_in_the_documented_order) {
    struct setup setup = setup_of(TIME
                                  "defaults: {fish: {force: reactive}}\nfish: [{nodes: 5, sheet_points: 6}, {nodes: 4, "
                                  "sheet_points: 5, start: {position: [0, 2]}}]\n");
    const struct layout *a = &setup.school->fish[0].at, *b = &setup.school->fish[1].at;
    const int first[] = {a->x, a->y, a->vx, a->vy, a->ax, a->ay, a->gamma, a->circulation, a->phi0, a->end};
    const int want[] = {0, 5, 10, 15, 20, 25, 30, 36, 37, 38};
    assert_memory_equal(first, want, sizeof want);
    assert_int_equal(b->x, 38);
    assert_int_equal(b->end, 38 + 24 + 7);
    assert_int_equal(setup.school->n_unknowns, b->end);
}

TEST(gust_blows_across_the_stream) {
    struct setup setup =
        setup_of(SMALL "fluid: {velocity: [3, 4], gust: {amplitude: 0.5, frequency: 2}}\nfish: [{}]\n");
    NEAR(setup.school->gust[0], -0.4, 1e-15, 0);
    NEAR(setup.school->gust[1], 0.3, 1e-15, 0);
    NEAR(setup.school->gust_omega, 4 * pi, 0, 1e-15);
}

TEST(a_wave_has_an_amplitude_a_frequency_and_a_free_body) {
    static const struct {
        const char *fish;
        bool has_wave;
    } cases[] = {{"", 1},
                 {"wave: {amplitude: 0}", 0},
                 {"wave: {frequency: 0}", 0},
                 {"wave: {amplitude: 0, table: [[0, 1, -1], [0, 2, -2]]}", 1},
                 {"motion: {prescribed: head, heave: 0.1, frequency: 1}", 1},
                 {"motion: {prescribed: all, heave: 0.1, frequency: 1}", 0}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct setup setup =
            setup_with("time: {end: 1, shedding_interval: 0.02}\nfish: [{nodes: 7, %s}]\n", cases[i].fish);
        const struct fish *const fish = setup.school->fish;
        assert_int_equal(fish_has_wave(fish), cases[i].has_wave);
        // the friction of a body on which a wave travels
        NEAR(fish->waving, cases[i].has_wave ? 1.5 : 1, 0, 0);
    }
}

// ---- distances between the outlines of bodies

#define TIME "time: {end: 1, shedding_interval: 0.02, output_interval: 0.02}\n"

TEST(distance_is_that_of_the_outlines) {
    struct setup setup = setup_of(TIME
                                  "defaults: {fish: {nodes: 7, body: {profile: uniform, thickness: 0.1}}}\n"
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
}

// the distance between two edges is the smallest of four
static int n_hypot;
double __real_hypot(double x, double y);
double __wrap_hypot(double x, double y);
double __wrap_hypot(double x, double y) {
    n_hypot++;
    return __real_hypot(x, y);
}

TEST(bodies_in_boxes_apart_are_not_compared_edge_by_edge) {
    enum { ROWS = 6, COLUMNS = 5 };
    char text[4000] = SMALL "fish:\n";
    for (int i = 0; i < ROWS * COLUMNS; i++) {
        const size_t used = strlen(text);
        snprintf(text + used, sizeof text - used, "  - {start: {position: [%g, %g]}}\n", 1.5 * (i % COLUMNS),
                 0.6 * (i / COLUMNS));
    }
    const struct case_values values = school_values(text);
    struct school *school;
    n_hypot = 0;
    school_ok(fish_school_create(test_arena(), &school, &values.school));
    const int per_pair = 4 * school->fish->n_edges * school->fish->n_edges;
    BELOW(n_hypot, per_pair);
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

TEST(distance_of_bent_bodies_is_the_least_of_their_points) {
    struct setup setup = setup_of(
        TIME
        "defaults: {fish: {nodes: 4, force: reactive, sheet_points: 5, body: {profile: uniform, thickness: 0.02}}}\n"
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
        AT_MOST(got, want + 1e-14);
        AT_LEAST(got, want - spacing);
        NEAR(fish_distance(b, a, y, INFINITY), got, 1e-15, 0);
        // boxes never exclude near bodies
        NEAR(fish_distance(a, b, y, got + 1e-12), got, 0, 0);
        n_touching += got <= 0;
    }
    assert_in_range(n_touching, 10, 50);
}

TEST(distance_from_a_wall_counts_the_thicker_edge_of_a_node) {
    struct setup setup =
        setup_of(TIME
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
}

TEST(a_street_has_two_staggered_rows_along_the_stream) {
    struct setup setup =
        setup_of(SMALL
                 "fluid: {velocity: [0, 2]}\nwake: {vortices: [[7, 8, 9]],\n"
                 "       street: {vortices: 3, spacing: 0.8, row_distance: 0.3, circulation: 5, position: [1, 2]}}\n"
                 "fish: [{force: published}]\n");
    // along y: the row on the left has the smaller x
    static const double want[] = {7, 8, 9, 0.85, 1.6, -5, 1.15, 2, 5, 0.85, 2.4, -5};
    assert_int_equal(setup.school->n_vortices, 4);
    for (int i = 0; i < 12; i++) NEAR(setup.school->vortices[i], want[i], 1e-15, 0);

    // von Karman's ratio
    school_build(&setup,
                 SMALL "wake: {street: {vortices: 2, spacing: 2, circulation: 1}}\nfish: [{force: published}]\n");
    NEAR(setup.school->vortices[1] - setup.school->vortices[4], 2 * 0.28055, 1e-5, 0);
}

TEST(the_widening_is_the_slope_of_a_depth_that_swells_and_narrows) {
    struct setup setup = setup_of(
        TIME
        "wake: {shedding: sheet}\nsheet: {curve: smooth}\n"
        "fish: [{nodes: 7, sheet_points: 401, force: pressure, pressure: {span: finite}, body: {profile: table, "
        "thickness_table: [.1, .1, .1, .1, .1, .1], depth_table: [.2, .5, .6, .3, .2, .7]}}]\n");
    const struct fish *const fish = setup.school->fish;
    for (int c = 0; c < fish->n_control; c++) {
        // w^2/32 at the sheet points on both sides; edge midpoints have a kink of the slope between them
        const double pace = pi / fish->n_control, left = fish->n_edges * (1 - cos(pace * c)) / 2,
                     right = fish->n_edges * (1 - cos(pace * (c + 1))) / 2;
        const double change = (fish->sheet_half[c + 1] - fish->sheet_half[c]) / (right - left);
        NEAR(fish->control_widening[c], change, 2.5e-4, 0);
    }
}

TEST(only_equal_sheets_share_their_integrals) {
    struct setup setup =
        setup_of(TIME
                 "wake: {shedding: sheet}\nsheet: {curve: smooth}\n"
                 "defaults: {fish: {nodes: 7, sheet_points: 21, force: pressure, pressure: {span: infinite}}}\nfish:\n"
                 "  - {}\n"
                 "  - {sheet_points: 41, start: {position: [0, 2]}}\n"
                 "  - {nodes: 9, start: {position: [0, 4]}}\n"
                 "  - {body: {depth: 0.4}, start: {position: [0, 6]}}\n"
                 "  - {start: {position: [0, 8]}}\n");
    const struct fish *const fish = setup.school->fish;
    for (int f = 1; f < 4; f++) {
        for (int g = 0; g < f; g++) assert_ptr_not_equal(fish[f].integrals, fish[g].integrals);
    }
    assert_ptr_equal(fish[4].integrals, fish[0].integrals);
}

TEST(a_depth_that_grows_in_proportion_is_a_straight_edge) {
    struct setup setup = setup_of(
        TIME
        "wake: {shedding: sheet}\nsheet: {curve: smooth}\n"
        "fish: [{nodes: 7, sheet_points: 41, force: pressure, pressure: {span: finite}, body: {profile: table, "
        "thickness_table: [.1, .1, .1, .1, .1, .1], depth_table: [.2, .3, .4, .5, .6, .7]}}]\n");
    const struct fish *const fish = setup.school->fish;
    int n = 0;
    for (int c = 0; c < fish->n_control; c++) {
        // between the middles of edges that have neighbours on both sides; the slope is 0 at nose and tail
        const double u = fish->n_edges * (1 - cos(pi * (c + 0.5) / fish->n_control)) / 2, depth = 0.15 + 0.1 * u;
        if (u < 1.5 || u > fish->n_edges - 1.5) continue;
        NEAR(fish->point_half[c], depth * depth / 32, 0, 1e-13);
        NEAR(fish->control_widening[c], depth * 0.1 / 16, 0, 1e-13);
        n++;
    }
    ABOVE(n, 10);
}
