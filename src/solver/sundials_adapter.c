/* sundials_adapter.c: objects of SUNDIALS that wrap our arrays and our linear solver. */
#include "solver/sundials_adapter.h"

#include <stdlib.h>

static enum status find_memory(int n) {
    // vectors of doubles, of which IDA makes about 25, and what is small
    enum { VECTORS = 40, SMALL = 1 << 20 };
    void *volatile const needed = malloc((size_t)n * VECTORS * sizeof(double) + SMALL);
    free(needed);
    return needed ? STATUS_OK : status_fail(STATUS_MEMORY, "out of memory: the solver of %d unknowns", n);
}

enum status sundials_adapter_context(SUNContext *context, int n, enum status *failure) {
    TRY(find_memory(n));
    // without a logger: it would print warnings
    if (SUNContext_Create(SUN_COMM_NULL, context) != SUN_SUCCESS ||
        SUNContext_SetLogger(*context, NULL) != SUN_SUCCESS || SUNContext_ClearErrHandlers(*context) != SUN_SUCCESS ||
        SUNContext_PushErrHandler(*context, sundials_adapter_message, failure) != SUN_SUCCESS) {
        return status_fail(STATUS_MEMORY, "out of memory: a context of SUNDIALS");
    }
    return STATUS_OK;
}

enum status sundials_adapter_vector(N_Vector *vector, SUNContext context, int n, double *values) {
    *vector = N_VMake_Serial(n, values, context);
    return *vector ? STATUS_OK : status_fail(STATUS_MEMORY, "out of memory: a vector of %d unknowns", n);
}

static SUNMatrix_ID matrix_id(SUNMatrix matrix) {
    (void)matrix;
    return SUNMATRIX_CUSTOM;
}

// residual_jacobian sets the values to zero itself
static int matrix_zero(SUNMatrix matrix) {
    (void)matrix;
    return SUN_SUCCESS;
}

static SUNLinearSolver_Type solver_type(SUNLinearSolver solver) {
    (void)solver;
    return SUNLINEARSOLVER_DIRECT;
}

static int solver_setup(SUNLinearSolver solver, SUNMatrix matrix) {
    (void)matrix;
    const struct sundials_adapter_linear *const adapter = solver->content;
    *adapter->failure = linear_setup(adapter->linear);
    return *adapter->failure;
}

static int solver_solve(SUNLinearSolver solver, SUNMatrix matrix, N_Vector x, N_Vector b, sunrealtype tolerance) {
    (void)matrix, (void)tolerance;
    const struct sundials_adapter_linear *const adapter = solver->content;
    *adapter->failure = linear_solve(adapter->linear, N_VGetArrayPointer(b), N_VGetArrayPointer(x));
    return *adapter->failure;
}

enum status sundials_adapter_linear_create(struct sundials_adapter_linear *adapter, SUNContext context,
                                           const struct jacobian *jacobian, const double *scale,
                                           struct linear_tolerance tolerance, enum status *failure) {
    *adapter = (struct sundials_adapter_linear){.failure = failure};
    TRY(linear_create(&adapter->linear, jacobian, scale, tolerance));
    adapter->matrix = SUNMatNewEmpty(context);
    adapter->solver = SUNLinSolNewEmpty(context);
    if (!adapter->matrix || !adapter->solver) {
        sundials_adapter_linear_free(adapter);
        return status_fail(STATUS_MEMORY, "out of memory: a linear solver");
    }
    adapter->matrix->ops->getid = matrix_id;
    adapter->matrix->ops->zero = matrix_zero;
    adapter->solver->content = adapter;
    adapter->solver->ops->gettype = solver_type;
    adapter->solver->ops->setup = solver_setup;
    adapter->solver->ops->solve = solver_solve;
    return STATUS_OK;
}

void sundials_adapter_linear_free(struct sundials_adapter_linear *adapter) {
    if (adapter->solver) SUNLinSolFreeEmpty(adapter->solver);
    if (adapter->matrix) SUNMatFreeEmpty(adapter->matrix);
    linear_free(adapter->linear);
    *adapter = (struct sundials_adapter_linear){0};
}

void sundials_adapter_message(SUNDIALS_ERROR_ARGUMENTS) {
    const enum status *const failure = data;
    // warnings are dropped: what matters also comes back as a code
    if (code < 0 && *failure == STATUS_OK) status_fail(STATUS_SOLVER, "%s (%s)", text, function);
}
