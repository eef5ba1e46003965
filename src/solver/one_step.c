/* one_step.c: methods of fixed step for comparisons, implicit ones on the residual of the school, and Verlet's
 * method. */
#include <math.h>
#include <string.h>

#include "base/mathematics.h"
#include "school/residual.h"
#include "school/residual_jacobian.h"
#include "solver/integrator.h"
#include "solver/linear.h"
#include "solver/ode_rhs.h"

/* Newton's iteration has to reach this fraction of the tolerance of each unknown. */
static const double newton_coefficient = 0.01;

/* The linear solver has to reach this fraction of the right-hand side; an old Jacobian causes a larger error anyway. */
static const double linear_relative = 1e-3;

/* A Jacobian is kept while each correction is at most this fraction of the one before. */
static const double slow_rate = 0.3;

enum { MAX_ITERATIONS = 12 };

/* Equal steps from one event to the next. */
struct steps {
    double start, h; /* s */
    long i, n;       /* number of steps done, and of all steps */
};

static void steps_begin(struct steps *steps, double start, double interval, double step) {
    const long n = lround(interval / step);
    *steps = (struct steps){.start = start, .h = interval / (double)n, .n = n};
}

// the end of the next step; the last one ends exactly at the event t
static double steps_next(struct steps *steps, double t) {
    steps->i++;
    return steps->i < steps->n ? steps->start + (double)steps->i * steps->h : t;
}

struct one_step {
    struct residual *residual;
    struct state *state;
    struct integrator_options options;
    struct jacobian *jacobian;
    struct linear *linear;
    const volatile sig_atomic_t *stop; /* see integrator.h */
    struct steps steps;
    unsigned pattern;                /* of the residual, when the Jacobian was evaluated */
    double cj;                       /* of the factorised Jacobian; 0: there is none */
    double *kind, *tolerance;        /* kind and absolute tolerance of each unknown     (n_unknowns) */
    double *before, *rates;          /* unknowns and rates at the start of the step     (n_unknowns) */
    double *correction, *right_hand; /* Newton's                                        (n_unknowns) */
    double *older;                   /* imex: unknowns one step before `before`         (n_unknowns) */
    double *forces[2], *given;       /* imex, rows ax and ay: R_n, R_n-1, and R extrapolated, N (n_unknowns) */
    int n_known;                     /* imex: how many of R_n, R_n-1 are known */
    struct integrator_rates *algebraic_rates;
    struct integrator_counts counts;
};

static enum status one_step_create(struct arena *arena, void **created, struct residual *residual, struct state *state,
                                   const struct integrator_options *options) {
    const int n = residual->school->n_unknowns;
    struct one_step *solver;
    NEW(arena, solver, 1);
    solver->residual = residual;
    solver->state = state;
    solver->options = *options;
    solver->pattern = residual->couplings.pattern;
    solver->counts = options->before;
    solver->counts.step_size = options->step;
    solver->counts.order = methods_table[options->method].order;

    double **const arrays[] = {&solver->kind,       &solver->tolerance,  &solver->before, &solver->rates,
                               &solver->correction, &solver->right_hand, &solver->older,  &solver->forces[0],
                               &solver->forces[1],  &solver->given};
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++) NEW(arena, *arrays[i], n);
    residual_kinds(residual, &residual_run, solver->kind);
    for (int i = 0; i < n; i++) {
        // without this factor, errors of Newton's iteration in the velocities of a stiff body add up to a spurious
        // momentum
        const double tolerance = options->rtol * residual_scale(residual->school, i);
        solver->tolerance[i] = tolerance * residual_undamped(residual->school, i);
    }
    solver->algebraic_rates = integrator_rates_create(arena, residual->school);
    integrator_rates_begin(solver->algebraic_rates, state);
    solver->jacobian = jacobian_create(arena, residual->school);
    residual_mask(residual, solver->jacobian);
    solver->linear = linear_create(arena, solver->jacobian, solver->tolerance,
                                   (struct linear_tolerance){.relative = linear_relative});
    *created = solver;
    return STATUS_OK;
}

static void one_step_count(const void *data, struct integrator_counts *counts) {
    const struct one_step *const solver = data;
    const struct linear_counts linear = linear_count(solver->linear);
    *counts = solver->counts;
    integrator_count_linear(counts, &solver->options.before, &linear);
}

// the history consists of the Jacobian and, for imex, of the forces and unknowns before
static enum status one_step_restart(void *data) {
    struct one_step *const solver = data;
    solver->cj = 0;
    solver->n_known = 0;
    integrator_rates_begin(solver->algebraic_rates, solver->state);
    return STATUS_OK;
}

// ---- one step

/* Set the rates at the end of the step from the unknowns there. */
static void one_step_rates(struct one_step *solver, double h) {
    struct state *const state = solver->state;
    const bool is_trapezoid = solver->options.method == METHOD_TRAPEZOID, has_older = solver->n_known == 2;
    for (int i = 0; i < solver->residual->school->n_unknowns; i++) {
        const double change = (state->y[i] - solver->before[i]) / h;
        // integrator_rates_step and state_find_rates replace the rates of algebraic unknowns that are used
        state->yp[i] = is_trapezoid && solver->kind[i] > 0 ? 2 * change - solver->rates[i]
                       : has_older ? 1.5 * change - 0.5 * (solver->before[i] - solver->older[i]) / h
                                   : change;
    }
}

/* imex: move on to the step from t to t + h, that is find R_n there and extrapolate it. */
static enum status one_step_extrapolate(struct one_step *solver, double t) {
    struct residual *const residual = solver->residual;
    double *const older = solver->forces[1], *const known = solver->forces[0];
    solver->counts.residual_evaluations++;
    TRY(residual_evaluate(residual, &residual_run, t, solver->state->y, solver->state->yp, solver->right_hand));
    for (int f = 0; f < residual->school->n_fish; f++) {
        const struct fish *const fish = &residual->school->fish[f];
        for (int i = fish->at.ax; i < fish->at.ax + 2 * fish->n_nodes; i++) {
            older[i] = known[i];
            known[i] = 0;
        }
        residual_forces(residual, f, solver->state->y, known);
        for (int i = fish->at.ax; i < fish->at.ax + 2 * fish->n_nodes; i++) {
            known[i] *= -1;
            solver->given[i] = solver->n_known > 0 ? 2 * known[i] - older[i] : known[i];
        }
    }
    memcpy(solver->older, solver->before, (size_t)residual->school->n_unknowns * sizeof *solver->older);
    solver->n_known = solver->n_known > 0 ? 2 : 1;
    return STATUS_OK;
}

/* Newton's iteration, which starts from the unknowns in the state. STATUS_RETRY: it does not converge. */
static enum status one_step_iterate(struct one_step *solver, const struct residual_mode *mode, double t, double h) {
    struct residual *const residual = solver->residual;
    struct state *const state = solver->state;
    const double cj = (solver->options.method == METHOD_TRAPEZOID ? 2 : solver->n_known == 2 ? 1.5 : 1) / h;
    double before = 0;
    for (int i = 0; i < MAX_ITERATIONS; i++) {
        TRY(status_ask(solver->stop));

        if (solver->cj != cj || solver->pattern != residual->couplings.pattern) {
            solver->pattern = residual->couplings.pattern;
            solver->counts.jacobian_evaluations++;
            solver->cj = 0;
            TRY(residual_jacobian(residual, mode, t, cj, state->y, solver->jacobian));
            const enum status status = linear_setup(solver->linear);
            if (status == STATUS_SOLVER) return status_fail(STATUS_RETRY, "the Jacobian is singular");
            TRY(status);
            solver->cj = cj;
        }

        // correct the unknowns, and measure the correction in tolerances
        one_step_rates(solver, h);
        solver->counts.residual_evaluations++;
        solver->counts.newton_iterations++;
        TRY(residual_evaluate(residual, mode, t, state->y, state->yp, solver->right_hand));
        TRY(linear_solve(solver->linear, solver->right_hand, solver->correction));
        double size = 0;
        for (int k = 0; k < residual->school->n_unknowns; k++) {
            state->y[k] -= solver->correction[k];
            size = larger(size, fabs(solver->correction[k]) / solver->tolerance[k]);
        }
        if (!isfinite(size)) return STATUS_RETRY;

        // estimate the error that is left after this correction from the rate of convergence
        const double rate = i > 0 ? size / before : 0;
        const double error = i > 0 && rate < 0.5 ? size * rate / (1 - rate) : size;
        // at the level of rounding, corrections no longer shrink
        if (error < newton_coefficient || (rate > 0.9 && size < 1)) return STATUS_OK;
        if (rate > slow_rate) solver->cj = 0;
        before = size;
    }
    return STATUS_RETRY;
}

static enum status one_step_begin(void *data, double t, const struct integrator_watch *watch) {
    struct one_step *const solver = data;
    solver->stop = watch->stop;
    (void)t;
    steps_begin(&solver->steps, solver->state->t, solver->residual->school->interval, solver->options.step);
    return STATUS_OK;
}

static enum status one_step_step(void *data, double t, double *reached) {
    struct one_step *const solver = data;
    struct state *const state = solver->state;
    const double h = solver->steps.h, end = steps_next(&solver->steps, t);
    const size_t size = (size_t)solver->residual->school->n_unknowns * sizeof *state->y;
    const bool is_split = solver->options.method == METHOD_IMEX;
    const enum status extrapolated = is_split ? one_step_extrapolate(solver, end - h) : STATUS_OK;
    if (extrapolated > 0) {
        return status_fail(STATUS_SOLVER, "integration failed at t = %.10g s: %s", end - h, status_message());
    }
    TRY(extrapolated);
    memcpy(solver->before, state->y, size);
    memcpy(solver->rates, state->yp, size);

    // start from the extrapolated unknowns; if the iteration fails, try once more with a new Jacobian
    const struct residual_mode mode = {.forces = is_split ? solver->given : NULL};
    for (size_t k = 0; solver->n_known == 2 && k < size / sizeof *state->y; k++) {
        state->y[k] += solver->before[k] - solver->older[k];
    }
    enum status status = one_step_iterate(solver, &mode, end, h);
    if (status > 0) {
        solver->cj = 0;
        memcpy(state->y, solver->before, size);
        status = one_step_iterate(solver, &mode, end, h);
    }
    if (status > 0) {
        return status_fail(STATUS_SOLVER,
                           "integration failed at t = %.10g s: Newton's iteration did not converge with steps of "
                           "%.3g s: choose a smaller solver.step, or solver.method: ida",
                           end - h, solver->options.step);
    }
    TRY(status);
    one_step_rates(solver, h);
    solver->counts.steps++;
    solver->counts.steps_of_order[solver->counts.order - 1]++;
    integrator_rates_step(solver->algebraic_rates, end, state);
    *reached = end;
    return STATUS_OK;
}

const struct integrator one_step_integrator = {.create = one_step_create,
                                               .begin = one_step_begin,
                                               .step = one_step_step,
                                               .restart = one_step_restart,
                                               .count = one_step_count};

// ---- kick, drift, kick

struct verlet {
    struct steps steps;
    const volatile sig_atomic_t *stop; /* see integrator.h */
    struct residual *residual;
    struct state *state;
    struct integrator_options options;
    struct ode_rhs *rhs;
    struct integrator_counts counts;
};

static enum status verlet_create(struct arena *arena, void **created, struct residual *residual, struct state *state,
                                 const struct integrator_options *options) {
    struct verlet *solver;
    NEW(arena, solver, 1);
    solver->residual = residual;
    solver->state = state;
    solver->options = *options;
    solver->counts = options->before;
    solver->counts.step_size = options->step;
    solver->counts.order = methods_table[options->method].order;
    solver->rhs = ode_rhs_create(arena, residual);
    *created = solver;
    return STATUS_OK;
}

static void verlet_count(const void *data, struct integrator_counts *counts) {
    *counts = ((const struct verlet *)data)->counts;
}

static enum status verlet_unstable(const struct verlet *solver, double t) {
    return status_fail(
        STATUS_SOLVER,
        "unstable at t = %.10g s: with steps of %.3g s the body is too stiff for an explicit method: choose "
        "solver.method: ida, or a smaller solver.step",
        t, solver->options.step);
}

static enum status verlet_begin(void *data, double t, const struct integrator_watch *watch) {
    struct verlet *const solver = data;
    solver->stop = watch->stop;
    (void)t;
    steps_begin(&solver->steps, solver->state->t, solver->residual->school->interval, solver->options.step);
    return STATUS_OK;
}

// Advance the velocities by the acceleration over h/2. Without water the momentum over mass is the velocity; it must
// follow, because the velocities at an event are found from it.
static void verlet_kick(const struct fish *fish, double h, double *y) {
    const struct layout *const at = &fish->at;
    for (int k = 0; k < 2 * fish->n_nodes; k++) {
        y[at->vx + k] += h / 2 * y[at->ax + k];
        y[at->second + k] = y[at->vx + k];
    }
}

static enum status verlet_step(void *data, double t, double *reached) {
    struct verlet *const solver = data;
    struct residual *const residual = solver->residual;
    struct state *const state = solver->state;
    const struct school *school = residual->school;
    double *const y = state->y, *const value = residual->scratch;
    TRY(status_ask(solver->stop));
    const double h = solver->steps.h, now = steps_next(&solver->steps, t);

    // half a kick, and the drift
    for (int f = 0; f < school->n_fish; f++) {
        const struct layout *const at = &school->fish[f].at;
        verlet_kick(&school->fish[f], h, y);
        for (int k = 0; k < 2 * school->fish[f].n_nodes; k++) y[at->x + k] += h * y[at->vx + k];
    }
    enum status status = contact_find(residual->contact, state, now, y);
    if (status > 0) return verlet_unstable(solver, now);
    TRY(status);

    // The accelerations, and the other half of the kick. Without acceleration the balance is minus the forces.
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *const fish = &school->fish[f];
        const struct layout *const at = &fish->at;
        residual_actuate(residual, f, now, y);
        memset(y + at->ax, 0, 2 * (size_t)fish->n_nodes * sizeof *y);
        residual_balance(residual, f, y, value);
        for (int k = 0; k < 2 * fish->n_nodes; k++) {
            y[at->ax + k] = -value[at->ax + k] / fish->mass[k % fish->n_nodes];
        }
        verlet_kick(fish, h, y);
    }
    solver->counts.steps++;
    solver->counts.steps_of_order[solver->counts.order - 1]++;
    solver->counts.residual_evaluations++;

    // at the event, also find the sheets and the rates of the differential unknowns
    status = solver->steps.i == solver->steps.n ? ode_rhs_rates(solver->rhs, t, y, state->yp) : STATUS_OK;
    if (status > 0) return verlet_unstable(solver, t);
    TRY(status);
    *reached = now;
    return STATUS_OK;
}

const struct integrator one_step_verlet = {
    .create = verlet_create, .begin = verlet_begin, .step = verlet_step, .count = verlet_count};
