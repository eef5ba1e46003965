/* diagnostics.c: derives the quantities of each fish, and then those of the school. */
#include "school/diagnostics.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/mathematics.h"
#include "contact/clearance.h"
#include "control/control.h"
#include "fish/fish.h"
#include "flow/flow.h"
#include "flow/flow_at_bodies.h"
#include "flow/flow_external.h"
#include "force/bound_sheet.h"
#include "force/drag.h"
#include "force/force_model.h"
#include "force/sensor_pressure.h"
#include "school/diagnostics_energy.h"
#include "school/diagnostics_momentum.h"

// ---- differences and means of samples

// displacement through the water between two samples, m
static void way_through_water(const struct sample *latest, const struct sample *earliest, double way[2]) {
    for (int i = 0; i < 2; i++)
        way[i] = latest->com[i] - earliest->com[i] - (latest->drifted[i] - earliest->drifted[i]);
}

void diagnostics_remember(struct residual *residual, struct state *state) {
    const double interval = residual->school->interval;
    const int threads = fish_threads(residual->school);
    state_reserve(state, residual->school);

#pragma omp parallel for num_threads(threads) schedule(static)
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
        flow_external(residual->school, state->t, sample.com[0], sample.com[1], &sample.stream[0], &sample.stream[1]);

        const struct fluid_forces forces = diagnostics_fluid(residual, f, sample.com, y);
        memcpy(sample.friction, forces.friction, sizeof sample.friction);
        diagnostics_fluid_force(forces.resistive, forces.reactive, &forces.pressure, sample.force);
        sample.leading_edge = forces.pressure.leading_edge_a0;
        sample.bias = y[fish->at.phi0];
        const struct fish *const leader =
            fish->control.law == CONTROL_PLACE ? &residual->school->fish[fish->control.leader] : NULL;
        if (leader) {
            sample.leader[0] = fish_mass_mean(leader, y + leader->at.x);
            sample.leader[1] = fish_mass_mean(leader, y + leader->at.y);
            sample.leader_heading = control_heading(leader, y);
        }
        memcpy(sample.work, state->balance[f].work, sizeof sample.work);

        // continue from the sample before: the headings are unwrapped, and the drift of the stream is integrated by
        // trapezoids
        if (history->n > 0) {
            const struct sample *before = state_recall(history, 0);
            sample.heading = before->heading + angle_wrap(sample.heading - before->heading);
            sample.leader_heading = before->leader_heading + angle_wrap(sample.leader_heading - before->leader_heading);
            for (int i = 0; i < 2; i++) {
                sample.drifted[i] = before->drifted[i] + interval * (before->stream[i] + sample.stream[i]) / 2;
            }
        }

        // the mean speed through the water over one period; the sample capacity - 2 events ago is one period older than
        // the new one
        if (history->capacity > 1 && history->n >= history->capacity - 1) {
            double way[2];
            way_through_water(&sample, state_recall(history, history->capacity - 2), way);
            sample.speed = hypot(way[0], way[1]) / ((history->capacity - 1) * interval);
        }
        state_remember(history, &sample);
    }
}

bool diagnostics_course(const struct history *history, bool through_water, double interval, double *course,
                        double *rate, double *speed) {
    if (history->n < 2 || history->n < history->capacity) return false;

    const struct sample *latest = state_recall(history, 0), *earliest = state_recall(history, history->n - 1);
    double way[2], change[2];
    for (int i = 0; i < 2; i++) {
        way[i] = latest->com[i] - earliest->com[i];
        change[i] = latest->velocity[i] - earliest->velocity[i];
        if (through_water) way[i] -= latest->drifted[i] - earliest->drifted[i];
        if (through_water) change[i] -= latest->stream[i] - earliest->stream[i];
    }
    const double square = way[0] * way[0] + way[1] * way[1];
    *course = atan2(way[1], way[0]);
    *rate = square > 0 ? (way[0] * change[1] - way[1] * change[0]) / square : 0;
    *speed = sqrt(square) / ((history->n - 1) * interval);
    return true;
}

double diagnostics_mean_heading(const struct history *history) {
    if (history->n == 1) return state_recall(history, 0)->heading;

    double sum = 0;
    for (int age = 0; age < history->n; age++) {
        sum += (age == 0 || age == history->n - 1 ? 0.5 : 1) * state_recall(history, age)->heading;
    }
    return sum / (history->n - 1);
}

void diagnostics_leader(const struct history *history, double away[2], double change[2], double *heading) {
    away[0] = away[1] = change[0] = change[1] = *heading = 0;
    for (int age = 0; age < history->n; age++) {
        const struct sample *const sample = state_recall(history, age);
        const double weight = (age == 0 || age == history->n - 1 ? 0.5 : 1) / (history->n - 1);
        for (int i = 0; i < 2; i++) away[i] += weight * (sample->leader[i] - sample->com[i]);
        *heading += weight * sample->leader_heading;
    }

    const struct sample *latest = state_recall(history, 0), *earliest = state_recall(history, history->n - 1);
    for (int i = 0; i < 2; i++) {
        change[i] = latest->leader[i] - latest->com[i] - (earliest->leader[i] - earliest->com[i]);
    }
}

// where the tail is across the path of the fish, in the frame of the water
static double tail_across(const struct history *history, int age, const double way[2], double distance) {
    const struct sample *const sample = state_recall(history, age);
    const double x = sample->tail[0] - sample->drifted[0], y = sample->tail[1] - sample->drifted[1];
    return (way[0] * y - way[1] * x) / distance;
}

/* The peak-to-peak amplitude of the tail across the path of the fish. A crest is the vertex of the parabola through
 * three samples, which is of fourth order in the interval; the largest sample would be of second order. */
static double peak_to_peak(const struct history *history, const double way[2], double distance) {
    double least = INFINITY, most = -INFINITY;
    for (int age = 0; age < history->n; age++) {
        const double here = tail_across(history, age, way, distance);

        double crest = here;
        if (age > 0 && age + 1 < history->n) {
            const double newer = tail_across(history, age - 1, way, distance);
            const double older = tail_across(history, age + 1, way, distance);
            const double slope = (newer - older) / 2, bend = newer - 2 * here + older;
            const bool is_crest = (here - newer) * (here - older) >= 0 && fabs(bend) > 0;
            if (is_crest) crest -= slope * slope / (2 * bend);
        }

        least = fmin(least, crest);
        most = fmax(most, crest);
    }
    return most - least;
}

// the forces against the direction of the path, as means over the samples by trapezoids
struct mean_resistance {
    double fluid, friction; /* of all forces of the fluid, and of the friction alone, N */
};

static struct mean_resistance mean_resistance(const struct history *history, const double way[2], double distance) {
    struct mean_resistance sum = {0};
    for (int age = 0; age < history->n; age++) {
        const struct sample *const sample = state_recall(history, age);
        const double weight = age == 0 || age == history->n - 1 ? 0.5 : 1;
        sum.fluid -= weight * (sample->force[0] * way[0] + sample->force[1] * way[1]) / distance;
        sum.friction -= weight * (sample->friction[0] * way[0] + sample->friction[1] * way[1]) / distance;
    }
    return (struct mean_resistance){sum.fluid / (history->n - 1), sum.friction / (history->n - 1)};
}

/* How often the steering bias has reversed over the last period. Only moves of at least a share of the limit count, so
 * that neither a bias that settles nor its rounding does. */
static int bias_reversals(const struct history *history, double limit) {
    const double least = 0.01 * limit;
    double turn = state_recall(history, 0)->bias; /* the last turning point, or the farthest value since */
    int direction = 0, n = 0;

    for (int age = 1; age < history->n; age++) {
        const double bias = state_recall(history, age)->bias, move = bias - turn;
        if (direction * move >= 0 && direction != 0) {
            turn = bias;
        } else if (fabs(move) >= least) {
            n += direction != 0;
            direction = move > 0 ? 1 : -1;
            turn = bias;
        }
    }
    return n;
}

void diagnostics_period(const struct fish *fish, const struct history *history, double interval,
                        struct diagnostics_fish *to) {
    const struct sample *latest = state_recall(history, 0), *earliest = state_recall(history, history->n - 1);

    // A_0: its largest magnitude (NaN unless force: pressure), and how long it was above the limit, by trapezoids
    double most = NAN, share = 0;
    for (int age = 0; age < history->n; age++) {
        const double a0 = fabs(state_recall(history, age)->leading_edge);
        const double weight = history->n > 1 && (age == 0 || age == history->n - 1) ? 0.5 : 1;
        most = fmax(most, a0);
        share += a0 > fish->suction_limit ? weight : 0;
    }
    to->leading_edge_most = most;
    to->separation_share = fish->suction_limit > 0 ? share / (history->n > 1 ? history->n - 1 : 1) : 0;
    to->bias_reversals = fish->control.law == CONTROL_NONE ? 0 : bias_reversals(history, fish->control.limit);

    // instantaneous values, which stand until there is a second sample
    to->ground_speed = hypot(to->com_velocity[0], to->com_velocity[1]);
    to->speed = hypot(to->com_velocity[0] - latest->stream[0], to->com_velocity[1] - latest->stream[1]);
    to->drift = to->heading_error = to->strouhal = NAN;
    to->cost_of_transport = to->cost_of_transport_fluid = to->cost_of_transport_body = to->efficiency = NAN;
    to->towed_efficiency = NAN;
    to->mean_thrust = to->mean_power = to->mean_actuation_power = NAN;
    if (history->n < 2) return;

    // speeds, through the water and over the ground, and powers
    const double duration = (history->n - 1) * interval;
    double way[2];
    way_through_water(latest, earliest, way);
    const double distance = hypot(way[0], way[1]);
    to->ground_speed = hypot(latest->com[0] - earliest->com[0], latest->com[1] - earliest->com[1]) / duration;
    to->speed = distance / duration;
    to->drift = (latest->speed - earliest->speed) / latest->speed;
    to->mean_actuation_power = (latest->work[WORK_ACTUATION] - earliest->work[WORK_ACTUATION]) / duration;
    const double drive = (latest->work[WORK_DRIVING_ON_WATER] - earliest->work[WORK_DRIVING_ON_WATER]) / duration;
    to->mean_power = to->mean_actuation_power + drive;

    // A held body (doc/model.md, section 13): its drive also takes the thrust, whose work is no part of the power of
    // the motion. A body that has travelled no further than rounding has the direction of its heading.
    const bool is_held = fish->motion.is_held, has_travelled = distance > 1e-9 * fish->length;
    if (is_held) {
        const double ahead[2] = {cos(fish->start_heading), sin(fish->start_heading)};
        to->mean_thrust = -mean_resistance(history, has_travelled ? way : ahead, has_travelled ? distance : 1).fluid;
        to->mean_power += to->mean_thrust * to->speed;
        to->efficiency = to->mean_thrust * to->speed / to->mean_power;
    }
    if (!has_travelled) return;

    // quantities along the path
    to->heading_error = angle_degrees(angle_wrap(atan2(way[1], way[0]) - angle_radians(to->desired_heading)));
    const double momentum = fish->total_mass * to->speed,
                 into_water = earliest->work[WORK_FLUID] - latest->work[WORK_FLUID];
    to->cost_of_transport = (to->mean_actuation_power + drive) / momentum;
    to->cost_of_transport_fluid = into_water / duration / momentum;
    to->cost_of_transport_body = (earliest->work[WORK_DAMPING] - latest->work[WORK_DAMPING]) / duration / momentum;
    to->strouhal = fish->frequency * peak_to_peak(history, way, distance) / to->speed;
    if (is_held) return;
    const struct mean_resistance resistance = mean_resistance(history, way, distance);
    to->mean_thrust = -resistance.fluid;
    to->efficiency = resistance.friction * distance / into_water;
    to->towed_efficiency = drag_towed(fish, to->speed) * distance / into_water;
}

struct diagnostics *diagnostics_create(struct arena *arena, const struct school *school) {
    struct diagnostics *diagnostics;
    NEW(arena, diagnostics, 1);
    NEW(arena, diagnostics->fish, school->n_fish);
    NEW(arena, diagnostics->body, school->n_fish);
    NEW(arena, diagnostics->wake, school->n_fish);
    return diagnostics;
}

// How many free vortices or markers are inside the outline of a body. The newest marker of its own is at the tail and
// does not count.
static double swept_vortices(const struct school *school, const struct state *state,
                             const struct diagnostics *diagnostics, int f) {
    const struct fish *const fish = &school->fish[f];
    const struct box *const body = &diagnostics->body[f];
    int n = 0;
    for (int g = 0; g < school->n_fish; g++) {
        const struct wake *const wake = &state->wake[g];
        const int end = wake->n_vortex - (g == f && wake->n_vortex > 0);
        if (box_gap(body, &diagnostics->wake[g]) > 0) continue;

        for (int i = 0; i < end; i++) {
            const double p[2] = {wake->x[i], wake->y[i]};
            const bool is_close =
                p[0] >= body->low[0] && p[0] <= body->high[0] && p[1] >= body->low[1] && p[1] <= body->high[1];
            n += is_close && fish_point_distance(fish, state->y, p) < 0;
        }
    }
    return n;
}

static void diagnostics_fill_fish(struct residual *residual, const struct state *state, int f,
                                  struct diagnostics *diagnostics) {
    struct diagnostics_fish *const to = &diagnostics->fish[f];
    const struct fish *fish = &residual->school->fish[f];
    const struct fluid_force *const force = &residual->force[f];
    const struct history *history = &state->history[f];
    const double *const y = state->y;

    to->com[0] = fish_mass_mean(fish, y + fish->at.x);
    to->com[1] = fish_mass_mean(fish, y + fish->at.y);
    to->com_velocity[0] = fish_mass_mean(fish, y + fish->at.vx);
    to->com_velocity[1] = fish_mass_mean(fish, y + fish->at.vy);

    // unwrap the desired heading so that it is next to the heading
    to->heading = angle_degrees(state_recall(history, 0)->heading);
    const double desired = control_desired_heading(fish, &state->control[f], state->t, y);
    to->desired_heading = to->heading - angle_degrees(angle_wrap(angle_radians(to->heading) - desired));

    diagnostics_period(fish, history, residual->school->interval, to);
    diagnostics_forces(residual, f, state->t, y, to);
    if (force->pressure) sensor_pressure_update(residual->flow, state, f, force->pressure);
    to->swept_vortices = swept_vortices(residual->school, state, diagnostics, f);

    to->phi0 = y[fish->at.phi0];
    const struct fish_gait gait = control_gait(fish, &state->control[f], state->t, 0);
    to->wave_amplitude = gait.amplitude * fish->amplitude;
    to->wave_frequency = gait.omega / (2 * M_PI);
    to->shed_circulation = y[fish->at.circulation];
    to->shedding_rate =
        residual->school->kutta == KUTTA_EDGE ? state->yp[fish->at.circulation] : residual_kutta_rate(residual, f, y);

    // energies, powers, and the energy balance
    const struct diagnostics_energies energies = diagnostics_energies(residual, f, state->t, y);
    to->kinetic_energy = energies.kinetic;
    to->bending_energy = energies.bending;
    to->stretching_energy = energies.stretching;
    to->contact_energy = energies.contact;
    const struct flow_at_body flow = flow_at_body(residual->flow, f);
    to->added_mass_energy = force->model->energy(force, &flow, y);

    const struct diagnostics_power power = diagnostics_power(residual, f, state->t, y);
    to->actuation_power = power.actuation;
    to->damping_power = power.damping;
    to->drag_power = power.drag;
    to->friction_power = power.friction;
    to->cross_flow_power = power.drag - power.friction;
    to->added_mass_power = power.added_mass;
    to->wake_power = power.wake;
    to->constraint_power = power.driving;
    to->contact_power = power.contact;

    const struct energy_balance *balance = &state->balance[f];
    to->energy_balance = to->kinetic_energy + to->bending_energy + to->stretching_energy + to->contact_energy -
                         balance->initial_energy - balance->work[WORK_ALL];
    to->actuation_work = balance->work[WORK_ACTUATION];
}

void diagnostics_event(struct residual *residual, const struct state *state, struct diagnostics *diagnostics) {
    const struct school *school = residual->school;
    double sum[2] = {0, 0};
    diagnostics->t = state->t;
    flow_velocity(residual->flow, state, state->t, state->y, residual->flow->is_steady);

    // boxes around bodies and wakes
    for (int f = 0; f < school->n_fish; f++) {
        const struct wake *const wake = &state->wake[f];
        diagnostics->body[f] = clearance_box(&school->fish[f], 0, state->y, state->y);
        diagnostics->wake[f] = box_around(wake->n_vortex, wake->x, wake->y);
    }

    for (int f = 0; f < school->n_fish; f++) {
        diagnostics_fill_fish(residual, state, f, diagnostics);
        sum[0] += cos(angle_radians(diagnostics->fish[f].heading));
        sum[1] += sin(angle_radians(diagnostics->fish[f].heading));
    }

    diagnostics->polarisation = hypot(sum[0], sum[1]) / school->n_fish;
    diagnostics_momentum(residual, state, diagnostics);

    // the smallest distance between two bodies
    double least = INFINITY;
    for (int f = 0; f < school->n_fish; f++) {
        for (int g = 0; g < f; g++) {
            if (box_gap(&diagnostics->body[f], &diagnostics->body[g]) > least) continue;
            least = fmin(least, fish_distance(&school->fish[f], &school->fish[g], state->y, least));
        }
    }
    diagnostics->least_distance = school->n_fish > 1 ? least : NAN;

    // the circulation of every vortex: bound, nascent, free, and removed, whether it is retained or has returned to the
    // body
    double total = 0;
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *fish = &school->fish[f];
        const struct wake *wake = &state->wake[f];
        total += bound_sheet_circulation(fish, state->y) + (state->y[fish->at.circulation] - wake->shed_before);
        for (int i = 0; i < wake_n_sources(wake); i++) total += wake_source(wake, i);
        if (school->removed == REMOVED_RETAINED) total += wake->removed;
        if (school->removed == REMOVED_DROPPED) total += wake->removed - residual_lost(residual, f, state->t);
    }
    diagnostics->total_circulation = total;
}
