/* newton.c: KINSOL with a dense matrix. */
#include "solver/newton.h"

#include <stdio.h>
#include <stdlib.h>

#include "solver/sundials.h"
#include "solver/sundials_context.h"

struct solver {
    const struct newton *problem;
    enum status failure; /* of the last callback */
    struct sundials_context context;
    N_Vector unknowns, scales;
    SUNMatrix matrix;
    SUNLinearSolver linear;
    void *kinsol;
};

// a failure of a callback is final: a smaller step would cost as much as all that went before
static int value_of(N_Vector u, N_Vector value, void *data) {
    struct solver *const solver = data;
    solver->failure = solver->problem->value(solver->problem->data, N_VGetArrayPointer(u), N_VGetArrayPointer(value));
    return solver->failure == STATUS_OK ? 0 : -1;
}

static int jacobian_of(N_Vector u, N_Vector value, SUNMatrix matrix, void *data, N_Vector scratch1, N_Vector scratch2) {
    (void)u, (void)value, (void)scratch1, (void)scratch2;
    struct solver *const solver = data;
    solver->failure = solver->problem->jacobian(solver->problem->data, SUNDenseMatrix_Data(matrix));
    return solver->failure == STATUS_OK ? 0 : -1;
}

static void release(struct solver *solver) {
    if (solver->kinsol) KINFree(&solver->kinsol);
    if (solver->linear) SUNLinSolFree(solver->linear);
    if (solver->matrix) SUNMatDestroy(solver->matrix);
    if (solver->unknowns) N_VDestroy(solver->unknowns);
    if (solver->scales) N_VDestroy(solver->scales);
    sundials_context_free(&solver->context);
}

static enum status set_up(struct solver *solver, double *u, double *inverse) {
    const struct newton *const problem = solver->problem;
    for (int i = 0; i < problem->n; i++) inverse[i] = 1 / problem->scale[i];
    TRY(sundials_context_create(&solver->context, problem->n, 1, &solver->failure));
    TRY(sundials_context_vector(&solver->context, &solver->unknowns, u));
    TRY(sundials_context_vector(&solver->context, &solver->scales, inverse));
    solver->matrix = SUNDenseMatrix(problem->n, problem->n, solver->context.context);
    solver->linear = solver->matrix ? SUNLinSol_Dense(solver->unknowns, solver->matrix, solver->context.context) : NULL;
    solver->kinsol = KINCreate(solver->context.context);
    if (!solver->linear || !solver->kinsol) return status_fail(STATUS_MEMORY, "out of memory: KINSOL");
    // steps of rounding do not end the iteration
    if (KINSetErrHandlerFn(solver->kinsol, sundials_context_message, &solver->failure) ||
        KINSetUserData(solver->kinsol, solver) || KINInit(solver->kinsol, value_of, solver->unknowns) ||
        KINSetLinearSolver(solver->kinsol, solver->linear, solver->matrix) ||
        KINSetJacFn(solver->kinsol, jacobian_of) || KINSetMaxSetupCalls(solver->kinsol, problem->reuse) ||
        KINSetFuncNormTol(solver->kinsol, problem->tolerance) || KINSetScaledStepTol(solver->kinsol, 1e-14) ||
        KINSetNumMaxIters(solver->kinsol, problem->max_iterations) ||
        KINSetMaxNewtonStep(solver->kinsol, problem->max_step)) {
        TRY(sundials_context_check(&solver->context));
        return status_fail(STATUS_SOLVER, "KINSOL cannot be set up: %s", status_message());
    }
    return sundials_context_check(&solver->context);
}

static const char *reason(int code) {
    switch (code) {
        case KIN_MXNEWT_5X_EXCEEDED:
        case KIN_MAXITER_REACHED: return "Newton's method did not converge";
        case KIN_LSETUP_FAIL:
        case KIN_LSOLVE_FAIL: return "the Jacobian is singular";
        default: return "KINSOL failed";
    }
}

static enum status solve(struct solver *solver) {
    int code = KIN_MXNEWT_5X_EXCEEDED;
    long n_iterations = 0, n = 0;
    // five longest steps in a row are no reason to stop
    while (code == KIN_MXNEWT_5X_EXCEEDED && n_iterations < solver->problem->max_iterations) {
        code = KINSol(solver->kinsol, solver->unknowns, KIN_NONE, solver->scales, solver->scales);
        KINGetNumNonlinSolvIters(solver->kinsol, &n);
        n_iterations += n;
    }
    if (solver->failure != STATUS_OK) return solver->failure;
    if (code >= 0) return STATUS_OK;
    char cause[512];
    snprintf(cause, sizeof cause, "%s", status_message());
    return status_fail(STATUS_SOLVER, "%s (%s)", reason(code), cause);
}

enum status newton_solve(const struct newton *problem, double *u) {
    struct solver solver = {.problem = problem};
    double *const inverse = calloc((size_t)problem->n, sizeof *inverse);
    enum status status = inverse ? STATUS_OK : status_fail(STATUS_MEMORY, "out of memory: Newton's method");
    if (status == STATUS_OK) status = set_up(&solver, u, inverse);
    if (status == STATUS_OK) status = solve(&solver);
    release(&solver);
    free(inverse);
    return status;
}
