/* array.c: arrays of zeros. */
#include "base/array.h"

#include <stdlib.h>

enum status array_doubles(double **values, int n, const char *what) {
    *values = calloc(n > 0 ? (size_t)n : 1, sizeof **values);
    return *values ? STATUS_OK : status_fail(STATUS_MEMORY, "out of memory: %s, %d numbers", what, n);
}

enum status array_many_doubles(double **const *values, int n_arrays, int n, const char *what) {
    for (int i = 0; i < n_arrays; i++) TRY(array_doubles(values[i], n, what));
    return STATUS_OK;
}
