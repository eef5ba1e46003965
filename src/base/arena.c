/* arena.c: an arena is a ring of pieces, each from the allocator of the C library, so that sanitizers see every
 * piece. */
#include "base/arena.h"

#include <assert.h>
#include <omp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/status.h"

/* The head of a piece; the memory of the caller follows. */
struct piece {
    _Alignas(16) struct piece *previous;
    struct piece *next;
    size_t size;                   /* bytes after the head */
    void (*release)(void *object); /* called before the piece is freed; NULL: none */
    void *object;
};

/* The memory of the piece of an arena in the ring of its parent. */
struct arena {
    struct piece ring; /* previous: the newest piece, next: the oldest */
    const char *name;
};

static _Thread_local struct boundary *innermost;

void arena_boundary_enter(struct boundary *boundary) {
    boundary->outer = innermost;
    innermost = boundary;
}

void arena_boundary_leave(struct boundary *boundary) {
    innermost = boundary->outer;
}

void arena_lack(const struct arena *arena, double n_bytes) {
    if (n_bytes > 0) {
        status_fail(STATUS_MEMORY, "out of memory: %s, %.0f bytes", arena->name, n_bytes);
    } else {
        status_fail(STATUS_MEMORY, "out of memory: %s", arena->name);
    }
    if (innermost) longjmp(innermost->jump, 1);
    fprintf(stderr, "%s\n", status_message());
    abort();
}

// insert a piece as the newest
static void piece_link(struct piece *piece, struct piece *ring) {
    piece->previous = ring->previous;
    piece->next = ring;
    piece->previous->next = piece->next->previous = piece;
}

// remove a piece from its ring
static void piece_unlink(struct piece *piece) {
    piece->previous->next = piece->next;
    piece->next->previous = piece->previous;
    piece->previous = piece->next = piece;
}

void *arena_new(struct arena *arena, size_t n, size_t size) {
    assert(!omp_in_parallel());
    struct piece *const piece = n <= (SIZE_MAX - sizeof *piece) / size ? calloc(1, sizeof *piece + n * size) : NULL;
    if (!piece) arena_lack(arena, (double)n * (double)size);
    piece->size = n * size;
    piece_link(piece, &arena->ring);
    return piece + 1;
}

void *arena_grow(struct arena *arena, void *old, size_t n, size_t size) {
    if (!old) return arena_new(arena, n, size);
    assert(!omp_in_parallel());
    struct piece *piece = (struct piece *)old - 1;
    const size_t before = piece->size;
    piece = n <= (SIZE_MAX - sizeof *piece) / size ? realloc(piece, sizeof *piece + n * size) : NULL;
    if (!piece) arena_lack(arena, (double)n * (double)size);

    // the neighbours of a moved piece
    piece->previous->next = piece->next->previous = piece;
    piece->size = n * size;
    if (piece->size > before) memset((char *)(piece + 1) + before, 0, piece->size - before);
    return piece + 1;
}

char *arena_text(struct arena *arena, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    const int length = vsnprintf(NULL, 0, format, arguments);
    va_end(arguments);
    char *const text = arena_new(arena, (size_t)length + 1, 1);
    va_start(arguments, format);
    vsnprintf(text, (size_t)length + 1, format, arguments);
    va_end(arguments);
    return text;
}

void arena_defer(struct arena *arena, void (*release)(void *object), void *object) {
    struct piece *const piece = calloc(1, sizeof *piece);
    if (!piece) {
        release(object);
        arena_lack(arena, sizeof *piece);
    }
    piece->release = release;
    piece->object = object;
    piece_link(piece, &arena->ring);
}

void *arena_take(struct arena *arena, void *object) {
    if (!object) arena_lack(arena, 0);
    return object;
}

// release the pieces, the newest first; a release may add pieces
static void arena_release(void *object) {
    struct arena *const arena = object;
    while (arena->ring.previous != &arena->ring) {
        struct piece *const piece = arena->ring.previous;
        piece_unlink(piece);
        if (piece->release) piece->release(piece->object);
        free(piece);
    }
}

struct arena *arena_create(struct arena *parent, const char *name) {
    const struct arena owner = {.name = name};
    struct piece *const piece = calloc(1, sizeof *piece + sizeof owner);
    if (!piece) arena_lack(&owner, sizeof *piece + sizeof owner);
    struct arena *const arena = (struct arena *)(piece + 1);
    arena->ring.previous = arena->ring.next = &arena->ring;
    arena->name = name;
    piece->release = arena_release;
    piece->object = arena;
    piece->previous = piece->next = piece;
    arena_move(arena, parent);
    return arena;
}

void arena_move(struct arena *arena, struct arena *parent) {
    struct piece *const piece = (struct piece *)arena - 1;
    piece_unlink(piece);
    if (parent) piece_link(piece, &parent->ring);
}

void arena_free(struct arena *arena) {
    if (!arena) return;
    arena_move(arena, NULL);
    arena_release(arena);
    free((struct piece *)arena - 1);
}
