#include "near.h"

#include <stdbool.h>
#include <stdlib.h>

// ---- the tests of a program, in the order of their lines

enum { MAX_TESTS = 128 };
static struct CMUnitTest tests[MAX_TESTS];
static int lines[MAX_TESTS], n_tests, now = -1;
static CMFixtureFunction set_up_group, tear_down_group;
static struct arena *arena, *of_group; /* of the test that runs; of the functions around all tests */

struct arena *test_arena(void) {
    if (!arena) arena = arena_create(NULL, "a test");
    return arena;
}

double *test_array(int n) {
    return arena_new(test_arena(), (size_t)n, sizeof(double));
}

double *test_copy(int n, const double *values) {
    return memcpy(test_array(n), values, (size_t)n * sizeof *values);
}

void near_add(int line, struct CMUnitTest test) {
    if (n_tests == MAX_TESTS) abort();
    int at = n_tests++;
    for (; at > 0 && lines[at - 1] > line; at--) {
        tests[at] = tests[at - 1];
        lines[at] = lines[at - 1];
    }
    tests[at] = test;
    lines[at] = line;
}

void near_group(CMFixtureFunction set_up, CMFixtureFunction tear_down) {
    set_up_group = set_up;
    tear_down_group = tear_down;
}

// before and after each test
static int begin(void **state) {
    if (now < 0) of_group = arena;
    arena = NULL;
    now++;
    return tests[now].setup_func ? tests[now].setup_func(state) : 0;
}

static int end(void **state) {
    const int failed = tests[now].teardown_func ? tests[now].teardown_func(state) : 0;
    arena_free(arena);
    arena = of_group;
    return failed;
}

int near_run(void) {
    struct CMUnitTest all[MAX_TESTS];
    for (int i = 0; i < n_tests; i++) {
        all[i] = tests[i];
        all[i].setup_func = begin;
        all[i].teardown_func = end;
    }
    const int failed = _cmocka_run_group_tests("tests", all, (size_t)n_tests, set_up_group, tear_down_group);
    arena_free(of_group);
    return failed;
}

// weak: a program may have a main of its own
__attribute__((weak)) int main(void) {
    return near_run();
}

// ---- comparisons

void near_fail(const char *name, double got, const char *relation, double bound, const char *file, int line) {
    print_error("%s: got %.17g, which is not %s %.17g\n", name, got, relation, bound);
    _fail(file, line);
}

void near_int(const char *name, const char *wanted, long long got, long long want, const char *file, int line) {
    if (got == want) return;
    const bool is_status = strncmp(wanted, "STATUS_", 7) == 0 || strncmp(wanted, "SHOAL_", 6) == 0;
    print_error("%s: got %lld, want %s, which is %lld%s%s\n", name, got, wanted, want, is_status ? ": " : "",
                is_status ? status_message() : "");
    _fail(file, line);
}

double near_excess(double got, double want, double atol, double rtol) {
    if (got == want) return 0;  // infinities too
    const double excess = fabs(got - want) - (atol + rtol * fabs(want));
    return isnan(excess) ? INFINITY : excess;
}

void near_check(const char *name, double got, double want, double atol, double rtol, const char *file, int line) {
    if (near_excess(got, want, atol, rtol) <= 0) return;
    print_error("%s: got %.17g, want %.17g, atol %g, rtol %g, difference %g\n", name, got, want, atol, rtol,
                got - want);
    _fail(file, line);
}

void near_array(const char *name, int n, const double *got, const double *want, double atol, double rtol,
                const char *file, int line) {
    int worst = 0, n_wrong = 0;
    double worst_excess = 0;
    for (int i = 0; i < n; i++) {
        const double excess = near_excess(got[i], want[i], atol, rtol);
        if (!(excess > 0)) continue;
        n_wrong++;
        if (excess > worst_excess) {
            worst_excess = excess;
            worst = i;
        }
    }
    if (n_wrong == 0) return;
    print_error("%s: %d of %d values differ; the worst is index %d\n", name, n_wrong, n, worst);
    near_check(name, got[worst], want[worst], atol, rtol, file, line);
}
