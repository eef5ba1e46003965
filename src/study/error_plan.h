/* error_plan.h: the error of a value: each numerical key is varied alone. Keys, levels and members of the study.
 * doc/studies.md, "Error bars". Tested by tests/study/test_error_study.c and test_error.sh.
 *
 *                       fish.nodes               13     17    [25]    35
 *     the case  --<     fish.sheet_points        25     35    [49]    69        [ ]: the stated value
 *                       time.shedding_interval    0.04   0.02 [0.01]   0.005
 *
 * Each level is a member of a study with one axis, which sets all keys that are varied; member 0 is the case. */
#ifndef ERROR_PLAN_H
#define ERROR_PLAN_H

#include "base/status.h"
#include "case/case.h"
#include "case/sweep_error.h"
#include "study/error_budget.h"
#include "study/member_file.h"

enum { ERROR_STUDY_LEVELS = 1 + SWEEP_ERROR_LEVELS, ERROR_STUDY_QUANTITIES = 16 };

/* A numerical key, or a choice of the model, and its levels from fine to coarse. */
struct error_study_key {
    const struct sweep_error_key *row;
    const char *unit;                 /* " beats" if the case gives a duration in beats, otherwise "" */
    int n_levels, stated;             /* number of levels; level of the stated value */
    double value[ERROR_STUDY_LEVELS]; /* of the first fish that has the key */
    int member[ERROR_STUDY_LEVELS];
    int first_stated;                   /* level of the case, before any refinement */
    int n_added;                        /* levels added for `within` */
    char objection[ERROR_BUDGET_BYTES]; /* reason to distrust any order, or ""; n_levels 1: reason for not varying */
    double cost_exponent;               /* exponent of the resolution in the wall time */
    struct error_budget_result *part;   /* of each quantity; for a choice of the model: the change (n_asked, n_fish) */
};

struct error_study {
    struct case_values study;             /* the case, with the axis of members */
    int is_steady, is_static, n_fish;     /* steady states; equilibria, without a beat */
    double beat;                          /* s; 0: none */
    int n_asked;                          /* requested quantities */
    int quantity[ERROR_STUDY_QUANTITIES]; /* numbers of member_file.h */
    int n_keys;
    struct error_study_key key[SWEEP_N_ERROR_KEYS];
    int stated; /* the member of the stated value */
    double *value, *error,
        *together;  /* stated values; errors of the stated values; interaction of keys refined together,
                                         which is a part of the error; NaN: unknown            (n_asked, n_fish) */
    double noise;   /* relative error of the integrator and of the search */
    double cost;    /* CPU time of the stated value over the CPU time of the case */
    int is_reached; /* the error is within the bound of the case, or the case has no bound */
};

/* Plan the members of a case with `error`. Fails with STATUS_CASE (unknown quantity, or no key can be varied) or
 * STATUS_MEMORY; call error_plan_free also after a failure. */
enum status error_plan_create(struct error_study *study, const struct case_values *values);
void error_plan_free(struct error_study *study);

/* The index of a quantity of a fish in part, value and error. */
int error_plan_place(const struct error_study *study, int quantity, int fish);

/* The column of the axis that sets a key, for the first fish; -1: not varied. */
int error_plan_column(const struct error_study *study, const char *path);

/* The grid spacing of a level. */
double error_plan_size(const struct sweep_error_key *row, double value);

/* Find a level of a key near from*factor that is a valid case: points are rounded; an interval divides the beat of a
 * steady state or the end of a run; a step divides the interval. *level NaN: no such level. Fails with
 * STATUS_MEMORY. */
enum status error_plan_find_level(struct error_study *study, int key, double from, double factor, double *level);

/* Insert a value into the levels of a key. error_plan_members then adds *n_new members for all levels without a member.
 * Fails with STATUS_MEMORY. */
void error_plan_insert(struct error_study_key *key, double value);
enum status error_plan_members(struct error_study *study, int *n_new);

/* Find the member with some changes of the case. If no such member exists (*is_new), add a member whose search starts
 * from the state of the member before. error_plan_shorten removes the last members. */
struct error_plan_change {
    int key;
    double value; /* of the first fish; the values of the other fish change in proportion */
};
enum status error_plan_member(struct error_study *study, int n, const struct error_plan_change *changes, int before,
                              int *member, int *is_new);
void error_plan_shorten(struct error_study *study, int n_members);

// ---- error_study.c: judgement of the levels by error_budget.h, and refinement
//
// With `within` the stated value moves to finer levels, which adds members. The choice depends on the case and the
// existing members only, so the same files always give the same study.

/* The next refinement: the key with the largest share of the largest relative error. */
struct error_study_next {
    int key;       /* -1: nothing to refine */
    int place;     /* quantity and fish with the largest relative error */
    double value;  /* next level of the key; NaN: no finer level is a valid case */
    int is_member; /* a member at this level exists */
    double cost;   /* CPU time of the stated value after over before the refinement, at least 1 */
    double part;   /* predicted error of the key over the value of the quantity; NaN: not predictable */
    double sum;    /* predicted largest error of all keys over the value of a quantity */
};

/* The levels of a key as error_budget.h takes them; size: (ERROR_STUDY_LEVELS), filled. */
struct error_budget_levels error_study_levels(const struct error_study *study, const struct error_study_key *key,
                                              double *size);

/* Judge all keys by the members, one member for each value of the axis. */
void error_study_judge(struct error_study *study, const struct member_file *members);

/* Find the next refinement of a judged study. Fails with STATUS_MEMORY. */
enum status error_study_find_next(struct error_study *study, const struct member_file *members,
                                  struct error_study_next *next);

/* Refine a judged study: move the stated value towards `within` of the case and add *n_new required members to the
 * axis, up to most_members in total. *n_new 0: the study is complete. Fails with STATUS_MEMORY. */
enum status error_study_refine(struct error_study *study, const struct member_file *members, int most_members,
                               int *n_new);

/* Describe the cost of a judged study with errors within the bound, "fish.nodes 69: 3.1 times the CPU time", or the
 * reason why the cost is not predictable. */
void error_study_say_cost(const struct error_study *study, char words[ERROR_BUDGET_BYTES]);

#endif
