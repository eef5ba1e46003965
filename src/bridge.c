/* bridge.c: SUNDIALS objects around our arrays. */
#include "bridge.h"

#include <nvector/nvector_serial.h>
#include <string.h>
#include <sundials/sundials_context.h>
#include <sunlinsol/sunlinsol_klu.h>
#include <sunmatrix/sunmatrix_sparse.h>

enum status bridge_context(SUNContext *context) {
    if (SUNContext_Create(NULL, context) != 0) return status_fail(STATUS_MEMORY, "no room for the solvers");
    return STATUS_OK;
}

enum status bridge_vector(N_Vector *vector, SUNContext context, long n, double *values) {
    *vector = N_VMake_Serial(n, values, context);
    return *vector ? STATUS_OK : status_fail(STATUS_MEMORY, "no room for a vector of %ld unknowns", n);
}

enum status bridge_klu_create(struct bridge_klu *klu, SUNContext context, N_Vector like, long n) {
    *klu = (struct bridge_klu){.context = context, .like = like};
    klu->matrix = SUNSparseMatrix(n, n, 1, CSC_MAT, context);
    if (klu->matrix) klu->solver = SUNLinSol_KLU(like, klu->matrix, context);
    if (!klu->solver) {
        bridge_klu_free(klu);
        return status_fail(STATUS_MEMORY, "no room for a sparse matrix of order %ld", n);
    }
    return STATUS_OK;
}

void bridge_klu_free(struct bridge_klu *klu) {
    if (klu->solver) SUNLinSolFree(klu->solver);
    if (klu->matrix) SUNMatDestroy(klu->matrix);
    *klu = (struct bridge_klu){0};
}

enum status bridge_klu_copy(struct bridge_klu *klu, const struct sparse *from) {
    _Static_assert(sizeof(sunindextype) == sizeof(int64_t), "the indices of SUNDIALS and ours are of one size");
    if (klu->version != from->version) {
        if (SUNSparseMatrix_NNZ(klu->matrix) < from->n_nonzeros &&
            SUNSparseMatrix_Reallocate(klu->matrix, from->n_nonzeros) != 0) {
            return status_fail(STATUS_MEMORY, "no room for a Jacobian of %lld entries", (long long)from->n_nonzeros);
        }
        if (SUNLinSol_KLUReInit(klu->solver, klu->matrix, from->n_nonzeros, SUNKLU_REINIT_PARTIAL) != 0) {
            return status_fail(STATUS_MEMORY, "no room to analyse a Jacobian of %lld entries",
                               (long long)from->n_nonzeros);
        }
        klu->version = from->version;
    }
    memcpy(SUNSparseMatrix_IndexPointers(klu->matrix), from->column_start,
           ((size_t)from->n + 1) * sizeof *from->column_start);
    memcpy(SUNSparseMatrix_IndexValues(klu->matrix), from->row_index,
           (size_t)from->n_nonzeros * sizeof *from->row_index);
    memcpy(SUNSparseMatrix_Data(klu->matrix), from->value, (size_t)from->n_nonzeros * sizeof *from->value);
    return STATUS_OK;
}

void bridge_message(int code, const char *module, const char *function, char *text, void *data) {
    (void)data;
    // a warning needs no word: what matters comes back as a code
    if (code < 0) status_fail(STATUS_SOLVER, "%s (%s, %s)", text, module, function);
}
