/* fish_factors.c: elimination of the rod, and the full matrix that is left. */
#include "solver/fish_factors.h"

#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Sheets of at least this many points are eliminated by LAPACK. With fewer, KLU is nearly as fast. */
enum { MIN_POINTS = 100 };

/* KLU takes all if the elimination of the rod without the sheet makes the entries of a column grow by more than the
 * inverse of this: as in sparse_factors.c, the digits that are left may be too few. */
static const double min_growth = 1e-6;

struct fish_factors {
    const struct fish *fish;
    const struct sparse *block;
    int was_factorised;
    struct sparse_factors *whole;

    /* in parts: the rows of A are the first of the block, its columns begin with first */
    int in_parts;
    struct sparse_factors *a;
    unsigned version; /* of the pattern that is divided; 0: none */
    int first, n_rod, n_sheet;
    int64_t *split;            /* where rows of the sheet begin in the columns of the block   (n) */
    struct sparse_columns rod; /* A; owned */
    double *schur;             /* S, then its factors                        (n_sheet, n_sheet), by columns */
    lapack_int *pivot;         /* (n_sheet) */
    double *row_scale;         /* the largest entry of each row of the block                  (n) */
    double *x_rod, *x_sheet;   /* room for solutions                               (n_rod), (n_sheet) */
};

static int is_large(const struct fish_factors *factors) {
    return factors->fish->n_sheet >= MIN_POINTS;
}

void fish_factors_free(struct fish_factors *factors) {
    if (!factors) return;
    sparse_factors_free(factors->whole);
    sparse_factors_free(factors->a);
    free(factors->split);
    free(factors->rod.start);
    free(factors->rod.row);
    free(factors->rod.value);
    free(factors->schur);
    free(factors->pivot);
    free(factors->row_scale);
    free(factors->x_rod);
    free(factors->x_sheet);
    free(factors);
}

// for the parts, but the entries of A
static enum status make_room(struct fish_factors *factors) {
    TRY(sparse_factors_create(&factors->a));
    const size_t n_rod = (size_t)factors->n_rod, n_sheet = (size_t)factors->n_sheet, n = n_rod + n_sheet;
    factors->split = calloc(n, sizeof *factors->split);
    factors->rod.start = calloc(n_rod + 1, sizeof *factors->rod.start);
    factors->schur = calloc(n_sheet * n_sheet, sizeof *factors->schur);
    factors->pivot = calloc(n_sheet, sizeof *factors->pivot);
    factors->row_scale = calloc(n, sizeof *factors->row_scale);
    factors->x_rod = calloc(n_rod, sizeof *factors->x_rod);
    factors->x_sheet = calloc(n_sheet, sizeof *factors->x_sheet);
    const int has_all = factors->split && factors->rod.start && factors->schur && factors->pivot &&
                        factors->row_scale && factors->x_rod && factors->x_sheet;
    return has_all ? STATUS_OK : STATUS_MEMORY;
}

enum status fish_factors_create(struct fish_factors **factors, const struct fish *fish, const struct sparse *block) {
    *factors = NULL;
    struct fish_factors *const new = calloc(1, sizeof *new);
    if (!new || sparse_factors_create(&new->whole) != STATUS_OK) goto no_memory;
    new->fish = fish;
    new->block = block;
    // with momenta the law of motion is as full as the rows of the sheet, and with it the places are left to the last
    const int is_full = fish_has_momentum(fish);
    new->first = is_full ? fish->at.vx - fish->at.x : 0;
    new->n_rod = (is_full ? fish->at.ax : fish->at.gamma) - fish->at.x;
    new->n_sheet = block->n - new->n_rod;
    if (is_large(new) && make_room(new) != STATUS_OK) goto no_memory;
    *factors = new;
    return STATUS_OK;

no_memory:
    fish_factors_free(new);
    return status_fail(STATUS_MEMORY, "out of memory: factors of the %d unknowns of fish %s", block->n, fish->name);
}

// the column of the block that is column k of the sheet
static int sheet_column(const struct fish_factors *factors, int k) {
    return k < factors->first ? k : k + factors->n_rod;
}

// find where the parts lie in the columns of the block, and the pattern of A
static enum status divide(struct fish_factors *factors) {
    const struct sparse *const block = factors->block;
    struct sparse_columns *const rod = &factors->rod;
    for (int c = 0; c < block->n; c++) {
        int64_t i = block->column_start[c];
        while (i < block->column_start[c + 1] && block->row_index[i] < factors->n_rod) i++;
        factors->split[c] = i;
    }
    for (int c = 0; c < factors->n_rod; c++) {
        const int column = factors->first + c;
        rod->start[c + 1] = rod->start[c] + factors->split[column] - block->column_start[column];
    }
    const size_t n_entries = (size_t)rod->start[factors->n_rod] + 1;
    free(rod->row);
    free(rod->value);
    rod->row = calloc(n_entries, sizeof *rod->row);
    rod->value = calloc(n_entries, sizeof *rod->value);
    if (!rod->row || !rod->value) return STATUS_MEMORY;
    for (int c = 0; c < factors->n_rod; c++) {
        const int64_t *const from = block->row_index + block->column_start[factors->first + c];
        memcpy(rod->row + rod->start[c], from, (size_t)(rod->start[c + 1] - rod->start[c]) * sizeof *from);
    }
    rod->n = factors->n_rod;
    rod->version = factors->version = block->version;
    factors->in_parts = 1;
    return STATUS_OK;
}

static void take_values(struct fish_factors *factors) {
    const struct sparse *const block = factors->block;
    const struct sparse_columns *const rod = &factors->rod;
    for (int c = 0; c < factors->n_rod; c++) {
        const double *const from = block->value + block->column_start[factors->first + c];
        memcpy(rod->value + rod->start[c], from, (size_t)(rod->start[c + 1] - rod->start[c]) * sizeof *from);
    }
    memset(factors->row_scale, 0, (size_t)block->n * sizeof *factors->row_scale);
    for (int64_t i = 0; i < block->n_nonzeros; i++) {
        double *const scale = &factors->row_scale[block->row_index[i]];
        *scale = fmax(*scale, fabs(block->value[i]));
    }
}

// subtract C x from rows of the sheet; x are unknowns of the rod
static void subtract_rod(const struct fish_factors *factors, const double *x, double *rows) {
    const struct sparse *const block = factors->block;
    for (int c = 0; c < factors->n_rod; c++) {
        if (x[c] == 0) continue;
        const int column = factors->first + c;
        for (int64_t i = factors->split[column]; i < block->column_start[column + 1]; i++)
            rows[block->row_index[i] - factors->n_rod] -= block->value[i] * x[c];
    }
}

// column k of S; returns the largest entry of that column of the block over the largest of S, in units of the rows
static double fill_column(struct fish_factors *factors, int k) {
    const struct sparse *const block = factors->block;
    const int column = sheet_column(factors, k);
    const int64_t start = block->column_start[column], split = factors->split[column];
    double *const s = factors->schur + (size_t)k * (size_t)factors->n_sheet;
    double before = 0, after = 0;
    memset(s, 0, (size_t)factors->n_sheet * sizeof *s);
    memset(factors->x_rod, 0, (size_t)factors->n_rod * sizeof *factors->x_rod);
    for (int64_t i = start; i < block->column_start[column + 1]; i++) {
        const int64_t row = block->row_index[i];
        before = fmax(before, fabs(block->value[i]) / factors->row_scale[row]);
        if (i < split)
            factors->x_rod[row] = block->value[i];
        else
            s[row - factors->n_rod] = block->value[i];
    }
    if (split > start) {
        sparse_factors_solve(factors->a, factors->x_rod);
        subtract_rod(factors, factors->x_rod, s);
    }
    for (int r = 0; r < factors->n_sheet; r++) after = fmax(after, fabs(s[r]) / factors->row_scale[factors->n_rod + r]);
    return after > 0 ? before / after : 1;
}

// STATUS_RETRY: the rod cannot be eliminated, or not well
static enum status set_up_parts(struct fish_factors *factors) {
    take_values(factors);
    const enum status status = sparse_factors_set_up(factors->a, &factors->rod);
    if (status != STATUS_OK) return status == STATUS_MEMORY ? status : STATUS_RETRY;
    const int n = factors->n_sheet;
    for (int k = 0; k < n; k++) {
        if (fill_column(factors, k) < min_growth) return STATUS_RETRY;
    }
    const int is_singular = LAPACKE_dgetrf_work(LAPACK_COL_MAJOR, n, n, factors->schur, n, factors->pivot) != 0;
    return is_singular ? STATUS_SOLVER : STATUS_OK;
}

static enum status set_up(struct fish_factors *factors) {
    const struct sparse *const block = factors->block;
    if (is_large(factors) && factors->version != block->version) TRY(divide(factors));
    if (factors->in_parts) {
        const enum status status = set_up_parts(factors);
        if (status != STATUS_RETRY) return status;
        // the whole block, until it has another pattern
        factors->in_parts = 0;
    }
    return sparse_factors_set_up(factors->whole, &(struct sparse_columns){block->n, block->version, block->column_start,
                                                                          block->row_index, block->value});
}

enum status fish_factors_set_up(struct fish_factors *factors) {
    const enum status status = set_up(factors);
    if (status == STATUS_SOLVER && factors->was_factorised) return STATUS_RETRY;
    if (status == STATUS_OK) factors->was_factorised = 1;
    return status;
}

// unknowns of the sheet: S y = d - C A^-1 b; then those of the rod: A z = b - B y
static void solve_parts(struct fish_factors *factors, double *x) {
    const struct sparse *const block = factors->block;
    const int n = factors->n_sheet;
    double *const rod = factors->x_rod, *const sheet = factors->x_sheet;
    memcpy(rod, x, (size_t)factors->n_rod * sizeof *rod);
    memcpy(sheet, x + factors->n_rod, (size_t)n * sizeof *sheet);
    sparse_factors_solve(factors->a, rod);
    subtract_rod(factors, rod, sheet);
    LAPACKE_dgetrs_work(LAPACK_COL_MAJOR, 'N', n, 1, factors->schur, n, factors->pivot, sheet, n);
    memcpy(rod, x, (size_t)factors->n_rod * sizeof *rod);
    for (int k = 0; k < n; k++) {
        const int column = sheet_column(factors, k);
        for (int64_t i = block->column_start[column]; i < factors->split[column]; i++)
            rod[block->row_index[i]] -= block->value[i] * sheet[k];
    }
    sparse_factors_solve(factors->a, rod);
    memcpy(x + factors->first, rod, (size_t)factors->n_rod * sizeof *rod);
    for (int k = 0; k < n; k++) x[sheet_column(factors, k)] = sheet[k];
}

void fish_factors_solve(struct fish_factors *factors, double *x) {
    if (factors->in_parts)
        solve_parts(factors, x);
    else
        sparse_factors_solve(factors->whole, x);
}

struct sparse_factors_counts fish_factors_count(const struct fish_factors *factors) {
    struct sparse_factors_counts counts = sparse_factors_count(factors->whole);
    if (!factors->a) return counts;
    const struct sparse_factors_counts of_rod = sparse_factors_count(factors->a);
    counts.analyses += of_rod.analyses;
    counts.factorisations += of_rod.factorisations;
    counts.refactorisations += of_rod.refactorisations;
    return counts;
}
