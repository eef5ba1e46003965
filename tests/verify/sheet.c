/* sheet.c: the section "sheet": the bound sheet alone against the closed forms of thin plates and circular arcs, and
 * bent fish against themselves with many nodes.
 *
 * The rows of impermeability and Kelvin of the residual are linear in the strengths: probing the residual with unit
 * strengths gives the matrix, and a dense solver of this file solves the system. The checks therefore measure the
 * discretisation and not the tolerance of a solver.
 *
 *     no circulation:  M - 1 times impermeability, sum of q_j = 0
 *     steady Kutta:    M - 1 times impermeability, q_{M-1} = 0: the starting vortex is infinitely far away
 */
#include <complex.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "force/bound_sheet.h"
#include "verify.h"

static const double pi = 3.14159265358979323846;
static const double incidence = 10 * 3.14159265358979323846 / 180; /* of a stream of 1 m/s on a body of length 1 m */

/* The line through the nodes, and the choice of control points. */
struct scheme {
    const char *name, *curve, *collocation;
};
static const struct scheme schemes[] = {
    {"chebyshev", "polygon", "chebyshev"}, {"midpoint", "polygon", "midpoint"}, {"smooth", "smooth", "chebyshev"}};
enum { CHEBYSHEV, MIDPOINT, SMOOTH, N_SCHEMES };
enum closure { NO_CIRCULATION, STEADY_KUTTA };
static const char *const closures[] = {"no circulation", "Kutta"};

// ---- the sheet's linear system

/* A body at rest in the stream and the system of the bound sheet: matrix * strength = right. */
struct probe {
    struct simulation *simulation;
    const struct fish *fish;
    int n;                 /* M: equations, and strengths */
    double *matrix;        /* row by row                                     (n, n) */
    double *inverse;       /* (n, n) */
    double *right, *sheet; /* right side, and the solution gamma             (n) */
};

static double *numbers(int n) {
    double *const values = calloc((size_t)n, sizeof *values);
    if (!values) abort();
    return values;
}

/* The inverse of a matrix, row by row; Gauss and Jordan with the largest pivot of each column. */
static void invert(int n, const double *matrix, double *inverse) {
    double *const a = numbers(n * n);
    memcpy(a, matrix, (size_t)(n * n) * sizeof *a);
    memset(inverse, 0, (size_t)(n * n) * sizeof *inverse);
    for (int i = 0; i < n; i++) inverse[i * n + i] = 1;
    for (int column = 0; column < n; column++) {
        int pivot = column;
        for (int i = column; i < n; i++) {
            if (fabs(a[i * n + column]) > fabs(a[pivot * n + column])) pivot = i;
        }
        double *const both[2] = {a, inverse};
        const double scale = a[pivot * n + column];
        for (int m = 0; m < 2; m++) {
            for (int j = 0; j < n; j++) {
                const double value = both[m][pivot * n + j] / scale;
                both[m][pivot * n + j] = both[m][column * n + j];
                both[m][column * n + j] = value;
            }
        }
        for (int i = 0; i < n; i++) {
            const double factor = a[i * n + column];
            for (int m = 0; i != column && m < 2; m++) {
                for (int j = 0; j < n; j++) both[m][i * n + j] -= factor * both[m][column * n + j];
            }
        }
    }
    free(a);
}

/* The one-norm of the matrix, or of the inverse, for unknowns multiplied by weight[j]. */
static double norm(int n, const double *matrix, const double *weight, int of_inverse) {
    double largest = 0;
    for (int j = 0; j < n; j++) {
        double sum = 0;
        for (int i = 0; i < n; i++) sum += fabs(matrix[i * n + j]) * (of_inverse ? weight[i] : 1 / weight[j]);
        largest = fmax(largest, sum);
    }
    return largest;
}

/* The rows of the residual that the system consists of. */
static void rows(const struct probe *probe, enum closure closure, const double *y, double *row) {
    struct residual *const residual = probe->simulation->residual;
    double *const value = numbers(probe->simulation->school->n_unknowns);
    if (residual_evaluate(residual, &residual_run, 0, y, probe->simulation->state->yp, value) != STATUS_OK) abort();
    memcpy(row, value + probe->fish->at.gamma, (size_t)probe->n * sizeof *row);
    const int last = probe->n - 1;
    if (closure == STEADY_KUTTA) row[last] = probe->fish->sheet_weight[last] * y[probe->fish->at.gamma + last];
    free(value);
}

static void probe_solve(struct probe *probe, enum closure closure) {
    const int n = probe->n;
    double *const y = numbers(probe->simulation->school->n_unknowns), *const row = numbers(n);
    memcpy(y, probe->simulation->state->y, (size_t)probe->simulation->school->n_unknowns * sizeof *y);
    double *const sheet = y + probe->fish->at.gamma;
    memset(sheet, 0, (size_t)n * sizeof *sheet);
    rows(probe, closure, y, probe->right);
    for (int i = 0; i < n; i++) probe->right[i] *= -1;
    for (int j = 0; j < n; j++) {
        sheet[j] = 1;
        rows(probe, closure, y, row);
        for (int i = 0; i < n; i++) probe->matrix[i * n + j] = row[i] + probe->right[i];
        sheet[j] = 0;
    }
    invert(n, probe->matrix, probe->inverse);
    for (int i = 0; i < n; i++) {
        probe->sheet[i] = 0;
        for (int j = 0; j < n; j++) probe->sheet[i] += probe->inverse[i * n + j] * probe->right[j];
    }
    free(y);
    free(row);
}

/* A body with n_nodes nodes and n sheet points; kutta: rate sheds nothing at the start. */
static struct probe probe_open(const struct scheme *scheme, int n, int n_nodes, const char *prescribed) {
    struct probe probe = {.n = n};
    probe.simulation = verify_open(
        VERIFY_ARTICLE
        "format: 1\ntime: {end: 1, shedding_interval: 0.1, output_interval: 1}\nfluid: {velocity: [%.17g, %.17g]}\n"
        "sheet: {kutta: rate, curve: %s, collocation: %s}\nfish:\n"
        "  - {nodes: %d, sheet_points: %d, wave: {amplitude: 0}, start: {heading: 180, speed: 0},\n"
        "     motion: {prescribed: %s, speed: 0}}\n",
        cos(incidence), sin(incidence), scheme->curve, scheme->collocation, n_nodes, n, prescribed);
    probe.fish = &probe.simulation->school->fish[0];
    probe.matrix = numbers(n * n);
    probe.inverse = numbers(n * n);
    probe.right = numbers(n);
    probe.sheet = numbers(n);
    return probe;
}

static void probe_close(struct probe *probe) {
    simulate_free(probe->simulation);
    free(probe->matrix);
    free(probe->inverse);
    free(probe->right);
    free(probe->sheet);
}

static double probe_circulation(const struct probe *probe) {
    double sum = 0;
    for (int j = 0; j < probe->n; j++) sum += probe->fish->sheet_weight[j] * probe->sheet[j];
    return sum;
}

/* The strength of the sheet at bound vortex j, gamma_j. */
static double probe_strength(const struct probe *probe, int j) {
    double *const y = numbers(probe->simulation->school->n_unknowns);
    memcpy(y, probe->simulation->state->y, (size_t)probe->simulation->school->n_unknowns * sizeof *y);
    y[probe->fish->at.gamma + j] = probe->sheet[j];
    const double strength = bound_sheet_strength(probe->fish, j, y);
    free(y);
    return strength;
}

/* Largest difference between q_j and the circulation of the strength density(s), both per angle theta with s = (1 - cos
 * theta)/2, between the tips, at which the density is infinite; in_middle: over a quarter to three quarters of the
 * angle, 0.15 < s/L < 0.85, with ends that are bound vortices at every M used here. */
static double probe_error(const struct probe *probe, enum closure closure, double (*density)(enum closure, double),
                          int in_middle) {
    const int last = probe->n - 1;
    double largest = 0;
    for (int j = 1; j < last; j++) {
        const double theta = pi * j / last, s = (1 - cos(theta)) / 2;
        if (in_middle && (4 * j < last || 4 * j > 3 * last)) continue;
        const double per_angle = probe->fish->sheet_weight[j] * probe->sheet[j] * last / pi;
        largest = fmax(largest, fabs(per_angle - density(closure, s) * sin(theta) / 2));
    }
    return largest;
}

/* Errors of one solution. All over U L. */
struct errors {
    double strength, middle; /* of q_j between the tips, and in the middle */
    double circulation;
    double gamma; /* of gamma_j where theta = pi/4, relative */
};

static struct errors probe_errors(struct probe *probe, enum closure closure, double (*density)(enum closure, double),
                                  double circulation) {
    probe_solve(probe, closure);
    const int quarter = (probe->n - 1) / 4;
    const double s = (1 - cos(pi * quarter / (probe->n - 1))) / 2;
    return (struct errors){.strength = probe_error(probe, closure, density, 0),
                           .middle = probe_error(probe, closure, density, 1),
                           .circulation = fabs(probe_circulation(probe) - (closure == STEADY_KUTTA ? circulation : 0)),
                           .gamma = fabs(probe_strength(probe, quarter) / density(closure, s) - 1)};
}

// ---- the flat plate

/* Counter-clockwise circulation is positive: a stream from below turns the sheet at the nose clockwise. */
static double plate_strength(enum closure closure, double s) {
    if (closure == STEADY_KUTTA) return -2 * sin(incidence) * sqrt((1 - s) / s);
    return -2 * sin(incidence) * (0.5 - s) / sqrt(s * (1 - s));
}

static struct errors plate_errors(const struct scheme *scheme, enum closure closure, int n) {
    struct probe probe = probe_open(scheme, n, 4, "all");
    const struct errors errors = probe_errors(&probe, closure, plate_strength, -pi * sin(incidence));
    probe_close(&probe);
    return errors;
}

static void chebyshev_on_a_plate(enum closure closure, const char *source) {
    const struct errors errors = plate_errors(&schemes[CHEBYSHEV], closure, 33),
                        twice = plate_errors(&schemes[CHEBYSHEV], closure, 65);
    verify_zero(verify_text("plate, %s, chebyshev, M = 33: error of q_j", closures[closure]), source, errors.strength,
                1e-10);
    // ds_j is half the distance of the neighbours and no weight of the quadrature: sin(pi/(M-1)) stands for pi/(M-1)
    verify_order(verify_text("plate, %s, chebyshev: order of gamma_j = q_j/ds_j", closures[closure]), source,
                 verify_order_of_errors(errors.gamma, twice.gamma), 1.9, 2.1);
    verify_show(verify_text("plate, %s, chebyshev, M = 33: error of gamma_j", closures[closure]),
                "relative: (pi/(M-1))/sin(pi/(M-1)) - 1", errors.gamma);
}

static void smooth_on_a_plate(enum closure closure, const char *source) {
    const struct errors errors = plate_errors(&schemes[SMOOTH], closure, 33);
    verify_zero(verify_text("plate, %s, smooth, M = 33: error of q_j", closures[closure]), source, errors.strength,
                1e-10);
    verify_zero(verify_text("plate, %s, smooth, M = 33: error of gamma_j", closures[closure]), source, errors.gamma,
                1e-10);
}

static void midpoint_on_a_plate(enum closure closure, const char *source) {
    const struct errors coarse = plate_errors(&schemes[MIDPOINT], closure, 33),
                        fine = plate_errors(&schemes[MIDPOINT], closure, 65);
    verify_show(verify_text("plate, %s, midpoint, M = 33: error of q_j", closures[closure]), source, coarse.middle);
    verify_order(verify_text("plate, %s, midpoint: order of q_j, 0.15 < s/L < 0.85", closures[closure]), source,
                 verify_order_of_errors(coarse.middle, fine.middle), 0.9, 1.1);
    verify_show(verify_text("plate, %s, midpoint: the same next to the tips", closures[closure]), source,
                verify_order_of_errors(coarse.strength, fine.strength));
}

/* With q_{M-1} = 0 the matrix is Cauchy's: sum q = 2 pi U sin(alpha) (sum of control points - sum of vortices), which
 * is exact for both schemes at every M. */
static void circulation_of_a_plate(void) {
    for (int scheme = 0; scheme < N_SCHEMES; scheme++) {
        verify_zero(verify_text("plate, Kutta, %s, M = 33: error of circulation", schemes[scheme].name),
                    "Gamma = pi L U sin(alpha)", plate_errors(&schemes[scheme], STEADY_KUTTA, 33).circulation, 1e-10);
    }
}

static void figure_of_the_plate(void) {
    for (int scheme = 0; scheme <= MIDPOINT; scheme++) {
        for (int closure = NO_CIRCULATION; closure <= STEADY_KUTTA; closure++) {
            for (int n = 9; n <= 129; n = 2 * n - 1) {
                const struct errors errors = plate_errors(&schemes[scheme], (enum closure)closure, n);
                verify_point("sheet_plate", verify_text("%s, %s", schemes[scheme].name, closures[closure]), n,
                             errors.middle);
            }
        }
    }
}

/* The start of the program has the same solution: the rate of the Kutta condition has not shed circulation yet. */
static void start_of_a_run(void) {
    struct probe probe = probe_open(&schemes[CHEBYSHEV], 33, 4, "all");
    probe_solve(&probe, NO_CIRCULATION);
    double largest = 0;
    for (int j = 0; j < probe.n; j++) {
        const double difference = probe.simulation->state->y[probe.fish->at.gamma + j] - probe.sheet[j];
        largest = fmax(largest, fabs(difference) * probe.fish->sheet_weight[j]);
    }
    verify_zero("plate: q_j of KINSOL and KLU against a dense solver", "the same equations, U L = 1 m2/s", largest,
                1e-12);
    probe_close(&probe);
}

/* The one-norm condition of the system with gamma_j, or with q_j, as unknowns. */
static double condition(const struct probe *probe, bool with_circulations) {
    double *const weight = numbers(probe->n);
    for (int j = 0; j < probe->n; j++) weight[j] = with_circulations ? probe->fish->sheet_weight[j] : 1;
    const double product = norm(probe->n, probe->matrix, weight, 0) * norm(probe->n, probe->inverse, weight, 1);
    free(weight);
    return product;
}

static void conditions(void) {
    const int most = verify_is_fast() ? 33 : 129;
    for (int scheme = 0; scheme <= MIDPOINT; scheme++) {
        for (int n = 9; n <= most; n = 2 * n - 1) {
            struct probe probe = probe_open(&schemes[scheme], n, 4, "all");
            probe_solve(&probe, NO_CIRCULATION);
            verify_show(verify_text("condition of the sheet's system, %s, M = %d", schemes[scheme].name, n),
                        "one-norm; impermeability and Kelvin for gamma_j, L = 1 m", condition(&probe, 0));
            verify_point("sheet_condition", verify_text("%s, gamma_j", schemes[scheme].name), n, condition(&probe, 0));
            verify_point("sheet_condition", verify_text("%s, q_j", schemes[scheme].name), n, condition(&probe, 1));
            probe_close(&probe);
        }
    }
}

// ---- the circular arc

/* A sixth of a circle of length 1, nose and tail on the line y = 0, bulging up. Joukowski's map z = w + a^2/w maps the
 * circle through w = -a and a about i a tan(quarter angle) to both sides of the arc, quarter = 15 degrees. */
static const double quarter = 15 * 3.14159265358979323846 / 180;

static double complex arc_place(double s, double complex *tangent) {
    const double radius = 1 / (4 * quarter), angle = (4 * s - 2) * quarter;
    *tangent = cexp(-I * angle);
    return radius * (sin(angle) + I * (cos(angle) - cos(2 * quarter)));
}

/* The velocity along the arc on one side. */
static double arc_side(enum closure closure, double a, double complex w, double complex tangent) {
    const double complex centre = I * a * tan(quarter);
    const double radius = a / cos(quarter);
    // Kutta: the flow in the plane of the circle comes to rest at the point that becomes the tail
    const double circulation = closure == STEADY_KUTTA ? -4 * pi * radius * sin(incidence + quarter) : 0;
    const double complex r = w - centre;
    const double complex flow =
        cexp(-I * incidence) - cexp(I * incidence) * radius * radius / (r * r) + circulation / (2 * pi * I * r);
    return creal(flow / (1 - a * a / (w * w)) * tangent);
}

static double arc_strength(enum closure closure, double s) {
    double complex tangent;
    const double complex z = arc_place(s, &tangent);
    const double a = sin(2 * quarter) / (8 * quarter);
    // (z - 2a)/(z + 2a) = ((w - a)/(w + a))^2 has one root above and one below
    const double complex root = csqrt((z - 2 * a) / (z + 2 * a));
    const double complex one = a * (1 + root) / (1 - root), other = a * (1 - root) / (1 + root);
    const int one_is_above = cimag(one) > cimag(other);
    return arc_side(closure, a, one_is_above ? other : one, tangent) -
           arc_side(closure, a, one_is_above ? one : other, tangent);
}

static double arc_circulation(void) {
    const double a = sin(2 * quarter) / (8 * quarter);
    return -4 * pi * a / cos(quarter) * sin(incidence + quarter);
}

/* Position on a body of length 1 at the fraction s of the length; phase: of the beat. */
typedef double complex line(double s, double phase);

static double complex arc_line(double s, double phase) {
    (void)phase;
    double complex tangent;
    return arc_place(s, &tangent);
}

/* A free body whose nodes lie on a line. */
static struct probe probe_open_bent(const struct scheme *scheme, int n, int n_nodes, line *place, double phase) {
    struct probe probe = probe_open(scheme, n, n_nodes, "none");
    double *const y = probe.simulation->state->y;
    for (int k = 0; k < n_nodes; k++) {
        const double complex z = place((double)k / (n_nodes - 1), phase);
        y[probe.fish->at.x + k] = creal(z);
        y[probe.fish->at.y + k] = cimag(z);
    }
    return probe;
}

static struct errors arc_errors(const struct scheme *scheme, enum closure closure, int n, int n_nodes) {
    struct probe probe = probe_open_bent(scheme, n, n_nodes, arc_line, 0);
    const struct errors errors = probe_errors(&probe, closure, arc_strength, arc_circulation());
    probe_close(&probe);
    return errors;
}

static void figure_of_the_arc(void) {
    const int n_nodes[] = {7, 65, 1025};
    for (int scheme = 0; scheme < N_SCHEMES; scheme++) {
        for (int body = 0; body < 3; body++) {
            for (int n = 9; n <= 129; n = 2 * n - 1) {
                verify_point("sheet_arc", verify_text("%s, %d nodes", schemes[scheme].name, n_nodes[body]), n,
                             arc_errors(&schemes[scheme], STEADY_KUTTA, n, n_nodes[body]).circulation);
            }
        }
    }
}

/* Of the polygon. The body between the nodes is straight. With 1025 nodes the corners add a few per cent to the errors
 * at M = 33 (figure sheet_arc: with 257 nodes 14 % of the error of the circulation, with 65 more than half). */
static void circular_arc(void) {
    static const char source[] = "Joukowski's map of a circle, exact";
    const int n_nodes = 1025;
    for (int scheme = 0; scheme <= MIDPOINT; scheme++) {
        // chebyshev: the normal is the chord's, which is the body's in the middle of the chord, a step squared away
        const double order = scheme == 0 ? 2 : 1, slack = scheme == 0 ? 0.2 : 0.1;
        const char *const name = schemes[scheme].name;
        for (int closure = NO_CIRCULATION; closure <= STEADY_KUTTA; closure++) {
            const struct errors coarse = arc_errors(&schemes[scheme], (enum closure)closure, 17, n_nodes);
            const struct errors fine = arc_errors(&schemes[scheme], (enum closure)closure, 33, n_nodes);
            verify_show(verify_text("arc, %s, %s, M = 33: error of q_j", closures[closure], name), source, fine.middle);
            verify_order(verify_text("arc, %s, %s: order of q_j, 0.15 < s/L < 0.85", closures[closure], name), source,
                         verify_order_of_errors(coarse.middle, fine.middle), order - slack, order + slack);
            if (closure == NO_CIRCULATION) continue;
            verify_order(verify_text("arc, Kutta, %s: order of circulation", name), source,
                         verify_order_of_errors(coarse.circulation, fine.circulation), order - slack, order + slack);
            verify_zero(verify_text("arc, Kutta, %s, M = 33: error of circulation / U L", name), source,
                        fine.circulation, scheme == 0 ? 2e-3 : 4e-2);
        }
    }
    verify_show("arc, Kutta, chebyshev, 7 nodes, M = 21: error of circulation", source,
                arc_errors(&schemes[CHEBYSHEV], STEADY_KUTTA, 21, 7).circulation);
}

/* The smooth curve through few nodes of the arc. */
static void smooth_arc(void) {
    static const char source[] = "Joukowski's map of a circle, exact";
    static const int n_nodes[] = {7, 11, 21, 41};
    static const double bounds[] = {1e-4, 2e-5, 2e-6, 2e-7};
    struct errors errors[4];
    for (int i = 0; i < 4; i++) {
        errors[i] = arc_errors(&schemes[SMOOTH], STEADY_KUTTA, 41, n_nodes[i]);
        const struct errors polygon = arc_errors(&schemes[CHEBYSHEV], STEADY_KUTTA, 41, n_nodes[i]);
        verify_zero(verify_text("arc, Kutta, smooth, N = %d, M = 41: error of circulation / U L", n_nodes[i]), source,
                    errors[i].circulation, bounds[i]);
        verify_show(verify_text("arc, Kutta, polygon, N = %d, M = 41: error of circulation / U L", n_nodes[i]), source,
                    polygon.circulation);
        verify_show(verify_text("arc, Kutta, smooth, N = %d, M = 41: error of gamma_j", n_nodes[i]), source,
                    errors[i].gamma);
        verify_show(verify_text("arc, Kutta, polygon, N = %d, M = 41: error of gamma_j", n_nodes[i]), source,
                    polygon.gamma);
    }
    verify_order("arc, Kutta, smooth: order of circulation in N", source,
                 log(errors[2].circulation / errors[3].circulation) / log(40.0 / 20.0), 3, 4);
}

// ---- a bent fish

static const double mid_beat = 1;

/* A default fish at a phase of the beat: the curvature 6 A (s + 0.2 s^2) sin(phase - 6 s), by Simpson's rule. */
static double complex beat_line(double s, double phase) {
    enum { N_PIECES = 2000 };
    double angle = 0;
    double complex z = 0;
    for (int i = 0; i < N_PIECES; i++) {
        double turn[5];
        for (int k = 0; k < 5; k++) {
            const double q = s * (i + k / 4.0) / N_PIECES;
            turn[k] = s / N_PIECES * 6 * 0.4 * (q + 0.2 * q * q) * sin(phase - 6 * q);
        }
        const double middle = angle + (turn[0] + 4 * turn[1] + turn[2]) / 12;
        const double end = middle + (turn[2] + 4 * turn[3] + turn[4]) / 12;
        z += s / N_PIECES * (cexp(I * angle) + 4 * cexp(I * middle) + cexp(I * end)) / 6;
        angle = end;
    }
    return z;
}

/* Differences of the circulation of two bent fish, and of gamma where theta = pi/4, both relative. */
static struct errors beat_errors(const struct scheme *scheme, int n, int n_nodes, double phase,
                                 const struct probe *reference) {
    struct probe probe = probe_open_bent(scheme, n, n_nodes, beat_line, phase);
    probe_solve(&probe, STEADY_KUTTA);
    const double gamma = probe_strength(&probe, (n - 1) / 4), want = probe_strength(reference, (reference->n - 1) / 4);
    const struct errors errors = {.circulation = fabs(probe_circulation(&probe) / probe_circulation(reference) - 1),
                                  .gamma = fabs(gamma / want - 1)};
    probe_close(&probe);
    return errors;
}

static void bent_fish(void) {
    static const char source[] = "the same with N = 641, smooth";
    static const int n_nodes[] = {9, 17, 33, 65};
    static const double bounds[] = {1e-2, 1e-3, 1e-4, 1e-5};
    struct probe reference = probe_open_bent(&schemes[SMOOTH], 65, 641, beat_line, mid_beat);
    probe_solve(&reference, STEADY_KUTTA);
    double error[4], polygon[4];
    for (int i = 0; i < 4; i++) {
        error[i] = beat_errors(&schemes[SMOOTH], 65, n_nodes[i], mid_beat, &reference).circulation;
        polygon[i] = beat_errors(&schemes[CHEBYSHEV], 65, n_nodes[i], mid_beat, &reference).circulation;
        verify_zero(verify_text("bent fish, smooth, N = %d, M = 65: circulation, relative", n_nodes[i]), source,
                    error[i], bounds[i]);
        verify_show(verify_text("bent fish, polygon, N = %d, M = 65: circulation, relative", n_nodes[i]), source,
                    polygon[i]);
    }
    verify_order("bent fish, smooth: order of circulation in N", source, verify_order_of_errors(error[2], error[3]), 3,
                 4);
    verify_order("bent fish, polygon: order of circulation in N", source,
                 verify_order_of_errors(polygon[2], polygon[3]), 1.2, 1.8);
    probe_close(&reference);
}

/* How the sheet on a body of 17 nodes converges in M: against itself with 129 points. */
static void points_of_a_bent_fish(void) {
    static const int lines[] = {SMOOTH, CHEBYSHEV};
    for (int i = 0; i < 2; i++) {
        const struct scheme *const scheme = &schemes[lines[i]];
        struct probe reference = probe_open_bent(scheme, 129, 17, beat_line, mid_beat);
        probe_solve(&reference, STEADY_KUTTA);
        for (int n = 17; n <= 33; n += 16) {
            const struct errors errors = beat_errors(scheme, n, 17, mid_beat, &reference);
            const char *const source = "the same with M = 129";
            const double bound = n == 17 ? 1e-5 : 1e-9;
            if (lines[i] == SMOOTH) {
                verify_zero(verify_text("bent fish, smooth, N = 17, M = %d: circulation, relative", n), source,
                            errors.circulation, bound);
                verify_zero(verify_text("bent fish, smooth, N = 17, M = %d: gamma_j, relative", n), source,
                            errors.gamma, bound);
            } else {
                verify_show(verify_text("bent fish, polygon, N = 17, M = %d: circulation, relative", n), source,
                            errors.circulation);
                verify_show(verify_text("bent fish, polygon, N = 17, M = %d: gamma_j, relative", n), source,
                            errors.gamma);
            }
        }
        probe_close(&reference);
    }
}

/* The same over half a beat (the other half is the mirror image): the number of points of a swimming fish. Errors of
 * the circulation are relative to the largest circulation of the beat. */
static void points_of_a_beat(const struct scheme *scheme, int n_points, const int *points, int most,
                             struct errors *largest) {
    enum { N_PHASES = 8 };
    struct errors sum[N_PHASES][2];
    double scale = 0;
    for (int i = 0; i < N_PHASES; i++) {
        const double phase = pi * i / N_PHASES;
        struct probe reference = probe_open_bent(scheme, most, 17, beat_line, phase);
        probe_solve(&reference, STEADY_KUTTA);
        const double circulation = fabs(probe_circulation(&reference));
        scale = fmax(scale, circulation);
        for (int m = 0; m < n_points; m++) {
            sum[i][m] = beat_errors(scheme, points[m], 17, phase, &reference);
            sum[i][m].circulation *= circulation;
        }
        probe_close(&reference);
    }
    for (int m = 0; m < n_points; m++) {
        largest[m] = (struct errors){0};
        for (int i = 0; i < N_PHASES; i++) {
            largest[m].circulation = fmax(largest[m].circulation, sum[i][m].circulation / scale);
            largest[m].gamma = fmax(largest[m].gamma, sum[i][m].gamma);
        }
    }
}

static void beat(void) {
    static const int smooth[] = {17, 25}, polygon[] = {33, 161};
    struct errors errors[2];
    points_of_a_beat(&schemes[SMOOTH], 2, smooth, 129, errors);
    verify_zero("bent fish over its beat, smooth, M = 17: circulation", "the same with M = 129, N = 17",
                errors[0].circulation, 1e-5);
    verify_zero("bent fish over its beat, smooth, M = 25: gamma_j", "the same with M = 129, N = 17", errors[1].gamma,
                1e-6);
    points_of_a_beat(&schemes[CHEBYSHEV], 2, polygon, 321, errors);
    for (int i = 0; i < 2; i++) {
        verify_show(verify_text("bent fish over its beat, polygon, M = %d: circulation", polygon[i]),
                    "the same with M = 321, N = 17", errors[i].circulation);
        verify_show(verify_text("bent fish over its beat, polygon, M = %d: gamma_j", polygon[i]),
                    "the same with M = 321, N = 17", errors[i].gamma);
    }
}

static void figures_of_the_curve(void) {
    static const int lines[] = {SMOOTH, CHEBYSHEV};
    struct probe nodes = probe_open_bent(&schemes[SMOOTH], 65, 641, beat_line, mid_beat);
    probe_solve(&nodes, STEADY_KUTTA);
    for (int i = 0; i < 2; i++) {
        const struct scheme *const scheme = &schemes[lines[i]];
        struct probe points = probe_open_bent(scheme, 129, 17, beat_line, mid_beat);
        probe_solve(&points, STEADY_KUTTA);
        for (int n = 6; n <= 96; n *= 2) {
            verify_point("sheet_nodes", verify_text("arc, %s", scheme->curve), n + 1,
                         arc_errors(scheme, STEADY_KUTTA, 65, n + 1).circulation);
            verify_point("sheet_nodes", verify_text("bent fish, %s", scheme->curve), n + 1,
                         beat_errors(scheme, 65, n + 1, mid_beat, &nodes).circulation);
        }
        for (int n = 9; n <= 65; n += 8) {
            verify_point("sheet_points", verify_text("%s, circulation", scheme->curve), n,
                         beat_errors(scheme, n, 17, mid_beat, &points).circulation);
            verify_point("sheet_points", verify_text("%s, gamma_j", scheme->curve), n,
                         beat_errors(scheme, n, 17, mid_beat, &points).gamma);
        }
        probe_close(&points);
    }
    probe_close(&nodes);
}

void verify_sheet(void) {
    static const char *const sources[] = {"gamma = 2 U sin(alpha) (L/2 - s)/sqrt(s (L - s))",
                                          "gamma = 2 U sin(alpha) sqrt((L - s)/s)"};
    for (int closure = NO_CIRCULATION; closure <= STEADY_KUTTA; closure++) {
        chebyshev_on_a_plate((enum closure)closure, sources[closure]);
        smooth_on_a_plate((enum closure)closure, sources[closure]);
        midpoint_on_a_plate((enum closure)closure, sources[closure]);
    }
    circulation_of_a_plate();
    start_of_a_run();
    conditions();
    circular_arc();
    smooth_arc();
    bent_fish();
    points_of_a_bent_fish();
    if (verify_is_fast()) return;
    beat();
    figure_of_the_plate();
    figure_of_the_arc();
    figures_of_the_curve();
}
