/* verlet.c: kick, drift, kick. */
#include "solver/verlet.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "school/diagnostics_energy.h"
#include "solver/ode_rhs.h"

struct verlet {
    struct residual *residual;
    struct state *state;
    struct integrator_options options;
    struct ode_rhs *rhs;
    double *circulation; /* that each fish has shed at the start of an interval            (n_fish) */
    struct integrator_counts counts;
};

static void verlet_free(void *data) {
    struct verlet *const solver = data;
    if (!solver) return;
    ode_rhs_free(solver->rhs);
    free(solver->circulation);
    free(solver);
}

static enum status verlet_create(void **solver, struct residual *residual, struct state *state,
                                 const struct integrator_options *options) {
    *solver = NULL;
    struct verlet *const new = calloc(1, sizeof *new);
    if (!new) goto no_memory;
    new->residual = residual;
    new->state = state;
    new->options = *options;
    new->counts = options->before;
    new->counts.step_size = options->step;
    new->counts.order = methods_table[options->method].order;
    new->circulation = calloc((size_t)residual->school->n_fish, sizeof *new->circulation);
    if (!new->circulation) goto no_memory;
    const enum status status = ode_rhs_create(&new->rhs, residual);
    if (status != STATUS_OK) {
        verlet_free(new);
        return status;
    }
    *solver = new;
    return STATUS_OK;

no_memory:
    verlet_free(new);
    return status_fail(STATUS_MEMORY, "out of memory: the solver of rods");
}

static void verlet_count(const void *data, struct integrator_counts *counts) {
    *counts = ((const struct verlet *)data)->counts;
}

// a one-step method has no history
static enum status verlet_restart(void *data) {
    (void)data;
    return STATUS_OK;
}

static enum status unstable(const struct verlet *solver, double t) {
    return status_fail(
        STATUS_SOLVER,
        "unstable at t = %.10g s: with steps of %.3g s the body is too stiff for an explicit method: choose "
        "solver.method: ida, or a smaller solver.step",
        t, solver->options.step);
}

// the accelerations of fish f where its nodes are in the state, time t
static void accelerate(struct verlet *solver, int f, double t) {
    const struct fish *fish = &solver->residual->school->fish[f];
    double *const y = solver->state->y, *const value = solver->residual->scratch;
    residual_muscle(solver->residual, f, t, y);
    // without acceleration the balance is minus the forces
    memset(y + fish->at.ax, 0, 2 * (size_t)fish->n_nodes * sizeof *y);
    residual_balance(solver->residual, f, y, value);
    for (int k = 0; k < fish->n_nodes; k++) {
        y[fish->at.ax + k] = -value[fish->at.ax + k] / fish->mass[k];
        y[fish->at.ay + k] = -value[fish->at.ay + k] / fish->mass[k];
    }
}

// to[i] += h rate[i] for x and y of all nodes
static void move(const struct fish *fish, double h, const double *rate, double *to) {
    for (int i = 0; i < 2 * fish->n_nodes; i++) to[i] += h * rate[i];
}

/* One step of h to time t. */
static enum status step(struct verlet *solver, double t, double h) {
    const struct school *school = solver->residual->school;
    double *const y = solver->state->y;
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *fish = &school->fish[f];
        move(fish, h / 2, y + fish->at.ax, y + fish->at.vx);
        move(fish, h, y + fish->at.vx, y + fish->at.x);
    }
    const enum status status = residual_contact(solver->residual, t, y);
    if (status > 0) return unstable(solver, t);
    TRY(status);
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *fish = &school->fish[f];
        accelerate(solver, f, t);
        move(fish, h / 2, y + fish->at.ax, y + fish->at.vx);
    }
    solver->counts.steps++;
    solver->counts.residual_evaluations++;
    return STATUS_OK;
}

// the sheets, and the rates of all unknowns; that of the circulation shed is a difference over the interval
static enum status close_interval(struct verlet *solver, double t) {
    struct state *const state = solver->state;
    const struct school *school = solver->residual->school;
    const enum status status = ode_rhs_rates(solver->rhs, t, state->y, state->yp);
    if (status > 0) return unstable(solver, t);
    TRY(status);
    for (int f = 0; f < school->n_fish; f++) {
        const int shed = school->fish[f].at.circulation;
        state->yp[shed] = (state->y[shed] - solver->circulation[f]) / school->interval;
    }
    return STATUS_OK;
}

static enum status verlet_advance(void *data, double t, const volatile sig_atomic_t *stop) {
    struct verlet *const solver = data;
    struct state *const state = solver->state;
    const struct school *school = solver->residual->school;
    const double start = state->t;
    const long n = lround(school->interval / solver->options.step);
    const double h = school->interval / (double)n;
    if (n > solver->options.max_steps) {
        return status_fail(STATUS_SOLVER,
                           "integration failed at t = %.10g s: %ld steps between two events are more than "
                           "solver.max_steps: raise it, or solver.step",
                           start, n);
    }
    for (int f = 0; f < school->n_fish; f++) solver->circulation[f] = state->y[school->fish[f].at.circulation];
    for (long i = 1; i <= n; i++) {
        TRY(integrator_ask(stop));
        const double now = i < n ? start + (double)i * h : t;
        TRY(step(solver, now, h));
        if (i == n) TRY(close_interval(solver, t));
        diagnostics_step(solver->residual, state, now, state->y);
    }
    return STATUS_OK;
}

const struct integrator verlet_integrator = {.create = verlet_create,
                                             .advance = verlet_advance,
                                             .restart = verlet_restart,
                                             .count = verlet_count,
                                             .free = verlet_free};
