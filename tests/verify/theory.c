/* theory.c: The section "theory" compares the solvers of linear_theory.h with published values, limits in closed form,
 * and each other. It prints the numbers that other sections use. */
#include <complex.h>
#include <math.h>

#include "linear_theory.h"
#include "verify.h"

static const double pi = 3.14159265358979323846;

static double relative(double complex a, double complex b) {
    return cabs(a - b) / cabs(b);
}

// ---- rigid plates

static void published_functions(void) {
    static const struct {
        double k, f, g;
    } table[] = {{0.1, 0.8319, -0.1723}, {0.5, 0.5979, -0.1507}, {1, 0.5394, -0.1003}, {2, 0.5129, -0.0577}};
    for (int i = 0; i < 4; i++) {
        const double complex c = linear_theory_theodorsen(table[i].k);
        verify_value(verify_text("Re C(%g)", table[i].k), "Theodorsen (1935), table", table[i].f, creal(c), 1e-4);
        verify_value(verify_text("Im C(%g)", table[i].k), "Theodorsen (1935), table", table[i].g, cimag(c), 1e-4);
    }
    static const double s[] = {0.1, 0.5, 1, 2, 4, 10};
    for (int i = 0; i < 6; i++) {
        verify_value(verify_text("Wagner's lift over the final value, s = %g", s[i]),
                     "the wake's integral equation, solved by steps", linear_theory_growth(s[i]).lift,
                     linear_theory_wagner(s[i]), 2e-6);
    }
    static const double at[] = {1, 2, 5, 10}, growth[] = {0.41669496, 0.55081397, 0.73882952, 0.85613719};
    for (int i = 0; i < 4; i++) {
        verify_value(verify_text("Wagner's equation solved by steps: G(%g)", at[i]),
                     "f as 16 Chebyshev polynomials (12 agree to 1e-9), not by this program", growth[i],
                     linear_theory_growth(at[i]).circulation, 1e-6);
    }
}

// Sears' function in its other closed form, 1/(i k (K_0(i k) + K_1(i k))), K_n by Hankel's functions; Kuessner's
// function as the integral over Sears' function of all frequencies, (2/pi) int Re(S exp(-i k)) sin(k s)/k dk
static void gusts(void) {
    static const double k[] = {0.1, 1, 5}, s[] = {0.5, 1, 2, 5, 20};
    for (int i = 0; i < 3; i++) {
        const double complex h0 = j0(k[i]) - I * y0(k[i]), h1 = j1(k[i]) - I * y1(k[i]);
        verify_zero(verify_text("Sears' function, k = %g: relative difference of two closed forms", k[i]),
                    "Sears (1941)", relative(linear_theory_sears(k[i]), 2 / (pi * k[i] * (h0 - I * h1))), 1e-12);
    }
    for (int i = 0; i < 5; i++) {
        enum { N = 400000 };
        const double step = 1e-3;
        double sum = 0;
        for (int n = 0; n < N; n++) {
            const double at = (n + 0.5) * step;
            sum += step * creal(linear_theory_sears(at) * cexp(-I * at)) * sin(at * s[i]) / at;
        }
        verify_value(verify_text("Kuessner's function, s = %g", s[i]), "Sears' function of all frequencies",
                     2 / pi * sum, linear_theory_kuessner(s[i]), 2e-4);
    }
}

static void limits(void) {
    const struct linear_theory_plate slow = {1.7, 1.3, 2, 1e-7}, fast = {1.7, 1e-7, 2, 1.9};
    const double b = 0.85;
    verify_zero("steady lift of a plate: relative difference", "2 pi rho U^2 b alpha",
                relative(linear_theory_rigid(&slow, 0, -1, 0.3).lift, 2 * pi * 2 * 1.3 * 1.3 * b), 1e-5);
    verify_zero("its moment", "lift at a quarter of the length",
                relative(linear_theory_rigid(&slow, 0, -1, 0.3).moment, 2 * pi * 2 * 1.3 * 1.3 * b * b / 2), 1e-5);
    verify_zero("force on a plate that heaves in fluid at rest", "pi rho b^2 omega^2",
                relative(linear_theory_rigid(&fast, 1, 0, 0).lift, pi * 2 * b * b * 1.9 * 1.9), 1e-6);
    verify_zero("moment on a plate that rotates about the middle in fluid at rest", "pi rho b^4 omega^2/8",
                relative(linear_theory_rigid(&fast, 0, 1, b).moment, pi * 2 * pow(b, 4) * 1.9 * 1.9 / 8), 1e-6);
}

struct rigid_motion {
    double complex heave, pitch;
    double axis, length;
};
static void rigid_at(double x, const void *data, double complex *place, double complex *slope) {
    const struct rigid_motion *const motion = data;
    *place = motion->heave + motion->pitch * (x * motion->length - motion->axis);
    *slope = motion->pitch;
}

// the series of a rigid motion against the closed form
static void series_of_rigid_motions(void) {
    const struct {
        const char *name;
        double complex heave, pitch;
        double axis;
    } motions[] = {{"heave", 0.1, 0, 0},
                   {"pitch about the nose", 0, 0.2, 0},
                   {"pitch about 0.75 L", 0, 0.2, 1.275},
                   {"heave and pitch 80 degrees later", 0.1, 0.2 * cexp(-I * 80 * pi / 180), 0.4}};
    const struct linear_theory_plate plate = {1.7, 1.3, 2, 1.9};
    for (int i = 0; i < 4; i++) {
        const struct rigid_motion motion = {motions[i].heave, motions[i].pitch, motions[i].axis, plate.length};
        struct linear_theory_shape shape;
        linear_theory_sample(&(struct linear_theory_function){rigid_at, &motion}, &shape);
        const struct linear_theory_load series = linear_theory_flexible(&plate, &shape);
        const struct linear_theory_load closed =
            linear_theory_rigid(&plate, motion.heave, motion.pitch, motions[i].axis);
        const double worst = fmax(fmax(relative(series.lift, closed.lift), relative(series.moment, closed.moment)),
                                  fmax(relative(series.thrust, closed.thrust), relative(series.power, closed.power)));
        verify_zero(verify_text("series for %s: lift, moment, thrust, power", motions[i].name),
                    "Theodorsen, Garrick in closed form", worst, 1e-12);
    }
}

static void heaving_plate(void) {
    const struct linear_theory_plate plate = {2, 1, 1, 2 * pi};
    static const double amplitude[] = {0.1, 0.2}, speed[] = {4.19302, 13.24202};
    for (int i = 0; i < 2; i++) {
        struct linear_theory_plate moving = plate;
        moving.speed = linear_theory_heaving_speed(&plate, amplitude[i], 0.04);
        verify_relative(verify_text("self-propelled heaving plate, A = %g b: U", amplitude[i]),
                        "Garrick's thrust, not by this program", speed[i], moving.speed, 2e-6);
        const double complex c = linear_theory_theodorsen(moving.omega / moving.speed);
        const struct linear_theory_load load = linear_theory_rigid(&moving, amplitude[i], 0, 0);
        verify_relative("its efficiency", "|C|^2/Re C", creal(c * conj(c)) / creal(c),
                        load.thrust * moving.speed / load.power, 1e-12);
    }
}

// ---- elastic plates

static void modes(void) {
    static const double known[] = {1.8751041, 4.6940911, 7.8547574, 10.9955407};
    for (int j = 0; j < 4; j++) {
        verify_value(verify_text("beta L of mode %d of a clamped beam", j + 1), "tables of beams", known[j],
                     linear_theory_mode_number(j), 5e-8);
    }
    double worst = 0;
    for (int j = 0; j < LINEAR_THEORY_MODES; j++) {
        double place, slope, other;
        linear_theory_mode(j, 1, &place, &slope);
        worst = fmax(worst, fabs(fabs(place) - 2));
        linear_theory_mode(j, 0, &place, &slope);
        worst = fmax(worst, fabs(place) + fabs(slope));
        linear_theory_mode(j, 0.6 + 1e-5, &place, &slope);
        linear_theory_mode(j, 0.6 - 1e-5, &other, &slope);
        const double difference = (place - other) / 2e-5;
        linear_theory_mode(j, 0.6, &place, &slope);
        worst = fmax(worst, fabs(difference - slope) / linear_theory_mode_number(j));
    }
    verify_zero("ends of all modes, and slopes against differences", "0, 0 and 2, -2", worst, 1e-7);
}

// without fluid the tip follows the nose as the closed form of the beam says
static void driven_in_vacuum(void) {
    const struct linear_theory_plate plate = {1.7, 1, 1e-12, 5};
    const struct linear_theory_body body = {0.8, 3};
    struct linear_theory_shape shape;
    double complex tip;
    linear_theory_driven(&plate, &body, &shape, &tip);
    const double z = plate.length * pow(body.mass * 25 / body.stiffness, 0.25);
    verify_relative("clamped beam in vacuum, nose heaves: tip over nose",
                    "(cos z + cosh z)/(1 + cos z cosh z), z^4 = m omega^2 L^4/(E I)",
                    (cos(z) + cosh(z)) / (1 + cos(z) * cosh(z)), creal(tip), 1e-4);
}

// int y dx of a shape: cos(n theta) has the mean (1 + cos(n pi))/2/(1 - n^2)
static double complex mean_place(const struct linear_theory_shape *shape) {
    double complex sum = shape->place[0] / 2;
    for (int n = 2; n < LINEAR_THEORY_TERMS; n += 2) sum += shape->place[n] / (1 - n * n);
    return sum;
}

static void driven_plates(void) {
    static const struct {
        double mass, stiffness, tip, degrees;
    } table[] = {{0.1, 0.1, 1.8232, -125.46},
                 {0.1, 1, 1.9674, -107.31},
                 {0.1, 2, 3.0048, -76.49},
                 {0.1, 10, 1.5022, -5.75},
                 {1, 5, 6.0871, -77.55}};
    const struct linear_theory_plate plate = {1, 1, 1, 2 * pi};
    for (int i = 0; i < 5; i++) {
        const struct linear_theory_body body = {table[i].mass, table[i].stiffness};
        struct linear_theory_shape shape;
        double complex tip;
        linear_theory_driven(&plate, &body, &shape, &tip);
        const char *const source = "8 modes, not by this program";
        verify_value(verify_text("clamped plate, k = pi, m = %g, E I = %g: tip over nose", body.mass, body.stiffness),
                     source, table[i].tip, cabs(tip), 5e-5);
        verify_value("its phase, degrees", source, table[i].degrees, carg(tip) * 180 / pi, 5e-3);
        // the power at the nose goes into the fluid: no damping
        const struct linear_theory_load load = linear_theory_flexible(&plate, &shape);
        const double complex force = -plate.omega * plate.omega * body.mass * plate.length * mean_place(&shape);
        const double power = creal((force - load.lift) * conj(I * plate.omega)) / 2;
        verify_relative("power", "force on the nose times velocity", power, load.power, 1e-9);
    }
}

static void flutter(void) {
    static const struct {
        double mass_ratio, speed, frequency, last_mode;
    } table[] = {
        {0.5, 4.9727, 0.5960, 2e-4}, {1, 5.5529, 0.4917, 5e-4}, {3, 8.9208, 0.6574, 5e-4}, {10, 10.6461, 0.7263, 2e-3}};
    for (int i = 0; i < 4; i++) {
        const struct linear_theory_threshold all = linear_theory_flutter(table[i].mass_ratio, LINEAR_THEORY_MODES);
        const char *const source = "8 modes, not by this program";
        verify_relative(verify_text("flutter of a clamped plate, M* = %g: U*", table[i].mass_ratio), source,
                        table[i].speed, all.speed, 2e-5);
        verify_relative("its f L/U", source, table[i].frequency, all.frequency, 1e-4);
        const struct linear_theory_threshold fewer =
            linear_theory_flutter(table[i].mass_ratio, LINEAR_THEORY_MODES - 1);
        verify_zero("relative change of U* by the last mode", "converges with the modes", fewer.speed / all.speed - 1,
                    table[i].last_mode);
    }
}

// ---- a plate behind another one

// H1 = i H0 = sqrt(2/(pi k)) exp(-i (k - 3 pi/4)) where k is large
static void follower(void) {
    const struct linear_theory_plate slow = {1.7, 1.3, 2, 1e-7}, fast = {1.7, 1.3e-4, 2, 1.9},
                                     plate = {1.7, 1.3, 2, 1.9};
    const struct linear_theory_places at_slow = linear_theory_places(&slow, 0),
                                      at_fast = linear_theory_places(&fast, 0);
    verify_value("follower of a plate, k to 0: stable place", "a quarter of a wavelength", 0.25, at_slow.stable, 1e-5);
    verify_value("its unstable place", "three quarters", 0.75, at_slow.unstable, 1e-5);
    verify_value("follower of a plate, k to infinity: stable place", "1 - 1/12", 11.0 / 12, at_fast.stable, 1e-4);
    verify_value("its unstable place", "1/2 + 1/12", 7.0 / 12, at_fast.unstable, 1e-4);
    const double wavelength = 2 * pi * plate.speed / plate.omega, lead = 1.1;
    const double gap = (3 + linear_theory_places(&plate, 0.2).stable - lead / (2 * pi)) * wavelength;
    verify_value("thrust at a stable place over the leader's", "the same", 1,
                 linear_theory_follower_thrust(&plate, 0.2, gap, lead), 1e-12);
}

void verify_theory(void) {
    published_functions();
    gusts();
    limits();
    series_of_rigid_motions();
    heaving_plate();
    modes();
    driven_in_vacuum();
    driven_plates();
    flutter();
    follower();
}
