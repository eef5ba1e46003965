/* shoal_change.c: the functions of include/shoal.h that change bodies and wakes at an event. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "contact/clearance.h"
#include "library/handle.h"
#include "run/event.h"
#include "run/simulate.h"
#include "school/diagnostics_energy.h"
#include "school/diagnostics_momentum.h"
#include "state/impulse.h"
#include "state/state.h"

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

// ---- the change: complete, or no change on failure

struct change {
    int fish;
    const double *position, *velocity; /* NULL: unchanged                            (n_nodes, 2) */
    const double *vortex;              /* x, y, circulation; NULL: none */
};

static enum status change_apply(const struct change *change, const struct school *school, struct state *state) {
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

    // book the impulse of the vortex as external: lost impulse with the opposite sign
    const double x = change->vortex[0], y = change->vortex[1], circulation = change->vortex[2];
    struct impulse_moments none = {0}, added = {0};
    impulse_add(&added, circulation, x, y);
    TRY(wake_add_vortex(wake, school, state->t, x, y, circulation));
    impulse_book(&state->momentum[change->fish], &none, &added);
    return STATUS_OK;
}

static enum status change_make(struct shoal *run, const void *data) {
    const struct change *const change = data;
    struct simulation *const simulation = run->simulation;
    struct state *const state = simulation->state;
    const struct school *const school = simulation->school;

    // momentum balance before the change
    double before[3];
    simulate_measure(simulation);
    memcpy(before, simulation->diagnostics->momentum_balance, sizeof before);
    diagnostics_before_jump(simulation->residual, state);

    TRY(change_apply(change, school, state));

    // restart the record of the closest approach
    if (change->position) {
        const struct closest *const closest = state->closest;
        clearance_start(school, state, simulation->residual->neighbours, simulation->residual->scratch);
        if (!(closest->distance > 0) && school->contact != CONTACT_WARN) {
            return status_fail(STATUS_CASE, "shoal_set_state: %s and %s would overlap",
                               school->fish[closest->fish[0]].name, school->fish[closest->fish[1]].name);
        }
        self_crossing_remember(school, state, simulation->residual->scratch);
    }

    // make the state consistent, evaluate forces and samples again
    TRY(event_change(state, simulation->residual, simulation->consistent, !change->vortex));
    TRY(handle_evaluate(simulation));

    // replace the newest sample of each fish; discard all earlier samples of a fish with new positions
    for (int f = 0; f < school->n_fish; f++) {
        struct history *const history = &state->history[f];
        state_forget_newest(history);
        if (change->position && f == change->fish) history->n = 0;
    }
    diagnostics_remember(simulation->residual, state);

    // evaluate the forces of images again; the external impulse until this event is unchanged
    double(*external)[3];
    NEW(run->arena, external, school->n_fish);
    for (int f = 0; f < school->n_fish; f++) memcpy(external[f], state->momentum[f].external, sizeof *external);
    diagnostics_momentum_event(simulation->residual, state);
    for (int f = 0; f < school->n_fish; f++) memcpy(state->momentum[f].external, external[f], sizeof *external);
    diagnostics_after_jump(simulation->residual, state);

    // book the change of momentum of the body as external impulse
    simulate_measure(simulation);
    for (int i = 0; i < 3 && !change->vortex; i++) {
        const double given = simulation->diagnostics->momentum_balance[i] - before[i];
        if (isfinite(given)) state->momentum[change->fish].external[i] += given;
    }

    // restart the integrator from the state, as in shoal_clone
    handle_forget_row(run);
    return handle_renew(run);
}

/* Where to put a copy of the state. */
struct keeping {
    struct state **kept;
};

static enum status keep_state(struct shoal *run, const void *data) {
    const struct keeping *const to = data;
    *to->kept = state_create(run->arena, run->simulation->school);
    state_table_copy(*to->kept, run->simulation->state, run->simulation->school, true);
    return STATUS_OK;
}

/* Change a run; after a failure restore the state before the change. */
static enum status change_run(struct shoal *run, const struct change *change) {
    TRY(handle_renew(run));
    const struct integrator_counts when_reached = run->when_reached;
    struct state *kept = NULL;
    TRY(handle_call(run, keep_state, &(struct keeping){&kept}));

    const enum status status = handle_call(run, change_make, change);
    if (status != STATUS_OK) {
        // keep the message of the failure
        char reason[sizeof run->failure];
        snprintf(reason, sizeof reason, "%s", status_message());
        handle_forget_row(run);
        if (handle_call(run, handle_restore, kept) != STATUS_OK) handle_fail(run);
        status_fail(status, "%s", reason);
    }

    run->when_reached = when_reached;
    state_free(kept);
    return status;
}

int shoal_set_state(struct shoal *run, int fish, const double *position, const double *velocity) {
    TRY(handle_check_fish(run, fish, __func__));
    TRY(handle_check_alive(run, __func__));
    const struct fish *const of = &run->simulation->school->fish[fish];
    const double *const given[] = {position, velocity};
    for (int i = 0; i < 4 * of->n_nodes; i++) {
        const int which = i / (2 * of->n_nodes), k = i % (2 * of->n_nodes);
        if (!given[which] || isfinite(given[which][k])) continue;
        return status_fail(STATUS_CASE, "%s: the %s of node %d, %g, is not finite", __func__,
                           which == 0 ? "position" : "velocity", k / 2, given[which][k]);
    }

    // edge lengths within a factor 2 of the length at rest, and turns of joints below the singularity of the curvature
    static const double least = 0.5, most = 2, largest_turn = 3;
    double angle = 0;
    for (int k = 0; k < of->n_edges && position; k++) {
        const double along[2] = {position[2 * k + 2] - position[2 * k], position[2 * k + 3] - position[2 * k + 1]};
        const double length = hypot(along[0], along[1]), at_rest = of->length / of->n_edges;
        if (!(length > least * at_rest && length < most * at_rest)) {
            return status_fail(STATUS_CASE,
                               "%s: edge %d of %s would be %.3g m long, length at rest %.3g m: the ratio must be "
                               "between 0.5 and 2",
                               __func__, k, of->name, length, at_rest);
        }

        // turn of the joint between the previous edge and this edge
        const double before = angle;
        angle = atan2(along[1], along[0]);
        const double turn = remainder(angle - before, 2 * M_PI);
        if (k > 0 && fabs(turn) > largest_turn) {
            return status_fail(STATUS_CASE, "%s: joint %d of %s would turn by %.3g rad, limit %g rad", __func__, k - 1,
                               of->name, turn, largest_turn);
        }
    }
    if (!position && !velocity) return STATUS_OK;
    return change_run(run, &(struct change){.fish = fish, .position = position, .velocity = velocity});
}

int shoal_add_vortex(struct shoal *run, int fish, double x, double y, double circulation) {
    TRY(handle_check_fish(run, fish, __func__));
    TRY(handle_check_alive(run, __func__));
    const double vortex[3] = {x, y, circulation};
    if (!isfinite(x) || !isfinite(y) || !isfinite(circulation)) {
        return status_fail(STATUS_CASE, "%s: vortex at (%g, %g) with circulation %g: not finite", __func__, x, y,
                           circulation);
    }
    return change_run(run, &(struct change){.fish = fish, .vortex = vortex});
}
