/* coupled.c: The section "coupled" has bodies under the pressure of the bound sheet: the added mass of a plate, the
 * impulse of a sudden stream, and fish that swim alone and one behind the other. Length L, density of the fluid and
 * span are 1. */
#include <lapacke.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "linear_theory.h"
#include "solver/initial_conditions.h"
#include "verify.h"

static const double pi = 3.14159265358979323846;

enum { MAX_NODES = 33 };

// ---- added mass

/* A free plate along the x axis: mass, E I, and the stream across the plate. */
struct plate {
    int nodes, n_sheet;
    double mass, stiffness, stream, relaxation_time;
};

static struct simulation *open_plate(const struct plate *plate) {
    const double thickness = 0.1;
    return verify_open(
        "format: 1\ntime: {end: 1, shedding_interval: 0.002}\n"
        "fluid: {density: 1, viscosity: 0, velocity: [0, %.17g]}\nfish:\n"
        "  - {nodes: %d, sheet_points: %d, force: pressure, pressure: {span: infinite}, wave: "
        "{amplitude: 0, frequency: 0},\n"
        "     body: {profile: uniform, thickness: %g, depth: 1, density: %.17g, modulus: %.17g,\n"
        "            relaxation_time: %g}}\n",
        plate->stream, plate->nodes, plate->n_sheet, thickness, plate->mass / (pi / 4 * thickness),
        plate->stiffness / (pi / 64 * pow(thickness, 3)), plate->relaxation_time);
}

// the added momentum of the nodes of a plate in still fluid for given velocities across the plate, without shedding
static void added_momentum(struct simulation *simulation, const double *velocity, double *momentum) {
    const struct fish *fish = simulation->school->fish;
    double *const y = simulation->state->y;
    for (int k = 0; k < fish->n_nodes; k++) y[fish->at.vy + k] = velocity[k];
    const struct residual_mode start = {.shed = SHED_IS_GIVEN, .velocities_are_given = true};
    verify_ok(initial_conditions_solve(simulation->consistent, &start, 0, y, simulation->state->yp));
    memcpy(momentum, simulation->residual->force[0].momentum + fish->n_nodes, (size_t)fish->n_nodes * sizeof *momentum);
}

// the added mass of one motion by another
static double added_mass(struct simulation *simulation, const double *velocity) {
    double momentum[MAX_NODES], sum = 0;
    added_momentum(simulation, velocity, momentum);
    for (int k = 0; k < simulation->school->fish[0].n_nodes; k++) sum += momentum[k] * velocity[k];
    return sum;
}

// the smallest eigenvalue of the symmetric part of the matrix from velocities to momenta
static double smallest_eigenvalue(struct simulation *simulation) {
    const int n = simulation->school->fish[0].n_nodes;
    double matrix[MAX_NODES * MAX_NODES], symmetric[MAX_NODES * MAX_NODES], value[MAX_NODES];
    for (int i = 0; i < n; i++) {
        double velocity[MAX_NODES] = {0};
        velocity[i] = 1;
        added_momentum(simulation, velocity, matrix + i * n);
    }
    for (int i = 0; i < n; i++) {
        for (int k = 0; k < n; k++) symmetric[i * n + k] = (matrix[i * n + k] + matrix[k * n + i]) / 2;
    }
    LAPACKE_dsyev(LAPACK_ROW_MAJOR, 'N', 'U', n, symmetric, n, value);
    return value[0];
}

static void added_masses(void) {
    const struct {
        int nodes, points;
        double heave, rotation, least; /* bounds, and the smallest eigenvalue */
    } cases[] = {{17, 33, 3e-5, 1.2e-4, 1.6e-4}, {17, 65, 4e-6, 1.5e-5, 0}, {33, 65, 4e-6, 1.5e-5, 4.0e-5}};
    for (int i = 0; i < 3; i++) {
        const struct plate plate = {cases[i].nodes, cases[i].points, 1, 1, 0, 0};
        struct simulation *const simulation = open_plate(&plate);
        double heave[MAX_NODES], rotation[MAX_NODES];
        for (int k = 0; k < plate.nodes; k++) {
            heave[k] = 1;
            rotation[k] = k / (plate.nodes - 1.0) - 0.5;
        }
        verify_relative(verify_text("added mass of heave, N = %d, M = %d", plate.nodes, plate.n_sheet), "pi/4 rho L^2",
                        pi / 4, added_mass(simulation, heave), cases[i].heave);
        verify_relative(
            verify_text("added mass of rotation about the middle, N = %d, M = %d", plate.nodes, plate.n_sheet),
            "pi/128 rho L^4", pi / 128, added_mass(simulation, rotation), cases[i].rotation);
        if (cases[i].least > 0) {
            verify_relative(verify_text("smallest eigenvalue, N = %d, M = %d", plate.nodes, plate.n_sheet),
                            "positive; the number is the prototype's", cases[i].least, smallest_eigenvalue(simulation),
                            0.05);
        }
    }
}

// ---- a stream of 0.1 across a free plate starts at once: places and momenta stay, velocities jump

static double mean_velocity(const struct simulation *simulation) {
    const struct fish *fish = simulation->school->fish;
    double sum = 0;
    for (int k = 0; k < fish->n_nodes; k++)
        sum += fish->mass[k] / fish->total_mass * simulation->state->y[fish->at.vy + k];
    return sum;
}

// the momenta are the momenta of still fluid; without shedding where stated
static struct simulation *start_stream(const struct plate *plate, enum shed_now shed) {
    struct simulation *const simulation = open_plate(plate);
    const struct fish *fish = simulation->school->fish;
    double *const y = simulation->state->y;
    for (int i = fish->at.px; i < fish->at.ax; i++) y[i] = 0;
    if (shed == SHED_IS_GIVEN) y[fish->at.circulation] = 0;
    const struct residual_mode mode = {.shed = shed};
    verify_ok(initial_conditions_solve(simulation->consistent, &mode, 0, y, simulation->state->yp));
    return simulation;
}

static void impulses(void) {
    const double stream = 0.1, added = pi / 4;
    const struct plate stiff = {17, 33, 0.1, 1e4, stream, 0.01};
    struct simulation *simulation = start_stream(&stiff, SHED_BY_LAW);
    verify_ok(simulation->integrator->restart(simulation->solver));
    verify_run(simulation, 0.002);
    verify_relative("stream of 0.1 starts at once: velocity of a stiff plate, m = 0.1", "0.1 mu/(m + mu)",
                    stream * added / (0.1 + added), mean_velocity(simulation), 1e-3);
    // the velocity falls to 0 at both ends like a square root, within the last edges
    const double masses[] = {0.1, 1};
    for (int i = 0; i < 2; i++) {
        const double exact = linear_theory_impulse(masses[i], stream);
        double error[3];
        for (int n = 0; n < 3; n++) {
            const struct plate limp = {(8 << n) + 1, (16 << n) + 1, masses[i], 1e-3, stream, 0};
            simulation = start_stream(&limp, SHED_IS_GIVEN);
            error[n] = mean_velocity(simulation) / exact - 1;
            verify_show(verify_text("relative error of a limp plate, m = %g, N = %d", masses[i], limp.nodes),
                        "sine series of the impulse", error[n]);
        }
        verify_order(verify_text("mean velocity of a limp plate, m = %g, in the nodes", masses[i]),
                     "sine series of the impulse", verify_order_of_errors(error[0], error[2]) / 2, 0.8, 3);
    }
}

// ---- fish

// A fish: curvature 5 S(t/2) (0.2 + 0.8 s) sin(2 pi (t - s)), mass 0.1, E I = 1, E A = 500,
// friction 0.0133 U^1.5; a second fish behind the first if the gap is above 0
static struct simulation *open_fish(int nodes, double interval, double rtol, double start, double end, double gap,
                                    double smoothing) {
    const double thickness = sqrt(16 / 500.0);
    char follower[128] = "";
    if (gap > 0) {
        snprintf(follower, sizeof follower, ", {name: follower, start: {position: [%.17g, 0], speed: %.17g}}", 1 + gap,
                 start);
    }
    return verify_open(
        "format: 1\ntime: {end: %g, shedding_interval: %.17g}\n"
        "fluid: {density: 1, viscosity: 1.003e-4}\nwake: {lifetime: 8, smoothing: %g}\n"
        "solver: {rtol: %g}\ndefaults: {fish: {nodes: %d, sheet_points: %d, " VERIFY_ATTACHED
        ", start: {speed: %.17g},\n"
        "  wave: {amplitude: 0.83333333333333337, constant: 0.2, linear: 0.8, quadratic: 0,\n"
        "         number: -6.2831853071795862, ramp: 2},\n"
        "  body: {profile: uniform, thickness: %.17g, depth: 1, density: %.17g, modulus: %.17g,\n"
        "         relaxation_time: 0.002}}}\nfish: [{name: leader}%s]\n",
        end, interval, smoothing, rtol, nodes, 2 * nodes - 1, start, thickness, 0.1 / (pi / 4 * thickness),
        64 / (pi * pow(thickness, 3)), follower);
}

// the speed in the sixth beat, and the checks that every such run passes
static double swim(int nodes, double interval) {
    struct simulation *const simulation = open_fish(nodes, interval, 1e-5, 0.65, 6, 0, 0.1);
    verify_run(simulation, 6);
    simulate_measure(simulation);
    const struct diagnostics_fish *of = simulation->diagnostics->fish;
    const double speed = of->speed;
    verify_zero(verify_text("free fish, N = %d, Dt = %g: energy balance over the muscle's work", nodes, interval),
                "rtol 1e-5", of->energy_balance / of->actuation_work, 1e-3);
    verify_zero(verify_text("free fish, N = %d, Dt = %g: total circulation", nodes, interval), "Kelvin",
                simulation->diagnostics->total_circulation, 1e-10);
    return speed;
}

static void free_fish(void) {
    // the prototype had a polygon, of first order in the nodes: 0.6888 with 17, 0.681 with 33
    const double prototype = 2 * 0.681 - 0.6888, intervals[] = {0.02, 0.01, 0.005};
    double speed[3];
    for (int i = 0; i < 3; i++) {
        speed[i] = swim(17, intervals[i]);
        verify_relative(verify_text("free fish, beat 6: speed, N = 17, Dt = %g", intervals[i]),
                        "the prototype's, in the limit of many nodes", prototype, speed[i], 0.007);
    }
    verify_relative("free fish, beat 6: speed, Dt = 0.01", "with Dt = 0.005", speed[2], speed[1], 1e-3);
    const double coarse = swim(9, 0.01), fine = swim(33, 0.01);
    verify_show("free fish, beat 6: speed, N = 9", "", coarse);
    verify_relative("free fish, beat 6: speed, N = 17", "with N = 33", fine, speed[1], 1e-3);
    const double rtols[] = {1e-4, 1e-6}, bounds[] = {6e-3, 3e-4};
    for (int i = 0; i < 2; i++) {
        struct simulation *const simulation = open_fish(17, 0.01, rtols[i], 0.65, 3, 0, 0.1);
        verify_run(simulation, 3);
        simulate_measure(simulation);
        const struct diagnostics_fish *of = simulation->diagnostics->fish;
        verify_zero(verify_text("free fish: energy balance over the work of the muscle, rtol %g", rtols[i]),
                    "the prototype's bound", of->energy_balance / of->actuation_work, bounds[i]);
    }
}

static void followers(void) {
    const double smoothings[] = {0.1, 0.05}, speeds[] = {0.618, 0.597};
    for (int i = 0; i < 2; i++) {
        struct simulation *const simulation = open_fish(17, 0.01, 1e-5, 0.6, 4, 0.3, smoothings[i]);
        verify_run(simulation, 4);
        simulate_measure(simulation);
        verify_relative(verify_text("follower 0.3 L behind, beat 4: speed, smoothing %g L", smoothings[i]),
                        "the prototype's", speeds[i], simulation->diagnostics->fish[1].speed, 0.03);
        verify_zero(verify_text("both, smoothing %g L: total circulation", smoothings[i]), "Kelvin",
                    simulation->diagnostics->total_circulation, 1e-10);
    }
}

void verify_coupled(void) {
    added_masses();
    impulses();
    if (verify_is_fast()) return;
    free_fish();
    followers();
}
