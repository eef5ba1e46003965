/* kernels.c: measures how many interactions of sources and targets one core computes per second, with both kernels. It
 * sums one wake at itself with every variant of the inner loops, in pairs, with gradients, and by the tree, which shows
 * from where on the tree is faster (kernel.h: tree_sources, tree_interactions). `make bench` runs it. The machine may
 * be shared, so each rate is the best of several runs, and only rates of one run of this program can be compared. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "flow/kernel.h"
#include "flow/tree.h"

enum { MOST = 24000, RUNS = 9 };
static double u[MOST], v[MOST], div_u[MOST], u_x[MOST], u_y[MOST], v_x[MOST], div_x[MOST], div_y[MOST];

static double cpu_time(void) {
    struct timespec at;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &at);
    return (double)at.tv_sec + 1e-9 * (double)at.tv_nsec;
}

// wakes of 300 markers, 3 lengths long, side by side
static struct sources wakes(struct arena *arena, int n) {
    struct sources all = {.arena = arena};
    sources_append(&all, n);
    for (int i = 0; i < n; i++) {
        all.x[i] = 0.01 * (i % 300);
        all.y[i] = i / 300 + 0.2 * sin(0.03 * i);
        all.q[i] = 0.01 * cos(0.03 * i);
        all.dx[i] = 1e-4 * sin(0.03 * i);
        all.half[i] = 0.002;
    }
    return all;
}

enum how { DIRECT, GRADIENT, MUTUAL, BY_TREE };

// seconds of one sum
static double seconds_of(const struct kernel_pair *pair, const struct sources *all, enum how how, struct tree *tree) {
    struct targets at = {.n = all->n, .x = all->x, .y = all->y, .half = all->half, .u = u, .v = v, .div = div_u};
    if (how == GRADIENT) at.u_x = u_x, at.u_y = u_y, at.v_x = v_x, at.div_x = div_x, at.div_y = div_y;
    double best = INFINITY;
    for (int run = 0; run < (all->n > 3000 ? 2 : RUNS); run++) {
        const double since = cpu_time();
        if (how == MUTUAL) kernel_induce_mutual(pair, all, &at, all, &at);
        if (how == DIRECT || how == GRADIENT) kernel_induce(pair, all, (struct range){0, all->n}, &at);
        if (how == BY_TREE) tree_induce(tree, pair, all, 1, 2.5e-8, 1, &at);
        best = fmin(best, cpu_time() - since);
    }
    return best;
}

int main(void) {
    const struct kernel_pair pairs[] = {kernel_infinite.other(0, 0.01), kernel_finite.other(0.25, 0.01)};
    const char *const names[] = {"infinite", "finite"};
    struct arena *const arena = arena_create(NULL, "the sums");
    struct tree *const tree = tree_create(arena);
    printf("%-10s %9s %12s %12s %12s %12s   millions of interactions a second\n", "", "sources", "direct", "gradient",
           "mutual", "by tree");
    for (int k = 0; k < 2; k++) {
        for (int n = 300; n <= MOST; n = n < 1500 ? 1500 : 2 * n) {
            struct sources all = wakes(arena, n);
            printf("%-10s %9d", names[k], n);
            for (enum how how = DIRECT; how <= BY_TREE; how++) {
                printf(" %12.0f", 1e-6 * n * n / seconds_of(&pairs[k], &all, how, tree));
            }
            puts("");
        }
    }
    arena_free(arena);
    return 0;
}
