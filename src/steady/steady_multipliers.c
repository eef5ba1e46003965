/* steady_multipliers.c: see steady_multipliers.h. */
#include "steady/steady_multipliers.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "solver/newton.h"

/* disturbance: increment of a slow quantity, in the scale of the quantity; a disturbance that grows beyond small is
 * followed no further. Of at most BEATS beats the last SLOW_BEATS count, and not the first two, in which the fast
 * quantities decay. */
static const double disturbance = 0.01, small = 0.1;
enum { BEATS = 8, SLOW_BEATS = 4 };

/* base, seen: the unknowns, over the scales, after each beat; the first column holds the start. before, after: the
 * columns used for the multipliers, before and after a beat. */
struct disturbances {
    struct steady_problem *problem;
    struct state *kept;        /* undisturbed state */
    double *add, *base, *seen; /* (n_unknowns), (n_unknowns, BEATS + 1) */
    double *before, *after;    /* (n_unknowns, n_columns) */
    int n_columns;
};

static double largest_value(int n, const double *value) {
    double most = 0;
    for (int i = 0; i < n; i++) most = fmax(most, fabs(value[i]));
    return most;
}

// simulate from the kept state plus the increment; subtract the undisturbed beats, unless NULL, and stop above small
static enum status follow_disturbance(struct disturbances *all, double *seen, const double *without, int *n_beats) {
    struct steady_map *const map = &all->problem->map;
    const int n = all->problem->n_unknowns;
    TRY(steady_map_return(map, all->kept));
    TRY(steady_map_add(map, n, all->problem->unknown, all->add));

    for (*n_beats = 0; *n_beats < BEATS; ++*n_beats) {
        double *const now = seen + (*n_beats + 1) * n;
        TRY(steady_map_beat(map, NULL, NULL));
        steady_problem_read(all->problem, now);
        for (int i = 0; i < n && without; i++) now[i] -= without[i + (*n_beats + 1) * n];
        if (without && *n_beats > 0 && largest_value(n, now) > small) break;
    }

    return STATUS_OK;
}

// change per beat without a disturbance, mean of the last beats; stored in add, which is free now
static void mean_change(struct disturbances *all) {
    const int n = all->problem->n_unknowns;
    const double *const last = all->base + BEATS * n, *const first = last - SLOW_BEATS * n;
    for (int i = 0; i < n; i++) all->add[i] = (last[i] - first[i]) / SLOW_BEATS;
}

// collect the columns before and after the last of n_beats beats; at least one beat
static void collect_beats(struct disturbances *all, int n_beats) {
    const size_t n = (size_t)all->problem->n_unknowns, bytes = n * sizeof *all->seen;
    int first = n_beats - SLOW_BEATS;
    if (first < 2) first = n_beats > 2 ? 2 : 1;
    for (int k = first; k == first || k < n_beats; k++) {
        memcpy(all->before + (size_t)all->n_columns * n, all->seen + (size_t)k * n, bytes);
        memcpy(all->after + (size_t)all->n_columns * n, all->seen + (size_t)(k + 1) * n, bytes);
        all->n_columns++;
    }
}

static enum status disturb_each_unknown(struct disturbances *all) {
    const struct steady_problem *const problem = all->problem;
    int n_beats;
    TRY(follow_disturbance(all, all->base, NULL, &n_beats));
    for (int j = 0; j < problem->n_unknowns; j++) {
        memset(all->add, 0, (size_t)problem->n_unknowns * sizeof *all->add);
        all->add[j] = disturbance * steady_map_scale(&problem->map, problem->unknown[j]);
        TRY(follow_disturbance(all, all->seen, all->base, &n_beats));
        collect_beats(all, n_beats);
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
    if (status == STATUS_OK) status = disturb_each_unknown(&all);
    if (status == STATUS_OK) {
        mean_change(&all);
        status = newton_multipliers((int)n, all.n_columns, all.before, all.after, all.add, real, imaginary, way);
    }

    if (status == STATUS_OK) status = steady_map_return(&problem->map, all.kept);
    state_free(all.kept, problem->map.simulation->school);
    free(memory);
    *n_beats = problem->map.n_beats - n_before;
    problem->map.n_beats = n_before;

    return status;
}
