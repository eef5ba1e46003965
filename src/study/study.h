/* study.h: runs the members of a study, each in a process of its own. Tested by tests/study/test_study.sh and
 * tests/slurm/test_slurm.sh.
 *
 * A second call on the same folder continues the study: finished members are skipped, members with a checkpoint are
 * resumed, and all others run again. */
#ifndef STUDY_H
#define STUDY_H

#include <signal.h>
#include <stdbool.h>
#include <stdio.h>

#include "base/arena.h"
#include "base/status.h"
#include "case/case_values.h"

/* Progress of a study. */
struct study_progress {
    int n_members;       /* members requested by this call */
    const char *checked; /* "checked" or "planned", before any member runs; NULL: the members run */
    int n_checked;       /* members so far */
    int n_done;          /* finished members, including earlier calls */
    int n_failed, n_running;
    double part;      /* completed part of the work of this call, 0 to 1 */
    double wall_time; /* of this call, s */
};

struct study_options {
    const char *folder;
    const char *command; /* command line, for the history attribute of the files */
    const char *from;    /* steady state that the first search starts from; NULL: the start of the case */
    int n_processes;     /* simultaneous processes; 0: usable processors over threads per member */
    bool is_part;        /* run only the members from first to last */
    int first, last;
    int n_required; /* the first n_required members must succeed: a failure stops the study */
    double limit;   /* wall time after which a member counts as failed, s; 0: none */
    bool force;     /* remove the results of another study from the folder */
    void (*progress)(const struct study_progress *progress, void *data); /* may be NULL */
    void *data;
    const volatile sig_atomic_t *stop; /* may be NULL */
};

/* Run all unfinished members. *n_failed: number of failed members; the folder contains the reasons. Fails with
 * STATUS_CASE (members that cannot run; no member has run), STATUS_FILE (the folder contains another study, or a
 * process cannot be started), STATUS_SOLVER (a required member has failed), STATUS_STOPPED or STATUS_MEMORY. */
enum status study_run(const struct case_values *values, const struct study_options *options, int *n_failed);

#endif
