/* test_arena.c: An arena hands out zeroed memory, releases it newest first together with its children, and turns a lack
 * of memory into one message at the nearest boundary. */
#include <stdint.h>
#include <string.h>

#include "base/arena.h"
#include "base/status.h"
#include "failing_malloc.h"
#include "near.h"

TEST(new_memory_is_zero_and_never_null) {
    struct arena *const arena = arena_create(NULL, "a test");
    double *values, *none;
    NEW(arena, values, 3);
    NEW(arena, none, 0);
    NEAR_ARRAY(3, values, ((const double[]){0, 0, 0}), 0, 0);
    assert_non_null(none);
    arena_free(arena);
    arena_free(NULL);
    assert_int_equal(n_live, 0);
}

TEST(memory_grows_with_its_values_and_zeros) {
    struct arena *const arena = arena_create(NULL, "a test");
    double *values = NULL, *other;
    GROW(arena, values, 2);
    NEW(arena, other, 1);
    values[0] = 3;
    values[1] = 4;
    GROW(arena, values, 100000);
    NEAR_ARRAY(3, values, ((const double[]){3, 4, 0}), 0, 0);
    NEAR(values[99999], 0, 0, 0);
    GROW(arena, values, 1);
    GROW(arena, values, 2);
    NEAR_ARRAY(2, values, ((const double[]){3, 0}), 0, 0);
    arena_free(arena);
    assert_int_equal(n_live, 0);
}

TEST(a_text_has_any_length) {
    struct arena *const arena = arena_create(NULL, "a test");
    assert_string_equal(arena_text(arena, "%s %d", "fish", 3), "fish 3");
    assert_int_equal(strlen(arena_text(arena, "%5000d", 1)), 5000);
    arena_free(arena);
}

static char order[8];

static void note(void *letter) {
    order[strlen(order)] = *(const char *)letter;
}

TEST(releases_run_newest_first_and_children_before_older_pieces) {
    memset(order, 0, sizeof order);
    struct arena *const parent = arena_create(NULL, "a parent");
    arena_defer(parent, note, "a");
    struct arena *const child = arena_create(parent, "a child");
    arena_defer(child, note, "b");
    arena_defer(child, note, "c");
    struct arena *const early = arena_create(parent, "freed first");
    arena_defer(early, note, "d");
    arena_defer(parent, note, "e");
    arena_free(early);
    assert_string_equal(order, "d");
    arena_free(parent);
    assert_string_equal(order, "decba");
    assert_int_equal(n_live, 0);
}

TEST(a_moved_arena_belongs_to_its_new_parent) {
    memset(order, 0, sizeof order);
    struct arena *const first = arena_create(NULL, "first"), *const second = arena_create(NULL, "second");
    struct arena *const child = arena_create(first, "a child");
    arena_defer(child, note, "x");
    arena_move(child, second);
    arena_free(first);
    assert_string_equal(order, "");
    arena_move(child, NULL);
    arena_free(second);
    assert_string_equal(order, "");
    arena_free(child);
    assert_string_equal(order, "x");
    assert_int_equal(n_live, 0);
}

static int request(struct arena *arena, size_t n) {
    MEMORY_BOUNDARY(-1);
    double *values;
    NEW(arena, values, n);
    return 0;
}

static int grow(struct arena *arena, double **values, size_t n) {
    MEMORY_BOUNDARY(-1);
    GROW(arena, *values, n);
    return 0;
}

TEST(a_lack_of_memory_ends_the_boundary_with_a_message) {
    struct arena *const arena = arena_create(NULL, "the points");
    assert_int_equal(request(arena, 5), 0);
    n_until_failure = 0;
    assert_int_equal(request(arena, 5), -1);
    n_until_failure = -1;
    assert_string_equal(status_message(), "out of memory: the points, 40 bytes");
    // sizes above the range of size_t, also from a negative number
    assert_int_equal(request(arena, SIZE_MAX / 4), -1);
    assert_int_equal(request(arena, (size_t)-1), -1);

    double *values = NULL;
    assert_int_equal(grow(arena, &values, 2), 0);
    values[1] = 7;
    n_until_failure = 0;
    assert_int_equal(grow(arena, &values, 1000), -1);
    n_until_failure = -1;
    assert_int_equal(grow(arena, &values, SIZE_MAX / 4), -1);
    NEAR(values[1], 7, 0, 0);
    arena_free(arena);
    assert_int_equal(n_live, 0);
}

static int request_twice(struct arena *arena, int *inner) {
    MEMORY_BOUNDARY(-1);
    *inner = request(arena, SIZE_MAX / 4);
    double *values;
    NEW(arena, values, SIZE_MAX / 4);
    return 0;
}

TEST(boundaries_nest) {
    struct arena *const arena = arena_create(NULL, "a test");
    int inner = 0;
    assert_int_equal(request_twice(arena, &inner), -1);
    assert_int_equal(inner, -1);
    assert_int_equal(request(arena, 1), 0);
    arena_free(arena);
}

static int create(void) {
    MEMORY_BOUNDARY(-1);
    arena_free(arena_create(NULL, "a test"));
    return 0;
}

static int defer(struct arena *arena) {
    MEMORY_BOUNDARY(-1);
    arena_defer(arena, note, "z");
    return 0;
}

TEST(an_object_that_cannot_be_deferred_is_released_at_once) {
    memset(order, 0, sizeof order);
    struct arena *const arena = arena_create(NULL, "a solver");
    n_until_failure = 0;
    assert_int_equal(defer(arena), -1);
    n_until_failure = -1;
    assert_string_equal(order, "z");
    arena_free(arena);
    assert_string_equal(order, "z");
}

static int take_nothing(struct arena *arena) {
    MEMORY_BOUNDARY(-1);
    assert_ptr_equal(arena_take(arena, arena), arena);
    arena_take(arena, NULL);
    return 0;
}

TEST(an_arena_or_an_object_of_a_library_may_be_lacking) {
    n_until_failure = 0;
    assert_int_equal(create(), -1);
    n_until_failure = -1;
    struct arena *const arena = arena_create(NULL, "a solver");
    assert_int_equal(take_nothing(arena), -1);
    assert_string_equal(status_message(), "out of memory: a solver");
    arena_free(arena);
    assert_int_equal(n_live, 0);
}
