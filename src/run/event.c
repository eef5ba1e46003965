/* event.c: steps of the event between two intervals. */
#include "run/event.h"

#include <math.h>
#include <stddef.h>

#include "contact/clearance.h"
#include "flow/flow_at_bodies.h"
#include "flow/flow_at_wake.h"
#include "force/drag.h"
#include "school/diagnostics.h"
#include "school/diagnostics_energy.h"
#include "school/diagnostics_momentum.h"
#include "school/warnings.h"
#include "state/impulse.h"
#include "state/wake_merge.h"

// evaluate the equations; STATUS_RETRY is final, because an event has no step size
static enum status event_evaluate(struct residual *residual, const struct state *state) {
    const enum status status = residual_evaluate(residual, state->t, state->y, state->yp, residual->scratch);
    return status == STATUS_RETRY ? status_fail(STATUS_SOLVER, "%s", status_message()) : status;
}

static void tail_position(const struct state *state, const struct fish *fish, double place[2]) {
    const int last = fish->n_nodes - 1;
    place[0] = state->y[fish->at.x + last];
    place[1] = state->y[fish->at.y + last];
}

// release a vortex with the circulation shed since the last release
static void event_release(struct state *state, const struct school *school, int f, const double place[2]) {
    struct wake *const wake = &state->wake[f];
    const double circulation = state->y[school->fish[f].at.circulation];
    wake_release(wake, place[0], place[1], circulation - wake->shed_before, state->t);
    wake->shed_before = circulation;
}

// continuous shedding: release the nascent vortex with its position and circulation
static void event_release_nascent(struct state *state, const struct school *school) {
    for (int f = 0; f < school->n_fish; f++) {
        double tail[2], position[2];
        tail_position(state, &school->fish[f], tail);
        wake_nascent(&state->wake[f], school->interval, tail, position);
        event_release(state, school, f, position);
    }
}

// impulsive shedding: a vortex appears at the tail
static enum status event_release_impulse(struct state *state, struct residual *residual,
                                         struct initial_conditions *initial) {
    const struct school *school = residual->school;
    if (school->kutta == KUTTA_EDGE) {
        // circulation for a vanishing bound vortex at the tail
        residual->shed_now = SHED_BY_IMPULSE;
        const enum status status = initial_conditions_solve(initial, state->t, state->y, state->yp);
        residual->shed_now = SHED_BY_LAW;
        TRY(status);
    } else {
        // shedding rate times the interval
        TRY(event_evaluate(residual, state));
        for (int f = 0; f < school->n_fish; f++) {
            state->y[school->fish[f].at.circulation] +=
                school->interval * residual_kutta_rate(residual, f, state->t, state->y);
        }
    }

    for (int f = 0; f < school->n_fish; f++) {
        double tail[2];
        tail_position(state, &school->fish[f], tail);
        event_release(state, school, f, tail);
    }

    return STATUS_OK;
}

// a free sheet: a marker is born at the tail
static void event_release_markers(struct state *state, const struct school *school) {
    for (int f = 0; f < school->n_fish; f++) {
        struct wake *const wake = &state->wake[f];
        double tail[2];
        tail_position(state, &school->fish[f], tail);
        wake->shed_before = state->y[school->fish[f].at.circulation];
        wake_release(wake, tail[0], tail[1], wake->shed_before, state->t);
    }
}

// A new marker starts with the velocity of the fluid at the tail, without the forward component of the slip along the
// body: with this component, a tail that moves backwards would place the sheet on the body.
static void event_start_marker(const struct fish *fish, struct state *state, int f, double *u, double *v) {
    const int last = fish->n_nodes - 1;
    struct wake *const wake = &state->wake[f];
    const double *const y = state->y;
    const double velocity[2] = {y[fish->at.vx + last], y[fish->at.vy + last]};
    const struct direction tail = fish_direction(fish, &fish->tail_tangent, y);
    wake->slip[0] = *u - velocity[0];
    wake->slip[1] = *v - velocity[1];
    const double forwards = fmax(0, -(wake->slip[0] * tail.t[0] + wake->slip[1] * tail.t[1]));
    *u += forwards * tail.t[0];
    *v += forwards * tail.t[1];
    wake_set_tail(wake, velocity, tail.t);
}

enum { ALL = -1 };

// evaluate the velocities of all free vortices at the present state; n_new: number of vortices per fish without a
// previous velocity, or ALL
static void event_wake_velocities(struct state *state, struct residual *residual, int n_new) {
    const struct school *school = residual->school;
    struct flow *const flow = residual->flow;
    flow_at_wake(flow, state);
    const int threads = fish_threads(school);

#pragma omp parallel for num_threads(threads) schedule(static)
    for (int f = 0; f < school->n_fish; f++) {
        const int first = flow->wake_range[f].first, newest = first + state->wake[f].n_vortex - 1;
        if (state->wake[f].has_markers) {
            event_start_marker(&school->fish[f], state, f, &flow->wake_u[newest], &flow->wake_v[newest]);
        }
        if (state->wake[f].n_vortex > 0) {
            const int n = n_new == ALL ? state->wake[f].n_vortex : n_new;
            const double *const rate = flow->kernel->has_legs ? flow->wake_rate + first : NULL;
            wake_set_velocity(&state->wake[f], flow->wake_u + first, flow->wake_v + first, rate, n);
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

// observations of the control law of fish f
static struct control_view event_control_view(const struct state *state, const struct residual *residual, int f) {
    const struct fish *fish = &residual->school->fish[f];
    const struct flow_at_body flow = flow_at_body(residual->flow, f);
    struct control_view view = {.t = state->t,
                                .interval = residual->school->interval,
                                .mean_heading = diagnostics_mean_heading(&state->history[f])};
    if (control_uses_moment(fish)) view.moment = drag_moment(fish, flow.u, flow.v, state->y);
    view.has_course = diagnostics_course(&state->history[f], &view.course, &view.course_rate);
    return view;
}

// update the control of every fish; returns whether a bias jumps
static int event_control(struct state *state, struct residual *residual) {
    const struct school *school = residual->school;
    const int threads = fish_threads(school);
    int jumps = 0;

#pragma omp parallel for num_threads(threads) schedule(static)
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *fish = &school->fish[f];
        struct control_memory *const memory = &state->control[f];
        const struct control_view view = event_control_view(state, residual, f);
        const double before = control_rate(fish, memory, state->t, 0, state->y);
        if (control_event(fish, memory, &view, state->y)) {
#pragma omp atomic write
            jumps = 1;
        }
        const double change = control_rate(fish, memory, state->t, 0, state->y) - before;
        if (fabs(change) > 0) diagnostics_begin(residual, state, f);
    }

    return jumps;
}

// remaining steps of an event after the velocities of the free vortices. jumps: the unknowns have jumped; *jumped: the
// unknowns have jumped, or a control law makes the unknowns jump
static enum status event_finish(struct state *state, struct residual *residual, struct initial_conditions *initial,
                                int jumps, int *jumped) {
    TRY(event_flow(state, residual));
    TRY(diagnostics_momentum_event(residual, state));
    TRY(diagnostics_remember(residual, state));
    self_crossing_remember(residual->school, state, residual->scratch);
    warnings_remember(residual->school, state);

    const int steered = event_control(state, residual);
    if (steered) {
        if (!jumps) diagnostics_before_jump(residual, state);
        TRY(initial_conditions_solve(initial, state->t, state->y, state->yp));
    }

    residual_couple(&residual->couplings, state->y);
    *jumped = jumps || steered;
    if (*jumped) diagnostics_after_jump(residual, state);
    return STATUS_OK;
}

// the vortices of the case, in the wake of the first fish
static enum status event_add_vortices(struct state *state, const struct school *school) {
    for (int i = 0; i < school->n_vortices; i++) {
        const double *const vortex = school->vortices + 3 * (long)i;
        TRY(wake_add_vortex(&state->wake[0], school, state->t, vortex[0], vortex[1], vortex[2]));
    }

    return STATUS_OK;
}

// release the first markers, in the flow without shed circulation
static enum status event_start_sheets(struct state *state, struct residual *residual,
                                      struct initial_conditions *initial) {
    residual->shed_now = SHED_IS_GIVEN;
    enum status status = initial_conditions_solve(initial, state->t, state->y, state->yp);
    if (status == STATUS_OK) {
        event_release_markers(state, residual->school);
        status = event_add_vortices(state, residual->school);
    }
    if (status == STATUS_OK && residual->school->n_vortices > 0) {
        status = initial_conditions_solve(initial, state->t, state->y, state->yp);
    }
    if (status == STATUS_OK) event_wake_velocities(state, residual, ALL);
    residual->shed_now = SHED_BY_LAW;
    return status;
}

// solve for the state at the start, with given velocities of the bodies
static enum status event_start_bodies(struct state *state, struct residual *residual,
                                      struct initial_conditions *initial) {
    if (residual->school->shedding == SHEDDING_SHEET) {
        TRY(event_start_sheets(state, residual, initial));
        return initial_conditions_solve(initial, state->t, state->y, state->yp);
    }
    TRY(event_add_vortices(state, residual->school));
    TRY(initial_conditions_solve(initial, state->t, state->y, state->yp));
    if (residual->school->n_vortices > 0) event_wake_velocities(state, residual, ALL);
    return STATUS_OK;
}

enum status event_start(struct state *state, struct residual *residual, struct initial_conditions *initial) {
    int jumped;
    residual->at_start = 1;
    const enum status started = event_start_bodies(state, residual, initial);
    residual->at_start = 0;
    TRY(started);

    if (residual->school->shedding == SHEDDING_IMPULSIVE) {
        TRY(event_release_impulse(state, residual, initial));
        TRY(initial_conditions_solve(initial, state->t, state->y, state->yp));
        event_wake_velocities(state, residual, ALL);
    }

    TRY(event_finish(state, residual, initial, 1, &jumped));
    diagnostics_start(residual, state);
    return STATUS_OK;
}

enum status event_next(struct state *state, struct residual *residual, struct initial_conditions *initial,
                       int *jumped) {
    const struct school *school = residual->school;
    const int threads = fish_threads(school);
    state_find_rates(state, school, residual_shed_is_algebraic(residual));

#pragma omp parallel for num_threads(threads) schedule(static)
    for (int f = 0; f < school->n_fish; f++) {
        impulse_fade(school, state, f);
        wake_advance(&state->wake[f], school->interval);
        control_advance(&state->control[f], school->interval);
    }

    state->event++;
    state->t = fish_event_time(school, state->event);

    // shed
    const int jumps = school->shedding == SHEDDING_IMPULSIVE;
    if (jumps) diagnostics_before_jump(residual, state);
    if (jumps) {
        TRY(event_release_impulse(state, residual, initial));
    } else if (school->shedding == SHEDDING_SHEET) {
        event_release_markers(state, school);
    } else {
        event_release_nascent(state, school);
    }

#pragma omp parallel for num_threads(threads) schedule(static)
    for (int f = 0; f < school->n_fish; f++) {
        impulse_remove(school, state, f);
        wake_remove_old(&state->wake[f], school, state->t);
    }

    wake_merge(school, state);

    if (jumps) TRY(initial_conditions_solve(initial, state->t, state->y, state->yp));
    event_wake_velocities(state, residual, 1);
    return event_finish(state, residual, initial, jumps, jumped);
}

enum status event_change(struct state *state, struct residual *residual, struct initial_conditions *initial,
                         int velocities_are_given) {
    residual->at_start = velocities_are_given;
    const enum status status = initial_conditions_solve(initial, state->t, state->y, state->yp);
    residual->at_start = 0;
    TRY(status);
    event_wake_velocities(state, residual, ALL);
    TRY(event_flow(state, residual));
    residual_couple(&residual->couplings, state->y);
    return STATUS_OK;
}
