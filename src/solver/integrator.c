/* integrator.c: rates by divided differences of the last three steps. */
#include "solver/integrator.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

enum { N_KEPT = 2 };

struct integrator_rates {
    const struct school *school;
    int of_circulation;
    int n;             /* number of stored steps, newest first */
    double t[N_KEPT];  /* s */
    double *y[N_KEPT]; /*                                                                    (n_unknowns) */
};

enum status integrator_rates_create(struct integrator_rates **rates, const struct school *school, int of_circulation) {
    TRY(MEMORY_NEW(*rates, 1, "the rates of the unknowns"));
    (*rates)->school = school;
    (*rates)->of_circulation = of_circulation;
    enum status status = STATUS_OK;
    for (int i = 0; i < N_KEPT && status == STATUS_OK; i++) {
        status = MEMORY_NEW((*rates)->y[i], school->n_unknowns, "the rates of the unknowns");
    }
    if (status == STATUS_OK) return status;

    integrator_rates_free(*rates);
    *rates = NULL;
    return status;
}

void integrator_rates_free(struct integrator_rates *rates) {
    if (!rates) return;
    for (int i = 0; i < N_KEPT; i++) free(rates->y[i]);
    free(rates);
}

static void rates_keep(struct integrator_rates *rates, double t, const double *y) {
    double *const oldest = rates->y[N_KEPT - 1];
    memcpy(oldest, y, (size_t)rates->school->n_unknowns * sizeof *y);
    rates->y[1] = rates->y[0];
    rates->y[0] = oldest;
    rates->t[1] = rates->t[0];
    rates->t[0] = t;
    if (rates->n < N_KEPT) rates->n++;
}

void integrator_rates_begin(struct integrator_rates *rates, const struct state *state) {
    rates->n = 0;
    rates_keep(rates, state->t, state->y);
}

// the slope at t of the parabola through three steps, or of the line through two
static double rates_slope(const struct integrator_rates *rates, double t, double value, int i) {
    const double newest = (value - rates->y[0][i]) / (t - rates->t[0]);
    if (rates->n < 2) return newest;
    const double before = (rates->y[0][i] - rates->y[1][i]) / (rates->t[0] - rates->t[1]);
    return newest + (newest - before) * (t - rates->t[0]) / (t - rates->t[1]);
}

void integrator_rates_step(struct integrator_rates *rates, double t, struct state *state) {
    if (t <= rates->t[0]) return;
    for (int f = 0; f < rates->school->n_fish; f++) {
        const struct fish *fish = &rates->school->fish[f];
        const int shed = fish->at.circulation;
        if (fish_has_momentum(fish)) {
            for (int i = fish->at.vx; i < fish->at.px; i++) state->yp[i] = rates_slope(rates, t, state->y[i], i);
            for (int i = fish->at.gamma; i <= shed; i++) state->yp[i] = rates_slope(rates, t, state->y[i], i);
        } else if (rates->of_circulation) {
            state->yp[shed] = rates_slope(rates, t, state->y[shed], shed);
        }
    }
    rates_keep(rates, t, state->y);
}
