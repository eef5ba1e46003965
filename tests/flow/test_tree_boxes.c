/* test_tree_boxes.c: Any number of threads sorts the points of the tree into the same boxes. */
#include <stdlib.h>
#include <string.h>

#include "flow/tree_boxes.h"
#include "school.h"

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
    struct tree_boxes boxes = {.arena = test_arena()};
    tree_boxes_fill(&boxes, N, x, y, weight, leaf, threads);
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

TEST(threads_make_the_same_boxes) {
    scatter();
    struct tree_boxes one = filled(LEAF, 1), more = filled(LEAF, 3);
    assert_encloses(&one);
    assert_same(&more, &one);
}
