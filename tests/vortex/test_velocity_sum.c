/* test_velocity_sum.c: the sums by trees against the direct sum. */
#include <stdlib.h>
#include <string.h>

#include "near.h"
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

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(trees_of_every_smoothing_add_up_to_the_direct_sum),
        cmocka_unit_test(the_tree_has_a_tenth_of_the_tolerance),
        cmocka_unit_test(by_plan_it_is_the_same_sum_to_the_tolerance),
        cmocka_unit_test(the_tree_is_for_many_vortices_and_a_tolerance),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
