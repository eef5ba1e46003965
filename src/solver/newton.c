/* newton.c: KINSOL with a dense matrix. */
#include "solver/newton.h"

#include <lapacke.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "solver/sundials.h"

struct solver {
    const struct newton *problem;
    enum status failure; /* of the last callback */
    struct sundials_context context;
    N_Vector unknowns, scales;
    SUNMatrix matrix;
    SUNLinearSolver linear;
    void *kinsol;
};

// a failure of a callback is final: evaluations are too expensive for smaller steps
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

static const char *newton_reason(int code) {
    switch (code) {
        case KIN_MXNEWT_5X_EXCEEDED:
        case KIN_MAXITER_REACHED: return "Newton's method did not converge";
        case KIN_LSETUP_FAIL:
        case KIN_LSOLVE_FAIL: return "the Jacobian is singular";
        default: return "KINSOL failed";
    }
}

static void release_kinsol(void *solver) {
    KINFree(&((struct solver *)solver)->kinsol);
}

static void release_matrix(void *matrix) {
    SUNMatDestroy(matrix);
}

static void release_linear(void *linear) {
    SUNLinSolFree(linear);
}

// solve with memory and objects of an arena, which the caller frees
static enum status newton_solve_with(struct arena *arena, const struct newton *problem, double *u) {
    struct solver *solver;
    double *inverse;
    NEW(arena, solver, 1);
    NEW(arena, inverse, problem->n);
    for (int i = 0; i < problem->n; i++) inverse[i] = 1 / problem->scale[i];
    solver->problem = problem;
    sundials_context_create(&solver->context, arena, problem->n, 1, &solver->failure);
    solver->unknowns = sundials_context_vector(&solver->context, u);
    solver->scales = sundials_context_vector(&solver->context, inverse);
    const SUNContext context = solver->context.context;
    solver->matrix = arena_take(arena, SUNDenseMatrix(problem->n, problem->n, context));
    arena_defer(arena, release_matrix, solver->matrix);
    solver->linear = arena_take(arena, SUNLinSol_Dense(solver->unknowns, solver->matrix, context));
    arena_defer(arena, release_linear, solver->linear);
    sundials_context_reserve(&solver->context, 12);  // KINSOL clones 5
    void *const kinsol = solver->kinsol = arena_take(arena, KINCreate(context));
    arena_defer(arena, release_kinsol, solver);
    // small steps do not end the iteration
    if (KINSetErrHandlerFn(kinsol, sundials_context_message, &solver->failure) || KINSetUserData(kinsol, solver) ||
        KINInit(kinsol, newton_value_of, solver->unknowns) ||
        KINSetLinearSolver(kinsol, solver->linear, solver->matrix) || KINSetJacFn(kinsol, newton_jacobian_of) ||
        KINSetMaxSetupCalls(kinsol, problem->reuse) || KINSetFuncNormTol(kinsol, problem->tolerance) ||
        KINSetScaledStepTol(kinsol, 1e-14) || KINSetNumMaxIters(kinsol, problem->max_iterations) ||
        KINSetMaxNewtonStep(kinsol, problem->max_step)) {
        return status_fail(STATUS_SOLVER, "KINSOL cannot be set up: %s", status_message());
    }

    // five longest steps in a row are no reason to stop
    int code = KIN_MXNEWT_5X_EXCEEDED;
    long n_iterations = 0, n = 0;
    while (code == KIN_MXNEWT_5X_EXCEEDED && n_iterations < problem->max_iterations) {
        code = KINSol(kinsol, solver->unknowns, KIN_NONE, solver->scales, solver->scales);
        KINGetNumNonlinSolvIters(kinsol, &n);
        n_iterations += n;
    }
    if (solver->failure != STATUS_OK) return solver->failure;
    if (code >= 0) return STATUS_OK;
    char cause[512];
    snprintf(cause, sizeof cause, "%s", status_message());
    return status_fail(STATUS_SOLVER, "%s (%s)", newton_reason(code), cause);
}

enum status newton_solve(struct arena *arena, const struct newton *problem, double *u) {
    struct arena *const scratch = arena_create(arena, "Newton's method");
    const enum status status = newton_solve_with(scratch, problem, u);
    arena_free(scratch);
    return status;
}

// ---- least squares and eigenvalues of LAPACK

static int multiplier_comes_before(const double *real, const double *imaginary, int i, int j) {
    const double a = hypot(real[i], imaginary[i]), b = hypot(real[j], imaginary[j]);
    // both values of a complex pair have the same modulus up to rounding
    if (fabs(a - b) > 1e-12 * (a + b)) return a > b;
    return imaginary[i] > imaginary[j];
}

static void swap(double *a, double *b) {
    const double value = *a;
    *a = *b;
    *b = value;
}

// exchange rows and columns                                                       from (n, m), to (m, n)
static void multipliers_transpose(int n, int m, const double *from, double *to) {
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < m; j++) to[j + m * i] = from[i + n * j];
    }
}

/* Directions in which the columns are below this fraction of the largest column have decayed: the remaining columns are
 * errors of the integration. */
static const double least_singular = 0.03;

/* Eigenvalues of decayed directions are below this limit. */
static const double dead_multiplier = 1e-10;

// (I - A) way = change, with the transposed map in the first n rows of images                        (m, n)
static void newton_find_fixed_point(struct arena *scratch, int n, int m, const double *images, const double *change,
                                    double *way) {
    double *matrix;
    lapack_int *pivot;
    NEW(scratch, matrix, n * n);
    NEW(scratch, pivot, n);
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) matrix[i + n * j] = (i == j) - images[j + m * i];
    }
    memcpy(way, change, (size_t)n * sizeof *way);
    if (LAPACKE_dgesv(LAPACK_COL_MAJOR, n, 1, matrix, n, pivot, way, n) != 0) memset(way, 0, (size_t)n * sizeof *way);
}

// the transposed map is the solution X of before^T X = after^T, and has the same eigenvalues
static enum status newton_multipliers_with(struct arena *scratch, int n, int m, const double *before,
                                           const double *after, const double *change, double *real, double *imaginary,
                                           double *way) {
    double *matrix, *images;
    NEW(scratch, matrix, (size_t)n * (size_t)m);
    NEW(scratch, images, (size_t)n * (size_t)m);
    multipliers_transpose(n, m, before, matrix);
    multipliers_transpose(n, m, after, images);
    // real is scratch for the singular values; rows of images below n contain the residuals
    lapack_int rank = 0;
    const int failed = LAPACKE_dgelsd(LAPACK_COL_MAJOR, m, n, n, matrix, m, images, m, real, least_singular, &rank);
    if (failed != 0 || rank < 1) return status_fail(STATUS_SOLVER, "the multipliers cannot be told apart");
    newton_find_fixed_point(scratch, n, m, images, change, way);
    if (LAPACKE_dgeev(LAPACK_COL_MAJOR, 'N', 'N', n, images, m, real, imaginary, NULL, 1, NULL, 1) != 0) {
        return status_fail(STATUS_SOLVER, "the multipliers cannot be told apart");
    }
    for (int i = 0; i < n; i++) {
        if (hypot(real[i], imaginary[i]) < dead_multiplier) real[i] = imaginary[i] = 0;
    }

    // sort by absolute value
    for (int i = 1; i < n; i++) {
        for (int j = i; j > 0 && multiplier_comes_before(real, imaginary, j, j - 1); j--) {
            swap(&real[j], &real[j - 1]);
            swap(&imaginary[j], &imaginary[j - 1]);
        }
    }

    return STATUS_OK;
}

enum status newton_multipliers(struct arena *arena, int n, int n_columns, const double *before, const double *after,
                               const double *change, double *real, double *imaginary, double *way) {
    struct arena *const scratch = arena_create(arena, "multipliers");
    const enum status status =
        newton_multipliers_with(scratch, n, n_columns, before, after, change, real, imaginary, way);
    arena_free(scratch);
    return status;
}
