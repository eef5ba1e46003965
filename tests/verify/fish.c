/* fish.c: the section "fish": the numbers of a default fish with the reactive force converge in the nodes and in the
 * stiffness, and do not depend on numerical parameters of the wake; the numbers of the default fish itself converge in
 * nodes, sheet points and shedding interval. doc/model.md, sections 1, 3, 9, 13, 18. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "steady/steady_search.h"
#include "verify.h"

struct swim {
    double speed, cost; /* m s-1, m s-2 */
};

// the steady state of a default fish with some keys; school: the other sections of the case
static struct swim steady_swim(const char *school, const char *keys) {
    char text[512];
    snprintf(text, sizeof text,
             "format: 1\n"
             "%sfish: [{%s}]\n",
             school, keys);
    struct verify_search search;
    verify_search_open(&search, text);
    verify_ok(steady_search_run(&search.problem));
    const struct steady_beat *const beat = &search.problem.map.last[0];
    const double mass = search.simulation->school->fish[0].total_mass;
    return (struct swim){beat->speed, beat->actuation / mass / beat->speed};
}

// the body for which the first version of the model was measured
#define BODY "defaults: {fish: {body: {thickness: 0.2, depth: 0.25, modulus: 1e6}}}\n"
#define FINE "solver: {rtol: 1e-5}\n" BODY "time: {end: 1}\n"
#define COARSE "solver: {rtol: 1e-5}\n" BODY "time: {end: 1, shedding_interval: 0.02}\n"
#define REACTIVE "force: reactive, "

// ---- nodes

static void refine(const char *modulus, const struct swim *limit, double speed_bound, double cost_bound) {
    static const int nodes[] = {13, 17, 25, 35, 49};
    enum { N = sizeof nodes / sizeof *nodes };
    struct swim swim[N];
    char keys[96];
    for (int i = 0; i < N; i++) {
        snprintf(keys, sizeof keys, REACTIVE "nodes: %d, body: {modulus: %s}", nodes[i], modulus);
        swim[i] = steady_swim(COARSE, keys);
        verify_point("fish_nodes", verify_text("speed [m/s], %s Pa", modulus), nodes[i], swim[i].speed);
    }
    const struct swim *const best = &swim[N - 1], *const standard = &swim[2];
    verify_relative(verify_text("%s Pa, 49 nodes: speed, m/s", modulus),
                    "extrapolated, by the first version of the model", limit->speed, best->speed, 1e-3);
    verify_relative(verify_text("%s Pa, 49 nodes: cost, m/s2", modulus),
                    "extrapolated, by the first version of the model", limit->cost, best->cost, 4e-3);
    verify_relative(verify_text("%s Pa, 25 nodes: speed, m/s", modulus), "49 nodes", best->speed, standard->speed,
                    speed_bound);
    verify_relative(verify_text("%s Pa, 25 nodes: cost, m/s2", modulus), "49 nodes", best->cost, standard->cost,
                    cost_bound);
    // 13, 25, 49: edges halved
    verify_order(verify_text("%s Pa, 13, 25, 49 nodes: speed", modulus), "flux and thickness at the tail itself",
                 verify_order_of_values(swim[0].speed, standard->speed, best->speed), 1.8, 5);
}

// ---- parameters without an effect on the fish

static void leave_out_the_wake(void) {
    const struct swim standard = steady_swim(COARSE, REACTIVE);
    static const double smoothing[] = {0.05, 0.4};
    for (int i = 0; i < 2; i++) {
        char school[256];
        snprintf(school, sizeof school, COARSE "wake: {smoothing: %g}\n", smoothing[i]);
        verify_relative(verify_text("wake.smoothing %g: speed, m/s", smoothing[i]), "smoothing 0.1: not felt",
                        standard.speed, steady_swim(school, REACTIVE).speed, 1e-4);
    }
}

// the same swimming motion at another frequency: modulus proportional to the square
static void scale(void) {
    const struct swim standard = steady_swim(FINE, REACTIVE);
    static const double frequency[] = {0.2, 4, 20};
    for (int i = 0; i < 3; i++) {
        const double f = frequency[i];
        char keys[96];
        snprintf(keys, sizeof keys, REACTIVE "wave: {frequency: %g}, body: {modulus: %.1f}", f, 1e6 * f * f);
        const struct swim swim = steady_swim(FINE, keys);
        verify_relative(verify_text("%g Hz: lengths per beat", f), "1 Hz", standard.speed, swim.speed / f, 1e-5);
        verify_relative(verify_text("%g Hz: cost over f^2, m", f), "1 Hz", standard.cost, swim.cost / (f * f), 1e-4);
    }
}

// ---- the default fish

// all lengths and the interval halved at once; bounds: the error bars of `shoal error cases/swim.yaml`
static void refine_all(void) {
    const struct swim standard = steady_swim("time: {end: 1}\n", "");
    const struct swim fine = steady_swim("time: {end: 1, shedding_interval: 0.005}\n", "nodes: 49, sheet_points: 137");
    static const char source[] = "49 nodes, 137 sheet points, half the interval";
    verify_relative("default fish: speed, m/s", source, fine.speed, standard.speed, 4.7e-3);
    verify_relative("default fish: cost, m/s2", source, fine.cost, standard.cost, 1.1e-2);
}

// ---- stiff bodies

// the cost of the last of eight beats from rest
static double cost_from_rest(double modulus, double rtol) {
    struct simulation *const simulation = verify_open(
        "format: 1\n" BODY "time: {end: 8}\nsolver: {rtol: %g}\nfish: [{" REACTIVE "body: {modulus: %g}}]\n", rtol,
        modulus);
    verify_run(simulation, 8);
    simulate_measure(simulation);
    const struct diagnostics_fish *const fish = &simulation->diagnostics->fish[0];
    const double cost = fish->cost_of_transport;
    verify_zero(verify_text("%.0e Pa, rtol %.0e: energy balance over work", modulus, rtol), "residual after 8 s",
                fish->energy_balance / fish->actuation_work, 1e-3);
    verify_point("fish_stiffness", "cost [m/s2]", modulus, cost);
    return cost;
}

static void stiffen(void) {
    const double limit = cost_from_rest(1e9, 1e-5);
    static const double moduli[] = {1e7, 1e8, 1e10, 1e11, 1e12};
    for (int i = 0; i < 5; i++) {
        verify_relative(verify_text("%.0e Pa, last of 8 beats: cost, m/s2", moduli[i]), "1e9 Pa", limit,
                        cost_from_rest(moduli[i], 1e-5), 0.01);
    }
    verify_relative("1e12 Pa, rtol 2e-4: cost, m/s2", "rtol 1e-6", cost_from_rest(1e12, 1e-6),
                    cost_from_rest(1e12, 2e-4), 5e-3);
}

void verify_fish(void) {
    if (verify_is_fast()) return;
    refine("1e6", &(struct swim){0.9372, 0.0730}, 2e-3, 6e-3);
    refine("1e8", &(struct swim){0.9272, 0.0622}, 4.5e-3, 1e-2);
    leave_out_the_wake();
    scale();
    stiffen();
    refine_all();
}
