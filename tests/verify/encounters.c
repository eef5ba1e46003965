/* encounters.c: The section "encounters" compares plates in gusts that travel with the stream, vortex streets, and
 * plates in vortex streets with linear theory and von Karman. Length L, speed and density of the fluid are 1, the span
 * is 1 m. */
#include <complex.h>
#include <math.h>
#include <stdio.h>

#include "linear_theory.h"
#include "verify.h"
#include "wake/wake.h"

static const double pi = 3.14159265358979323846;
static const double amplitude = 0.005; /* of gusts, m s-1 */

// ---- a fixed plate in a gust

/* A plate from x = 0 to 1 in the stream 1 along x; gust: keys of the gust. */
static struct simulation *open_plate(int n_sheet, double interval, double end, const char *gust) {
    return verify_open(
        "format: 1\ntime: {end: %.17g, shedding_interval: %.17g, output_interval: %.17g}\n"
        "fluid: {density: 1, viscosity: 0, velocity: [1, 0], gust: {amplitude: %.17g, %s}}\n"
        "wake: {lifetime: 1000}\nfish:\n  - {nodes: 17, sheet_points: %d, " VERIFY_ATTACHED
        ", wave: {amplitude: 0, frequency: 0},\n     start: {speed: 0}, motion: {prescribed: all},\n"
        "     body: {profile: uniform, thickness: 0.02, depth: 1, density: 1}}\n",
        end, interval, interval, amplitude, gust, n_sheet);
}

/* The force of the fluid at an event, N: pressure across the stream, suction along the stream. */
static void measure(struct simulation *simulation, double force[2]) {
    simulate_measure(simulation);
    const struct diagnostics_fish *const of = simulation->diagnostics->fish;
    for (int i = 0; i < 2; i++) force[i] = of->pressure.pressure[i] + of->pressure.suction[i];
}

// lift over pi density U L v; mean thrust over pi density L v^2/2
struct response {
    double complex lift;
    double thrust;
};

/* The last of n_periods in a sine gust, whose phase is 0 at the middle of the plate: v = amplitude cos(omega t). */
static struct response sine(double k, int n_sheet, int per_period, int n_periods) {
    const double omega = 2 * k, period = 2 * pi / omega, interval = period / per_period;
    char gust[160];
    snprintf(gust, sizeof gust, "profile: sine, wavelength: %.17g, position: %.17g", period, 0.5 - period / 4);
    struct simulation *const simulation = open_plate(n_sheet, interval, n_periods * period, gust);
    struct response response = {0};
    verify_run(simulation, (n_periods - 1) * period);
    for (int n = 0; n < per_period; n++) {
        double force[2];
        verify_run(simulation, (n_periods - 1) * period + (n + 1) * interval);
        measure(simulation, force);
        response.lift += force[1] * 2 / per_period * cexp(-I * omega * simulation->state->t) / (pi * amplitude);
        response.thrust -= force[0] / per_period / (pi * amplitude * amplitude / 2);
    }
    return response;
}

static void sears(void) {
    const struct {
        double k;
        int n_periods;
        double lift, phase, thrust;
    } cases[] = {
        {1, 4, 0.005, 0.3, 0.005}, {0.1, 2, 0.003, 0.2, 0.003}, {0.5, 3, 0.003, 0.2, 0.003}, {2, 6, 0.005, 0.3, 0.003}};
    for (int i = 0; i < (verify_is_fast() ? 1 : 4); i++) {
        const double k = cases[i].k;
        const struct response response =
            sine(k, verify_is_fast() ? 33 : 65, verify_is_fast() ? 100 : 300, cases[i].n_periods);
        const double complex theory = linear_theory_sears(k);
        verify_relative(verify_text("sine gust, k = %g: amplitude of lift", k), "Sears (1941)", cabs(theory),
                        cabs(response.lift), cases[i].lift);
        verify_value(verify_text("sine gust, k = %g: phase of lift, degree", k), "Sears (1941)",
                     carg(theory) * 180 / pi, carg(response.lift) * 180 / pi, cases[i].phase);
        verify_relative(verify_text("sine gust, k = %g: mean thrust", k), "the suction of Sears' pressure, |S|^2",
                        cabs(theory) * cabs(theory), response.thrust, cases[i].thrust);
    }
}

/* A step whose front starts 0.3 ahead of the nose. */
static void kuessner(void) {
    const double s[] = {0.5, 1, 2, 4, 10}, ahead = 0.3;
    const int n = verify_is_fast() ? 3 : 5;
    struct simulation *const simulation =
        verify_is_fast() ? open_plate(33, 0.01, 6, "profile: step, position: -0.3, gradient_distance: 0.2")
                         : open_plate(65, 0.005, 6, "profile: step, position: -0.3, gradient_distance: 0.1");
    for (int i = 0; i < n; i++) {
        double force[2];
        verify_run(simulation, ahead + s[i] / 2);
        measure(simulation, force);
        verify_relative(verify_text("step gust: lift over the final value, s = %g", s[i]), "Kuessner (1936)",
                        linear_theory_kuessner(s[i]), force[1] / (pi * amplitude), 0.01);
    }
}

// ---- a vortex street

/* Speed of the four vortices in the middle of a street of n vortices over 0.4 of the spacing 1, circulation 1, far from
 * a small body. */
static double street_speed(int n, double interval) {
    const double end = 1;
    struct simulation *const simulation = verify_open(
        "format: 1\ntime: {end: %g, shedding_interval: %.17g, output_interval: %.17g}\n"
        "wake: {lifetime: 1000, street: {vortices: %d, spacing: 1, circulation: 1}}\nsolver: {rtol: 1e-4}\n"
        "fish: [{length: 1e-3, force: published, sheet_points: 9, wave: {amplitude: 0, frequency: 0},\n"
        "        start: {position: [0, 1000], speed: 0}, motion: {prescribed: all}}]\n",
        end, interval, interval, n);
    const struct wake *const wake = &simulation->state->wake[0];
    double sum = 0;
    for (int way = 0; way < 2; way++) {
        for (int i = 0; i < wake_n_sources(wake); i++) {
            const bool is_middle = fabs(wake->x[i] + (way ? 0.5 * end * tanh(pi * 0.280549) : 0)) < 0.99;
            if (fabs(wake_source(wake, i)) > 0.5 && is_middle) sum += (way ? 1 : -1) * wake->x[i] / 4;
        }
        verify_run(simulation, end);
    }
    return -sum / end;
}

/* The ends of a street are missing: an error proportional to 1/n. */
static void street(void) {
    const int n = verify_is_fast() ? 40 : 160;
    const double interval = verify_is_fast() ? 0.02 : 0.01, karman = sqrt(0.5) / 2;
    const double speed[2] = {street_speed(n, interval), street_speed(2 * n, interval)};
    verify_relative(verify_text("vortex street: speed of the middle of %d vortices", 2 * n),
                    "von Karman (1911): G/(2 a) tanh(pi h/a)", karman, speed[1], verify_is_fast() ? 0.02 : 0.005);
    verify_relative(verify_text("vortex street: speed, %d and %d vortices extrapolated", n, 2 * n),
                    "von Karman (1911): G/(2 a) tanh(pi h/a)", karman, 2 * speed[1] - speed[0],
                    verify_is_fast() ? 1e-3 : 1e-4);
}

// ---- a plate in a vortex street

/* A plate on the centre line of a street of spacing 2 is free along the stream and held in all other directions. The
 * velocity across the plate has the amplitudes 2 G/a exp(-pi m h/a), m = 1, 3, .. The mean flow on the centre line is
 * the stream less G/a. */
static void drift(void) {
    const double a = 2, h = acosh(sqrt(2)) / pi * a, circulation = 0.01, interval = verify_is_fast() ? 0.02 : 0.01;
    const double mass = pi / 4 * 0.02, from = 10, to = from + 3 * a;
    struct simulation *const simulation = verify_open(
        "format: 1\ntime: {end: %g, shedding_interval: %.17g, output_interval: %.17g}\n"
        "fluid: {density: 1, viscosity: 0, velocity: [%.17g, 0]}\n"
        "wake: {lifetime: 1000, smoothing: 0.005,\n"
        "       street: {vortices: 48, spacing: %g, circulation: %g, position: [-7, 0]}}\nfish:\n"
        "  - {nodes: 17, sheet_points: %d, " VERIFY_ATTACHED
        ", wave: {amplitude: 0, frequency: 0},\n"
        "     start: {speed: 0}, motion: {prescribed: all, surge: free},\n"
        "     body: {profile: uniform, thickness: 0.02, depth: 1, density: 1}}\n",
        to, interval, interval, 1 + circulation / a, a, circulation, verify_is_fast() ? 33 : 65);
    double thrust = 0, speed[2];
    for (int m = 1; m < 8; m += 2) {
        const double across = 2 * circulation / a * exp(-pi * m * h / a), lift = cabs(linear_theory_sears(pi * m / a));
        thrust += pi * across * across * lift * lift / 2;
    }
    for (int i = 0; i < 2; i++) {
        verify_run(simulation, i == 0 ? from : to);
        simulate_measure(simulation);
        speed[i] = simulation->diagnostics->fish[0].com_velocity[0];
    }
    verify_relative("plate in a street, free along the stream: mean acceleration", "Sears (1941), the suction",
                    -thrust / mass, (speed[1] - speed[0]) / (to - from), 0.01);
}

/* A free rigid plate meets a weak street: heave y and pitch p (slope of the plate) of linear theory, integrated in time
 * by trapezoids. The lift of Wagner's function phi for changes of the downwash q at three quarters of the chord acts at
 * the first quarter,
 *
 *     F = pi (int phi dq + 1/2 d/dt int v sin^2(theta) dtheta/pi)
 *     q = int v (1 - cos theta) dtheta/pi - y' - p - p'/4
 *     (m + pi/4) y'' = F - pi/4 p'          (I + pi/128) p'' = - F/4 - pi/16 p'
 *
 * with the velocity v of the street, which moves with the stream 1, across the plate at x = (1 - cos theta)/2. */
enum { N_STEPS = 500, N_STREET = 12, N_PLACES = 40 };
static const double step = 0.01, street_spacing = 2, street_ahead = 2, street_circulation = 0.002;

struct free_plate {
    double phi[N_STEPS + 1], downwash[N_STEPS + 1], mass, inertia;
    double y[2], pitch[2]; /* value and rate */
};

static double street_middle(void) {
    return -(N_STREET - 1) / 4.0 * street_spacing - street_ahead;
}

/* Sums over the chord: of v (1 - cos theta), and of the rate of v sin^2(theta) by a difference. */
static void gust_of_street(double t, double *downwash, double *rate) {
    const double h = acosh(sqrt(2)) / pi * street_spacing, dt = 1e-4;
    *downwash = *rate = 0;
    for (int i = 0; i < N_PLACES; i++) {
        const double theta = pi * (i + 0.5) / N_PLACES, x = (1 - cos(theta)) / 2;
        double v[3] = {0};
        for (int k = 0; k < 3 * N_STREET; k++) {
            const int n = k / 3, side = n % 2 == 0 ? 1 : -1;
            const double ahead = street_middle() + (n - (N_STREET - 1) / 2.0) * street_spacing / 2;
            const double r = x - ahead - (t + (k % 3 - 1) * dt);
            v[k % 3] -= side * street_circulation * r / (r * r + h * h / 4) / (2 * pi);
        }
        *downwash += v[1] * (1 - cos(theta)) / N_PLACES;
        *rate += (v[2] - v[0]) / (2 * dt) * sin(theta) * sin(theta) / N_PLACES;
    }
}

/* Accelerations of heave and pitch at step n with these rates and this pitch. */
static void accelerate(struct free_plate *plate, int n, const double y[2], const double pitch[2], double a[2]) {
    double downwash, rate;
    gust_of_street(n * step, &downwash, &rate);
    plate->downwash[n] = downwash - y[1] - pitch[0] - pitch[1] / 4;
    double lift = plate->downwash[0] * plate->phi[n] + rate / 2;
    for (int i = 0; i < n; i++) {
        lift += (plate->downwash[i + 1] - plate->downwash[i]) * (plate->phi[n - i] + plate->phi[n - i - 1]) / 2;
    }
    a[0] = pi * (lift - pitch[1] / 4) / (plate->mass + pi / 4);
    a[1] = -pi * (lift / 4 + pitch[1] / 16) / (plate->inertia + pi / 128);
}

static void advance(struct free_plate *plate, int n) {
    double before[2], after[2], y[2], pitch[2];
    accelerate(plate, n, plate->y, plate->pitch, before);
    for (int i = 0; i < 2; i++) after[i] = before[i];
    for (int iteration = 0; iteration < 3; iteration++) {
        y[1] = plate->y[1] + step * (before[0] + after[0]) / 2;
        y[0] = plate->y[0] + step * (plate->y[1] + y[1]) / 2;
        pitch[1] = plate->pitch[1] + step * (before[1] + after[1]) / 2;
        pitch[0] = plate->pitch[0] + step * (plate->pitch[1] + pitch[1]) / 2;
        accelerate(plate, n + 1, y, pitch, after);
    }
    for (int i = 0; i < 2; i++) {
        plate->y[i] = y[i];
        plate->pitch[i] = pitch[i];
    }
}

static void free_plate(void) {
    const double density = 500, mass = pi / 4 * 0.02 * density;
    struct free_plate plate = {.mass = mass, .inertia = mass / 12};
    struct simulation *const simulation = verify_open(
        "format: 1\ntime: {end: 5, shedding_interval: %.17g, output_interval: %.17g}\n"
        "fluid: {density: 1, viscosity: 0, velocity: [1, 0]}\nwake: {lifetime: 1000, smoothing: 0.005,\n"
        "       street: {vortices: %d, spacing: %g, circulation: %g, position: [%.17g, 0]}}\nfish:\n"
        "  - {nodes: 33, sheet_points: 65, " VERIFY_ATTACHED
        ", wave: {amplitude: 0, frequency: 0}, start: {speed: 0},\n"
        "     body: {profile: uniform, thickness: 0.02, depth: 1, density: %g, modulus: 1.0e+9}}\n",
        step, step, N_STREET, street_spacing, street_circulation, street_middle(), density);
    const struct fish *const fish = &simulation->school->fish[0];
    const double *const y = simulation->state->y;
    for (int n = 0; n <= N_STEPS; n++) plate.phi[n] = n == 0 ? 0.5 : linear_theory_wagner(2 * n * step);
    for (int n = 0; n < (verify_is_fast() ? 200 : N_STEPS); n++) {
        advance(&plate, n);
        if ((n + 1) % 100 > 0 || n + 1 == 100) continue;
        const double t = (n + 1) * step;
        verify_run(simulation, t);
        simulate_measure(simulation);
        verify_relative(verify_text("free plate in a street: heave after %g s", t), "Wagner, integrated in time",
                        plate.y[0], simulation->diagnostics->fish[0].com[1], 0.005);
        verify_relative(verify_text("free plate in a street: pitch after %g s", t), "Wagner, integrated in time",
                        plate.pitch[0], y[fish->at.y + fish->n_nodes - 1] - y[fish->at.y], 0.005);
    }
}

void verify_encounters(void) {
    sears();
    kuessner();
    street();
    drift();
    free_plate();
}
