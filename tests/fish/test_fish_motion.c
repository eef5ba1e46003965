/* test_fish_motion.c: A prescribed motion moves a straight body as doc/model.md, section 5, says, and its velocity and
 * acceleration are exact derivatives. */
#include "fish/fish_motion.h"
#include "school.h"

#define TIME "time: {end: 1, shedding_interval: 0.02, output_interval: 0.02}\n"
#define SMALL TIME "defaults: {fish: {nodes: 7}}\n"

static const double pi = 3.14159265358979323846;

TEST(prescribed_velocity_and_acceleration_are_derivatives) {
    struct setup setup =
        setup_of(SMALL
                 "fish: [{start: {heading: 20}, motion: {prescribed: all, speed: 0.6, heave: 0.2, pitch: 25, "
                 "pitch_phase: 70, frequency: 1.3, phase: 15, pivot: 0.3}}]\n");
    const struct fish *fish = &setup.school->fish[0];
    const double h = 1e-4;
    for (int k = 0; k < fish->n_nodes; k++) {
        double p[3][2], v[3][2], a[3][2];
        for (int i = 0; i < 3; i++) fish_prescribed_node(fish, NULL, k, 0.37 + (i - 1) * h, p[i], v[i], a[i]);
        for (int i = 0; i < 2; i++) {
            // truncation h^2/6 omega^3 with omega = 8
            NEAR(v[1][i], (p[2][i] - p[0][i]) / (2 * h), 1e-6, 0);
            NEAR(a[1][i], (v[2][i] - v[0][i]) / (2 * h), 1e-5, 0);
        }
    }
}

TEST(prescribed_body_is_straight_and_turns_about_its_pivot) {
    struct setup setup = setup_of(
        TIME
        "fish: [{nodes: 5, start: {heading: 180, speed: 2, position: [1, 1]}, motion: {prescribed: all, heave: "
        "0.2, pitch: 25, frequency: 1, pivot: 0.25}}]\n");
    const struct fish *fish = &setup.school->fish[0];
    // a quarter period on: heave and pitch are largest; left of the heading 180 degrees is downwards
    double p[2], v[2], a[2], q[2];
    fish_prescribed_node(fish, NULL, 1, 0.25, p, v, a);
    NEAR(p[0], 1 - 0.5 + 0.25, 1e-14, 0);
    NEAR(p[1], 1 - 0.2, 1e-14, 0);
    NEAR(v[0], -2, 1e-14, 0);
    NEAR(v[1], 0, 1e-14, 0);
    fish_prescribed_node(fish, NULL, 4, 0.25, q, v, a);
    // the body extends backwards from the pivot: the heading 205 degrees turned round
    NEAR(q[0] - p[0], 0.75 * cos(25 * pi / 180), 1e-14, 0);
    NEAR(q[1] - p[1], 0.75 * sin(25 * pi / 180), 1e-14, 0);
}

TEST(pitch_is_its_phase_before_heave) {
    struct setup setup =
        setup_of(SMALL
                 "fish: [{start: {heading: 0}, motion: {prescribed: all, heave: 0.2, pitch: 25, pitch_phase: 90, "
                 "frequency: 1}}]\n");
    const struct fish *fish = setup.school->fish;
    // pitch is largest, to the left, while heave begins: a quarter period later heave is largest and pitch is over
    const double t[] = {0, 0.25}, pitch[] = {25 * pi / 180, 0}, heave[] = {0, 0.2};
    for (int i = 0; i < 2; i++) {
        double nose[2], tail[2], v[2], a[2];
        fish_prescribed_node(fish, NULL, 0, t[i], nose, v, a);
        fish_prescribed_node(fish, NULL, fish->n_nodes - 1, t[i], tail, v, a);
        NEAR(atan2(nose[1] - tail[1], nose[0] - tail[0]), pitch[i], 1e-15, 0);
        // the pivot is the nose
        NEAR(nose[1], heave[i], 1e-15, 0);
    }
}
