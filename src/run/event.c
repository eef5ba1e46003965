/* event.c: from the end of one interval to the start of the next. */
#include "run/event.h"

#include <stdlib.h>

#include "model/diagnostics.h"
#include "model/drag.h"

// evaluate the equations; at an event there is no smaller step to try
static enum status evaluate(struct residual *residual, const struct state *state) {
    const enum status status = residual_evaluate(residual, state->t, state->y, state->yp, residual->scratch);
    return status == STATUS_RETRY ? status_fail(STATUS_SOLVER, "%s", status_message()) : status;
}

// continuous shedding: the nascent vortex is set free where it is, with the strength it has
static enum status release_nascent(struct state *state, const struct school *school) {
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *fish = &school->fish[f];
        struct wake *wake = &state->wake[f];
        const int last = fish->n_nodes - 1;
        const double tail[2] = {state->y[fish->at.x + last], state->y[fish->at.y + last]};
        double position[2];
        wake_nascent(wake, school->interval, tail, position);
        TRY(wake_release(wake, position[0], position[1], state->y[fish->at.circulation] - wake->shed_before, state->t));
        wake->shed_before = state->y[fish->at.circulation];
    }
    return STATUS_OK;
}

// impulsive shedding: a vortex appears at the tail
static enum status release_impulse(struct state *state, struct residual *residual, struct initial_conditions *initial) {
    const struct school *school = residual->school;
    if (school->kutta == KUTTA_EDGE) {
        // with the strength that makes the bound vortex at the tail vanish
        residual->at_impulse = 1;
        const enum status status = initial_conditions_solve(initial, state->t, state->y, state->yp);
        residual->at_impulse = 0;
        TRY(status);
    } else {
        // with what the rate gives over one interval
        flow_sum_exactly(residual->flow);
        TRY(evaluate(residual, state));
        for (int f = 0; f < school->n_fish; f++) {
            state->y[school->fish[f].at.circulation] +=
                school->interval * residual_kutta_rate(residual, f, state->t, state->y);
        }
    }
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *fish = &school->fish[f];
        struct wake *wake = &state->wake[f];
        const int last = fish->n_nodes - 1;
        TRY(wake_release(wake, state->y[fish->at.x + last], state->y[fish->at.y + last],
                         state->y[fish->at.circulation] - wake->shed_before, state->t));
        wake->shed_before = state->y[fish->at.circulation];
    }
    return STATUS_OK;
}

// velocities of all free vortices, and the slip at every tail, from the state as it is now; n_new: the vortices of each
// fish that have none yet
static enum status take_velocities(struct state *state, struct residual *residual, int n_new) {
    const struct school *school = residual->school;
    struct flow *const flow = residual->flow;
    TRY(flow_at_wake(flow, state));
    for (int f = 0; f < school->n_fish; f++) {
        const int first = flow->released_range[f].first;
        if (state->wake[f].n_vortex > 0) {
            wake_set_velocity(&state->wake[f], flow->wake_u + first, flow->wake_v + first, n_new);
        }
    }
    TRY(flow_interpolate(flow, state));
    TRY(evaluate(residual, state));
    for (int f = 0; f < school->n_fish; f++) flow_slip(flow, f, state->y, state->wake[f].slip);
    return STATUS_OK;
}

// the control of every fish takes its decision; returns whether a bias jumps
static int steer(struct state *state, const struct residual *residual) {
    const struct school *school = residual->school;
    int jumps = 0;
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *fish = &school->fish[f];
        const int first = residual->flow->points[f].first;
        const double tau = fish->control.torque_scale > 0
                               ? drag_moment(fish, residual->flow->u + first, residual->flow->v + first, state->y)
                               : 0;
        jumps |= control_event(fish, &state->control[f], state->t, school->interval, tau,
                               diagnostics_mean_heading(&state->history[f]), state->y);
    }
    return jumps;
}

// what follows once every wake has its new vortices: jumps tells whether the unknowns have become inconsistent, *jumped
// whether they have, or a control law made them so
static enum status finish_event(struct state *state, struct residual *residual, struct initial_conditions *initial,
                                int n_new, int jumps, int *jumped) {
    if (jumps) TRY(initial_conditions_solve(initial, state->t, state->y, state->yp));
    TRY(take_velocities(state, residual, n_new));
    diagnostics_remember(residual, state);
    const int steered = steer(state, residual);
    if (steered) {
        if (!jumps) diagnostics_before_jump(residual, state);
        TRY(initial_conditions_solve(initial, state->t, state->y, state->yp));
        TRY(flow_interpolate(residual->flow, state));
    }
    residual_couple(residual, state->y);
    *jumped = jumps || steered;
    if (*jumped) diagnostics_after_jump(residual, state);
    return STATUS_OK;
}

enum status event_start(struct state *state, struct residual *residual, struct initial_conditions *initial) {
    const int impulsive = residual->school->shedding == SHEDDING_IMPULSIVE;
    int jumped;
    TRY(initial_conditions_solve(initial, state->t, state->y, state->yp));
    if (impulsive) TRY(release_impulse(state, residual, initial));
    TRY(finish_event(state, residual, initial, impulsive, 1, &jumped));
    diagnostics_start(residual, state);
    return STATUS_OK;
}

// whether what happens to the wakes at time t makes a velocity of the fluid, or a circulation, jump
static int wakes_jump(const struct state *state, const struct school *school, double t) {
    if (school->shedding == SHEDDING_IMPULSIVE) return 1;
    for (int f = 0; f < school->n_fish; f++) {
        const struct wake *wake = &state->wake[f];
        if (wake_removal_jumps(wake, school, t)) return 1;
        if (school->removed == REMOVED_DROPPED && wake_n_old(wake, school, t) > 0) return 1;
    }
    return 0;
}

enum status event_next(struct state *state, struct residual *residual, struct initial_conditions *initial,
                       int *jumped) {
    const struct school *school = residual->school;
    for (int f = 0; f < school->n_fish; f++) wake_advance(&state->wake[f], school->interval);
    state->event++;
    state->t = (double)state->event * school->interval;
    const int jumps = wakes_jump(state, school, state->t);
    if (jumps) diagnostics_before_jump(residual, state);
    if (school->shedding == SHEDDING_IMPULSIVE) {
        TRY(release_impulse(state, residual, initial));
    } else {
        TRY(release_nascent(state, school));
    }
    for (int f = 0; f < school->n_fish; f++) wake_remove_old(&state->wake[f], school, state->t);
    return finish_event(state, residual, initial, 1, jumps, jumped);
}
