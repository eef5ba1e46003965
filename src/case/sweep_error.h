/* sweep_error.h: the numerical keys, on which results depend and fish do not, and what is known of each before a study.
 * Tested by tests/case/test_sweep.c. */
#ifndef SWEEP_ERROR_H
#define SWEEP_ERROR_H

#include "case/case_values.h"

enum sweep_error_kind {
    SWEEP_POINTS,   /* a number of points n: grid spacing 1/(n - 1) */
    SWEEP_SPACING,  /* the value is the grid spacing, or a tolerance */
    SWEEP_DURATION, /* the larger the better, without an order */
    SWEEP_MODEL     /* a length of the model: its effect is shown, and is no error */
};

/* A numerical key, or a choice of the model that looks like one. */
struct sweep_error_key {
    const char *path;      /* of the table of keys */
    const char *companion; /* another key that is changed in proportion; NULL: none */
    enum sweep_error_kind kind;
    double coarser[2], finer; /* levels: the base value times these; 0: none */
    double order;             /* design order; NaN: none. See sweep_error_order */
};

enum { SWEEP_N_ERROR_KEYS = 11 };
extern const struct sweep_error_key sweep_error_keys[SWEEP_N_ERROR_KEYS];

/* The row of a key by its path in the table of keys, as in "fish.nodes"; NULL: it is not numerical. */
const struct sweep_error_key *sweep_error_find(const char *path);

/* The design order of a key in this case; NaN: none. */
double sweep_error_order(const struct case_values *values, const struct sweep_error_key *key);

#endif
