/* steady_multipliers.c: see steady_multipliers.h. */
#include "run/steady_multipliers.h"

#include <stdlib.h>
#include <string.h>

#include "solver/multipliers.h"

/* How much is added to a slow quantity to see what becomes of it, in its scale; the beats after which what is fast has
 * gone, and those that are looked at then. */
static const double disturbance = 0.01;
enum { FAST_BEATS = 2, SLOW_BEATS = 4 };

// the unknowns over their scales after FAST_BEATS beats, from the state that is kept with something added, and after
// each of the SLOW_BEATS that follow: the columns of seen                              (n_unknowns, 1 + SLOW_BEATS)
static enum status follow(struct steady_problem *problem, const struct state *kept, const double *add, double *seen) {
    struct steady_map *const map = &problem->map;
    const int n = problem->n_unknowns;
    TRY(steady_map_return(map, kept));
    TRY(steady_map_add(map, n, problem->unknown, add));
    for (int i = 1; i < FAST_BEATS; i++) TRY(steady_map_beat(map, NULL, NULL));
    for (int k = 0; k <= SLOW_BEATS; k++) {
        TRY(steady_map_beat(map, NULL, NULL));
        steady_map_read(map, n, problem->unknown, seen + k * n);
        for (int i = 0; i < n; i++) seen[i + k * n] /= steady_map_scale(map, problem->unknown[i]);
    }
    return STATUS_OK;
}

// what a disturbance of each unknown adds: before and after each of the SLOW_BEATS  (n_unknowns, n_unknowns SLOW_BEATS)
static enum status disturb(struct steady_problem *problem, const struct state *kept, double *seen, double *before,
                           double *after) {
    const int n = problem->n_unknowns, size = n * (1 + SLOW_BEATS);
    double *const add = problem->scratch, *const base = seen, *const disturbed = seen + size;
    memset(add, 0, (size_t)n * sizeof *add);
    TRY(follow(problem, kept, add, base));
    for (int j = 0; j < n; j++) {
        memset(add, 0, (size_t)n * sizeof *add);
        add[j] = disturbance * steady_map_scale(&problem->map, problem->unknown[j]);
        TRY(follow(problem, kept, add, disturbed));
        for (int i = 0; i < size; i++) disturbed[i] -= base[i];
        const size_t bytes = (size_t)(n * SLOW_BEATS) * sizeof *before;
        memcpy(before + j * n * SLOW_BEATS, disturbed, bytes);
        memcpy(after + j * n * SLOW_BEATS, disturbed + n, bytes);
    }
    return STATUS_OK;
}

enum status steady_multipliers_find(struct steady_problem *problem, double *real, double *imaginary, int *n_beats) {
    const size_t n = (size_t)problem->n_unknowns, n_columns = n * SLOW_BEATS;
    const int n_before = problem->map.n_beats;
    struct state *kept = NULL;
    double *const before = calloc(n * n_columns, sizeof *before), *const after = calloc(n * n_columns, sizeof *after),
                  *const seen = calloc(2 * n * (1 + SLOW_BEATS), sizeof *seen);
    enum status status = before && after && seen ? steady_map_save(&problem->map, &kept)
                                                 : status_fail(STATUS_MEMORY, "out of memory: %zu multipliers", n);
    if (status == STATUS_OK) status = disturb(problem, kept, seen, before, after);
    if (status == STATUS_OK) {
        status = multipliers_of((int)n, (int)n_columns, before, after, real, imaginary);
    }
    if (status == STATUS_OK) status = steady_map_return(&problem->map, kept);
    state_free(kept, problem->map.simulation->school);
    free(before);
    free(after);
    free(seen);
    *n_beats = problem->map.n_beats - n_before;
    problem->map.n_beats = n_before;
    return status;
}
