/* static.c: The section "static" (doc/steady.md, "Equilibria without a beat") compares foils and plates at rest in a
 * stream with thin airfoils, Euler's column and the elastica, which have solvers of their own here, and with runs.
 * Density, length and span are 1. */
#include <lapacke.h>
#include <math.h>

#include "linear_theory.h"
#include "steady/steady_problem.h"
#include "steady/steady_static.h"
#include "verify.h"

static const double pi = 3.14159265358979323846;

// ---- a body in a stream along x

struct body {
    int n_nodes;
    double speed, angle; /* of the stream; of the nose to the stream, degrees */
    double thickness, stiffness;
    const char *prescribed, *more; /* further keys of the fish */
    double end;                    /* of a run, s */
    double depth;                  /* 0: the length */
};

static const char pressure[] = VERIFY_ATTACHED,
                  finite[] = "force: pressure, drag: {skin: laminar}, pressure: {span: finite, suction_limit: 0}",
                  slender[] = "force: reactive, drag: {tangential: 0}",
                  drag_alone[] = "force: reactive, drag: {tangential: 0}, added_mass: {coefficient: 0}";

static struct simulation *open_body(const struct body *body) {
    return verify_open(
        "format: 1\ntime: {end: %.17g, shedding_interval: 0.04}\n"
        "fluid: {density: 1, velocity: [%.17g, 0]%s}\nwake: {lifetime: %.17g}\nfish:\n"
        "  - {nodes: %d, sheet_points: %d, wave: {amplitude: 0, frequency: 0}, %s,\n"
        "     body: {profile: uniform, thickness: %.17g, depth: %.17g, density: 20, modulus: %.17g,\n"
        "            relaxation_time: 0.2},\n"
        "     start: {heading: %.17g, speed: 0}, motion: {prescribed: %s, speed: 0}}\n",
        fmax(body->end, 1), body->speed, body->more == pressure || body->more == finite ? ", viscosity: 0" : "",
        fmax(body->end / 3, 1), body->n_nodes, 2 * body->n_nodes - 1, body->more, body->thickness,
        body->depth > 0 ? body->depth : 1, body->stiffness / (pi / 64 * pow(body->thickness, 3)), 180 - body->angle,
        body->prescribed);
}

// the equilibrium by `shoal steady`
struct found {
    struct simulation *simulation;
    struct steady_values values;
    struct steady_fish fish;
};

static void find(struct found *found, const struct body *body) {
    *found = (struct found){.simulation = open_body(body)};
    found->values.fish = &found->fish;
    verify_ok(steady_static_refuse(found->simulation->school));
    verify_ok(steady_static_find(found->simulation, NULL, &found->values));
}

static struct steady_fish find_fish(const struct body *body) {
    struct found found;
    find(&found, body);
    return found.fish;
}

// ---- a stiff plate

static const char airfoils[] = "thin airfoils";

// the moment of all pressures about a quarter of the chord
static double quarter_moment(const struct found *found) {
    const struct fish *const fish = &found->simulation->school->fish[0];
    const struct pressure_forces *const on = &found->simulation->diagnostics->fish[0].pressure;
    const double *const x = found->simulation->state->y + fish->at.x, *const y = x + fish->n_nodes;
    const int tail = fish->n_nodes - 1;
    const double arm[2] = {(x[tail] - x[0]) / 4, (y[tail] - y[0]) / 4};
    const double force[2] = {on->pressure[0] + on->suction[0], on->pressure[1] + on->suction[1]};
    return on->pressure_moment + on->suction_moment + arm[0] * force[1] - arm[1] * force[0];
}

static void stiff_plate(void) {
    const int angles[] = {2, 10, 30};
    for (int i = 0; i < 3; i++) {
        const double lift = 2 * pi * sin(angles[i] * pi / 180);
        struct found found;
        find(&found, &(struct body){33, 1, angles[i], 0.02, 1, "all", pressure, 0, 0});
        verify_relative(verify_text("stiff plate at %d degrees: lift coefficient", angles[i]), airfoils, lift,
                        2 * found.fish.lift, 5e-4);
        verify_zero(verify_text("stiff plate at %d degrees: drag over lift", angles[i]), airfoils,
                    found.fish.drag / found.fish.lift, 1e-4);
        verify_zero(verify_text("stiff plate at %d degrees: moment about L/4 over lift", angles[i]), airfoils,
                    quarter_moment(&found) / found.fish.lift, 5e-4);
    }
}

// ---- a flexible plate: Galerkin's method with modes of the clamped beam and the pressure of thin airfoils

enum { N_MODES = LINEAR_THEORY_MODES, N_POINTS = 200 };

// chord x = (1 - cos(phi))/2 and the lift U gamma per length of a plate with given slope at all points:
// gamma = 2 U (A_0 (1 + cos(phi))/sin(phi) + sum A_n sin(n phi)), times sin(phi)
static void load_of(double speed, const double slope[N_POINTS], double load[N_POINTS]) {
    for (int i = 0; i < N_POINTS; i++) load[i] = 0;
    for (int n = 0; n < 40; n++) {
        double coefficient = 0;
        for (int i = 0; i < N_POINTS; i++) coefficient += slope[i] * cos(n * (i + 0.5) * pi / N_POINTS) / N_POINTS;
        for (int i = 0; i < N_POINTS; i++) {
            const double phi = (i + 0.5) * pi / N_POINTS;
            const double shape = n == 0 ? -(1 + cos(phi)) : 2 * sin(n * phi) * sin(phi);
            load[i] += 2 * speed * speed * coefficient * shape;
        }
    }
}

// integral over the chord of a load, which includes sin(phi), with a function
static double integral(const double load[N_POINTS], const double function[N_POINTS]) {
    double sum = 0;
    for (int i = 0; i < N_POINTS; i++) sum += load[i] * function[i] * pi / N_POINTS / 2;
    return sum;
}

struct bent {
    double lift, tip;
};

// at this angle, rad, of the nose to the stream
static struct bent thin_airfoil(double stiffness, double angle) {
    double place[N_MODES][N_POINTS], slope[N_MODES][N_POINTS], load[N_MODES][N_POINTS];
    double straight[N_POINTS], one[N_POINTS], of_angle[N_POINTS], matrix[N_MODES * N_MODES], q[N_MODES];
    lapack_int pivot[N_MODES];
    for (int i = 0; i < N_POINTS; i++) {
        const double x = (1 - cos((i + 0.5) * pi / N_POINTS)) / 2;
        for (int j = 0; j < N_MODES; j++) linear_theory_mode(j, x, &place[j][i], &slope[j][i]);
        straight[i] = -angle;
        one[i] = 1;
    }
    load_of(1, straight, of_angle);
    for (int j = 0; j < N_MODES; j++) load_of(1, slope[j], load[j]);
    for (int i = 0; i < N_MODES; i++) {
        q[i] = integral(of_angle, place[i]);
        for (int j = 0; j < N_MODES; j++) {
            const double own = i == j ? stiffness * pow(linear_theory_mode_number(i), 4) : 0;
            matrix[i + j * N_MODES] = own - integral(load[j], place[i]);
        }
    }
    LAPACKE_dgesv(LAPACK_COL_MAJOR, N_MODES, 1, matrix, N_MODES, pivot, q, N_MODES);
    struct bent bent = {.lift = integral(of_angle, one)};
    for (int j = 0; j < N_MODES; j++) {
        double tip, unused;
        linear_theory_mode(j, 1, &tip, &unused);
        bent.lift += q[j] * integral(load[j], one);
        bent.tip += q[j] * tip;
    }
    return bent;
}

static void flexible_foil(void) {
    const char *const theory = "thin airfoils, Galerkin with 8 modes";
    const double stiffnesses[] = {1, 0.1, 0.02};
    for (int i = 0; i < 3; i++) {
        const struct bent bent = thin_airfoil(stiffnesses[i], pi / 180);
        const struct body body = {33, 1, 1, 0.02, stiffnesses[i], "head", pressure, 0, 0};
        const struct steady_fish found = find_fish(&body);
        verify_relative(verify_text("foil at 1 degree, E I = %g: lift", stiffnesses[i]), theory, bent.lift, found.lift,
                        0.01);
        // to the left of the heading is down
        verify_relative(verify_text("foil at 1 degree, E I = %g: tail", stiffnesses[i]), theory, bent.tip,
                        -found.deflection, 0.01);
    }
}

// ---- a plate with the clamp downstream: mass pi/4 per length of slender bodies, a column under the load of the flow

static double stiffness_of(int n_nodes, double speed) {
    struct found found;
    find(&found, &(struct body){n_nodes, speed, 180, 0.02, 1, "head", slender, 0, 0});
    return found.values.stiffness;
}

static void divergence(void) {
    const char *const euler = "pi/4 U^2 = pi^2 E I/(4 L^2): Euler's column";
    const double critical = sqrt(pi);
    const double parts[] = {0.3, 0.6, 0.9};
    for (int i = 0; i < 3; i++) {
        verify_value(verify_text("stiffness at %g of the divergence", parts[i]), "cos(pi/2 U/U_D)",
                     cos(pi / 2 * parts[i]), stiffness_of(33, parts[i] * critical), 2e-3);
    }
    double error[3];
    for (int i = 0; i < 3; i++) {
        const int n = 8 * (1 << i) + 1;
        const double low = 0.98 * critical, high = 1.02 * critical;
        const double before = stiffness_of(n, low), after = stiffness_of(n, high);
        error[i] = (low + (high - low) * before / (before - after)) / critical - 1;
    }
    verify_zero("speed of divergence, 33 nodes: relative error", euler, error[2], 1e-3);
    verify_order("speed of divergence", euler, verify_order_of_errors(error[1], error[2]), 1.7, 2.3);
}

// ---- a plate across the stream: the elastica with a normal drag 1/2 U_n^2, Cauchy number Ca = U^2/(2 E I)

// over the distance from the tip: angle to the stream, slope, and the force beyond, relative to a stiff plate
static void bend(double cauchy, const double z[4], double rate[4]) {
    const double f = sin(z[0]) * fabs(sin(z[0]));
    rate[0] = z[1];
    rate[1] = cauchy * (z[2] * sin(z[0]) - z[3] * cos(z[0]));
    rate[2] = f * sin(z[0]);
    rate[3] = -f * cos(z[0]);
}

// z at the clamp for an angle at the tip: Runge-Kutta of order 4
static void shoot(double cauchy, double angle, double z[4]) {
    enum { N_STEPS = 1000 };
    const double h = 1.0 / N_STEPS;
    z[0] = angle;
    z[1] = z[2] = z[3] = 0;
    for (int step = 0; step < N_STEPS; step++) {
        static const double part[4] = {0, 0.5, 0.5, 1}, weight[4] = {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6};
        double rate[4] = {0}, sum[4] = {0};
        for (int stage = 0; stage < 4; stage++) {
            double at[4];
            for (int i = 0; i < 4; i++) at[i] = z[i] + h * part[stage] * rate[i];
            bend(cauchy, at, rate);
            for (int i = 0; i < 4; i++) sum[i] += weight[stage] * rate[i];
        }
        for (int i = 0; i < 4; i++) z[i] += h * sum[i];
    }
}

// drag relative to a stiff plate: the least angle at the tip for a clamp across the stream
static double elastica(double cauchy) {
    double z[4], low = log(1e-9), high = low;
    for (z[0] = 0; z[0] < pi / 2 && high < 1; high += 0.05) shoot(cauchy, exp(high), z);
    low = high - 0.1;
    for (int i = 0; i < 60; i++) {
        const double middle = (low + high) / 2;
        shoot(cauchy, exp(middle), z);
        if (z[0] < pi / 2) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return z[2];
}

static double drag_at(int n_nodes, double cauchy) {
    const double speed = sqrt(2 * cauchy);
    return 2 * find_fish(&(struct body){n_nodes, speed, 90, 0.003, 1, "head", drag_alone, 0, 0}).drag / (speed * speed);
}

static void reconfiguration(void) {
    const double cauchy[] = {1, 10, 100, 1000, 10000}, bound[] = {1e-4, 1e-4, 1e-4, 1e-3, 0.01};
    double log_cauchy[2], log_drag[2];
    for (int i = 0; i < 5; i++) {
        const double reference = elastica(cauchy[i]), drag = drag_at(65, cauchy[i]);
        verify_relative(verify_text("plate across the stream, Ca = %g: drag", cauchy[i]), "the elastica, by shooting",
                        reference, drag, bound[i]);
        verify_point("reconfiguration", "elastica", cauchy[i], reference);
        verify_point("reconfiguration", "program", cauchy[i], drag);
        if (i < 3) continue;
        log_cauchy[i - 3] = log(cauchy[i]);
        log_drag[i - 3] = log(drag);
    }
    const double vogel = 2 * (log_drag[1] - log_drag[0]) / (log_cauchy[1] - log_cauchy[0]);
    verify_value("plate across the stream: Vogel's exponent", "-2/3: Alben et al. 2002, Luhar and Nepf 2011", -2.0 / 3,
                 vogel, 0.02);
}

// ---- where runs end

// the largest distance of two bodies
static double distance_of(const struct simulation *one, const struct simulation *other) {
    const struct fish *const fish = &one->school->fish[0];
    double most = 0;
    for (int i = fish->at.x; i < fish->at.vx; i++) most = fmax(most, fabs(one->state->y[i] - other->state->y[i]));
    return most;
}

static double distance_of_run(const struct body *body) {
    struct found found;
    find(&found, body);
    struct simulation *const run = open_body(body);
    verify_run(run, body->end);
    return distance_of(found.simulation, run);
}

static void ends_of_runs(void) {
    const char *const run = "a converged run: 80 s";
    verify_zero("foil at 6 degrees, E I = 0.05: places", run,
                distance_of_run(&(struct body){17, 0.5, 6, 0.05, 0.05, "head", pressure, 80, 0}), 1e-4);
    // the wake of the run is convected by the own velocity, which is of second order in the angle
    verify_zero("foil at 6 degrees, E I = 0.05, w/L = 0.5: places", run,
                distance_of_run(&(struct body){17, 0.5, 6, 0.05, 0.05, "head", finite, 80, 0.5}), 5e-4);
    verify_zero("plate across the stream, Ca = 8: places", run,
                distance_of_run(&(struct body){9, 0.5, 90, 0.05, 0.0156, "head", drag_alone, 80, 0}), 1e-4);
}

// ---- finite span

/* Lift of the stiff plate at a small angle, as in the section "depth": beside lifting surfaces
 * (data/lifting_surface.csv), with the error of the kernel. */
static void finite_span(void) {
    static const struct {
        double depth, slope, least, most;
    } wings[] = {{0.1, 0.1570, 0.995, 1.01},
                 {0.25, 0.3916, 0.995, 1.01},
                 {1, 1.4602, 1.02, 1.04},
                 {4, 3.6119, 1.065, 1.085},
                 {20, 5.4332, 1.035, 1.055}};
    for (size_t i = 0; i < sizeof wings / sizeof *wings; i++) {
        const double w = wings[i].depth, angle = 0.5;
        const struct body wing = {w < 0.2 ? 33 : 25, 1, angle, 0.02, 1, "all", finite, 0, w};
        verify_regression(verify_text("wing, w/L = %g: slope of the lift", w), "lifting surface", wings[i].slope,
                          2 * find_fish(&wing).lift / (w * sin(angle * pi / 180)), wings[i].least, wings[i].most);
    }

    // the load of a deep wing is less by the fraction 2 L/w (Prandtl), here of a deflection of 0.02
    const struct body plane = {17, 1, 6, 0.01, 0.05, "head", pressure, 0, 0};
    struct body deep = plane;
    deep.more = finite;
    deep.depth = 1e4;
    struct found one, other;
    find(&one, &plane);
    find(&other, &deep);
    verify_zero("foil at 6 degrees, E I = 0.05, w/L = 10000: places less those in two dimensions", "two dimensions",
                distance_of(one.simulation, other.simulation), 1e-5);
}

void verify_static(void) {
    stiff_plate();
    flexible_foil();
    divergence();
    reconfiguration();
    finite_span();
    if (!verify_is_fast()) ends_of_runs();
}
