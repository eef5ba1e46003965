/* failing_malloc.h: lets allocations of the program fail on demand, and counts those that live.
 *
 * Include it in one file of a test: the Makefile then links every malloc of the program to __wrap_malloc. Libraries
 * keep their own. */
#ifndef FAILING_MALLOC_H
#define FAILING_MALLOC_H

#include <stddef.h>

static _Atomic int n_until_failure = -1;  // -1: never
static _Atomic int n_live;                // allocations that have not been freed
static _Atomic size_t n_bytes;            // requested of malloc and calloc so far

static int may_allocate(void) {
    return n_until_failure < 0 || n_until_failure-- > 0;
}

static void *counted(void *memory) {
    n_live += memory != NULL;
    return memory;
}

void *__real_malloc(size_t size);
void *__real_calloc(size_t n, size_t size);
void *__real_aligned_alloc(size_t alignment, size_t size);
void *__real_realloc(void *memory, size_t size);
char *__real_strdup(const char *text);
char *__real_strndup(const char *text, size_t length);
void __real_free(void *memory);
void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t n, size_t size);
void *__wrap_aligned_alloc(size_t alignment, size_t size);
void *__wrap_realloc(void *memory, size_t size);
char *__wrap_strdup(const char *text);
char *__wrap_strndup(const char *text, size_t length);
void __wrap_free(void *memory);

void *__wrap_malloc(size_t size) {
    n_bytes += size;
    return may_allocate() ? counted(__real_malloc(size)) : NULL;
}

void *__wrap_calloc(size_t n, size_t size) {
    n_bytes += n * size;
    return may_allocate() ? counted(__real_calloc(n, size)) : NULL;
}

void *__wrap_aligned_alloc(size_t alignment, size_t size) {
    return may_allocate() ? counted(__real_aligned_alloc(alignment, size)) : NULL;
}

void *__wrap_realloc(void *memory, size_t size) {
    if (!may_allocate()) return NULL;
    n_live -= memory != NULL;
    return counted(__real_realloc(memory, size));
}

char *__wrap_strdup(const char *text) {
    return may_allocate() ? counted(__real_strdup(text)) : NULL;
}

char *__wrap_strndup(const char *text, size_t length) {
    return may_allocate() ? counted(__real_strndup(text, length)) : NULL;
}

void __wrap_free(void *memory) {
    n_live -= memory != NULL;
    __real_free(memory);
}

#endif
