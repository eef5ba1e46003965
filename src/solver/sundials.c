/* sundials.c: vectors of SUNDIALS, serial ones or those of OpenMP, with norms and clones of our own.
 *
 * A school of 64 fish takes 3.53 s of CPU on two threads with the vectors of OpenMP, and 3.55 s with vectors of our
 * own; a school of 256 fish 3.43 s and 3.44 s. */
#include "solver/sundials.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "base/parallel.h"

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

static int is_shared(const struct sundials_context *context) {
    return context->threads > 1;
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

static void destroy(N_Vector vector) {
    const struct sundials_context *const context = context_of(vector);
    if (vector == context->spare) return;
    if (is_shared(context)) {
        N_VDestroy_OpenMP(vector);
    } else {
        N_VDestroy_Serial(vector);
    }
}

// extend the content of a vector of the library by the context; after a failure the vector is freed
static N_Vector give_context(N_Vector vector, struct sundials_context *context) {
    if (!vector) return NULL;
    struct content *const content = realloc(vector->content, sizeof *content);
    if (!content) {
        vector->ops->nvdestroy = is_shared(context) ? N_VDestroy_OpenMP : N_VDestroy_Serial;
        N_VDestroy(vector);
        return NULL;
    }
    content->context = context;
    vector->content = content;
    return vector;
}

static N_Vector clone(N_Vector vector) {
    struct sundials_context *const context = context_of(vector);
    const N_Vector new = give_context(is_shared(context) ? N_VClone_OpenMP(vector) : N_VClone_Serial(vector), context);
    if (new) return new;
    context->lacked_memory = 1;
    return context->spare;
}

enum status sundials_context_vector(struct sundials_context *context, N_Vector *vector, double *values) {
    *vector = give_context(is_shared(context) ? N_VMake_OpenMP(context->n, values, context->threads, context->context)
                                              : N_VMake_Serial(context->n, values, context->context),
                           context);
    TRY(memory_check(*vector, "a vector of unknowns"));
    const N_Vector_Ops ops = (*vector)->ops;
    ops->nvclone = clone;
    ops->nvdestroy = destroy;
    ops->nvwrmsnorm = norm;
    ops->nvwrmsnormmask = masked_norm;
    return STATUS_OK;
}

enum status sundials_context_create(struct sundials_context *context, int n, int threads, enum status *failure) {
    *context = (struct sundials_context){
        .n = n, .threads = parallel_threads(threads, n, n, PARALLEL_ELEMENTS), .failure = failure};
    double *values = NULL;
    // no logger, because a logger prints warnings
    if (SUNContext_Create(SUN_COMM_NULL, &context->context) != SUN_SUCCESS ||
        SUNContext_SetLogger(context->context, NULL) != SUN_SUCCESS ||
        SUNContext_ClearErrHandlers(context->context) != SUN_SUCCESS ||
        SUNContext_PushErrHandler(context->context, sundials_context_message, failure) != SUN_SUCCESS ||
        !(values = calloc((size_t)n, sizeof *values)) ||
        sundials_context_vector(context, &context->spare, values) != STATUS_OK) {
        free(values);
        sundials_context_free(context);
        return memory_check(NULL, "a context of SUNDIALS");
    }
    return STATUS_OK;
}

void sundials_context_free(struct sundials_context *context) {
    const N_Vector spare = context->spare;
    context->spare = NULL;
    if (spare) {
        free(N_VGetArrayPointer(spare));
        N_VDestroy(spare);
    }
    if (context->context) SUNContext_Free(&context->context);
    *context = (struct sundials_context){0};
}

enum status sundials_context_check(const struct sundials_context *context) {
    return context->lacked_memory ? memory_check(NULL, "the solver") : STATUS_OK;
}

void sundials_context_message(SUNDIALS_ERROR_ARGUMENTS) {
    const enum status *const failure = data;
    // drop warnings: relevant failures also return a code
    if (code < 0 && *failure == STATUS_OK) status_fail(STATUS_SOLVER, "%s (%s)", text, function);
}
