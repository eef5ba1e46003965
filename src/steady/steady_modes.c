/* steady_modes.c: see steady_modes.h. */
#include "steady/steady_modes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "fish/fish_prescribed.h"
#include "flow/flow_external.h"
#include "run/event.h"
#include "solver/modes.h"
#include "state/state.h"

/* Wake length, in body lengths: the growth rates agree with an infinite wake to 1e-4 of speed over length. */
static const double wake_lengths = 12;
enum { MOST_EVENTS = 4000 };

static void set_growth(struct steady_values *found) {
    found->growth = found->n_exponents > 0 ? found->rate[0] : NAN;
    found->growth_frequency = found->n_exponents > 0 ? found->omega[0] / (2 * M_PI) : NAN;
}

// ---- an equilibrium

/* The number of events until the wakes are long enough; 0 without a stream. */
static int count_events(const struct simulation *simulation) {
    const struct school *const school = simulation->school;
    const struct fish *const fish = &school->fish[0];
    double stream[2], position[2], velocity[2], acceleration[2];
    fish_prescribed_node(fish, 0, 0, position, velocity, acceleration);
    flow_external(school, 0, position[1], &stream[0], &stream[1]);

    const double speed = hypot(stream[0] - velocity[0], stream[1] - velocity[1]);
    const double duration = fmin(school->lifetime, wake_lengths * fish->length / speed);
    return speed > 0 ? (int)fmin(MOST_EVENTS, duration / school->interval) : 0;
}

/* Set the bodies to the positions at time t: the whole body moves at the velocity of the first node. */
static void hold_bodies(const struct simulation *simulation, const struct state *equilibrium, double t) {
    const struct school *const school = simulation->school;
    struct state *const state = simulation->state;
    const size_t bytes = (size_t)school->n_unknowns * sizeof *state->y;

    memcpy(state->y, equilibrium->y, bytes);
    memcpy(state->yp, equilibrium->yp, bytes);
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *const fish = &school->fish[f];
        double position[2], velocity[2], acceleration[2];
        fish_prescribed_node(fish, 0, equilibrium->t, position, velocity, acceleration);
        for (int i = 0; i < 2 * fish->n_nodes; i++) {
            state->y[fish->at.x + i] += (t - equilibrium->t) * velocity[i / fish->n_nodes];
        }
    }
}

static enum status find_modes_behind_bodies(struct simulation *simulation, const struct state *equilibrium,
                                            int n_events, struct steady_values *found) {
    struct state *const state = simulation->state;
    int n_most = STEADY_QUANTITIES * simulation->school->n_fish, jumped;

    // the held bodies grow a wake
    TRY(event_start(state, simulation->residual, simulation->consistent));
    hold_bodies(simulation, equilibrium, state->t);
    for (int i = 0; i < n_events; i++) {
        if (simulation->stop && *simulation->stop) {
            return status_fail(STATUS_STOPPED, "stopped %s before the modes were found",
                               simulate_stopped_by(simulation->stop));
        }
        hold_bodies(simulation, equilibrium, (double)(state->event + 1) * simulation->school->interval);
        TRY(event_next(state, simulation->residual, simulation->consistent, &jumped));
    }

    struct mode *const mode = calloc((size_t)n_most, sizeof *mode);
    if (!mode) return status_fail(STATUS_MEMORY, "out of memory: %d modes", n_most);
    const enum status status = modes_find(simulation->residual, state, n_most, mode, &found->n_exponents);
    for (int i = 0; i < found->n_exponents; i++) {
        found->rate[i] = mode[i].rate;
        found->omega[i] = mode[i].omega;
    }

    free(mode);
    return status;
}

enum status steady_modes_find(struct simulation *simulation, struct steady_values *found) {
    const int n_events = count_events(simulation);
    found->n_exponents = 0;
    set_growth(found);
    if (n_events == 0 || simulation->school->shedding == SHEDDING_IMPULSIVE || !(simulation->school->density > 0)) {
        return STATUS_OK;
    }

    struct state *kept = NULL;
    TRY(state_create(&kept, simulation->school));
    enum status status = state_table_copy(kept, simulation->state, simulation->school);
    if (status == STATUS_OK) {
        status = find_modes_behind_bodies(simulation, kept, n_events, found);
        const enum status back = state_table_copy(simulation->state, kept, simulation->school);
        if (status == STATUS_OK) status = back;
    }

    state_free(kept, simulation->school);
    TRY(status);
    set_growth(found);
    TRY(simulate_renew(simulation));
    const struct state *const state = simulation->state;
    TRY(residual_evaluate(simulation->residual, state->t, state->y, state->yp, simulation->residual->scratch));
    simulate_measure(simulation);

    return STATUS_OK;
}

// ---- a beat

void steady_modes_of_multipliers(struct steady_values *found, double period) {
    found->n_exponents = 0;
    for (int i = 0; i < found->n_multipliers; i++) {
        const double size = hypot(found->real[i], found->imaginary[i]);
        // take the first multiplier of a complex pair; a zero multiplier has no rate
        if (found->imaginary[i] < 0 || !(size > 0)) continue;
        found->rate[found->n_exponents] = log(size) / period;
        found->omega[found->n_exponents++] = atan2(found->imaginary[i], found->real[i]) / period;
    }
    set_growth(found);
}
