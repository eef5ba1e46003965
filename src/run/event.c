/* event.c: what happens to the water and to the fish between two intervals, step by step. event_next is the event of a
 * run; event_start and event_change are its variants at the start and after a change from outside. */
#include "run/event.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>

#include "contact/clearance.h"
#include "flow/flow.h"
#include "flow/flow_at_bodies.h"
#include "flow/flow_at_wake.h"
#include "force/drag.h"
#include "run/simulate.h"
#include "school/diagnostics.h"
#include "school/diagnostics_energy.h"
#include "school/diagnostics_momentum.h"
#include "school/warnings.h"
#include "state/impulse.h"
#include "state/state.h"

// evaluate the equations; STATUS_RETRY becomes final, because an event has no step size to reduce
static enum status event_evaluate(struct residual *residual, const struct state *state) {
    const enum status status =
        residual_evaluate(residual, &residual_run, state->t, state->y, state->yp, residual->scratch);
    return status == STATUS_RETRY ? status_fail(STATUS_SOLVER, "%s", status_message()) : status;
}

// Every fish releases a vortex with the circulation that it has shed since the last release. The marker of a free sheet
// is labelled with the circulation of the body instead.
static void event_release(struct state *state, const struct school *school) {
    for (int f = 0; f < school->n_fish; f++) {
        struct wake *const wake = &state->wake[f];
        double tail[2], nascent[2];
        fish_tail(&school->fish[f], state->y, tail);
        const bool is_nascent = school->shedding == SHEDDING_CONTINUOUS, is_marker = school->shedding == SHEDDING_SHEET;
        if (is_nascent) wake_nascent(wake, school->interval, tail, nascent);
        const double *const place = is_nascent ? nascent : tail;
        const double circulation = state->y[school->fish[f].at.circulation];
        wake_release(wake, place[0], place[1], is_marker ? circulation : circulation - wake->shed_before, state->t);
        wake->shed_before = circulation;
    }
}

// impulsive shedding: a vortex appears at the tail at once
static enum status event_release_impulse(struct state *state, struct residual *residual,
                                         struct initial_conditions *initial) {
    const struct school *school = residual->school;
    if (school->kutta == KUTTA_EDGE) {
        // the circulation that makes the bound vortex at the tail vanish
        const struct residual_mode impulse = {.shed = SHED_BY_IMPULSE};
        TRY(initial_conditions_solve(initial, &impulse, state->t, state->y, state->yp));
    } else {
        // the shedding rate times the interval
        TRY(event_evaluate(residual, state));
        for (int f = 0; f < school->n_fish; f++) {
            state->y[school->fish[f].at.circulation] += school->interval * residual_kutta_rate(residual, f, state->y);
        }
    }

    event_release(state, school);
    return STATUS_OK;
}

enum { ALL = -1 };

// Evaluate the velocities of all free vortices at the present state. n_new: so many vortices of each fish have no
// velocity from before, or ALL.
static void event_wake_velocities(struct state *state, struct residual *residual, int n_new) {
    const struct school *school = residual->school;
    struct flow *const flow = residual->flow;
    flow_at_wake(flow, state);
    const int threads = fish_threads(school);

#pragma omp parallel for num_threads(threads) schedule(static)
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *const fish = &school->fish[f];
        struct wake *const wake = &state->wake[f];
        const int first = flow->wake_range[f].first, newest = first + wake->n_vortex - 1, last = fish->n_nodes - 1;

        // A new marker starts with the velocity of the fluid at the tail, but without the forward component of the slip
        // along the body. With it, a tail that moves backwards would place the sheet on the body.
        if (wake->has_markers) {
            const double velocity[2] = {state->y[fish->at.vx + last], state->y[fish->at.vy + last]};
            const struct direction tail = fish_direction(fish, &fish->tail_tangent, state->y);
            wake->slip[0] = flow->wake_u[newest] - velocity[0];
            wake->slip[1] = flow->wake_v[newest] - velocity[1];
            const double forwards = fmax(0, -(wake->slip[0] * tail.t[0] + wake->slip[1] * tail.t[1]));
            flow->wake_u[newest] += forwards * tail.t[0];
            flow->wake_v[newest] += forwards * tail.t[1];
            wake_set_tail(wake, velocity, tail.t);
        }

        if (wake->n_vortex > 0) {
            const int n = n_new == ALL ? wake->n_vortex : n_new;
            const double *const rate = flow->kernel->has_legs ? flow->wake_rate + first : NULL;
            wake_set_velocity(wake, flow->wake_u + first, flow->wake_v + first, rate, n);
        }
    }
}

// evaluate the slip at every tail
static enum status event_flow(struct state *state, struct residual *residual) {
    TRY(event_evaluate(residual, state));
    for (int f = 0; f < residual->school->n_fish; f++) {
        if (!state->wake[f].has_markers) flow_slip(residual->flow, f, state->y, state->wake[f].slip);
    }
    return STATUS_OK;
}

// update the control of every fish; returns whether a bias jumps
static bool event_control(struct state *state, struct residual *residual) {
    const struct school *school = residual->school;
    const int threads = fish_threads(school);
    bool jumps = false;

#pragma omp parallel for num_threads(threads) schedule(static)
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *fish = &school->fish[f];
        struct control_memory *const memory = &state->control[f];

        // the observations of the control law
        const struct flow_at_body flow = flow_at_body(residual->flow, f);
        struct control_view view = {
            .t = state->t, .interval = school->interval, .mean_heading = diagnostics_mean_heading(&state->history[f])};
        if (control_uses_moment(fish)) view.moment = drag_moment(fish, flow.u, flow.v, state->y);
        const bool holds_place = fish->control.law == CONTROL_PLACE;
        view.has_course = diagnostics_course(&state->history[f], holds_place, school->interval, &view.course,
                                             &view.course_rate, &view.speed);
        if (holds_place && view.has_course) {
            diagnostics_leader(&state->history[f], view.away, view.away_change, &view.leader_heading);
        }

        const double before = control_rate(fish, memory, state->t, 0, state->y), drive_before = memory->drive_rate;
        if (control_event(fish, memory, &view, state->y)) {
#pragma omp atomic write
            jumps = true;
        }
        const double change =
            fabs(control_rate(fish, memory, state->t, 0, state->y) - before) + fabs(memory->drive_rate - drive_before);
        if (fabs(change) > 0) diagnostics_begin(residual, state, f);
    }

    return jumps;
}

// What is recorded at an event, and changes neither the water nor the fish. Before: the rates of algebraic unknowns at
// the end of the interval, and the impulse that the wakes lose by decay in it.
static void event_observe_before(struct residual *residual, struct state *state) {
    const struct school *const school = residual->school;
    const int threads = fish_threads(school);
    state_find_rates(state, school, residual_shed_is_algebraic(residual));

#pragma omp parallel for num_threads(threads) schedule(static)
    for (int f = 0; f < school->n_fish; f++) impulse_fade(school, state, f);
}

// After the water has its new velocities: the momentum balance, the samples of the histories, which the control reads,
// self-crossings and divergence.
static void event_observe_after(struct residual *residual, struct state *state) {
    const struct school *const school = residual->school;
    diagnostics_momentum_event(residual, state);
    diagnostics_remember(residual, state);
    self_crossing_remember(school, state, residual->scratch);
    warnings_divergence(school, state, state->divergence, &state->diverged);
}

// The rest of an event, after the velocities of the free vortices are known. jumps: the unknowns have jumped. *jumped:
// they have, or a control law has made them jump.
static enum status event_finish(struct state *state, struct residual *residual, struct initial_conditions *initial,
                                bool jumps, bool *jumped) {
    // Evaluate the flow at the event if unknowns jump, or if shedding or control take values from it. The samples of
    // the history do not need it: the last evaluation of the step is exact to the tolerance of Newton's iteration.
    const struct school *const school = residual->school;
    bool uses_flow = jumps || school->shedding != SHEDDING_SHEET;
    for (int f = 0; f < school->n_fish; f++) uses_flow |= control_uses_moment(&school->fish[f]);
    if (uses_flow) TRY(event_flow(state, residual));

    event_observe_after(residual, state);

    const bool steered = event_control(state, residual);
    if (steered) {
        if (!jumps) diagnostics_before_jump(residual, state);
        TRY(initial_conditions_solve(initial, &residual_run, state->t, state->y, state->yp));
    }

    residual_couple(&residual->couplings, state->y);
    *jumped = jumps || steered;
    if (*jumped) diagnostics_after_jump(residual, state);
    return STATUS_OK;
}

enum status event_start(struct state *state, struct residual *residual, struct initial_conditions *initial) {
    const struct school *const school = residual->school;
    const bool is_sheet = school->shedding == SHEDDING_SHEET, has_vortices = school->n_vortices > 0;
    struct residual_mode mode = {.velocities_are_given = true};

    // release the first markers while no circulation has been shed
    if (is_sheet) {
        mode.shed = SHED_IS_GIVEN;
        TRY(initial_conditions_solve(initial, &mode, state->t, state->y, state->yp));
        event_release(state, school);
    }

    // put the vortices of the case into the wake of the first fish
    for (int i = 0; i < school->n_vortices; i++) {
        const double *const vortex = school->vortices + 3 * (long)i;
        TRY(wake_add_vortex(&state->wake[0], school, state->t, vortex[0], vortex[1], vortex[2]));
    }

    // solve with all vortices, and if the first markers had a given circulation, once more with the law of shedding
    if (has_vortices || !is_sheet) TRY(initial_conditions_solve(initial, &mode, state->t, state->y, state->yp));
    if (has_vortices || is_sheet) event_wake_velocities(state, residual, ALL);
    mode.shed = SHED_BY_LAW;
    if (is_sheet) TRY(initial_conditions_solve(initial, &mode, state->t, state->y, state->yp));

    if (school->shedding == SHEDDING_IMPULSIVE) {
        TRY(event_release_impulse(state, residual, initial));
        TRY(initial_conditions_solve(initial, &residual_run, state->t, state->y, state->yp));
        event_wake_velocities(state, residual, ALL);
    }

    bool jumped;
    TRY(event_finish(state, residual, initial, true, &jumped));
    diagnostics_start(residual, state);
    return STATUS_OK;
}

enum status event_next(struct state *state, struct residual *residual, struct initial_conditions *initial,
                       bool *jumped) {
    const struct school *school = residual->school;
    const int threads = fish_threads(school);
    event_observe_before(residual, state);

#pragma omp parallel for num_threads(threads) schedule(static)
    for (int f = 0; f < school->n_fish; f++) {
        wake_advance(&state->wake[f], school->interval);
        control_advance(&state->control[f], school->interval);
    }

    state->event++;
    state->t = fish_event_time(school, state->event);

    const bool jumps = school->shedding == SHEDDING_IMPULSIVE;
    if (jumps) diagnostics_before_jump(residual, state);
    if (jumps) {
        TRY(event_release_impulse(state, residual, initial));
    } else {
        event_release(state, school);
    }

#pragma omp parallel for num_threads(threads) schedule(static)
    for (int f = 0; f < school->n_fish; f++) {
        impulse_thin_wake(school, state, f);
    }

    if (jumps) TRY(initial_conditions_solve(initial, &residual_run, state->t, state->y, state->yp));
    event_wake_velocities(state, residual, 1);
    return event_finish(state, residual, initial, jumps, jumped);
}

enum status event_change(struct state *state, struct residual *residual, struct initial_conditions *initial,
                         bool velocities_are_given) {
    const struct residual_mode mode = {.velocities_are_given = velocities_are_given};
    TRY(initial_conditions_solve(initial, &mode, state->t, state->y, state->yp));
    event_wake_velocities(state, residual, ALL);
    TRY(event_flow(state, residual));
    residual_couple(&residual->couplings, state->y);
    return STATUS_OK;
}
