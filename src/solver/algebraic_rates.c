/* algebraic_rates.c: divided differences of the last three steps. */
#include "solver/algebraic_rates.h"

#include <stdlib.h>
#include <string.h>

enum { N_KEPT = 2 };

struct algebraic_rates {
    const struct school *school;
    int n;             /* steps that are kept, the newest first */
    double t[N_KEPT];  /* s */
    double *y[N_KEPT]; /*                                                                    (n_unknowns) */
};

enum status algebraic_rates_create(struct algebraic_rates **rates, const struct school *school) {
    *rates = NULL;
    struct algebraic_rates *const new = calloc(1, sizeof *new);
    if (!new) goto no_memory;
    new->school = school;
    for (int i = 0; i < N_KEPT; i++) {
        new->y[i] = calloc((size_t)school->n_unknowns, sizeof *new->y[i]);
        if (!new->y[i]) goto no_memory;
    }
    *rates = new;
    return STATUS_OK;

no_memory:
    algebraic_rates_free(new);
    return status_fail(STATUS_MEMORY, "out of memory: the rates of %d unknowns", school->n_unknowns);
}

void algebraic_rates_free(struct algebraic_rates *rates) {
    if (!rates) return;
    for (int i = 0; i < N_KEPT; i++) free(rates->y[i]);
    free(rates);
}

static void keep(struct algebraic_rates *rates, double t, const double *y) {
    double *const oldest = rates->y[N_KEPT - 1];
    memcpy(oldest, y, (size_t)rates->school->n_unknowns * sizeof *y);
    rates->y[1] = rates->y[0];
    rates->y[0] = oldest;
    rates->t[1] = rates->t[0];
    rates->t[0] = t;
    if (rates->n < N_KEPT) rates->n++;
}

void algebraic_rates_begin(struct algebraic_rates *rates, const struct state *state) {
    rates->n = 0;
    keep(rates, state->t, state->y);
}

// the slope at t of the parabola through three steps, or of the line through two
static double slope(const struct algebraic_rates *rates, double t, double value, int i) {
    const double newest = (value - rates->y[0][i]) / (t - rates->t[0]);
    if (rates->n < 2) return newest;
    const double before = (rates->y[0][i] - rates->y[1][i]) / (rates->t[0] - rates->t[1]);
    return newest + (newest - before) * (t - rates->t[0]) / (t - rates->t[1]);
}

void algebraic_rates_step(struct algebraic_rates *rates, double t, struct state *state) {
    if (t <= rates->t[0]) return;
    for (int f = 0; f < rates->school->n_fish; f++) {
        const struct fish *fish = &rates->school->fish[f];
        if (!fish_has_momentum(fish)) continue;
        for (int i = fish->at.vx; i < fish->at.px; i++) state->yp[i] = slope(rates, t, state->y[i], i);
        for (int i = fish->at.gamma; i <= fish->at.circulation; i++) state->yp[i] = slope(rates, t, state->y[i], i);
    }
    keep(rates, t, state->y);
}
