/* memory.c: allocation by the C library, and messages. */
#include "base/memory.h"

#include <stdlib.h>
#include <string.h>

static enum status memory_lack(size_t n, size_t size, const char *what) {
    return status_fail(STATUS_MEMORY, "out of memory: %s, %.0f bytes", what, (double)n * (double)size);
}

// pointer is the address of a pointer of any type, so assign by memcpy
enum status memory_new(void *pointer, size_t n, size_t size, const char *what) {
    void *const memory = calloc(n > 0 ? n : 1, size);
    memcpy(pointer, &memory, sizeof memory);
    return memory ? STATUS_OK : memory_lack(n, size, what);
}

enum status memory_resize(void *pointer, size_t n, size_t size, const char *what) {
    void *memory;
    memcpy(&memory, pointer, sizeof memory);
    if (n == 0) n = 1;
    memory = n <= (size_t)-1 / size ? realloc(memory, n * size) : NULL;
    if (!memory) return memory_lack(n, size, what);

    memcpy(pointer, &memory, sizeof memory);
    return STATUS_OK;
}

enum status memory_arrays(double **const *arrays, size_t n_arrays, int n, const char *what) {
    for (size_t i = 0; i < n_arrays; i++) TRY(MEMORY_NEW(*arrays[i], n, what));
    return STATUS_OK;
}

enum status memory_check(const void *object, const char *what) {
    return object ? STATUS_OK : status_fail(STATUS_MEMORY, "out of memory: %s", what);
}

enum status memory_copy_string(char **copy, const char *string, const char *what) {
    *copy = strdup(string);
    return *copy ? STATUS_OK : memory_lack(strlen(string) + 1, 1, what);
}
