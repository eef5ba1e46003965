/* diagnostics_energy.c: powers and energies term by term, and their integrals over time. */
#include "school/diagnostics_energy.h"

#include <math.h>
#include <string.h>

#include "base/mathematics.h"
#include "base/parallel.h"
#include "body/rod.h"
#include "contact/clearance.h"
#include "fish/fish_motion.h"
#include "flow/flow.h"
#include "flow/flow_at_bodies.h"
#include "flow/flow_external.h"
#include "force/force_model.h"
#include "school/diagnostics_momentum.h"

// The strains, the strain rates for the damping, and the stresses for the actuation of fish f. They follow from the
// positions of the nodes or, with strain damping, from the strains and stresses that have been integrated over the
// steps.
static struct rod_strains find_strains(struct residual *residual, int f, const struct actuation *muscle,
                                       const double *y) {
    const struct fish *fish = &residual->school->fish[f];
    const struct energy_balance *const balance = &residual->state->balance[f];
    double *const scratch = residual->scratch;
    const struct rod_strains by_places = {scratch + fish->at.x, scratch + fish->at.vx, scratch + fish->at.ax};
    if (fish->damping == DAMPING_CURVATURE) {
        rod_strains(fish, muscle, y, &by_places);
        return by_places;
    }
    rod_stress_rates(fish, balance->strain, balance->stress, by_places.rate);
    return (struct rod_strains){balance->strain, by_places.rate, balance->stress};
}

struct diagnostics_power diagnostics_power(struct residual *residual, int f, double t, const double *y) {
    const struct fish *fish = &residual->school->fish[f];
    const struct flow_at_body flow = flow_at_body(residual->flow, f);
    const struct fluid_force *const force = &residual->force[f];
    if (force->model->update) force->model->update(force, &flow, y, residual->state->yp);
    const struct fluid_power fluid = force->model->power(force, &flow, y);
    const struct actuation muscle = residual_actuate(residual, f, t, y);
    const struct rod_strains strains = find_strains(residual, f, &muscle, y);

    // internal powers
    const struct rod_clamp_terms clamp = rod_clamp_terms(fish, t, y);
    const struct rod_energetics body = rod_energetics(fish, &muscle, &strains);

    // the load at the tip, the moment on a clamped head, and the constraint forces of prescribed nodes
    const int tail = fish->n_nodes - 1;
    double driving = fish->load_tip[0] * y[fish->at.vx + tail] + fish->load_tip[1] * y[fish->at.vy + tail];
    double driving_force[2] = {fish->load_tip[0], fish->load_tip[1]};
    double *const reaction = residual->scratch;
    if (fish->motion.prescribed != PRESCRIBED_NONE) {
        driving += clamp.driving_power;
        residual_reaction(residual, f, y, residual->state->yp, reaction);
    }
    for (int k = 0; k < fish_n_prescribed(fish); k++) {
        const double fx = fish_is_prescribed(fish, k, 0) ? reaction[fish->at.ax + k] : 0;
        const double fy = reaction[fish->at.ay + k];
        driving += fx * y[fish->at.vx + k] + fy * y[fish->at.vy + k];
        driving_force[0] += fx;
        driving_force[1] += fy;
    }

    struct diagnostics_power power = {.actuation = body.actuation,
                                      .damping = body.damping + clamp.damping_power,
                                      .drag = fluid.drag,
                                      .friction = fluid.friction,
                                      .added_mass = fluid.added_mass,
                                      .wake = fluid.wake,
                                      .pressure = fluid.pressure,
                                      .suction = fluid.suction,
                                      .contact = contact_terms(residual->contact, f, y).power,
                                      .driving = driving};

    // the powers in the frame of the external flow at the centre of mass; without external flow both frames are the
    // same
    const double com[2] = {fish_mass_mean(fish, y + fish->at.x), fish_mass_mean(fish, y + fish->at.y)};
    double stream[2], of_fluid[2];
    power.on_water = power.drag + power.added_mass + power.wake + power.pressure + power.suction;
    power.driving_on_water = power.driving;
    flow_external(residual->school, t, com[0], com[1], &stream[0], &stream[1]);
    if (!(fabs(stream[0]) + fabs(stream[1]) > 0)) return power;
    const struct fluid_forces forces = force->model->forces(force, &flow, com, y);
    diagnostics_fluid_force(forces.resistive, forces.reactive, &forces.pressure, of_fluid);
    for (int i = 0; i < 2; i++) power.on_water -= of_fluid[i] * stream[i];
    for (int i = 0; i < 2; i++) power.driving_on_water -= driving_force[i] * stream[i];
    return power;
}

struct diagnostics_energies diagnostics_energies(struct residual *residual, int f, double t, const double *y) {
    const struct fish *fish = &residual->school->fish[f];
    const struct actuation muscle = residual_actuate(residual, f, t, y);
    const struct rod_strains strains = find_strains(residual, f, &muscle, y);
    const struct rod_energetics body = rod_energetics(fish, &muscle, &strains);
    double kinetic = 0;
    for (int k = 0; k < fish->n_nodes; k++) {
        const double vx = y[fish->at.vx + k], vy = y[fish->at.vy + k];
        kinetic += fish->mass[k] * (vx * vx + vy * vy) / 2;
    }
    return (struct diagnostics_energies){.kinetic = kinetic,
                                         .bending = body.bending + rod_clamp_terms(fish, t, y).energy,
                                         .stretching = body.stretching,
                                         .contact = contact_terms(residual->contact, f, y).energy};
}

double diagnostics_energy(struct residual *residual, int f, double t, const double *y) {
    const struct diagnostics_energies of = diagnostics_energies(residual, f, t, y);
    return of.kinetic + of.bending + of.stretching + of.contact;
}

static void gather_powers(const struct diagnostics_power *power, double *of) {
    of[WORK_ALL] = power->actuation + power->damping + power->drag + power->added_mass + power->wake + power->driving;
    of[WORK_ALL] += power->pressure + power->suction + power->contact;
    of[WORK_ACTUATION] = power->actuation;
    of[WORK_FLUID] = power->on_water;
    of[WORK_DAMPING] = power->damping;
    of[WORK_DRIVING] = power->driving;
    of[WORK_DRIVING_ON_WATER] = power->driving_on_water;
}

// add the work of the step to the works of fish f
static void add_works(struct residual *residual, struct state *state, int f, double t, const double *y) {
    const struct fish *fish = &residual->school->fish[f];
    struct energy_balance *const balance = &state->balance[f];

    // Integrate strains and stresses to the end of the step. The stresses follow from the positions and are corrected
    // by the momentum balance.
    const double h = t - balance->t[0], g = balance->n > 1 ? balance->t[0] - balance->t[1] : 0;
    if (fish->damping != DAMPING_CURVATURE && h > 0) {
        double *const scratch = residual->scratch, *const stress = scratch + fish->at.vx;
        const struct rod_strains by_places = {scratch + fish->at.x, scratch + fish->at.ax, stress};
        const struct actuation muscle = residual_actuate(residual, f, t, y);
        rod_strains(fish, &muscle, y, &by_places);
        residual_balance(residual, f, y, scratch);
        rod_stress_balance(fish, scratch, y, stress);
        rod_stress_creep(fish, h, g, balance->stress_before, balance->stress, stress, balance->strain);
        const size_t size = (size_t)rod_n_strains(fish) * sizeof *stress;
        memcpy(balance->stress_before, balance->stress, size);
        memcpy(balance->stress, stress, size);
    }

    const struct diagnostics_power now = diagnostics_power(residual, f, t, y);
    const double times[3] = {t, balance->t[0], balance->t[1]};
    double newest[N_WORKS];
    gather_powers(&now, newest);

    // integrate the powers, and move them on by one step
    for (int i = 0; i < N_WORKS; i++) {
        const double power[3] = {newest[i], balance->power[0][i], balance->power[1][i]};
        if (t > times[1]) balance->work[i] += quadrature_newest(balance->n + 1, times, power);
        balance->power[1][i] = power[1];
        balance->power[0][i] = power[0];
    }

    const bool has_area = t > times[1];
    diagnostics_momentum_step(residual, state, f, t, y, has_area ? balance->n + 1 : 0, times);
    for (int i = 0; i < 2; i++) balance->t[i] = times[i];
    if (balance->n < 2) balance->n++;
}

void diagnostics_step(struct residual *residual, struct state *state, double t, const double *y) {
    const struct school *const school = residual->school;
    const int threads = fish_threads(school);
    if (threads == 1) {
        for (int f = 0; f < school->n_fish; f++) add_works(residual, state, f, t, y);
    } else {
#pragma omp parallel for num_threads(threads) schedule(static)
        for (int f = 0; f < school->n_fish; f++) add_works(residual, state, f, t, y);
    }
    clearance_step(residual->school, state, t, y, residual->neighbours, residual->scratch);
}

void diagnostics_before_jump(struct residual *residual, struct state *state) {
    const int threads = fish_threads(residual->school);
#pragma omp parallel for num_threads(threads) schedule(static)
    for (int f = 0; f < residual->school->n_fish; f++) {
        state->balance[f].work[WORK_ALL] -= diagnostics_energy(residual, f, state->t, state->y);
    }
}

void diagnostics_begin(struct residual *residual, struct state *state, int f) {
    struct energy_balance *balance = &state->balance[f];
    const struct diagnostics_power now = diagnostics_power(residual, f, state->t, state->y);
    balance->n = 1;
    balance->t[0] = state->t;
    gather_powers(&now, balance->power[0]);

    diagnostics_momentum_step(residual, state, f, state->t, state->y, 0, NULL);
}

void diagnostics_after_jump(struct residual *residual, struct state *state) {
    const int threads = fish_threads(residual->school);
    state_begin_rates(state, residual->school);
#pragma omp parallel for num_threads(threads) schedule(static)
    for (int f = 0; f < residual->school->n_fish; f++) {
        // the strains and stresses of a consistent state, from which add_works starts
        const struct fish *fish = &residual->school->fish[f];
        struct energy_balance *const balance = &state->balance[f];
        const struct actuation muscle = residual_actuate(residual, f, state->t, state->y);
        const struct rod_strains strains = {balance->strain, residual->scratch + fish->at.vx, balance->stress};
        rod_strains(fish, &muscle, state->y, &strains);

        state->balance[f].work[WORK_ALL] += diagnostics_energy(residual, f, state->t, state->y);
        diagnostics_begin(residual, state, f);
    }
}

void diagnostics_start(struct residual *residual, struct state *state) {
    diagnostics_after_jump(residual, state);
    for (int f = 0; f < residual->school->n_fish; f++) {
        state->balance[f].initial_energy = diagnostics_energy(residual, f, state->t, state->y);
        memset(state->balance[f].work, 0, sizeof state->balance[f].work);
    }

    diagnostics_momentum_start(residual, state);
    clearance_start(residual->school, state, residual->neighbours, residual->scratch);
}

void diagnostics_restart(struct residual *residual, struct state *state) {
    for (int f = 0; f < residual->school->n_fish; f++) {
        struct energy_balance *const balance = &state->balance[f];
        balance->initial_energy = diagnostics_energy(residual, f, state->t, state->y) - balance->work[WORK_ALL];
    }

    diagnostics_momentum_start(residual, state);
    clearance_start(residual->school, state, residual->neighbours, residual->scratch);
    state->has_crossed = false;
    memset(state->divergence, 0, sizeof state->divergence);
    memset(state->fading, 0, sizeof state->fading);
    self_crossing_remember(residual->school, state, residual->scratch);
}
