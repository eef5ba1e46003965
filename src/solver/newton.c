/* newton.c: KINSOL with a dense matrix. */
#include "solver/newton.h"

#include <lapacke.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
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

static enum status newton_set_up(struct solver *solver, double *u, double *inverse) {
    const struct newton *const problem = solver->problem;
    for (int i = 0; i < problem->n; i++) inverse[i] = 1 / problem->scale[i];
    TRY(sundials_context_create(&solver->context, problem->n, 1, &solver->failure));
    TRY(sundials_context_vector(&solver->context, &solver->unknowns, u));
    TRY(sundials_context_vector(&solver->context, &solver->scales, inverse));
    solver->matrix = SUNDenseMatrix(problem->n, problem->n, solver->context.context);
    solver->linear = solver->matrix ? SUNLinSol_Dense(solver->unknowns, solver->matrix, solver->context.context) : NULL;
    solver->kinsol = KINCreate(solver->context.context);
    if (!solver->linear || !solver->kinsol) return memory_check(NULL, "KINSOL");
    // steps of dead_multiplier do not end the iteration
    if (KINSetErrHandlerFn(solver->kinsol, sundials_context_message, &solver->failure) ||
        KINSetUserData(solver->kinsol, solver) || KINInit(solver->kinsol, newton_value_of, solver->unknowns) ||
        KINSetLinearSolver(solver->kinsol, solver->linear, solver->matrix) ||
        KINSetJacFn(solver->kinsol, newton_jacobian_of) || KINSetMaxSetupCalls(solver->kinsol, problem->reuse) ||
        KINSetFuncNormTol(solver->kinsol, problem->tolerance) || KINSetScaledStepTol(solver->kinsol, 1e-14) ||
        KINSetNumMaxIters(solver->kinsol, problem->max_iterations) ||
        KINSetMaxNewtonStep(solver->kinsol, problem->max_step)) {
        TRY(sundials_context_check(&solver->context));
        return status_fail(STATUS_SOLVER, "KINSOL cannot be set up: %s", status_message());
    }
    return sundials_context_check(&solver->context);
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

static enum status solve(struct solver *solver) {
    int code = KIN_MXNEWT_5X_EXCEEDED;
    long n_iterations = 0, n = 0;
    // five longest steps in a row are no newton_reason to stop
    while (code == KIN_MXNEWT_5X_EXCEEDED && n_iterations < solver->problem->max_iterations) {
        code = KINSol(solver->kinsol, solver->unknowns, KIN_NONE, solver->scales, solver->scales);
        KINGetNumNonlinSolvIters(solver->kinsol, &n);
        n_iterations += n;
    }
    if (solver->failure != STATUS_OK) return solver->failure;
    if (code >= 0) return STATUS_OK;
    char cause[512];
    snprintf(cause, sizeof cause, "%s", status_message());
    return status_fail(STATUS_SOLVER, "%s (%s)", newton_reason(code), cause);
}

enum status newton_solve(const struct newton *problem, double *u) {
    struct solver solver = {.problem = problem};
    double *const inverse = calloc((size_t)problem->n, sizeof *inverse);
    enum status status = memory_check(inverse, "Newton's method");
    if (status == STATUS_OK) status = newton_set_up(&solver, u, inverse);
    if (status == STATUS_OK) status = solve(&solver);
    if (solver.kinsol) KINFree(&solver.kinsol);
    if (solver.linear) SUNLinSolFree(solver.linear);
    if (solver.matrix) SUNMatDestroy(solver.matrix);
    if (solver.unknowns) N_VDestroy(solver.unknowns);
    if (solver.scales) N_VDestroy(solver.scales);
    sundials_context_free(&solver.context);

    free(inverse);
    return status;
}

// ---- least squares and eigenvalues of LAPACK

static int multiplier_comes_before(const double *real, const double *imaginary, int i, int j) {
    const double a = hypot(real[i], imaginary[i]), b = hypot(real[j], imaginary[j]);
    // the two of a pair have the same value but for dead_multiplier
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
static enum status newton_find_fixed_point(int n, int m, const double *images, const double *change, double *way) {
    double *matrix = NULL;
    lapack_int *pivot = NULL;
    enum status status = MEMORY_NEW(matrix, n * n, "the fixed point of a map");
    if (status == STATUS_OK) status = MEMORY_NEW(pivot, n, "the fixed point of a map");
    if (status == STATUS_OK) {
        for (int i = 0; i < n; i++) {
            for (int j = 0; j < n; j++) matrix[i + n * j] = (i == j) - images[j + m * i];
        }
        memcpy(way, change, (size_t)n * sizeof *way);
        if (LAPACKE_dgesv(LAPACK_COL_MAJOR, n, 1, matrix, n, pivot, way, n) != 0) {
            memset(way, 0, (size_t)n * sizeof *way);
        }
    }
    free(matrix);
    free(pivot);
    return status;
}

/* A map of n dimensions and m images; results. */
struct map {
    int n, m;
    const double *before, *after, *change;
    double *real, *imaginary, *way;
};

// the transposed map is the solution X of before^T X = after^T, and has the same eigenvalues
static enum status multipliers_solve(const struct map *map, double *matrix, double *images) {
    const int n = map->n, m = map->m;
    multipliers_transpose(n, m, map->before, matrix);
    multipliers_transpose(n, m, map->after, images);
    // real is scratch for the singular values; rows of images below n contain the residuals
    lapack_int rank = 0;
    double *const real = map->real, *const imaginary = map->imaginary;
    const int failed = LAPACKE_dgelsd(LAPACK_COL_MAJOR, m, n, n, matrix, m, images, m, real, least_singular, &rank);
    if (failed != 0 || rank < 1) return status_fail(STATUS_SOLVER, "the multipliers cannot be told apart");
    TRY(newton_find_fixed_point(n, m, images, map->change, map->way));
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

enum status newton_multipliers(int n, int n_columns, const double *before, const double *after, const double *change,
                               double *real, double *imaginary, double *way) {
    const struct map map = {n, n_columns, before, after, change, real, imaginary, way};
    const size_t size = (size_t)n * (size_t)n_columns;
    double *matrix = NULL, *images = NULL;
    enum status status = MEMORY_NEW(matrix, size, "multipliers");
    if (status == STATUS_OK) status = MEMORY_NEW(images, size, "multipliers");
    if (status == STATUS_OK) status = multipliers_solve(&map, matrix, images);
    free(matrix);
    free(images);
    return status;
}
