/* test_reactive.c: Tests the reactive force on a body (doc/model.md, section 9). */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fish/fish_motion.h"
#include "flow/flow_at_bodies.h"
#include "force/edge_force.h"
#include "force/reactive.h"
#include "school.h"

#define TIME "time: {end: 60, shedding_interval: 0.05}\n"
#define SMALL TIME "defaults: {fish: {nodes: 7}}\n"
// free vortices with this smoothing induce velocities of 1e-12 m/s: the fluid is still
#define STILL "wake: {smoothing: 1.0e+6}\n"
#define NO_DRAG "tangential: 0, normal: 0"
#define NO_DAMPING "bending_damping: 0, stretching_damping: 0"

static const double pi = 3.14159265358979323846;

// kinetic energy of still fluid accelerated by an edge, as a function of positions and velocities of the two nodes (x y
// vx vy each)
static double energy_at(const struct fish *fish, const double *state) {
    double y[64] = {0};
    for (int node = 0; node < 2; node++) {
        for (int i = 0; i < 2; i++) {
            y[edge_place(fish, i, node)] = state[2 * node + i];
            y[edge_velocity(fish, i, node)] = state[4 + 2 * node + i];
        }
    }

    const struct edge edge = edge_at(fish, 0, y);
    const double wn = edge_dot(edge.velocity, edge.n);
    return fish->added_mass[0] * wn * wn / 2;
}

// dT/dq of the eight coordinates by differences of fourth order: exact for the velocities
static double slope_of_energy(const struct fish *fish, const double *state, int q) {
    static const double node[4] = {-2, -1, 1, 2}, weight[4] = {1.0 / 12, -8.0 / 12, 8.0 / 12, -1.0 / 12};
    const double h = 1e-4;
    double moved[8], slope = 0;

    memcpy(moved, state, sizeof moved);
    for (int i = 0; i < 4; i++) {
        moved[q] = state[q] + node[i] * h;
        slope += weight[i] / h * energy_at(fish, moved);
    }

    return slope;
}

// state at the time tau from now on the path with these accelerations
static void go_on(const double *state, const double *acceleration, double tau, double *moved) {
    for (int q = 0; q < 4; q++) {
        moved[q] = state[q] + tau * state[4 + q] + tau * tau / 2 * acceleration[q];
        moved[4 + q] = state[4 + q] + tau * acceleration[q];
    }
}

TEST(force_follows_from_lagrange_s_equations_of_the_kinetic_energy) {
    struct setup setup =
        setup_of(TIME "fish: [{nodes: 4, sheet_points: 5, force: reactive, added_mass: {extent: depth}}]\n");
    const struct fish *fish = setup.school->fish;
    const double still[2] = {0, 0};
    for (int trial = 0; trial < 5; trial++) {
        double motion[8], acceleration[4], y[64] = {0};
        for (int q = 0; q < 8; q++) motion[q] = school_random(&setup);
        motion[2] = motion[0] + 0.2 + 0.1 * school_random(&setup);
        for (int q = 0; q < 4; q++) acceleration[q] = school_random(&setup);
        for (int node = 0; node < 2; node++) {
            for (int i = 0; i < 2; i++) {
                y[edge_place(fish, i, node)] = motion[2 * node + i];
                y[edge_velocity(fish, i, node)] = motion[4 + 2 * node + i];
                y[edge_acceleration(fish, i, node)] = acceleration[2 * node + i];
            }
        }

        const struct edge edge = edge_at(fish, 0, y);
        double force[2][2];
        reactive_of_lagrange.force(fish, 0, &edge, edge.velocity, still, force);
        for (int q = 0; q < 4; q++) {
            const double h = 1e-4;
            double before[8], after[8];
            go_on(motion, acceleration, -h, before);
            go_on(motion, acceleration, h, after);
            const double rate = (slope_of_energy(fish, after, 4 + q) - slope_of_energy(fish, before, 4 + q)) / (2 * h);
            // truncation error of the differences in time
            NEAR(force[q / 2][q % 2], slope_of_energy(fish, motion, q) - rate, 1e-4, 1e-5);
        }
    }
}

TEST(a_stream_that_accelerates_acts_as_a_body_that_does_not_and_pushes_what_it_surrounds) {
    struct setup setup = setup_stirred(SMALL "fish: [{force: reactive, added_mass: {extent: depth}}]\n");
    const struct fish *fish = setup.school->fish;
    const double u[2] = {0.4, -0.3}, b[2] = {1.1, 0.7}, still[2] = {0, 0};
    for (int k = 0; k < fish->n_edges; k++) {
        struct edge edge = edge_at(fish, k, setup.state->y);
        const double w[2] = {edge.velocity[0] - u[0], edge.velocity[1] - u[1]};
        double in_stream[2][2], at_rest[2][2];
        reactive_of_lagrange.force(fish, k, &edge, w, b, in_stream);
        for (int i = 0; i < 2; i++) edge.acceleration[i] -= b[i];
        reactive_of_lagrange.force(fish, k, &edge, w, still, at_rest);
        const double displaced = 1000 * pi * fish->thickness[k] * 0.2 / 4 / 6;
        for (int end = 0; end < 2; end++) {
            for (int i = 0; i < 2; i++) NEAR(in_stream[end][i], at_rest[end][i] + displaced * b[i] / 2, 1e-12, 1e-13);
        }
    }
}

// forces on the nodes of a straight plate of 7 nodes along the x axis, nose first, with prescribed motion in still
// fluid
static void forces_on_plate(const char *motion, double t, double force[7][2]) {
    struct setup setup = setup_with(SMALL
                                    "fish: [{force: reactive, body: {profile: uniform, thickness: 0.1, depth: 0.3},\n"
                                    "        drag: {" NO_DRAG
                                    "}, added_mass: {extent: depth, coefficient: 1}, motion: {prescribed: all, %s}}]\n",
                                    motion);
    const struct fish *fish = setup.school->fish;
    double *const y = setup.state->y;
    for (int k = 0; k < fish->n_nodes; k++) {
        double place[2], velocity[2], acceleration[2];
        fish_prescribed_node(fish, NULL, k, t, place, velocity, acceleration);
        for (int i = 0; i < 2; i++) {
            y[edge_place(fish, i, k)] = place[i];
            y[edge_velocity(fish, i, k)] = velocity[i];
            y[edge_acceleration(fish, i, k)] = acceleration[i];
        }
    }

    const double still[64] = {0};
    const struct flow_at_body flow = {.u = still, .v = still};
    edge_force_residual(setup.residual->force, &flow, y, setup.value);
    for (int k = 0; k < 7; k++) {
        force[k][0] = -setup.value[fish->at.ax + k];
        force[k][1] = -setup.value[fish->at.ay + k];
    }
}

static const double mass_per_length = 1000 * 3.14159265358979323846 * 0.09 / 4; /* of the plate above, C_A 1 */

TEST(towed_plate_feels_a_couple_and_loses_at_its_tail) {
    // heading 180 degrees, pitched by 10 degrees at all times, towed at 2 m/s: w_t = -2 cos, w_n = -+2 sin
    double force[7][2], sum[2] = {0, 0}, moment = 0;
    forces_on_plate("speed: 2, pitch: 10, frequency: 0, phase: 90", 0, force);
    const double alpha = pi / 18, wt = -2 * cos(alpha), c = cos(pi + alpha), s = sin(pi + alpha);
    const double t[2] = {-c, -s}, n[2] = {s, -c}, wn = -2 * n[0];
    NEAR(-2 * t[0], wt, 1e-14, 0);
    for (int k = 0; k < 7; k++) {
        // tail flux: acts on the last node only
        if (k == 6) {
            for (int i = 0; i < 2; i++) force[k][i] -= mass_per_length * (wt * wn * n[i] - wn * wn / 2 * t[i]);
        }

        const double arm = k / 6.0;
        moment += arm * (t[0] * force[k][1] - t[1] * force[k][0]);
        for (int i = 0; i < 2; i++) sum[i] += force[k][i];
    }

    // d'Alembert: no force in steady motion; Munk: the couple -mu w_n w_t, mu of the whole plate
    NEAR(sum[0], 0, 1e-11, 0);
    NEAR(sum[1], 0, 1e-11, 0);
    NEAR(moment, -mass_per_length * wn * wt, 0, 1e-12);
}

TEST(oscillating_plate_feels_its_added_mass) {
    // at the end of the stroke the plate is at rest: -mu a on all nodes, half on each end node
    double force[7][2];
    forces_on_plate("speed: 0, heave: 0.1, frequency: 2", 0.125, force);
    const double a =
        0.1 * 16 * pi * pi;  // the heave is to the left of 180 degrees: displacement downwards, acceleration upwards
    for (int k = 0; k < 7; k++) {
        NEAR(force[k][0], 0, 1e-11, 0);
        NEAR(force[k][1], -mass_per_length / 6 * a * (k == 0 || k == 6 ? 0.5 : 1), 0, 1e-12);
    }
}

TEST(mean_thrust_of_a_plate_of_small_amplitude_is_lighthill_s) {
    // heave and pitch at the nose; at the tail h = heave sin + pitch sin(angle + phase) L to the left
    enum { N = 64 };
    const double speed = 1.5, heave = 2e-3, pitch = 3e-3, phase = 70 * pi / 180, omega = 2 * pi * 1.2;
    char motion[200];
    snprintf(motion, sizeof motion, "speed: %g, heave: %g, pitch: %.17g, pitch_phase: 70, frequency: 1.2", speed, heave,
             pitch * 180 / pi);
    double thrust = 0, lighthill = 0;
    for (int i = 0; i < N; i++) {
        const double angle = 2 * pi * i / N;
        double force[7][2];
        forces_on_plate(motion, angle / omega, force);
        for (int k = 0; k < 7; k++) thrust -= force[k][0] / N;  // the heading is along -x

        // a positive pitch turns the nose to the left, and the tail behind the pivot to the right
        const double rate = omega * (heave * cos(angle) - pitch * cos(angle + phase));
        const double slope = pitch * sin(angle + phase);
        lighthill += mass_per_length / 2 * (rate * rate - speed * speed * slope * slope) / N;
    }

    ABOVE(lighthill, 1e-3);

    // relative error of the order of the amplitude squared
    NEAR(thrust, lighthill, 0, 2e-5);
}

static const struct diagnostics_fish *measured(struct simulation *simulation) {
    simulate_measure(simulation);
    return &simulation->diagnostics->fish[0];
}

static double whole_energy(const struct diagnostics_fish *fish) {
    return fish->kinetic_energy + fish->bending_energy + fish->stretching_energy + fish->added_mass_energy;
}

TEST(energy_of_body_and_fluid_is_the_work_of_the_muscle) {
    // no drag, no damping, a pointed tail: energy is conserved
    const double rtol[] = {1e-5, 1e-7};
    double worst[2] = {0, 0};
    for (int i = 0; i < 2; i++) {
        struct simulation *const simulation = school_simulation_of(
            SMALL STILL "solver: {rtol: %g}\nfish: [{force: reactive, start: {speed: 0.5}, drag: {" NO_DRAG
                        "}, added_mass: {extent: thickness}, body: {tail_thickness: 0, modulus: 1.0e+5, "
                        "relaxation_time: 0, " NO_DAMPING "}}]\n",
            rtol[i]);
        const double before = whole_energy(measured(simulation));
        while (simulation->state->t < 2) {
            school_ok(simulate_step(simulation));
            const struct diagnostics_fish *const fish = measured(simulation);
            worst[i] = fmax(worst[i], fabs(whole_energy(fish) - before - fish->actuation_work));
        }

        const struct diagnostics_fish *const fish = measured(simulation);
        print_message("rtol %.0e: %.1e J of %.2f J, %.2f J of them in the fluid\n", rtol[i], worst[i],
                      whole_energy(fish), fish->added_mass_energy);
        ABOVE(fish->added_mass_energy, 0.01);

        // a method of order 2 with steps proportional to rtol^(1/3)
        BELOW(worst[i], pow(rtol[i], 2.0 / 3.0) * whole_energy(fish));

        // the energy balance of the body alone finds the same error
        BELOW(fabs(fish->energy_balance), 2 * worst[i]);
    }

    ABOVE(worst[0] / worst[1], 10);
}

TEST(no_fish_gains_energy_from_still_fluid) {
    struct setup random = {.seed = 7};
    for (int i = 0; i < 5; i++) {
        const double amplitude = 0.4 + 0.2 * school_random(&random), number = 8 * school_random(&random);
        const double frequency = 1 + 0.5 * school_random(&random), quadratic = school_random(&random);
        struct simulation *const simulation =
            school_simulation_of(SMALL STILL "fish: [{force: reactive, start: {speed: 0}, drag: {" NO_DRAG
                                             "}, added_mass: {extent: %s},\n"
                                             "  body: {modulus: 1.0e+5, relaxation_time: 0.001, " NO_DAMPING
                                             "}, wave: {amplitude: %g, number: %g, frequency: %g, quadratic: %g}}]\n",
                                 i % 2 == 0 ? "depth" : "thickness", amplitude, number, frequency, quadratic);
        double gained = 0, fastest = 0;
        while (simulation->state->t < 10) {
            school_ok(simulate_step(simulation));
            const struct diagnostics_fish *const fish = measured(simulation);
            // energy of the body = work of the muscle less damping
            const double in_body = whole_energy(fish) - fish->added_mass_energy;
            gained = fmax(gained, in_body - fish->actuation_work);
            fastest = fmax(fastest, hypot(fish->com_velocity[0], fish->com_velocity[1]));
            AT_MOST(fish->wake_power, 0);
        }

        print_message("number %.1f: %.1e J gained of %.1f J, at most %.2f m/s\n", number, gained,
                      measured(simulation)->actuation_work, fastest);
        AT_MOST(gained, 1e-4 * measured(simulation)->actuation_work);
    }
}

// a fish in still fluid without dissipation that beats from the start
static struct simulation *ideal_fish(double amplitude, double number, double phase) {
    char text[512];
    snprintf(
        text, sizeof text,
        "time: {end: 60, shedding_interval: 0.05}\n" STILL
        "solver: {method: rk4, step: 0.001}\nfish: [{nodes: 7, force: reactive, drag: {" NO_DRAG
        "}, added_mass: {extent: thickness}, body: {tail_thickness: 0, modulus: 2.0e+4, relaxation_time: 0, " NO_DAMPING
        "}, wave: {ramp: 0, amplitude: %g, number: %g, phase: %g}}]\n",
        amplitude, number, phase);
    return school_simulation(text);
}

TEST(reversing_the_wave_reverses_the_path) {
    // after a period the wave is reversed in time: kbar(t) becomes kbar(T - t), and all velocities change sign
    struct simulation *const there = ideal_fish(0.4, -6, 20), *const back = ideal_fish(-0.4, 6, -20);
    const struct fish *fish = there->school->fish;
    double start[14];
    memcpy(start, there->state->y + fish->at.x, sizeof start);
    school_run(there, 1);
    double *const y = back->state->y, gone = 0;
    for (int i = 0; i < 14; i++) {
        y[fish->at.x + i] = there->state->y[fish->at.x + i];
        y[fish->at.vx + i] = -there->state->y[fish->at.vx + i];
        gone = fmax(gone, fabs(y[fish->at.x + i] - start[i]));
    }

    school_ok(initial_conditions_solve(back->consistent, &residual_run, 0, y, back->state->yp));
    school_ok(back->integrator->restart(back->solver));
    school_run(back, 1);
    ABOVE(gone, 0.01);

    // error of the method: (omega step)^4 of the fastest motion
    NEAR_ARRAY(14, y + fish->at.x, start, 1e-5 * gone, 0);
}
