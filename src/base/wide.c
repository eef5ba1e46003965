/* wide.c: the product of a full matrix and a vector. */
#include "base/wide.h"

#include <string.h>

/* Eight rows at any address of an array of numbers. */
enum { ROWS = 8, MOST = 5 };
typedef double rows_of_eight __attribute__((vector_size(ROWS * sizeof(double)), aligned(sizeof(double)), may_alias));

// n groups of eight rows, from the rows `first` on, stay in registers for all columns; groups may overlap
static inline __attribute__((always_inline)) void multiply_groups(int n, const int first[MOST], int n_rows,
                                                                  int n_columns, const double *matrix,
                                                                  const double *vector, double *product) {
    rows_of_eight sum[MOST];
    for (int k = 0; k < n; k++) sum[k] = *(const rows_of_eight *)(product + first[k]);
    for (int c = 0; c < n_columns; c++) {
        const double *const column = matrix + (long)c * n_rows;
        for (int k = 0; k < n; k++) sum[k] += vector[c] * *(const rows_of_eight *)(column + first[k]);
    }
    for (int k = 0; k < n; k++) *(rows_of_eight *)(product + first[k]) = sum[k];
}

WIDE(void, wide_multiply, (int n_rows, int n_columns, const double *matrix, const double *vector, double *product),
     (n_rows, n_columns, matrix, vector, product)) {
    for (int c = 0; c < n_columns && n_rows < ROWS; c++) {
        for (int r = 0; r < n_rows; r++) product[r] += vector[c] * matrix[(long)c * n_rows + r];
    }

    // four groups at a time; the last rows are a group that overlaps the last full one
    const int n_full = n_rows / ROWS, has_rest = n_rows % ROWS > 0;
    for (int done = 0; done < n_full;) {
        int first[MOST], n = 0;
        while (n < MOST - 1 && done < n_full) first[n++] = ROWS * done++;
        if (done == n_full && has_rest) first[n++] = n_rows - ROWS;
        switch (n) {
            case 1: multiply_groups(1, first, n_rows, n_columns, matrix, vector, product); break;
            case 2: multiply_groups(2, first, n_rows, n_columns, matrix, vector, product); break;
            case 3: multiply_groups(3, first, n_rows, n_columns, matrix, vector, product); break;
            case 4: multiply_groups(4, first, n_rows, n_columns, matrix, vector, product); break;
            default: multiply_groups(5, first, n_rows, n_columns, matrix, vector, product);
        }
    }
}

void wide_product(int n_rows, int n_columns, const double *matrix, const double *vector, double *product) {
    memset(product, 0, (size_t)n_rows * sizeof *product);
    wide_multiply(n_rows, n_columns, matrix, vector, product);
}
