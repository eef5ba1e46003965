/* depth.c: the section "depth": sheets of finite span (doc/model.md, section 18) between the slender body and two
 * dimensions. Length L = 1 m, density 1. */
#include <math.h>

#include "verify.h"

static const double pi = 3.14159265358979323846;

// a plate that heaves in a stream of 1 m/s
static struct simulation *heave(const char *span, double depth, double amplitude, const char *wake) {
    return verify_open(VERIFY_DEFAULTS
                       "format: 1\n"
                       "time: {end: 5}\n"
                       "fluid: {density: 1, viscosity: 0, velocity: [1, 0]}\n"
                       "wake: {%s}\n"
                       "fish: [{nodes: 9, sheet_points: 33, force: pressure, wave: {amplitude: 0, frequency: 0},\n"
                       "        pressure: {span: %s, suction_limit: 0},\n"
                       "        body: {profile: uniform, thickness: 0.02, depth: %.17g},\n"
                       "        motion: {prescribed: all, heave: %.17g, frequency: 0.8}}]\n",
                       wake, span, depth, amplitude);
}

/* Thrust m (v^2 - U^2 y'^2)/2 and power m U v^2 of a slender body by the motion of the tail, m = pi rho w^2/4. */
static void check_slender(void) {
    const double depth = 0.25, amplitude = 0.03, square = pow(amplitude * 2 * pi * 0.8, 2) / 2;
    const double mass = pi * depth * depth / 4;
    struct simulation *const simulation = heave("finite", depth, amplitude, "lifetime: 3.75");
    verify_run(simulation, 5);
    simulate_measure(simulation);
    const struct diagnostics_fish *const of = simulation->diagnostics->fish;
    verify_relative("plate in heave, w/L = 0.25: mean thrust", "Lighthill", mass * square / 2, of->mean_thrust, 0.03);
    verify_relative("plate in heave, w/L = 0.25: mean power", "Lighthill", mass * square, of->mean_power, 0.03);
    simulate_free(simulation);
}

static void check_deep(void) {
    static const char kept[] = "lifetime: 100, decay: 0";
    struct simulation *const deep = heave("finite", 1e4, 0.175, kept), *const plane =
                                                                           heave("infinite", 1e4, 0.175, kept);
    double most = 0, largest = 0;
    for (int i = 1; i <= 10; i++) {
        verify_run(deep, 0.25 * i);
        verify_run(plane, 0.25 * i);
        const int shed = deep->school->fish[0].at.circulation;
        most = fmax(most, fabs(deep->state->y[shed] - plane->state->y[shed]));
        largest = fmax(largest, fabs(plane->state->y[shed]));
    }
    verify_zero("plate in heave, w/L = 10000: circulation shed less that in two dimensions", "two dimensions",
                most / largest, 1e-6);
    simulate_free(deep);
    simulate_free(plane);
}

// the momentum of a fish, and of two of different depth, is found in the fluid
static void check_momentum(const char *name, const char *fish, double bound) {
    struct simulation *const simulation = verify_open(VERIFY_DEFAULTS
                                                      "format: 1\n"
                                                      "time: {end: 2}\n"
                                                      "fluid: {viscosity: 0}\n"
                                                      "defaults: {fish: {force: pressure, start: {speed: 0.5},\n"
                                                      "  pressure: {span: finite, suction_limit: 0}}}\n"
                                                      "fish: [%s]\n",
                                                      fish);
    double most = 0, momentum = 0;
    for (int i = 1; i <= 20; i++) {
        verify_run(simulation, 0.1 * i);
        simulate_measure(simulation);
        const struct diagnostics *const now = simulation->diagnostics;
        double sum = 0;
        for (int f = 0; f < simulation->school->n_fish; f++) {
            sum += simulation->school->fish[f].total_mass *
                   hypot(now->fish[f].com_velocity[0], now->fish[f].com_velocity[1]);
        }
        most = fmax(most, hypot(now->momentum_balance[0], now->momentum_balance[1]));
        momentum = fmax(momentum, sum);
    }
    verify_zero(name, "momentum of bodies and rings", most / momentum, bound);
    simulate_free(simulation);
}

// The wake of a slow slender fish stays at the tail. A strip that is not rolled up there breaks up: labels grow to 6
// times the circulation shed, and the fish diverges.
static void check_slow_start(void) {
    struct simulation *const simulation = verify_open(VERIFY_DEFAULTS
                                                      "format: 1\n"
                                                      "time: {end: 5}\n"
                                                      "fish: [{force: pressure, body: {depth: 0.05},\n"
                                                      "        start: {speed: 0}, pressure: {span: finite}}]\n");
    double label = 0, shed = 0;
    for (int i = 1; i <= 100; i++) {
        verify_run(simulation, 0.05 * i);
        const struct wake *const wake = &simulation->state->wake[0];
        for (int k = 0; k < wake->n_vortex; k++) label = fmax(label, fabs(wake->circulation[k]));
        shed = fmax(shed, fabs(simulation->state->y[simulation->school->fish[0].at.circulation]));
    }
    verify_ratio("a fish from rest, w/L = 0.05: largest label of the wake", "circulation shed", shed, label, 0, 1.5);
    simulate_free(simulation);
}

void verify_depth(void) {
    check_slender();
    check_deep();
    check_momentum("a fish, w/L = 0.25: momentum lost", "{}", 1e-3);
    check_momentum("two fish, w = 0.25 and 0.4 m: momentum lost",
                   "{}, {body: {depth: 0.4}, start: {position: [0.3, 0.4]}}", 1e-3);
    check_slow_start();
}
