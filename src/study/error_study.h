/* error_study.h: the errors of quantities of a case: each numerical key is varied alone (error_plan.h), and
 * error_budget.h judges the levels. doc/studies.md, "Error bars". Tested by tests/study/test_error_study.c and
 * test_error.sh.
 *
 * With `within` the stated value moves to finer levels, which adds members. The choice depends on the case and the
 * existing members only, so the same files always give the same study. */
#ifndef ERROR_STUDY_H
#define ERROR_STUDY_H

#include "study/error_plan.h"

/* The next refinement: the key with the largest share. */
struct error_study_next {
    int key;       /* -1: nothing to refine */
    double value;  /* next level of the key; NaN: no finer level is a valid case */
    int is_member; /* a member at this level exists */
    double cost;   /* CPU time of the stated value after over before the refinement */
    double part;   /* predicted largest error of the key over the value of the quantity; NaN: not predictable */
    double sum;    /* predicted largest error of all keys over the value of the quantity */
};

/* Judge all keys by the members, one member for each value of the axis. Fails with STATUS_MEMORY. */
enum status error_study_judge(struct error_study *study, const struct member_file *members);

/* Find the next refinement of a judged study. Fails with STATUS_MEMORY. */
enum status error_study_find_next(struct error_study *study, const struct member_file *members,
                                  struct error_study_next *next);

/* Refine a judged study: move the stated value towards `within` of the case and add *n_new required members to the
 * axis, up to most_members in total. *n_new 0: the study is complete. Fails with STATUS_MEMORY. */
enum status error_study_refine(struct error_study *study, const struct member_file *members, int most_members,
                               int *n_new);

/* Describe the cost of a judged study with errors within the bound, "fish.nodes 69: 3.1 times the CPU time", or the
 * reason why the cost is not predictable. */
void error_study_say_cost(const struct error_study *study, char words[ERROR_STUDY_BYTES]);

#endif
