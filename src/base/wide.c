/* wide.c: the product of a full matrix and a vector. */
#include "base/wide.h"

#include <string.h>

/* Rows of a group; groups in registers at a time. gcc keeps a vector that is longer than those of the processor in
 * memory, which makes the product fifteen times slower, so that every width has its own loops. */
enum { ROWS = 8, MOST = 5 };

#ifdef __x86_64__

#define VARIANT(name) name##_avx512
#define TARGET __attribute__((target("avx512f")))
#define LANES 8
#include "base/wide_loops.h"

#define VARIANT(name) name##_avx2
#define TARGET __attribute__((target("avx2")))
#define LANES 4
#include "base/wide_loops.h"

#endif

// any processor
#define VARIANT(name) name##_baseline
#define TARGET
#define LANES 2
#include "base/wide_loops.h"

void wide_multiply(int n_rows, int n_columns, const double *matrix, const double *vector, double *product) {
#ifdef __x86_64__
    if (__builtin_cpu_supports("avx512f")) return multiply_avx512(n_rows, n_columns, matrix, vector, product);
    if (__builtin_cpu_supports("avx2")) return multiply_avx2(n_rows, n_columns, matrix, vector, product);
#endif
    multiply_baseline(n_rows, n_columns, matrix, vector, product);
}

void wide_product(int n_rows, int n_columns, const double *matrix, const double *vector, double *product) {
    memset(product, 0, (size_t)n_rows * sizeof *product);
    wide_multiply(n_rows, n_columns, matrix, vector, product);
}
