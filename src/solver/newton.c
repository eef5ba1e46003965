/* newton.c: KINSOL with a dense matrix, and least squares by LAPACK. */
#include "solver/newton.h"

#include <lapacke.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "solver/sundials.h"

struct solver {
    const struct newton *problem;
    enum status failure; /* of the last callback */
    struct sundials_context context;
};

// a failed callback ends the solution: evaluations are too expensive to try smaller steps
static int newton_value_of(N_Vector u, N_Vector value, void *data) {
    struct solver *const solver = data;
    solver->failure = solver->problem->value(solver->problem->data, N_VGetArrayPointer(u), N_VGetArrayPointer(value));
    return solver->failure == STATUS_OK ? 0 : -1;
}

static int newton_jacobian_of(N_Vector u, N_Vector value, SUNMatrix matrix, void *data, N_Vector scratch1,
                              N_Vector scratch2) {
    (void)u, (void)value, (void)scratch1, (void)scratch2;
    struct solver *const solver = data;
    solver->failure = solver->problem->jacobian(solver->problem->data, SUNDenseMatrix_Data(matrix));
    return solver->failure == STATUS_OK ? 0 : -1;
}

enum status newton_solve(struct arena *arena, const struct newton *problem, double *u) {
    ARENA(scratch, arena, "Newton's method");
    struct solver *solver;
    double *inverse;
    NEW(scratch, solver, 1);
    NEW(scratch, inverse, problem->n);
    for (int i = 0; i < problem->n; i++) inverse[i] = 1 / problem->scale[i];
    solver->problem = problem;
    struct sundials_context *const context = &solver->context;
    sundials_context_create(context, scratch, problem->n, 1, &solver->failure);
    const N_Vector unknowns = sundials_context_vector(context, u), scales = sundials_context_vector(context, inverse);
    const SUNMatrix matrix =
        sundials_context_own(context, OWNED_MATRIX, SUNDenseMatrix(problem->n, problem->n, context->context));
    const SUNLinearSolver linear =
        sundials_context_own(context, OWNED_LINEAR, SUNLinSol_Dense(unknowns, matrix, context->context));
    sundials_context_reserve(context, 12);  // KINSOL clones 5
    void *const kinsol = sundials_context_own(context, OWNED_KINSOL, KINCreate(context->context));

    // the step tolerance is so small that short steps do not end the iteration
    if (KINSetErrHandlerFn(kinsol, sundials_context_message, &solver->failure) || KINSetUserData(kinsol, solver) ||
        KINInit(kinsol, newton_value_of, unknowns) || KINSetLinearSolver(kinsol, linear, matrix) ||
        KINSetJacFn(kinsol, newton_jacobian_of) || KINSetMaxSetupCalls(kinsol, problem->reuse) ||
        KINSetFuncNormTol(kinsol, problem->tolerance) || KINSetScaledStepTol(kinsol, 1e-14) ||
        KINSetNumMaxIters(kinsol, problem->max_iterations) || KINSetMaxNewtonStep(kinsol, problem->max_step)) {
        return status_fail(STATUS_SOLVER, "KINSOL cannot be set up: %s", status_message());
    }

    // five steps of the largest allowed size in a row are no reason to stop
    int code = KIN_MXNEWT_5X_EXCEEDED;
    long n_iterations = 0, n = 0;
    while (code == KIN_MXNEWT_5X_EXCEEDED && n_iterations < problem->max_iterations) {
        code = KINSol(kinsol, unknowns, KIN_NONE, scales, scales);
        KINGetNumNonlinSolvIters(kinsol, &n);
        n_iterations += n;
    }
    TRY(solver->failure);
    if (code >= 0) return STATUS_OK;

    char cause[512];
    snprintf(cause, sizeof cause, "%s", status_message());
    const bool is_slow = code == KIN_MXNEWT_5X_EXCEEDED || code == KIN_MAXITER_REACHED;
    const bool is_singular = code == KIN_LSETUP_FAIL || code == KIN_LSOLVE_FAIL;
    return status_fail(STATUS_SOLVER, "%s (%s)",
                       is_slow       ? "Newton's method did not converge"
                       : is_singular ? "the Jacobian is singular"
                                     : "KINSOL failed",
                       cause);
}

// ---- least squares and eigenvalues of LAPACK

/* Directions in which the columns are below this fraction of the largest column count as decayed: what is left there is
 * the error of the integration. */
static const double least_singular = 0.03;

/* Eigenvalues of decayed directions are below this limit. */
static const double dead_multiplier = 1e-10;

enum status newton_multipliers(struct arena *arena, int n, int n_columns, const double *before, const double *after,
                               const double *change, double *real, double *imaginary, double *way) {
    ARENA(scratch, arena, "multipliers");
    static const char not_apart[] = "the multipliers cannot be told apart";
    const int m = n_columns;
    double *matrix, *images;
    lapack_int *pivot, rank = 0;
    NEW(scratch, matrix, (size_t)n * (size_t)m);
    NEW(scratch, images, (size_t)n * (size_t)m);
    NEW(scratch, pivot, n);

    // before^T X = after^T has as its solution X the transposed map, whose eigenvalues are the same. real serves as
    // scratch for the singular values; the rows of images below n receive the residuals.
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < m; j++) {
            matrix[j + m * i] = before[i + n * j];
            images[j + m * i] = after[i + n * j];
        }
    }
    const int failed = LAPACKE_dgelsd(LAPACK_COL_MAJOR, m, n, n, matrix, m, images, m, real, least_singular, &rank);
    if (failed != 0 || rank < 1) return status_fail(STATUS_SOLVER, not_apart);

    // (I - A) way = change
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) matrix[i + n * j] = (i == j) - images[j + m * i];
    }
    memcpy(way, change, (size_t)n * sizeof *way);
    if (LAPACKE_dgesv(LAPACK_COL_MAJOR, n, 1, matrix, n, pivot, way, n) != 0) memset(way, 0, (size_t)n * sizeof *way);

    if (LAPACKE_dgeev(LAPACK_COL_MAJOR, 'N', 'N', n, images, m, real, imaginary, NULL, 1, NULL, 1) != 0) {
        return status_fail(STATUS_SOLVER, not_apart);
    }

    // sort by absolute value, in which the two members of a complex pair agree up to rounding
    for (int i = 0; i < n; i++) {
        double re = real[i], im = imaginary[i];
        if (hypot(re, im) < dead_multiplier) re = im = 0;
        int place = i;
        for (; place > 0; place--) {
            const double size = hypot(re, im), before_it = hypot(real[place - 1], imaginary[place - 1]);
            const bool differ = fabs(size - before_it) > 1e-12 * (size + before_it);
            if (!(differ ? size > before_it : im > imaginary[place - 1])) break;
            real[place] = real[place - 1];
            imaginary[place] = imaginary[place - 1];
        }
        real[place] = re;
        imaginary[place] = im;
    }
    return STATUS_OK;
}
