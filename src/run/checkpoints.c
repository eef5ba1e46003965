/* checkpoints.c: the plan of the checkpoints, and writing them. */
#include "run/checkpoints.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/parallel.h"
#include "base/text.h"
#include "case/case.h"
#include "result/durable.h"

// ---- the plan

char *checkpoints_path(struct arena *arena, const char *result) {
    const size_t length = strlen(result), n = strlen(".nc");
    const bool has_ending = length > n && strcmp(result + length - n, ".nc") == 0 && result[length - n - 1] != '/';

    // two names, so that the results "a" and "a.nc" do not share a checkpoint
    return arena_text(arena, "%.*s%s", (int)(has_ending ? length - n : length), result,
                      has_ending ? ".ckpt" : ".checkpoint");
}

enum status checkpoints_create(struct arena *arena, struct checkpoints *checkpoints, const struct case_values *values,
                               const char *result, const char *at) {
    *checkpoints = (struct checkpoints){.arena = arena, .places = ""};
    checkpoints->interval = lround(values->time.checkpoint_interval / values->school.shedding_interval);
    checkpoints->wall = values->time.checkpoint_wall;
    checkpoints->written = clock_seconds(CLOCK_MONOTONIC);
    checkpoints->path = checkpoints_path(arena, result);
    checkpoints->previous = arena_text(arena, "%s" CHECKPOINTS_PREVIOUS, checkpoints->path);
    const char *const slash = strrchr(result, '/');
    checkpoints->result = arena_text(arena, "%s", slash ? slash + 1 : result);
    struct text word = {.arena = arena};
    text_add_word(&word, checkpoints->path);
    checkpoints->word = word.text;

    // the times of --checkpoint-at, "0.3,1.25"
    const double interval = values->school.shedding_interval;
    if (at) NEW(arena, checkpoints->at, strlen(at) / 2 + 1);
    while (at && *at) {
        char time_word[64];
        const size_t length = strcspn(at, ",");
        double time;
        snprintf(time_word, sizeof time_word, "%.*s", (int)(length < sizeof time_word ? length : sizeof time_word - 1),
                 at);
        const bool is_number = text_number(time_word, &time);
        const double event = is_number ? round(time / interval) : 0;
        if (!is_number || !(fabs(time - event * interval) <= 1e-9 * time) || time > values->time.end + interval / 2) {
            return status_fail(STATUS_CASE,
                               "--checkpoint-at: '%s' is not the time of an event: an integer multiple of "
                               "time.shedding_interval, %.9g s, up to time.end, %.9g s",
                               time_word, interval, values->time.end);
        }
        checkpoints->at[checkpoints->n_at++] = (long)event;
        at += length + (at[length] == ',');
    }

    TRY(checkpoint_check_target(arena, checkpoints->path, checkpoints->result));
    TRY(checkpoint_check_target(arena, checkpoints->previous, checkpoints->result));
    durable_discard(checkpoints->path);
    checkpoints->effective = case_show(arena, values);
    return STATUS_OK;
}

void checkpoints_resume(struct checkpoints *checkpoints, const struct checkpoint *from, long event,
                        bool with_other_end) {
    checkpoints->has_place = true;
    checkpoints->last_place = event;
    checkpoints->places = arena_text(checkpoints->arena, "%s", from->places);
    if (with_other_end) return;
    checkpoints->has_last = true;
    checkpoints->last = event;
    checkpoints->effective = arena_text(checkpoints->arena, "%s", from->effective);
}

void checkpoints_remove(const struct checkpoints *checkpoints) {
    unlink(checkpoints->path);
    unlink(checkpoints->previous);
}

static bool checkpoint_is_regular(const struct checkpoints *checkpoints, long event) {
    return event > 0 && checkpoints->interval > 0 && event % checkpoints->interval == 0;
}

bool checkpoints_are_due(const struct checkpoints *checkpoints, long event) {
    bool is_due = checkpoint_is_regular(checkpoints, event);
    for (int i = 0; i < checkpoints->n_at; i++) is_due |= checkpoints->at[i] == event;
    return is_due;
}

bool checkpoints_are_due_by_wall(const struct checkpoints *checkpoints) {
    return checkpoints->wall > 0 && clock_seconds(CLOCK_MONOTONIC) - checkpoints->written >= checkpoints->wall;
}

void checkpoints_end(const struct checkpoints *checkpoints) {
    const bool is_planned = checkpoints->interval > 0 || checkpoints->n_at > 0;
    if (checkpoints->is_by_wall && !is_planned) checkpoints_remove(checkpoints);
}

// ---- writing

// the places of further checkpoints, including the present one
static const char *checkpoint_places(const struct checkpoints *checkpoints, const struct state *state) {
    const bool has_place = checkpoints->has_place && state->event == checkpoints->last_place;
    if (has_place || checkpoint_is_regular(checkpoints, state->event)) {
        return checkpoints->places;
    }
    return arena_text(checkpoints->arena, "%s%s%.10g", checkpoints->places, *checkpoints->places ? "," : "", state->t);
}

static enum status checkpoint_put(struct checkpoints *checkpoints, const struct simulation *simulation,
                                  const struct record *record, const char *places) {
    struct checkpoint marked = {.effective = checkpoints->effective,
                                .result = checkpoints->result,
                                .places = places,
                                .totals = simulation->totals,
                                .wall_time = simulate_wall_time(simulation)};
    TRY(result_file_mark(record->file, &marked.rows));
    TRY(checkpoint_write(checkpoints->arena, checkpoints->path, checkpoints->previous, &marked, simulation->state,
                         simulation->school));
    checkpoints->has_last = true;
    checkpoints->last = simulation->state->event;
    checkpoints->written = clock_seconds(CLOCK_MONOTONIC);
    return STATUS_OK;
}

enum status checkpoints_write(struct checkpoints *checkpoints, const struct simulation *simulation,
                              const struct record *record) {
    const struct state *const state = simulation->state;

    // if the wall time has just written a checkpoint at this event, it lacks only the note
    const char *const places = checkpoint_places(checkpoints, state);
    if (places != checkpoints->places) {
        checkpoints->places = places;
        checkpoints->has_place = true;
        checkpoints->last_place = state->event;
        result_file_note(record->file, RESULT_CHECKPOINT_AT, checkpoints->places);
    }
    const bool is_written = checkpoints->has_last && state->event == checkpoints->last;
    if (is_written && !checkpoints->is_by_wall) return STATUS_OK;
    checkpoints->is_by_wall = false;
    return checkpoint_put(checkpoints, simulation, record, checkpoints->places);
}

enum status checkpoints_write_by_wall(struct checkpoints *checkpoints, const struct simulation *simulation,
                                      const struct record *record) {
    checkpoints->is_by_wall = true;
    return checkpoint_put(checkpoints, simulation, record, checkpoint_places(checkpoints, simulation->state));
}
