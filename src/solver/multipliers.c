/* multipliers.c: least squares and eigenvalues of LAPACK. */
#include "solver/multipliers.h"

#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

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

/* Directions in which the columns are smaller than this part of the largest have died: what is left of them are the
 * errors of the integration, which have a multiplier of their own. */
static const double least_singular = 0.03;

/* An eigenvalue below this is that of a direction that has died. */
static const double rounding = 1e-10;

// (I - A) way = change, with the transposed map in the first n rows of images                        (m, n)
static enum status find_fixed_point(int n, int m, const double *images, const double *change, double *way) {
    double *const matrix = calloc((size_t)n * (size_t)n, sizeof *matrix);
    lapack_int *const pivot = calloc((size_t)n, sizeof *pivot);
    enum status status = STATUS_OK;
    if (matrix && pivot) {
        for (int i = 0; i < n; i++) {
            for (int j = 0; j < n; j++) matrix[i + n * j] = (i == j) - images[j + m * i];
        }
        memcpy(way, change, (size_t)n * sizeof *way);
        if (LAPACKE_dgesv(LAPACK_COL_MAJOR, n, 1, matrix, n, pivot, way, n) != 0) {
            memset(way, 0, (size_t)n * sizeof *way);
        }
    } else {
        status = status_fail(STATUS_MEMORY, "out of memory: the fixed point of %d quantities", n);
    }
    free(matrix);
    free(pivot);
    return status;
}

/* A map of n dimensions and m images of it; what is found. */
struct map {
    int n, m;
    const double *before, *after, *change;
    double *real, *imaginary, *way;
};

// the transposed map is the solution X of before^T X = after^T, and has the same eigenvalues
static enum status solve(const struct map *map, double *matrix, double *images) {
    const int n = map->n, m = map->m;
    transpose(n, m, map->before, matrix);
    transpose(n, m, map->after, images);
    // real serves as scratch; the rows below n of images hold what is left over
    lapack_int rank = 0;
    double *const real = map->real, *const imaginary = map->imaginary;
    const int failed = LAPACKE_dgelsd(LAPACK_COL_MAJOR, m, n, n, matrix, m, images, m, real, least_singular, &rank);
    if (failed != 0 || rank < 1) return status_fail(STATUS_SOLVER, "the multipliers cannot be told apart");
    TRY(find_fixed_point(n, m, images, map->change, map->way));
    if (LAPACKE_dgeev(LAPACK_COL_MAJOR, 'N', 'N', n, images, m, real, imaginary, NULL, 1, NULL, 1) != 0) {
        return status_fail(STATUS_SOLVER, "the multipliers cannot be told apart");
    }
    for (int i = 0; i < n; i++) {
        if (hypot(real[i], imaginary[i]) < rounding) real[i] = imaginary[i] = 0;
    }
    sort(n, real, imaginary);
    return STATUS_OK;
}

enum status multipliers_of(int n, int n_columns, const double *before, const double *after, const double *change,
                           double *real, double *imaginary, double *way) {
    const struct map map = {n, n_columns, before, after, change, real, imaginary, way};
    const size_t size = (size_t)n * (size_t)n_columns;
    double *const matrix = calloc(size, sizeof *matrix), *const images = calloc(size, sizeof *images);
    const enum status status =
        matrix && images ? solve(&map, matrix, images) : status_fail(STATUS_MEMORY, "out of memory: %d multipliers", n);
    free(matrix);
    free(images);
    return status;
}
