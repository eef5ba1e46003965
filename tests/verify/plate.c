/* plate.c: the section "plate" compares a rigid plate and its wake with the linear theory of thin foils: Wagner's
 * impulsive start and a heaving plate. Length L = 1 m, speed U = 1 m/s.
 *
 * Linear theory has a vortex sheet that begins at the edge. So has the program by default (shedding: sheet), for which
 * the checks at default settings hold. With shedding: continuous the wake has vortices of radius delta (smoothing), the
 * newest at half the distance w Dt of the flow past the tail in one interval. The effect of vortices near the edge on
 * the bound circulation is an integral with 1/sqrt(distance): smoothing reduces the integral by a part of order
 * sqrt(delta/L), one vortex at the centroid instead of a sheet by a part of order sqrt(U Dt/L), as the studies of point
 * vortices show. */
#include <complex.h>
#include <math.h>
#include <stdio.h>

#include "force/bound_sheet.h"
#include "linear_theory.h"
#include "verify.h"

static const double pi = 3.14159265358979323846;

// ---- varied keys

struct resolution {
    double interval, smoothing, sheet_smoothing; /* s, L, L */
    int n_sheet;
    const char *kutta, *collocation, *shedding;
};

/* Radii far below the distance of the vortices, and bound vortices closer to each other at the edge, (pi/M)^2/4
 * lengths, than the newest free vortex is to the edge: the remaining error is the error of the interval. */
static struct resolution point_vortices(double interval) {
    return (struct resolution){interval, 1e-5, 0.05, 81, "edge", "chebyshev", "continuous"};
}

/* The default settings, at U Dt = 0.01 L. */
static const struct resolution defaults = {0.01, 0.1, 0.05, 33, "edge", "chebyshev", "sheet"};

/* One nascent vortex, smoothed also next to the edge: the default of the article's model. */
static const struct resolution smoothed = {0.01, 0.2, 0.05, 21, "edge", "chebyshev", "continuous"};

/* A straight prescribed plate; motion: further keys of the motion. */
static struct simulation *open_plate(const struct resolution *with, double end, const double velocity[2],
                                     const char *motion) {
    return verify_open(
        "format: 1\ntime: {end: %.17g, shedding_interval: %.17g, output_interval: %.17g}\n"
        "fluid: {velocity: [%.17g, %.17g]}\nwake: {smoothing: %.17g, lifetime: 1000, shedding: %s}\n"
        "sheet: {smoothing: %.17g, kutta: %s, collocation: %s}\nsolver: {rtol: 1e-6}\nfish:\n"
        "  - {force: reactive, nodes: 4, sheet_points: %d, wave: {amplitude: 0}, start: {heading: 180, speed: 0},\n"
        "     motion: {prescribed: all, %s}}\n",
        end, with->interval, with->interval, velocity[0], velocity[1], with->smoothing, with->shedding,
        with->sheet_smoothing, with->kutta, with->collocation, with->n_sheet, motion);
}

static double bound_circulation(const struct simulation *simulation) {
    return bound_sheet_circulation(&simulation->school->fish[0], simulation->state->y);
}

// ---- Wagner's problem

/* Shed circulation over the final value. */
static double exact_growth(double s) {
    return linear_theory_growth(s).circulation;
}

static const double incidence = 0.5 * 3.14159265358979323846 / 180; /* small: 2 degrees change 0.0004 of G(2) */
static const char wagner[] = "Wagner's integral equation";

static struct simulation *start_plate(const struct resolution *with, double s) {
    const double velocity[2] = {cos(incidence), sin(incidence)};
    return open_plate(with, s / 2, velocity, "speed: 0");
}

/* Shed circulation over the final value after s half lengths. */
static double grown(struct simulation *simulation, double s) {
    verify_run(simulation, s / 2);
    return -bound_circulation(simulation) / (pi * sin(incidence));
}

static double start_error(struct resolution with, double s) {
    struct simulation *const simulation = start_plate(&with, s);
    return grown(simulation, s) / exact_growth(s) - 1;
}

/* The finest runs: within 1 % from s = 2 on. */
static void start_values(void) {
    const double fine = verify_is_fast() ? 0.00125 : 0.000625, coarse = verify_is_fast() ? 0.005 : 0.0025;
    const struct resolution early = point_vortices(fine), late = point_vortices(coarse);
    struct simulation *simulation = start_plate(&early, 2);
    verify_show(verify_text("impulsive start: error of G(1), Dt = %g s", fine), wagner,
                grown(simulation, 1) / exact_growth(1) - 1);
    verify_relative(verify_text("impulsive start: G(2), Dt = %g s", fine), wagner, exact_growth(2),
                    grown(simulation, 2), 0.01);
    simulation = start_plate(&late, 10);
    verify_relative(verify_text("impulsive start: G(5), Dt = %g s", coarse), wagner, exact_growth(5),
                    grown(simulation, 5), 0.01);
    verify_relative(verify_text("impulsive start: G(10), Dt = %g s", coarse), wagner, exact_growth(10),
                    grown(simulation, 10), 0.01);
    // Kelvin: bound, free and nascent
    double sum = bound_circulation(simulation);
    const struct wake *const wake = &simulation->state->wake[0];
    for (int i = 0; i < wake->n_vortex; i++) sum += wake->circulation[i];
    sum += simulation->state->y[simulation->school->fish[0].at.circulation] - wake->shed_before;
    verify_zero("impulsive start: all circulation / (pi L U sin alpha), s = 10", "Kelvin's theorem",
                sum / (pi * sin(incidence)), 1e-10);
}

/* At default settings. */
static void start_by_default(void) {
    static const double s[] = {1, 2, 5, 10};
    struct simulation *const simulation = start_plate(&defaults, 10);
    for (int i = 0; i < 4; i++) {
        verify_relative(verify_text("impulsive start at default settings: G(%g), Dt = 0.01 s", s[i]), wagner,
                        exact_growth(s[i]), grown(simulation, s[i]), 0.015);
    }
    double error[3];
    for (int i = 0; i < 3; i++) {
        struct resolution with = defaults;
        with.interval = 0.02 / (1 << i);
        error[i] = start_error(with, 2);
        verify_point("wagner_interval", "default", with.interval, fabs(error[i]));
    }
    verify_show("impulsive start at default settings: error of G(2), Dt = 0.02 s", wagner, error[0]);
    verify_show("impulsive start at default settings: error of G(2), Dt = 0.005 s", wagner, error[2]);
}

static void order_in_the_interval(void) {
    double error[6];
    const int n = verify_is_fast() ? 3 : 5;
    for (int i = 0; i < n; i++) {
        const double interval = 0.02 / (1 << i);
        error[i] = start_error(point_vortices(interval), 2);
        verify_point("wagner_interval", "point vortices", interval, fabs(error[i]));
    }
    verify_order("impulsive start: order of G(2) in Dt, smoothing 1e-5",
                 "reached: 1/2, as one vortex at the centroid of what was shed stands for a sheet from the edge on",
                 verify_order_of_errors(error[n - 2], error[n - 1]), 0.4, 0.6);
}

static void order_in_the_smoothing(void) {
    double error[8];
    const int n = 6;
    struct resolution with = point_vortices(verify_is_fast() ? 0.01 : 0.0025);
    for (int i = 0; i < n; i++) {
        with.smoothing = 0.2 / (1 << i);
        error[i] = start_error(with, 2);
        verify_point("wagner_smoothing", "s = 2", with.smoothing, fabs(error[i]));
    }
    verify_order("impulsive start: order of G(2) in smoothing",
                 "reached: 1/2, as the plate feels the newest vortices less",
                 verify_order_of_errors(error[n - 2], error[n - 1]), 0.4, 0.6);
    verify_show("impulsive start: error of G(1), continuous, smoothing 0.2", wagner, start_error(smoothed, 1));
    verify_show("impulsive start: error of G(2), continuous, smoothing 0.2", wagner, start_error(smoothed, 2));
    verify_show("impulsive start: error of G(10), continuous, smoothing 0.2", wagner, start_error(smoothed, 10));
    // the bound sheet moves the wake along the plate only, by a part of the order of the incidence squared
    struct resolution other = defaults;
    other.sheet_smoothing = 0.01;
    verify_zero("impulsive start: G(2) when sheet_smoothing is 0.01, not 0.05", "no effect in linear theory",
                start_error(other, 2) - start_error(defaults, 2), 1e-4);
}

/* At one interval: edge and chebyshev with 161 points are the limit of many sheet points. */
static void convergence_in_the_sheet(void) {
    static const char *const kutta[] = {"edge", "rate"}, *const collocation[] = {"chebyshev", "midpoint"};
    struct resolution with = point_vortices(0.01);
    with.n_sheet = 161;
    const double limit = start_error(with, 2);
    const int n = verify_is_fast() ? 3 : 4;
    for (int scheme = 0; scheme < 4; scheme++) {
        double error[4];
        with.kutta = kutta[scheme / 2];
        with.collocation = collocation[scheme % 2];
        for (int i = 0; i < n; i++) {
            with.n_sheet = (10 << i) + 1;
            error[i] = start_error(with, 2) - limit;
            verify_point("wagner_sheet", verify_text("%s, %s", with.kutta, with.collocation), with.n_sheet,
                         fabs(error[i]));
        }
        if (scheme == 0) {
            verify_zero(verify_text("impulsive start: G(2), edge, chebyshev, M = %d against 161", with.n_sheet),
                        "its own limit", error[n - 1], 2e-4);
        } else {
            verify_order(verify_text("impulsive start: order of G(2) in 1/M, %s, %s", with.kutta, with.collocation),
                         "against edge, chebyshev, M = 161", verify_order_of_errors(error[n - 2], error[n - 1]), 0.7,
                         1.3);
        }
    }
}

static void figure_of_the_start(void) {
    const struct resolution fine = point_vortices(0.005);
    struct simulation *const both[2] = {start_plate(&defaults, 10), start_plate(&fine, 10)};
    for (int i = 1; i <= 20; i++) {
        const double s = 0.5 * i;
        verify_point("wagner", "exact", s, exact_growth(s));
        verify_point("wagner", "default, Dt = 0.01 s", s, grown(both[0], s));
        verify_point("wagner", "point vortices, Dt = 0.005 s", s, grown(both[1], s));
    }
}

// ---- heaving plate

/* Bound circulation over the quasi-steady circulation; j0, j1, y0, y1 of the C library. */
static double complex exact_ratio(double k) {
    const double complex h0 = j0(k) - I * y0(k), h1 = j1(k) - I * y1(k);
    return 2 * I * cexp(-I * k) / (pi * k * (h1 + I * h0));
}

/* Solve four normal equations with the right sides in column 4; the factor of function i is in sums[i][4]. */
static void solve_normal(double sums[4][5]) {
    for (int pivot = 0; pivot < 4; pivot++) {
        for (int column = 4; column >= pivot; column--) sums[pivot][column] /= sums[pivot][pivot];
        for (int i = 0; i < 4; i++) {
            const double factor = sums[i][pivot];
            for (int column = pivot; i != pivot && column < 5; column++)
                sums[i][column] -= factor * sums[pivot][column];
        }
    }
}

/* Lift, against the motion, over the velocity of heave and the density. */
static double complex exact_lift(double k) {
    const struct linear_theory_plate plate = {1, 1, 1, 2 * k};
    return linear_theory_rigid(&plate, I / plate.omega, 0, 0).lift;
}

/* sum of circulation times x over all vortices: the rate of the sum is the lift over the density. */
static double impulse(const struct simulation *simulation) {
    const struct fish *const fish = &simulation->school->fish[0];
    const struct wake *const wake = &simulation->state->wake[0];
    const double *const y = simulation->state->y;
    double sum = 0;
    for (int j = 0; j < fish->n_sheet; j++) {
        sum += fish->sheet_weight[j] * y[fish->at.gamma + j] * fish_mean(&fish->sheet_point[j], y + fish->at.x);
    }
    for (int i = 0; i < wake_n_sources(wake); i++) {
        sum += wake_source(wake, i) * (wake->has_markers ? (wake->x[i] + wake->x[i + 1]) / 2 : wake->x[i]);
    }
    return sum;
}

/* Obtained over exact: the bound circulation and the lift of a heaving plate with n intervals a period, each fitted
 * over the second period with a sine and, for the remaining transient, a straight line. The plate starts at rest at the
 * lowest point. */
struct heaving {
    double complex circulation, lift;
};
static struct heaving heave(double k, int n, struct resolution with) {
    const double omega = 2 * k, period = 2 * pi / omega, velocity = 0.01, still[2] = {0, 0};
    with.interval = period / n;
    char motion[160];
    snprintf(motion, sizeof motion, "speed: 1, heave: %.17g, frequency: %.17g, phase: -90", velocity / omega,
             1 / period);
    struct simulation *const simulation = open_plate(&with, 2 * period, still, motion);
    double sums[2][4][5] = {0};
    for (int step = 1; step <= 2 * n; step++) {
        verify_run(simulation, step * with.interval);
        if (step <= n) continue;
        const double angle = omega * simulation->state->t - pi / 2; /* the velocity's: its cosine */
        const double measured[2] = {bound_circulation(simulation), impulse(simulation)};
        for (int what = 0; what < 2; what++) {
            const double value[5] = {cos(angle), sin(angle), 1, (double)step / n - 1.5, measured[what]};
            for (int i = 0; i < 4; i++) {
                for (int j = 0; j < 5; j++) sums[what][i][j] += value[i] * value[j];
            }
        }
    }
    for (int what = 0; what < 2; what++) solve_normal(sums[what]);
    const double complex circulation = sums[0][0][4] - I * sums[0][1][4], moment = sums[1][0][4] - I * sums[1][1][4];
    // a motion to the left of a plate that swims towards -x, to -y, is a stream from below with a clockwise sheet
    return (struct heaving){-circulation / (pi * velocity) / exact_ratio(k),
                            I * omega * moment / velocity / exact_lift(k)};
}

static double degrees(double complex z) {
    return carg(z) * 180 / pi;
}

static void heave_check(double k, int n) {
    static const char theory[] = "2i exp(-ik)/(pi k (H1(k) + i H0(k))), Theodorsen";
    const double complex exact = exact_ratio(k), obtained = heave(k, n, point_vortices(0)).circulation;
    verify_relative(verify_text("heaving plate, k = %g: amplitude, %d intervals a period", k, n), theory, cabs(exact),
                    cabs(exact * obtained), 0.01);
    verify_value(verify_text("heaving plate, k = %g: phase, degrees", k), theory, degrees(exact),
                 degrees(exact) + degrees(obtained), 1);
}

static void heave_study(void) {
    double error[4];
    for (int i = 0; i < 3; i++) {
        const int n = 250 << i;
        const double complex obtained = heave(0.5, n, point_vortices(0)).circulation;
        error[i] = cabs(obtained - 1);
        verify_point("heave_interval", "amplitude", pi * 2 / n, fabs(cabs(obtained) - 1));
        verify_point("heave_interval", "phase / rad", pi * 2 / n, fabs(carg(obtained)));
    }
    verify_order("heaving plate, k = 0.5: order in Dt, smoothing 1e-5", "reached: 1/2, as for the impulsive start",
                 verify_order_of_errors(error[1], error[2]), 0.4, 0.6);
    const double complex single = heave(1, 314, smoothed).circulation;
    verify_show("heaving plate, k = 1, continuous, smoothing 0.2: amplitude", "over the exact one", cabs(single));
    verify_show("heaving plate, k = 1, continuous, smoothing 0.2: phase", "degrees ahead of the exact one",
                degrees(single));
}

/* At default settings, U Dt = 0.01 L or, for the slowest, 0.02. */
static void heave_by_default(void) {
    static const double k[] = {0.1, 0.25, 0.5, 1, 2};
    for (int i = verify_is_fast() ? 4 : 0; i < 5; i++) {
        const double interval = k[i] < 0.2 ? 0.02 : 0.01;
        const struct heaving got = heave(k[i], (int)lround(pi / k[i] / interval), defaults);
        const double complex of[2] = {got.circulation, got.lift};
        static const char *const name[2] = {"circulation", "lift"};
        static const char *const theory[2] = {"2i exp(-ik)/(pi k (H1(k) + i H0(k))), Theodorsen",
                                              "pi b^2 i omega + 2 pi U b C(k), Theodorsen"};
        for (int what = 0; what < 2; what++) {
            verify_relative(
                verify_text("heaving plate at default settings, k = %g: amplitude of the %s", k[i], name[what]),
                theory[what], 1, cabs(of[what]), 0.015);
            verify_zero(
                verify_text("heaving plate at default settings, k = %g: phase of the %s, degrees", k[i], name[what]),
                theory[what], degrees(of[what]), 1);
        }
    }
}

void verify_plate(void) {
    start_by_default();
    heave_by_default();
    start_values();
    order_in_the_interval();
    order_in_the_smoothing();
    convergence_in_the_sheet();
    if (verify_is_fast()) return;
    figure_of_the_start();
    heave_check(0.1, 1200);
    heave_check(0.5, 2000);
    heave_check(1, 2200);
    heave_study();
}
