/* depth.c: The section "depth" compares sheets of finite span (doc/model.md, section 18) with their limits, the slender
 * body and two-dimensional flow, and with lifting surfaces between them. Length L = 1 m, density 1. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "flow/flow_at_bodies.h"
#include "solver/initial_conditions.h"
#include "verify.h"

static const double pi = 3.14159265358979323846;

// a plate that heaves in a stream of 1 m/s
static struct simulation *heave_at(double frequency, const char *span, double depth, double amplitude, const char *wake,
                                   const char *walls) {
    return verify_open(
        "format: 1\ntime: {end: 20}\nfluid: {density: 1, viscosity: 0, velocity: [1, 0], walls: [%s]}\n"
        "wake: {%s}\n"
        "fish: [{nodes: 9, sheet_points: %d, force: pressure, wave: {amplitude: 0, frequency: 0},\n"
        "        pressure: {span: %s, suction_limit: 0},\n"
        "        body: {profile: uniform, thickness: 0.02, depth: %.17g},\n"
        "        motion: {prescribed: all, heave: %.17g, frequency: %.17g}}]\n",
        walls, wake, depth < 0.2 ? 65 : 33, span, depth, amplitude, frequency);
}

static struct simulation *heave(const char *span, double depth, double amplitude, const char *wake, const char *walls) {
    return heave_at(0.8, span, depth, amplitude, wake, walls);
}

/* Thrust m (v^2 - U^2 y'^2)/2 and power m U v^2 of a slender body by the motion of the tail, m = pi rho w^2/4. */
static void check_slender(void) {
    const double depth = 0.25, amplitude = 0.03, square = pow(amplitude * 2 * pi * 0.8, 2) / 2;
    const double mass = pi * depth * depth / 4;
    struct simulation *const simulation = heave("finite", depth, amplitude, "lifetime: 3.75", "");
    verify_run(simulation, 5);
    simulate_measure(simulation);
    const struct diagnostics_fish *const of = simulation->diagnostics->fish;
    verify_relative("plate in heave, w/L = 0.25: mean thrust", "Lighthill", mass * square / 2, of->mean_thrust, 0.03);
    verify_relative("plate in heave, w/L = 0.25: mean power", "Lighthill", mass * square, of->mean_power, 0.03);
}

/* Steady lift over that of two dimensions, pi rho U^2 w L alpha, at a small incidence, D lengths after the start. */
static double lift_part(double depth, int n_sheet, double interval, double end) {
    const double angle = 0.01;
    struct simulation *const simulation = verify_open(
        "format: 1\ntime: {end: %.17g, shedding_interval: %.17g, output_interval: %.17g}\n"
        "fluid: {density: 1, viscosity: 0, velocity: [1, %.17g]}\nwake: {lifetime: 1000, decay: 0}\n"
        "fish: [{nodes: 9, sheet_points: %d, force: pressure, wave: {amplitude: 0, frequency: 0},\n"
        "        pressure: {span: finite, suction_limit: 0}, motion: {prescribed: all},\n"
        "        body: {profile: uniform, thickness: 0.02, depth: %.17g}}]\n",
        end, interval, interval, tan(angle), n_sheet, depth);
    verify_run(simulation, end);
    simulate_measure(simulation);
    const struct pressure_forces *const of = &simulation->diagnostics->fish[0].pressure;
    const double force[2] = {of->pressure[0] + of->suction[0], of->pressure[1] + of->suction[1]};
    const double lift = force[1] * cos(angle) - force[0] * sin(angle), speed = 1 / cos(angle);
    return lift / (pi * speed * speed * depth * angle);
}

/* Added mass of a plate that heaves, over pi rho L^2 w/4 of two dimensions, without shed circulation. */
static double added_mass_part(double depth, int n_sheet) {
    struct simulation *const simulation = verify_open(
        "format: 1\ntime: {end: 1}\nfluid: {density: 1, viscosity: 0}\n"
        "fish: [{nodes: 17, sheet_points: %d, force: pressure, wave: {amplitude: 0, frequency: 0},\n"
        "        pressure: {span: finite}, start: {speed: 0},\n"
        "        body: {profile: uniform, thickness: 0.1, depth: %.17g}}]\n",
        n_sheet, depth);
    struct residual *const residual = simulation->residual;
    const struct fish *const fish = &simulation->school->fish[0];
    double *const y = simulation->state->y, mass = 0;
    for (int k = 0; k < fish->n_nodes; k++) y[fish->at.vy + k] = 1;
    struct initial_conditions *initial = NULL;
    const struct residual_mode start = {.shed = SHED_IS_GIVEN, .velocities_are_given = true};
    verify_ok(initial_conditions_create(simulation->arena, &initial, residual));
    verify_ok(initial_conditions_solve(initial, &start, 0, y, simulation->state->yp));
    for (int k = 0; k < fish->n_nodes; k++) mass += residual->force[0].momentum[fish->n_nodes + k];
    return mass / (pi / 4 * depth);
}

/* A rectangular plate beside a lifting surface (data/lifting_surface.csv): steady lift and added mass (error 2e-4),
 * mean power and thrust in heave at k = 1 (error .005). The ratios are the error of the kernel, which is exact for
 * slender bodies and in two dimensions (doc/model.md, section 18). */
static void check_surface(void) {
    static const struct {
        double depth;
        int n_sheet;
        double interval, end;             /* of the steady lift */
        double lift, mass, power, thrust; /* largest ratios */
    } wings[] = {
        {0.1, 65, 0.02, 3, 1.01, 1.015, 1.01, 1.01}, {0.25, 49, 0.02, 4, 1.01, 1.03, 1.01, 1.01},
        {0.5, 49, 0.02, 5, 1.015, 1.06, 1.02, 1.02}, {1, 49, 0.02, 8, 1.035, 1.095, 1.055, 1.05},
        {2, 49, 0.04, 16, 1.065, 1.11, 1.11, 1.11},  {4, 49, 0.05, 30, 1.085, 1.09, 1.125, 1.135},
        {8, 49, 0.05, 60, 1.075, 1.06, 1.09, 1.10},  {20, 49, 0.1, 120, 1.055, 1.03, 1.05, 1.055},
    };
    static const char source[] = "lifting surface";
    FILE *const file = fopen("tests/verify/data/lifting_surface.csv", "r");
    char line[256];
    verify_ok(file ? STATUS_OK : status_fail(STATUS_FILE, "tests/verify/data/lifting_surface.csv is missing"));
    for (size_t i = 0; fgets(line, sizeof line, file) && i < sizeof wings / sizeof *wings;) {
        double w, lift, mass, k, power, thrust;
        if (sscanf(line, "%lf,%lf,%lf,%lf,%lf,%lf", &w, &lift, &mass, &k, &power, &thrust) != 6 || k != 1) continue;
        if (w != wings[i].depth) abort();
        if (verify_is_fast() && w != 1) {
            i++;
            continue;
        }
        const double amplitude = 0.03, frequency = 1 / 3.14, velocity = 2 * pi * frequency * amplitude;
        const double unit = pi / 2 * w * velocity * velocity;
        struct simulation *const simulation = heave_at(frequency, "finite", w, amplitude, "lifetime: 20", "");
        verify_run(simulation, 4 * 3.14);
        simulate_measure(simulation);
        const struct diagnostics_fish *const of = simulation->diagnostics->fish;
        verify_regression(verify_text("plate, w/L = %g: slope of the lift", w), source, lift,
                          2 * pi * lift_part(w, wings[i].n_sheet, wings[i].interval, wings[i].end), 0.995,
                          wings[i].lift);
        verify_regression(verify_text("plate, w/L = %g: added mass over that of two dimensions", w), source, mass,
                          added_mass_part(w, w < 0.2 ? 97 : 65), 0.995, wings[i].mass);
        verify_regression(verify_text("plate in heave, w/L = %g: mean power", w), source, power, of->mean_power / unit,
                          0.99, wings[i].power);
        verify_regression(verify_text("plate in heave, w/L = %g: mean thrust", w), source, thrust,
                          of->mean_thrust / unit, 0.99, wings[i].thrust);
        i++;
    }
    fclose(file);
}

static void check_added_mass(void) {
    verify_relative("plate, w/L = 0.02: added mass over that of two dimensions", "slender body, w/L", 0.02,
                    added_mass_part(0.02, 401), 0.01);
    verify_relative("plate, w/L = 20: added mass over that of two dimensions", "two dimensions", 1,
                    added_mass_part(20, 65), 0.01);
}

// the energy balance of a free fish at the end over the work of its muscle
static void check_energy(const char *name, const char *walls, double end) {
    struct simulation *const simulation = verify_open(
        "format: 1\ntime: {end: %.17g}\nsolver: {rtol: 1e-7}\n"
        "fluid: {walls: [%s]}\n"
        "fish: [{force: pressure, start: {speed: 0.5},\n"
        "        pressure: {span: finite}}]\n",
        end, walls);
    verify_run(simulation, end);
    simulate_measure(simulation);
    const struct diagnostics_fish *const of = simulation->diagnostics->fish;
    verify_zero(verify_text("%s: energy balance after %g s over work", name, end), "first law",
                of->energy_balance / of->actuation_work, 3e-5);
}

// the largest difference of the circulation shed, over the circulation
static double shed_difference(struct simulation *one, struct simulation *other) {
    const int n_quarters = verify_is_fast() ? 4 : 10;
    double most = 0, largest = 0;
    for (int i = 1; i <= n_quarters; i++) {
        verify_run(one, 0.25 * i);
        verify_run(other, 0.25 * i);
        const int shed = one->school->fish[0].at.circulation;
        most = fmax(most, fabs(one->state->y[shed] - other->state->y[shed]));
        largest = fmax(largest, fabs(other->state->y[shed]));
    }
    return most / largest;
}

static const char kept[] = "lifetime: 100, decay: 0";

static void check_deep(void) {
    const double amplitude = 0.175;
    verify_zero("plate in heave, w/L = 10000: circulation shed less that in two dimensions", "two dimensions",
                shed_difference(heave("finite", 1e4, amplitude, kept, ""), heave("infinite", 1e4, amplitude, kept, "")),
                1e-6);
}

// ---- a channel

/* The legs across the channel and the legs of the images are two lines from wall to wall at the distance b = w/2: the
 * flow C dy/(pi H b) falls only like H/w. */
static void check_channel_limits(void) {
    static const struct { double depth, bound; } deep[] = {{1e4, 1e-4}, {1e7, 1e-6}};
    static const char channel[] = "-0.4, 0.6";
    const double amplitude = 0.175;
    for (int i = 0; i < 2; i++) {
        verify_zero(verify_text("plate in heave in a channel, H/L = 1, w/L = %g: circulation shed less that in two "
                                "dimensions",
                                deep[i].depth),
                    "images of vortices",
                    shed_difference(heave("finite", deep[i].depth, amplitude, kept, channel),
                                    heave("infinite", deep[i].depth, amplitude, kept, channel)),
                    verify_is_fast() ? deep[i].bound / 5 : deep[i].bound);
    }
    verify_zero("plate in heave, w/L = 0.25, one wall: circulation shed less that with a second wall at 100 L",
                "one wall",
                shed_difference(heave("finite", 0.25, amplitude, kept, "-0.4"),
                                heave("finite", 0.25, amplitude, kept, "-0.4, 100")),
                1e-6);
}

static struct simulation *in_channel(double y, double phase) {
    return verify_open(
        "format: 1\ntime: {end: 1}\nsolver: {rtol: 1e-8}\nfluid: {viscosity: 0, walls: [-0.5, 0.5]}\n"
        "fish: [{force: pressure, start: {speed: 0.5, position: [0, %.17g]},\n"
        "        wave: {phase: %.17g}, pressure: {span: finite, suction_limit: 0}}]\n",
        y, phase);
}

// flow through the walls, mirror symmetry, momentum of a fish that swims between walls
static void check_channel_fish(void) {
    enum { N = 42 };
    const int n_tenths = verify_is_fast() ? 3 : 10;
    struct simulation *const one = in_channel(0.2, 0), *const mirrored = in_channel(-0.2, 180);
    double most = 0, momentum = 0, through = 0, along = 0, asymmetry = 0;
    for (int i = 1; i <= n_tenths; i++) {
        verify_run(one, 0.1 * i);
        simulate_measure(one);
        const struct diagnostics *const now = one->diagnostics;
        const double *const velocity = now->fish[0].com_velocity;
        most = fmax(most, hypot(now->momentum_balance[0], now->momentum_balance[1]));
        momentum = fmax(momentum, one->school->fish[0].total_mass * hypot(velocity[0], velocity[1]));
    }

    double x[N], y[N], u[N], v[N], u_x[N], u_y[N], v_x[N];
    const double *const at = one->state->y + one->school->fish[0].at.x;
    for (int i = 0; i < N; i++) {
        x[i] = at[0] - 2 + 0.1 * i;
        y[i] = i % 2 == 0 ? -0.5 : 0.5;
    }
    const struct targets points = {.n = N, .x = x, .y = y, .u = u, .v = v, .u_x = u_x, .u_y = u_y, .v_x = v_x};
    flow_field(one->residual->flow, one->state, &points, false);
    for (int i = 0; i < N; i++) {
        through = fmax(through, fabs(v[i]));
        along = fmax(along, fabs(u[i]));
    }

    verify_run(mirrored, 0.1 * n_tenths);
    const int n = one->school->fish[0].n_nodes;
    for (int k = 0; k < n; k++) {
        asymmetry = fmax(asymmetry, fabs(at[k] - mirrored->state->y[k]));
        asymmetry = fmax(asymmetry, fabs(at[n + k] + mirrored->state->y[n + k]));
    }
    verify_zero("a fish in a channel, w/H = 0.25: flow through the walls over flow along the walls", "impermeable",
                through / along, 1e-8);
    verify_zero("a fish in a channel, w/H = 0.25: place less that of the mirrored case, L", "symmetry", asymmetry,
                1e-9);
    verify_zero("a fish in a channel, w/H = 0.25: momentum lost", "momentum of bodies and rings", most / momentum,
                1e-3);
}

// the momentum of a fish, and of two of different depth, is found in the fluid
static void check_momentum(const char *name, const char *fish, double bound) {
    struct simulation *const simulation = verify_open(
        "format: 1\ntime: {end: 2}\nfluid: {viscosity: 0}\n"
        "defaults: {fish: {force: pressure, start: {speed: 0.5},\n"
        "  pressure: {span: finite, suction_limit: 0}}}\nfish: [%s]\n",
        fish);
    double most = 0, momentum = 0;
    for (int i = 1; i <= 20; i++) {
        verify_run(simulation, 0.1 * i);
        simulate_measure(simulation);
        const struct diagnostics *const now = simulation->diagnostics;
        double sum = 0;
        for (int f = 0; f < simulation->school->n_fish; f++) {
            sum += simulation->school->fish[f].total_mass *
                   hypot(now->fish[f].com_velocity[0], now->fish[f].com_velocity[1]);
        }
        most = fmax(most, hypot(now->momentum_balance[0], now->momentum_balance[1]));
        momentum = fmax(momentum, sum);
    }
    verify_zero(name, "momentum of bodies and rings", most / momentum, bound);
}

// The wake of a slow slender fish stays at the tail. A strip that is not rolled up there breaks up: labels grow to 6
// times the circulation shed, and the fish diverges.
static void check_slow_start(void) {
    struct simulation *const simulation = verify_open(
        "format: 1\ntime: {end: 9}\n"
        "fish: [{force: pressure, body: {depth: 0.05},\n"
        "        start: {speed: 0}, pressure: {span: finite}}]\n");
    double label = 0, shed = 0;
    for (int i = 1; i <= 180; i++) {
        verify_run(simulation, 0.05 * i);
        const struct wake *const wake = &simulation->state->wake[0];
        for (int k = 0; k < wake->n_vortex; k++) label = fmax(label, fabs(wake->circulation[k]));
        shed = fmax(shed, fabs(simulation->state->y[simulation->school->fish[0].at.circulation]));
    }
    verify_ratio("a fish from rest, w/L = 0.05: largest label of the wake", "circulation shed", shed, label, 0, 1.5);
}

void verify_depth(void) {
    check_slender();
    check_surface();
    check_added_mass();
    check_deep();
    check_energy("a fish, w/L = 0.25", "", verify_is_fast() ? 2 : 4);
    check_momentum("a fish, w/L = 0.25: momentum lost", "{}", 1e-3);
    check_momentum("two fish, w = 0.25 and 0.4 m: momentum lost",
                   "{}, {body: {depth: 0.4}, start: {position: [0.3, 0.4]}}", 1e-3);
    check_slow_start();
    if (!verify_is_fast()) check_energy("a fish in a channel, H/L = 1, w/L = 0.25", "-0.45, 0.55", 4);
    check_channel_limits();
    check_channel_fish();
}
