/* sundials.h: SUNDIALS 6.4 to 7.x under the names of 7.x. All differences between the versions stand here: other files
 * include this header instead of those of SUNDIALS, and have no #if of their own.
 *
 * In 7 the errors of all packages reach the handlers of their context; in 6 each package has a handler of its own. Who
 * creates a package calls both SUNContext_PushErrHandler and the package's SetErrHandlerFn: of the two the version at
 * hand has one, and the other one does nothing. */
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

#define SUNDIALS_AT_LEAST(major, minor) \
    (SUNDIALS_VERSION_MAJOR > (major) || (SUNDIALS_VERSION_MAJOR == (major) && SUNDIALS_VERSION_MINOR >= (minor)))
#define SUNDIALS_UNUSED __attribute__((unused))

#if SUNDIALS_AT_LEAST(7, 0)

/* The arguments of a handler of errors: code, function, text and data are those that both versions give. */
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
#define ARKodeSVtolerances ARKStepSVtolerances
#define ARKodeSetFixedStep ARKStepSetFixedStep
#define ARKodeSetInterpolantType ARKStepSetInterpolantType
#define ARKodeSetMaxErrTestFails ARKStepSetMaxErrTestFails
#define ARKodeSetMaxNumSteps ARKStepSetMaxNumSteps
#define ARKodeSetMinStep ARKStepSetMinStep
#define ARKodeSetStopTime ARKStepSetStopTime
#define ARKodeSetUserData ARKStepSetUserData
#endif

#endif
