/* error_budget.h: the error of a value from the levels of one numerical key: a pure function of sequences.
 * doc/studies.md, "Error bars". Tested by tests/study/test_error_budget.c and by the section "error" of `make verify`.
 *
 *     grid spacing   h_0  <  h_1  <  h_2  <  h_3        from the finest level to the coarsest
 *     value          f_0     f_1     f_2     f_3        f_base is the stated value
 *     difference        d_0     d_1     d_2
 *     order               p       p'                    p of f_0 f_1 f_2, p' of f_1 f_2 f_3
 *
 * A sequence is accepted if the differences have one sign and fall (p, p' > 0), and if p and p' agree with the design
 * order of the key. Then |f_0 - limit| <= 1.25 d_0/((h_1/h_0)^min(p, design) - 1), to which |f_0 - f_base|
 * is added. All sequences of a key are judged together: one rejected sequence flags all sequences of the key. The error
 * of a flagged sequence is the largest |f_i - f_base|, doubled for fewer than four levels. */
#ifndef ERROR_BUDGET_H
#define ERROR_BUDGET_H

#include <stddef.h>

enum { ERROR_BUDGET_LEVELS = 4 /* the finest ones are judged */ };

enum error_budget_verdict {
    ERROR_BUDGET_NONE,      /* all differences are below the noise */
    ERROR_BUDGET_ACCEPTED,  /* the error comes from the order */
    ERROR_BUDGET_OBJECTION, /* flagged before any level is known; all following verdicts are flags, too */
    ERROR_BUDGET_NO_ORDER,  /* the key has no design order */
    ERROR_BUDGET_FEW,       /* fewer than three levels */
    ERROR_BUDGET_TURNS,     /* differences of both signs */
    ERROR_BUDGET_GROWS,     /* an order is not above 0 */
    ERROR_BUDGET_LOW,       /* an order is more than 1 below the design order */
    ERROR_BUDGET_CHANGES, /* p and p' differ by more than 0.8, p is not far above the design order and does not rise */
    ERROR_BUDGET_UNKNOWN  /* a level is missing: the error is NaN */
};

/* The levels of a key. */
struct error_budget_levels {
    int n, base;
    const double *size;    /* grid spacing, growing                                                          (n) */
    double design_order;   /* NaN: none */
    const char *objection; /* reason to distrust any order of these levels; NULL: none */
};

/* One quantity at these levels. */
struct error_budget_sequence {
    const double (*value)[2]; /* a number has y = 0; NaN: missing                                            (n) */
    double noise;             /* relative error of a value independent of the levels: steady search and integrator */
};

/* Verdict and error of a quantity. */
struct error_budget_result {
    enum error_budget_verdict verdict; /* on this sequence alone */
    double error;                      /* of the value at the base, in the unit of the quantity */
    double finest_error;               /* of the value at the finest level; NaN: flagged key */
    double order, coarse_order;        /* p and p'; NaN: too few levels, or equal ones */
};

/* Judge n sequences of one key together. *culprit: the first sequence that flags the key, or -1. Only the finest
 * ERROR_BUDGET_LEVELS levels count, and the base must be one of these levels. */
enum error_budget_verdict error_budget_judge(const struct error_budget_levels *levels, int n,
                                             const struct error_budget_sequence *sequences,
                                             struct error_budget_result *results, int *culprit);

/* Whether a verdict is a flag: the error is a largest difference. */
int error_budget_is_flagged(enum error_budget_verdict verdict);

/* The verdict in words: "differences change sign". */
const char *error_budget_words(enum error_budget_verdict verdict);

/* The order p of three values, from fine to coarse: |f_2 - f_1|/|f_1 - f_0| = r^p (s^p - 1)/(r^p - 1) with r = h_1/h_0
 * and s = h_2/h_1 (Roache, Annual Review of Fluid Mechanics 29, 1997). NaN if f_0 = f_1 to rounding, minus infinity if
 * only f_1 = f_2. */
double error_budget_order(const double *size, const double (*value)[2]);

#endif
