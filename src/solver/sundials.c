/* sundials.c: vectors of SUNDIALS, serial ones or those of OpenMP, with a few operations of our own. The norms add the
 * values in their order, so that their bits do not depend on the number of threads; the sums are compiled for the
 * vectors of the processor; and clones belong to an arena. */
#include "solver/sundials.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/parallel.h"
#include "base/wide.h"

/* The content of a vector begins with the content that the operations of the library expect. */
struct content {
    union {
        struct _N_VectorContent_Serial serial;
        struct _N_VectorContent_OpenMP shared;
    } library;
    struct sundials_context *context;
};

static struct sundials_context *context_of(N_Vector vector) {
    return ((const struct content *)vector->content)->context;
}

// in the order of the values, whatever the number of threads
static double norm(N_Vector x, N_Vector weight) {
    const double *const value = N_VGetArrayPointer(x), *const w = N_VGetArrayPointer(weight);
    const int n = context_of(x)->n;
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
    const int n = context_of(x)->n;
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
    add_products(context_of(z)->n, a, N_VGetArrayPointer(x), b, N_VGetArrayPointer(y), N_VGetArrayPointer(z));
}

static WIDE(void, multiply, (int n, double a, const double *x, double *z), (n, a, x, z)) {
    for (int i = 0; i < n; i++) z[i] = a * x[i];
}

static void scale(double a, N_Vector x, N_Vector z) {
    multiply(context_of(z)->n, a, N_VGetArrayPointer(x), N_VGetArrayPointer(z));
}

// ---- vectors

static void release_vector(void *object) {
    const N_Vector vector = object;
    if (context_of(vector)->threads > 1) {
        N_VDestroy_OpenMP(vector);
    } else {
        N_VDestroy_Serial(vector);
    }
}

// the arena releases all vectors
static void keep(N_Vector vector) {
    (void)vector;
}

static N_Vector clone(N_Vector vector) {
    struct sundials_context *const context = context_of(vector);
    return context->n_spare > 0 ? context->spare[--context->n_spare] : sundials_context_vector(context, NULL);
}

N_Vector sundials_context_vector(struct sundials_context *context, double *values) {
    struct arena *const arena = context->arena;
    if (!values) NEW(arena, values, context->n);
    const N_Vector vector =
        arena_take(arena, context->threads > 1 ? N_VMake_OpenMP(context->n, values, context->threads, context->context)
                                               : N_VMake_Serial(context->n, values, context->context));

    // extend the content of the vector by the context
    struct content *const content = realloc(vector->content, sizeof *content);
    if (!content) {
        N_VDestroy(vector);
        arena_lack(arena, sizeof *content);
    }
    content->context = context;
    vector->content = content;
    vector->ops->nvclone = clone;
    vector->ops->nvdestroy = keep;
    if (context->threads == 1) {
        vector->ops->nvlinearsum = linear_sum;
        vector->ops->nvscale = scale;
    }
    vector->ops->nvwrmsnorm = norm;
    vector->ops->nvwrmsnormmask = masked_norm;
    return sundials_own(arena, release_vector, vector);
}

void sundials_context_reserve(struct sundials_context *context, int n) {
    GROW(context->arena, context->spare, n);
    while (context->n_spare < n) context->spare[context->n_spare++] = sundials_context_vector(context, NULL);
}

// ---- the context and its objects

void *sundials_own(struct arena *arena, void (*release)(void *object), void *object) {
    arena_defer(arena, release, arena_take(arena, object));
    return object;
}

void sundials_release_kinsol(void *kinsol) {
    KINFree(&kinsol);
}

void sundials_release_matrix(void *matrix) {
    SUNMatDestroy(matrix);
}

static void release_context(void *context) {
    SUNContext_Free(context);
}

void sundials_context_create(struct sundials_context *context, struct arena *arena, int n, int threads,
                             enum status *failure) {
    *context = (struct sundials_context){.arena = arena_create(arena, "vectors of SUNDIALS"),
                                         .n = n,
                                         .threads = parallel_threads(threads, n, n, PARALLEL_ELEMENTS),
                                         .failure = failure};
    if (SUNContext_Create(SUN_COMM_NULL, &context->context) != SUN_SUCCESS) arena_lack(arena, 0);
    sundials_own(context->arena, release_context, &context->context);
    // no logger, because a logger prints warnings
    if (SUNContext_SetLogger(context->context, NULL) != SUN_SUCCESS ||
        SUNContext_ClearErrHandlers(context->context) != SUN_SUCCESS ||
        SUNContext_PushErrHandler(context->context, sundials_context_message, failure) != SUN_SUCCESS) {
        arena_lack(arena, 0);
    }
}

void sundials_context_message(SUNDIALS_ERROR_ARGUMENTS) {
    enum status *const failure = data;
    // drop warnings: relevant failures also return a code
    if (code >= 0 || *failure != STATUS_OK) return;
    // all packages use these words where an allocation has failed, each with a code of its own
    if (strstr(text, "memory request failed")) {
        *failure = status_fail(STATUS_MEMORY, "out of memory: SUNDIALS (%s)", function);
    } else {
        status_fail(STATUS_SOLVER, "%s (%s)", text, function);
    }
}

enum status sundials_context_failed(const struct sundials_context *context, const char *package) {
    if (*context->failure != STATUS_OK) return *context->failure;
    return status_fail(STATUS_SOLVER, "%s cannot be set up: %s", package, status_message());
}
