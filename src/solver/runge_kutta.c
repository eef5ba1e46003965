/* runge_kutta.c: explicit Runge-Kutta methods, by ARKStep on the right-hand side of ode_rhs.h. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "solver/integrator.h"
#include "solver/ode_rhs.h"
#include "solver/sundials.h"

struct runge_kutta {
    struct residual *residual;
    struct state *state;
    struct integrator_options options;
    struct ode_rhs *rhs;
    const volatile sig_atomic_t *stop; /* see integrator.h */
    enum status failure;               /* of the last right-hand side */
    double *tolerance;                 /* absolute tolerance of each unknown                        (n_unknowns) */

    /* the last evaluation, with all unknowns and rates, so that it need not be repeated */
    double *work, *rates; /*                                                           (n_unknowns) */
    bool known;           /* whether they are valid */
    double known_t;
    long known_event;
    long evaluations; /* so far, over all restarts */
    struct integrator_rates *algebraic_rates;

    struct sundials_context context;
    N_Vector y, tolerances;
    void *arkode;
    struct integrator_counts before; /* totals up to the last restart, which sets those of ARKODE to zero */
};

// compute work and rates from the differential unknowns in y, unless they are known
static enum status runge_kutta_evaluate(struct runge_kutta *solver, double t, const double *y) {
    const struct school *const school = solver->residual->school;
    struct residual *const residual = solver->residual;

    // One evaluation serves the end of a step and the start of the next. It is known if time, differential unknowns and
    // wakes equal the arguments of the last evaluation.
    bool is_known = solver->known && t == solver->known_t && solver->state->event == solver->known_event;
    for (int f = 0; f < school->n_fish && is_known; f++) {
        const struct layout *at = &school->fish[f].at;
        const size_t places = (size_t)(at->vx - at->x) * sizeof *y, rest = (size_t)(at->ax - at->second) * sizeof *y;
        is_known = memcmp(y + at->x, solver->work + at->x, places) == 0 &&
                   memcmp(y + at->second, solver->work + at->second, rest) == 0 &&
                   (residual_shed_is_algebraic(residual) ||
                    memcmp(y + at->circulation, solver->work + at->circulation, sizeof *y) == 0);
    }
    if (is_known) return STATUS_OK;

    solver->known = false;
    solver->evaluations++;
    memcpy(solver->work, y, (size_t)school->n_unknowns * sizeof *y);
    TRY(ode_rhs_rates(solver->rhs, t, solver->work, solver->rates));
    solver->known = true;
    solver->known_t = t;
    solver->known_event = solver->state->event;
    return STATUS_OK;
}

static int rates_callback(sunrealtype t, N_Vector y, N_Vector rates, void *data) {
    struct runge_kutta *const solver = data;
    solver->failure = status_ask(solver->stop);
    if (solver->failure == STATUS_OK) solver->failure = runge_kutta_evaluate(solver, t, N_VGetArrayPointer(y));
    if (solver->failure == STATUS_OK) {
        memcpy(N_VGetArrayPointer(rates), solver->rates,
               (size_t)solver->residual->school->n_unknowns * sizeof *solver->rates);
    }
    return solver->failure;
}

static void release_tableau(void *tableau) {
    ARKodeButcherTable_Free(tableau);
}

static void release_arkode(void *arkode) {
    ARKodeFree(&arkode);
}

static enum status runge_kutta_create(struct arena *arena, void **created, struct residual *residual,
                                      struct state *state, const struct integrator_options *options) {
    const struct school *const school = residual->school;
    const int n = school->n_unknowns;
    const double step = options->step;
    struct runge_kutta *solver;
    NEW(arena, solver, 1);
    solver->residual = residual;
    solver->state = state;
    solver->options = *options;
    solver->before = options->before;
    solver->evaluations = options->before.residual_evaluations;
    NEW(arena, solver->work, n);
    NEW(arena, solver->rates, n);
    NEW(arena, solver->tolerance, n);
    // Algebraic unknowns have no rate and so no error here. Velocities need a tolerance, because only they reveal an
    // instability.
    for (int i = 0; i < n; i++) {
        const double tolerance = options->rtol * residual_scale(school, i);
        solver->tolerance[i] = tolerance * residual_undamped(school, i);
    }
    solver->rhs = ode_rhs_create(arena, residual);
    solver->algebraic_rates = integrator_rates_create(arena, school);
    integrator_rates_begin(solver->algebraic_rates, state);

    sundials_context_create(&solver->context, arena, n, 1, &solver->failure);
    solver->y = sundials_context_vector(&solver->context, state->y);
    solver->tolerances = sundials_context_vector(&solver->context, solver->tolerance);
    sundials_context_reserve(&solver->context, 32);  // ARKODE clones fewer for seven stages
    struct sundials_context *const context = &solver->context;

    // the tableau of the method
    const struct method_properties *const properties = &methods_table[options->method];
    const struct butcher_tableau *const tableau = step > 0 ? properties->fixed : properties->adaptive;
    const int n_stages = tableau->n_stages;
    const ARKodeButcherTable table =
        sundials_own(context->arena, release_tableau, ARKodeButcherTable_Alloc(n_stages, tableau->embedded != NULL));
    table->q = tableau->order;
    table->p = tableau->embedded_order;
    for (int i = 0; i < n_stages; i++) {
        table->c[i] = tableau->c[i];
        table->b[i] = tableau->b[i];
        if (tableau->embedded) table->d[i] = tableau->embedded[i];
        for (int j = 0; j < n_stages; j++) table->A[i][j] = tableau->a[i * n_stages + j];
    }

    void *const arkode = solver->arkode = sundials_own(
        context->arena, release_arkode, ARKStepCreate(rates_callback, NULL, state->t, solver->y, context->context));
    // At the stop time 6.4 interpolates, and at order one it does so by a constant: Hermite's interpolant would be the
    // mean of both ends of the step, Lagrange's is the solution at the end.
    if (ARKStepSetErrHandlerFn(arkode, sundials_context_message, &solver->failure) ||
        ARKodeSetUserData(arkode, solver) || ARKStepSetTables(arkode, 0, 0, NULL, table) ||
        (table->q == 1 && ARKodeSetInterpolantType(arkode, ARK_INTERP_LAGRANGE)) ||
        ARKodeSVtolerances(arkode, 0, solver->tolerances) || ARKodeSetMaxNumSteps(arkode, -1) ||
        ARKodeSetMaxErrTestFails(arkode, 20) || ARKodeSetMinStep(arkode, step > 0 ? 0 : 1e-10 * school->interval) ||
        (step > 0 && ARKodeSetFixedStep(arkode, step))) {
        return sundials_context_failed(context, "ARKODE");
    }
    *created = solver;
    return STATUS_OK;
}

static void runge_kutta_count(const void *data, struct integrator_counts *counts) {
    const struct runge_kutta *const solver = data;
    long steps = 0, error_failures = 0;
    double last_step = 0;
    *counts = solver->before;
    ARKodeGetNumSteps(solver->arkode, &steps);
    ARKodeGetNumErrTestFails(solver->arkode, &error_failures);
    ARKodeGetLastStep(solver->arkode, &last_step);
    counts->steps += steps;
    counts->residual_evaluations = solver->evaluations;
    counts->error_test_failures += error_failures;
    if (last_step > 0) counts->step_size = last_step;
    counts->order = methods_table[solver->options.method].order;
    counts->steps_of_order[counts->order - 1] = counts->steps;
}

static enum status runge_kutta_restart(void *data) {
    struct runge_kutta *const solver = data;
    runge_kutta_count(solver, &solver->before);
    integrator_rates_begin(solver->algebraic_rates, solver->state);
    if (ARKStepReInit(solver->arkode, rates_callback, NULL, solver->state->t, solver->y)) {
        return status_fail(STATUS_SOLVER, "ARKODE cannot start again: %s", status_message());
    }
    if (solver->options.step > 0 && ARKodeSetFixedStep(solver->arkode, solver->options.step)) return STATUS_SOLVER;
    return STATUS_OK;
}

static enum status unstable(const struct runge_kutta *solver, double t, const char *why) {
    const struct school *const school = solver->residual->school;
    double step = 0, most = -1;
    int worst = school->fish[0].at.vx;
    if (*why == '\0') why = "the equations have no finite value";
    ARKodeGetLastStep(solver->arkode, &step);
    char with[64] = "even in the first step";
    if (step > 0) snprintf(with, sizeof with, "with the last step, %.3g s,", step);

    // the velocity that is largest in units of its scale, or is not a number
    for (int f = 0; f < school->n_fish; f++) {
        for (int i = school->fish[f].at.vx; i < school->fish[f].at.ax; i++) {
            const double size = fabs(solver->state->y[i]) / residual_scale(school, i);
            if (size <= most) continue;
            worst = i;
            most = isnan(size) ? INFINITY : size;
        }
    }

    const struct unknown_place place = residual_place(school, worst);
    const struct fish *const fish = &school->fish[place.fish];
    // a body that is too stiff and an unstable control show the same symptom
    const char *const control = fish->control.law == CONTROL_NONE
                                    ? ""
                                    : "; or the control is unstable: lower control.gain, and check that the desired "
                                      "heading is reachable";
    return status_fail(STATUS_SOLVER,
                       "unstable at t = %.10g s: %s; the largest velocity is %s[%d] of fish %s; %s the body "
                       "is too stiff for an explicit method: choose solver.method: ida%s%s",
                       t, why, place.name, place.index, fish->name, with,
                       solver->options.step > 0 ? ", or a smaller solver.step" : "", control);
}

static enum status runge_kutta_begin(void *data, double t, const struct integrator_watch *watch) {
    (void)t;
    struct runge_kutta *const solver = data;
    solver->stop = watch->stop;

    // The event has changed the rates. A method whose last stage serves as the next first one would use the old ones.
    if (ARKodeReset(solver->arkode, solver->state->t, solver->y)) {
        return status_fail(STATUS_SOLVER, "ARKODE: %s", status_message());
    }
    return STATUS_OK;
}

static enum status runge_kutta_step(void *data, double t, double *reached) {
    struct runge_kutta *const solver = data;
    struct state *const state = solver->state;
    const size_t size = (size_t)solver->residual->school->n_unknowns * sizeof *state->y;
    if (ARKodeSetStopTime(solver->arkode, t)) return status_fail(STATUS_SOLVER, "ARKODE: %s", status_message());
    solver->failure = STATUS_OK;
    status_clear();
    const int code = ARKodeEvolve(solver->arkode, t, solver->y, reached, ARK_ONE_STEP);
    if (solver->failure == STATUS_STOPPED || solver->failure == STATUS_MEMORY) return solver->failure;
    if (code < 0) return unstable(solver, *reached, status_message());
    if (code == ARK_TSTOP_RETURN) *reached = t;

    // find the algebraic unknowns and all rates at the end of the step, for the energy balance and the event
    const enum status status = runge_kutta_evaluate(solver, *reached, state->y);
    if (status > 0) return unstable(solver, *reached, status_message());
    TRY(status);
    memcpy(state->yp, solver->rates, size);
    memcpy(state->y, solver->work, size);
    integrator_rates_step(solver->algebraic_rates, *reached, state);
    return STATUS_OK;
}

const struct integrator runge_kutta_integrator = {.create = runge_kutta_create,
                                                  .begin = runge_kutta_begin,
                                                  .step = runge_kutta_step,
                                                  .restart = runge_kutta_restart,
                                                  .count = runge_kutta_count};
