/* bridge.c: SUNDIALS objects around our arrays. */
#include "bridge.h"

#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>

enum status bridge_context(SUNContext *context) {
    if (SUNContext_Create(NULL, context) != 0) return status_fail(STATUS_MEMORY, "no room for the solvers");
    return STATUS_OK;
}

enum status bridge_vector(N_Vector *vector, SUNContext context, long n, double *values) {
    *vector = N_VMake_Serial(n, values, context);
    return *vector ? STATUS_OK : status_fail(STATUS_MEMORY, "no room for a vector of %ld unknowns", n);
}

static SUNMatrix_ID matrix_id(SUNMatrix matrix) {
    (void)matrix;
    return SUNMATRIX_CUSTOM;
}

// the Jacobian sets its values to zero itself when it is filled
static int matrix_zero(SUNMatrix matrix) {
    (void)matrix;
    return SUNMAT_SUCCESS;
}

static SUNLinearSolver_Type solver_type(SUNLinearSolver solver) {
    (void)solver;
    return SUNLINEARSOLVER_DIRECT;
}

static int solver_setup(SUNLinearSolver solver, SUNMatrix matrix) {
    (void)matrix;
    return linear_setup(solver->content);
}

static int solver_solve(SUNLinearSolver solver, SUNMatrix matrix, N_Vector x, N_Vector b, realtype tolerance) {
    (void)matrix, (void)tolerance;
    return linear_solve(solver->content, N_VGetArrayPointer(b), N_VGetArrayPointer(x));
}

enum status bridge_linear_create(struct bridge_linear *bridge, SUNContext context, const struct jacobian *jacobian,
                                 const double *scale, struct linear_end end) {
    *bridge = (struct bridge_linear){0};
    TRY(linear_create(&bridge->linear, jacobian, scale, end));
    bridge->matrix = SUNMatNewEmpty(context);
    bridge->solver = SUNLinSolNewEmpty(context);
    if (!bridge->matrix || !bridge->solver) {
        bridge_linear_free(bridge);
        return status_fail(STATUS_MEMORY, "no room for a linear solver");
    }
    bridge->matrix->ops->getid = matrix_id;
    bridge->matrix->ops->zero = matrix_zero;
    bridge->solver->content = bridge->linear;
    bridge->solver->ops->gettype = solver_type;
    bridge->solver->ops->setup = solver_setup;
    bridge->solver->ops->solve = solver_solve;
    return STATUS_OK;
}

void bridge_linear_free(struct bridge_linear *bridge) {
    if (bridge->solver) SUNLinSolFreeEmpty(bridge->solver);
    if (bridge->matrix) SUNMatFreeEmpty(bridge->matrix);
    linear_free(bridge->linear);
    *bridge = (struct bridge_linear){0};
}

void bridge_message(int code, const char *module, const char *function, char *text, void *data) {
    (void)data;
    // a warning needs no word: what matters comes back as a code
    if (code < 0) status_fail(STATUS_SOLVER, "%s (%s, %s)", text, module, function);
}
