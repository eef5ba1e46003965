/* resume.h: the search for what a run can go on from: a checkpoint that is whole, was made by this program, and whose
 * rows its result still holds. Tested by tests/run/test_resume.sh. */
#ifndef RESUME_H
#define RESUME_H

#include "base/status.h"
#include "case/case.h"
#include "result/checkpoint.h"
#include "result/result_lock.h"

struct resume {
    struct checkpoint checkpoint;
    char *result; /* path of the result */
    struct result_lock lock;
    struct result_checksum checksum; /* of its rows */
    int is_complete;                 /* its run has reached its end */
    char *note;                      /* why the newest checkpoint is not used; NULL: it is */
};

/* Find the checkpoint at path or, where that cannot be used, the one before it, and lock its result. Fails with
 * STATUS_FILE and the reason, or with STATUS_MEMORY. resume_close releases all, the lock too, also after a failure. */
enum status resume_open(struct resume *resume, const char *path);
void resume_close(struct resume *resume);

/* Read the case of the checkpoint with assignments, as case_read does. It knows the file and the study that the result
 * was made for. Fails with STATUS_CASE, STATUS_FILE or STATUS_MEMORY; *values then owns nothing. */
enum status resume_case(const struct resume *resume, int n_assignments, const char *const *assignments,
                        struct case_values *values);

/* Whether a case (effective) has an unfinished result with a checkpoint there, or one before it, that this program
 * made; *t: its time, s. */
int resume_is_possible(const char *result, const char *checkpoint, const char *effective, double *t);

#endif
