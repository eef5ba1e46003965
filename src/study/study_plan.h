/* study_plan.h: selection of the unfinished members of a study. Tested by tests/study/test_study_plan.c.
 *
 * A member is finished if the member file is complete and was written by the same case. */
#ifndef STUDY_PLAN_H
#define STUDY_PLAN_H

#include "base/status.h"
#include "case/case_values.h"

struct study_plan {
    int n_members, n_done; /* requested members; finished members among the requested ones */
    int n, *member;        /* numbers of the unfinished members                    (n) */
    int max_threads;       /* largest number of threads of an unfinished member */
};

/* Check all members from first to last (last -1: all) and list the unfinished members. force: accept results of another
 * study in the folder, and remove such results beyond the last member. The caller frees the plan, also after a failure.
 * Fails with STATUS_CASE (no such members, or a member is not a valid case), STATUS_FILE (the folder contains results
 * of another study) or STATUS_MEMORY. */
enum status study_plan_create(struct study_plan *plan, const struct case_values *study, const char *folder, int first,
                              int last, int force);
void study_plan_free(struct study_plan *plan);

#endif
