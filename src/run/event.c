/* event.c: from the end of one interval to the start of the next. */
#include "run/event.h"

#include <math.h>
#include <stddef.h>

#include "contact/self_crossing.h"
#include "flow/flow_at_bodies.h"
#include "flow/flow_at_wake.h"
#include "flow/flow_rings.h"
#include "force/drag.h"
#include "school/diagnostics_energy.h"
#include "school/diagnostics_history.h"
#include "school/diagnostics_momentum.h"
#include "state/impulse.h"
#include "state/wake_merge.h"

// evaluate the equations; at an event there is no smaller step to try
static enum status evaluate(struct residual *residual, const struct state *state) {
    const enum status status = residual_evaluate(residual, state->t, state->y, state->yp, residual->scratch);
    return status == STATUS_RETRY ? status_fail(STATUS_SOLVER, "%s", status_message()) : status;
}

static void place_of_tail(const struct state *state, const struct fish *fish, double place[2]) {
    const int last = fish->n_nodes - 1;
    place[0] = state->y[fish->at.x + last];
    place[1] = state->y[fish->at.y + last];
}

// a vortex of all that has been shed since the last one
static enum status release(struct state *state, const struct school *school, int f, const double place[2]) {
    struct wake *const wake = &state->wake[f];
    const double circulation = state->y[school->fish[f].at.circulation];
    TRY(wake_release(wake, place[0], place[1], circulation - wake->shed_before, state->t));
    wake->shed_before = circulation;
    return STATUS_OK;
}

// continuous shedding: the nascent vortex is set free where it is, with the strength it has
static enum status release_nascent(struct state *state, const struct school *school) {
    for (int f = 0; f < school->n_fish; f++) {
        double tail[2], position[2];
        place_of_tail(state, &school->fish[f], tail);
        wake_nascent(&state->wake[f], school->interval, tail, position);
        TRY(release(state, school, f, position));
    }
    return STATUS_OK;
}

// impulsive shedding: a vortex appears at the tail
static enum status release_impulse(struct state *state, struct residual *residual, struct initial_conditions *initial) {
    const struct school *school = residual->school;
    if (school->kutta == KUTTA_EDGE) {
        // with the strength that makes the bound vortex at the tail vanish
        residual->shed_now = SHED_BY_IMPULSE;
        const enum status status = initial_conditions_solve(initial, state->t, state->y, state->yp);
        residual->shed_now = SHED_BY_LAW;
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
        double tail[2];
        place_of_tail(state, &school->fish[f], tail);
        TRY(release(state, school, f, tail));
    }
    return STATUS_OK;
}

// a free sheet: a marker is born at the tail
static enum status release_markers(struct state *state, const struct school *school) {
    for (int f = 0; f < school->n_fish; f++) {
        struct wake *const wake = &state->wake[f];
        double tail[2];
        place_of_tail(state, &school->fish[f], tail);
        wake->shed_before = state->y[school->fish[f].at.circulation];
        TRY(wake_release(wake, tail[0], tail[1], wake->shed_before, state->t));
    }
    return STATUS_OK;
}

// A newborn marker starts with the velocity of the fluid at the tail. Of the slip, the part along the body that points
// forwards is left out: a tail that goes backwards would lay the sheet on the body.
static void start_marker(const struct fish *fish, struct state *state, int f, double *u, double *v) {
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

// the velocities of all free vortices from the state as it is now; n_new: the vortices of each fish that have none yet,
// or ALL
static enum status take_velocities(struct state *state, struct residual *residual, int n_new) {
    const struct school *school = residual->school;
    struct flow *const flow = residual->flow;
    TRY(flow_at_wake(flow, state));
    const int threads = fish_threads(school);
#pragma omp parallel for num_threads(threads) schedule(static)
    for (int f = 0; f < school->n_fish; f++) {
        const int first = flow->wake_range[f].first, newest = first + state->wake[f].n_vortex - 1;
        if (state->wake[f].has_markers) {
            start_marker(&school->fish[f], state, f, &flow->wake_u[newest], &flow->wake_v[newest]);
        }
        if (state->wake[f].n_vortex > 0) {
            const int n = n_new == ALL ? state->wake[f].n_vortex : n_new;
            const double *const rate = flow->rings ? flow->rings->wake_rate + first : NULL;
            wake_set_velocity(&state->wake[f], flow->wake_u + first, flow->wake_v + first, rate, n);
        }
    }
    return STATUS_OK;
}

// the flow as it will be during the next interval, and the slip at every tail
static enum status take_flow(struct state *state, struct residual *residual) {
    TRY(flow_interpolate(residual->flow, state));
    TRY(evaluate(residual, state));
    for (int f = 0; f < residual->school->n_fish; f++) {
        if (!state->wake[f].has_markers) flow_slip(residual->flow, f, state->y, state->wake[f].slip);
    }
    return STATUS_OK;
}

// what the law of fish f sees
static struct control_view view_of(const struct state *state, const struct residual *residual, int f) {
    const struct fish *fish = &residual->school->fish[f];
    const struct flow_at_body flow = flow_at_body(residual->flow, f);
    struct control_view view = {.t = state->t,
                                .interval = residual->school->interval,
                                .mean_heading = diagnostics_mean_heading(&state->history[f])};
    if (control_feels_moment(fish)) view.moment = drag_moment(fish, flow.u, flow.v, state->y);
    view.has_course = diagnostics_course(&state->history[f], &view.course, &view.course_rate);
    return view;
}

// the control of every fish takes its decision; returns whether a bias jumps
static int steer(struct state *state, struct residual *residual) {
    const struct school *school = residual->school;
    const int threads = fish_threads(school);
    int jumps = 0;
#pragma omp parallel for num_threads(threads) schedule(static)
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *fish = &school->fish[f];
        struct control_memory *const memory = &state->control[f];
        const struct control_view view = view_of(state, residual, f);
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

// what follows once every free vortex has its velocity: jumps tells whether the unknowns have jumped, *jumped whether
// they have, or a control law makes them
static enum status finish_event(struct state *state, struct residual *residual, struct initial_conditions *initial,
                                int jumps, int *jumped) {
    TRY(take_flow(state, residual));
    TRY(diagnostics_momentum_event(residual, state));
    diagnostics_remember(residual, state);
    self_crossing_remember(residual->school, state, residual->scratch);
    const int steered = steer(state, residual);
    if (steered) {
        if (!jumps) diagnostics_before_jump(residual, state);
        TRY(initial_conditions_solve(initial, state->t, state->y, state->yp));
        TRY(flow_interpolate(residual->flow, state));
    }
    TRY(residual_couple(&residual->couplings, state->y));
    *jumped = jumps || steered;
    if (*jumped) diagnostics_after_jump(residual, state);
    return STATUS_OK;
}

// the first markers, from the flow before anything has been shed
static enum status start_sheets(struct state *state, struct residual *residual, struct initial_conditions *initial) {
    residual->shed_now = SHED_IS_GIVEN;
    enum status status = initial_conditions_solve(initial, state->t, state->y, state->yp);
    if (status == STATUS_OK) status = release_markers(state, residual->school);
    if (status == STATUS_OK) status = take_velocities(state, residual, 1);
    residual->shed_now = SHED_BY_LAW;
    return status;
}

enum status event_start(struct state *state, struct residual *residual, struct initial_conditions *initial) {
    int jumped;
    residual->at_start = 1;
    if (residual->school->shedding == SHEDDING_SHEET) TRY(start_sheets(state, residual, initial));
    TRY(initial_conditions_solve(initial, state->t, state->y, state->yp));
    residual->at_start = 0;
    if (residual->school->shedding == SHEDDING_IMPULSIVE) {
        TRY(release_impulse(state, residual, initial));
        TRY(initial_conditions_solve(initial, state->t, state->y, state->yp));
        TRY(take_velocities(state, residual, 1));
    }
    TRY(finish_event(state, residual, initial, 1, &jumped));
    diagnostics_start(residual, state);
    return STATUS_OK;
}

enum status event_next(struct state *state, struct residual *residual, struct initial_conditions *initial,
                       int *jumped) {
    const struct school *school = residual->school;
    const int threads = fish_threads(school);
#pragma omp parallel for num_threads(threads) schedule(static)
    for (int f = 0; f < school->n_fish; f++) {
        impulse_fade(school, state, f);
        wake_advance(&state->wake[f], school->interval);
        control_advance(&state->control[f], school->interval);
    }
    state->event++;
    state->t = (double)state->event * school->interval;
    const int jumps = school->shedding == SHEDDING_IMPULSIVE;
    if (jumps) diagnostics_before_jump(residual, state);
    if (jumps) {
        TRY(release_impulse(state, residual, initial));
    } else if (school->shedding == SHEDDING_SHEET) {
        TRY(release_markers(state, school));
    } else {
        TRY(release_nascent(state, school));
    }
#pragma omp parallel for num_threads(threads) schedule(static)
    for (int f = 0; f < school->n_fish; f++) {
        impulse_remove(school, state, f);
        wake_remove_old(&state->wake[f], school, state->t);
    }
    TRY(wake_merge(school, state));
    if (jumps) TRY(initial_conditions_solve(initial, state->t, state->y, state->yp));
    TRY(take_velocities(state, residual, 1));
    return finish_event(state, residual, initial, jumps, jumped);
}

enum status event_change(struct state *state, struct residual *residual, struct initial_conditions *initial,
                         int velocities_are_given) {
    residual->at_start = velocities_are_given;
    const enum status status = initial_conditions_solve(initial, state->t, state->y, state->yp);
    residual->at_start = 0;
    TRY(status);
    TRY(take_velocities(state, residual, ALL));
    TRY(take_flow(state, residual));
    return residual_couple(&residual->couplings, state->y);
}
