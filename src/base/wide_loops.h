/* wide_loops.h: the product of a full matrix and a vector. wide.c includes this text once for every vector width, with
 *
 *     VARIANT(name)       the name of a function for this width
 *     TARGET              the attribute of a function for this processor
 *     LANES               how many numbers a vector has: 8, 4 or 2
 *
 * A row sums its products in the order of the columns, for every width. */

// n groups of eight rows, from the rows `first` on, stay in registers for all columns; groups may overlap
static inline __attribute__((always_inline)) TARGET void VARIANT(multiply_groups)(const int n, const int first[MOST],
                                                                                  int n_rows, int n_columns,
                                                                                  const double *matrix,
                                                                                  const double *vector,
                                                                                  double *product) {
    typedef double lanes __attribute__((vector_size(LANES * sizeof(double)), aligned(sizeof(double)), may_alias));
    enum { PARTS = ROWS / LANES };
    lanes sum[MOST * PARTS];
    int row[MOST * PARTS];
#pragma GCC unroll 20
    for (int k = 0; k < n * PARTS; k++) {
        row[k] = first[k / PARTS] + k % PARTS * LANES;
        sum[k] = *(const lanes *)(product + row[k]);
    }
    for (int c = 0; c < n_columns; c++) {
        const double *const column = matrix + (long)c * n_rows;
#pragma GCC unroll 20
        for (int k = 0; k < n * PARTS; k++) sum[k] += vector[c] * *(const lanes *)(column + row[k]);
    }
#pragma GCC unroll 20
    for (int k = 0; k < n * PARTS; k++) *(lanes *)(product + row[k]) = sum[k];
}

static TARGET void VARIANT(multiply)(int n_rows, int n_columns, const double *matrix, const double *vector,
                                     double *product) {
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
            case 1: VARIANT(multiply_groups)(1, first, n_rows, n_columns, matrix, vector, product); break;
            case 2: VARIANT(multiply_groups)(2, first, n_rows, n_columns, matrix, vector, product); break;
            case 3: VARIANT(multiply_groups)(3, first, n_rows, n_columns, matrix, vector, product); break;
            case 4: VARIANT(multiply_groups)(4, first, n_rows, n_columns, matrix, vector, product); break;
            default: VARIANT(multiply_groups)(5, first, n_rows, n_columns, matrix, vector, product);
        }
    }
}

#undef VARIANT
#undef TARGET
#undef LANES
