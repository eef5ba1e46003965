/* elastic.c: the section "elastic": plates that the pressure of their sheet bends and pushes, against linear theory:
 * the threshold of flutter, and plates whose clamped nose heaves.
 *
 * Lengths in L, speeds in U, density of the fluid and span 1; the plate is at rest in a stream. Its mass and bending
 * stiffness are those of elliptic sections of a thickness that linear theory does not know. */
#include <complex.h>
#include <lapacke.h>
#include <math.h>
#include <stdlib.h>

#include "linear_theory.h"
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

/* A plate with its nose in a stream of speed 1: body as in linear theory, motion: further keys of it. */
static struct simulation *open_plate(const struct setting *setting, double end, const struct linear_theory_body *body,
                                     double heading, const char *motion) {
    const double thickness = 0.1;
    return verify_open(VERIFY_SECOND
                       "format: 1\n"
                       "time: {end: %.17g, shedding_interval: %.17g}\n"
                       "fluid: {density: 1, viscosity: 0, velocity: [1, 0]}\n"
                       "wake: {lifetime: 1000, taper: %g}\n"
                       "solver: {rtol: %g}\n"
                       "fish:\n"
                       "  - {nodes: %d, sheet_points: %d, " VERIFY_ATTACHED
                       ", wave: {amplitude: 0},\n"
                       "     body: {profile: uniform, thickness: %g, width: 1, density: %.17g, modulus: %.17g,\n"
                       "            relaxation_time: 0},\n"
                       "     start: {heading: %.17g, speed: 0}, motion: {driven: head, speed: 0%s}}\n",
                       end, 1.0 / N_FRACTION, setting->taper, setting->rtol, setting->n_nodes, setting->n_sheet,
                       thickness, body->mass / (pi / 4 * thickness), body->stiffness / (pi / 64 * pow(thickness, 3)),
                       heading, motion);
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
    simulate_free(simulation);
}

// ---- flutter

/* Growth and frequency of one mode among others. */
struct growing {
    double rate, frequency; /* per unit of time */
};

enum { N_MODES = 6, N_DRIFT = 2, N_TERMS = N_MODES + N_DRIFT, MOST_SAMPLES = 1000 };

/* Prony's method: what is a sum of N_MODES exponentials, with a drift, satisfies a recurrence
 * y_i+6 = c_5 y_i+5 + ... + c_0 y_i + d + e i, whose coefficients are fitted; the roots of its polynomial are the
 * exponentials. The samples are a sixth of a period apart. The mode whose frequency is nearest to the given one. */
static struct growing prony(int n, const double *sample, double interval, double frequency) {
    const int lag = (int)lround(1 / (6 * frequency) / interval), n_rows = n - N_MODES * lag;
    static double matrix[MOST_SAMPLES * N_TERMS], right[MOST_SAMPLES];
    for (int i = 0; i < n_rows; i++) {
        for (int k = 0; k < N_MODES; k++) matrix[i * N_TERMS + k] = sample[i + k * lag];
        matrix[i * N_TERMS + N_MODES] = sample[0];
        matrix[i * N_TERMS + N_MODES + 1] = sample[0] * i / n_rows;
        right[i] = sample[i + N_MODES * lag];
    }
    if (LAPACKE_dgels(LAPACK_ROW_MAJOR, 'N', n_rows, N_TERMS, 1, matrix, N_TERMS, right, 1) != 0) abort();
    double companion[N_MODES * N_MODES] = {0}, real[N_MODES], imaginary[N_MODES];
    for (int k = 0; k < N_MODES; k++) {
        companion[k] = right[N_MODES - 1 - k];
        if (k + 1 < N_MODES) companion[(k + 1) * N_MODES + k] = 1;
    }
    if (LAPACKE_dgeev(LAPACK_ROW_MAJOR, 'N', 'N', N_MODES, companion, N_MODES, real, imaginary, NULL, 1, NULL, 1) !=
        0) {
        abort();
    }
    struct growing best = {0, INFINITY};
    for (int k = 0; k < N_MODES; k++) {
        const double complex exponent = clog(real[k] + I * imaginary[k]) / (lag * interval);
        const struct growing mode = {creal(exponent), cimag(exponent) / (2 * pi)};
        if (fabs(mode.frequency - frequency) < fabs(best.frequency - frequency)) best = mode;
    }
    return best;
}

/* A plate at 1 degree to the stream starts to swing about its small deflection; the first 3 units of time are left to
 * the start. */
static struct growing swing(int n_nodes, double mass_ratio, const struct linear_theory_threshold *at) {
    enum { END = 8, FROM = 3, N = (END - FROM) * N_FRACTION };
    const struct linear_theory_body body = {1 / mass_ratio, 1 / mass_ratio / (at->speed * at->speed)};
    // the sheet is straight: a longer taper costs nothing, and halves the error of the shedding
    const struct setting setting = {n_nodes, 2 * n_nodes - 1, 0.8, 1e-5};
    static double tail[END * N_FRACTION];
    follow_tail(open_plate(&setting, END, &body, 181, ""), END * N_FRACTION, tail);
    return prony(N, tail + FROM * N_FRACTION, 1.0 / N_FRACTION, at->frequency);
}

/* Where the growth of a plate of so many nodes vanishes, by its growth at the theory's threshold and 2 % above it. */
static struct linear_theory_threshold measure(int n_nodes, double mass_ratio,
                                              const struct linear_theory_threshold *theory) {
    struct linear_theory_threshold above = *theory;
    above.speed *= 1.02;
    const struct growing at = swing(n_nodes, mass_ratio, theory), beyond = swing(n_nodes, mass_ratio, &above);
    const double part = -at.rate / (beyond.rate - at.rate);
    return (struct linear_theory_threshold){theory->speed * (1 + 0.02 * part),
                                            at.frequency + part * (beyond.frequency - at.frequency)};
}

// the limit of many nodes from two numbers of them, n and 2 n - 1: errors of second order
static double limit_of(double coarse, double fine) {
    return (4 * fine - coarse) / 3;
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
    verify_point("flutter", "N = 33 to 81", mass_ratio, fine.speed);
    verify_point("flutter", "limit of many nodes", mass_ratio, limit_of(coarse.speed, fine.speed));
    verify_show(verify_text("flutter, M* = %g: relative error of U*, N = %d", mass_ratio, (n_nodes + 1) / 2), source,
                coarse.speed / theory.speed - 1);
    verify_relative(verify_text("flutter, M* = %g: U*, N = %d", mass_ratio, n_nodes), source, theory.speed, fine.speed,
                    0.005);
    verify_relative(verify_text("flutter, M* = %g: U*, limit of many nodes", mass_ratio), source, theory.speed,
                    limit_of(coarse.speed, fine.speed), 0.005);
    verify_relative(verify_text("flutter, M* = %g: f L/U, limit of many nodes", mass_ratio), source, theory.frequency,
                    limit_of(coarse.frequency, fine.frequency), 0.005);
}

// ---- the heaving nose

/* What one period shows: the first harmonic of nose and tail, and the means of thrust and power. */
struct driven {
    double complex nose, tail, lift;
    double thrust, power, efficiency; /* efficiency: that of the result */
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
    driven.efficiency = simulation->diagnostics->fish[0].thrust_efficiency;
    simulate_free(simulation);
    driven.lift /= amplitude;
    driven.thrust /= amplitude * amplitude;
    driven.power /= amplitude * amplitude;
    return driven;
}

// what linear theory says of such a plate
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
    verify_relative("its mean thrust over the square of the amplitude", "Wu's series for that shape", load.thrust,
                    driven.thrust, 0.02);
    verify_relative("its mean power over the square of the amplitude", "Wu's series for that shape", load.power,
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

// what the tolerance leaves of the motion of a soft light plate whose nose heaves by 0.01
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
    // the modes that flutter at larger M* are higher ones
    flutter_of(0.5, 33);
    flutter_of(1, 33);
    flutter_of(3, 49);
    flutter_of(10, 81);
}
