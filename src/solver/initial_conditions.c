/* initial_conditions.c: KINSOL's Newton method for the algebraic equations. The equation of a differential unknown
 * becomes "no change", so that the Jacobian of the school serves here too, with the rows of differential unknowns
 * masked. */
#include "solver/initial_conditions.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "flow/flow_at_bodies.h"
#include "school/residual.h"
#include "school/residual_jacobian.h"
#include "solver/integrator.h"
#include "solver/linear.h"
#include "solver/sundials.h"

/* Newton's method has converged when the norm of the scaled residual is below this, or when steps no longer change the
 * unknowns. */
static const double tolerance = 1e-14;

/* With many close bodies, rounding in the long sums of a row can keep the norm above the tolerance while the steps no
 * longer change: after the last iteration this norm is accepted. */
static const double rounded = 1e-12;

/* With momenta, an acceleration appears only in its own linear equation, and velocities are algebraic. Their rounding
 * errors, multiplied by stiff forces, must not prevent convergence, so the scale of accelerations is larger by this
 * factor. */
static const double loose = 1e6;

/* So small that each step of Newton's method gains as many digits as with an exact solution. */
static const struct linear_tolerance linear_tolerance = {.relative = 1e-10};

struct initial_conditions {
    struct residual *residual;
    struct jacobian *jacobian;
    int n;
    const struct residual_mode *mode;
    double t;
    /* unknowns, rates of zero, kinds, scales of the unknowns and of the equations in their rows, and their inverses
     * (n) */
    double *y, *zero, *kind, *scale, *inverse_scale;
    bool has_kinds;      /* the kinds are those of a mode */
    double *value;       /* residual of the last evaluation                                             (n) */
    double *start;       /* initial guess and solution of KINSOL                                        (n) */
    enum status failure; /* of the last callback */

    struct sundials_context context;
    N_Vector solution, inverse_scales;
    struct linear_sundials linear;
    void *kinsol;
    long iterations;
};

// copy only the algebraic unknowns, so that the differential ones keep their bits
static void take_algebraic(const struct initial_conditions *c, const double *from, double *y) {
    for (int i = 0; i < c->n; i++) {
        if (c->kind[i] <= 0) y[i] = from[i];
    }
}

static int algebraic_value(N_Vector solution, N_Vector value, void *data) {
    struct initial_conditions *const c = data;
    double *const to = N_VGetArrayPointer(value);
    take_algebraic(c, N_VGetArrayPointer(solution), c->y);
    c->failure = status_ask(c->residual->stop);
    if (c->failure == STATUS_OK) c->failure = residual_evaluate(c->residual, c->mode, c->t, c->y, c->zero, c->value);
    for (int i = 0; i < c->n; i++) to[i] = c->kind[i] > 0 ? 0 : c->value[i];
    return c->failure;
}

static int algebraic_jacobian(N_Vector solution, N_Vector value, SUNMatrix matrix, void *data, N_Vector scratch1,
                              N_Vector scratch2) {
    (void)value, (void)matrix, (void)scratch1, (void)scratch2;
    struct initial_conditions *const c = data;
    take_algebraic(c, N_VGetArrayPointer(solution), c->y);
    c->failure = residual_jacobian(c->residual, c->mode, c->t, 0, c->y, c->jacobian);
    return c->failure;
}

enum status initial_conditions_create(struct arena *arena, struct initial_conditions **solver,
                                      struct residual *residual) {
    const int n = residual->school->n_unknowns;
    struct initial_conditions *c;
    NEW(arena, c, 1);
    c->residual = residual;
    c->n = n;
    double **const arrays[] = {&c->y, &c->zero, &c->kind, &c->scale, &c->value, &c->inverse_scale, &c->start};
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++) NEW(arena, *arrays[i], n);
    for (int i = 0; i < n; i++) {
        // with momenta no other equation depends on the acceleration of a node
        const struct unknown_place place = residual_place(residual->school, i);
        const struct layout *const at = &residual->school->fish[place.fish].at;
        const bool is_acceleration = place.kind == UNKNOWN_AX || place.kind == UNKNOWN_AY;
        const bool is_loose = is_acceleration && at->second > at->vx;
        c->scale[i] = residual_scale(residual->school, i);
        c->inverse_scale[i] = 1 / ((is_loose ? loose : 1) * c->scale[i]);
    }

    c->jacobian = jacobian_create(arena, residual->school);
    sundials_context_create(&c->context, arena, n, 1, &c->failure);
    c->solution = sundials_context_vector(&c->context, c->start);
    c->inverse_scales = sundials_context_vector(&c->context, c->inverse_scale);
    c->linear = linear_sundials_create(&c->context, c->jacobian, c->scale, linear_tolerance);
    sundials_context_reserve(&c->context, 12);  // KINSOL clones 5
    c->kinsol = sundials_own(c->context.arena, sundials_release_kinsol, KINCreate(c->context.context));
    // full Newton steps, because the equations are nearly linear, and a new Jacobian for each
    if (KINSetErrHandlerFn(c->kinsol, sundials_context_message, &c->failure) || KINSetUserData(c->kinsol, c) ||
        KINInit(c->kinsol, algebraic_value, c->solution) ||
        KINSetLinearSolver(c->kinsol, c->linear.solver, c->linear.matrix) ||
        KINSetJacFn(c->kinsol, algebraic_jacobian) || KINSetMaxSetupCalls(c->kinsol, 1) ||
        KINSetFuncNormTol(c->kinsol, tolerance) || KINSetScaledStepTol(c->kinsol, 1e-14) ||
        KINSetNumMaxIters(c->kinsol, 50) || KINSetMaxNewtonStep(c->kinsol, 1e30)) {
        return sundials_context_failed(&c->context, "KINSOL");
    }
    *solver = c;
    return STATUS_OK;
}

// the largest scaled residual of the last evaluation, and the row where it is
static double largest_residual(const struct initial_conditions *c, int *worst) {
    double max = -1;
    for (int i = 0; i < c->n; i++) {
        const double size = c->kind[i] > 0 ? 0 : fabs(c->value[i] * c->inverse_scale[i]);
        if (!(size <= max)) {
            max = size;
            *worst = i;
        }
    }
    return max;
}

// fail with a message that names the equation with the largest residual
static enum status initial_failed(struct initial_conditions *c, int code) {
    int worst = 0;
    const double max = largest_residual(c, &worst);
    const struct unknown_place place = residual_place(c->residual->school, worst);
    const char *reason = "KINSOL failed";
    switch (code) {
        case KIN_MAXITER_REACHED: reason = "Newton's method did not converge"; break;
        case KIN_FIRST_SYSFUNC_ERR:
        case KIN_REPTD_SYSFUNC_ERR: reason = "the equations have no finite value"; break;
        case KIN_LSETUP_FAIL: reason = "the Jacobian is singular"; break;
    }
    char cause[512];
    snprintf(cause, sizeof cause, "%s", status_message());
    const char *const name = c->residual->school->fish[place.fish].name;
    char largest[256] = "";
    // omit a residual that has not been computed
    if (isfinite(max) && max > 0) {
        snprintf(largest, sizeof largest, "; largest residual: %s[%d] of fish %.60s, %.3g of its scale", place.name,
                 place.index, name, max);
    }
    return status_fail(
        STATUS_SOLVER,
        "no consistent initial conditions at t = %.10g s: %s: check the units of sizes, speeds and positions%s (%s)",
        c->t, reason, largest, cause);
}

enum status initial_conditions_solve(struct initial_conditions *c, const struct residual_mode *mode, double t,
                                     double *y, double *yp) {
    c->mode = mode;
    c->t = t;
    memcpy(c->y, y, (size_t)c->n * sizeof *y);
    memcpy(c->start, y, (size_t)c->n * sizeof *y);

    // Another mode may have other differential unknowns than the last solution had: mask their rows.
    const struct school *const school = c->residual->school;
    residual_kinds(c->residual, c->mode, c->value);
    if (!c->has_kinds || memcmp(c->value, c->kind, (size_t)c->n * sizeof *c->kind) != 0) {
        c->has_kinds = true;
        memcpy(c->kind, c->value, (size_t)c->n * sizeof *c->kind);
        residual_mask(c->residual, c->jacobian);
        for (int f = 0; f < school->n_fish; f++) {
            const struct layout *at = &school->fish[f].at;
            for (int i = at->x; i < at->end; i++) {
                if (c->kind[i] > 0) sparse_mask(c->jacobian->own[f], i, 1);
            }
        }
    }

    c->failure = STATUS_OK;
    const int code = KINSol(c->kinsol, c->solution, KIN_NONE, c->inverse_scales, c->inverse_scales);
    long iterations = 0;
    KINGetNumNonlinSolvIters(c->kinsol, &iterations);
    c->iterations += iterations;
    if (c->failure == STATUS_STOPPED || c->failure == STATUS_MEMORY) return c->failure;
    int worst;
    const bool is_rounded = code == KIN_MAXITER_REACHED && largest_residual(c, &worst) <= rounded;
    if (code < 0 && !is_rounded) return initial_failed(c, code);
    // rates and diagnostics need the velocity of the fluid at the solution
    take_algebraic(c, c->start, c->y);
    c->failure = residual_evaluate(c->residual, c->mode, t, c->y, c->zero, c->value);
    if (c->failure != STATUS_OK) return initial_failed(c, code);
    memcpy(y, c->y, (size_t)c->n * sizeof *y);

    // the rates of the differential unknowns
    for (int f = 0; f < school->n_fish; f++) {
        const struct layout *at = &school->fish[f].at;
        for (int i = at->x; i < at->vx; i++) yp[i] = y[i + (at->vx - at->x)];
        for (int i = at->second; i < at->ax; i++) yp[i] = y[i + (at->ax - at->second)];
        if (c->kind[at->circulation] > 0) yp[at->circulation] = residual_shed_rate(c->residual, c->mode, f, y);
    }
    return STATUS_OK;
}

long initial_conditions_iterations(const struct initial_conditions *solver) {
    return solver->iterations;
}
