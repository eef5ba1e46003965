/* test_vortices.c: groups of one smoothing, and the induced velocity. */
#include <stdlib.h>

#include "near.h"
#include "vortex/kernel.h"
#include "vortex/vortices.h"

// vortices with the smoothings 0.1 (3), 0.1 (2), 0.2 (4), 0.1 (1)
static void make(struct vortices *vortices) {
    *vortices = (struct vortices){0};
    assert_int_equal(vortices_append(vortices, 3, 0.1), STATUS_OK);
    assert_int_equal(vortices_append(vortices, 2, 0.1), STATUS_OK);
    assert_int_equal(vortices_append(vortices, 0, 0.3), STATUS_OK);
    assert_int_equal(vortices_append(vortices, 4, 0.2), STATUS_OK);
    assert_int_equal(vortices_append(vortices, 1, 0.1), STATUS_OK);
    for (int i = 0; i < vortices->n; i++) {
        vortices->x[i] = sin(3 * i);
        vortices->y[i] = cos(5 * i);
        vortices->circulation[i] = 1 + 0.1 * i;
    }
}

static double smoothing_of(int i) {
    return i < 5 || i == 9 ? 0.1 : 0.2;
}

static void neighbours_of_one_smoothing_are_one_group(void **state) {
    (void)state;
    struct vortices vortices;
    make(&vortices);
    assert_int_equal(vortices.n, 10);
    assert_int_equal(vortices.n_groups, 3);
    const int first[] = {0, 5, 9}, n[] = {5, 4, 1};
    for (int g = 0; g < 3; g++) {
        assert_int_equal(vortices.group[g].at.first, first[g]);
        assert_int_equal(vortices.group[g].at.n, n[g]);
        NEAR(vortices.group[g].smoothing, smoothing_of(first[g]), 0, 0);
    }
    assert_int_equal((uintptr_t)vortices.x % 64, 0);
    vortices_clear(&vortices);
    assert_int_equal(vortices.n, 0);
    assert_int_equal(vortices.n_groups, 0);
    vortices_free(&vortices);
    vortices_free(&vortices);
}

static void a_pair_has_the_mean_of_squares_in_both_directions(void **state) {
    (void)state;
    NEAR(vortices_pair_smoothing(0.1, 0.1), 0.1, 0, 0);
    NEAR(vortices_pair_smoothing(0.1, 0.7), 0.5, 1e-16, 0);
    NEAR(vortices_pair_smoothing(0.7, 0.1), 0.5, 1e-16, 0);
    struct vortices vortices;
    struct vortex_group group[3];
    make(&vortices);
    const struct vortices felt = vortices_felt_by(&vortices, 0.7, group);
    assert_int_equal(felt.n, 10);
    assert_ptr_equal(felt.x, vortices.x);
    for (int g = 0; g < 3; g++) {
        assert_int_equal(felt.group[g].at.first, vortices.group[g].at.first);
        NEAR(felt.group[g].smoothing, g == 1 ? sqrt(0.53 / 2) : 0.5, 1e-15, 0);
        NEAR(vortices.group[g].smoothing, g == 1 ? 0.2 : 0.1, 0, 0);
    }
    vortices_free(&vortices);
}

static void values_are_kept_when_the_capacity_grows(void **state) {
    (void)state;
    struct vortices vortices;
    make(&vortices);
    assert_int_equal(vortices_append(&vortices, 1000, 0.1), STATUS_OK);
    for (int i = 0; i < 10; i++) NEAR(vortices.circulation[i], 1 + 0.1 * i, 0, 0);
    assert_int_equal(vortices.n_groups, 3);
    assert_int_equal(vortices.group[2].at.n, 1001);
    vortices_free(&vortices);
}

static void a_range_induces_what_its_vortices_do_one_by_one(void **state) {
    (void)state;
    struct vortices vortices;
    make(&vortices);
    enum { N = 3 };
    const double x[N] = {0.3, -0.2, 2}, y[N] = {0.1, 0.4, -1};
    for (int first = 0; first < vortices.n; first++) {
        for (int n = 0; first + n <= vortices.n; n++) {
            double value[5][N] = {{1, 1, 1}, {2, 2, 2}, {3, 3, 3}, {4, 4, 4}, {5, 5, 5}}, u[N] = {1, 1, 1},
                   v[N] = {2, 2, 2};
            const struct induced with = {N, x, y, value[0], value[1], value[2], value[3], value[4]};
            const struct induced without = {N, x, y, u, v, NULL, NULL, NULL};
            vortices_induce(&vortices, (struct range){first, n}, &with);
            vortices_induce(&vortices, (struct range){first, n}, &without);
            for (int p = 0; p < N; p++) {
                double want[5] = {1, 2, 3, 4, 5};
                for (int i = first; i < first + n; i++) {
                    struct kernel_values unit;
                    kernel_unit(1, &x[p], &y[p], vortices.x[i], vortices.y[i], smoothing_of(i), &unit);
                    const double of[5] = {unit.u[0], unit.v[0], unit.u_x[0], unit.u_y[0], unit.v_x[0]};
                    for (int k = 0; k < 5; k++) want[k] += vortices.circulation[i] * of[k];
                }
                for (int k = 0; k < 5; k++) NEAR(value[k][p], want[k], 1e-13, 1e-13);
                NEAR(u[p], want[0], 1e-13, 1e-13);
                NEAR(v[p], want[1], 1e-13, 1e-13);
            }
        }
    }
    vortices_free(&vortices);
}

static void some_targets_leave_out_a_range(void **state) {
    (void)state;
    struct vortices vortices;
    make(&vortices);
    enum { N = 3 };
    const double x[N] = {0.3, -0.2, 2}, y[N] = {0.1, 0.4, -1};
    const struct range left_out = {1, vortices.n - 2}, all = {0, vortices.n};
    // including ranges that begin before the first target or end after the last target
    for (int first = -2; first < N + 2; first++) {
        for (int n = 0; n <= N + 2; n++) {
            double value[5][N] = {{0}}, whole[5][N] = {{0}}, out[5][N] = {{0}};
            const struct induced got = {N, x, y, value[0], value[1], value[2], value[3], value[4]};
            const struct induced every = {N, x, y, whole[0], whole[1], whole[2], whole[3], whole[4]};
            const struct induced of_range = {N, x, y, out[0], out[1], out[2], out[3], out[4]};
            vortices_induce_without(&vortices, left_out, (struct range){first, n}, &got);
            vortices_induce(&vortices, all, &every);
            vortices_induce(&vortices, left_out, &of_range);
            for (int p = 0; p < N; p++) {
                const int without = p >= first && p < first + n;
                for (int k = 0; k < 5; k++) {
                    NEAR(value[k][p], whole[k][p] - (without ? out[k][p] : 0), 1e-13, 1e-13);
                }
            }
        }
    }
    vortices_free(&vortices);
}

static void a_range_of_the_targets_points_into_all(void **state) {
    (void)state;
    double value[7][4] = {{0}};
    const struct induced all = {4, value[0], value[1], value[2], value[3], value[4], value[5], value[6]};
    const struct induced part = vortices_targets(&all, (struct range){1, 2});
    assert_int_equal(part.n, 2);
    assert_true(part.x == &value[0][1] && part.y == &value[1][1] && part.u == &value[2][1] && part.v == &value[3][1]);
    assert_true(part.u_x == &value[4][1] && part.u_y == &value[5][1] && part.v_x == &value[6][1]);
    const struct induced plain = {4, value[0], value[1], value[2], value[3], NULL, NULL, NULL};
    assert_null(vortices_targets(&plain, (struct range){1, 2}).u_x);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(neighbours_of_one_smoothing_are_one_group),
        cmocka_unit_test(a_pair_has_the_mean_of_squares_in_both_directions),
        cmocka_unit_test(values_are_kept_when_the_capacity_grows),
        cmocka_unit_test(a_range_induces_what_its_vortices_do_one_by_one),
        cmocka_unit_test(some_targets_leave_out_a_range),
        cmocka_unit_test(a_range_of_the_targets_points_into_all),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
