/* test_tree.c: Velocities that the tree sums agree with the direct sum within the tolerance. */
#include <stdlib.h>
#include <string.h>

#include "flow/tree.h"
#include "school.h"
#include "third_kernel.h"

enum { PER_WAKE = 300, MOST_FISH = 256, MOST = PER_WAKE * MOST_FISH, SUMS = KERNEL_SUMS };

static uint64_t seed;

// in [0, 1)
static double random_number(void) {
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    return (double)(seed >> 11) * 0x1p-53;
}

// ---- distributions of rings; lengths in bodies, depth of the bodies w

static void put(const struct sources *rings, int i, double x, double y, double depth) {
    rings->x[i] = x;
    rings->y[i] = y;
    rings->q[i] = 0.1 * (random_number() - 0.5);
    rings->dx[i] = 0.02 * (random_number() - 0.5);
    rings->dy[i] = 0.02 * (random_number() - 0.5);
    rings->half[i] = depth * depth / 32;
    rings->leg[i] = depth * depth / 8 * random_number();
}

// wakes of 300 markers, 6 lengths long, of fish in staggered rows; legs are full after one length
static void wakes(const struct sources *rings, int i, int n, double depth) {
    const int fish = i / PER_WAKE, columns = (int)ceil(sqrt(n / PER_WAKE)), row = fish / columns;
    const double along = 0.02 * (i % PER_WAKE), roll = 0.1 * sin(40 * along);
    put(rings, i, 3 * (fish % columns) + 1.5 * (row % 2) + along + 0.3 * roll, row + 0.1 * sin(6.3 * along) + roll,
        depth);
    rings->leg[i] = depth * depth / 8 * fmin(1, along);
}

static void square(const struct sources *rings, int i, int n, double depth) {
    const double x = sqrt(n / 10.0) * random_number();
    put(rings, i, x, sqrt(n / 10.0) * random_number(), depth);
}

// all of one sign
static void line(const struct sources *rings, int i, int n, double depth) {
    put(rings, i, 30 * random_number(), 7 + 0 * n, depth);
    rings->q[i] = 0.01;
    rings->dx[i] = 0.001;
    rings->dy[i] = 0;
}

// heaps of 64, at the ends of the boxes
static void heaps(const struct sources *rings, int i, int n, double depth) {
    const double x = i / 64 % 12 + 1e-3 * random_number();
    put(rings, i, x, i / 768 + 1e-3 * random_number() + 0 * n, depth);
    rings->q[i] = fabs(rings->q[i]);
}

static void one_place(const struct sources *rings, int i, int n, double depth) {
    put(rings, i, 0.3, -0.1 + 0 * n, depth);
}

typedef void distribution(const struct sources *rings, int i, int n, double depth);

static struct sources fill(distribution *place, int n, double depth) {
    struct sources rings = {.arena = test_arena()};
    seed = 1;
    sources_append(&rings, n);
    for (int i = 0; i < n; i++) place(&rings, i, n, depth);
    return rings;
}

// ---- sums

struct sums {
    double value[SUMS][MOST];
};

static struct targets targets_of(const struct sources *rings, bool with_gradient, struct sums *sums) {
    double *sum[SUMS];
    for (int i = 0; i < SUMS; i++) sum[i] = i < 3 || with_gradient ? sums->value[i] : NULL;
    memset(sums, 0, sizeof *sums);
    struct targets at = kernel_targets(rings->n, rings->x, rings->y, sum);
    at.half = rings->half;
    at.leg = rings->leg;
    return at;
}

static double induce(const struct sources *rings, const struct kernel_pair *pair, double tolerance, int threads,
                     const struct targets *at) {
    struct arena *const arena = arena_create(NULL, "the tree");
    struct tree *const tree = tree_create(arena);
    tree_induce(tree, pair, rings, 1, tolerance, threads, at);
    const double interactions = tree_interactions(tree);
    arena_free(arena);
    return interactions;
}

// sum of the sizes of all velocities at ring i
static double without_cancellation(const struct kernel_pair *pair, const struct sources *rings, int i) {
    double sum = 0;
    for (int j = 0; j < rings->n; j++) {
        const double rx = rings->x[i] - rings->x[j], ry = rings->y[i] - rings->y[j], r = rx * rx + ry * ry;
        if (!pair->kernel->has_legs) {
            sum += fabs(rings->q[j]) / (2 * M_PI * sqrt(r + pair->square + 1e-12));
            continue;
        }
        const double t = r + pair->factor * (rings->half[i] + rings->half[j]) + rings->leg[i] + rings->leg[j];
        const double d = sqrt(rings->dx[j] * rings->dx[j] + rings->dy[j] * rings->dy[j]), root = sqrt(t);
        sum += pair->span / (2 * M_PI * root) * (fabs(rings->q[j]) / sqrt(r + pair->square + 1e-12) + d / t);
    }
    return sum;
}

// the larger one, NaN included (fmax ignores NaN)
static void keep_worse(double *worst, double error) {
    if (!(error <= *worst)) *worst = error;
}

TEST(errors_are_below_the_tolerance_and_not_far_below) {
    static const struct {
        const char *name;
        distribution *place;
        int n;
    } clouds[] = {{"wakes", wakes, 16 * PER_WAKE},
                  {"square", square, 5000},
                  {"line", line, 5000},
                  {"heaps", heaps, 4608},
                  {"one place", one_place, 700}};
    static const double depths[] = {0.05, 0.25, 10}, smoothings[] = {0, 0.1}, tolerances[] = {1e-4, 1e-6, 1e-8};
    static struct sums got, with, direct;
    enum { EACH = 23 };  // of so many rings the sum at one is compared
    double largest[3] = {0};

    for (size_t c = 0; c < sizeof clouds / sizeof *clouds; c++) {
        double worst = 0, worst_gradient = 0;
        for (int k = 0; k < 10; k++) {
            // finite span of three depths, infinite span, a third kernel
            const struct kernel *const kernel = k < 6 ? &kernel_finite : k < 8 ? &kernel_infinite : third_kernel();
            const double depth = depths[k < 6 ? k / 2 : 1], smoothing = smoothings[k % 2];
            const struct kernel_pair pair = kernel->other(depth, smoothing * smoothing);
            struct sources rings = fill(clouds[c].place, clouds[c].n, depth);
            // the sum of all rings at some of them, and the sum without cancellation
            struct sources some = {.arena = test_arena()};
            static double size[MOST];
            sources_append(&some, (rings.n + EACH - 1) / EACH);
            for (int i = 0; i < some.n; i++) {
                some.x[i] = rings.x[EACH * i];
                some.y[i] = rings.y[EACH * i];
                some.half[i] = rings.half[EACH * i];
                some.leg[i] = rings.leg[EACH * i];
                size[i] = without_cancellation(&pair, &rings, EACH * i);
            }
            const struct targets by_sum = targets_of(&some, 1, &direct);
            kernel_induce(&pair, &rings, (struct range){0, rings.n}, &by_sum);

            for (int t = k < 6 ? 0 : 1; t < (k < 6 ? 3 : 2); t++) {
                const struct targets at = targets_of(&rings, 0, &got), all = targets_of(&rings, 1, &with);
                induce(&rings, &pair, tolerances[t], 1, &at);
                induce(&rings, &pair, tolerances[t], 1, &all);
                double error = 0, gradient = 0;
                for (int i = 0; i < some.n; i++) {
                    const double unit = tolerances[t] * fmax(1, size[i]);
                    for (int s = 0; s < SUMS; s++) {
                        const double sum = direct.value[s][i];
                        if (s < 3) keep_worse(&error, fabs(got.value[s][EACH * i] - sum) / unit);
                        keep_worse(s < 3 ? &error : &gradient, fabs(with.value[s][EACH * i] - sum) / unit);
                    }
                }
                NEAR(error, 0, 1, 0);
                // with the smallest half of a box of 0.02 lengths; no smoothing: no gradient at a source
                if (smoothing > 0) NEAR(gradient, 0, 200, 0);
                keep_worse(&worst, error);
                if (smoothing > 0) keep_worse(&worst_gradient, gradient);
                keep_worse(&largest[t], error);
            }
        }
        print_message("%-9s errors in tolerances: velocity and divergence %.3f, gradients %.2f\n", clouds[c].name,
                      worst, worst_gradient);
    }
    // the numbers of nodes are no higher than needed for the worst of these clouds
    for (int t = 0; t < 3; t++) ABOVE(largest[t], 0.01);
}

// the exponent falls to 1; between 16 and 64 wakes 1.4
TEST(interactions_grow_almost_as_the_number_of_rings) {
    static struct sums got;
    double before = 0;
    for (int fish = 16; fish <= MOST_FISH; fish *= 4) {
        struct sources rings = fill(wakes, fish * PER_WAKE, 0.25);
        const struct kernel_pair pair = kernel_finite.other(0.25, 0.0025);
        const struct targets at = targets_of(&rings, 0, &got);
        const double now = induce(&rings, &pair, 5e-8, 1, &at);
        if (fish == MOST_FISH) NEAR(log(now / before) / log(4), 1, 0.25, 0);
        if (fish == MOST_FISH) BELOW(now, 0.1 * rings.n * rings.n);
        before = now;
    }
}

TEST(the_bits_do_not_depend_on_threads_or_earlier_sums) {
    static struct sums one, three;
    const struct kernel_pair pair = kernel_finite.other(0.25, 0.0025);
    struct sources rings = fill(wakes, 16 * PER_WAKE, 0.25), others = fill(square, 3000, 1);
    const struct targets at = targets_of(&rings, 1, &one), again = targets_of(&rings, 1, &three);
    induce(&rings, &pair, 1e-7, 1, &at);

    struct tree *const tree = tree_create(test_arena());
    tree_induce(tree, &pair, &others, 1, 1e-4, 3, &again);
    memset(&three, 0, sizeof three);
    tree_induce(tree, &pair, &rings, 1, 1e-7, 3, &again);
    assert_memory_equal(&three, &one, sizeof one);
}

TEST(few_rings_and_few_targets_are_summed_too) {
    static struct sums got, direct;
    const struct kernel_pair pair = kernel_finite.other(0.25, 0.0025);
    const int numbers[] = {0, 1, 2, 129, 2000};
    for (int i = 0; i < 5; i++) {
        struct sources rings = fill(square, numbers[i], 0.25);
        for (int n = 0; n <= rings.n; n += rings.n > 2 ? rings.n / 2 : 1) {
            struct targets at = targets_of(&rings, 0, &got), by_sum = targets_of(&rings, 0, &direct);
            at.n = by_sum.n = n;
            induce(&rings, &pair, 1e-6, 1, &at);
            kernel_induce(&pair, &rings, (struct range){0, rings.n}, &by_sum);
            for (int s = 0; s < 3; s++) NEAR_ARRAY(n, got.value[s], direct.value[s], 1e-6, 1e-13);
        }
    }
}

TEST(the_tree_is_for_many_rings_and_a_tolerance) {
    assert_true(tree_is_faster(&kernel_finite, 4800, 2e7, 1e-7));
    assert_false(tree_is_faster(&kernel_finite, 4800, 2e7, 0));
    assert_false(tree_is_faster(&kernel_finite, 4800, 1e5, 1e-7));
    assert_false(tree_is_faster(&kernel_finite, 300, 2e7, 1e-7));
    assert_false(tree_is_faster(&kernel_infinite, 4800, 2e7, 1e-7));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(errors_are_below_the_tolerance_and_not_far_below),
        cmocka_unit_test(interactions_grow_almost_as_the_number_of_rings),
        cmocka_unit_test(the_bits_do_not_depend_on_threads_or_earlier_sums),
        cmocka_unit_test(few_rings_and_few_targets_are_summed_too),
        cmocka_unit_test(the_tree_is_for_many_rings_and_a_tolerance),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
