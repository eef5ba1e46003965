/* wide.h: compiles a plain loop for each vector width, and calls the widest that the processor has; also the product
 * of a full matrix and a vector. Tested by tests/base/test_mathematics.c. */
#ifndef WIDE_H
#define WIDE_H

/* The head of a function with plain loops, compiled for several vector widths; each call selects the widest vectors of
 * the processor. The body follows, static may precede:
 *
 *     WIDE(void, double_all, (int n, double *x), (n, x)) {
 *         for (int i = 0; i < n; i++) x[i] *= 2;
 *     } */
#ifdef __x86_64__
#define WIDE(type, name, parameters, arguments)                                \
    type name parameters;                                                      \
    static inline __attribute__((always_inline)) type name##_loops parameters; \
    static __attribute__((target("avx512f"))) type name##_avx512 parameters {  \
        return name##_loops arguments;                                         \
    }                                                                          \
    static __attribute__((target("avx2"))) type name##_avx2 parameters {       \
        return name##_loops arguments;                                         \
    }                                                                          \
    static type name##_baseline parameters {                                   \
        return name##_loops arguments;                                         \
    }                                                                          \
    type name parameters {                                                     \
        if (__builtin_cpu_supports("avx512f")) return name##_avx512 arguments; \
        if (__builtin_cpu_supports("avx2")) return name##_avx2 arguments;      \
        return name##_baseline arguments;                                      \
    }                                                                          \
    static inline type name##_loops parameters
#else
#define WIDE(type, name, parameters, arguments) \
    type name parameters;                       \
    type name parameters
#endif

/* A vector that the compiler keeps in registers in such a loop: of the width of AVX2, or of any arm64 processor. gcc
 * keeps longer ones in memory. */
#ifdef __x86_64__
enum { WIDE_LANES = 4 };
#else
enum { WIDE_LANES = 2 };
#endif
typedef double wide_lanes __attribute__((vector_size(WIDE_LANES * sizeof(double)), aligned(sizeof(double)), may_alias));

/* product += matrix * vector: a dense matrix (n_rows, n_columns) in column-major order; columns are added in array
 * order. */
void wide_multiply(int n_rows, int n_columns, const double *matrix, const double *vector, double *product);

/* The same with product = matrix * vector. */
void wide_product(int n_rows, int n_columns, const double *matrix, const double *vector, double *product);

#endif
