/* sundials.h: SUNDIALS 6.4 to 7.x under the names of 7.x, and contexts and vectors. All differences between the
 * versions are here: other files include this header instead of the headers of SUNDIALS, and contain no #if.
 *
 * In 7 the errors of all packages reach the handlers of their context; in 6 each package has a handler. The creator of
 * a package calls both SUNContext_PushErrHandler and the SetErrHandlerFn of the package; one of the two is a no-op. */
#ifndef SOLVER_SUNDIALS_H
#define SOLVER_SUNDIALS_H

#include <arkode/arkode_arkstep.h>
#include <ida/ida.h>
#include <kinsol/kinsol.h>
#include <nvector/nvector_serial.h>
#if __has_include(<nvector/nvector_openmp.h>)
#include <nvector/nvector_openmp.h>
#endif
#include <sundials/sundials_context.h>
#include <sundials/sundials_linearsolver.h>
#include <sundials/sundials_logger.h>
#include <sundials/sundials_matrix.h>
#include <sundials/sundials_nonlinearsolver.h>
#include <sundials/sundials_nvector.h>
#include <sundials/sundials_types.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunlinsol/sunlinsol_spgmr.h>
#include <sunmatrix/sunmatrix_dense.h>

#include "base/arena.h"
#include "base/status.h"

#define SUNDIALS_AT_LEAST(major, minor) \
    (SUNDIALS_VERSION_MAJOR > (major) || (SUNDIALS_VERSION_MAJOR == (major) && SUNDIALS_VERSION_MINOR >= (minor)))
#define SUNDIALS_UNUSED __attribute__((unused))

#if SUNDIALS_AT_LEAST(7, 0)

/* The arguments of an error handler; both versions give code, function, text and data. */
#define SUNDIALS_ERROR_ARGUMENTS                                                                        \
    SUNDIALS_UNUSED int line, const char *function, SUNDIALS_UNUSED const char *file, const char *text, \
        SUNErrCode code, void *data, SUNDIALS_UNUSED SUNContext context

#define IDASetErrHandlerFn(ida, handler, data) SUN_SUCCESS
#define KINSetErrHandlerFn(kinsol, handler, data) SUN_SUCCESS
#define ARKStepSetErrHandlerFn(arkode, handler, data) SUN_SUCCESS

#else

typedef int SUNErrCode;
#define SUN_SUCCESS 0
#define SUN_COMM_NULL NULL

#define SUNDIALS_ERROR_ARGUMENTS \
    int code, SUNDIALS_UNUSED const char *module, const char *function, char *text, void *data

#define SUNContext_ClearErrHandlers(context) ((void)(context), SUN_SUCCESS)
#define SUNContext_PushErrHandler(context, handler, data) ((void)(context), (void)(data), SUN_SUCCESS)

#endif

// built without OpenMP: vectors on one thread
#if !__has_include(<nvector/nvector_openmp.h>)
#define _N_VectorContent_OpenMP _N_VectorContent_Serial
#define N_VMake_OpenMP(n, values, threads, context) N_VMake_Serial(n, values, context)
#define N_VClone_OpenMP N_VClone_Serial
#define N_VDestroy_OpenMP N_VDestroy_Serial
#endif

#if !SUNDIALS_AT_LEAST(7, 1)
#define ARKodeEvolve ARKStepEvolve
#define ARKodeFree ARKStepFree
#define ARKodeGetLastStep ARKStepGetLastStep
#define ARKodeGetNumErrTestFails ARKStepGetNumErrTestFails
#define ARKodeGetNumSteps ARKStepGetNumSteps
#define ARKodeReset ARKStepReset
#define ARKodeSVtolerances ARKStepSVtolerances
#define ARKodeSetFixedStep ARKStepSetFixedStep
#define ARKodeSetInterpolantType ARKStepSetInterpolantType
#define ARKodeSetMaxErrTestFails ARKStepSetMaxErrTestFails
#define ARKodeSetMaxNumSteps ARKStepSetMaxNumSteps
#define ARKodeSetMinStep ARKStepSetMinStep
#define ARKodeSetStopTime ARKStepSetStopTime
#define ARKodeSetUserData ARKStepSetUserData
#endif

// ---- context, vectors, error handler. Tested by tests/solver/test_sundials.c

/* The context of one solver, shared by its vectors. The struct must not move while vectors exist. */
struct sundials_context {
    SUNContext context;
    struct arena *arena; /* of the context and all vectors, also of clones by SUNDIALS; freed after later objects */
    N_Vector *spare;     /* vectors for the next clones */
    int n_spare;
    int n, threads;       /* of every vector: number of values, threads of an operation */
    enum status *failure; /* status of the last callback; owned by the caller */
};

/* Create a context for vectors of n values. Threads share the operations on long vectors; the bits of each value are
 * independent of the number of threads, and norms are sums in the order of the values. Errors of SUNDIALS go to
 * sundials_context_message with failure. An object that clones vectors is deferred to the same arena later, and so is
 * freed before its vectors. */
void sundials_context_create(struct sundials_context *context, struct arena *arena, int n, int threads,
                             enum status *failure);

/* Prepare n clones, so that no clone inside SUNDIALS requests memory. SUNDIALS writes through the NULL of a clone that
 * failed (N_VClone of 6.4.1), and a jump out of its functions would lose what they have allocated. */
void sundials_context_reserve(struct sundials_context *context, int n);

/* Release an object with the arena, before older objects. object NULL is a lack of memory. Returns the object. */
void *sundials_own(struct arena *arena, void (*release)(void *object), void *object);
void sundials_release_kinsol(void *kinsol);
void sundials_release_matrix(void *matrix);

/* Create a vector on an array of the caller, or, if values is NULL, of zeros. */
N_Vector sundials_context_vector(struct sundials_context *context, double *values);

/* Error handler for SUNDIALS; data: status of the last callback. The message of a failed callback is the cause and
 * stays; otherwise the text of SUNDIALS becomes the message of this thread. Where SUNDIALS lacks memory, the status
 * becomes STATUS_MEMORY. */
void sundials_context_message(SUNDIALS_ERROR_ARGUMENTS);

/* Fail because a package could not be set up: with STATUS_MEMORY, or else with STATUS_SOLVER. */
enum status sundials_context_failed(const struct sundials_context *context, const char *package);

#endif
