/* steady_multipliers.c: see steady_multipliers.h. */
#include "steady/steady_multipliers.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "solver/multipliers.h"

/* How much is added to a slow quantity to see what becomes of it, in its scale; what grows beyond small is followed no
 * longer. Of at most BEATS beats the last SLOW_BEATS count, in which what is fast has gone, and none of the first
 * two. */
static const double disturbance = 0.01, small = 0.1;
enum { BEATS = 8, SLOW_BEATS = 4 };

/* The unknowns over their scales after each beat, the first column at the start; columns that are used, one after the
 * other, as what is before a beat and after it. */
struct disturbances {
    struct steady_problem *problem;
    struct state *kept;        /* the state that is disturbed */
    double *add, *base, *seen; /* (n_unknowns), (n_unknowns, BEATS + 1) */
    double *before, *after;    /* (n_unknowns, n_columns) */
    int n_columns;
};

static double largest(int n, const double *value) {
    double most = 0;
    for (int i = 0; i < n; i++) most = fmax(most, fabs(value[i]));
    return most;
}

// from the state that is kept with something added; less what is without, if that is given, and then while it is small
static enum status follow(struct disturbances *all, double *seen, const double *without, int *n_beats) {
    struct steady_map *const map = &all->problem->map;
    const int n = all->problem->n_unknowns;
    TRY(steady_map_return(map, all->kept));
    TRY(steady_map_add(map, n, all->problem->unknown, all->add));
    for (*n_beats = 0; *n_beats < BEATS; ++*n_beats) {
        double *const now = seen + (*n_beats + 1) * n;
        TRY(steady_map_beat(map, NULL, NULL));
        steady_problem_read(all->problem, now);
        for (int i = 0; i < n && without; i++) now[i] -= without[i + (*n_beats + 1) * n];
        if (without && *n_beats > 0 && largest(n, now) > small) break;
    }
    return STATUS_OK;
}

// what a beat changes where nothing is disturbed, as the mean of the last beats; in add, which is no longer needed
static void mean_change(struct disturbances *all) {
    const int n = all->problem->n_unknowns;
    const double *const last = all->base + BEATS * n, *const first = last - SLOW_BEATS * n;
    for (int i = 0; i < n; i++) all->add[i] = (last[i] - first[i]) / SLOW_BEATS;
}

// the last beats, before and after, of which there are n_beats; one at least
static void collect(struct disturbances *all, int n_beats) {
    const size_t n = (size_t)all->problem->n_unknowns, bytes = n * sizeof *all->seen;
    int first = n_beats - SLOW_BEATS;
    if (first < 2) first = n_beats > 2 ? 2 : 1;
    for (int k = first; k == first || k < n_beats; k++) {
        memcpy(all->before + (size_t)all->n_columns * n, all->seen + (size_t)k * n, bytes);
        memcpy(all->after + (size_t)all->n_columns * n, all->seen + (size_t)(k + 1) * n, bytes);
        all->n_columns++;
    }
}

static enum status disturb(struct disturbances *all) {
    const struct steady_problem *const problem = all->problem;
    int n_beats;
    TRY(follow(all, all->base, NULL, &n_beats));
    for (int j = 0; j < problem->n_unknowns; j++) {
        memset(all->add, 0, (size_t)problem->n_unknowns * sizeof *all->add);
        all->add[j] = disturbance * steady_map_scale(&problem->map, problem->unknown[j]);
        TRY(follow(all, all->seen, all->base, &n_beats));
        collect(all, n_beats);
    }
    return STATUS_OK;
}

enum status steady_multipliers_find(struct steady_problem *problem, double *real, double *imaginary, double *way,
                                    int *n_beats) {
    const size_t n = (size_t)problem->n_unknowns, size = n * n * SLOW_BEATS, seen = n * (BEATS + 1);
    const int n_before = problem->map.n_beats;
    double *const memory = calloc(n + 2 * seen + 2 * size, sizeof *memory);
    if (!memory) return status_fail(STATUS_MEMORY, "out of memory: %zu multipliers", n);
    struct disturbances all = {.problem = problem,
                               .add = memory,
                               .base = memory + n,
                               .seen = memory + n + seen,
                               .before = memory + n + 2 * seen,
                               .after = memory + n + 2 * seen + size};
    enum status status = steady_map_save(&problem->map, &all.kept);
    if (status == STATUS_OK) status = disturb(&all);
    if (status == STATUS_OK) {
        mean_change(&all);
        status = multipliers_of((int)n, all.n_columns, all.before, all.after, all.add, real, imaginary, way);
    }
    if (status == STATUS_OK) status = steady_map_return(&problem->map, all.kept);
    state_free(all.kept, problem->map.simulation->school);
    free(memory);
    *n_beats = problem->map.n_beats - n_before;
    problem->map.n_beats = n_before;
    return status;
}
