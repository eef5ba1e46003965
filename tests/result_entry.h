/* result_entry.h: The values of a variable of a run as one number, for the tests that notice a change of a result. */
#ifndef RESULT_ENTRY_H
#define RESULT_ENTRY_H

#include <math.h>
#include <netcdf.h>
#include <string.h>

#include "near.h"
#include "shoal.h"

enum { MAX_VARIABLES = 200 };

/* The body of all fish in these runs, unless a fish has another. */
#define BODY "defaults: {fish: {body: {thickness: 0.2, depth: 0.25, modulus: 1e6}}}\n"

/* The values of a variable, as one number: a sum with weights that differ, and the sum of the magnitudes. NaN counts as
 * a number of its own. */
struct entry {
    char run[32], name[NC_MAX_NAME + 1];
    double sum, size;
};

static inline void entry_add(struct entry *entry, size_t i, double value) {
    const double weight = 1 + 0.5 * cos(1.3 * (double)i), term = weight * (isnan(value) ? 1e-3 : value);
    entry->sum += term;
    entry->size += fabs(term);
}

static inline struct entry entry_of(struct shoal *run, const char *name) {
    struct entry entry = {.size = 0};
    struct shoal_array array;
    if (shoal_read(run, name, &array) != SHOAL_OK) fail_msg("%s: %s", name, shoal_message());
    size_t n = 1;
    for (int d = 0; d < array.n_dimensions; d++) n *= array.shape[d];
    for (size_t i = 0; i < n; i++) {
        const double value = array.type == SHOAL_INT    ? ((const int *)array.values)[i]
                             : array.type == SHOAL_LONG ? (double)((const long *)array.values)[i]
                                                        : ((const double *)array.values)[i];
        entry_add(&entry, i, value);
    }
    return entry;
}

// numbers of the machine, numbers and errors of steps, and sums that are zero but for rounding
static inline bool is_left_out(const char *name) {
    static const char *const names[] = {"wall_time",
                                        "steps",
                                        "residual_evaluations",
                                        "newton_iterations",
                                        "order",
                                        "jacobian_evaluations",
                                        "error_test_failures",
                                        "step_size",
                                        "convergence_failures",
                                        "steps_of_order",
                                        "klu_analyses",
                                        "klu_factorisations",
                                        "klu_refactorisations",
                                        "gmres_iterations",
                                        "initial_iterations",
                                        "jacobian_non_zeros",
                                        "factor_non_zeros",
                                        "differential_unknowns",
                                        "algebraic_unknowns",
                                        "total_circulation",
                                        "energy_balance",
                                        "momentum_balance",
                                        "angular_momentum_balance",
                                        "steady_beats",
                                        "steady_residual",
                                        "steady_error",
                                        "steady_multiplier_beats"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        if (strcmp(names[i], name) == 0) return 1;
    }
    return 0;
}

#endif
