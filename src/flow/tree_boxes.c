/* tree_boxes.c: each box is halved across its longer side, at the median. */
#include "flow/tree_boxes.h"

#include <math.h>
#include <stdbool.h>

#include "base/parallel.h"

struct tree_point {
    double at[2], weight;
    int index;
};

// Reorder the points around the middle one along an axis (quickselect): those before it are not greater, those after it
// not less.
static void points_halve(struct tree_point *point, int n, int middle, int axis) {
    int low = 0, high = n - 1;
    while (low < high) {
        const double pivot = point[low + (high - low) / 2].at[axis];
        int i = low, j = high;
        while (i <= j) {
            while (point[i].at[axis] < pivot) i++;
            while (point[j].at[axis] > pivot) j--;
            if (i > j) break;
            const struct tree_point other = point[i];
            point[i++] = point[j];
            point[j--] = other;
        }

        if (middle <= j) {
            high = j;
        } else if (middle >= i) {
            low = i;
        } else {
            return;
        }
    }
}

// Find the circle around the smallest rectangle of the points of box i. Unless it is a leaf, halve the box across the
// longer side of the rectangle. Nothing but the points and the halves of box i changes, so threads can divide a level.
static void box_divide(struct tree_boxes *boxes, int i, bool is_leaf) {
    struct tree_box *const box = &boxes->box[i];
    struct tree_point *const point = boxes->work + box->first;
    double low[2] = {point->at[0], point->at[1]}, high[2] = {point->at[0], point->at[1]};
    for (int p = 1; p < box->n; p++) {
        for (int axis = 0; axis < 2; axis++) {
            const double at = point[p].at[axis];
            low[axis] = at < low[axis] ? at : low[axis];
            high[axis] = at > high[axis] ? at : high[axis];
        }
    }

    box->x = low[0] + (high[0] - low[0]) / 2;
    box->y = low[1] + (high[1] - low[1]) / 2;
    double square = 0;
    for (int p = 0; p < box->n; p++) {
        const double rx = point[p].at[0] - box->x, ry = point[p].at[1] - box->y;
        const double distance = rx * rx + ry * ry;
        square = distance > square ? distance : square;
    }

    // the radius is a divisor, so it must not be 0 even if all points coincide
    box->radius = fmax(sqrt(square), 1e-100);
    if (is_leaf) return;

    const int axis = high[1] - low[1] > high[0] - low[0], middle = box->n / 2;
    points_halve(point, box->n, middle, axis);
    boxes->box[2 * i + 1] = (struct tree_box){.first = box->first, .n = middle};
    boxes->box[2 * i + 2] = (struct tree_box){.first = box->first + middle, .n = box->n - middle};
}

void tree_boxes_fill(struct tree_boxes *boxes, int n, const double *x, const double *y, const double *weight, int leaf,
                     int threads) {
    int depth = 0;
    while ((n + (1 << depth) - 1) >> depth > leaf) depth++;
    const int n_boxes = n > 0 ? tree_boxes_level(depth + 1) : 0;
    boxes->n = n;
    boxes->depth = depth;
    boxes->n_boxes = n_boxes;
    if (n == 0) return;

    if (n > boxes->capacity) {
        const int capacity = n + n / 2;
        GROW(boxes->arena, boxes->index, capacity);
        GROW(boxes->arena, boxes->x, capacity);
        GROW(boxes->arena, boxes->y, capacity);
        GROW(boxes->arena, boxes->weight, capacity);
        GROW(boxes->arena, boxes->work, capacity);
        boxes->capacity = capacity;
    }
    if (n_boxes > boxes->box_capacity) {
        GROW(boxes->arena, boxes->box, n_boxes);
        boxes->box_capacity = n_boxes;
    }
    struct tree_point *const point = boxes->work;
    const int sharing = parallel_threads(threads, n, n, PARALLEL_SORTED);

#pragma omp parallel for num_threads(sharing) schedule(static)
    for (int i = 0; i < n; i++) {
        point[i] = (struct tree_point){.at = {x[i], y[i]}, .weight = weight ? weight[i] : 0, .index = i};
    }

    boxes->box[0] = (struct tree_box){.first = 0, .n = n};
    for (int level = 0; level <= depth; level++) {
        const int first = tree_boxes_level(level), end = tree_boxes_level(level + 1);

#pragma omp parallel for num_threads(parallel_threads(threads, end - first, n, PARALLEL_SORTED)) schedule(static)
        for (int i = first; i < end; i++) box_divide(boxes, i, level == depth);
    }

#pragma omp parallel for num_threads(sharing) schedule(static)
    for (int i = 0; i < n; i++) {
        boxes->x[i] = point[i].at[0];
        boxes->y[i] = point[i].at[1];
        boxes->weight[i] = point[i].weight;
        boxes->index[i] = point[i].index;
    }
}
