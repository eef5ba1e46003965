/* pressure.c: The section "pressure" compares the forces of the bound sheet (force: pressure) with the linear theory of
 * thin foils. Length L, speed and density of the fluid are 1 and the span is 1 m unless stated. */
#include <complex.h>
#include <math.h>
#include <stdio.h>

#include "linear_theory.h"
#include "verify.h"

static const double pi = 3.14159265358979323846;

// ---- rigid plates

struct plate {
    int nodes, n_sheet;
    double interval, end; /* s */
    double smoothing;     /* of the wake, L */
    bool is_uniform;      /* without taper: the body sees the same smoothing as all others */
    const char *motion;   /* further keys of the prescribed motion */
};

static struct simulation *open_plate(const struct plate *plate) {
    return verify_open(
        "format: 1\ntime: {end: %.17g, shedding_interval: %.17g, output_interval: %.17g}\n"
        "solver: {rtol: 1.0e-6}\nfluid: {density: 1, viscosity: 0}\n"
        "wake: {lifetime: 1000, smoothing: %.17g%s}\nfish:\n"
        "  - {nodes: %d, sheet_points: %d, " VERIFY_ATTACHED
        ", wave: {amplitude: 0, frequency: 0},\n     start: {speed: 1},\n"
        "     body: {profile: uniform, thickness: 0.02, depth: 1, density: 1},\n"
        "     motion: {prescribed: all, %s}}\n",
        plate->end, plate->interval, plate->interval, plate->smoothing,
        plate->is_uniform ? ", taper: 0, taper_beside: 0" : "", plate->nodes, plate->n_sheet, plate->motion);
}

/* The force of the fluid at an event, N, and the moment about the nose, N m. */
struct load {
    double force[2], moment;
};
static struct load load_of(struct simulation *simulation) {
    simulate_measure(simulation);
    const struct fish *fish = simulation->school->fish;
    const struct diagnostics_fish *of = simulation->diagnostics->fish;
    const double *const y = simulation->state->y;
    struct load load = {.moment = of->pressure.pressure_moment + of->pressure.suction_moment};
    const double arm[2] = {of->com[0] - y[fish->at.x], of->com[1] - y[fish->at.y]};
    for (int i = 0; i < 2; i++) load.force[i] = of->pressure.pressure[i] + of->pressure.suction[i];
    load.moment += arm[0] * load.force[1] - arm[1] * load.force[0];
    return load;
}

/* Force of the fluid over the last period of a run: amplitudes across the stream and about the nose, mean thrust, and
 * the power of the motion of the nose across the stream. */
static struct linear_theory_load oscillate(struct simulation *simulation, double omega, int n_periods, int per_period) {
    struct linear_theory_load load = {.thrust = 0};
    const double interval = simulation->school->interval;
    verify_run(simulation, (n_periods - 1) * per_period * interval);
    for (int n = 0; n < per_period; n++) {
        verify_run(simulation, ((n_periods - 1) * per_period + n + 1) * interval);
        const struct load now = load_of(simulation);
        const double complex wave = 2.0 / per_period * cexp(-I * omega * simulation->state->t);
        load.lift += now.force[1] * wave;
        load.moment += now.moment * wave;
        load.thrust -= now.force[0] / per_period;
        load.power -= now.force[1] * simulation->state->y[simulation->school->fish[0].at.vy] / per_period;
    }
    return load;
}

static double relative(double complex a, double complex b) {
    return cabs(a - b) / cabs(b);
}

/* Heave or pitch of a small amplitude at a reduced frequency. */
struct oscillation {
    double k;
    int n_sheet, per_period, n_periods, is_pitch, is_uniform; /* is_uniform: hardly smoothed, no taper */
};

// the program has heave to the left of the heading, -y
static struct linear_theory_load run_oscillation(struct oscillation of) {
    const double omega = 2 * of.k, period = 2 * pi / omega;
    char motion[160];
    snprintf(motion, sizeof motion, "%s: %.17g, frequency: %.17g", of.is_pitch ? "pitch" : "heave",
             of.is_pitch ? 0.5 : 0.005 / of.k, omega / (2 * pi));
    const struct plate plate = {
        17,    of.n_sheet, period / of.per_period, of.n_periods * period, of.is_uniform ? 1e-4 : 0.1, of.is_uniform,
        motion};
    struct simulation *const simulation = open_plate(&plate);
    return oscillate(simulation, omega, of.n_periods, of.per_period);
}

static void heave(void) {
    const struct {
        double k, lift, thrust, power, moment; /* bounds */
    } cases[] = {{1, 0.001, 0.001, 0.002, 0.0015},
                 {0.1, 0.001, 0.001, 0.001, 0.0015},
                 {0.25, 0.0015, 0.0015, 0.0015, 0.0025},
                 {0.5, 0.001, 0.001, 0.001, 0.0015},
                 {2, 0.001, 0.0015, 0.001, 0.002}};
    for (int i = 0; i < (verify_is_fast() ? 1 : 5); i++) {
        const double k = cases[i].k, amplitude = 0.005 / k;
        const int per_period = verify_is_fast() ? 100 : 300;
        const struct linear_theory_load load =
            run_oscillation((struct oscillation){k, 65, per_period, k < 0.3 ? 2 : 4, 0, 0});
        const struct linear_theory_plate plate = {1, 1, 1, 2 * k};
        const struct linear_theory_load theory = linear_theory_rigid(&plate, I * amplitude, 0, 0);
        if (verify_is_fast()) {
            verify_zero("heave, k = 1, 100 events a period: relative difference of lift", "Theodorsen",
                        relative(load.lift, theory.lift), 0.03);
            return;
        }
        verify_relative(verify_text("heave, k = %g: amplitude of lift", k), "Theodorsen (1935)", cabs(theory.lift),
                        cabs(load.lift), cases[i].lift);
        verify_value(verify_text("heave, k = %g: phase of lift, degree", k), "Theodorsen (1935)", 0,
                     carg(load.lift / theory.lift) * 180 / pi, 0.2);
        verify_zero(verify_text("heave, k = %g: relative difference of moment about the middle", k),
                    "Theodorsen (1935)", relative(load.moment - load.lift / 2, theory.moment - theory.lift / 2),
                    cases[i].moment);
        verify_relative(verify_text("heave, k = %g: mean thrust", k), "Garrick (1936)", theory.thrust, load.thrust,
                        cases[i].thrust);
        verify_relative(verify_text("heave, k = %g: mean power", k), "Garrick (1936)", theory.power, load.power,
                        cases[i].power);
    }
}

static void pitch(void) {
    const struct { double k, lift; } cases[] = {{0.1, 0.001}, {0.5, 0.0015}, {1, 0.0025}};
    for (int i = 0; i < 3; i++) {
        const double k = cases[i].k;
        const struct linear_theory_load load = run_oscillation((struct oscillation){k, 65, 300, k < 0.3 ? 2 : 4, 1, 0});
        const struct linear_theory_plate plate = {1, 1, 1, 2 * k};
        const struct linear_theory_load theory = linear_theory_rigid(&plate, 0, -I * 0.5 * pi / 180, 0);
        verify_zero(verify_text("pitch about the nose, k = %g: relative difference of lift", k), "Theodorsen (1935)",
                    relative(load.lift, theory.lift), cases[i].lift);
    }
}

// the error of the taper: a wake with negligible smoothing, without a taper for the body
static void without_taper(void) {
    const struct linear_theory_plate plate = {1, 1, 1, 2};
    const struct linear_theory_load theory = linear_theory_rigid(&plate, I * 0.005, 0, 0);
    const struct linear_theory_load load = run_oscillation((struct oscillation){1, 65, 1200, 2, 0, 1});
    verify_relative("heave, k = 1, smoothing 1e-4 without taper, 1200 events a period: amplitude of lift",
                    "Theodorsen (1935)", cabs(theory.lift), cabs(load.lift), 0.0042);
    verify_value("its phase, degree", "Theodorsen (1935)", 0, carg(load.lift / theory.lift) * 180 / pi, 0.13);
    verify_relative("its mean thrust", "Garrick (1936)", theory.thrust, load.thrust, 0.0016);
}

// fine interval and sheet: the remaining error is the error of the taper
static void refined(void) {
    const struct linear_theory_plate plate = {1, 1, 1, 2};
    const struct linear_theory_load theory = linear_theory_rigid(&plate, I * 0.005, 0, 0);
    const struct linear_theory_load load = run_oscillation((struct oscillation){1, 129, 800, 3, 0, 0});
    verify_relative("heave, k = 1, M = 129, 800 events a period: amplitude of lift", "Theodorsen (1935)",
                    cabs(theory.lift), cabs(load.lift), 0.001);
    verify_value("heave, k = 1, M = 129, 800 events a period: phase of lift, degree", "Theodorsen (1935)", 0,
                 carg(load.lift / theory.lift) * 180 / pi, 0.1);
}

// orders of the lift at k = 1 in the interval and in vortices
static void orders(void) {
    const struct linear_theory_plate plate = {1, 1, 1, 2};
    const struct linear_theory_load theory = linear_theory_rigid(&plate, I * 0.005, 0, 0);
    double error[4];
    double complex lift[4];
    for (int i = 0; i < 4; i++) {
        error[i] = relative(run_oscillation((struct oscillation){1, 129, 50 << i, 3, 0, 0}).lift, theory.lift);
        verify_point("pressure_interval", "heave, k = 1", pi / (50 << i), error[i]);
    }
    // 0.64: from 100 events on an error of the phase of 0.1 degree remains, whose cause is open
    verify_order("lift of a heaving plate in the interval, k = 1", "events 50 to 200 a period",
                 verify_order_of_errors(error[0], error[2]) / 2, 0.6, 2);
    for (int i = 0; i < 4; i++) {
        lift[i] = run_oscillation((struct oscillation){1, (32 << i) + 1, 400, 3, 0, 0}).lift;
        error[i] = relative(lift[i], theory.lift);
        verify_point("pressure_sheet", "heave, k = 1", 32 << i, error[i]);
    }
    verify_relative("lift of a heaving plate, k = 1, M = 33, U Dt = 0.008 L: amplitude", "Theodorsen (1935)",
                    cabs(theory.lift), cabs(lift[0]), 0.004);
    verify_show("lift of a heaving plate, M = 257, U Dt = 0.008 L: relative difference", "Theodorsen (1935)", error[3]);
    for (int i = 0; i < 3; i++) error[i] = cabs(lift[i + 1] - lift[i]);
    verify_order("lift of a heaving plate in the vortices, k = 1", "M = 33 to 257, 400 events a period",
                 verify_order_of_errors(error[0], error[2]) / 2, 0.7, 3);
}

// ---- sudden starts, and long after

// a plate at an incidence with a sudden start; a positive angle points the nose down
static struct simulation *start_plate(double alpha, double interval, double end, int n_sheet) {
    char motion[160];
    snprintf(motion, sizeof motion, "pitch: %.17g, pitch_phase: 90", alpha * 180 / pi);
    const struct plate plate = {17, n_sheet, interval, end, 0.1, 0, motion};
    return open_plate(&plate);
}

static void wagner(void) {
    const double alpha = 0.02;
    const struct {
        double s, lift, circulation; /* bounds */
    } cases[] = {{0.1, 0.0015, 0},  {0.2, 0.001, 0}, {0.5, 0.001, 0},   {1, 0.002, 0.001},
                 {2, 0.002, 0.002}, {4, 0.0015, 0},  {10, 0.001, 0.001}};
    struct simulation *const simulation = start_plate(alpha, 0.005, 5, 65);
    for (int i = 0; i < 7; i++) {
        verify_run(simulation, cases[i].s / 2);
        const struct linear_theory_growth growth = linear_theory_growth(cases[i].s);
        verify_relative(verify_text("sudden start: lift over the final value, s = %g", cases[i].s), "Wagner (1925)",
                        growth.lift, -load_of(simulation).force[1] / (pi * sin(alpha)), cases[i].lift);
        if (cases[i].circulation <= 0) continue;
        verify_relative(verify_text("sudden start: shed circulation over the final value, s = %g", cases[i].s),
                        "Wagner (1925)", growth.circulation,
                        -simulation->diagnostics->fish[0].shed_circulation / (pi * sin(alpha)), cases[i].circulation);
    }
}

static void steady(void) {
    const double angles[] = {0.02, 0.1};
    for (int i = 0; i < 2; i++) {
        struct simulation *const simulation = start_plate(angles[i], 0.05, 60, 33);
        verify_run(simulation, 60);
        const struct load load = load_of(simulation);
        const struct diagnostics_fish *of = simulation->diagnostics->fish;
        const struct linear_theory_growth growth = linear_theory_growth(120);
        verify_relative(verify_text("plate at %g rad after 60 lengths: shed circulation", angles[i]), "Wagner (1925)",
                        growth.circulation, -of->shed_circulation / (pi * sin(angles[i])), 0.001);
        verify_value(verify_text("plate at %g rad: A_0", angles[i]), "tan(alpha), less the effect of the wake",
                     tan(angles[i]), fabs(of->pressure.leading_edge_a0), 0.012 * tan(angles[i]));
        verify_zero(verify_text("plate at %g rad: drag over suction", angles[i]), "d'Alembert",
                    load.force[0] / hypot(of->pressure.suction[0], of->pressure.suction[1]), 0.011);
    }
}

// ---- self-propelled bodies

// A heaving plate of length 2 with friction 0.04 U^(3/2). The mass is 1.5: theory has a uniform speed, and the speed of
// a lighter body oscillates with the thrust (mass 0.5: -0.18 %). The wake decays over several periods, because the end
// of a short wake moves with the phase of the heave: 2 beats and a decay of 0.2 make the plate 5 % too fast.
static void self_propelled(double amplitude, const char *wake, int per_period, int n_periods, double bound) {
    const struct linear_theory_plate plate = {2, 1, 1, 2 * pi};
    const double speed = linear_theory_heaving_speed(&plate, amplitude, 0.04), k = 2 * pi / speed;
    const double complex c = linear_theory_theodorsen(k);
    struct simulation *const simulation = verify_open(
        "format: 1\ntime: {end: %d, shedding_interval: %.17g, output_interval: %.17g}\n"
        "fluid: {density: 1, viscosity: %.17g}\nwake: {%ssmoothing: 0.05}\nfish:\n"
        "  - {length: 2, nodes: 17, sheet_points: 33, " VERIFY_ATTACHED
        ", wave: {amplitude: 0, frequency: 0}, start: {speed: %.17g},\n"
        "     body: {profile: uniform, thickness: 0.1, depth: 0.5, density: 4.8, modulus: 1.0e+5},\n"
        "     motion: {prescribed: all, surge: free, heave: %g, frequency: 1}}\n",
        n_periods, 1.0 / per_period, 1.0 / per_period, pow(0.04 / 1.328, 2) / 2, wake, speed, amplitude);
    verify_run(simulation, n_periods);
    simulate_measure(simulation);
    const char *const which = *wake ? "" : ", default wake";
    verify_relative(verify_text("heaving plate that swims, A = %g%s: speed", amplitude, which), "Garrick (1936)", speed,
                    simulation->diagnostics->fish[0].speed, bound);
    verify_relative(verify_text("heaving plate that swims, A = %g%s: efficiency", amplitude, which),
                    "Garrick (1936), |C|^2/Re C", cabs(c) * cabs(c) / creal(c),
                    simulation->diagnostics->fish[0].efficiency, 0.018);
}

void verify_pressure(void) {
    heave();
    if (verify_is_fast()) return;
    pitch();
    wagner();
    steady();
    self_propelled(0.1, "lifetime: 8, decay: 6, ", 100, 24, 0.0011);
    self_propelled(0.2, "lifetime: 4, decay: 3, ", 200, 16, 0.001);
    self_propelled(0.1, "", 100, 24, 0.003);
    without_taper();
    refined();
    orders();
}
