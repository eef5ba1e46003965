/* near.h: cmocka, and NEAR and NEAR_ARRAY: compare in double and say all that is needed when it fails.
 *
 *     NEAR(got, want, atol, rtol)                passes when |got - want| <= atol + rtol |want|
 *     NEAR_ARRAY(n, got, want, atol, rtol)       the same for each of n values; names the worst index
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

#define NEAR(got, want, atol, rtol) near_check(#got, (got), (want), (atol), (rtol), __FILE__, __LINE__)
#define NEAR_ARRAY(n, got, want, atol, rtol) near_array(#got, (n), (got), (want), (atol), (rtol), __FILE__, __LINE__)

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
