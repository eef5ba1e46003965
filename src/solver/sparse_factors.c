/* sparse_factors.c: KLU, and when to choose new pivots. */
#include "solver/sparse_factors.h"

#include <klu.h>
#include <stdbool.h>

/* Pivots on the diagonal keep the factors sparse. One is used if it is at least diagonal_tolerance (the default of KLU)
 * times the largest entry of its column. If the reciprocal pivot growth then falls below SPARSE_MIN_GROWTH, as it does
 * in soft rods of many nodes, the solution has too few digits for Newton's iteration, and the largest entries become
 * the pivots. */
static const double diagonal_tolerance = 1e-3;

/* Pivots of an earlier matrix are kept while the estimate of the reciprocal condition number and the reciprocal pivot
 * growth are at least this fraction of what they were when the pivots were chosen. */
static const double min_quality = 1e-3;

struct sparse_factors {
    int n;
    unsigned version; /* version of the analysed pattern; 0: none */
    klu_l_common common;
    klu_l_symbolic *symbolic;
    klu_l_numeric *numeric;
    bool lacks_memory;     /* KLU had no memory for the last set-up */
    double rcond, rgrowth; /* when the pivots were chosen */
    struct klu_counts counts;
};

static void release_sparse_factors(void *object) {
    struct sparse_factors *const factors = object;
    klu_l_free_numeric(&factors->numeric, &factors->common);
    klu_l_free_symbolic(&factors->symbolic, &factors->common);
}

struct sparse_factors *sparse_factors_create(struct arena *arena) {
    struct sparse_factors *factors;
    NEW(arena, factors, 1);
    klu_l_defaults(&factors->common);
    arena_defer(arena, release_sparse_factors, factors);
    return factors;
}

// choose pivots of at least this fraction (tolerance) of the largest entry of their column; returns whether the matrix
// is regular
static bool sparse_factor(struct sparse_factors *factors, const struct sparse_columns *matrix, double tolerance) {
    klu_l_common *const common = &factors->common;
    klu_l_free_numeric(&factors->numeric, common);
    common->tol = tolerance;
    factors->counts.factorisations++;
    factors->numeric = klu_l_factor(matrix->start, matrix->row, matrix->value, factors->symbolic, common);
    factors->lacks_memory = !factors->numeric && common->status == KLU_OUT_OF_MEMORY;
    if (!factors->numeric) return false;
    klu_l_rcond(factors->symbolic, factors->numeric, common);
    factors->rcond = common->rcond;
    klu_l_rgrowth(matrix->start, matrix->row, matrix->value, factors->symbolic, factors->numeric, common);
    factors->rgrowth = common->rgrowth;
    return true;
}

bool sparse_factors_set_up(struct sparse_factors *factors, const struct sparse_columns *matrix) {
    klu_l_common *const common = &factors->common;
    if (factors->version != matrix->version) {
        klu_l_free_numeric(&factors->numeric, common);
        klu_l_free_symbolic(&factors->symbolic, common);
        factors->counts.analyses++;
        factors->symbolic = klu_l_analyze(matrix->n, matrix->start, matrix->row, common);
        factors->lacks_memory = !factors->symbolic && common->status == KLU_OUT_OF_MEMORY;
        if (factors->lacks_memory) return false;
        factors->version = matrix->version;
        factors->n = matrix->n;
    }
    // KLU analyses every pattern but those of structurally singular matrices
    if (!factors->symbolic) return false;

    // try the last pivots first
    if (factors->numeric) {
        factors->counts.refactorisations++;
        if (klu_l_refactor(matrix->start, matrix->row, matrix->value, factors->symbolic, factors->numeric, common) &&
            klu_l_rcond(factors->symbolic, factors->numeric, common) && common->rcond >= min_quality * factors->rcond &&
            klu_l_rgrowth(matrix->start, matrix->row, matrix->value, factors->symbolic, factors->numeric, common) &&
            common->rgrowth >= min_quality * factors->rgrowth) {
            return true;
        }
    }
    if (!sparse_factor(factors, matrix, diagonal_tolerance)) return false;
    return factors->rgrowth >= SPARSE_MIN_GROWTH || sparse_factor(factors, matrix, 1);
}

void sparse_factors_solve(struct sparse_factors *factors, int n_sides, double *x) {
    klu_l_solve(factors->symbolic, factors->numeric, factors->n, n_sides, x, &factors->common);
}

void sparse_factors_forget(struct sparse_factors *factors) {
    klu_l_free_numeric(&factors->numeric, &factors->common);
}

bool sparse_factors_lack_memory(const struct sparse_factors *factors) {
    return factors->lacks_memory;
}

void sparse_factors_count(const struct sparse_factors *factors, struct klu_counts *counts) {
    counts->analyses += factors->counts.analyses;
    counts->factorisations += factors->counts.factorisations;
    counts->refactorisations += factors->counts.refactorisations;
}

long sparse_factors_non_zeros(const struct sparse_factors *factors) {
    const klu_l_numeric *const numeric = factors->numeric;
    if (!numeric) return 0;
    // KLU also counts the ones on the diagonal of L
    return (long)numeric->lnz + (long)numeric->unz + (long)numeric->nzoff - (long)factors->n;
}
