/* error_study.h: the errors of quantities of a case: each numerical key is varied alone (error_plan.h), and its levels
 * are judged by error_budget.h. doc/studies.md, "Error bars". Tested by tests/study/test_error_study.c and
 * test_error.sh.
 *
 * With `within` the stated value moves to finer levels, and members are added: which ones depends on nothing but the
 * case and the members before, so that the same files always make the same study. */
#ifndef ERROR_STUDY_H
#define ERROR_STUDY_H

#include "study/error_plan.h"

/* What to refine next: the key with the largest share. */
struct error_study_next {
    int key;       /* -1: nothing to refine */
    double value;  /* its next level; NaN: no finer one is a valid case */
    int is_member; /* whether a member has that level already */
    double cost;   /* CPU time of the stated value then, over that now */
    double part;   /* the largest error of the key then, over the value of the quantity; NaN: cannot be predicted */
    double sum;    /* the same of all keys */
};

/* Judge all keys by the members, of which there are as many as the axis has values. Fails with STATUS_MEMORY. */
enum status error_study_judge(struct error_study *study, const struct member_file *members);

/* Of a study that was judged: what to refine next. Fails with STATUS_MEMORY. */
enum status error_study_find_next(struct error_study *study, const struct member_file *members,
                                  struct error_study_next *next);

/* Of a study that was judged: move the stated value towards `within` of the case, and add the members that this needs
 * to the axis, which then has at most this many; *n_new: how many. Where there are none the study is complete. Fails
 * with STATUS_MEMORY. */
enum status error_study_refine(struct error_study *study, const struct member_file *members, int most_members,
                               int *n_new);

/* Of a study that was judged: what it would take to have the errors within the bound, "fish.nodes 69: 3.1 times the
 * CPU time", or why that cannot be said. */
void error_study_say_cost(const struct error_study *study, char words[ERROR_STUDY_BYTES]);

#endif
