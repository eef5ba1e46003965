/* control.c: The section "control" (model.md 11) compares the control laws of soft and stiff bodies with an explicit
 * method whose steps resolve every vibration. It also has a fish that swims to waypoints and one that holds its course
 * in a wake. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "verify.h"

// ---- stiff bodies

#define INTERVAL 0.02

// five beats per second: a period is over, and a course made, well before the end
#define STEERED                                                                                           \
    VERIFY_ARTICLE                                                                                        \
    "format: 1\ntime: {end: 1, shedding_interval: %g}\nsolver: {rtol: 1.0e-5, max_steps: 10000000, %s}\n" \
    "fluid: {velocity: [0.3, 0.2], shear: 2}\n"                                                           \
    "fish: [{sheet_points: 13, body: {modulus: %g}, wave: {frequency: 5, amplitude: 0.2},\n"              \
    "  control: {law: %s}}]\n"

struct steered {
    double place[14], phi0, largest_rate;
};

// final position of a body, and the rate of change of the bias from event to event
static struct steered steer(const char *law, double modulus, const char *solver, double end) {
    struct simulation *const simulation = verify_open(STEERED, INTERVAL, solver, modulus, law);
    const struct fish *const fish = simulation->school->fish;
    const double *const y = simulation->state->y;
    struct steered result = {.phi0 = y[fish->at.phi0]};
    for (double t = INTERVAL; t < end + INTERVAL / 2; t += INTERVAL) {
        verify_run(simulation, t);
        result.largest_rate = fmax(result.largest_rate, fabs(y[fish->at.phi0] - result.phi0) / INTERVAL);
        result.phi0 = y[fish->at.phi0];
    }
    memcpy(result.place, y + fish->at.x, sizeof result.place);
    return result;
}

// The bound is a little more than twice the error of ida at rtol 1e-5 on the worst of these bodies without a law.
static void compare(const char *name, const char *law, double modulus, double end) {
    static const char source[] = "ida at rtol 1e-5 and rk4 with steps that resolve all vibrations";
    // stable for stretching, and a whole part of the interval
    const double step = INTERVAL / ceil(INTERVAL / (1e-4 * fmin(5, sqrt(1e6 / modulus))));
    char solver[80];
    snprintf(solver, sizeof solver, "method: rk4, step: %.17g", step);
    const struct steered with = steer(law, modulus, "order: 2", end), against = steer(law, modulus, solver, end);
    double difference = 0;
    for (int k = 0; k < 14; k++) difference = fmax(difference, fabs(with.place[k] - against.place[k]));
    verify_zero(verify_text("law %s, %.0e Pa, %g s: nodes, m", name, modulus, end), source, difference, 2e-4);
    verify_zero(verify_text("law %s, %.0e Pa, %g s: phi0", name, modulus, end), source, with.phi0 - against.phi0, 2e-4);
    verify_show(verify_text("law %s, %.0e Pa, %g s: phi0 changes by, 1/s", name, modulus, end),
                "at most, from event to event", with.largest_rate);
}

static void stiff_bodies(void) {
    static const char heading[] = "heading, feedforward: 100, filter: 0.2, desired_heading: 160";
    static const char course[] = "course, desired_heading: 160";
    const double moduli[] = {1e4, 1e6, 1e8};
    const int n = verify_is_fast() ? 2 : 3;
    for (int i = 0; i < n; i++) {
        compare("heading", heading, moduli[i], 0.5);
        compare("course", course, moduli[i], 0.5);
    }
    compare("none", "none", 1e6, 0.5);
    // the stiffest take steps of 3e-7 s
    if (!verify_is_fast()) compare("heading", heading, 1e11, 0.3);
}

// ---- paths

static void waypoints(void) {
    if (verify_is_fast()) return;
    struct simulation *const simulation = verify_open(
        "format: 1\ntime: {end: 40, shedding_interval: 0.02}\n"
        "fish: [{control: {waypoints: [[-4, 1], [-8, -1], [-12, 0]]}}]\n");
    const struct state *const state = simulation->state;
    double t = 0;
    while (state->control[0].waypoint < 3 && t < 30) verify_run(simulation, t += 0.02);
    verify_value("law course, default fish: waypoints reached", "[-4, 1], [-8, -1], [-12, 0]; arrival 0.5 L", 3,
                 state->control[0].waypoint, 0);
    verify_show("law course, default fish: all reached at, s", "from rest", t);
}

static void course_in_a_wake(void) {
    if (verify_is_fast()) return;
    struct simulation *const simulation = verify_open(
        "format: 1\ntime: {end: 20, shedding_interval: 0.02}\n"
        "fish: [{control: {law: course, gain: 2}}, {start: {position: [2, 0.3]}, control: {law: course, gain: 2}}]\n");
    double most = 0;
    for (double t = 10; t < 20.01; t += 1) {
        verify_run(simulation, t);
        simulate_measure(simulation);
        most = fmax(most, fabs(simulation->diagnostics->fish[1].heading_error));
    }
    verify_zero("law course, in the wake of another: error, degree", "10 to 20 s, one-beat means", most, 2);
}

void verify_control(void) {
    stiff_bodies();
    waypoints();
    course_in_a_wake();
}
