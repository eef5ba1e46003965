/* near.h: cmocka, and comparisons in double that print all values when they fail.
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

#include "base/status.h"

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

static inline void near_fail(const char *name, double got, const char *relation, double bound, const char *file,
                             int line) {
    print_error("%s: got %.17g, which is not %s %.17g\n", name, got, relation, bound);
    _fail(file, line);
}

#undef assert_int_equal
#define assert_int_equal(got, want) near_int(#got, #want, (long long)(got), (long long)(want), __FILE__, __LINE__)

static inline void near_int(const char *name, const char *wanted, long long got, long long want, const char *file,
                            int line) {
    if (got == want) return;
    const int is_status = strncmp(wanted, "STATUS_", 7) == 0 || strncmp(wanted, "SHOAL_", 6) == 0;
    print_error("%s: got %lld, want %s, which is %lld%s%s\n", name, got, wanted, want, is_status ? ": " : "",
                is_status ? status_message() : "");
    _fail(file, line);
}

/* By how much got misses its tolerance; 0 or less when near, infinite for NaN. */
static inline double near_excess(double got, double want, double atol, double rtol) {
    if (got == want) return 0;  // infinities too
    const double excess = fabs(got - want) - (atol + rtol * fabs(want));
    return isnan(excess) ? INFINITY : excess;
}

static inline void near_check(const char *name, double got, double want, double atol, double rtol, const char *file,
                              int line) {
    if (near_excess(got, want, atol, rtol) <= 0) return;
    print_error("%s: got %.17g, want %.17g, atol %g, rtol %g, difference %g\n", name, got, want, atol, rtol,
                got - want);
    _fail(file, line);
}

static inline void near_array(const char *name, int n, const double *got, const double *want, double atol, double rtol,
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

#endif
