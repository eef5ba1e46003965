/* sweep_error.c: the table of numerical keys. */
#include "case/sweep_error.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

/* The table that studies of convergence, error bars and doc/studies.md share. */
const struct sweep_error_key sweep_error_keys[SWEEP_N_ERROR_KEYS] = {
    {"fish.nodes", NULL, SWEEP_POINTS, {1 / 1.5, 1 / 2.0}, 1.4, 2},
    {"fish.sheet_points", NULL, SWEEP_POINTS, {1 / 1.4, 1 / 2.0}, 1.4, 1},
    {"time.shedding_interval", NULL, SWEEP_SPACING, {2, 4}, 0.5, 1},  // of a sheet: see sweep_error_order
    {"solver.rtol", NULL, SWEEP_SPACING, {10, 0}, 0.1, 1},
    {"solver.step", NULL, SWEEP_SPACING, {2, 4}, 0.5, 1},  // of the first order: see sweep_error_order
    {"wake.tolerance", NULL, SWEEP_SPACING, {10, 0}, 0.1, 1},
    {"wake.merge", NULL, SWEEP_SPACING, {10, 0}, 0.1, 1},
    {"wake.lifetime", "wake.fade", SWEEP_DURATION, {1 / 1.5, 0}, 1.5, NAN},
    {"wake.smoothing", NULL, SWEEP_MODEL, {0, 0}, 0.5, 1},
    {"wake.sheet_smoothing", NULL, SWEEP_MODEL, {0, 0}, 0.5, 1},
    {"wake.taper", "wake.taper_beside", SWEEP_MODEL, {0, 0}, 0.5, 1},
};

const struct sweep_error_key *sweep_error_find(const char *path) {
    for (int i = 0; i < SWEEP_N_ERROR_KEYS; i++) {
        if (strcmp(sweep_error_keys[i].path, path) == 0) return &sweep_error_keys[i];
    }
    return NULL;
}

double sweep_error_order(const struct case_values *values, const struct sweep_error_key *key) {
    if (strcmp(key->path, "solver.step") == 0) return methods_table[values->solver.method].order;
    // continuous shedding is of second order, towards a wake that is wrong next to the edge (doc/numerics.md, 5)
    const int is_interval = strcmp(key->path, "time.shedding_interval") == 0;
    if (is_interval && values->school.wake.shedding == SHEDDING_CONTINUOUS) return 2;
    return key->order;
}
