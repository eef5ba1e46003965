/* integrator.c: the loop over the steps of one interval, the totals of the linear solver, and the rates of the bound
 * strengths, which are divided differences over the last three steps. */
#include "solver/integrator.h"

#include <string.h>

#include "solver/linear.h"

enum status integrator_limited(const struct integrator_options *options, double t, const char *more) {
    return status_fail(STATUS_SOLVER,
                       "limited by solver.max_steps at t = %.10g s: more than %d steps from one event to the next%s; "
                       "increase solver.max_steps or %s%s",
                       t, options->max_steps, more, options->step > 0 ? "solver.step" : "solver.rtol",
                       options->method == METHOD_IDA ? "" : ", or choose solver.method: ida");
}

enum status integrator_advance(const struct integrator *integrator, void *solver,
                               const struct integrator_options *options, double start, double t,
                               const struct integrator_watch *watch) {
    // with a fixed step the number of steps is known, so fail before the first one
    double reached = start;
    if (options->step > 0 && (t - start) / options->step > options->max_steps + 0.5) {
        return integrator_limited(options, start, "");
    }

    TRY(integrator->begin(solver, t, watch));
    for (long n = 0; reached < t; n++) {
        if (n == options->max_steps) {
            return integrator->limited ? integrator->limited(solver) : integrator_limited(options, reached, "");
        }
        TRY(integrator->step(solver, t, &reached));
        if (watch->after) watch->after(watch->data, reached);
    }
    return STATUS_OK;
}

void integrator_count_linear(struct integrator_counts *counts, const struct integrator_counts *before,
                             const struct linear_counts *linear) {
    counts->klu_analyses = before->klu_analyses + linear->klu.analyses;
    counts->klu_factorisations = before->klu_factorisations + linear->klu.factorisations;
    counts->klu_refactorisations = before->klu_refactorisations + linear->klu.refactorisations;
    counts->gmres_iterations = before->gmres_iterations + linear->iterations;

    // a solver that has not factorised yet has no sizes of its own
    const bool is_set_up = linear->factor_non_zeros > 0;
    counts->jacobian_non_zeros = is_set_up ? linear->jacobian_non_zeros : before->jacobian_non_zeros;
    counts->factor_non_zeros = is_set_up ? linear->factor_non_zeros : before->factor_non_zeros;
}

enum { N_KEPT = 2 };

struct integrator_rates {
    const struct school *school;
    int n;             /* number of stored steps, newest first */
    double t[N_KEPT];  /* s */
    double *y[N_KEPT]; /*                                                                    (n_unknowns) */
};

struct integrator_rates *integrator_rates_create(struct arena *arena, const struct school *school) {
    struct integrator_rates *rates;
    NEW(arena, rates, 1);
    rates->school = school;
    for (int i = 0; i < N_KEPT; i++) NEW(arena, rates->y[i], school->n_unknowns);
    return rates;
}

void integrator_rates_begin(struct integrator_rates *rates, const struct state *state) {
    memcpy(rates->y[0], state->y, (size_t)rates->school->n_unknowns * sizeof *state->y);
    rates->t[0] = state->t;
    rates->n = 1;
}

void integrator_rates_step(struct integrator_rates *rates, double t, struct state *state) {
    if (t <= rates->t[0]) return;
    for (int f = 0; f < rates->school->n_fish; f++) {
        const struct layout *const at = &rates->school->fish[f].at;
        for (int i = at->gamma; i < at->rated; i++) {
            // the slope of the parabola through three steps, or of the line through two
            const double newest = (state->y[i] - rates->y[0][i]) / (t - rates->t[0]);
            state->yp[i] = newest;
            if (rates->n < 2) continue;
            const double before = (rates->y[0][i] - rates->y[1][i]) / (rates->t[0] - rates->t[1]);
            state->yp[i] = newest + (newest - before) * (t - rates->t[0]) / (t - rates->t[1]);
        }
    }

    double *const oldest = rates->y[N_KEPT - 1];
    memcpy(oldest, state->y, (size_t)rates->school->n_unknowns * sizeof *oldest);
    rates->y[1] = rates->y[0];
    rates->y[0] = oldest;
    rates->t[1] = rates->t[0];
    rates->t[0] = t;
    if (rates->n < N_KEPT) rates->n++;
}
