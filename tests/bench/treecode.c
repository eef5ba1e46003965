/* treecode.c: the tree against the direct sum of kernel.h: time, error, memory. `make bench`; the tables of
 * doc/performance.md, section "Fast multipole sums".
 *
 * Wakes of 200 vortices, 2 lengths long, of fish 1.5 lengths apart in a square school; lengths are those of a fish.
 * Times are the shortest of several runs, ms: CPU time on one core, wall clock on more. A tree's time is that of
 * treecode_build and the sum together. The direct sum is timed on at most 2048 targets and scaled. */
#include "vortex/treecode.h"

#include <malloc.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "vortex/kernel.h"
#include "vortex/ring_tree.h"

enum { REPEAT = 7, SAMPLE = 2048 };

struct points {
    int n;
    double *x, *y;
};

struct result {
    double direct, alone, shared; /* ms */
    double error, relative;       /* largest error: relative to the largest velocity; in units of A, treecode.h */
    double gradient;              /* largest error of the gradient, relative to the largest one; 0 without */
    double megabytes;             /* of the tree */
};

static uint64_t seed = 1;

static double random_number(void) {
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    return (double)(seed >> 11) * 0x1p-53;
}

static double milliseconds(clockid_t clock) {
    struct timespec t;
    clock_gettime(clock, &t);
    return 1e3 * (double)t.tv_sec + 1e-6 * (double)t.tv_nsec;
}

static void die(const char *what) {
    fprintf(stderr, "treecode: %s\n", what);
    exit(1);
}

static double *doubles(int n) {
    double *const value = calloc((size_t)n, sizeof *value);
    if (!value) die("out of memory");
    return value;
}

static struct points points(int n) {
    return (struct points){n, doubles(n), doubles(n)};
}

static struct points wakes(int n, double *circulation) {
    const struct points all = points(n);
    const int side = (int)ceil(sqrt(n / 200.0));
    for (int i = 0; i < n; i++) {
        const int fish = i / 200;
        const double along = 0.01 * (i % 200), phase = 9.4 * along + fish;
        all.x[i] = 1.5 * (fish % side) + along + 0.005 * random_number();
        all.y[i] = 1.5 * (fish / side) + 0.1 * sin(phase) + 0.005 * random_number();
        circulation[i] = cos(phase) + 0.2 * random_number();
    }
    return all;
}

// 27 points along each body, in front of the wakes
static struct points bodies(int n, int n_vortex) {
    const struct points all = points(n);
    const int side = (int)ceil(sqrt(n_vortex / 200.0));
    for (int i = 0; i < n; i++) {
        const int fish = i / 27;
        const double along = (i % 27) / 26.0;
        all.x[i] = 1.5 * (fish % side) - along;
        all.y[i] = 1.5 * (fish / side) + 0.05 * sin(6 * along + fish);
    }
    return all;
}

static void direct(const struct points *to, int n_targets, const struct points *from, const double *circulation,
                   double smoothing, int with_gradient, double *const out[5]) {
    if (with_gradient) {
        kernel_add_gradient(n_targets, to->x, to->y, from->n, from->x, from->y, circulation, smoothing, out[0], out[1],
                            out[2], out[3], out[4]);
    } else {
        kernel_add_velocity(n_targets, to->x, to->y, from->n, from->x, from->y, circulation, smoothing, out[0], out[1]);
    }
}

static void by_tree(struct treecode *tree, const struct points *to, const struct points *from,
                    const double *circulation, double smoothing, double tolerance, int with_gradient, int threads,
                    double *const out[5]) {
    for (int k = 0; k < 5; k++) memset(out[k], 0, (size_t)to->n * sizeof *out[k]);
    enum status status = treecode_build(tree, from->n, from->x, from->y, circulation, smoothing, tolerance, threads);
    if (status == STATUS_OK && with_gradient) {
        status = treecode_add_gradient(tree, to->n, to->x, to->y, threads, out[0], out[1], out[2], out[3], out[4]);
    } else if (status == STATUS_OK) {
        status = treecode_add_velocity(tree, to->n, to->x, to->y, threads, out[0], out[1]);
    }
    if (status != STATUS_OK) die(status_message());
}

// the sum A of treecode.h
static double unsigned_sum(double x, double y, const struct points *from, const double *circulation, double smoothing) {
    double sum = 0;
    for (int j = 0; j < from->n; j++) {
        const double rx = x - from->x[j], ry = y - from->y[j];
        const double square = rx * rx + ry * ry + smoothing * smoothing;
        if (square > 0) sum += fabs(circulation[j]) / (2 * M_PI * sqrt(square));
    }
    return sum;
}

static void find_errors(struct result *result, const struct points *sample, const struct points *from,
                        const double *circulation, double smoothing, const int *which, double *const got[5],
                        double *const want[5]) {
    double velocity = 0, gradient = 0, error = 0, error_gradient = 0;
    for (int i = 0; i < sample->n; i++) {
        const double e = hypot(got[0][which[i]] - want[0][i], got[1][which[i]] - want[1][i]);
        velocity = fmax(velocity, hypot(want[0][i], want[1][i]));
        error = fmax(error, e);
        result->relative =
            fmax(result->relative, e / unsigned_sum(sample->x[i], sample->y[i], from, circulation, smoothing));
        for (int k = 2; k < 5; k++) {
            gradient = fmax(gradient, fabs(want[k][i]));
            error_gradient = fmax(error_gradient, fabs(got[k][which[i]] - want[k][i]));
        }
    }
    result->error = error / velocity;
    result->gradient = gradient > 0 ? error_gradient / gradient : 0;
}

static struct result compare(const struct points *to, const struct points *from, const double *circulation,
                             double smoothing, double tolerance, int with_gradient, int threads) {
    struct result result = {.direct = 1e99, .alone = 1e99, .shared = 1e99};
    double *got[5], *want[5];
    for (int k = 0; k < 5; k++) got[k] = doubles(to->n);
    struct points sample = points(to->n < SAMPLE ? to->n : SAMPLE);
    int *const which = calloc((size_t)sample.n, sizeof *which);
    if (!which) die("out of memory");
    for (int i = 0; i < sample.n; i++) {
        which[i] = (int)((long)i * to->n / sample.n);
        sample.x[i] = to->x[which[i]];
        sample.y[i] = to->y[which[i]];
    }
    for (int k = 0; k < 5; k++) want[k] = doubles(sample.n);
    const struct mallinfo2 before = mallinfo2();
    struct treecode *tree;
    if (treecode_create(&tree) != STATUS_OK) die(status_message());
    for (int r = 0; r < REPEAT; r++) {
        for (int k = 0; k < 5; k++) memset(want[k], 0, (size_t)sample.n * sizeof *want[k]);
        const double t0 = milliseconds(CLOCK_PROCESS_CPUTIME_ID);
        direct(&sample, sample.n, from, circulation, smoothing, with_gradient, want);
        const double t1 = milliseconds(CLOCK_PROCESS_CPUTIME_ID);
        by_tree(tree, to, from, circulation, smoothing, tolerance, with_gradient, 1, got);
        const double t2 = milliseconds(CLOCK_PROCESS_CPUTIME_ID), w2 = milliseconds(CLOCK_MONOTONIC);
        by_tree(tree, to, from, circulation, smoothing, tolerance, with_gradient, threads, got);
        const double w3 = milliseconds(CLOCK_MONOTONIC);
        result.direct = fmin(result.direct, (t1 - t0) * to->n / sample.n);
        result.alone = fmin(result.alone, t2 - t1);
        result.shared = fmin(result.shared, w3 - w2);
    }
    const struct mallinfo2 after = mallinfo2();
    result.megabytes = 1e-6 * (double)(after.uordblks + after.hblkhd - before.uordblks - before.hblkhd);
    treecode_free(tree);
    find_errors(&result, &sample, from, circulation, smoothing, which, got, want);
    for (int k = 0; k < 5; k++) free(got[k]), free(want[k]);
    free(sample.x), free(sample.y), free(which);
    return result;
}

static void print_row(const char *first, const struct result *r) {
    printf("| %s | %.2f | %.2f | %.1f | %.2f | %.1e | %.1e | ", first, r->direct, r->alone, r->direct / r->alone,
           r->shared, r->error, r->relative);
    if (r->gradient > 0) printf("%.1e | ", r->gradient);
    printf("%.1f |\n", r->megabytes);
}

static void print_table(const char *title, const int *n, int n_rows, double smoothing, double tolerance,
                        int with_bodies, int threads) {
    printf("\n%s\n\n| n | direct | tree | ratio | %d threads | error / max \\|u\\| | error / A | %sMB |\n", title,
           threads, with_bodies ? "of gradient | " : "");
    printf("|---|---|---|---|---|---|---|%s---|\n", with_bodies ? "---|" : "");
    for (int i = 0; i < n_rows; i++) {
        double *const circulation = doubles(n[i]);
        const struct points from = wakes(n[i], circulation);
        const struct points to = with_bodies ? bodies(n[i] / 7, n[i]) : from;
        const struct result result = compare(&to, &from, circulation, smoothing, tolerance, with_bodies, threads);
        char first[32];
        snprintf(first, sizeof first, "%d", n[i]);
        print_row(first, &result);
        free(circulation), free(from.x), free(from.y);
        if (with_bodies) free(to.x), free(to.y);
    }
}

/* Rings of wakes on themselves: depth 0.25, e = 0.05, the tolerance of the default case. */
static void print_rings(void) {
    static const int n[] = {1200, 2400, 4800, 19200, 76800};
    printf(
        "\nRings on rings, tolerance 2.5e-8\n\n| n | direct | tree | ratio | interactions / direct "
        "|\n|---|---|---|---|---|\n");
    struct ring_tree *tree;
    if (ring_tree_create(&tree) != STATUS_OK) die(status_message());
    for (size_t i = 0; i < sizeof n / sizeof *n; i++) {
        struct rings rings = {0};
        double *const circulation = doubles(n[i]), *const u = doubles(n[i]), *const v = doubles(n[i]);
        double *const div = doubles(n[i]);
        const struct points from = wakes(n[i], circulation);
        if (ring_append(&rings, n[i]) != STATUS_OK) die(status_message());
        for (int k = 0; k < n[i]; k++) {
            rings.x[k] = from.x[k];
            rings.y[k] = from.y[k];
            rings.q[k] = 0.05 * circulation[k];
            rings.dx[k] = 0.01 * circulation[k];
            rings.half[k] = 0.25 * 0.25 / 32;
            rings.leg[k] = 0.25 * 0.25 / 8 * fmin(1, 0.01 * (k % 300));
        }

        const struct ring_pair pair = {.span = 0.125, .factor = 4, .square = 0.0025};
        const struct ring_targets at = {
            .n = n[i], .x = rings.x, .y = rings.y, .half = rings.half, .leg = rings.leg, .u = u, .v = v, .div = div};
        const struct ring_targets sample = ring_targets_part(&at, (struct range){0, n[i] < 4800 ? n[i] : 2400});
        double by_sum = INFINITY, by_tree = INFINITY;
        for (int r = 0; r < REPEAT; r++) {
            const double t0 = milliseconds(CLOCK_PROCESS_CPUTIME_ID);
            ring_induce(&pair, &rings, (struct range){0, rings.n}, &sample);
            const double t1 = milliseconds(CLOCK_PROCESS_CPUTIME_ID);
            if (ring_tree_induce(tree, &pair, &rings, 1, 2.5e-8, 1, &at) != STATUS_OK) die(status_message());
            const double t2 = milliseconds(CLOCK_PROCESS_CPUTIME_ID);
            by_sum = fmin(by_sum, (t1 - t0) * n[i] / sample.n);
            by_tree = fmin(by_tree, t2 - t1);
        }

        printf("| %d | %.2f | %.2f | %.1f | %.3f |\n", n[i], by_sum, by_tree, by_sum / by_tree,
               ring_tree_interactions(tree) / n[i] / n[i]);
        ring_free(&rings);
        free(circulation), free(u), free(v), free(div), free(from.x), free(from.y);
    }
    ring_tree_free(tree);
}

int main(void) {
    const int n[] = {1000, 2000, 3000, 4000, 8000, 16384, 32768, 65536}, n_rows = sizeof n / sizeof *n,
              many[] = {32768};
    print_table("Vortices on vortices, e = 0.2, tolerance 1e-8", n, n_rows, 0.2, 1e-8, 0, 2);
    print_table("Vortices on n / 7 points of bodies, with the gradient", n, n_rows, 0.2, 1e-8, 1, 2);
    print_table("e = 1e-5", many, 1, 1e-5, 1e-8, 0, 2);
    print_table("e = 1", many, 1, 1, 1e-8, 0, 2);
    print_table("Tolerance 1e-6", many, 1, 0.2, 1e-6, 0, 2);
    print_table("Tolerance 1e-10", many, 1, 0.2, 1e-10, 0, 2);
    print_table("Tolerance 1e-12", many, 1, 0.2, 1e-12, 0, 2);
    print_rings();
    return 0;
}
