/* neighbours.c: sort by x, sweep, and list the overlaps of each box. */
#include "contact/neighbours.h"

#include <stdlib.h>
#include <string.h>

enum status neighbours_create(struct neighbours **neighbours, int n) {
    *neighbours = NULL;
    struct neighbours *const new = calloc(1, sizeof *new);
    if (!new) goto no_memory;
    const size_t size = (size_t)n;
    new->n = n;
    new->box = calloc(size, sizeof *new->box);
    new->order = calloc(size, sizeof *new->order);
    new->filled = calloc(size, sizeof *new->filled);
    new->first = calloc(size + 1, sizeof *new->first);
    if (!new->box || !new->order || !new->filled || !new->first) goto no_memory;
    for (int i = 0; i < n; i++) new->order[i] = i;
    *neighbours = new;
    return STATUS_OK;

no_memory:
    neighbours_free(new);
    return status_fail(STATUS_MEMORY, "out of memory: %d boxes", n);
}

void neighbours_free(struct neighbours *neighbours) {
    if (!neighbours) return;
    free(neighbours->box);
    free(neighbours->order);
    free(neighbours->filled);
    free(neighbours->first);
    free(neighbours->other);
    free(neighbours->pair);
    free(neighbours);
}

// insertion sort by low x: the order hardly changes between two calls
static void order_sort(struct neighbours *neighbours) {
    int *const order = neighbours->order;
    for (int i = 1; i < neighbours->n; i++) {
        const int moving = order[i];
        int j = i;
        for (; j > 0 && neighbours->box[order[j - 1]].low[0] > neighbours->box[moving].low[0]; j--)
            order[j] = order[j - 1];
        order[j] = moving;
    }
}

// reserve memory for one more pair
static int pairs_reserve(struct neighbours *neighbours, int n) {
    if (n + 2 <= neighbours->capacity) return 1;
    const int capacity = neighbours->capacity > 0 ? 2 * neighbours->capacity : 64;
    int *const pair = realloc(neighbours->pair, (size_t)capacity * sizeof *pair);
    if (pair) neighbours->pair = pair;
    int *const other = realloc(neighbours->other, (size_t)capacity * sizeof *other);
    if (other) neighbours->other = other;
    if (!pair || !other) return 0;
    neighbours->capacity = capacity;

    return 1;
}

// store the overlapping pairs in sweep order; returns twice the number of pairs, or -1 if out of memory
static int pairs_sweep(struct neighbours *neighbours) {
    int n = 0;
    for (int i = 0; i < neighbours->n; i++) {
        const int here = neighbours->order[i];
        const struct box *const a = &neighbours->box[here];
        for (int j = i + 1; j < neighbours->n; j++) {
            const int there = neighbours->order[j];
            const struct box *const b = &neighbours->box[there];
            if (b->low[0] > a->high[0]) break;
            if (b->low[1] > a->high[1] || b->high[1] < a->low[1]) continue;
            if (!pairs_reserve(neighbours, n)) return -1;
            neighbours->pair[n++] = here;
            neighbours->pair[n++] = there;
        }
    }

    return n;
}

// insert a number into an ascending list of n numbers
static void ascending_insert(int *list, int n, int number) {
    for (; n > 0 && list[n - 1] > number; n--) list[n] = list[n - 1];
    list[n] = number;
}

enum status neighbours_find(struct neighbours *neighbours) {
    int *const first = neighbours->first;
    memset(first, 0, ((size_t)neighbours->n + 1) * sizeof *first);
    order_sort(neighbours);
    const int n = pairs_sweep(neighbours);
    if (n < 0) return status_fail(STATUS_MEMORY, "out of memory: the neighbours of %d bodies", neighbours->n);
    for (int i = 0; i < n; i++) first[neighbours->pair[i] + 1]++;
    for (int i = 0; i < neighbours->n; i++) first[i + 1] += first[i];
    int *const filled = neighbours->filled;
    memset(filled, 0, (size_t)neighbours->n * sizeof *filled);

    for (int i = 0; i < n; i += 2) {
        const int a = neighbours->pair[i], b = neighbours->pair[i + 1];
        ascending_insert(neighbours->other + first[a], filled[a]++, b);
        ascending_insert(neighbours->other + first[b], filled[b]++, a);
    }

    return STATUS_OK;
}
