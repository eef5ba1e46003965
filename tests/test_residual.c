/* test_residual.c: the Jacobian of the whole school against differences, for every option of the model. */
#include <stdlib.h>
#include <string.h>

#include "school.h"

#define TIME "time: {end: 1, shedding_interval: 0.02, output_interval: 0.02}\n"
#define FAR "solver: {coupling_distance: 100}\n"
#define FISH "fish: [{sheet_points: 9, body: {modulus: 1.0e+5}}]\n"

/* Every option of doc/model.md at least once, alone or with those that it meets. */
static const struct variant {
    const char *name, *text;
} variants[] = {
    {"defaults", TIME FISH},
    {"stiff, 21 sheet points", TIME "fish: [{body: {modulus: 1.0e+9}}]\n"},
    {"second moment published", TIME "fish: [{sheet_points: 9, body: {second_moment: published}}]\n"},
    {"profile uniform", TIME "fish: [{sheet_points: 9, nodes: 5, body: {profile: uniform, thickness: 0.1}}]\n"},
    {"profile table", TIME "fish: [{sheet_points: 9, nodes: 5, body: {profile: table, h: [0.1, 0.2, 0.15, 0.05], "
                           "w: [0.2, 0.3, 0.25, 0.1]}}]\n"},
    {"relaxation time", TIME "fish: [{sheet_points: 9, body: {relaxation_time: 0.1, bending_damping: 2}}]\n"},
    {"load at the tip", TIME "fish: [{sheet_points: 9, load: {tip: [3, -2]}}]\n"},
    {"collocation midpoint", TIME "wake: {collocation: midpoint}\n" FISH},
    {"kutta rate", TIME "wake: {kutta: rate}\n" FISH},
    {"kutta rate with ramp, midpoint", TIME "wake: {kutta: rate, kutta_ramp: 0.5, collocation: midpoint}\n" FISH},
    {"impulsive edge", TIME "wake: {shedding: impulsive}\n" FISH},
    {"impulsive rate", TIME "wake: {shedding: impulsive, kutta: rate}\n" FISH},
    {"dropped, no fade", TIME "wake: {dissipated_circulation: dropped, fade: 0}\n" FISH},
    {"preset published", TIME "preset: published\n" FISH},
    {"linear-quadratic drag", TIME "fish: [{sheet_points: 9, drag: {law: linear_quadratic, tangential: 0.1}}]\n"},
    {"extent width", TIME "fish: [{sheet_points: 9, drag: {extent: width, tangential: 0.1}}]\n"},
    {"stream, shear, gust", TIME "fluid: {velocity: [0.3, -0.2], shear: 0.7, gust: {amplitude: 0.4, frequency: 1.3}}\n"
                                 "fish: [{sheet_points: 9, control: {law: heading}}]\n"},
    {"bias", TIME "fish: [{sheet_points: 9, control: {bias: 0.2}}]\n"},
    {"heading", TIME "fish: [{sheet_points: 9, control: {law: heading, desired_heading: 150}}]\n"},
    {"heading without feedforward",
     TIME "fish: [{sheet_points: 9, control: {law: heading, desired_heading: 150, feedforward: 0}}]\n"},
    {"headings in time",
     TIME "fish: [{sheet_points: 9, control: {law: heading, desired_heading: [[0, 180], [1, 120]]}}]\n"},
    {"waypoints", TIME "fish: [{sheet_points: 9, control: {law: heading, waypoints: [[-3, 1], [-4, 5]]}}]\n"},
    {"averaged heading", TIME "fish: [{sheet_points: 9, control: {law: averaged_heading, desired_heading: 150}}]\n"},
    {"averaged heading, waypoints",
     TIME "fish: [{sheet_points: 9, control: {law: averaged_heading, waypoints: [[-3, 1]]}}]\n"},
    {"driven head", TIME "fish: [{sheet_points: 9, motion: {driven: head, heave: 0.1, pitch: 10, pitch_phase: 70, "
                         "frequency: 1, pivot: 0.2}}]\n"},
    {"driven body", TIME "fish: [{sheet_points: 9, motion: {driven: all, heave: 0.1, pitch: 10, frequency: 1}}]\n"},
    {"driven head, kutta rate, load",
     TIME "wake: {kutta: rate}\n"
          "fish: [{sheet_points: 9, load: {tip: [1, 2]}, motion: {driven: head, heave: 0.1, frequency: 1}}]\n"},
    {"three fish",
     TIME FAR "fluid: {velocity: [0.1, 0.05], shear: 0.2}\n"
              "fish:\n"
              "  - {sheet_points: 9, control: {law: heading, desired_heading: 150}}\n"
              "  - {nodes: 5, sheet_points: 7, length: 0.7, start: {position: [0.2, 0.5], heading: 170},\n"
              "     drag: {law: linear_quadratic, extent: width}, control: {law: averaged_heading}}\n"
              "  - {nodes: 9, sheet_points: 11, length: 1.2, start: {position: [0.1, -0.6], heading: 200},\n"
              "     motion: {driven: head, heave: 0.1, frequency: 1}}\n"},
    {"three fish, kutta rate, midpoint, waypoints",
     TIME FAR "wake: {kutta: rate, collocation: midpoint}\n"
              "fish:\n"
              "  - {sheet_points: 9, control: {law: heading, waypoints: [[-3, 1]]}}\n"
              "  - {nodes: 5, sheet_points: 7, length: 0.7, start: {position: [0.2, 0.5], heading: 170}}\n"
              "  - {nodes: 9, sheet_points: 11, length: 1.2, start: {position: [0.1, -0.6], heading: 200},\n"
              "     body: {second_moment: published}, control: {law: heading}}\n"},
    {"two fish, impulsive", TIME FAR "preset: published\n"
                                     "fish:\n"
                                     "  - {sheet_points: 9}\n"
                                     "  - {nodes: 5, sheet_points: 7, start: {position: [0.2, 0.5]}}\n"},
};

static void value_of_school(struct setup *setup, const double *y, const double *yp, double *value) {
    school_ok(residual_evaluate(setup->residual, setup->t, y, yp, value));
}

static void jacobian_agrees_with_differences_for_every_option(void **state) {
    (void)state;
    for (size_t i = 0; i < sizeof variants / sizeof *variants; i++) {
        struct setup setup;
        school_build(&setup, variants[i].text);
        school_stir(&setup);
        school_compare(&setup, value_of_school, NULL, variants[i].name);
        if (setup.school->shedding == SHEDDING_IMPULSIVE) {
            setup.residual->at_impulse = 1;
            school_compare(&setup, value_of_school, NULL, variants[i].name);
        }
        school_clear(&setup);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(jacobian_agrees_with_differences_for_every_option),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
