/* skin.c: The section "skin" (model.md 9 and 15) compares the pressure on both sides of a plate, at sensors, with
 * potential theory that shares no code with the program, and tests the friction on both sides. Length L, speed and
 * density of the fluid are 1. */
#include <complex.h>
#include <math.h>

#include "force/thwaites.h"
#include "linear_theory.h"
#include "verify.h"

static const double pi = 3.14159265358979323846;

// ---- a vortex that passes a plate

/* A plate from 0 to 1 is the image of the unit circle, z = 1/2 + (zeta + 1/zeta)/4. A vortex G at zeta_k has the
 * complex potential G/(2 pi i) log((zeta - zeta_k)/(zeta - 1/conj zeta_k)), which vanishes at infinity, for a
 * vortex shed by the plate. A vortex with its opposite at infinity adds log zeta. */
struct free_vortex {
    double complex zeta, rate; /* position and velocity in the plane of the circle */
    double circulation;
};

static double complex slope_at(double complex zeta) {
    return (1 - 1 / (zeta * zeta)) / 4;
}

static struct free_vortex vortex_at(double complex z, double complex velocity, double circulation) {
    const double complex a = 2 * z - 1;
    double complex zeta = a + csqrt(a - 1) * csqrt(a + 1);
    if (cabs(zeta) < 1) zeta = 1 / zeta;
    return (struct free_vortex){zeta, velocity / slope_at(zeta), circulation};
}

/* Sums over all vortices at the point zeta of the circle: rate of the potential, and dF/dzeta. */
struct sums {
    double complex rate, slope;
};
static void add_vortex(const struct free_vortex *vortex, double complex zeta, struct sums *sums) {
    const double complex image = 1 / conj(vortex->zeta), image_rate = -conj(vortex->rate) * image * image;
    const double complex strength = vortex->circulation / (2 * pi * I);
    sums->rate += strength * (image_rate / (zeta - image) - vortex->rate / (zeta - vortex->zeta));
    sums->slope += strength * (1 / (zeta - vortex->zeta) - 1 / (zeta - image));
}

/* The wake of a plate along x with the nose at 0, as points of the stretches between markers; the newest six stretches
 * by Gauss-Legendre quadrature in the root of the distance from the newer end. */
static void add_wake(const struct wake *wake, double complex zeta, struct sums *sums) {
    static const double eta[4] = {0.06943184420297371, 0.33000947820757187, 0.66999052179242813, 0.93056815579702629};
    static const double weight[4] = {0.17392742256872693, 0.32607257743127307, 0.32607257743127307,
                                     0.17392742256872693};
    for (int i = 0; i + 1 < wake->n_vortex; i++) {
        const int n = i > wake->n_vortex - 8 ? 4 : 1;
        const double circulation = wake->circulation[i + 1] - wake->circulation[i];
        for (int k = 0; k < n; k++) {
            const double xi = n == 1 ? 0.5 : eta[k] * eta[k], part = n == 1 ? 1 : 2 * eta[k] * weight[k];
            const double complex z =
                (1 - xi) * (wake->x[i + 1] + I * wake->y[i + 1]) + xi * (wake->x[i] + I * wake->y[i]);
            const double complex velocity =
                (1 - xi) * (wake->u[i + 1] + I * wake->v[i + 1]) + xi * (wake->u[i] + I * wake->v[i]);
            const struct free_vortex vortex = vortex_at(z, velocity, part * circulation);
            add_vortex(&vortex, zeta, sums);
        }
    }
}

/* A vortex of circulation 0.3 passes a plate in a stream at the height 0.2. The references use the vortices of the run,
 * but not the bound sheet, its rate, or the sums of the program. */
static void check_passing_vortex(void) {
    const double circulation = 0.3, place[] = {0.1, 0.5, 0.9}, times[] = {0.25, 0.5, 0.75};
    const bool is_fast = verify_is_fast();
    struct simulation *const simulation = verify_open(
        "format: 1\ntime: {end: 1, shedding_interval: %g}\n"
        "fluid: {density: 1, viscosity: 0, velocity: [1, 0]}\n"
        "wake: {lifetime: 1000, decay: 0, smoothing: 0.003, taper: 0, taper_beside: 0,\n"
        "       vortices: [[-0.2, 0.2, %g]]}\n"
        "fish: [{nodes: 9, sheet_points: %d, sensors: [0.1, 0.5, 0.9], " VERIFY_ATTACHED
        ",\n        wave: {amplitude: 0, frequency: 0}, motion: {prescribed: all},\n"
        "        body: {profile: uniform, thickness: 1e-4, depth: 1}}]\n",
        is_fast ? 0.01 : 0.0025, circulation, is_fast ? 65 : 129);
    for (int i = 0; i < (is_fast ? 2 : 3); i++) {
        verify_run(simulation, times[i]);
        simulate_measure(simulation);
        for (int k = 0; k < 6; k++) {
            const bool is_right = k < 3;
            const double angle = acos(2 * place[k % 3] - 1) * (is_right ? 1 : -1);
            const double complex zeta = cexp(I * angle);
            struct sums sums = {0, circulation / (2 * pi * I) / zeta + (1 - 1 / (zeta * zeta)) / 4};
            add_wake(&simulation->state->wake[0], zeta, &sums);
            const double speed = cabs(sums.slope / slope_at(zeta)),
                         pressure = -creal(sums.rate) - (speed * speed - 1) / 2;
            verify_value(verify_text("vortex beside a plate, t = %g: pressure at %g, %s", times[i], place[k % 3],
                                     is_right ? "right" : "left"),
                         "conformal mapping", pressure,
                         simulation->residual->force[0].pressure->sensor[is_right][k % 3], is_fast ? 5e-4 : 5e-5);
        }
    }
}

// ---- a plate in an oscillating stream

/* A plate at 20 degrees to x, along a stream of 1 m/s, held in a gust v sin(omega t) across the stream. The pressure
 * difference of linear theory is 2 U C(k) v cot(theta/2) + 2 b dv/dt sin(theta), theta = pi at the tail. The second
 * term is the elliptic pressure of the added mass. Sine and cosine over the last period. */
static void check_gust(double k, double bound) {
    const double v = 0.001, omega = 2 * k, period = 2 * pi / omega, place[] = {0.1, 0.5, 0.9}, angle = 20 * pi / 180;
    const int per_period = verify_is_fast() ? 100 : 200, n_periods = 4;
    struct simulation *const simulation = verify_open(
        "format: 1\ntime: {end: %.17g, shedding_interval: %.17g, output_interval: %.17g}\n"
        "fluid: {density: 1, viscosity: 0, velocity: [%.17g, %.17g], gust: {amplitude: %g, frequency: %.17g}}\n"
        "wake: {lifetime: 1000, decay: 0}\n"
        "fish: [{nodes: 17, sheet_points: 65, sensors: [0.1, 0.5, 0.9], " VERIFY_ATTACHED
        ",\n        start: {heading: 200}, wave: {amplitude: 0, frequency: 0}, motion: {prescribed: all},\n"
        "        body: {profile: uniform, thickness: 1e-4, depth: 1}}]\n",
        n_periods * period, period / per_period, period / per_period, cos(angle), sin(angle), v, omega / (2 * pi));
    double complex jump[3] = {0, 0, 0}, mean[3] = {0, 0, 0};
    verify_run(simulation, (n_periods - 1) * period);
    for (int n = 1; n <= per_period; n++) {
        verify_run(simulation, (n_periods - 1 + (double)n / per_period) * period);
        simulate_measure(simulation);
        double *const *const sensor = simulation->residual->force[0].pressure->sensor;
        const double complex wave = 2.0 / per_period * cexp(-I * omega * simulation->state->t) / v;
        for (int i = 0; i < 3; i++) {
            jump[i] += (sensor[0][i] - sensor[1][i]) * wave;
            mean[i] += (sensor[1][i] + sensor[0][i]) / 2 * wave;
        }
    }

    for (int i = 0; i < 3; i++) {
        const double theta = acos(1 - 2 * place[i]);
        const double complex theory = -I * (2 * linear_theory_theodorsen(k) / tan(theta / 2) + I * omega * sin(theta));
        verify_zero(verify_text("plate in a gust, k = %g: relative difference of the pressure at %g", k, place[i]),
                    "Theodorsen (1935)", cabs(jump[i] - theory) / cabs(theory), bound);
        verify_zero(verify_text("plate in a gust, k = %g: mean of both sides at %g over the difference", k, place[i]),
                    "linear theory", cabs(mean[i]) / cabs(theory), 1e-5);
    }
}

// ---- friction on both sides by Thwaites' method

/* Mean friction along x over a time, N: of both sides by Thwaites' method, and of the law that acts. */
struct frictions {
    double sides, law;
};
static struct frictions mean_friction(struct simulation *simulation, double from, double duration) {
    struct frictions mean = {0, 0};
    const int n = (int)lround(duration / simulation->school->interval);
    for (int i = 1; i <= n; i++) {
        verify_run(simulation, from + i * duration / n);
        simulate_measure(simulation);
        const struct thwaites_friction sides =
            thwaites_friction(simulation->residual->force[0].pressure, simulation->state->y, simulation->state->yp);
        mean.sides += (sides.force[0][0] + sides.force[1][0]) / n;
        mean.law += simulation->diagnostics->fish[0].friction_force[0] / n;
    }
    return mean;
}

// an ellipse of 12 % at Reynolds number 1000 at rest in a stream, Navier-Stokes: C_F 0.0995; and a thin plate
static void check_friction_at_rest(void) {
    static const struct {
        const char *name, *source;
        double thickness, reference, bound;
    } bodies[] = {{"plate", "Blasius", 1e-4, 2 * 1.328 / 31.6227766, 0.012},
                  {"ellipse of 12 %", "Navier-Stokes", 0.12, 0.0995, 0.05}};
    for (int i = 0; i < 2; i++) {
        struct simulation *const simulation = verify_open(
            "format: 1\ntime: {end: 1, shedding_interval: 0.01}\nfluid: {density: 1, viscosity: 1e-3}\n"
            "fish: [{force: pressure, pressure: {span: infinite}, start: {speed: 1}, wave: {amplitude: 0, "
            "frequency: 0},\n"
            "        body: {profile: uniform, thickness: %g, depth: 1}, motion: {prescribed: all}}]\n",
            bodies[i].thickness);
        const struct frictions mean = mean_friction(simulation, 0, 0.02);
        verify_relative(verify_text("%s at Reynolds number 1000: friction of both sides", bodies[i].name),
                        bodies[i].source, bodies[i].reference, 2 * mean.sides, bodies[i].bound);
    }
}

// the friction of Navier-Stokes solutions in motion: less in heave, more for the swimmer
static void check_friction_in_motion(void) {
    const double pressure = 1.25 * 1.25 / 2;
    struct simulation *const foil = verify_open_case("foil_heave.yaml", 0, NULL);
    const struct frictions of_foil = mean_friction(foil, 0, 2);
    verify_regression("heave of an ellipse at Re 1000: friction of both sides", "Navier-Stokes, about 0.06", 0.06,
                      of_foil.sides / pressure, 1.3, 1.6);
    verify_regression("heave of an ellipse at Re 1000: friction of the law", "Navier-Stokes, about 0.06", 0.06,
                      of_foil.law / pressure, 1.9, 2.2);

    struct simulation *const swimmer = verify_open_case("swimmer_navier_stokes.yaml", 0, NULL);
    verify_run(swimmer, 6);
    const struct frictions of_swimmer = mean_friction(swimmer, 6, 1);
    verify_regression("swimmer: friction of both sides over the law", "law that acts", of_swimmer.law, of_swimmer.sides,
                      0.78, 0.88);
}

void verify_skin(void) {
    check_passing_vortex();
    check_gust(1, verify_is_fast() ? 0.02 : 0.004);
    check_friction_at_rest();
    if (verify_is_fast()) return;
    check_gust(4, 0.004);
    check_friction_in_motion();
}
