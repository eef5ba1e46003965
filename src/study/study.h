/* study.h: runs the members of a study, each in a process of its own. Tested by tests/study/test_study.sh.
 *
 * The next call on the same folder goes on: finished members are passed over, those with a checkpoint are resumed, and
 * all others run again. */
#ifndef STUDY_H
#define STUDY_H

#include <signal.h>

#include "base/status.h"
#include "case/case_values.h"

/* How far it is. */
struct study_progress {
    int n_members; /* that this call is about */
    int n_done;    /* finished, also before this call */
    int n_failed, n_running;
    double part;      /* of this call's work */
    double wall_time; /* of this call, s */
};

struct study_options {
    const char *folder;
    const char *command; /* command line, for the files' history */
    int n_processes;     /* at once; 0: the usable processors, shared by the threads of the members */
    int first, last;     /* members to run; last -1: all */
    int n_required;      /* once one of the first so many members fails, no more are started */
    double limit;        /* wall time after which a member counts as failed, s; 0: none */
    int force;           /* remove the results of another study from the folder */
    void (*progress)(const struct study_progress *progress, void *data); /* may be NULL */
    void *data;
    const volatile sig_atomic_t *stop; /* may be NULL */
};

/* Run what is not finished; *n_failed of them have failed, and the folder says why. Fails with STATUS_CASE (a member is
 * no valid case: nothing has run), STATUS_FILE (the folder holds something else, or no process can be started),
 * STATUS_SOLVER (a required member has failed), STATUS_STOPPED or STATUS_MEMORY. */
enum status study_run(const struct case_values *values, const struct study_options *options, int *n_failed);

#endif
