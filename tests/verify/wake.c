/* wake.c: the section "wake" has free vortices alone. The bound sheets have strength zero and shed nothing, so only
 * wakes move wakes, with the steps of the program: velocities at an event (flow.c), then motion to the next event
 * (wake.c).
 *
 * Two distant fish own the wakes: the checks concern the wake of the first fish; the wake of the second fish acts on
 * the first wake. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "flow/flow.h"
#include "flow/flow_at_wake.h"
#include "verify.h"

static const double pi = 3.14159265358979323846;
static const double delta = 0.2; /* smoothing, m: fish of length 1 m with the default of the case files */

static struct simulation *still_water(double interval) {
    return verify_open(
        VERIFY_ARTICLE
        "format: 1\ntime: {end: %.17g, shedding_interval: %.17g, output_interval: %.17g}\n"
        "wake: {smoothing: %.17g, lifetime: 1000, tolerance: 1e-8}\n"
        "defaults: {fish: {nodes: 4, sheet_points: 5, wave: {amplitude: 0}, motion: {prescribed: all, speed: 0}}}\n"
        "fish:\n  - start: {position: [1000, 0], speed: 0}\n  - start: {position: [2000, 0], speed: 0}\n",
        interval, interval, interval, delta);
}

static void release(struct simulation *simulation, int f, double x, double y, double circulation) {
    wake_release(&simulation->state->wake[f], x, y, circulation, 0);
}

/* One event and the following interval, as in event.c, for the wake of the first fish. */
static void step(struct simulation *simulation) {
    struct state *const state = simulation->state;
    struct wake *const wake = &state->wake[0];
    struct flow *const flow = simulation->residual->flow;
    flow_at_wake(flow, state);
    wake_set_velocity(wake, flow->wake_u, flow->wake_v, NULL, state->event == 0 ? wake->n_vortex : 0);
    wake_advance(wake, simulation->school->interval);
    state->event++;
    state->t = (double)state->event * simulation->school->interval;
}

static void steps(struct simulation *simulation, int n) {
    for (int i = 0; i < n; i++) step(simulation);
}

// ---- two vortices

static const double strength = 1, distance = 0.5; /* m2/s, m */

/* The vortices of the pair have one constant velocity: the path is a straight line, and every step is exact. */
static void opposite_pair(void) {
    const double interval = 0.1;
    const int n = 200;
    const double along[2] = {sin(0.7), -cos(0.7)}, across[2] = {cos(0.7), sin(0.7)}; /* the direction of motion */
    struct simulation *const simulation = still_water(interval);
    const struct wake *const wake = &simulation->state->wake[0];
    release(simulation, 0, distance / 2 * across[0], distance / 2 * across[1], strength);
    release(simulation, 0, -distance / 2 * across[0], -distance / 2 * across[1], -strength);
    steps(simulation, n);
    const double speed = strength * distance / (2 * pi * (distance * distance + delta * delta));
    const double mean[2] = {(wake->x[0] + wake->x[1]) / 2, (wake->y[0] + wake->y[1]) / 2};
    verify_relative("pair +-G: speed", "G d/(2 pi (d^2 + delta^2))", speed,
                    (mean[0] * along[0] + mean[1] * along[1]) / (n * interval), 1e-12);
    verify_zero("pair +-G: drift across, in distances d", "0, by symmetry",
                (mean[0] * across[0] + mean[1] * across[1]) / distance, 1e-12);
}

/* The angle by which two equal vortices have turned after the time 10 s, about three turns. */
static double turned(int n) {
    struct simulation *const simulation = still_water(10.0 / n);
    const struct wake *const wake = &simulation->state->wake[0];
    release(simulation, 0, distance / 2, 0, strength);
    release(simulation, 0, -distance / 2, 0, strength);
    double angle = 0;
    for (int i = 0; i < n; i++) {
        step(simulation);
        const double now = atan2(wake->y[0] - wake->y[1], wake->x[0] - wake->x[1]);
        angle += remainder(now - angle, 2 * pi);
    }
    return angle;
}

static void equal_pair(void) {
    const double exact = 10 * strength / (pi * (distance * distance + delta * delta));
    double error[5];
    for (int i = 0; i < 5; i++) {
        const int n = 250 << i;
        error[i] = turned(n) - exact;
        verify_point("wake_order", "two equal vortices, angle / rad", 10.0 / n, fabs(error[i]));
    }
    verify_relative("pair of equal vortices: angular speed, Dt = 0.0025 s", "G/(pi (d^2 + delta^2))", exact / 10,
                    (exact + error[4]) / 10, 1e-4);
    verify_order("pair of equal vortices: order in Dt", "the angle after 10 s",
                 verify_order_of_errors(error[3], error[4]), 1.9, 2.1);
}

// ---- a cloud of vortices

struct invariants {
    double circulation, impulse[2], angular, energy;
};

static struct invariants invariants(const struct wake *wake) {
    struct invariants sums = {0};
    for (int i = 0; i < wake->n_vortex; i++) {
        const double q = wake->circulation[i], x = wake->x[i], y = wake->y[i];
        sums.circulation += q;
        sums.impulse[0] += q * y;
        sums.impulse[1] -= q * x;
        sums.angular -= q * (x * x + y * y) / 2;
        for (int j = 0; j < i; j++) {
            const double rx = x - wake->x[j], ry = y - wake->y[j];
            sums.energy -= q * wake->circulation[j] * log(rx * rx + ry * ry + delta * delta) / (4 * pi);
        }
    }
    return sums;
}

/* Changes after 4 s in a cloud of twelve interacting vortices of both signs. */
static struct invariants change(int n) {
    struct simulation *const simulation = still_water(4.0 / n);
    const struct wake *const wake = &simulation->state->wake[0];
    for (int i = 0; i < 12; i++)
        release(simulation, 0, 0.6 * cos(2.4 * i), 0.4 * sin(1.7 * i + 0.3), 0.5 * cos(1.1 * i));
    const struct invariants before = invariants(wake);
    steps(simulation, n);
    const struct invariants after = invariants(wake);
    return (struct invariants){.circulation = after.circulation - before.circulation,
                               .impulse = {after.impulse[0] - before.impulse[0], after.impulse[1] - before.impulse[1]},
                               .angular = after.angular - before.angular,
                               .energy = after.energy - before.energy};
}

static void isolated_wake(void) {
    struct invariants changes[4];
    for (int i = 0; i < 4; i++) {
        const int n = 200 << i;
        changes[i] = change(n);
        verify_point("wake_order", "twelve vortices, angular impulse / m4 s-1", 4.0 / n, fabs(changes[i].angular));
        verify_point("wake_order", "twelve vortices, energy / m4 s-2", 4.0 / n, fabs(changes[i].energy));
    }
    verify_zero("twelve vortices: change of circulation, m2/s", "constant", changes[0].circulation, 0);
    verify_zero("twelve vortices: change of linear impulse, m3/s",
                "sum G (y, -x), constant: the velocities weighted with G cancel",
                hypot(changes[0].impulse[0], changes[0].impulse[1]), 1e-12);
    verify_zero("twelve vortices: change of angular impulse, Dt = 0.0025 s, m4/s", "-sum G r^2/2, constant",
                changes[3].angular, 1e-5);
    verify_order("twelve vortices: order in Dt of angular impulse", "-sum G r^2/2, constant",
                 verify_order_of_errors(changes[2].angular, changes[3].angular), 1.8, 2.2);
    verify_order("twelve vortices: order in Dt of energy", "-sum G G log(r^2 + delta^2)/(4 pi), constant",
                 verify_order_of_errors(changes[2].energy, changes[3].energy), 1.8, 2.2);
}

/* Old vortices are removed; the removed circulation is kept. */
static void removed_vortices(void) {
    struct simulation *const simulation = still_water(0.01);
    struct wake *const wake = &simulation->state->wake[0];
    double sum = 0;
    for (int i = 0; i < 1000; i++) {
        const double circulation = sin(0.1 * i) + 0.3;
        wake_release(wake, i, 0, circulation, 0.01 * i);
        sum += circulation;
    }
    wake_remove_old(wake, simulation->school, simulation->school->lifetime + 5);
    const int removed = 1000 - wake->n_vortex;
    verify_value("a thousand vortices, half grown old: number removed", "ages beyond the lifetime", 501, removed, 0);
    verify_zero("the same: change of circulation including removed vortices, m2/s", "constant",
                invariants(wake).circulation + wake->removed - sum, 1e-10);
}

// ---- a row of vortices

/* A flat row along x of strength g = 1 m/s, wavelength 1 m with 32 vortices; the wake of the first fish is one
 * wavelength, the wake of the second fish contains n_images more on either side, which move with the first wake. */
enum { PER_WAVE = 32 };
static const double kappa = 2 * 3.14159265358979323846;

static void place_images(struct simulation *simulation, int n_images) {
    const struct wake *const wake = &simulation->state->wake[0];
    struct wake *const images = &simulation->state->wake[1];
    int n = 0;
    for (int image = -n_images; image <= n_images; image++) {
        if (image == 0) continue;
        for (int i = 0; i < PER_WAVE; i++, n++) {
            images->x[n] = wake->x[i] + image;
            images->y[n] = wake->y[i];
        }
    }
}

static double exact_growth(void) {
    return 0.5 * sqrt(kappa * exp(-kappa * delta) * (1 - exp(-kappa * delta)) / delta);
}

/* The sine part of the vortices' height after n steps to the time t, from the growing mode of this amplitude. */
static double height(int n, double t, int n_images, double amplitude) {
    struct simulation *const simulation = still_water(t / n);
    struct wake *const wake = &simulation->state->wake[0];
    const double ahead = (1 - exp(-kappa * delta)) / (2 * delta * exact_growth()); /* x moves so much more than y */
    for (int i = 0; i < PER_WAVE; i++) {
        const double s = (i + 0.5) / PER_WAVE - 0.5, wave = amplitude * sin(kappa * s);
        release(simulation, 0, s - ahead * wave, wave, 1.0 / PER_WAVE);
    }
    for (int i = 0; i < 2 * n_images * PER_WAVE; i++) release(simulation, 1, 0, 0, 1.0 / PER_WAVE);
    for (int i = 0; i < n; i++) {
        place_images(simulation, n_images);
        step(simulation);
    }
    double sum = 0;
    for (int i = 0; i < PER_WAVE; i++) sum += 2.0 / PER_WAVE * wake->y[i] * sin(kappa * ((i + 0.5) / PER_WAVE - 0.5));
    return sum;
}

/* Growth rate of the difference of two rows, perturbed upwards and downwards: effects of the finite length and of even
 * powers of the amplitude cancel. */
static double growth(int n, int n_images) {
    const double t = 1, amplitude = 1e-6;
    return log((height(n, t, n_images, amplitude) - height(n, t, n_images, -amplitude)) / (2 * amplitude)) / t;
}

static void row(void) {
    static const char source[] = "sigma^2 = (g^2/4) kappa exp(-kappa delta)(1 - exp(-kappa delta))/delta";
    const double exact = exact_growth();
    const int n = verify_is_fast() ? 100 : 400, most = verify_is_fast() ? 64 : 256;
    double rate[2] = {0};  // of the last two
    for (int images = verify_is_fast() ? most / 2 : 8; images <= most; images *= 2) {
        rate[0] = rate[1];
        rate[1] = growth(n, images);
        verify_point("wake_row", "finite row", images, fabs(rate[1] / exact - 1));
    }
    verify_show("row of vortices: growth rate with the images summed, 1/s", source, rate[1]);
    // the missing images reduce the rate by 2/(pi^2 n): the limit of n to infinity from two sums
    verify_relative("row of vortices: growth rate, 1/s", source, exact, 2 * rate[1] - rate[0], 1e-4);
    verify_order("row of vortices: order in the number of images", "1/n is missing beyond n images",
                 verify_order_of_errors(rate[0] - exact, rate[1] - exact), 0.9, 1.1);
}

void verify_wake(void) {
    opposite_pair();
    equal_pair();
    isolated_wake();
    removed_vortices();
    row();
}
