/* sources.c: growing arrays. */
#include "wake/sources.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

enum { N_ARRAYS = 8 };

static void sources_arrays(struct sources *sources, double **array[N_ARRAYS]) {
    double **const all[N_ARRAYS] = {&sources->x,  &sources->y,    &sources->q,   &sources->dx,
                                    &sources->dy, &sources->half, &sources->leg, &sources->square};
    memcpy(array, all, sizeof all);
}

void sources_free(struct sources *sources) {
    double **array[N_ARRAYS];
    sources_arrays(sources, array);
    for (int i = 0; i < N_ARRAYS; i++) free(*array[i]);
    *sources = (struct sources){0};
}

enum status sources_append(struct sources *sources, int n) {
    double **array[N_ARRAYS];
    sources_arrays(sources, array);
    const int needed = sources->n + n;

    if (needed > sources->capacity) {
        const int capacity = needed + needed / 2;
        for (int i = 0; i < N_ARRAYS; i++) TRY(MEMORY_RESIZE(*array[i], capacity, "the sources of the flow"));
        sources->capacity = capacity;
    }

    for (int i = 0; i < N_ARRAYS && n > 0; i++) memset(*array[i] + sources->n, 0, (size_t)n * sizeof **array[i]);
    sources->n = needed;
    return STATUS_OK;
}
