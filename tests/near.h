/* near.h: cmocka, tests without a list, and comparisons in double that print all values when they fail.
 *
 *     TEST(a_fact) { ... }                       a test; the main of near.c runs the tests of a program in their order
 *     TEST_WITH(a_fact, set_up, tear_down)       with cmocka's functions around it; *state is what set_up leaves there
 *     TEST_GROUP(set_up, tear_down)              cmocka's functions around all tests of a program
 *     test_arena()                               an arena that is freed at the end of the test
 *     test_array(n), test_copy(n, values)        n zeros, or a copy of n values, in this arena
 *
 *     NEAR(got, want, atol, rtol)                passes when |got - want| <= atol + rtol |want|
 *     NEAR_ARRAY(n, got, want, atol, rtol)       the same for each of n values; names the worst index
 *     BELOW(got, bound), AT_MOST(got, bound)     got < bound, got <= bound
 *     ABOVE(got, bound), AT_LEAST(got, bound)    got > bound, got >= bound
 *
 *     assert_int_equal(got, want)                prints both expressions, so that enums have names, and the message of
 *                                                an unexpected status
 *
 * Each argument is evaluated once. NaN fails; an infinity is near itself only. */
#ifndef NEAR_H
#define NEAR_H

// cmocka.h needs these four before it
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
// clang-format off
#include <setjmp.h>
#include <cmocka.h>
// clang-format on
#include <math.h>
#include <string.h>

#include "base/arena.h"
#include "base/status.h"

#define TEST(name) TEST_WITH(name, NULL, NULL)
#define TEST_WITH(name, set_up, tear_down)                                             \
    static void name(void **state);                                                    \
    __attribute__((constructor)) static void near_add_##name(void) {                   \
        near_add(__LINE__, (struct CMUnitTest){#name, name, set_up, tear_down, NULL}); \
    }                                                                                  \
    static void name(__attribute__((unused)) void **state)
#define TEST_GROUP(set_up, tear_down)                               \
    __attribute__((constructor)) static void near_add_group(void) { \
        near_group(set_up, tear_down);                              \
    }

void near_add(int line, struct CMUnitTest test);
void near_group(CMFixtureFunction set_up, CMFixtureFunction tear_down);
struct arena *test_arena(void);
double *test_array(int n);
double *test_copy(int n, const double *values);
int near_run(void); /* all tests of the program; the exit code. For a main with arguments. */

#define NEAR(got, want, atol, rtol) near_check(#got, (got), (want), (atol), (rtol), __FILE__, __LINE__)
#define NEAR_ARRAY(n, got, want, atol, rtol) near_array(#got, (n), (got), (want), (atol), (rtol), __FILE__, __LINE__)

#define BELOW(got, bound) NEAR_BOUND(got, <, bound)
#define AT_MOST(got, bound) NEAR_BOUND(got, <=, bound)
#define ABOVE(got, bound) NEAR_BOUND(got, >, bound)
#define AT_LEAST(got, bound) NEAR_BOUND(got, >=, bound)
#define NEAR_BOUND(got, relation, bound)                                                                           \
    do {                                                                                                           \
        const double near_got = (double)(got), near_bound = (double)(bound);                                       \
        if (!(near_got relation near_bound)) near_fail(#got, near_got, #relation, near_bound, __FILE__, __LINE__); \
    } while (0)

#undef assert_int_equal
#define assert_int_equal(got, want) near_int(#got, #want, (long long)(got), (long long)(want), __FILE__, __LINE__)

/* By how much got misses its tolerance; 0 or less when near, infinite for NaN. */
double near_excess(double got, double want, double atol, double rtol);

// behind the macros
void near_fail(const char *name, double got, const char *relation, double bound, const char *file, int line);
void near_int(const char *name, const char *wanted, long long got, long long want, const char *file, int line);
void near_check(const char *name, double got, double want, double atol, double rtol, const char *file, int line);
void near_array(const char *name, int n, const double *got, const double *want, double atol, double rtol,
                const char *file, int line);

#endif
