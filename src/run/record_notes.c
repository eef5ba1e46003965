/* record_notes.c: attributes of a result that are written at the end of the run. */
#include "run/record_notes.h"

#include <math.h>
#include <stdio.h>

#include "school/warnings.h"

static void record_note_closest(struct result_file *file, const struct simulation *simulation) {
    const struct school *const school = simulation->school;
    const struct closest *const closest = simulation->state->closest;
    if (isinf(closest->distance)) return;
    char text[256];
    snprintf(text, sizeof text, "%.4f m between %.60s and %.60s at t = %.4g s", closest->distance,
             school->fish[closest->fish[0]].name, school->fish[closest->fish[1]].name, closest->t);
    result_file_note(file, RESULT_CLOSEST_APPROACH, text);
}

static void record_note_merged(struct result_file *file, const struct simulation *simulation) {
    const struct school *const school = simulation->school;
    if (school->wake_merge <= 0) return;
    long n_merged = 0, n_vortices = 0;
    for (int f = 0; f < school->n_fish; f++) {
        n_merged += simulation->state->wake[f].n_merged;
        n_vortices += simulation->state->wake[f].n_vortex;
    }

    char text[128];
    snprintf(text, sizeof text, "%ld merged with a neighbour; %ld vortices in the wakes at the end", n_merged,
             n_vortices);
    result_file_note(file, RESULT_MERGED, text);
}

void record_notes_write(struct result_file *file, const struct simulation *simulation,
                        void (*warn)(const char *line, void *data), void *data) {
    char line[WARNING_BYTES], lines[N_WARNINGS * (WARNING_BYTES + 1)];
    size_t length = 0;
    for (enum warning w = 0; w < N_WARNINGS; w++) {
        if (!warnings_line(w, simulation->school, simulation->state, simulation->diagnostics,
                           simulation->residual->scratch, line))
            continue;
        length += (size_t)snprintf(lines + length, sizeof lines - length, "%s%s", length > 0 ? "\n" : "", line);
        if (warn) warn(line, data);
    }

    if (length > 0) result_file_note(file, RESULT_WARNINGS, lines);
    record_note_closest(file, simulation);
    record_note_merged(file, simulation);
}
