/* study_plan.h: which members of a study are to be run. Tested by tests/study/test_study_plan.c.
 *
 * A member is finished when its file is complete and was made by the same case. */
#ifndef STUDY_PLAN_H
#define STUDY_PLAN_H

#include "base/status.h"
#include "case/case_values.h"

struct study_plan {
    int n_members, n_done; /* that the call is about; those of them that are finished */
    int n, *member;        /* numbers of the others                                (n) */
    int max_threads;       /* of one of these */
};

/* Check all members from first to last (last -1: all), and list those that are not finished. force: allow the folder to
 * hold results of another study, and remove those beyond the last member. The caller frees the plan, also after a
 * failure. Fails with STATUS_CASE (there are no such members, or one is no valid case), STATUS_FILE (the folder holds
 * results of another study) or STATUS_MEMORY. */
enum status study_plan_create(struct study_plan *plan, const struct case_values *study, const char *folder, int first,
                              int last, int force);
void study_plan_free(struct study_plan *plan);

#endif
