/* test_sensor_pressure.c: The sensors have the pressure of potential theory on both sides of a body (doc/model.md,
 * section 15). */
#include <stdio.h>

#include "force/pressure.h"
#include "school.h"

static const double pi = 3.14159265358979323846;

// a straight body in steady motion: p = U^2/2 (1 - s/(s + r/2)), the pressure of a stagnation point at the nose
TEST(a_body_that_glides_reads_the_stagnation_pressure_at_the_nose) {
    struct simulation *const simulation = school_simulation(
        "time: {end: 1}\nfluid: {density: 2, velocity: [0.5, 0]}\n"
        "fish: [{force: pressure, pressure: {span: infinite}, sensors: [0, 0.1, 0.5, 1], wave: "
        "{amplitude: 0, frequency: 0},\n"
        "        start: {speed: 1}, body: {profile: uniform, thickness: 0.1},\n"
        "        motion: {prescribed: all}}]\n");
    school_measure(simulation, 0.5);
    const struct fish *const fish = simulation->school->fish;
    NEAR(fish->nose_radius, 0.005, 0, 1e-12);
    for (int i = 0; i < fish->n_sensors; i++) {
        const double s = fish->sensor[i], pressure = 2 * 1.5 * 1.5 / 2 * (1 - s / (s + 0.0025));
        for (int side = 0; side < 2; side++)
            NEAR(simulation->residual->force[0].pressure->sensor[side][i], pressure, 1e-9, 0);
    }
}

// ---- the rate of the potential by differences

/* A mirror image: sign -1 mirrors y; then a shift. */
struct mirror {
    double sign, shift;
};

// circulations of the bound vortices from the nose to vortex j
static double circulation_at(const struct fish *fish, int j, const double *y) {
    double sum = 0;
    const double theta = pi * j / fish->n_control;
    for (int i = 0; i < fish->n_sheet; i++) {
        double value = theta / pi;
        for (int m = 1; m <= fish->n_control; m++) {
            const double half = m == fish->n_control ? 0.5 : 1;
            value += 2 / pi * half * cos(m * pi * i / fish->n_control) * sin(m * theta) / m;
        }
        sum += value * fish->sheet_weight[i] * y[fish->at.gamma + i];
    }
    return sum;
}

/* A piece dx of the line from nose to tail and on along the wake, which carries a circulation. */
struct piece {
    double x[2], dx[2], circulation, half;
};

/* Potential at x of a piece and its images: in two dimensions C (r x dx)/(2 pi r^2), of a ring with the half span b
 * times b/sqrt(r^2 + B). The own strip has b = w/4, all other strips w/2. */
static double potential_of(const struct fish *own, int c, const struct fish *fish, const double x[2],
                           const struct piece *piece, int n_mirrors, const struct mirror *mirrors) {
    double sum = 0;
    for (int m = 0; m < n_mirrors; m++) {
        const struct mirror mirror = mirrors[m];
        const double r[2] = {x[0] - piece->x[0], x[1] - (mirror.sign * piece->x[1] + mirror.shift)};
        const double r2 = r[0] * r[0] + r[1] * r[1], cross = r[0] * mirror.sign * piece->dx[1] - r[1] * piece->dx[0];
        double ring = 1;
        if (fish->strip_depth > 0) {
            const bool is_own = fish == own && m == 0;
            ring =
                fish->strip_depth / (is_own ? 4 : 2) / sqrt(r2 + (is_own ? 1 : 4) * (own->point_half[c] + piece->half));
        }
        sum += mirror.sign * piece->circulation * cross / (2 * pi * r2) * ring;
    }
    return sum;
}

// mean of the potential of both sides at control point c of fish f: bodies and wakes of all fish and their images;
// wakes have decayed as at time t
static double potential(const struct simulation *simulation, double t, int f, int c, int n_mirrors,
                        const struct mirror *mirrors) {
    static const double eta[4] = {0.06943184420297371, 0.33000947820757187, 0.66999052179242813, 0.93056815579702629};
    static const double weight[4] = {0.17392742256872693, 0.32607257743127307, 0.32607257743127307,
                                     0.17392742256872693};
    const struct school *const school = simulation->school;
    const struct fish *const own = &school->fish[f];
    const double *const y = simulation->state->y;
    const double x[2] = {fish_mean(&own->control_point[c], y + own->at.x),
                         fish_mean(&own->control_point[c], y + own->at.y)};
    double sum = 0;
    for (int g = 0; g < school->n_fish; g++) {
        const struct fish *const fish = &school->fish[g];
        const struct wake *const wake = &simulation->state->wake[g];
        for (int j = 1; j < fish->n_control; j++) {
            const double theta = pi * j / fish->n_control;
            const double du = fish->n_edges / 2.0 * sin(theta) * pi / fish->n_control;
            const struct piece piece = {.x = {fish_mean(&fish->sheet_point[j], y + fish->at.x),
                                              fish_mean(&fish->sheet_point[j], y + fish->at.y)},
                                        .dx = {du * fish_mean(&fish->sheet_slope[j], y + fish->at.x),
                                               du * fish_mean(&fish->sheet_slope[j], y + fish->at.y)},
                                        .circulation = circulation_at(fish, j, y),
                                        .half = fish->strip_depth > 0 ? fish->sheet_half[j] : 0};
            sum += potential_of(own, c, fish, x, &piece, n_mirrors, mirrors);
        }

        for (int i = 0; i + 1 < wake->n_vortex; i++) {
            const double line[2] = {wake->x[i] - wake->x[i + 1], wake->y[i] - wake->y[i + 1]};
            const double left = wake_strength_within(school, t - wake->birth[i + 1], 0);
            for (int k = 0; k < 4; k++) {
                const double xi = eta[k] * eta[k], part = 2 * eta[k] * weight[k];
                const struct piece piece = {
                    .x = {wake->x[i + 1] + xi * line[0], wake->y[i + 1] + xi * line[1]},
                    .dx = {part * line[0], part * line[1]},
                    .circulation = -left * ((1 - xi) * wake->circulation[i + 1] + xi * wake->circulation[i]),
                    .half = fish->strip_depth * fish->strip_depth / 32};
                sum += potential_of(own, c, fish, x, &piece, n_mirrors, mirrors);
            }
        }
    }
    return sum;
}

// the rate of the potential at the skin of fish 0 at time t is the difference over two intervals, but for the decay
static void compare_with_differences(double t, const char *keys, const char *fish, int n_mirrors,
                                     const struct mirror *mirrors, double bound) {
    enum { MOST = 64 };
    struct simulation *const simulation = school_simulation_of(
        "time: {end: 1, shedding_interval: 0.0025}\nsolver: {rtol: 1e-7}\n"
        "wake: {smoothing: 1e-3, lifetime: 0.4, decay: 0.39}\nsheet: {smoothing: 1e-3}\n"
        "%sdefaults: {fish: {force: pressure, start: {speed: 0.5}, nodes: 9, sheet_points: 33, sensors: [0.5],\n"
        "                  wave: {ramp: 0.2}%s}}\nfish: [{}, {start: {position: [0.1, 0.4]}, wave: {phase: 70}}]\n",
        keys, fish);
    const struct fish *const of = simulation->school->fish;
    double before[MOST], rate[MOST], most = 0, error = 0;
    AT_MOST(of->n_control, MOST);

    school_run(simulation, t - 0.0025);
    for (int c = 0; c < of->n_control; c++) before[c] = potential(simulation, t, 0, c, n_mirrors, mirrors);
    school_measure(simulation, t);
    for (int c = 0; c < of->n_control; c++) rate[c] = simulation->residual->force[0].pressure->point[c].potential_rate;
    school_run(simulation, t + 0.0025);
    // the last two points are nearer to the tail than the stretches of an interval
    for (int c = 0; c < of->n_control - 2; c++) {
        const double difference = (potential(simulation, t, 0, c, n_mirrors, mirrors) - before[c]) / 0.005;
        assert_true(isfinite(rate[c]));
        most = fmax(most, fabs(difference));
        error = fmax(error, fabs(rate[c] - difference));
    }
    NEAR(error / most, 0, bound, 0);
}

TEST(the_rate_of_the_potential_is_its_difference_in_time) {
    static const struct mirror none[] = {{1, 0}}, wall[] = {{1, 0}, {-1, -0.6}};
    compare_with_differences(0.1, "", ", pressure: {span: infinite}", 1, none, 0.005);
    compare_with_differences(0.1, "", ", pressure: {span: finite}", 1, none, 0.005);
    compare_with_differences(0.5, "", ", pressure: {span: finite}", 1, none, 0.005);
    compare_with_differences(0.1, "fluid: {walls: [-0.3]}\n", ", pressure: {span: infinite}", 2, wall, 0.005);
    compare_with_differences(0.1, "fluid: {walls: [-0.3]}\n", ", pressure: {span: finite}", 2, wall, 0.005);
}

TEST(in_a_channel_the_rate_of_the_potential_is_its_difference_in_time) {
    enum { ROWS = 50 };
    static struct mirror mirrors[2 * (2 * ROWS + 1)];
    int n = 0;
    mirrors[n++] = (struct mirror){1, 0};
    for (int k = -ROWS; k <= ROWS; k++) {
        if (k != 0) mirrors[n++] = (struct mirror){1, 3.0 * k};
        mirrors[n++] = (struct mirror){-1, -0.6 + 3.0 * k};
    }
    compare_with_differences(0.1, "fluid: {walls: [-0.3, 1.2]}\n", ", pressure: {span: infinite}", n, mirrors, 0.008);
    compare_with_differences(0.1, "fluid: {walls: [-0.3, 1.2]}\n", ", pressure: {span: finite}", n, mirrors, 0.008);
}

// ---- sides

// the pressure on the right less the pressure on the left is the jump at a control point, up to the round nose
TEST(both_sides_differ_by_the_jump) {
    // sensors at the control points 12, 24 and 36
    struct simulation *const simulation = school_simulation(
        "time: {end: 1}\n"
        "fish: [{force: pressure, pressure: {span: infinite}, start: {speed: 0.5}, sensors: "
        "[0.15820385, 0.51635954, 0.86493204],\n"
        "        sheet_points: 49, body: {profile: uniform, thickness: 1e-3}, wave: {ramp: 0.2}},\n"
        "       {pressure: {span: infinite}, start: {position: [0.2, 0.4]}}]\n");
    school_measure(simulation, 0.5);
    struct pressure *const pressure = simulation->residual->force[0].pressure;
    for (int i = 0; i < 3; i++) {
        const int c = 12 * (i + 1);
        const double jump = pressure_jump(pressure, c, simulation->state->y, simulation->state->yp);
        NEAR(simulation->school->fish[0].sensor[i], (1 - cos(pi * (c + 0.5) / 48)) / 2, 0, 1e-6);
        NEAR(pressure->sensor[1][i] - pressure->sensor[0][i], jump, 0, 1e-4);
    }
}

// a school that is mirrored in x exchanges left and right
TEST(mirrored_fish_exchange_left_and_right) {
    struct simulation *two[2];
    for (int i = 0; i < 2; i++) {
        two[i] = school_simulation_of(
            "time: {end: 1}\n"
            "defaults: {fish: {force: pressure, pressure: {span: finite}, nodes: 9, start: {speed: 0.5}}}\n"
            "fish: [{sensors: [0.1, 0.7], wave: {phase: %d, ramp: 0.3}},\n"
            "       {start: {position: [0.2, %g]}, wave: {phase: %d, ramp: 0.3}}]\n",
            i == 0 ? 0 : 180, i == 0 ? 0.4 : -0.4, i == 0 ? 60 : 240);
        school_measure(two[i], 0.5);
    }
    for (int i = 0; i < 2; i++) {
        for (int side = 0; side < 2; side++) {
            const double one = two[0]->residual->force[0].pressure->sensor[side][i];
            NEAR(two[1]->residual->force[0].pressure->sensor[1 - side][i], one, 1e-6, 1e-6);
            ABOVE(fabs(one), 0.1);
        }
    }
}
