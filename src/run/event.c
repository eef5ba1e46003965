/* event.c: from the end of one interval to the start of the next. */
#include "run/event.h"

#include <stdlib.h>

#include "model/diagnostics.h"
#include "model/drag.h"

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
static enum status release_impulse(struct state *state, struct residual *residual,
                                   struct initial_conditions *consistent) {
    const struct school *school = residual->school;
    if (school->kutta == KUTTA_EDGE) {
        // with the strength that makes the bound vortex at the tail vanish
        residual->at_impulse = 1;
        const enum status status = initial_conditions_solve(consistent, state->t, state->y, state->yp);
        residual->at_impulse = 0;
        TRY(status);
    } else {
        // with what the rate gives over one interval
        flow_invalidate(residual->flow);
        TRY(residual_evaluate(residual, state->t, state->y, state->yp, residual->scratch));
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

// velocities of all free vortices, and the slip at every tail, from the state as it is now
static enum status take_velocities(struct state *state, struct residual *residual, int n_new) {
    const struct school *school = residual->school;
    const struct flow *const flow = residual->flow;
    flow_invalidate(residual->flow);
    TRY(flow_update_sources(residual->flow, state, state->t, state->y));
    const int n = flow->released.n;
    double *const u = malloc((2 * (size_t)n + 1) * sizeof *u);
    if (!u) return status_fail(STATUS_MEMORY, "out of memory: the velocities of %d vortices", n);
    double *const v = u + n;
    const enum status status = flow_at_wake(flow, u, v);
    for (int f = 0; f < school->n_fish && status == STATUS_OK; f++) {
        const int first = flow->released_range[f].first;
        if (state->wake[f].n_vortex > 0) wake_set_velocity(&state->wake[f], u + first, v + first, n_new);
    }
    free(u);
    TRY(status);
    TRY(flow_interpolate(residual->flow, state));
    TRY(residual_evaluate(residual, state->t, state->y, state->yp, residual->scratch));
    for (int f = 0; f < school->n_fish; f++) flow_slip(flow, f, state->y, state->wake[f].slip);
    return STATUS_OK;
}

// the control of every fish looks around; returns whether a bias jumps
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

// the state is about to jump: the audits take leave of the energy that it has now, once
static void leave(struct state *state, const struct residual *residual, int *jumped) {
    if (!*jumped) diagnostics_before_jump(residual, state);
    *jumped = 1;
}

// everything after the wake has its new vortices; *jumped comes in as what has jumped so far
static enum status settle(struct state *state, struct residual *residual, struct initial_conditions *consistent,
                          int n_new, int *jumped) {
    if (*jumped) TRY(initial_conditions_solve(consistent, state->t, state->y, state->yp));
    TRY(take_velocities(state, residual, n_new));
    diagnostics_remember(residual, state);
    if (steer(state, residual)) {
        leave(state, residual, jumped);
        TRY(initial_conditions_solve(consistent, state->t, state->y, state->yp));
        TRY(flow_interpolate(residual->flow, state));
    }
    residual_couple(residual, state->y);
    if (*jumped) diagnostics_after_jump(residual, state);
    return STATUS_OK;
}

enum status event_start(struct state *state, struct residual *residual, struct initial_conditions *consistent) {
    int jumped = 1, n_new = 0;
    TRY(initial_conditions_solve(consistent, state->t, state->y, state->yp));
    if (residual->school->shedding == SHEDDING_IMPULSIVE) {
        TRY(release_impulse(state, residual, consistent));
        n_new = 1;
    }
    TRY(settle(state, residual, consistent, n_new, &jumped));
    diagnostics_start(residual, state);
    return STATUS_OK;
}

enum status event_next(struct state *state, struct residual *residual, struct initial_conditions *consistent,
                       int *jumped) {
    const struct school *school = residual->school;
    *jumped = 0;
    for (int f = 0; f < school->n_fish; f++) wake_advance(&state->wake[f], school->interval);
    state->event++;
    state->t = (double)state->event * school->interval;
    if (school->shedding == SHEDDING_IMPULSIVE) {
        leave(state, residual, jumped);
        TRY(release_impulse(state, residual, consistent));
    } else {
        TRY(release_nascent(state, school));
    }
    for (int f = 0; f < school->n_fish; f++) {
        const int n_before = state->wake[f].n_vortex;
        const int lost_strength = wake_remove_old(&state->wake[f], school, state->t);
        const int dropped = school->removed == REMOVED_DROPPED && state->wake[f].n_vortex != n_before;
        if (lost_strength || dropped) leave(state, residual, jumped);
    }
    return settle(state, residual, consistent, 1, jumped);
}
