/* initial_conditions.c: KINSOL's Newton method on the algebraic equations. The differential unknowns take part with the
 * equation that they do not change, so that the Jacobian of the school can be used with their rows masked. */
#include "solver/initial_conditions.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "flow/flow_at_bodies.h"
#include "school/residual_jacobian.h"
#include "solver/integrator.h"
#include "solver/sundials.h"
#include "solver/sundials_context.h"
#include "solver/sundials_linear.h"

/* Rows are scaled to order one; Newton's method has converged at this norm, or when its steps no longer change the
 * unknowns. */
static const double tolerance = 1e-14;

/* Where many bodies are near each other, rounding in the sums of a row can keep the norm above that, and the steps as
 * long as before: after all iterations a solution is good enough at this norm. */
static const double rounded = 1e-12;

/* With momenta nothing depends on accelerations, which follow from an equation that is linear in them, and velocities
 * are solved for: the rounding of what they do to stiff forces must not keep the iteration from ending. Factor on the
 * scale. */
static const double loose = 1e6;

/* Tight, so that no step of Newton's method gains fewer digits than with an exact solution. */
static const struct linear_tolerance linear_tolerance = {.relative = 1e-10};

struct initial_conditions {
    struct residual *residual;
    struct jacobian *jacobian;
    int n;
    double t;
    /* unknowns, rates of zero, kinds, scales of the unknowns, inverse scales of unknowns and of equations      (n) */
    double *y, *zero, *kind, *scale, *solution_scale, *value_scale;
    double *value;       /* residual of the last evaluation                                             (n) */
    double *start;       /* initial guess and solution of KINSOL                                        (n) */
    enum status failure; /* of the last callback */
    const volatile sig_atomic_t *stop;

    struct sundials_context context;
    N_Vector solution, solution_scales, value_scales;
    struct sundials_linear linear;
    void *kinsol;
    long iterations;
};

void initial_conditions_free(struct initial_conditions *c) {
    if (!c) return;
    if (c->kinsol) KINFree(&c->kinsol);
    sundials_linear_free(&c->linear);
    const N_Vector vectors[] = {c->solution, c->solution_scales, c->value_scales};
    for (size_t i = 0; i < sizeof vectors / sizeof *vectors; i++) {
        if (vectors[i]) N_VDestroy(vectors[i]);
    }
    jacobian_free(c->jacobian);
    double *const owned[] = {c->y, c->zero, c->kind, c->scale, c->solution_scale, c->value_scale, c->value, c->start};
    for (size_t i = 0; i < sizeof owned / sizeof *owned; i++) free(owned[i]);
    sundials_context_free(&c->context);
    free(c);
}

// the differential unknowns keep their bits, whatever KINSOL adds to them
static void take_algebraic(const struct initial_conditions *c, const double *from, double *y) {
    for (int i = 0; i < c->n; i++) {
        if (c->kind[i] <= 0) y[i] = from[i];
    }
}

// the residual of the algebraic equations
static int algebraic_value(N_Vector solution, N_Vector value, void *data) {
    struct initial_conditions *const c = data;
    double *const to = N_VGetArrayPointer(value);
    take_algebraic(c, N_VGetArrayPointer(solution), c->y);
    c->failure = integrator_ask(c->stop);
    if (c->failure == STATUS_OK) c->failure = residual_evaluate(c->residual, c->t, c->y, c->zero, c->value);
    for (int i = 0; i < c->n; i++) to[i] = c->kind[i] > 0 ? 0 : c->value[i];
    return c->failure;
}

static int algebraic_jacobian(N_Vector solution, N_Vector value, SUNMatrix matrix, void *data, N_Vector scratch1,
                              N_Vector scratch2) {
    (void)value, (void)matrix, (void)scratch1, (void)scratch2;
    struct initial_conditions *const c = data;
    take_algebraic(c, N_VGetArrayPointer(solution), c->y);
    c->failure = residual_jacobian(c->residual, c->t, 0, c->y, c->jacobian);
    return c->failure;
}

// whether an unknown is an acceleration on which nothing depends
static int is_loose(const struct residual *residual, int i) {
    const struct unknown_place place = residual_place(residual->school, i);
    const int is_acceleration = place.kind == UNKNOWN_AX || place.kind == UNKNOWN_AY;
    return is_acceleration && fish_has_momentum(&residual->school->fish[place.fish]);
}

// equations are accelerations, velocities, circulations and numbers: most have the scale of the unknown of their row
static double row_scale(const struct residual *residual, int i) {
    const struct unknown_place place = residual_place(residual->school, i);
    const struct layout *at = &residual->school->fish[place.fish].at;
    const double speed = residual_scale(residual->school, at->gamma);
    if (place.kind == UNKNOWN_GAMMA) return speed;
    // the relation of p and v has the size of p, in whichever row it stands
    const int is_velocity = place.kind == UNKNOWN_VX || place.kind == UNKNOWN_VY;
    return residual_scale(residual->school, is_velocity && at->px < at->ax ? i + (at->px - at->vx) : i);
}

static enum status set_up_kinsol(struct initial_conditions *c) {
    c->kinsol = KINCreate(c->context.context);
    if (!c->kinsol) return status_fail(STATUS_MEMORY, "out of memory: KINSOL");
    // full Newton steps, since the equations are nearly linear, with a new Jacobian each
    if (KINSetErrHandlerFn(c->kinsol, sundials_context_message, &c->failure) || KINSetUserData(c->kinsol, c) ||
        KINInit(c->kinsol, algebraic_value, c->solution) ||
        KINSetLinearSolver(c->kinsol, c->linear.solver, c->linear.matrix) ||
        KINSetJacFn(c->kinsol, algebraic_jacobian) || KINSetMaxSetupCalls(c->kinsol, 1) ||
        KINSetFuncNormTol(c->kinsol, tolerance) || KINSetScaledStepTol(c->kinsol, 1e-14) ||
        KINSetNumMaxIters(c->kinsol, 50) || KINSetMaxNewtonStep(c->kinsol, 1e30)) {
        TRY(sundials_context_check(&c->context));
        return status_fail(STATUS_SOLVER, "KINSOL cannot be set up: %s", status_message());
    }
    return sundials_context_check(&c->context);
}

static enum status fill(struct initial_conditions *c) {
    const int n = c->n;
    double **const arrays[] = {&c->y,     &c->zero,           &c->kind,        &c->scale,
                               &c->value, &c->solution_scale, &c->value_scale, &c->start};
    TRY(MEMORY_ARRAYS(arrays, n, "initial conditions"));
    for (int i = 0; i < n; i++) {
        c->scale[i] = residual_scale(c->residual->school, i);
        const double factor = is_loose(c->residual, i) ? loose : 1;
        c->solution_scale[i] = 1 / (factor * c->scale[i]);
        c->value_scale[i] = 1 / (factor * row_scale(c->residual, i));
        c->kind[i] = -1;  // unknown
    }
    TRY(jacobian_create(&c->jacobian, c->residual->school));
    TRY(sundials_context_create(&c->context, n, 1, &c->failure));
    TRY(sundials_context_vector(&c->context, &c->solution, c->start));
    TRY(sundials_context_vector(&c->context, &c->solution_scales, c->solution_scale));
    TRY(sundials_context_vector(&c->context, &c->value_scales, c->value_scale));
    TRY(sundials_linear_create(&c->linear, c->context.context, c->jacobian, c->scale, linear_tolerance, &c->failure));
    return set_up_kinsol(c);
}

enum status initial_conditions_create(struct initial_conditions **solver, struct residual *residual) {
    *solver = NULL;
    struct initial_conditions *new;
    TRY(MEMORY_NEW(new, 1, "the initial conditions"));
    new->residual = residual;
    new->n = residual->school->n_unknowns;
    const enum status status = fill(new);
    if (status != STATUS_OK) {
        initial_conditions_free(new);
        return status;
    }
    *solver = new;
    return STATUS_OK;
}

// kinds of unknowns may have changed since the last solution: mask the rows of the differential ones
static void update_kinds(struct initial_conditions *c) {
    double *const kind = c->value;
    residual_kinds(c->residual, kind);
    if (memcmp(kind, c->kind, (size_t)c->n * sizeof *kind) == 0) return;
    memcpy(c->kind, kind, (size_t)c->n * sizeof *kind);
    residual_mask(c->residual, c->jacobian);
    for (int f = 0; f < c->residual->school->n_fish; f++) {
        const struct layout *at = &c->residual->school->fish[f].at;
        for (int i = at->x; i < at->end; i++) {
            if (c->kind[i] > 0) sparse_mask(c->jacobian->own[f], i, 1);
        }
    }
}

static const char *reason(int code) {
    switch (code) {
        case KIN_MAXITER_REACHED: return "Newton's method did not converge";
        case KIN_FIRST_SYSFUNC_ERR:
        case KIN_REPTD_SYSFUNC_ERR: return "the equations have no finite value";
        case KIN_LSETUP_FAIL: return "the Jacobian is singular";
        default: return "KINSOL failed";
    }
}

// the largest residual of the last evaluation over its scale, and the row that has it
static double largest_residual(const struct initial_conditions *c, int *worst) {
    double max = -1;
    for (int i = 0; i < c->n; i++) {
        const double size = c->kind[i] > 0 ? 0 : fabs(c->value[i] * c->value_scale[i]);
        if (!(size <= max)) {
            max = size;
            *worst = i;
        }
    }
    return max;
}

// a message that names the equation with the largest residual
static enum status failed(struct initial_conditions *c, int code) {
    int worst = 0;
    const double max = largest_residual(c, &worst);
    const struct unknown_place place = residual_place(c->residual->school, worst);
    char cause[512];
    snprintf(cause, sizeof cause, "%s", status_message());
    const char *const name = c->residual->school->fish[place.fish].name;
    char largest[256] = "";
    // a residual that has not been computed is not told
    if (isfinite(max) && max > 0)
        snprintf(largest, sizeof largest, "; the largest residual is that of %s[%d] of fish %.60s, %.3g of its scale",
                 place.name, place.index, name, max);
    return status_fail(
        STATUS_SOLVER,
        "no consistent initial conditions at t = %.10g s: %s: see whether sizes, speeds and positions have "
        "the units that the keys say%s (%s)",
        c->t, reason(code), largest, cause);
}

// rates of the differential unknowns; those of the algebraic ones keep their values
static void set_rates(const struct initial_conditions *c, double t, const double *y, double *yp) {
    const struct school *school = c->residual->school;
    for (int f = 0; f < school->n_fish; f++) {
        const struct layout *at = &school->fish[f].at;
        for (int i = at->x; i < at->vx; i++) yp[i] = y[i + (at->vx - at->x)];
        const int second = fish_has_momentum(&school->fish[f]) ? at->px : at->vx;
        for (int i = second; i < at->ax; i++) yp[i] = y[i + (at->ax - second)];
        if (c->kind[at->circulation] > 0) yp[at->circulation] = residual_shed_rate(c->residual, f, t, y);
    }
}

void initial_conditions_listen(struct initial_conditions *c, const volatile sig_atomic_t *stop) {
    c->stop = stop;
}

enum status initial_conditions_solve(struct initial_conditions *c, double t, double *y, double *yp) {
    c->t = t;
    memcpy(c->y, y, (size_t)c->n * sizeof *y);
    memcpy(c->start, y, (size_t)c->n * sizeof *y);
    flow_sum_exactly(c->residual->flow);
    update_kinds(c);
    c->failure = STATUS_OK;
    const int code = KINSol(c->kinsol, c->solution, KIN_NONE, c->solution_scales, c->value_scales);
    long iterations = 0;
    KINGetNumNonlinSolvIters(c->kinsol, &iterations);
    c->iterations += iterations;
    if (c->failure == STATUS_MEMORY || c->failure == STATUS_STOPPED) return c->failure;
    int worst;
    const int is_rounded = code == KIN_MAXITER_REACHED && largest_residual(c, &worst) <= rounded;
    if (code < 0 && !is_rounded) return failed(c, code);
    // the fluid's velocity at the solution is needed for the rates, and for the diagnostics
    take_algebraic(c, c->start, c->y);
    c->failure = residual_evaluate(c->residual, t, c->y, c->zero, c->value);
    if (c->failure == STATUS_MEMORY) return STATUS_MEMORY;
    if (c->failure != STATUS_OK) return failed(c, code);
    memcpy(y, c->y, (size_t)c->n * sizeof *y);
    set_rates(c, t, y, yp);
    return STATUS_OK;
}

long initial_conditions_iterations(const struct initial_conditions *solver) {
    return solver->iterations;
}
