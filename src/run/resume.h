/* resume.h: search for a usable checkpoint: a complete file, written by this program, with a result that contains all
 * rows up to the checkpoint. Tested by tests/run/test_resume.sh. */
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
    struct result_checksum checksum; /* of the rows of the result */
    int is_complete;                 /* the run of the result has reached the end */
    char *note;                      /* reason for not using the newest checkpoint; NULL: used */
};

/* Open the checkpoint at path or, if this checkpoint cannot be used, the previous checkpoint, and lock the result.
 * Fails with STATUS_FILE and the reason, or with STATUS_MEMORY. resume_close releases everything, including the lock,
 * also after a failure. */
enum status resume_open(struct resume *resume, const char *path);
void resume_close(struct resume *resume);

/* Read the case of the checkpoint with assignments, as case_read does. The values include the text of the case file and
 * the study of the result. Fails with STATUS_CASE, STATUS_FILE or STATUS_MEMORY; *values then owns nothing. */
enum status resume_case(const struct resume *resume, int n_assignments, const char *const *assignments,
                        struct case_values *values);

/* Whether a case (effective) has an unfinished result with a usable checkpoint, or previous checkpoint, of this
 * program; *t: time of the checkpoint, s. */
int resume_is_possible(const char *result, const char *checkpoint, const char *effective, double *t);

#endif
