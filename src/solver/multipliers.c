/* multipliers.c: least squares and eigenvalues of LAPACK. */
#include "solver/multipliers.h"

#include <lapacke.h>
#include <math.h>
#include <stdlib.h>

static int comes_before(const double *real, const double *imaginary, int i, int j) {
    const double a = hypot(real[i], imaginary[i]), b = hypot(real[j], imaginary[j]);
    // the two of a pair have the same value but for rounding
    if (fabs(a - b) > 1e-12 * (a + b)) return a > b;
    return imaginary[i] > imaginary[j];
}

static void swap(double *a, double *b) {
    const double value = *a;
    *a = *b;
    *b = value;
}

static void sort(int n, double *real, double *imaginary) {
    for (int i = 1; i < n; i++) {
        for (int j = i; j > 0 && comes_before(real, imaginary, j, j - 1); j--) {
            swap(&real[j], &real[j - 1]);
            swap(&imaginary[j], &imaginary[j - 1]);
        }
    }
}

// exchange rows and columns                                                       from (n, m), to (m, n)
static void transpose(int n, int m, const double *from, double *to) {
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < m; j++) to[j + m * i] = from[i + n * j];
    }
}

/* Directions in which the columns are smaller than this part of the largest are rounding. */
static const double least_singular = 1e-10;

// the transposed map is the solution X of before^T X = after^T, and has the same eigenvalues
static enum status solve(int n, int m, const double *before, const double *after, double *matrix, double *images,
                         double *real, double *imaginary) {
    transpose(n, m, before, matrix);
    transpose(n, m, after, images);
    // real serves as scratch; the rows below n of images hold what is left over
    lapack_int rank = 0;
    const int failed = LAPACKE_dgelsd(LAPACK_COL_MAJOR, m, n, n, matrix, m, images, m, real, least_singular, &rank);
    if (failed != 0 || rank < n ||
        LAPACKE_dgeev(LAPACK_COL_MAJOR, 'N', 'N', n, images, m, real, imaginary, NULL, 1, NULL, 1) != 0) {
        return status_fail(STATUS_SOLVER, "the multipliers cannot be told apart");
    }
    sort(n, real, imaginary);
    return STATUS_OK;
}

enum status multipliers_of(int n, int n_columns, const double *before, const double *after, double *real,
                           double *imaginary) {
    const size_t size = (size_t)n * (size_t)n_columns;
    double *const matrix = calloc(size, sizeof *matrix), *const images = calloc(size, sizeof *images);
    const enum status status = matrix && images ? solve(n, n_columns, before, after, matrix, images, real, imaginary)
                                                : status_fail(STATUS_MEMORY, "out of memory: %d multipliers", n);
    free(matrix);
    free(images);
    return status;
}
