/* error_budget.h: the error of a value from the levels of one numerical key: a pure function of a sequence.
 * doc/studies.md, "Error bars". Tested by tests/study/test_error_budget.c and by the section "error" of `make verify`.
 *
 *     grid spacing   h_0  <  h_1  <  h_2  <  h_3        from the finest level to the coarsest
 *     value          f_0     f_1     f_2     f_3        f_base is the stated value
 *     difference        d_0     d_1     d_2
 *     order               p       p'                    p of f_0 f_1 f_2, p' of f_1 f_2 f_3
 *
 * A sequence is accepted if the differences have one sign, if p and p' are at least half of the design order of the key
 * and agree to 0.8, and if p is at most 0.5 above the design order. Then |f_0 - limit| <= 1.25
 * d_0/((h_1/h_0)^min(p, design) - 1), to which |f_0 - f_base| is added. Any other sequence is flagged: the error is the
 * largest |f_i - f_base|, doubled for fewer than four levels. If p is too high, d_0 is small by accident: the error is
 * the larger of d_0 and d_1, and at least the error of an accepted sequence. */
#ifndef ERROR_BUDGET_H
#define ERROR_BUDGET_H

#include <stddef.h>

enum { ERROR_BUDGET_LEVELS = 4 /* at most so many levels are judged */, ERROR_BUDGET_BYTES = 256 };

enum error_budget_verdict {
    ERROR_BUDGET_NONE,      /* all differences are below the noise */
    ERROR_BUDGET_ACCEPTED,  /* the error comes from the order */
    ERROR_BUDGET_OBJECTION, /* flagged before any level is known; all following verdicts are flags, too */
    ERROR_BUDGET_NO_ORDER,  /* the key has no design order */
    ERROR_BUDGET_FEW,       /* fewer than three levels */
    ERROR_BUDGET_TURNS,     /* differences of both signs */
    ERROR_BUDGET_GROWS,     /* an order is not above 0 */
    ERROR_BUDGET_LOW,       /* an order is below half of the design order */
    ERROR_BUDGET_HIGH,      /* p is more than 0.5 above the design order */
    ERROR_BUDGET_CHANGES,   /* p and p' differ by more than 0.8 */
    ERROR_BUDGET_UNKNOWN    /* a level is missing: the error is NaN */
};

/* The levels of a key. */
struct error_budget_levels {
    int n, n_judged;       /* levels; the finest levels that are judged, at most ERROR_BUDGET_LEVELS */
    int base;              /* level of the stated value, 0 to n - 1 */
    const double *size;    /* grid spacing, growing                                                          (n) */
    double design_order;   /* NaN: none */
    const char *objection; /* reason to distrust any order of these levels; NULL or "": none */
};

/* Verdict and error of a quantity. */
struct error_budget_result {
    enum error_budget_verdict verdict;
    int first;                  /* the flag is that of the three levels from this level on */
    double error;               /* of the value at the base, in the unit of the quantity */
    double finest_error;        /* of the value at the finest level; NaN: unknown */
    double order, coarse_order; /* p and p'; NaN: too few levels, or equal ones */
};

/* Judge the values of one quantity at the levels, from fine to coarse: a number has y = 0, a missing value is NaN.
 * noise: relative error of a value independent of the levels, of steady search and integrator. */
struct error_budget_result error_budget_judge(const struct error_budget_levels *levels, const double (*value)[2],
                                              double noise);

/* Whether a verdict is a flag: the error is a largest difference. */
int error_budget_is_flagged(enum error_budget_verdict verdict);

/* The verdict in words: "differences change sign". */
const char *error_budget_words(enum error_budget_verdict verdict);

/* The reason of a flag with its levels, "differences do not fall from 13 to 25"; "" without a flag. key: value of the
 * key at each level (n). */
void error_budget_reason(const struct error_budget_levels *levels, const struct error_budget_result *result,
                         const double *key, char text[ERROR_BUDGET_BYTES]);

/* The order p of three values, from fine to coarse: |f_2 - f_1|/|f_1 - f_0| = r^p (s^p - 1)/(r^p - 1) with r = h_1/h_0
 * and s = h_2/h_1 (Roache, Annual Review of Fluid Mechanics 29, 1997). NaN if f_0 = f_1 to rounding, minus infinity if
 * only f_1 = f_2. */
double error_budget_order(const double *size, const double (*value)[2]);

#endif
