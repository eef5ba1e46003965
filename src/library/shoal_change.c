/* shoal_change.c: the part of include/shoal.h that changes bodies and wakes from outside, at an event. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "contact/clearance.h"
#include "contact/self_crossing.h"
#include "library/handle.h"
#include "run/event.h"
#include "school/diagnostics_energy.h"
#include "school/diagnostics_history.h"
#include "school/diagnostics_momentum.h"
#include "state/impulse.h"
#include "state/state_table.h"

int shoal_state(struct shoal *run, int fish, double *position, double *velocity) {
    TRY(handle_check_fish(run, fish, __func__));
    const struct fish *const of = &run->simulation->school->fish[fish];
    const double *const y = run->simulation->state->y;
    for (int k = 0; k < of->n_nodes; k++) {
        if (position) position[2 * k] = y[of->at.x + k], position[2 * k + 1] = y[of->at.y + k];
        if (velocity) velocity[2 * k] = y[of->at.vx + k], velocity[2 * k + 1] = y[of->at.vy + k];
    }
    return STATUS_OK;
}

// ---- what can be a body

static enum status check_finite(int n, const double *values, const char *name) {
    for (int i = 0; i < n; i++) {
        if (isfinite(values[i])) continue;
        return status_fail(STATUS_CASE, "shoal_set_state: %s of node %d, %g, is not finite", name, i / 2, values[i]);
    }
    return STATUS_OK;
}

// edges near the length that they have at rest, and joints that the curvature can state
static enum status check_shape(const struct fish *fish, const double *position) {
    static const double least = 0.5, most = 2, largest_turn = 3;
    double angle = 0;
    for (int k = 0; k < fish->n_edges; k++) {
        const double along[2] = {position[2 * k + 2] - position[2 * k], position[2 * k + 3] - position[2 * k + 1]};
        const double length = hypot(along[0], along[1]), at_rest = fish->length / fish->n_edges;
        if (!(length > least * at_rest && length < most * at_rest)) {
            return status_fail(
                STATUS_CASE,
                "shoal_set_state: edge %d of %s would be %.3g m long, and %.3g m at rest: give nodes from "
                "half to twice as far apart",
                k, fish->name, length, at_rest);
        }
        const double before = angle;
        angle = atan2(along[1], along[0]);
        const double turn = remainder(angle - before, 2 * M_PI);
        if (k > 0 && fabs(turn) > largest_turn) {
            return status_fail(STATUS_CASE, "shoal_set_state: joint %d of %s would turn by %.3g rad: at most %g", k - 1,
                               fish->name, turn, largest_turn);
        }
    }
    return STATUS_OK;
}

static enum status check_overlap(const struct simulation *simulation) {
    const struct school *const school = simulation->school;
    const struct closest *const closest = simulation->state->closest;
    if (closest->distance > 0 || school->contact == CONTACT_WARN) return STATUS_OK;
    return status_fail(STATUS_CASE, "shoal_set_state: %s and %s would overlap", school->fish[closest->fish[0]].name,
                       school->fish[closest->fish[1]].name);
}

// ---- the change, which happens as a whole or not at all

struct change {
    int fish;
    const double *position, *velocity; /* NULL: as it is                             (n_nodes, 2) */
    const double *vortex;              /* x, y, circulation; NULL: none */
};

static enum status apply(const struct change *change, const struct school *school, struct state *state) {
    const struct fish *const fish = &school->fish[change->fish];
    struct wake *const wake = &state->wake[change->fish];
    const int n = fish->n_nodes;
    for (int k = 0; k < n && change->position; k++) {
        state->y[fish->at.x + k] = change->position[2 * k];
        state->y[fish->at.y + k] = change->position[2 * k + 1];
    }
    for (int k = 0; k < n && change->velocity; k++) {
        state->y[fish->at.vx + k] = change->velocity[2 * k];
        state->y[fish->at.vy + k] = change->velocity[2 * k + 1];
    }
    if (change->position) TRY(wake_break(wake, school, state->t, change->position + 2 * (n - 1)));
    if (!change->vortex) return STATUS_OK;

    // its impulse comes from outside: circulation that is lost with the other sign
    const double x = change->vortex[0], y = change->vortex[1], circulation = change->vortex[2];
    struct impulse_moments none = {0}, added = {0};
    impulse_add(&added, circulation, x, y);
    TRY(wake_add_vortex(wake, school, state->t, x, y, circulation));
    impulse_book(&state->momentum[change->fish], &none, &added);
    return STATUS_OK;
}

/* The newest sample of each fish is taken again; of a fish that was moved it is the first one. */
static void sample_again(const struct simulation *simulation, const struct change *change) {
    struct state *const state = simulation->state;
    for (int f = 0; f < simulation->school->n_fish; f++) {
        struct history *const history = &state->history[f];
        history->n = change->position && f == change->fish ? 0 : history->n - (history->n > 0);
        history->last = (history->last + history->capacity - 1) % history->capacity;
    }
    diagnostics_remember(simulation->residual, state);
}

// the images act with their new forces from now on
static enum status images_again(const struct simulation *simulation) {
    struct state *const state = simulation->state;
    const int n = simulation->school->n_fish;
    double(*const external)[3] = calloc((size_t)n, sizeof *external);
    if (!external) return status_fail(STATUS_MEMORY, "out of memory: impulses of %d fish", n);
    for (int f = 0; f < n; f++) memcpy(external[f], state->momentum[f].external, sizeof *external);
    const enum status status = diagnostics_momentum_event(simulation->residual, state);
    for (int f = 0; f < n; f++) memcpy(state->momentum[f].external, external[f], sizeof *external);
    free(external);
    return status;
}

static enum status make(struct shoal *run, const struct change *change) {
    struct simulation *const simulation = run->simulation;
    struct state *const state = simulation->state;
    double before[3];
    simulate_measure(simulation);
    memcpy(before, simulation->diagnostics->momentum_balance, sizeof before);
    diagnostics_before_jump(simulation->residual, state);

    TRY(apply(change, simulation->school, state));
    if (change->position) {
        clearance_start(simulation->school, state, simulation->residual->neighbours, simulation->residual->scratch);
        TRY(check_overlap(simulation));
        self_crossing_remember(simulation->school, state, simulation->residual->scratch);
    }
    TRY(event_change(state, simulation->residual, simulation->consistent, !change->vortex));
    TRY(handle_evaluate(simulation));
    sample_again(simulation, change);
    TRY(images_again(simulation));
    diagnostics_after_jump(simulation->residual, state);

    // momentum that a body is given comes from outside
    simulate_measure(simulation);
    for (int i = 0; i < 3 && !change->vortex; i++) {
        const double given = simulation->diagnostics->momentum_balance[i] - before[i];
        if (isfinite(given)) state->momentum[change->fish].external[i] += given;
    }

    // nothing but the state counts from here on, as in a copy
    handle_forget_row(run);
    return handle_renew(run);
}

static enum status change_all(struct shoal *run, const struct change *change) {
    struct simulation *const simulation = run->simulation;
    struct state *kept = NULL;
    TRY(handle_renew(run));
    const struct integrator_counts when_reached = run->when_reached;
    TRY(state_create(&kept, simulation->school));
    enum status status = state_table_copy(kept, simulation->state, simulation->school);
    if (status == STATUS_OK) status = make(run, change);
    if (status != STATUS_OK) {
        // back to the state before
        char reason[sizeof run->failure];
        snprintf(reason, sizeof reason, "%s", status_message());
        handle_forget_row(run);
        enum status back = state_table_copy(simulation->state, kept, simulation->school);
        if (back == STATUS_OK) back = handle_renew(run);
        if (back != STATUS_OK) handle_fail(run);
        status_fail(status, "%s", reason);
    }
    run->when_reached = when_reached;
    state_free(kept, simulation->school);
    return status;
}

int shoal_set_state(struct shoal *run, int fish, const double *position, const double *velocity) {
    TRY(handle_check_fish(run, fish, __func__));
    if (handle_has_failed(run, __func__)) return STATUS_SOLVER;
    const struct fish *const of = &run->simulation->school->fish[fish];
    if (position) TRY(check_finite(2 * of->n_nodes, position, "the position"));
    if (velocity) TRY(check_finite(2 * of->n_nodes, velocity, "the velocity"));
    if (position) TRY(check_shape(of, position));
    if (!position && !velocity) return STATUS_OK;
    return change_all(run, &(struct change){.fish = fish, .position = position, .velocity = velocity});
}

int shoal_add_vortex(struct shoal *run, int fish, double x, double y, double circulation) {
    TRY(handle_check_fish(run, fish, __func__));
    if (handle_has_failed(run, __func__)) return STATUS_SOLVER;
    const double vortex[3] = {x, y, circulation};
    for (int i = 0; i < 3; i++) {
        if (isfinite(vortex[i])) continue;
        return status_fail(STATUS_CASE, "%s: (%g, %g) with %g: not finite", __func__, x, y, circulation);
    }
    return change_all(run, &(struct change){.fish = fish, .vortex = vortex});
}
