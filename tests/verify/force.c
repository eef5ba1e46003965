/* force.c: the section "force": the reactive force (model.md 9) in still fluid: limits of the energy gain,
 * conservation, and closed results for plates.
 *
 * Still fluid: free vortices of a smoothing of 1e6 lengths induce velocities of 1e-12 m/s, and the own sheet does not
 * act on a body. Bodies have no drag and no damping, so only the muscle and the reactive force act. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "body/rod.h"
#include "fish/fish_motion.h"
#include "verify.h"

#define STILL VERIFY_ARTICLE "format: 1\nwake: {smoothing: 1.0e+6}\n"
#define IDEAL                                                                                                 \
    "force: reactive, sheet_points: 5, start: {speed: 0}, body: {section: mean, density: 1000, modulus: %g, " \
    "bending_damping: 0, stretching_damping: 0, relaxation_time: %g}, drag: {tangential: 0, normal: 0}, "     \
    "added_mass: {coefficient: 1, extent: %s}"

static const struct diagnostics_fish *measured(struct simulation *simulation) {
    simulate_measure(simulation);
    return &simulation->diagnostics->fish[0];
}

static double body_energy(const struct diagnostics_fish *fish) {
    return fish->kinetic_energy + fish->bending_energy + fish->stretching_energy;
}

// ---- a fish cannot gain

// a number in [-1, 1]; Knuth's linear congruential generator
static double random_number(uint64_t *seed) {
    *seed = *seed * 6364136223846793005u + 1442695040888963407u;
    return (double)(int64_t)(*seed >> 11) / 4503599627370496.0 - 1;
}

// largest energy from the fluid of a fish with a random gait, over the work of the muscle: without damping the energy
// of the body that did not come from the muscle, less the error of the integration in the energy balance
static double most_gained(uint64_t *seed, int flux, double end, double *speed) {
    const double amplitude = 0.4 + 0.2 * random_number(seed), number = 8 * random_number(seed);
    const double frequency = 1 + 0.5 * random_number(seed), quadratic = random_number(seed);
    struct simulation *const simulation =
        verify_open(STILL "time: {end: %g, shedding_interval: 0.25}\nsolver: {rtol: 1.0e-4}\nfish: [{" IDEAL
                          ", wave: {amplitude: %g, number: %g, frequency: %g, quadratic: %g}}]\n",
                    end, 1e5, 0.0, flux ? "depth" : "thickness", amplitude, number, frequency, quadratic);
    const double before = body_energy(measured(simulation));
    double most = 0;
    for (double t = 0.25; t < end + 0.1; t += 0.25) {
        verify_run(simulation, t);
        const struct diagnostics_fish *const fish = measured(simulation);
        most = fmax(most, body_energy(fish) - before - fish->actuation_work - fish->energy_balance);
        *speed = fmax(*speed, fish->speed);
    }
    most /= fabs(measured(simulation)->actuation_work);
    return most;
}

static void no_gain(void) {
    const int n = verify_is_fast() ? 3 : 200;
    const double end = verify_is_fast() ? 5 : 60;
    for (int flux = 0; flux < 2; flux++) {
        uint64_t seed = 11;
        double most = 0, speed = 0;
        for (int i = 0; i < n; i++) most = fmax(most, most_gained(&seed, flux, end, &speed));
        const char *const tail = flux ? "with the flux at the tail" : "pointed tail";
        char name[120];
        snprintf(name, sizeof name, "%d random gaits, %g s, %s: most gained", n, end, tail);
        verify_zero(name, "from still fluid, over the work of the muscle", most, 1e-9);
        snprintf(name, sizeof name, "%d random gaits, %g s, %s: fastest, m/s", n, end, tail);
        verify_show(name, "mean over a period, from rest", speed);
    }
}

// ---- conservation

// the largest change of the energy of body and fluid less the work of the muscle, over that energy
static double lost(double rtol, double *step) {
    struct simulation *const simulation =
        verify_open(STILL "time: {end: 2, shedding_interval: 0.05}\nsolver: {rtol: %g}\nfish: [{" IDEAL "}]\n", rtol,
                    1e5, 0.0, "thickness");
    double most = 0, largest = 0;
    for (double t = 0.05; t < 2.01; t += 0.05) {
        verify_run(simulation, t);
        const struct diagnostics_fish *const fish = measured(simulation);
        const double energy = body_energy(fish) + fish->added_mass_energy;
        most = fmax(most, fabs(energy - fish->actuation_work));
        largest = fmax(largest, energy);
    }
    struct integrator_counts counts;
    simulate_count(simulation, &counts);
    *step = 2.0 / (double)counts.steps;
    return most / largest;
}

static void conservation(void) {
    enum { MOST = 4 };
    static const char source[] = "no drag, no damping, nothing leaves at the tail: E + T is the work of the muscle";
    const int n = verify_is_fast() ? 3 : MOST;
    double step[MOST], change[MOST], rtol = 1e-4;
    for (int i = 0; i < n; i++) {
        rtol /= 10;
        change[i] = lost(rtol, &step[i]);
        verify_point("energy of body and fluid", "E + T", step[i], change[i]);
        char name[80];
        snprintf(name, sizeof name, "energy of body and fluid, rtol %.0e", rtol);
        // a method of order 2 with steps proportional to rtol^(1/3)
        verify_zero(name, source, change[i], pow(rtol, 2.0 / 3.0));
    }
    verify_order("energy of body and fluid, order in the mean step", source, verify_slope(n, step, change), 1.8, 3.2);
}

static struct simulation *beating(double amplitude, double number, double phase) {
    return verify_open(STILL
                       "time: {end: 1, shedding_interval: 0.05}\nsolver: {method: rk4, step: 0.0005}\nfish: [{" IDEAL
                       ", wave: {ramp: 0, amplitude: %g, number: %g, phase: %g}}]\n",
                       2e4, 0.0, "thickness", amplitude, number, phase);
}

// after a period all velocities are turned round and the wave runs backwards, kbar(T - t)
static void reversal(void) {
    struct simulation *const there = beating(0.4, -6, 20), *const back = beating(-0.4, 6, -20);
    const struct fish *const fish = there->school->fish;
    const int n = 2 * fish->n_nodes;
    double start[64], went = 0, missed = 0;
    memcpy(start, there->state->y + fish->at.x, (size_t)n * sizeof *start);
    verify_run(there, 1);
    double *const y = back->state->y;
    for (int i = 0; i < n; i++) {
        y[fish->at.x + i] = there->state->y[fish->at.x + i];
        y[fish->at.vx + i] = -there->state->y[fish->at.vx + i];
        went = fmax(went, fabs(y[fish->at.x + i] - start[i]));
    }
    if (initial_conditions_solve(back->consistent, &residual_run, 0, y, back->state->yp) != STATUS_OK ||
        back->integrator->restart(back->solver) != STATUS_OK) {
        abort();
    }
    verify_run(back, 1);
    for (int i = 0; i < n; i++) missed = fmax(missed, fabs(y[fish->at.x + i] - start[i]));
    // the method's error, (omega step)^4 with omega the fastest motion of a soft body
    verify_zero("the wave reversed: final less initial position of the nodes", "over the distance before the reversal",
                missed / went, 1e-9);
}

// ---- plates

static const double added_mass = 1000 * M_PI * 0.0625 / 4; /* per length: width 0.25 */

#define PLATE                                                                                               \
    STILL                                                                                                   \
    "time: {end: 1, shedding_interval: 1}\nfish: [{force: reactive, sheet_points: 5, nodes: 11, "           \
    "body: {profile: uniform, section: mean, thickness: 0.1}, wave: {amplitude: 0}, drag: {tangential: 0, " \
    "normal: 0}, added_mass: {coefficient: 1, extent: depth}, motion: {prescribed: all, %s}}]\n"

// force on the plate at time t and moment about the nose, from the balance of the prescribed nodes
static void force_on_plate(const char *motion, double t, double force[2], double *moment) {
    struct simulation *const simulation = verify_open(PLATE, motion);
    const struct fish *const fish = simulation->school->fish;
    double *const y = simulation->state->y, *const value = simulation->residual->scratch;
    for (int k = 0; k < fish->n_nodes; k++) {
        double place[2], velocity[2], acceleration[2];
        fish_prescribed_node(fish, NULL, k, t, place, velocity, acceleration);
        for (int i = 0; i < 2; i++) {
            y[edge_place(fish, i, k)] = place[i];
            y[edge_velocity(fish, i, k)] = velocity[i];
            y[edge_acceleration(fish, i, k)] = acceleration[i];
        }
    }
    if (residual_evaluate(simulation->residual, &residual_run, 0, y, simulation->state->yp, value) != STATUS_OK)
        abort();
    residual_balance(simulation->residual, 0, y, value);
    force[0] = force[1] = *moment = 0;
    for (int k = 0; k < fish->n_nodes; k++) {
        double at_node[2];
        for (int i = 0; i < 2; i++) {
            const int row = edge_acceleration(fish, i, k);
            at_node[i] = fish->mass[k] * y[row] - value[row];
            force[i] += at_node[i];
        }
        *moment += (y[edge_place(fish, 0, k)] - y[fish->at.x]) * at_node[1] -
                   (y[edge_place(fish, 1, k)] - y[fish->at.y]) * at_node[0];
    }
}

static void towed_plate(void) {
    // heading 180 degrees, nose 10 degrees to the left, at 2 m/s
    double force[2], moment;
    force_on_plate("speed: 2, pitch: 10, phase: 90", 0, force, &moment);
    const double alpha = M_PI / 18, wt = -2 * cos(alpha), wn = 2 * sin(alpha);
    verify_relative("towed plate: drag, N", "by hand: the energy left in the wake per second, over the speed",
                    added_mass * wn * wn * -wt / 4, force[0], 1e-12);
    verify_relative("towed plate: side force, N", "by hand: flux at the tail",
                    added_mass * (wt * wn * cos(alpha) - wn * wn / 2 * sin(alpha)), force[1], 1e-12);
    verify_zero("towed plate: moment about the nose over m_L U^2 L, N m",
                "by hand: Munk's couple and the force at the tail cancel", moment / (4 * added_mass), 1e-12);
}

static void oscillating_plate(void) {
    // the plate is at rest at the end of the stroke; the heave is to the left of 180 degrees, downwards
    double force[2], moment;
    force_on_plate("speed: 0, heave: 0.1, frequency: 2", 0.125, force, &moment);
    const double acceleration = 0.1 * 16 * M_PI * M_PI;
    verify_relative("oscillating plate: force at the end of the stroke, N", "by hand: added mass times acceleration",
                    -added_mass * acceleration, force[1], 1e-12);
    verify_relative("oscillating plate: moment about the nose, N m", "by hand: at half of the length",
                    -added_mass * acceleration / 2, moment, 1e-12);
}

// mean thrust of a plate in heave and pitch about the nose over Lighthill's, (m_L/2) mean(hdot^2 - U^2 h'^2)
static double thrust_ratio(double heave, double pitch) {
    enum { N = 64 };
    const double speed = 1.5, phase = 70 * M_PI / 180, omega = 2 * M_PI * 1.2;
    char motion[200];
    snprintf(motion, sizeof motion, "speed: %g, heave: %g, pitch: %.17g, pitch_phase: 70, frequency: 1.2", speed, heave,
             pitch * 180 / M_PI);
    double thrust = 0, lighthill = 0;
    for (int i = 0; i < N; i++) {
        const double angle = 2 * M_PI * i / N;
        double force[2], moment;
        force_on_plate(motion, angle / omega, force, &moment);
        thrust -= force[0] / N;
        // a positive pitch turns the nose to the left and the tail to the right
        const double rate = omega * (heave * cos(angle) - pitch * cos(angle + phase));
        const double slope = pitch * sin(angle + phase);
        lighthill += added_mass / 2 * (rate * rate - speed * speed * slope * slope) / N;
    }
    return thrust / lighthill;
}

static void lighthill_s_thrust(void) {
    double error[2];
    for (int i = 0; i < 2; i++) {
        const double heave = i == 0 ? 0.02 : 0.01, pitch = 1.5 * heave;
        const double ratio = thrust_ratio(heave, pitch);
        error[i] = ratio - 1;
        verify_relative(verify_text("heaving and pitching plate, heave %g L: thrust over Lighthill's", heave),
                        "Lighthill 1960, small amplitude", 1, ratio, 3 * heave * heave);
    }
    verify_order("heaving and pitching plate: thrust, order in the amplitude", "terms of the amplitude squared",
                 verify_order_of_errors(error[0], error[1]), 1.9, 2.1);
}

void verify_force(void) {
    no_gain();
    conservation();
    reversal();
    towed_plate();
    oscillating_plate();
    lighthill_s_thrust();
}
