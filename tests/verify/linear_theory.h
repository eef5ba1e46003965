/* linear_theory.h: independent solvers for the linear theory of thin foils, the references of `make verify`. The
 * solvers share no code with the model in src.
 *
 * A plate of length L and span 1 along the x axis in a stream U towards +x, its nose at x = 0; small displacements y(x,
 * t) = Re(y(x) exp(i omega t)) to the left (+y); b = L/2, k = omega b/U, x = b (1 + cos theta), so that theta = 0 is
 * the tail. [p] is the pressure on the right side less the pressure on the left: the force per area to the left.
 *
 * Sources: T. Theodorsen (1935), NACA report 496; I. E. Garrick (1936), NACA report 567; W. R. Sears (1941), J.
 * Aeronautical Sciences 8; T. Y. Wu (1961), J. Fluid Mech. 10. Tested by the section "theory" of `make verify`. */
#ifndef LINEAR_THEORY_H
#define LINEAR_THEORY_H

#include <complex.h>

/* Theodorsen's function C(k) of the reduced frequency k > 0, and Wagner's lift over the final value after s > 0 half
 * lengths: 1/2 + (2/pi) int (Re C - 1/2) sin(k s)/k dk. */
double complex linear_theory_theodorsen(double k);
double linear_theory_wagner(double s);

/* A fixed plate in a gust v across the stream that moves with the stream. Sears' function: lift over pi density U L v
 * for a sine gust, v its phase at the middle of the plate. Kuessner's function: the same for a step, whose front has
 * moved s > 0 half lengths from the nose; with theta = acos(1 - s) of the front, pi beyond the tail, and Wagner's
 * function,
 * (1/pi) (int_0^theta wagner(s - 1 + cos a) (1 - cos a) da + sin theta). */
double complex linear_theory_sears(double k);
double linear_theory_kuessner(double s);

/* A plate that starts suddenly, after s half lengths, over the final values: shed circulation, and lift once more, from
 * Wagner's integral equation of the wake. */
struct linear_theory_growth {
    double circulation, lift;
};
struct linear_theory_growth linear_theory_growth(double s);

/* Parameters of every plate: L [m], U [m s-1], density of the fluid [kg m-3], omega > 0 [rad s-1]. */
struct linear_theory_plate {
    double length, speed, density, omega;
};

/* Load of the fluid on a plate of span 1 m: the force to the left [N] and the moment about the nose, positive
 * counter-clockwise [N m], as amplitudes; and means over a period: thrust [N] and power of the motion [W]. */
struct linear_theory_load {
    double complex lift, moment;
    double thrust, power;
};

/* A rigid plate: y = heave + pitch (x - axis), heave and axis in m, pitch in rad: Theodorsen and Garrick in closed
 * form. */
struct linear_theory_load linear_theory_rigid(const struct linear_theory_plate *plate, double complex heave,
                                              double complex pitch, double axis);

/* A motion of any shape: coefficients c_n of y = c_0/2 + sum c_n cos(n theta) [m], and of the slope dy/dx [1]. */
enum { LINEAR_THEORY_TERMS = 64 };
struct linear_theory_shape {
    double complex place[LINEAR_THEORY_TERMS], slope[LINEAR_THEORY_TERMS];
};

/* Fill a shape with a function of x/L that gives place [m] and slope [1]. */
struct linear_theory_function {
    void (*at)(double x, const void *data, double complex *place, double complex *slope);
    const void *data;
};
void linear_theory_sample(const struct linear_theory_function *function, struct linear_theory_shape *shape);

/* Load of the fluid on a plate that moves with this shape: Wu's series. */
struct linear_theory_load linear_theory_flexible(const struct linear_theory_plate *plate,
                                                 const struct linear_theory_shape *shape);

/* The speed [m s-1] at which the mean thrust of a heaving plate, amplitude in m, equals a drag friction U^(3/2) of the
 * plate of span 1 m. */
double linear_theory_heaving_speed(const struct linear_theory_plate *plate, double amplitude, double friction);

/* Two of these plates in line heave alike, the second plate `lead` [rad] ahead, with the nose `gap` [m] behind the tail
 * of the first: the mean thrust of the second over the mean thrust of the first. The second plate moves in the far wake
 * of the first, a flat sheet with a velocity smoothed over `smoothing` [m], and does not act on the wake. The sheet
 * moves with U, so the result depends on 2 pi gap/wavelength + lead only, wavelength 2 pi U/omega. */
double linear_theory_follower_thrust(const struct linear_theory_plate *plate, double smoothing, double gap,
                                     double lead);

/* Positions of equal thrust, in wavelengths from 0 to 1 behind the tail, plus any integer: stable if the thrust of the
 * second plate grows with the distance, unstable at the other position. Minus lead/(2 pi). */
struct linear_theory_places {
    double stable, unstable;
};
struct linear_theory_places linear_theory_places(const struct linear_theory_plate *plate, double smoothing);

/* Mean velocity of a free limp plate of this mass per length over density L in a sudden stream across the plate. The
 * impulse of the pressure at a point is density C, C the circulation between the nose and the point. */
double linear_theory_impulse(double mass, double stream);

/* ---- elastic plates, clamped at the nose: Galerkin's method with modes of a clamped beam in vacuum */

enum { LINEAR_THEORY_MODES = 8 };

/* beta L of mode j, from 0, of a beam clamped at x = 0 and free at x = L; and the mode, of mean square 1, at x/L:
 * place, and slope over L. */
double linear_theory_mode_number(int j);
void linear_theory_mode(int j, double x, double *place, double *slope);

/* Mass [kg m-1] and bending stiffness [N m2] of a plate of span 1 m. */
struct linear_theory_body {
    double mass, stiffness;
};

/* The shape of a plate with a clamped nose that heaves with amplitude 1 m; tip: displacement of the tail [m]. */
void linear_theory_driven(const struct linear_theory_plate *plate, const struct linear_theory_body *body,
                          struct linear_theory_shape *shape, double complex *tip);

/* Threshold of flutter of a clamped plate in a stream: the least U* = U L sqrt(mass/stiffness) with a neutral motion,
 * and f L/U of this motion. mass_ratio: M* = density L/mass. */
struct linear_theory_threshold {
    double speed, frequency;
};
struct linear_theory_threshold linear_theory_flutter(double mass_ratio, int n_modes);

#endif
