/* sources.c: arrays of sources that grow. */
#include "wake/sources.h"

#include <stdbool.h>
#include <string.h>

void sources_append(struct sources *sources, int n) {
    double **const array[] = {&sources->x,  &sources->y,    &sources->q,   &sources->dx,
                              &sources->dy, &sources->half, &sources->leg, &sources->square};
    const int first = sources->n, needed = first + n;
    const bool is_full = needed > sources->capacity;
    const int capacity = is_full ? needed + needed / 2 : sources->capacity;
    for (size_t i = 0; i < sizeof array / sizeof *array; i++) {
        if (is_full) GROW(sources->arena, *array[i], capacity);
        if (n > 0) memset(*array[i] + first, 0, (size_t)n * sizeof **array[i]);
    }
    sources->capacity = capacity;
    sources->n = needed;
}
