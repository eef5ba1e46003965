/* sparse_factors.c: KLU, and when its pivots are chosen again. */
#include "solver/sparse_factors.h"

#include <klu.h>
#include <stdlib.h>

/* A pivot is the diagonal entry, which keeps the factors sparse, if that is at least this fraction of the largest entry
 * of its column: KLU's default. Where the reciprocal pivot growth then is below the minimum, the digits that are left
 * may be too few for Newton's iteration, as in soft rods of many nodes, and pivots are the largest entries instead. */
static const double diagonal_tolerance = 1e-3, min_growth = 1e-6;

/* The pivots of an earlier matrix are kept while the reciprocal condition estimate and the reciprocal pivot growth are
 * at least this fraction of what they were when the pivots were chosen. */
static const double min_quality = 1e-3;

struct sparse_factors {
    int n;
    unsigned version; /* of the pattern that is analysed; 0: none */
    klu_l_common common;
    klu_l_symbolic *symbolic;
    klu_l_numeric *numeric;
    double rcond, rgrowth; /* when the pivots were chosen */
    struct sparse_factors_counts counts;
};

enum status sparse_factors_create(struct sparse_factors **factors) {
    *factors = calloc(1, sizeof **factors);
    if (!*factors) return status_fail(STATUS_MEMORY, "out of memory: factors of a sparse matrix");
    klu_l_defaults(&(*factors)->common);
    return STATUS_OK;
}

void sparse_factors_free(struct sparse_factors *factors) {
    if (!factors) return;
    klu_l_free_numeric(&factors->numeric, &factors->common);
    klu_l_free_symbolic(&factors->symbolic, &factors->common);
    free(factors);
}

// factorise with the pivots of the last factorisation; returns whether the factors are good
static int refactor(struct sparse_factors *factors, const struct sparse_columns *matrix) {
    if (!factors->numeric) return 0;
    klu_l_common *const common = &factors->common;
    factors->counts.refactorisations++;
    return klu_l_refactor(matrix->start, matrix->row, matrix->value, factors->symbolic, factors->numeric, common) &&
           klu_l_rcond(factors->symbolic, factors->numeric, common) && common->rcond >= min_quality * factors->rcond &&
           klu_l_rgrowth(matrix->start, matrix->row, matrix->value, factors->symbolic, factors->numeric, common) &&
           common->rgrowth >= min_quality * factors->rgrowth;
}

// choose pivots: of at least this fraction of the largest entry
static enum status factor(struct sparse_factors *factors, const struct sparse_columns *matrix, double tolerance) {
    klu_l_common *const common = &factors->common;
    klu_l_free_numeric(&factors->numeric, common);
    common->tol = tolerance;
    factors->counts.factorisations++;
    factors->numeric = klu_l_factor(matrix->start, matrix->row, matrix->value, factors->symbolic, common);
    if (!factors->numeric) return common->status == KLU_OUT_OF_MEMORY ? STATUS_MEMORY : STATUS_SOLVER;
    klu_l_rcond(factors->symbolic, factors->numeric, common);
    factors->rcond = common->rcond;
    klu_l_rgrowth(matrix->start, matrix->row, matrix->value, factors->symbolic, factors->numeric, common);
    factors->rgrowth = common->rgrowth;
    return STATUS_OK;
}

enum status sparse_factors_set_up(struct sparse_factors *factors, const struct sparse_columns *matrix) {
    if (factors->version != matrix->version) {
        klu_l_free_numeric(&factors->numeric, &factors->common);
        klu_l_free_symbolic(&factors->symbolic, &factors->common);
        factors->counts.analyses++;
        factors->symbolic = klu_l_analyze(matrix->n, matrix->start, matrix->row, &factors->common);
        factors->version = matrix->version;
        factors->n = matrix->n;
    }
    // a matrix that cannot be analysed is structurally singular, or there is no memory
    if (!factors->symbolic) {
        factors->version = 0;
        return factors->common.status == KLU_OUT_OF_MEMORY ? STATUS_MEMORY : STATUS_SOLVER;
    }
    if (refactor(factors, matrix)) return STATUS_OK;
    const enum status status = factor(factors, matrix, diagonal_tolerance);
    return status == STATUS_OK && factors->rgrowth < min_growth ? factor(factors, matrix, 1) : status;
}

void sparse_factors_solve(struct sparse_factors *factors, double *x) {
    klu_l_solve(factors->symbolic, factors->numeric, factors->n, 1, x, &factors->common);
}

struct sparse_factors_counts sparse_factors_count(const struct sparse_factors *factors) {
    return factors->counts;
}
