/* fish_factors.c: the rod is eliminated from the block of a fish by KLU, and the Schur complement of the sheet, which
 * is full, is factorised densely. */
#include "solver/fish_factors.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "base/wide.h"
#include "solver/dense_factors.h"
#include "solver/sparse_factors.h"

/* If eliminating the rod makes a column of S grow by more than 1/min_growth, too many digits are lost, and KLU
 * factorises the whole block. */
static const double min_growth = SPARSE_MIN_GROWTH;

/* Without momenta, sheets with at least MIN_POINTS points are treated as full; with fewer, KLU is nearly as fast. KLU
 * solves AT_ONCE right-hand sides at a time. */
enum { MIN_POINTS = 100, AT_ONCE = 4 };

struct fish_factors {
    struct arena *arena;
    const struct fish *fish;
    const struct sparse *block;
    enum status status; /* of the last set-up */
    bool was_factorised;
    struct sparse_factors *whole;

    /* What follows is used only if the block may be divided. The rows of A are the first rows of the block, and its
     * columns begin with column first; in_parts: whether the last set-up divided the block. */
    bool may_divide, in_parts;
    struct sparse_factors *a;
    unsigned version; /* version of the divided pattern; 0: none */
    int first, n_rod, n_sheet;
    int64_t *split;             /* start of the rows of the sheet in each column of the block  (n) */
    struct sparse_columns rod;  /* A */
    struct dense_factors schur; /* S, later the factors of S                         (order n_sheet) */
    double *row_scale;          /* one over the largest entry of each row of the block         (n) */
    int first_full, n_full;     /* the columns of A below which C is nearly full */
    double *full;               /* -C of these columns                               (n_full, n_sheet) */
    double *x_rod, *x_sheet;    /* solutions                               (AT_ONCE, n_rod), (n_sheet) */
};

struct fish_factors *fish_factors_create(struct arena *arena, const struct fish *fish, const struct sparse *block) {
    struct fish_factors *factors;
    NEW(arena, factors, 1);
    factors->arena = arena;
    factors->fish = fish;
    factors->block = block;
    // where the law of motion is as full as the rows of the sheet, the positions count among the last columns
    const bool is_full = fish_is_loaded_by_sheet(fish);
    factors->first = is_full ? fish->at.vx - fish->at.x : 0;
    factors->n_rod = fish->at.full - fish->at.x;
    factors->n_sheet = block->n - factors->n_rod;
    factors->whole = sparse_factors_create(arena);
    factors->may_divide = is_full || fish->n_sheet >= MIN_POINTS;
    if (!factors->may_divide) return factors;

    factors->a = sparse_factors_create(arena);
    NEW(arena, factors->split, block->n);
    NEW(arena, factors->rod.start, factors->n_rod + 1);
    factors->schur = dense_factors_create(arena, factors->n_sheet);
    NEW(arena, factors->row_scale, block->n);
    NEW(arena, factors->x_rod, AT_ONCE * factors->n_rod);
    NEW(arena, factors->x_sheet, factors->n_sheet);
    return factors;
}

// number in the block of column k of the sheet
static int sheet_column(const struct fish_factors *factors, int k) {
    return k < factors->first ? k : k + factors->n_rod;
}

void fish_factors_prepare(struct fish_factors *factors) {
    const struct sparse *const block = factors->block;
    struct sparse_columns *const rod = &factors->rod;
    if (!factors->may_divide || factors->version == block->version) return;

    // where the rows of the sheet begin in each column
    for (int c = 0; c < block->n; c++) {
        int64_t i = block->column_start[c];
        while (i < block->column_start[c + 1] && block->row_index[i] < factors->n_rod) i++;
        factors->split[c] = i;
    }

    // the pattern of A
    for (int c = 0; c < factors->n_rod; c++) {
        const int column = factors->first + c;
        rod->start[c + 1] = rod->start[c] + factors->split[column] - block->column_start[column];
    }
    GROW(factors->arena, rod->row, rod->start[factors->n_rod]);
    GROW(factors->arena, rod->value, rod->start[factors->n_rod]);
    for (int c = 0; c < factors->n_rod; c++) {
        const int64_t *const from = block->row_index + block->column_start[factors->first + c];
        memcpy(rod->row + rod->start[c], from, (size_t)(rod->start[c + 1] - rod->start[c]) * sizeof *from);
    }

    // the longest run of columns in which C has at least half of its rows
    int run = 0;
    factors->n_full = 0;
    for (int c = 0; c < factors->n_rod; c++) {
        const int column = factors->first + c;
        run = 2 * (block->column_start[column + 1] - factors->split[column]) > factors->n_sheet ? run + 1 : 0;
        if (run <= factors->n_full) continue;
        factors->n_full = run;
        factors->first_full = c + 1 - run;
    }
    GROW(factors->arena, factors->full, (size_t)factors->n_full * (size_t)factors->n_sheet);
    rod->n = factors->n_rod;
    rod->version = factors->version = block->version;
}

// y -= A x for one column. Rows up to the last gap are done one by one; the rest are neighbours and vectorise.
static inline __attribute__((always_inline)) void subtract_column(const struct sparse *block, int64_t start,
                                                                  int64_t end, int64_t first_row, double x,
                                                                  double *restrict y) {
    const int64_t *const row = block->row_index;
    for (; start < end && row[end - 1] - row[start] > end - 1 - start; start++) {
        y[row[start] - first_row] -= block->value[start] * x;
    }
    if (start == end) return;

    const double *const value = block->value + start;
    double *const to = y + row[start] - first_row;
    for (int64_t i = 0; i < end - start; i++) to[i] -= value[i] * x;
}

// subtract C x from the rows of the sheet, leaving out n_left columns from first_left on; x: unknowns of the rod
static WIDE(void, subtract_rod,
            (const struct fish_factors *factors, const double *x, int first_left, int n_left, double *rows),
            (factors, x, first_left, n_left, rows)) {
    const struct sparse *const block = factors->block;
    for (int c = 0; c < factors->n_rod; c++) {
        if (x[c] == 0 || (c >= first_left && c < first_left + n_left)) continue;
        const int column = factors->first + c;
        subtract_column(block, factors->split[column], block->column_start[column + 1], factors->n_rod, x[c], rows);
    }
}

// subtract B y from the rows of the rod; y: unknowns of the sheet
static WIDE(void, subtract_sheet, (const struct fish_factors *factors, const double *y, double *rows),
            (factors, y, rows)) {
    const struct sparse *const block = factors->block;
    for (int k = 0; k < factors->n_sheet; k++) {
        const int column = sheet_column(factors, k);
        subtract_column(block, block->column_start[column], factors->split[column], 0, y[k], rows);
    }
}

// Find n columns of S from column first on, n <= AT_ONCE. Returns how much the elimination lets them grow: the smallest
// ratio of the largest entry of a column before and after, in units of the rows.
static double fill_columns(struct fish_factors *factors, int first, int n) {
    const struct sparse *const block = factors->block;
    double before[AT_ONCE] = {0}, least = 1;
    bool has_rod = false;
    memset(factors->x_rod, 0, (size_t)n * (size_t)factors->n_rod * sizeof *factors->x_rod);

    for (int k = 0; k < n; k++) {
        const int column = sheet_column(factors, first + k);
        double *const s = (factors->schur.value + (long)(first + k) * factors->schur.stride), *const x =
                                                                                                  factors->x_rod +
                                                                                                  k * factors->n_rod;
        memset(s, 0, (size_t)factors->schur.stride * sizeof *s);
        for (int64_t i = block->column_start[column]; i < block->column_start[column + 1]; i++) {
            const int64_t row = block->row_index[i];
            const double size = fabs(block->value[i]) * factors->row_scale[row];
            before[k] = size > before[k] ? size : before[k];
            *(row < factors->n_rod ? x + row : s + row - factors->n_rod) = block->value[i];
        }
        has_rod |= factors->split[column] > block->column_start[column];
    }

    if (has_rod) sparse_factors_solve(factors->a, n, factors->x_rod);
    for (int k = 0; k < n; k++) {
        double *const s = (factors->schur.value + (long)(first + k) * factors->schur.stride);
        if (has_rod) subtract_rod(factors, factors->x_rod + k * factors->n_rod, 0, 0, s);
        double after = 0;
        for (int r = 0; r < factors->n_sheet; r++) {
            const double size = fabs(s[r]) * factors->row_scale[factors->n_rod + r];
            after = size > after ? size : after;
        }
        if (after > 0) least = fmin(least, before[k] / after);
    }
    return least;
}

// set up the factors in parts; STATUS_RETRY if A is singular or nearly so
static enum status factors_set_up_parts(struct fish_factors *factors) {
    const struct sparse *const block = factors->block;
    const struct sparse_columns *const rod = &factors->rod;
    const int n = factors->n_sheet;

    // take the values of A, the scale of each row, and -C where C is nearly full
    for (int c = 0; c < factors->n_rod; c++) {
        const double *const from = block->value + block->column_start[factors->first + c];
        memcpy(rod->value + rod->start[c], from, (size_t)(rod->start[c + 1] - rod->start[c]) * sizeof *from);
    }
    memset(factors->row_scale, 0, (size_t)block->n * sizeof *factors->row_scale);
    for (int64_t i = 0; i < block->n_nonzeros; i++) {
        double *const scale = &factors->row_scale[block->row_index[i]];
        const double size = fabs(block->value[i]);
        *scale = size > *scale ? size : *scale;
    }
    for (int r = 0; r < block->n; r++) factors->row_scale[r] = 1 / factors->row_scale[r];
    memset(factors->full, 0, (size_t)factors->n_full * (size_t)n * sizeof *factors->full);
    for (int c = 0; c < factors->n_full; c++) {
        const int column = factors->first + factors->first_full + c;
        double *const to = factors->full + (long)c * n;
        for (int64_t i = factors->split[column]; i < block->column_start[column + 1]; i++) {
            to[block->row_index[i] - factors->n_rod] = -block->value[i];
        }
    }

    if (!sparse_factors_set_up(factors->a, rod)) return STATUS_RETRY;
    for (int k = 0; k < n; k += AT_ONCE) {
        if (fill_columns(factors, k, k + AT_ONCE < n ? AT_ONCE : n - k) < min_growth) return STATUS_RETRY;
    }
    return dense_factors_set_up(&factors->schur) ? STATUS_OK : STATUS_SOLVER;
}

void fish_factors_set_up(struct fish_factors *factors) {
    const struct sparse *const block = factors->block;
    enum status status = factors->may_divide ? factors_set_up_parts(factors) : STATUS_RETRY;
    factors->in_parts = status == STATUS_OK;

    // factorise the whole block instead; later values may be divided again, with new pivots
    if (status == STATUS_RETRY && !(factors->may_divide && sparse_factors_lack_memory(factors->a))) {
        const struct sparse_columns whole = {block->n, block->version, block->column_start, block->row_index,
                                             block->value};
        if (factors->may_divide) sparse_factors_forget(factors->a);
        status = sparse_factors_set_up(factors->whole, &whole) ? STATUS_OK : STATUS_SOLVER;
    }
    factors->status = status == STATUS_SOLVER && factors->was_factorised ? STATUS_RETRY : status;
    factors->was_factorised |= status == STATUS_OK;
}

enum status fish_factors_status(const struct fish_factors *factors) {
    const struct sparse_factors *const parts[] = {factors->whole, factors->a};
    for (int i = 0; i < 2; i++) {
        if (parts[i] && sparse_factors_lack_memory(parts[i])) return status_fail(STATUS_MEMORY, "out of memory: KLU");
    }
    return factors->status;
}

void fish_factors_solve(struct fish_factors *factors, double *x) {
    if (!factors->in_parts) {
        sparse_factors_solve(factors->whole, 1, x);
        return;
    }

    // unknowns of the sheet: S y = d - C A^-1 b
    const int n = factors->n_sheet;
    double *const rod = factors->x_rod, *const sheet = factors->x_sheet;
    memcpy(rod, x, (size_t)factors->n_rod * sizeof *rod);
    memcpy(sheet, x + factors->n_rod, (size_t)n * sizeof *sheet);
    sparse_factors_solve(factors->a, 1, rod);
    subtract_rod(factors, rod, factors->first_full, factors->n_full, sheet);
    wide_multiply(n, factors->n_full, factors->full, rod + factors->first_full, sheet);
    dense_factors_solve(&factors->schur, sheet);

    // unknowns of the rod: A z = b - B y
    memcpy(rod, x, (size_t)factors->n_rod * sizeof *rod);
    subtract_sheet(factors, sheet, rod);
    sparse_factors_solve(factors->a, 1, rod);
    memcpy(x + factors->first, rod, (size_t)factors->n_rod * sizeof *rod);
    for (int k = 0; k < n; k++) x[sheet_column(factors, k)] = sheet[k];
}

void fish_factors_count(const struct fish_factors *factors, struct klu_counts *counts) {
    sparse_factors_count(factors->whole, counts);
    if (factors->a) sparse_factors_count(factors->a, counts);
}

long fish_factors_non_zeros(const struct fish_factors *factors) {
    const long full = factors->in_parts ? (long)factors->n_sheet * factors->n_sheet : 0;
    return sparse_factors_non_zeros(factors->in_parts ? factors->a : factors->whole) + full;
}
