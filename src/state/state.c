/* state.c: the state before the start, and histories of samples. */
#include "state/state.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "body/rod.h"
#include "fish/fish_start.h"

static enum status history_create(struct history *history, const struct fish *fish, double interval) {
    const double in_a_period = fish->period / interval;
    history->capacity = (int)fmin(floor(in_a_period + 0.5), 1e7) + 1;
    history->n = 0;
    history->last = -1;

    history->sample = calloc((size_t)history->capacity, sizeof *history->sample);
    if (!history->sample) return status_fail(STATUS_MEMORY, "out of memory: %d samples", history->capacity);
    return STATUS_OK;
}

static enum status balance_create(struct energy_balance *balance, const struct fish *fish) {
    double **const per_strain[] = {&balance->strain, &balance->stress, &balance->stress_before};
    return array_many_doubles(per_strain, sizeof per_strain / sizeof *per_strain, rod_n_strains(fish), "the strains");
}

static enum status state_fill(struct state *state, const struct school *school) {
    const size_t n_fish = (size_t)school->n_fish, n_unknowns = (size_t)school->n_unknowns;

    // allocate
    state->y = calloc(n_unknowns, sizeof *state->y);
    state->yp = calloc(n_unknowns, sizeof *state->yp);
    state->wake = calloc(n_fish, sizeof *state->wake);
    state->control = calloc(n_fish, sizeof *state->control);
    state->history = calloc(n_fish, sizeof *state->history);
    state->balance = calloc(n_fish, sizeof *state->balance);
    state->momentum = calloc(n_fish, sizeof *state->momentum);
    state->closest = calloc(1, sizeof *state->closest);
    if (state->closest) state->closest->before = calloc(n_unknowns, sizeof *state->closest->before);
    if (!state->y || !state->yp || !state->wake || !state->control || !state->history || !state->balance ||
        !state->momentum || !state->closest || !state->closest->before) {
        return status_fail(STATUS_MEMORY, "out of memory: the state of %d fish", school->n_fish);
    }

    // set values that do not start at zero
    state->closest->distance = INFINITY;
    state->crossed = -1;
    for (int f = 0; f < school->n_fish; f++) {
        TRY(wake_create(&state->wake[f], 16));
        state->wake[f].has_markers = school->shedding == SHEDDING_SHEET;
        TRY(history_create(&state->history[f], &school->fish[f], school->interval));
        TRY(balance_create(&state->balance[f], &school->fish[f]));
        state->control[f].held_heading = school->fish[f].start_heading;
        fish_start(&school->fish[f], state->y);
    }

    memcpy(state->closest->before, state->y, n_unknowns * sizeof *state->y);
    return STATUS_OK;
}

enum status state_create(struct state **state, const struct school *school) {
    *state = NULL;
    struct state *const new = calloc(1, sizeof *new);
    if (!new) return status_fail(STATUS_MEMORY, "out of memory: a state");

    const enum status status = state_fill(new, school);
    if (status != STATUS_OK) {
        state_free(new, school);
        return status;
    }
    *state = new;
    return STATUS_OK;
}

void state_free(struct state *state, const struct school *school) {
    if (!state) return;
    for (int f = 0; f < school->n_fish; f++) {
        if (state->wake) wake_free(&state->wake[f]);
        if (state->history) free(state->history[f].sample);
        if (!state->balance) continue;
        free(state->balance[f].strain);
        free(state->balance[f].stress);
        free(state->balance[f].stress_before);
    }

    free(state->y);
    free(state->yp);
    free(state->wake);
    free(state->control);
    free(state->history);
    free(state->balance);
    free(state->momentum);
    if (state->closest) free(state->closest->before);
    free(state->closest);
    free(state);
}

unsigned long state_wake_version(const struct state *state, const struct school *school) {
    unsigned long version = 0;
    for (int f = 0; f < school->n_fish; f++) version += state->wake[f].version;
    return version;
}

void state_remember(struct history *history, const struct sample *sample) {
    history->last = (history->last + 1) % history->capacity;
    history->sample[history->last] = *sample;
    if (history->n < history->capacity) history->n++;
}

const struct sample *state_recall(const struct history *history, int age) {
    return &history->sample[(history->last - age + history->capacity) % history->capacity];
}
