/* memory.h: the allocator: zeroed memory, and the message for a lack of memory. Tested by tests/base/test_memory.c.
 *
 * pointer is a variable of any pointer type; the element is the type that the pointer points to. The caller frees the
 * memory. Each function fails with STATUS_MEMORY and the message "out of memory: WHAT, N bytes". */
#ifndef MEMORY_H
#define MEMORY_H

#include <stddef.h>

#include "base/status.h"

/* Let the pointer point to n zeroed elements, at least one. After a failure the pointer is NULL. */
#define MEMORY_NEW(pointer, n, what) memory_new(&(pointer), (size_t)(n), sizeof *(pointer), what)

/* Resize the memory to n elements, at least one; elements beyond the old size are undefined. After a failure pointer
 * and memory are unchanged. */
#define MEMORY_RESIZE(pointer, n, what) memory_resize(&(pointer), (size_t)(n), sizeof *(pointer), what)

enum status memory_new(void *pointer, size_t n, size_t size, const char *what);
enum status memory_resize(void *pointer, size_t n, size_t size, const char *what);

/* MEMORY_NEW for a list of arrays of n numbers each; arrays after a failed allocation are unchanged. */
#define MEMORY_ARRAYS(arrays, n, what) memory_arrays(arrays, sizeof(arrays) / sizeof *(arrays), n, what)
enum status memory_arrays(double **const *arrays, size_t n_arrays, int n, const char *what);

/* Fail with STATUS_MEMORY and the message "out of memory: WHAT" if an object of a library is NULL. */
enum status memory_check(const void *object, const char *what);

/* A copy of a string. After a failure *copy is NULL. */
enum status memory_copy_string(char **copy, const char *string, const char *what);

#endif
