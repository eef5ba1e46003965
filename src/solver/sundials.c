/* sundials.c: vectors of SUNDIALS, serial ones or those of OpenMP, with norms and sums of our own.
 *
 * A school of 64 fish takes 3.53 s of CPU on two threads with the vectors of OpenMP, and 3.55 s with vectors of our
 * own; a school of 256 fish 3.43 s and 3.44 s. */
#include "solver/sundials.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include "base/parallel.h"
#include "base/wide.h"

// in the order of the values, whatever the number of threads
static double norm(N_Vector x, N_Vector weight) {
    const double *const value = N_VGetArrayPointer(x), *const w = N_VGetArrayPointer(weight);
    const int n = (int)N_VGetLength(x);
    double sum = 0;
    for (int i = 0; i < n; i++) {
        const double weighted = value[i] * w[i];
        sum += weighted * weighted;
    }
    return sqrt(sum / n);
}

// without the branch on the kind of a value in the norm of SUNDIALS
static double masked_norm(N_Vector x, N_Vector weight, N_Vector mask) {
    const double *const value = N_VGetArrayPointer(x), *const w = N_VGetArrayPointer(weight);
    const double *const kind = N_VGetArrayPointer(mask);
    const int n = (int)N_VGetLength(x);
    double sum = 0;
    for (int i = 0; i < n; i++) {
        const double weighted = value[i] * w[i];
        sum += kind[i] > 0 ? weighted * weighted : 0;
    }
    return sqrt(sum / n);
}

static WIDE(void, add_products, (int n, double a, const double *x, double b, const double *y, double *z),
            (n, a, x, b, y, z)) {
    for (int i = 0; i < n; i++) z[i] = a * x[i] + b * y[i];
}

// with the vectors of the processor, unlike the libraries of distributions; factors of one size, except 1, multiply the
// sum, as in the library
static void linear_sum(double a, N_Vector x, double b, N_Vector y, N_Vector z) {
    if (!(fabs(fabs(a) - fabs(b)) > 0) && fabs(fabs(a) - 1) > 0) {
        N_VLinearSum_Serial(a, x, b, y, z);
        return;
    }
    add_products((int)N_VGetLength(z), a, N_VGetArrayPointer(x), b, N_VGetArrayPointer(y), N_VGetArrayPointer(z));
}

static WIDE(void, multiply, (int n, double a, const double *x, double *z), (n, a, x, z)) {
    for (int i = 0; i < n; i++) z[i] = a * x[i];
}

static void scale(double a, N_Vector x, N_Vector z) {
    multiply((int)N_VGetLength(z), a, N_VGetArrayPointer(x), N_VGetArrayPointer(z));
}

/* An object and its kind, for the arena. */
struct sundials_owned {
    enum sundials_owned_kind kind;
    void *object;
};

static void release_owned(void *data) {
    struct sundials_owned *const owned = data;
    void *const object = owned->object;
    switch (owned->kind) {
        case OWNED_CONTEXT: SUNContext_Free(object); return;
        case OWNED_VECTOR: N_VDestroy(object); return;
        case OWNED_MATRIX: SUNMatDestroy(object); return;
        case OWNED_LINEAR: SUNLinSolFree(object); return;
        case OWNED_CUSTOM_LINEAR: SUNLinSolFreeEmpty(object); return;
        case OWNED_CUSTOM_NEWTON: SUNNonlinSolFreeEmpty(object); return;
        case OWNED_TABLEAU: ARKodeButcherTable_Free(object); return;
        case OWNED_ARKODE: ARKodeFree(&owned->object); return;
        case OWNED_IDA: IDAFree(&owned->object); return;
        case OWNED_KINSOL: KINFree(&owned->object); return;
    }
}

void *sundials_context_own(struct sundials_context *context, enum sundials_owned_kind kind, void *object) {
    // the place was requested before the object: a lack of memory loses no object
    struct sundials_owned *const owned = context->next;
    *owned = (struct sundials_owned){kind, arena_take(context->arena, object)};
    arena_defer(context->arena, release_owned, owned);
    NEW(context->arena, context->next, 1);
    return object;
}

N_Vector sundials_context_vector(struct sundials_context *context, double *values) {
    struct arena *const arena = context->arena;
    if (!values) NEW(arena, values, context->n);
    const N_Vector vector =
        arena_take(arena, context->threads > 1 ? N_VMake_OpenMP(context->n, values, context->threads, context->context)
                                               : N_VMake_Serial(context->n, values, context->context));

    if (context->threads == 1) {
        vector->ops->nvlinearsum = linear_sum;
        vector->ops->nvscale = scale;
    }
    vector->ops->nvwrmsnorm = norm;
    vector->ops->nvwrmsnormmask = masked_norm;
    return sundials_context_own(context, OWNED_VECTOR, vector);
}

void sundials_context_reserve(const struct sundials_context *context, int n) {
    // the vectors, and room for the small arrays of a package
    enum { STRUCTS = 2048, SMALL = 1 << 17 };
    void *volatile const needed = malloc((size_t)n * ((size_t)context->n * sizeof(double) + STRUCTS) + SMALL);
    free(needed);
    if (!needed) arena_lack(context->arena, 0);
}

/* The log of SUNDIALS, if an environment variable of SUNDIALS names a file for it, else NULL. The process has one: each
 * logger empties the files that it opens. */
static SUNLogger environment_logger(void) {
    static const char *const names[] = {"SUNLOGGER_ERROR_FILENAME", "SUNLOGGER_WARNING_FILENAME",
                                        "SUNLOGGER_INFO_FILENAME", "SUNLOGGER_DEBUG_FILENAME"};
    static SUNLogger logger;
    static bool is_known;
#pragma omp critical
    {
        bool is_wanted = false;
        for (size_t i = 0; i < sizeof names / sizeof *names; i++) is_wanted |= getenv(names[i]) != NULL;
        if (is_wanted && !is_known && SUNLogger_CreateFromEnv(SUN_COMM_NULL, &logger) != SUN_SUCCESS) logger = NULL;
        is_known = true;
    }
    return logger;
}

void sundials_context_create(struct sundials_context *context, struct arena *arena, int n, int threads,
                             enum status *failure) {
    *context = (struct sundials_context){.arena = arena_create(arena, "vectors of SUNDIALS"),
                                         .n = n,
                                         .threads = parallel_threads(threads, n, n, PARALLEL_ELEMENTS),
                                         .failure = failure};
    NEW(context->arena, context->next, 1);
    if (SUNContext_Create(SUN_COMM_NULL, &context->context) != SUN_SUCCESS) arena_lack(arena, 0);
    sundials_context_own(context, OWNED_CONTEXT, &context->context);
    // without a log, neither a logger nor the handler for it, because both print
    SUNLogger const logger = environment_logger();
    if (SUNContext_SetLogger(context->context, logger) != SUN_SUCCESS ||
        (!logger && SUNContext_ClearErrHandlers(context->context) != SUN_SUCCESS) ||
        SUNContext_PushErrHandler(context->context, sundials_context_message, failure) != SUN_SUCCESS) {
        arena_lack(arena, 0);
    }
}

void sundials_context_message(SUNDIALS_ERROR_ARGUMENTS) {
    const enum status *const failure = data;
    // drop warnings: relevant failures also return a code
    if (code < 0 && *failure == STATUS_OK) status_fail(STATUS_SOLVER, "%s (%s)", text, function);
}
