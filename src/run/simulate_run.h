/* simulate_run.h: a case from its start, or from a checkpoint, to its end: go from event to event, write the rows and
 * checkpoints that are due. doc/reliability.md. Tested by tests/run/test_simulate.c and tests/run/test_resume.sh. */
#ifndef SIMULATE_RUN_H
#define SIMULATE_RUN_H

#include <signal.h>

#include "base/status.h"
#include "case/case.h"

/* What a run tells while it goes on, after every event. */
struct simulate_progress {
    double t, end;
    long event;
    long steps;     /* of the integrator, in all */
    int n_vortices; /* of all fish */
    double wall_time;
};

struct simulate_options {
    const char *path;    /* of the result file */
    int overwrite;       /* replace one that exists */
    const char *command; /* command line, for the file's history */
    /* times of checkpoints besides those of the case, s: "0.3,1.25"; NULL: none. They must be times of events */
    const char *checkpoint_at;
    /* told the case and the path of the result before the work begins, which a failure of it prevents; may be NULL */
    enum status (*begin)(const struct case_values *values, const char *path, void *data);
    void (*progress)(const struct simulate_progress *progress, void *data); /* may be NULL */
    /* told each warning about the result, before the run returns; may be NULL */
    void (*warn)(const char *line, void *data);
    /* told in one line what a user should know, such as that a damaged checkpoint is not used; may be NULL */
    void (*note)(const char *line, void *data);
    void *data;
    /* the run stops once this is not 0, with a checkpoint; SIGALRM: its time is over; may be NULL */
    const volatile sig_atomic_t *stop;
};

/* Run a case into a result file. On STATUS_SOLVER, STATUS_CONTACT and STATUS_STOPPED the file is closed with all rows
 * up to there; after STATUS_STOPPED there is a checkpoint too. Fails with STATUS_FILE, too, where an unfinished result
 * of the case stands there, or another run writes it. */
enum status simulate_run(const struct case_values *values, const struct simulate_options *options);

/* What is other in a run that is resumed. */
struct simulate_changes {
    int n_assignments;
    const char *const *assignments; /* of solver.threads, which changes no result, and of time.end */
    int has_other_end;              /* whether that is among them */
};

/* Go on from a checkpoint, into the result that it belongs to; path and overwrite of the options are not used. With
 * another end the result is made again with its rows, and may have been complete before. Where the checkpoint cannot be
 * used, the one before it is. Fails as simulate_run, and with STATUS_FILE where neither can. */
enum status simulate_resume(const char *checkpoint, const struct simulate_changes *changes,
                            const struct simulate_options *options);

#endif
