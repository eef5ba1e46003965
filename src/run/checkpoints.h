/* checkpoints.h: when a run writes checkpoints, and where: RESULT.ckpt beside RESULT.nc, RESULT.checkpoint beside a
 * RESULT without that ending, and the one before it with the ending .previous. Tested by tests/run/test_checkpoints.c
 * and tests/run/test_resume.sh.
 *
 * At each checkpoint but one at the end of the run, every run renews itself (simulate_renew), whether anybody resumes
 * it or not: a run that is resumed there is then the same run. */
#ifndef CHECKPOINTS_H
#define CHECKPOINTS_H

#include "base/status.h"
#include "base/text.h"
#include "case/case.h"
#include "result/checkpoint.h"
#include "run/record.h"
#include "run/simulate.h"

struct checkpoints {
    char *path, *previous; /* owned */
    char *effective;       /* the complete case; owned */
    long interval;         /* in events; 0: none */
    int n_at;
    long *at;           /* further events with a checkpoint; owned                           (n_at) */
    struct text places; /* times of those so far, as in --checkpoint-at */
    long last_place;    /* event of the last one of these; -1: none yet */
    long last;          /* event of the last checkpoint; -1: none yet */
};

/* The path of the checkpoint of a result, and of the one before it; the caller frees it. NULL: out of memory. */
char *checkpoints_path(const char *result);
char *checkpoints_previous(const char *path);

/* Plan the checkpoints of a run with this result. at: more of their times, s, separated by commas; may be NULL. Fails
 * with STATUS_CASE (at holds what is no time of an event), with STATUS_FILE (something else has the name) or with
 * STATUS_MEMORY. checkpoints_free releases and zeroes them, also after a failure. */
enum status checkpoints_create(struct checkpoints *checkpoints, const struct case_values *values, const char *result,
                               const char *at);
void checkpoints_free(struct checkpoints *checkpoints);

/* Go on with those of a run that is resumed at an event. with_other_end: of a result that is made again; else it stays
 * that of its case, whatever threads the run has now. Fails with STATUS_MEMORY. */
enum status checkpoints_resume(struct checkpoints *checkpoints, const struct checkpoint *from, long event,
                               int with_other_end);

/* Let the one before the newest one take its name: the newest one cannot be used. */
void checkpoints_fall_back(const struct checkpoints *checkpoints);

/* Remove the files of an earlier run. */
void checkpoints_remove(const struct checkpoints *checkpoints);

/* Whether there is a checkpoint at this event. */
int checkpoints_are_due(const struct checkpoints *checkpoints, long event);

/* Write a checkpoint of a simulation at its event, once the rows of its record are safe; not twice at one event. Fails
 * with STATUS_FILE or STATUS_MEMORY. */
enum status checkpoints_write(struct checkpoints *checkpoints, const struct simulation *simulation,
                              const struct record *record);

#endif
