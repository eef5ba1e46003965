/* sundials_linear.c: a matrix and a linear solver of SUNDIALS that hold nothing but ours. */
#include "solver/sundials_linear.h"

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
    const struct sundials_linear *const own = solver->content;
    *own->failure = linear_setup(own->linear);
    return *own->failure;
}

static int solver_solve(SUNLinearSolver solver, SUNMatrix matrix, N_Vector x, N_Vector b, sunrealtype tolerance) {
    (void)matrix, (void)tolerance;
    const struct sundials_linear *const own = solver->content;
    *own->failure = linear_solve(own->linear, N_VGetArrayPointer(b), N_VGetArrayPointer(x));
    return *own->failure;
}

enum status sundials_linear_create(struct sundials_linear *linear, SUNContext context, const struct jacobian *jacobian,
                                   const double *scale, struct linear_tolerance tolerance, enum status *failure) {
    *linear = (struct sundials_linear){.failure = failure};
    TRY(linear_create(&linear->linear, jacobian, scale, tolerance));
    linear->matrix = SUNMatNewEmpty(context);
    linear->solver = SUNLinSolNewEmpty(context);
    if (!linear->matrix || !linear->solver) {
        sundials_linear_free(linear);
        return status_fail(STATUS_MEMORY, "out of memory: a linear solver");
    }
    linear->matrix->ops->getid = matrix_id;
    linear->matrix->ops->zero = matrix_zero;
    linear->solver->content = linear;
    linear->solver->ops->gettype = solver_type;
    linear->solver->ops->setup = solver_setup;
    linear->solver->ops->solve = solver_solve;
    return STATUS_OK;
}

void sundials_linear_free(struct sundials_linear *linear) {
    if (linear->solver) SUNLinSolFreeEmpty(linear->solver);
    if (linear->matrix) SUNMatFreeEmpty(linear->matrix);
    linear_free(linear->linear);
    *linear = (struct sundials_linear){0};
}
