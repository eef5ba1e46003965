/* diagnostics.c: diagnostics of each fish, then of the school. */
#include "school/diagnostics.h"

#include <math.h>
#include <stdlib.h>

#include "base/mathematics.h"
#include "contact/clearance.h"
#include "control/control.h"
#include "fish/fish_distance.h"
#include "flow/flow_at_bodies.h"
#include "force/bound_sheet.h"
#include "force/fluid_force.h"
#include "school/diagnostics_energy.h"
#include "school/diagnostics_forces.h"
#include "school/diagnostics_history.h"
#include "school/diagnostics_momentum.h"

enum status diagnostics_create(struct diagnostics **diagnostics, const struct school *school) {
    *diagnostics = NULL;
    struct diagnostics *const new = calloc(1, sizeof *new);
    if (new) {
        new->fish = calloc((size_t)school->n_fish, sizeof *new->fish);
        new->body = calloc((size_t)school->n_fish, sizeof *new->body);
        new->wake = calloc((size_t)school->n_fish, sizeof *new->wake);
    }
    if (!new || !new->fish || !new->body || !new->wake) {
        diagnostics_free(new);
        return status_fail(STATUS_MEMORY, "out of memory: the diagnostics of %d fish", school->n_fish);
    }
    *diagnostics = new;
    return STATUS_OK;
}

void diagnostics_free(struct diagnostics *diagnostics) {
    if (!diagnostics) return;
    free(diagnostics->fish);
    free(diagnostics->body);
    free(diagnostics->wake);
    free(diagnostics);
}

static double shedding_rate(const struct residual *residual, const struct state *state, int f) {
    if (residual->school->kutta == KUTTA_EDGE) return state->yp[residual->school->fish[f].at.circulation];
    return residual_kutta_rate(residual, f, state->t, state->y);
}

// number of free vortices, or markers, inside the outline of a body; the newest own marker lies at the tail: skip
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
            const int is_close =
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
    const struct history *history = &state->history[f];
    const double *const y = state->y;

    to->com[0] = fish_mass_mean(fish, y + fish->at.x);
    to->com[1] = fish_mass_mean(fish, y + fish->at.y);
    to->com_velocity[0] = fish_mass_mean(fish, y + fish->at.vx);
    to->com_velocity[1] = fish_mass_mean(fish, y + fish->at.vy);

    // the desired heading is unwrapped next to the heading
    to->heading = angle_degrees(state_recall(history, 0)->heading);
    const double desired = control_desired_heading(fish, &state->control[f], state->t, y);
    to->desired_heading = to->heading - angle_degrees(angle_wrap(angle_radians(to->heading) - desired));

    diagnostics_period(fish, history, residual->school->interval, to);
    diagnostics_forces(residual, f, state->t, y, to);
    to->swept_vortices = swept_vortices(residual->school, state, diagnostics, f);

    to->phi0 = y[fish->at.phi0];
    const struct fish_gait gait = control_gait(fish, &state->control[f], state->t);
    to->wave_amplitude = gait.amplitude * fish->amplitude;
    to->wave_frequency = gait.omega / (2 * M_PI);
    to->shed_circulation = y[fish->at.circulation];
    to->shedding_rate = shedding_rate(residual, state, f);

    // energies, powers, and the energy balance
    const struct diagnostics_energies energies = diagnostics_energies(residual, f, state->t, y);
    to->kinetic_energy = energies.kinetic;
    to->bending_energy = energies.bending;
    to->stretching_energy = energies.stretching;
    to->contact_energy = energies.contact;
    const struct flow_at_body flow = flow_at_body(residual->flow, f);
    to->added_mass_energy = fluid_force_added_mass_energy(fish, &flow, y);

    const struct diagnostics_power power = diagnostics_power(residual, f, state->t, y);
    to->actuation_power = power.actuation;
    to->damping_power = power.damping;
    to->drag_power = power.drag;
    to->friction_power = power.friction;
    to->added_mass_power = power.added_mass;
    to->wake_power = power.wake;
    to->constraint_power = power.driving;
    to->contact_power = power.contact;

    const struct energy_balance *balance = &state->balance[f];
    to->energy_balance = to->kinetic_energy + to->bending_energy + to->stretching_energy + to->contact_energy -
                         balance->initial_energy - balance->work[WORK_ALL];
    to->actuation_work = balance->work[WORK_ACTUATION];
}

// sum over every vortex: bound, nascent, free, removed
static double total_circulation(const struct residual *residual, const struct state *state) {
    double total = 0;
    for (int f = 0; f < residual->school->n_fish; f++) {
        const struct fish *fish = &residual->school->fish[f];
        const struct wake *wake = &state->wake[f];
        total += bound_sheet_circulation(fish, state->y) + (state->y[fish->at.circulation] - wake->shed_before);
        for (int i = 0; i < wake_n_sources(wake); i++) total += wake_source(wake, i);

        // removed circulation is retained in the sum, or has returned to the body
        if (residual->school->removed == REMOVED_RETAINED) total += wake->removed;
        if (residual->school->removed == REMOVED_DROPPED) {
            total += wake->removed - residual_lost(residual, f, state->t);
        }
    }
    return total;
}

// smallest distance between two bodies, m; NaN for one fish
static double least_distance(const struct school *school, const double *y, const struct box *body) {
    double least = INFINITY;
    for (int f = 0; f < school->n_fish; f++) {
        for (int g = 0; g < f; g++) {
            if (box_gap(&body[f], &body[g]) > least) continue;
            least = fmin(least, fish_distance(&school->fish[f], &school->fish[g], y, least));
        }
    }
    return school->n_fish > 1 ? least : NAN;
}

void diagnostics_event(struct residual *residual, const struct state *state, struct diagnostics *diagnostics) {
    const struct school *school = residual->school;
    double sum[2] = {0, 0};
    diagnostics->t = state->t;

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

    diagnostics_momentum(residual, state, diagnostics);
    diagnostics->least_distance = least_distance(school, state->y, diagnostics->body);
    diagnostics->polarisation = hypot(sum[0], sum[1]) / school->n_fish;
    diagnostics->total_circulation = total_circulation(residual, state);
}
