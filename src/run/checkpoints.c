/* checkpoints.c: plan and files of checkpoints. */
#include "run/checkpoints.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/memory.h"
#include "case/case.h"
#include "result/durable.h"

// ---- names

static char *path_with_ending(const char *path, size_t length, const char *ending) {
    struct text name = {0};
    text_add(&name, "%.*s%s", (int)length, path, ending);
    return name.text;
}

// file name without folders
static const char *file_name_of(const char *path) {
    const char *const slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

char *checkpoints_path(const char *result) {
    const size_t length = strlen(result), n = strlen(".nc");
    const int has_ending = length > n && strcmp(result + length - n, ".nc") == 0 && result[length - n - 1] != '/';

    // the results "a" and "a.nc" have different checkpoints
    return has_ending ? path_with_ending(result, length - n, ".ckpt") : path_with_ending(result, length, ".checkpoint");
}

char *checkpoints_previous(const char *path) {
    return path_with_ending(path, strlen(path), ".previous");
}

// ---- the plan

// read "0.3,1.25"
static enum status checkpoint_places_read(struct checkpoints *checkpoints, const struct case_values *values,
                                          const char *at) {
    const double interval = values->school.shedding_interval;
    TRY(MEMORY_NEW(checkpoints->at, strlen(at) / 2 + 1, "the times of checkpoints"));

    while (*at) {
        char word[64];
        const size_t length = strcspn(at, ",");
        double time;
        snprintf(word, sizeof word, "%.*s", (int)(length < sizeof word ? length : sizeof word - 1), at);
        const int is_number = text_number(word, &time);
        const double event = is_number ? round(time / interval) : 0;
        if (!is_number || !(fabs(time - event * interval) <= 1e-9 * time) || time < 0 ||
            time > values->time.end + interval / 2) {
            return status_fail(STATUS_CASE,
                               "--checkpoint-at: '%s' is not the time of an event: an integer multiple of "
                               "time.shedding_interval, %.9g s, up to time.end, %.9g s",
                               word, interval, values->time.end);
        }
        checkpoints->at[checkpoints->n_at++] = (long)event;
        at += length + (at[length] == ',');
    }

    return STATUS_OK;
}

enum status checkpoints_create(struct checkpoints *checkpoints, const struct case_values *values, const char *result,
                               const char *at) {
    *checkpoints = (struct checkpoints){.last = -1, .last_place = -1};
    checkpoints->interval = lround(values->time.checkpoint_interval / values->school.shedding_interval);
    checkpoints->path = checkpoints_path(result);
    checkpoints->previous = checkpoints->path ? checkpoints_previous(checkpoints->path) : NULL;
    TRY(memory_check(checkpoints->previous, "a file name"));
    text_add_word(&checkpoints->word, checkpoints->path);
    if (checkpoints->word.failed) return memory_check(NULL, "a file name");
    TRY(memory_copy_string(&checkpoints->result, file_name_of(result), "a file name"));

    if (at) TRY(checkpoint_places_read(checkpoints, values, at));
    TRY(checkpoint_check_target(checkpoints->path, checkpoints->result));
    TRY(checkpoint_check_target(checkpoints->previous, checkpoints->result));
    durable_discard(checkpoints->path);
    return case_show(values, &checkpoints->effective);
}

void checkpoints_free(struct checkpoints *checkpoints) {
    free(checkpoints->path);
    free(checkpoints->previous);
    free(checkpoints->result);
    free(checkpoints->effective);
    free(checkpoints->at);
    text_free(&checkpoints->places);
    text_free(&checkpoints->word);
    *checkpoints = (struct checkpoints){0};
}

enum status checkpoints_resume(struct checkpoints *checkpoints, const struct checkpoint *from, long event,
                               int with_other_end) {
    checkpoints->last_place = event;
    if (*from->places) text_add(&checkpoints->places, "%s", from->places);
    if (!with_other_end) {
        checkpoints->last = event;
        free(checkpoints->effective);
        checkpoints->effective = strdup(from->effective);
    }

    if (checkpoints->effective && !checkpoints->places.failed) return STATUS_OK;
    return memory_check(NULL, "the checkpoints of a run");
}

void checkpoints_fall_back(const struct checkpoints *checkpoints) {
    // after a failed rename, simulate_resume refuses the newest checkpoint again
    rename(checkpoints->previous, checkpoints->path);
}

void checkpoints_remove(const struct checkpoints *checkpoints) {
    unlink(checkpoints->path);
    unlink(checkpoints->previous);
}

static int checkpoint_is_regular(const struct checkpoints *checkpoints, long event) {
    return event > 0 && checkpoints->interval > 0 && event % checkpoints->interval == 0;
}

int checkpoints_are_due(const struct checkpoints *checkpoints, long event) {
    int is_due = checkpoint_is_regular(checkpoints, event);
    for (int i = 0; i < checkpoints->n_at; i++) is_due |= checkpoints->at[i] == event;
    return is_due;
}

// ---- writing

enum status checkpoints_write(struct checkpoints *checkpoints, const struct simulation *simulation,
                              const struct record *record) {
    const long event = simulation->state->event;
    if (event == checkpoints->last) return STATUS_OK;
    if (!checkpoint_is_regular(checkpoints, event) && event != checkpoints->last_place) {
        checkpoints->last_place = event;
        const char *const before = checkpoints->places.length > 0 ? "," : "";
        text_add(&checkpoints->places, "%s%.10g", before, simulation->state->t);
        if (checkpoints->places.failed) return memory_check(NULL, "the times of checkpoints");
        result_file_note(record->file, RESULT_CHECKPOINT_AT, checkpoints->places.text);
    }

    struct checkpoint marked = {.effective = checkpoints->effective,
                                .result = checkpoints->result,
                                .places = checkpoints->places.text ? checkpoints->places.text : "",
                                .totals = simulation->totals,
                                .wall_time = simulate_wall_time(simulation)};
    TRY(result_file_mark(record->file, &marked.rows));
    TRY(checkpoint_write(checkpoints->path, checkpoints->previous, &marked, simulation->state, simulation->school));
    checkpoints->last = event;
    return STATUS_OK;
}
