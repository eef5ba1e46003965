/* checkpoints.h: when a run writes checkpoints, and into which files. The checkpoint of RESULT.nc is RESULT.ckpt; for a
 * RESULT without this ending it is RESULT.checkpoint. The checkpoint before it has the ending .previous in addition.
 * Tested by tests/run/test_checkpoints.c and tests/run/test_resume.sh.
 *
 * A checkpoint is either planned, by time.checkpoint_interval or --checkpoint-at, or it is written because the run is
 * stopped or because time.checkpoint_wall has passed. At a planned checkpoint every run renews the simulation
 * (simulate_renew), whether it is resumed there or not, so a resumed run has the bits of the uninterrupted one. At the
 * others only a resumed run begins anew. Its attribute checkpoint_at then names the place, and a run with this
 * --checkpoint-at has the same bits. In this way the wall time never changes a bit of a run that is not interrupted. */
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
    char *word;            /* the path as a word of a command line */
    const char *result;    /* name of the result file, in the same folder */
    const char *effective; /* the complete case */
    long interval;         /* in events; 0: none */
    int n_at;
    long *at;           /* further events with a checkpoint                                      (n_at) */
    const char *places; /* times of the further checkpoints so far, as in --checkpoint-at */
    bool has_place;     /* whether there was a further checkpoint; its event */
    long last_place;
    bool has_last; /* whether there was a checkpoint; the event of the last one */
    long last;
    double wall;     /* wall time between two checkpoints, s; 0: none */
    double written;  /* clock (monotonic) at the last checkpoint, or at the start of the run, s */
    bool is_by_wall; /* the last checkpoint was written because time.checkpoint_wall had passed */
};

/* The ending of the previous checkpoint, and the path of the checkpoint of a result. */
#define CHECKPOINTS_PREVIOUS ".previous"
char *checkpoints_path(struct arena *arena, const char *result);

/* Plan the checkpoints of a run with this result; the plan is a part of the arena. at: times of further checkpoints, s,
 * separated by commas; may be NULL. Fails with STATUS_CASE if a time in at is not the time of an event, and with
 * STATUS_FILE if the name of the checkpoint belongs to a file that is not a checkpoint of this result. */
enum status checkpoints_create(struct arena *arena, struct checkpoints *checkpoints, const struct case_values *values,
                               const char *result, const char *at);

/* Continue the plan of a run that is resumed at an event. with_other_end: the result is written again for another end;
 * otherwise the checkpoints keep the case of the one resumed from, whatever the number of threads is now. */
void checkpoints_resume(struct checkpoints *checkpoints, const struct checkpoint *from, long event,
                        bool with_other_end);

/* Remove the files of an earlier run. */
void checkpoints_remove(const struct checkpoints *checkpoints);

/* Whether a checkpoint is planned at this event, and whether time.checkpoint_wall has passed since the last one. */
bool checkpoints_are_due(const struct checkpoints *checkpoints, long event);
bool checkpoints_are_due_by_wall(const struct checkpoints *checkpoints);

/* Write a checkpoint at the event of the simulation, after the rows of the record are safe on disk. Does nothing if the
 * event already has one. Fails with STATUS_FILE. */
enum status checkpoints_write(struct checkpoints *checkpoints, const struct simulation *simulation,
                              const struct record *record);

/* The same for a checkpoint that is due by the wall time. Its place is noted in the checkpoint but not in the
 * result. */
enum status checkpoints_write_by_wall(struct checkpoints *checkpoints, const struct simulation *simulation,
                                      const struct record *record);

/* Call this when the run has reached its end and its result is complete: checkpoints that were written for the wall
 * time alone are no longer needed and are removed. */
void checkpoints_end(const struct checkpoints *checkpoints);

#endif
