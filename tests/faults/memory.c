/* memory.c: lets allocations and threads of a program fail on demand, but not those of its libraries.
 * tests/soak/memory.py preloads it (LD_PRELOAD). It cannot be used with the address sanitizer, which has a malloc of
 * its own.
 *
 *     MEMORY_AT      which allocation fails, from 1; 0: none
 *     MEMORY_COUNT   a file to append the number of allocations to at the end
 *     THREAD_AT      from which on threads cannot be started, from 1; 0: all can */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <link.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// glibc's own functions, under names that nobody takes
void *__libc_malloc(size_t size);
void *__libc_calloc(size_t n, size_t size);
void *__libc_realloc(void *memory, size_t size);
void *__libc_memalign(size_t alignment, size_t size);

static uintptr_t program_start, program_end;
static long count, failing;

// the program comes first
static int find_program(struct dl_phdr_info *object, size_t size, void *data) {
    (void)size, (void)data;
    for (int i = 0; i < object->dlpi_phnum; i++) {
        const ElfW(Phdr) *const part = &object->dlpi_phdr[i];
        if (part->p_type != PT_LOAD || !(part->p_flags & PF_X)) continue;
        program_start = object->dlpi_addr + part->p_vaddr;
        program_end = program_start + part->p_memsz;
    }
    return 1;
}

__attribute__((constructor)) static void prepare(void) {
    const char *const at = getenv("MEMORY_AT");
    failing = at ? atol(at) : 0;
    dl_iterate_phdr(find_program, NULL);
}

__attribute__((destructor)) static void report(void) {
    const char *const path = getenv("MEMORY_COUNT");
    FILE *const file = path ? fopen(path, "a") : NULL;
    if (!file) return;
    fprintf(file, "%ld\n", count);
    fclose(file);
}

static bool is_program(const void *caller) {
    return (uintptr_t)caller >= program_start && (uintptr_t)caller < program_end;
}

// whether an allocation for this caller fails
static int fails(const void *caller) {
    if (!is_program(caller) || ++count != failing) return 0;
    errno = ENOMEM;
    return 1;
}
#define FAILS fails(__builtin_return_address(0))

void *malloc(size_t size) {
    return FAILS ? NULL : __libc_malloc(size);
}

void *calloc(size_t n, size_t size) {
    return FAILS ? NULL : __libc_calloc(n, size);
}

void *realloc(void *memory, size_t size) {
    return FAILS ? NULL : __libc_realloc(memory, size);
}

void *aligned_alloc(size_t alignment, size_t size) {
    return FAILS ? NULL : __libc_memalign(alignment, size);
}

int pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*start)(void *), void *data) {
    static atomic_long n_threads;
    static int (*real)(pthread_t *, const pthread_attr_t *, void *(*)(void *), void *);
    const char *const text = getenv("THREAD_AT");
    const long at = text ? atol(text) : 0;
    if (at > 0 && is_program(__builtin_return_address(0)) && ++n_threads >= at) return EAGAIN;
    if (!real) *(void **)&real = dlsym(RTLD_NEXT, "pthread_create");
    return real(thread, attributes, start, data);
}

static char *copy(const char *text, size_t length) {
    char *const made = __libc_malloc(length + 1);
    if (!made) return NULL;
    memcpy(made, text, length);
    made[length] = '\0';
    return made;
}

char *strdup(const char *text) {
    return FAILS ? NULL : copy(text, strlen(text));
}

char *strndup(const char *text, size_t n) {
    return FAILS ? NULL : copy(text, strnlen(text, n));
}
