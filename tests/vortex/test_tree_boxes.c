/* test_tree_boxes.c: copied boxes, and boxes with moved points, against boxes sorted from the same points. */
#include <stdlib.h>
#include <string.h>

#include "failing_malloc.h"
#include "near.h"
#include "vortex/tree_boxes.h"

enum { N = 3000, LEAF = 50 };

static double x[N], y[N], weight[N];

static void scatter(void) {
    for (int i = 0; i < N; i++) {
        x[i] = 10 * sin(17.0 * i);
        y[i] = 3 * cos(5.0 * i * i);
        weight[i] = i;
    }
}

static struct tree_boxes filled(int leaf, int threads) {
    struct tree_boxes boxes = {0};
    assert_int_equal(tree_boxes_fill(&boxes, N, x, y, weight, leaf, threads), STATUS_OK);
    return boxes;
}

static void assert_same(const struct tree_boxes *got, const struct tree_boxes *want) {
    assert_int_equal(got->n, want->n);
    assert_int_equal(got->depth, want->depth);
    assert_int_equal(got->n_boxes, want->n_boxes);
    assert_memory_equal(got->box, want->box, (size_t)want->n_boxes * sizeof *want->box);
    assert_memory_equal(got->index, want->index, N * sizeof *want->index);
    assert_memory_equal(got->x, want->x, N * sizeof *want->x);
    assert_memory_equal(got->y, want->y, N * sizeof *want->y);
    assert_memory_equal(got->weight, want->weight, N * sizeof *want->weight);
}

// every point is inside the circle of the leaf, and of all parent boxes
static void assert_encloses(const struct tree_boxes *boxes) {
    for (int b = 0; b < boxes->n_boxes; b++) {
        const struct tree_box *const box = &boxes->box[b];
        double farthest = 0;
        for (int i = box->first; i < box->first + box->n; i++) {
            farthest = fmax(farthest, hypot(boxes->x[i] - box->x, boxes->y[i] - box->y));
        }
        NEAR(box->radius, farthest, 0, 1e-15);  // one point is at the edge
    }
}

static void boxes_know_the_points_that_they_hold(void **state) {
    (void)state;
    scatter();
    struct tree_boxes boxes = filled(LEAF, 1);
    assert_true(tree_boxes_hold(&boxes, N, x, y, LEAF));
    assert_false(tree_boxes_hold(&boxes, N, x, y, LEAF / 2));
    assert_false(tree_boxes_hold(&boxes, N - 1, x, y, LEAF));
    assert_false(tree_boxes_hold(&boxes, N, y, x, LEAF));
    x[1234] += 1e-12;
    assert_false(tree_boxes_hold(&boxes, N, x, y, LEAF));
    x[1234] = NAN;
    assert_false(tree_boxes_hold(&boxes, N, x, y, LEAF));
    tree_boxes_clear(&boxes);
    assert_false(tree_boxes_hold(&boxes, 0, x, y, LEAF));
}

static void a_copy_is_what_the_same_points_would_make(void **state) {
    (void)state;
    scatter();
    struct tree_boxes from = filled(LEAF, 1), copy = {0};
    for (int i = 0; i < N; i++) weight[i] = -2 * i;
    struct tree_boxes want = filled(LEAF, 1);
    n_until_failure = 0;
    assert_int_equal(tree_boxes_copy(&copy, &from, weight), STATUS_MEMORY);
    n_until_failure = -1;
    assert_int_equal(copy.n, 0);
    assert_int_equal(tree_boxes_copy(&copy, &from, weight), STATUS_OK);
    assert_same(&copy, &want);
    assert_int_equal(tree_boxes_copy(&copy, &from, NULL), STATUS_OK);
    for (int i = 0; i < N; i++) assert_true(copy.weight[i] == 0);
    tree_boxes_clear(&from);
    tree_boxes_clear(&copy);
    tree_boxes_clear(&want);
}

static void points_that_move_stay_in_their_boxes(void **state) {
    (void)state;
    scatter();
    struct tree_boxes boxes = filled(LEAF, 1), more = filled(LEAF, 1), want = filled(LEAF, 1);
    tree_boxes_move(&boxes, x, y, weight, 1);
    assert_same(&boxes, &want);
    const double far[] = {1e-3, 0.3, 100};
    for (int k = 0; k < 3; k++) {
        scatter();
        for (int i = 0; i < N; i++) {
            x[i] += far[k] * sin(3.0 * i);
            y[i] += far[k] * cos(7.0 * i);
            weight[i] = 1.0 / (i + k + 1);
        }
        tree_boxes_move(&boxes, x, y, weight, 1);
        assert_encloses(&boxes);
        assert_memory_equal(boxes.index, want.index, sizeof(int) * N);
        for (int i = 0; i < N; i++) {
            const int from = boxes.index[i];
            assert_true(boxes.x[i] == x[from] && boxes.y[i] == y[from] && boxes.weight[i] == weight[from]);
        }
        tree_boxes_move(&more, x, y, weight, 4);
        assert_same(&more, &boxes);
    }
    // and back
    scatter();
    tree_boxes_move(&boxes, x, y, weight, 2);
    assert_same(&boxes, &want);
    tree_boxes_clear(&boxes);
    tree_boxes_clear(&more);
    tree_boxes_clear(&want);
}

static void threads_make_the_same_boxes(void **state) {
    (void)state;
    scatter();
    struct tree_boxes one = filled(LEAF, 1), more = filled(LEAF, 3);
    assert_encloses(&one);
    assert_same(&more, &one);
    tree_boxes_clear(&one);
    tree_boxes_clear(&more);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(boxes_know_the_points_that_they_hold),
        cmocka_unit_test(a_copy_is_what_the_same_points_would_make),
        cmocka_unit_test(points_that_move_stay_in_their_boxes),
        cmocka_unit_test(threads_make_the_same_boxes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
