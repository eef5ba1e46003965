/* diagnostics.c: energies and powers at one instant, means over the last period, the energy balance over all steps. */
#include "model/diagnostics.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "base/angle.h"
#include "model/actuation.h"
#include "model/bound_sheet.h"
#include "model/clamp.h"
#include "model/clearance.h"
#include "model/fish_distance.h"
#include "model/fish_prescribed.h"
#include "model/flow_at_bodies.h"
#include "model/flow_external.h"
#include "model/fluid_force.h"
#include "model/rod.h"

enum status diagnostics_create(struct diagnostics **diagnostics, const struct school *school) {
    *diagnostics = NULL;
    struct diagnostics *const new = calloc(1, sizeof *new);
    if (new) new->fish = calloc((size_t)school->n_fish, sizeof *new->fish);
    if (!new || !new->fish) {
        diagnostics_free(new);
        return status_fail(STATUS_MEMORY, "out of memory: the diagnostics of %d fish", school->n_fish);
    }
    *diagnostics = new;
    return STATUS_OK;
}

void diagnostics_free(struct diagnostics *diagnostics) {
    if (!diagnostics) return;
    free(diagnostics->fish);
    free(diagnostics);
}

// what holds the prescribed nodes on their path, turns a clamped head, and the load at the tip
static double driving_power(struct residual *residual, int f, double t, const double *y, double *scratch) {
    const struct fish *fish = &residual->school->fish[f];
    const int tail = fish->n_nodes - 1;
    double power = fish->load_tip[0] * y[fish->at.vx + tail] + fish->load_tip[1] * y[fish->at.vy + tail];
    if (fish->motion.prescribed == PRESCRIBED_NONE) return power;
    power += clamp_driving_power(fish, t, y);
    residual_reaction(residual, f, y, residual->state->yp, scratch);
    for (int k = 0; k < fish_n_prescribed(fish); k++) {
        const int has_surge = fish_is_prescribed(fish, k, 0);
        power += (has_surge ? scratch[fish->at.ax + k] * y[fish->at.vx + k] : 0) +
                 scratch[fish->at.ay + k] * y[fish->at.vy + k];
    }
    return power;
}

// what a prescribed motion takes: the reactions of its nodes, and their moment with that of the clamp
static void find_constraint(struct residual *residual, int f, double t, const double *y, struct diagnostics_fish *to) {
    const struct fish *fish = &residual->school->fish[f];
    double *const reaction = residual->scratch;
    to->constraint_force[0] = to->constraint_force[1] = 0;
    to->constraint_moment = clamp_moment(fish, t, y);
    if (fish->motion.prescribed == PRESCRIBED_NONE) return;
    residual_reaction(residual, f, y, residual->state->yp, reaction);
    for (int k = 0; k < fish_n_prescribed(fish); k++) {
        const double along_x = fish_is_prescribed(fish, k, 0) ? reaction[fish->at.ax + k] : 0;
        const double force[2] = {along_x, reaction[fish->at.ay + k]};
        const double arm[2] = {y[fish->at.x + k] - to->com[0], y[fish->at.y + k] - to->com[1]};
        for (int i = 0; i < 2; i++) to->constraint_force[i] += force[i];
        to->constraint_moment += arm[0] * force[1] - arm[1] * force[0];
    }
}

// the forces that come from the pressure; all 0 with other forces
static struct pressure_forces pressure_forces(struct residual *residual, int f, const double about[2],
                                              const double *y) {
    struct pressure *const pressure = residual->pressure[f];
    if (!pressure) return (struct pressure_forces){.pressure_moment = 0};
    const struct flow_at_body flow = flow_at_body(residual->flow, f);
    pressure_update(pressure, &flow, y);
    pressure_update_rate(pressure, y, residual->state->yp);
    return pressure_sum(pressure, about, y);
}

// the forces on the body by name; thrust is what the fluid's forces are along the heading
static void find_forces(struct residual *residual, int f, double t, const double *y, struct diagnostics_fish *to) {
    const struct fish *fish = &residual->school->fish[f];
    const struct flow_at_body flow = flow_at_body(residual->flow, f);
    const struct fluid_forces forces = fluid_force_sum(fish, &flow, to->com, y);
    const double heading = control_heading(fish, y), ahead[2] = {cos(heading), sin(heading)};
    to->pressure = pressure_forces(residual, f, to->com, y);
    to->thrust = 0;
    for (int i = 0; i < 2; i++) {
        to->resistive_force[i] = forces.resistive[i];
        to->friction_force[i] = forces.friction[i];
        to->reactive_force[i] = forces.reactive[i];
        to->thrust +=
            (forces.resistive[i] + forces.reactive[i] + to->pressure.pressure[i] + to->pressure.suction[i]) * ahead[i];
    }
    to->resistive_moment = forces.resistive_moment;
    to->friction_moment = forces.friction_moment;
    to->reactive_moment = forces.reactive_moment;
    contact_force(residual->contact, f, y, to->contact_force);
    find_constraint(residual, f, t, y, to);
}

// the power of the fluid's forces as seen by one who drifts with the external flow at the centre of mass
static double power_on_water(struct residual *residual, int f, double t, const struct fluid_power *power,
                             const struct pressure_forces *pressure, const double *y) {
    const struct fish *fish = &residual->school->fish[f];
    const struct flow_at_body flow = flow_at_body(residual->flow, f);
    const double com[2] = {fish_mass_mean(fish, y + fish->at.x), fish_mass_mean(fish, y + fish->at.y)};
    double stream[2], on_water = power->drag + power->added_mass + power->wake;
    on_water += pressure->pressure_power + pressure->suction_power;
    flow_external(residual->school, t, com[1], &stream[0], &stream[1]);
    if (!(fabs(stream[0]) + fabs(stream[1]) > 0)) return on_water;
    const struct fluid_forces forces = fluid_force_sum(fish, &flow, com, y);
    for (int i = 0; i < 2; i++) {
        on_water -=
            (forces.resistive[i] + forces.reactive[i] + pressure->pressure[i] + pressure->suction[i]) * stream[i];
    }
    return on_water;
}

struct diagnostics_power diagnostics_power(struct residual *residual, int f, double t, const double *y) {
    const struct fish *fish = &residual->school->fish[f];
    const struct flow_at_body flow = flow_at_body(residual->flow, f);
    const struct fluid_power fluid = fluid_force_power(fish, &flow, y);
    const struct pressure_forces pressure = pressure_forces(residual, f, (const double[2]){0, 0}, y);
    // natural curvature, its derivative and its rate at this very state
    double *const curvature = residual->scratch, *const by_phi0 = curvature + fish->n_joints;
    const struct state *const state = residual->state;
    const struct fish_gait gait = control_gait(fish, &state->control[f], t);
    actuation_curvature(fish, gait, y[fish->at.phi0], curvature, by_phi0);
    double *const rate = by_phi0;
    const double phi0_rate = control_rate(fish, &state->control[f], t, t - state->t, y);
    actuation_rate(fish, gait, y[fish->at.phi0], phi0_rate, rate);
    return (struct diagnostics_power){.actuation = rod_actuation_power(fish, curvature, rate, y),
                                      .damping = rod_damping_power(fish, y) + clamp_damping_power(fish, t, y),
                                      .drag = fluid.drag,
                                      .friction = fluid.friction,
                                      .added_mass = fluid.added_mass,
                                      .wake = fluid.wake,
                                      .pressure = pressure.pressure_power,
                                      .suction = pressure.suction_power,
                                      .contact = contact_power(residual->contact, f, y),
                                      .on_water = power_on_water(residual, f, t, &fluid, &pressure, y),
                                      .driving = driving_power(residual, f, t, y, residual->scratch)};
}

static double kinetic_energy(const struct fish *fish, const double *y) {
    double energy = 0;
    for (int k = 0; k < fish->n_nodes; k++) {
        const double vx = y[fish->at.vx + k], vy = y[fish->at.vy + k];
        energy += fish->mass[k] * (vx * vx + vy * vy) / 2;
    }
    return energy;
}

static double bending_energy(struct residual *residual, int f, double t, const double *y) {
    const struct fish *fish = &residual->school->fish[f];
    double *const curvature = residual->scratch;
    const struct fish_gait gait = control_gait(fish, &residual->state->control[f], t);
    actuation_curvature(fish, gait, y[fish->at.phi0], curvature, curvature + fish->n_joints);
    return rod_bending_energy(fish, curvature, y) + clamp_energy(fish, t, y);
}

double diagnostics_energy(struct residual *residual, int f, double t, const double *y) {
    const struct fish *fish = &residual->school->fish[f];
    return kinetic_energy(fish, y) + bending_energy(residual, f, t, y) + rod_stretching_energy(fish, y) +
           contact_energy(residual->contact, f, y);
}

// the powers whose work is kept
static void gather_powers(const struct diagnostics_power *power, double *of) {
    of[WORK_ALL] = power->actuation + power->damping + power->drag + power->added_mass + power->wake + power->driving;
    of[WORK_ALL] += power->pressure + power->suction + power->contact;
    of[WORK_ACTUATION] = power->actuation;
    of[WORK_FLUID] = power->on_water;
    of[WORK_DAMPING] = power->damping;
}

// integral over the newest interval of the quadratic through three values, or the line through two
static double newest_area(int n, const double t[3], const double value[3]) {
    const double h = t[0] - t[1], slope = (value[0] - value[1]) / h;
    double area = h * (value[0] + value[1]) / 2;
    if (n == 3) area -= h * h * h / 6 * (slope - (value[1] - value[2]) / (t[1] - t[2])) / (t[0] - t[2]);
    return area;
}

void diagnostics_step(struct residual *residual, struct state *state, double t, const double *y) {
    for (int f = 0; f < residual->school->n_fish; f++) {
        struct energy_balance *balance = &state->balance[f];
        const struct diagnostics_power now = diagnostics_power(residual, f, t, y);
        const double times[3] = {t, balance->t[0], balance->t[1]};
        double newest[N_WORKS];
        gather_powers(&now, newest);
        for (int i = 0; i < N_WORKS; i++) {
            const double power[3] = {newest[i], balance->power[0][i], balance->power[1][i]};
            if (t > times[1]) balance->work[i] += newest_area(balance->n + 1, times, power);
            balance->power[1][i] = power[1];
            balance->power[0][i] = power[0];
        }
        for (int i = 0; i < 2; i++) balance->t[i] = times[i];
        if (balance->n < 2) balance->n++;
    }
    clearance_step(residual->school, state, t, y, residual->neighbours, residual->scratch);
}

void diagnostics_before_jump(struct residual *residual, struct state *state) {
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
}

void diagnostics_after_jump(struct residual *residual, struct state *state) {
    for (int f = 0; f < residual->school->n_fish; f++) {
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
    clearance_start(residual->school, state, residual->neighbours, residual->scratch);
}

void diagnostics_restart(struct residual *residual, struct state *state) {
    for (int f = 0; f < residual->school->n_fish; f++) {
        struct energy_balance *const balance = &state->balance[f];
        balance->initial_energy = diagnostics_energy(residual, f, state->t, state->y) - balance->work[WORK_ALL];
    }
    clearance_start(residual->school, state, residual->neighbours, residual->scratch);
}

// the way through the water between two samples, m
static void way_through_water(const struct sample *new, const struct sample *old, double way[2]) {
    for (int i = 0; i < 2; i++) way[i] = new->com[i] - old->com[i] - (new->drifted[i] - old->drifted[i]);
}

// what a sample has from those before it: the drift of the stream, by trapezoids, and the heading without jumps
static void continue_sample(const struct history *history, double interval, struct sample *sample) {
    if (history->n == 0) return;
    const struct sample *before = state_recall(history, 0);
    sample->heading = before->heading + angle_wrap(sample->heading - before->heading);
    for (int i = 0; i < 2; i++) {
        sample->drifted[i] = before->drifted[i] + interval * (before->stream[i] + sample->stream[i]) / 2;
    }
}

void diagnostics_remember(struct residual *residual, struct state *state) {
    const double interval = residual->school->interval;
    for (int f = 0; f < residual->school->n_fish; f++) {
        const struct fish *fish = &residual->school->fish[f];
        const double *const y = state->y;
        struct history *history = &state->history[f];
        const int tail = fish->n_nodes - 1;
        struct sample sample = {
            .com = {fish_mass_mean(fish, y + fish->at.x), fish_mass_mean(fish, y + fish->at.y)},
            .velocity = {fish_mass_mean(fish, y + fish->at.vx), fish_mass_mean(fish, y + fish->at.vy)},
            .tail = {y[fish->at.x + tail], y[fish->at.y + tail]},
            .speed = NAN,
            .heading = control_heading(fish, y)};
        flow_external(residual->school, state->t, sample.com[1], &sample.stream[0], &sample.stream[1]);
        const struct flow_at_body flow = flow_at_body(residual->flow, f);
        const struct fluid_forces forces = fluid_force_sum(fish, &flow, sample.com, y);
        const struct pressure_forces pressure = pressure_forces(residual, f, sample.com, y);
        memcpy(sample.friction, forces.friction, sizeof sample.friction);
        for (int i = 0; i < 2; i++) {
            sample.force[i] = forces.resistive[i] + forces.reactive[i] + pressure.pressure[i] + pressure.suction[i];
        }
        if (fish_has_momentum(fish)) sample.leading_edge = pressure_leading_edge(fish, 1, y);
        memcpy(sample.work, state->balance[f].work, sizeof sample.work);
        continue_sample(history, interval, &sample);
        // the newest sample of a full history takes the place of the one of a period and an interval ago
        if (history->capacity > 1 && history->n >= history->capacity - 1) {
            double way[2];
            way_through_water(&sample, state_recall(history, history->capacity - 2), way);
            sample.speed = hypot(way[0], way[1]) / ((history->capacity - 1) * interval);
        }
        state_remember(history, &sample);
    }
}

int diagnostics_course(const struct history *history, double *course, double *rate) {
    if (history->n < 2 || history->n < history->capacity) return 0;
    const struct sample *new = state_recall(history, 0), *old = state_recall(history, history->n - 1);
    const double way[2] = {new->com[0] - old->com[0], new->com[1] - old->com[1]};
    const double change[2] = {new->velocity[0] - old->velocity[0], new->velocity[1] - old->velocity[1]};
    const double square = way[0] * way[0] + way[1] * way[1];
    if (square <= 0) return 0;
    *course = atan2(way[1], way[0]);
    *rate = (way[0] * change[1] - way[1] * change[0]) / square;
    return 1;
}

double diagnostics_mean_heading(const struct history *history) {
    if (history->n == 1) return state_recall(history, 0)->heading;
    double sum = 0;
    for (int age = 0; age < history->n; age++) {
        sum += (age == 0 || age == history->n - 1 ? 0.5 : 1) * state_recall(history, age)->heading;
    }
    return sum / (history->n - 1);
}

// extent of the tail's path through the water, across the fish's way
static double peak_to_peak(const struct history *history, const double way[2], double distance) {
    double min = INFINITY, max = -INFINITY;
    for (int age = 0; age < history->n; age++) {
        const struct sample *sample = state_recall(history, age);
        const double x = sample->tail[0] - sample->drifted[0], y = sample->tail[1] - sample->drifted[1];
        const double across = (way[0] * y - way[1] * x) / distance;
        min = fmin(min, across);
        max = fmax(max, across);
    }
    return max - min;
}

// the change of the mean speed from the period before the last one to the last, over the last
static double drift_of(const struct history *history) {
    const double now = state_recall(history, 0)->speed, before = state_recall(history, history->n - 1)->speed;
    return (now - before) / now;
}

// the mean of a force of the samples against the way, by trapezoids
static double mean_against(const struct history *history, size_t which, const double way[2], double distance) {
    double sum = 0;
    for (int age = 0; age < history->n; age++) {
        const double *const force = (const double *)state_recall(history, age) + which / sizeof(double);
        const double weight = age == 0 || age == history->n - 1 ? 0.5 : 1;
        sum -= weight * (force[0] * way[0] + force[1] * way[1]) / distance;
    }
    return sum / (history->n - 1);
}

// the largest magnitude of A_0
static double leading_edge_most(const struct history *history, double speed) {
    double most = 0;
    for (int age = 0; age < history->n; age++) most = fmax(most, fabs(state_recall(history, age)->leading_edge));
    return most / speed;
}

// what is stated over the last period, or since the start where that is less
static void diagnostics_period(const struct fish *fish, const struct history *history, double interval,
                               struct diagnostics_fish *to) {
    const struct sample *new = state_recall(history, 0), *old = state_recall(history, history->n - 1);
    to->ground_speed = hypot(to->com_velocity[0], to->com_velocity[1]);
    to->speed = hypot(to->com_velocity[0] - new->stream[0], to->com_velocity[1] - new->stream[1]);
    to->drift = to->heading_error = to->strouhal = NAN;
    to->cost_of_transport = to->cost_of_transport_fluid = to->cost_of_transport_body = to->efficiency = NAN;
    to->mean_thrust = to->mean_power = to->thrust_efficiency = NAN;
    if (history->n < 2) return;
    const double duration = (history->n - 1) * interval;
    double way[2];
    way_through_water(new, old, way);
    const double distance = hypot(way[0], way[1]);
    to->ground_speed = hypot(new->com[0] - old->com[0], new->com[1] - old->com[1]) / duration;
    to->speed = distance / duration;
    to->drift = drift_of(history);
    if (distance <= 0) return;
    to->heading_error = angle_degrees(angle_wrap(atan2(way[1], way[0]) - angle_radians(to->desired_heading)));
    const double momentum = fish->total_mass * to->speed;
    to->cost_of_transport = (new->work[WORK_ACTUATION] - old->work[WORK_ACTUATION]) / duration / momentum;
    to->cost_of_transport_fluid = (old->work[WORK_FLUID] - new->work[WORK_FLUID]) / duration / momentum;
    to->cost_of_transport_body = (old->work[WORK_DAMPING] - new->work[WORK_DAMPING]) / duration / momentum;
    const double into_water = old->work[WORK_FLUID] - new->work[WORK_FLUID];
    to->efficiency = mean_against(history, offsetof(struct sample, friction), way, distance) * distance / into_water;
    to->mean_thrust = -mean_against(history, offsetof(struct sample, force), way, distance);
    to->mean_power = into_water / duration + to->mean_thrust * to->speed;
    to->thrust_efficiency = to->mean_thrust * to->speed / to->mean_power;
    to->strouhal = fish->frequency * peak_to_peak(history, way, distance) / to->speed;
}

static double shedding_rate(const struct residual *residual, const struct state *state, int f) {
    if (residual->school->kutta == KUTTA_EDGE) return state->yp[residual->school->fish[f].at.circulation];
    return residual_kutta_rate(residual, f, state->t, state->y);
}

// whether a place can lie inside a body, none of whose points is farther from the middle than half its length
static int is_close(const struct fish *fish, const double *y, const double p[2]) {
    const int middle = fish->n_nodes / 2;
    const double dx = p[0] - y[fish->at.x + middle], dy = p[1] - y[fish->at.y + middle];
    return dx * dx + dy * dy < fish->length * fish->length;
}

// the free vortices, or markers, inside the outline of a body; its own newest marker is on its tail
static double swept_vortices(const struct school *school, const struct state *state, int f) {
    const struct fish *const fish = &school->fish[f];
    int n = 0;
    for (int g = 0; g < school->n_fish; g++) {
        const struct wake *const wake = &state->wake[g];
        const int end = wake->n_vortex - (g == f && wake->n_vortex > 0);
        for (int i = 0; i < end; i++) {
            const double p[2] = {wake->x[i], wake->y[i]};
            n += is_close(fish, state->y, p) && fish_point_distance(fish, state->y, p) < 0;
        }
    }
    return n;
}

static void diagnostics_one(struct residual *residual, const struct state *state, int f, struct diagnostics_fish *to) {
    const struct fish *fish = &residual->school->fish[f];
    const struct history *history = &state->history[f];
    const double *const y = state->y;
    to->com[0] = fish_mass_mean(fish, y + fish->at.x);
    to->com[1] = fish_mass_mean(fish, y + fish->at.y);
    to->com_velocity[0] = fish_mass_mean(fish, y + fish->at.vx);
    to->com_velocity[1] = fish_mass_mean(fish, y + fish->at.vy);
    to->heading = angle_degrees(state_recall(history, 0)->heading);
    const double desired = control_desired_heading(fish, &state->control[f], state->t, y);
    to->desired_heading = to->heading - angle_degrees(angle_wrap(angle_radians(to->heading) - desired));
    diagnostics_period(fish, history, residual->school->interval, to);
    find_forces(residual, f, state->t, y, to);
    const int has_a0 = fish_has_momentum(fish) && to->speed > 0;
    to->leading_edge_a0 = has_a0 ? pressure_leading_edge(fish, to->speed, y) : NAN;
    to->leading_edge_most = has_a0 ? leading_edge_most(history, to->speed) : NAN;
    to->swept_vortices = swept_vortices(residual->school, state, f);
    to->phi0 = y[fish->at.phi0];
    const struct fish_gait gait = control_gait(fish, &state->control[f], state->t);
    to->wave_amplitude = gait.amplitude * fish->amplitude;
    to->wave_frequency = gait.omega / (2 * M_PI);
    to->shed_circulation = y[fish->at.circulation];
    to->shedding_rate = shedding_rate(residual, state, f);
    to->kinetic_energy = kinetic_energy(fish, y);
    to->bending_energy = bending_energy(residual, f, state->t, y);
    to->stretching_energy = rod_stretching_energy(fish, y);
    const struct flow_at_body flow = flow_at_body(residual->flow, f);
    to->added_mass_energy = fluid_force_added_mass_energy(fish, &flow, y);
    const struct diagnostics_power power = diagnostics_power(residual, f, state->t, y);
    to->actuation_power = power.actuation;
    to->damping_power = power.damping;
    to->drag_power = power.drag;
    to->friction_power = power.friction;
    to->added_mass_power = power.added_mass;
    to->wake_power = power.wake;
    to->driving_power = power.driving;
    to->contact_energy = contact_energy(residual->contact, f, y);
    to->contact_power = power.contact;
    const struct energy_balance *balance = &state->balance[f];
    to->energy_audit = to->kinetic_energy + to->bending_energy + to->stretching_energy + to->contact_energy -
                       balance->initial_energy - balance->work[WORK_ALL];
    to->actuation_work = balance->work[WORK_ACTUATION];
}

// every vortex counted one by one: bound, nascent, free, removed
static double total_circulation(const struct residual *residual, const struct state *state) {
    double total = 0;
    for (int f = 0; f < residual->school->n_fish; f++) {
        const struct fish *fish = &residual->school->fish[f];
        const struct wake *wake = &state->wake[f];
        total += bound_sheet_circulation(fish, state->y) + (state->y[fish->at.circulation] - wake->shed_before);
        for (int i = 0; i < wake_n_sources(wake); i++) total += wake_source(wake, i);
        // what has been lost still counts, or has been given back to the body
        if (residual->school->removed == REMOVED_RETAINED) total += wake->removed;
        if (residual->school->removed == REMOVED_DROPPED) {
            total += wake->removed - residual_lost(residual, f, state->t);
        }
    }
    return total;
}

void diagnostics_event(struct residual *residual, const struct state *state, struct diagnostics *diagnostics) {
    const struct school *school = residual->school;
    double sum[2] = {0, 0};
    diagnostics->t = state->t;
    diagnostics->least_distance = NAN;
    for (int f = 0; f < school->n_fish; f++) {
        diagnostics_one(residual, state, f, &diagnostics->fish[f]);
        sum[0] += cos(angle_radians(diagnostics->fish[f].heading));
        sum[1] += sin(angle_radians(diagnostics->fish[f].heading));
        for (int g = 0; g < f; g++) {
            const double most = isnan(diagnostics->least_distance) ? INFINITY : diagnostics->least_distance;
            diagnostics->least_distance =
                fmin(diagnostics->least_distance, fish_distance(&school->fish[f], &school->fish[g], state->y, most));
        }
    }
    diagnostics->polarisation = hypot(sum[0], sum[1]) / school->n_fish;
    diagnostics->total_circulation = total_circulation(residual, state);
}
