/* test_pairwise.c: the pairs of tiles against the direct sum over all pairs of vortices. */
#include <stdlib.h>
#include <string.h>

#include "school.h"
#include "vortex/kernel.h"
#include "vortex/pairwise.h"

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
    school_ok(pairwise_add_velocity(&vortices, smoothing, threads, u, u + vortices.n));
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
    school_ok(pairwise_add_velocity(&vortices, PAIRWISE_OF_SOURCE, 1, u, v));
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
        const enum status status = pairwise_add_velocity(&vortices, PAIRWISE_OF_SOURCE, 1, u, v);
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
