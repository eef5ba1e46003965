/* checkpoints.h: times and files of the checkpoints of a run. The checkpoint of RESULT.nc is RESULT.ckpt, the
 * checkpoint of a RESULT without this ending is RESULT.checkpoint; the previous checkpoint has the ending .previous in
 * addition. Tested by tests/run/test_checkpoints.c and tests/run/test_resume.sh.
 *
 * Every run renews the simulation (simulate_renew) at each checkpoint before the end of the run, resumed or not. A
 * resumed run therefore has the bits of the uninterrupted run. */
#ifndef CHECKPOINTS_H
#define CHECKPOINTS_H

#include <stdbool.h>

#include "base/arena.h"
#include "base/status.h"
#include "case/case.h"
#include "result/checkpoint.h"
#include "run/record.h"
#include "run/simulate.h"

struct checkpoints {
    struct arena *arena;
    char *path, *previous;
    char *word;            /* the path for a command line */
    const char *result;    /* name of the result file, in the same folder */
    const char *effective; /* the complete case */
    long interval;         /* in events; 0: none */
    int n_at;
    long *at;           /* further events with a checkpoint                                      (n_at) */
    const char *places; /* times of the further checkpoints so far, as in --checkpoint-at */
    long last_place;    /* event of the last further checkpoint; -1: none yet */
    long last;          /* event of the last checkpoint; -1: none yet */
};

/* The ending of the previous checkpoint, and the path of the checkpoint of a result. */
#define CHECKPOINTS_PREVIOUS ".previous"
char *checkpoints_path(struct arena *arena, const char *result);

/* Plan the checkpoints of a run with this result; the plan is a part of the arena. at: times of further checkpoints, s,
 * separated by commas; may be NULL. Fails with STATUS_CASE (a time in at is not the time of an event) or STATUS_FILE (a
 * file that is not a checkpoint of this result has the name). */
enum status checkpoints_create(struct arena *arena, struct checkpoints *checkpoints, const struct case_values *values,
                               const char *result, const char *at);

/* Continue the plan of a run that is resumed at an event. with_other_end: the result is written again for another end;
 * else the checkpoints keep the case of the resumed checkpoint, regardless of the number of threads now. */
void checkpoints_resume(struct checkpoints *checkpoints, const struct checkpoint *from, long event,
                        bool with_other_end);

/* Remove the files of an earlier run. */
void checkpoints_remove(const struct checkpoints *checkpoints);

/* Whether there is a checkpoint at this event. */
bool checkpoints_are_due(const struct checkpoints *checkpoints, long event);

/* Write a checkpoint at the event of the simulation, after the rows of the record are safe on disk; no-op if the event
 * has a checkpoint. Fails with STATUS_FILE or, as a boundary, with STATUS_MEMORY. */
enum status checkpoints_write(struct checkpoints *checkpoints, const struct simulation *simulation,
                              const struct record *record);

#endif
