/* test_velocity_sum.c: the sums by trees against the direct sum. */
#include <stdlib.h>
#include <string.h>

#include "near.h"
#include "school.h"
#include "vortex/kernel.h"
#include "vortex/treecode.h"
#include "vortex/velocity_sum.h"

enum { VORTICES = 4000, TARGETS = 500 };

// rows of vortices, with two smoothings that alternate
static void make(struct vortices *vortices) {
    *vortices = (struct vortices){0};
    for (int row = 0; row < VORTICES / 100; row++) {
        assert_int_equal(vortices_append(vortices, 100, row % 3 == 0 ? 0.1 : 0.2), STATUS_OK);
    }
    for (int i = 0; i < vortices->n; i++) {
        vortices->x[i] = 0.02 * (i % 100) + 3 * (i / 1000);
        vortices->y[i] = 0.7 * (i / 100 % 10) + 0.1 * sin(0.3 * i);
        vortices->circulation[i] = 0.01 * cos(0.1 * i);
    }
}

struct result {
    double x[TARGETS], y[TARGETS], value[5][TARGETS];
};

static struct induced at(struct result *result, int with_gradient) {
    for (int i = 0; i < TARGETS; i++) {
        result->x[i] = 0.025 * i;
        result->y[i] = 3.3 + 3 * sin(i);
        for (int k = 0; k < 5; k++) result->value[k][i] = 1;
    }
    double *const *const none = (double *[]){NULL, NULL, NULL};
    double *const gradient[] = {result->value[2], result->value[3], result->value[4]};
    double *const *const g = with_gradient ? gradient : none;
    return (struct induced){TARGETS, result->x, result->y, result->value[0], result->value[1], g[0], g[1], g[2]};
}

static void trees_of_every_smoothing_add_up_to_the_direct_sum(void **state) {
    (void)state;
    struct vortices vortices;
    struct velocity_sum *sum;
    make(&vortices);
    assert_int_equal(velocity_sum_create(&sum), STATUS_OK);
    for (int with_gradient = 0; with_gradient < 2; with_gradient++) {
        const double tolerance = 1e-6;
        struct result got, want, threads;
        struct induced targets = at(&want, with_gradient);
        vortices_induce(&vortices, (struct range){0, vortices.n}, &targets);
        targets = at(&got, with_gradient);
        assert_int_equal(velocity_sum_induce(sum, &vortices, tolerance, 1, &targets), STATUS_OK);
        // the velocity without cancellation is below 10 m/s, see the first assertion
        double max = 0, error = 0;
        for (int i = 0; i < TARGETS; i++) {
            const double u = want.value[0][i] - 1, v = want.value[1][i] - 1;
            max = fmax(max, hypot(u, v));
            error = fmax(error, hypot(got.value[0][i] - want.value[0][i], got.value[1][i] - want.value[1][i]));
        }
        assert_true(max > 0.01 && max < 10 && error > 0 && error < tolerance);
        for (int k = 2; k < 5; k++) NEAR_ARRAY(TARGETS, got.value[k], want.value[k], 50 * tolerance, 0);
        targets = at(&threads, with_gradient);
        assert_int_equal(velocity_sum_induce(sum, &vortices, tolerance, 3, &targets), STATUS_OK);
        assert_memory_equal(threads.value, got.value, sizeof got.value);
    }
    velocity_sum_free(sum);
    vortices_free(&vortices);
}

// the largest difference of two results
static double difference(const struct result *one, const struct result *other) {
    double worst = 0;
    for (int k = 0; k < 5; k++) {
        for (int i = 0; i < TARGETS; i++) worst = fmax(worst, fabs(one->value[k][i] - other->value[k][i]));
    }
    return worst;
}

static void move(struct vortices *vortices, double far) {
    for (int i = 0; i < vortices->n; i++) {
        vortices->x[i] += far * sin(i);
        vortices->y[i] += far * cos(0.2 * i);
    }
}

static void the_tree_has_a_tenth_of_the_tolerance(void **state) {
    (void)state;
    const double tolerance = 1e-6;
    struct vortices all, vortices = {0};
    struct velocity_sum *sum;
    struct treecode *tree;
    make(&all);
    // one smoothing, so one set
    assert_int_equal(vortices_append(&vortices, all.n, 0.1), STATUS_OK);
    memcpy(vortices.x, all.x, (size_t)all.n * sizeof *all.x);
    memcpy(vortices.y, all.y, (size_t)all.n * sizeof *all.y);
    memcpy(vortices.circulation, all.circulation, (size_t)all.n * sizeof *all.circulation);
    assert_int_equal(velocity_sum_create(&sum), STATUS_OK);
    assert_int_equal(treecode_create(&tree), STATUS_OK);
    struct result got, want, coarse;
    struct induced targets = at(&got, 0);
    assert_int_equal(velocity_sum_induce(sum, &vortices, tolerance, 1, &targets), STATUS_OK);
    for (int i = 0; i < 2; i++) {
        targets = at(i == 0 ? &want : &coarse, 0);
        assert_int_equal(treecode_build(tree, vortices.n, vortices.x, vortices.y, vortices.circulation, 0.1,
                                        i == 0 ? tolerance / 10 : tolerance, 1),
                         STATUS_OK);
        assert_int_equal(treecode_add_velocity(tree, targets.n, targets.x, targets.y, 1, targets.u, targets.v),
                         STATUS_OK);
    }
    assert_memory_equal(got.value, want.value, 2 * sizeof *got.value);
    assert_memory_not_equal(got.value, coarse.value, 2 * sizeof *got.value);
    treecode_free(tree);
    velocity_sum_free(sum);
    vortices_free(&vortices);
    vortices_free(&all);
}

static void by_plan_it_is_the_same_sum_to_the_tolerance(void **state) {
    (void)state;
    const double tolerance = 1e-6;
    struct vortices vortices;
    struct velocity_sum *sum;
    assert_int_equal(velocity_sum_create(&sum), STATUS_OK);
    for (int with_gradient = 0; with_gradient < 2; with_gradient++) {
        make(&vortices);
        struct result planned, again, fresh;
        struct induced targets = at(&planned, with_gradient);
        assert_int_equal(velocity_sum_plan(sum, &vortices, tolerance, 1, &targets), STATUS_OK);
        assert_true(planned.value[0][0] == 1 && planned.value[1][TARGETS - 1] == 1);
        move(&vortices, 0.003);
        assert_int_equal(velocity_sum_by_plan(sum, &vortices, tolerance, 1, &targets), STATUS_OK);
        targets = at(&fresh, with_gradient);
        assert_int_equal(velocity_sum_induce(sum, &vortices, tolerance, 1, &targets), STATUS_OK);
        // the bits distinguish the two sums
        const double small = difference(&planned, &fresh);
        assert_true(small > 0 && small < 50 * tolerance);
        // too far for the plan: the sum of velocity_sum_induce
        move(&vortices, 2);
        targets = at(&again, with_gradient);
        assert_int_equal(velocity_sum_by_plan(sum, &vortices, tolerance, 1, &targets), STATUS_OK);
        targets = at(&fresh, with_gradient);
        assert_int_equal(velocity_sum_induce(sum, &vortices, tolerance, 1, &targets), STATUS_OK);
        assert_memory_equal(again.value, fresh.value, sizeof fresh.value);
        // the plan is still valid, for any number of threads
        vortices_free(&vortices);
        make(&vortices);
        move(&vortices, 0.003);
        targets = at(&again, with_gradient);
        assert_int_equal(velocity_sum_by_plan(sum, &vortices, tolerance, 3, &targets), STATUS_OK);
        assert_memory_equal(again.value, planned.value, sizeof planned.value);
        vortices_free(&vortices);
    }
    velocity_sum_free(sum);
}

static void the_tree_is_for_many_vortices_and_a_tolerance(void **state) {
    (void)state;
    const struct vortices few = {.n = 1600}, many = {.n = 12800};
    assert_false(velocity_sum_by_tree(&few, 1600, 1e-7));
    assert_true(velocity_sum_by_tree(&many, 12800, 1e-7));
    assert_true(velocity_sum_by_tree(&many, 1728, 1e-7));
    assert_false(velocity_sum_by_tree(&many, 27, 1e-7));
    assert_false(velocity_sum_by_tree(&many, 12800, 0));
}

// ---- the pairs of tiles against the direct sum over all pairs of vortices

static int n_until_failure = -1;  // -1: never

void *__real_malloc(size_t size);
void *__wrap_malloc(size_t size);

void *__wrap_malloc(size_t size) {
    return n_until_failure < 0 || n_until_failure-- > 0 ? __real_malloc(size) : NULL;
}

enum { MAX = 3000, MAX_GROUPS = 4 };

static struct { double x[MAX], y[MAX], circulation[MAX]; } cloud;

static int scatter(void **state) {
    (void)state;
    struct setup random = {.seed = 5};
    for (int i = 0; i < MAX; i++) {
        cloud.x[i] = 3 * school_random(&random);
        cloud.y[i] = school_random(&random);
        cloud.circulation[i] = school_random(&random);
    }
    // two coincident vortices, adjacent in the array and in different tiles
    const int twins[2][2] = {{3, 4}, {5, 900}};
    for (int k = 0; k < 2; k++) {
        cloud.x[twins[k][0]] = cloud.x[twins[k][1]];
        cloud.y[twins[k][0]] = cloud.y[twins[k][1]];
    }
    return 0;
}

// consecutive vortices of one smoothing
struct stretch {
    int n;
    double smoothing;
};

static int n_vortices(int n_groups, const struct stretch *group) {
    int n = 0;
    for (int k = 0; k < n_groups; k++) n += group[k].n;
    return n;
}

// the first vortices of the cloud, sorted into groups
static struct vortices grouped(int n_groups, const struct stretch *stretch, struct vortex_group *group) {
    struct vortices vortices = {.x = cloud.x, .y = cloud.y, .circulation = cloud.circulation, .group = group};
    for (int k = 0; k < n_groups; k++) {
        group[k] = (struct vortex_group){{vortices.n, stretch[k].n}, stretch[k].smoothing};
        vortices.n += stretch[k].n;
    }
    vortices.n_groups = n_groups;
    return vortices;
}

// velocities added to zero; the caller frees u, v is in the same allocation
static double *velocity(int n_groups, const struct stretch *stretch, enum pairwise_smoothing smoothing, int threads) {
    struct vortex_group group[MAX_GROUPS];
    const struct vortices vortices = grouped(n_groups, stretch, group);
    double *const u = calloc(2 * (size_t)vortices.n + 1, sizeof *u);
    assert_non_null(u);
    school_ok(velocity_sum_pairwise(&vortices, smoothing, threads, u, u + vortices.n));
    return u;
}

// the smoothing of vortex i
static double smoothing_of(const struct stretch *group, int i) {
    for (; i >= group->n; group++) i -= group->n;
    return group->smoothing;
}

static void compare(int n_groups, const struct stretch *group, enum pairwise_smoothing smoothing) {
    const int n = n_vortices(n_groups, group);
    double *const got = velocity(n_groups, group, smoothing, 1);
    for (int i = 0; i < n; i++) {
        double u = 0, v = 0, size = 0;
        for (int k = 0, j = 0; k < n_groups; k++) {
            for (const int end = j + group[k].n; j < end; j++) {
                struct kernel_values unit;
                const double own = smoothing_of(group, i), other = group[k].smoothing;
                const double length = smoothing == PAIRWISE_OF_SOURCE ? other : sqrt(own * own / 2 + other * other / 2);
                kernel_unit(1, cloud.x + i, cloud.y + i, cloud.x[j], cloud.y[j], length, &unit);
                u += cloud.circulation[j] * unit.u[0];
                v += cloud.circulation[j] * unit.v[0];
                size += fabs(cloud.circulation[j]) * hypot(unit.u[0], unit.v[0]);
            }
        }
        // rounding of the terms, and of the sums, in proportion to the square root of the number of terms
        NEAR(got[i], u, 2e-15 * size, 0);
        NEAR(got[n + i], v, 2e-15 * size, 0);
    }
    free(got);
}

static void velocities_are_those_of_all_vortices_at_all_others(void **state) {
    (void)state;
    const int n[] = {0, 1, 2, 7, 8, 9, 15, 16, 17, 127, 128, 129, 300, 1000};
    for (size_t k = 0; k < sizeof n / sizeof *n; k++) {
        for (int s = 0; s < 2; s++) compare(1, &(struct stretch){n[k], s ? 0.2 : 0}, PAIRWISE_OF_SOURCE);
    }
}

static void every_group_has_its_own_smoothing_or_that_of_a_pair(void **state) {
    (void)state;
    const struct stretch groups[][MAX_GROUPS] = {
        {{30, 0.1}, {0, 0.5}, {200, 0.2}, {1, 0.3}},    // all different, one empty, one alone
        {{150, 0.1}, {70, 0.2}, {33, 0.1}, {19, 0.2}},  // two smoothings that alternate
        {{100, 0.1}, {100, 0.1}, {100, 0.1}, {9, 0}},   // one smoothing for nearly all vortices
        {{0, 0.1}, {0, 0.1}, {0, 0.2}, {0, 0.3}},       // no vortex at all
    };
    for (size_t k = 0; k < sizeof groups / sizeof *groups; k++) {
        compare(MAX_GROUPS, groups[k], PAIRWISE_OF_SOURCE);
        compare(MAX_GROUPS, groups[k], PAIRWISE_OF_PAIR);
    }
}

static void groups_of_one_smoothing_have_the_bits_of_one_group(void **state) {
    (void)state;
    const struct stretch three[] = {{100, 0.1}, {31, 0.1}, {200, 0.1}}, one = {331, 0.1};
    double *const a = velocity(3, three, PAIRWISE_OF_SOURCE, 1), *const b = velocity(1, &one, PAIRWISE_OF_SOURCE, 1);
    assert_memory_equal(a, b, 2 * 331 * sizeof *a);
    free(a);
    free(b);
}

static void the_impulse_of_pairs_with_one_smoothing_is_zero(void **state) {
    (void)state;
    const struct stretch groups[] = {{400, 0.1}, {600, 0.3}};
    const int n = 1000;
    double *const u = velocity(2, groups, PAIRWISE_OF_PAIR, 1), *const v = u + n;
    double sum_u = 0, sum_v = 0, size = 0;
    for (int i = 0; i < n; i++) {
        sum_u += cloud.circulation[i] * u[i];
        sum_v += cloud.circulation[i] * v[i];
        size += fabs(cloud.circulation[i] * u[i]) + fabs(cloud.circulation[i] * v[i]);
    }
    assert_true(size > 100);
    NEAR(sum_u, 0, 1e-14 * size, 0);
    NEAR(sum_v, 0, 1e-14 * size, 0);
    free(u);
}

static void threads_change_no_bit(void **state) {
    (void)state;
    const struct stretch groups[][2] = {{{1, 0.1}, {0, 0}}, {{300, 0.1}, {77, 0.2}}, {{3000, 0.1}, {0, 0}}};
    for (size_t k = 0; k < sizeof groups / sizeof *groups; k++) {
        const size_t size = 2 * (size_t)n_vortices(2, groups[k]) * sizeof(double);
        double *const one = velocity(2, groups[k], PAIRWISE_OF_SOURCE, 1);
        for (int threads = 2; threads <= 5; threads++) {
            double *const more = velocity(2, groups[k], PAIRWISE_OF_SOURCE, threads);
            assert_memory_equal(more, one, size);
            free(more);
        }
        free(one);
    }
}

static void velocity_is_added_to_what_is_there(void **state) {
    (void)state;
    enum { N = 20 };
    const struct stretch group = {N, 0.1};
    double u[N + 1], v[N + 1];
    for (int i = 0; i <= N; i++) u[i] = v[i] = 100;
    struct vortex_group all;
    const struct vortices vortices = grouped(1, &group, &all);
    school_ok(velocity_sum_pairwise(&vortices, PAIRWISE_OF_SOURCE, 1, u, v));
    double *const alone = velocity(1, &group, PAIRWISE_OF_SOURCE, 1);
    for (int i = 0; i < N; i++) {
        NEAR(u[i], 100 + alone[i], 0, 0);
        NEAR(v[i], 100 + alone[N + i], 0, 0);
    }
    NEAR(u[N], 100, 0, 0);
    NEAR(v[N], 100, 0, 0);
    free(alone);
}

static void without_memory_nothing_is_added(void **state) {
    (void)state;
    enum { N = 20 };
    const struct stretch group = {N, 0.1};
    struct vortex_group all;
    const struct vortices vortices = grouped(1, &group, &all);
    int n_failures = 0;
    for (int k = 0;; k++) {
        double u[N] = {0}, v[N] = {0};
        n_until_failure = k;
        const enum status status = velocity_sum_pairwise(&vortices, PAIRWISE_OF_SOURCE, 1, u, v);
        n_until_failure = -1;
        if (status == STATUS_OK) break;
        assert_int_equal(status, STATUS_MEMORY);
        for (int i = 0; i < N; i++) {
            NEAR(u[i], 0, 0, 0);
            NEAR(v[i], 0, 0, 0);
        }
        n_failures++;
    }
    assert_int_equal(n_failures, 3);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(trees_of_every_smoothing_add_up_to_the_direct_sum),
        cmocka_unit_test(the_tree_has_a_tenth_of_the_tolerance),
        cmocka_unit_test(by_plan_it_is_the_same_sum_to_the_tolerance),
        cmocka_unit_test(the_tree_is_for_many_vortices_and_a_tolerance),
        cmocka_unit_test(velocities_are_those_of_all_vortices_at_all_others),
        cmocka_unit_test(every_group_has_its_own_smoothing_or_that_of_a_pair),
        cmocka_unit_test(groups_of_one_smoothing_have_the_bits_of_one_group),
        cmocka_unit_test(the_impulse_of_pairs_with_one_smoothing_is_zero),
        cmocka_unit_test(threads_change_no_bit),
        cmocka_unit_test(velocity_is_added_to_what_is_there),
        cmocka_unit_test(without_memory_nothing_is_added),
    };
    return cmocka_run_group_tests(tests, scatter, NULL);
}
