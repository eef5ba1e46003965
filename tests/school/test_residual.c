/* test_residual.c: The Jacobian of a whole school agrees with differences of the residual, for every option of the
 * model. */
#include <stdlib.h>
#include <string.h>

#include "fish/fish_motion.h"
#include "school.h"
#include "school/residual.h"
#include "school/residual_jacobian.h"

#define TIME "time: {end: 1, shedding_interval: 0.02, output_interval: 0.02}\n"
#define SMALL TIME "defaults: {fish: {nodes: 5, sheet_points: 26}}\n"
#define CONTINUOUS "wake: {shedding: continuous}\n"
// stirred bodies may cross
#define FAR "solver: {coupling_distance: 100}\ncontact: {action: warn}\n"
#define PRESSURE TIME "defaults: {fish: {drag: {skin: laminar}}}\n"
#define FISH "fish: [{}]\n"

/* Every option of doc/model.md at least once, alone or with the options that interact. */
static const struct variant {
    const char *name, *text;
} variants[] = {
    {"defaults", TIME "fish: [{}]\n"},
    {"a small fish", SMALL FISH},
    {"stiff", SMALL "fish: [{body: {modulus: 1.0e+9}}]\n"},
    {"second moment published", SMALL "fish: [{body: {second_moment: published}}]\n"},
    {"profile uniform", TIME "fish: [{nodes: 5, body: {profile: uniform, thickness: 0.1}}]\n"},
    {"profile table", TIME "fish: [{nodes: 5, body: {profile: table, thickness_table: [0.1, 0.2, 0.15, 0.05], "
                           "depth_table: [0.2, 0.3, 0.25, 0.1]}}]\n"},
    {"relaxation time", SMALL "fish: [{body: {relaxation_time: 0.1, bending_damping: 2}}]\n"},
    {"damping of the curvature",
     SMALL "fish: [{body: {damping: curvature, relaxation_time: 0.1, bending_damping: 2}}]\n"},
    {"reactive, table, course", SMALL
     "fish: [{sheet_points: 9, force: reactive, body: {relaxation_time: 0.1},\n"
     "        wave: {ramp: 2, table: [[0, 1, -1, 0.4], [2, -3, 1, 1], [1, 0, -2, 5]]}, control: {law: course}}]\n"},
    {"load at the tip", SMALL "fish: [{load: {tip: [3, -2]}}]\n"},
    {"collocation midpoint", SMALL CONTINUOUS "sheet: {collocation: midpoint}\n" FISH},
    {"polygon", SMALL "sheet: {curve: polygon}\n" FISH},
    {"polygon, kutta rate, midpoint",
     SMALL CONTINUOUS "sheet: {curve: polygon, kutta: rate, collocation: midpoint}\n" FISH},
    {"kutta rate", SMALL CONTINUOUS "sheet: {kutta: rate}\n" FISH},
    {"kutta rate, midpoint", SMALL CONTINUOUS "sheet: {kutta: rate, collocation: midpoint}\n" FISH},
    {"impulsive edge", SMALL "wake: {shedding: impulsive}\n" FISH},
    {"impulsive rate", SMALL "wake: {shedding: impulsive}\nsheet: {kutta: rate}\n" FISH},
    {"dropped, no decay", SMALL "wake: {shedding: continuous, removed_circulation: dropped, decay: 0}\n" FISH},
    {"preset published", TIME "preset: published\n" FISH},
    {"published", SMALL "fish: [{force: published}]\n"},
    {"published, linear-quadratic drag",
     SMALL "fish: [{force: published, drag: {law: linear_quadratic, tangential: 0.1}}]\n"},
    {"published, extent thickness",
     SMALL "fish: [{force: published, drag: {tangential: 0.1}, added_mass: {extent: thickness}}]\n"},
    {"stream, shear, gust", SMALL "fluid: {velocity: [0.3, -0.2], shear: 0.7, gust: {amplitude: 0.4, frequency: 1.3}}\n"
                                  "fish: [{control: {law: heading}}]\n"},
    {"reactive", SMALL "fish: [{sheet_points: 9, force: reactive, body: {section: mean}}]\n"},
    {"reactive, extent depth, linear-quadratic drag, stream, shear, gust",
     SMALL "fluid: {velocity: [0.3, -0.2], shear: 0.7, gust: {amplitude: 0.4, frequency: 1.3}}\n"
           "fish: [{sheet_points: 9, force: reactive, control: {law: heading},\n"
           "        drag: {law: linear_quadratic, linear_speed: 0.5}, added_mass: {extent: depth}}]\n"},
    {"reactive, four nodes",
     TIME "fish: [{nodes: 4, sheet_points: 7, force: reactive, added_mass: {extent: depth}}]\n"},
    {"reactive, midpoint, kutta rate, backwards",
     SMALL CONTINUOUS "sheet: {kutta: rate, collocation: midpoint}\n"
                      "fish: [{sheet_points: 9, force: reactive, added_mass: {extent: depth}, start: {speed: -2}}]\n"},
    {"reactive, prescribed head", SMALL "fish: [{sheet_points: 9, force: reactive, added_mass: {extent: depth},\n"
                                        "        motion: {prescribed: head, heave: 0.1, pitch: 10, frequency: 1}}]\n"},
    {"bias", SMALL "fish: [{control: {bias: 0.2}}]\n"},
    {"heading", SMALL "fish: [{control: {law: heading, desired_heading: 150}}]\n"},
    {"heading, damping of the curvature",
     SMALL "fish: [{body: {damping: curvature}, control: {law: heading, desired_heading: 150}}]\n"},
    {"heading, strongly damped",
     SMALL "fish: [{body: {relaxation_time: 1}, control: {law: heading, desired_heading: 150}}]\n"},
    {"heading without feedforward", SMALL "fish: [{control: {law: heading, desired_heading: 150, feedforward: 0}}]\n"},
    {"headings in time", SMALL "fish: [{control: {law: heading, desired_heading: [[0, 180], [1, 120]]}}]\n"},
    {"waypoints", SMALL "fish: [{control: {law: heading, waypoints: [[-3, 1], [-4, 5]]}}]\n"},
    {"averaged heading", SMALL "fish: [{control: {law: averaged_heading, desired_heading: 150}}]\n"},
    {"a place beside a fish", SMALL "fish:\n  - {name: one}\n"
                                    "  - {nodes: 5, start: {position: [0.2, 0.6]},\n"
                                    "     control: {law: place, of: one, offset: [0.2, 0.6]}}\n"},
    {"a place beside a reactive fish", TIME "defaults: {fish: {nodes: 7, sheet_points: 9, force: reactive}}\n"
                                            "fish:\n  - {name: one}\n"
                                            "  - {start: {position: [0.2, 0.6]},\n"
                                            "     control: {law: place, of: one, offset: [0.2, 0.6]}}\n"},
    {"averaged heading, waypoints", SMALL "fish: [{control: {law: averaged_heading, waypoints: [[-3, 1]]}}]\n"},
    {"prescribed head", SMALL "fish: [{motion: {prescribed: head, heave: 0.1, pitch: 10, pitch_phase: 70, "
                              "frequency: 1, pivot: 0.2}}]\n"},
    {"clamped head",
     SMALL "fish: [{sheet_points: 9, body: {section: mean, damping: strain, relaxation_time: 0.05}, force: reactive,\n"
           "        motion: {prescribed: head, heave: 0.1, pitch: 10, pitch_phase: 70, frequency: 1, pivot: 0.2}}]\n"},
    {"prescribed body", SMALL "fish: [{motion: {prescribed: all, heave: 0.1, pitch: 10, frequency: 1}}]\n"},
    {"prescribed head, kutta rate, load",
     SMALL CONTINUOUS "sheet: {kutta: rate}\n"
                      "fish: [{load: {tip: [1, 2]}, motion: {prescribed: head, heave: 0.1, frequency: 1}}]\n"},
    {"three fish", SMALL FAR "fluid: {velocity: [0.1, 0.05], shear: 0.2}\n"
                             "fish:\n  - {control: {law: heading, desired_heading: 150}}\n"
                             "  - {nodes: 5, length: 0.7, start: {position: [0.2, 0.5], heading: 170},\n"
                             "     force: reactive, drag: {law: linear_quadratic}, control: {law: averaged_heading}}\n"
                             "  - {nodes: 9, length: 1.2, start: {position: [0.1, -0.6], heading: 200},\n"
                             "     motion: {prescribed: head, heave: 0.1, frequency: 1}}\n"},
    {"three fish, reactive", TIME FAR
     "fluid: {velocity: [0.1, 0.05], shear: 0.2}\n"
     "defaults: {fish: {nodes: 5, sheet_points: 9, force: reactive, added_mass: {extent: depth}}}\nfish:\n  - {}\n"
     "  - {nodes: 5, length: 0.7, start: {position: [0.2, 0.5], heading: 170}}\n"
     "  - {nodes: 9, sheet_points: 11, force: published, start: {position: [0.1, -0.6], heading: 200}}\n"},
    {"three fish, kutta rate, midpoint, waypoints",
     SMALL FAR CONTINUOUS "sheet: {kutta: rate, collocation: midpoint}\n"
                          "fish:\n  - {control: {law: heading, waypoints: [[-3, 1]]}}\n"
                          "  - {nodes: 5, length: 0.7, start: {position: [0.2, 0.52], heading: 170}}\n"
                          "  - {nodes: 9, length: 1.2, start: {position: [0.1, -0.6], heading: 200},\n"
                          "     body: {second_moment: published, damping: curvature}, control: {law: heading}}\n"},
    {"two fish, polygon", SMALL FAR "sheet: {curve: polygon}\n"
                                    "fish:\n  - {control: {law: heading, desired_heading: 150}}\n"
                                    "  - {nodes: 5, length: 0.7, start: {position: [0.2, 0.5], heading: 170}}\n"},
    {"another smoothing and taper", SMALL "wake: {smoothing: 0.05, taper: 0.4, taper_beside: 0.1}\n" FISH},
    {"three fish, another taper",
     SMALL FAR "wake: {taper: 0.4, taper_beside: 0.1}\n"
               "fish:\n  - {control: {law: heading, desired_heading: 150}}\n"
               "  - {nodes: 5, length: 0.7, start: {position: [0.2, 0.5], heading: 170}}\n"
               "  - {nodes: 9, length: 1.2, start: {position: [0.1, -0.6], heading: 200}}\n"},
    {"pressure", PRESSURE "fish: [{nodes: 5, sheet_points: 9, force: pressure, pressure: {span: infinite}}]\n"},
    {"pressure, less suction, quadratic skin and cross-flow drag, stream, shear, gust, bias",
     PRESSURE "fluid: {velocity: [0.3, -0.2], shear: 0.7, gust: {amplitude: 0.4, frequency: 1.3}}\n"
              "fish: [{nodes: 5, sheet_points: 9, force: pressure, pressure: {span: infinite, suction: 0.4},\n"
              "        drag: {skin: quadratic, tangential: 0.1, normal: 0.7}, control: {bias: 0.2}}]\n"},
    {"pressure, a depth for every edge, heading", PRESSURE
     "fish: [{nodes: 5, sheet_points: 9, force: pressure, pressure: {span: infinite}, drag: {skin: laminar, normal: "
     "0.5},\n"
     "        body: {profile: table, thickness_table: [0.1, 0.2, 0.15, 0.05],\n"
     "               depth_table: [0.2, 0.3, 0.25, 0.1]},\n"
     "        control: {law: heading, feedforward: 0, desired_heading: 150}}]\n"},
    {"pressure, a boundary layer with transition, waving and form",
     PRESSURE "fluid: {viscosity: 1.0e-4, velocity: [0.3, -0.2], shear: 0.7}\n"
              "fish: [{nodes: 5, sheet_points: 9, force: pressure, pressure: {span: infinite}, body: {modulus: "
              "1.0e+4}, control: {bias: 0.2},\n"
              "        drag: {skin: boundary_layer, transition: 5000, waving: 1.7, form: 100, normal: 0.5}}]\n"},
    {"reactive, a turbulent boundary layer",
     SMALL "fish: [{sheet_points: 9, force: reactive, drag: {skin: boundary_layer, transition: 0, form: 100}}]\n"},
    {"pressure, clamped head", PRESSURE
     "fish: [{nodes: 5, sheet_points: 9, force: pressure, pressure: {span: infinite}, body: {section: mean, "
     "relaxation_time: 0.05},\n        load: {tip: [3, -2]},\n"
     "        motion: {prescribed: head, heave: 0.1, pitch: 10, pitch_phase: 70, frequency: 1, pivot: 0.2}}]\n"},
    {"pressure, prescribed body",
     PRESSURE "fish: [{nodes: 5, sheet_points: 9, force: pressure, pressure: {span: infinite},\n"
              "        motion: {prescribed: all, heave: 0.1, pitch: 10, frequency: 1}}]\n"},
    {"pressure, prescribed body that goes by its forces",
     PRESSURE "fish: [{nodes: 5, sheet_points: 9, force: pressure, pressure: {span: infinite},\n"
              "        motion: {prescribed: all, surge: free, heave: 0.1, pitch: 10, frequency: 1}}]\n"},
    {"four fish, one force each and a prescribed head", PRESSURE FAR
     "fluid: {velocity: [0.1, 0.05], shear: 0.2}\nfish:\n"
     "  - {nodes: 5, sheet_points: 9, force: pressure, pressure: {span: infinite}}\n"
     "  - {nodes: 5, sheet_points: 7, force: reactive, length: 0.7, start: {position: [0.2, 0.5], heading: 170}}\n"
     "  - {nodes: 4, sheet_points: 7, force: published, start: {position: [0.1, -0.6], heading: 200}}\n"
     "  - {nodes: 4, sheet_points: 7, force: pressure, pressure: {span: infinite}, start: {position: [0, 1.2]},\n"
     "     motion: {prescribed: head, surge: free, heave: 0.1, frequency: 1}}\n"},
    {"pressure of finite span",
     PRESSURE "fish: [{nodes: 5, sheet_points: 26, force: pressure, pressure: {span: finite},\n"
              "        body: {profile: uniform, thickness: 0.1}}]\n"},
    {"pressure of finite span, a depth for every edge, stream, shear, wall", PRESSURE
     "fluid: {velocity: [0.3, 0], shear: 0.7, walls: [-0.7]}\n"
     "fish: [{nodes: 5, sheet_points: 14, force: pressure, pressure: {span: finite},\n"
     "        drag: {skin: laminar, normal: 0.5},\n"
     "        body: {profile: table, thickness_table: [0.1, 0.2, 0.15, 0.05], depth_table: [0.5, 0.7, 0.6, 0.4]}}]\n"},
    {"two fish of finite span and two depths in a channel",
     PRESSURE FAR "fluid: {velocity: [0.3, 0], walls: [-0.7, 1.1]}\n"
                  "fish:\n"
                  "  - {nodes: 5, sheet_points: 26, force: pressure, pressure: {span: finite}, drag: {normal: 1}}\n"
                  "  - {nodes: 4, force: pressure, pressure: {span: finite}, body: {depth: 0.6},\n"
                  "     drag: {normal: 2, law: linear_quadratic},\n"
                  "     start: {position: [0.2, 0.5], heading: 170}}\n"},
    {"four fish of finite span, one force each, two depths", PRESSURE FAR
     "fluid: {velocity: [0.1, 0.05], shear: 0.2}\nfish:\n"
     "  - {nodes: 5, sheet_points: 26, force: pressure, pressure: {span: finite}}\n"
     "  - {nodes: 5, sheet_points: 15, force: reactive, length: 0.7, start: {position: [0.2, 0.5], heading: 170}}\n"
     "  - {nodes: 4, sheet_points: 7, force: published, start: {position: [0.1, -0.6], heading: 200}}\n"
     "  - {nodes: 4, force: pressure, pressure: {span: finite}, start: {position: [0, 1.2]},\n"
     "     body: {depth: 0.5}, motion: {prescribed: head, surge: free, heave: 0.1, frequency: 1}}\n"},
    {"two fish with pressure, a sine gust",
     PRESSURE FAR "fluid: {velocity: [0.3, -0.2], gust: {profile: sine, amplitude: 0.4, wavelength: 1.6, speed: 0.5}}\n"
                  "fish:\n"
                  "  - {nodes: 5, sheet_points: 9, force: pressure, pressure: {span: infinite}, drag: {normal: 0.7}}\n"
                  "  - {nodes: 5, sheet_points: 9, force: pressure, pressure: {span: infinite}, start: {position: "
                  "[0.2, 0.6], heading: 190}}\n"},
    {"finite span, a step gust, a stream across",
     PRESSURE "fluid: {velocity: [0, 0.3], shear: 0.2,\n"
              "        gust: {profile: step, amplitude: 0.4, position: 0.1, gradient_distance: 0.6}}\n"
              "fish: [{nodes: 5, sheet_points: 26, force: pressure, pressure: {span: finite}}]\n"},
    {"force published, a sine gust",
     SMALL "fluid: {velocity: [0.3, 0], gust: {profile: sine, amplitude: 0.4, wavelength: 1.6}}\n"
           "fish: [{sheet_points: 9, force: published, control: {law: heading}}]\n"},
    {"two fish of finite span beside a wall, driven",
     TIME FAR "fluid: {walls: [1.5]}\n"
              "defaults: {fish: {force: pressure, pressure: {span: finite}, drag: {skin: laminar}}}\nfish:\n"
              "  - {nodes: 5, sheet_points: 26, motion: {prescribed: all, heave: 0.1, pitch: 10, frequency: 1}}\n"
              "  - {nodes: 5, sheet_points: 26, length: 0.7, start: {position: [0.2, 0.5], heading: 170}}\n"},
    {"fish in contact that are not coupled otherwise",
     SMALL "solver: {coupling_distance: 0}\ncontact: {range: 0.9}\n"
           "fish:\n  - {control: {law: heading, desired_heading: 150}}\n"
           "  - {nodes: 5, length: 0.7, start: {position: [0.2, 0.6], heading: 190}}\n"},
    {"three fish in contact, one of them prescribed",
     SMALL "solver: {coupling_distance: 100}\nfluid: {density: 0}\ncontact: {range: 0.9}\n"
           "fish:\n  - {}\n"
           "  - {nodes: 5, length: 0.7, start: {position: [0.2, 0.6], heading: 190}}\n"
           "  - {nodes: 9, start: {position: [0.1, -0.6], heading: 170},\n"
           "     motion: {prescribed: head, heave: 0.1, frequency: 1}}\n"},
    {"a wall", SMALL "fluid: {velocity: [0.3, 0], shear: 0.2, walls: [-0.5]}\n" FISH},
    {"a wall above, in contact, free sheet",
     SMALL "fluid: {walls: [0.9]}\ncontact: {range: 0.8}\n"
           "wake: {shedding: sheet, smoothing: 0.1, taper: 0.4, taper_beside: 0.1}\n" FISH},
    {"a wall, kutta rate, midpoint",
     SMALL "fluid: {walls: [-0.5]}\nwake: {shedding: continuous}\nsheet: {kutta: rate, collocation: midpoint}\n" FISH},
    {"two fish in a channel, free sheets, one in contact",
     SMALL FAR "fluid: {velocity: [0.3, 0], shear: 0.2, walls: [-0.6, 1.1]}\n"
               "wake: {shedding: sheet, taper: 0.4, taper_beside: 0.1}\nsheet: {curve: smooth}\nfish:\n"
               "  - {}\n"
               "  - {nodes: 5, length: 0.7, start: {position: [0.2, 0.5], heading: 170}}\n"},
    {"two fish in a channel, one held",
     SMALL FAR "fluid: {walls: [-0.7, 1.2]}\n"
               "fish:\n  - {motion: {prescribed: head, heave: 0.1, frequency: 1}}\n"
               "  - {nodes: 5, length: 0.7, start: {position: [0.2, 0.5], heading: 170}}\n"},
    {"pressure in a channel",
     PRESSURE "fluid: {walls: [-0.5, 0.8]}\ncontact: {range: 0.6}\n"
              "fish: [{nodes: 5, sheet_points: 9, force: pressure, pressure: {span: infinite}}]\n"},
    {"two fish, impulsive", TIME FAR "preset: published\n"
                                     "fish:\n  - {}\n"
                                     "  - {nodes: 5, start: {position: [0.2, 0.5]}}\n"},
};

static const struct residual_mode impulse = {.shed = SHED_BY_IMPULSE};

static void value_of_school(struct setup *setup, const double *y, const double *yp, double *value) {
    school_ok(residual_evaluate(setup->residual, setup->mode, setup->t, y, yp, value));
}

TEST(jacobian_agrees_with_differences_for_every_option) {
    for (size_t i = 0; i < sizeof variants / sizeof *variants; i++) {
        struct setup setup = setup_stirred(variants[i].text);
        school_compare(&setup, value_of_school, NULL, variants[i].name);
        if (setup.school->shedding == SHEDDING_IMPULSIVE) {
            setup.mode = &impulse;
            school_compare(&setup, value_of_school, NULL, variants[i].name);
        }
    }
}

// Below, at, and above the leading-edge parameter that the bodies have; they are soft, so that the derivatives by the
// places are those of the fluid. In a channel, with a second fish.
TEST(jacobian_agrees_with_differences_where_the_suction_ends) {
    static const char text[] = TIME FAR
        "wake: {shedding: sheet, smoothing: 0.1, taper: 0.4, taper_beside: 0.1}\nsheet: {curve: smooth}\n"
        "fluid: {velocity: [0.3, 0], shear: 0.7, walls: [-1.2, 1.3]}\n"
        "defaults: {fish: {nodes: 5, sheet_points: 9, force: pressure, pressure: {span: infinite}, body: {modulus: "
        "1}}}\nfish: [{}, {start: {position: [0.2, 0.5], heading: 170}}]\n";
    const double factor[] = {0.3, 0.9, 1, 1.1, 2};
    for (size_t i = 0; i < sizeof factor / sizeof *factor; i++) {
        struct setup setup = setup_stirred(text);
        value_of_school(&setup, setup.state->y, setup.state->yp, setup.value);
        for (int f = 0; f < 2; f++) {
            const double about[2] = {0, 0};
            const struct pressure_forces forces =
                pressure_sum(setup.residual->force[f].pressure, about, setup.state->y);
            setup.school->fish[f].suction_limit = factor[i] * fabs(forces.leading_edge_a0);
        }
        school_compare(&setup, value_of_school, NULL, "limited suction");
    }
}

// The newest markers lie beside the bodies, ahead of their tails; in a channel, with a second fish.
static void compare_overtaken(const char *keys, bool with_legs) {
    struct setup setup =
        setup_with(TIME FAR
                   "wake: {shedding: sheet, smoothing: 0.1, taper: 0.4, taper_beside: 0.1}\nsheet: {curve: smooth}\n"
                   "fluid: {walls: [-1.2, 1.3]}\ndefaults: {fish: {nodes: 5, %s, force: pressure}}\n"
                   "fish: [{}, {start: {position: [0.2, 0.5], heading: 170}}]\n",
                   keys);
    school_stir(&setup);
    for (int f = 0; f < 2; f++) {
        const struct fish *const fish = &setup.school->fish[f];
        struct wake *const wake = &setup.state->wake[f];
        const double *const t = wake->tail_tangent, *const y = setup.state->y;
        wake->x[5] = y[fish->at.x + 4] - 0.2 * t[0] - 0.1 * t[1];
        wake->y[5] = y[fish->at.y + 4] - 0.2 * t[1] + 0.1 * t[0];
        wake->version++;
    }
    school_compare(&setup, value_of_school, NULL, "overtaken");
    const struct flow *const flow = setup.residual->flow;
    for (int f = 0; f < 2; f++) {
        assert_int_equal(flow->kernel->has_legs, with_legs);
        assert_true(flow->fish[f].wake.graded.end.is_overtaken);
    }
}

TEST(jacobian_agrees_with_differences_where_a_tail_has_overtaken_its_wake) {
    compare_overtaken("sheet_points: 9, pressure: {span: infinite}, body: {modulus: 1}", 0);
    compare_overtaken("sheet_points: 26, pressure: {span: finite}, body: {modulus: 1}", 1);
    // the depth varies: force of the side edges
    compare_overtaken(
        "sheet_points: 26, pressure: {span: finite}, body: {modulus: 1, profile: table, "
        "thickness_table: [0.1, 0.2, 0.15, 0.05], depth_table: [0.5, 0.7, 0.6, 0.4]}",
        1);
}

TEST(far_fish_are_left_out_of_the_jacobian_and_of_nothing_else) {
    const char *const text = SMALL "solver: {coupling_distance: 0.6}\nfish: [{}, {start: {position: [0, 1]}}]\n";
    struct setup setup = setup_of(text);
    const struct layout *a = &setup.school->fish[0].at, *b = &setup.school->fish[1].at;
    const size_t n = (size_t)setup.school->n_unknowns;
    assert_int_equal(setup.residual->couplings.coupled[1], 0);
    school_ok(residual_jacobian(setup.residual, &residual_run, 0, 1, setup.state->y, setup.jacobian));
    double *dense = school_dense_jacobian(test_arena(), setup.jacobian);
    for (int row = a->x; row < a->end; row++) {
        for (int column = b->x; column < b->end; column++) NEAR(dense[(size_t)row * n + (size_t)column], 0, 0, 0);
    }
    // closer by 0.5: coupled, which is another pattern; asked again nothing has changed
    for (int k = 0; k < 5; k++) setup.state->y[b->y + k] -= 0.5;
    const unsigned pattern = setup.residual->couplings.pattern;
    residual_couple(&setup.residual->couplings, setup.state->y);
    assert_int_equal(setup.residual->couplings.pattern, pattern + 1);
    residual_couple(&setup.residual->couplings, setup.state->y);
    assert_int_equal(setup.residual->couplings.pattern, pattern + 1);
    school_ok(residual_jacobian(setup.residual, &residual_run, 0, 1, setup.state->y, setup.jacobian));
    dense = school_dense_jacobian(test_arena(), setup.jacobian);
    ABOVE(fabs(dense[(size_t)a->gamma * n + (size_t)b->gamma]), 1e-4);
}

TEST(unknowns_have_names_kinds_and_scales) {
    struct setup setup = setup_of(
        TIME
        "defaults: {fish: {force: reactive}}\nfish: [{nodes: 4},\n"
        "  {length: 2, nodes: 5, body: {section: nodes}, start: {position: [0, 1]}, motion: {prescribed: head, heave: "
        "0.1, frequency: 1}}]\n");
    const struct layout *a = &setup.school->fish[0].at, *b = &setup.school->fish[1].at;
    const struct {
        int i;
        double kind;
    } want[] = {{a->x, 1},     {a->vy + 3, 1}, {a->ax + 1, 0}, {a->gamma + 4, 0}, {a->circulation, 0}, {a->phi0, 0},
                {b->x + 1, 0}, {b->y + 2, 1},  {b->vx + 1, 0}, {b->vx + 2, 1},    {b->circulation, 0}};
    double kind[160];
    AT_MOST(setup.school->n_unknowns, 160);
    residual_kinds(setup.residual, &residual_run, kind);
    for (size_t k = 0; k < sizeof want / sizeof *want; k++) NEAR(kind[want[k].i], want[k].kind, 0, 0);
    // every slice in turn, with scales of the dimension of its unknowns: a fish of twice the length and three times the
    // beat, with the added momenta of the same shape
    school_build(&setup, TIME
                 "defaults: {fish: {force: pressure, nodes: 5, sheet_points: 26}}\n"
                 "fish: [{}, {length: 2, wave: {frequency: 3}, start: {position: [0, 3]}}]\n");
    static const char *const names[] = {"x", "y", "vx", "vy", "px", "py", "ax", "ay", "gamma", "circulation", "phi0"};
    a = &setup.school->fish[0].at;
    const int first[] = {a->x,  a->y,  a->vx,    a->vy,          a->px,   a->py,
                         a->ax, a->ay, a->gamma, a->circulation, a->phi0, a->end};
    const double units[] = {2, 2, 6, 6, 6, 6, 18, 18, 6, 12, 1};
    for (int s = 0; s < 11; s++) {
        for (int i = first[s]; i < first[s + 1]; i++) {
            const struct unknown_place place = residual_place(setup.school, i);
            assert_int_equal(place.kind, (enum unknown)s);
            assert_int_equal(place.fish, 0);
            assert_int_equal(residual_place(setup.school, i + a->end).fish, 1);
            assert_int_equal(place.index, i - first[s]);
            assert_int_equal(place.component, s < UNKNOWN_GAMMA ? s % 2 : 0);
            assert_string_equal(place.name, names[s]);
            NEAR(residual_scale(setup.school, i + a->end), units[s] * residual_scale(setup.school, i), 0, 1e-14);
            NEAR(residual_undamped(setup.school, i), s >= UNKNOWN_VX && s <= UNKNOWN_PY ? 1 / 3e3 : 1, 0, 1e-15);
        }
    }
    // velocities of methods without damping: ten times the scale of the positions in the time 1/f, f = 1 Hz
    NEAR(residual_scale(setup.school, a->vx) * residual_undamped(setup.school, a->vx),
         10 * residual_scale(setup.school, a->x), 0, 1e-14);
}

TEST(circulation_shed_is_differential_only_with_a_rate) {
    const struct {
        const char *text;
        int algebraic, algebraic_at_impulse;
    } cases[] = {{SMALL FISH, 1, 1},
                 {SMALL CONTINUOUS "sheet: {kutta: rate}\n" FISH, 0, 0},
                 {SMALL "wake: {shedding: impulsive}\n" FISH, 0, 1},
                 {SMALL "wake: {shedding: impulsive}\nsheet: {kutta: rate}\n" FISH, 0, 0}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct setup setup = setup_of(cases[i].text);
        assert_int_equal(residual_shed_is_algebraic(setup.residual), cases[i].algebraic);
        assert_int_equal(residual_sheet_law(setup.residual, &impulse) == BOUND_SHEET_EDGE,
                         cases[i].algebraic_at_impulse);
    }
}

TEST(a_value_that_is_not_finite_asks_for_a_retry_and_says_where) {
    struct setup setup = setup_stirred(SMALL FISH);
    setup.state->y[setup.school->fish[0].at.phi0] = INFINITY;
    assert_int_equal(
        residual_evaluate(setup.residual, &residual_run, setup.t, setup.state->y, setup.state->yp, setup.value),
        STATUS_RETRY);
    assert_non_null(strstr(status_message(), "of fish fish1"));
}

TEST(rows_of_prescribed_nodes_vanish_on_their_motion_only) {
    struct setup setup = setup_stirred(
        SMALL
        "fish: [{start: {heading: 25}, motion: {prescribed: all, speed: 0.6, heave: 0.2, pitch: 20, pitch_phase: 70, "
        "frequency: 1.3}}]\n");
    const struct fish *const fish = setup.school->fish;
    double *const y = setup.state->y;
    fish_prescribe(fish, NULL, 1, setup.t, y);
    for (int k = 0; k < fish->n_nodes; k++) {
        double position[2], velocity[2], acceleration[2];
        fish_prescribed_node(fish, NULL, k, setup.t, position, velocity, acceleration);
        y[fish->at.ax + k] = acceleration[0];
        y[fish->at.ay + k] = acceleration[1];
    }
    school_ok(residual_evaluate(setup.residual, &residual_run, setup.t, y, setup.state->yp, setup.value));
    // the momenta of the fluid are no motion of the nodes
    for (int i = fish->at.x; i < fish->at.gamma; i++) {
        if (i < fish->at.px || i >= fish->at.ax) NEAR(setup.value[i], 0, 0, 0);
    }
    for (int i = fish->at.x; i < fish->at.gamma; i++) y[i] += 1e-3 * (i + 1);
    school_ok(residual_evaluate(setup.residual, &residual_run, setup.t, y, setup.state->yp, setup.value));
    for (int i = fish->at.x; i < fish->at.gamma; i++) {
        if (i < fish->at.px || i >= fish->at.ax) NEAR(setup.value[i], 1e-3 * (i + 1), 1e-13, 0);
    }
}

TEST(load_at_the_tip_accelerates_the_tail_only) {
    struct setup with, without;
    school_build(&with, SMALL "fish: [{load: {tip: [3, -2]}}]\n");
    school_build(&without, SMALL "fish: [{}]\n");
    school_stir(&with);
    school_stir(&without);
    school_ok(residual_evaluate(with.residual, &residual_run, with.t, with.state->y, with.state->yp, with.value));
    school_ok(residual_evaluate(without.residual, &residual_run, with.t, with.state->y, with.state->yp, without.value));
    const struct fish *fish = with.school->fish;
    without.value[fish->at.ax + 4] -= 3 / fish->mass[4];
    without.value[fish->at.ay + 4] += 2 / fish->mass[4];
    // rounding of accelerations of 1e5
    NEAR_ARRAY(with.school->n_unknowns, with.value, without.value, 1e-10, 1e-14);
}

static int n_coupled(const struct residual *residual) {
    int n = 0;
    const int n_fish = residual->school->n_fish;
    for (int i = 0; i < n_fish * n_fish; i++) n += residual->couplings.coupled[i];
    return n;
}

TEST(more_fish_couple_when_asked_until_all_do) {
    struct setup setup;
    // gaps of 0.5, 1.5, and 3 between those that are not neighbours
    school_build(&setup, TIME
                 "solver: {coupling_distance: 0.1}\n"
                 "fish: [{}, {start: {position: [1.5, 0]}}, {start: {position: [4, 0]}}]\n");
    struct residual *const residual = setup.residual;
    const double *const y = setup.state->y;
    assert_int_equal(n_coupled(residual), 3);
    assert_int_equal(residual_couple_more(&residual->couplings, y), 1);
    assert_int_equal(n_coupled(residual), 5);
    // a second call changes nothing
    residual_couple(&residual->couplings, y);
    assert_int_equal(n_coupled(residual), 5);
    assert_int_equal(residual_couple_more(&residual->couplings, y), 1);
    assert_int_equal(n_coupled(residual), 7);
    assert_int_equal(residual_couple_more(&residual->couplings, y), 1);
    assert_int_equal(n_coupled(residual), 9);
    assert_int_equal(residual_couple_more(&residual->couplings, y), 0);
    assert_int_equal(n_coupled(residual), 9);
}
