/* wide.c: a product of a full matrix and a vector. */
#include "base/wide.h"

WIDE(void, wide_multiply,
     (int n_rows, int n_columns, const double *restrict matrix, const double *restrict vector,
      double *restrict product),
     (n_rows, n_columns, matrix, vector, product)) {
    int c = 0;
    // four columns at a time: each product is read and written once per four columns
    for (; c + 4 <= n_columns; c += 4) {
        const double *const column = matrix + (long)c * n_rows;
        const double f0 = vector[c], f1 = vector[c + 1], f2 = vector[c + 2], f3 = vector[c + 3];
        for (int r = 0; r < n_rows; r++) {
            product[r] = product[r] + f0 * column[r] + f1 * column[n_rows + r] + f2 * column[2 * n_rows + r] +
                         f3 * column[3 * n_rows + r];
        }
    }

    for (; c < n_columns; c++) {
        const double *const column = matrix + (long)c * n_rows;
        for (int r = 0; r < n_rows; r++) product[r] += vector[c] * column[r];
    }
}
