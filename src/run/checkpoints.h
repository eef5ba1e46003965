/* checkpoints.h: times and files of the checkpoints of a run. The checkpoint of RESULT.nc is RESULT.ckpt, the
 * checkpoint of a RESULT without this ending is RESULT.checkpoint; the previous checkpoint has the ending .previous in
 * addition. Tested by tests/run/test_checkpoints.c and tests/run/test_resume.sh.
 *
 * A checkpoint is planned, by time.checkpoint_interval and --checkpoint-at, or is written because the run is stopped,
 * or because time.checkpoint_wall has passed. Every run renews the simulation (simulate_renew) at each planned
 * checkpoint before its end, resumed or not, so a resumed run has the bits of the uninterrupted run. At the others
 * only a resumed run begins anew: its attribute checkpoint_at names the place, and a run with this --checkpoint-at
 * has the same bits. The wall time therefore never changes a bit of a run that is not interrupted. */
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
    double wall;        /* wall time between two checkpoints, s; 0: none */
    double written;     /* monotonic time of the last checkpoint, or of the start of the run, s */
    bool is_by_wall;    /* the last checkpoint was written because its wall time had come */
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

/* Whether a checkpoint is planned at this event; whether the wall time of a further one has come. */
bool checkpoints_are_due(const struct checkpoints *checkpoints, long event);
bool checkpoints_are_due_by_wall(const struct checkpoints *checkpoints);

/* Write a checkpoint at the event of the simulation, after the rows of the record are safe on disk; no-op if the event
 * has a checkpoint. Fails with STATUS_FILE or, as a boundary, with STATUS_MEMORY. */
enum status checkpoints_write(struct checkpoints *checkpoints, const struct simulation *simulation,
                              const struct record *record);

/* The same for a checkpoint whose wall time has come: the place is noted in the checkpoint, and not in the result. */
enum status checkpoints_write_by_wall(struct checkpoints *checkpoints, const struct simulation *simulation,
                                      const struct record *record);

/* The run has reached its end, and its result is complete: remove the checkpoints of its wall time, unless others were
 * planned. */
void checkpoints_end(const struct checkpoints *checkpoints);

#endif
