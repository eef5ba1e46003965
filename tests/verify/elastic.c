/* elastic.c: the section "elastic": flexible plates under the pressure of the bound sheet, against linear theory: the
 * threshold of flutter, and plates with a heaving clamped nose.
 *
 * Lengths in L, speeds in U, density of the fluid and span 1; the plate is at rest in a stream. Mass and bending
 * stiffness belong to elliptic sections; linear theory neglects the thickness. */
#include <complex.h>
#include <math.h>
#include <stdlib.h>

#include "linear_theory.h"
#include "steady/steady_modes.h"
#include "steady/steady_problem.h"
#include "steady/steady_static.h"
#include "verify.h"

static const double pi = 3.14159265358979323846;

enum { N_FRACTION = 100 /* events per unit of time: U Dt = 0.01 L */ };

// ---- plates

/* Points of body and sheet, the taper of the wake in L, the tolerance. */
struct setting {
    int n_nodes, n_sheet;
    double taper, rtol;
};

static struct setting usual(int n_nodes) {
    return (struct setting){n_nodes, 2 * n_nodes - 1, 0.4, 1e-5};
}

/* A plate with a clamped nose in a stream of speed 1: body as in linear theory, motion: further keys of the motion. */
static struct simulation *open_plate(const struct setting *setting, double end, const struct linear_theory_body *body,
                                     double heading, const char *motion) {
    const double thickness = 0.1;
    return verify_open(
        "format: 1\ntime: {end: %.17g, shedding_interval: %.17g}\n"
        "fluid: {density: 1, viscosity: 0, velocity: [1, 0]}\nwake: {lifetime: 1000, taper: %g}\n"
        "solver: {rtol: %g}\nfish:\n  - {nodes: %d, sheet_points: %d, " VERIFY_ATTACHED
        ", wave: {amplitude: 0},\n"
        "     body: {profile: uniform, thickness: %g, depth: 1, density: %.17g, modulus: %.17g,\n"
        "            relaxation_time: 0},\n"
        "     start: {heading: %.17g, speed: 0}, motion: {prescribed: head, speed: 0%s}}\n",
        end, 1.0 / N_FRACTION, setting->taper, setting->rtol, setting->n_nodes, setting->n_sheet, thickness,
        body->mass / (pi / 4 * thickness), body->stiffness / (pi / 64 * pow(thickness, 3)), heading, motion);
}

static double height(const struct simulation *simulation, int node) {
    return simulation->state->y[simulation->school->fish[0].at.y + node];
}

// the tail above the nose, from the event after the start on; frees the simulation
static void follow_tail(struct simulation *simulation, int n, double *tail) {
    for (int i = 0; i < n; i++) {
        verify_run(simulation, (i + 1.0) / N_FRACTION);
        tail[i] = height(simulation, simulation->school->fish[0].n_nodes - 1) - height(simulation, 0);
    }
}

// ---- flutter

/* Growth rate of the mode with the frequency nearest to a given frequency, from the equilibrium along the stream. */
static double growth_of(int n_nodes, double mass_ratio, double speed, double *frequency) {
    const struct linear_theory_body body = {1 / mass_ratio, 1 / mass_ratio / (speed * speed)};
    // the sheet is straight: a longer taper costs nothing, and halves the error of the shedding
    const struct setting setting = {n_nodes, 2 * n_nodes - 1, 0.8, 1e-5};
    struct simulation *const simulation = open_plate(&setting, 1, &body, 180, "");
    double rate[STEADY_QUANTITIES], omega[STEADY_QUANTITIES];
    struct steady_fish fish;
    struct steady_values found = {.fish = &fish, .rate = rate, .omega = omega};
    verify_ok(steady_static_find(simulation, NULL, &found));
    verify_ok(steady_modes_find(simulation, &found));
    int best = -1;
    for (int i = 0; i < found.n_exponents; i++) {
        const double here = fabs(omega[i] / (2 * pi) - *frequency);
        if (best < 0 || here < fabs(omega[best] / (2 * pi) - *frequency)) best = i;
    }
    if (best < 0) verify_ok(status_fail(STATUS_SOLVER, "the plate has no modes"));
    *frequency = omega[best] / (2 * pi);
    return rate[best];
}

/* U* of zero growth: secants from the theoretical threshold and a value 0.5 % above. */
static struct linear_theory_threshold measure(int n_nodes, double mass_ratio,
                                              const struct linear_theory_threshold *theory) {
    double speed[2] = {theory->speed, 1.005 * theory->speed}, frequency = theory->frequency;
    double rate = growth_of(n_nodes, mass_ratio, speed[0], &frequency);
    for (int i = 0; i < 8 && fabs(speed[1] / speed[0] - 1) > 1e-6; i++) {
        const double next = growth_of(n_nodes, mass_ratio, speed[1], &frequency);
        const double zero = speed[1] - next * (speed[1] - speed[0]) / (next - rate);
        speed[0] = speed[1];
        speed[1] = zero;
        rate = next;
    }
    return (struct linear_theory_threshold){speed[1], frequency};
}

// the threshold over the mass ratio, for a figure
static void draw_theory_of_flutter(void) {
    for (int i = 0; i <= 40; i++) {
        const double mass_ratio = 0.2 * pow(75, i / 40.0);
        verify_point("flutter", "exact (linear theory)", mass_ratio,
                     linear_theory_flutter(mass_ratio, LINEAR_THEORY_MODES).speed);
    }
}

static void flutter_of(double mass_ratio, int n_nodes) {
    const struct linear_theory_threshold theory = linear_theory_flutter(mass_ratio, LINEAR_THEORY_MODES);
    const struct linear_theory_threshold coarse = measure((n_nodes + 1) / 2, mass_ratio, &theory);
    const struct linear_theory_threshold fine = measure(n_nodes, mass_ratio, &theory);
    const char *const source = "8 modes of a beam, Theodorsen's function";
    verify_point("flutter", "N = 65, 81", mass_ratio, fine.speed);
    verify_show(verify_text("flutter, M* = %g: relative error of U*, N = %d", mass_ratio, (n_nodes + 1) / 2), source,
                coarse.speed / theory.speed - 1);
    verify_relative(verify_text("flutter, M* = %g: U*, N = %d", mass_ratio, n_nodes), source, theory.speed, fine.speed,
                    0.005);
    verify_relative(verify_text("flutter, M* = %g: f L/U, N = %d", mass_ratio, n_nodes), source, theory.frequency,
                    fine.frequency, 0.005);
}

/* The growth rate and the growth rate of a run: the logarithm of the ratio of two swings of the tail. */
static void growth_of_a_run(void) {
    enum { FROM = 12, PERIODS = 3, END = 24, N = END * N_FRACTION };
    const double mass_ratio = 1, speed = 8;
    const struct linear_theory_body body = {1 / mass_ratio, 1 / mass_ratio / (speed * speed)};
    const struct setting setting = {17, 33, 0.8, 1e-8};
    static double tail[N];
    double frequency = 0.35;
    const double rate = growth_of(17, mass_ratio, speed, &frequency), period = 1 / frequency;
    follow_tail(open_plate(&setting, END, &body, 180.0005, ""), N, tail);
    double swing[2];
    for (int i = 0; i < 2; i++) {
        const int from = (int)lround((FROM + i * PERIODS * period) * N_FRACTION);
        double least = INFINITY, most = -INFINITY;
        for (int k = from; k < from + (int)lround(period * N_FRACTION) && k < N; k++) {
            least = fmin(least, tail[k]);
            most = fmax(most, tail[k]);
        }
        swing[i] = most - least;
    }
    verify_value("growth rate of a flag, M* = 1, U* = 8, N = 17", "three periods of a run",
                 log(swing[1] / swing[0]) / (PERIODS * period), rate, 0.003);
}

// ---- the heaving nose

/* Results of one period: the first harmonic of nose and tail, and the means of thrust and power. */
struct driven {
    double complex nose, tail, lift;
    double thrust, power, efficiency; /* efficiency: the result variable */
};

// add an event to the means over a period that begins and ends at events
static void add_event(struct simulation *simulation, double part, struct driven *driven) {
    simulate_measure(simulation);
    const struct pressure_forces *const fluid = &simulation->diagnostics->fish[0].pressure;
    const double complex turn = 2 * part * cexp(-2 * pi * I * simulation->state->t);
    driven->nose += turn * height(simulation, 0);
    driven->tail += turn * height(simulation, simulation->school->fish[0].n_nodes - 1);
    driven->lift += turn * (fluid->pressure[1] + fluid->suction[1]);
    driven->thrust -= part * (fluid->pressure[0] + fluid->suction[0]);
    driven->power -= part * (fluid->pressure_power + fluid->suction_power);
}

static struct driven drive(const struct setting *setting, double amplitude, int n_periods,
                           const struct linear_theory_body *body) {
    const char *const motion = verify_text(", heave: %.17g, frequency: 1, phase: -90", amplitude);
    struct simulation *const simulation = open_plate(setting, n_periods, body, 180, motion);
    struct driven driven = {0};
    for (int i = 1; i <= N_FRACTION; i++) {
        verify_run(simulation, n_periods - 1 + (double)i / N_FRACTION);
        add_event(simulation, 1.0 / N_FRACTION, &driven);
    }
    driven.efficiency = simulation->diagnostics->fish[0].efficiency;
    driven.lift /= amplitude;
    driven.thrust /= amplitude * amplitude;
    driven.power /= amplitude * amplitude;
    return driven;
}

// linear theory of such a plate
static struct linear_theory_load theory_of(const struct linear_theory_body *body, double complex *tip) {
    const struct linear_theory_plate plate = {1, 1, 1, 2 * pi};
    struct linear_theory_shape shape;
    linear_theory_driven(&plate, body, &shape, tip);
    return linear_theory_flexible(&plate, &shape);
}

static void driven_plate(double mass, double stiffness, int n_nodes, int n_periods) {
    const struct linear_theory_body body = {mass, stiffness};
    const struct setting setting = usual(n_nodes);
    double complex tip;
    const struct linear_theory_load load = theory_of(&body, &tip);
    const struct driven driven = drive(&setting, 0.002, n_periods, &body);
    const double complex ratio = driven.tail / driven.nose;
    static const char source[] = "8 modes of a beam, Theodorsen's function";
    verify_relative(verify_text("heaving nose, k = pi, m = %g, E I = %g: tail over nose", mass, stiffness), source,
                    cabs(tip), cabs(ratio), 0.01);
    verify_value("its phase, degrees", source, carg(tip) * 180 / pi, carg(ratio) * 180 / pi, 1);
    verify_relative("mean thrust over the square of the amplitude", "Wu's series for that shape", load.thrust,
                    driven.thrust, 0.02);
    verify_relative("mean power over the square of the amplitude", "Wu's series for that shape", load.power,
                    driven.power, 0.02);
    verify_relative("its efficiency", "Wu's series for that shape", load.thrust / load.power, driven.efficiency, 0.01);
}

// tail over nose, and efficiency, over the stiffness of a plate of mass 0.1, for figures
static void draw_stiffness(void) {
    double complex tip;
    for (int i = 0; i <= 120; i++) {
        const struct linear_theory_body body = {0.1, 0.05 * pow(400, i / 120.0)};
        const struct linear_theory_load load = theory_of(&body, &tip);
        verify_point("stiffness, tail", "exact (linear theory)", body.stiffness, cabs(tip));
        verify_point("stiffness, efficiency", "exact (linear theory)", body.stiffness, load.thrust / load.power);
    }
    for (int i = 0; i <= 12; i++) {
        const struct linear_theory_body body = {0.1, 0.05 * pow(400, i / 12.0)};
        const struct setting setting = usual(33);
        const struct driven driven = drive(&setting, 0.002, 5, &body);
        verify_point("stiffness, tail", "N = 33", body.stiffness, cabs(driven.tail / driven.nose));
        verify_point("stiffness, efficiency", "N = 33", body.stiffness, driven.thrust / driven.power);
    }
}

// the lift of a flexible plate with more and more nodes, on one sheet
static void order_in_nodes(void) {
    const struct linear_theory_body body = {0.1, 1};
    double complex lift[3];
    for (int i = 0; i < 3; i++) {
        const struct setting setting = {(8 << i) + 1, 65, 0.4, 1e-5};
        lift[i] = drive(&setting, 0.002, 4, &body).lift;
    }
    verify_order("lift of a plate with a heaving nose in the nodes, k = pi, m = 0.1, E I = 1", "N = 9, 17, 33; M = 65",
                 verify_order_of_errors(cabs(lift[0] - lift[1]), cabs(lift[1] - lift[2])), 1.6, 3);
}

// effect of the tolerance on the motion of a soft light plate with a heave of 0.01 at the nose
static void tolerance_of_tail(void) {
    enum { END = 3, N = END * N_FRACTION };
    const struct linear_theory_body body = {0.1, 0.1};
    static double exact[N], tail[N];
    struct setting setting = usual(17);
    setting.rtol = 1e-9;
    static const char motion[] = ", heave: 0.01, frequency: 1, phase: -90";
    follow_tail(open_plate(&setting, END, &body, 180, motion), N, exact);
    const double rtols[] = {1e-4, 1e-5, 1e-6}, bounds[] = {1e-4, 2e-5, 6e-6};
    for (int i = 0; i < 3; i++) {
        double square = 0;
        setting.rtol = rtols[i];
        follow_tail(open_plate(&setting, END, &body, 180, motion), N, tail);
        for (int n = 0; n < N; n++) square += pow(tail[n] - exact[n], 2) / N;
        verify_zero(verify_text("heaving nose, m = 0.1, E I = 0.1: error of the tail in L, rtol %g", rtols[i]),
                    "root mean square, of a motion of 0.018 L; rtol 1e-9", sqrt(square), bounds[i]);
    }
}

void verify_elastic(void) {
    if (verify_is_fast()) {
        driven_plate(0.1, 1, 33, 3);
        return;
    }
    driven_plate(0.1, 0.1, 33, 6);
    driven_plate(0.1, 1, 33, 6);
    driven_plate(0.1, 2, 33, 6);
    driven_plate(0.1, 10, 33, 6);
    driven_plate(1, 5, 33, 10);
    order_in_nodes();
    tolerance_of_tail();
    draw_stiffness();
    draw_theory_of_flutter();
    growth_of_a_run();
    // the modes that flutter at larger M* are higher ones
    flutter_of(0.2, 65);
    flutter_of(0.5, 65);
    flutter_of(1, 65);
    flutter_of(3, 65);
    flutter_of(10, 81);
}
