/* kernels.c: how many velocities of one vortex at one point the program computes in a second: the loops of
 * src/vortex/kernel.c on one core, for every variant that this processor has, and whole wakes at themselves
 * (src/vortex/velocity_sum.c) with more threads. A pair of the pairwise sum counts twice. Printed by `make bench`.
 *
 * The first two rows are the speed of the processor with vectors of that width: products and divisions of numbers in
 * registers. A velocity takes 5.5 products (some with a sum) and half a division, two velocities of a pair at each
 * other 9.5 and half a division. The machine may be shared: each rate is the best of many short runs, and only rates
 * of one run of this program can be compared. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "vortex/kernel.h"
#include "vortex/velocity_sum.h"

enum { MAX = 3200, N_RUNS = 50 };
static const double per_run = 1e6; /* interactions at least */

static struct { double x[MAX], y[MAX], circulation[MAX], u[MAX], v[MAX], u_x[MAX], u_y[MAX], v_x[MAX]; } cloud;

/* What is timed: a use of a variant with two sizes n and m. */
typedef void some_use(const struct kernel_variant *variant, int n, int m);

// ---- the processor

#ifdef __aarch64__
#define IN_VECTOR "w"
#else
#define IN_VECTOR "x"
#endif

// 10 n m operations on vectors, none of which waits for another
#define OPERATIONS(name, target, width, operation)                                 \
    target static void name(int n, int m) {                                        \
        typedef double lanes __attribute__((vector_size(width * sizeof(double)))); \
        lanes a = 1.1 - (lanes){0}, b = 1.3 - (lanes){0};                          \
        for (long i = 0; i < (long)n * m; i++) {                                   \
            _Pragma("GCC unroll 10") for (int k = 0; k < 10; k++) {                \
                const lanes result = a operation b;                                \
                __asm__ volatile(""                                                \
                                 : "+" IN_VECTOR(a), "+" IN_VECTOR(b)              \
                                 : IN_VECTOR(result)); /* is not optimised away */ \
            }                                                                      \
        }                                                                          \
    }
#ifdef __x86_64__
OPERATIONS(products_avx512, __attribute__((target("avx512f"))), 8, *)
OPERATIONS(products_avx2, __attribute__((target("avx2"))), 4, *)
OPERATIONS(divisions_avx512, __attribute__((target("avx512f"))), 8, /)
OPERATIONS(divisions_avx2, __attribute__((target("avx2"))), 4, /)
#endif
OPERATIONS(products_two, , 2, *)
OPERATIONS(divisions_two, , 2, /)

static const struct {
    const char *name;
    int width;
    void (*products)(int n, int m), (*divisions)(int n, int m);
} processor[] = {
#ifdef __x86_64__
    {"avx512", 8, products_avx512, divisions_avx512},
    {"avx2", 4, products_avx2, divisions_avx2},
#endif
    {"neon", 2, products_two, divisions_two},
    {"baseline", 2, products_two, divisions_two}};

static int processor_of(const struct kernel_variant *variant) {
    int i = 0;
    while (strcmp(processor[i].name, variant->name) != 0) i++;
    return i;
}

static void products(const struct kernel_variant *variant, int n, int m) {
    processor[processor_of(variant)].products(n, m);
}

static void divisions(const struct kernel_variant *variant, int n, int m) {
    processor[processor_of(variant)].divisions(n, m);
}

// ---- the loops

static void velocity(const struct kernel_variant *variant, int n, int m) {
    const struct kernel_sources sources = {m, cloud.x, cloud.y, cloud.circulation, 0.04};
    variant->velocity(n, cloud.x, cloud.y, &sources, cloud.u, cloud.v);
}

static void gradient(const struct kernel_variant *variant, int n, int m) {
    const struct kernel_sources sources = {m, cloud.x, cloud.y, cloud.circulation, 0.04};
    variant->gradient(n, cloud.x, cloud.y, &sources, cloud.u, cloud.v, cloud.u_x, cloud.u_y, cloud.v_x);
}

static void tiles(const struct kernel_variant *variant, int n, int m) {
    struct kernel_tile tile[2];
    for (int k = 0; k < 2; k++) {
        const int first = k == 0 ? 0 : n;
        tile[k] = (struct kernel_tile){
            k == 0 ? n : m,  cloud.x + first, cloud.y + first, cloud.circulation + first,
            cloud.u + first, cloud.v + first,
        };
    }
    variant->pairwise(&tile[0], &tile[1], 0.04);
}

// ---- whole wakes

/* n vortices with m threads; the fastest variant */
static void wake(const struct kernel_variant *variant, int n, int m) {
    (void)variant;
    struct vortex_group all = {{0, n}, 0.2};
    const struct vortices vortices = {
        .n = n, .x = cloud.x, .y = cloud.y, .circulation = cloud.circulation, .n_groups = 1, .group = &all};
    if (velocity_sum_pairwise(&vortices, PAIRWISE_OF_SOURCE, m, cloud.u, cloud.v) != STATUS_OK) abort();
}

// ---- the tables

static double now(clockid_t clock) {
    struct timespec t;
    clock_gettime(clock, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* The best of many short runs, in 1e9 per second of a clock; one call does so many of what is counted. */
static double rate(clockid_t clock, some_use *use, const struct kernel_variant *variant, int n, int m,
                   double per_call) {
    const int n_calls = 1 + (int)(per_run / per_call);
    double best = 0;
    for (int run = 0; run < N_RUNS; run++) {
        const double start = now(clock);
        for (int i = 0; i < n_calls; i++) use(variant, n, m);
        const double done = n_calls * per_call / (now(clock) - start);
        if (done > best) best = done;
    }
    return 1e-9 * best;
}

static void print_variants(void) {
    const struct {
        const char *name;
        some_use *use;
        int n, m;
        double per_call; /* counted in one call, per lane of a vector if negative */
    } rows[] = {
        {"products", products, 100, 10, -100 * 10 * 10},
        {"divisions", divisions, 100, 10, -100 * 10 * 10},
        {"sheet on wake, 1600 x 21", velocity, 1600, 21, 1600 * 21},
        {"wake on body points, 112 x 400", velocity, 112, 400, 112 * 400},
        {"16 x 400", velocity, 16, 400, 16 * 400},
        {"8 x 400", velocity, 8, 400, 8 * 400},
        {"with gradient, 112 x 400", gradient, 112, 400, 112 * 400},
        {"with gradient, 112 x 21", gradient, 112, 21, 112 * 21},
        {"wake on wake, 128 with 128", tiles, 128, 128, 2 * 128 * 128},
        {"64 with 64", tiles, 64, 64, 2 * 64 * 64},
    };
    const struct kernel_variant *variant;
    printf("%-32s", "1e9 per CPU second");
    for (int i = 0; (variant = kernel_variant(i)); i++) printf(" %9s", variant->name);
    printf("\n");
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        printf("%-32s", rows[k].name);
        for (int i = 0; (variant = kernel_variant(i)); i++) {
            double per_call = rows[k].per_call;
            if (per_call < 0) per_call *= -processor[processor_of(variant)].width;
            printf(" %9.2f", rate(CLOCK_PROCESS_CPUTIME_ID, rows[k].use, variant, rows[k].n, rows[k].m, per_call));
        }
        printf("\n");
    }
}

static void print_threads(void) {
    const int sizes[] = {400, 1600, 3200}, threads[] = {1, 2, 4};
    printf("\n%-32s", "1e9 per second, threads");
    for (int i = 0; i < 3; i++) printf(" %9d", threads[i]);
    printf("\n");
    for (int k = 0; k < 3; k++) {
        printf("wake on wake, %4d vortices      ", sizes[k]);
        for (int i = 0; i < 3; i++) {
            printf(" %9.2f", rate(CLOCK_MONOTONIC, wake, NULL, sizes[k], threads[i], (double)sizes[k] * sizes[k]));
        }
        printf("\n");
    }
}

int main(void) {
    for (int i = 0; i < MAX; i++) {
        cloud.x[i] = rand() / (double)RAND_MAX;
        cloud.y[i] = rand() / (double)RAND_MAX;
        cloud.circulation[i] = rand() / (double)RAND_MAX - 0.5;
    }
    print_variants();
    print_threads();
    printf("\n");
    return 0;
}
