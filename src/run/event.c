/* event.c: what happens to the water and to the fish between two intervals, step by step. Nothing is recorded here:
 * observers.c does that before, between and after the functions of this file. */
#include "run/event.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#include "flow/flow.h"
#include "flow/flow_at_bodies.h"
#include "flow/flow_at_wake.h"
#include "force/drag.h"
#include "school/diagnostics.h"

struct event *event_create(struct arena *arena, const struct school *school) {
    struct event *event;
    NEW(arena, event, 1);
    NEW(arena, event->has_kink, school->n_fish);
    NEW(arena, event->lost, school->n_fish);
    NEW(arena, event->thinning, school->n_fish);
    event->arena = arena;
    return event;
}

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

// Evaluate the velocities of all free vortices at the present state. Either the newest vortex of each fish has no
// velocity from the event before, or none of them has.
enum without_velocity { NEWEST_VORTEX, ALL_VORTICES };

static void event_wake_velocities(struct state *state, struct residual *residual, enum without_velocity which) {
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
            const int n_new = which == ALL_VORTICES ? wake->n_vortex : 1;
            const double *const rate = flow->kernel->has_legs ? flow->wake_rate + first : NULL;
            wake_set_velocity(wake, flow->wake_u + first, flow->wake_v + first, rate, n_new);
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

// the fish look at the samples of their last period, and the control law acts; returns whether a bias jumps
static bool event_act(struct state *state, struct residual *residual, struct event *event) {
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
        event->has_kink[f] = fabs(change) > 0;
    }

    return jumps;
}

// Evaluate the flow at the event if unknowns jump, or if shedding or control take values from it. The samples of the
// history do not need it: the last evaluation of the step is exact to the tolerance of Newton's iteration.
static enum status event_flow_if_used(struct state *state, struct residual *residual, bool jumps) {
    const struct school *const school = residual->school;
    bool is_used = jumps || school->shedding != SHEDDING_SHEET;
    for (int f = 0; f < school->n_fish; f++) is_used |= control_uses_moment(&school->fish[f]);
    return is_used ? event_flow(state, residual) : STATUS_OK;
}

enum status event_start(struct state *state, struct residual *residual, struct initial_conditions *initial,
                        struct event *event) {
    const struct school *const school = residual->school;
    const bool is_sheet = school->shedding == SHEDDING_SHEET, has_vortices = school->n_vortices > 0;
    struct residual_mode mode = {.velocities_are_given = true};
    memset(event->lost, 0, (size_t)school->n_fish * sizeof *event->lost);

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
    if (has_vortices || is_sheet) event_wake_velocities(state, residual, ALL_VORTICES);
    mode.shed = SHED_BY_LAW;
    if (is_sheet) TRY(initial_conditions_solve(initial, &mode, state->t, state->y, state->yp));

    if (school->shedding == SHEDDING_IMPULSIVE) {
        TRY(event_release_impulse(state, residual, initial));
        TRY(initial_conditions_solve(initial, &residual_run, state->t, state->y, state->yp));
        event_wake_velocities(state, residual, ALL_VORTICES);
    }

    event->jumps = true;
    return event_flow_if_used(state, residual, event->jumps);
}

enum status event_water(struct state *state, struct residual *residual, struct initial_conditions *initial,
                        struct event *event) {
    const struct school *school = residual->school;
    const int threads = fish_threads(school);

    // wakes and control arrive at the time of the event
#pragma omp parallel for num_threads(threads) schedule(static)
    for (int f = 0; f < school->n_fish; f++) {
        wake_advance(&state->wake[f], school->interval);
        control_advance(&state->control[f], school->interval);
    }
    state->event++;
    state->t = fish_event_time(school, state->event);

    // tails shed; impulsive shedding makes the unknowns jump
    event->jumps = school->shedding == SHEDDING_IMPULSIVE;
    if (event->jumps) {
        TRY(event_release_impulse(state, residual, initial));
    } else {
        event_release(state, school);
    }

    // old vortices and markers go; room for a marker back in every old stretch
    for (int f = 0; f < school->n_fish; f++) {
        struct wake *const wake = &state->wake[f];
        wake_reserve(wake, wake->n_vortex + wake->n_old);
        impulse_thinning_reserve(event->arena, &event->thinning[f], wake);
    }
#pragma omp parallel for num_threads(threads) schedule(static)
    for (int f = 0; f < school->n_fish; f++) event->lost[f] = impulse_thin_wake(school, state, f, &event->thinning[f]);

    // the water has new velocities
    if (event->jumps) TRY(initial_conditions_solve(initial, &residual_run, state->t, state->y, state->yp));
    event_wake_velocities(state, residual, NEWEST_VORTEX);
    return event_flow_if_used(state, residual, event->jumps);
}

enum status event_control(struct state *state, struct residual *residual, struct initial_conditions *initial,
                          struct event *event) {
    const bool steered = event_act(state, residual, event);
    if (steered) TRY(initial_conditions_solve(initial, &residual_run, state->t, state->y, state->yp));
    residual_couple(&residual->couplings, state->y);
    event->jumps |= steered;
    return STATUS_OK;
}

enum status event_change(struct state *state, struct residual *residual, struct initial_conditions *initial,
                         bool velocities_are_given) {
    const struct residual_mode mode = {.velocities_are_given = velocities_are_given};
    TRY(initial_conditions_solve(initial, &mode, state->t, state->y, state->yp));
    event_wake_velocities(state, residual, ALL_VORTICES);
    TRY(event_flow(state, residual));
    residual_couple(&residual->couplings, state->y);
    return STATUS_OK;
}
