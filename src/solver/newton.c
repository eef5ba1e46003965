/* newton.c: KINSOL with a dense matrix, and maps with memory by LAPACK. */
#include "solver/newton.h"

#include <complex.h>
#include <lapacke.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
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

static void release_linear(void *linear) {
    SUNLinSolFree(linear);
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
        sundials_own(scratch, sundials_release_matrix, SUNDenseMatrix(problem->n, problem->n, context->context));
    const SUNLinearSolver linear =
        sundials_own(scratch, release_linear, SUNLinSol_Dense(unknowns, matrix, context->context));
    sundials_context_reserve(context, 12);  // KINSOL clones 5
    void *const kinsol = sundials_own(scratch, sundials_release_kinsol, KINCreate(context->context));

    // the step tolerance is so small that short steps do not end the iteration
    if (KINSetErrHandlerFn(kinsol, sundials_context_message, &solver->failure) || KINSetUserData(kinsol, solver) ||
        KINInit(kinsol, newton_value_of, unknowns) || KINSetLinearSolver(kinsol, linear, matrix) ||
        KINSetJacFn(kinsol, newton_jacobian_of) || KINSetMaxSetupCalls(kinsol, problem->reuse) ||
        KINSetFuncNormTol(kinsol, problem->tolerance) || KINSetScaledStepTol(kinsol, 1e-14) ||
        KINSetNumMaxIters(kinsol, problem->max_iterations) || KINSetMaxNewtonStep(kinsol, problem->max_step)) {
        return sundials_context_failed(context, "KINSOL");
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

// ---- a linear map with memory

/* Eigenvalues below this limit are rounding errors of 0. */
static const double dead_multiplier = 1e-10;

struct eigenvalue {
    double real, imaginary;
    lapack_int column; /* of the eigenvector */
};

// by falling absolute value, in a pair the positive imaginary part first; both values of a pair have the same modulus
// up to rounding
static int compare_eigenvalues(const void *a, const void *b) {
    const struct eigenvalue *const one = a, *const other = b;
    const double size = hypot(one->real, one->imaginary), size_of_other = hypot(other->real, other->imaginary);
    if (fabs(size - size_of_other) > 1e-12 * (size + size_of_other)) return size > size_of_other ? -1 : 1;
    if (one->imaginary != other->imaginary) return one->imaginary > other->imaginary ? -1 : 1;
    return one->column - other->column;
}

enum status newton_multipliers(struct arena *arena, int n, int n_memory, const double *response, double *real,
                               double *imaginary, double *mode) {
    ARENA(scratch, arena, "multipliers");
    const int size = n * n_memory;
    double *companion, *re, *im, *vectors = NULL;
    struct eigenvalue *all;
    NEW(scratch, companion, (size_t)size * (size_t)size);
    NEW(scratch, re, size);
    NEW(scratch, im, size);
    NEW(scratch, all, size);
    if (mode) NEW(scratch, vectors, (size_t)size * (size_t)size);

    // the companion matrix maps (x_k, x_k-1, ...) to (x_k+1, x_k, ...)
    for (int j = 0; j < size; j++) {
        for (int i = 0; i < n; i++) companion[i + size * j] = response[i + n * j];
        if (j + n < size) companion[j + n + size * j] = 1;
    }
    if (LAPACKE_dgeev(LAPACK_COL_MAJOR, 'N', mode ? 'V' : 'N', size, companion, size, re, im, NULL, 1, vectors, size)) {
        return status_fail(STATUS_SOLVER, "the multipliers have not converged: a response is not finite");
    }
    for (int i = 0; i < size; i++) {
        // the second vector of a pair is the conjugate of the first
        all[i] = (struct eigenvalue){re[i], im[i], im[i] < 0 ? i - 1 : i};
        if (hypot(re[i], im[i]) < dead_multiplier) all[i] = (struct eigenvalue){0, 0, i};
    }
    qsort(all, (size_t)size, sizeof *all, compare_eigenvalues);

    for (int i = 0; i < n; i++) {
        real[i] = all[i].real;
        imaginary[i] = all[i].imaginary;
        if (!mode) continue;

        // the components of x, over the largest
        const double *const of_real = vectors + (size_t)size * (size_t)all[i].column;
        const double *const of_imaginary = of_real + size;
        const double sign = all[i].imaginary > 0 ? 1 : all[i].imaginary < 0 ? -1 : 0;
        double complex largest = 0;
        for (int k = 0; k < n; k++) {
            const double complex one = of_real[k] + (sign != 0 ? sign * I * of_imaginary[k] : 0);
            if (cabs(one) > cabs(largest)) largest = one;
        }
        for (int k = 0; k < n; k++) {
            const double complex one = of_real[k] + (sign != 0 ? sign * I * of_imaginary[k] : 0);
            mode[2 * (k + n * i)] = largest != 0 ? creal(one / largest) : 0;
            mode[2 * (k + n * i) + 1] = largest != 0 ? cimag(one / largest) : 0;
        }
    }
    return STATUS_OK;
}

void newton_way(struct arena *arena, int n, int n_memory, const double *response, const double *change, double *way) {
    ARENA(scratch, arena, "the way to a fixed point");
    double *matrix;
    lapack_int *pivot;
    NEW(scratch, matrix, (size_t)n * (size_t)n);
    NEW(scratch, pivot, n);
    for (int i = 0; i < n; i++) matrix[i + n * i] = 1;
    for (int i = 0; i < n * n * n_memory; i++) matrix[i % (n * n)] -= response[i];
    memcpy(way, change, (size_t)n * sizeof *way);
    if (LAPACKE_dgesv(LAPACK_COL_MAJOR, n, 1, matrix, n, pivot, way, n) != 0) memset(way, 0, (size_t)n * sizeof *way);
}

enum status newton_tangent(struct arena *arena, int n, const double *jacobian, double *tangent) {
    ARENA(scratch, arena, "a tangent");
    const int size = n + 1;
    double *matrix, *way, square = 0;
    lapack_int *pivot;
    NEW(scratch, matrix, (size_t)size * (size_t)size);
    NEW(scratch, way, size);
    NEW(scratch, pivot, size);
    for (int j = 0; j < size; j++) {
        memcpy(matrix + (size_t)size * (size_t)j, jacobian + (size_t)n * (size_t)j, (size_t)n * sizeof *matrix);
        matrix[n + size * j] = tangent[j];
    }
    way[n] = 1;
    if (LAPACKE_dgesv(LAPACK_COL_MAJOR, size, 1, matrix, size, pivot, way, size) != 0) {
        return status_fail(STATUS_SOLVER, "the branch has no single tangent");
    }
    for (int i = 0; i < size; i++) square += way[i] * way[i];
    for (int i = 0; i < size; i++) tangent[i] = way[i] / sqrt(square);
    return STATUS_OK;
}
