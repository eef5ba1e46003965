/* dense_factors.c: Gaussian elimination by panels of columns. Tiles of the remaining matrix stay in registers while a
 * panel is applied to them, which is where the speed comes from. */
#include "solver/dense_factors.h"

#include <math.h>
#include <string.h>

#include "base/wide.h"
#include "solver/fish_factors.h"

/* Columns of a panel and rows of a tile; columns of a tile. */
enum { PANEL = 16, TILE_COLUMNS = 8 };

struct dense_factors dense_factors_create(struct arena *arena, int n) {
    struct dense_factors factors = {.n = n, .stride = (n + PANEL - 1) / PANEL * PANEL};
    NEW(arena, factors.value, (size_t)n * (size_t)factors.stride);
    NEW(arena, factors.pivot, n);
    return factors;
}

// eliminate the columns first to end - 1 below the diagonal; returns whether every pivot is finite and not 0
static WIDE(int, factor_panel, (const struct dense_factors *of, int first, int end), (of, first, end)) {
    const int n = of->n;
    for (int k = first; k < end; k++) {
        double *const column = of->value + (long)k * of->stride;
        int pivot = k;
        for (int r = k + 1; r < n; r++) pivot = fabs(column[r]) > fabs(column[pivot]) ? r : pivot;
        of->pivot[k] = pivot;
        if (!isfinite(column[pivot]) || !(fabs(column[pivot]) > 0)) return 0;

        for (int j = first; j < end && pivot != k; j++) {
            double *const other = of->value + (long)j * of->stride, swapped = other[k];
            other[k] = other[pivot];
            other[pivot] = swapped;
        }

        const double inverse = 1 / column[k];
        for (int r = k + 1; r < n; r++) column[r] *= inverse;
        for (int j = k + 1; j < end; j++) {
            double *const restrict other = of->value + (long)j * of->stride;
            const double factor = other[k];
            for (int r = k + 1; r < n; r++) other[r] -= factor * column[r];
        }
    }
    return 1;
}

// Apply the row swaps of a panel to another column. To the right of the panel also solve for the rows of the panel.
static WIDE(void, apply_panel, (const struct dense_factors *of, int first, int end, int j), (of, first, end, j)) {
    double *const restrict column = of->value + (long)j * of->stride;
    for (int k = first; k < end; k++) {
        const double swapped = column[k];
        column[k] = column[of->pivot[k]];
        column[of->pivot[k]] = swapped;
    }

    for (int k = first; k < end && j >= end; k++) {
        const double *const left = of->value + (long)k * of->stride;
        for (int r = k + 1; r < end; r++) column[r] -= column[k] * left[r];
    }
}

// subtract from a few rows below the panel the products of its rows with one tile of columns
static inline __attribute__((always_inline)) void subtract_tile(const struct dense_factors *of, int first, int row,
                                                                int column, const int n_columns) {
    const long stride = of->stride;
    const double *const left = of->value + first * stride + row, *const top = of->value + column * stride + first;
    double *const to = of->value + column * stride + row;
    wide_lanes sum[TILE_COLUMNS];

#pragma GCC unroll 8
    for (int c = 0; c < n_columns; c++) memcpy(&sum[c], to + c * stride, sizeof sum[c]);
    for (int k = 0; k < PANEL; k++) {
        wide_lanes rows;
        memcpy(&rows, left + k * stride, sizeof rows);
#pragma GCC unroll 8
        for (int c = 0; c < n_columns; c++) sum[c] -= top[c * stride + k] * rows;
    }
#pragma GCC unroll 8
    for (int c = 0; c < n_columns; c++) memcpy(to + c * stride, &sum[c], sizeof sum[c]);
}

WIDE(int, dense_factors_set_up, (struct dense_factors * factors), (factors)) {
    const int n = factors->n;
    for (int first = 0; first < n; first += PANEL) {
        const int end = first + PANEL < n ? first + PANEL : n;
        if (!factor_panel(factors, first, end)) return 0;
        for (int j = 0; j < n; j++) {
            if (j < first || j >= end) apply_panel(factors, first, end, j);
        }

        // all rows and columns behind the panel, which has PANEL columns here; the rows up to the stride are 0
        for (int row = end; end < n && row < factors->stride; row += WIDE_LANES) {
            int column = end;
            for (; column + TILE_COLUMNS <= n; column += TILE_COLUMNS) {
                subtract_tile(factors, first, row, column, TILE_COLUMNS);
            }
            for (; column < n; column++) subtract_tile(factors, first, row, column, 1);
        }
    }
    return 1;
}

WIDE(void, dense_factors_solve, (const struct dense_factors *factors, double *restrict x), (factors, x)) {
    const int n = factors->n;
    for (int k = 0; k < n; k++) {
        const double swapped = x[k];
        x[k] = x[factors->pivot[k]];
        x[factors->pivot[k]] = swapped;
    }

    for (int k = 0; k < n; k++) {
        const double *const column = factors->value + (long)k * factors->stride, factor = x[k];
        for (int r = k + 1; r < n; r++) x[r] -= factor * column[r];
    }
    for (int k = n - 1; k >= 0; k--) {
        const double *const column = factors->value + (long)k * factors->stride, factor = x[k] / column[k];
        x[k] = factor;
        for (int r = 0; r < k; r++) x[r] -= factor * column[r];
    }
}
