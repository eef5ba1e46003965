/* arena.h: memory by owner. Tested by tests/base/test_arena.c.
 *
 * An arena holds all memory of one owner: a case, a school, a simulation, a file. arena_free releases the arena with
 * all pieces, all children and all objects of libraries (arena_defer), the newest first. A part of an owner takes the
 * arena of the owner and has no function that frees it.
 *
 * A request for memory never fails for the caller. A lack of memory sets the message and jumps to the boundary of the
 * thread: the function with MEMORY_BOUNDARY returns. There are three boundaries, each at an entry:
 *
 *     main_choose (app/main.c)      the program: it prints the message and ends with exit code 4
 *     run_member (study/study.c)    the process of a member of a study, which leaves the message to the study
 *     handle_call (library)         a function of include/shoal.h, which returns SHOAL_MEMORY
 *
 * Between the request and the boundary no code runs, so what must not stay has to be known at the boundary. Memory,
 * files and objects of libraries belong to an arena that the caller of the boundary frees, or end with the process; the
 * names of unfinished files are listed by the process (durable_remove_parts); the lock of NetCDF is taken outside of
 * the boundary. A file on the disk needs nothing: it is whole at every instant, because the process may be killed.
 *
 * No memory is requested in a parallel region, out of which no jump is possible; arena_new asserts it. Libraries report
 * their own lack of memory, and the call of the library fails. The equations may need more room while SUNDIALS
 * evaluates them, because wakes grow; the jump then leaves objects of SUNDIALS that can only be freed, which is what
 * their owner does. */
#ifndef ARENA_H
#define ARENA_H

#include <setjmp.h>
#include <stddef.h>

struct arena;

/* Create an arena; it is released with the parent, or earlier by arena_free. parent NULL: released only by arena_free.
 * name: the owner in the message "out of memory: NAME, N bytes"; must outlive the arena. */
struct arena *arena_create(struct arena *parent, const char *name);
void arena_free(struct arena *arena); /* accepts NULL */

/* An arena that is freed when this function returns; a lack of memory leaves it to the boundary. */
#define ARENA(scratch, parent, name) \
    __attribute__((cleanup(arena_leave))) struct arena *const scratch = arena_create(parent, name)
static inline void arena_leave(struct arena *const *arena) {
    arena_free(*arena);
}

/* Let the pointer, of any type, point to n zeroed elements, never NULL. */
#define NEW(arena, pointer, n) ((pointer) = arena_new(arena, (size_t)(n), sizeof *(pointer)))

/* Resize a piece of this arena, or NULL, to n elements; new elements are zero. The piece may move. */
#define GROW(arena, pointer, n) ((pointer) = arena_grow(arena, pointer, (size_t)(n), sizeof *(pointer)))

void *arena_new(struct arena *arena, size_t n, size_t size);
void *arena_grow(struct arena *arena, void *piece, size_t n, size_t size);

/* A text by a printf format. */
char *arena_text(struct arena *arena, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Call release(object) when the arena is freed, or at once if memory is lacking. For objects of libraries, files and
 * locks. */
void arena_defer(struct arena *arena, void (*release)(void *object), void *object);

/* The object of a library, which is NULL if the library had no memory: NULL is a lack of memory of the arena. */
void *arena_take(struct arena *arena, void *object);

/* Move an arena to another parent, or to none. */
void arena_move(struct arena *arena, struct arena *parent);

/* Jump to the boundary for a lack of memory of the owner; n_bytes 0: of an unknown size. */
_Noreturn void arena_lack(const struct arena *arena, double n_bytes);

/* ---- boundaries */

struct boundary {
    jmp_buf jump;
    struct boundary *outer;
};

/* Make the rest of this function a boundary: on a lack of memory below, the function returns the value failure. Local
 * variables that failure reads must not change after this statement. */
#define MEMORY_BOUNDARY(failure)                                                    \
    __attribute__((cleanup(arena_boundary_leave))) struct boundary memory_boundary; \
    arena_boundary_enter(&memory_boundary);                                         \
    if (setjmp(memory_boundary.jump) != 0) return failure

void arena_boundary_enter(struct boundary *boundary);
void arena_boundary_leave(struct boundary *boundary);

#endif
