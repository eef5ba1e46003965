/* observers.c: what is recorded at the events of a run. */
#include "run/observers.h"

#include <math.h>

#include "contact/clearance.h"
#include "school/diagnostics.h"
#include "school/diagnostics_energy.h"
#include "school/diagnostics_momentum.h"
#include "school/warnings.h"
#include "state/impulse.h"

struct observers {
    double *energy; /* of each fish before the event, J                                     (n_fish) */
};

struct observers *observers_create(struct arena *arena, const struct school *school) {
    struct observers *observers;
    NEW(arena, observers, 1);
    NEW(arena, observers->energy, school->n_fish);
    return observers;
}

void observers_before(struct observers *observers, struct residual *residual, struct state *state) {
    const struct school *const school = residual->school;
    const double t = fish_event_time(school, state->event + 1);
    const int threads = fish_threads(school);
    state_find_rates(state, school, residual_shed_is_algebraic(residual));

#pragma omp parallel for num_threads(threads) schedule(static)
    for (int f = 0; f < school->n_fish; f++) {
        impulse_fade(school, state, f);
        observers->energy[f] = diagnostics_energy(residual, f, t, state->y);
    }
}

void observers_after(struct residual *residual, struct state *state, const struct event *event) {
    const struct school *const school = residual->school;
    for (int f = 0; f < school->n_fish; f++) impulse_book_thinned(school, state, f, &event->lost[f]);
    diagnostics_momentum_event(residual, state);
    diagnostics_remember(residual, state);
    self_crossing_remember(school, state, residual->scratch);
    warnings_divergence(school, state, state->divergence, &state->diverged);

    // look for faded wakes once in the shortest beat
    double rate = 0;
    for (int f = 0; f < school->n_fish; f++) rate = fmax(rate, fish_rate(school, &school->fish[f]));
    const double events_per_beat = fmax(1, round(1 / (rate * school->interval)));
    const bool has_beaten = fmod((double)state->event, events_per_beat) <= 0;
    if (has_beaten) warnings_fading(residual, state, state->fading, &state->faded);
}

void observers_jump(const struct observers *observers, struct residual *residual, struct state *state,
                    const struct event *event) {
    const struct school *const school = residual->school;
    if (event->jumps) {
        // the energy of the jump counts as work
        for (int f = 0; f < school->n_fish; f++) state->balance[f].work[WORK_ALL] -= observers->energy[f];
        diagnostics_after_jump(residual, state);
        return;
    }

    const int threads = fish_threads(school);
#pragma omp parallel for num_threads(threads) schedule(static)
    for (int f = 0; f < school->n_fish; f++) {
        if (event->has_kink[f]) diagnostics_begin(residual, state, f);
    }
}
