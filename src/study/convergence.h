/* convergence.h: the error of a value from the levels of one numerical key; the judgement of error studies and of
 * refined axes. doc/studies.md, "Error bars" and "Convergence". Tested by tests/study/test_convergence.c,
 * test_error_plan.c and test_study_file.c, and by the section "error" of `make verify`.
 *
 *     grid spacing   h_0  <  h_1  <  h_2  <  h_3        from the finest level to the coarsest
 *     value          f_0     f_1     f_2     f_3        f_base is the stated value
 *     difference        d_0     d_1     d_2
 *     order               p       p'                    p of f_0 f_1 f_2, p' of f_1 f_2 f_3
 *
 * A sequence is accepted if the differences have one sign, if p and p' are at least half of the design order of the key
 * and agree to 0.8, and if p is at most 0.5 above the design order. Then |f_0 - limit| <= 1.25
 * d_0/((h_1/h_0)^min(p, design) - 1), to which |f_0 - f_base| is added. Any other sequence is flagged. If the finest of
 * four levels is about twice as fine as the stated one, the error is |f_0 - f_base| plus the larger of d_0 and d_1;
 * otherwise the largest |f_i - f_base|, doubled for fewer than four levels. If p is too high because it jumps from p',
 * d_0 is small by accident: the error is at least that of an accepted sequence. If p is too high without a jump, what
 * remains beyond f_0 is between 0 and Richardson's estimate with the design order.
 *
 * The error of a key has a known sign: the limit is expected at f_base + shift +- spread. An accepted sequence has the
 * shift of Richardson's extrapolation, any other that of the finest level, with a spread of at least d_0 and d_1.
 * Shifts of several keys add with their signs, and the member with the finest levels of all keys adds what they do
 * together; independent spreads add in quadrature. The error of the value is |shift| + spread + noise. */
#ifndef CONVERGENCE_H
#define CONVERGENCE_H

#include <stdbool.h>
#include <stddef.h>

#include "base/arena.h"
#include "case/case_values.h"
#include "case/sweep_quantity.h"
#include "study/member_file.h"

enum {
    CONVERGENCE_LEVELS = 4, /* at most so many levels are judged */
    CONVERGENCE_STEPS = 10, /* at most so many values give a derivative */
    CONVERGENCE_BYTES = 256
};

enum convergence_verdict {
    CONVERGENCE_NONE,      /* all differences are below the noise */
    CONVERGENCE_ACCEPTED,  /* the error comes from the order */
    CONVERGENCE_OBJECTION, /* flagged before any level is known; all following verdicts are flags, too */
    CONVERGENCE_NO_ORDER,  /* the key has no design order */
    CONVERGENCE_FEW,       /* fewer than three levels */
    CONVERGENCE_TURNS,     /* differences of both signs */
    CONVERGENCE_GROWS,     /* an order is not above 0 */
    CONVERGENCE_LOW,       /* an order is below half of the design order */
    CONVERGENCE_HIGH,      /* p is more than 0.5 above the design order */
    CONVERGENCE_CHANGES,   /* p and p' differ by more than 0.8 */
    CONVERGENCE_UNKNOWN    /* a level is missing: the error is NaN */
};

/* The levels of a key. */
struct convergence_levels {
    int n, n_judged;       /* levels; the finest levels that are judged, at most CONVERGENCE_LEVELS */
    int base;              /* level of the stated value, 0 to n - 1 */
    const double *size;    /* grid spacing, growing                                                          (n) */
    double design_order;   /* NaN: none */
    const char *objection; /* reason to distrust any order of these levels; NULL or "": none */
};

/* Verdict and error of a quantity. */
struct convergence_result {
    enum convergence_verdict verdict;
    int first;                  /* the flag is that of the three levels from this level on */
    double error;               /* of the value at the base, in the unit of the quantity */
    double finest_error;        /* of the value at the finest level; NaN: unknown */
    double shift, spread;       /* of a number: the limit is the value at the base + shift +- spread */
    double order, coarse_order; /* p and p'; NaN: too few levels, or equal ones */
};

/* A derivative d ln Q/d ln p = p/Q dQ/dp, with its error. */
struct convergence_slope {
    double value, error;
};

/* The derivative of a quantity at the stated value, from n values at p (1 + step): that of the polynomial through all
 * of them. Its error is the difference from that of the polynomial without the one or two farthest values, plus what
 * noise, a relative error of each value, adds in quadrature. NaN: a value is missing, or fewer than three. base: the
 * value with the step 0 */
struct convergence_slope convergence_find_slope(int n, const double *step, const double *value, int base, double noise);

/* Judge the values of one quantity at the levels, from fine to coarse: a number has y = 0, a missing value is NaN.
 * noise: relative error of a value independent of the levels, of steady search and integrator. */
struct convergence_result convergence_judge(const struct convergence_levels *levels, const double (*value)[2],
                                            double noise);

/* The same for a given exact value: the error is the distance of the finest level, each order follows from two levels,
 * log(e_2/e_1)/log(h_2/h_1). */
struct convergence_result convergence_judge_exact(int n, const double *size, const double (*value)[2],
                                                  const double *exact);

/* Whether a verdict is a flag: the error is a largest difference. */
bool convergence_is_flagged(enum convergence_verdict verdict);

/* The verdict in words: "differences change sign". */
const char *convergence_words(enum convergence_verdict verdict);

/* The reason of a flag with its levels, "differences do not fall from 13 to 25"; "" without a flag. key: value of the
 * key at each level (n). */
void convergence_reason(const struct convergence_levels *levels, const struct convergence_result *result,
                        const double *key, char text[CONVERGENCE_BYTES]);

/* The order p of three values, from fine to coarse: |f_2 - f_1|/|f_1 - f_0| = r^p (s^p - 1)/(r^p - 1) with r = h_1/h_0
 * and s = h_2/h_1 (Roache, Annual Review of Fluid Mechanics 29, 1997). NaN if f_0 = f_1 to rounding, minus infinity if
 * only f_1 = f_2. */
double convergence_order(const double *size, const double (*value)[2]);

/* The relative error of a value of member m independent of the levels: error of the integrator, and of the steady
 * search over the distance travelled per beat (of a Strouhal number: over the extent of the tail path). The error of a
 * search without multipliers is the residual times the ratio of error and residual of the member known, or times 10.
 * values: case of the member but for the keys of the axes; beat: s, 0 of an equilibrium; quantity NULL: any. */
double convergence_noise(const struct case_values *study, const struct case_values *values,
                         const struct member_file *members, int m, int known, double beat, const char *quantity, int f);

// ---- the refined axis of a study: an error study of one key
//
// A group: members that differ in the refined axis only.

/* Convergence of a quantity of a fish (a number, or a point in the plane) over the levels of a refinement. */
struct convergence_row {
    struct convergence_result result; /* error of the finest level, or from a given value */
    double limit[2];                  /* Richardson extrapolation with the observed order; NaN: flagged levels */
    bool is_known;                    /* some level has a value */
    char flag[CONVERGENCE_BYTES];     /* reason of a flag, or "" */
};

struct convergence_orders {
    int axis, n_groups, n_levels, n_fish; /* n_groups 0: no refined axis, all fields below are empty */
    int n_judged;                         /* the finest levels, which determine the error */
    int *level;                           /* number of a value of the axis, from coarse to fine  (n_levels) */
    double *value;                        /* of the refined key                                   (n_levels) */
    double *grid_spacing;                 /* the value of the axis, or 1/(n - 1) of n points      (n_levels) */
    int *first;                           /* the first member of each group                      (n_groups) */
    struct convergence_row *row;          /* (n_groups, SWEEP_N_ORDERS, n_fish) */
    double *error; /* distance from the finest level or the given value; NaN: finest level (as row, n_levels) */
};

/* The index of a row: quantity of sweep_quantities, of a fish, in a group. */
int convergence_place(const struct convergence_orders *orders, int group, int quantity, int fish);

/* Compute errors and orders along the refined axis; without a refined axis there are no groups. */
void convergence_orders_create(struct arena *arena, struct convergence_orders *orders, const struct case_values *study,
                               const struct member_file *members);

// ---- an error study (error_plan.h): judgement of the levels, and refinement
//
// With `within` the stated value moves to finer levels, which adds members. The choice depends on the case and the
// existing members only, so the same files always give the same study.

struct error_study;
struct error_study_key;
struct error_sweep;

/* The next refinement: the key with the largest share of the largest relative error. */
struct error_study_next {
    int key;        /* -1: nothing to refine */
    int place;      /* quantity and fish with the largest relative error */
    double value;   /* next level of the key; NaN: no finer level is a valid case */
    bool is_member; /* a member at this level exists */
    double cost;    /* CPU time of the stated value after over before the refinement, at least 1 */
    double part;    /* predicted error of the key over the value of the quantity; NaN: not predictable */
    double sum;     /* predicted largest error of all keys over the value of a quantity */
};

/* A requested quantity of a fish of a member, or its ratio to that of the twin, or the difference; NaN if a member is
 * not complete. */
double convergence_study_value(const struct error_study *study, const struct member_file *members, int m, int quantity,
                               int fish);

/* The levels of a key for convergence_judge; size: (ERROR_STUDY_LEVELS), filled. */
struct convergence_levels convergence_study_levels(const struct error_study *study, const struct error_study_key *key,
                                                   double *size);

/* Judge all keys by the members, one member for each value of the axis; of all points, or of one point. */
void convergence_sweep_judge(struct error_sweep *sweep, const struct member_file *members);
void convergence_study_judge(struct error_study *study, const struct member_file *members);

/* Find the next refinement of a judged study. */
struct error_study_next convergence_study_next(struct error_study *study, const struct member_file *members);

/* Refine a judged study: move the stated value towards `within` of the case and add the required members to the axis,
 * up to most_members in total. Returns the number of new members; 0: the study is complete. */
int convergence_study_refine(struct error_study *study, const struct member_file *members, int most_members);

/* Describe the cost of a judged study with errors within the bound, "fish.nodes 69: 3.1 times the CPU time", or the
 * reason why the cost is not predictable. */
void convergence_study_say_cost(const struct error_study *study, char words[CONVERGENCE_BYTES]);

#endif
