/* checkpoints.h: times and files of the checkpoints of a run. The checkpoint of RESULT.nc is RESULT.ckpt, the
 * checkpoint of a RESULT without this ending is RESULT.checkpoint; the previous checkpoint has the ending .previous in
 * addition. Tested by tests/run/test_checkpoints.c and tests/run/test_resume.sh.
 *
 * Every run renews the simulation (simulate_renew) at each checkpoint before the end of the run, resumed or not. A
 * resumed run therefore has the bits of the uninterrupted run. */
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
    struct text word;      /* the path for a command line */
    char *result;          /* name of the result file, in the same folder; owned */
    char *effective;       /* the complete case; owned */
    long interval;         /* in events; 0: none */
    int n_at;
    long *at;           /* further events with a checkpoint; owned                           (n_at) */
    struct text places; /* times of the further checkpoints so far, as in --checkpoint-at */
    long last_place;    /* event of the last further checkpoint; -1: none yet */
    long last;          /* event of the last checkpoint; -1: none yet */
};

/* Path of the checkpoint of a result, and of the previous checkpoint. The caller frees the path. NULL: out of
 * memory. */
char *checkpoints_path(const char *result);
char *checkpoints_previous(const char *path);

/* Plan the checkpoints of a run with this result. at: times of further checkpoints, s, separated by commas; may be
 * NULL. Fails with STATUS_CASE (a time in at is not the time of an event), STATUS_FILE (a file that is not a
 * checkpoint of this result has the name) or STATUS_MEMORY. checkpoints_free releases and zeroes the plan, also after
 * a failure. */
enum status checkpoints_create(struct checkpoints *checkpoints, const struct case_values *values, const char *result,
                               const char *at);
void checkpoints_free(struct checkpoints *checkpoints);

/* Continue the plan of a run that is resumed at an event. with_other_end: the result is written again for another end;
 * else the checkpoints keep the case of the resumed checkpoint, regardless of the number of threads now. Fails with
 * STATUS_MEMORY. */
enum status checkpoints_resume(struct checkpoints *checkpoints, const struct checkpoint *from, long event,
                               int with_other_end);

/* Replace a newest checkpoint that cannot be used by the previous checkpoint. */
void checkpoints_fall_back(const struct checkpoints *checkpoints);

/* Remove the files of an earlier run. */
void checkpoints_remove(const struct checkpoints *checkpoints);

/* Whether there is a checkpoint at this event. */
int checkpoints_are_due(const struct checkpoints *checkpoints, long event);

/* Write a checkpoint at the event of the simulation, after the rows of the record are safe on disk; no-op if the event
 * has a checkpoint. Fails with STATUS_FILE or STATUS_MEMORY. */
enum status checkpoints_write(struct checkpoints *checkpoints, const struct simulation *simulation,
                              const struct record *record);

#endif
