/* kernels.c: how many interactions of a vortex with a point the loops of src/kernel.c do in a second, on one core, for
 * every variant that this processor has. A pair that feels each other counts twice. Printed by `make bench`.
 *
 * The last columns are what the processor can do with vectors of that width, in numbers (not vectors): fused products
 * and divisions, each alone. A velocity takes 5.5 products or fused products and half a division. The machine may be
 * shared: each rate is the best of several runs, and only rates of one table compare. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "kernel.h"

enum { MOST = 1600, N_RUNS = 7 };
static const double run_time = 0.02; /* s */

static struct {
    double x[MOST], y[MOST], circulation[MOST], u[MOST], v[MOST], u_x[MOST], u_y[MOST], v_x[MOST];
} cloud __attribute__((aligned(64)));

static double now(void) {
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* One use of a variant: what is timed, on n targets and m sources. */
typedef void some_use(const struct kernel_variant *variant, int n, int m);

static void velocity(const struct kernel_variant *variant, int n, int m) {
    const struct kernel_sources sources = {m, cloud.x, cloud.y, cloud.circulation, 0.04};
    variant->velocity(n, cloud.x, cloud.y, &sources, cloud.u, cloud.v);
}

static void gradient(const struct kernel_variant *variant, int n, int m) {
    const struct kernel_sources sources = {m, cloud.x, cloud.y, cloud.circulation, 0.04};
    variant->gradient(n, cloud.x, cloud.y, &sources, cloud.u, cloud.v, cloud.u_x, cloud.u_y, cloud.v_x);
}

static struct kernel_tile tile(int first, int n) {
    return (struct kernel_tile){
        n, cloud.x + first, cloud.y + first, cloud.circulation + first, cloud.u + first, cloud.v + first};
}

static void mutual(const struct kernel_variant *variant, int n, int m) {
    const struct kernel_tile a = tile(0, n), b = tile(n, m);
    variant->mutual(&a, &b, 0.04);
}

/* The best rate of several runs, in 1e9 per second; one call does so many interactions. */
static double rate(some_use *use, const struct kernel_variant *variant, int n, int m, double interactions) {
    double best = 0;
    for (int run = 0; run < N_RUNS; run++) {
        const double start = now();
        double spent = 0, done = 0;
        do {
            for (int i = 0; i < 50; i++) use(variant, n, m);
            done += 50 * interactions;
            spent = now() - start;
        } while (spent < run_time);
        if (done / spent > best) best = done / spent;
    }
    return 1e-9 * best;
}

int main(void) {
    for (int i = 0; i < MOST; i++) {
        cloud.x[i] = rand() / (double)RAND_MAX;
        cloud.y[i] = rand() / (double)RAND_MAX;
        cloud.circulation[i] = rand() / (double)RAND_MAX - 0.5;
    }
    const struct {
        const char *name;
        some_use *use;
        int n, m, both;
    } rows[] = {
        {"sheet on wake, 1600 x 21", velocity, 1600, 21, 1}, {"wake on body points, 16 x 400", velocity, 16, 400, 1},
        {"the same, 112 x 400", velocity, 112, 400, 1},      {"the same, 8 x 400", velocity, 8, 400, 1},
        {"with gradient, 112 x 400", gradient, 112, 400, 1}, {"sheet with gradient, 112 x 21", gradient, 112, 21, 1},
        {"wake on wake, tiles of 128", mutual, 128, 128, 2}, {"the same, tiles of 64", mutual, 64, 64, 2},
    };
    const struct kernel_variant *variant;
    printf("%-32s", "G interactions/s");
    for (int i = 0; (variant = kernel_variant(i)); i++) printf(" %9s", variant->name);
    printf("\n");
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        printf("%-32s", rows[k].name);
        for (int i = 0; (variant = kernel_variant(i)); i++) {
            printf(" %9.2f",
                   rate(rows[k].use, variant, rows[k].n, rows[k].m, (double)rows[k].both * rows[k].n * rows[k].m));
        }
        printf("\n");
    }
    return 0;
}
